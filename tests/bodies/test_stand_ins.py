"""Meshes that simple forms stand for badly, and some well: nothing called exact or good is further off than its spread."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.creation import annulus, box, capsule, cylinder, icosphere

from coeflab.bodies import added_masses as hulls
from coeflab.bodies.added_mass import panel
from coeflab.bodies.added_masses import added_masses
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.readers import read_body
from coeflab.bodies.simplify.simplify import simplify
from coeflab.bodies.triangulation import Triangulation
from coeflab.core.axes import Datum
from coeflab.core.provenance import Source
from tests.bodies.twelve import FORWARD, Mesh, at, ducted_quadrotor, ellipsoid, triple_hull, united

RHO, COARSE, FINE = 1000.0, 1200, 2000
DOWN = np.diag([1.0, -1.0, -1.0])
SILENT = 1e-3  # of the largest of its kind: motions about an axis of revolution, which facets make of nothing


def frame() -> Mesh:
    parts = [box((0.6, 0.64, 0.2))]
    for y in (-0.3, 0.3):
        parts += [at(box((1.0, 0.041, 0.042)), 0.0, y, z) for z in (-0.25, 0.25)]
        parts += [at(box((0.043, 0.037, 0.54)), x, y, 0.0) for x in (-0.45, 0.45)]
        parts += [at(box((0.047, 0.033, 0.53)), 0.01, y, 0.0)]
    return united(*parts)


def sphere_with_arms() -> Mesh:
    ways = [np.array([np.cos(a), np.sin(a), 0.0]) for a in 2.0 * np.pi / 3.0 * np.arange(3)]
    return united(icosphere(2, 0.3), *(cylinder(0.03, segment=[0.2 * w, 0.8 * w], sections=16) for w in ways))


def torpedo() -> Mesh:
    turns = [trimesh.transformations.rotation_matrix(k * np.pi / 2.0, [1.0, 0.0, 0.0]) for k in range(4)]
    fins = [at(box((0.15, 0.012, 0.2)), -0.7, 0.0, 0.15).apply_transform(t) for t in turns]
    return united(ellipsoid(1.0, 0.12, 0.12), *fins)


def cuboid_rov() -> Mesh:
    return united(box((0.6, 0.4, 0.15)), *(at(box((0.6, 0.05, 0.4)), 0.0, y, 0.15) for y in (-0.2, 0.2)))


def catamaran() -> Mesh:
    return united(*(at(ellipsoid(1.0, 0.15, 0.15), 0.0, y, 0.0) for y in (-0.5, 0.5)), box((0.3, 0.9, 0.04)))


def far_pair() -> Mesh:
    return trimesh.util.concatenate([at(ellipsoid(1.0, 0.1, 0.1), 0.0, y, 0.0) for y in (-2.5, 2.5)])


def pointed() -> Mesh:
    x = np.linspace(-1.0, 1.0, 31)
    made = trimesh.creation.revolve(np.column_stack([0.2 * (1.0 - x**2), x]), sections=24)
    return made.apply_transform(FORWARD)


MESHES: dict[str, Callable[[], Mesh]] = {
    "ducted quadrotor": ducted_quadrotor,
    "duct": lambda: annulus(0.4, 0.5, 0.6, sections=32),
    "frame": frame,
    "triple hull": triple_hull,
    "sphere with arms": sphere_with_arms,
    "tube": lambda: annulus(0.15, 0.2, 1.5, sections=24, transform=FORWARD),
    "manta": lambda: united(ellipsoid(0.6, 0.2, 0.12), at(ellipsoid(0.25, 0.9, 0.05), 0.013, 0.007, 0.011)),
    "torpedo": torpedo,
    "cuboid ROV": cuboid_rov,
    "catamaran": catamaran,
    "pointed spindle": pointed,
    "glider": lambda: united(ellipsoid(0.9, 0.12, 0.12), box((0.2, 1.2, 0.02))),
    "capsule": lambda: capsule(1.6, 0.2, count=[16, 12], transform=FORWARD),
    "far pair": far_pair,
    "cuboid": lambda: box((0.8, 0.5, 0.4)),
    "rod": lambda: cylinder(0.2, 2.0, sections=24, transform=FORWARD),
    "spheroid": lambda: ellipsoid(1.0, 0.2, 0.2),
    "saucer": lambda: ellipsoid(0.5, 0.5, 0.15),
}
# Every piece has its form: not rough, though unchecked without the mesh.
CLOSE = (
    "capsule", "far pair", "cuboid", "rod", "spheroid", "saucer", "ducted quadrotor", "duct", "frame", "triple hull",
    "sphere with arms", "tube", "pointed spindle",
)  # fmt: skip


def body(name: str) -> Body:
    mesh = MESHES[name]()
    mesh.merge_vertices()
    shape = TriangleMesh(np.asarray(mesh.vertices) @ DOWN, np.asarray(mesh.faces))
    return Body(name, name, Datum("middle"), np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), shape)


def missed(found: Triangulation, mesh: Body) -> list[str]:
    """Diagonal entries that are further from the panel method on the mesh than their spread and the errors of both."""
    own = found.recommended
    reference = panel.added_mass(mesh, RHO, {"panels": FINE, "kernel": "numpy"})
    size = np.diag(reference.matrix)
    live = size > SILENT * np.repeat(size.reshape(2, 3).max(axis=1), 3)
    allowed = np.nan_to_num(np.diag(found.spread)) * np.diag(own.matrix)
    allowed += sum(np.diag(r.error) for r in (own, reference) if r.error is not None)
    off = np.abs(np.diag(own.matrix) - size)
    return [axis for axis, o, a, ok in zip("uvwpqr", off, allowed, live, strict=True) if ok and o > a]


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_nothing_called_good_is_further_off_than_its_spread(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Few panels and no strips keep it short."""
    monkeypatch.setattr(panel, "reproducible", {"kernel": "numpy", "panels": COARSE})
    monkeypatch.setattr(hulls, "methods", lambda: ("ellipsoid", "panel", "primitives", "primitives:huuv"))
    mesh = body(name)
    made = simplify(mesh)
    (tmp_path / "body.toml").write_bytes(made.part_file())
    (tmp_path / "mesh.ply").write_bytes(made.mesh_file())
    for file, content in made.mesh_parts().items():
        (tmp_path / file).write_bytes(content)
    stand_in = read_body(tmp_path / "body.toml")
    found = added_masses(stand_in, RHO, reproducible=True)
    assert "is an ellipsoid: exact" not in str([r.statements for r in found.results])
    assert "panel" in found.on_mesh  # of thin walls too: panels are raised until they are smaller than these
    assert not found.caution
    assert found.recommended.method == "panel"
    assert missed(found, mesh) == []

    alone = added_masses(replace(stand_in, mesh=None), RHO, reproducible=True)
    assert np.all(np.isnan(alone.spread))
    assert alone.recommended.rough == bool(made.shape.rough)
    said = "NONE OF THE METHODS SHOWN IS GOOD" if made.shape.rough else "NOT CHECKED: the parts replace a mesh"
    assert alone.recommended.statements[0].startswith(said)
    assert "is an ellipsoid: exact" not in str([r.statements for r in alone.results])
    assert alone.recommended.rough != (name in CLOSE)
