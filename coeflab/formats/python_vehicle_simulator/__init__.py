"""Fossen's Python Vehicle Simulator."""
