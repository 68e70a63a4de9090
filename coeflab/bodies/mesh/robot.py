"""The bodies of a URDF or SDF model as one surface: its links' primitives and meshes, each in its pose.

Joints stand at zero. What is seen (visual) is taken, of a link without it what collides. Shapes of cylinders and spheres have
64 sides around.

Sources: URDF, wiki.ros.org/urdf/XML; SDFormat 1.11, sdformat.org/spec.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.files import typed
from coeflab.core.text.xml import numbers, read_xml
from coeflab.core.texts import input_error
from coeflab.core.types import Array, Faces

Surface = tuple[Array, Faces]
Loaded = Callable[[Path], tuple[Array, NDArray[np.int64]]]
AROUND, MOST_LINKS = 64, 1000
VERBATIM = "Save what you want computed as one STL, or write its parts into a body.toml of reader primitives."


def robot_surface(path: Path, load: Loaded) -> Surface:
    """Vertices, m, and faces of all links, united where they overlap, along the axes of the model.

    Parameters
    ----------
    path : Path
        Ends in .urdf or .sdf.
    load : callable
        Reads a mesh file.

    Raises
    ------
    InputError
        No shape, a shape of another kind, a mesh that is not there, a pose relative to something else than its parent.
    """
    root = read_xml(path)
    pieces = list(_urdf(root, path, load) if path.suffix.lower() == ".urdf" else _sdf(root, path, load))
    if not pieces:
        raise input_error("mesh.visual_collision_shape", path, advice=VERBATIM)
    return _joined(pieces)


def _joined(pieces: list[Surface]) -> Surface:
    from manifold3d import Manifold, OpType

    from coeflab.bodies.mesh.solids import solid, surface
    from coeflab.bodies.mesh.topology import repeated, welded

    try:
        # A union would drop what is given from both sides.
        solids = (
            [] if any(repeated(welded(*piece)[1]).any() for piece in pieces) else [solid(*piece) for piece in pieces]
        )
    except ValueError:
        solids = []
    if not solids:  # such pieces and open ones are left to the gates, which name what is wrong with them
        starts = np.cumsum([0, *(len(v) for v, _ in pieces[:-1])])
        return np.concatenate([v for v, _ in pieces]), np.concatenate(
            [f + s for (_, f), s in zip(pieces, starts, strict=True)]
        )
    return surface(Manifold.batch_boolean(solids, OpType.Add))


def _urdf(root: Element, path: Path, load: Loaded) -> Iterator[Surface]:
    """Links of a tree of joints; rpy turns about fixed x, y and z."""
    joints = {}
    for joint in root.findall("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            joints[child.get("link", "")] = (parent.get("link", ""), _origin(joint.find("origin"), path))
    for link in root.findall("link"):
        pose, name, seen = np.eye(4), link.get("name", ""), 0
        while name in joints:
            name, own = joints[name]
            pose, seen = own @ pose, seen + 1
            if seen > MOST_LINKS:
                raise input_error("mesh.joints_circle_link", path, get=shown(link.get("name", "")))
        for shape in _shapes(link):
            yield _posed(_geometry(shape, path, load), pose @ _origin(shape.find("origin"), path))


def _sdf(root: Element, path: Path, load: Loaded) -> Iterator[Surface]:
    """Links of the first model; includes and poses relative to other frames are refused."""
    model = root if root.tag == "model" else root.find(".//model")
    if model is None:
        raise InputError("no <model>", "an SDF model", file=path)
    if model.find("include") is not None or model.find("model") is not None:
        raise InputError("a model that includes others", "links of its own", file=path, advice=VERBATIM)
    for link in model.findall("link"):
        pose = _pose(link.find("pose"), path)
        for shape in _shapes(link):
            yield _posed(_geometry(shape, path, load), pose @ _pose(shape.find("pose"), path))


def _shapes(link: Element) -> list[Element]:
    for kind in ("visual", "collision"):
        found = [s for s in link.findall(kind) if s.find("geometry") is not None]
        if found:
            return found
    return []


def _origin(origin: Element | None, path: Path) -> Array:
    if origin is None:
        return np.eye(4)
    at = numbers(origin.get("xyz", "0 0 0"), (3,), "xyz", path)
    return _placed(at, numbers(origin.get("rpy", "0 0 0"), (3,), "rpy", path))


def _pose(pose: Element | None, path: Path) -> Array:
    if pose is None or not (pose.text or "").strip():
        return np.eye(4)
    if pose.get("relative_to"):
        raise input_error("mesh.pose_in_other_frame", path, get=shown(pose.get("relative_to", "")), advice=VERBATIM)
    six = numbers(pose.text, (6,), "pose", path)
    return _placed(six[:3], six[3:])


def _placed(at: tuple[float, ...], rpy: tuple[float, ...]) -> Array:
    from coeflab.law.transforms import rotation

    out = np.eye(4)
    out[:3, :3], out[:3, 3] = rotation(*rpy), at
    return out


def _posed(piece: Surface, pose: Array) -> Surface:
    vertices, faces = piece
    return vertices @ pose[:3, :3].T + pose[:3, 3], faces


def _geometry(shape: Element, path: Path, load: Loaded) -> Surface:
    from manifold3d import Manifold

    from coeflab.bodies.mesh.solids import surface

    geometry = shape.find("geometry")
    form = next(iter(geometry), None) if geometry is not None else None
    if form is None:
        raise InputError("an empty <geometry>", "a shape", file=path, advice=VERBATIM)

    def size(name: str, count: int = 1) -> tuple[float, ...]:
        child = form.find(name)
        return numbers(form.get(name) if child is None else child.text, (count,), f"{form.tag}.{name}", path)

    if form.tag == "box":
        return surface(Manifold.cube(size("size", 3), center=True))
    if form.tag == "cylinder":
        (radius,), (length,) = size("radius"), size("length")
        return surface(Manifold.cylinder(length, radius, radius, AROUND, center=True))
    if form.tag == "sphere":
        return surface(Manifold.sphere(size("radius")[0], AROUND))
    if form.tag == "mesh":
        uri = form.findtext("uri") or form.get("filename") or ""
        factor = form.findtext("scale") or form.get("scale") or "1 1 1"
        vertices, faces = load(_file(uri, path))
        scale = np.array(numbers(factor, (3,), "scale", path))
        return vertices * scale, faces[:, ::-1] if np.prod(scale) < 0.0 else faces
    raise InputError(f"the shape <{form.tag}>", "box, cylinder, sphere or mesh", file=path, advice=VERBATIM)


def _file(uri: str, path: Path) -> Path:
    """A mesh beside the model, or below a folder above it, as package:// and model:// name them."""
    kind, found, rest = uri.rpartition("://")
    if found and kind not in ("package", "model", "file"):
        raise InputError(f"the mesh {shown(uri)}", "a file, package://, model:// or file://", file=path)
    inside = Path(rest)
    if kind == "file" or (not found and inside.is_absolute()):
        return inside
    below = [inside, Path(*inside.parts[1:])] if found else [inside]
    for folder in (path.parent, *path.parent.resolve().parents[:4]):
        for one in below:
            if (there := typed(folder / one)).is_file():
                return there
    raise input_error("mesh.missing_mesh", path, uri=shown(uri))
