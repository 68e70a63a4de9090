"""MuJoCo: a free body with one geom of ``fluidshape="ellipsoid"``.

MuJoCo takes the ellipsoid's added masses for -C_A(nu) nu, the Munk moment among it, and has no force in proportion to
acceleration: the body moves without added inertia. Five coefficients, the place of the geom and its shape are all that is left:
they take X0, Yv, Nv, Yr and a mean of Nr. The damping in yaw that is linear in r comes of the place x alone and is x (Yr - m)
U r with m U v the Munk moment. Where that drives the turn, the ellipsoid gets another Munk moment; where no ellipsoid damps
every motion as the file does, terms are left out until none has the wrong sign, for those who accept that loss.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.text.xml import numbers, parse_xml, serialised
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import held_when_straight, number, states_buoyancy, straight_coefficients
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import unheld
from coeflab.formats.missing_parts import missing_mass
from coeflab.formats.mujoco.law import FluidEllipsoid, ellipsoid_of_masses
from coeflab.law.force_law import ForceLaw
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.force_law import force_law, force_of_tables
from coeflab.vehicle.inertia import central_inertia, centre_of_gravity, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile

summary = "MuJoCo: an MJCF body with a fluid ellipsoid; Munk moment and drag, no added inertia"
citations = ("lamb1932", "mujoco")
adds_coriolis = True
holds: frozenset[str] = frozenset()
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
RATE = 0.25
HELD = 1e-6
# v/U, r L/U and so on at which a damping must have the file's sign; X is tried at these speeds over half of the file's.
RATES = (0.05, 0.1, 0.2, 0.3, 0.5)
SLOW = 0.005  # a shape that damps here too goes first
ROUNDING = 1e-9
LEAST = 1e-3  # of the file's Munk moment, which an ellipsoid of another shape keeps
# A plane: side force, moment and turning force, axis across, and the sign that makes M over w an N over v.
PLANES = (("Yv", "Nv", "Yr", 1, 1.0), ("Zw", "Mw", "Zq", 2, -1.0))
_LEFT_OUT = "added inertia: MuJoCo has no force in proportion to acceleration"


@dataclass(frozen=True, slots=True, eq=False)
class _Geom:
    """The ellipsoid and x of its centre ahead of the reference point, m.

    ``hull`` are the semi-axes (3,) of the ellipsoid that has the file's added masses. ``angular`` meets the damping of the motion
    ``turn``, one of Nr, Mq, Kp or none, at the rate times length over speed ``rate``. ``own`` is the x that Nv would need with the
    Munk moment of that ellipsoid. ``refused`` says which damping no whole geom has with its sign, ``left_out`` what this one is
    without for that reason.
    """

    ellipsoid: FluidEllipsoid
    forward: float
    hull: Array
    plane: tuple[str, str, str, int, float] = PLANES[0]
    turn: str = ""
    rate: float = RATE
    own: float = 0.0
    refused: str = ""
    left_out: tuple[str, ...] = ()

    @property
    def reshaped(self) -> bool:
        """Whether the ellipsoid is not that of the file's added masses."""
        return not np.array_equal(self.hull, self.ellipsoid.axes)

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD, about the reference point."""
        v, w = (nu * FLU)[:, :3], (nu * FLU)[:, 3:]
        arm = np.array([self.forward, 0.0, 0.0])
        force, torque = self.ellipsoid.force(v + np.cross(w, arm), w)
        return np.asarray(np.hstack([force, torque + np.cross(arm, force)]) * FLU)


def _fitted(parameters: ParameterFile) -> tuple[_Geom, ForceLaw]:
    """The first geom, in the order of `_places`, that damps every motion as the file does; else the first without the terms that
    would drive one.

    Raises
    ------
    InputError
        The added masses along x, y and z are not all known, or those of no ellipsoid.
    """
    law = force_law(parameters)
    masses, rho = np.diag(water_inertia(parameters).matrix)[:3], parameters.conditions.density
    if np.any(masses <= 0.0):
        raise input_error("formats.no_added_mass")
    hull, miss = ellipsoid_of_masses(masses, rho)
    if miss > HELD:
        raise InputError(f"added masses {', '.join(f'{m:.4g}' for m in masses)} kg", "those of some ellipsoid")
    of = straight_coefficients(law, parameters.conditions.speed)
    places = list(_places(masses, hull, of, parameters))
    tried = [_geom(*place, hull, of, parameters, law) for place in places]
    for rates in ((SLOW, *RATES), RATES):
        for geom in tried:
            if not _flipped(geom, law, parameters, rates):
                return geom, law
    why = _flipped(tried[-1], law, parameters, RATES)
    flat = [
        _geom(*place, hull, of, parameters, law, lifts=False) for place in (*places, (masses, hull, 0.0, places[-1][3]))
    ]
    still = replace(flat[-1], ellipsoid=replace(flat[-1].ellipsoid, slender=0.0, angular=0.0))
    bare = replace(still, ellipsoid=replace(still.ellipsoid, blunt=0.0))
    geom = next(
        g
        for g in (*tried, *flat, still, bare)
        if g is bare or not _flipped(g, law, parameters, (SLOW, *RATES), whole=False)
    )
    lift = tried[-1].ellipsoid.kutta and not geom.ellipsoid.kutta
    left = [f"the lift of {geom.plane[0]}: with it {why}; drag alone stands for it"] if lift else []
    return replace(geom, refused=why, left_out=(*left, *_undamped(geom, law, parameters))), law


def _plane(of: Mapping[str, float]) -> tuple[str, str, str, int, float]:
    """The plane of Yv, Nv and Yr; that of Zw, Mw and Zq where the file has none of these."""
    return next((p for p in PLANES if set(p[:3]) & set(of)), PLANES[0])


def _drag_of(slope: str) -> str:
    """``Yv|v|`` of ``Yv``."""
    return f"{slope}|{slope[1]}|"


def _places(
    masses: Array, hull: Array, of: Mapping[str, float], parameters: ParameterFile
) -> Iterator[tuple[Array, Array, float, float]]:
    """Added masses, semi-axes, x of the centre, and the x that the file's own ellipsoid would need; the nearest to the file first.

    First the file's own ellipsoid, where Yv and its Munk moment make up Nv. Then one with a Munk moment m nearest to the file's
    that has Nv and for which x (Yr - m) does not drive the turn: m lies between Yr and -Nv. Last the file's own at the reference
    point, where its Munk moment alone stands for Nv.
    """
    side_force, moment, turning, side, sign = _plane(of)
    rho, length = parameters.conditions.density, parameters.scaling.length
    munk, surge, other = float(masses[side] - masses[0]), float(masses[0]), 3 - side
    sway = of.get(side_force, -max(0.0, -of.get("X0", 0.0)))
    turned, yawed = sign * of.get(moment, -sign * munk), sign * of.get(turning, -sign * surge)
    apart = turned + munk
    own = apart / sway if sway and not np.isclose(hull[0], hull[side]) else 0.0
    if abs(own) <= length and (own or not apart):
        yield masses, hull, own, own
    low, high = sorted((-turned, yawed)) if sway < 0.0 else (-turned, -turned)
    reach = length * abs(sway)
    low, high = max(low, -turned - reach, LEAST * munk), min(high, -turned + reach)
    if 0.0 < low <= high:
        new = min(max(munk, low), high)
        forward = (turned + new) / sway if new != -turned else 0.0
        across, crossed = PLANES[other - 1], float(masses[other] - masses[0])
        if forward:
            crossed = min(crossed, yawed) if forward < 0.0 else max(crossed, yawed)
        elif -across[4] * of.get(across[1], 0.0) > 0.0:
            crossed = -across[4] * of[across[1]]
        reshaped = masses.copy()
        reshaped[[side, other]] = surge + new, surge + crossed
        for shape in (reshaped, masses * new / munk):
            if np.all(shape > 0.0) and (found := ellipsoid_of_masses(shape, rho))[1] <= HELD:
                yield shape, found[0], forward, own
    if own or apart:
        yield masses, hull, 0.0, own


def _geom(
    masses: Array,
    axes: Array,
    forward: float,
    own: float,
    hull: Array,
    of: Mapping[str, float],
    parameters: ParameterFile,
    law: ForceLaw,
    *,
    lifts: bool = True,
) -> _Geom:
    """Coefficients for an ellipsoid in its place, without a Kutta lift where it is not to lift."""
    side_force, _, turning, side, sign = plane = _plane(of)
    rho, (a, b, c), across = parameters.conditions.density, axes, float(axes[side])
    drag, cross = max(0.0, -of.get("X0", 0.0)), max(0.0, -of.get(_drag_of(side_force), 0.0))
    blunt, slender = _drag(axes, side, drag / rho, cross / rho)
    sway = of.get(side_force, 0.0)
    slope = rho * np.pi * b * c * ((a / across) ** 2 - 1.0)
    lift = 0.0 if not lifts or not sway or np.isclose(a, across) else float((-sway - drag) / slope)
    arm = forward * (sway if lift else -drag)
    surge = float(masses[0])
    magnus = (sign * of.get(turning, -sign * surge) - arm + surge) / (rho * 4.0 / 3.0 * np.pi * a * b * c)
    still = _Geom(FluidEllipsoid(axes, blunt, slender, 0.0, lift, float(magnus), rho), forward, hull, plane, own=own)
    turn = next((t for t in ("Nr", "Mq", "Kp") if {t, _drag_of(t)} & set(of)), "")
    if not turn:
        return still
    rates = [max(abs(r.low), abs(r.high)) / 2.0 for r in parameters.offered if r.variable == f"{turn[1]}'"]
    rate = max(rates, default=0.0) or RATE
    i, states = MOTIONS.index(turn[1]), _states(turn[1], (rate,), parameters)
    most = replace(still, ellipsoid=replace(still.ellipsoid, angular=1.0))
    ours, none, one = (_odd(f(states)[:, i])[0] for f in (law.force, still.force, most.force))
    angular = max(0.0, float((ours - none) / (one - none)))
    return replace(still, ellipsoid=replace(still.ellipsoid, angular=angular), turn=turn, rate=rate)


def _states(motion: str, rates: tuple[float, ...], parameters: ParameterFile) -> Array:
    """(2 n, 6) velocities ahead with a motion to one side, then to the other; for u the speed itself, over half of the file's."""
    speed, i = parameters.conditions.speed, MOTIONS.index(motion)
    out = np.zeros((2 * len(rates), 6))
    out[:, 0] = speed
    if i == 0:
        out[:, 0] = np.tile(rates, 2) * 2.0 * speed
    else:
        unit = speed if i < 3 else speed / parameters.scaling.length
        out[:, i] = np.concatenate([rates, np.negative(rates)]) * unit
    return out


def _odd(values: Array) -> Array:
    """Half of the difference of the first half and the second."""
    first, second = np.split(values, 2)
    return np.asarray((first - second) / 2.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Damping:
    """Of one motion, at several rates: the part of a component that is odd in the motion; for u the component itself.

    Attributes
    ----------
    i : int
        Of the motion and its component.
    states : (2 n, 6) array
        Velocities.
    stated : (n,) array of bool
        Whether measured terms of the file speak of it.
    tabled : (n,) array of bool
        Whether fitted tables of the file do.
    ours, theirs : (n,) arrays
        Of the file and of the target, N or N m.
    scale : float
        What counts as rounding.
    """

    i: int
    states: Array
    stated: NDArray[np.bool_]
    tabled: NDArray[np.bool_]
    ours: Array
    theirs: Array
    scale: float

    @property
    def name(self) -> str:
        """``Nr``, ``Xu``."""
        return COMPONENTS[self.i] + MOTIONS[self.i]


def _dampings(geom: _Geom, law: ForceLaw, parameters: ParameterFile, rates: tuple[float, ...]) -> Iterator[_Damping]:
    """Of the six motions, yaw first and surge last."""
    measured = replace(law, ideal=np.zeros_like(law.ideal))
    for i in (5, 4, 3, 1, 2, 0):
        states = _states(MOTIONS[i], rates, parameters)
        tables = force_of_tables(parameters, states)
        tabled = np.zeros(states.shape) if tables is None else tables
        stated, by_table, ours, theirs = (
            (f[: len(rates), i] if i == 0 else _odd(f[:, i]))
            for f in (measured.force(states), tabled, law.force(states) + tabled, geom.force(states))
        )
        scale = ROUNDING * max(float(np.max(np.abs(ours))), float(np.max(np.abs(theirs))))
        yield _Damping(i, states, np.abs(stated) > scale, np.abs(by_table) > scale, ours, theirs, scale)


def _flipped(
    geom: _Geom, law: ForceLaw, parameters: ParameterFile, rates: tuple[float, ...], *, whole: bool = True
) -> str:
    """The first damping that has not the sign of the file's, or drives a motion of which the file says nothing; empty for none.

    The ideal fluid's products damp nothing by themselves: where they are all that the file has, the target only must not drive.
    Fitted tables are a loss of every simulator's: where a damping is in a table alone, the target may have none. Where ``whole``
    is false, it may have none of any.
    """
    for d in _dampings(geom, law, parameters, rates):
        ours, theirs, scale = d.ours, d.theirs, d.scale
        driven = theirs > np.maximum(ours, 0.0) + scale
        against = (np.abs(theirs) > scale) & (ours * theirs < 0.0)
        wrong = np.where(d.stated, ours * theirs <= 0.0 if whole else against | (driven & (ours <= scale)), driven)
        wrong |= d.tabled & against
        if np.any(wrong):
            return f"{d.name} does not keep its sign: {_both(d, int(np.argmax(wrong)), rates)}"
    return ""


def _both(d: _Damping, at: int, rates: tuple[float, ...]) -> str:
    """The file's damping and MuJoCo's at one of the rates, in words."""
    component, unit = COMPONENTS[d.i], "N" if d.i < 3 else "N m"
    at_rate = f"{MOTIONS[d.i]}' = {rates[at]:g}" if d.i else f"{d.states[at, 0]:.3g} m/s"
    return (
        f"at {at_rate} the file has {component} = {d.ours[at]:.4g} {unit}, MuJoCo's fluid ellipsoid "
        f"{d.theirs[at]:.4g} {unit}"
    )


def _undamped(geom: _Geom, law: ForceLaw, parameters: ParameterFile) -> Iterator[str]:
    """Each motion in which the file states a force and the target has none, in words."""
    for d in _dampings(geom, law, parameters, RATES):
        if np.any(d.stated) and np.all(np.abs(d.theirs) <= d.scale):
            yield f"{d.name}: {_both(d, int(np.argmax(d.stated)), RATES)}"


def _drag(axes: Array, side: int, ahead: float, across: float) -> tuple[float, float]:
    """Blunt and slender coefficients for drags per density ahead and along the axis ``side``; equal, the same drag whatever the
    course, where the latter is not known or both do not fit.
    """
    a, b, c = axes
    front, abeam, longest = np.pi * b * c, np.pi * a * b * c / axes[side], np.pi * np.prod(np.sort(axes)[1:])
    system = np.array([[front, longest - front], [abeam, longest - abeam]])
    if across and not np.isclose(front, abeam):
        blunt, slender = np.linalg.solve(system, [ahead, across])
        if blunt >= 0.0 and slender >= 0.0:
            return float(blunt), float(slender)
    same = ahead / float(longest)
    return same, same


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One model file; the body's frame is x forward, y port, z up, its origin the reference point.

    Raises
    ------
    InputError
        As `_fitted` says, or an inertia that is not positive.

    See Also
    --------
    left_out : What of the law is not in the file, for an ellipsoid would drive a motion with it.
    """
    geom, _ = _fitted(parameters)
    e, name = geom.ellipsoid, identifier(parameters.name)
    a, b, c = (float(x) for x in e.axes)
    root = Element("mujoco", model=name)
    SubElement(root, "option", density=number(e.density), viscosity="0", integrator="implicitfast")
    body = SubElement(SubElement(root, "worldbody"), "body", name=name, gravcomp="1")
    SubElement(body, "freejoint")
    if parameters.mass is not None or geom.reshaped:
        volume = 4.0 / 3.0 * np.pi * float(np.prod(geom.hull))
        mass = parameters.mass.mass if parameters.mass is not None else e.density * volume
        at, squares = centre_of_gravity(parameters) * FLU[:3], geom.hull**2
        solid = mass / 5.0 * np.diag(squares.sum() - squares)
        known = central_inertia(parameters)
        ((xx, xy, xz), (_, yy, yz), (_, _, zz)) = (
            solid if known is None else known * np.outer(FLU[:3], FLU[:3])
        ).tolist()
        moments = _row(xx, yy, zz, xy, xz, yz)
        SubElement(body, "inertial", pos=_row(*at.tolist()), mass=number(mass), fullinertia=moments)
    SubElement(
        body, "geom", name="fluid", type="ellipsoid", size=_row(a, b, c), pos=_row(geom.forward, 0.0, 0.0), density=number(e.density),
        contype="0", conaffinity="0", fluidshape="ellipsoid", fluidcoef=_row(e.blunt, e.slender, e.angular, e.kutta, e.magnus),
    )  # fmt: skip
    comment = (
        f"{one_line(parameters.name)}, body: {one_line(parameters.body)}",
        f"Shape by the inertia of the water: {one_line(water_inertia(parameters).source)}",
        *in_header(parameters),
        "Body frame: x forward, y port, z up, origin at the reference point. Weight is balanced (gravcomp), nothing rights it.",
        *(f"Left out: {one_line(what)}" for what in geom.left_out),
    )
    return {f"{name}.xml": serialised(root, comment)}


def _row(*values: float) -> str:
    return " ".join(number(v) for v in values)


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """MuJoCo's own law (`coeflab.formats.mujoco.law`, with its source) of the geom in the file, turned to FRD."""
    (content,) = files.values()
    root = parse_xml(content.decode())
    option, geom = root.find("option"), root.find("worldbody/body/geom")
    if option is None or geom is None:
        raise InputError("no geom", "a body with a fluid ellipsoid")
    size = np.array(numbers(geom.get("size"), (3,), "size"))
    at = numbers(geom.get("pos"), (3,), "pos")
    blunt, slender, angular, kutta, magnus = numbers(geom.get("fluidcoef"), (5,), "fluidcoef")
    density, viscosity = float(option.get("density", "0")), float(option.get("viscosity", "0"))
    fluid = FluidEllipsoid(size, blunt, slender, angular, kutta, magnus, density, viscosity)
    return _Geom(fluid, at[0], size).force(nu)


def added_mass(files: Mapping[str, bytes]) -> Array:  # noqa: ARG001 - the port's signature
    """Zero: MuJoCo has no force in proportion to acceleration."""
    return np.zeros((6, 6))


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """Added inertia; every term whose derivative at straight motion is not the target's; products; controls."""
    geom, law = _fitted(parameters)
    held = held_when_straight(geom.force, law, parameters.conditions.speed)
    return (_LEFT_OUT, *unheld(law, held, ideal=False))


def left_out(parameters: ParameterFile) -> tuple[InputError, tuple[str, ...]] | None:
    """Dampings of which no ellipsoid has the sign of the file's, for it has one lift, one drag and no linear damping of turning.

    Parameters
    ----------
    parameters : ParameterFile
    """
    geom, _ = _fitted(parameters)
    if not geom.refused:
        return None
    why = input_error("formats.damping_of_two_signs", column="coefficients", refused=geom.refused)
    return why, geom.left_out


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass and moments of inertia, where the file has none."""
    return missing_mass(
        parameters, "those of the ellipsoid, solid and as heavy as the file says or water, stand until you write yours"
    )


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the ellipsoid was made, in words."""
    geom, _ = _fitted(parameters)
    source = water_inertia(parameters).source
    e, (side_force, moment, turning, _, _) = geom.ellipsoid, geom.plane
    a, b, c = e.axes
    words = [
        f"the hull is an ellipsoid of semi-axes {a:.4g} {b:.4g} {c:.4g} m, whose added masses along x, y and z are those of the file "
        f"({source}); MuJoCo adds its Munk moment"
        if not geom.reshaped
        else f"the fluid's ellipsoid has semi-axes {a:.4g} {b:.4g} {c:.4g} m: its Munk moment, and with it {moment}, is chosen so that no turn "
        f"is driven. That of the file's added masses ({source}), {' '.join(f'{x:.4g}' for x in geom.hull)} m, would need its centre at "
        f"{geom.own:+.4g} m for {moment}, and its Munk moment would drive the turn there or {moment} would be lost",
        f"its centre lies {geom.forward:+.4g} m along x from the reference point"
        + ("" if geom.left_out else f", where {side_force} and the Munk moment make up the total {moment}"),
        f"fluidcoef: blunt and slender drag {e.blunt:.4g} {e.slender:.4g} from X0 and {_drag_of(side_force)}, "
        f"{f'Kutta lift {e.kutta:.4g} from {side_force}' if e.kutta else 'no Kutta lift'}, Magnus lift {e.magnus:.4g} from {turning}; terms alike on a straight course, such as {side_force} and "
        f"{side_force[0]}u{side_force[1]}, count as one",
        f"angular drag {e.angular:.4g}: quadratic in the rate, "
        + (
            f"it meets the file's damping {geom.turn} at {geom.turn[1]} L/U = {geom.rate:.3g} and the file's speed"
            if geom.turn
            else "none, for the file has no damping of a turn"
        ),
        f"{'no damping has another sign than' if geom.refused else 'each damping has the sign of'} the file's at v/U, r L/U and so on "
        f"of {', '.join(f'{r:g}' for r in RATES)}",
        "derivatives are met at straight motion; in drift and turning its lift and drag bend away, by the differences in this report",
        "axes: FRD to the body frame x forward, y port, z up",
        "weight is balanced by gravcomp and nothing rights the body: "
        + states_buoyancy(parameters, "the file states no buoyancy"),
    ]
    if not geom.reshaped and geom.own != geom.forward:
        words.append(
            f"{moment} would need the centre at {geom.own:+.4g} m: it stays at the reference point, and {moment} is the Munk moment alone"
        )
    return tuple(words)
