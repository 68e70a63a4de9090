"""Motions of a glider."""
