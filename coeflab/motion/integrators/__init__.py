"""Marches through a manoeuvre."""

from __future__ import annotations
