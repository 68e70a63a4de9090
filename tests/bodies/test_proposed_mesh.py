"""Unit and axes of a mesh that states neither, by its size and outline; and what --repair does alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from manifold3d import Manifold

from coeflab.bodies.mesh.crossing_faces import crossing_faces
from coeflab.bodies.mesh.gates import sound
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.proposed_mesh import proposed
from coeflab.core.axes import parse_axes
from coeflab.core.errors import InputError


def torpedo() -> tuple[np.ndarray, np.ndarray]:
    """1.8 m, FRD, fuller ahead, with a tail and a sail."""
    ahead = Manifold.sphere(1.0, 24).scale((0.4, 0.1, 0.1)).trim_by_plane((1.0, 0.0, 0.0), 0.0)
    aft = Manifold.sphere(1.0, 24).scale((1.4, 0.1, 0.1)).trim_by_plane((-1.0, 0.0, 0.0), 0.0)
    whole = (ahead + aft).translate((0.5, 0.0, 0.0))
    whole += Manifold.cube((0.15, 0.01, 0.4), True).translate((-0.75, 0.0, 0.0))
    whole += Manifold.cube((0.15, 0.4, 0.01), True).translate((-0.75, 0.0, 0.0))
    return surface(whole + Manifold.cube((0.2, 0.03, 0.2), True).translate((0.2, 0.0, -0.1)))


def written(path: Path, axes: str, scale: float, holes: int) -> Path:
    vertices, faces = torpedo()
    own = scale * vertices @ parse_axes(axes).rotation
    trimesh.Trimesh(own, faces[holes:], process=False).export(path)
    return path


@pytest.mark.parametrize(
    ("axes", "scale", "unit", "holes"),
    [
        ("forward,down,port", 1000.0, "mm", 1),
        pytest.param("FLU", 1.0, "m", 0, marks=pytest.mark.slow),
        pytest.param("up,forward,port", 1000.0, "mm", 0, marks=pytest.mark.slow),
        pytest.param("aft,port,down", 1.0, "m", 0, marks=pytest.mark.slow),
    ],
)
def test_size_and_outline_propose_what_was_written(
    tmp_path: Path, axes: str, scale: float, unit: str, holes: int
) -> None:
    found = proposed(written(tmp_path / "hull.stl", axes, scale, holes))
    assert found.unit == unit
    assert found.repair == (holes > 0)
    assert found.closed
    turned = parse_axes(found.axes).rotation @ parse_axes(axes).rotation.T
    assert turned @ [1.0, 0.0, 0.0] == pytest.approx([1.0, 0.0, 0.0])  # ahead lies ahead
    assert turned @ [0.0, 0.0, 1.0] == pytest.approx([0.0, 0.0, 1.0])  # down lies down
    assert found.sizes == pytest.approx((1.8, 0.4, 0.4), rel=0.01)


def test_a_surface_that_encloses_nothing_is_said_to_be_open(tmp_path: Path) -> None:
    vertices, faces = torpedo()
    half = faces[(vertices[faces][:, :, 1] > 1e-6).all(axis=1)]
    path = tmp_path / "half.stl"
    trimesh.Trimesh(vertices, half, process=False).export(path)
    found = proposed(path)
    assert not found.closed
    assert "mesh.open" in [f.code for f in found.findings]


def test_repair_alone_closes_small_holes_and_unites() -> None:
    vertices, faces = torpedo()
    fin = trimesh.creation.box((0.1, 0.3, 0.02))
    both = np.vstack([vertices, fin.vertices]), np.vstack([faces[1:], np.asarray(fin.faces) + len(vertices)])
    with pytest.raises(InputError):
        sound(*both, Path("hull.stl"))
    mended = sound(*both, Path("hull.stl"), repair=True)
    assert TriangleMesh(mended.vertices, mended.faces).volume > TriangleMesh(vertices, faces).volume
    said = " ".join(mended.statements)
    assert "filled" in said
    assert "2 shells united" in said


def test_faces_that_cross_within_single_precision_do_not_count() -> None:
    """Two boxes that share a wall, one of them 1e-8 too long: its corners stick through, deeper ones count."""
    for deep, counts in ((1e-8, False), (1e-3, True)):
        one = trimesh.creation.box((1.0, 1.0, 1.0))
        other = trimesh.creation.box((0.4, 0.3, 0.2), transform=trimesh.transformations.rotation_matrix(0.3, (0, 0, 1)))
        corners = np.array(other.vertices)
        corners[:, 0] += 0.5 - deep - corners[:, 0].min()
        vertices = np.vstack([one.vertices, corners])
        faces = np.vstack([one.faces, np.asarray(other.faces) + 8])
        assert bool(crossing_faces(vertices, faces, 1e-6)) == counts
    assert crossing_faces(vertices, faces)


@pytest.mark.parametrize("axis", [1, 2])
def test_a_hull_across_whose_bow_does_not_show_is_proposed_both_ways(tmp_path: Path, axis: int) -> None:
    hull = trimesh.creation.icosphere(subdivisions=3)
    sizes = np.full(3, 0.15)
    sizes[axis] = 1.0
    hull.apply_scale(sizes)
    hull.export(tmp_path / "hull.stl")
    found = proposed(tmp_path / "hull.stl", "m")
    assert found.sizes == pytest.approx((2.0, 0.3, 0.3), rel=0.02)
