"""Versions of the parameter file: what came when, and files of earlier versions written as such."""

from __future__ import annotations

import copy
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.stored import FIRST_VERSION, stored_fields
from coeflab.core.texts import input_error

VERSIONS = {
    "1.0": "Coefficients with uncertainty and covariance, scaling, conditions, mass, covered ranges, provenance.",
    "1.1": "Fitted tables and force laws (models).",
    "1.2": "Added mass and the potential part of every coefficient; damping about a state of rest; centre of gravity and "
    "inertia matrix; what the half-widths of models hold; the status form_assumed.",
    "1.3": "Buoyancy, gravity, thrusters and the limits of control surfaces.",
    "1.4": "The measured points behind the law, how far the law is from them, and the range in which it holds; the status "
    "form_rejected.",
    "1.5": "The status and the origin estimate: numbers from the shape alone, by semi-empirical methods; the origin stated: numbers of whoever wrote the file; added mass near walls.",
    "1.6": "Findings: what is assumed, left out or not assessed, as codes and numbers. The force is the sum of coefficients and tables, by the variables "
    "that they speak of; before, tables or coefficients spoke for a component.",
    "1.7": "Lag of thrusters.",
}
SAME = 1e-6  # relative: numbers of a file that follow from each other
NARROWER = 1e-3  # of a range: less is what a campaign is run at
_MINOR = re.compile(r"1\.\d{1,6}", re.ASCII)
SCHEMA_VERSION = next(reversed(VERSIONS))
SHIPPED = "*.parameters.json"
MESHES, MOST_NAMED = (".stl", ".obj", ".ply", ".glb", ".step", ".stp"), 3


def is_later(version: str, other: str) -> bool:
    """Whether a version came after another."""
    return tuple(map(int, version.split("."))) > tuple(map(int, other.split(".")))


def readable(version: object, file: Path) -> str:
    """The version that a file states.

    Raises
    ------
    InputError
        None, or not one of the first digit that is read here.
    """
    if isinstance(version, str) and _MINOR.fullmatch(version):
        return version
    raise input_error(
        "vehicle.this_release_coeflab", file, column="schema_version",
        found="no schema_version" if version is None else f"schema_version {shown(version)}", first_version=FIRST_VERSION,
        schema_version=SCHEMA_VERSION,
        advice="Is it a parameter file of coeflab?" if version is None else "Read it with the release that wrote it.",
    )  # fmt: skip


def advice(version: str) -> str:
    """What to do about a file that is refused."""
    if not is_later(version, SCHEMA_VERSION):
        return ""
    return f"Update coeflab, or have the file written as version {SCHEMA_VERSION}."


def without(content: Any, places: Sequence[Sequence[int | str]]) -> Any:
    """A copy of JSON content without the keys at these places."""
    out = copy.deepcopy(content)
    for *path, last in places:
        holder = out
        for key in path:
            holder = holder[key]
        del holder[last]
    return out


def too_new(noun: Any, version: str) -> str:
    """The first field with a value of its own that came after a version, in words; empty where there is none."""
    for f in stored_fields(noun.__class__):
        value = getattr(noun, f.name)
        if is_later(f.since, version):
            if value is not f.default and (isinstance(value, np.ndarray) or value != f.default):
                return f"{f.name} came with version {f.since}; this file says {version}"
        else:
            for part in value if isinstance(value, tuple) else (value,):
                if found := too_new(part, version):
                    return f"{f.name}.{found}"
    return ""


def as_of(version: str, noun: Any, content: Any) -> Any:
    """The JSON content of a noun without the fields that came after a version."""
    if known := stored_fields(noun.__class__):
        selected = [f.name for f in known if not is_later(f.since, version)]
        return {name: as_of(version, getattr(noun, name), content[name]) for name in selected if name in content}
    if isinstance(noun, tuple):
        return [as_of(version, v, c) for v, c in zip(noun, content, strict=True)]
    return content
