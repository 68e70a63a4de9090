"""What coefficients rest on that no source states: keys that an import accepted, and points and signs that are taken by default."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from coeflab.core.finding import Fact, Finding
from coeflab.core.table import Check, as_check
from coeflab.tables.assumptions import CODE, INERTIA

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "keys of campaigns that were accepted and that no source states, with the coefficients that hang on them"
citations = ("sname1950",)


def check(study: Study) -> Sequence[Check]:
    """One finding per accepted key of a table, with the coefficients of all fits that hang on it."""
    together: dict[tuple[object, ...], Finding] = {}
    for f in dict.fromkeys(f for fit in study.fits for f in fit.findings if f.code in (CODE, INERTIA)):
        facts = {fact.name: fact.value for fact in f.facts}
        key = (f.subject, *((name, value) for name, value in facts.items() if name != "symbols"))
        known = together.get(key)
        symbols: tuple[str, ...] = (*(known["symbols"] if known else ()), *f["symbols"])
        together[key] = replace(
            f, facts=tuple(Fact(n, tuple(dict.fromkeys(symbols)) if n == "symbols" else v) for n, v in facts.items())
        )
    return [as_check("assumed", f) for f in together.values()]
