"""Somebody's model file: which format it is, what it says, and what of that cannot be."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, replace
from pathlib import Path

from coeflab.core.errors import InputError
from coeflab.core.limits import JSON_BYTES, XML_BYTES
from coeflab.core.table import Check, Severity
from coeflab.core.text.toml import read_text
from coeflab.core.types import brief
from coeflab.formats import PARAMETER_IMPORTERS
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.plausibility import WRONG, plausibility

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
        None that is known.
    """
    text = read_text(path, max(XML_BYTES, JSON_BYTES))
    if "\0" in text:
        raise InputError("a zero byte", "UTF-8 text", file=path, advice="Save the file as UTF-8.")
    start = text.lstrip()[:1]
    if start == "{":
        return OWN
    if start == "<":
        if "hydrodynamic_model" in text:
            return "uuv_simulator"
        if re.search(r"<plugin[^<>]*hydrodynamics", text, re.IGNORECASE) or "<sdf" in text:
            return "gazebo"
        raise InputError("XML without <hydrodynamic_model> or a Hydrodynamics plugin", _known(), file=path)
    if re.search(r"^[ \t-]*(dynamics|external forces|rotations convention)[ \t]*:", text, re.MULTILINE):
        return "xdyn"
    if re.search(r"^\[+[A-Za-z_][\w.\"'-]*\]+[ \t]*(#.*)?$", text, re.MULTILINE):
        raise InputError("a TOML file", _known(), file=path)
    if re.search(r"^[^%#\n]*\b[XYZKMN]\w*[ \t]*=[ \t]*[-+.\d(\w]", text, re.MULTILINE):
        return "mss"
    raise InputError("a file that no importer knows", _known(), file=path)


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
    stands_in = False
    takes = "density" in inspect.signature(importer.read).parameters
    try:
        parameters = importer.read(path, density=density) if takes and density else importer.read(path)  # type: ignore[call-arg]
    except InputError as why:
        if not takes or density or why.found != "no density":
            raise
        stands_in = True
        parameters = importer.read(path, density=STAND_IN)  # type: ignore[call-arg]
        findings.append(Check(kind, DENSITY, Severity.NOTE, f"{STAND_IN:g} kg/m^3 stands in", "a density in the file",
                              "Only primes depend on it; give --density."))  # fmt: skip
    examine = getattr(importer, "examine", None)
    findings += examine(path) if examine is not None else ()
    told = stands_in or any(c.subject.startswith(DENSITY) for c in findings)
    found = [c for c in plausibility(parameters) if not (told and c.subject == DENSITY)]
    return ModelFile(kind, parameters, (*findings, *(_in_terms_of(c, importer) for c in found)))


def _in_terms_of(check: Check, importer: object) -> Check:
    """A finding about a sign, with the signs that the format itself takes."""
    signs = getattr(importer, "signs", "")
    return replace(check, comment=f"{check.comment} {signs}") if signs and check.comment.endswith(WRONG) else check


def _known() -> str:
    return "a parameter file, SDF with the Hydrodynamics plugin, uuv_simulator URDF or xacro, xdyn YAML, or MSS .m"
