"""How far the volume of panels is from that of the body they stand for, and what that may cost its added mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.facet_volume import enclosed, facet_deficit
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.types import Array

STRONGEST, SAME_BODY = 2.0, 0.05


@dataclass(frozen=True, slots=True)
class VolumeGap:
    """Volume of panels over that of the body, less one.

    Attributes
    ----------
    finest : float
        Of the finest panels as they are.
    left : float
        Of all panels, extrapolated as the square of their size: what no refinement of these panels takes away.
    body : str
        Whose volume that is, in words.
    meshes : int
        How many there were; one alone has no error estimate.
    step : float
        Of the second mesh, less that of the finest; 0 where there is one.
    ratio : float
        Of the panels' sizes in these two.
    """

    finest: float
    left: float
    body: str
    meshes: int
    step: float
    ratio: float

    def cost(self, matrix: Array) -> Array:
        """(6, 6) what may be missing from an added mass: twice what is left of the volume, of the size of each entry.

        Of a long spheroid that is too thin all over, the entry along x goes with the square of the volume, those across
        with the volume itself; of one that is too small all over, the moments with its power 5/3.
        """
        root = np.sqrt(np.abs(np.diag(matrix)))
        return np.asarray(STRONGEST * abs(self.left) * np.outer(root, root))

    def hidden(self, matrix: Array, order: float | None) -> Array:
        """(6, 6) what thinning may hide: with its edges a coarse mesh loses volume, against what its large panels add.

        As `cost`, of the step in volume, and carried on as the extrapolation of this order carries differences.

        Parameters
        ----------
        matrix : (6, 6) array
        order : float or None
            None where there is no extrapolation; 1 is taken then.
        """
        if self.meshes == 1:
            return np.zeros((6, 6))
        root = np.sqrt(np.abs(np.diag(matrix)))
        carried = self.ratio ** (order or 1.0) - 1.0
        return np.asarray(STRONGEST * abs(self.step) / carried * np.outer(root, root))

    @property
    def summary(self) -> str:
        """The same in words."""
        out = f"volume of the finest panels {self.finest:+.2%} from {self.body}"
        if self.meshes == 1:
            return out
        return f"{out}, {self.left:+.2%} once extrapolated: included in the error estimate"


def volume_gap(body: Body, mesh: TriangleMesh, meshes: Sequence[Array]) -> VolumeGap:
    """Hold panels against the volume of the body's equations; else as stated, within 5 %; else as its facets suggest.

    Parameters
    ----------
    body : Body
    mesh : TriangleMesh
        The body's own, or one made of its shape.
    meshes : sequence of (n, 3, 3) arrays
        Panel, corner, component, m; the finest first.
    """
    volumes = [enclosed(corners) for corners in meshes]
    whole, name = _whole(body, mesh)
    step, ratio = 0.0, 1.0
    if len(meshes) > 1:
        step, ratio = (volumes[1] - volumes[0]) / whole, float(np.sqrt(len(meshes[0]) / len(meshes[1])))
    finest = volumes[0] / whole - 1.0
    left = finest - step / (ratio**2 - 1.0) if len(meshes) > 1 else finest
    return VolumeGap(finest, left, name, len(meshes), step, ratio)


def _whole(body: Body, mesh: TriangleMesh) -> tuple[float, str]:
    if mesh.exact_volume is not None:
        return mesh.exact_volume, "the body's by its equations"
    # The first configuration is computed from the shape itself; the others were stated.
    stated = [(abs(mesh.volume / c.volume - 1.0), c.volume, c.name) for c in body.configurations[1:] if c.volume]
    if body.shape is mesh and stated:
        off, volume, name = min(stated)
        if off <= SAME_BODY:
            return volume, f"that of {name}"
    smooth = mesh.volume + facet_deficit(mesh.vertices, mesh.faces)
    return smooth, "a smooth surface through the corners of its facets, estimated by the angles between these"
