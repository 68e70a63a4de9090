"""Marches through a manoeuvre."""
