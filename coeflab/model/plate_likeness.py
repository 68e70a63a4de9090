"""The one plate that a thin mesh is like, by the test of ``coeflab simplify``."""

from __future__ import annotations

import numpy as np

from coeflab.kernels import solids
from coeflab.kernels.part_forms import THIN, likeness
from coeflab.model.mesh import TriangleMesh
from coeflab.model.shape import Part, Plate

KEPT_FACES = 20_000


def like_one_plate(mesh: TriangleMesh) -> Part | None:
    """The plate in the mesh's place, or None where it is no single shell, not thin, or of another outline.

    Parameters
    ----------
    mesh : TriangleMesh

    Notes
    -----
    See `coeflab.kernels.part_forms.likeness`. Bodies that are plainly not thin are told by their second moments of volume
    alone, without a cut; of more than 20,000 faces a decimated copy is looked at.
    """
    smallest, middle, _ = np.sqrt(np.clip(np.linalg.eigvalsh(mesh.integrals.second_moments), 0.0, None))
    if smallest > THIN * middle:
        return None
    try:
        whole, _ = solids.simplified(solids.solid(mesh.vertices, mesh.faces), KEPT_FACES)
    except ValueError:
        return None
    if len(solids.pieces(whole)) != 1:
        return None
    like = likeness(whole)
    if like.kind != "plate":
        return None
    chord, span = like.sizes
    return Part("plate", Plate(chord, span), like.centre, like.rotation)
