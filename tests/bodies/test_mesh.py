"""Bodies from mesh files: formats, units, axes, stated sizes, and what is computed of them."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.added_mass import strip
from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError

RADIUS, LENGTH = 0.1, 1.5
HEAD = """[body]
name = "hull"
reader = "mesh"
datum = "nose"
reference_point = [-0.7, 0.0, 0.0]
[source]
citation = "synthetic"
"""
MESH = '[mesh]\npath = "{}"\nunit = "{}"\naxes = {}\n'


def hull(pieces: int = 96) -> trimesh.Trimesh:
    """A spindle with its nose at the origin and its tail aft, with a keel; x forward, y starboard, z down; mm.

    Revolved in mm: the library drops small triangles of a revolution.
    """
    t = np.linspace(0.0, np.pi, 49)
    outline = np.column_stack([1e3 * RADIUS * np.sin(t), -500.0 * LENGTH * np.cos(t)])
    outline[[0, -1], 0] = 0.0
    made = trimesh.creation.revolve(outline, sections=pieces)
    made.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2.0, [0, 1, 0]))
    made.apply_translation([-500.0 * LENGTH, 0.0, 0.0])
    keel = trimesh.creation.box(extents=(300.0, 20.0, 120.0))
    keel.apply_translation([-600.0, 5.0, 100.0])
    return trimesh.boolean.union([made, keel], engine="manifold")


@pytest.fixture(scope="module")
def solid() -> trimesh.Trimesh:
    return hull()


def in_axes(mesh: trimesh.Trimesh, rows: Sequence[Sequence[float]], scale: float = 1.0) -> trimesh.Trimesh:
    """Components along other axes, from FRD."""
    return trimesh.Trimesh(scale * mesh.vertices @ np.array(rows, dtype=float).T, mesh.faces, process=False)


FLU = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
CFD = [[-1, 0, 0], [0, 1, 0], [0, 0, -1]]
FRD = np.eye(3).tolist()


def export(mesh: trimesh.Trimesh, path: Path) -> None:
    """OBJ with all digits; the others as trimesh writes them."""
    if path.suffix == ".obj":
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
        path.write_text("\n".join(lines))
    else:
        mesh.export(path)


def read(folder: Path, mesh: trimesh.Trimesh, name: str, unit: str, axes: str = '"FRD"', more: str = "") -> Body:
    export(mesh, folder / name)
    (folder / "body.toml").write_text(HEAD + MESH.format(name, unit, axes) + more)
    return read_body(folder / "body.toml")


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "glb"])
def test_every_format_gives_the_same_body(tmp_path: Path, solid: trimesh.Trimesh, kind: str) -> None:
    body = read(tmp_path, solid, f"hull.{kind}", "mm")
    shape, found = body.shape, body.configurations[0]
    assert isinstance(shape, TriangleMesh)
    assert shape.volume == pytest.approx(1e-9 * solid.volume, rel=1e-6)
    assert shape.extents == pytest.approx(1e-3 * solid.extents, rel=1e-6)
    assert found.name == "by_mesh"
    assert found.wetted_surface == pytest.approx(1e-6 * solid.area, rel=1e-6)
    assert found.centre_of_buoyancy == pytest.approx(1e-3 * solid.center_mass, abs=1e-6)
    assert found.displaced_inertia(1000.0) == pytest.approx(1e-12 * solid.moment_inertia, rel=1e-4, abs=1e-5)
    assert found.projected_areas is not None
    assert found.title == f"integrals over {len(solid.faces)} faces"


def test_units_and_axes_round_trip(tmp_path: Path, solid: trimesh.Trimesh) -> None:
    """The same body in FLU and mm, in CFD axes and feet, and in FRD and m: one matrix in kg and m."""
    bodies = {}
    for name, rows, scale, unit, axes in (
        ("frd", FRD, 1e-3, "m", '"FRD"'),
        ("flu", FLU, 1.0, "mm", '"FLU"'),
        ("own", FLU, 1.0, "mm", '["forward", "port", "up"]'),
        ("cfd", CFD, 1e-3 / 0.3048, "ft", '"CFD"'),
    ):
        folder = tmp_path / name
        folder.mkdir()
        bodies[name] = read(folder, in_axes(solid, rows, scale), "hull.obj", unit, axes)
    exact = strip.added_mass(bodies["frd"], 1000.0).matrix
    for name in ("flu", "own", "cfd"):
        assert strip.added_mass(bodies[name], 1000.0).matrix == pytest.approx(exact, rel=1e-9, abs=1e-9)
    assert bodies["cfd"].require_shape().volume == pytest.approx(bodies["frd"].require_shape().volume, rel=1e-12)


def test_origin_of_the_file(tmp_path: Path, solid: trimesh.Trimesh) -> None:
    there = read(tmp_path, solid, "hull.stl", "mm", more='origin = ["10 cm", 0.0, -0.2]\n')
    assert there.require_shape().centre_of_volume == pytest.approx(
        1e-3 * solid.center_mass + [0.1, 0.0, -0.2], abs=1e-6
    )


def test_files_are_named_with_their_sums(tmp_path: Path, solid: trimesh.Trimesh) -> None:
    body = read(tmp_path, solid, "hull.stl", "mm")
    assert [f.name for f in body.files] == ["hull/body.toml", "hull/hull.stl"]
    assert body.files[1].sha256 == hashlib.sha256((tmp_path / "hull.stl").read_bytes()).hexdigest()


def test_repair_is_said(tmp_path: Path) -> None:
    inward = trimesh.creation.icosphere(subdivisions=2)
    inward.invert()
    with pytest.raises(InputError, match="inward normals"):
        read(tmp_path, inward, "ball.ply", "m")
    body = read(tmp_path, inward, "ball.ply", "m", more="repair = true\n")
    assert body.configurations[0].title == "integrals over 320 faces; repaired: 1 of 1 shells turned outward"
    assert body.require_shape().volume > 4.0


@pytest.mark.parametrize(
    ("declared", "said"),
    [
        ("m", ["a body 1500 m in size", "0.05 to 500 m", 'Is the unit "mm"? The body would be 1.5 m long']),
        ("um", ["a body 0.0015 m in size", 'Is the unit "mm"?']),
        ("km", ["a body 1.5e+06 m in size", 'Is the unit "mm"?']),
        ("kg", ['"mesh.unit"', "a unit of length"]),
        ("", ['"mesh.unit"']),
        ("furlogs", ['"mesh.unit"', "unknown unit", "Name the unit of the file"]),
    ],
)
def test_wrong_units(tmp_path: Path, solid: trimesh.Trimesh, declared: str, said: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, solid, "hull.stl", declared)
    for words in said:
        assert words in str(caught.value)


@pytest.mark.parametrize(
    ("unit", "stated", "said"),
    [
        ("m", "length = 1.5", ['"mesh.path"', "a length of 1500 m", "1.5 m as in [particulars]", 'Is the unit "mm"?']),
        ("in", "length_overall = 1.5", ["a length of 38.1 m", 'Is the unit "mm"?']),
        ("mm", "length = 1.7", ["a length of 1.5 m", "1.7 m as in [particulars], within 5 %", "Is the unit right?"]),
        ("mm", "breadth = 1.5", ["a breadth of 0.2 m", "Are the axes right?"]),
        ("mm", 'length = 1.5\ndepth = "2 m"', ["a depth of 0.26 m"]),
        (
            "mm",
            '[[configuration]]\nname = "bare"\nvolume = 0.02',
            ["a volume of 0.0317385 m^3", "0.02 m^3 as in [[configuration]] bare"],
        ),
        (
            "cm",
            '[[configuration]]\nname = "bare"\nvolume = 0.0317',
            ["a volume of 31.7385 m^3", 'Is the unit "mm"?'],
        ),
    ],
)
def test_far_from_what_is_stated(
    tmp_path: Path, solid: trimesh.Trimesh, unit: str, stated: str, said: list[str]
) -> None:
    more = stated if stated.startswith("[[") else f"[particulars]\n{stated}\n"
    with pytest.raises(InputError) as caught:
        read(tmp_path, solid, "hull.stl", unit, more=more)
    for words in ("body.toml", *said):
        assert words in str(caught.value)


def test_near_to_what_is_stated_is_said(tmp_path: Path, solid: trimesh.Trimesh) -> None:
    volume = 1e-9 * float(solid.volume)
    more = (
        f'[particulars]\nlength = {1.5 / 1.02}\nbreadth = 0.2\nhandle = 9.0\n[[configuration]]\nname = "bare"\nvolume = {2 * volume}\n'
        f'[[configuration]]\nname = "keel"\nvolume = {volume / 0.99}\n'
    )
    title = read(tmp_path, solid, "hull.stl", "mm", more=more).configurations[0].title
    assert title.endswith("; length +2.0 % from the stated; volume -1.0 % from keel")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('axes = "FRD"', 'axes = ["forward", "port", "down"]', ['"mesh.axes"', "left-handed", "FLU"]),
        ('axes = "FRD"', 'axes = "NED"', ['"mesh.axes"', '"NED"']),
        ('axes = "FRD"\n', "", ['"mesh.axes"', "found nothing"]),
        ('unit = "m"\n', "", ['"mesh.unit"', "found nothing"]),
        ('path = "ball.stl"\n', "", ['"mesh.path"', "found nothing"]),
        ("ball.stl", "bell.stl", ["bell.stl", "no such file"]),
        ("ball.stl", ".", ["a folder"]),
        ("[mesh]", "[mesh]\nrepair = 1", ['"mesh.repair"', "true or false"]),
        ("[mesh]", "[mesh]\nscale = 1", ['"mesh.scale"', "an unknown key"]),
        ("[mesh]", "[mesh]\norigin = [1]", ['"mesh.origin"', "a point"]),
        ("[mesh]", "[net]", ['"mesh"', "found nothing"]),
    ],
)
def test_files_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    trimesh.creation.icosphere(subdivisions=1).export(tmp_path / "ball.stl")
    text = HEAD + MESH.format("ball.stl", "m", '"FRD"')
    assert old in text
    (tmp_path / "body.toml").write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_body(tmp_path / "body.toml")
    for words in said:
        assert words in str(caught.value)


def test_a_centre_that_is_rounding_is_zero() -> None:
    ball = trimesh.creation.icosphere(2)
    turned = ball.vertices @ trimesh.transformations.rotation_matrix(0.3, [1.0, 2.0, 0.5])[:3, :3].T
    for faces in (ball.faces, np.random.default_rng(3).permutation(ball.faces)):
        assert TriangleMesh(turned, faces).centre_of_volume.tolist() == [0.0, 0.0, 0.0]
    aside = TriangleMesh(turned + np.array([0.0, 1e-9, 0.0]), ball.faces).centre_of_volume
    assert aside[1] == pytest.approx(1e-9, rel=1e-4)
