"""Reading a glider file: TOML with units, one clear error with file and key."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.glider.glider import BuoyancyEngine, Glider, GliderMass, GliderPhase, SlidingMass, StatedPolar
from coeflab.glider.masses import MassModel
from coeflab.glider.space import Lateral, Thrusters

NO_SLIDING_MASS = SlidingMass(0.0, 0.0, 0.0, 0.0, 1.0)
KINDS = ("printed", "derived", "calibrated", "assumed")
IN_SPACE = ("masses", "lateral", "thrusters")
TABLES = ("glider", "mass", "sliding_mass", "engine", "polar", *IN_SPACE, "phase")


def _no_name(text: str) -> str:
    return "" if all(c.isascii() and (c.isalnum() or c in "_-") for c in text) else "letters, digits, _ and -"


@dataclass(frozen=True, slots=True)
class GliderHead(takes.Declaration):
    """What the glider is.

    Attributes
    ----------
    name : str
        Letters, digits, _ and -.
    title : str
        As reports print it.
    citation : str
        Key of a work or free text.
    gravity : float
        Acceleration; the standard one unless given.
    """

    name: Annotated[takes.Text, takes.Within(_no_name, schema={"pattern": "^[A-Za-z0-9_-]+$"})]
    title: takes.Text
    citation: takes.Text
    gravity: Annotated[takes.Acceleration, takes.ABOVE_ZERO] = STANDARD_GRAVITY


@dataclass(frozen=True, slots=True, kw_only=True)
class GliderFile(takes.Declaration):
    """A glider file: a vehicle with a sliding mass and a buoyancy engine, and one cycle of it.

    Attributes
    ----------
    glider : table
        What the glider is.
    mass : table
        Masses without the sliding mass, about the reference point.
    sliding_mass : table
        A mass that slides along x; none unless given.
    engine : table
        What makes the vehicle heavy or light.
    polar : table
        Lift, drag and moment over the angle of attack.
    masses : table
        Pistons, roller and the rest; with [lateral] and [thrusters] the glider moves in space.
    lateral : table
        What moves it to the side.
    thrusters : table
        Two thrusters that push ahead.
    phase : array of tables
        Orders of one cycle, one after the other.
    basis : mapping of str to str
        Where a table or ``"table.key"`` of this file comes from: begins with printed, derived, calibrated or assumed.
    """

    glider: GliderHead
    mass: GliderMass
    sliding_mass: SlidingMass = NO_SLIDING_MASS
    engine: BuoyancyEngine
    polar: StatedPolar
    masses: MassModel | None = None
    lateral: Lateral | None = None
    thrusters: Thrusters | None = None
    phase: tuple[GliderPhase, ...] = ()
    basis: dict[str, takes.Text] = field(default_factory=dict)

    def check(self) -> None:
        """Orders that the glider can follow."""
        if not self.phase:
            raise InputError("no phase", "at least one [[phase]] with net_mass, position and lasts", column="phase")
        for i, phase in enumerate(self.phase):
            for key, part, unit in (("net_mass", self.engine, "kg"), ("position", self.sliding_mass, "m")):
                if not part.low <= (value := getattr(phase, key)) <= part.high:
                    expected = f"{part.low:g} to {part.high:g} {unit}, which it reaches"
                    raise InputError(f"{value:g} {unit}", expected, column=f"phase[{i}].{key}")
            self._check_in_space(i, phase)

    def _check_in_space(self, i: int, phase: GliderPhase) -> None:
        """Orders that leave the vertical plane need all that moves the glider there."""
        asked = [key for key in ("roller", "thrust_right", "thrust_left") if getattr(phase, key)]
        absent = [f"[{name}]" for name in IN_SPACE if getattr(self, name) is None]
        if asked and absent:
            advice = f"{asked[0]} moves the glider out of the vertical plane or drives it."
            raise InputError(
                f"no {absent[0]}", "[masses], [lateral] and [thrusters]", column=f"phase[{i}].{asked[0]}", advice=advice
            )
        for key in (k for k in asked if k != "roller"):
            most = 0.0 if self.thrusters is None else self.thrusters.largest
            if abs(value := getattr(phase, key)) > most:
                raise InputError(
                    f"{value:g} N", f"{-most:g} to {most:g} N, [thrusters] largest", column=f"phase[{i}].{key}"
                )


def read_glider(path: Path) -> Glider:
    """A glider file, or the only one of a folder.

    Raises
    ------
    InputError
        Not readable, a key that lacks, is unknown or has no sense; one error that names file, line and key.
    """
    toml = read_toml(path)
    file = takes.declared(GliderFile, toml)
    head = file.glider
    for key, words in file.basis.items():
        table, _, inner = key.partition(".")
        content = toml.content.get(table, {}) if table in TABLES else {}
        if not (table in TABLES and table in toml.content) or (
            inner and not (isinstance(content, dict) and inner in content)
        ):
            raise toml.fail(f"basis.{key}", shown(key), "a table of this file, or table.key")
        if words.split()[0].rstrip(":,") not in KINDS:
            raise toml.fail(f"basis.{key}", shown(words), "a text that begins with " + ", ".join(KINDS))
    return Glider(
        head.name, head.title, head.citation, head.gravity, file.mass, file.sliding_mass, file.engine, file.polar,
        file.phase, tuple(file.basis.items()), file.masses, file.lateral, file.thrusters,
    )  # fmt: skip


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
            raise input_error("glider.name_too", file, column="glider.name", name=shown(name), name_2=found[name].name)
        found[name] = file
    return tuple(out)
