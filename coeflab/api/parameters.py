"""The parameter file that a person means: a path, a shipped name, a file that was read, a vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol

from coeflab.core.errors import InputError
from coeflab.formats.model_files import OWN, read_model_file, read_vehicle_file
from coeflab.vehicle.coefficient_list import read_coefficient_list, with_sheet
from coeflab.vehicle.conform import conform
from coeflab.vehicle.force_law import EDGE, not_used
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausibility import plausibility

__all__ = [
    "EDGE",
    "OWN",
    "HasParameters",
    "ParameterFile",
    "conform",
    "not_used",
    "parameters_of",
    "plausibility",
    "read_coefficient_list",
    "read_model_file",
    "read_parameters",
    "typed_file",
    "with_sheet",
]  # fmt: skip


class HasParameters(Protocol):
    """What holds a parameter file, as a vehicle does."""

    @property
    def file(self) -> ParameterFile:
        """All of it."""
        ...


def read_parameters(source: str | Path) -> ParameterFile:
    """A parameter file as its JSON has it; `coeflab.read_vehicle` gives it with verbs.

    Parameters
    ----------
    source : str or Path
        A file, the name of a shipped one, or a simulator's model: SDF, URDF, xacro, xdyn YAML, MSS .m, Stonefish .scn.

    Returns
    -------
    ParameterFile

    Raises
    ------
    InputError
        Nothing there; all that breaks the schema, by line.

    Examples
    --------
    >>> read_parameters("remus100").name
    'remus100'
    """
    if not isinstance(source, str | Path):
        raise InputError(f"a {type(source).__name__}", "a path, or the name of a shipped vehicle", column="source")
    return read_vehicle_file(Path(source))


def parameters_of(source: Any) -> ParameterFile:
    """The parameter file of whatever holds one."""
    if isinstance(source, ParameterFile):
        return source
    held = getattr(source, "file", None)
    return held if isinstance(held, ParameterFile) else read_parameters(source)
