"""One body's added mass by several methods, side by side, and which of them to use.

Mirror planes of a body and what they say about its added-mass matrix.

The mirror planes of a body's shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Ellipsoid, Part, Parts, Revolution, Shape
from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, Faces, brief
from coeflab.law.added_mass import AddedMass
from coeflab.law.symbols import COMPONENTS, MOTIONS

# Signs of u v w p q r under the mirror that turns x, y or z round: velocities are polar, rates axial vectors.
SIGNS = np.array([[-1, 1, 1, 1, -1, -1], [1, -1, 1, -1, 1, -1], [1, 1, -1, -1, -1, 1]])
INNER, OUTER = 1.0 / 6.0, 1.0 / 2.0
WEIGHTS = np.array([-0.8, 0.45, 0.45, 0.45, 0.45])


def asymmetries(vertices: Array, faces: Faces) -> Array:
    """How far a closed surface is from its mirror images in x, y and z through its centre of volume, shape (3,).

    The largest volume moment up to the third degree that a mirror plane would make vanish, in coordinates of unit second
    moment, over the volume: zero for a symmetric body however it is meshed.

    Notes
    -----
    Necessary, not sufficient: a body that only higher moments tell from its image, such as one of canted fins all alike,
    passes. Tetrahedra from the centre to the faces, each by the rule of degree 3 of Keast (1986) with five points.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    sixth = np.einsum("ij,ij->i", a - vertices[0], np.cross(b - vertices[0], c - vertices[0])) / 6.0
    volume = sixth.sum()
    centre = sixth @ (a + b + c + vertices[0]) / (4.0 * volume)
    a, b, c = a - centre, b - centre, c - centre
    signed = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    middle, corners = (a + b + c) / 4.0, (np.zeros_like(a), a, b, c)
    total = a + b + c
    points = np.stack([middle, *(INNER * (total - k) + OUTER * k for k in corners)])
    weight = WEIGHTS[:, None] * signed
    scale = np.sqrt(np.einsum("sn,snk->k", weight, points**2) / volume)
    x = points / scale
    out = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        others = (x[..., i], x[..., j], x[..., k] ** 2, x[..., i] ** 2, x[..., j] ** 2, x[..., i] * x[..., j])
        out.append(max(abs(float(np.sum(weight * x[..., k] * f))) for f in others) / volume)
    return np.array(out)


def vanishing(mirrors: tuple[bool, bool, bool]) -> NDArray[np.bool_]:
    """Which entries of the (6, 6) matrix vanish about a point on the mirror planes of x, y and z, as booleans."""
    out = np.zeros((6, 6), dtype=bool)
    for signs, holds in zip(SIGNS, mirrors, strict=True):
        if holds:
            out |= np.outer(signs, signs) < 0
    return out


WITHIN = 2e-3
NAMES = ("fore-aft", "port-starboard", "top-bottom")


@lru_cache(2)
def mirrors(shape: Shape) -> tuple[bool, bool, bool]:
    """Whether a shape equals its image in x, in y and in z, each through its centre of volume.

    A mesh is held to volume moments up to the third degree, 0.2 % in units of its own size; parts are compared one by one.
    """
    if isinstance(shape, Revolution):
        return _fore_aft(shape), True, True
    if isinstance(shape, TriangleMesh) and not len(shape.faces):
        return False, False, False
    if isinstance(shape, TriangleMesh):
        x, y, z = asymmetries(shape.vertices, shape.faces) < WITHIN
        return bool(x), bool(y), bool(z)
    middle = shape.centre_of_volume
    x, y, z = (_parts_mirror(shape, k, middle) for k in range(3))
    return x, y, z


def _fore_aft(hull: Revolution) -> bool:
    area, middle = hull.radius**2 * hull.weight, hull.centre_of_volume[0]
    spread = float(np.sqrt(np.sum(area * (hull.x - middle) ** 2) / area.sum()))
    return abs(float(np.sum(area * (hull.x - middle) ** 3))) < WITHIN * spread**3 * float(area.sum())


def _parts_mirror(shape: Parts, axis: int, middle: Array) -> bool:
    turn = np.ones(3)
    turn[axis] = -1.0
    size = max(float(np.max(p.form.half_extents(p.rotation))) for p in shape.parts)
    figures = [_figure(p) for p in shape.parts]
    return all(
        any(
            other[0] == kind
            and abs(other[1] - volume) <= WITHIN * max(volume, other[1])
            and np.allclose(other[2], turn * (centre - middle) + middle, atol=WITHIN * size)
            and np.allclose(other[3], np.outer(turn, turn) * spread, atol=WITHIN * size**2)
            and np.allclose(other[4], turn * skew, atol=WITHIN * size)
            for other in figures
        )
        for kind, volume, centre, spread, skew in figures
    )


def _figure(part: Part) -> tuple[str, float, Array, Array, Array]:
    """Kind, volume, centre, second moments, and how far a form without middle leans out of its centre of volume."""
    return type(part.form).__name__, part.form.volume, part.centre, part.second_moments, part.middle - part.centre


def must_vanish(shape: Shape, point: Array) -> NDArray[np.bool_]:
    """Entries of the added mass about a point that the mirror planes through it make vanish, (6, 6) of booleans."""
    off = np.abs(point - shape.centre_of_volume)
    size = shape.length or 1.0
    found = mirrors(shape)
    x, y, z = (m and bool(d <= 1e-6 * size) for m, d in zip(found, off, strict=True))
    return vanishing((x, y, z))


EXACT = "Lamb's exact form for one ellipsoid, or ellipsoids too far apart to interact"
ELSE = (
    "the panel method; else closed forms with corrected ends, for parts and for a mesh like one plate; else strips with Lamb's end correction; else the ellipsoid of equal volume and proportions; rough guides come last: strips of a short body, an ellipsoid whose projected areas or second moments "
    "of volume are off by over 10 %, a mesh as one plate"
)
RULE = f"{EXACT}; else {ELSE}"
UNCHECKED = "NOT CHECKED: the parts replace a mesh, and {} computes the parts; only the panel method on the mesh shows what they miss"
OF_MESH = f"for parts that replace a mesh, the panel method on that mesh; else {ELSE}, parts that are poor stand-ins"
CAUTION = (
    "NONE OF THE METHODS SHOWN IS GOOD FOR THIS BODY: {} is a rough guide; compare them all, or describe the body by parts, thin ones "
    "as plates (coeflab simplify, or a body.toml of reader primitives), for the method primitives"
)
CAUTION_PARTS = (
    "NONE OF THE METHODS SHOWN IS GOOD FOR THIS BODY: {} is a rough guide, as parts are poor stand-ins for a mesh: {}. Take the panel "
    "method on the mesh itself, or replace these parts"
)
ORDER = ("panel", "primitives", "strip:lamb", "ellipsoid", "primitives:huuv", "strip")
ROUNDING = 1e-12
SILENT = 1e-6  # of the largest diagonal entry: a motion that moves no water
APART = 1e-3  # of a sphere's added mass, by what the others induce: as exact as the panel method gets
NOISE = 2e-3  # what a triangulated surface leaves of entries that symmetry makes vanish


@brief
@dataclass(frozen=True, slots=True)
class Triangulation:
    """Added mass by every method that applies, and why the others do not.

    Attributes
    ----------
    body : Body
        With a shape.
    density : float
        kg/m^3.
    results : tuple of AddedMass
        About the body's reference point.
    refused : mapping of method to str
    citations : tuple of str
    original : Body, optional
        The mesh, where the body's parts stand for one.
    on_mesh : tuple of str
        Methods that took it in their place.
    """

    body: Body
    density: float
    results: tuple[AddedMass, ...]
    refused: Mapping[str, str]
    citations: tuple[str, ...]
    original: Body | None = None
    on_mesh: tuple[str, ...] = ()

    @property
    def shape(self) -> Shape:
        """The body's, or that of the mesh for which its parts stand."""
        return (self.original or self.body).require_shape()

    @property
    def _parts(self) -> Parts | None:
        """The parts, where some stand for pieces of a mesh."""
        shape = self.body.require_shape()
        return shape if isinstance(shape, Parts) and shape.stand_ins else None

    @property
    def rule(self) -> str:
        """`RULE`, or `OF_MESH` where parts stand for a mesh: forms that stand in are never exact."""
        return RULE if self._parts is None else OF_MESH

    @property
    def recommended(self) -> AddedMass:
        """The first by `RULE` that is a kinetic energy; a rough guide says so first.

        Raises
        ------
        InputError
            None of them is.
        """
        alone, order = () if self._parts else _ellipsoids(self.body.require_shape()), ORDER
        if alone and _felt(alone) < APART:
            exact = ("ellipsoid", "primitives") if len(alone) == 1 else ("primitives",)
            order = (*exact, *(m for m in ORDER if m not in exact))
        ranked = sorted(
            self.results, key=lambda r: (r.rough, order.index(r.method) if r.method in order else len(order))
        )
        found = next((r for r in ranked if r.definiteness.holds), None)
        if found is None:
            raise InputError(
                f"no added mass of {shown(self.body.name)} that is a kinetic energy", "a symmetric, positive matrix"
            )
        caution = self._caution(found)
        return self._symmetric(replace(found, statements=(caution, *found.statements)) if caution else found)

    def _caution(self, found: AddedMass) -> str:
        """What must be said first: none is good, or the parts that it is of were not compared with their mesh."""
        parts = self._unchecked(found)
        if parts is not None and parts.rough:
            return CAUTION_PARTS.format(found.method, "; ".join(parts.rough))
        if found.rough:
            return CAUTION.format(found.method)
        return "" if parts is None else UNCHECKED.format(found.method)

    def _unchecked(self, found: AddedMass) -> Parts | None:
        """The parts that stand for a mesh, where nothing was computed of that mesh."""
        return None if "panel" in self.on_mesh or found.method in self.on_mesh else self._parts

    @property
    def none_recommended(self) -> bool:
        """Whether every result is of parts that are poor stand-ins for a mesh: the first by the rule is no advice then."""
        parts = self._unchecked(self.recommended)
        return parts is not None and bool(parts.rough)

    def _symmetric(self, found: AddedMass) -> AddedMass:
        """Without the small entries that symmetry makes vanish and a mesh does not quite."""
        diagonal = np.diag(found.matrix)
        noise = self.vanishing()[0] & (np.abs(found.matrix) < NOISE * np.sqrt(np.outer(diagonal, diagonal)))
        if not np.any(found.matrix[noise]):
            return found
        said = f"entries up to {NOISE:.1%} that symmetry makes vanish were left by the mesh and are set to zero"
        return replace(found, matrix=np.where(noise, 0.0, found.matrix), statements=(*found.statements, said))

    @property
    def caution(self) -> str:
        """What must be said of the recommended one where it is only a rough guide, or not checked; else nothing."""
        return self._caution(self.recommended)

    @property
    def ordered(self) -> tuple[AddedMass, ...]:
        """The recommended one first."""
        first = self.recommended
        return (first, *(r for r in self.results if r.method != first.method))

    @property
    def spread(self) -> Array:
        """(6, 6) range over the methods that say something on an entry, over the recommended one's size there.

        The size is the entry itself on the diagonal, the root of both its diagonal entries off it; NaN where fewer than
        two methods have it or the recommended one has not. A zero on the diagonal, or what rounding makes of it, is silence
        and not a value. Where parts stand for a mesh and no panel method took that mesh there is no range: the methods share
        what the parts miss, and their agreement says nothing of it.
        """
        stack = np.array([r.matrix for r in self.results])
        diagonal = np.einsum("nii->ni", stack)
        largest = np.repeat(diagonal.reshape(-1, 2, 3).max(axis=2), 3, axis=1)
        heard = diagonal > SILENT * largest
        speaks = heard[:, :, None] & heard[:, None, :]
        own = np.diag(self.recommended.matrix)
        own = np.where(own > SILENT * np.repeat(own.reshape(2, 3).max(axis=1), 3), own, 0.0)
        size = np.sqrt(np.outer(own, own))
        high = np.max(np.where(speaks, stack, -np.inf), axis=0)
        low = np.min(np.where(speaks, stack, np.inf), axis=0)
        known = (speaks.sum(axis=0) > 1) & (size > 0.0)
        if self._unchecked(self.recommended) is not None:
            known = np.zeros_like(known)
        return np.where(known, np.where(known, high - low, 0.0) / np.where(size > 0.0, size, 1.0), np.nan)

    @property
    def mirror_planes(self) -> tuple[str, ...]:
        """Names of the shape's planes of symmetry."""
        return tuple(n for n, holds in zip(NAMES, mirrors(self.shape), strict=True) if holds)

    def vanishing(self) -> tuple[NDArray[np.bool_], dict[str, float]]:
        """Entries that symmetry makes vanish, (6, 6) of booleans, and the largest of them by method.

        Largest over the root of both diagonal entries.
        """
        zero = must_vanish(self.shape, self.body.reference_point)
        left = {}
        for r in self.results:
            diagonal = np.diag(r.matrix)
            size = np.sqrt(np.outer(diagonal, diagonal))
            live = zero & (size > ROUNDING * float(size.max()))
            left[r.method] = float(np.max(np.abs(r.matrix[live]) / size[live], initial=0.0))
        return zero, left

    def vanishing_symbols(self) -> tuple[str, ...]:
        """The same as derivatives of the upper triangle: Yudot, ..."""
        zero, _ = self.vanishing()
        return tuple(f"{COMPONENTS[i]}{MOTIONS[j]}dot" for i in range(6) for j in range(i + 1, 6) if zero[i, j])


def _ellipsoids(shape: Shape) -> tuple[Part, ...]:
    """The parts, where all are ellipsoids."""
    alike = isinstance(shape, Parts) and all(isinstance(p.form, Ellipsoid) for p in shape.parts)
    return shape.parts if isinstance(shape, Parts) and alike else ()


def _felt(parts: tuple[Part, ...]) -> float:
    """Change of a part's added mass by the flow about the others, the largest, over it; 0 for one part.

    Notes
    -----
    Each is taken as the sphere of radius R around it: a dipole of moment R^3 U / 2, which at a distance d makes a velocity of
    (R/d)^3 U at most, in which a sphere feels 3/2 of the displaced mass, three times its added mass (Lamb, 92, 137 and 138).
    """
    centres = np.array([p.centre for p in parts])
    radii = np.array([float(np.max(p.form.axes)) for p in parts if isinstance(p.form, Ellipsoid)])
    away = np.linalg.norm(centres[:, None] - centres, axis=2)
    away[np.diag_indices(len(parts))] = np.inf
    with np.errstate(divide="ignore"):
        return float(np.max(3.0 * np.sum((radii / away) ** 3, axis=1)))
