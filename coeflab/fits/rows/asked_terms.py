"""Which terms of a manoeuvring model are fitted: those that were named, and those of a set that the tables hold."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import dataclass
from coeflab.fits.joint.rows import joint_name, measured, moving
from coeflab.law.named_terms import SETS, NamedTerm, read_term, read_terms
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.force_table import AT_REST, ForceTable


@dataclass(frozen=True, slots=True)
class AskedTerms:
    """Terms of a fit.

    Attributes
    ----------
    fitted : tuple of NamedTerm
        By component, intercepts first.
    idle : tuple of NamedTerm
        Of the set, without motion in the tables.
    own : tuple of str
        Components in which every campaign has an intercept of its own.
    """

    fitted: tuple[NamedTerm, ...]
    idle: tuple[NamedTerm, ...]
    own: tuple[str, ...]


def asked_terms(
    texts: Sequence[str],
    chosen: str,
    components: Sequence[str],
    tables: Sequence[ForceTable],
    *,
    intercepts: bool,
    place: str,
) -> AskedTerms:
    """Terms by name and of a set.

    Parameters
    ----------
    texts : sequence of str
        Named ones.
    chosen : str
        Set, or ``none``.
    components : sequence of str
        Of the set; none for all that the tables have.
    tables : sequence of ForceTable
    intercepts : bool
        Add one to every component that names none; where the tables are of several campaigns, one for each campaign.
    place : str
        Plugin, for messages.

    Raises
    ------
    InputError
        Unknown or repeated terms, or none that the tables hold.
    """
    named = read_terms(tuple(texts), f"{place}.terms")
    if chosen == "none" and not named:
        raise input_error("fits.no_terms", column=f"{place}.terms")
    unknown = [c for c in components if c not in COMPONENTS]
    if unknown:
        raise InputError(", ".join(unknown), f"some of {', '.join(COMPONENTS)}", column=f"{place}.components")
    wanted = set(measured(tables)) & set(components or COMPONENTS)
    of_set = [t for s in SETS.get(chosen, ()) if (t := read_term(s, "set")).component in wanted]
    if intercepts:
        of_set += [read_term(f"{c}0", "set") for c in {t.component for t in named}]
    else:
        of_set = [t for t in of_set if t.term.factors]
    taken, moves = {t.key for t in named}, set(moving(tables))
    fitted, idle = list(named), list[NamedTerm]()
    for t in of_set:
        if t.key in taken:
            continue
        taken.add(t.key)
        occurring = _occurs(t, tables) if moves.issuperset(v for v, _, _ in t.term.factors) else False
        (fitted if occurring else idle).append(t)
    alone = {t.component for t in fitted} - {t.component for t in fitted if t.term.factors or t in named}
    idle += [t for t in fitted if t.component in alone]
    fitted = [t for t in fitted if t.component not in alone]
    if not fitted:
        campaigns = joint_name(t.campaign for t in tables)
        raise input_error("fits.no_motion", column=f"{place}.set", chosen=chosen, campaigns=campaigns)
    own: tuple[str, ...] = ()
    if len({t.campaign for t in tables}) > 1:
        own = tuple(t.component for t in fitted if not t.term.factors and t not in named)
        fitted = [t for t in fitted if t.term.factors or t in named]
    order = {c: i for i, c in enumerate(COMPONENTS)}
    fitted.sort(key=lambda t: (order[t.component], bool(t.term.factors)))
    return AskedTerms(tuple(fitted), tuple(idle), own)


def _motion(table: ForceTable, name: str) -> NDArray[np.float64]:
    """A motion or control of a table, primed; zero where it has none."""
    if name in table.controls or name in table.motion:
        return table.primed_motion(name, table.scaling.length)
    return np.zeros(len(table))


def _occurs(term: NamedTerm, tables: Sequence[ForceTable]) -> bool:
    """Whether a usable row of the component has all motions of a term at once."""
    for t in tables:
        if term.component not in t.forces:
            continue
        together = np.array(t.usable[term.component])
        for v, _, _ in term.term.factors:
            together &= np.abs(_motion(t, v)) > AT_REST
        if np.any(together):
            return True
    return False
