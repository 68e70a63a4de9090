"""The body as a solver gets it: one closed surface whose triangles know which patch they belong to."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.images import MIRRORS, QUARTER, same
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import united
from coeflab.bodies.mesh.topology import edges
from coeflab.bodies.pieces import HULL, STERN, Piece, mesh_piece
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, Faces, brief, locked

Index = NDArray[np.int64]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TowedBody:
    """A closed surface with named patches, about the reference point of its moments.

    Attributes
    ----------
    body : Body
    vertices : (n, 3) array
        m, FRD, from the **reference point**, which is the origin of the cases.
    faces : (m, 3) array of int
        Counter-clockwise seen from the water.
    patches : tuple of str
        ``hull``, ``stern``, ``sail``, ``fins``, or the names of the body's parts.
    patch : (m,) array of int
        Of each face, an index into ``patches``.
    chord : mapping of str to float
        Of each appendage, its mean chord, m; of the hull and of a bare body, its length. Grid sizes come from them.
    mirrors : (3,) tuple of bool
        Whether the body is its own mirror image in the planes x = 0, y = 0, z = 0 through the origin.
    fourfold : bool
        Whether a quarter of a turn about x leaves the body as it is.
    """

    body: Body
    vertices: Array
    faces: NDArray[np.int64]
    patches: tuple[str, ...]
    patch: NDArray[np.int64]
    chord: Mapping[str, float] = field(default_factory=dict)
    mirrors: tuple[bool, bool, bool] = (False, False, False)
    fourfold: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", locked(self.vertices))
        object.__setattr__(self, "faces", locked(self.faces, np.int64))
        object.__setattr__(self, "patch", locked(self.patch, np.int64))
        object.__setattr__(self, "chord", MappingProxyType(dict(self.chord)))

    @property
    def length(self) -> float:
        """Over all along x, m."""
        return float(np.ptp(self.vertices[:, 0]))


PANELS = 100_000  # of the whole surface, where it is made from equations
FEWEST = 64
DIGITS = 9  # of coordinates: a nanometre, in the file as in memory
WORD = re.compile(r"[^A-Za-z0-9_.+-]")
STRAIGHT: Mapping[str, float] = MappingProxyType({})


def towed(
    body: Body, reference_point: Array, controls: Mapping[str, float] = STRAIGHT, panels: int = PANELS
) -> TowedBody:
    """The closed surface of a body with its patches, about the reference point, with its controls turned.

    Appendages are united with the hull and keep their names; a gap that a turned control opens at its root is not there.

    Parameters
    ----------
    body : Body
    reference_point : (3,) array
        m, FRD, from the body's datum; the origin of the cases.
    controls : mapping of str to float
        Angle of each control by its name, rad; an absent one is at zero.
    panels : int
        About how many triangles, where the surface is made from equations; a mesh file is taken as it is.

    Raises
    ------
    InputError
        A body without a closed surface: particulars only, plates without thickness; a control that the body does not have.
    """
    pieces, surfaces, from_file = _placed(body, controls, panels)
    origin = np.asarray(reference_point, dtype=float)
    vertices, faces, which = _tidied(*_united(body, surfaces, origin))
    _require_closed(body, faces)
    patches, patch, chord = _patches(pieces, surfaces, vertices[faces].mean(axis=1) + origin, which)
    x, y, z = (same(surfaces, origin, turn, from_file) for turn in MIRRORS)
    fourfold = same(surfaces, origin, QUARTER, from_file)
    return TowedBody(body, vertices, faces, patches, patch, chord, (x, y, z), fourfold)


@functools.lru_cache(maxsize=1)  # every mesh of a tow has the same
def stl(towed: TowedBody) -> bytes:
    """The surface as an ASCII STL, one solid a patch, m; the same bytes for the same surface."""
    corners = towed.vertices[towed.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1)[:, None]
    normal = np.round(np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0), 6) + 0.0
    rows = np.hstack([normal, corners.reshape(-1, 9)])
    facet = (
        "facet normal %.6f %.6f %.6f\nouter loop\n"
        + f"vertex %.{DIGITS}f %.{DIGITS}f %.{DIGITS}f\n" * 3
        + "endloop\nendfacet\n"
    )
    out = []
    for k, name in enumerate(towed.patches):
        own = rows[towed.patch == k]
        out.append(f"solid {name}\n" + (facet * len(own)) % tuple(own.ravel()) + f"endsolid {name}\n")
    return "".join(out).encode()


def _placed(
    body: Body, controls: Mapping[str, float], panels: int
) -> tuple[tuple[Piece, ...], list[TriangleMesh], bool]:
    """The pieces, their surfaces from the datum with controls turned, and whether these are what a file says."""
    known = tuple(dict.fromkeys(control.name for control in body.controls))
    for name in controls:
        if name not in known:
            advice = "" if known else "Add [[control]] to its body.toml: which parts turn about which hinge."
            raise InputError(f"no control {shown(name)} of {body.name}", f"one of {', '.join(known) or 'none'}",
                             advice=advice)  # fmt: skip
    for name, angle in controls.items():
        if not abs(angle) <= np.pi / 2.0:
            raise InputError(f"{name} at {angle:g} rad", "an angle within 90 deg", advice="A bare number is in rad.")
    shape = body.require_shape()
    pieces = body.pieces
    if body.mesh is not None:  # what the parts stand for
        shape, _ = body.mesh.read()
        pieces = (mesh_piece(shape, body.mesh),)
    _require_turnable(body, pieces, controls)
    if panels < FEWEST * len(pieces):
        raise InputError(f"{panels} triangles", f"{FEWEST * len(pieces)} at least, {FEWEST} a part", column="panels")
    share = np.sqrt([piece.area for piece in pieces])
    counts = np.maximum(panels * share / share.sum(), FEWEST).astype(int)
    surfaces = []
    for piece, count in zip(pieces, counts, strict=True):
        surface = piece.surface(int(count))
        for control in body.controls:
            if piece.name in control.parts and controls.get(control.name):
                turned = control.turned(surface.vertices, controls[control.name])
                surface = TriangleMesh(turned, surface.faces)
        surfaces.append(surface)
    return pieces, surfaces, isinstance(shape, TriangleMesh) and shape.remade is None


def _require_turnable(body: Body, pieces: tuple[Piece, ...], controls: Mapping[str, float]) -> None:
    """Refuse an angle of what is a fin of a mesh in one piece: estimates see it, but nothing can be cut off and turned."""
    own = {piece.name for piece in pieces}
    for control in body.controls:
        if controls.get(control.name) and not own & set(control.parts):
            parts = ", ".join(control.parts)
            raise InputError(f"{control.name} turns {parts}, which {body.name} has in one piece with its hull",
                             "a part of its own", column="control", advice="Give the fin as a part in body.toml.")  # fmt: skip


def _united(body: Body, surfaces: list[TriangleMesh], origin: Array) -> tuple[Array, Faces, Index]:
    """Vertices from the origin, faces, and the piece that each face is of."""
    if len(surfaces) == 1:
        return surfaces[0].vertices - origin, surfaces[0].faces, np.zeros(len(surfaces[0].faces), dtype=np.int64)
    try:
        return united([(s.vertices - origin, s.faces) for s in surfaces])
    except ValueError as why:
        raise InputError(f"{body.name}: {why}", "parts of closed surfaces") from None


def _tidied(vertices: Array, faces: Faces, which: Index) -> tuple[Array, Faces, Index]:
    """Coordinates of a nanometre, faces without an edge of less than that gone; sorted, whatever order they came in."""
    places, number = np.unique(np.round(vertices, DIGITS) + 0.0, axis=0, return_inverse=True)
    corners = number.reshape(-1)[faces]
    whole = np.all(corners != np.roll(corners, 1, axis=1), axis=1)
    corners, which = corners[whole], which[whole]
    first = np.argmin(corners, axis=1)[:, None]
    corners = np.take_along_axis(corners, (first + np.arange(3)) % 3, axis=1)
    order = np.lexsort((corners[:, 2], corners[:, 1], corners[:, 0], which))
    return places, corners[order], which[order]


def _require_closed(body: Body, faces: Faces) -> None:
    border = edges(faces)
    if not border.sound:
        count = border.open + border.crowded + border.turned
        raise input_error("tow.surface_closed_edges", name=body.name, count=count)


def _patches(
    pieces: tuple[Piece, ...], surfaces: list[TriangleMesh], middles: Array, which: Index
) -> tuple[tuple[str, ...], Index, dict[str, float]]:
    """Names of the patches that have faces, the patch of each face, and chords.

    Parameters
    ----------
    pieces : tuple of Piece
    surfaces : list of TriangleMesh
        Theirs, from the datum.
    middles : (m, 3) array
        Of the faces, from the datum.
    which : (m,) array of int
        The piece of each face.
    """
    label = np.empty(len(which), dtype=object)
    chords: dict[str, list[float]] = {}
    for k, (piece, surface) in enumerate(zip(pieces, surfaces, strict=True)):
        own = which == k
        if not np.any(own):
            raise input_error("tow.part_lies_wholly", name=shown(piece.name))
        label[own], found = _labelled(piece, surface, middles[own])
        for name, chord in found.items():
            chords.setdefault(name, []).append(chord)
    present = {name: k for k, name in enumerate(name for name in chords if np.any(label == name))}
    patch = np.array([present[name] for name in label], dtype=np.int64)
    return tuple(present), patch, {name: float(np.mean(chords[name])) for name in present}


def _labelled(piece: Piece, surface: TriangleMesh, middles: Array) -> tuple[NDArray[Any], dict[str, float]]:
    """The patch of each face of a piece, and chords by patch: of a named region its extent along x."""
    names, region = piece.regions(middles) if piece.regions else ((), np.zeros(0, dtype=np.int64))
    if names:
        words = [WORD.sub("_", name) for name in names]
        extents = (float(np.ptp(middles[region == k, 0])) for k in range(len(names)))
        chord = {w: piece.chord if w in (HULL, STERN) else e for w, e in zip(words, extents, strict=True)}
        return np.array(words, dtype=object)[region], chord
    word = WORD.sub("_", piece.patch)
    label = np.full(len(middles), word, dtype=object)
    if piece.stern is None:
        return label, {word: piece.chord}
    rings = np.unique(surface.vertices[:, 0])
    label[middles[:, 0] < rings[np.argmin(np.abs(rings - piece.stern))]] = STERN
    return label, {word: piece.chord, STERN: piece.chord}
