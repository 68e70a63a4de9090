"""Commands about a vehicle with an arm."""
