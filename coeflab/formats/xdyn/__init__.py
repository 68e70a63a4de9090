"""xdyn and lxdyn."""

from __future__ import annotations
