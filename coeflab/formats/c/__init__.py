"""C99: header and source of a vehicle."""
