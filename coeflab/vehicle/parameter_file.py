"""The parameter file: JSON, one body, one scaling, one reference point.

The models below are the schema; ``parameter_file.schema.json`` beside them is generated from them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError, model_validator

from coeflab.core.axes import Datum
from coeflab.core.cards import html_by
from coeflab.core.errors import CoeflabError, InputError, shown
from coeflab.core.files import named, shipped
from coeflab.core.finding import Finding
from coeflab.core.limits import JSON_BYTES
from coeflab.core.provenance import InputFile
from coeflab.core.stored import FIRST_VERSION, AsStored, Finite, Means, Name, RefusedError, Words
from coeflab.core.text.bounded import own_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.text.model_kinds import model_kind
from coeflab.core.text.toml import read_text, read_toml
from coeflab.core.texts import input_error, remark
from coeflab.core.types import in_angles
from coeflab.core.units import also_written, same_unit
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
from coeflab.vehicle.parameter_refusals import complaints, first_complaint
from coeflab.vehicle.schema_versions import (
    MESHES,
    MOST_NAMED,
    NARROWER,
    SAME,
    SCHEMA_VERSION,
    SHIPPED,
    advice,
    as_of,
    is_later,
    readable,
    too_new,
    without,
)

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
    findings: Annotated[tuple[Finding, ...], Means("what is assumed, left out or not assessed", since="1.6")] = ()
    provenance: Annotated[Provenance, Means("where it all comes from")]

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader has to know, in words: the notes, and what was found."""
        return tuple(dict.fromkeys((*self.provenance.notes, *(remark(f) for f in self.findings))))

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
        strange = too_new(self, self.schema_version)
        if strange:
            raise ValueError(strange)
        wrong = [*self._no_duplicates(), *self._disagreements()]
        if wrong:
            first, *others = wrong
            raise RefusedError(first.found, first.expected, first.advice, first.where, tuple(others))
        return self

    def _no_duplicates(self) -> Iterator[RefusedError]:
        """What stands twice, and a covariance of what does not stand at all."""
        symbols = [c.symbol for c in self.coefficients]
        named = [t.name for t in self.thrusters] + [c.control for c in self.surfaces]
        for where, twice in (("coefficients", repeated(symbols)), ("thrusters", repeated(named))):
            if twice:
                yield RefusedError(f"{', '.join(twice)} occurs more than once", "each once", where=(where,))
        unknown = sorted(set(self.covariance.symbols) - set(symbols))
        if unknown:
            yield RefusedError(
                f"the covariance names {', '.join(unknown)}, which are no coefficients", "symbols of coefficients",
                where=("covariance", "symbols"),
            )  # fmt: skip
        for response, names in repeated([(m.response, m.names) for m in self.models]):
            yield RefusedError(
                f"{response} over {', '.join(names)} occurs more than once", "each once", where=("models",)
            )

    def _disagreements(self) -> Iterator[RefusedError]:
        """Numbers that do not follow from those that they follow from."""
        at = self.conditions
        for k, c in enumerate(self.coefficients):
            where = ("coefficients", k)
            unit = derivative(c.symbol).unit
            if not same_unit(c.unit_si, unit):
                yield RefusedError(
                    f"{c.symbol}: unit_si {shown(c.unit_si)}", f"{unit}, the unit of its symbol, also written {also_written(unit)}",
                    where=(*where, "unit_si"),
                )  # fmt: skip
            if c.value is not None and c.value_si is not None:
                si = c.value * self.scaling.unit(c.symbol, at.density, at.speed)
                if not math.isclose(c.value_si, si, rel_tol=SAME, abs_tol=1e-12 * abs(si)):
                    yield RefusedError(
                        f"{c.symbol}: value_si {c.value_si:g}", f"its value {c.value:g} at these conditions, {si:g}",
                        "Change one of them, or write null for value_si.", (*where, "value_si"),
                    )  # fmt: skip
        if self.mass is not None:
            yield from self._primes_of_the_mass(self.mass)
        yield from self._potential_parts()

    def _primes_of_the_mass(self, mass: MassProperties) -> Iterator[RefusedError]:
        """Where m' or x_G' m' is not that of the mass."""
        due = mass.primed(self.scaling, self.conditions.density)
        by = f"density {self.conditions.density:g} kg/m^3 and length {self.scaling.length:g} m"
        for name, unit in (("mass", "kg"), ("mass_moment", "kg m")):
            given, right = getattr(mass, f"{name}_prime"), getattr(due, f"{name}_prime")
            if not math.isclose(given, right, rel_tol=SAME, abs_tol=SAME * 1e-3 * due.mass_prime):
                yield RefusedError(
                    f"{name}_prime {given:g}", f"{right:g}, of {name} {getattr(mass, name):g} {unit}, {by}",
                    f"Change {name}_prime or {name}.", ("mass", f"{name}_prime"),
                )  # fmt: skip

    def _potential_parts(self) -> Iterator[RefusedError]:
        """Where a potential part is not what the added mass gives."""
        for k, c in enumerate(self.coefficients):
            if c.potential is None:
                continue
            where = ("coefficients", k, "potential")
            if self.added_mass is None:
                yield RefusedError(
                    f"{c.symbol}: a potential part without an added mass", "potential null, or added_mass", where=where
                )
                return
            due = potential_part(c.symbol, self.added_mass, self.scaling, self.added_mass.density) or 0.0
            if not math.isclose(c.potential, due, rel_tol=SAME, abs_tol=1e-9):
                yield RefusedError(
                    f"{c.symbol}: potential {c.potential:g}",
                    f"that of the added mass, {due:g}",
                    "null says nothing.",
                    where,
                )

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
    content["$comment"] = "generated: coeflab schema parameters"
    return (json.dumps(content, indent=2) + "\n").encode()


@contextmanager
def located_refusals(place: str) -> Iterator[None]:
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
        raise first_complaint(why, place) from None


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
            raise input_error("vehicle.vehicle_with_arm", path=shown(str(path), 300), path_2=path)
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
        raise input_error("vehicle.mesh_for_a_file", file=path, path=path)
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
        Not JSON (with line and column), or all that breaks the schema, with lines.
    """
    path = file_typed(path)
    refuse_shape(path)
    text = read_text(path, JSON_BYTES)
    if kind := model_kind(text):
        raise input_error("vehicle.simulator_model", file=path, simulator=kind, path=path)
    content = parse_json(text, path, "a parameter file in JSON")
    if not isinstance(content, dict):
        raise InputError(f"a {type(content).__name__}", "an object", file=path, column="file")
    version = readable(content.get("schema_version"), path)
    del content  # a large file's content is held once only
    try:
        return _validated(text, version)
    except ValidationError as why:
        given = complaints(why, text, path, own_bytes(SCHEMA_FILE), advice(version))
        if not is_later(version, SCHEMA_VERSION):
            raise given from None
        raise input_error(
            "vehicle.file_schema_version", path, given.line, key=given.column, found=given.found, version=version,
            first_version=FIRST_VERSION, schema_version=SCHEMA_VERSION, advice=advice(version),
        ) from None  # fmt: skip
    except CoeflabError as why:
        raise InputError(str(why), "a valid parameter file", file=path) from None


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
    return ParameterFile.model_validate_json(json.dumps(without(parse_json(text), unknown)))
