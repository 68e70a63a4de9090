"""Tubes, revolutions, fins, bars and mesh parts: integrals against their meshes, added mass against panels, body.toml."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.added_mass import primitives
from coeflab.bodies.body import Body
from coeflab.bodies.mesh import solids
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import form_surface, meshed, surface_of
from coeflab.bodies.mesh.source import ply
from coeflab.bodies.mirror_planes import mirrors
from coeflab.bodies.panel_solver.solve import panel_added_mass
from coeflab.bodies.readers.primitives import read
from coeflab.bodies.shape import (
    Agreement,
    Bar,
    Cylinder,
    Faceted,
    Finned,
    Form,
    Part,
    Parts,
    Tube,
    Turned,
    as_revolution,
    shadow,
)
from coeflab.bodies.simplify.part_file import part_file
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import Source
from coeflab.law.transforms import rotation

PROFILE = Turned.about_its_centre(np.array([0.0, 0.2, 0.5, 1.5, 2.0]), np.array([0.0, 0.1, 0.2, 0.2, 0.05]))[0]
WEDGE = Faceted.about_its_centre(TriangleMesh(*form_surface(PROFILE, 2000)))[0]
FORMS: dict[str, Form] = {
    "tube": Tube(0.16, 0.13, 0.1), "revolution": PROFILE, "bar": Bar(1.0, 0.1, 0.05), "four fins": Finned(0.1, 0.3, 0.2, 0.01),
    "two fins": Finned(0.1, 0.3, 0.2, 0.01, 2), "mesh": WEDGE,
}  # fmt: skip
SKEW = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, 0.5, 0.8])


def body(*parts: Part, agreement: Agreement | None = None) -> Body:
    shape = Parts(parts, agreement)
    return Body("b", "b", Datum("nose"), np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), shape)


def part(form: Form, turn: np.ndarray | None = None, centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Part:
    return Part("p", form, np.array(centre), np.eye(3) if turn is None else turn)


def panels(surface: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    vertices, faces = surface
    return np.diag(panel_added_mass(vertices[faces], np.zeros(3), compiled=False).matrix)


@pytest.mark.parametrize("name", FORMS)
def test_integrals_are_those_of_the_mesh(name: str) -> None:
    """Fins of the mesh reach 3 % of the root's radius further inward, which a hull covers."""
    form = FORMS[name]
    within = 0.025 if isinstance(form, Finned) else 0.012
    vertices, faces = form_surface(form, 4000)
    turn = rotation(0.4, -0.3, 1.1)
    own = meshed(Parts((part(form, turn),)), 4000) if not isinstance(form, Finned) else None
    whole = TriangleMesh(vertices, faces).integrals
    assert form.volume == pytest.approx(whole.volume, rel=within)
    assert part(form).second_moments == pytest.approx(whole.second_moments / whole.volume, rel=within, abs=1e-6)
    assert surface_of(form) == pytest.approx(whole.area, rel=0.12)
    assert form.half_extents(np.eye(3)) == pytest.approx(np.ptp(vertices, axis=0) / 2.0, rel=2e-3)
    if own is not None:
        assert form.half_extents(turn) == pytest.approx(own.extents / 2.0, rel=2e-3)
        middle = (own.vertices.min(axis=0) + own.vertices.max(axis=0)) / 2.0
        if not isinstance(form, Turned):
            assert part(form, turn).middle == pytest.approx(middle, abs=2e-3)
    corner = vertices[faces]
    area = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    for direction in (*np.eye(3), SKEW):
        assert shadow(form, direction) == pytest.approx(np.abs(area @ direction).sum() / 4.0, rel=within)


def test_a_revolution_of_two_stations_is_the_cylinder() -> None:
    turned, rod = Turned((-1.0, 1.0), (0.2, 0.2)), Cylinder(0.2, 2.0)
    assert turned.volume == pytest.approx(rod.volume, rel=1e-12)
    assert turned.spread == pytest.approx(rod.spread, rel=1e-12)
    assert turned.half_extents(rotation(0.1, 0.2, 0.3)) == pytest.approx(rod.half_extents(rotation(0.1, 0.2, 0.3)))
    for direction in (*np.eye(3), SKEW):
        assert shadow(turned, direction) == pytest.approx(shadow(rod, direction), rel=1e-12)


def test_a_revolution_has_no_fore_and_aft_symmetry_unless_it_is_one() -> None:
    assert mirrors(Parts((part(PROFILE),))) == (False, True, True)
    assert mirrors(Parts((part(Turned((-1.0, 1.0), (0.2, 0.2))),))) == (True, True, True)


def test_as_a_body_of_revolution_it_keeps_its_volume_turned_round() -> None:
    found = as_revolution(Parts((part(PROFILE, rotation(0.0, 0.0, np.pi)),)))
    assert found.volume == pytest.approx(PROFILE.volume, rel=1e-12)
    assert float(np.max(found.x)) == pytest.approx(-PROFILE.stations[0], abs=0.05)


def test_bars_against_panels() -> None:
    """Roll of so few panels is a sixth more."""
    for form in (Bar(1.0, 0.1, 0.1), Bar(1.0, 0.2, 0.1), Bar(1.0, 0.1, 0.03)):
        found = np.diag(primitives.added_mass(body(part(form)), 1.0).matrix)
        exact = panels(form_surface(form, 1500))
        assert np.delete(found, 3) == pytest.approx(np.delete(exact, 3), rel=0.11)
        assert found[3] == pytest.approx(exact[3], rel=0.2)


@pytest.mark.slow
def test_fins_add_to_a_hull_what_panels_say() -> None:
    """Four fins of 7 % thickness on a long cylinder: 4 % less than panels, which count the thickness."""
    fins, rod = Finned(0.12, 0.25, 0.15, 0.01), Cylinder(0.12, 1.2)
    hull = solids.solid(*form_surface(rod, 1500))
    united = hull
    for one in solids.pieces(solids.solid(*form_surface(fins, 400))):
        united = united + one
    bare, finned = (panels(solids.surface(solids.divided(s, 0.045, 20_000))) for s in (hull, united))
    found = np.diag(primitives.added_mass(body(part(fins)), 1.0).matrix)
    assert found[1] == found[2]
    assert found[1] == pytest.approx((finned - bare)[1], rel=0.15)
    assert found[3] == pytest.approx(finned[3], rel=0.4)
    assert found[0] == 0.0


def test_a_tube_takes_the_water_within_along() -> None:
    """Long and thin-walled: sideways what a cylinder displaces and what is within, twice; along little."""
    radius, length = 0.1, 2.0
    found = np.diag(primitives.added_mass(body(part(Tube(radius, 0.09, length))), 1.0).matrix)
    sections = np.pi * (radius**2 + 0.09**2) * length
    assert found[1] == pytest.approx(sections, rel=0.08)
    assert found[0] < 0.02 * sections


def test_a_mesh_part_is_the_panel_method_on_it() -> None:
    result = primitives.added_mass(body(part(WEDGE)), 1.0)
    assert np.diag(result.matrix)[:3] == pytest.approx(panels(form_surface(PROFILE, 3000))[:3], rel=0.04)
    assert any(s.startswith("p: the panel method on the part alone") for s in result.statements)


def test_no_agreement_is_told_where_the_mesh_itself_is_not_resolved() -> None:
    assert Agreement((0.1, -0.13, None, 0.0, 0.0, 0.0), 0.35).unresolved
    assert not Agreement((0.1, -0.13, None, 0.0, 0.0, 0.0), 0.14).unresolved
    assert not Agreement((0.1, -0.13, None, 0.0, 0.0, 0.0), None).unresolved


def test_a_tall_disagreement_makes_parts_rough() -> None:
    near = Agreement((0.1, -0.14, None, 0.0, 0.0, 0.0), 0.02)
    far = Agreement((0.1, -0.16, None, 0.0, 0.0, 0.4), 0.02)
    assert Parts((part(PROFILE),), near).rough == ()
    assert Parts((part(PROFILE),), far).rough == ("added mass off the mesh's: v -16 %, r +40 %",)


@pytest.mark.parametrize("error", [0.05, None])
def test_the_file_of_every_form_is_read_again(error: float | None, tmp_path: Path) -> None:
    parts = [
        Part(name.replace(" ", "_"), form, np.array([k, 0.5, 0.0]), rotation(0.0, 0.0, 0.5))
        for k, (name, form) in enumerate(FORMS.items())
    ]
    made = body(*parts, agreement=Agreement((0.1, None, -0.2, 0.0, 0.3, 0.0), error))
    path = tmp_path / "body.toml"
    path.write_bytes(part_file(made, made.shape, (), {}))
    (tmp_path / "mesh.ply").write_bytes(ply(WEDGE.mesh.vertices, WEDGE.mesh.faces))
    again = read(path).require_shape()
    assert again.agreement == made.shape.agreement
    for p, q in zip(again.parts, parts, strict=True):
        assert p.centre == pytest.approx(q.centre, abs=1e-9)
        assert p.rotation == pytest.approx(q.rotation, abs=1e-6)
        assert type(p.form) is type(q.form)
        assert p.form.volume == pytest.approx(q.form.volume, rel=1e-9)


def test_stations_may_start_anywhere(tmp_path: Path) -> None:
    """The centre of volume is found; ``centre`` says where the stations' zero lies."""
    path = tmp_path / "body.toml"
    path.write_text(
        '[body]\nname = "cone"\ntitle = "cone"\nreader = "primitives"\ndatum = "tip"\nreference_point = [0.0, 0.0, 0.0]\n'
        '[source]\ncitation = "synthetic"\nkind = "synthetic"\n[[part]]\nname = "cone"\nform = "revolution"\n'
        'stations = ["-1 m", 0.0]\nradii = [0.5, 0.0]\ncentre = [2.0, 0.0, 0.0]\n'
    )
    found = read(path).require_shape()
    assert found.volume == pytest.approx(np.pi * 0.25 / 3.0, rel=1e-12)
    assert found.centre_of_volume == pytest.approx([2.0 - 0.75, 0.0, 0.0], abs=1e-12)
    assert found.length == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: Tube(0.1, 0.1, 1.0), "an inner radius below the outer one"),
        (lambda: Turned((0.0, 0.0), (0.1, 0.1)), "stations from aft to fore"),
        (lambda: Turned((0.0, 1.0), (0.1,)), "as many radii as stations"),
        (lambda: Turned((0.0, 1.0), (0.1, -0.1)), "radii of at least zero"),
        (lambda: Finned(0.1, 0.1, 0.1, 0.01), "tips beyond the hull"),
        (lambda: Finned(0.1, 0.2, 0.1, 0.01, 3), "2 or 4"),
        (lambda: Finned(0.1, 0.2, 0.1, 0.3), "less than the hull's diameter"),
        (lambda: Bar(1.0, 0.0, 0.1), "width = 0 m of a box"),
        (lambda: Agreement((0.0,), 0.1), "6: u, v, w, p, q, r"),
    ],
)
def test_what_no_form_is(made: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        made()  # type: ignore[operator]
