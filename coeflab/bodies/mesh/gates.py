"""What a mesh must be before anything is computed from it.

The repair of a mesh that a person may ask for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.crossing_faces import crossing_faces
from coeflab.bodies.mesh.solids import Solid, solid, surface
from coeflab.bodies.mesh.topology import (
    Filled,
    Labels,
    degenerate,
    edges,
    filled,
    joined,
    oriented,
    repeated,
    sheets,
    shell_volumes,
    shells,
    welded,
)
from coeflab.core.errors import InputError
from coeflab.core.machine import stage
from coeflab.core.texts import input_error
from coeflab.core.types import Array, Faces, brief

MOST_TESTED, MOST_SHELLS = 50_000, 1000
NOTHING, JOINED, OVERLAP, SHEET = 1e-9, 1e-6, 1e-6, 1e-6
SMALL_HOLE = 0.01
NAMED = 3
ROUNDED = 1e-6  # of the size: single precision moves corners by a tenth of it


@brief
@dataclass(frozen=True, slots=True, eq=False)
class SoundMesh:
    """A closed mesh with all faces outward, and what was done or left undone to say so; sheets have water on both sides."""

    vertices: Array
    faces: Faces
    statements: tuple[str, ...]
    sheets: Faces = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))


def examined(vertices: Array, faces: Faces, file: Path, unfilled: str = "") -> SoundMesh:
    """The mesh with equal vertices joined, if it is sound.

    Sound is: no face without an area, none twice, every edge between two faces that run opposite ways, a volume above
    zero in every shell, no shells that overlap, no faces that cross. Crossing is looked for in meshes of up to 50,000
    faces; the statements say so of larger ones.

    Parameters
    ----------
    vertices, faces : (n, 3) and (m, 3) arrays
    file : Path
    unfilled : str
        Holes that were not filled though that was asked for, and why, in words.

    Raises
    ------
    InputError
        The first of these that does not hold, with the way out.
    """
    fail = partial(input_error, file=file)
    stage(f"joining the corners of {len(faces):,} faces")
    vertices, faces = welded(vertices, faces)
    if _thickness(vertices) < SHEET:
        raise fail("mesh.plate")
    stage(f"looking for holes and turned faces among {len(faces):,}")
    twice = int(repeated(faces).sum())
    if twice:
        raise fail("mesh.duplicates", count=twice, of=len(faces))
    border = edges(faces)
    if border.open or border.crowded:
        what = [f"{border.open} edges with one face"] * bool(border.open)
        what += [f"{border.crowded} edges with more than two"] * bool(border.crowded)
        why = "crowded" if not border.open else "unfilled" if unfilled else "open_edges"
        why = "nearly_closed" if why != "unfilled" and _nearly_closed(vertices, faces) else why
        raise fail(f"mesh.{why}", edges=" and ".join(what), unfilled=unfilled, limit=SMALL_HOLE)
    flat = int(degenerate(vertices, faces).sum())
    if flat:
        raise fail("mesh.degenerate", count=flat, of=len(faces))
    if border.turned:
        raise fail("mesh.winding", count=border.turned)
    words: tuple[str, ...] = ()
    if border.shared:
        # Solids that meet in an edge: each gets vertices of its own there, as everything behind this gate expects.
        vertices, faces = surface(as_solid(vertices, faces, fail))
        words = (f"solids that meet in {border.shared} edges taken apart there",)
    stage(f"separating the shells of {len(faces):,} faces")
    count, shell = shells(faces)
    _outward(*shell_volumes(vertices, faces, shell), fail)
    if count > 1:
        _apart(vertices, faces, shell, count, fail)
    if len(faces) > MOST_TESTED:
        words += (f"self-intersection not looked for above {MOST_TESTED} faces",)
    else:
        crossing = crossing_faces(vertices, faces, ROUNDED * float(np.ptp(vertices, axis=0).max()))
        if crossing is None:
            words += ("self-intersection not looked for: too many faces lie close together",)
        elif crossing:
            raise fail("mesh.crossing", count=crossing)
    return SoundMesh(vertices, faces, words)


def _unfilled(found: Filled) -> str:
    """What `filled` left open and why, in words; empty for nothing."""
    words = []
    if found.large:
        sizes = ", ".join(f"{100.0 * x:.3g} %" for x in found.large[:NAMED])
        more = len(found.large) - NAMED
        sizes += f" and {more} more" if more > 0 else ""
        several = f"{len(found.large)} holes" if len(found.large) > 1 else "a hole"
        words.append(f"{several} of {sizes} of the surface, above the limit of {100.0 * SMALL_HOLE:g} %")
    if found.rims.touching:
        words.append(f"rims that touch in a vertex, with {found.rims.touching} edges")
    if found.rims.loose:
        words.append(f"rims that do not close, with {found.rims.loose} edges")
    return "; ".join(words)


def _thickness(vertices: Array) -> float:
    """Smallest over largest size, along the principal axes of the corners."""
    away = vertices - vertices.mean(axis=0)
    sizes = np.ptp(away @ np.linalg.eigh(away.T @ away)[1], axis=0)
    return float(sizes.min() / sizes.max()) if sizes.max() > 0.0 else 0.0


def _nearly_closed(vertices: Array, faces: Faces) -> bool:
    left = joined(vertices, faces, JOINED)[1]
    if not len(left):
        return False
    border = edges(left)
    return not (border.open or border.crowded)


def _outward(volume: Array, area: Array, fail: Callable[..., InputError]) -> None:
    """Every shell encloses something, and from outside."""
    empty = int(np.sum(np.abs(volume) <= NOTHING * area**1.5))
    if empty:
        raise fail("mesh.empty_shells", count=empty, of=len(volume))
    inward = volume < 0.0
    if inward.all():
        raise fail("mesh.inward")
    if inward.any():
        raise fail("mesh.cavity", count=inward.sum(), of=len(volume))


def _boxes(vertices: Array, faces: Faces, shell: Labels, count: int) -> tuple[Array, Array]:
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    for corner in faces.T:
        np.minimum.at(low, shell, vertices[corner])
        np.maximum.at(high, shell, vertices[corner])
    return low, high


def _apart(vertices: Array, faces: Faces, shell: Labels, count: int, fail: Callable[..., InputError]) -> None:
    """Shells do not overlap; the volume that they share would count twice."""
    if count > MOST_SHELLS:
        raise fail("mesh.shells", count=count, most=MOST_SHELLS)
    low, high = _boxes(vertices, faces, shell, count)
    meet = np.all((low[:, None] < high[None]) & (low[None] < high[:, None]), axis=2)
    close = np.argwhere(np.triu(meet, 1))
    solids = {int(k): as_solid(vertices, faces[shell == k], fail) for k in np.unique(close)}
    pairs = [(solids[int(a)], solids[int(b)]) for a, b in close]
    common = [(a ^ b).volume() / min(a.volume(), b.volume()) for a, b in pairs]
    overlapping = sum(c > OVERLAP for c in common)
    if overlapping:
        raise fail("mesh.overlapping", count=count, pairs=overlapping)


def as_solid(vertices: Array, faces: Faces, fail: Callable[..., InputError]) -> Solid:
    """One shell as a solid that can be cut and united."""
    try:
        return solid(*welded(vertices, faces))
    except ValueError as why:
        raise fail("mesh.no_solid", why=why) from None


def sound(
    vertices: Array, faces: Faces, file: Path, *, repair: bool = False, fill: bool = False, open_sheets: bool = False
) -> SoundMesh:
    """The mesh as a person wants it read.

    Parameters
    ----------
    vertices, faces : (n, 3) and (m, 3) arrays
    file : Path
    repair : bool
        See `repaired`; small holes are closed as with ``fill``, unless open surfaces are sheets.
    fill : bool
        Close holes of up to 1 % of the surface each, but for rims that touch in a vertex; faces are then turned alike as well.
    open_sheets : bool
        Take faces with an open edge, and those that have one once they are gone, as sheets with water on both sides.

    Raises
    ------
    InputError
        See `examined`.
    """
    words: tuple[str, ...] = ()
    unfilled = ""
    if fill or (repair and not open_sheets):
        vertices, faces = joined(vertices, faces, JOINED)
        count = len(faces)
        if repair:
            faces = _once(faces)
        single = len(faces)
        turned = oriented(faces)
        done = filled(vertices, faces if turned is None else turned, SMALL_HOLE)
        vertices, faces, unfilled = done.vertices, done.faces, _unfilled(done)
        many = f"{done.number} hole{'s' * (done.number != 1)} of up to {SMALL_HOLE:.0%} of the surface filled"
        words = (many,) if fill or done.number else ()
        words += (f"not filled: {unfilled}",) if unfilled else ()
        words += (f"{count - single} duplicate faces dropped",) if count > single else ()
    thin = np.zeros((0, 3), dtype=np.int64)
    if open_sheets:
        vertices, faces = joined(vertices, faces, JOINED)
        faces = faces[~repeated(faces) & ~degenerate(vertices, faces)]
        loose = sheets(faces)
        thin, faces = faces[loose], faces[~loose]
        turned = oriented(thin) if len(thin) else thin
        if turned is None:
            raise input_error("mesh.one_sided", file)
        corner = vertices[turned]
        area = (
            float(np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1).sum())
            / 2.0
        )
        words += (f"{len(turned)} faces of {area:.4g} (file units squared) are sheets with water on both sides",)
        thin = turned
        if not len(faces):
            return SoundMesh(vertices, faces, words, thin)
    closed = (repaired if repair else examined)(vertices, faces, file, unfilled)
    joint = np.concatenate([closed.vertices, vertices]) if len(thin) else closed.vertices
    return replace(
        closed,
        vertices=joint,
        statements=(*words, *closed.statements),
        sheets=thin + len(closed.vertices) if len(thin) else thin,
    )


def repaired(vertices: Array, faces: Faces, file: Path, unfilled: str = "") -> SoundMesh:
    """The mesh mended as far as that is safe, then examined like any other; the statements say what was done.

    Vertices within 1e-6 of the size are joined; faces that lost their area or came twice go, both of a pair that look at
    each other; faces are turned alike and outward, which fills cavities; shells are united.

    Parameters
    ----------
    vertices, faces : (n, 3) and (m, 3) arrays
    file : Path
    unfilled : str
        As of `examined`.

    Raises
    ------
    InputError
        What remains after that, such as holes.
    """
    words: list[str] = []
    count = len(faces)
    before = len(welded(vertices, faces)[0])
    vertices, faces = joined(vertices, faces, JOINED)
    _say(words, before - len(vertices), "vertices joined")
    if len(faces):
        faces = _once(faces)
    if not len(faces):
        raise input_error("mesh.no_area", file)
    _say(words, count - len(faces), "degenerate or duplicate faces dropped")
    # Where solids meet in an edge, turning faces alike would guess which belong together; wound in balance they need none.
    turned = faces if edges(faces).shared and edges(faces).sound else oriented(faces)
    if turned is not None:
        _say(words, int(np.any(turned != faces, axis=1).sum()), "faces turned")
        faces = turned
    if edges(faces).sound and edges(faces).shared:
        vertices, faces = surface(_whole(vertices, faces, file))
    number, shell = shells(faces)
    inward = shell_volumes(vertices, faces, shell)[0] < 0.0
    if edges(faces).sound:
        faces = np.where(inward[shell][:, None], faces[:, ::-1], faces)
        _say(words, int(inward.sum()), f"of {number} shells turned outward")
        if number > 1 or degenerate(vertices, faces).any():
            vertices, faces = _united(vertices, faces, shell, number, file)
            words.append(
                f"{number} shells united" if number > 1 else "faces without an area merged into their neighbours"
            )
        vertices, faces = _without_slivers(vertices, faces, file)
    found = examined(vertices, faces, file, unfilled)
    return SoundMesh(
        found.vertices, found.faces, (f"repaired: {', '.join(words) or 'nothing to do'}", *found.statements)
    )


def _once(faces: Faces) -> Faces:
    """No face twice: of walls between solids that were glued together none is left, of a shell that is given from both sides one."""
    paired = np.flatnonzero(_facing(faces))
    if not len(paired):
        return faces[~repeated(faces)]
    single = paired[~repeated(faces[paired])]
    count, shell = shells(faces[single])
    ends = np.sort(faces[single][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, edge, number = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    rim = (number[edge.ravel()] == 1).reshape(-1, 3).any(axis=1)
    is_open = np.bincount(shell, rim, count) > 0.0
    wall = _same(faces, faces[single[is_open[shell]]])
    return faces[~wall & ~repeated(faces)]


def _same(faces: Faces, others: Faces) -> NDArray[np.bool_]:
    """Faces on the same corners as one of the others, whichever way round."""
    if not len(others):
        return np.zeros(len(faces), dtype=bool)
    key = np.unique(np.sort(np.concatenate([others, faces]), axis=1), axis=0, return_inverse=True)[1].ravel()
    return np.isin(key[len(others) :], key[: len(others)])


def _facing(faces: Faces) -> NDArray[np.bool_]:
    """Pairs of faces on the same corners that look at each other."""
    turned = np.stack([np.roll(faces, -k, axis=1) for k in range(3)])[np.argmin(faces, axis=1), np.arange(len(faces))]
    count = int(faces.max()) + 1
    key = (turned[:, 0] * count + turned[:, 1]) * count + turned[:, 2]
    back = (turned[:, 0] * count + turned[:, 2]) * count + turned[:, 1]
    return np.isin(key, back)


def _whole(vertices: Array, faces: Faces, file: Path) -> Solid:
    return as_solid(vertices, faces, partial(input_error, file=file))


def _without_slivers(vertices: Array, faces: Faces, file: Path) -> tuple[Array, Faces]:
    """Faces without an area, which a union of near surfaces leaves, merged into their neighbours; the surface moves by rounding."""
    size = float(np.ptp(vertices, axis=0).max())
    for share in (ROUNDED / 10.0, ROUNDED, 10.0 * ROUNDED):
        if not degenerate(vertices, faces).any():
            break
        vertices, faces = surface(_whole(vertices, faces, file).simplify(share * size))
    return vertices, faces


def _united(vertices: Array, faces: Faces, shell: Labels, count: int, file: Path) -> tuple[Array, Faces]:
    """What all shells enclose together."""
    from manifold3d import Manifold, OpType

    result = [_whole(vertices, faces[shell == k], file) for k in range(count)]
    return surface(Manifold.batch_boolean(result, OpType.Add).simplify(0.0))


def _say(found: list[str], count: int, what: str) -> None:
    if count:
        found.append(f"{count} {what}")
