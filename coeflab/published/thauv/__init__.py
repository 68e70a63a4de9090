"""THAUV, a twin-hull glider."""

from __future__ import annotations
