"""One body's added mass by several methods, side by side, and which of them to use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.added_mass import ADDED_MASS, resolving
from coeflab.bodies.body import Body
from coeflab.bodies.mirror_planes import NAMES, mirrors, vanishing
from coeflab.bodies.rough_guide import rough_finding, rough_u95, unresolved_finding
from coeflab.bodies.shape import Ellipsoid, Part, Parts, Shape
from coeflab.core.errors import shown
from coeflab.core.finding import Finding
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.law.added_mass import AddedMass
from coeflab.law.symbols import COMPONENTS, MOTIONS


def _place(method: str) -> float:
    """A method's place in the recommendation."""
    name, _, preset = method.partition(":")
    return ADDED_MASS.load(name).places.get(preset, np.inf)


def _exact(ellipsoids: int) -> tuple[str, ...]:
    """Methods that are exact for so many ellipsoids, the narrowest first."""
    limits = {name: ADDED_MASS.load(name).exact_ellipsoids for name in ADDED_MASS.usable()}
    return tuple(sorted((n for n in limits if limits[n] >= ellipsoids), key=lambda n: limits[n]))


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
        alone = () if self._parts else _ellipsoids(self.body.require_shape())
        exact = _exact(len(alone)) if alone and _felt(alone) < APART else ()
        order = {name: place - len(exact) for place, name in enumerate(exact)}
        ranked = sorted(self.results, key=lambda r: (r.rough, order.get(r.method, _place(r.method))))
        found = next((r for r in ranked if r.definiteness.holds), None)
        if found is None:
            raise input_error("bodies.added_mass_kinetic", name=shown(self.body.name))
        caution = self._caution(found)
        found = self._symmetric(replace(found, statements=(caution, *found.statements)) if caution else found)
        if not found.rough:
            return found
        half = rough_u95(found, self.shape, self.density, self.vanishing()[0])
        return replace(found, error=half, u95=half)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What must travel with the recommended one: that it is a rough guide, with its U95; that no panels were possible."""
        found, out = self.recommended, []
        if found.rough:
            untried = [name for name in resolving() if name not in self._tried]
            out.append(rough_finding(found, f"--method {untried[0]}" if untried else "coeflab simplify"))
        why = next(
            (self.refused[k] for name in resolving() for k in (f"{name} on the mesh", name) if k in self.refused), ""
        )
        if why and self._used.isdisjoint(resolving()) and not self._is_exact(found):
            out.append(unresolved_finding(found.body, found.method, why, "coeflab simplify"))
        return tuple(out)

    @property
    def _used(self) -> set[str]:
        return {r.method for r in self.results}

    @property
    def _tried(self) -> set[str]:
        return self._used | set(self.refused) | {name.partition(" ")[0] for name in self.refused}

    def _is_exact(self, found: AddedMass) -> bool:
        """Lamb's form for one ellipsoid."""
        return found.method in _exact(1) and len(_ellipsoids(self.body.require_shape())) == 1

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
        return None if {found.method, *resolving()} & set(self.on_mesh) else self._parts

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
        words = f"entries up to {NOISE:.1%} that symmetry makes vanish were left by the mesh and are set to zero"
        return replace(found, matrix=np.where(noise, 0.0, found.matrix), statements=(*found.statements, words))

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
