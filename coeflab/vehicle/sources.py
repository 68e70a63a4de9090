"""Which source of a parameter file speaks of which variables, and what of them the force law takes: a sum, nothing twice.

A source states one component of the force over a set of moved variables (v w p q r dr ds db; u and V are the speed of every
source). A coefficient speaks of the variables of its product; a table of every product of its own variables, an increment
over a control of those with that control alone. Sources of different products add up. Of two that speak of the same products
the one over more variables stands; coefficients that cover all variables of a table stand before it, unless tables are asked
for first. Drag, side force and lift speak for X, Y and Z in that order; turned into another axis by alpha or beta they act there
unless a source along the body speaks of what that makes: Yv' holds -D sin(beta).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error
from coeflab.core.types import dataclass
from coeflab.law.force_law import CONTROLS, EVERYWHERE, WIND, ForceTerm
from coeflab.law.symbols import COMPONENTS, MOTIONS, primed
from coeflab.vehicle.parameter_model import ANGLE_OF, ParameterModel

AXES = COMPONENTS[:3]
MAIN = dict(zip(WIND, AXES, strict=True))
# What turns drag, side force and lift into an axis: sin(alpha) holds w, sin(beta) v. Lift has no part in Y.
TURNS = {
    place: frozenset(by) for place, by in
    {"DX": "", "DY": "v", "DZ": "w", "SX": "v", "SY": "", "SZ": "vw", "LX": "w", "LZ": ""}.items()
}  # fmt: skip
OF_SUM = "1.6"  # the first version of files that were written under this rule

Moved = frozenset[str]


def moved_by(variables: Iterable[str]) -> Moved:
    """What a product of variables is about: motions but u, and controls; incidence is that of v and w."""
    return frozenset(ANGLE_OF.get(v, v) for v in variables) & {*MOTIONS[1:], *CONTROLS}


def name_of(model: ParameterModel) -> str:
    """``C_D over alpha and beta``."""
    return f"{model.response} over {' and '.join(model.names)}"


@dataclass(frozen=True, slots=True, eq=False)
class TableSource:
    """A fitted table as a source.

    Attributes
    ----------
    model : ParameterModel
    place : str
        X Y Z K M N, or D S L.
    variables : frozenset of str
        Moved ones.
    needed : frozenset of str
        Those in all of its terms: without them its force is zero by its form.
    into : (3,) bool
        Of drag, side force and lift: which of X, Y and Z they act in.
    """

    model: ParameterModel
    place: str
    variables: Moved
    needed: Moved
    into: tuple[bool, bool, bool] = EVERYWHERE

    @classmethod
    def of(cls, model: ParameterModel) -> TableSource:
        """The source that a model is."""
        each = [moved_by(f.variable for f in t.factors) for t in model.terms]
        return cls(model, model.place, moved_by(model.names), frozenset.intersection(*each))

    @property
    def component(self) -> str:
        """The one of X Y Z K M N that it speaks for."""
        return MAIN.get(self.place, self.place)

    def speaks_of(self, product: Moved) -> bool:
        """Whether products of these variables are among its own."""
        return self.needed <= product <= self.variables

    @property
    def components(self) -> tuple[str, ...]:
        """X Y Z K M N that it acts in."""
        if self.place not in WIND:
            return (self.place,)
        return tuple(c for c, acts in zip(AXES, self.into, strict=True) if acts and self.turned(c) is not None)

    def turned(self, axis: str) -> Moved | None:
        """The product that it makes in an axis; None where it has no part in it."""
        turn = TURNS.get(self.place + axis)
        return None if turn is None else self.needed | turn

    def meets(self, other: TableSource) -> bool:
        """Whether both speak of some product."""
        return self.needed | other.needed <= self.variables & other.variables

    @property
    def whole(self) -> bool:
        """Whether it is the force of a motion, potential part and all, and no increment over a control."""
        return self.model.contains_potential and not self.needed & set(CONTROLS)


@dataclass(frozen=True, slots=True, eq=False)
class Sources:
    """What the law of a file is the sum of.

    Attributes
    ----------
    terms : tuple of ForceTerm
        Coefficients.
    tables : tuple of TableSource
    unused_terms : tuple of ForceTerm
    findings : tuple of Finding
        What is not used, and why.
    """

    terms: tuple[ForceTerm, ...]
    tables: tuple[TableSource, ...]
    unused_terms: tuple[ForceTerm, ...]
    findings: tuple[Finding, ...]

    def open_products(self) -> NDArray[np.bool_]:
        """(6, 6, 6), by force and two velocities: the products that no source speaks of, left to the ideal fluid."""
        out = open_of(t for t in self.terms if not steered(t))
        for s in self.tables:
            if s.whole:
                at = sorted({0, *(MOTIONS.index(m) for m in s.variables if m in MOTIONS)})
                for c in s.components:
                    out[np.ix_([COMPONENTS.index(c)], at, at)] = False
        return out


def steered(term: ForceTerm) -> bool:
    """Whether a control is in it."""
    return any(v in CONTROLS for v in term.variables)


def open_of(terms: Iterable[ForceTerm]) -> NDArray[np.bool_]:
    """(6, 6, 6), by force and two velocities: the products that no term speaks of."""
    out = np.ones((6, 6, 6), dtype=bool)
    for t in terms:
        if t.pair is not None:
            i, (j, k) = COMPONENTS.index(t.component), t.pair
            out[i, j, k] = out[i, k, j] = False
    return out


def summed(
    terms: Sequence[ForceTerm], models: Sequence[ParameterModel], tables_first: bool, version: str = OF_SUM
) -> Sources:
    """What of coefficients and tables adds up to the force.

    Parameters
    ----------
    terms : sequence of ForceTerm
        Coefficients, controls among them.
    models : sequence of ParameterModel
    tables_first : bool
        Whether a table stands before the coefficients of its variables, even where these cover all of them.
    version : str
        Of the file: one before `OF_SUM` was written when tables or coefficients spoke for a component, never both.

    Raises
    ------
    InputError
        Two tables speak of the same products, and neither holds the variables of the other.
    """
    found: list[Finding] = []
    every = [TableSource.of(m) for m in models if m.place]
    standing = _among_tables(every, found)
    selected, dropped = list(terms), list[ForceTerm]()
    for s in list(standing):
        rivals = [t for t in selected if t.component == s.component and s.speaks_of(moved_by(t.variables))]
        if not rivals:
            continue
        covered = frozenset().union(*(moved_by(t.variables) for t in rivals)) >= s.variables
        if covered and not tables_first:
            standing.remove(s)
            found.append(_unused_table(s, [primed(t.symbol) for t in rivals]))
            continue
        selected = [t for t in selected if t not in rivals]
        dropped += rivals
        found.append(_unused_terms(rivals, s))
    if version != OF_SUM and tuple(map(int, version.split("."))) < tuple(map(int, OF_SUM.split("."))):
        found += _by_the_older_rule(terms, every, selected, standing, version)
    acting = _of_wind(standing, [(t.component, moved_by(t.variables)) for t in selected], found)
    return Sources(tuple(selected), acting, tuple(dropped), tuple(found))


def still_known(models: Sequence[ParameterModel], terms: Sequence[tuple[str, str, Moved]]) -> Sources:
    """The tables that stay known where terms are to be found from data: those that speak of nothing that a term speaks of.

    Parameters
    ----------
    models : sequence of ParameterModel
    terms : sequence of (symbol, component, moved variables)
        To be found; they stand before every table.

    Raises
    ------
    InputError
        Two tables speak of the same products.
    """
    found: list[Finding] = []
    every = [TableSource.of(m) for m in models if m.place]
    standing = _among_tables(every, found)
    for s in list(standing):
        rivals = [symbol for symbol, c, moved in terms if c == s.component and s.speaks_of(moved)]
        if rivals:
            standing.remove(s)
            found.append(_unused_table(s, list(map(primed, rivals))))
    return Sources((), _of_wind(standing, [(c, moved) for _, c, moved in terms], found), (), tuple(found))


def _among_tables(every: Sequence[TableSource], found: list[Finding]) -> list[TableSource]:
    """The tables that stand beside each other: of two of the same products the one over more variables."""
    out = list(every)
    for a, b in combinations(every, 2):
        if a not in out or b not in out or a.component != b.component or not a.meets(b):
            continue
        if a.variables == b.variables or not (a.variables < b.variables or b.variables < a.variables):
            raise input_error(
                "vehicle.both_force", column="models", name_of=name_of(a.model), name_of_2=name_of(b.model),
                component=a.component, shared=_shared(a, b),
            )  # fmt: skip
        less, more = (a, b) if a.variables < b.variables else (b, a)
        out.remove(less)
        found.append(_unused_table(less, [name_of(more.model)]))
    return out


def _shared(a: TableSource, b: TableSource) -> str:
    """The smallest product that two tables share, in words."""
    least = sorted(a.needed | b.needed)
    return f"by {' and '.join(least)}" if least else "at rest of its own"


def _of_wind(
    standing: Sequence[TableSource], along: Sequence[tuple[str, Moved]], found: list[Finding]
) -> tuple[TableSource, ...]:
    """The tables of the law, with the axes that those of drag, side force and lift act in.

    Parameters
    ----------
    standing : sequence of TableSource
    along : sequence of (component, moved variables)
        Coefficients of the law.
    found : list of Finding
        To which those are added that say where a table does not act.
    """
    out, partly = list[TableSource](), dict[tuple[str, ...], list[str]]()
    for s in standing:
        left = []
        for c in AXES:
            turned = s.turned(c)
            if turned is not None and (
                any(axis == c and moved == turned for axis, moved in along)
                or any(other.place == c and other.speaks_of(turned) for other in standing)
            ):
                left.append(c)
        one, two, three = (c not in left for c in AXES)
        out.append(replace(s, into=(one, two, three)))
        if left:
            partly.setdefault(tuple(left), []).append(s.model.response)
    for components, responses in partly.items():
        names = list(dict.fromkeys(responses))
        found.append(
            Finding.of("law.wind_partly", ", ".join(names), Severity.NOTE, tables=names, components=list(components))
        )
    return tuple(out)


def _unused_table(s: TableSource, by: Sequence[str]) -> Finding:
    return Finding.of(
        "law.table_unused", name_of(s.model), Severity.NOTE, component=s.component, by=list(dict.fromkeys(by)),
        advice="--tables",
    )  # fmt: skip


def _unused_terms(terms: Sequence[ForceTerm], s: TableSource) -> Finding:
    names = [primed(t.symbol) for t in terms]
    return Finding.of(
        "law.coefficients_unused", ", ".join(names), Severity.NOTE, component=s.component, coefficients=names,
        table=name_of(s.model),
    )  # fmt: skip


def _by_the_older_rule(
    terms: Sequence[ForceTerm],
    every: Sequence[TableSource],
    selected: Sequence[ForceTerm],
    standing: Sequence[TableSource],
    version: str,
) -> list[Finding]:
    """Where the sum is another force than a file before `OF_SUM` had: tables of components without a derivative alone."""
    old = {t.component for t in terms if not t.variables or any(v not in CONTROLS for v in t.variables)}
    were = [s for s in every if not (set(AXES) if s.place in WIND else {s.place}) & old]
    changed = {s.component for s in every if (s in were) != (s in standing)}
    changed |= {t.component for t in terms if t not in selected}
    if not changed:
        return []
    names = [c for c in COMPONENTS if c in changed]
    return [Finding.of("law.older_rule", ", ".join(names), Severity.NOTE, version=version, components=names)]


def acts_in(model: ParameterModel) -> Mapping[str, Moved]:
    """By component, the variables that a table has a force over; empty where its response is no force."""
    names = AXES if model.place in WIND else (model.place,) if model.place else ()
    return dict.fromkeys(names, moved_by(model.names))
