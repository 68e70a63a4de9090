"""Errors, units, axes, provenance, citations, the registry of plugins: what every subject needs."""

from __future__ import annotations
