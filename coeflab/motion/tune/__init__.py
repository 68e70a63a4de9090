"""Parameters tuned to measured motions."""

from __future__ import annotations
