"""The test matrix: the conditions in which a body is towed, turned and steered.

A body that is its own mirror image is towed on one side only, and in half the domain where the motion lies in its other mirror
plane: what the mirror says is declared, not run.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.tables.campaign import FOURFOLD, PORT_STARBOARD, UP_DOWN

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

# Sizes of drift and attack, deg. Small ones carry the slope at the origin, large ones show how it bends.
ONE_SIDE, BOTH_SIDES = (2.0, 4.0, 6.0, 8.0, 10.0, 12.0), (2.0, 4.0, 8.0, 12.0)
# Of the largest rate. That rate gives the farther end of the body the cross flow of the largest drift: on an arm the local
# incidence grows along the body, and beyond it the ends separate before the middle sees a rate at all.
ONE_TURN, BOTH_TURNS = (1 / 6, 1 / 3, 1 / 2, 2 / 3, 5 / 6, 1.0), (1 / 6, 1 / 3, 2 / 3, 1.0)
LARGEST_RATE = 0.5  # r'; half of it and less, three rates at least, is what oscillation tests reach
KEEPS = {"dr": UP_DOWN, "ds": PORT_STARBOARD, "db": PORT_STARBOARD}  # mirror that a deflected pair of controls leaves
_NO_NAME = re.compile(r"[^A-Za-z0-9_.+-]+")
EXACT = 1e-9  # smaller components of a motion are rounding


class Kind(StrEnum):
    """What a condition is for."""

    STRAIGHT = "straight"
    DRIFT = "drift"
    ATTACK = "attack"
    ARM = "arm"
    COMBINED = "combined"
    CONTROL = "control"


class Half(StrEnum):
    """Which half of the body is in the domain; on the cut is a symmetry plane."""

    WHOLE = ""
    PORT = "y<0"
    UPPER = "z<0"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("velocity rates")
class TowCondition:
    """One steady motion of the body through water at rest.

    Attributes
    ----------
    name : str
        Of its folder and its row: letters, digits, ``_ . + -``.
    kind : Kind
    velocity : (3,) array
        u, v, w of the reference point, m/s, FRD.
    rates : (3,) array
        p, q, r, rad/s, FRD.
    controls : mapping of str to float
        Angle of each control by its name (``dr``, ``ds``), rad; an absent one is at zero.
    half : Half
        What has to be computed of the body.
    grid : str
        Name of the grid, ``medium`` by default.
    variant : mapping of str to str
        What a study changes, by its name: ``domain`` (factor of its size), ``turbulence`` (name of the model), ``iterations``
        (their number); empty for the matrix itself.
    """

    name: str
    kind: Kind
    velocity: Array
    rates: Array
    controls: Mapping[str, float] = field(default_factory=dict)
    half: Half = Half.WHOLE
    grid: str = "medium"
    variant: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("controls", "variant"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def speed(self) -> float:
        """Of the reference point, m/s."""
        return float(np.linalg.norm(self.velocity))

    @property
    def turns(self) -> bool:
        """Whether the body is on a rotating arm."""
        return bool(np.any(self.rates))

    @property
    def table(self) -> str:
        """Stem of the campaign's table that its row belongs to: straight runs go with the sweep that shares their mesh."""
        if self.kind is not Kind.STRAIGHT:
            return str(self.kind)
        return str(Kind.ATTACK if self.half is Half.PORT else Kind.DRIFT)


@brief
@dataclass(frozen=True, slots=True)
class Sweeps:
    """What is to be run, as people say it: angles and primed rates.

    Attributes
    ----------
    drift, attack : tuple of float
        Angles, rad: v = U sin(drift), w = U sin(attack).
    yaw, pitch : tuple of float
        Rates r' = r L/U and q' = q L/U, by the length of the primes.
    combined : tuple of (drift, attack, yaw, pitch)
        Motions at once.
    controls : mapping of str to tuple of float
        Angles of each control, rad, straight ahead.
    speeds : tuple of float
        Of further straight runs, m/s.
    pairs : tuple of str
        Conditions of which the mirror image is run as well: half the sum of both is the bias of the flow and its mesh.
    """

    drift: tuple[float, ...] = ()
    attack: tuple[float, ...] = ()
    yaw: tuple[float, ...] = ()
    pitch: tuple[float, ...] = ()
    combined: tuple[tuple[float, float, float, float], ...] = ()
    controls: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    speeds: tuple[float, ...] = ()
    pairs: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "controls", MappingProxyType(dict(self.controls)))


@brief
@dataclass(frozen=True, slots=True)
class Study:
    """What is varied of some conditions to see how far a choice moves their forces.

    Attributes
    ----------
    of : tuple of str
        Names of conditions.
    values : mapping of str to tuple of str
        ``grid`` (names), ``domain`` (factors of its size), ``turbulence`` (models), ``iterations`` (numbers); each alone.
    """

    of: tuple[str, ...]
    values: Mapping[str, tuple[str, ...]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))


def symmetries(body: TowedBody | None) -> tuple[str, ...]:
    """Of port-starboard, up-down, fourfold those that the body has; none of a body that is not known."""
    if body is None:
        return ()
    named = {PORT_STARBOARD: body.mirrors[1], UP_DOWN: body.mirrors[2], FOURFOLD: body.fourfold}
    return tuple(name for name, has in named.items() if has)


def largest_rate(body: TowedBody | None, length: float) -> float:
    """The r' at which the farther end of the body moves sideways as fast as at the largest drift, at most `LARGEST_RATE`.

    Parameters
    ----------
    body : TowedBody or None
        Without one its ends are half a length from the reference point.
    length : float
        Of the primes, m.
    """
    reach = 0.5 * length if body is None else float(np.abs(body.vertices[:, 0]).max())
    return min(LARGEST_RATE, float(np.sin(np.radians(ONE_SIDE[-1]))) * length / reach)


def default_sweeps(body: TowedBody | None, length: float) -> Sweeps:
    """What Yv', Nv', Zw', Mw', Yr' and Nr' need.

    One sign where the body is its own mirror image, both where it is not; no attack where a quarter of a turn makes it drift.

    Parameters
    ----------
    body : TowedBody or None
    length : float
        Of the primes, m.
    """
    has = symmetries(body)
    step = _rounded(largest_rate(body, length) / 6.0)
    turns = ONE_TURN if PORT_STARBOARD in has else BOTH_TURNS
    yaw = tuple(round(6.0 * share * step, 9) for share in turns)
    return Sweeps(
        drift=_angles(PORT_STARBOARD in has),
        attack=() if FOURFOLD in has else _angles(UP_DOWN in has),
        yaw=yaw if PORT_STARBOARD in has else (*(-r for r in reversed(yaw)), *yaw),
    )


def _angles(one_side: bool) -> tuple[float, ...]:
    sizes = ONE_SIDE if one_side else (*(-a for a in reversed(BOTH_SIDES)), *BOTH_SIDES)
    return tuple(float(np.radians(a)) for a in sizes)


def _rounded(step: float) -> float:
    """Down to two digits."""
    unit = 10.0 ** (np.floor(np.log10(step)) - 1.0)
    return float(np.floor(step / unit + EXACT) * unit)


def conditions(sweeps: Sweeps, body: TowedBody | None, speed: float, length: float) -> tuple[TowCondition, ...]:
    """The conditions of sweeps, a straight run first in every domain that a sweep has.

    Parameters
    ----------
    sweeps : Sweeps
    body : TowedBody or None
    speed : float
        m/s.
    length : float
        Of the primes, m.

    Raises
    ------
    InputError
        One condition twice, or the mirror image of another of a body with that mirror.
    """
    has = symmetries(body)

    def condition(
        name: str, kind: Kind, angles: tuple[float, float] = (0.0, 0.0), turns: tuple[float, float] = (0.0, 0.0),
        controls: Mapping[str, float] | None = None, at: float = speed,
    ) -> TowCondition:  # fmt: skip
        velocity = at * _direction(*angles)
        rates = np.array([0.0, turns[1], turns[0]]) * at / length
        return TowCondition(name, kind, velocity, rates, controls or {}, half_of(velocity, rates, controls or {}, has))

    swept = [condition(f"drift{_degrees(a)}", Kind.DRIFT, (a, 0.0)) for a in sweeps.drift]
    swept += [condition(f"attack{_degrees(a)}", Kind.ATTACK, (0.0, a)) for a in sweeps.attack]
    swept += [condition(f"yaw{r:+.6g}", Kind.ARM, turns=(r, 0.0)) for r in sweeps.yaw]
    swept += [condition(f"pitch{q:+.6g}", Kind.ARM, turns=(0.0, q)) for q in sweeps.pitch]
    straight = condition("straight", Kind.STRAIGHT)
    halves = list(dict.fromkeys(c.half for c in swept)) or [straight.half]
    ahead = [replace(straight, half=halves[0])]
    ahead += [replace(straight, half=half, name=f"straight_{half.name.lower()}") for half in halves[1:]]
    more = [condition(_combined(*m), Kind.COMBINED, m[:2], m[2:]) for m in sweeps.combined]
    for name, angles in sweeps.controls.items():
        more += [condition(f"{name}{_degrees(a)}", Kind.CONTROL, controls={name: a}) for a in angles]
    more += [replace(condition(f"speed{v:+.6g}", Kind.STRAIGHT, at=v), half=halves[0]) for v in sweeps.speeds]
    out = (*ahead, *swept, *more)
    _check(out, has)
    for name in sweeps.pairs:
        out = (*out, _image(name, out, has))
    return out


def _image(name: str, among: Sequence[TowCondition], has: Sequence[str]) -> TowCondition:
    """The mirror image of a condition, which is run to see the bias: of what symmetry says, nothing is taken for granted."""
    found = {c.name: c for c in among}.get(name)
    sweep = {Kind.DRIFT: PORT_STARBOARD, Kind.ATTACK: UP_DOWN, Kind.ARM: PORT_STARBOARD}
    if found is None or found.kind not in sweep:
        known = ", ".join(c.name for c in among if c.kind in sweep)
        raise InputError(shown(name), f"a condition of one motion: {known}", column="matrix.pairs")
    plane = UP_DOWN if found.kind is Kind.ARM and found.rates[1] else sweep[found.kind]
    if plane not in has:
        raise input_error("tow.pair_body_without", column="matrix.pairs", name=name, plane=plane)
    other = name.translate(str.maketrans("+-", "-+"))
    if other in {c.name for c in among}:
        raise InputError(f"{other} twice", "a condition that is run on one side", column="matrix.pairs")
    velocity, rates = mirrored(found, plane)
    return replace(found, name=other, velocity=velocity, rates=rates + 0.0)


def _direction(drift: float, attack: float) -> Array:
    """Unit vector of the velocity: v' = sin(drift), w' = sin(attack)."""
    v, w = np.sin(drift), np.sin(attack)
    ahead = 1.0 - v * v - w * w
    if not ahead > 0.0:
        raise input_error(
            "tow.drift_attack_deg", column="matrix", degrees=np.degrees(drift), degrees_2=np.degrees(attack),
        )  # fmt: skip
    return np.array([np.sqrt(ahead), v, w])


def _degrees(angle: float) -> str:
    return f"{round(float(np.degrees(angle)), 6):+.6g}"


def _combined(drift: float, attack: float, yaw: float, pitch: float) -> str:
    parts = [
        f"drift{_degrees(drift)}" if drift else "", f"attack{_degrees(attack)}" if attack else "",
        f"yaw{yaw:+.6g}" if yaw else "", f"pitch{pitch:+.6g}" if pitch else "",
    ]  # fmt: skip
    return "_".join(p for p in parts if p) or "straight"


def half_of(velocity: Array, rates: Array, controls: Mapping[str, float], has: Sequence[str]) -> Half:
    """Which half of the body says all of a motion.

    The upper half where the motion lies in the horizontal plane and the body is alike above and below, the port half where it
    lies in the vertical plane and the body is alike on both sides, else the whole body.

    Parameters
    ----------
    velocity, rates : (3,) array
    controls : mapping of str to float
    has : sequence of str
        Of `symmetries`.
    """
    size = EXACT * float(np.linalg.norm(velocity))
    turning = EXACT * max(float(np.linalg.norm(rates)), 1e-300)
    selected = {KEEPS.get(name, "") for name, angle in controls.items() if angle}
    flat = abs(velocity[2]) <= size and bool(np.all(np.abs(rates[:2]) <= turning)) and selected <= {UP_DOWN}
    upright = (
        abs(velocity[1]) <= size and bool(np.all(np.abs(rates[[0, 2]]) <= turning)) and selected <= {PORT_STARBOARD}
    )
    if flat and UP_DOWN in has:
        return Half.UPPER
    return Half.PORT if upright and PORT_STARBOARD in has else Half.WHOLE


def mirrored(condition: TowCondition, plane: str) -> tuple[Array, Array]:
    """Velocity and rates, (3,) each, of the mirror image; rates are axial."""
    flips = np.array([1.0, -1.0, 1.0]) if plane == PORT_STARBOARD else np.array([1.0, 1.0, -1.0])
    return condition.velocity * flips, -condition.rates * flips


def _check(found: Sequence[TowCondition], has: Sequence[str]) -> None:
    """Every condition once, and none that the mirror gives."""
    names: dict[str, TowCondition] = {}
    for c in found:
        if c.name in names:
            raise InputError(f"the condition {shown(c.name)} twice", "every condition once", column="matrix")
        names[c.name] = c
    for plane in (PORT_STARBOARD, UP_DOWN):
        for i, c in enumerate(found):
            if plane not in has or c.controls:
                continue
            velocity, rates = mirrored(c, plane)
            for other in found[:i]:
                same = not other.controls and np.allclose(other.velocity, velocity, rtol=0.0, atol=1e-6 * c.speed)
                if same and np.allclose(other.rates, rates, rtol=1e-6, atol=0.0) and c.kind is not Kind.STRAIGHT:
                    raise input_error(
                        "tow.mirror_image", column="matrix", name=shown(c.name), name_2=shown(other.name), plane=plane,
                    )  # fmt: skip


def with_studies(matrix: Sequence[TowCondition], studies: Sequence[Study]) -> tuple[TowCondition, ...]:
    """The matrix, and behind it every condition of a study with one thing changed.

    Parameters
    ----------
    matrix : sequence of TowCondition
    studies : sequence of Study

    Raises
    ------
    InputError
        A study of a condition that the matrix does not have, or one twice.
    """
    known = {c.name: c for c in matrix}
    out = list(matrix)
    for i, study in enumerate(studies):
        for name in study.of:
            if name not in known:
                raise input_error(
                    "tow.condition_matrix", column=f"study[{i}].of", found=shown(name), known=", ".join(known),
                )  # fmt: skip
            for what, values in study.values.items():
                out += [_varied(known[name], what, value) for value in values]
    names = [c.name for c in out]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"the condition {shown(name)} twice", "every condition once", column="study")
    return tuple(out)


def _varied(condition: TowCondition, what: str, value: str) -> TowCondition:
    name = f"{condition.name}_{what}_{_NO_NAME.sub('-', value)}"
    if what == "grid":
        return replace(condition, name=name, grid=value)
    return replace(condition, name=name, variant={what: value})


def _named(**swept: Sequence[float]) -> str:
    """The motions that are run at all."""
    return " and ".join(name for name, settings in swept.items() if any(settings))


def stated(body: TowedBody | None, sweeps: Sweeps) -> tuple[str, ...]:
    """What symmetry says in the place of runs, in words; see `default_sweeps`."""
    has = symmetries(body)
    out = []
    if PORT_STARBOARD in has and _one_sided((*sweeps.drift, *sweeps.yaw)):
        out.append(
            f"{_named(drift=sweeps.drift, **{'yaw rate': sweeps.yaw})} of the other side from this one by port-starboard symmetry"
        )
    if UP_DOWN in has and _one_sided((*sweeps.attack, *sweeps.pitch)):
        out.append(
            f"{_named(attack=sweeps.attack, **{'pitch rate': sweeps.pitch})} of the other side from this one by up-down symmetry"
        )
    if FOURFOLD in has and (sweeps.drift and not sweeps.attack):
        out.append("attack from drift by fourfold symmetry: Zw' = Yv', Mw' = -Nv'")
    if FOURFOLD in has and (sweeps.yaw and not sweeps.pitch):
        out.append("pitch rate from yaw rate by fourfold symmetry: Zq' = -Yr', Mq' = Nr'")
    return tuple(out)


def _one_sided(values: Sequence[float]) -> bool:
    return bool(values) and not (min(values) < 0.0 < max(values))
