"""Published values beside ours: what they are, and what a comparison may conclude."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import Datum, read_datum
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import Section, read_toml
from coeflab.core.types import brief, locked
from coeflab.core.units import quantity
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.scaling import Scaling, read_scaling
from coeflab.law.symbols import symbol_at

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
            Relation.RE_ANALYSIS: "the same data evaluated by their authors; passes when the difference lies within "
            "our U95 alone",
            Relation.CROSS_BODY: "another body or another method: compared, no verdict",
            Relation.QUOTED: "quoted from another column, no verdict of its own",
        }[self]


@dataclass(frozen=True, slots=True)
class PublishedValue:
    """A printed value; ``value`` is None where a digit is illegible."""

    symbol: str
    printed: str
    value: float | None


@brief
@dataclass(frozen=True, slots=True)
class Literature:
    """Published values that may enter a parameter file, with their stated relative uncertainty."""

    kind: str
    method: str
    uncertainty: float
    values: tuple[PublishedValue, ...]


@brief
@dataclass(frozen=True, slots=True, eq=False)
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

    def __post_init__(self) -> None:
        object.__setattr__(self, "uncertainties", MappingProxyType(dict(self.uncertainties)))
        if self.reference_point is not None:
            object.__setattr__(self, "reference_point", locked(self.reference_point))

    def printed(self, symbol: str) -> PublishedValue | None:
        """The published value of a symbol, if there is one."""
        return next((v for v in self.values if v.symbol == symbol), None)

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


@brief
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
    """

    coefficient: Coefficient
    reference: str
    relation: Relation
    reading: str
    published: float
    difference: float | None
    combined: float | None
    passed: bool | None


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
    beside: tuple[Reference, ...] | None = None,
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
            if r.relation is not Relation.RE_ANALYSIS and not _beside(c, r, beside or references):
                continue
            for reading, published in r.readings(c.symbol, scaling):
                difference = None if c.value is None else c.value - published
                verdict = None
                if r.relation is Relation.RE_ANALYSIS and difference is not None and c.u95 is not None:
                    verdict = abs(difference) <= c.u95
                combined = None if c.u95 is None else _combined(c.u95, published, r.stated(c.symbol))
                out.append(Comparison(c, r.name, r.relation, reading, published, difference, combined, verdict))
    return tuple(out)


def _combined(u95: float, published: float, stated: float | None) -> float | None:
    return None if stated is None else float(np.hypot(u95, stated * published))


def _beside(c: Coefficient, r: Reference, references: tuple[Reference, ...]) -> bool:
    """A cross-body column stands beside the body that the quoted experiment column is about."""
    quoted = {q.body for q in references if q.relation is Relation.QUOTED} or {r.body}
    return c.body in quoted


def _values(section: Section, named: tuple[str, ...] = ()) -> tuple[PublishedValue, ...]:
    """Of derivatives, or of these names."""
    out = []
    for symbol in section.content:
        printed = section.text(symbol)
        if not named:
            symbol_at(section, symbol, symbol)
        elif symbol not in named:
            raise section.fail(symbol, shown(symbol), f"one of {', '.join(named)}")
        try:
            value: float | None = quantity(printed, "none")
        except InputError:
            if not printed.endswith("?"):
                raise section.fail(symbol, shown(printed), 'a number, or one that ends in "?" if illegible') from None
            value = None
        out.append(PublishedValue(symbol, printed, value))
    return tuple(out)


def _uncertainties(section: Section) -> dict[str, float]:
    return {name: section.positive(name, "none") for name in section.content}


def read_references(path: Path) -> tuple[Reference, ...]:
    """Read a published.toml.

    Raises
    ------
    InputError
        By file and key.
    """
    root = read_toml(path)
    out = []
    for s in root.sections("reference"):
        kinds = s.section("literature", required=False)
        literature = []
        for kind in kinds.content:
            k = kinds.section(kind)
            literature.append(
                Literature(kind, k.text("method"), k.positive("uncertainty", "none"), _values(k.section("values")))
            )
            k.finish()
        out.append(
            Reference(
                name=s.text("name"),
                citation=s.text("citation"),
                place=s.text("place", ""),
                body=s.text("body"),
                relation=Relation(s.text("relation", choices=tuple(r.value for r in Relation))),
                campaigns=s.texts("campaigns"),
                scaling=read_scaling(s),
                other_scaling=read_scaling(s, "other_") if s.has("other_length") else None,
                note=s.text("note", ""),
                values=_values(s.section("values")),
                literature=tuple(literature),
                uncertainties=_uncertainties(s.section("uncertainties", required=False)),
                reference_point=s.point("reference_point") if s.has("reference_point") else None,
                indices=_values(s.section("indices", required=False), STABILITY),
                datum=read_datum(s) if s.has("datum") else None,
            )
        )
        s.finish()
    root.finish()
    return tuple(out)
