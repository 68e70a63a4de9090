"""The solution on bodies whose added mass is known otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coeflab as cf
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.mesh.structured_surface import box_surface, revolved, rings
from coeflab.bodies.panel_solver import solve as kernel
from coeflab.bodies.panel_solver.solve import memory_needed, panel_added_mass
from coeflab.core.types import Array
from coeflab.law.transforms import moved, turned

ORIGIN = np.zeros(3)


def ellipsoid(axes: tuple[float, float, float], panels: int) -> Array:
    angle = np.linspace(np.pi, 0.0, 2001)
    radius = np.sin(angle)
    radius[[0, -1]] = 0.0
    vertices, faces = revolved(*rings(axes[0] * np.cos(angle), radius, panels))
    return np.asarray((vertices * np.array([1.0, axes[1], axes[2]]))[faces])


def box(sides: tuple[float, float, float], panels: int) -> Array:
    vertices, faces = box_surface(np.array(sides), panels)
    return np.asarray(vertices[faces])


def test_a_sphere_moves_half_its_volume_and_turns_freely() -> None:
    found = panel_added_mass(ellipsoid((1.0, 1.0, 1.0), 2000), ORIGIN, compiled=False)
    assert found.converged
    half = 2.0 * np.pi / 3.0
    assert np.diag(found.matrix)[:3] == pytest.approx(half, rel=0.015)
    assert np.max(np.abs(found.matrix[3:])) < 1e-3 * half


def test_the_error_on_a_spheroid_falls_with_the_square_of_the_size() -> None:
    exact = np.diag(ellipsoid_added_mass(np.array([3.0, 1.0, 1.0]), 1.0))[[0, 1, 2, 4, 5]]
    meshes = [ellipsoid((3.0, 1.0, 1.0), n) for n in (500, 2000)]
    found = [np.diag(panel_added_mass(m, ORIGIN, compiled=False).matrix)[[0, 1, 2, 4, 5]] for m in meshes]
    ratio = (found[0] - exact) / (found[1] - exact)
    order = np.log(ratio) / np.log(np.sqrt(len(meshes[1]) / len(meshes[0])))
    assert np.all(order > 1.7)
    assert np.all(order < 2.3)
    assert found[1] == pytest.approx(exact, rel=0.02)


def test_turned_and_moved_bodies_turn_and_move_their_matrix() -> None:
    corners = box((2.0, 1.0, 0.5), 600)
    own = panel_added_mass(corners, ORIGIN, compiled=False)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])
    away = np.array([5.0, -2.0, 1.0])
    point = np.array([4.0, 4.0, 4.0])
    found = panel_added_mass(corners @ turn.T + away, point, compiled=False)
    wanted = moved(turned(own.matrix, turn), point - away)
    # The two sides are scaled by different boxes, so near and far panels are the same but rounding is not.
    assert found.matrix == pytest.approx(wanted, rel=1e-6, abs=1e-6 * np.max(np.abs(wanted)))


def test_size_scales_masses_by_volume_and_inertias_by_its_five_thirds() -> None:
    corners = box((2.0, 1.0, 0.5), 600)
    small = np.diag(panel_added_mass(corners, ORIGIN, compiled=False).matrix)
    large = np.diag(panel_added_mass(10.0 * corners, ORIGIN, compiled=False).matrix)
    assert large / small == pytest.approx([1e3] * 3 + [1e5] * 3, rel=1e-6)


def test_a_cube_against_its_polarisability() -> None:
    """An insulating cube in a field has -1.6383 of its volume as polarisability: added mass 0.6383 of it.

    Sihvola, Yla-Oijala, Jarvenpaa & Avelin, Polarizabilities of Platonic solids, IEEE Trans. AP 52 (2004).
    """
    coarse, fine = (panel_added_mass(box((1.0, 1.0, 1.0), n), ORIGIN, compiled=False) for n in (768, 3072))
    assert (coarse.count, fine.count) == (768, 3072)
    limit = fine.matrix[0, 0] + (fine.matrix[0, 0] - coarse.matrix[0, 0]) / (2.0 ** (4.0 / 3.0) - 1.0)
    assert limit == pytest.approx(0.6383, rel=0.01)
    assert fine.matrix[0, 0] > 0.6383


def test_compiled_and_plain_agree() -> None:
    corners = ellipsoid((3.0, 1.0, 0.6), 1500)
    plain, fast = (panel_added_mass(corners, ORIGIN, compiled=c) for c in (False, True))
    assert fast.matrix == pytest.approx(plain.matrix, rel=1e-6, abs=1e-6)


def test_what_does_not_converge_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "MOST_STEPS", 2)
    found = panel_added_mass(box((4.0, 1.0, 0.2), 600), ORIGIN, compiled=False)
    assert not found.converged
    assert found.steps == 2
    assert found.residual > 1e-4


def test_memory_is_stated() -> None:
    assert memory_needed(8_000) == 4 * 8_000**2 + 400 * 2**20
    assert memory_needed(32_000) < 8 * 2**30


def test_a_body_asked_for_again_with_another_mass_in_other_water_is_not_solved_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    first = cf.vehicle("remus100", mass=30.5)
    assert first.file.added_mass is not None
    assert first.file.added_mass.method == "panel"

    def solved(*_: object) -> None:
        raise AssertionError("solved again")

    monkeypatch.setattr(kernel, "_solved", solved)
    again = cf.vehicle("remus100", mass=33.0, density=1025.0, centre_of_gravity=(-0.6, 0.0, 0.02))
    assert again.file.added_mass is not None
    assert again.file.added_mass.matrix[1, 1] == pytest.approx(
        first.file.added_mass.matrix[1, 1] * 1025.0 / first.file.conditions.density, rel=1e-9
    )
    longer = replace(cf.read_body("remus100").shape, x=1.01 * cf.read_body("remus100").shape.x)
    with pytest.raises(AssertionError, match="solved again"):
        cf.vehicle(replace(cf.read_body("remus100"), shape=longer))
