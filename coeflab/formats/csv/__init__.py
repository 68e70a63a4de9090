"""Coefficients and tables as CSV."""
