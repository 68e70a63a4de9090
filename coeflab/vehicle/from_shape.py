"""A vehicle from its shape and its mass: what is stated, what is assumed, and the estimates as one fit among others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mass_model import at_rest, rest_words
from coeflab.bodies.shape import Parts, Revolution
from coeflab.bodies.volume_moments import parts_spread
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array, dataclass, locked
from coeflab.core.wording import listed
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.rigid_body import MassProperties, about_another, inertia_doubt
from coeflab.law.symbols import CONTROLS
from coeflab.vehicle import parameter_parts

if TYPE_CHECKING:
    from coeflab.bodies.body import Body, Configuration
    from coeflab.bodies.pieces import Control
    from coeflab.bodies.thrusters import Thruster
    from coeflab.estimates import Estimates
    from coeflab.law.scaling import Conditions
    from coeflab.vehicle.parameter_file import ParameterFile

CLOSED = "A vehicle needs a closed hull; coeflab added-mass takes sheets alone."
ESTIMATES = "estimates"  # what fit and campaign are called
FAR = 0.5  # of the length: a centre of gravity beyond the ends of the hull is another unit or another axis
ABSURD = 3.0  # of the displacement, either way: no unit and no water in the hull makes that a vehicle
TRIMMED = 0.005  # of the displacement: less is what a scale reads


@dataclass(frozen=True, slots=True, eq=False)
class Stated:
    """What is said of a vehicle beside its shape; None where nothing is.

    Attributes
    ----------
    mass : float or None
        kg.
    centre : (3,) array or None
        Of gravity, m, FRD, from the body's datum.
    inertia : (3, 3) array or None
        About the centre of gravity, kg m^2.
    unstated : tuple of str
        Of the conditions, density and speed: which are assumed.
    """

    mass: float | None = None
    centre: NDArray[np.float64] | None = None
    inertia: NDArray[np.float64] | None = None
    unstated: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("centre", "inertia"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))


@dataclass(frozen=True, slots=True, eq=False)
class Weighed:
    """A body with its mass in water.

    Attributes
    ----------
    body : Body
        With a configuration of its own name, which has volume, centre of buoyancy and mass.
    statements : tuple of str
        Mass against displacement first, then what is assumed, one line each.
    assumed : tuple of str
        Which of ``mass``, ``centre`` and ``inertia`` nobody stated.
    at_rest : tuple of float or None
        Pitch and roll at rest, rad; None where it does not stay at rest, or nobody stated the centre of gravity.
    """

    body: Body
    statements: tuple[str, ...]
    assumed: tuple[str, ...]
    at_rest: tuple[float, float] | None = None

    @property
    def configuration(self) -> Configuration:
        """The one with the mass."""
        return self.body.require(self.body.name)


def weighed(body: Body, stated: Stated, density: float) -> Weighed:
    """The body with mass, centre of gravity and inertia: those stated, else its file's, else assumed and said.

    Parameters
    ----------
    body : Body
    stated : Stated
    density : float
        Of the water, kg/m^3.

    Raises
    ------
    InputError
        No volume, an inertia that no body has, or a mass beyond a factor of 3 of the displacement without flooded room or ballast.
    """
    base = _floating(body)
    if not base.volume or base.centre_of_buoyancy is None:
        raise InputError(f"{body.name} without a volume", "a body that displaces water", advice=CLOSED)
    own = next((c.mass for c in reversed(body.configurations) if c.mass is not None), None)
    displaced, assumed, words = density * base.volume, [], []
    mass = stated.mass if stated.mass is not None else own.mass if own is not None else None
    if mass is None:
        mass = displaced
        assumed.append("mass")
        words.append(f"assumed: as heavy as the water that it displaces, {displaced:.4g} kg; no mass is stated")
    else:
        _refuse_absurd(body, mass, displaced, density)
        words.append(_buoyed(mass, displaced, density) + _to_neutral(body, mass / displaced, stated))
        if stated.mass is not None and body.mass_model is not None:
            words.append(text_of("vehicle.stated_mass", stated=stated.mass, built=body.mass_model.mass))
        words += _of_other_water(body, density) if stated.mass is None else []
    buoyancy = base.centre_of_buoyancy - body.reference_point
    centre = None if stated.centre is None else stated.centre - body.reference_point
    if centre is None and own is not None and (own.centre is not None or own.mass_moment):
        centre = own.centre_of_gravity
    if centre is None:
        centre = buoyancy
        assumed.append("centre")
        words.append("assumed: centre of gravity at the centre of buoyancy, so no righting moment; none is stated")
        rest = None
    else:
        _refuse_far(body, centre - buoyancy, "--cg" if stated.centre is not None else "centre_of_gravity")
        rest = at_rest(mass / displaced - 1.0, centre - buoyancy)
        words.append(rest_words(rest, centre - buoyancy))
    turning = stated.inertia
    if turning is None and own is not None and own.inertia_matrix is not None:
        turning = about_another(own.inertia_matrix, own.mass, own.centre_of_gravity, np.zeros(3))
    if turning is None:
        water = spread_of(body, base)
        turning = mass / displaced * density * (np.trace(water) * np.eye(3) - water)
        assumed.append("inertia")
        words.append("assumed: inertia of the displaced water, scaled to the mass; none is stated")
    elif why := inertia_doubt(mass, np.zeros(3), turning):
        raise InputError(why, "moments of inertia of a body about its centre of gravity", column="--inertia")
    about = about_another(turning, mass, np.zeros(3), centre)
    transverse = float(about[1, 1]) if np.isclose(about[1, 1], about[2, 2], rtol=1e-9) else None
    result = MassProperties(mass, mass * float(centre[0]), transverse, centre, about)
    vehicle = replace(base, name=body.name, title=body.title, mass=result)
    others = tuple(c for c in body.configurations if c.name != body.name)
    return Weighed(replace(body, configurations=(*others, vehicle)), tuple(words), tuple(assumed), rest)


def displaced_mass(body: Body, density: float) -> float:
    """Of the water that a body displaces, kg.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.

    Raises
    ------
    InputError
        No volume.
    """
    return density * float(_floating(body).volume or 0.0)


def floods(body: Body) -> bool:
    """Whether its file declares flooded rooms or ballast, so that mass and displacement may differ."""
    parts = body.mass_model.parts if body.mass_model is not None else ()
    return any(p.flooded or "ballast" in p.material for p in parts)


def _refuse_absurd(body: Body, mass: float, displaced: float, density: float) -> None:
    if displaced / ABSURD <= mass <= ABSURD * displaced or floods(body):
        return
    raise InputError(
        f"a mass of {mass:.4g} kg in {displaced:.4g} kg of displacement, {displaced / density:.4g} m^3 of {density:.4g} kg/m^3",
        f"{displaced / ABSURD:.3g} to {ABSURD * displaced:.3g} kg",
        column="--mass",
        advice="Look at the units of mass, mesh and density. A hull that floods: [[mass]] with flooded = true in its body.toml.",
    )


def _refuse_far(body: Body, lever: np.ndarray, column: str) -> None:
    """A centre of gravity further from the centre of buoyancy than half the body's length: millimetres, x aft, or another origin."""
    shape = body.require_shape()
    size, apart = FAR * max(shape.length, shape.volume ** (1.0 / 3.0)), float(np.linalg.norm(lever))
    if apart > size:
        raise input_error("vehicle.centre_of_gravity_far_off", column=column, apart=apart, size=size, datum=body.datum)


def _floating(body: Body) -> Configuration:
    """What the body displaces: of a printed configuration where it has mass and volume, with what only the shape tells."""
    first = next((c for c in body.configurations if c.volume), None)
    if first is None:
        raise InputError(f"{body.name} without a volume", "a body that displaces water", advice=CLOSED)
    own = next((c for c in reversed(body.configurations) if c.mass is not None and c.volume), None)
    if own is None or own is first:
        return first
    middle = own.centre_of_buoyancy if own.centre_of_buoyancy is not None else first.centre_of_buoyancy
    return replace(
        first, volume=own.volume, centre_of_buoyancy=middle, wetted_surface=own.wetted_surface or first.wetted_surface
    )


def _buoyed(mass: float, displaced: float, density: float) -> str:
    over = mass - displaced
    words = f"mass {mass:.4g} kg; the shape displaces {displaced:.4g} kg of water of {density:.5g} kg/m^3: "
    if abs(over) <= TRIMMED * displaced:
        return words + "neutrally buoyant within 0.5 %"
    if over > 0.0:
        return words + f"{over:.3g} kg too heavy ({100.0 * over / displaced:.1f} %), it sinks"
    return words + f"{-over:.3g} kg of ballast to neutral ({-100.0 * over / displaced:.1f} %), it rises"


def _to_neutral(body: Body, share: float, stated: Stated) -> str:
    """What makes a light vehicle neutral; empty of one that is not light, or whose file states its masses."""
    if share >= 1.0 - TRIMMED or body.mass_model is not None:
        return ""
    neutral = ", and without a stated mass it is neutral" * (
        stated.mass is not None and all(c.mass is None for c in body.configurations)
    )
    return f"; [[mass]] with ballast = true, or flooded = true, in its body.toml makes up for it{neutral}"


def _of_other_water(body: Body, density: float) -> list[str]:
    """That ballast and flooded rooms of the mass model are for other water, where that is so."""
    model = body.mass_model
    if model is None or not floods(body) or abs(model.density / density - 1.0) <= TRIMMED:
        return []
    how = "assumed, as its file has no [water] density" if model.assumed else "the [water] density of its file"
    return [
        f"ballast and flooded rooms are for water of {model.density:g} kg/m^3, {how}; the vehicle is in {density:g}"
    ]


def spread_of(body: Body, configuration: Configuration) -> Array:
    """(3, 3) integral of d d^T over the displaced volume about its centre, m^5."""
    if configuration.second_moments is not None:
        return np.array(configuration.second_moments)
    shape = body.require_shape()
    if isinstance(shape, Revolution):
        area = np.pi * shape.radius**2 * shape.weight
        along = float(area @ (shape.x - shape.centre_of_volume[0]) ** 2)
        across = float(area @ shape.radius**2) / 4.0
        return np.diag([along, across, across])
    if isinstance(shape, Parts):
        return parts_spread(shape)
    return np.array(shape.integrals.second_moments)


def as_fit(estimates: Estimates, body: str) -> FitResult:
    """The estimates as one fit of a campaign called ``estimates``, so that all that takes fits takes them.

    Parameters
    ----------
    estimates : Estimates
    body : str
        Name of the body.
    """
    found = estimates.coefficients
    mine = replace(
        found, coefficients=tuple(replace(c, body=body, campaign=ESTIMATES) for c in found.coefficients), body=body
    )
    works = dict.fromkeys(k for c in estimates.contributions for k in c.citation.split(", ") if k)
    methods = ", ".join(dict.fromkeys(c.method for c in estimates.contributions))
    return FitResult(ESTIMATES, ESTIMATES, body, mine, (), tuple(works), {"methods": methods} if methods else {})


def equipped(parameters: ParameterFile, body: Body, configuration: Configuration) -> ParameterFile:
    """The file with buoyancy, thrusters and control surfaces of the body.

    Parameters
    ----------
    parameters : ParameterFile
    body : Body
    configuration : Configuration
        With volume and centre of buoyancy.
    """
    point = np.array(parameters.reference_point.point)
    update: dict[str, object] = {
        "thrusters": tuple(parameter_thruster(t, point, parameters.conditions) for t in body.thrusters),
        "surfaces": _surfaces(body.controls),
    }
    if configuration.volume and configuration.centre_of_buoyancy is not None:
        middle = tuple(float(v) for v in configuration.centre_of_buoyancy - point)
        update["hydrostatics"] = parameter_parts.ParameterHydrostatics(
            volume=configuration.volume, centre_of_buoyancy=middle
        )
    return parameters.model_copy(update=update)


def parameter_thruster(t: Thruster, point: Array, at: Conditions) -> parameter_parts.ParameterThruster:
    """A thruster of a body about a point of its datum; straight lines between its points, or squares of the command."""
    curve = parameter_parts.curve_of(t.squares, t.command, t.unit) or _lines(t, t.thrusts(at.speed, at.density))
    torques = t.torques(at.speed, at.density)
    torque = parameter_parts.curve_of(t.torque, t.command, t.unit) if torques is None else _lines(t, torques)
    place, axis = (tuple(float(v) for v in a) for a in (t.place - point, t.axis))
    tilting = None if t.tilt_axis is None else tuple(float(v) for v in t.tilt_axis)
    low, high = t.tilt if tilting is not None else (0.0, 0.0)
    return parameter_parts.ParameterThruster(
        name=t.name, position=place, direction=axis, curve=curve, torque_curve=torque,
        handedness=t.handedness, tilt_axis=tilting, tilt_low=low, tilt_high=high, lag=t.lag,
    )  # fmt: skip


def _lines(t: Thruster, points: Array) -> parameter_parts.ParameterCurve:
    """Straight lines between points of commands and values."""
    segments = []
    for (low, start), (high, end) in pairwise(points):
        slope = (end - start) / (high - low)
        segments.append(
            parameter_parts.CurveSegment(low=low, high=high, coefficients=(float(start - slope * low), float(slope)))
        )
    return parameter_parts.ParameterCurve(command=t.command, unit=t.unit, segments=tuple(segments))


def by_series(body: Body, speed: float) -> tuple[str, ...]:
    """Whose thrust the open-water series gives, one line each.

    Parameters
    ----------
    body : Body
    speed : float
        m/s.
    """
    return tuple(
        f"thrust of {t.name}: {_water_of(t)} at {speed:g} m/s; no wake, no thrust deduction; slower it thrusts more"
        for t in body.thrusters
        if t.curve is None and not t.squares
    )


def _water_of(t: Thruster) -> str:
    own = t.screw is not None and t.screw.measured is not None
    return "its own open water" if own else "estimate, Wageningen B-series"


def _surfaces(controls: Sequence[Control]) -> tuple[parameter_parts.ParameterSurface, ...]:
    """Limits of the angles that the law knows: of several hinges of one angle the narrowest."""
    out = []
    for name in CONTROLS:
        limits = [c.limit for c in controls if c.name == name and c.limit is not None]
        rates = [c.rate for c in controls if c.name == name and c.rate is not None]
        if limits:
            out.append(parameter_parts.ParameterSurface(control=name, limit=min(limits), rate=min(rates, default=None)))
    return tuple(out)


def lacking(body: Body, parameters: ParameterFile, assumed: Sequence[str], turns: bool) -> tuple[str, ...]:
    """What is missing for a manoeuvre under way, one line each with what to write.

    Parameters
    ----------
    body : Body
    parameters : ParameterFile
    assumed : sequence of str
        Of `Weighed`.
    turns : bool
        Whether something turns it, be it thrusters.
    """
    out = []
    steered = {c.symbol.removesuffix("'")[1:] for c in parameters.coefficients if c.value is not None}
    named = {c.name for c in body.controls}
    if "dr" not in named and not turns:
        out.append(
            'no rudder: write [[control]] with name = "dr", parts, hinge, axis, limit and rate into its body.toml; none is invented'
        )
    elif "dr" in named and "dr" not in steered:
        out.append("no effect of dr: none of its parts is a foil that an estimate knows")
    if "dr" in named and not any(c.limit for c in body.controls if c.name == "dr"):
        out.append("no limit and rate of dr: write both into its [[control]]; until then 15 deg are ordered, at once")
    if strange := sorted(named - set(CONTROLS)):
        out.append(
            f"{listed([shown(n) for n in strange])}: no angle that a manoeuvre orders; those are {', '.join(CONTROLS)}"
        )
    if not body.thrusters:
        out.append(
            "no thruster: write [[thruster]] with name, place, axis and curve; a run ahead takes the thrust it needs"
        )
    seen = body.outline
    if seen is not None and seen.hulls and seen.bluff:
        parts = listed([b.name for b in seen.bluff])
        out.append(f"drag without lift: {parts}, taken as bluff; `coeflab draw` shows what the estimates see")
    if seen is not None:
        out += [f"not in the estimates: {line}" for line in seen.left_out]
    options = {"mass": "--mass", "centre": "--cg", "inertia": "--inertia"}
    if assumed:
        rights = "; without --cg nothing rights it" if "centre" in assumed else ""
        out.append(f"not stated: {', '.join(options[a] for a in assumed)}{rights}")
    return tuple(out)
