"""Coefficients and tables as CSV."""

from __future__ import annotations
