"""A simulator's model given where a parameter file or a table is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run, flat

GOLDEN = Path(__file__).parents[1] / "formats" / "golden"
KINDS = {"gazebo.sdf": "an SDF", "uuv_simulator.urdf": "a URDF", "file.yml": "an xdyn YAML", "mss.m": "a MATLAB file"}


@pytest.mark.parametrize("name", KINDS)
def test_a_model_is_named_with_what_reads_it(coeflab: Run, name: str) -> None:
    done = coeflab("export", GOLDEN / name, "--to", "mss")
    assert done.returncode == 2
    assert f"found {KINDS[name]}, a simulator's model; expected a parameter file" in flat(done.stderr)
    assert "coeflab params check" in done.stderr


def test_compare_and_import_say_so_too(coeflab: Run) -> None:
    for words in (("compare", "remus100", GOLDEN / "gazebo.sdf"), ("import", GOLDEN / "gazebo.sdf")):
        done = coeflab(*words)
        assert done.returncode == 2
        assert "an SDF" in done.stderr
        assert "coeflab params check" in done.stderr


def test_where_a_json_breaks_is_said_plainly(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{\n  "a": 1,,\n}')
    assert "line 2, character 10: found" in flat(coeflab("params", "check", "a.json").stderr)
