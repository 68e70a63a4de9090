"""Gliders in the vertical plane."""
