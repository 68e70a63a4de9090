"""DARPA SUBOFF from its equations: bow, parallel middle body, afterbody and cap, with sail and stern planes on request.

Source: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Tables 1-3; feet, x aft of the nose. Ring wings are not part of it.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.axisymmetric import graded_nodes
from coeflab.kernels.structured_surface import lofted
from coeflab.kernels.suboff_appendages import Appendage, plane, plane_sections, sail, sail_sections
from coeflab.model.body import Body, Configuration
from coeflab.model.body_file import open_body_file
from coeflab.model.mesh import TriangleMesh
from coeflab.model.meshing import meshed, united
from coeflab.model.shape import Revolution

summary = "SUBOFF from the equations of Groves, Huang and Chang: bare hull, or with sail and stern planes"
citations = ("groves1989",)

Array = NDArray[np.float64]
FOOT = 0.3048
LARGEST_RADIUS = 5.0 / 6.0
BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END = 3.333333, 10.645833, 13.979167, 14.291667
CAP_RADIUS, K0, K1 = 0.1175, 10.0, 44.6244
NODES, GRADING = 96, 4
HULL_PANELS, FEWEST_HULL = 60_000, 64
SAIL, PLANE = (48, 24, 12), (40, 20)

_X = Polynomial([0.0, 1.0])
_BOW = (
    1.126395101 * _X * (0.3 * _X - 1.0) ** 4
    + 0.442874707 * _X**2 * (0.3 * _X - 1.0) ** 3
    + 1.0
    - (0.3 * _X - 1.0) ** 4 * (1.2 * _X + 1.0)
)
_R2, _RK = CAP_RADIUS**2, CAP_RADIUS * K0
_AFTERBODY = Polynomial(
    [
        _R2,
        0.0,
        _RK,
        20.0 - 20.0 * _R2 - 4.0 * _RK - K1 / 3.0,
        -45.0 + 45.0 * _R2 + 6.0 * _RK + K1,
        36.0 - 36.0 * _R2 - 4.0 * _RK - K1,
        -10.0 + 10.0 * _R2 + _RK + K1 / 3.0,
    ]
)(Polynomial([AFTERBODY_END / 3.333333, -1.0 / 3.333333]))
_CAP = _R2 * (1.0 - Polynomial([-44.733333, 3.2]) ** 2)


def _bow(x: Array) -> tuple[Array, Array]:
    """(R/Rmax)^2 and half its slope; the power 1/2.1 makes the slope infinite at the nose itself."""
    p = np.clip(_BOW(x), 0.0, None)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.where(p > 0.0, p ** (1.0 / 1.05 - 1.0) * _BOW.deriv()(x) / 2.1, np.inf)
    return p ** (1.0 / 1.05), half


def _rest(x: Array, square: Polynomial) -> tuple[Array, Array]:
    return np.clip(square(x), 0.0, None), square.deriv()(x) / 2.0


def _piece(x: Array, end: float) -> tuple[Array, Array]:
    if end == BOW_END:
        return _bow(x)
    square = {MIDDLE_END: Polynomial([1.0]), AFTERBODY_END: _AFTERBODY, CAP_END: _CAP}[end]
    return _rest(x, square)


def profile(x: Array) -> tuple[Array, Array]:
    """R and R dR/dx at stations within the hull, ft."""
    ends = (BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END)
    square, half = np.empty_like(x), np.empty_like(x)
    for k, end in enumerate(ends):
        here = np.searchsorted(ends, x).clip(max=3) == k
        square[here], half[here] = _piece(x[here], end)
    return LARGEST_RADIUS * np.sqrt(square), LARGEST_RADIUS**2 * half


def radius(aft: float) -> float:
    """Radius of the bare hull, m.

    Parameters
    ----------
    aft : float
        Distance aft of the nose, m, from 0 to 4.3561 (14.291667 ft).

    Raises
    ------
    InputError
        Ahead of the nose or aft of the tail.
    """
    x = aft / FOOT
    if not -1e-12 <= x <= CAP_END + 1e-12:
        raise InputError(f"x = {aft:g} m aft of the nose", f"0 to {CAP_END * FOOT:.4f} m, where the equations hold")
    return float(FOOT * profile(np.array([x]))[0][0])


def meridian(nodes: int = NODES) -> Revolution:
    """The hull by Gauss-Legendre stations, ``nodes`` on each of the four pieces, graded to the ends of each."""
    joints = (0.0, BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END)
    pieces = []
    for start, end in pairwise(joints):
        stations, weights = graded_nodes(start, end, nodes, GRADING)
        pieces.append((stations, weights, *_piece(stations, end)))
    x, weight, square, half = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return Revolution(
        x=-FOOT * x,
        weight=FOOT * weight,
        radius=FOOT * LARGEST_RADIUS * np.sqrt(square),
        radius_slope=-FOOT * LARGEST_RADIUS**2 * half,
        axis=np.zeros(2),
        length=FOOT * CAP_END,
    )


def appended(with_sail: bool, with_planes: bool) -> Configuration:
    """Integrals of the equations: the hull, and of sail and planes what stands outside it."""
    hull = meridian()
    parts: list[Appendage] = [sail(profile)] if with_sail else []
    parts += [plane(profile)] * 4 if with_planes else []
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

    def remade(panels: int) -> TriangleMesh:
        other = _whole(with_sail, with_planes, max(round(panels * share), FEWEST_HULL))
        return TriangleMesh(other.vertices, other.faces, volume)

    return TriangleMesh(whole.vertices, whole.faces, volume, remade)


def _whole(with_sail: bool, with_planes: bool, hull_panels: int) -> TriangleMesh:
    fine = np.sqrt(hull_panels / HULL_PANELS)
    solids = [meshed(meridian(), hull_panels)]
    if with_sail:
        solids.append(_solid(sail_sections(*_counts(SAIL, fine)), 0.0))
    if with_planes:
        sections = plane_sections(*_counts(PLANE, fine))[:, :, [0, 2, 1]]
        solids += [_solid(sections, turn * np.pi / 2.0) for turn in range(4)]
    return united(solids)


def _counts(finest: tuple[int, ...], fine: float) -> tuple[int, ...]:
    """Even counts along a section, so that its checkerboard of diagonals keeps its symmetry."""
    return tuple(max(2, 2 * round(count * fine / 2.0)) for count in finest)


def _solid(sections: Array, roll: float) -> TriangleMesh:
    """Loops of x aft, breadth and height, ft, about an upright appendage: to m, FRD, and rolled about the axis."""
    vertices, faces = lofted(FOOT * sections * np.array([-1.0, 1.0, -1.0]))
    c, s = np.cos(roll), np.sin(roll)
    return TriangleMesh(vertices @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]).T, faces)


def read(path: Path) -> Body:
    """Read a body.toml whose shape is SUBOFF; ``[hull]`` may say ``sail = true`` and ``planes = true``.

    The bare hull is a body of revolution. With appendages the shape is a mesh, and the configuration ``by_equations``
    still holds exact integrals.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    opened = open_body_file(path, "groves")
    chosen = opened.root.section("hull", required=False)
    with_sail, with_planes = chosen.flag("sail", False), chosen.flag("planes", False)
    chosen.finish()
    shape = mesh(with_sail, with_planes) if with_sail or with_planes else meridian()
    return opened.body(shape, appended(with_sail, with_planes))
