"""One document for terminal, HTML, PDF and notebook."""

from __future__ import annotations
