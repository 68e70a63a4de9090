"""Reading a glider file: TOML with units, one clear error with file and key."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import cast

from coeflab.core.errors import InputError, shown
from coeflab.core.toml import Section, read_toml
from coeflab.core.units import STANDARD_GRAVITY, quantity
from coeflab.model.glider import (
    SYMBOLS,
    AngleUnit,
    BuoyancyEngine,
    Glider,
    GliderMass,
    GliderPhase,
    SlidingMass,
    StatedPolar,
)

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
