"""Results as drawings."""

from __future__ import annotations
