"""Candidate terms of hydrodynamic forces, named by SNAME subscripts: ``v``, ``v|v|``, ``vr``, ``dr``, ``0``.

A term stands for its product of motions and controls times the power of the speed V that makes it quadratic in velocities,
as the prime system has it (Gertler & Hagen 1967, Feldman 1979): Yv' multiplies V v, Yv|v|' v|v|, Ydr' V^2 dr. ``X0'``
multiplies V^2 ahead and -V^2 astern. Damping about a state of rest multiplies the velocities alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import combinations

import numpy as np

from coeflab.core.types import Array
from coeflab.law.force_law import AHEAD, CONTROLS, SLOWEST
from coeflab.law.terms import Term

ALONG = {"X": "u", "Y": "v", "Z": "w", "K": "p", "M": "q", "N": "r"}
_FLIPPED = frozenset(("v", "p", "r", "dr"))
_FLIPPED_FORCES = frozenset("YKN")


def allowed(component: str, term: Term) -> bool:
    """Whether a body symmetric port to starboard can have the term."""
    odd = sum(n for v, n, absolute in term.factors if v in _FLIPPED and not absolute) % 2 == 1
    return odd == (component in _FLIPPED_FORCES)


def candidates(component: str, moving: Iterable[str], symmetric: bool) -> tuple[Term, ...]:
    """Terms of the first and second order over what moves.

    Parameters
    ----------
    component : str
        X Y Z K M N.
    moving : iterable of str
        Motions and controls that vary; the forward speed enters by V alone.
    symmetric : bool
        Leave out what a body symmetric port to starboard cannot have.

    Notes
    -----
    In order: the constant, x, x^2 and x|x|, x y, x|y| and |x|y, the controls and, for X, their squares.
    """
    moves = [m for m in moving if m not in (*CONTROLS, "u")]
    controls = [c for c in moving if c in CONTROLS]
    found = [Term(), *(_product(m) for m in moves)]
    for m in moves:
        found += [_product(m, m), Term(((m, 1, False), (m, 1, True)))]
    for a, b in combinations(moves, 2):
        found += [_product(a, b), Term(((a, 1, False), (b, 1, True))), Term(((b, 1, False), (a, 1, True)))]
    found += [_product(c) for c in controls]
    if component == "X":
        found += [_product(c, c) for c in controls]
    return tuple(t for t in found if not symmetric or allowed(component, t))


def _product(a: str, b: str = "") -> Term:
    return Term(((a, 2 if a == b else 1, False), *(((b, 1, False),) if b not in ("", a) else ())))


def same(a: Term, b: Term) -> bool:
    """Whether two terms are one function, whatever the order of their factors."""
    return _counts(a) == _counts(b)


def _counts(term: Term) -> dict[tuple[str, bool], int]:
    out: dict[tuple[str, bool], int] = {}
    for variable, power, absolute in term.factors:
        key = variable, absolute
        out[key] = out.get(key, 0) + power
    return out


def column(component: str, term: Term, columns: Mapping[str, Array], rest: bool = False) -> Array:
    """(n,) values of a term with its power of the speed.

    Parameters
    ----------
    component : str
    term : Term
    columns : mapping of str to (n,) array
        u v w p q r, m/s and rad/s, and dr ds db, rad.
    rest : bool
        Damping about a state of rest: no power of the speed.
    """
    speed = np.sqrt(columns["u"] ** 2 + columns["v"] ** 2 + columns["w"] ** 2)
    if component == "X" and not term.factors:
        ahead = np.clip(AHEAD.prime * columns["u"] / np.maximum(speed, SLOWEST), AHEAD.low, AHEAD.high)
        return np.asarray(speed**2 * ahead)
    power = 0 if rest else 2 - sum(n for v, n, _ in term.factors if v not in CONTROLS)
    out = term.evaluate(columns)
    return out if power == 0 else np.asarray(out * np.maximum(speed, SLOWEST) ** power)
