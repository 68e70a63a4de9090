"""Uncertainty carried through manoeuvres."""

from __future__ import annotations
