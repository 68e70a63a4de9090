"""A trajectory is no table of forces: its x and y move at the speed of its u and v."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.time_record import clock, record_over_time

T = np.arange(0.0, 8.0, 0.5)
R = 0.2
PATH = {
    "t": T,
    "X": 1.4 / R * np.sin(R * T),
    "Y": 1.4 / R * (1.0 - np.cos(R * T)),
    "u": np.full(len(T), 1.4),
    "v": 0.0 * T,
}


def raw(columns: dict[str, np.ndarray]) -> RawTable:
    return RawTable(
        Path("run.csv"), tuple(RawColumn(n, "", v) for n, v in columns.items()), tuple(range(2, len(T) + 2))
    )


@pytest.mark.parametrize("names", ["t X Y u v", "time x y u v", "t X Y u"])
def test_positions_are_no_forces(names: str) -> None:
    made = {n: PATH[{"time": "t", "x": "X", "y": "Y"}.get(n, n)] for n in names.split()}
    (why,) = record_over_time(raw(made))
    assert "a record over time" in why.found
    assert "identify" in why.advice


def test_positions_that_move_where_the_heading_points_are_no_forces() -> None:
    psi = {"psi": np.degrees(R * T)}
    moved = {n: PATH[n] for n in ("t", "X", "Y")}
    assert [why.column for why in record_over_time(raw(moved | psi))] == ["X"]
    swept = {
        "t": T,
        "X": -3.0 - 0.01 * (4.0 * T - 16.0) ** 2,
        "Y": 4.0 * T - 16.0,
    }  # a sweep of 16 angles, one after the other
    assert not list(record_over_time(raw(swept | {"psi": 4.0 * T - 16.0})))


@pytest.mark.parametrize("names", [("t", "psi"), ("Zeit (s)", "Kurs"), ("column 1", "column 2")])
def test_a_clock_without_a_force_is_a_record(names: tuple[str, str]) -> None:
    time, many = names[0], np.arange(60.0)
    columns = tuple(RawColumn(n, "", v) for n, v in zip(names, (many, np.sin(many)), strict=True))
    table = RawTable(Path("run.txt"), columns, tuple(range(2, 62)))
    assert f"{time} rises from 0 to 59" in clock(table)
    back = RawTable(Path("run.txt"), (RawColumn(names[0], "", many[::-1]), columns[1]), tuple(range(2, 62)))
    assert not clock(back)


def test_forces_over_time_stay_forces() -> None:
    """Forces of a slow test beside a clock do not move at its speed; nor does what has no clock."""
    assert not list(record_over_time(raw(PATH | {"X": np.full(len(T), -9.0), "Y": 12.0 + 0.1 * np.sin(T)})))
    assert not list(record_over_time(raw({n: v for n, v in PATH.items() if n != "t"})))
    assert not list(record_over_time(raw(PATH | {"t": T[::-1]})))


@pytest.mark.parametrize(
    ("path", "rate", "per"), [("y", "v", 1.0), ("z [mm]", "w [mm/s]", 1.0), ("psi [deg]", "r [rad/s]", np.pi / 180)]
)
def test_an_oscillation_is_no_sweep_of_steady_runs(path: str, rate: str, per: float) -> None:
    """Its forces hold the added mass; as a sweep of 400 rows it gave slopes."""
    t = np.arange(0.0, 20.0, 0.05)
    made = {
        "time [s]": t,
        path: 0.2 * np.sin(1.3 * t),
        rate: 0.26 * per * np.cos(1.3 * t),
        "Fy": -50.0 * np.cos(1.3 * t),
    }
    (why,) = record_over_time(raw(made))
    assert "record over time" in str(why)
    steady = made | {rate: np.resize([0.1, 0.2, 0.3], t.size)}
    assert not list(record_over_time(raw(steady)))
