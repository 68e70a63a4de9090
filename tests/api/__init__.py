"""The front door: what a user of coeflab in Python touches."""
