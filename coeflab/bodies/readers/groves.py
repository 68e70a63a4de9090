"""DARPA SUBOFF from its equations: bow, parallel middle body, afterbody and cap, with sail and stern planes on request.

Source: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Tables 1-3; feet, x aft of the nose. Ring wings are not part of it.

Sail and stern planes of DARPA SUBOFF: integrals of what stands outside the hull, and sections to loft a mesh from.

Source: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Tables 2 and 3. All in feet, x aft of the nose. The hull comes in
as a function of x that returns R and R dR/dx.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from itertools import pairwise
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.polynomial import Polynomial

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import ShapedBodyFile
from coeflab.bodies.closed_forms.revolution import graded_nodes
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed, united
from coeflab.bodies.mesh.structured_surface import lofted
from coeflab.bodies.outline import Foil, Outline
from coeflab.bodies.outlining import Trapezoid, radius_towards, round_hull, with_controls
from coeflab.bodies.pieces import Control, Piece, hull_piece
from coeflab.bodies.profiles import FOOT, LARGEST_RADIUS, MIDDLE_END, suboff_meridian, suboff_profile
from coeflab.core.declarations import Declaration, Flag, declared
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array, brief, locked, remembered

Hull = Callable[[Array], tuple[Array, Array]]

SAIL_JOINTS = (3.032986, 3.333333, 3.358507, 3.559028, 4.241319)
SIDE_TOP, SAIL_FOOT = 1.507813, 0.6
HALF_THICKNESS = 0.109375
TRAILING_EDGE, TAPER, AXIS_CHORD = 13.146284, -0.466308, 0.88859
TIP, PLANE_FOOT = 5.0 / 6.0, 0.12
APPENDAGE_NODES, APPENDAGE_GRADING, ROUNDS = 48, 4, 32

_D = Polynomial([0.0, 1.0])
_FORE = (
    2.094759 * 2.0 * _D * (_D - 1.0) ** 4
    + 0.2071781 * _D**2 * (_D - 1.0) ** 3 / 3.0
    + 1.0
    - (_D - 1.0) ** 4 * (4.0 * _D + 1.0)
)
_AFTER = 2.238361 * _D * (_D - 1.0) ** 4 + 3.106529 * _D**2 * (_D - 1.0) ** 3 + 1.0 - (_D - 1.0) ** 4 * (4.0 * _D + 1.0)


@brief
@dataclass(frozen=True, slots=True)
class Appendage:
    """What an appendage adds to the hull, in feet.

    Attributes
    ----------
    volume : float
        Outside the hull.
    moment : (2,) array
        First moments of that volume: x aft of the nose, and height above the axis.
    surface : float
        Its own wetted surface.
    covered : float
        Surface of the hull that it hides.
    """

    volume: float
    moment: Array
    surface: float
    covered: float


def sail_half_thickness(x: Array) -> tuple[Array, Array]:
    """Half thickness b and b db/dx of the sail."""
    d, e = 3.072 * (x - SAIL_JOINTS[0]), (SAIL_JOINTS[4] - x) / 0.6822917
    fore = np.sqrt(np.clip(_FORE(d), 0.0, None)), _FORE.deriv()(d) * 3.072 / 2.0
    after = _AFTER(e), -_AFTER(e) * _AFTER.deriv()(e) / 0.6822917
    ahead, behind = x < SAIL_JOINTS[2], x > SAIL_JOINTS[3]
    share = np.where(ahead, fore[0], np.where(behind, after[0], 1.0))
    slope = np.where(ahead, fore[1], np.where(behind, after[1], 0.0))
    return HALF_THICKNESS * share, HALF_THICKNESS**2 * slope


@cache
def sail(hull: Hull) -> Appendage:
    """The sail: vertical sides on the hull, a cap of half an ellipse as high as a quarter of the local thickness."""
    volume, surface, covered, moment = 0.0, 0.0, 0.0, np.zeros(2)
    turn, turn_weight = graded_nodes(0.0, np.pi, APPENDAGE_NODES)
    for start, end in pairwise(SAIL_JOINTS):
        x, weight = graded_nodes(start, end, APPENDAGE_NODES, APPENDAGE_GRADING)
        (b, slope), (radius, radius_slope) = sail_half_thickness(x), hull(x)
        foot = np.sqrt(radius**2 - b**2)
        area = 2.0 * b * SIDE_TOP - b * foot - radius**2 * np.arcsin(b / radius) + np.pi * b**2 / 4.0
        lift = b * (SIDE_TOP**2 - radius**2) + b**3 / 3.0 + np.pi * b**2 / 4.0 * SIDE_TOP + b**3 / 6.0
        cap = np.sqrt((slope[:, None] / 2.0) ** 2 + b[:, None] ** 2 * (1.0 - 0.75 * np.cos(turn) ** 2)) @ turn_weight
        volume += float(weight @ area)
        moment += np.array([weight @ (area * x), weight @ lift])
        surface += float(weight @ (2.0 * (SIDE_TOP - foot) * np.hypot(b, slope) / b + cap))
        covered += float(weight @ (2.0 * np.arcsin(b / radius) * np.hypot(radius, radius_slope)))
    return Appendage(volume, locked(moment), surface, covered)


def sail_sections(stations: int, levels: int, cap: int) -> Array:
    """(stations + 1, 2 levels + cap + 1, 3) closed loops x, y, height across the sail, from within the hull to its top.

    Parameters
    ----------
    stations : int
        Intervals along the chord.
    levels : int
        Intervals from foot to the top of the side.
    cap : int
        Intervals over the rounded top.
    """
    x = SAIL_JOINTS[0] + (SAIL_JOINTS[4] - SAIL_JOINTS[0]) * _eased(stations)
    b, _ = sail_half_thickness(x)
    up, turn = np.linspace(SAIL_FOOT, SIDE_TOP, levels + 1), np.pi * np.arange(1, cap) / cap
    share = np.concatenate([np.ones(levels + 1), np.cos(turn), -np.ones(levels + 1)])
    rise = np.concatenate([np.zeros(levels + 1), np.sin(turn) / 2.0, np.zeros(levels + 1)])
    foot = np.concatenate([up, np.full(cap - 1, SIDE_TOP), up[::-1]])
    y, height = b[:, None] * share, foot + b[:, None] * rise
    return np.stack([np.broadcast_to(x[:, None], y.shape), y, height], axis=-1)


def _eased(count: int) -> Array:
    """From 0 to 1, dense at both ends, both exact."""
    out: Array = (1.0 - np.cos(np.pi * np.arange(count + 1) / count)) / 2.0
    out[[0, -1]] = 0.0, 1.0
    return out


def _half(q: Array) -> Array:
    """Half thickness over chord of the planes at a share q of the chord."""
    return 0.2969 * np.sqrt(q) - 0.126 * q - 0.3516 * q**2 + 0.2852 * q**3 - 0.1045 * q**4


def _chord(y: Array) -> Array:
    return TAPER * y + AXIS_CHORD


def _foot(hull: Hull, q: Array, share: Array) -> Array:
    """Distance from the axis at which a line along the span leaves the hull; share of the half thickness from -1 to 1."""
    half = _half(q)
    y = np.full(np.broadcast_shapes(q.shape, share.shape), TIP / 2.0)
    for _ in range(ROUNDS):
        radius, _ = hull(TRAILING_EDGE - _chord(y) * (1.0 - q))
        y = np.sqrt(radius**2 - (share * half * _chord(y)) ** 2)
    return y


@cache
def plane(hull: Hull) -> Appendage:
    """One stern plane; its moment counts x alone, since four of them balance about the axis.

    Integrals run along the span, from the hull's surface to the tip, in closed form for every share of the chord and of
    the thickness.
    """
    q, q_weight = graded_nodes(0.0, 1.0, APPENDAGE_NODES, APPENDAGE_GRADING)
    share, share_weight = graded_nodes(0.0, 1.0, APPENDAGE_NODES)
    half, slope = _half(q), (0.14845 / np.sqrt(q) - 0.126 - 0.7032 * q + 0.8556 * q**2 - 0.418 * q**3)
    tip, foot = _chord(np.array(TIP)), _chord(_foot(hull, q[:, None], share))
    second = (tip**3 - foot**3) / (3.0 * TAPER) @ share_weight
    third = (tip**4 - foot**4) / (4.0 * TAPER) @ share_weight
    volume = 2.0 * q_weight @ (half * second)
    along = 2.0 * q_weight @ (half * (TRAILING_EDGE * second - (1.0 - q) * third))
    edge = _chord(_foot(hull, q, np.ones_like(q)))
    stretch = np.sqrt(1.0 + slope**2 + TAPER**2 * (slope * (1.0 - q) + half) ** 2)
    sides = 2.0 * q_weight @ (stretch * (tip**2 - edge**2) / (2.0 * TAPER))
    flat = 2.0 * tip**2 * (q_weight @ half)
    return Appendage(float(volume), locked([float(along), 0.0]), float(sides + flat), _covered(hull))


def _covered(hull: Hull) -> float:
    nose = TRAILING_EDGE - float(_chord(_foot(hull, np.zeros(1), np.zeros(1)))[0])
    x, weight = graded_nodes(nose, TRAILING_EDGE, APPENDAGE_NODES, APPENDAGE_GRADING)
    radius, radius_slope = hull(x)
    angle = np.zeros_like(x)
    for _ in range(ROUNDS):
        chord = _chord(radius * np.cos(angle))
        q = np.clip((x - TRAILING_EDGE) / chord + 1.0, 0.0, 1.0)
        angle = np.arcsin(chord * _half(q) / radius)
    return float(weight @ (2.0 * angle * np.hypot(radius, radius_slope)))


def plane_sections(stations: int, levels: int) -> Array:
    """(stations + 1, 2 levels + 3, 3) closed loops x, distance from the axis, thickness across one stern plane."""
    q = _eased(stations)
    half = np.zeros(stations + 1)
    half[1:-1] = _half(q[1:-1])
    span = np.linspace(PLANE_FOOT, TIP, levels + 1)
    y = np.concatenate([span, [TIP], span[::-1]])
    side = np.concatenate([np.ones(levels + 1), [0.0], -np.ones(levels + 1)])
    x = TRAILING_EDGE - _chord(y) * (1.0 - q[:, None])
    return np.stack([x, np.broadcast_to(y, x.shape), _chord(y) * half[:, None] * side], axis=-1)


summary = "SUBOFF from the equations of Groves, Huang and Chang: bare hull, or with sail and stern planes"
citations = ("groves1989",)
HULL_PANELS, FEWEST_HULL = 60_000, 64
SAIL, PLANE = (48, 24, 12), (40, 20)
TOWED_SAIL, TOWED_PLANE = (96, 16, 16), (80, 12)  # the sides are straight along the span: stations count
PLANES = ("upper", "starboard", "lower", "port")  # each a quarter of a turn about x from the one before


def appended(with_sail: bool, with_planes: bool) -> Configuration:
    """Integrals of the equations: the hull, and of sail and planes what stands outside it."""
    hull = suboff_meridian()
    parts: list[Appendage] = [sail(suboff_profile)] if with_sail else []
    parts += [plane(suboff_profile)] * 4 if with_planes else []
    volume = hull.volume + FOOT**3 * sum(p.volume for p in parts)
    centre = hull.centre_of_volume
    if parts:
        aft, up = FOOT**4 * np.sum([p.moment for p in parts], axis=0)
        centre = (hull.volume * centre - np.array([aft, 0.0, up])) / volume
    names = ["sail"] * with_sail + ["four stern planes"] * with_planes
    return Configuration(
        name="by_equations",
        title=", ".join(["integrals of the equations", *names]),
        volume=volume,
        wetted_surface=hull.integrals.wetted_surface + FOOT**2 * sum(p.surface - p.covered for p in parts),
        centre_of_buoyancy=centre,
        mass=None,
    )


def mesh(with_sail: bool, with_planes: bool, hull_panels: int = HULL_PANELS) -> TriangleMesh:
    """The hull with its appendages as one closed mesh; the exact volume by equations is known to it.

    Parameters
    ----------
    with_sail, with_planes : bool
    hull_panels : int
        On the hull; what is attached has triangles as much larger or smaller than by default as the hull.
    """
    whole = _whole(with_sail, with_planes, hull_panels)
    volume, share = appended(with_sail, with_planes).volume, hull_panels / len(whole.faces)
    return TriangleMesh(whole.vertices, whole.faces, volume, partial(_of_panels, with_sail, with_planes, share, volume))


def _of_panels(with_sail: bool, with_planes: bool, share: float, volume: float | None, panels: int) -> TriangleMesh:
    """The same body on about so many panels; ``share`` of them on the hull."""
    other = _whole(with_sail, with_planes, max(round(panels * share), FEWEST_HULL))
    return TriangleMesh(other.vertices, other.faces, volume)


def _whole(with_sail: bool, with_planes: bool, hull_panels: int) -> TriangleMesh:
    fine = np.sqrt(hull_panels / HULL_PANELS)
    solids = [meshed(suboff_meridian(), hull_panels)]
    if with_sail:
        solids.append(_sail_of(_counts(SAIL, fine)))
    if with_planes:
        solids += [_plane_of(turn, _counts(PLANE, fine)) for turn in range(4)]
    return _joined(tuple(solids))


@remembered(1)
def _joined(solids: tuple[TriangleMesh, ...]) -> TriangleMesh:
    """Their union; many numbers of panels one after the other give the same solids."""
    return united(solids)


def pieces(with_sail: bool, with_planes: bool) -> tuple[Piece, ...]:
    """Hull, sail and planes, each closed; the roots of the appendages lie within the hull."""
    hull = suboff_meridian()
    found = [hull_piece(hull, hull.integrals.wetted_surface, -FOOT * MIDDLE_END)]
    if with_sail:
        chord = FOOT * (SAIL_JOINTS[4] - SAIL_JOINTS[0])
        found.append(Piece("sail", "sail", _sail, FOOT**2 * sail(suboff_profile).surface, chord))
    if with_planes:
        own = plane(suboff_profile)
        foot = float(_foot(suboff_profile, np.array([0.5]), np.zeros(1))[0])
        chord = FOOT * float(_chord(np.array((foot + TIP) / 2.0)))
        found += [
            Piece(f"plane_{name}", "fins", partial(_plane, turn), FOOT**2 * own.surface, chord)
            for turn, name in enumerate(PLANES)
        ]
    return tuple(found)


def outline(with_sail: bool, with_planes: bool, controls: tuple[Control, ...] = ()) -> Outline:
    """Hull, sail and planes as semi-empirical methods see them.

    The sail is a straight foil from the hull's parallel middle body to its top; its tip chord leaves out as much of the
    area as the cap cuts off.

    Parameters
    ----------
    with_sail, with_planes : bool
    controls : tuple of Control
    """
    hull = round_hull(suboff_meridian())
    foils: list[Foil] = []
    if with_sail:
        nose, tail = SAIL_JOINTS[0], SAIL_JOINTS[4]
        x, weight = (np.concatenate(v) for v in zip(
            *(graded_nodes(*ends, APPENDAGE_NODES, APPENDAGE_GRADING) for ends in pairwise(SAIL_JOINTS)), strict=True))  # fmt: skip
        chord, top = tail - nose, SIDE_TOP + HALF_THICKNESS / 2.0
        area = float(weight @ (SIDE_TOP + sail_half_thickness(x)[0] / 2.0 - LARGEST_RADIUS))
        tip_chord = 2.0 * area / (top - LARGEST_RADIUS) - chord
        quarter = -FOOT * (nose + chord / 4.0)
        root, tip = (np.array([quarter, 0.0, -FOOT * height]) for height in (LARGEST_RADIUS, top))
        thickness = 2.0 * HALF_THICKNESS / chord
        foils.append(Foil("sail", root, tip, FOOT * chord, FOOT * tip_chord, thickness, np.zeros(2)))
    if with_planes:
        chords, spread = (
            [FOOT * float(_chord(np.array(y))) for y in (PLANE_FOOT, TIP)],
            2.0 * float(_half(_eased(200)).max()),
        )
        flat = Trapezoid(FOOT * PLANE_FOOT, FOOT * TIP, (chords[0], chords[1]), (-FOOT * TRAILING_EDGE,) * 2)
        for turn, name in enumerate(PLANES):
            way = np.array([(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)][turn])
            found = flat.foil(f"plane_{name}", way, np.zeros(2), spread, radius_towards(hull, way))
            foils += [] if found is None else [found]
    turned, left = with_controls(foils, controls)
    whole = appended(with_sail, with_planes)
    return Outline((hull,), turned, (), (), whole.wetted_surface or 0.0, whole.volume or 0.0, left)


def _sail(panels: int) -> TriangleMesh:
    return _sail_of(_shared(TOWED_SAIL, panels, lambda n: 2 * n[0] * (2 * n[1] + n[2] + 1)))


def _plane(turn: int, panels: int) -> TriangleMesh:
    return _plane_of(turn, _shared(TOWED_PLANE, panels, lambda n: 2 * n[0] * (2 * n[1] + 3)))


@lru_cache(16)  # meshes of one body at many counts share most of these
def _sail_of(counts: tuple[int, ...]) -> TriangleMesh:
    return _solid(sail_sections(*counts), 0.0)


@lru_cache(64)
def _plane_of(turn: int, counts: tuple[int, ...]) -> TriangleMesh:
    return _solid(plane_sections(*counts)[:, :, [0, 2, 1]], turn * np.pi / 2.0)


def _shared(counts: tuple[int, ...], panels: int, triangles: Callable[[tuple[int, ...]], int]) -> tuple[int, ...]:
    return _counts(counts, np.sqrt(panels / triangles(counts)))


def _counts(finest: tuple[int, ...], fine: float) -> tuple[int, ...]:
    """Even counts along a section, so that its checkerboard of diagonals keeps its symmetry."""
    return tuple(max(2, 2 * round(count * fine / 2.0)) for count in finest)


def _solid(sections: Array, roll: float) -> TriangleMesh:
    """Loops of x aft, breadth and height, ft, about an upright appendage: to m, FRD, and rolled about the axis."""
    vertices, faces = lofted(FOOT * sections * np.array([-1.0, 1.0, -1.0]))
    c, s = np.cos(roll), np.sin(roll)
    return TriangleMesh(vertices @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]).T, faces)


@dataclass(frozen=True, slots=True)
class HullKeys(Declaration):
    """What is attached to the hull.

    Attributes
    ----------
    sail, planes : bool
        The sail, and the four stern planes.
    """

    sail: Flag = False
    planes: Flag = False


@dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml whose shape is DARPA SUBOFF.

    Attributes
    ----------
    hull : table
        What is attached to the hull.
    """

    reader: ClassVar[str] = "groves"
    hull: HullKeys = HullKeys()


def read(path: Path) -> Body:
    """Read a body.toml whose shape is SUBOFF; ``[hull]`` may say ``sail = true`` and ``planes = true``.

    The bare hull is a body of revolution. With appendages the shape is a mesh, and the configuration ``by_equations``
    still holds exact integrals.

    Raises
    ------
    InputError
        Everything missing, unknown or of the wrong unit, by file, line and key.
    """
    file = declared(File, read_toml(path))
    with_sail, with_planes = file.hull.sail, file.hull.planes
    shape = mesh(with_sail, with_planes) if with_sail or with_planes else suboff_meridian()
    seen = partial(outline, with_sail, with_planes)
    return file.shaped(path, shape, appended(with_sail, with_planes), pieces(with_sail, with_planes), seen)
