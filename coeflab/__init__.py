"""coeflab: virtual CFD-tow and rotating-arm coefficient workbench for underwater vehicles."""

from __future__ import annotations

__version__ = "0.1.0"
