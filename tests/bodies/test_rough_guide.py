"""A rough guide to an added mass has a U95 that holds what panels find, and a warning that travels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.creation import annulus, box

from coeflab.bodies.added_mass import AddedMassMethod
from coeflab.bodies.added_masses import added_masses
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.rough_guide import rough_u95
from coeflab.bodies.shape import Ellipsoid, Part, Parts
from coeflab.bodies.simplify.source import mesh_body
from coeflab.bodies.volume_moments import displaced
from coeflab.core.axes import Datum
from coeflab.core.finding import Severity
from coeflab.core.provenance import Source
from coeflab.law.added_mass import AddedMass
from coeflab.report.rendered import rendered
from coeflab.study.checking import checked
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.vehicle.parameter_file import read_parameter_file
from coeflab.vehicle.plausibility import plausibility
from tests.bodies.twelve import TWELVE

FLU = np.diag([1.0, -1.0, -1.0])


def body(mesh: trimesh.Trimesh, name: str = "body") -> Body:
    mesh.merge_vertices()
    shape = TriangleMesh(np.asarray(mesh.vertices) @ FLU, np.asarray(mesh.faces))
    return Body(
        name, name, Datum("middle"), shape.centre_of_volume, {}, (), Source("synthetic", kind="synthetic"), (), shape
    )


def test_displaced_water_of_a_box_by_hand() -> None:
    shape = body(box((2.0, 1.0, 0.5))).require_shape()
    found = displaced(shape, 1000.0, np.array([0.3, 0.0, 0.0]))
    assert found[:3] == pytest.approx([1000.0] * 3)
    turns = [(1.0 + 0.25) / 12.0, (4.0 + 0.25) / 12.0 + 0.09, (4.0 + 1.0) / 12.0 + 0.09]
    assert found[3:] == pytest.approx([1000.0 * t for t in turns], rel=1e-9)


def test_the_half_width_of_a_ball_is_that_of_entry_and_displaced_water() -> None:
    """A ball of radius R: entry 2/3 pi rho R^3, displaced twice that; turned, nothing and 2/5 m R^2."""
    shape = Parts((Part("ball", Ellipsoid(1.0, 1.0, 1.0), np.zeros(3), np.eye(3)),))
    mass = 4.0 / 3.0 * np.pi
    found = AddedMass(np.diag([mass / 2.0] * 3 + [0.0] * 3), method="ellipsoid", rough=True)
    half, other = rough_u95(found, shape, 1.0, np.zeros((6, 6), dtype=bool)), AddedMassMethod.rough_share
    assert np.diag(half) == pytest.approx([other * 1.5 * mass] * 3 + [other * 0.4 * mass] * 3, rel=1e-9)


def test_a_panel_result_has_no_half_width_and_no_finding() -> None:
    found = added_masses(body(trimesh.creation.icosphere(2)), 1000.0)
    assert found.recommended.method == "panel"
    assert found.recommended.u95 is None
    assert found.findings == ()


@pytest.mark.slow
def test_half_widths_hold_what_panels_find_in_95_of_100_entries() -> None:
    held = count = 0
    for name, made in TWELVE.items():
        one = body(made(), name)
        panels = added_masses(one, 1.0, "panel", {"panels": 2000}).recommended.matrix
        for method in ("ellipsoid", "strip:lamb"):
            rough = added_masses(one, 1.0, method).recommended
            if not rough.rough:
                continue
            assert rough.u95 is not None
            inside = np.abs(np.diag(rough.matrix - panels)) <= np.diag(rough.u95)
            held, count = held + int(inside.sum()), count + 6
    assert count >= 100
    assert held >= 0.95 * count


def wedge() -> trimesh.Trimesh:
    ends = [[-1.0, y, z] for y in (0.6, -0.6) for z in (0.3, -0.3)]
    return trimesh.convex.convex_hull(np.array([[1.0, 0.0, 0.0], *ends])).subdivide().subdivide()


def ring() -> trimesh.Trimesh:
    made = annulus(0.45, 0.6, 0.7, sections=32)
    made.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    return made


HELD_OUT = {"wedge": wedge, "ring": ring, "tall box": lambda: box((0.6, 0.4, 1.4)).subdivide().subdivide()}


@pytest.mark.slow
@pytest.mark.parametrize("name", HELD_OUT)
def test_half_widths_hold_bodies_that_did_not_choose_them(name: str) -> None:
    """The twelve chose the shares; these had no part in it."""
    one = body(HELD_OUT[name](), name)
    panels = added_masses(one, 1.0, "panel", {"panels": 1000}).recommended.matrix
    for method in ("ellipsoid", "strip:lamb"):
        rough = added_masses(one, 1.0, method).recommended
        assert rough.rough
        assert rough.u95 is not None
        assert np.all(np.abs(np.diag(rough.matrix - panels)) <= np.diag(rough.u95))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ellipsoid", "strip:lamb"])
def test_a_rough_guide_warns_in_every_consumer(tmp_path: Path, method: str) -> None:
    TWELVE["box_rov"]().export(tmp_path / "rov.stl")
    rov = mesh_body(str(tmp_path / "rov.stl"), "m", "FLU")
    plan, stated = asked(rov, method=method, to=["xdyn"], accept_loss=True)
    study = checked(from_shape(plan, rov, stated))
    warned = [c for c in study.checks if c.name == "added_mass"]
    assert [c.severity for c in warned] == [Severity.WARN]
    files = rendered(study)
    for name, content in files.items():
        (tmp_path / Path(name).name).write_bytes(content)
    kept = read_parameter_file(tmp_path / "rov.parameters.json")
    (rough,) = (f for f in kept.findings if f.code == "added_mass.rough")
    assert kept.added_mass.u95 is not None
    assert np.diag(kept.added_mass.u95)[2] == pytest.approx(rough["half_widths"][2], rel=1e-2)
    assert any(c.severity is Severity.WARN and c.name == "added mass" for c in plausibility(kept))
    told = study.manoeuvres[0].statements
    assert any("rough guide" in s for s in told)
    for end in ("report.html", ".loss.txt"):
        assert any(b"rough guide" in content for name, content in files.items() if name.endswith(end)), end
    # The ideal fluid of the estimates has the half-widths of the guide.
    wide = {c.symbol: c for c in kept.coefficients}
    assert wide["Nuv'"].u95 > 0.5 * abs(wide["Nuv'"].value)


def test_a_ring_by_sections_is_a_rough_guide_and_its_half_width_holds_the_published() -> None:
    """Of a tube 4 long, radius 1 and .95, nothing along x but its rim; sections take the ellipsoid of its volume."""
    tube = annulus(0.95, 1.0, 4.0, sections=64)
    tube.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2.0, [0.0, 1.0, 0.0]))
    found = added_masses(body(tube), 1000.0, "strip:lamb")
    assert found.recommended.rough
    assert found.findings[0].code == "added_mass.rough"
