"""The towed body: closed, its patches where they belong, its mirrors, its controls, and the same file byte for byte."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull, cKDTree

from coeflab.bodies import profiles
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.topology import edges
from coeflab.bodies.pieces import Piece
from coeflab.bodies.readers import finned, groves, read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.tank.towed_body import TowedBody, stl, towed

GEOMETRY = shipped("geometry")
FEW = 5_000
SPHEROID = (GEOMETRY / "finned_spheroid" / "body.toml").read_text(encoding="utf-8")


@cache
def body(name: str) -> Body:
    return read_body(GEOMETRY / name / "body.toml")


@cache
def in_tank(name: str, **controls: float) -> TowedBody:
    whole = body(name)
    return towed(whole, whole.reference_point, controls, FEW)


def above_the_meridian(of: TowedBody, points: np.ndarray) -> np.ndarray:
    """Distance to the SUBOFF hull by its equations, m, negative inside."""
    end = np.linspace(0.0, 1.0, 4000) ** 3 * 0.1
    aft = np.concatenate([end, np.linspace(0.1, profiles.CAP_END - 0.1, 60_000), profiles.CAP_END - end])
    radius = profiles.suboff_profile(aft)[0]
    around = np.hypot(points[:, 1], points[:, 2])
    found = np.column_stack([-points[:, 0] - of.body.reference_point[0], around])
    away, nearest = cKDTree(profiles.FOOT * np.column_stack([aft, radius])).query(found)
    return np.where(around < profiles.FOOT * radius[nearest], -away, away)


def corners(of: TowedBody, patch: str) -> np.ndarray:
    return of.vertices[np.unique(of.faces[of.patch == of.patches.index(patch)])]


@pytest.fixture(scope="module")
def suboff() -> Body:
    return body("suboff_aff8")


@pytest.fixture(scope="module")
def aff8(suboff: Body) -> TowedBody:
    return towed(suboff, suboff.reference_point)


@pytest.fixture(scope="module")
def planes() -> Body:
    return body("suboff_hull_planes")


def test_aff8_is_closed_and_has_its_volume_and_surface(suboff: Body, aff8: TowedBody) -> None:
    exact = suboff.require("by_equations")
    found = mesh_integrals(aff8.vertices, aff8.faces)
    assert edges(aff8.faces).sound
    assert 80_000 < len(aff8.faces) < 120_000
    assert found.volume == pytest.approx(exact.volume, rel=5e-4)
    assert found.area == pytest.approx(exact.wetted_surface, rel=2e-4)
    assert found.centre + suboff.reference_point == pytest.approx(exact.centre_of_buoyancy, abs=2e-5)


def test_the_origin_is_the_reference_point(suboff: Body, aff8: TowedBody) -> None:
    assert aff8.vertices[:, 0].max() == pytest.approx(-suboff.reference_point[0], abs=1e-9)
    assert aff8.length == pytest.approx(profiles.FOOT * profiles.CAP_END, abs=1e-8)


def test_patches_of_aff8_lie_where_the_equations_say(suboff: Body, aff8: TowedBody) -> None:
    """Hull and stern on the meridian, nothing of sail and planes below it; the areas of Groves' integrals."""
    assert aff8.patches == ("hull", "stern", "sail", "fins")
    run = -profiles.FOOT * profiles.MIDDLE_END - suboff.reference_point[0]
    for patch in aff8.patches:
        points = corners(aff8, patch)
        gap, x, z = above_the_meridian(aff8, points), points[:, 0], points[:, 2]
        if patch in ("hull", "stern"):
            assert np.abs(gap).max() < 1e-4  # of the facets that appendages cut
            assert (x.min() > run - 0.03) if patch == "hull" else (x.max() < run + 0.03)
        else:
            assert gap.min() > -1e-4
            assert np.all(z < 0.0) if patch == "sail" else np.all(x < run)
    triangles = aff8.vertices[aff8.faces]
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2.0
    sail, four = groves.sail(profiles.suboff_profile).surface, 4.0 * groves.plane(profiles.suboff_profile).surface
    for patch, exact in (("sail", sail), ("fins", four)):
        own = area[aff8.patch == aff8.patches.index(patch)].sum()
        assert own == pytest.approx(profiles.FOOT**2 * exact, rel=2e-3)


def test_chords(aff8: TowedBody) -> None:
    assert aff8.chord["hull"] == aff8.chord["stern"] == pytest.approx(aff8.length, abs=1e-8)
    assert aff8.chord["sail"] == pytest.approx(0.3683, abs=1e-4)
    assert aff8.chord["fins"] == pytest.approx(0.1838, abs=1e-4)  # 0.60317 ft halfway along the exposed half-chord line


def test_facets_of_the_hull_are_fine_where_it_bends() -> None:
    """Halfway along its edges the bare hull lies within 0.1 mm of its meridian: 1/80 of a cell of 1/512 of the length."""
    bare = body("suboff_bare_hull")
    fine = towed(bare, bare.reference_point)
    assert fine.patches == ("hull", "stern")
    ends = fine.vertices[fine.faces]
    middles = ((ends + np.roll(ends, 1, axis=1)) / 2.0).reshape(-1, 3)
    assert np.abs(above_the_meridian(fine, middles)).max() < 1e-4


@pytest.mark.parametrize(
    ("name", "mirrors", "fourfold"),
    [
        ("suboff_bare_hull", (False, True, True), True),
        ("suboff_hull_planes", (False, True, True), True),
        ("suboff_aff8", (False, True, False), False),
        ("naca0020_plane", (False, True, True), False),
        ("tow_spheroid", (True, True, True), True),
        ("finned_spheroid", (False, True, True), False),
        ("remus100", (False, True, True), True),
        ("huuv_mesh", (False, True, False), False),
    ],
)
def test_mirrors(name: str, mirrors: tuple[bool, bool, bool], fourfold: bool) -> None:
    found = in_tank(name)
    assert found.mirrors == mirrors
    assert found.fourfold == fourfold


def test_a_mirror_plane_beside_the_reference_point_is_none() -> None:
    found = towed(body("tow_spheroid"), np.array([0.1, 0.0, 0.01]), panels=FEW)
    assert found.mirrors == (False, True, False)
    assert not found.fourfold


def test_a_mirror_image_that_differs_by_a_millimetre_is_none(tmp_path: Path) -> None:
    other = SPHEROID.replace("tip = 0.15", "tip = 0.149", 1)
    assert written(tmp_path, other).mirrors == (False, True, False)


@pytest.mark.parametrize("angle", [0.3, 1e-3])
def test_a_turned_rudder_leaves_only_the_mirror_in_its_own_plane(planes: Body, angle: float) -> None:
    found = towed(planes, planes.reference_point, {"dr": angle}, FEW)
    assert found.mirrors == (False, False, True)
    assert not found.fourfold


def test_controls_turn_right_handed_about_their_hinges(planes: Body) -> None:
    """A positive rudder has its trailing edge to port, positive stern planes have theirs down; lengths stay."""
    straight, turned = (towed(planes, planes.reference_point, c, FEW) for c in ({}, {"dr": 0.2, "ds": 0.1}))
    assert edges(turned.faces).sound
    hinge = planes.controls[0].hinge - planes.reference_point
    for angle, toward, side in ((0.2, [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]), (0.1, [0.0, 0.0, 1.0], [0.0, 1.0, 0.0])):
        was, is_ = (corners(b, "fins") for b in (straight, turned))
        tip = was[np.isclose(was @ side, was[:, 2].max(), atol=1e-6)]
        edge = tip[np.argmin(tip[:, 0])] - hinge
        back = edge[0] * np.cos(angle)
        expected = (
            hinge
            + np.array([back, 0.0, 0.0])
            + np.multiply(side, edge @ side)
            - edge[0] * np.sin(angle) * np.array(toward)
        )
        assert np.linalg.norm(is_ - expected, axis=1).min() < 1e-8


def test_unknown_controls_name_those_that_are(planes: Body) -> None:
    with pytest.raises(InputError, match="no control") as known:
        towed(planes, planes.reference_point, {"rudder": 0.1}, FEW)
    assert known.value.expected == "one of dr, ds"
    with pytest.raises(InputError, match=r"\[\[control\]\]"):
        towed(body("tow_spheroid"), np.zeros(3), {"dr": 0.1}, FEW)


@pytest.mark.parametrize(("name", "found"), [("suboff", "particulars"), ("huuv", "no thickness")])
def test_what_encloses_nothing_cannot_be_towed(name: str, found: str) -> None:
    whole = body(name)
    with pytest.raises(InputError, match=found):
        towed(whole, whole.reference_point)


def test_a_control_by_degrees_in_place_of_radians(planes: Body) -> None:
    with pytest.raises(InputError, match="10 rad"):
        towed(planes, planes.reference_point, {"dr": 10.0}, FEW)


def test_a_part_that_the_hull_hides(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="which lies within the hull"):
        written(tmp_path, SPHEROID.replace("tip = 0.15", "tip = 0.04", 1))
    fin = next(p for p in body("naca0020_plane").pieces)
    spheroid = body("finned_spheroid")
    hidden = Piece("hidden", "hidden", lambda n: scaled(fin.surface(n), 0.1), fin.area, fin.chord)
    with pytest.raises(InputError, match="which lies wholly inside the body"):
        towed(replace(spheroid, pieces=(*spheroid.pieces, hidden)), spheroid.reference_point, panels=FEW)


def scaled(of: TriangleMesh, share: float) -> TriangleMesh:
    return TriangleMesh(share * of.vertices, of.faces)


def test_too_few_triangles() -> None:
    with pytest.raises(InputError, match="64 a part"):
        towed(body("finned_spheroid"), np.zeros(3), panels=100)


def test_the_file_is_the_same_byte_for_byte_and_holds_what_was_towed() -> None:
    first = in_tank("finned_spheroid", dr=0.1)
    towed(body("tow_spheroid"), np.zeros(3), panels=FEW)
    again = towed(body("finned_spheroid"), np.zeros(3), {"dr": 0.1}, FEW)
    assert stl(first) == stl(again)
    lines = stl(first).decode().splitlines()
    assert [line for line in lines if line.startswith("solid")] == [f"solid {name}" for name in first.patches]
    read = np.array([line.split()[1:] for line in lines if line.startswith("vertex")], dtype=float).reshape(-1, 3, 3)
    order = np.argsort(first.patch, kind="stable")
    assert np.array_equal(read, first.vertices[first.faces[order]])
    normal = np.array([line.split()[2:] for line in lines if line.startswith("facet")], dtype=float)
    outward = np.cross(read[:, 1] - read[:, 0], read[:, 2] - read[:, 0])
    assert np.all(np.einsum("ij,ij->i", normal, outward) > 0.0)


def test_a_mesh_file_is_taken_as_it_is() -> None:
    found = in_tank("huuv_mesh")
    assert found.patches == ("hull",)
    assert len(found.faces) == 4222
    simplified = in_tank("huuv_mesh_simplified")  # its parts stand for the same mesh
    assert stl(simplified) == stl(found)


def test_solids_that_a_text_stl_names_stay_patches(tmp_path: Path) -> None:
    first = in_tank("finned_spheroid", dr=0.1)
    (tmp_path / "body.stl").write_bytes(stl(first))
    (tmp_path / "body.toml").write_text(
        '[body]\nname = "again"\nreader = "mesh"\ndatum = "centre"\nreference_point = [0.0, 0.0, 0.0]\n'
        '[mesh]\npath = "body.stl"\nunit = "m"\naxes = "FRD"\n[source]\ncitation = "synthetic"\n'
    )
    again = read_body(tmp_path / "body.toml")
    found = towed(again, np.zeros(3))
    assert found.patches == first.patches
    assert stl(found) == stl(first)
    assert 0.09 < found.chord["rudder_upper"] < 0.12  # its extent along x, from middle to middle of its faces
    assert found.chord["hull"] == pytest.approx(1.0)


def written(folder: Path, text: str) -> TowedBody:
    (folder / "body.toml").write_text(text, encoding="utf-8")
    return towed(read_body(folder / "body.toml"), np.zeros(3), panels=FEW)


def test_names_become_words_of_a_case(tmp_path: Path) -> None:
    assert written(tmp_path, SPHEROID.replace("rudder_upper", "upper rudder")).patches[1] == "upper_rudder"


def test_the_section_is_that_of_suboffs_planes() -> None:
    q = np.linspace(0.0, 1.0, 41)
    assert finned.half_thickness(q, 0.2)[:-1] == pytest.approx(groves._half(q)[:-1], abs=1e-15)
    assert finned.half_thickness(q, 0.1) == pytest.approx(finned.half_thickness(q, 0.2) / 2.0)


def test_the_isolated_plane_is_suboffs() -> None:
    """Root cut where the half-chord line leaves the hull; the planform's area, and its mirror image below."""
    found = in_tank("naca0020_plane")
    foot = float(groves._foot(profiles.suboff_profile, np.array([0.5]), np.zeros(1))[0])
    root, tip = (profiles.FOOT * float(groves._chord(np.array(y))) for y in (foot, groves.TIP))
    span = profiles.FOOT * (groves.TIP - foot)
    assert found.length == pytest.approx(root, rel=1e-5)
    assert found.vertices[:, 2].max() == pytest.approx(span, rel=1e-5)
    assert found.chord["plane"] == pytest.approx((root + tip) / 2.0, rel=1e-5)
    assert mesh_integrals(found.vertices, found.faces).projected[1] == pytest.approx(span * (root + tip), rel=1e-4)


@pytest.mark.parametrize(
    ("was", "is_", "line", "found"),
    [
        ('section = "NACA 0020"', 'section = "NACA 2412"', 26, "NACA 2412"),
        ("root = 0.02", "root = 0.2", 26, "a root at 0.2 m"),
        ('parts = ["rudder_upper"', 'parts = ["rudder"', 44, "no part"),
        ("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.0, 0.0]", 44, "an axis without a direction"),
        ('name = "rudder_lower"', 'name = "rudder_upper"', 34, "two parts called"),
    ],
)
def test_a_wrong_body_is_refused_at_its_line(tmp_path: Path, was: str, is_: str, line: int, found: str) -> None:
    with pytest.raises(InputError, match=found) as why:
        written(tmp_path, SPHEROID.replace(was, is_, 1))
    assert why.value.file == tmp_path / "body.toml"
    assert abs(why.value.line - line) <= 4


def test_a_mesh_by_itself_is_answered_with_the_body_toml_that_it_needs(tmp_path: Path) -> None:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
    faces = ConvexHull(corners).simplices
    outward = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
    faces[(outward * corners[faces].mean(1)).sum(1) < 0.0] = faces[(outward * corners[faces].mean(1)).sum(1) < 0.0][
        :, ::-1
    ]
    records = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    records["corners"] = corners[faces]
    mesh = tmp_path / "box.stl"
    mesh.write_bytes(b"\x80" * 80 + len(faces).to_bytes(4, "little") + records.tobytes())
    with pytest.raises(InputError, match="found a mesh") as why:
        read_body(mesh)
    (tmp_path / "body.toml").write_text(str(why.value).partition("\n")[2])
    found = towed(read_body(tmp_path / "body.toml"), np.zeros(3))
    assert found.length == pytest.approx(1.0)
    assert found.patches == ("hull",)
