"""Steady motions and operating points."""

from __future__ import annotations
