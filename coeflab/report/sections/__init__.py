"""Sections of a report, one subject a file."""

from __future__ import annotations
