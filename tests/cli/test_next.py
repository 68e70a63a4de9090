"""`coeflab next` through real processes."""

from __future__ import annotations

import json
from pathlib import Path

from coeflab.tank.tank_file import read_tank
from tests.cli.forked import Forks


def test_runs_are_written_and_read_by_the_tank(tmp_path: Path, forks: Forks) -> None:
    done = forks.run(["next", "tow_spheroid", "--for", "Nv'", "--runs", "4", "--to", "next.toml", "--json"], tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    head = '[tank]\nname = "n"\nbody = "tow_spheroid"\n[conditions]\nspeed = "2 m/s"\ndensity = "998 kg/m^3"\nviscosity = "1e-6 m^2/s"\n'
    (tmp_path / "tank.toml").write_text(head + (tmp_path / "next.toml").read_text())
    tank = read_tank(tmp_path / "tank.toml")
    assert len(found["tests"][0]["settings"]) == sum(c.kind.value == "drift" for c in tank.matrix)


def test_a_target_out_of_reach_and_a_wrong_ending(tmp_path: Path, forks: Forks) -> None:
    far = forks.run(["next", "tow_spheroid", "--for", "Nv'", "--runs", "4", "--target", "0.01%"], tmp_path)
    assert far.returncode == 1
    wrong = forks.run(["next", "tow_spheroid", "--for", "Nv'", "--to", "next.txt"], tmp_path)
    assert (wrong.returncode, list(tmp_path.iterdir())) == (2, [])
