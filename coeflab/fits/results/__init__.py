"""What fits return."""

from __future__ import annotations
