"""Estimates from the shape against measurements."""
