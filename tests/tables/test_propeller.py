"""Propellers that run and models of ships: thrust is no resistance, the speed of a ship is not that of its model."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.fits.rows.straight_runs import straight_runs
from coeflab.study.checks import data_gate
from coeflab.study.checks.propeller import left_out, self_propulsion
from coeflab.study.checks.straight_runs import friction
from coeflab.tables.column_company import proposals
from coeflab.tables.column_map import read_column_map
from coeflab.tables.force_table import DRIVEN, ForceTable
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.mapping import assigned
from coeflab.tables.words.primes import SCALE

Read = Callable[..., ForceTable]
HEAD = "beta [deg],U [m/s],rps [rpm],J [-],X [N],Y [N]\n"
# X = -R + T with R 2.4 and 5.4 N; T by hand at 360, 540 and 720 rpm.
ROWS = "0,1,0,,-2.4,0\n0,1,360,2,-1.6,0\n0,1,540,1.5,-0.4,0\n0,1,720,1,1.2,0\n0,1.5,540,2,-4,0\n0,1.5,720,1.8,-2,0\n4,1,540,1.5,-0.5,3\n"


def test_thrust_is_kept_out_of_resistance_and_self_propulsion_is_named(read_table: Read) -> None:
    table = read_table(HEAD + ROWS)
    assert table.usable["X"].tolist() == [True, *[False] * 6]
    assert table.usable["Y"].all()
    assert {e.reason for e in table.exclusions} == {DRIVEN}
    assert table.propeller["rps"][1] == pytest.approx(6.0 * 2.0 * np.pi)
    (left,), (own,) = left_out(table), self_propulsion(table)
    assert left["count"] == 6
    assert own["speed"] == 1.0
    assert own["rps"] == pytest.approx(9.0 + 3.0 * 0.4 / 1.6)  # between 9 and 12 turns a second
    assert own["J"] == pytest.approx(1.5 - 0.5 * 0.4 / 1.6)


def test_x_of_the_hull_alone_is_used_where_it_is_declared(read_table: Read) -> None:
    table = read_table(HEAD + ROWS, table="contains_thrust = false")
    assert table.usable["X"].all()
    assert not [*left_out(table), *self_propulsion(table)]


@pytest.mark.parametrize(
    ("name", "unit", "what"),
    [
        ("rpm", "", "rps [rpm]"), ("n", "1/s", "rps [rps]"), ("n", "rpm", "rps [rpm]"), ("Propeller speed", "Hz", "rps [rps]"),
        ("Drehzahl", "1/min", "rps [rpm]"), ("J", "", "J [-]"), ("Advance ratio", "", "J [-]"), ("T", "N", "thrust [N]"), ("Schub", "kN", "thrust [kN]"),
        ("N", "N*m", "N [N*m]"), ("KQ", "", "ignore"),
    ],
)  # fmt: skip
def test_columns_of_a_propeller_are_known(tmp_path: Path, name: str, unit: str, what: str) -> None:
    head = f"{name} [{unit}]" if unit else name
    (tmp_path / "t.csv").write_text(f"beta [deg],{head},Y [N]\n0,5,1\n2,6,2\n4,7,3\n")
    raw = IMPORTERS.load("table").raw(tmp_path / "t.csv", {})
    assert proposals(raw)[1].text == what


def ship(tmp_path: Path, head: str, scale: float = 25.0) -> Path:
    """Resistance of a model of 4 m, 3.2 m^2: (1 + 0.15) C_F + 0.03 Fn^4, over the speed of its ship."""
    knots = np.array([9.0, 12.0, 15.0, 18.0, 20.0, 22.0])
    speed = knots * 1852.0 / 3600.0 / np.sqrt(scale)
    friction = 0.075 / (np.log10(speed * 4.0 / 1e-6) - 2.0) ** 2
    drag = 0.5 * 1000.0 * speed**2 * 3.2 * (1.15 * friction + 0.03 * (speed**2 / (9.80665 * 4.0)) ** 2)
    (tmp_path / "ship.csv").write_text(
        f"{head}\nShip speed [kn],RTM [N]\n"
        + "\n".join(f"{a},{b:.6f}" for a, b in zip(knots, drag, strict=True))
        + "\n"
    )
    return tmp_path / "ship.csv"


@pytest.mark.parametrize(
    "words", ["# scale 1:25", "# Scale factor = 25", "# λ = 25", "# Maßstab 1 : 25", "# model scale ratio 25.0"]
)
def test_the_speed_of_a_ship_is_turned_by_the_scale_of_its_model(tmp_path: Path, words: str) -> None:
    raw = IMPORTERS.load("table").raw(ship(tmp_path, words), {})
    assert raw.stated[SCALE].value == 25.0
    assert [p.text for p in proposals(raw)] == ["U [kn ship 25.0]", "drag [N]"]
    assert read_column_map("U [kn ship 25.0]").ship == 25.0
    assert str(read_column_map("U [kn ship 25.0]")) == "U [kn ship 25.0]"
    one = assigned(raw, {"Ship speed": read_column_map("U [kn ship 25]"), "RTM": read_column_map("drag [N]")})
    assert one[0].values[0] == pytest.approx(9.0 * 1852.0 / 3600.0 / 5.0)


def test_the_speed_of_a_ship_without_a_scale_is_asked(tmp_path: Path) -> None:
    raw = IMPORTERS.load("table").raw(ship(tmp_path, "# a model"), {})
    assert not proposals(raw)[0].whole


def test_a_resistance_table_gives_its_form_factor(read_table: Read, tmp_path: Path) -> None:
    lines = ship(tmp_path, "#").read_text().split("\n")[2:-1]
    rows = [line.split(",") for line in lines]
    text = "U [kn],drag [N]\n" + "\n".join(f"{float(u) / 5.0!r},{r}" for u, r in rows) + "\n"
    conditions = "speed = 1.5\ndensity = 1000.0\nviscosity = 1e-6"
    table = read_table(text, conditions=conditions, scaling='length = 4.0\nlength_name = "LBP"')
    runs = straight_runs(table, 4.0)
    assert runs is not None
    (found,) = friction(runs, table)
    assert found.statistic == pytest.approx(1.15 * 3.2 / 16.0, rel=1e-5)
    assert found["per"] == pytest.approx(0.03 * 3.2 / 16.0, rel=1e-3)


def test_a_speed_of_the_model_is_taken_before_that_of_the_ship_and_torque_is_of_no_use(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(
        "Vs (kn),Vm (m/s),n (rps),Q (Nm),T (N),Fx (N)\n" + "".join(f"{v},{v / 10},{v},1,2,{-v}\n" for v in (8, 10, 12))
    )
    raw = IMPORTERS.load("table").raw(tmp_path / "t.csv", {})
    assert [p.text for p in proposals(raw)] == ["ignore", "U [m/s]", "rps [rps]", "ignore", "thrust [N]", "X [N]"]


def test_a_test_of_self_propulsion_varies_the_rate(read_table: Read) -> None:
    table = read_table("beta [deg],U [m/s],rps [rps],X [N]\n0,1,6,-2\n0,1,8,-1\n0,1,10,0.5\n")
    assert all("nothing varies" not in c.statistic for c in data_gate.findings([table], 4.0))
    still = read_table("beta [deg],U [m/s],rps [rps],X [N]\n0,1,6,-2\n0,1,6,-2\n0,1,6,-2.1\n")
    assert any("nothing varies" in c.statistic for c in data_gate.findings([still], 4.0))
