"""Uncertainty carried through manoeuvres."""
