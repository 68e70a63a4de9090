"""Estimates from a shape."""
