"""FMI 2.0 co-simulation units."""

from __future__ import annotations
