"""The ``[mesh]`` of a body.toml: where a surface lies and how its numbers are meant; and a surface as a PLY."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.declared_faces import LARGEST_TEXT
from coeflab.bodies.mesh.file import load
from coeflab.bodies.mesh.gates import sound
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core import declarations as takes
from coeflab.core.axes import Frame
from coeflab.core.errors import InputError, UnitsError
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.bounded import leading_bytes
from coeflab.core.types import Array, locking
from coeflab.core.units import factor


@dataclass(frozen=True, slots=True, eq=False)
@locking("rotation origin")
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
    fill : bool
        Close its small holes.
    sheets : bool
        Take open surfaces as sheets with water on both sides.
    """

    file: Path
    unit: float
    rotation: Array
    origin: Array
    repair: bool = False
    fill: bool = False
    sheets: bool = False

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
        found = sound(*load(self.file), self.file, repair=self.repair, fill=self.fill, open_sheets=self.sheets)
        placed = self.unit * found.vertices @ self.rotation.T + self.origin
        return TriangleMesh(placed, found.faces, sheets=found.sheets), found.statements

    def solids(self, points: Array) -> tuple[tuple[str, ...], NDArray[np.int64]]:
        """The named solids of a text STL, and which of them each point of its surface lies on; none of other files.

        Parameters
        ----------
        points : (n, 3) array
            Middles of faces, m, FRD, from the datum.

        Returns
        -------
        names : tuple of str
            None where the file has fewer than two names.
        which : (n,) array of int
            The solid of the facet with the nearest middle.
        """
        from scipy.spatial import cKDTree

        data = leading_bytes(self.file, LARGEST_TEXT) if self.file.suffix.lower() == ".stl" else b""
        found = [(name.decode("utf-8", "replace"), VERTEX.findall(rest)) for name, rest in SOLID.findall(data)]
        names = tuple(dict.fromkeys(name for name, corners in found if corners))
        if len(names) < 2:
            return (), np.zeros(len(points), dtype=np.int64)
        corners = np.array([corner for _, own in found for corner in own], dtype=float)
        middles = corners.reshape(-1, 3, 3).mean(axis=1)
        number = np.repeat(
            [names.index(name) for name, own in found if own], [len(own) // 3 for _, own in found if own]
        )
        nearest = cKDTree(self.unit * middles @ self.rotation.T + self.origin).query(points)[1]
        return names, np.asarray(number[nearest], dtype=np.int64)


SOLID = re.compile(rb"^[ \t]*solid[ \t]+([^\r\n]*?)[ \t]*$(.*?)^[ \t]*endsolid", re.MULTILINE | re.DOTALL)
VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)")


def _unit(value: Any, file: Path) -> float:
    try:
        return factor(takes.text_of(value, file), "length")
    except UnitsError as why:
        raise InputError(why.found, why.expected, advice='Name the unit of the file: "m", "mm", "ft" ...') from None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshKeys(takes.Declaration):
    """A surface of triangles.

    Attributes
    ----------
    path : str
        STL, OBJ, PLY, GLB, DAE, STEP, URDF or SDF, from the folder of the body.toml.
    unit : str
        Of its numbers, such as m, mm or ft.
    axes : str or list of str
        FRD, FLU, CFD (x aft, y starboard, z up), or where x, y and z point.
    origin : (3,) array
        Where its origin lies, [x, y, z], m, FRD, from the datum; the datum itself unless given.
    repair : bool
        Mend a mesh that is not sound.
    fill : bool
        Close holes of up to 1 % of the surface each.
    sheets : bool
        Take open surfaces as sheets with water on both sides.
    """

    path: takes.Text
    unit: Annotated[float, takes.Takes("a text", _unit, {"type": "string"})]
    axes: Frame
    origin: takes.Point | None = None
    repair: takes.Flag = False
    fill: takes.Flag = False
    sheets: takes.Flag = False

    def source(self, folder: Path) -> MeshSource:
        """The file itself is not opened."""
        origin = np.zeros(3) if self.origin is None else self.origin
        return MeshSource(
            folder / self.path, self.unit, self.axes.rotation, origin, self.repair, self.fill, self.sheets
        )


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
