"""HUUV, a hybrid underwater vehicle steered by two thrusters."""

from __future__ import annotations
