"""Motions of a vehicle with an arm."""
