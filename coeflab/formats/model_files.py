"""Somebody's model file: which format it is, what it says, and what of that cannot be."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import JSON_BYTES, XML_BYTES
from coeflab.core.table import Check
from coeflab.core.text.toml import read_text
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.core.wording import listed
from coeflab.formats import PARAMETER_IMPORTERS, NoDensityError
from coeflab.law.water import ROUND_DENSITY
from coeflab.vehicle.imported_numbers import DENSITY_OF_WATER
from coeflab.vehicle.parameter_file import ParameterFile, file_typed, read_parameter_file, refuse_shape
from coeflab.vehicle.parameter_refusals import first_complaint
from coeflab.vehicle.plausibility import plausibility

OWN = "coeflab"
OF_DENSITY = frozenset({DENSITY_OF_WATER, "model.in_slugs", "plausibility.air"})  # findings
LEFT_OUT = "model.left_out"


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

    @property
    def left_out(self) -> dict[str, list[str]]:
        """What the file states and the parameter file does not hold: names by kind."""
        out: dict[str, list[str]] = {}
        for f in self.parameters.findings:
            if f.code == LEFT_OUT:
                out.setdefault(str(f["kind"]), []).extend(map(str, f["names"]))
        return out


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
        raise input_error("formats.zero_byte", path)
    if text.lstrip().startswith("{"):
        return OWN
    known = _known(path)
    if len(known) != 1:
        found = f"a file that {listed(known)} both know" if known else "a file that no importer knows"
        kinds = ", ".join(PARAMETER_IMPORTERS.load(name).reads for name in PARAMETER_IMPORTERS.usable())
        raise InputError(found, f"a parameter file, or {kinds}", file=path)
    return known[0]


def _known(path: Path) -> list[str]:
    return [name for name in PARAMETER_IMPORTERS.usable() if PARAMETER_IMPORTERS.load(name).recognises(path)]


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
    except ValidationError as why:  # a number beyond what a parameter file may hold
        refused = first_complaint(why, kind)
        refused.file = path
        raise refused from None
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
        parameters = importer.read(path, ROUND_DENSITY)
        words = Finding.of(
            "model.density", parameters.name, Severity.NOTE, statistic=ROUND_DENSITY, advice="--density 1025"
        )
        parameters = parameters.model_copy(update={"findings": (*parameters.findings, words)})
    findings += importer.examine(path)
    known = any(map(_is_of_density, findings))
    asked = {_question(c) for c in findings if c.severity in (Severity.WARN, Severity.FAIL)}
    found = [
        c for c in plausibility(parameters, importer.signs)
        if not (known and _is_of_density(c)) and _question(c) not in asked
    ]  # fmt: skip
    return ModelFile(kind, parameters, (*findings, *found))


def _is_of_density(check: Check) -> bool:
    return check.finding is not None and check.finding.code in OF_DENSITY


def _question(check: Check) -> tuple[str, str]:
    """What a check asks, whatever the key is called."""
    return check.rule, check.statistic


def read_vehicle_file(path: Path, density: float | None = None) -> ParameterFile:
    """The parameter file of whatever a person names: its own JSON, or a model of any format that is known.

    Parameters
    ----------
    path : path
        Or the name of a shipped file.
    density : float, optional
        kg/m^3, for models that state none.

    Raises
    ------
    InputError
    PluginError
        The format has no importer here.

    Notes
    -----
    What checks of a foreign model found travels with it: a finding counts those that fail or warn.
    """
    typed = file_typed(path)
    refuse_shape(typed)
    if recognised_or_own(typed) == OWN:
        return read_parameter_file(path)
    found = read_model_file(typed, density)
    failed, warned = (sum(c.severity is s for c in found.findings) for s in (Severity.FAIL, Severity.WARN))
    if not failed + warned:
        return found.parameters
    words = Finding.of(
        "model.checks", found.parameters.name, Severity.WARN, statistic=float(failed + warned), threshold=0.0,
        advice=f"coeflab params check {shlex.quote(typed.name)}", format=found.format, failed=failed, warned=warned,
    )  # fmt: skip
    return found.parameters.model_copy(update={"findings": (*found.parameters.findings, words)})


def recognised_or_own(path: Path) -> str:
    """The format of a file; that of a parameter file where it looks like none, whose reader then says what it is."""
    text = read_text(path, max(XML_BYTES, JSON_BYTES))
    if "\0" in text or text.lstrip().startswith("{"):
        return OWN
    known = _known(path)
    return known[0] if len(known) == 1 else OWN
