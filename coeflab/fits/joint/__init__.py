"""One law fitted over several tables, campaigns and components."""

from __future__ import annotations
