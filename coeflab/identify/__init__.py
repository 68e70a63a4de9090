"""Coefficients from time series of motions."""
