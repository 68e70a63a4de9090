"""``coeflab added-mass`` as a real process."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
import trimesh

from tests.cli.conftest import flat
from tests.cli.survey import too_long

Run = Callable[..., CompletedProcess[str]]


@pytest.mark.slow
def test_suboff_shows_the_gap(coeflab: Run) -> None:
    done = coeflab("added-mass", "suboff_bare_hull")
    assert done.returncode == 0
    assert done.stderr == ""
    assert too_long(done.stdout) == []
    for words in ("5.9883", "5.9195", "0.699211", "+28.4 to +28.5 %", "+36.1 to +36.2 %", "+30.4 %", "-0.01327?"):
        assert words in flat(done.stdout)
    assert "primed by LBP 4.26086 m" in flat(done.stdout)
    assert "primitives: not used" in flat(done.stdout)
    assert "ellipsoid      /m  * panel      /m" in done.stdout
    assert "* recommended: panel, by the rule" in flat(done.stdout)
    assert done.stdout.count("semidefinite") == 1


@pytest.mark.slow
def test_json_holds_matrices(coeflab: Run) -> None:
    done = coeflab("added-mass", "huuv", "--json", "--density", "1025")
    found = json.loads(done.stdout)
    assert set(found) == {"ellipsoid", "panel", "primitives", "primitives:huuv"}
    matrix = np.array(found["primitives:huuv"]["matrix"])
    assert matrix.shape == (6, 6)
    assert matrix[1, 1] == pytest.approx(1025.0 * np.pi * (0.07**2 * 1.2 + 0.02**2 * 0.3), rel=1e-12)


def test_json_leaves_remarks_on_standard_error(coeflab: Run, tmp_path: Path) -> None:
    """What was mended and which method to use are said, but never within the object."""
    bar = trimesh.creation.box(extents=(1.0, 0.2, 0.2))
    bar.invert()
    bar.export(tmp_path / "bar.stl")
    asked = ("added-mass", tmp_path / "bar.stl", "--unit", "m", "--axes", "FRD", "--method", "strip", "--json")
    assert coeflab(*asked).returncode == 2
    done = coeflab(*asked, "--repair")
    assert list(json.loads(done.stdout)) == ["strip"]
    for words in ("by_mesh: integrals over 12 faces; ", "* recommended: strip, by the rule", "strip: sections only"):
        assert words in done.stderr


def test_a_thin_box_gets_no_ellipsoid_without_a_caveat(coeflab: Run, tmp_path: Path) -> None:
    trimesh.creation.box(extents=(1.0, 0.5, 0.02)).export(tmp_path / "thin.stl")
    said = coeflab("added-mass", tmp_path / "thin.stl", "--unit", "m", "--axes", "FRD", "--wide").stdout
    for words in (
        "* recommended: primitives, by the rule",
        "NONE OF THE METHODS SHOWN IS GOOD FOR THIS BODY: primitives is a rough guide",
        "projected areas +50, +9, +9 %, second moments of volume -40, +15, +15 % along x, y, z; over 10%: a rough guide",
        "chord 1 m, span 0.5 m, of mean thickness 0.04 of the shorter",
        "panel: not used: a body whose smallest side is 0.04 of the next",
    ):
        assert words in said


def test_one_method(coeflab: Run) -> None:
    done = coeflab("added-mass", "spheroid_example", "--method", "strip:lamb", "--json")
    found = json.loads(done.stdout)
    assert list(found) == ["strip:lamb"]
    said = found["strip:lamb"]
    assert list(said) == ["matrix", "error", "point", "datum", "density", "rough", "recommended", "statements"]
    assert (said["error"], said["density"], said["rough"], said["recommended"]) == (None, 998.2, False, True)
    assert len(said["point"]) == 3


def test_json_of_the_panel_method_has_its_error(coeflab: Run) -> None:
    done = coeflab("added-mass", "spheroid_example", "--method", "panel", "--json", "--density", "1025")
    said = json.loads(done.stdout)["panel"]
    share = said["error"][1][1] / said["matrix"][1][1]
    assert 0.0 < share < 0.05
    assert said["density"] == 1025.0


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
    matrix = np.array(json.loads(done.stdout)["panel"]["matrix"])
    assert np.diag(matrix)[:3] == pytest.approx(0.5 * 1000.0 * 4.0 / 3.0 * np.pi * 0.5**3, rel=0.02)
    done = coeflab("added-mass", tmp_path / "ball.stl")
    assert done.returncode == 2
    assert "--unit" in done.stderr


def test_a_mesh_file_shows_its_particulars(coeflab: Run, tmp_path: Path) -> None:
    """Centre in all directions, projected areas and inertia of the displaced water: as of a body.toml."""
    bar = trimesh.creation.box(extents=(2000.0, 200.0, 100.0))
    bar.apply_translation([100.0, 20.0, 30.0])
    bar.export(tmp_path / "bar.stl")
    done = coeflab("added-mass", tmp_path / "bar.stl", "--unit", "mm", "--axes", "FLU", "--method", "strip")
    assert done.returncode == 0
    row = next(line for line in done.stdout.splitlines() if "by_mesh" in line and "integrals" in line)
    assert row.split()[1:6] == ["0.0400000", "0.1000", "-0.0200", "-0.0300", "1.2400"]
    row = next(line for line in done.stdout.splitlines() if line.split()[:1] == ["by_mesh"] and "integrals" not in line)
    assert [float(x) for x in row.split()[1:5]] == pytest.approx(
        [0.02, 0.2, 0.4, 998.2 * 0.04 * (0.04 + 0.01) / 12.0], rel=1e-3
    )


@pytest.mark.parametrize("command", ["added-mass", "simplify"])
def test_a_mesh_file_of_4356_m(coeflab: Run, tmp_path: Path, command: str) -> None:
    trimesh.creation.box(extents=(4356.0, 508.0, 508.0)).export(tmp_path / "suboff.stl")
    done = coeflab(command, tmp_path / "suboff.stl", "--unit", "m", "--axes", "FLU")
    assert (done.returncode, done.stdout) == (2, "")
    for words in (
        '"--unit"',
        "a body 4356 m in size",
        "0.05 to 500 m",
        'Is the unit "mm"? The body would be 4.356 m long.',
    ):
        assert words in done.stderr


def test_what_rounding_leaves_has_no_spread(coeflab: Run, tmp_path: Path) -> None:
    """The panel method finds that a ring does not turn the water about its axis; others do not matter beside that."""
    trimesh.creation.torus(0.5, 0.1).export(tmp_path / "ring.stl")
    done = coeflab("added-mass", tmp_path / "ring.stl", "--unit", "m", "--axes", "FLU", "--wide")
    lines = [line for line in done.stdout.splitlines() if line.split()[:1] in (["Nrdot"], ["Yrdot"])]
    assert [line.split()[-1] for line in lines] == ["-", "-"]


def test_a_spread_beyond_the_value_has_no_digits(coeflab: Run, tmp_path: Path) -> None:
    """About the axis of a duct the panels find the corners of its facets, sections the water within."""
    trimesh.creation.annulus(0.4, 0.5, 0.3).export(tmp_path / "duct.stl")
    done = coeflab("added-mass", tmp_path / "duct.stl", "--unit", "m", "--axes", "FLU", "--wide")
    assert next(line for line in done.stdout.splitlines() if "Nrdot" in line).endswith("> 1000 %")


def test_options_go_to_the_one_method(coeflab: Run) -> None:
    coarse = coeflab("added-mass", "spheroid_example", "--method", "panel", "--panels", "1200", "--kernel", "numpy")
    assert coarse.returncode == 0
    assert "plain" in coarse.stdout or "numpy" in flat(coarse.stdout)
    assert coeflab("added-mass", "spheroid_example", "--method", "panel", "--panel", "9").returncode == 2
    everyone = coeflab("added-mass", "spheroid_example", "--panels", "1200")
    assert everyone.returncode == 2
    assert "one --method" in everyone.stderr
