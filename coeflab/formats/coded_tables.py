"""The fitted tables of a law as plain rows of numbers, for programs in MATLAB and Python, and the law back from such rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coeflab.formats.flat_law import RULES, flat_tables, place_at, table_of
from coeflab.law.force_law import BASE, ForceLaw, ForceTerm, place_of
from coeflab.law.terms import Factor, Term
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.parameter_file import ParameterFile

# variables: which of u v w p q r dr ds db U alpha beta, from 1; terms: component from 1, X Y Z K M N, then D S L of each row of speaks, SI
# value, power of U, then of each variable its power and that of its absolute value.
KEYS = ("variables", "prime", "rule", "boxed", "rests", "low", "high", "spaces", "faces", "maps", "terms")
Rows = dict[str, Any]


def coded_tables(parameters: ParameterFile) -> tuple[list[Rows], list[list[int]]]:
    """Rows of every table in the law, and for which of X, Y, Z each group of drag, side force and lift speaks."""
    law = motion_law(parameters)[0]
    out: list[Rows] = []
    for t in flat_tables(law):
        terms = []
        for term in t.terms:
            powers = [0] * (2 * len(t.base))
            for v, n, absolute in t.factors(term):
                powers[2 * v + absolute] += n
            terms.append([place_of(term, law.wind) + 1, float(term.coefficient), term.speed_power, *powers])
        out.append({
            "name": t.name, "variables": [v + 1 for v in t.base], "prime": [float(p) for p in t.prime], "rule": RULES.index(t.hull.rule),
            "boxed": int(t.boxed), "rests": int(t.rests), "low": t.hull.low.tolist(), "high": t.hull.high.tolist(),
            "spaces": t.hull.spaces.tolist(), "faces": t.faces.tolist(), "maps": t.maps.reshape(-1, len(t.base) + 1).tolist(), "terms": terms,
        })  # fmt: skip
    return out, [[int(x) for x in into] for into in law.wind]


def law_of_tables(tables: Sequence[Mapping[str, Any]], wind: Sequence[Sequence[Any]]) -> ForceLaw:
    """The law of such rows alone."""
    terms: list[ForceTerm] = []
    for k, t in enumerate(tables):
        names = tuple(BASE[int(v) - 1] for v in t["variables"])
        box = t["low"], t["high"]
        hull, readings = table_of(str(k), names, box, t["spaces"], int(t["rule"]), t["prime"], bool(t["boxed"]))
        for place, value, power, *powers in t["terms"]:
            factors = tuple(
                Factor(v, int(n), absolute)
                for i, v in enumerate(names)
                for absolute, n in ((False, powers[2 * i]), (True, powers[2 * i + 1]))
                if n
            )
            component, into = place_at(int(place) - 1, wind)
            whole = Term(factors), float(value), int(power), 1.0
            terms.append(ForceTerm(str(k), component, *whole, "table", readings=readings, hull=hull, into=into))
    return ForceLaw(tuple(terms), np.zeros((6, 6, 6)))
