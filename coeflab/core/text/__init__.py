"""Readers and writers of text: delimited tables, TOML, XML, YAML, names."""

from __future__ import annotations
