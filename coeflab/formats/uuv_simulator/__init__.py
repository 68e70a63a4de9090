"""uuv_simulator and DAVE."""

from __future__ import annotations
