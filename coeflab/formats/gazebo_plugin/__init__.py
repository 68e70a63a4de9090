"""gz-sim with added mass in the Hydrodynamics plugin."""

from __future__ import annotations
