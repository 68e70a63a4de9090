"""The repair of a mesh that a person may ask for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.mesh_topology import (
    Labels,
    degenerate,
    edges,
    joined,
    oriented,
    repeated,
    shell_volumes,
    shells,
    welded,
)
from coeflab.kernels.solids import surface
from coeflab.model.mesh_gates import JOINED, SoundMesh, as_solid, examined

Array = NDArray[np.float64]
Faces = NDArray[np.int64]


def repaired(vertices: Array, faces: Faces, file: Path) -> SoundMesh:
    """The mesh mended as far as that is safe, then examined like any other; the statements say what was done.

    Vertices within 1e-6 of the size are joined; faces that lost their area or came twice go; faces are turned alike and
    outward, which fills cavities; shells are united.

    Raises
    ------
    InputError
        What remains after that, such as holes.
    """
    said: list[str] = []
    count = len(faces)
    before = len(welded(vertices, faces)[0])
    vertices, faces = joined(vertices, faces, JOINED)
    _say(said, before - len(vertices), "vertices joined")
    faces = faces[~repeated(faces)]
    if not len(faces):
        raise InputError(
            "no face with an area", "triangles of a closed surface", file=file, advice="Is the file damaged?"
        )
    _say(said, count - len(faces), "degenerate or duplicate faces dropped")
    turned = oriented(faces)
    if turned is not None:
        _say(said, int(np.any(turned != faces, axis=1).sum()), "faces turned")
        faces = turned
    number, shell = shells(faces)
    inward = shell_volumes(vertices, faces, shell)[0] < 0.0
    if edges(faces).sound:
        faces = np.where(inward[shell][:, None], faces[:, ::-1], faces)
        _say(said, int(inward.sum()), f"of {number} shells turned outward")
        if number > 1 or degenerate(vertices, faces).any():
            vertices, faces = _united(vertices, faces, shell, number, file)
            said.append(
                f"{number} shells united" if number > 1 else "faces without an area merged into their neighbours"
            )
    found = examined(vertices, faces, file)
    return SoundMesh(
        found.vertices, found.faces, (f"repaired: {', '.join(said) or 'nothing to do'}", *found.statements)
    )


def _united(vertices: Array, faces: Faces, shell: Labels, count: int, file: Path) -> tuple[Array, Faces]:
    """What all shells enclose together."""
    from manifold3d import Manifold, OpType

    def fail(found: str, expected: str, advice: str) -> InputError:
        return InputError(found, expected, file=file, advice=advice)

    made = [as_solid(vertices, faces[shell == k], fail) for k in range(count)]
    return surface(Manifold.batch_boolean(made, OpType.Add).simplify(0.0))


def _say(said: list[str], count: int, what: str) -> None:
    if count:
        said.append(f"{count} {what}")
