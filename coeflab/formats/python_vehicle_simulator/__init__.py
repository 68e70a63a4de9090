"""Fossen's Python Vehicle Simulator."""

from __future__ import annotations
