"""The Stonefish export: its own law from closed forms, its mesh, and the drag that it meets at the file's speed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.core.errors import InputError
from coeflab.core.text.xml import parse_xml
from coeflab.formats.export import export
from coeflab.formats.loss import covered_grid
from coeflab.formats.stonefish import write as exporter
from coeflab.formats.stonefish.drags import StonefishLink, met_at_speed
from coeflab.formats.stonefish.law import added, ellipsoid_mesh, raw_drag, weighed
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import CENTRE, MASS, OWN, torpedo, with_mass

GOLDEN = Path(__file__).parent / "golden"
SIDES = np.array([2.0, 0.5, 0.4])
AXES = np.array([1.0, 0.2, 0.15])


def box() -> np.ndarray:
    """Triangles, seen from outside counter-clockwise."""
    return np.array(trimesh.creation.box(extents=SIDES).triangles)


def only(*components: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([components[:3]]), np.array([components[3:] or (0.0, 0.0, 0.0)])


def test_golden() -> None:
    """Regenerate by hand: write exporter.render(with_mass(plain())) to golden/stonefish.* and read the difference."""
    found = exporter.render(with_mass(made.plain()))
    assert found == {f"file.{s}": (GOLDEN / f"stonefish.{s}").read_bytes() for s in ("obj", "scn")}


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_box_has_the_cube_of_its_speed_on_its_front_and_friction_on_its_sides(axis: int) -> None:
    v, w = np.zeros((1, 3)), np.zeros((1, 3))
    v[0, axis] = 1.7
    form, form_torque, skin, skin_torque = raw_drag(box(), v, w)
    front = np.prod(SIDES) / SIDES[axis]
    sides = 2.0 * sum(np.prod(SIDES) / SIDES[k] for k in range(3) if k != axis)
    assert form[0, axis] == pytest.approx(-front * 1.7**3)
    assert skin[0, axis] == pytest.approx(-sides * 1.7)
    np.testing.assert_allclose([*form_torque[0], *skin_torque[0]], 0.0, atol=1e-12)


def test_form_drag_is_against_the_motion_and_sees_the_projected_area() -> None:
    v, w = only(1.2, 0.5, -0.3)
    form = raw_drag(box(), v, w)[0][0]
    fronts = np.prod(SIDES) / SIDES
    np.testing.assert_allclose(form, -v[0] * np.linalg.norm(v) * np.sum(fronts * np.abs(v[0])))


def test_coefficients_are_weighed_by_direction() -> None:
    raw = np.array([[3.0, -4.0, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(
        weighed(raw, np.array([0.1, 1.0, 9.0])), [[3.0 * (0.06 + 0.8), -4.0 * (0.06 + 0.8), 0], [0, 0, 0]]
    )


def test_many_states_are_each_as_one() -> None:
    nu = np.random.default_rng(5).normal(size=(300, 6))
    corners = box()
    together = raw_drag(corners, nu[:, :3], nu[:, 3:])
    for k in (0, 127, 128, 299):
        for many, one in zip(together, raw_drag(corners, nu[k : k + 1, :3], nu[k : k + 1, 3:]), strict=True):
            np.testing.assert_allclose(many[k], one[0], rtol=1e-12, atol=1e-12)


def test_the_mesh_is_closed_turned_outwards_and_even() -> None:
    centre = np.array([0.3, -0.1, 0.2])
    vertices, faces = ellipsoid_mesh(AXES, centre)
    edges = {(int(f[i]), int(f[(i + 1) % 3])) for f in faces for i in range(3)}
    assert len(edges) == 3 * len(faces)
    assert {(b, a) for a, b in edges} == edges
    integrals = mesh_integrals(vertices, faces)
    assert integrals.volume == pytest.approx(4.0 / 3.0 * np.pi * np.prod(AXES), rel=0.06)
    np.testing.assert_allclose(integrals.centre, centre, atol=1e-12)
    corners = vertices[faces]
    sizes = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert sizes.max() < 3.0 * sizes.mean()


def test_added_mass_is_the_mean_of_three_by_the_sources_own_formula() -> None:
    vertices, faces = ellipsoid_mesh(AXES, np.zeros(3))
    mass, moments = added(vertices[faces], 1000.0)
    a, b, c = AXES
    r = (b + c) / 2.0
    e = 1.0 - r**2 / a
    alpha = 2.0 * (1.0 - e**2) / e**2 * (0.5 * np.log((1.0 + e) / (1.0 - e)) - e)
    three = 4.0 / 3.0 * np.pi * 1000.0 * np.array([alpha / (2.0 - alpha) * a * r**2, a * c**2, a * b**2])
    assert mass == pytest.approx(three.mean(), rel=1e-9)
    np.testing.assert_allclose(moments, np.pi * 1000.0 / 12.0 * a**3 * np.array([0.0, b**2, c**2]), rtol=1e-9)


def bare(file: ParameterFile) -> StonefishLink:
    none = np.zeros(3)
    return replace(exporter._fitted(file).link, form=none, skin=none)


def at_speed(file: ParameterFile) -> StonefishLink:
    """The link with the drags that meet the file at its speed, whichever the export chooses."""
    found = met_at_speed(file, bare(file))
    return replace(bare(file), form=found[:3], skin=found[3:])


def test_drags_meet_the_file_in_value_and_slope_at_its_speed() -> None:
    file = with_mass(made.parameters({"X0": -1.5e-3, "Xu|u|": -5e-4, "Yv|v|": -0.1}, made.HULL), np.zeros(3))
    link, law, speed = at_speed(file), force_law(file), file.conditions.speed
    for axis, exact in ((0, True), (1, True), (2, False)):
        at = np.eye(6)[axis] * speed
        nu = np.array([at, at * 1.001, at * 0.999])
        theirs, ours = link.force(nu)[:, axis], law.force(nu)[:, axis]
        if exact:
            assert theirs[0] == pytest.approx(ours[0], rel=1e-6)
            assert theirs[1] - theirs[2] == pytest.approx(ours[1] - ours[2], rel=1e-5)
        else:
            np.testing.assert_allclose(theirs, 0.0, atol=1e-9)
    for part, ratio in ((0.5, 1.25), (1.5, 2.4375 / 2.25)):
        nu = np.array([[part * speed, 0, 0, 0, 0, 0]])
        assert link.force(nu)[0, 0] / law.force(nu)[0, 0] == pytest.approx(ratio, rel=1e-6)


def test_damping_at_rest_is_friction() -> None:
    file = with_mass(made.parameters({"Xu": -1e-3, "Yv": -3e-2}, law="rest"), np.zeros(3))
    slow = 0.3 * np.eye(6)[:2]
    np.testing.assert_allclose(np.diag(at_speed(file).force(slow)), np.diag(force_law(file).force(slow)), rtol=1e-6)


def rms(link: StonefishLink, file: ParameterFile) -> np.ndarray:
    """Of X, Y, Z over the covered range."""
    nu, _ = covered_grid(file)
    return np.sqrt(np.mean((link.force(nu) - force_law(file).force(nu))[:, :3] ** 2, axis=0))


def test_drags_that_would_be_worse_than_none_give_way_to_least_squares() -> None:
    """The torpedo's drag at its speed makes X over twenty times worse in drift and turning than no drag at all."""
    file = torpedo()
    chosen = exporter._fitted(file)
    none, met, written = rms(bare(file), file), rms(at_speed(file), file), rms(chosen.link, file)
    assert not chosen.met
    assert met[0] > 20.0 * none[0]
    assert np.all(written <= none)
    np.testing.assert_allclose([chosen.none, chosen.at_speed, chosen.least], [none, met, written], rtol=1e-12)
    said = " ".join(exporter.changes(file))
    for errors in (none, met, written):
        assert f"X {errors[0]:.3g} Y {errors[1]:.3g} Z {errors[2]:.3g}" in said
    assert "X0" in exporter.not_held(file)
    straight = file.conditions.speed * np.eye(6)[:1]
    ahead = chosen.link.force(straight)[0, 0] / force_law(file).force(straight)[0, 0]
    assert f"straight ahead at that speed the drag is {ahead:.3g} of the file's" in said
    assert exporter.force(exporter.render(file), np.eye(6)[:1]) == pytest.approx(chosen.link.force(np.eye(6)[:1]))


def test_least_squares_is_the_least() -> None:
    """No other coefficient nearby, none negative, has a smaller sum of squares, each force over its error without drag."""
    file = torpedo()
    (nu, _), link = covered_grid(file), exporter._fitted(file).link
    columns = link.per_coefficient(nu)[:, :3]
    found = np.concatenate([link.form, link.skin])
    wanted = (force_law(file).force(nu) - link.force(nu))[:, :3] + columns @ found

    def misfit(coefficients: np.ndarray) -> float:
        errors = np.mean((wanted - columns @ coefficients) ** 2, axis=0)
        return float(np.sum(errors / np.mean(wanted**2, axis=0)))

    for axis in np.eye(6):
        for step in (-1e-3, 1e-3):
            assert misfit(np.maximum(found + step * axis, 0.0)) >= misfit(found) * (1.0 - 1e-6)
    assert misfit(found) < 0.8 * misfit(np.zeros(6))


@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull", "suboff_bare_hull_cfd"])
def test_suboff_has_no_force_that_drag_makes_worse(suboff: Study, name: str) -> None:
    """AFF-8's drag at its speed doubles the error of X; the bare hull's is good, and meets the resistance at its speed."""
    file = made.slopes_alone(suboff.parameter_files[name])
    chosen = exporter._fitted(file)
    assert chosen.met == (name != "suboff_fully_appended")
    assert ("X0" in exporter.not_held(file)) == (not chosen.met)
    assert np.all(rms(chosen.link, file) <= rms(bare(file), file) * (1.0 + 1e-9) + 1e-6)


def test_a_turn_has_the_inertia_of_the_added_mass_and_drift_no_munk_moment() -> None:
    """Without drag: -m w x v about the centre of gravity, alike in all directions."""
    file = with_mass(made.parameters({"Nv": -1e-2}, made.HULL), np.zeros(3))
    link = exporter._fitted(file).link
    mass, moments = added(link.corners, 1000.0)
    nu = np.random.default_rng(9).normal(size=(20, 6))
    v, w = nu[:, :3], nu[:, 3:]
    expected = np.hstack([-mass * np.cross(w, v), -np.cross(w, moments * w)])
    np.testing.assert_allclose(exporter.force(exporter.render(file), nu), expected, rtol=1e-9, atol=1e-9)


def test_forces_are_about_the_reference_point() -> None:
    """Moved by hand: the force at the centre of gravity times its arm."""
    file = torpedo()
    nu = np.array([[1.5, 0.1, -0.05, 0.0, 0.0, 0.0]])
    found = exporter.force(exporter.render(file), nu)[0]
    np.testing.assert_allclose(found[3:], np.cross(CENTRE, found[:3]), atol=1e-6 * np.abs(found).max())
    assert np.abs(found[3:]).max() > 1e-3


def test_mass_properties_are_the_files() -> None:
    body = parse_xml(exporter.render(torpedo())["file.scn"].decode()).find("robot/base_link")
    assert float(body.find("mass").get("value")) == MASS
    assert [float(x) for x in body.find("cg").get("xyz").split()] == CENTRE.tolist()
    np.testing.assert_allclose([float(x) for x in body.find("inertia").get("xyz").split()], np.diag(OWN))
    assert any("products of inertia are left out" in c for c in exporter.changes(torpedo()))


def test_the_mesh_displaces_the_mass() -> None:
    link = exporter._fitted(torpedo()).link
    volume = mesh_integrals(link.vertices, link.faces).volume
    assert volume * 1000.0 == pytest.approx(MASS, rel=0.06)


def test_the_loss_is_said() -> None:
    loss = export(torpedo(), "stonefish").loss
    assert not loss.lossless
    assert "square of the speed" in loss.not_held[0]
    assert "no Munk moment" in loss.not_held[1]
    assert {"Yv", "Nv", "Nr", "Yv|v|"} <= set(loss.not_held)
    assert "X0" in loss.not_held


def test_no_mesh_without_a_size() -> None:
    with pytest.raises(InputError, match="neither mass nor the added masses"):
        exporter.render(made.at_rest())


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_that_hurt(name: str) -> None:
    rendered = exporter.render(made.named(name))
    root = parse_xml(rendered[next(n for n in rendered if n.endswith(".scn"))].decode())
    assert root.find("robot/base_link/physical/mesh").get("filename") in rendered
    assert root.find("robot").get("name").isidentifier()
