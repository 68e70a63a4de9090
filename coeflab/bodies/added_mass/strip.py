"""Sections along x of a body of revolution or of a mesh, with Lamb's end correction as an option."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.revolution import lamb_end_correction, strip_added_mass
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Revolution, Shape, as_revolution
from coeflab.bodies.stations import joints
from coeflab.bodies.strips import Strips, ellipsoid_correction, strips
from coeflab.core.options import bounded, one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.law.added_mass import AddedMass
from coeflab.law.definiteness import composed

summary = "sections along x, exact for circles, by boundary elements for any shape; end correction none or lamb"
citations = ("newman1977", "bryson1954", "lamb1932")
presets: Mapping[str, Mapping[str, str]] = {"lamb": {"end_correction": "lamb"}}
takes_surface = True
places: Mapping[str, int] = {"lamb": 3, "": 6}
rough_share = 0.8

NONE = "sections only: nothing along {}the axis, ends not corrected"
POOR, SLENDER, COARSE, ROUNDING = 0.005, 3.0, 80, 1e-6
WATER = 0.1  # of the volume, within closed rings: no ellipsoid of that volume has such ends


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the method.

    Attributes
    ----------
    end_correction : str
        ``none``: sections alone. ``lamb``: multiplied by k2 (sideways) and k' (turning) of the spheroid of the same
        length and volume, with its k1 along the axis; for a mesh by those of the ellipsoid of the same length, volume
        and breadth over depth.
    stations : int
        Of a mesh, about; a body of revolution has its own.
    """

    end_correction: str = one_of("none", "none", "lamb")
    stations: int = bounded(96, 16, 2000)


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass by strip theory, about the body's reference point.

    Parameters
    ----------
    body : Body
        A mesh, or a body of revolution about x: a hull form, or a single cylinder, spheroid or sphere along x.
    density : float
        kg/m^3.
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        No shape, or another shape, or a mesh with a section of more than 40 separate contours.
    """
    chosen = parse_options(Options, options or {}, "strip")
    shape, rough = body.require_shape(), False
    corrected = chosen.end_correction == "lamb"
    if isinstance(shape, TriangleMesh):
        *own, statements, rough = _of_mesh(body, shape, chosen.stations, corrected)
    else:
        revolution = as_revolution(shape)
        if revolution is None:
            raise input_error("bodies.mesh_body_revolution", name=body.name)
        *own, statements = _of_revolution(revolution, corrected)
    fine, *coarse = (composed([density * m], [np.eye(3)], [shape.centre_of_volume], body.reference_point) for m in own)
    error = np.abs(fine - coarse[0]) if coarse else None
    method = "strip:lamb" if corrected else "strip"
    return AddedMass(fine, body.reference_point, body.datum, body.name, method, statements, error, rough)


def _of_revolution(shape: Revolution, corrected: bool) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    if not corrected:
        return strip_added_mass(shape.integrals, 1.0), (NONE.format("or about "),)
    k = lamb_end_correction(shape.length, shape.volume)
    words = (
        f"Lamb end correction: k1 {k.axial:.4f}, k2 {k.lateral:.4f}, k' {k.turning:.4f} of the spheroid of the same length "
        "and volume"
    )
    return strip_added_mass(shape.integrals, 1.0, k), (words,)


def _of_mesh(
    body: Body, shape: TriangleMesh, count: int, corrected: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[str, ...], bool]:
    """The matrix about the centre of volume, a coarser one that tells its numerical error, statements, whether it is rough."""
    points = shape.vertices - shape.centre_of_volume
    try:
        places = joints(points, shape.faces)
        found = strips(points, shape.faces, count, places=places)
        coarse = strips(points, shape.faces, count // 2, COARSE, places)
    except ValueError as why:
        raise input_error("bodies.closed_mesh_whose", name=body.name, why=why) from None
    live = np.diag(found.matrix) > ROUNDING * np.diag(found.matrix).max()
    change = float(np.max(np.abs(np.diag(coarse.matrix)[live] / np.diag(found.matrix)[live] - 1.0)))
    words = (
        *_sections(found, shape),
        f"half the stations and {COARSE} elements change the diagonal by {change:.1e} at most",
    )
    rough = _short(shape) or found.trapped > WATER * shape.volume
    if not corrected:
        return found.matrix, coarse.matrix, (NONE.format(""), *words), rough
    half = shape.length / 2.0
    bc = 3.0 * shape.volume / (4.0 * np.pi * half)
    ratio = shape.breadth_over_depth
    k = ellipsoid_correction(half, float(np.sqrt(bc * ratio)), float(np.sqrt(bc / ratio)))
    end = (
        f"Lamb end correction: k1 {k.axial:.4f}, sway {k.sway:.4f}, heave {k.heave:.4f}, pitch {k.pitch:.4f}, yaw {k.yaw:.4f} "
        "of the ellipsoid of the same length, volume and breadth over depth; roll as the sections give it"
    )
    return k.applied(found.matrix, shape.volume), k.applied(coarse.matrix, shape.volume), (end, *words), rough


def _short(shape: Shape) -> bool:
    """Whether sections along x say little: a mesh less than three times as long as wide or deep."""
    return isinstance(shape, TriangleMesh) and shape.length < SLENDER * float(shape.extents[1:].max())


def _sections(found: Strips, shape: TriangleMesh) -> tuple[str, ...]:
    """What was cut, and how well the sections add up to the volume of the mesh."""
    off = found.volume / shape.volume - 1.0
    kinds = {"ellipses": found.ellipses, "rectangles": found.rectangles, "by boundary elements": found.others}
    words = [f"{found.count} sections: {', '.join(f'{n} {kind}' for kind, n in kinds.items() if n)}"]
    words.append(
        f"their volume over the mesh's, minus one: {off:+.1e}" + ("; raise stations" if abs(off) > POOR else "")
    )
    if _short(shape):
        slender = shape.length / float(shape.extents[1:].max())
        words.append(f"{slender:.2g} times as long as wide or deep: not slender, the sections are a rough guide")
    if found.trapped > 0.0:
        ends = "; the ends of a ring are not those of an ellipsoid: along the axis a rough guide"
        more = ends if found.trapped > WATER * shape.volume else ""
        words.append(f"{found.trapped:.4g} m^3 of water within closed rings moves sideways with the body{more}")
    return tuple(words)
