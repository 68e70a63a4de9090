"""Cases of a towed body: its motion as inflow and rotating frame, the fields of a turbulence model, and the files of it all.

Axes are the body's own (x forward, y to starboard, z down), the origin is the reference point, so no frame is ever turned.

On the arm the whole domain is one rotating frame in absolute velocity (Weller et al. 1998, MRF): the water is at rest far away,
and the forces are those of the water alone, without any inertia of a frame.
"""

from __future__ import annotations

import functools
import hashlib
import os
import re
import shutil
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.files import write_all, write_atomically
from coeflab.core.limits import FOAM_BYTES
from coeflab.core.text.bounded import stream_of, whole_bytes
from coeflab.core.types import Array
from coeflab.tables.campaign import CUTS, PORT_STARBOARD, UP_DOWN
from coeflab.tank.openfoam import rendered
from coeflab.tank.openfoam.mirroring import SYMMETRY_AXIS, sides
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half, TowCondition

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

C_MU = 0.09
FOOT = b"// ****"  # with which OpenFOAM ends every field that it has written whole
STOP_AT = re.compile(r"^(stopAt\s+)\w+;", re.MULTILINE)
# The image in the cut has the same; of the others it has the opposite, so that they vanish in the sum of both.
EVEN = {Half.PORT: CUTS[PORT_STARBOARD].doubled, Half.UPPER: CUTS[UP_DOWN].doubled}
ALIKE = ("system/decomposeParDict",)  # does not count for the key: how many processes share a run
SOMETIMES = {"constant/MRFProperties", "0/k", "0/omega", "0/epsilon", "0/nut", "0/nuTilda"}  # not in every case
TAKEN = {
    "forces",
    "yPlus",
    "pressure",
    "viscous",
    "internal",
    "porous",
    "far",
    "cut",
}  # names of other things than patches
ONCE = (
    "constant/transportProperties",
    "constant/physicalProperties",
    "constant/turbulenceProperties",
    "constant/momentumTransport",
    "constant/towProperties",
    "system/controlDict",
    "system/fvSchemes",
    "system/fvSolution",
    "system/decomposeParDict",
    "0/U",
    "0/p",
)


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a turbulence model.

    Attributes
    ----------
    name, dimensions : str
        As OpenFOAM has them.
    start : float
        Everywhere, before the first iteration.
    far, at_wall : float
    wall : str
        Type of the boundary condition on the body.
    """

    name: str
    dimensions: str
    start: float
    far: float
    wall: str
    at_wall: float


def frame(velocity: Array, rates: Array) -> tuple[Array, Array]:
    """The water far away and the centre of the arm, for a body that moves steadily.

    Every point of the body moves with V + omega x r. Where V is at right angles to omega this vanishes at
    c = omega x V / omega^2, and the water there and everywhere is at rest. What V has along omega is a translation along the axis:
    seen from a frame that shares it, the water comes against it, steadily.

    Parameters
    ----------
    velocity : (3,) array
        Of the reference point, m/s, FRD.
    rates : (3,) array
        rad/s.

    Returns
    -------
    water : (3,) array
        m/s; in straight tow -V.
    centre : (3,) array
        m, from the reference point; in yaw and without drift (0, u/r, 0). In straight tow the origin.
    """
    squared = float(rates @ rates)
    if squared == 0.0:
        return -velocity, np.zeros(3)
    return -rates * float(rates @ velocity) / squared, np.cross(rates, velocity) / squared


def axis_inside(velocity: Array, rates: Array, low: Array, high: Array) -> bool:
    """Whether the axis of the arm goes through a box.

    Parameters
    ----------
    velocity, rates : (3,) array
        Of the reference point, m/s, and rad/s, not all zero; FRD.
    low, high : (3,) array
        Corners of the box, m, from the reference point.
    """
    centre, along = frame(velocity, rates)[1], rates / np.linalg.norm(rates)
    runs = np.abs(along) > 1e-12
    if np.any((centre[~runs] < low[~runs]) | (centre[~runs] > high[~runs])):
        return False
    ends = np.sort(np.array([low[runs] - centre[runs], high[runs] - centre[runs]]) / along[runs], axis=0)
    return bool(ends[0].max() <= ends[1].min())


def fastest(body: TowedBody, condition: TowCondition) -> float:
    """Speed of the point of the body that is the fastest, m/s."""
    return float(np.linalg.norm(condition.velocity + np.cross(condition.rates, body.vertices), axis=1).max())


def turbulent_fields(
    model: str, wall: str, speed: float, viscosity: float, intensity: float, ratio: float
) -> tuple[Field, ...]:
    """The fields that a model needs.

    Runs start with far more turbulence than the water brings: a boundary layer that starts laminar takes longer.

    Parameters
    ----------
    model : {"kOmegaSST", "realizableKE", "SpalartAllmaras", ""}
        Empty for laminar flow, which needs none.
    wall : {"functions", "resolved", "none"}
    speed : float
        m/s.
    viscosity : float
        Kinematic, m^2/s.
    intensity : float
        Of the turbulence in the water, over the speed.
    ratio : float
        Of its eddy viscosity to that of the water.
    """
    if not model:
        return ()
    k = 1.5 * (intensity * speed) ** 2
    nut = ratio * viscosity
    start_k, start_nut = 50.0 * k, 20.0 * nut
    resolved = wall == "resolved"
    eddy = Field(
        "nut", "[0 2 -1 0 0 0 0]", start_nut, nut, "nutLowReWallFunction" if resolved else "nutkWallFunction", 0.0
    )
    if model == "SpalartAllmaras":
        # Far away nuTilda is about the eddy viscosity and more: f_v1 is small there (Spalart and Allmaras 1994).
        eddy = eddy if resolved else replace(eddy, wall="nutUSpaldingWallFunction")
        return (eddy, Field("nuTilda", "[0 2 -1 0 0 0 0]", start_nut, 3.0 * viscosity, "fixedValue", 0.0))
    kinetic = Field(
        "k", "[0 2 -2 0 0 0 0]", start_k, k, *(("fixedValue", 1e-12) if resolved else ("kqRWallFunction", k))
    )
    if model == "kOmegaSST":
        omega = Field("omega", "[0 0 -1 0 0 0 0]", start_k / start_nut, k / nut, "omegaWallFunction", k / nut)
        return (eddy, kinetic, omega)
    start, far = C_MU * start_k**2 / start_nut, C_MU * k**2 / nut
    return (eddy, kinetic, Field("epsilon", "[0 2 -3 0 0 0 0]", start, far, "epsilonWallFunction", far))


@functools.lru_cache(maxsize=2)  # all conditions of a half have the same
def split(body: TowedBody, half: Half) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Which patches the cut divides, and which lie in the half as the image of one that does not.

    Parameters
    ----------
    body : TowedBody
        Its own mirror image in the cut.
    half : Half

    Returns
    -------
    divided : tuple of str
        Of the whole body every patch.
    pairs : tuple of (str, str)
        The patch in the half and its image, a patch of another name.

    Raises
    ------
    InputError
        A patch outside the half is no image of one within.
    """
    if half is Half.WHOLE:
        return body.patches, ()
    found = sides(body, SYMMETRY_AXIS[half])
    for name in found.alone:
        raise InputError(
            f"the patch {name}, of which no patch with {half} is the mirror image", "a body that is its own image",
            advice="Tow the whole body.",
        )  # fmt: skip
    return found.divided, found.pairs


def slices(cores: int) -> tuple[int, int, int]:
    """Into how many parts a domain is cut along x, y, z: along the body first, across it where that leaves thin slices."""
    across = next((n for n in (2,) if cores >= 8 and cores % n == 0), 1)
    return cores // across, across, 1


def case_files(
    tank: Tank, body: TowedBody, condition: TowCondition, fields: Sequence[Field], model: str, *, simplec: bool,
    iterations: int, checkpoint: int,
) -> dict[str, bytes]:  # fmt: skip
    """Every file of a case but its mesh, by its path.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    condition : TowCondition
    fields : sequence of Field
    model : str
        ``RASModel``; empty for laminar flow.
    simplec : bool
        SIMPLEC, else SIMPLE.
    iterations : int
        At most.
    checkpoint : int
        Iterations after which fields are written.

    Raises
    ------
    InputError
        A patch has a name that is taken, or a half is asked for of a body that is not its own image.
    """
    water, centre = frame(condition.velocity, condition.rates)
    rate = float(np.linalg.norm(condition.rates))
    if taken := TAKEN.intersection(body.patches):
        raise InputError(
            f"a part named {sorted(taken)[0]}", f"any name but {', '.join(sorted(TAKEN))}", file=tank.body,
            advice="OpenFOAM or coeflab uses this name for something else.",
        )  # fmt: skip
    divided, pairs = split(body, condition.half)
    values = {
        "divided": divided, "pairs": pairs, "parts": (*divided, *(mine for mine, _ in pairs)),
        "condition": condition, "half": condition.half.value, "turns": condition.turns, "water": water, "centre": centre,
        "axis": condition.rates / rate if rate else np.zeros(3), "omega": rate, "model": model, "simplec": simplec,
        "density": tank.conditions.density, "viscosity": tank.conditions.viscosity, "patches": body.patches,
        "length": body.length, "fastest": fastest(body, condition), "iterations": iterations, "checkpoint": checkpoint,
        "cores": tank.cores, "slices": slices(tank.cores),
    }  # fmt: skip
    out = {name: rendered(f"case/{name}", **values) for name in ONCE}
    if condition.turns:
        out["constant/MRFProperties"] = rendered("case/constant/MRFProperties", **values)
    out.update({f"0/{f.name}": rendered("case/0/turbulence", field=f) for f in fields})
    return out


def digest(files: Mapping[str, bytes], *more: str) -> str:
    """Sha256 of the files by their names, and of more texts; without what changes nothing in the result of a run.

    That is how many processes share it, and how often it writes or how long it may go on: a run ends on its plateau.
    """
    total = hashlib.sha256()
    for name in sorted(files):
        if name not in ALIKE:
            content = re.sub(rb"(?m)^(endTime|writeInterval)\s.*$", b"", files[name])
            total.update(f"{name}\n{len(content)}\n".encode() + content)
    for text in more:
        total.update(f"\n{text}".encode())
    return total.hexdigest()


def placed(folder: Path, files: Mapping[str, bytes], mesh: Path) -> None:
    """Write the files and the link to the mesh; what is there and equal is left alone, a field or a frame too many is removed."""
    write_all(folder, files)
    for name in SOMETIMES - files.keys():
        (folder / name).unlink(missing_ok=True)
    link, target = folder / "constant/polyMesh", Path(os.path.relpath(mesh / "constant/polyMesh", folder / "constant"))
    if not link.is_symlink() or link.readlink() != target:
        link.unlink(missing_ok=True)
        link.symlink_to(target)


def set_stop(folder: Path, at: str) -> None:
    """Have the solver end there: ``writeNow`` after writing its fields, ``endTime`` at its last iteration.

    Raises
    ------
    InputError
        system/controlDict is not the one that was written.
    """
    file = folder / "system/controlDict"
    text = whole_bytes(file, FOAM_BYTES).decode()
    changed, many = STOP_AT.subn(rf"\g<1>{at};", text)
    if many != 1:
        raise InputError(f"{many} entries stopAt", "one", file=file, advice="Remove the case; it is written anew.")
    if changed != text:
        write_atomically(file, changed.encode())


def written_times(folder: Path) -> list[float]:
    """Times at which every process has written every field whole, latest last."""
    parts = sorted(folder.glob("processor[0-9]*")) or [folder]
    names = {f.name for f in (folder / "0").iterdir() if f.suffix == ""} | {"phi"}
    times = [
        {t.name for t in p.iterdir() if re.fullmatch(r"\d+(\.\d+)?", t.name) and float(t.name) > 0.0} for p in parts
    ]
    whole = [t for t in set.intersection(*times) if all(_is_whole(p / t / n) for p in parts for n in names)]
    return sorted(map(float, whole))


def _is_whole(field: Path) -> bool:
    """Whether a field was written to its end: the solver may have been killed within it."""
    with suppress(FileNotFoundError), stream_of(field) as stream:
        stream.seek(max(0, field.stat().st_size - 200))
        return FOOT in stream.read()
    return False


def shares(folder: Path) -> int:
    """Processes among which a run is divided; 0 for one that is not."""
    return len(list(folder.glob("processor[0-9]*")))


def remove_after(folder: Path, last: float) -> None:
    """Remove fields of later times, which the solver would start from, and which it did not write whole."""
    for part in (folder, *folder.glob("processor[0-9]*")):
        for time in part.iterdir():
            if re.fullmatch(r"\d+(\.\d+)?", time.name) and float(time.name) > last:
                shutil.rmtree(time)
