"""A glider in the vertical plane: masses, polar, sliding mass, buoyancy engine and what is ordered, with the basis of each.

Reading a glider file: TOML with units, one clear error with file and key.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import Section, read_toml, toml_text
from coeflab.core.types import brief
from coeflab.core.units import STANDARD_GRAVITY, quantity
from coeflab.motion.glider.motion import GliderBody, Polar, Setting
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until

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


KINDS = ("printed", "derived", "calibrated", "assumed")
TABLES = ("glider", "mass", "sliding_mass", "engine", "polar", "phase")
LONGEST = 1e7


def read_glider(path: Path) -> Glider:
    """A glider file, or the only one of a folder.

    Raises
    ------
    InputError
        Not readable, a key that lacks, is unknown or has no sense; one error that names file and key.
    """
    root = read_toml(path)
    head = root.section("glider")
    mass, sliding, engine = _mass(root.section("mass")), _sliding(root), _engine(root.section("engine"))
    out = Glider(
        name=_name(head),
        title=head.text("title"),
        citation=head.text("citation"),
        gravity=head.positive("gravity", "acceleration") if head.has("gravity") else STANDARD_GRAVITY,
        mass=mass,
        sliding_mass=sliding,
        engine=engine,
        polar=_polar(root.section("polar")),
        phases=tuple(_phase(s, sliding, engine) for s in root.sections("phase")),
        basis=_basis(root),
    )
    head.finish()
    root.finish()
    if not out.phases:
        raise root.fail("phase", "no phase", "at least one [[phase]] with net_mass, position and lasts")
    return out


def gliders_at(path: Path) -> tuple[Glider, ...]:
    """The glider of a file, or all those of a folder's TOML files, by file name.

    Raises
    ------
    InputError
        A file that cannot be used, a folder without one, or two gliders of one name.
    """
    files = sorted(path.glob("*.toml")) if path.is_dir() else [path]
    if not files:
        raise InputError("a folder without a TOML file", "a glider file, or a folder of them", file=path)
    found: dict[str, Path] = {}
    out = []
    for file in files:
        out.append(read_glider(file))
        if (name := out[-1].name) in found:
            raise InputError(
                f"{shown(name)}, the name in {found[name].name} too",
                "a name of its own",
                file=file,
                column="glider.name",
            )
        found[name] = file
    return tuple(out)


def _name(head: Section) -> str:
    name = head.text("name")
    if not all(c.isascii() and (c.isalnum() or c in "_-") for c in name):
        raise head.fail("name", shown(name), "letters, digits, _ and -")
    return name


def _mass(section: Section) -> GliderMass:
    out = GliderMass(
        surge=section.positive("surge", "mass"),
        heave=section.positive("heave", "mass"),
        pitch_inertia=section.positive("pitch_inertia", "inertia"),
        moment_ahead=section.quantity("moment_ahead", "moment"),
        moment_below=section.quantity("moment_below", "moment"),
    )
    section.finish()
    return out


def _range(section: Section, dimension: str) -> tuple[float, float]:
    low, high = section.quantity("low", dimension), section.quantity("high", dimension)
    if low > high:
        raise section.fail("low", shown(section.raw("low")), f"no more than high, {shown(section.raw('high'))}")
    return low, high


def _sliding(root: Section) -> SlidingMass:
    if not root.has("sliding_mass"):
        return SlidingMass(0.0, 0.0, 0.0, 0.0, 1.0)
    section = root.section("sliding_mass")
    mass = section.quantity("mass", "mass")
    if mass < 0.0:
        raise section.fail("mass", shown(section.raw("mass")), "zero or more")
    out = SlidingMass(
        mass, section.quantity("below", "length"), *_range(section, "length"), section.positive("rate", "speed")
    )
    section.finish()
    return out


def _engine(section: Section) -> BuoyancyEngine:
    ahead = section.quantity("ahead", "length") if section.has("ahead") else 0.0
    out = BuoyancyEngine(ahead, *_range(section, "mass"), section.positive("rate", "mass rate"))
    section.finish()
    return out


def _polar(section: Section) -> StatedPolar:
    if not section.has("angle_unit"):
        raise section.fail(
            "angle_unit", "nothing", '"deg" or "rad"',
            "K_L and K_M per degree are 57.3 times smaller than per radian, K_D 3283 times. Coefficients without their "
            "unit cannot be used; `coeflab fit` with glide_polar finds it from the forces.",
        )  # fmt: skip
    unit = cast(AngleUnit, section.text("angle_unit", choices=("deg", "rad")))
    k = {symbol: section.quantity(symbol, "none") for symbol in SYMBOLS}
    for symbol in ("K_L", "K_D0"):
        if not k[symbol] > 0.0:
            raise section.fail(symbol, shown(section.raw(symbol)), "a value above zero: lift is upward, drag aft")
    damping = section.quantity("pitch_damping", "none")
    for symbol, value in (("K_D", k["K_D"]), ("pitch_damping", damping)):
        if value < 0.0:
            raise section.fail(symbol, shown(section.raw(symbol)), "zero or more")
    out = StatedPolar(
        angle_unit=unit,
        K_L0=k["K_L0"],
        K_L=k["K_L"],
        K_D0=k["K_D0"],
        K_D=k["K_D"],
        K_M0=k["K_M0"],
        K_M=k["K_M"],
        pitch_damping=damping,
        contains_munk=section.flag("contains_munk"),
        covered=_covered(section),
    )
    section.finish()
    return out


def _covered(section: Section) -> tuple[float, float] | None:
    if not section.has("covered"):
        return None
    value, expected = section.raw("covered"), 'two angles of attack, such as ["-8 deg", "8 deg"], within 90 deg'
    if not isinstance(value, list) or len(value) != 2:
        raise section.fail("covered", shown(value), expected)
    low, high = (quantity(v, "angle", file=section.file, key=section.key("covered")) for v in value)
    if not -math.pi / 2 < low < high < math.pi / 2:
        raise section.fail("covered", shown(value), expected)
    return low, high


def _phase(section: Section, sliding: SlidingMass, engine: BuoyancyEngine) -> GliderPhase:
    out = GliderPhase(
        name=section.text("name"),
        net_mass=section.quantity("net_mass", "mass"),
        position=section.quantity("position", "length") if section.has("position") else 0.0,
        lasts=section.positive("lasts", "time"),
        until_depth=section.optional_quantity("until_depth", "length"),
    )
    for key, value, part, unit in (("net_mass", out.net_mass, engine, "kg"), ("position", out.position, sliding, "m")):
        if not part.low <= value <= part.high:
            raise section.fail(key, f"{value:g} {unit}", f"{part.low:g} to {part.high:g} {unit}, which it reaches")
    if out.lasts > LONGEST:
        raise section.fail("lasts", shown(section.raw("lasts")), f"at most {LONGEST:g} s")
    section.finish()
    return out


def _basis(root: Section) -> tuple[tuple[str, str], ...]:
    section = root.section("basis", required=False)
    known = {name for name in TABLES if root.has(name)}
    out = []
    for key in section.content:
        said, (table, _, inner) = section.text(key), key.partition(".")
        content = root.raw(table, {}) if table in known else {}
        if table not in known or (inner and not (isinstance(content, Mapping) and inner in content)):
            raise section.fail(key, shown(key), "a table of this file, or table.key")
        if said.split()[0].rstrip(":,") not in KINDS:
            raise section.fail(key, shown(said), "a text that begins with " + ", ".join(KINDS))
        out.append((key, said))
    return tuple(out)
