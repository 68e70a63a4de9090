"""gz-sim with added mass in the link."""

from __future__ import annotations
