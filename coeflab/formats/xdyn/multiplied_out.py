"""The force law of an xdyn body, multiplied out into products of velocities about one point."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from coeflab.core.arithmetic import ArithmeticProblem
from coeflab.core.types import Array, brief
from coeflab.formats.xdyn.actuators import limited, read_limits
from coeflab.formats.xdyn.expressions import settled
from coeflab.formats.xdyn.law import Manoeuvring, XdynBody
from coeflab.formats.xdyn.products import Product, Products, as_products
from coeflab.law.force_law import AHEAD
from coeflab.law.symbols import COMPONENTS, CONTROLS, LINEAR, MOTIONS
from coeflab.law.transforms import force_transfer

FLOOR = 1e-9
MARK = "@"
SIGN, SIDES = "course", ("course + 1", "course - 1")
RESISTANCE: Product = (("U", 2),)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class MultipliedOut:
    """The law as sums of products.

    Attributes
    ----------
    point : (3,) array
        That the moments are about and the velocities are of, from the origin of the body frame, m.
    components : tuple of 6 Products
        X Y Z K M N in SI over ``u`` ... ``r``, ``|u|`` ... , ``U`` and control angles.
    constants : dict of name to float
        Keys of the manoeuvring models that are plain numbers.
    notes : tuple of str
    """

    point: Array
    components: tuple[Products, ...]
    constants: dict[str, float]
    notes: tuple[str, ...]


def multiplied_out(body: XdynBody) -> MultipliedOut:
    """Everything in the body's hydrodynamic models, about the manoeuvring model's point where its expressions use the
    velocities there, else about the centre of gravity.

    Raises
    ------
    ArithmeticProblem
        An expression that is no sum of products of velocities, their absolute values, powers of the speed and angles.
    """
    notes: list[str] = []
    constants: dict[str, float] = {}
    if len(body.manoeuvring) == 1 and not body.damping:
        model = body.manoeuvring[0]
        found = _components(body, model, True, notes, constants)
        if found is not None:
            return MultipliedOut(model.point, found, constants, tuple(dict.fromkeys(notes)))
        notes.clear()
    total = [as_products(0.0)] * 6
    for model in body.manoeuvring:
        found = _components(body, model, False, notes, constants) or tuple(total)
        total = [a + b for a, b in zip(total, _moved(found, body.centre - model.point), strict=True)]
    for power, matrix in body.damping:
        at_centre = force_transfer(body.centre - body.damping_point) @ matrix
        for j, name in enumerate(MOTIONS):
            motion = Products.of(name) if power == 1 else Products.of(name) * abs(Products.of(name))
            total = [a + motion * -float(at_centre[i, j]) for i, a in enumerate(total)]
    return MultipliedOut(body.centre, tuple(total), constants, tuple(dict.fromkeys(notes)))


def _moved(components: tuple[Products, ...], shift: Array) -> tuple[Products, ...]:
    transfer = force_transfer(shift)
    rows = []
    for row in transfer:
        out = as_products(0.0)
        for factor, component in zip(row, components, strict=True):
            out = out + component * float(factor)
        rows.append(out)
    return tuple(rows)


def _components(
    body: XdynBody, model: Manoeuvring, at_point: bool, notes: list[str], constants: dict[str, float]
) -> tuple[Products, ...] | None:
    """X Y Z K M N of one model; with ``at_point`` over the velocities at its point, None if others are used too."""
    marked = MARK if at_point else ""
    shift = model.point - body.centre
    expected = dict(zip(LINEAR, _velocities_at(shift), strict=True)) if at_point else {}
    still = not np.any(shift)

    def state(name: str, _time: Any) -> Products:
        return Products.of(name + (marked if still and name in LINEAR else ""))

    def finish(_name: str, value: Any) -> Any:
        if not isinstance(value, Products):
            return value
        number = value.number
        if number is not None:
            return number
        if dict(value.terms) == {((SIDES[0], 1),): 0.5, ((SIDES[1], 1),): -0.5}:
            return Products.of(SIGN)
        at = next((m for m, form in expected.items() if not still and value.same(form)), None)
        return value if at is None else Products.of(at + marked)

    functions: dict[str, Callable[..., Any]] = {m: partial(state, m) for m in MOTIONS}
    functions |= {"abs": partial(_absolute, f"u{marked}"), "sqrt": partial(_root, notes)}
    functions |= {f: partial(_of_number, f) for f in ("exp", "log", "cos", "sin")}
    given = {**body.given(model), **{c: Products.of(c) for c in model.commands if c in CONTROLS}}
    free = {limited(c): c for c in read_limits(model.expressions) if c in model.commands}
    try:
        known = settled({**model.expressions, **free}, given, functions, finish)
    except ArithmeticProblem:
        if at_point:
            return None
        raise
    constants |= {k: v for k, v in known.items() if isinstance(v, float) and k in model.expressions}
    out = tuple(as_products(known[c]) for c in COMPONENTS)
    names = {n.strip("|") for c in out for p in c.terms for n, _ in p}
    if at_point and names & set(LINEAR):
        return None
    plain = [{tuple(sorted((n.replace(MARK, ""), k) for n, k in p)): v for p, v in c.terms.items()} for c in out]
    if RESISTANCE in plain[0]:
        notes.append("X with U^2 alone pushes ahead on a course astern in the file; here it is drag there too")
    signed = tuple(sorted((*RESISTANCE, (SIGN, 1))))
    if signed in plain[0]:
        plain[0][RESISTANCE] = plain[0].get(RESISTANCE, 0.0) + plain[0].pop(signed)
    return tuple(Products(c) for c in plain)


def _absolute(ahead: str, value: Any) -> Any:
    """An absolute value: of one product, or of the two of which the sign of the course is made (`formats.exported_law.COURSE`)."""
    if isinstance(value, Products) and len(value.terms) == 2:
        share = {p: v / AHEAD.prime if p else v for p, v in value.terms.items()}
        for name, side in zip(SIDES, (1.0, -1.0), strict=True):
            if share == {tuple(sorted(((ahead, 1), ("U", -1)))): 1.0, (): side}:
                return Products.of(name)
    return abs(value)


def _velocities_at(shift: Array) -> tuple[Products, ...]:
    """Velocities u v w at a point ``shift`` from the centre of gravity, over the states of xdyn."""
    u, v, w, p, q, r = (Products.of(m) for m in MOTIONS)
    x, y, z = map(float, shift)
    return u + q * z - r * y, v + r * x - p * z, w + p * y - q * x


def _root(notes: list[str], value: Any) -> Any:
    """A square root: of a number, or the speed."""
    products = as_products(value)
    number = products.number
    if number is not None:
        if number < 0.0:
            raise ArithmeticProblem("the root of a negative number")
        return math.sqrt(number)
    squares = {}
    for product, factor in products.terms.items():
        if product == () and abs(factor) <= FLOOR:
            continue
        name, power = product[0] if len(product) == 1 else ("", 0)
        if power != 2 or abs(factor - 1.0) > 1e-12:
            raise ArithmeticProblem("a root that is not that of u^2 + v^2 + w^2")
        squares[name.replace(MARK, "")] = factor
    if not squares or not set(squares) <= set(LINEAR):
        raise ArithmeticProblem("a root that is not that of u^2 + v^2 + w^2")
    if len(squares) < 3:
        notes.append(
            f"U of the file is the root of {' + '.join(f'{n}^2' for n in squares)}; here it is that of all three"
        )
    return Products.of("U")


def _of_number(function: str, value: Any) -> float:
    number = as_products(value).number
    if number is None:
        raise ArithmeticProblem(f"{function} of a velocity")
    return float(getattr(math, function)(number))
