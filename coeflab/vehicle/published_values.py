"""Published values beside ours: what they are, and what a comparison may conclude."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from coeflab.core import declarations as takes
from coeflab.core.axes import Datum, DatumName
from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import in_digits_of
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import dataclass, locking
from coeflab.core.units import quantity
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import derivative

STABILITY = ("G_h", "G_v")


class Relation(StrEnum):
    """What a published value is to ours."""

    RE_ANALYSIS = "re-analysis"
    CROSS_BODY = "cross-body"
    QUOTED = "quoted"

    @property
    def meaning(self) -> str:
        """In words."""
        return {
            Relation.RE_ANALYSIS: text_of("vehicle.re_analysis"),
            Relation.CROSS_BODY: "another body or another method: compared, no verdict",
            Relation.QUOTED: "quoted from another column, no verdict of its own",
        }[self]


@dataclass(frozen=True, slots=True)
class PublishedValue:
    """A printed value; ``value`` is None where a digit is illegible."""

    symbol: str
    printed: str
    value: float | None


@dataclass(frozen=True, slots=True)
class Literature:
    """Published values that may enter a parameter file, with their stated relative uncertainty."""

    kind: str
    method: str
    uncertainty: float
    values: tuple[PublishedValue, ...]


@dataclass(frozen=True, slots=True, eq=False)
@locking("reference_point")
class Reference:
    """One column of published derivatives, and the stability indices G_h and G_v that its source prints."""

    name: str
    citation: str
    place: str
    body: str
    relation: Relation
    campaigns: tuple[str, ...]
    scaling: Scaling
    other_scaling: Scaling | None
    note: str
    values: tuple[PublishedValue, ...]
    literature: tuple[Literature, ...]
    uncertainties: Mapping[str, float]
    reference_point: NDArray[np.float64] | None
    indices: tuple[PublishedValue, ...] = ()
    datum: Datum | None = None
    inferred: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "inferred", MappingProxyType(dict(self.inferred)))
        object.__setattr__(self, "uncertainties", MappingProxyType(dict(self.uncertainties)))

    @property
    def assumed(self) -> tuple[Finding, ...]:
        """What of the column its source does not print."""
        return tuple(
            Finding.of("published.inferred", self.name, Severity.NOTE, key=key, why=why)
            for key, why in self.inferred.items()
        )

    def printed(self, symbol: str) -> PublishedValue | None:
        """The published value of a symbol, if there is one."""
        return next((v for v in self.values if v.symbol == symbol), None)

    def printed_by_any_method(self, symbol: str) -> PublishedValue | None:
        """The same, or else the value that the source prints by another method, such as an oscillation."""
        others = (v for kind in self.literature for v in kind.values if v.symbol == symbol)
        return self.printed(symbol) or next(others, None)

    def stated(self, symbol: str) -> float | None:
        """The relative uncertainty that the source states for a symbol, if it does."""
        return self.uncertainties.get(symbol, self.uncertainties.get("default"))

    def readings(self, symbol: str, to: Scaling) -> tuple[tuple[str, float], ...]:
        """The value primed by ``to``, once for each length that the source may have used."""
        published = self.printed(symbol)
        if published is None or published.value is None:
            return ()
        lengths = [self.scaling, *([self.other_scaling] if self.other_scaling else [])]
        return tuple((s.length_name, published.value * s.ratio(symbol, to)) for s in lengths)


@dataclass(frozen=True, slots=True)
class Comparison:
    """Ours against one published value.

    Attributes
    ----------
    coefficient : Coefficient
    reference : str
    relation : Relation
    reading : str
        Name of the length that the published value is read with.
    published : float
        Rescaled to our length.
    difference : float or None
        Ours minus published.
    combined : float or None
        Root of the squares of our U95 and of the uncertainty that the source states.
    passed : bool or None
        Only a re-analysis has a verdict.
    shown : str
        The published value with the digits of its source.
    """

    coefficient: Coefficient
    reference: str
    relation: Relation
    reading: str
    published: float
    difference: float | None
    combined: float | None
    passed: bool | None
    shown: str = ""


def compare_set(among: CoefficientSet, references: tuple[Reference, ...]) -> tuple[Comparison, ...]:
    """Hold a set against published values, each about the point and by the length of its own source.

    Those that count from another datum are left out; those that name none count from that of the set.
    """
    out: list[Comparison] = []
    references = tuple(r for r in references if r.datum is None or r.datum == among.datum)
    points = {None if r.reference_point is None else tuple(map(float, r.reference_point)) for r in references}
    for point in sorted(points, key=str, reverse=True):
        here = [
            r
            for r in references
            if (None if r.reference_point is None else tuple(map(float, r.reference_point))) == point
        ]
        moved = among if point is None else among.about(np.array(point))
        out += compare(moved.coefficients, tuple(here), among.scaling, references)
    return tuple(out)


def compare(
    coefficients: tuple[Coefficient, ...],
    references: tuple[Reference, ...],
    scaling: Scaling,
    known_references: tuple[Reference, ...] | None = None,
) -> tuple[Comparison, ...]:
    """Hold every coefficient against the published values that have its symbol and belong beside it.

    A re-analysis belongs to its own campaigns; the other relations to a body of the same kind (fully appended), that
    is to coefficients whose campaign a re-analysis of the same symbol names with the same body, or to any.
    """
    out = []
    for c in coefficients:
        for r in references:
            if r.relation is Relation.RE_ANALYSIS and c.campaign not in r.campaigns:
                continue
            if r.relation is not Relation.RE_ANALYSIS and not _is_of_body(c, r, known_references or references):
                continue
            for reading, published in r.readings(c.symbol, scaling):
                difference = None if c.value is None else c.value - published
                verdict = None
                if r.relation is Relation.RE_ANALYSIS and difference is not None and c.u95 is not None:
                    verdict = abs(difference) <= c.u95
                combined = None if c.u95 is None else _combined(c.u95, published, r.stated(c.symbol))
                printed = r.printed(c.symbol)
                text = "" if printed is None else in_digits_of(published, printed.printed)
                out.append(Comparison(c, r.name, r.relation, reading, published, difference, combined, verdict, text))
    return tuple(out)


def _combined(u95: float, published: float, stated: float | None) -> float | None:
    return None if stated is None else float(np.hypot(u95, stated * published))


def _is_of_body(c: Coefficient, r: Reference, references: tuple[Reference, ...]) -> bool:
    """A cross-body column stands beside the body that the quoted experiment column is about."""
    quoted = {q.body for q in references if q.relation is Relation.QUOTED} or {r.body}
    return c.body in quoted


Printed = dict[str, takes.Text]
INFERRED = ("body", "length", "reference_point")  # what a source may leave unsaid of a column


def _values(printed: Mapping[str, str], table: str, known: tuple[str, ...] = ()) -> tuple[PublishedValue, ...]:
    """Of derivatives, or of these names."""
    out = []
    for symbol, text in printed.items():
        try:
            out.append(_value(symbol, text, known))
        except InputError as why:
            raise why.at(column=f"{table}.{symbol}") from None
    return tuple(out)


def _value(symbol: str, text: str, known: tuple[str, ...]) -> PublishedValue:
    if not known:
        derivative(symbol)
    elif symbol not in known:
        raise InputError(shown(symbol), f"one of {', '.join(known)}")
    return PublishedValue(symbol, text, _number(text))


def _number(printed: str) -> float | None:
    try:
        return quantity(printed, "none")
    except InputError:
        if not printed.endswith("?"):
            raise InputError(shown(printed), 'a number, or one that ends in "?" if illegible') from None
        return None


@dataclass(frozen=True, slots=True)
class LiteratureKeys(takes.Declaration):
    """Published values that may enter a parameter file.

    Attributes
    ----------
    method : str
        How they were found, such as PMM or rotating arm.
    uncertainty : float
        Relative U95 that the source states, 0.1 for 10 %.
    values : mapping of str to str
        Symbol without prime, and number as printed, in quotes; a closing ? is an illegible digit and gives no value.
    """

    method: takes.Text
    uncertainty: Annotated[takes.Pure, takes.ABOVE_ZERO]
    values: Printed

    def check(self) -> None:
        """Derivatives and numbers."""
        _values(self.values, "values")


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceKeys(takes.Declaration):
    """One column of published derivatives.

    Attributes
    ----------
    name : str
        Of the column; a plan's [[parameter_file]] names it so under literature.
    citation : str
        Key of the work, or words of your own.
    place : str
        Where in the work it is printed.
    body : str
        Which body it is about; one of a campaign is compared with it where it bears the same name.
    relation : {"re-analysis", "cross-body", "quoted"}
        What it is to ours: the authors' own evaluation of the tables in campaigns, with a verdict; another body or another method; quoted from another column. The latter two have no verdict.
    campaigns : tuple of str
        Whose tables a re-analysis evaluates; it needs them.
    length : float
        Of its primes.
    length_name : str
        Which length that is.
    other_length : float
        Another length that the source may have used; both readings are shown.
    other_length_name : str
        Which length that is.
    note : str
        What a reader has to know.
    values : mapping of str to str
        Derivatives that are compared with ours: symbol without prime, and number as printed, in quotes; a closing ? is an illegible digit.
    literature : mapping
        Values that enter a parameter file whose plan names this column, by a word of your own, such as rotary: [reference.literature.rotary]. They need reference_point.
    uncertainties : mapping of str to float
        Relative, as the source states it, by symbol or default, for the comparison.
    reference_point : (3,) array
        [x, y, z], m, FRD, from the datum, that moments and rates are about.
    indices : mapping of str to str
        G_h and G_v as printed.
    datum : str
        Id of the point that the reference point counts from; unless given that of the tables.
    datum_note : str
        Where that is.
    inferred : mapping of str to str
        Keys of this column that the source does not print, body or length, and what they are inferred from, in words.
    """

    name: takes.Text
    citation: takes.Text
    place: takes.Words = ""
    body: takes.Text
    relation: Annotated[str, takes.one_of(*(r.value for r in Relation))]
    campaigns: takes.Texts = ()
    length: Annotated[takes.Length, takes.ABOVE_ZERO]
    length_name: takes.Text
    other_length: Annotated[takes.Length, takes.ABOVE_ZERO] | None = None
    other_length_name: takes.Text | None = None
    note: takes.Words = ""
    values: Printed = field(default_factory=dict)
    literature: dict[str, LiteratureKeys] = field(default_factory=dict)
    uncertainties: dict[str, Annotated[takes.Pure, takes.ABOVE_ZERO]] = field(default_factory=dict)
    reference_point: takes.Point | None = None
    indices: Printed = field(default_factory=dict)
    datum: DatumName | None = None
    datum_note: takes.Words | None = None
    inferred: dict[str, takes.Text] = field(default_factory=dict)

    def check(self) -> None:
        """Keys that go together, derivatives and numbers."""
        for key, other in (("other_length", "other_length_name"), ("datum_note", "datum")):
            if getattr(self, key) is not None and getattr(self, other) is None:
                raise InputError("nothing", f"what goes with {key}", column=other, advice=f"Add {other}.")
        if self.other_length_name is not None and self.other_length is None:
            raise InputError("a name without a length", "other_length", column="other_length_name")
        for key in self.inferred:
            if key not in INFERRED:
                raise InputError(shown(key), f"one of {', '.join(INFERRED)}", column=f"inferred.{key}")
        if self.relation == Relation.RE_ANALYSIS and not self.campaigns:
            raise input_error("vehicle.re_analysis_without_campaigns", column="campaigns")
        _ = self.built

    @property
    def built(self) -> Reference:
        """The column."""
        other, name = self.other_length, self.other_length_name
        return Reference(
            name=self.name,
            citation=self.citation,
            place=self.place,
            body=self.body,
            relation=Relation(self.relation),
            campaigns=self.campaigns,
            scaling=Scaling(self.length, self.length_name),
            other_scaling=None if other is None or name is None else Scaling(other, name),
            note=self.note,
            values=_values(self.values, "values"),
            literature=tuple(
                Literature(kind, k.method, k.uncertainty, _values(k.values, "values"))
                for kind, k in self.literature.items()
            ),
            uncertainties=self.uncertainties,
            reference_point=self.reference_point,
            indices=_values(self.indices, "indices", STABILITY),
            inferred=self.inferred,
            datum=None if self.datum is None else Datum.named(self.datum, self.datum_note or ""),
        )


@dataclass(frozen=True, slots=True)
class ReferenceFile(takes.Declaration):
    """Values that others printed, beside ours or in their place; a plan's [[references]] gives the path, as published.toml.

    Attributes
    ----------
    reference : array of tables
        Columns of published derivatives.
    """

    reference: tuple[ReferenceKeys, ...] = ()


def read_references(path: Path) -> tuple[Reference, ...]:
    """Read a published.toml.

    Raises
    ------
    InputError
        Everything that is wrong, by file, line and key.
    """
    return tuple(r.built for r in takes.declared(ReferenceFile, read_toml(path)).reference)
