"""Twelve kinds of vehicles, and four more: each becomes the forms that it was made of, or stays a mesh and says so."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from coeflab.bodies.added_masses import against_mesh
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Faceted
from coeflab.bodies.simplify.simplify import simplify
from coeflab.core.axes import Datum
from coeflab.core.provenance import Source
from tests.bodies.four import FOUR
from tests.bodies.twelve import TWELVE

FOUND: dict[str, dict[str, int]] = {
    "torpedo": {"revolution": 1, "plate": 4},
    "glider": {"revolution": 1, "plate": 3},
    "manta": {"mesh": 1},
    "frame_rov": {"box": 3, "bar": 12},
    "box_rov": {"box": 5, "plate": 2, "cylinder": 1},
    "ducted_quadrotor": {"box": 1, "tube": 4, "cylinder": 4},
    "triple_hull": {"ellipsoid": 3, "box": 2},
    "submarine": {"revolution": 1, "box": 1, "plate": 4},
    "sphere_with_arms": {"ellipsoid": 1, "cylinder": 3},
    "tube": {"tube": 1},
    "catamaran": {"ellipsoid": 2, "plate": 1},
    "towfish": {"revolution": 1, "tube": 1, "plate": 4, "box": 1},
    "blended_wing": {"mesh": 1},
    "ring_wing_hull": {"revolution": 1, "tube": 1, "plate": 7},
    "lander": {"ellipsoid": 3, "cylinder": 10},
    "kayak": {"ellipsoid": 1, "revolution": 1, "plate": 1, "box": 1},
}
VEHICLES = {**TWELVE, **FOUR}
FLU_TO_FRD = np.diag([1.0, -1.0, -1.0])


def body(name: str) -> Body:
    mesh = VEHICLES[name]()
    mesh.merge_vertices()
    shape = TriangleMesh(np.asarray(mesh.vertices) @ FLU_TO_FRD, np.asarray(mesh.faces))
    return Body(name, name, Datum("middle"), np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), shape)


@pytest.mark.slow
@pytest.mark.parametrize("name", VEHICLES)
def test_a_vehicle_becomes_its_forms_or_stays_a_mesh(name: str) -> None:
    found = simplify(body(name))
    assert Counter(p.likeness.kind for p in found.parts) == FOUND[name]
    assert sum(p.volume for p in found.parts) + found.unassigned == pytest.approx(found.mesh.volume, rel=1e-9)
    assert abs(found.unassigned) < 0.005 * found.mesh.volume
    assert found.failures == ()
    plates = sum(p.volume for p in found.parts if not p.part.form.volume)
    assert found.shape.volume == pytest.approx(found.mesh.volume - plates, rel=0.005)
    assert found.left_as_mesh == (name in ("manta", "blended_wing"))
    for p in found.parts:
        if isinstance(p.part.form, Faceted):
            assert p.part.form.volume == pytest.approx(p.volume, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "apart"), [("sphere_with_arms", ""), ("triple_hull", "uvw")])
def test_parts_are_recommended_only_where_they_move_what_the_mesh_moves(name: str, apart: str) -> None:
    """Three hulls side by side and the water between them are no sum of three hulls; arms on a sphere nearly are."""
    found = against_mesh(simplify(body(name)), panels=4000)  # fewer are no arms
    assert found.compared is not None
    parts, mesh = (np.diag(c.matrix) for c in found.compared)
    agreement = found.shape.agreement
    for k, entry in enumerate(agreement.entries):
        if entry is not None:
            assert entry == pytest.approx(parts[k] / mesh[k] - 1.0, abs=6e-4)
    off = {text.split()[0] for text in agreement.apart}
    assert off >= set(apart)
    assert bool(off) == bool(apart)
    agree = "Not known whether parts agree" if name == "sphere_with_arms" else "Parts agree with the mesh within"
    assert found.advice.startswith(
        "USE THE MESH" if apart else agree
    )  # the mesh of the arms has an error of half its value
