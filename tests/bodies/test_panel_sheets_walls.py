"""Panels without thickness, walls by images, exact mirrors and the target of the error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.added_mass import panel
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.panel_solver import influence as kernel
from coeflab.bodies.panel_solver.influence import exact_integrals, gradients
from coeflab.bodies.panel_solver.panels import bisected, graded, panels_of, sharp_points
from coeflab.bodies.panel_solver.solve import panel_added_mass
from coeflab.bodies.panel_solver.wall import Wall
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Part, Parts, Plate, Shape
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.types import Array

ORIGIN, NOTHING = np.zeros(3), np.zeros((0, 3, 3))
RHO = 1000.0


def body(shape: Shape) -> Body:
    hull = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    return replace(hull, shape=shape, reference_point=np.zeros(3))


def one(form: Box | Plate | Cylinder | Ellipsoid, *at: float) -> Part:
    return Part(f"p{at}", form, np.array(at or (0.0, 0.0, 0.0)), np.eye(3))


def rectangle(chord: float, span: float, count: int) -> Array:
    return bisected(panel._rectangle(one(Plate(chord, span))), count)


def ball(panels: int) -> Array:
    mesh = meshed(Parts((one(Ellipsoid(1.0, 1.0, 1.0)),)), panels)
    return np.asarray(mesh.vertices[mesh.faces])


@pytest.mark.parametrize("reach", [5.0, 100.0])
def test_slopes_are_those_of_differences(monkeypatch: pytest.MonkeyPatch, reach: float) -> None:
    """Rings and Hess & Smith's logarithms against central differences of the exact integrals, near and far."""
    chance = np.random.default_rng(0)
    panels = panels_of(0.3 * chance.normal(size=(40, 3, 3)) + chance.normal(size=(40, 1, 3)))
    at, way = chance.normal(size=(30, 3)), chance.normal(size=(30, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]

    def exact(targets: Array) -> tuple[Array, Array]:
        """Solid angles (m, n), integrals of n / r (m, 3)."""
        m, n = len(targets), panels.count
        i, j = np.repeat(np.arange(m), n), np.tile(np.arange(n), m)
        angle, inverse = exact_integrals(targets[i], panels.corners[j], panels.normal[j])
        return angle.reshape(m, n), inverse.reshape(m, n) @ panels.normal

    (high, layer), (low, below) = (exact(at + s * 1e-5 * way) for s in (1.0, -1.0))
    monkeypatch.setattr(kernel, "REACH", reach)
    velocity, slope, itself = gradients(at, way, panels)
    for found, wanted in (
        (velocity, (high - low) / 2e-5),
        (slope, (layer - below) / 2e-5),
        (itself, (layer + below) / 2.0),
    ):
        assert np.max(np.abs(found - wanted)) < 1e-3 * np.max(np.abs(wanted))
    # Near panels are a hundred times as large: those by dipoles are judged by themselves.
    far = np.linalg.norm(at[:, None] - panels.centre, axis=2) > reach * panels.size
    assert far.any() == (reach == 5.0)
    wanted = ((high - low) / 2e-5)[far]
    assert np.max(np.abs(velocity[far] - wanted), initial=0.0) <= 0.01 * np.max(np.abs(wanted), initial=0.0)


@pytest.mark.parametrize(("aspect", "printed"), [(1.0, 0.579), (2.0, 0.757)])
def test_plates_hold_the_printed_coefficients(aspect: float, printed: float) -> None:
    """DNV-RP-H103 (2011), Table A-2, rectangular plates: 0.579 and 0.757 of pi/4 rho c^2 b."""
    found = panel.added_mass(body(Parts((one(Plate(1.0, aspect)),))), RHO, {"panels": 1100})
    assert found.matrix[2, 2] == pytest.approx(printed * np.pi / 4.0 * RHO * aspect, rel=0.006)
    assert abs(found.matrix[2, 2] - printed * np.pi / 4.0 * RHO * aspect) < found.error[2, 2]
    assert not np.any(found.matrix[:2])
    assert "dipole panels" in found.statements[1]


def test_a_plate_far_from_a_ball_adds_to_it() -> None:
    plate = rectangle(1.0, 1.0, 100) + np.array([0.0, 0.0, 30.0])
    both = panel_added_mass(ball(500), ORIGIN, False, plate).matrix
    apart = panel_added_mass(ball(500), ORIGIN, False).matrix + panel_added_mass(NOTHING, ORIGIN, False, plate).matrix
    assert both[:3, :3] == pytest.approx(apart[:3, :3], abs=1e-4)


def test_a_fin_as_a_sheet_is_near_the_fin_as_a_box() -> None:
    """What lies within the hull is left out of the sheet; the box is a little more for its thickness."""
    hull = one(Cylinder(0.5, 3.0))
    sheet = panel.added_mass(body(Parts((hull, one(Plate(0.6, 2.0), -1.0, 0.0, 0.0)))), RHO, {"panels": 2000})
    thick = panel.added_mass(body(Parts((hull, one(Box(0.6, 2.0, 0.06), -1.0, 0.0, 0.0)))), RHO, {"panels": 2000})
    bare = panel.added_mass(body(Parts((hull,))), RHO, {"panels": 2000})
    more = np.array([f.matrix[2, 2] - bare.matrix[2, 2] for f in (sheet, thick)])
    assert 0.8 < more[0] / more[1] < 1.02
    assert sheet.matrix[2, 4] > 0.0
    assert sheet.verdict == "symmetric, positive semidefinite"


def dipoles(height: float, factor: float, power: int) -> float:
    """Added mass of a circle (2) or a sphere (3) of unit radius over that far from walls, moving along the normal.

    A dipole, its image behind the wall, the image of that in the body and so on: Lamb, Hydrodynamics (1932), 138 for
    spheres, the same with squares for circles; the first term is 3/8 (a/h)^3 of a sphere (Lamb 138, (9)).
    """
    strength, away, total = 1.0, 2.0 * height, 0.0
    for _ in range(60):
        strength *= factor / away**power
        total += strength
        away = 2.0 * height - 1.0 / away
    return 1.0 + power * total


@pytest.mark.parametrize("factor", [1.0, -1.0])
@pytest.mark.parametrize("height", [1.5, 3.0])
def test_a_sphere_near_a_wall_is_lambs(factor: float, height: float) -> None:
    corners = ball(1500)
    wall = Wall(np.array([0.0, 0.0, height]), np.array([0.0, 0.0, 1.0]), factor)
    near, free = (panel_added_mass(corners, ORIGIN, False, wall=w).matrix for w in (wall, None))
    assert near[2, 2] / free[2, 2] == pytest.approx(dipoles(height, factor, 3), abs=3e-3)
    along = 1.0 + factor * 3.0 / 16.0 / height**3
    assert near[0, 0] / free[0, 0] == pytest.approx(along, abs=4e-3 if height < 2.0 else 5e-4)


def test_a_long_cylinder_near_a_bottom_has_the_images_of_a_circle() -> None:
    """Two lengths, so that the ends cancel: per length it is the plane flow, the same along and across the wall."""
    wall = Wall(np.array([0.0, 0.0, 1.5]), np.array([0.0, 0.0, 1.0]), 1.0)
    found = []
    for length in (10.0, 14.0):
        mesh = meshed(Parts((one(Cylinder(1.0, length)),)), int(150 * length))
        found.append(panel_added_mass(mesh.vertices[mesh.faces], ORIGIN, False, wall=wall).matrix)
    per = (found[1] - found[0]) / 4.0 / np.pi
    assert per[2, 2] == pytest.approx(dipoles(1.5, 1.0, 2), rel=0.02)
    assert per[1, 1] == pytest.approx(dipoles(1.5, 1.0, 2), rel=0.03)


def test_a_wall_is_the_body_twice() -> None:
    """A box and a sheet beside a wall, moving along it: half of what they and their mirror images move together."""
    box_corners = np.multiply(1.0, box_surface(np.array([0.5, 0.4, 0.3]), 200)[0])[
        box_surface(np.array([0.5, 0.4, 0.3]), 200)[1]
    ]
    upright = rectangle(0.5, 0.5, 60)[:, :, [2, 0, 1]] + np.array([0.7, 0.0, 0.0])
    wall = Wall(np.array([0.0, 0.0, 0.4]), np.array([0.0, 0.0, 1.0]), 1.0)
    near = panel_added_mass(box_corners, ORIGIN, False, upright, wall).matrix
    images = [wall.behind(c.reshape(-1, 3)).reshape(-1, 3, 3)[:, ::-1] for c in (box_corners, upright)]
    twice = panel_added_mass(
        np.concatenate([box_corners, images[0]]), ORIGIN, False, np.concatenate([upright, images[1]])
    ).matrix
    assert near[:2, :2] == pytest.approx(twice[:2, :2] / 2.0, rel=1e-4, abs=1e-6)


def test_a_body_in_the_wall_is_refused() -> None:
    with pytest.raises(InputError) as caught:
        panel.added_mass(
            body(Parts((one(Box(1.0, 1.0, 1.0)),))), RHO, {"panels": 1000, "wall": "bottom", "distance": 0.4}
        )
    assert "reaches 0.5 m" in caught.value.found
    assert caught.value.expected == "more than 0.5 m"


def test_mirrors_are_exact() -> None:
    """A cube: one mass, one inertia and zeros, to the last digit; a wall leaves the two mirrors across it."""
    whole = Parts((one(Box(1.0, 1.0, 1.0)),))
    found = panel.added_mass(body(whole), RHO, {"panels": 1000}).matrix
    assert np.count_nonzero(found) == 6
    assert found[0, 0] == found[1, 1] == found[2, 2]
    assert found[3, 3] == found[4, 4] == found[5, 5]
    near = panel.added_mass(body(whole), RHO, {"panels": 1000, "wall": "bottom", "distance": 1.0}).matrix
    assert near[2, 2] > near[0, 0] == near[1, 1]
    assert near[0, 4] == -near[1, 3] != 0.0
    assert np.count_nonzero(near) == 10


def test_panels_are_raised_until_the_error_is_met() -> None:
    shape = body(Parts((one(Ellipsoid(1.0, 0.5, 0.5)),)))
    coarse = panel.added_mass(shape, RHO, {"panels": 1000})
    fine = panel.added_mass(shape, RHO, {"panels": 1000, "error": "2%"})
    live = np.diag(fine.matrix) > 0.0
    assert fine.error is not None
    assert coarse.error is not None
    assert np.all(np.diag(fine.error)[live] <= 0.02 * np.diag(fine.matrix)[live])
    assert not np.all(np.diag(coarse.error)[live] <= 0.02 * np.diag(coarse.matrix)[live])
    with pytest.raises(InputError, match="in per cent such as 2%"):
        panel.added_mass(shape, RHO, {"error": "two"})


def test_an_error_out_of_reach_is_a_status(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel, "MOST_PANELS", 1100)
    found = panel.added_mass(body(Parts((one(Box(1.0, 1.0, 1.0)),))), RHO, {"panels": 1000, "error": 1e-4})
    assert found.statements[0].startswith("ERROR NOT REACHED: 0.0001 was asked for, ")
    assert "that of Kpdot" in " ".join(found.statements)


def test_grading_makes_edges_finer_on_the_same_facets() -> None:
    vertices, faces = box_surface(np.ones(3), 100)
    found = graded(vertices[faces], 1000, sharp_points(vertices, faces, 0.05))
    panels = panels_of(found)
    assert 900 <= panels.count <= 1100
    assert panels.area.sum() == pytest.approx(6.0, rel=1e-12)
    off = 0.5 - np.sort(np.abs(panels.centre), axis=1)[:, 1]
    assert np.median(panels.size[off < 0.05]) < 0.6 * np.median(panels.size[off > 0.3])
