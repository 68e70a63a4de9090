"""The parameter file: JSON, one body, one scaling, one reference point.

The models below are the schema; ``parameter_file.schema.json`` beside them is generated from them.

Versions of the parameter file: what came when, and files of earlier versions written as such.
"""

from __future__ import annotations

import copy
import json
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError, model_validator

from coeflab.core.axes import Datum
from coeflab.core.errors import CoeflabError, InputError, shown
from coeflab.core.files import named, shipped
from coeflab.core.limits import JSON_BYTES
from coeflab.core.provenance import InputFile
from coeflab.core.stored import FIRST_VERSION, AsStored, Finite, Means, Name, Words, stored_fields
from coeflab.core.table import html_by
from coeflab.core.text.json import parse_json
from coeflab.core.text.model_kinds import model_kind
from coeflab.core.text.toml import read_text, read_toml
from coeflab.core.types import in_angles
from coeflab.core.units import same_unit
from coeflab.core.wording import repeated
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.coefficient import Coefficient
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import derivative
from coeflab.vehicle.law_at_points import HeldRange, LawAtPoints, MeasuredTable
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.parameter_parts import (
    ParameterCovariance,
    ParameterHydrostatics,
    ParameterSurface,
    ParameterThruster,
    Strict,
)

VERSIONS = {
    "1.0": "Coefficients with uncertainty and covariance, scaling, conditions, mass, covered ranges, provenance.",
    "1.1": "Fitted tables and force laws (models).",
    "1.2": "Added mass and the potential part of every coefficient; damping about a state of rest; centre of gravity and "
    "inertia matrix; what the half-widths of models hold; the status form_assumed.",
    "1.3": "Buoyancy, gravity, thrusters and the limits of control surfaces.",
    "1.4": "The measured points behind the law, how far the law is from them, and the range in which it holds; the status "
    "form_rejected.",
    "1.5": "The status and the origin estimate: numbers from the shape alone, by semi-empirical methods; added mass near walls.",
}
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
        kept = [f.name for f in known if not is_later(f.since, version)]
        return {name: as_of(version, getattr(noun, name), content[name]) for name in kept if name in content}
    if isinstance(noun, tuple):
        return [as_of(version, v, c) for v, c in zip(noun, content, strict=True)]
    return content


SCHEMA_FILE = Path(__file__).with_name("parameter_file.schema.json")


class ParameterPoint(Strict):
    """Point that moments, rates and mass moments refer to."""

    point: Annotated[tuple[Finite, Finite, Finite], Means("x y z from the datum, in `axes`", "m")]
    datum: Annotated[
        Words,
        Means(
            "id of the point of the body that points are measured from, for example nose, cg or midship; compared letter by letter"
        ),
    ]
    axes: Annotated[Literal["FRD"], Means("x forward, y starboard, z down")] = "FRD"

    @property
    def origin(self) -> Datum:
        """The datum; phrases of files up to 1.3 stand for ids, as in `coeflab.core.axes`."""
        return Datum.named(self.datum)


class CoveredRange(Strict):
    """Range of a motion variable that a campaign covers."""

    variable: Annotated[Name, Means("asin(v/U) and asin(w/U) as angles; r' = r L/U and other primes; dr ds db")]
    low: Annotated[Finite, Means("lowest value", "see unit")]
    high: Annotated[Finite, Means("highest value", "see unit")]
    unit: Annotated[Literal["rad", "1"], Means("of low and high")]
    campaign: Annotated[str, Means("which campaign covers it")]


class Provenance(Strict):
    """Where it all comes from."""

    coeflab_version: Annotated[str, Means("release that wrote the file")]
    study: Annotated[str, Means("name of the study, or of the model file that was read")]
    inputs: Annotated[tuple[InputFile, ...], Means("every file that went in")]
    citations: Annotated[tuple[str, ...], Means("keys of the works that methods and values rest on")]
    notes: Annotated[tuple[str, ...], Means("what a reader has to know, in words")] = ()


class ParameterFile(Strict):
    """Hydrodynamic coefficients of one body with uncertainty and provenance."""

    schema_version: Annotated[
        str, Field(pattern=r"^1\.\d+$"), Means("version of this schema that the file follows")
    ] = SCHEMA_VERSION
    name: Annotated[Words, Means("name of the set of coefficients; exports are named after it")]
    body: Annotated[Words, Means("the vehicle, and in which configuration")]
    scaling: Annotated[Scaling, AsStored(Scaling), Means("the prime system: Y' = Y / (1/2 rho U^2 L^2), N' with L^3")]
    reference_point: Annotated[ParameterPoint, Means("where all moments and velocities are taken")]
    conditions: Annotated[Conditions, AsStored(Conditions), Means("density and speed of the dimensional values")]
    mass: Annotated[MassProperties | None, Means("mass properties; null where they are not known")]
    coefficients: Annotated[tuple[Coefficient, ...], Means("one entry a symbol, none twice")]
    covariance: Annotated[ParameterCovariance, Means("of the coefficients, as far as it is known")]
    covered: Annotated[tuple[CoveredRange, ...], Means("motions that the tables behind the coefficients cover")]
    models: Annotated[tuple[ParameterModel, ...], Means("fitted tables and force laws", since="1.1")] = ()
    added_mass: Annotated[
        AddedMass | None, Means("added mass in unbounded fluid; null where it is not known", since="1.2")
    ] = None
    hydrostatics: Annotated[
        ParameterHydrostatics | None,
        Means("buoyancy and gravity; null: neutrally buoyant, centres together", since="1.3"),
    ] = None
    thrusters: Annotated[tuple[ParameterThruster, ...], Means("thrusters, none twice", since="1.3")] = ()
    surfaces: Annotated[tuple[ParameterSurface, ...], Means("limits of control surfaces, none twice", since="1.3")] = ()
    measured: Annotated[
        tuple[MeasuredTable, ...], Means("points that the coefficients were fitted to", since="1.4")
    ] = ()
    law_holds: Annotated[
        tuple[HeldRange, ...],
        Means("motions over which the law meets its points; may be less than `covered`", since="1.4"),
    ] = ()
    law_at_points: Annotated[
        tuple[LawAtPoints, ...], Means("how far the law is from its points, by component and table", since="1.4")
    ] = ()
    provenance: Annotated[Provenance, Means("where it all comes from")]

    @property
    def offered(self) -> tuple[CoveredRange, ...]:
        """What is covered, less where the law of a component does not hold; X, which steers nothing, does not narrow it."""
        out = []
        for c in self.covered:
            held = [
                h for h in self.law_holds if (h.variable, h.campaign) == (c.variable, c.campaign) and h.component != "X"
            ]
            low, high = max((h.low for h in held), default=c.low), min((h.high for h in held), default=c.high)
            out.append(c.model_copy(update={"low": max(c.low, low), "high": min(c.high, high)}))
        return tuple(out)

    @property
    def narrowed(self) -> tuple[str, ...]:
        """Where less is offered than is covered, in words."""
        return tuple(
            f"{c.variable} of {c.campaign}: the law holds from {o.low:.3g} to {o.high:.3g}{unit}, the data span {c.low:.3g} to {c.high:.3g}{unit}"
            for c, o in zip(self.covered, self.offered, strict=True)
            for unit in [" rad" if c.unit == "rad" else ""]
            if max(o.low - c.low, c.high - o.high) > NARROWER * max(abs(c.low), abs(c.high))
        )

    @model_validator(mode="after")
    def _consistent(self) -> ParameterFile:
        if self.added_mass is not None:
            point, origin = np.array(self.reference_point.point), self.reference_point.origin
            self.__dict__["added_mass"] = replace(self.added_mass, reference_point=point, datum=origin)
        symbols = [c.symbol for c in self.coefficients]
        twice = repeated(symbols)
        if twice:
            raise ValueError(f"{', '.join(twice)} occurs more than once")
        at = self.conditions
        for c in self.coefficients:
            if c.unit_si and not same_unit(c.unit_si, derivative(c.symbol).unit):
                raise ValueError(
                    f"{c.symbol}: unit_si {shown(c.unit_si)} is not {derivative(c.symbol).unit}, that of its symbol"
                )
            if c.value is None or c.value_si is None:
                continue
            si = c.value * self.scaling.unit(c.symbol, at.density, at.speed)
            if not math.isclose(c.value_si, si, rel_tol=1e-6, abs_tol=1e-12 * abs(si)):
                raise ValueError(
                    f"{c.symbol}: value_si {c.value_si:g} is not its value at these conditions, {si:g}; change one of them, or write null for value_si"
                )
        unknown = sorted(set(self.covariance.symbols) - set(symbols))
        if unknown:
            raise ValueError(f"the covariance names {', '.join(unknown)}, which are no coefficients")
        named = [t.name for t in self.thrusters] + [c.control for c in self.surfaces]
        again = repeated(named)
        if again:
            raise ValueError(f"{', '.join(again)} occurs more than once")
        tables = [(m.response, m.names) for m in self.models]
        for response, names in repeated(tables):
            raise ValueError(f"{response} over {', '.join(names)} occurs more than once")
        strange = too_new(self, self.schema_version)
        if strange:
            raise ValueError(strange)
        self._potential_parts()
        return self

    def _potential_parts(self) -> None:
        """Raise where a potential part is not what the added mass gives."""
        booked = [c for c in self.coefficients if c.potential is not None]
        if booked and self.added_mass is None:
            raise ValueError(f"{booked[0].symbol}: a potential part without an added mass")
        if self.added_mass is None:
            return
        for c in booked:
            due = potential_part(c.symbol, self.added_mass, self.scaling, self.added_mass.density) or 0.0
            if not math.isclose(c.potential or 0.0, due, rel_tol=1e-6, abs_tol=1e-9):
                raise ValueError(f"{c.symbol}: potential {c.potential:g} is not that of the added mass, {due:g}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ParameterFile) and self.model_dump() == other.model_dump()

    def __hash__(self) -> int:
        return hash((self.name, self.body, self.coefficients))

    def coefficient(self, symbol: str) -> Coefficient | None:
        """The coefficient of a symbol, with or without prime."""
        wanted = symbol.removesuffix("'") + "'"
        return next((c for c in self.coefficients if c.symbol == wanted), None)

    def __repr__(self) -> str:
        valued = sum(c.value is not None for c in self.coefficients)
        by = f"{self.scaling.length_name} {self.scaling.length:.5g} m"
        return in_angles(self, f"{self.name}: {valued} of {len(self.coefficients)} coefficients valued, primed by {by}")

    def _repr_html_(self) -> str:
        """The force law and the coefficients, for notebooks."""
        return html_by("parameters", self)

    def to_json(self) -> bytes:
        """The file's bytes: sorted as declared, two blanks of indent, a closing newline, never NaN.

        A file of an earlier version is written as one, without the keys that came later.
        """
        content = as_of(self.schema_version, self, self.model_dump(mode="json"))
        text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
        return (text + "\n").encode()


def schema() -> bytes:
    """The JSON Schema, as shipped."""
    content: dict[str, Any] = ParameterFile.model_json_schema()
    content["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    content["$id"] = f"coeflab-parameter-file-{SCHEMA_VERSION}"
    return (json.dumps(content, indent=2) + "\n").encode()


def _in_words(kind: str, message: str, value: object) -> tuple[str, str]:
    """What pydantic found and expected."""
    if kind == "missing":
        return "nothing", "a value"
    if kind == "extra_forbidden":
        return "an unknown key", "only the keys of the schema"
    if kind == "value_error":
        return message.removeprefix("Value error, "), "a parameter file that agrees with itself"
    return shown(value), message.removeprefix("Input should be ").removeprefix("String should ").removeprefix("have ")


@contextmanager
def refusals_told(place: str) -> Iterator[None]:
    """What the models refuse while a file is put together, as one error.

    Parameters
    ----------
    place : str
        Key that the refused key stands below, for example ``parameter_file.hull``.

    Raises
    ------
    InputError
        In place of pydantic's error.
    """
    try:
        yield
    except ValidationError as why:
        first = why.errors()[0]
        found, expected = _in_words(first["type"], first["msg"], first["input"])
        raise InputError(found, expected, column=".".join(map(str, (place, *first["loc"])))) from None


def file_typed(path: Path) -> Path:
    """The path of a parameter file or model file that a person typed, or the shipped one of that name.

    Raises
    ------
    InputError
        Nothing is there; a vehicle with an arm, which has no parameter file.
    """
    plain = Path(path)
    try:  # a name may be longer than any path can be
        typed = next((p for p in (plain, shipped("geometry") / plain) if p.exists()), plain)
        body = typed / "body.toml" if typed.is_dir() else typed
        is_body = body.suffix == ".toml" and body.is_file()
    except OSError:
        is_body = False
    if is_body:
        head = read_toml(body).content.get("body")
        if isinstance(head, dict) and head.get("reader") == "arm":
            raise InputError(
                f"{shown(str(path), 300)}, a vehicle with an arm, which has no parameter file", "a parameter file",
                advice=f"Write its equations: coeflab derive {path} --to c. Simulate it: coeflab simulate {path}.",
            )  # fmt: skip
    try:
        return named(path, SHIPPED)
    except InputError as why:
        if "suboff" in str(path).lower():
            why.advice = "Its files are fitted, not shipped: `coeflab validate suboff` writes reports/suboff/suboff_fully_appended.parameters.json."
        raise


def refuse_shape(path: Path) -> None:
    """Refuse a mesh or a folder in place of a parameter file; name the file that is meant, or the command that makes one.

    Raises
    ------
    InputError
        It is one of these.
    """
    if path.suffix.lower() in MESHES and path.is_file():
        raise InputError(
            "a mesh", "a parameter file", file=path,
            advice=f"Make one: coeflab vehicle {path} --unit mm --axes FLU --mass MASS, with the mesh's own unit and axes.",
        )  # fmt: skip
    if path.is_dir():
        inside = [str(p) for p in sorted(path.glob(SHIPPED))]
        more = f" and {len(inside) - MOST_NAMED} more" if len(inside) > MOST_NAMED else ""
        advice = f"In it: {', '.join(inside[:MOST_NAMED])}{more}." if inside else ""
        if (path / "campaign.toml").is_file():
            advice = f"This is a campaign: coeflab run {path} fits it and writes the file."
        raise InputError("a folder", "a parameter file, NAME.parameters.json", file=path, advice=advice)


def read_parameter_file(path: Path) -> ParameterFile:
    """Read and validate a parameter file.

    Parameters
    ----------
    path : Path
        Of the file, or the name of a shipped one: ``remus100``.

    Raises
    ------
    InputError
        Not JSON (with line and column), or the first thing that breaks the schema.
    """
    path = file_typed(path)
    refuse_shape(path)
    text = read_text(path, JSON_BYTES)
    if kind := model_kind(text):
        raise InputError(
            f"{kind}, a simulator's model", "a parameter file in JSON", file=path,
            advice=f"Read it by: coeflab params check {path}. Only parameter files are exported, compared and simulated.",
        )  # fmt: skip
    content = parse_json(text, path, "a parameter file in JSON")
    if not isinstance(content, dict):
        raise InputError(f"a {type(content).__name__}", "an object", file=path, column="file")
    version = readable(content.get("schema_version"), path)
    del content  # a large file's content is held once only
    try:
        return _validated(text, version)
    except ValidationError as why:
        first = _telling(why)
        place = _place(first["loc"], text) or "file"
        more = f" ({why.error_count() - 1} more)" if why.error_count() > 1 else ""
        found, expected = _in_words(first["type"], first["msg"], first["input"])
        if is_later(version, SCHEMA_VERSION):
            found += f" in a file of schema_version {version}"
            expected, more = (
                f"schema_version {FIRST_VERSION} to {SCHEMA_VERSION}, which this release of coeflab reads",
                "",
            )
        raise InputError(found, expected + more, file=path, column=place, advice=advice(version)) from None
    except CoeflabError as why:
        raise InputError(str(why), "a valid parameter file", file=path) from None


def _telling(why: ValidationError) -> Any:
    """The first error; where a key is missing beside one that nobody knows, the unknown key, which may be the same misspelt."""
    every = why.errors()
    beside = (e for e in every if e["type"] == "extra_forbidden" and e["loc"][:-1] == every[0]["loc"][:-1])
    return next(beside, every[0]) if every[0]["type"] == "missing" else every[0]


def _place(where: tuple[str | int, ...], text: str) -> str:
    """Keys to a value; of a coefficient its symbol stands for its number."""
    match where:
        case ("coefficients", int(k), *rest):
            symbol = json.loads(text)["coefficients"][k]
            named = symbol.get("symbol") if isinstance(symbol, dict) else None
            return ".".join(map(str, ("coefficients", named if isinstance(named, str) else k, *rest)))
    return ".".join(map(str, where))


def _validated(text: str, version: str) -> ParameterFile:
    """The file; of a later version without the keys that nobody here knows and that say nothing."""
    try:
        return ParameterFile.model_validate_json(text)
    except ValidationError as why:
        if not is_later(version, SCHEMA_VERSION):
            raise
        unknown = [
            e["loc"] for e in why.errors() if e["type"] == "extra_forbidden" and e["input"] in (None, [], {}, "")
        ]
        if not unknown:
            raise
    return ParameterFile.model_validate_json(json.dumps(without(json.loads(text), unknown)))
