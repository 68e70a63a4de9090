"""A glider in the vertical plane: masses, polar, sliding mass, buoyancy engine and what is ordered, with the basis of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated, Literal

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.toml import toml_text
from coeflab.core.types import Array, brief
from coeflab.glider.masses import MassModel
from coeflab.glider.motion import GliderBody, Setting
from coeflab.glider.space import Force, Lateral, SpaceBody, Thrusters
from coeflab.glider.steady_glide import Polar
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until

AngleUnit = Literal["deg", "rad"]
LONGEST = 1e7
TWO_ANGLES = 'two angles of attack, such as ["-8 deg", "8 deg"], within 90 deg'
UNIT_OF_ANGLE = replace(
    takes.one_of("deg", "rad"),
    words='"deg" or "rad"',
    absent="K_L and K_M per degree are 57.3 times smaller than per radian, K_D 3283 times. Coefficients without their "
    "unit cannot be used; `coeflab fit` with glide_polar finds it from the forces.",
)
UPWARD_OR_AFT = takes.Within(
    lambda v: "" if v > 0.0 else "a value above zero: lift is upward, drag aft", schema={"exclusiveMinimum": 0}
)
WITHIN_RIGHT_ANGLES = takes.Within(lambda v: "" if -math.pi / 2 < v[0] < v[1] < math.pi / 2 else TWO_ANGLES)
NOT_FOR_EVER = takes.Within(lambda v: f"at most {LONGEST:g} s" if v > LONGEST else "")
WIDE = (-np.pi / 6, np.pi / 6)
MUNK = (
    1.5  # (m3 - m1) / m1: a slender hull has at most 1 (Lamb 1932, article 114), the shipped Slocum with its wings 1.44
)


def _require_order(low: float, high: float, unit: str) -> None:
    if low > high:
        raise InputError(f"{low:g} {unit}", f"no more than high, {high:g} {unit}", column="low")


@dataclass(frozen=True, slots=True)
class GliderMass(takes.Declaration):
    """Mass of the vehicle without the sliding mass, about the reference point.

    Attributes
    ----------
    surge, heave : float
        m1 and m3, mass plus added mass along x and z, kg.
    pitch_inertia : float
        J, inertia plus added inertia, kg m^2.
    moment_ahead, moment_below : float
        Sums of m g x and m g z at neutral buoyancy, N m.
    """

    surge: Annotated[takes.Mass, takes.ABOVE_ZERO]
    heave: Annotated[takes.Mass, takes.ABOVE_ZERO]
    pitch_inertia: Annotated[takes.Inertia, takes.ABOVE_ZERO]
    moment_ahead: takes.Moment
    moment_below: takes.Moment


@dataclass(frozen=True, slots=True)
class SlidingMass(takes.Declaration):
    """A mass that slides along x.

    Attributes
    ----------
    mass : float
        kg; zero where there is none.
    below : float
        Its z, m.
    low, high : float
        Ends of its travel, m.
    rate : float
        m/s.
    """

    mass: Annotated[takes.Mass, takes.ZERO_OR_MORE]
    below: takes.Length
    low: takes.Length
    high: takes.Length
    rate: Annotated[takes.Speed, takes.ABOVE_ZERO]

    def check(self) -> None:
        """A travel from low to high."""
        _require_order(self.low, self.high, "m")


@dataclass(frozen=True, slots=True)
class BuoyancyEngine(takes.Declaration):
    """What makes the vehicle heavy or light.

    Attributes
    ----------
    ahead : float
        x at which the net weight acts, m.
    low, high : float
        Net mass that it reaches, kg; above zero is heavy.
    rate : float
        kg/s.
    """

    ahead: takes.Length = 0.0
    low: takes.Mass = field(kw_only=True)
    high: takes.Mass = field(kw_only=True)
    rate: Annotated[takes.MassRate, takes.ABOVE_ZERO] = field(kw_only=True)

    def check(self) -> None:
        """A net mass from low to high."""
        _require_order(self.low, self.high, "kg")


@brief
@dataclass(frozen=True, slots=True)
class StatedPolar(takes.Declaration):
    """L = (K_L0 + K_L a) V^2, D = (K_D0 + K_D a^2) V^2, M = (K_M0 + K_M a) V^2 - damping V q.

    Attributes
    ----------
    angle_unit : {"deg", "rad"}
        Of a in these coefficients: in the other unit they are another vehicle's, so it is never guessed.
    K_L0, K_L, K_D0, K_D, K_M0, K_M : float
        N/(m/s)^2 and N m/(m/s)^2, per unit of angle.
    pitch_damping : float
        N m/(m/s rad/s); above zero damps.
    contains_munk : bool
        Whether M holds the Munk moment (m3 - m1) v1 v3, as one from CFD or a tank does.
    covered : (float, float) or None
        Angles of attack that the data cover, rad.
    """

    angle_unit: Annotated[AngleUnit, UNIT_OF_ANGLE]
    K_L0: takes.Pure
    K_L: Annotated[takes.Pure, UPWARD_OR_AFT]
    K_D0: Annotated[takes.Pure, UPWARD_OR_AFT]
    K_D: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    K_M0: takes.Pure
    K_M: takes.Pure
    pitch_damping: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    contains_munk: takes.Flag
    covered: Annotated[tuple[float, float], takes.numbers(2, "angle", TWO_ANGLES), WITHIN_RIGHT_ANGLES] | None = None

    @property
    def per_radian(self) -> Polar:
        """The same law over angles in radians."""
        k = 1.0 if self.angle_unit == "rad" else float(np.degrees(1.0))
        return Polar(
            (self.K_L0, self.K_L * k), (self.K_D0, self.K_D * k * k), (self.K_M0, self.K_M * k), self.pitch_damping
        )

    @property
    def searched(self) -> tuple[float, float]:
        """Angles of attack among which steady glides are looked for, rad."""
        return self.covered or WIDE


@dataclass(frozen=True, slots=True)
class GliderPhase(takes.Declaration):
    """Orders that stand for a time, or until a depth is met.

    Attributes
    ----------
    name : str
        Of the phase.
    net_mass, position : float
        Ordered net mass, kg, and position of the sliding mass, m.
    lasts : float
        s, the longest where ``until_depth`` is given.
    until_depth : float or None
        m; met on the way down where the glider is heavy, on the way up where it is light.
    roller : float
        Ordered angle of the roller, rad, above zero to starboard.
    thrust_right, thrust_left : float
        Ordered thrusts, N.
    """

    name: takes.Text
    net_mass: takes.Mass
    position: takes.Length = 0.0
    roller: takes.Angle = field(default=0.0, kw_only=True)
    thrust_right: Force = field(default=0.0, kw_only=True)
    thrust_left: Force = field(default=0.0, kw_only=True)
    lasts: Annotated[takes.Time, takes.ABOVE_ZERO, NOT_FOR_EVER] = field(kw_only=True)
    until_depth: takes.Length | None = field(default=None, kw_only=True)

    @property
    def setting(self) -> Setting:
        """All that is ordered."""
        return Setting(self.net_mass, self.position, self.roller, self.thrust_right, self.thrust_left)

    @property
    def turns(self) -> bool:
        """Whether roller or thrusters take it out of a straight glide."""
        return any(self.setting[2:])

    @property
    def ordered(self) -> Phase:
        """The same as a phase of a manoeuvre; a heavy glider meets its depth from above, a light one from below."""
        until = None if self.until_depth is None else Until("depth", self.net_mass > 0.0, self.until_depth)
        return Phase(self.name, self.setting._asdict(), self.lasts, until)


@brief
@dataclass(frozen=True, slots=True)
class Glider:
    """A glider and a cycle of it.

    Attributes
    ----------
    name, title, citation : str
    gravity : float
        m/s^2.
    mass : GliderMass
    sliding_mass : SlidingMass
    engine : BuoyancyEngine
    polar : StatedPolar
    phases : tuple of GliderPhase
        One cycle.
    masses, lateral, thrusters : MassModel, Lateral and Thrusters, or None
        What a motion in space needs; without one of them the glider stays in the vertical plane.
    basis : tuple of (str, str)
        Where a table or key of the file comes from: ``printed ...``, ``derived ...``, ``calibrated ...``, ``assumed ...``.
    """

    name: str
    title: str
    citation: str
    gravity: float
    mass: GliderMass
    sliding_mass: SlidingMass
    engine: BuoyancyEngine
    polar: StatedPolar
    phases: tuple[GliderPhase, ...]
    basis: tuple[tuple[str, str], ...] = ()
    masses: MassModel | None = None
    lateral: Lateral | None = None
    thrusters: Thrusters | None = None

    @property
    def body(self) -> GliderBody:
        """What the equations of motion need."""
        return GliderBody(
            polar=self.polar.per_radian,
            surge=self.mass.surge,
            heave=self.mass.heave,
            inertia=self.mass.pitch_inertia,
            sliding=self.sliding_mass.mass,
            sliding_below=self.sliding_mass.below,
            ahead=self.mass.moment_ahead,
            below=self.mass.moment_below,
            engine_ahead=self.engine.ahead,
            gravity=self.gravity,
            holds_munk=self.polar.contains_munk,
        )

    @property
    def findings(self) -> tuple[Finding, ...]:
        """That m3 - m1, which turns the glider across the stream, is of no hull with wings."""
        difference = self.mass.heave - self.mass.surge
        share = difference / self.mass.surge
        if 0.0 < share <= MUNK:
            return ()
        return (
            Finding.of(
                "glider.munk", self.name, Severity.WARN, statistic=share, threshold=MUNK, advice="mass.heave, mass.surge",
                difference=difference, way="more" if share > MUNK else "less",
            ),
        )  # fmt: skip

    @property
    def space(self) -> SpaceBody | None:
        """What the equations of motion in space need; None where the file holds the vertical plane alone."""
        if self.masses is None or self.lateral is None or self.thrusters is None:
            return None
        return SpaceBody(self.body, self.masses, self.lateral, self.thrusters)

    @property
    def rest_place(self) -> Array | None:
        """(3,) m, of all masses but pistons and roller, from the moments of [mass]; None without [masses]."""
        if self.masses is None:
            return None
        ahead, below = self.body.moments(0.0, 0.0)
        return self.masses.rest_place(ahead / self.gravity, below / self.gravity)

    def rolled(self, angle: float) -> Glider:
        """The same with the roller at an angle, rad, in every phase.

        Raises
        ------
        InputError
            The file holds the vertical plane alone.
        """
        if self.space is None:
            raise InputError(f"{self.name} without a roller", "[masses], [lateral] and [thrusters]", column="roller")
        return replace(self, phases=tuple(replace(p, roller=angle) for p in self.phases))

    def manoeuvre(self, cycles: int) -> Manoeuvre:
        """The phases, flown several times, from rest, level, at the surface, neutral."""
        phases = tuple(p.ordered for p in self.phases) * cycles
        return Manoeuvre(f"{self.name}, {cycles} cycle{'s' if cycles > 1 else ''}", phases, np.zeros(6))

    def file(self) -> bytes:
        """The glider file, in SI; reading it gives an equal glider."""
        m, s, e, p = self.mass, self.sliding_mass, self.engine, self.polar
        covered = None if p.covered is None else [f"{angle!r} rad" for angle in p.covered]
        content = {
            "glider": {"name": self.name, "title": self.title, "citation": self.citation, "gravity": self.gravity},
            "mass": {name: getattr(m, name) for name in GliderMass.__slots__},
            "sliding_mass": {name: getattr(s, name) for name in SlidingMass.__slots__},
            "engine": {name: getattr(e, name) for name in BuoyancyEngine.__slots__},
            "polar": {name: getattr(p, name) for name in StatedPolar.__slots__} | {"covered": covered},
            **{n: {k: _stored(getattr(part, k)) for k in part.__slots__} for n, part in self._in_space().items()},
            "basis": dict(self.basis),
            "phase": [
                {name: getattr(p, name) for name in GliderPhase.__slots__} | {"roller": f"{p.roller!r} rad"}
                for p in self.phases
            ],
        }
        return toml_text(content).encode()

    def _in_space(self) -> dict[str, MassModel | Lateral | Thrusters]:
        parts = {"masses": self.masses, "lateral": self.lateral, "thrusters": self.thrusters}
        return {name: part for name, part in parts.items() if part is not None}


def _stored(value: float | tuple[float, ...]) -> float | list[float]:
    return list(value) if isinstance(value, tuple) else value
