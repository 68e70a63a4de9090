"""From tables to the rows of a regression."""

from __future__ import annotations
