"""Unit and axes of a mesh that states neither, proposed from its size and its outline; a person confirms them by typing them.

Size tells millimetres from metres, not from 1.1 times as much; shape tells what lies ahead and up, not port from starboard.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.file import SELF_DESCRIBED, load
from coeflab.bodies.mesh.gates import SoundMesh, sound
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import computed
from coeflab.bodies.orientation import doubt
from coeflab.core.axes import Datum, parse_axes
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import Source
from coeflab.core.types import Array, Faces
from coeflab.core.units import factor

UNITS = ("m", "mm", "cm", "in")  # the first that makes it as long as a vehicle is; ft is told from m by nothing
SIZES = 0.15, 150.0  # m, from a small ROV to a large submarine
HABIT = "FLU"  # of CAD for robots, where the shape does not contradict it


@dataclass(frozen=True, slots=True)
class Proposal:
    """What a mesh file may be.

    Attributes
    ----------
    unit, axes : str
        As options take them.
    repair, closed : bool
        It is sound only once repaired; it is sound.
    sizes : tuple of float
        Along x forward, y, z, m, with these.
    findings : tuple of Finding
        Why; and what neither size nor shape says.
    """

    unit: str
    axes: str
    repair: bool
    closed: bool
    sizes: tuple[float, float, float]
    findings: tuple[Finding, ...]

    @property
    def options(self) -> tuple[str, ...]:
        """What to type behind the file."""
        return ("--unit", self.unit, "--axes", self.axes, *(("--repair",) if self.repair else ()))


def proposed(path: Path, unit: str = "", axes: str = "") -> Proposal:
    """Unit and axes by size and outline; what is stated stands.

    Parameters
    ----------
    path : Path
    unit, axes : str
        As stated, or empty.

    Raises
    ------
    InputError
        No mesh can be read.
    """
    vertices, faces = load(path)
    largest = float(np.ptp(vertices, axis=0).max())
    own = SELF_DESCRIBED.get(path.suffix.lower().lstrip("."), ("", ""))
    unit = unit or own[0] or _unit(largest)
    long = largest * factor(unit, "length")
    found = [Finding.of("mesh.size", path.name, Severity.NOTE, statistic=long, unit=unit, numbers=largest)]
    mesh, mended, why = _surface(vertices, faces, path)
    if why:
        found.append(Finding.of("mesh.open", path.name, Severity.WARN, why=why))
    stated = axes or own[1]
    axes = stated or HABIT
    frame = parse_axes(axes, file=path, key="--axes")
    shape = TriangleMesh(
        factor(unit, "length") * (vertices if mesh is None else mesh.vertices) @ frame.rotation.T,
        faces if mesh is None else mesh.faces,
    )
    if mesh is not None and not stated:
        body = Body(
            name=path.stem, title=path.name, datum=Datum.of_file(path.name), reference_point=np.zeros(3), lengths={},
            configurations=(computed(shape, ()),), source=Source(path.name), files=(), shape=shape, axes=replace(frame, spelled=False),
        )  # fmt: skip
        contradicted = doubt(body)
        if contradicted is not None:
            axes = contradicted["better"]
            found.append(contradicted)
    if not stated and mesh is None:
        axes = ("", "starboard,forward,up", "port,up,forward")[int(np.argmax(shape.extents))] or axes
    turned = np.abs(parse_axes(axes).rotation @ frame.rotation.T) @ shape.extents
    found.append(Finding.of("mesh.axes", path.name, Severity.NOTE, axes=axes, sizes=[float(x) for x in turned]))
    return Proposal(
        unit, axes, mended, mesh is not None, (float(turned[0]), float(turned[1]), float(turned[2])), tuple(found)
    )


def _unit(numbers: float) -> str:
    for name in UNITS:
        if SIZES[0] <= numbers * factor(name, "length") <= SIZES[1]:
            return name
    return UNITS[0]


def _surface(vertices: Array, faces: Faces, path: Path) -> tuple[SoundMesh | None, bool, str]:
    """The surface as it is, else repaired, else none and why."""
    why = ""
    for repair in (False, True):
        try:
            return sound(vertices, faces, path, repair=repair), repair, ""
        except InputError as wrong:
            why = wrong.found
    return None, True, why
