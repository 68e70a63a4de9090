"""Regression and resampling: arrays in, arrays out."""

from __future__ import annotations
