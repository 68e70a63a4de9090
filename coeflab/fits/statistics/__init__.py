"""Regression and resampling: arrays in, arrays out."""
