"""From files of other programs to parameter files: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import ParameterImporter

PARAMETER_IMPORTERS = Registry(__name__, "parameter importer", ParameterImporter)  # type: ignore[type-abstract]
