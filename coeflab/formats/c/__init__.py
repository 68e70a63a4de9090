"""C99: header and source of a vehicle, and the FMU about them."""
