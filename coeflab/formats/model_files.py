"""Somebody's model file: which format it is, what it says, and what of that cannot be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.limits import JSON_BYTES, XML_BYTES
from coeflab.core.table import Check
from coeflab.core.text.toml import read_text
from coeflab.core.types import brief
from coeflab.core.wording import listed
from coeflab.formats import PARAMETER_IMPORTERS, NoDensityError
from coeflab.vehicle.parameter_file import ParameterFile, file_typed, read_parameter_file, refuse_shape
from coeflab.vehicle.plausibility import plausibility

OWN = "coeflab"
DENSITY = "density"
STAND_IN = 1000.0  # kg/m^3, fresh water; the finding says so


@brief
@dataclass(frozen=True, slots=True)
class ModelFile:
    """A file as read.

    Attributes
    ----------
    format : str
        ``coeflab`` for a parameter file, else the importer.
    parameters : ParameterFile
    findings : tuple of Check
    """

    format: str
    parameters: ParameterFile
    findings: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether nothing failed."""
        return not any(c.severity is Severity.FAIL for c in self.findings)


def recognised(path: Path) -> str:
    """The format of a file by its content.

    Raises
    ------
    InputError
        None that is known, or several.
    """
    path = file_typed(path)
    refuse_shape(path)
    text = read_text(path, max(XML_BYTES, JSON_BYTES))
    if "\0" in text:
        raise InputError("a zero byte", "UTF-8 text", file=path, advice="Save the file as UTF-8.")
    if text.lstrip().startswith("{"):
        return OWN
    importers = {name: PARAMETER_IMPORTERS.load(name) for name in PARAMETER_IMPORTERS.usable()}
    known = [name for name, importer in importers.items() if importer.recognises(path)]
    if len(known) != 1:
        found = f"a file that {listed(known)} both know" if known else "a file that no importer knows"
        raise InputError(found, f"a parameter file, or {', '.join(i.reads for i in importers.values())}", file=path)
    return known[0]


def read_model_file(path: Path, density: float | None = None) -> ModelFile:
    """Read a file of any known format and look for what cannot be.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, for files that state none; else 1000, with a finding that says so. SI values do not depend on it.

    Raises
    ------
    InputError
    PluginError
        The format has no importer here.
    """
    kind = recognised(path)
    if kind == OWN:
        parameters = read_parameter_file(path)
        return ModelFile(kind, parameters, plausibility(parameters))
    try:
        return _imported(path, kind, density)
    except InputError as why:
        if why.file is None:
            why.file = path
        raise


def _imported(path: Path, kind: str, density: float | None) -> ModelFile:
    """The file by its importer."""
    importer = PARAMETER_IMPORTERS.load(kind)
    findings: list[Check] = []
    try:
        parameters = importer.read(path, density)
    except NoDensityError:
        parameters = importer.read(path, STAND_IN)
        findings.append(Check(kind, DENSITY, Severity.NOTE, f"{STAND_IN:g} kg/m^3 is assumed", "a density in the file",
                              "Only primes depend on it; give --density."))  # fmt: skip
    findings += importer.examine(path)
    known = any(c.subject.startswith(DENSITY) for c in findings)
    found = [c for c in plausibility(parameters, importer.signs) if not (known and c.subject == DENSITY)]
    return ModelFile(kind, parameters, (*findings, *found))
