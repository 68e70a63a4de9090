"""Joint frames, bodies and bodies that move as one, in symbols."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import sympy as sp  # type: ignore[import-untyped]

from coeflab.arm.tape import ZERO, Square, Tape, Vector, Wrench, cross, plus, product, times, transposed


class Body(NamedTuple):
    """A rigid body with its water, in its own axes; for links those of the joint frame.

    ``mass`` is a scalar, ``inertia`` and the blocks of ``added`` (A, B, D: p = A v + B w, L = B^T v + D w) are about the centre
    of mass; strips have a start, an axis, a length and 1/2 rho C_D d L.
    """

    mass: Any
    centre: Vector
    inertia: Square
    added: tuple[Square, Square, Square] | None
    displaced: Any
    lifted: Vector
    strips: tuple[tuple[Vector, Vector, Any, Any], ...]


class Step(NamedTuple):
    """From a parent's axes to a joint frame: origin there, K Rz(theta)."""

    shift: Vector
    fixed: Square
    cos: Any
    sin: Any
    turns: bool

    def inward(self, t: Tape, v: Sequence[Any]) -> Vector:
        """A vector of the joint frame in the parent's axes."""
        turned = t.vector((self.cos * v[0] - self.sin * v[1], self.sin * v[0] + self.cos * v[1], v[2]))
        return t.vector(times(self.fixed, turned))

    def outward(self, t: Tape, v: Sequence[Any]) -> Vector:
        """A vector of the parent in the joint frame's axes."""
        x, y, z = t.vector(times(transposed(self.fixed), v))
        return t.vector((self.cos * x + self.sin * y, self.cos * y - self.sin * x, z))

    def symmetric_inward(self, t: Tape, m: Square) -> Square:
        """A symmetric (3, 3) of the joint frame in the parent's axes."""
        c, s = self.cos, self.sin
        cc, cs = t.name(c * c), t.name(c * s)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = m
        gap = t.name(xx - yy)
        low = t.name(yy + cc * gap - 2 * cs * xy)
        across = t.name(cs * gap + (2 * cc - 1) * xy)
        ux, uy = t.name(c * xz - s * yz), t.name(s * xz + c * yz)
        turned = [[low, across, ux], [across, t.name(xx + yy - low), uy], [ux, uy, zz]]
        return product(t, product(t, self.fixed, turned), transposed(self.fixed))

    def square_inward(self, t: Tape, m: Square) -> Square:
        """Any (3, 3) of the joint frame in the parent's axes."""
        rows = transposed([list(self.inward(t, column)) for column in transposed(m)])
        return [list(self.inward(t, row)) for row in rows]


class Whole(NamedTuple):
    """Inertia about the origin of the axes it stands in.

    ``mass``, ``moment`` m c and ``inertia`` of dry bodies; ``added`` takes all where there is water that moves with them.
    """

    mass: Any
    moment: Vector
    inertia: Square
    added: tuple[Square, Square, Square] | None


def scaled(amount: Any, v: Sequence[Any]) -> Vector:
    """A vector times a scalar, without names."""
    return amount * v[0], amount * v[1], amount * v[2]


def inward(t: Tape, step: Step, wrench: Wrench) -> Wrench:
    """Force and moment of a joint frame, in the parent's axes and about its origin."""
    force = step.inward(t, wrench[0])
    return force, t.vector(plus(step.inward(t, wrench[1]), cross(step.shift, force)))


def skew(v: Sequence[Any]) -> Square:
    """The matrix that turns x into v x x."""
    nil = sp.S.Zero
    return [[nil, -v[2], v[1]], [v[2], nil, -v[0]], [-v[1], v[0], nil]]


def summed(t: Tape, a: Square, b: Square) -> Square:
    """Sum of two (3, 3), named."""
    return [[t.name(x + y) for x, y in zip(r, s, strict=True)] for r, s in zip(a, b, strict=True)]


def shifted(t: Tape, mass: Any, moment: Vector, inertia: Square, r: Vector) -> tuple[Vector, Square]:
    """M c and inertia about the origin of axes in which the old origin is at r."""
    x, y, z = r
    a, b, c = moment
    twice = (2 * x * a + mass * x * x, 2 * y * b + mass * y * y, 2 * z * c + mass * z * z)
    out = [list(row) for row in inertia]
    for i in range(3):
        out[i][i] = t.name(inertia[i][i] + sum(twice[j] for j in range(3) if j != i))
        for j in range(i + 1, 3):
            out[i][j] = out[j][i] = t.name(inertia[i][j] - r[i] * moment[j] - r[j] * moment[i] - mass * r[i] * r[j])
    return t.vector(m + mass * e for m, e in zip(moment, r, strict=True)), out


def shifted_water(t: Tape, blocks: tuple[Square, Square, Square], r: Vector) -> tuple[Square, Square, Square]:
    """Blocks about the origin of axes in which the old origin is at r."""
    a, b, d = blocks
    s = skew(r)
    there = [[-e for e in row] for row in product(t, a, s)]
    both = summed(t, b, there)
    low = product(t, transposed(b), s)
    high = product(t, s, both)
    out = [[sp.S.Zero] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(i, 3):
            out[i][j] = out[j][i] = t.name(d[i][j] - low[i][j] + high[i][j])
    return a, both, out


def about_origin(t: Tape, body: Body) -> Whole:
    """A body about the origin of its axes."""
    centre = t.vector(body.centre)
    inertia = [[t.name(e) for e in row] for row in body.inertia]
    dry = Whole(body.mass, *shifted(t, body.mass, ZERO, inertia, centre), None)
    if body.added is None:
        return dry
    a, b, d = ([[t.name(e) for e in row] for row in block] for block in body.added)
    return joined(t, dry, dry._replace(added=shifted_water(t, (a, b, d), centre)))


def blocks(whole: Whole) -> tuple[Square, Square, Square]:
    """A, B and D."""
    if whole.added is not None:
        return whole.added
    nil = sp.S.Zero
    mass = [[whole.mass if i == j else nil for j in range(3)] for i in range(3)]
    return mass, [[-e for e in row] for row in skew(whole.moment)], whole.inertia


def joined(t: Tape, one: Whole, other: Whole | None) -> Whole:
    """Two that move as one."""
    if other is None:
        return one
    if one.added is None and other.added is None:
        mass, moment = t.name(one.mass + other.mass), t.vector(plus(one.moment, other.moment))
        return Whole(mass, moment, summed(t, one.inertia, other.inertia), None)
    a, b, d = (summed(t, x, y) for x, y in zip(blocks(one), blocks(other), strict=True))
    return other._replace(added=(a, b, d))


def moved_in(t: Tape, step: Step, whole: Whole) -> Whole:
    """The same in the parent's axes, about its origin."""
    if whole.added is not None:
        a, b, d = whole.added
        turned = step.symmetric_inward(t, a), step.square_inward(t, b), step.symmetric_inward(t, d)
        return whole._replace(added=shifted_water(t, turned, step.shift))
    moment, inertia = step.inward(t, whole.moment), step.symmetric_inward(t, whole.inertia)
    return Whole(whole.mass, *shifted(t, whole.mass, moment, inertia, step.shift), None)


def momentum(whole: Whole, turns: bool) -> Wrench:
    """Momentum of a unit rate of the joint, about z or along it."""
    a, b, d = blocks(whole)
    if turns:
        return (b[0][2], b[1][2], b[2][2]), (d[0][2], d[1][2], d[2][2])
    return (a[0][2], a[1][2], a[2][2]), (b[2][0], b[2][1], b[2][2])
