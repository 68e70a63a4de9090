"""Force tables and the campaigns that they come from."""

from __future__ import annotations
