"""Strip theory on meshes beside the exact path of the same body of revolution, and what the method says of itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.added_mass import strip
from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

RHO = 1000.0


def body(folder: Path, mesh: trimesh.Trimesh, point: str = "[0.0, 0.0, 0.0]") -> Body:
    mesh.export(folder / "body.ply")
    (folder / "body.toml").write_text(
        f'[body]\nname = "b"\nreader = "mesh"\ndatum = "d"\nreference_point = {point}\n[source]\ncitation = "synthetic"\n'
        '[mesh]\npath = "body.ply"\nunit = "m"\naxes = "FRD"\n'
    )
    return read_body(folder / "body.toml")


def as_trimesh(vertices: np.ndarray, faces: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(vertices, faces, process=False)


@pytest.fixture(scope="module")
def suboff() -> Body:
    return read_body(shipped("geometry") / "suboff_bare_hull" / "body.toml")


@pytest.mark.parametrize("end", ["none", "lamb"])
def test_suboff_as_a_mesh_and_by_its_equations(tmp_path: Path, suboff: Body, end: str) -> None:
    mesh = meshed(suboff.require_shape(), 40_000)
    point = ", ".join(str(float(x)) for x in suboff.reference_point)
    found = strip.added_mass(
        body(tmp_path, as_trimesh(mesh.vertices, mesh.faces), f"[{point}]"), RHO, {"end_correction": end}
    )
    exact = strip.added_mass(suboff, RHO, {"end_correction": end})
    size = np.sqrt(np.outer(np.diag(exact.matrix), np.diag(exact.matrix)))
    assert found.matrix == pytest.approx(exact.matrix, rel=2e-3, abs=2e-3 * float(size[1, 1]))
    assert np.diag(found.matrix) == pytest.approx(np.diag(exact.matrix), rel=3e-3, abs=1e-6)
    assert found.method == exact.method == ("strip" if end == "none" else "strip:lamb")
    assert found.definiteness.holds


def test_lamb_on_an_ellipsoid_off_the_point(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=5)
    axes = np.array([2.0, 0.4, 0.3])
    mesh = as_trimesh(np.asarray(ball.vertices) * axes + [1.0, 0.0, 0.5], np.asarray(ball.faces))
    found = strip.added_mass(body(tmp_path, mesh), RHO, strip.presets["lamb"])
    own = np.diag(ellipsoid_added_mass(axes, RHO))
    assert found.matrix[0, 0] == pytest.approx(own[0], rel=6e-3)
    assert found.matrix[1, 1] == pytest.approx(own[1], rel=6e-3)
    assert found.matrix[5, 5] == pytest.approx(own[5] + own[1], rel=6e-3)
    assert found.matrix[4, 4] == pytest.approx(own[4] + own[2] + 0.25 * own[0], rel=6e-3)
    assert found.matrix[0, 4] == pytest.approx(0.5 * own[0], rel=6e-3)
    assert found.matrix[1, 5] == pytest.approx(own[1], rel=6e-3)
    assert "of the ellipsoid of the same length, volume and breadth over depth" in found.statements[0]
    assert "roll as the sections give it" in found.statements[0]


def test_statements_say_how_the_sections_were_done(tmp_path: Path) -> None:
    rod = trimesh.creation.cylinder(0.2, 2.0, sections=48)
    rod.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2.0, [0, 1, 0]))
    fin, block = (trimesh.creation.box(extents=e) for e in ((0.5, 0.04, 1.0), (0.5, 0.6, 0.6)))
    block.apply_translation([1.25, 0.0, 0.0])
    whole = trimesh.boolean.union([rod, fin, block], engine="manifold")
    found = strip.added_mass(body(tmp_path, whole), RHO, {"stations": 60})
    head, counts, volume, slender, change = found.statements
    assert head == "sections only: nothing along the axis, ends not corrected"
    assert counts.startswith("60 sections: ")
    for words in ("ellipses", "rectangles", "by boundary elements"):
        assert words in counts
    assert float(volume.rpartition(" ")[2]) == pytest.approx(0.0, abs=1e-9)
    assert slender.startswith("2.5 times as long as wide or deep")
    assert change.startswith("half the stations and 80 elements change the diagonal by ")
    assert float(change.split()[-3]) < 0.02


def test_the_error_estimate_holds_the_error(tmp_path: Path) -> None:
    """A hull with a mast and two fins, against the same at many more stations."""
    hull = trimesh.creation.icosphere(subdivisions=4)
    hull.vertices = hull.vertices * [1.5, 0.2, 0.2]
    mast = trimesh.creation.cylinder(0.05, 1.0, sections=32)
    mast.apply_translation([0.2, 0.0, -0.5])
    fins = trimesh.creation.box(extents=(0.2, 1.0, 0.03))
    fins.apply_translation([-0.9, 0.0, 0.0])
    made = body(tmp_path, trimesh.boolean.union([hull, mast, fins], engine="manifold"), "[0.3, 0.0, 0.0]")
    found, fine = (strip.added_mass(made, RHO, {"stations": n}) for n in (96, 600))
    size = np.sqrt(np.outer(np.diag(fine.matrix), np.diag(fine.matrix)))
    off = np.abs(found.matrix - fine.matrix)
    assert np.all(off <= found.error + 2e-4 * size)
    assert np.max(np.diag(found.error)[1:] / np.diag(found.matrix)[1:]) < 0.02


def test_too_few_stations_are_said(tmp_path: Path) -> None:
    """Forty thin discs along x: sections jump where no station is; the volume tells."""
    discs = [trimesh.creation.box(extents=(0.01, 1.0, 1.0)) for _ in range(60)]
    for k, disc in enumerate(discs):
        disc.apply_translation([0.1 * k, 0.0, 0.0])
    core = trimesh.creation.box(extents=(6.0, 0.1, 0.1))
    core.apply_translation([2.95, 0.0, 0.0])
    comb = trimesh.boolean.union([core, *discs], engine="manifold")
    few = strip.added_mass(body(tmp_path, comb), RHO, {"stations": 16})
    assert any("raise stations" in s for s in few.statements)


def test_rings_are_said(tmp_path: Path) -> None:
    ring = trimesh.creation.annulus(0.8, 1.0, 2.0, sections=128)
    ring.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2.0, [0, 1, 0]))
    found = strip.added_mass(body(tmp_path, ring), RHO)
    assert "m^3 of water within closed rings moves sideways with the body" in found.statements[-2]
    assert found.statements[-3] == "1 times as long as wide or deep: not slender, the sections are a rough guide"


def test_too_many_contours(tmp_path: Path) -> None:
    bars = [trimesh.creation.box(extents=(1.0, 0.1, 0.1)) for _ in range(41)]
    for k, bar in enumerate(bars):
        bar.apply_translation([0.0, 0.2 * k, 0.0])
    with pytest.raises(InputError, match="a section of 41 separate contours"):
        strip.added_mass(body(tmp_path, trimesh.util.concatenate(bars)), RHO)


def test_options_out_of_bounds(suboff: Body) -> None:
    with pytest.raises(InputError, match=r"strip\.stations"):
        strip.added_mass(suboff, RHO, {"stations": 8})
