"""Thrust over the speed of a rotor as models of simulators write it: squares, squares beyond a dead band, lines between points.

A thruster of a parameter file pushes more where it is commanded more: one that pushes less turns its direction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterThruster

FASTEST = 1e3  # rad/s, of a rotor whose file states no largest command: 9,500 rpm, above those under water


class Piece(NamedTuple):
    """A polynomial of the rotor's speed between two speeds."""

    low: float
    high: float
    coefficients: tuple[float, ...]


Pieces = tuple[Piece, ...]


def squares(reverse: float, ahead: float, dead: tuple[float, float] = (0.0, 0.0)) -> Pieces:
    """``k (n|n| - d)`` outside of a dead band of n|n|, nothing inside.

    Parameters
    ----------
    reverse, ahead : float
        k of speeds below and above zero.
    dead : (float, float)
        d of both, the first not above zero, the second not below.
    """
    below, above = -math.sqrt(-dead[0]), math.sqrt(dead[1])
    return (
        Piece(-math.inf, below, (-reverse * dead[0], 0.0, -reverse)), Piece(above, math.inf, (-ahead * dead[1], 0.0, ahead)),
    )  # fmt: skip


def lines(speeds: Sequence[float], values: Sequence[float]) -> Pieces:
    """Straight between points in rising order; their ends hold beyond."""
    points = list(zip(speeds, values, strict=True))
    return tuple(Piece(a, b, (v - a * (w - v) / (b - a), (w - v) / (b - a))) for (a, v), (b, w) in pairwise(points))


def held(pieces: Pieces, low: float, high: float) -> Pieces:
    """The pieces between two speeds."""
    cut = (Piece(max(p.low, low), min(p.high, high), p.coefficients) for p in pieces)
    return tuple(p for p in cut if p.low < p.high)


def where(pieces: Pieces, value: float) -> float | None:
    """The speed at which they come to a value other than zero; None where they do not."""
    for p in pieces:
        c = (*p.coefficients, 0.0, 0.0)
        if c[2]:
            square = (value - c[0]) / c[2]
            found = math.copysign(math.sqrt(square), p.low + p.high) if square >= 0.0 else math.nan
        else:
            found = (value - c[0]) / c[1] if c[1] else math.nan
        if p.low <= found <= p.high:
            return found
    return None


def per_command(pieces: Pieces, gain: float, factor: float = 1.0) -> Pieces:
    """Over a command that the speed is ``gain`` times of; values times a factor."""
    out = []
    for p in pieces:
        ends = p.low / gain, p.high / gain
        out.append(Piece(min(ends), max(ends), tuple(factor * c * gain**k for k, c in enumerate(p.coefficients))))
    return tuple(sorted(out))


def rise(pieces: Pieces) -> float:
    """1 of what is more at its upper end than at its lower, -1 of what is less, else 0; both ends are finite."""
    if not pieces:
        return 0.0
    first, last = (
        math.fsum(c * x**k for k, c in enumerate(p.coefficients))
        for p, x in ((pieces[0], pieces[0].low), (pieces[-1], pieces[-1].high))
    )
    return float(last > first) - float(last < first)


def rotor(
    name: str, at: Array, along: Array, thrust: Pieces, torque: Pieces = (), *, unit: str = "rad/s", lag: float | None = None
) -> ParameterThruster | None:  # fmt: skip
    """A thruster by its pieces over the command; None where they state no thrust, or one that falls and rises.

    Parameters
    ----------
    name : str
    at, along : (3,) array
        Position, and direction of what is above zero in ``thrust``, FRD.
    thrust, torque : tuple of Piece
        Newtons along ``along`` and newton metres about it on the vehicle, over the command.
    unit : str
        Of the command.
    lag : float, optional
        s.
    """
    way = rise(thrust)
    curve = _curve(per_command(thrust, 1.0, way), unit) if way else None
    if curve is None or curve.falls_at() is not None:
        return None
    x, y, z = (float(v) for v in at + 0.0)
    a, b, c = (float(v) for v in way * along / math.hypot(*along) + 0.0)
    side = -1.0 if way * rise(torque) < 0.0 else 1.0
    return ParameterThruster(
        name=one_line(name)[:100], position=(x, y, z), direction=(a, b, c), curve=curve, lag=lag,
        torque_curve=_curve(per_command(torque, 1.0, way * side), unit) if torque else None, handedness=1 if side > 0.0 else -1,
    )  # fmt: skip


def _curve(pieces: Pieces, unit: str) -> ParameterCurve:
    segments = tuple(
        CurveSegment(low=p.low, high=p.high, coefficients=tuple(c + 0.0 for c in p.coefficients)) for p in pieces
    )
    return ParameterCurve(command="speed" if unit != "1" else "input", unit=unit, segments=segments)


def not_limited(subject: str, names: Sequence[str]) -> tuple[Finding, ...]:
    """A finding of thrusters whose file states no largest command."""
    return () if not names else (
        Finding.of("model.no_limit", subject, Severity.NOTE, statistic=FASTEST, names=tuple(names)),
    )  # fmt: skip
