"""Coefficients and tables as TOML."""

from __future__ import annotations
