"""A mesh file as vertices and faces, as they stand there."""

from __future__ import annotations

import logging
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.declared_faces import (
    composed_faces,
    dae_faces,
    glb_faces,
    metres_of_dae,
    obj_faces,
    ply_faces,
    require_corners,
    stl_faces,
    text_of,
)
from coeflab.core.errors import InputError, shown
from coeflab.core.machine import physical_memory, stage
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array

if TYPE_CHECKING:
    from trimesh import Scene, Trimesh


FORMATS: dict[str, Callable[[Path], int]] = {
    "stl": stl_faces,
    "obj": obj_faces,
    "ply": ply_faces,
    "glb": glb_faces,
    "dae": dae_faces,
    **dict.fromkeys(("step", "stp", "urdf", "sdf"), composed_faces),
}
SELF_DESCRIBED = {"dae": ("m", ""), "urdf": ("m", "FLU"), "sdf": ("m", "FLU"), "step": ("m", ""), "stp": ("m", "")}
PACKAGES = {  # that formats need: of the interpreter, the format's name, coeflab's extra
    "dae": ("collada", "COLLADA", "collada"), "step": ("cascadio", "STEP", "step"), "stp": ("cascadio", "STEP", "step"),
}  # fmt: skip
STEP_ANGLE = 0.1  # rad, largest turn from facet to facet of a curved face of a STEP


BYTES_PER_FACE, BYTES_PER_LETTER = 700, 7
SHARE_OF_MACHINE, UNKNOWN_MACHINE = 0.75, 8 << 30
LARGE_MESH = 500_000

log = logging.getLogger(__name__)


def memory_needed(faces: int, text: int = 0) -> int:
    """Bytes that a mesh takes at most, from file to added mass by every method; measured up to 10,000,000 faces.

    Parameters
    ----------
    faces : int
    text : int
        Bytes of a text format, which is held in pieces while it is read.
    """
    return max(BYTES_PER_FACE * faces, BYTES_PER_LETTER * text)


def _in_words(memory: int) -> str:
    return f"about {max(memory / 1e9, 0.1):.1f} GB of memory"


def most_memory() -> int:
    """Bytes that a mesh may take: three quarters of the machine's memory; of 8 GiB where the system does not tell."""
    return int(SHARE_OF_MACHINE * (physical_memory() or UNKNOWN_MACHINE))


def faces_of(path: Path) -> int:
    """How many faces a mesh file holds by its own account, checked against its size; nothing is loaded.

    Raises
    ------
    InputError
        Not there, a folder, empty, of another format, cut short, or too large for this machine.
    """
    kind = path.suffix.lower().lstrip(".")
    try:
        if path.is_dir():
            raise InputError("a folder", "a mesh file", file=path)
        if not path.exists():
            raise InputError("no such file", "a mesh file that exists", file=path)
        if kind not in FORMATS:
            advice = "Save it as GLB." if kind == "gltf" else "Export the body as STL."
            raise InputError(shown(path.suffix), f"a mesh file: {', '.join(FORMATS)}", file=path, advice=advice)
        if path.stat().st_size == 0:
            raise InputError("an empty file", "a mesh", file=path)
        count = FORMATS[kind](path)
    except (OSError, ValueError) as why:
        raise InputError(str(getattr(why, "strerror", None) or why), "a readable mesh file", file=path) from None
    if count == 0:
        raise InputError("no faces", "triangles of a closed surface", file=path)
    needed, most = memory_needed(count, text_of(path, count)), most_memory()
    if needed > most:
        raise input_error(
            "mesh.faces_would_take", path, count=count, in_words=_in_words(needed), most=most / 1000000000.0
        )
    return count


def _only(scene: Scene) -> Trimesh:
    """All meshes of a scene as one; a single one that stands at the origin is taken as it is, without a copy."""
    found: Trimesh | None = None
    if len(scene.graph.nodes_geometry) == len(scene.geometry) == 1:
        place, name = scene.graph[scene.graph.nodes_geometry[0]]
        found = scene.geometry[name] if np.array_equal(place, np.eye(4)) else None
    return scene.to_mesh() if found is None else found


def load(path: Path) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (n, 3) and faces (m, 3) of an STL, OBJ, PLY, GLB, DAE, STEP, URDF or SDF; nothing is joined, dropped or mended.

    The shapes of a URDF or SDF are united; a STEP is triangulated and turned to m by the package cascadio, a DAE is read by
    pycollada and scaled to m by the unit that it states; its axes stay as they are, whichever it calls up.

    Polygons become triangles; placed copies within a GLB become one mesh. Materials are not read.

    Raises
    ------
    InputError
        See `faces_of`; or the file is damaged inside, or holds coordinates that are no numbers.
    """
    count = faces_of(path)
    if count >= LARGE_MESH:
        log.info("%s: %d faces, %s", path.name, count, _in_words(memory_needed(count, text_of(path, count))))
    stage(f"reading {count:,} faces of {path.name}")
    import trimesh

    # The library logs what it stumbles over with a traceback; that is for those who have set up logging.
    theirs = logging.getLogger("trimesh")
    if not theirs.handlers:
        theirs.addHandler(logging.NullHandler())
    kind = path.suffix.lower().lstrip(".")
    if kind in ("urdf", "sdf"):
        from coeflab.bodies.mesh.robot import robot_surface

        return robot_surface(path, load)
    extra: dict[str, Any] = {"skip_materials": True} if kind in ("obj", "glb") else {}
    if kind in PACKAGES and find_spec(PACKAGES[kind][0]) is None:
        package, name, group = PACKAGES[kind]
        raise input_error("mesh.without_package_reads", path, name=name, expected=package, group=group)
    if kind in ("step", "stp"):
        extra = {"tol_angular": STEP_ANGLE}
    metres = metres_of_dae(path) if kind == "dae" else 1.0
    try:
        with stream_of(path) as stream:
            scene = trimesh.load_scene(stream, file_type=kind, process=False, **extra)
        found = _only(scene)
        vertices, faces = np.array(found.vertices, dtype=np.float64), np.array(found.faces, dtype=np.int64)
        vertices *= metres
    # The parser meets files of any kind; whatever it stumbles over, the file is at fault.
    except Exception as why:
        if kind == "obj":
            require_corners(path)
        raise InputError(
            f"contents that cannot be read ({type(why).__name__}: {shown(why)})", f"a whole {kind.upper()}", file=path
        ) from None
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise InputError("vertices without three coordinates", "x, y and z", file=path)
    if faces.ndim != 2 or len(faces) == 0 or faces.min() < 0 or faces.max() >= len(vertices):
        if kind == "obj":
            require_corners(path)
        raise InputError("no faces, or a face without its vertex", "triangles of a closed surface", file=path)
    if len(faces) < count:
        raise InputError(f"{len(faces)} readable faces of {count}", "all of them", file=path, advice="Export it again.")
    wrong = int(np.sum(~np.isfinite(vertices).all(axis=1)))
    if wrong:
        raise input_error("mesh.vertices_coordinates_numbers", path, wrong=wrong)
    return vertices, faces
