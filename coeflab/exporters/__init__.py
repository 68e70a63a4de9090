"""From parameter files to files of other programs: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Exporter

EXPORTERS = Registry(__name__, "exporter", Exporter)  # type: ignore[type-abstract]
