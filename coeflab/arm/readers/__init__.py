"""Body files of a vehicle with an arm."""
