"""Parameters tuned to measured motions."""
