"""Closed triangulated surfaces: files, gates, repair, topology, decimation."""

from __future__ import annotations
