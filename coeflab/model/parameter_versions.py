"""Versions of the parameter file: what came when, and files of earlier versions written as such."""

from __future__ import annotations

import copy
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from coeflab.core.errors import InputError, shown

VERSIONS = {
    "1.0": "Coefficients with uncertainty and covariance, scaling, conditions, mass, covered ranges, provenance.",
    "1.1": "Fitted tables and force laws (models).",
    "1.2": "Added mass and the potential part of every coefficient; damping about a state of rest; centre of gravity and "
    "inertia matrix; what the half-widths of models hold; the status form_assumed.",
    "1.3": "Buoyancy, gravity, thrusters and the limits of control surfaces.",
}
_MINOR = re.compile(r"1\.\d{1,6}", re.ASCII)
FIRST_VERSION, SCHEMA_VERSION = next(iter(VERSIONS)), next(reversed(VERSIONS))


def since(field: FieldInfo) -> str:
    """The version that brought a field."""
    extra = field.json_schema_extra
    return str(extra["since"]) if isinstance(extra, dict) and "since" in extra else FIRST_VERSION


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
    raise InputError(
        "no schema_version" if version is None else f"schema_version {shown(version)}",
        f"{FIRST_VERSION} to {SCHEMA_VERSION}, which this release of coeflab reads", file=file, column="schema_version",
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


def too_new(model: BaseModel, version: str) -> str:
    """The first field with a value of its own that came after a version, in words; empty where there is none."""
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if is_later(since(field), version):
            if value != field.get_default(call_default_factory=True):
                return f"{name} came with version {since(field)}; this file says {version}"
        else:
            for part in value if isinstance(value, tuple) else (value,):
                found = too_new(part, version) if isinstance(part, BaseModel) else ""
                if found:
                    return f"{name}.{found}"
    return ""


def as_of(version: str, model: BaseModel) -> dict[str, Any]:
    """The JSON content of a model without the fields that came after a version."""
    return _without_later(model, model.model_dump(mode="json"), version)


def _without_later(model: BaseModel, content: dict[str, Any], version: str) -> dict[str, Any]:
    return {
        name: _inside(getattr(model, name), content[name], version)
        for name, field in type(model).model_fields.items()
        if not is_later(since(field), version)
    }


def _inside(value: Any, content: Any, version: str) -> Any:
    if isinstance(value, BaseModel):
        return _without_later(value, content, version)
    if isinstance(value, tuple):
        return [_inside(v, c, version) for v, c in zip(value, content, strict=True)]
    return content
