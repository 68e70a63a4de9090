"""Coefficients and tables as TOML."""
