"""``coeflab added-mass`` as a real process."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
import trimesh

Run = Callable[..., CompletedProcess[str]]


def test_suboff_shows_the_gap(coeflab: Run) -> None:
    done = coeflab("added-mass", "suboff_bare_hull")
    assert done.returncode == 0
    assert done.stderr == ""
    for words in ("5.9883", "5.9195", "0.699211", "+28.4 to +28.5 %", "+36.1 to +36.2 %", "+30.4 %", "-0.01327?"):
        assert words in done.stdout
    assert "primed by LBP 4.26086 m" in done.stdout
    assert "primitives: not used" in done.stdout
    assert "ellipsoid      /m  * panel      /m" in done.stdout
    assert "* recommended: panel, by the rule" in done.stdout
    assert done.stdout.count("semidefinite") == 1


def test_json_holds_matrices(coeflab: Run) -> None:
    done = coeflab("added-mass", "huuv", "--json", "--density", "1025")
    found = json.loads(done.stdout)
    assert set(found) == {"ellipsoid", "primitives", "primitives:huuv"}
    matrix = np.array(found["primitives:huuv"])
    assert matrix.shape == (6, 6)
    assert matrix[1, 1] == pytest.approx(1025.0 * np.pi * (0.07**2 * 1.2 + 0.02**2 * 0.3), rel=1e-12)


def test_one_method(coeflab: Run) -> None:
    done = coeflab("added-mass", "spheroid_example", "--method", "strip:lamb", "--json")
    assert list(json.loads(done.stdout)) == ["strip:lamb"]


def test_help_has_an_example(coeflab: Run) -> None:
    assert "Example: coeflab added-mass" in coeflab("added-mass", "--help").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("suboff",), "a body of particulars without a shape"),
        (("huuv", "--method", "panle"), "no added-mass method is called"),
    ],
)
def test_wrong_input(coeflab: Run, arguments: tuple[str, ...], said: str) -> None:
    done = coeflab("added-mass", *arguments)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_a_mesh_file_with_its_unit_and_axes(coeflab: Run, tmp_path: Path) -> None:
    trimesh.creation.icosphere(3, 500.0).export(tmp_path / "ball.stl")
    done = coeflab("added-mass", tmp_path / "ball.stl", "--unit", "mm", "--axes", "FLU", "--method", "panel", "--json")
    matrix = np.array(json.loads(done.stdout)["panel"])
    assert np.diag(matrix)[:3] == pytest.approx(0.5 * 1000.0 * 4.0 / 3.0 * np.pi * 0.5**3, rel=0.02)
    done = coeflab("added-mass", tmp_path / "ball.stl")
    assert done.returncode == 2
    assert "--unit" in done.stderr


def test_options_go_to_the_one_method(coeflab: Run) -> None:
    coarse = coeflab("added-mass", "spheroid_example", "--method", "panel", "--panels", "1200", "--kernel", "numpy")
    assert coarse.returncode == 0
    assert "plain" in coarse.stdout or "numpy" in coarse.stdout
    assert coeflab("added-mass", "spheroid_example", "--method", "panel", "--panel", "9").returncode == 2
    everyone = coeflab("added-mass", "spheroid_example", "--panels", "1200")
    assert everyone.returncode == 2
    assert "one --method" in everyone.stderr
