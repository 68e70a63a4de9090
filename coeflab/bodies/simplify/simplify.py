"""A mesh as cylinders, plates, ellipsoids and boxes: cut into bodies, each replaced by the form that it resembles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.mesh import solids
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.shape import THIN, Faceted, Part, Parts
from coeflab.bodies.simplify.boxes import NamedBox
from coeflab.bodies.simplify.convex_pieces import convex_pieces
from coeflab.bodies.simplify.part_forms import Likeness, likeness
from coeflab.bodies.simplify.seams import patches
from coeflab.bodies.simplify.segmentation import segments, without_overlap
from coeflab.bodies.simplify.simplification import SIMPLIFIED_FACES, Simplification, SimplifiedPart
from coeflab.bodies.simplify.volume_forms import Piece
from coeflab.core.errors import InputError, shown
from coeflab.core.machine import one_thread
from coeflab.core.provenance import Source
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.law.transforms import angles, rotation, snapped

MOST_FACES, DRAWN_FACES = 1_000_000, 20_000
SNAP, SNAP_CUT = np.radians(0.3), np.radians(2.0)
SNAP_OFFSET = 5e-4
ROUNDING = 1e-9
RESOLUTION = 1e-5
PLURAL = {"box": "boxes", "revolution": "bodies of revolution", "mesh": "meshes"}
SECTORS = ("starboard", "starboard_bottom", "bottom", "port_bottom", "port", "port_top", "top", "starboard_top")
SLIVERS, REMNANT, HAIR, CHIPS = 2e-4, 0.2, 1e-6, 0.01
MOST_PARTED, MANY, WHOLLY = 20_000, 60, 0.97
SLICED = 0.5  # of a plate's area: more of it lies inside the body that it was cut from


@brief
@dataclass(frozen=True, slots=True)
class _Piece:
    """A body of the mesh before it has a form."""

    solid: solids.Solid
    name: str
    cut: bool
    shell: int = -1  # which one it was cut from; none where a box drew it


@one_thread()
def simplify(
    body: Body, boxes: Sequence[NamedBox] = (), expected: int | None = None, convex: bool = False
) -> Simplification:
    """Replace a mesh by simple parts.

    Parameters
    ----------
    body : Body
        Whose shape is a mesh, or a body of revolution, which is meshed first.
    boxes : sequence of NamedBox
        What is inside a box becomes a part of that name, before anything else is cut; what little it leaves between
        itself and the hull goes with it.
    expected : int, optional
        How many parts there must be.
    convex : bool
        Cut what no form is like into nearly convex pieces (`convex_pieces`); a named box stays one part.

    Raises
    ------
    InputError
        Simple parts already, a surface that is not closed, sheets, a shell that looks inward, a box that holds nothing, another number
        of parts than expected, nothing but plates, convex pieces without the package vhacdx.
    """
    shape = body.require_shape()
    if isinstance(shape, Parts):
        raise InputError(f"{body.name}, which is made of simple parts already", "a mesh, or a body given by equations")
    mesh = shape if isinstance(shape, TriangleMesh) else meshed(shape, DRAWN_FACES)
    if len(mesh.sheets):
        advice = "coeflab added-mass and coeflab vehicle take its sheets as they are; --fill closes small holes."
        raise InputError("a mesh with sheets of no thickness", "a closed surface", advice=advice)
    whole, statements = _whole(mesh)
    if mesh is not shape:
        statements.insert(0, f"meshed from its equations with {len(mesh.faces)} faces")
    _refuse_idle_boxes(boxes, mesh)
    found, unassigned, shared, shells = _pieces(whole, boxes)
    if shared > SLIVERS * mesh.volume:
        statements.append(f"shells overlap by {shared:.4g} m^3, which goes to the larger one")
    likes = [likeness(p.solid) for p in found]
    found, likes, missing_volume, words = _parted(found, likes, () if boxes else shells)
    unassigned += missing_volume
    statements += words
    if convex:
        found, likes, missing_volume, words = _convex(found, likes)
        unassigned += missing_volume
        statements += words
    unassigned = unassigned if abs(unassigned) > ROUNDING * mesh.volume else 0.0
    largest = max(range(len(found)), key=lambda k: found[k].solid.volume())
    likes[largest] = _no_thick_plate(likes[largest], found[largest].solid.volume())
    if all(like.kind == "plate" for like in likes):
        raise input_error("bodies.nothing_but_plates")
    if expected is not None and len(found) != expected:
        raise input_error(
            "bodies.parts_parts_says", count_of_found=len(found), counted=", ".join(_counted(likes)), expected=expected,
        )  # fmt: skip
    length = float(mesh.extents.max())
    parts = _named([_part(p, like, length) for p, like in zip(found, likes, strict=True)])
    result = Parts(tuple(p.part for p in parts))
    return Simplification(_body(body, result), result, mesh, parts, unassigned, tuple(statements))


def _no_thick_plate(like: Likeness, volume: float) -> Likeness:
    """What a body is like: it is no plate, whose volume and edges do not count, unless it is really thin."""
    if like.kind != "plate":
        return like
    thickness = volume / (like.sizes[0] * like.sizes[1] * min(like.sizes))
    if thickness <= THIN:
        return like
    return replace(like, clear=False, reason=f"{like.reason}; the body itself is a plate only up to {THIN:g}")


def _whole(mesh: TriangleMesh) -> tuple[solids.Solid, list[str]]:
    try:
        whole = solids.solid(mesh.vertices, mesh.faces)
    except ValueError as why:
        raise InputError(str(why), "a closed surface", advice="Repair the mesh first.") from None
    if len(mesh.faces) <= MOST_FACES:
        return whole, []
    fewer, moved = solids.simplified(whole, SIMPLIFIED_FACES)
    change = fewer.volume() / whole.volume() - 1.0
    words = f"{len(mesh.faces)} faces decimated to {fewer.num_tri()}: surface moved by at most {moved:.2g} m, volume "
    return fewer, [f"{words}{100.0 * change:+.3f} %"]


def _refuse_idle_boxes(boxes: Sequence[NamedBox], mesh: TriangleMesh) -> None:
    names = [b.name for b in boxes]
    for b in boxes:
        if names.count(b.name) > 1:
            raise InputError(f"two boxes called {shown(b.name)}", "one name for each box")
        if not np.any(np.all((mesh.vertices >= b.low) & (mesh.vertices <= b.high), axis=1)):
            low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
            reach = ", ".join(f"{axis} {a:.4g} to {z:.4g}" for axis, a, z in zip("xyz", low, high, strict=True))
            raise input_error("bodies.box_holds_vertex", name=shown(b.name), reach=reach)


def _boxed(whole: solids.Solid, boxes: Sequence[NamedBox]) -> tuple[list[_Piece], solids.Solid]:
    """What the boxes hold, in their order, and the rest.

    Boxes shrink by a hair, so that a side drawn on a flat face of the mesh does not take that face along as a skin.
    """
    out, rest, least = [], whole, SLIVERS * whole.volume()
    for b in boxes:
        hair = HAIR * float(np.ptp([b.low, b.high], axis=0).max())
        block = solids.box(np.add(b.low, hair), np.subtract(b.high, hair))
        inside = rest ^ block
        if inside.volume() <= least:
            raise InputError(f"the box {shown(b.name)}, which contains next to no volume", "a box around a part")
        out.append(_Piece(inside, b.name, False))
        rest = rest - block
    return out, rest


def _remnant_of(part: solids.Solid, boxes: Sequence[NamedBox], boxed: Sequence[_Piece]) -> int | None:
    """The box that cut an attachment and left this little of it between itself and the hull: under a fifth."""
    found = part.bounding_box()
    for k, b in enumerate(boxes):
        reach = HAIR * float(np.ptp([b.low, b.high], axis=0).max())
        touches = np.all(np.greater(found[3:], np.subtract(b.low, reach)) & np.less(found[:3], np.add(b.high, reach)))
        if touches and part.volume() < REMNANT * boxed[k].solid.volume():
            return k
    return None


def _pieces(whole: solids.Solid, boxes: Sequence[NamedBox]) -> tuple[list[_Piece], float, float, list[solids.Solid]]:
    """Bodies, named boxes first; the volume of the slivers; the volume that shells shared; the shells."""
    least = SLIVERS * whole.volume()
    out, rest = _boxed(whole, boxes)
    shells = solids.pieces(rest)
    if any(s.volume() < -least for s in shells):
        raise input_error("bodies.shell_looks_inward")
    alone = [p for s in without_overlap(shells) for p in solids.pieces(s)]
    shared = sum(s.volume() for s in shells) - sum(p.volume() for p in alone)
    unassigned = 0.0
    for k, shell in enumerate(alone):
        if shell.volume() <= least:
            unassigned += shell.volume()
            continue
        cut = segments(shell, least / shell.volume())
        for part, attached in zip(cut.bodies, cut.cut, strict=True):
            box = _remnant_of(part, boxes, out) if attached else None
            if box is None:
                out.append(_Piece(part, "", attached, k))
            else:
                out[box] = replace(out[box], solid=out[box].solid + part)
        unassigned += cut.unassigned
    if not out:
        raise InputError("nothing but slivers", "at least one body")
    return out, unassigned, shared, alone


def _parted(
    found: list[_Piece], likes: list[Likeness], shells: Sequence[solids.Solid]
) -> tuple[list[_Piece], list[Likeness], float, list[str]]:
    """Shells parted along their seams where that gives more forms, and all of them forms; what is like nothing parted along
    its seams, or along faces that meet inward, where all of it is forms then. With the volume that became slivers.
    """
    out, forms, missing_volume, words = list[_Piece](), list[Likeness](), 0.0, list[str]()
    members: dict[int, list[int]] = {}
    for k, piece in enumerate(found):
        members.setdefault(piece.shell, []).append(k)
    for shell, own_numbers in members.items():
        pieces, own = [found[k] for k in own_numbers], [likes[k] for k in own_numbers]
        seamed = None
        if 0 <= shell < len(shells):
            whole = shells[shell]
            seamed = _tried(whole, patches, len(own) if all(like.clear for like in own) else 1)
            if seamed is not None:
                words.append(_refusal(whole, seamed[0], "seams"))
                missing_volume += sum(p.solid.volume() for p in pieces) - sum(p.volume() for p in seamed[0])
                pieces, own = [_Piece(p, "", False, shell) for p in seamed[0]], seamed[1]
        for piece, like in zip(pieces, own, strict=True):
            parted, how = None, "seams"
            if not like.clear and not piece.name:
                parted = _tried(piece.solid, patches, 1) if len(own_numbers) > 1 else None
                if parted is None:
                    parted, how = _tried(piece.solid, _by_notches, 1), "faces that meet inward"
            if parted is None:
                out.append(piece)
                forms.append(like)
                continue
            words.append(_refusal(piece.solid, parted[0], how))
            missing_volume += piece.solid.volume() - sum(p.volume() for p in parted[0])
            out += [replace(piece, solid=p) for p in parted[0]]
            forms += parted[1]
    return out, forms, missing_volume, words


def _refusal(whole: solids.Solid, parts: list[solids.Solid], how: str) -> str:
    return f"a body of {whole.volume():.5g} m^3 parted along {how} into {len(parts)} forms"


def _tried(
    whole: solids.Solid, way: Callable[[solids.Solid], list[solids.Solid]], more_than: int
) -> tuple[list[solids.Solid], list[Likeness]] | None:
    """More parts than so many, all of them forms but for chips, that fill the solid; else None."""
    if whole.num_tri() > MOST_PARTED:
        return None
    least = CHIPS * whole.volume() / MANY
    parts = [p for p in way(whole) if p.volume() > least]
    if not more_than < len(parts) <= MANY:
        return None
    if abs(sum(p.volume() for p in parts) / whole.volume() - 1.0) > 1.0 - WHOLLY:
        return None
    likes = [likeness(p) for p in parts]
    if way is patches:
        parts, likes = _notched_too(parts, likes)
    else:
        likes = [_no_slice(like, part, whole) for like, part in zip(likes, parts, strict=True)]
    largest = max(range(len(parts)), key=lambda k: parts[k].volume())
    likes[largest] = _no_thick_plate(likes[largest], parts[largest].volume())
    good = sum(p.volume() for p, like in zip(parts, likes, strict=True) if like.clear)
    return (parts, likes) if good > WHOLLY * whole.volume() else None


def _no_slice(like: Likeness, part: solids.Solid, whole: solids.Solid) -> Likeness:
    """What a piece cut along planes is like: it is no plate where the cut, and not the body's surface, is one of its sides."""
    if like.kind != "plate":
        return like
    within = (part.surface_area() + (whole - part).surface_area() - whole.surface_area()) / 2.0
    if within <= SLICED * like.sizes[0] * like.sizes[1]:
        return like
    return replace(like, clear=False, reason=f"{like.reason}; a slice, which the body goes on from")


def _notched_too(parts: list[solids.Solid], likes: list[Likeness]) -> tuple[list[solids.Solid], list[Likeness]]:
    """What came out of seams and is like nothing, parted along faces that meet inward."""
    out, forms = list[solids.Solid](), list[Likeness]()
    for part, like in zip(parts, likes, strict=True):
        more = None if like.clear else _tried(part, _by_notches, 1)
        out += [part] if more is None else more[0]
        forms += [like] if more is None else more[1]
    return out, forms


def _by_notches(of: solids.Solid) -> list[solids.Solid]:
    return convex_pieces(of, by_notches=True)


def _convex(found: list[_Piece], likes: list[Likeness]) -> tuple[list[_Piece], list[Likeness], float, list[str]]:
    """Pieces and their forms, those that are like nothing cut further; volume that became slivers; what was done."""
    out, forms, missing_volume, words = [], [], 0.0, []
    for piece, like in zip(found, likes, strict=True):
        if like.clear or piece.name:
            out.append(piece)
            forms.append(like)
            continue
        try:
            least = CHIPS * piece.solid.volume()
            parts = [p for p in convex_pieces(piece.solid) if p.volume() > least]
        except ImportError:
            raise input_error("bodies.split_convex_without") from None
        missing_volume += piece.solid.volume() - sum(p.volume() for p in parts)
        words.append(
            f"what matches no form, {piece.solid.volume():.5g} m^3, cut into {len(parts)} nearly convex pieces"
        )
        out += [replace(piece, solid=p) for p in parts]
        forms += [likeness(p) for p in parts]
    return out, forms, missing_volume, words


def _part(piece: _Piece, like: Likeness, length: float) -> SimplifiedPart:
    """The form in round numbers: sizes to 1e-5 of the body's length, angles to 0.01 deg, near-right angles right."""
    surface = solids.surface(piece.solid)
    own = Piece.of(surface)
    if not like.clear:
        form, centre = Faceted.about_its_centre(TriangleMesh(*surface))
        part = Part(piece.name, form, centre, np.eye(3))
        areas, extents = own.projected(np.eye(3)), own.extents(np.eye(3))
        return SimplifiedPart(part, like, own.volume, areas, extents, piece.cut, 0.0, surface).with_fit()
    decimals = int(np.ceil(-np.log10(RESOLUTION * length)))
    turn = snapped(like.rotation, SNAP_CUT if piece.cut or piece.name else SNAP)
    turned = float(np.arccos(np.clip((np.trace(turn.T @ like.rotation) - 1.0) / 2.0, -1.0, 1.0)))
    turn = rotation(*(np.radians(np.round(np.degrees(a), 2)) for a in angles(turn)))
    centre = np.where(np.abs(like.centre) < np.array([0.0, 1.0, 1.0]) * SNAP_OFFSET * length, 0.0, like.centre)
    finest = 100.0 * RESOLUTION * length
    sizes = tuple(float(round(s, decimals) if s > finest else f"{s:.3g}") for s in like.sizes)
    if like.form == "revolution":
        sizes = tuple(float(round(s, decimals)) + 0.0 for s in like.sizes)
    result = replace(like, sizes=sizes).built
    part = Part(piece.name, result, np.asarray(np.round(centre, decimals) + 0.0), turn)
    return SimplifiedPart(
        part, like, own.volume, own.projected(turn), own.extents(turn), piece.cut, turned, surface
    ).with_fit()


def _named(parts: list[SimplifiedPart]) -> tuple[SimplifiedPart, ...]:
    """Hull first, then from fore to aft and from port to starboard; names by form and side unless a box gave one."""
    hull = max(parts, key=lambda p: p.volume)
    rest = sorted(
        (p for p in parts if p is not hull), key=lambda p: tuple(np.round([-1.0, 1.0, 1.0] * p.part.centre, 3))
    )
    given = {p.part.name for p in parts}
    names = [p.part.name or ("hull" if p is hull and "hull" not in given else _place(p, hull)) for p in (hull, *rest)]
    out = []
    for i, (p, name) in enumerate(zip((hull, *rest), names, strict=True)):
        numbered = name if names.count(name) == 1 or p.part.name else f"{name}_{names[: i + 1].count(name)}"
        out.append(replace(p, part=replace(p.part, name=numbered)))
    return tuple(out)


def _place(p: SimplifiedPart, hull: SimplifiedPart) -> str:
    """``plate_port``: the form, and where it lies about the hull's axis, in eighths of the girth; else fore or aft."""
    turn = hull.part.rotation if hull.part.rotation[0, 0] > 0.7 else np.eye(3)
    offset = turn.T @ (p.part.centre - hull.part.centre)
    half = hull.part.form.half_extents(turn.T @ hull.part.rotation)
    if np.hypot(offset[1], offset[2]) < 0.2 * max(half[1:]):
        return f"{p.likeness.kind}_{'fore' if offset[0] > 0.0 else 'aft'}"
    return f"{p.likeness.kind}_{SECTORS[round(np.arctan2(offset[2], offset[1]) / (np.pi / 4.0)) % 8]}"


def _counted(likes: Sequence[Likeness]) -> list[str]:
    forms = [like.kind for like in likes]
    return [f"{forms.count(f)} {PLURAL.get(f, f + 's') if forms.count(f) > 1 else f}" for f in dict.fromkeys(forms)]


def _body(body: Body, shape: Parts) -> Body:
    inputs_table = "; ".join(f"{f.name}, sha256 {f.sha256}" for f in body.files)
    source = Source(body.source.citation, body.source.place, f"coeflab simplify of {inputs_table}", "computed")
    computed = Configuration(
        "by_parts", "sum of the parts; overlaps count twice", shape.volume, None, shape.centre_of_volume, None
    )
    return replace(
        body, name=f"{body.name}_simplified", title=f"{body.title or body.name}, simplified", configurations=(computed,),
        source=source, shape=shape, measured=(),
    )  # fmt: skip
