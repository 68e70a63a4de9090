"""The Marine Systems Simulator (MSS)."""

from __future__ import annotations
