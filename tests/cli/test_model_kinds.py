"""A simulator's model given where a parameter file or a table is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run, flat

GOLDEN = Path(__file__).parents[1] / "formats" / "golden"
KINDS = {"gazebo.sdf": "an SDF", "uuv_simulator.urdf": "a URDF", "file.yml": "an xdyn YAML", "mss.m": "a MATLAB file"}


@pytest.mark.parametrize("name", KINDS)
def test_verbs_take_a_model(coeflab: Run, name: str, tmp_path: Path) -> None:
    """Before: refused, with what reads it."""
    done = coeflab("compare", GOLDEN / name, GOLDEN / name)
    assert done.returncode == 0, done.stderr
    assert "0 apart" in flat(done.stdout)
    done = coeflab("export", GOLDEN / name, "--to", "mss", "--accept-loss", "--out", tmp_path / "out")
    assert done.stderr == ""
    assert list((tmp_path / "out").glob("*.m"))


def test_convert_writes_a_parameter_file_once(coeflab: Run, tmp_path: Path) -> None:
    words = ("params", "convert", GOLDEN / "gazebo.sdf", "--name", "mine", "--out", tmp_path)
    done = coeflab(*words)
    assert "Left out of mine" in flat(done.stdout)
    assert (tmp_path / "mine.parameters.json").is_file()
    assert coeflab(*words).returncode == 2
    assert coeflab("params", "convert", "remus100").returncode == 2


@pytest.mark.parametrize("name", ["../x", "a/b", "$(rm)", "con\n", "", "-rf"])
def test_a_hostile_name_of_a_model_makes_no_path(coeflab: Run, name: str, tmp_path: Path) -> None:
    from xml.sax.saxutils import quoteattr

    text = (GOLDEN / "gazebo.sdf").read_text().replace('<model name="file"', f"<model name={quoteattr(name)}")
    (tmp_path / "m.sdf").write_text(text)
    coeflab("params", "convert", tmp_path / "m.sdf", "--out", tmp_path / "deep" / "out")
    written = [p for p in tmp_path.rglob("*") if p.is_file() and p.name != "m.sdf"]
    assert all(p.parent == tmp_path / "deep" / "out" and p.name.endswith(".parameters.json") for p in written)


def test_import_says_so_too(coeflab: Run) -> None:
    done = coeflab("import", GOLDEN / "gazebo.sdf")
    assert done.returncode == 2
    assert "an SDF" in done.stderr
    assert "coeflab params check" in done.stderr


def test_where_a_json_breaks_is_said_plainly(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{\n  "a": 1,,\n}')
    assert "line 2, character 10: found" in flat(coeflab("params", "check", "a.json").stderr)
