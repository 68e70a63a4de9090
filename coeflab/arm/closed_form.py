"""Kane's equations of a vehicle with an arm in closed form: expressions of q and the generalised speeds, by sympy.

What stands here are the equations of `coeflab.arm.kane`, in symbols. Partial velocities are not multiplied out. Forces
of a link pass from joint to joint, and each joint takes the share along its own axis: that is the product of equations 13, 14, 18
to 22 of the URV paper with the partial velocities, sums taken from the tip. Every scalar that is formed is a sympy expression of few
terms and gets a name, so that subexpressions are common from the start and nothing is expanded; `Function.expanded` puts the names
back in, for equations of one page.

Vectors of a link stand in its joint frame: z along the joint's axis, fixed in the link, origin where the axis meets x of frame j.
Numbers of the file are numbers of the equations; with ``symbols`` they keep names, and what is zero, a right angle or the mount
stays structure.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import sympy as sp  # type: ignore[import-untyped]

from coeflab.arm import composite
from coeflab.arm.chain import Base, Chain, Link
from coeflab.arm.tape import (
    ROUNDING,
    ZERO,
    ClosedForm,
    Parameter,
    Square,
    Tape,
    Vector,
    Wrench,
    cross,
    number,
    plus,
    right_angled,
    symbols_of,
    times,
    transposed,
)  # fmt: skip
from coeflab.core.errors import InputError
from coeflab.core.types import Array

Say = Callable[[str], None]


class _Numbers:
    """Numbers of a file: themselves, or symbols that remember them."""

    def __init__(self, symbols: bool) -> None:
        self.symbols, self.found = symbols, list[Parameter]()

    def __call__(self, name: str, value: float, unit: str, meaning: str) -> Any:
        if not self.symbols or value == 0.0:
            return number(value)
        self.found.append(Parameter(sp.Symbol(name), float(value), unit, meaning))
        return self.found[-1].symbol

    def vector(self, name: str, values: Array, meaning: str) -> Vector:
        x, y, z = (self(f"{name}{axis}", float(v), "m", f"{meaning}, {axis}") for axis, v in zip("xyz", values))
        return x, y, z

    def square(self, name: str, values: Array, unit: str, meaning: str, marks: str = "xyz", other: str = "") -> Square:
        """(3, 3); symmetric, and its entries above the diagonal stand twice, unless it couples two kinds of motion."""
        out = [[sp.S.Zero] * 3 for _ in range(3)]
        for i in range(3):
            for k in range(3) if other else range(i, 3):
                at = f"{marks[i]}{(other or marks)[k]}"
                out[i][k] = self(f"{name}{at}", float(values[i, k]), unit, f"{meaning}, {at}")
                if not other:
                    out[k][i] = out[i][k]
        return out


class Derivation:
    """One chain in symbols, all quantities on one tape."""

    def __init__(self, chain: Chain, symbols: bool = False) -> None:
        self.chain, self.n, self.tape = chain, chain.count, Tape()
        self.of = _Numbers(symbols)
        self.q, self.speeds = symbols_of("q", self.n), symbols_of("s", 6 + self.n)
        self.down, self.current = symbols_of("down", 3), symbols_of("current", 3)
        self.acceleration = symbols_of("acceleration", 3)
        self.gravity = self.of("g", chain.gravity, "m/s^2", "gravity")
        self.density = self.of("rho", chain.density, "kg/m^3", "density of the water")
        self.rows = [self._row(k, link) for k, link in enumerate(chain.links, 1)]
        self.attachment = self.of.vector("c_0", chain.attachment, "origin of frame 0 from the vehicle's centre of mass")
        self.tool = self.of.vector("e_", chain.tool, f"end effector in frame {self.n}")
        near = np.where(np.abs(chain.mount - np.round(chain.mount)) < ROUNDING, np.round(chain.mount), chain.mount)
        self.mount = [[number(float(v)) for v in row] for row in near]
        self.areas = [
            self.of(f"S_{axis}", float(v), "m^2", f"vehicle, C_D S along {axis}")
            for axis, v in zip("xyz", chain.base.drag_area)
        ]
        bodies: tuple[Base | Link, ...] = (chain.base, *chain.links)
        self.bodies = [self._body(k, one) for k, one in enumerate(bodies)]

    def _row(self, k: int, link: Link) -> tuple[Any, Any, Square, float]:
        """a, d and Rx(alpha) of link k, and theta."""
        joint, of = link.joint, self.of
        a, d = of(f"a_{k}", joint.a, "m", f"{link.name}, a"), of(f"d_{k}", joint.d, "m", f"{link.name}, d")
        c, s = (number(v) for v in right_angled(joint.alpha))
        if of.symbols and not {c, s} & {sp.S.Zero}:
            angle = of(f"alpha_{k}", joint.alpha, "rad", f"{link.name}, alpha")
            c, s = sp.cos(angle), sp.sin(angle)
        one, nil = sp.S.One, sp.S.Zero
        return a, d, [[one, nil, nil], [nil, c, -s], [nil, s, c]], joint.theta

    def _body(self, k: int, body: Base | Link) -> composite.Body:
        """Body k in the axes of its joint frame; the vehicle about its centre of mass."""
        of, name = self.of, body.name
        link = body if isinstance(body, Link) else None
        centre = ZERO if link is None else of.vector(f"c_{k}", link.centre_of_mass, f"{name}, centre of mass")
        mass = of(f"m_{k}", body.mass, "kg", f"{name}, mass")
        inertia = of.square(f"I_{k}", body.inertia, "kg m^2", f"{name}, inertia about the centre of mass")
        added = None
        if np.any(body.added_mass):
            water, words = (body.added_mass + body.added_mass.T) / 2.0, f"{name}, added mass"
            added = (
                of.square(f"A_{k}_", water[:3, :3], "kg", words, "123"),
                of.square(f"A_{k}_", water[:3, 3:], "kg m", words, "123", "456"),
                of.square(f"A_{k}_", water[3:, 3:], "kg m^2", words, "456"),
            )
        volume = of(f"V_{k}", body.volume, "m^3", f"{name}, displaced volume")
        lifted = of.vector(f"b_{k}", body.centre_of_buoyancy, f"{name}, centre of buoyancy")
        strips = []
        for i, strip in enumerate(link.strips if link else (), 1):
            mark, words = f"{k}_{i}", f"{name}, strip {i}"
            start = of.vector(f"r_{mark}", strip.start, f"{words}, start")
            whole = bool(np.any(np.abs(np.abs(strip.axis) - 1.0) < 1e-12))
            axis: Sequence[Any] = [number(float(np.round(v) if whole else v)) for v in strip.axis]
            if of.symbols and not whole:
                axis = [of(f"u_{mark}{x}", float(v), "-", f"{words}, axis, {x}") for x, v in zip("xyz", strip.axis)]
            length = of(f"l_{mark}", strip.length, "m", f"{words}, length")
            width = of(f"D_{mark}", strip.diameter, "m", f"{words}, diameter")
            drag = of(f"C_{mark}", strip.coefficient, "-", f"{words}, C_D")
            half = self.density * drag * width * length * sp.Float(0.5)
            strips.append((start, (axis[0], axis[1], axis[2]), length, half))
        out = composite.Body(mass, centre, inertia, added, self.density * volume, lifted, tuple(strips))
        return out if link is None else self._in_joint_frame(k, out)

    def _in_joint_frame(self, k: int, body: composite.Body) -> composite.Body:
        """A link of frame k in the axes of its joint frame: turned by Rx(alpha), moved by a."""
        a, _, turn, _ = self.rows[k - 1]
        back = transposed(turn)

        def placed(point: Vector) -> Vector:
            return plus(times(turn, point), (a, sp.S.Zero, sp.S.Zero))

        def turned(m: Square) -> Square:
            half = transposed([list(times(turn, column)) for column in transposed(m)])
            return [list(times(transposed(back), row)) for row in half]

        added = None if body.added is None else (turned(body.added[0]), turned(body.added[1]), turned(body.added[2]))
        strips = tuple((placed(start), times(turn, axis), length, half) for start, axis, length, half in body.strips)
        centre, lifted = placed(body.centre), placed(body.lifted)
        return composite.Body(body.mass, centre, turned(body.inertia), added, body.displaced, lifted, strips)

    @cached_property
    def steps(self) -> list[composite.Step]:
        """Cosines and sines of the joints, and where the joint frames stand."""
        t = self.tape
        t.stage = "joints"
        out = []
        nil = sp.S.Zero
        fixed, place = self.mount, self.attachment
        for k, (joint, q) in enumerate(zip(self.chain.joints, self.q, strict=True), 1):
            a, d, turn, offset = self.rows[k - 1]
            c0, s0 = right_angled(offset)
            if not joint.turns:
                d, c, s = d + q, number(c0), number(s0)
                if self.of.symbols and 0 not in (c0, s0):
                    angle = self.of(f"theta_{k}", offset, "rad", f"{joint.name}, theta")
                    c, s = t.name(sp.cos(angle), f"cos{k}"), t.name(sp.sin(angle), f"sin{k}")
            elif 0 in (c0, s0):
                c1, s1 = t.name(sp.cos(q), f"cos{k}"), t.name(sp.sin(q), f"sin{k}")
                c, s = c0 * c1 - s0 * s1, s0 * c1 + c0 * s1
            else:
                angle = t.name(q + self.of(f"theta_{k}", offset, "rad", f"{joint.name}, theta"), f"angle{k}")
                c, s = t.name(sp.cos(angle), f"cos{k}"), t.name(sp.sin(angle), f"sin{k}")
            shift = t.vector(plus(place, times(fixed, (nil, nil, d))))
            named = [[t.name(e) for e in row] for row in fixed]
            out.append(composite.Step(shift, named, c, s, joint.turns))
            fixed, place = turn, (a, nil, nil)
        return out

    @cached_property
    def mass(self) -> sp.Matrix:
        """M by composite bodies: what moves with a joint as one body, from the tip inwards."""
        t, steps = self.tape, self.steps
        size = 6 + self.n
        out = sp.zeros(size, size)
        whole = None
        for k in range(self.n, 0, -1):
            t.stage = f"inertia of link {k} and what it carries"
            step = steps[k - 1]
            whole = composite.joined(t, composite.about_origin(t, self.bodies[k]), whole)
            force = composite.momentum(whole, step.turns)
            out[5 + k, 5 + k] = force[1][2] if step.turns else force[0][2]
            for j in range(k, 0, -1):
                force = composite.inward(t, steps[j - 1], force)
                if j > 1:
                    out[4 + j, 5 + k] = out[5 + k, 4 + j] = force[1][2] if steps[j - 2].turns else force[0][2]
            for i, e in enumerate((*force[0], *force[1])):
                out[i, 5 + k] = out[5 + k, i] = e
            whole = composite.moved_in(t, step, whole)
        t.stage = "inertia of the vehicle with its arm"
        whole = composite.joined(t, composite.about_origin(t, self.bodies[0]), whole)
        a, b, d = composite.blocks(whole)
        for i in range(3):
            for j in range(3):
                out[i, j], out[3 + i, 3 + j] = a[i][j], d[i][j]
                out[i, 3 + j] = out[3 + j, i] = b[i][j]
        return out

    @cached_property
    def moving(self) -> list[_Motion]:
        """Motion where no generalised speed changes."""
        return self.motion(current=True)

    @cached_property
    def heavy(self) -> list[Vector]:
        """Gravity in the axes of every body."""
        return self.spread(composite.scaled(self.gravity, self.down))

    @cached_property
    def water(self) -> list[Vector]:
        """Acceleration of the water in the axes of every body."""
        return self.spread(self.acceleration)

    def motion(self, current: bool, changes: Sequence[Any] = ()) -> list[_Motion]:
        """How every joint frame moves, the vehicle first (equations 9 to 12); no speed changes unless ``changes`` says how."""
        t, steps = self.tape, self.steps
        t.stage = "velocity of the vehicle"
        v, w = self.speeds[:3], self.speeds[3:6]
        faster = changes or [sp.S.Zero] * (6 + self.n)
        a: Sequence[Any] = t.vector(plus(faster[:3], cross(w, v)))
        alpha: Sequence[Any] = tuple(faster[3:6])
        if current:
            v = [t.name(x - c) for x, c in zip(v, self.current, strict=True)]
        out = []
        for k in range(self.n + 1):
            turning = _turning(t, w, alpha)
            out.append(_Motion(tuple(v), tuple(w), tuple(a), tuple(alpha), turning))
            if k == self.n:
                break
            t.stage = f"velocity of link {k + 1}"
            step, rate, more = steps[k], self.speeds[6 + k], faster[6 + k]
            v = list(step.outward(t, t.vector(plus(v, cross(w, step.shift)))))
            a = step.outward(t, t.vector(plus(a, times(turning, step.shift))))
            alpha = step.outward(t, alpha)
            w = list(step.outward(t, w))
            if step.turns:
                alpha = (t.name(alpha[0] + w[1] * rate), t.name(alpha[1] - w[0] * rate), t.name(alpha[2] + more))
                w[2] = t.name(w[2] + rate)
            else:
                twice = t.name(2 * rate)
                a = (t.name(a[0] + w[1] * twice), t.name(a[1] - w[0] * twice), t.name(a[2] + more))
                v[2] = t.name(v[2] + rate)
        return out

    def spread(self, vector: Sequence[Any]) -> list[Vector]:
        """A vector of the vehicle's axes in those of every body."""
        t = self.tape
        out = [t.vector(vector)]
        for k, step in enumerate(self.steps, 1):
            t.stage = f"directions in link {k}"
            out.append(step.outward(t, out[-1]))
        return out

    def generalised(self, wrenches: list[Wrench]) -> sp.Matrix:
        """Generalised forces of forces and moments about the origins of the joint frames."""
        t, steps = self.tape, self.steps
        out = sp.zeros(6 + self.n, 1)
        force, moment = wrenches[-1]
        for k in range(self.n, 0, -1):
            t.stage = f"forces on link {k} and what it carries"
            force, moment = t.vector(force), t.vector(moment)
            out[5 + k] = moment[2] if steps[k - 1].turns else force[2]
            force, moment = composite.inward(t, steps[k - 1], (force, moment))
            more, turning = wrenches[k - 1]
            force, moment = plus(force, more), plus(moment, turning)
        t.stage = "forces on the vehicle with its arm"
        for i, e in enumerate((*t.vector(force), *t.vector(moment))):
            out[i] = e
        return out

    @cached_property
    def inertial(self) -> list[Wrench]:
        """What each body needs to move so: equations 6, 7 and 15, minus."""
        t, out = self.tape, []
        for k, (body, m) in enumerate(zip(self.bodies, self.moving, strict=True)):
            t.stage = f"inertia forces of link {k}" if k else "inertia forces of the vehicle"
            centre = t.vector(body.centre)
            at = t.vector(plus(m.a, times(m.turning, centre)))
            force = tuple(body.mass * e for e in at)
            spin = t.vector(times(body.inertia, m.w))
            moment = plus(times(body.inertia, m.alpha), cross(m.w, spin))
            if body.added is not None:
                mass, both, inertia = body.added
                v = t.vector(plus(m.v, cross(m.w, centre)))
                changing = t.vector(e - f - g for e, f, g in zip(at, self.water[k], cross(m.w, v), strict=True))
                p = t.vector(plus(times(mass, v), times(both, m.w)))
                h = t.vector(plus(times(transposed(both), v), times(inertia, m.w)))
                force = plus(force, plus(plus(times(mass, changing), times(both, m.alpha)), cross(m.w, p)))
                pushed = plus(times(transposed(both), changing), times(inertia, m.alpha))
                moment = plus(moment, plus(pushed, plus(cross(m.w, h), cross(v, p))))
            out.append(_at_origin(t, (t.vector(force), t.vector(moment)), centre))
        return out

    def uniform(self, kinds: Sequence[str], field: list[Vector]) -> list[Wrench]:
        """Forces of a field on masses, and against it on what is displaced, at its centre (equations 14, 19 and 20)."""
        t, out = self.tape, []
        for k, (body, along) in enumerate(zip(self.bodies, field, strict=True)):
            t.stage = f"forces of a field on link {k}" if k else "forces of a field on the vehicle"
            amount, lever = sp.S.Zero, ZERO
            if "mass" in kinds:
                amount, lever = body.mass, composite.scaled(body.mass, body.centre)
            if "displaced" in kinds:
                amount, lever = amount - body.displaced, plus(lever, composite.scaled(-body.displaced, body.lifted))
            amount, lever = t.name(amount), t.vector(lever)
            out.append((t.vector(composite.scaled(amount, along)), t.vector(cross(lever, along))))
        return out

    @cached_property
    def dragging(self) -> list[Wrench]:
        """Drag on every body (equations 21 and 22, erratum 7)."""
        t, moving = self.tape, self.moving
        t.stage = "drag of the vehicle"
        v = moving[0].v
        speed = t.name(sp.sqrt(sum(e * e for e in v))) if any(e != 0 for e in self.areas) else sp.S.Zero
        half = self.density * sp.Float(-0.5)
        out: list[Wrench] = [(t.vector(half * s * speed * e for s, e in zip(self.areas, v, strict=True)), ZERO)]
        for k, (body, m) in enumerate(zip(self.bodies[1:], moving[1:], strict=True), 1):
            t.stage = f"drag of link {k}"
            force, moment = ZERO, ZERO
            for start, axis, length, half in body.strips:
                here = t.vector(plus(m.v, cross(m.w, start)))
                along = t.name(sum(a * e for a, e in zip(axis, here, strict=True)))
                across = t.vector(e - a * along for a, e in zip(axis, here, strict=True))
                reach = t.vector(length * e for e in axis)
                first, second = t.strip(across, t.vector(cross(m.w, reach)))
                push, further = t.vector(-half * e for e in first), t.vector(-half * e for e in second)
                force = plus(force, push)
                moment = plus(moment, plus(cross(start, push), cross(reach, further)))
            out.append((force, moment))
        return out


class _Motion(NamedTuple):
    """Of a joint frame, in its axes: v through the water at its origin, w, a and alpha, and alpha x + w x w x as a matrix."""

    v: Any
    w: Any
    a: Any
    alpha: Any
    turning: Square


def _turning(t: Tape, w: Sequence[Any], alpha: Sequence[Any]) -> Square:
    """Alpha x + w x w x, named."""
    xx, yy, zz = (t.name(e * e) for e in w)
    xy, xz, yz = t.name(w[0] * w[1]), t.name(w[0] * w[2]), t.name(w[1] * w[2])
    return [
        [t.name(-yy - zz), t.name(xy - alpha[2]), t.name(xz + alpha[1])],
        [t.name(xy + alpha[2]), t.name(-xx - zz), t.name(yz - alpha[0])],
        [t.name(xz - alpha[1]), t.name(yz + alpha[0]), t.name(-xx - yy)],
    ]


def _at_origin(t: Tape, wrench: Wrench, centre: Vector) -> Wrench:
    """Of a force at a point the moment about the origin too."""
    force, moment = wrench
    return force, t.vector(plus(moment, cross(centre, force)))


def _mass_matrix(one: Derivation) -> Outputs:
    return {"M": (one.mass, INERTIA)}


def _equations(one: Derivation) -> Outputs:
    """M and all forces but the drives', in one go."""
    total = [(composite.scaled(-1, f), composite.scaled(-1, m)) for f, m in one.inertial]
    heavy = one.uniform(("mass", "displaced"), one.heavy)
    carried = [(composite.scaled(-1, f), composite.scaled(-1, m)) for f, m in one.uniform(("displaced",), one.water)]
    for more in (heavy, carried, one.dragging):
        total = [(plus(f, g), plus(m, n)) for (f, m), (g, n) in zip(total, more, strict=True)]
    return {"M": (one.mass, INERTIA), "f": (one.generalised(total), FORCES)}


def _bias(one: Derivation) -> Outputs:
    return {"h": (one.generalised(one.inertial), FORCES)}


def _weight(one: Derivation) -> Outputs:
    return {"w": (one.generalised(one.uniform(("mass",), one.heavy)), FORCES)}


def _buoyancy(one: Derivation) -> Outputs:
    return {"b": (one.generalised(one.uniform(("displaced",), one.heavy)), FORCES)}


def _fluid_acceleration(one: Derivation) -> Outputs:
    against = [composite.scaled(-1, v) for v in one.water]
    return {"f": (one.generalised(one.uniform(("displaced",), against)), FORCES)}


def _drag(one: Derivation) -> Outputs:
    return {"d": (one.generalised(one.dragging), FORCES)}


def _end(one: Derivation) -> Outputs:
    a, _, turn, _ = one.rows[-1]
    t = one.tape
    place = plus(times(turn, one.tool), (a, sp.S.Zero, sp.S.Zero))
    t.stage = "end effector"
    for step in reversed(one.steps):
        place = plus(step.inward(t, t.vector(place)), step.shift)
    return {"r": (sp.Matrix(t.vector(place)), "m")}


def link_motion(chain: Chain, link: int, *, symbols: bool = True) -> dict[str, sp.Matrix]:
    """Place and motion of a link's centre of mass along the vehicle's axes, written out (equations 8 to 12).

    Parameters
    ----------
    chain : Chain
    link : int
        From 1.
    symbols : bool
        Keep the numbers of the file as symbols.

    Returns
    -------
    dict of str to (3, 1) sympy.Matrix
        p from the vehicle's centre of mass, w, v, alpha and a, in q1 .., s1 .. and their rates sdot1 ...
    """
    one = Derivation(chain, symbols)
    t, steps = one.tape, one.steps
    moving = one.motion(current=False, changes=symbols_of("sdot", 6 + chain.count))[link]
    centre, turning = one.bodies[link].centre, moving.turning
    found: dict[str, Sequence[Any]] = {
        "w": moving.w, "v": plus(moving.v, cross(moving.w, centre)),
        "alpha": moving.alpha, "a": plus(moving.a, times(turning, centre)),
    }  # fmt: skip
    for step in reversed(steps[:link]):
        found = {key: step.inward(t, t.vector(vector)) for key, vector in found.items()}
        centre = plus(step.inward(t, t.vector(centre)), step.shift)
    outputs = {key: (sp.Matrix(list(vector)), "") for key, vector in {"p": centre, **found}.items()}
    result = t.function("link_motion", "", ("q", "s"), outputs)
    return {key: result.expanded(key) for key in outputs}


Outputs = dict[str, tuple[sp.Matrix, str]]
Quantity = Callable[[Derivation], Outputs]
INERTIA, FORCES = "kg, kg m, kg m^2", "N, N m"
QUANTITIES: dict[str, tuple[str, tuple[str, ...], Quantity]] = {
    "mass_matrix": (
        "M, inertia of bodies and of the water that moves with them.", ("q",),
        _mass_matrix,
    ),
    "bias": ("h, what motion asks for where no speed changes.", ("q", "s", "current", "acceleration"), _bias),
    "weight": ("Generalised force of the weight.", ("q", "down"), _weight),
    "buoyancy": ("Generalised force of buoyancy.", ("q", "down"), _buoyancy),
    "fluid_acceleration": (
        "Generalised force on the displaced water.", ("q", "acceleration"), _fluid_acceleration,
    ),
    "drag": ("Generalised force of drag.", ("q", "s", "current"), _drag),
    "equations": (
        "M and f = weight + buoyancy + fluid acceleration + drag - h, worked out together: M ds/dt = f + drives.",
        ("q", "s", "down", "current", "acceleration"), _equations,
    ),
    "end_effector": ("Place of the end effector, from the vehicle's centre of mass.", ("q",), _end),
}  # fmt: skip


def derive(chain: Chain, *, symbols: bool = False, say: Say = lambda _: None) -> ClosedForm:
    """The equations of a chain in closed form.

    Parameters
    ----------
    chain : Chain
    symbols : bool
        Keep the numbers of the file as symbols, with their values beside.
    say : callable
        Is handed what is worked out next.

    Raises
    ------
    InputError
        A vehicle without an arm.
    """
    if not chain.count:
        raise InputError("a vehicle without links", "one link or more", column="link")
    one = Derivation(chain, symbols)
    result = []
    for name, (words, arguments, quantity) in QUANTITIES.items():
        say(name.replace("_", " "))
        result.append(one.tape.function(name, words, arguments, quantity(one)))
    links = tuple((link.name, link.joint.kind) for link in chain.links)
    found = {p.symbol: p for p in one.of.found}
    return ClosedForm(chain.name, links, tuple(result), tuple(found.values()))
