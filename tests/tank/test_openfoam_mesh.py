"""Meshes for the tow tank: sizes that follow from the body, cells counted before they are made, and real ones judged."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.declarations import validated
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.text.foam import FoamCase
from coeflab.law.scaling import Conditions, Scaling
from coeflab.tank.jobs import Job
from coeflab.tank.openfoam.layers import FEWEST_ON_FOILS, GROWTH, layers, wall_unit
from coeflab.tank.openfoam.mesh import mesh_job, mesh_name
from coeflab.tank.openfoam.mesh_report import MESH_FILE, expected_cells, findings, mesh_ended, mesh_report
from coeflab.tank.openfoam.mesh_sizes import MeshKeys, mesh_sizes
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Half
from coeflab.tank.towed_body import TowedBody, towed

WATER = Conditions(density=1000.0, speed=1.0, viscosity=1e-6)
COARSE = Grid("coarse", 4.0)
BARE, LAYERED = MeshKeys(wall="none"), MeshKeys(y_plus=20.0)


openfoam = pytest.mark.skipif(
    shutil.which("snappyHexMesh") is None, reason="OpenFOAM is not installed: apt-get install openfoam"
)


@pytest.fixture(scope="module")
def body() -> TowedBody:
    """A spheroid of 5:1, 1 m long, with two rudders in the plane y = 0."""
    return towed(read_body(shipped("geometry") / "finned_spheroid" / "body.toml"), np.zeros(3), panels=6000)


def job(body: TowedBody, folder: Path, keys: MeshKeys = BARE, cores: int = 1, grid: Grid = COARSE) -> Job:
    tank = Tank("t", "t", Path("b"), None, np.zeros(3), Scaling(1.0, "length"), WATER, (), cores=cores)  # type: ignore[arg-type]
    return mesh_job(tank, body, grid, Half.UPPER, {}, keys, folder, "1912")


def test_edges_on_hull_and_appendages_follow_from_length_and_chord(body: TowedBody) -> None:
    sizes = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), WATER)
    assert sizes.edge("hull") == pytest.approx(1.0 / 280.0, rel=1e-9)
    for rudder in ("rudder_upper", "rudder_lower"):
        assert abs(np.log2(sizes.edge(rudder) * 90.0 / body.chord[rudder])) <= 0.5  # the power of two next to it
    finer = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(cells={"rudder_upper": 180}), WATER)
    assert finer.levels["rudder_upper"] == sizes.levels["rudder_upper"] + 1
    assert finer.levels["rudder_lower"] == sizes.levels["rudder_lower"]


def test_a_grid_of_twice_the_size_has_every_edge_doubled_and_nothing_else_changed(body: TowedBody) -> None:
    medium, coarse = (mesh_sizes(body, size, Half.WHOLE, LAYERED, WATER) for size in (1.0, 2.0))
    np.testing.assert_allclose(coarse.edges, 2.0 * medium.edges, rtol=0.05)  # whole numbers of cells
    np.testing.assert_array_equal([coarse.low, coarse.high], [medium.low, medium.high])
    assert (coarse.levels, coarse.layers) == (medium.levels, medium.layers)
    for one, other in zip(coarse.regions, medium.regions, strict=True):
        np.testing.assert_array_equal([one.low, one.high], [other.low, other.high])


def test_cells_of_half_a_domain_and_of_a_larger_one_are_those_of_the_whole(body: TowedBody) -> None:
    whole = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), WATER)
    for half, axis in ((Half.PORT, 1), (Half.UPPER, 2)):
        sizes = mesh_sizes(body, 1.0, half, MeshKeys(), WATER)
        assert sizes.high[axis] == 0.0
        assert 2 * sizes.counts[axis] == whole.counts[axis]
        np.testing.assert_allclose(sizes.edges, whole.edges, rtol=1e-12)
    larger = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), WATER, domain=1.5)
    np.testing.assert_allclose(larger.edges, whole.edges, rtol=1e-12)
    steps = (whole.low - larger.low) / whole.edges
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-9)  # its cells lie where those of the smaller one lie
    assert 0.0 <= -larger.low[1] - (1.5 * 1.4 + 0.1) < whole.edges[1]


def test_the_mesh_of_one_side_of_a_mirror_has_half_the_cells_of_the_background(body: TowedBody) -> None:
    half = mesh_sizes(body, 1.0, Half.UPPER, MeshKeys(), WATER)
    quarter = mesh_sizes(body, 1.0, Half.UPPER, MeshKeys(), WATER, mirrored=(1,))
    assert (quarter.high[1], quarter.high[2]) == (0.0, 0.0)
    assert 2 * quarter.counts[1] == half.counts[1]
    np.testing.assert_array_equal(quarter.low, half.low)


def test_layers_lead_from_the_wanted_y_plus_to_the_cell_on_them(body: TowedBody) -> None:
    sizes = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(wall="resolved"), WATER)
    layers = sizes.layers["hull"]
    assert layers.first / 2.0 / wall_unit(1.0, 1.0, 1e-6) == pytest.approx(0.8)
    assert layers.last * sizes.edge("hull") / GROWTH ** (layers.count - 1) == pytest.approx(layers.first)
    assert 0.3 < layers.last < 0.4
    by_hand = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(wall="resolved", y_plus=1.6), WATER).layers["hull"]
    assert layers.count - by_hand.count == round(np.log(2.0) / np.log(GROWTH))
    # At a Reynolds number of 1e5 the first layer for wall functions is as thick as a cell: a foil gets thinner ones.
    found = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), WATER)
    assert found.layers["rudder_upper"].count == FEWEST_ON_FOILS
    assert found.layers["rudder_upper"].last <= 0.43
    assert not mesh_sizes(body, 1.0, Half.WHOLE, BARE, WATER).layers


def test_wall_functions_of_a_hull_begin_at_sixty(body: TowedBody) -> None:
    fast = Conditions(1000.0, 10.0, 1e-6)
    first = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), fast).layers["hull"].first
    assert first / 2.0 / wall_unit(10.0, 1.0, 1e-6) == pytest.approx(60.0)


def test_wall_functions_of_a_foil_begin_at_thirty(body: TowedBody) -> None:
    fast, (name, chord) = Conditions(1000.0, 10.0, 1e-6), next((n, c) for n, c in body.chord.items() if n != "hull")
    found = layers(body, name, 0.1, "functions", None, fast)
    assert found.first / 2.0 / wall_unit(10.0, chord, 1e-6) == pytest.approx(30.0)


def test_boxes_of_finer_cells_reach_by_the_length_of_the_body(body: TowedBody) -> None:
    sizes = mesh_sizes(body, 1.0, Half.WHOLE, BARE, WATER)
    boxes = {r.name: r for r in sizes.regions}
    hull = body.vertices[np.unique(body.faces[body.patch == body.patches.index("hull")])]
    low, high, length = hull.min(0), hull.max(0), body.length
    near, nose, tail = boxes["near"], boxes["nose"], boxes["tail"]
    reach = [
        (low - near.low)[:2],
        (near.high - high)[:2],
        [high[0] - nose.low[0], nose.high[0] - high[0]],
        [low[0] - tail.low[0], tail.high[0] - low[0]],
    ]
    assert np.array(reach) / length == pytest.approx(
        np.array([[0.15, 0.038], [0.054, 0.038], [0.06, 0.011], [0.06, 0.17]])
    )
    assert [(r.high - high)[1] / length for r in (nose, tail)] == pytest.approx([0.006, 0.017])
    mid, whole = boxes["mid"], body.vertices
    assert (whole.min(0) - mid.low)[:2] / length == pytest.approx([0.72, 0.17])
    assert (mid.high - whole.max(0))[0] / length == pytest.approx(0.23)


def test_friction_at_the_wall_is_that_of_the_line_of_1957() -> None:
    """C_F = 0.075 / (lg Re - 2)^2 = 0.003 at Re = 1e7."""
    assert 1e-6 / wall_unit(10.0, 1.0, 1e-6) == pytest.approx(10.0 * np.sqrt(0.003 / 2.0))


def test_an_end_gets_cells_of_a_quarter_of_its_radius(body: TowedBody) -> None:
    """The spheroid's radius at its ends is b^2/a = 0.02 m: 0.005 m, which 280 cells a length have anyway and 100 have not."""
    for count, finer in ((280.0, 0), (100.0, 1), (10.0, 2)):
        sizes = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(cells_per_length=count), WATER)
        tips = [region.level - sizes.levels["hull"] for region in sizes.regions if "tip" in region.name]
        assert tips == [finer] * (2 if finer else 0)


@pytest.mark.parametrize(
    ("keys", "half", "viscosity", "said"),
    [
        (MeshKeys(cells={"sail": 90}), Half.WHOLE, 1e-6, "rudder_upper"),
        (MeshKeys(), Half.WHOLE, None, "viscosity"),
        (MeshKeys(), Half.PORT, 1e-6, "mirror image in y = 0"),
    ],
)
def test_sizes_that_cannot_be(body: TowedBody, keys: MeshKeys, half: Half, viscosity: float | None, said: str) -> None:
    lopsided = replace(body, mirrors=(False, False, True))
    with pytest.raises(InputError, match=said):
        mesh_sizes(lopsided, 1.0, half, keys, Conditions(1000.0, 1.0, viscosity))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"beside": 0.2}, "0.5 or more"),
        ({"cells": {"sail": "many"}}, "cells.sail"),
        ({"wall": "law"}, '"functions"'),
        ({"most_cells": 1e9}, "3e+07 at most"),
    ],
)
def test_keys_that_cannot_be(given: Mapping[str, object], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        validated(MeshKeys, given)


def test_the_dictionaries_are_read_and_say_what_was_chosen(body: TowedBody, tmp_path: Path) -> None:
    made = job(body, tmp_path, MeshKeys(wall="resolved"), cores=2)
    case = FoamCase(made.folder)
    for file in (made.folder / "system").iterdir():
        assert case.word(case.read(f"system/{file.name}"), "FoamFile", "object") == file.name
    snappy = case.read("system/snappyHexMeshDict")
    regions = snappy.part("geometry", "body.stl", "regions")
    assert list(regions.entries) == list(body.patches)
    assert case.value(snappy, "addLayersControls", "layers", "hull", "expansionRatio")[0] == 1.3  # type: ignore[index]
    assert not case.notes
    block = (made.folder / "system" / "blockMeshDict").read_text()
    assert re.search(r"cut\s*\{\s*type symmetryPlane;\s*faces \(\(4 5 6 7\)\);", block)
    surface = (made.folder / "constant" / "triSurface" / "body.stl").read_text()
    assert re.findall(r"^solid (\S+)", surface, re.MULTILINE) == list(body.patches)


def test_equal_files_are_left_alone_and_the_key_is_of_what_the_mesh_depends_on(body: TowedBody, tmp_path: Path) -> None:
    first = job(body, tmp_path)
    times = {p: p.stat().st_mtime_ns for p in first.folder.rglob("*") if p.is_file()}
    assert job(body, tmp_path) == first
    assert times == {p: p.stat().st_mtime_ns for p in first.folder.rglob("*") if p.is_file()}
    assert job(body, tmp_path / "b", cores=2).key == first.key
    others = {
        job(body, tmp_path / "c", grid=Grid("coarse", 4.1)).key,
        job(body, tmp_path / "d", MeshKeys(wall="none", cells_per_chord=40)).key,
    }
    assert len(others | {first.key}) == 3


def test_names_say_what_is_meshed() -> None:
    assert mesh_name(COARSE, Half.WHOLE, {"dr": 0.0}) == "mesh/coarse"
    assert mesh_name(COARSE, Half.PORT, {"dr": np.radians(-5.0)}, 1.5) == "mesh/coarse_port_dr-5_domain1.5"


def test_too_many_cells_are_refused_before_anything_is_written(body: TowedBody, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a mesh of about .*e\+04 cells for the grid coarse.*1e\+03 at most"):
        job(body, tmp_path, MeshKeys(wall="none", most_cells=1000.0))
    for many in (
        {"cells_per_length": 1e5},
        {"cells": {"rudder_upper": 1e5}},
    ):  # more than memory can hold, even to count
        with pytest.raises(InputError, match=r"a mesh of about .*e\+\d\d cells"):
            job(body, tmp_path, MeshKeys(wall="none", **many))  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_a_mesh_that_was_not_made_is_named(body: TowedBody, tmp_path: Path) -> None:
    made = job(body, tmp_path)
    assert mesh_ended(made) == ((), "no mesh was made: log.checkMesh is missing")
    (made.folder / "log.checkMesh").write_text("cells: 9\n")
    assert mesh_ended(made)[1] == "no mesh was made: constant/polyMesh/boundary is missing"
    assert mesh_report(made.folder) is None
    for name, content, found in (
        ("planned.json", '{"cells": 10}', "nothing"), ("planned.json", "[1]", "a list"), ("planned.json", '{"cells": "many"}', "many"),
        (MESH_FILE, '{"cells": 1.5}', "1.5"), (MESH_FILE, "{", "expected JSON"),
    ):  # fmt: skip
        (made.folder / name).write_text(content)
        with pytest.raises(InputError, match=name) as why:
            mesh_report(made.folder) if name == MESH_FILE else expected_cells(made.folder)
        assert found in str(why.value)
        (made.folder / MESH_FILE).unlink(missing_ok=True)


def carried_out(made: Job) -> Job:
    for step in made.steps:
        path = made.folder / f"log.{step.name}"
        with path.open("w") as log:
            done = subprocess.run(step.command, cwd=made.folder, stdout=log, stderr=log, timeout=300, check=False)
        assert done.returncode == 0, f"{step.name}\n{path.read_text()[-2000:]}"
    return made


@pytest.fixture(scope="module")
def mesh(body: TowedBody, tmp_path_factory: pytest.TempPathFactory) -> Job:
    return carried_out(job(body, tmp_path_factory.mktemp("serial"), LAYERED))


@pytest.fixture
def copy(mesh: Job, tmp_path: Path) -> Job:
    return replace(mesh, folder=shutil.copytree(mesh.folder, tmp_path / "mesh"))


@pytest.mark.slow
@openfoam
def test_it_is_sound_and_has_the_cells_expected(mesh: Job) -> None:
    before = json.loads((mesh.folder / "planned.json").read_text())["cells"]
    assert mesh_ended(mesh)[1] == ""
    made = mesh_report(mesh.folder)
    assert made.cells == expected_cells(mesh.folder) == pytest.approx(before, rel=0.15)
    assert made.volume == pytest.approx(1.0, abs=0.01)
    assert set(made.surface) == {"hull", "rudder_upper"}  # the other rudder is below the cut
    assert min(made.surface.values()) > 0.95
    assert made.layers["hull"] > 0.9


@pytest.mark.slow
@openfoam
def test_few_layers_and_lost_patches_are_said(copy: Job) -> None:
    planned = json.loads((copy.folder / "planned.json").read_text())
    planned["layers"] |= {"hull": planned["layers"]["hull"] * 4, "rudder_upper": 2}
    planned["surface"] |= {"sail": 0.1, "rudder_upper": planned["surface"]["rudder_upper"] * 1.5}
    (copy.folder / "planned.json").write_text(json.dumps(planned))
    remarks, why = mesh_ended(copy)
    codes = [f.code for f in findings(mesh_report(copy.folder), planned)]  # type: ignore[arg-type]
    assert codes[:3] == ["tow.layers", "tow.few_layers", "tow.surface"]
    assert len(remarks) == len(codes)
    assert why == "no cell lies on the patch sail: its cells are too large for its shape"


@pytest.mark.slow
@openfoam
def test_a_mesh_that_no_solver_can_use_is_not_sound(copy: Job) -> None:
    planned = json.loads((copy.folder / "planned.json").read_text())
    (copy.folder / "planned.json").write_text(json.dumps(planned | {"volume": 3.0 * planned["volume"]}))
    assert mesh_ended(copy)[1].startswith("the mesh leaves out 33% of the body's volume")
    (copy.folder / "planned.json").write_text(json.dumps(planned))
    with (copy.folder / "log.checkMesh").open("a") as log:
        log.write(" ***Zero or negative cell volume detected.  Minimum: -1\n")
    assert mesh_ended(copy)[1] == "checkMesh: Zero or negative cell volume detected. Minimum: -1"


@pytest.mark.slow
@openfoam
def test_two_cores_make_the_mesh_that_one_was_expected_to(body: TowedBody, tmp_path: Path) -> None:
    made = carried_out(job(body, tmp_path, cores=2, grid=Grid("coarsest", 8.0)))
    before = expected_cells(made.folder)
    assert mesh_ended(made)[1] == ""
    assert expected_cells(made.folder) == pytest.approx(before, rel=0.25)
    assert (made.folder / MESH_FILE).is_file()
    assert not list(made.folder.glob("processor*"))
