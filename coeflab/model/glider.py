"""A glider in the vertical plane: masses, polar, sliding mass, buoyancy engine and what is ordered, with the basis of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from coeflab.core.toml_text import toml_text
from coeflab.kernels.brief import brief
from coeflab.kernels.glider_motion import GliderBody, Setting
from coeflab.kernels.steady_glide import Polar
from coeflab.model.manoeuvre import Manoeuvre, Phase, Until

AngleUnit = Literal["deg", "rad"]
SYMBOLS = ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M")
WIDE = (-np.pi / 6, np.pi / 6)


@dataclass(frozen=True, slots=True)
class GliderMass:
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

    surge: float
    heave: float
    pitch_inertia: float
    moment_ahead: float
    moment_below: float


@dataclass(frozen=True, slots=True)
class SlidingMass:
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

    mass: float
    below: float
    low: float
    high: float
    rate: float


@dataclass(frozen=True, slots=True)
class BuoyancyEngine:
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

    ahead: float
    low: float
    high: float
    rate: float


@brief
@dataclass(frozen=True, slots=True)
class StatedPolar:
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

    angle_unit: AngleUnit
    K_L0: float
    K_L: float
    K_D0: float
    K_D: float
    K_M0: float
    K_M: float
    pitch_damping: float
    contains_munk: bool
    covered: tuple[float, float] | None = None

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
class GliderPhase:
    """Orders that stand for a time, or until a depth is met.

    Attributes
    ----------
    name : str
    net_mass, position : float
        Ordered net mass, kg, and position of the sliding mass, m.
    lasts : float
        s, the longest where ``until_depth`` is given.
    until_depth : float or None
        m; met on the way down where the glider is heavy, on the way up where it is light.
    """

    name: str
    net_mass: float
    position: float
    lasts: float
    until_depth: float | None = None

    @property
    def setting(self) -> Setting:
        """Net mass and position."""
        return Setting(self.net_mass, self.position)

    @property
    def ordered(self) -> Phase:
        """The same as a phase of a manoeuvre; a heavy glider meets its depth from above, a light one from below."""
        until = None if self.until_depth is None else Until("depth", self.net_mass > 0.0, self.until_depth)
        return Phase(self.name, {"net_mass": self.net_mass, "position": self.position}, self.lasts, until)


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

    def manoeuvre(self, cycles: int) -> Manoeuvre:
        """The phases, flown several times, from rest, level, at the surface, neutral."""
        phases = tuple(p.ordered for p in self.phases) * cycles
        return Manoeuvre(f"{self.name}, {cycles} cycle{'s' if cycles > 1 else ''}", phases, np.zeros(6))

    def file(self) -> bytes:
        """The glider file, in SI; reading it gives an equal glider."""
        m, s, e, p = self.mass, self.sliding_mass, self.engine, self.polar
        content = {
            "glider": {"name": self.name, "title": self.title, "citation": self.citation, "gravity": self.gravity},
            "mass": {name: getattr(m, name) for name in GliderMass.__slots__},
            "sliding_mass": {name: getattr(s, name) for name in SlidingMass.__slots__},
            "engine": {name: getattr(e, name) for name in BuoyancyEngine.__slots__},
            "polar": {name: getattr(p, name) for name in StatedPolar.__slots__},
            "basis": dict(self.basis),
            "phase": [{name: getattr(p, name) for name in GliderPhase.__slots__} for p in self.phases],
        }
        return toml_text(content).encode()
