"""The ``[mesh]`` of a body.toml: where a surface lies and how its numbers are meant; and a surface as a PLY."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.file import load
from coeflab.bodies.mesh.gates import examined, repaired
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.axes import parse_axes
from coeflab.core.errors import UnitsError
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.toml import Section
from coeflab.core.types import Array, locked
from coeflab.core.units import factor


@dataclass(frozen=True, slots=True, eq=False)
class MeshSource:
    """A mesh file and how it is to be read.

    Attributes
    ----------
    file : Path
    unit : float
        Of the file, m.
    rotation : (3, 3) array
        From the file's axes to FRD.
    origin : (3,) array
        Where the file's origin lies, m, FRD, from the datum.
    repair : bool
        Mend a mesh that is not sound.
    """

    file: Path
    unit: float
    rotation: Array
    origin: Array
    repair: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "rotation", locked(self.rotation))
        object.__setattr__(self, "origin", locked(self.origin))

    def input_file(self, body: str) -> InputFile:
        """The file with its digest, under the name of its body."""
        return InputFile(f"{body}/{self.file.name}", sha256_of(self.file))

    def read(self) -> tuple[TriangleMesh, tuple[str, ...]]:
        """The surface, m, FRD, from the datum, and what was done to it in words.

        Raises
        ------
        InputError
            A file that is no sound mesh.
        """
        raw = load(self.file)
        sound = repaired(*raw, self.file) if self.repair else examined(*raw, self.file)
        placed = self.unit * sound.vertices @ self.rotation.T + self.origin
        return TriangleMesh(placed, sound.faces), sound.statements


def mesh_source(section: Section, folder: Path) -> MeshSource:
    """Read ``path`` (from the folder), ``unit``, ``axes``, ``origin`` and ``repair``; the file itself is not opened.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    file = folder / section.text("path")
    name = section.text("unit")
    try:
        unit = factor(name, "length")
    except UnitsError as why:
        raise section.fail("unit", why.found, why.expected, 'Name the unit of the file: "m", "mm", "ft" ...') from None
    repair = section.flag("repair", False)
    axes = parse_axes(section.raw("axes"), section.file, section.key("axes"))
    origin = section.point("origin") if section.has("origin") else np.zeros(3)
    section.finish()
    return MeshSource(file, unit, axes.rotation, origin, repair)


def ply(vertices: Array, faces: NDArray[np.int64]) -> bytes:
    """A surface as a binary PLY of doubles (Turk, The PLY polygon file format, 1994); no digit is lost."""
    head = (
        "ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}",
        *(f"property double {axis}" for axis in "xyz"), f"element face {len(faces)}",
        "property list uchar int vertex_indices", "end_header", "",
    )  # fmt: skip
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    return "\n".join(head).encode() + np.ascontiguousarray(vertices, dtype="<f8").tobytes() + rows.tobytes()
