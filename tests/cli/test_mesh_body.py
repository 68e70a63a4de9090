"""A body with a mesh through the real command."""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh import file as mesh_file
from coeflab.cli import main
from tests.cli.conftest import flat

Run = Callable[..., CompletedProcess[str]]
BODY = """[body]
name = "bar"
title = "a bar of 2 m"
reader = "mesh"
datum = "middle"
reference_point = [0.0, 0.0, 0.0]
[mesh]
path = "{}"
unit = "{}"
axes = "FLU"
[source]
citation = "synthetic"
[particulars]
length = 2.0
"""


@pytest.fixture
def bar(tmp_path: Path) -> Path:
    trimesh.creation.box(extents=(2000.0, 200.0, 100.0)).export(tmp_path / "bar.stl")
    (tmp_path / "body.toml").write_text(BODY.format("bar.stl", "mm"))
    return tmp_path


def test_particulars_and_matrices(coeflab: Run, bar: Path) -> None:
    done = coeflab("added-mass", bar, "--method", "strip")
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        "bar: a bar of 2 m", "integrals over 12 faces", "0.0400000", "1.2400", "displaced water", "0.02000",
        "by_mesh", "96 sections: 96 rectangles", "J. N. Newman",
    ):  # fmt: skip
        assert words in flat(done.stdout)


def test_json(coeflab: Run, bar: Path) -> None:
    found = json.loads(coeflab("added-mass", bar / "body.toml", "--json", "--method", "strip").stdout)
    matrix = np.array(found["strip"]["matrix"])
    assert matrix[2, 2] == pytest.approx(1000.0 * 1.36 * np.pi * 0.1**2 * 2.0, rel=0.01)
    assert matrix[0] == pytest.approx(np.zeros(6))


def test_wrong_unit_is_one_clear_error(coeflab: Run, bar: Path) -> None:
    (bar / "body.toml").write_text(BODY.format("bar.stl", "m"))
    done = coeflab("added-mass", bar)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert 'Is the unit "mm"? The body would be 2 m long.' in done.stderr


def test_a_malicious_file_is_refused_at_once(coeflab: Run, bar: Path) -> None:
    (bar / "bar.stl").write_bytes(bytes(80) + struct.pack("<I", 4_000_000_000) + bytes(5000))
    done = coeflab("added-mass", bar)
    assert (done.returncode, done.stdout) == (2, "")
    assert "counts 4000000000 triangles" in done.stderr
    assert "Traceback" not in done.stderr


def test_large_meshes_are_announced_on_standard_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those of 500,000 faces or more, which take 0.4 GB."""
    assert mesh_file.LARGE_MESH == 500_000
    assert mesh_file.memory_needed(522_240) == pytest.approx(0.3656e9, rel=1e-3)
    monkeypatch.setattr(mesh_file, "LARGE_MESH", 3000)
    whole = trimesh.creation.uv_sphere(count=[32, 64])
    whole.vertices = whole.vertices * [2000.0, 200.0, 200.0]
    whole.vertices -= [1000.0, 0.0, 0.0]
    whole.export(tmp_path / "ball.stl")
    text = BODY.format("ball.stl", "mm").replace("length = 2.0", "length = 4.0")
    (tmp_path / "body.toml").write_text(text)
    monkeypatch.setattr(sys, "argv", ["coeflab", "added-mass", str(tmp_path), "--method", "strip:lamb", "--json"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    printed = capsys.readouterr()
    first, *remarks = printed.err.splitlines()
    assert first == f"ball.stl: {len(whole.faces)} faces, about 0.1 GB of memory"
    assert any("recommended: strip:lamb" in said for said in remarks)
    assert list(json.loads(printed.out)) == ["strip:lamb"]


def test_draw_and_simplify_take_holes_and_sheets_as_vehicle_does(coeflab: Run, tmp_path: Path) -> None:
    """A ball without one face, and a wall of one sheet beside it."""
    ball = trimesh.creation.icosphere(2, 0.5)
    trimesh.Trimesh(ball.vertices, ball.faces[1:]).export(tmp_path / "hole.stl")
    wall = trimesh.Trimesh([[0.6, 0, 0], [1, 0, 0], [1, 0.4, 0], [0.6, 0.4, 0]], [[0, 1, 2], [0, 2, 3]])
    trimesh.util.concatenate([ball, wall]).export(tmp_path / "sheet.stl")
    named = ("--unit", "m", "--axes", "FRD")
    assert coeflab("draw", "hole.stl", *named).returncode == 2
    assert coeflab("draw", "hole.stl", "--unit", "m", "--axes", "frd", "--fill").returncode == 0  # no capitals needed
    done = coeflab("draw", "hole.stl", *named, "--fill")
    assert done.returncode == 0, done.stderr
    done = coeflab("simplify", "hole.stl", *named, "--fill", "--panels", "0")
    assert done.returncode == 0, done.stderr
    assert "sphere" in done.stdout
    done = coeflab("draw", "sheet.stl", *named, "--sheets")
    assert done.returncode == 0, done.stderr
    done = coeflab("simplify", "sheet.stl", *named, "--sheets")
    assert done.returncode == 2
    assert "sheets of no thickness" in flat(done.stderr)
