"""Structured surfaces: closed, outward, symmetric, on the meridian, and of second order."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.closed_forms.revolution import graded_nodes
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.structured_surface import box_surface, lofted, outline, revolved, rings


def edges_pair_up(faces: np.ndarray) -> bool:
    """Every edge is run once each way: closed, and wound alike."""
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = {(int(a), int(b)) for a, b in directed}
    return len(there) == len(directed) and all((b, a) in there for a, b in there)


def as_set(vertices: np.ndarray, faces: np.ndarray) -> set[frozenset[tuple[float, ...]]]:
    points = [tuple(float(c) + 0.0 for c in p) for p in np.round(vertices, 9)]
    return {frozenset(points[i] for i in f) for f in faces}


def half_ellipse(a: float, b: float) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(np.pi, 0.0, 4097)
    radius = b * np.sin(angle)
    radius[[0, -1]] = 0.0
    return a * np.cos(angle), radius


@pytest.mark.parametrize("panels", [300, 2000, 9000])
@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (6.0, 1.0), (0.1, 1.0)])
def test_spheroids(a: float, b: float, panels: int) -> None:
    x, radius, around = rings(*half_ellipse(a, b), panels)
    vertices, faces = revolved(x, radius, around)
    assert edges_pair_up(faces)
    assert len(faces) == 2 * around * (len(x) - 2)
    assert len(faces) == pytest.approx(panels, rel=0.7 if panels < 1000 else 0.15)
    assert np.max(np.abs((vertices[:, 0] / a) ** 2 + np.sum(vertices[:, 1:] ** 2, axis=1) / b**2 - 1.0)) < 1e-6
    whole = mesh_integrals(vertices, faces)
    assert 0.0 < 1.0 - whole.volume / (4.0 / 3.0 * np.pi * a * b * b) < 80.0 / panels


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (6.0, 1.0)])
def test_second_order(a: float, b: float) -> None:
    exact = 4.0 / 3.0 * np.pi * a * b * b
    found = [mesh_integrals(*revolved(*rings(*half_ellipse(a, b), p))) for p in (2000, 8000, 32000)]
    counts = [len(revolved(*rings(*half_ellipse(a, b), p))[1]) for p in (2000, 8000, 32000)]
    scaled = [(f.volume / exact - 1.0) * n for f, n in zip(found, counts)]
    assert scaled[2] == pytest.approx(scaled[1], rel=0.03)
    h2 = [1.0 / n for n in counts]
    extrapolated = found[2].volume + (found[2].volume - found[1].volume) * h2[2] / (h2[1] - h2[2])
    assert extrapolated == pytest.approx(exact, rel=5e-5)


@pytest.mark.parametrize("mirror", [(-1, 1, 1), (1, -1, 1), (1, 1, -1)])
def test_mirrored_into_itself(mirror: tuple[int, int, int]) -> None:
    for vertices, faces in (
        revolved(*rings(*half_ellipse(3.0, 1.0), 600)),
        box_surface(np.array([3.0, 2.0, 1.0]), 300),
    ):
        assert as_set(vertices * np.array(mirror), faces) == as_set(vertices, faces)


def test_cylinder_has_its_edges() -> None:
    x = np.linspace(-2.0, 2.0, 513)
    x, radius, around = rings(x, np.full(513, 0.5), 3000)
    assert np.sum((np.abs(x) == 2.0) & (radius == 0.5)) == 2
    assert radius[0] == radius[-1] == 0.0
    whole = mesh_integrals(*revolved(x, radius, around))
    polygon = around / 2.0 * np.sin(2.0 * np.pi / around) * 0.25
    assert whole.volume == pytest.approx(4.0 * polygon, rel=1e-12)


@pytest.mark.parametrize("sides", [(3.0, 2.0, 1.0), (1.0, 1.0, 1.0), (5.0, 0.05, 1.0)])
def test_box(sides: tuple[float, float, float]) -> None:
    vertices, faces = box_surface(np.array(sides), 500)
    assert edges_pair_up(faces)
    whole = mesh_integrals(vertices, faces)
    assert whole.volume == pytest.approx(np.prod(sides), rel=1e-12)
    assert whole.area == pytest.approx(2.0 * (sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0]))
    assert 250 <= len(faces) <= 1000


def test_outline_finds_poles_and_flat_ends() -> None:
    x, _ = graded_nodes(-1.0, 1.0, 48, 2)
    pole, radius = outline(x, 1.0 - x**2, -x, (-1.0, 1.0))
    assert radius[0] == radius[-1] == 0.0
    assert np.max(np.abs(radius**2 + pole**2 - 1.0)) < 1e-12
    x, _ = graded_nodes(-1.0, 0.5, 48, 2)
    cut, radius = outline(x[::-1], 1.0 - x[::-1] ** 2, -x[::-1], (-1.0, 0.5))
    assert cut[-1] == 0.5
    assert radius[-1] == pytest.approx(np.sqrt(0.75), rel=1e-9)


def test_loft_closes_where_loops_fall_together() -> None:
    """An octahedron: a square between two points."""
    square = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
    tips = [np.tile([x, 0.0, 0.0], (4, 1)) for x in (-1.0, 1.0)]
    vertices, faces = lofted(np.stack([tips[0], square, tips[1]]))
    assert len(vertices) == 6
    assert len(faces) == 8
    assert edges_pair_up(faces)
    assert mesh_integrals(vertices, faces).volume == pytest.approx(4.0 / 3.0)
