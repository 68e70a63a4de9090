"""Meshes of known make become the parts that they were made of."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.readers import read_body
from coeflab.bodies.readers.primitives import read
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Plate, shadow
from coeflab.bodies.simplify import simplify as study
from coeflab.bodies.simplify.boxes import NamedBox
from coeflab.bodies.simplify.simplify import simplify
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, Source
from coeflab.law.scaling import Scaling
from coeflab.law.transforms import rotation
from coeflab.report.as_json.shapes import simplification
from coeflab.report.tables.simplification import part_table, total_table
from tests.bodies.vehicles import HULL, LENGTH, fin, lathe, rod, tailed_hull


def body(*solids: Manifold, turn: np.ndarray | None = None) -> Body:
    """A body of one mesh; several solids stay several shells."""
    surfaces = [surface(s) for s in solids]
    starts = np.cumsum([0] + [len(v) for v, _ in surfaces])
    vertices = np.vstack([v for v, _ in surfaces]) @ (np.eye(3) if turn is None else turn).T
    faces = np.vstack([f + s for (_, f), s in zip(surfaces, starts)])
    return Body(
        "b", "a body", Datum("nose"), np.array([-1.0, 0.0, 0.0]), {}, (), Source("synthetic", kind="synthetic"),
        (InputFile("b/b.stl", "0" * 64),), TriangleMesh(vertices, faces), Scaling(4.0, "length"),
    )  # fmt: skip


def mast() -> Manifold:
    """Upright, to 1.2 m above the axis, with 64 facets."""
    return Manifold.cylinder(1.2, 0.08, 0.08, 64).rotate((180.0, 0.0, 0.0)).translate((0.5, 0.0, 0.0))


def test_fused_vehicle() -> None:
    found = simplify(body(tailed_hull() + mast()))
    forms = {p.part.name: p.part.form for p in found.parts}
    assert list(forms) == ["hull", "cylinder_top", "plate_port", "plate_top", "plate_bottom", "plate_starboard"]
    hull, top = forms["hull"], forms["cylinder_top"]
    assert isinstance(hull, Cylinder)
    assert (hull.radius, hull.length) == pytest.approx((HULL, LENGTH), rel=0.01)
    assert isinstance(top, Cylinder)
    assert (top.radius, top.length) == pytest.approx((0.08, 1.2 - HULL), rel=0.025)
    for name in ("plate_port", "plate_top"):
        assert isinstance(forms[name], Plate)
        assert (forms[name].chord, forms[name].span) == pytest.approx((0.3, 0.6 - HULL), rel=5e-3)
    parts = {p.part.name: p.part for p in found.parts}
    assert parts["cylinder_top"].rotation == pytest.approx(rotation(0.0, np.pi / 2, 0.0), abs=1e-12)
    assert parts["plate_port"].centre == pytest.approx([-1.7, -(0.6 + HULL) / 2.0, 0.0], abs=2e-3)
    assert parts["plate_top"].rotation[:, 1] == pytest.approx([0, 0, 1], abs=1e-12)
    assert found.statements == ()


def test_errors_are_those_of_the_written_numbers() -> None:
    """64 facets leave 0.08 % of a circle's width; at a root the cut stands out by half a fin's thickness, or by the arc of the hull."""
    found = simplify(body(tailed_hull() + mast()))
    facets = 1.0 - np.sqrt(np.sin(np.pi / 32.0) / (np.pi / 32.0))
    arc = HULL - np.sqrt(HULL**2 - 0.08**2)
    areas = {
        "hull": facets + (2.0 * 0.01 * 0.3 + 2.0 * 0.08 * arc) / (2.0 * HULL * LENGTH),
        "cylinder_top": facets + arc / (1.2 - HULL),
    }
    whole = found.mesh.volume
    assert sum(p.volume for p in found.parts) + found.unassigned == pytest.approx(whole, rel=1e-9)
    for p in found.parts:
        if isinstance(p.part.form, Plate):
            assert p.volume_error == -1.0
            assert p.projected_errors[2] == pytest.approx(0.0, abs=1e-3)
            continue
        assert p.volume_error == pytest.approx(p.part.form.volume / p.volume - 1.0)
        assert abs(p.volume_error) < 5e-4
        assert p.length_error == pytest.approx(0.0, abs=1e-3)
        assert np.all(np.abs(p.projected_errors[1:]) <= areas[p.part.name])
        assert p.projected_errors[0] == pytest.approx(shadow(p.part.form, np.eye(3)[0]) / p.projected[0] - 1.0)
    row = total_table(found).rows[0]
    assert row[3] == f"{100.0 * (found.shape.volume / whole - 1.0):+.1f} %"


@pytest.mark.slow
def test_the_file_holds_exactly_the_parts(tmp_path: Path) -> None:
    made = body(tailed_hull() + mast(), turn=rotation(0.1, 0.2, 0.3))
    found = simplify(made)
    path = tmp_path / "body.toml"
    path.write_bytes(found.part_file())
    (tmp_path / "mesh.ply").write_bytes(found.mesh_file())
    again = read(path)
    assert again.source.kind == "computed"
    assert "b/b.stl, sha256 " + "0" * 64 in again.source.how_obtained
    assert again.reference_point == pytest.approx([-1.0, 0.0, 0.0])
    assert again.scaling == Scaling(4.0, "length")
    for p, q in zip(again.shape.parts, found.shape.parts, strict=True):
        assert (p.name, p.form, p.fit) == (q.name, q.form, q.fit)
        assert p.fit is not None
        assert np.array_equal(p.centre, q.centre)
        assert p.rotation == pytest.approx(q.rotation, abs=1e-12)
    assert path.read_text().count("fit = {class = ") == len(found.parts)
    surface_again, said = again.mesh.read()
    assert said == ()
    assert surface_again.integrals.volume == pytest.approx(found.mesh.volume, rel=1e-14)
    assert np.array_equal(np.unique(surface_again.vertices, axis=0), np.unique(found.mesh.vertices, axis=0))
    assert found.part_file() == simplify(made).part_file()


def test_scale_does_not_matter() -> None:
    small = body(tailed_hull().scale((0.01, 0.01, 0.01)))
    large = body(tailed_hull().scale((30.0, 30.0, 30.0)))
    for p, q in zip(simplify(small).parts, simplify(large).parts, strict=True):
        assert p.part.name == q.part.name
        assert type(p.part.form) is type(q.part.form)
        assert np.array(p.likeness.sizes) * 3000.0 == pytest.approx(q.likeness.sizes, rel=1e-6)


def test_separate_shells_that_overlap() -> None:
    """A slab through the hull is two plates, and the hull keeps what they share."""
    slab = Manifold.cube((0.3, 1.2, 0.02), True).translate((-1.5, 0.0, 0.0))
    found = simplify(body(rod(HULL, LENGTH), slab))
    assert [p.part.name for p in found.parts] == ["hull", "plate_port", "plate_starboard"]
    assert found.parts[0].volume == pytest.approx(rod(HULL, LENGTH).volume(), rel=1e-12)
    assert found.parts[1].volume == pytest.approx(0.3 * 0.02 * (0.6 - HULL), rel=2e-3)
    assert "overlap by 0.00299" in found.statements[0]


def test_boxes_name_parts_and_come_first() -> None:
    sail = NamedBox("sail", (0.0, -0.2, -2.0), (1.0, 0.2, -HULL))
    rudder = NamedBox("rudder", (-2.0, -0.1, -0.7), (-1.0, 0.1, -HULL))
    found = simplify(body(tailed_hull() + mast()), (sail, rudder), expected=6)
    names = [p.part.name for p in found.parts]
    assert names[0] == "hull"
    assert {"sail", "rudder", "plate_port", "plate_starboard", "plate_bottom"} == set(names[1:])


def test_other_forms_and_an_ellipsoid_hull() -> None:
    x = np.linspace(-1.0, 1.0, 121)
    spindle = lathe(x, 0.2 * np.sqrt(1.0 - x**2))
    pod = Manifold.cube((0.4, 0.2, 0.2), True).translate((0.0, 0.0, 0.5))
    found = simplify(body(spindle, pod))
    assert [p.part.name for p in found.parts] == ["hull", "box_bottom"]
    assert isinstance(found.parts[0].part.form, Ellipsoid)
    assert found.parts[0].part.form.axes == pytest.approx([1.0, 0.2, 0.2], rel=5e-3)
    assert found.parts[0].part.form.y == found.parts[0].part.form.z
    assert found.parts[1].part.form == Box(0.4, 0.2, 0.2)


def test_a_duct_is_a_tube() -> None:
    found = simplify(body(rod(1.0, 1.0) - rod(0.8, 1.2)))
    assert found.parts[0].part.form.radius == pytest.approx(1.0, rel=1e-3)
    assert found.parts[0].part.form.inner_radius == pytest.approx(0.8, rel=5e-3)
    assert not found.shape.rough
    assert 'form = "ring"' in found.part_file().decode()


def half_ring() -> Manifold:
    """Bent without a seam: like no form, and never an ellipsoid in disguise."""
    return (rod(1.0, 0.5) - rod(0.7, 0.6)) ^ Manifold.cube((4.0, 4.0, 4.0), True).translate((0.0, 2.0, 0.0))


def test_what_is_like_nothing_stays_a_mesh(tmp_path: Path) -> None:
    found = simplify(body(half_ring()))
    assert found.left_as_mesh
    assert "no form is good, so it stays a mesh" in found.parts[0].remarks[0]
    assert part_table(found).rows[0][1] == "mesh"
    part = found.parts[0].part
    assert part.fit.kind == "mesh"
    assert found.shape.volume == pytest.approx(found.mesh.volume, rel=1e-12)
    assert found.failures == ()
    assert (simplification(found)["recommended"], simplification(found)["status"]) == ("mesh", "ok")
    (tmp_path / "body.toml").write_bytes(found.part_file())
    (tmp_path / "mesh.ply").write_bytes(found.mesh_file())
    for name, content in found.mesh_parts().items():
        (tmp_path / name).write_bytes(content)
    again = read(tmp_path / "body.toml")
    assert again.require_shape().centre_of_volume == pytest.approx(found.mesh.centre_of_volume, abs=1e-12)
    assert [f.name for f in again.files] == [f"b_simplified/{n}" for n in ("body.toml", "hull.ply", "mesh.ply")]


@pytest.mark.slow
def test_plates_are_named_by_side_of_a_turned_hull() -> None:
    """The hull's own axes decide, so a trimmed hull keeps its port and starboard."""
    found = simplify(body(tailed_hull(), turn=rotation(0.0, np.radians(20.0), np.radians(15.0))))
    assert {p.part.name for p in found.parts} == {"hull", "plate_port", "plate_starboard", "plate_top", "plate_bottom"}


def test_two_fins_on_one_side_are_numbered() -> None:
    hull = rod(HULL, LENGTH) + fin(0.3, 0.02, 0.6, 90.0, -1.7) + fin(0.3, 0.02, 0.6, 90.0, 1.2)
    names = [p.part.name for p in simplify(body(hull)).parts]
    assert names == ["hull", "plate_starboard_1", "plate_starboard_2"]


@pytest.mark.slow
def test_what_is_like_nothing_is_cut_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    made = body(half_ring(), rod(0.05, 2.0).translate((0.0, 0.0, 3.0)))
    assert [p.likeness.kind for p in simplify(made).parts] == ["mesh", "cylinder"]
    found = simplify(made, convex=True)
    assert len(found.parts) > 3
    assert "nearly convex pieces" in found.statements[0]
    assert sum(p.volume for p in found.parts) + found.unassigned == pytest.approx(found.mesh.volume, rel=1e-9)
    whole = NamedBox("half", (-2.0, -2.0, -2.0), (2.0, 2.0, 2.0))
    assert len(simplify(made, (whole,), convex=True).parts) == 2
    monkeypatch.setitem(sys.modules, "vhacdx", None)
    with pytest.raises(InputError, match=r'without the package vhacdx; expected vhacdx. Install "coeflab\[convex\]"'):
        simplify(made, convex=True)


def test_a_bracket_is_parted_where_its_faces_meet_inward() -> None:
    bracket = Manifold.cube((1.0, 0.3, 0.1)) + Manifold.cube((0.1, 0.3, 0.8))
    found = simplify(body(bracket))
    assert [p.likeness.kind for p in found.parts] == ["box", "box"]
    assert found.shape.volume == pytest.approx(bracket.volume(), rel=1e-3)
    assert "parted along" in found.statements[0]


def test_a_body_given_by_equations_is_meshed_first() -> None:
    found = simplify(read_body(shipped("geometry") / "remus100" / "body.toml"))
    assert [p.likeness.kind for p in found.parts] == ["revolution"]
    assert found.parts[0].length_error == pytest.approx(0.0, abs=1e-4)
    assert found.statements[0].startswith("meshed from its equations with ")


@pytest.mark.slow
def test_suboff_planes_are_plates_and_its_hull_keeps_its_length() -> None:
    """Groves, Huang & Chang (1989): hull of 14.2917 ft; four planes of one size."""
    found = simplify(read_body(shipped("geometry") / "suboff_aff8" / "body.toml"))
    parts = {p.part.name: p for p in found.parts}
    planes = [parts[f"plate_{side}"] for side in ("port", "starboard", "top", "bottom")]
    assert {p.part.form for p in planes} == {planes[0].part.form}
    assert isinstance(planes[0].part.form, Plate)
    hull = parts["hull"]
    assert 2.0 * hull.part.form.x == pytest.approx(14.2917 * 0.3048, rel=1e-4)
    assert hull.volume_error == pytest.approx(0.0, abs=1e-4)
    assert hull.projected_errors[1:] == pytest.approx([0.0, 0.0], abs=5e-3)
    assert hull.poor == (f"A x {100.0 * hull.projected_errors[0]:+.1f} %",)


def test_a_body_far_off_right_angles_is_not_tidied() -> None:
    found = simplify(body(rod(0.2, 2.0, 128), turn=rotation(0.0, np.radians(1.5), np.radians(40.0)))).parts[0]
    assert found.turned < np.radians(0.01)
    assert found.projected_errors == pytest.approx(0.0, abs=3e-3)


def test_many_faces_are_decimated_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study, "MOST_FACES", 2000)
    monkeypatch.setattr(study, "SIMPLIFIED_FACES", 1500)
    found = simplify(body(Manifold.sphere(1.0, 64)))
    assert "faces decimated to" in found.statements[0]
    assert found.part_file().decode().count("decimated") == 1
    assert found.parts[0].part.form.volume == pytest.approx(4.0 * np.pi / 3.0, rel=0.05)


def open_mesh() -> Body:
    vertices, faces = surface(rod(0.2, 2.0))
    return Body("b", "", Datum("nose"), np.zeros(3), {}, (), Source(""), (), TriangleMesh(vertices, faces[1:]))


def hollow() -> Body:
    outer, faces = surface(Manifold.sphere(1.0, 32))
    inner, more = surface(Manifold.sphere(0.5, 32))
    mesh = TriangleMesh(np.vstack([outer, inner]), np.vstack([faces, more[:, ::-1] + len(outer)]))
    return Body("b", "", Datum("nose"), np.zeros(3), {}, (), Source(""), (), mesh)


@pytest.mark.parametrize(
    ("made", "boxes", "expected", "said"),
    [
        ("open", (), None, "not closed"),
        ("hollow", (), None, "a shell that looks inward"),
        ("plate", (), None, "nothing but plates"),
        ("rod", (), 2, r"1 parts \(1 cylinder\); expected 2 parts"),
        ("rod", (("m", (5, 5, 5), (6, 6, 6)),), None, "holds no vertex of the mesh; expected a box within x -1 to 1"),
        ("rod", (("m", (0, 0, -1), (2, 1, 1)), ("m", (0, -1, -1), (2, 0, 1))), None, 'two boxes called "m"'),
        ("rod", (("m", (-3, -1, -1), (3, 1, 1)),), None, ""),
        ("rod", (("m", (0.9999, -1, -1), (3, 1, 1)),), None, "contains next to no volume"),
    ],
)
def test_gates(made: str, boxes: tuple, expected: int | None, said: str) -> None:
    of = {
        "open": open_mesh, "hollow": hollow, "plate": lambda: body(Manifold.cube((1.0, 1.0, 0.02))),
        "rod": lambda: body(rod(0.2, 2.0)),
    }[made]()  # fmt: skip
    drawn = tuple(NamedBox(n, tuple(map(float, low)), tuple(map(float, high))) for n, low, high in boxes)
    if not said:
        assert [p.part.name for p in simplify(of, drawn, expected).parts] == ["m"]
        return
    with pytest.raises(InputError, match=said):
        simplify(of, drawn, expected)


def test_a_body_without_a_mesh() -> None:
    parts = simplify(body(rod(0.2, 2.0))).body
    with pytest.raises(InputError, match="made of simple parts already"):
        simplify(parts)
