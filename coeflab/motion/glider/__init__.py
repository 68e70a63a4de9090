"""Gliders in the vertical plane."""

from __future__ import annotations
