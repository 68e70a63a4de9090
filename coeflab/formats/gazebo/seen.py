"""The body's own mesh in a written gz-sim model, in the place of the ellipsoid that the parameter file alone gives."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.shape import Shape
from coeflab.core.axes import FLU
from coeflab.core.errors import InputError
from coeflab.core.types import Array
from coeflab.formats.gazebo.sdf import ELLIPSOID

PANELS = 8000
_VISUAL = re.compile(rb'<visual name="hull">.*?</visual>', re.DOTALL)


def with_mesh(files: Mapping[str, bytes], shape: Shape, point: Array) -> Mapping[str, bytes]:
    """The files with a mesh of the body beside them, a binary STL, and as the visual of every model.

    Parameters
    ----------
    files : mapping of str to bytes
        What `render` made.
    shape : Shape
        About its datum, FRD.
    point : (3,) array
        The reference point from the datum, which is the origin of the link.

    Returns
    -------
    mapping of str to bytes
        As given where the shape encloses nothing, or has no mesh of `PANELS` triangles.
    """
    try:
        mesh = meshed(shape, PANELS)
    except InputError:
        return files
    name = f"{next(iter(files)).removesuffix('.sdf')}_hull.stl"
    seen = f'<visual name="hull">\n<geometry>\n<mesh>\n<uri>{name}</uri>\n</mesh>\n</geometry>\n</visual>'.encode()
    words = f"The visual is the mesh {name}.".encode()
    out = {n: _VISUAL.sub(seen, text).replace(ELLIPSOID.encode(), words) for n, text in files.items()}
    return out | {name: _stl(mesh, point)}


def _stl(mesh: TriangleMesh, point: Array) -> bytes:
    """Binary: a head of 80 bytes, a count, and of each triangle normal, corners and two bytes; x forward, y port, z up."""
    corners = ((mesh.vertices - point) * FLU[:3])[np.vstack([mesh.faces, mesh.sheets])]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    rows = np.zeros(len(corners), dtype=[("numbers", "<f4", (4, 3)), ("rest", "<u2")])
    rows["numbers"][:, 0] = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
    rows["numbers"][:, 1:] = corners
    return b"coeflab".ljust(80, b"\0") + len(rows).to_bytes(4, "little") + rows.tobytes()
