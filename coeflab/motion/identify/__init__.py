"""Coefficients from time series of motions."""

from __future__ import annotations
