"""A mesh as simple parts."""

from __future__ import annotations
