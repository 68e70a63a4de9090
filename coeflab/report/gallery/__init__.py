"""Reports and parameter files of a folder, in the browser."""

from __future__ import annotations
