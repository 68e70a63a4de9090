"""Bluff parts and bodies of ROV type: drag by each face at its own velocity, with and without shielding, and ideal fluid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.outline import Bluff, Outline
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Water
from coeflab.law.definiteness import composed
from coeflab.law.rigid_body import ideal_force

summary = "bluff parts and bodies of ROV type: drag by faces, shielded and not, across the motion and along it"
citations = ("hoerner1965", "lamb1932")

SHARE, IDEAL_SHARE = 0.30, 0.50
# On the projected area, separated flow (Hoerner 1965, chapter 3): cube, cylinder across and along, plate, sphere.
CUBE, ACROSS, ALONG, PLATE, SPHERE = 1.05, 1.20, 0.82, 1.17, 0.47
LATTICE = 48  # cells across the shadow of all parts
POINTS = 4  # of each face, along each side


def face_drag(part: Bluff) -> Array:
    """(3,) drag coefficients along x, y and z of the body, of the part's projected areas."""
    own = {
        "box": np.full(3, CUBE), "cylinder": np.array([ALONG, ACROSS, ACROSS]), "plate": np.full(3, PLATE),
        "ellipsoid": np.full(3, SPHERE),
    }.get(part.kind, np.full(3, CUBE))  # fmt: skip
    return np.asarray((part.rotation**2) @ own)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("points areas")
class BluffForce:
    """Drag of a part, spread over its extent.

    Attributes
    ----------
    points : (k, 3) array
        m, from the datum.
    areas : (3,) array
        Drag areas along x, y, z, m^2.
    crossed : bool
        Each by its own velocity, |v_i| v_i; otherwise by the whole speed, |V| v_i.
    density : float
    """

    points: NDArray[np.float64]
    areas: NDArray[np.float64]
    crossed: bool
    density: float

    def __call__(self, nu: Array, angles: dict[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        del angles
        velocity = nu[:, None, :3] + np.cross(nu[:, None, 3:], self.points[None])
        speed = np.abs(velocity) if self.crossed else np.linalg.norm(velocity, axis=2, keepdims=True)
        force = -0.5 * self.density * self.areas / len(self.points) * speed * velocity
        return np.hstack([force.sum(axis=1), np.cross(self.points[None], force).sum(axis=1)])


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Drag of every bluff part, by four readings, and its ideal fluid.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    hidden = shielding(outline.bluff)
    for part in outline.bluff:
        for shielded in (False, True):
            for crossed in (True, False):
                areas = face_drag(part) * (part.areas * hidden if shielded else part.in_the_open)
                method = (
                    f"bluff, {'shielded' if shielded else 'in the open'}, {'each axis' if crossed else 'whole speed'}"
                )
                force = BluffForce(_points(part), areas, crossed, water.density)
                out.append(Contribution(part.name, "bluff drag", method, force, SHARE, "hoerner1965", "chapter 3"))
        ideal = partial(_ideal, added_mass(part, water.density))
        out.append(
            Contribution(
                part.name, "ideal fluid", "bluff", ideal, IDEAL_SHARE, "lamb1932", "ellipsoid of the part's extents"
            )
        )
    return tuple(out)


def shielding(parts: tuple[Bluff, ...]) -> Array:
    """(3,) shadow of all parts together over the sum of their own, along x, y and z: full shielding; 1 of a single part."""
    share = np.ones(3)
    if len(parts) < 2:
        return share
    reach = np.array([np.abs(p.rotation) @ p.half_extents for p in parts])
    centres = np.array([p.centre for p in parts])
    for axis in range(3):
        across = [i for i in range(3) if i != axis]
        low, high = (centres - reach)[:, across].min(axis=0), (centres + reach)[:, across].max(axis=0)
        lines = [low[i] + (high[i] - low[i]) * (np.arange(LATTICE) + 0.5) / LATTICE for i in range(2)]
        covered = np.zeros((LATTICE, LATTICE))
        single = 0.0
        for centre, size in zip(centres[:, across], reach[:, across], strict=True):
            inside = [np.abs(line - c) <= s for line, c, s in zip(lines, centre, size, strict=True)]
            shadow = np.outer(*inside)
            covered = np.maximum(covered, shadow)
            single += float(shadow.sum())
        share[axis] = float(covered.sum()) / single if single else 1.0
    return share


def _points(part: Bluff) -> Array:
    """Points through the part's extent, whose spread is that of its volume."""
    line = (np.arange(POINTS) + 0.5) / POINTS * 2.0 - 1.0
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    return np.asarray(part.centre + (grid * part.half_extents) @ part.rotation.T)


def added_mass(part: Bluff, density: float) -> Array:
    """(6, 6) of the ellipsoid of the part's extents about the datum."""
    own = ellipsoid_added_mass(np.maximum(part.half_extents, 1e-6 * part.half_extents.max()), density)
    return composed([own], [part.rotation], [part.centre], np.zeros(3))


def _ideal(matrix: Array, nu: Array, angles: dict[str, Array]) -> Array:  # noqa: ARG001 - as forces are
    return ideal_force(matrix, nu)
