"""Readers of force tables: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Importer

IMPORTERS = Registry(__name__, "importer", Importer)  # type: ignore[type-abstract]
