"""Added mass by panels on the surface."""

from __future__ import annotations
