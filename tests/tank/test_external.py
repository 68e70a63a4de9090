"""The solver outside coeflab: a list of runs and an empty table go out, the filled table comes back."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tank.solvers import SOLVERS, external
from coeflab.tank.tank import Tank
from coeflab.tank.tank_file import read_tank
from tests.tank.towed_bodies import BODY_FILE, with_mirrors

BODY = with_mirrors("y")
TANK_TOML = """
[tank]
solver = "external"
[conditions]
speed = 2.0
density = 998.0
viscosity = 1e-6
[matrix]
drift = ["2 deg", "4 deg"]
attack = ["-3 deg"]
yaw = [0.1]
[[study]]
of = ["drift+4"]
grid = ["fine"]
domain = [1.5]
"""


@pytest.fixture
def tank(tmp_path: Path) -> Tank:
    return read_with(tmp_path)


def read_with(folder: Path, more: str = "") -> Tank:
    (folder / "tank.toml").write_text(TANK_TOML + more)
    return read_tank(folder / "tank.toml", BODY, body_file=BODY_FILE)


def rows_of(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")))


def filled(path: Path, **cells: dict[str, str]) -> None:
    comments = [line for line in path.read_text().splitlines() if line.startswith("#")]
    rows = [row | cells.get(row["condition"].replace("+", "_"), {}) for row in rows_of(path)]
    lines = [",".join(rows[0]), *(",".join(row.values()) for row in rows)]
    path.write_text("\n".join([*comments, *lines]) + "\n")


def test_the_list_says_every_motion_and_the_table_is_empty(tank: Tank, tmp_path: Path) -> None:
    assert external.jobs(tank, BODY, tmp_path) == ()
    runs = rows_of(tmp_path / "external" / "run_list.csv")
    assert [r["condition"] for r in runs] == [c.name for c in tank.matrix]
    for run, c in zip(runs, tank.matrix, strict=True):
        motion = [float(run[f"{m} [{unit}]"]) for names, unit in (("uvw", "m/s"), ("pqr", "rad/s")) for m in names]
        assert motion == pytest.approx([*c.velocity, *c.rates], abs=1e-11)
    by_name = {r["condition"]: r for r in runs}
    assert by_name["attack-3"]["half"] == "y<0"
    assert by_name["attack-3"]["zero by symmetry"] == "Y K N"
    assert float(by_name["drift+4_grid_fine"]["cell size"]) == pytest.approx(1 / 1.3, rel=1e-5)
    assert by_name["drift+4_domain_1.5"]["domain"] == "1.5"
    empty = rows_of(tmp_path / "external" / "forces.csv")
    assert [r["condition"] for r in empty] == [c.name for c in tank.matrix]
    assert not any(cell for r in empty for name, cell in r.items() if name != "condition")


def test_what_is_filled_in_comes_back_in_si(tank: Tank, tmp_path: Path) -> None:
    external.jobs(tank, BODY, tmp_path)
    path = tmp_path / "external" / "forces.csv"
    filled(path, drift_4={"Y [N]": "18.5", "N [N*m]": "146", "se_Y [N]": "0.1", "cells": "600000"})
    path.write_text(path.read_text().replace("Y [N]", "Y [kN]", 1))
    table = external.table(tank, BODY, tmp_path)
    assert table.row_labels == tuple(c.name for c in tank.matrix)
    at = table.row_labels.index("drift+4")
    columns = {c.means: c for c in table.columns}
    assert columns["Y"].values[at] == 18500.0
    assert columns["N"].values[at] == 146.0
    assert columns["se_Y"].values[at] == 0.1
    assert columns["cells"].values[at] == 600000.0
    assert np.isnan(np.delete(columns["Y"].values, at)).all()
    assert table.lines[at] == path.read_text().splitlines().index("drift+4,,18.5,,,,146,,0.1,,,,,600000,") + 1


def test_a_filled_table_is_never_overwritten(tank: Tank, tmp_path: Path) -> None:
    external.jobs(tank, BODY, tmp_path)
    path = tmp_path / "external" / "forces.csv"
    filled(path, drift_2={"Y [N]": "9"})
    before = path.read_bytes().removesuffix(b"\n")
    path.write_bytes(before)
    more = read_with(tmp_path, '[[study]]\nof = ["yaw+0.1"]\nturbulence = ["k_epsilon"]\n')
    external.jobs(more, BODY, tmp_path)
    assert path.read_bytes().startswith(before + b"\n")
    assert rows_of(path)[-1]["condition"] == "yaw+0.1_turbulence_k_epsilon"
    after = path.read_bytes()
    external.jobs(more, BODY, tmp_path)
    assert path.read_bytes() == after
    assert external.table(more, BODY, tmp_path).column("Y").values[2] == 9.0


def test_an_empty_table_follows_the_matrix(tank: Tank, tmp_path: Path) -> None:
    external.jobs(tank, BODY, tmp_path)
    more = read_with(tmp_path, '[[study]]\nof = ["yaw+0.1"]\nturbulence = ["k_epsilon"]\n')
    external.jobs(more, BODY, tmp_path)
    names = [r["condition"] for r in rows_of(tmp_path / "external" / "forces.csv")]
    assert names == [c.name for c in more.matrix]


def test_a_table_elsewhere_is_named_by_tank_toml(tmp_path: Path) -> None:
    tank = read_with(tmp_path, '[solver.external]\ntable = "mine.csv"\nmade_by = "panel code 3"\n')
    (tmp_path / "mine.csv").write_text("condition,Y [N]\ndrift+2,9\n")
    table = external.table(tank, BODY)
    assert table.column("Y").values.tolist() == [9.0]
    assert table.stated["source.how_obtained"].value == "panel code 3"


@pytest.mark.parametrize(
    ("text", "words", "line"),
    [
        ("condition,Y [N]\ndrift+2,9\ndrift+2,9\n", "twice", 3),
        ("condition,Y [N]\ndrift+3,9\n", "a condition of run_list.csv", 2),
        ("condition,Y [N]\ndrift+2,nine\n", "a finite number", 2),
        ("condition,Y [N],se_Y [N]\ndrift+2,9,0\n", "a number above zero, or a blank cell", 2),
        ("condition,Y [m]\ndrift+2,9\n", "force", 1),
        ("condition,Y\ndrift+2,9\n", "a unit in brackets", 1),
        ("condition,lift [N]\ndrift+2,9\n", "the unknown column", 1),
        ("name,Y [N]\ndrift+2,9\n", "a column condition", 1),
    ],
)
def test_a_wrong_table_is_refused_by_line(tmp_path: Path, text: str, words: str, line: int) -> None:
    tank = read_with(tmp_path)
    (tmp_path / "external").mkdir()
    (tmp_path / "external" / "forces.csv").write_text(text)
    with pytest.raises(InputError) as why:
        external.table(tank, BODY, tmp_path)
    assert words in str(why.value)
    assert (why.value.file, why.value.line) == (tmp_path / "external" / "forces.csv", line)


def test_everything_wrong_with_a_table_is_said_at_once(tmp_path: Path) -> None:
    tank = read_with(tmp_path)
    (tmp_path / "external").mkdir()
    rows = "drift+3,9,0,1\ndrift+2,9,-1,1\ndrift+2,9,1,1\n"
    (tmp_path / "external" / "forces.csv").write_text(f"condition,Y [N],se_Y [N],lift [N]\n{rows}")
    with pytest.raises(InputError) as why:
        external.table(tank, BODY, tmp_path)
    assert [line.partition("line ")[2].partition(",")[0] for line in why.value.lines] == ["1", "2", "2", "3", "4"]


def test_no_table_at_all(tank: Tank, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"\[solver.external\] with table"):
        external.table(tank, BODY)
    with pytest.raises(InputError, match="no such file"):
        external.table(tank, BODY, tmp_path)


def test_it_needs_nothing_installed() -> None:
    plugin = SOLVERS.load("external")
    assert plugin.installed().missing == ""
    assert plugin.history is None
    assert plugin.stop is None


def test_lists_that_are_all_empty_are_no_tow(tmp_path: Path) -> None:
    """It wrote one straight run, which gives no derivative; speeds ask for the resistance alone."""
    head = TANK_TOML.partition("[matrix]")[0]
    nothing = "[matrix]\ndrift = []\nattack = []\nyaw = []\n"
    (tmp_path / "tank.toml").write_text(head + nothing)
    with pytest.raises(InputError, match="no condition"):
        read_tank(tmp_path / "tank.toml", BODY, body_file=BODY_FILE)
    (tmp_path / "tank.toml").write_text(head + nothing + "speeds = [1.0]\n")
    assert len(read_tank(tmp_path / "tank.toml", BODY, body_file=BODY_FILE).matrix) == 2
