"""What a command writes the next command reads: bodies, drafts, tanks, campaigns, studies, parameter files, models of simulators."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.cli.conftest import Run

TABLE = "beta [deg],Y [N],N [N*m]\n-4,8.1,3.9\n-2,4.0,2.0\n0,0.0,0.0\n2,-4.0,-2.0\n4,-8.1,-3.9\n"
ASKED = ("--set", "scaling.length=2", "--set", "scaling.length_name=LOA", "--set", "conditions.speed=2", "--set", "conditions.density=1000",
         "--set", "axes.datum=nose", "--set", "axes.reference_point=-1,0,0", "--set", "axes.beta=+", "--accept")  # fmt: skip


def mesh(path: Path) -> None:
    """A round hull of 1 m in mm, its bow along z of the file, y up."""
    s = np.linspace(0.05, np.pi - 0.02, 16)
    radius, along = np.r_[0.0, 0.1 * np.sqrt(np.sin(s)), 0.0], np.r_[0.0, np.linspace(0.01, 0.99, 16), 1.0]
    made = trimesh.creation.revolve(np.column_stack([radius, along]), sections=20)
    made.merge_vertices()
    made.apply_scale(1000.0).export(path)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "axes"), [("Rumpf ä'1", "port, up, forward"), ("0.9 m#2", "PORT,UP,FORWARD")])
def test_what_is_made_of_a_mesh_is_read_by_what_comes_next(tmp_path: Path, coeflab: Run, name: str, axes: str) -> None:
    mesh(tmp_path / f"{name}.stl")
    stated = (f"{name}.stl", "--unit", "mm", "--axes", axes)
    quick = ("--method", "ellipsoid")
    for step in (
        ("vehicle", *stated, *quick, "--out", "v"), ("vehicle", "v", *quick, "--out", "again"), ("inspect", "v"),
        ("tow", "v", "--dry-run", "--out", "t"),
        ("simplify", *stated, "--panels", "0", "--out", "s"), ("inspect", "s"), ("vehicle", "s", *quick, "--out", "of_parts"),
    ):  # fmt: skip
        done = coeflab(*step)
        assert done.returncode == 0, (step, done.stderr)
    (file,) = (tmp_path / "v").glob("*.parameters.json")
    assert coeflab("params", "check", file).returncode == 0
    for target, suffix in (("gazebo", "sdf"), ("mss", "m"), ("xdyn", "yml")):
        assert coeflab("export", file, "--to", target, "--accept-loss", "--out", target).returncode == 0
        for written in (tmp_path / target).glob(f"*.{suffix}"):
            assert coeflab("params", "check", written).returncode == 0, written


@pytest.mark.slow
@pytest.mark.parametrize(
    "axes",
    ["FRD", "flu", "CFD", "aft,port,down", "starboard,up,aft", "down, forward, starboard", "x aft, y port, z down"],
)
def test_axes_of_an_import_are_read_from_its_campaign(tmp_path: Path, coeflab: Run, axes: str) -> None:
    (tmp_path / "drift ä.csv").write_text(TABLE, encoding="utf-8")
    done = coeflab("import", "drift ä.csv", "--out", "c", "--set", f"axes.frame={axes}", *ASKED)
    assert done.returncode in (0, 1), done.stderr  # 1: the sign of Yv' is wrong in these axes
    done = coeflab("inspect", "c")
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_a_study_and_a_file_of_own_numbers_are_read_again(tmp_path: Path, coeflab: Run) -> None:
    assert coeflab("new", "study 1").returncode == 0
    assert coeflab("run", "study 1/plan.toml", "--out", "r").returncode == 0
    for file in (tmp_path / "r").glob("*.parameters.json"):
        assert coeflab("params", "check", file).returncode == 0
    own = ("--about", "cg", "--length", "2 m", "--speed", "1 m/s", "--density", "1000", "--mass", "40 kg", "--inertia", "12", "--set", "Yv'=-0.03 +- 0.003",
           "--set", "Nv'=-0.012", "--set", "Yr'=0.005", "--set", "Nr'=-0.006", "--set", "Yvdot'=-0.009", "--set", "Nrdot'=-0.0005")  # fmt: skip
    done = coeflab("params", "new", "own", *own)
    assert done.returncode == 0, done.stderr
    (file,) = tmp_path.glob("**/own.parameters.json")
    assert coeflab("params", "check", file).returncode == 0
    for kind in ("plan", "campaign", "body", "glider", "tuning", "tank", "published", "parameters"):
        assert coeflab("schema", kind).returncode == 0
