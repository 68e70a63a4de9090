"""Time series as CSV: units, gaps in what is given, and one clear error for what cannot be read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.identify.series import FEWEST, read_series
from coeflab.motion.simulation import simulate
from coeflab.motion.vehicle import vehicle
from coeflab.report.tables.motion import motion_csv
from coeflab.vehicle.own_numbers import typed_file
from tests.motion.vehicles import made

BODY = vehicle(made(), free=("u",))


def lines(n: int = 60) -> list[list[str]]:
    return [[f"{0.1 * k:g}", "1.5", f"{0.01 * k:g}", "0.02"] for k in range(n)]


def written(folder: Path, header: str, rows: list[list[str]]) -> Path:
    path = folder / "motion.csv"
    path.write_text("\n".join([header, *(",".join(r) for r in rows)]) + "\n")
    return path


HEADER = "t [s],u [m/s],v [m/s],dr [rad]"


def test_units_are_turned_to_si_and_other_columns_are_passed_over(tmp_path: Path) -> None:
    rows = [[*r, "12", "x"] for r in lines()]
    s = read_series(written(tmp_path, "t [min],u [kn],r [deg/s],delta_r [deg],thrust [kN],note", rows), BODY)
    assert s.time[1] == pytest.approx(6.0)
    assert s.velocity[0, 0] == pytest.approx(1.5 * 1852.0 / 3600.0)
    assert s.velocity[5, 5] == pytest.approx(np.radians(0.05))
    assert s.controls[0, 0] == pytest.approx(np.radians(0.02))
    assert s.wrench[0] == pytest.approx([12000.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert s.moving == {"u", "r", "dr"}


def test_what_simulate_writes_is_read_back(tmp_path: Path) -> None:
    t = simulate(made(), "zigzag", {"executes": 2}, free=("u", "v", "r")).trajectory
    (tmp_path / "zigzag.csv").write_bytes(motion_csv(t))
    s = read_series(tmp_path / "zigzag.csv", BODY)
    assert np.array_equal(s.time, t.time)
    assert np.array_equal(s.velocity, t.velocity)
    assert np.array_equal(s.controls[:, 0], t.controls["dr"])
    assert np.array_equal(s.wrench[:, 0], t.controls["thrust"])


def test_a_thruster_with_a_lag_is_recorded_as_it_turns_and_that_is_noted(tmp_path: Path) -> None:
    """As ``simulate`` writes it; without a lag there is nothing to say."""
    for lag, codes in (("", []), ("; lag = 2 s", ["record.lag"])):
        body = typed_file(
            "auv", ["Xuu=-10 N/(m/s)^2", "Xudot=-5 kg"], length="2 m", length_name="LOA", speed="2 m/s", density="1000", about="cg",
            mass="50", thrusters=["main; bollard = 60 N; rate = 720" + lag],
        )  # fmt: skip
        rows = [[f"{0.1 * k:g}", "1.5", "0" if k < 30 else "720"] for k in range(60)]
        s = read_series(written(tmp_path, "t [s],u [m/s],main [rpm]", rows), vehicle(body, free=("u",)))
        assert s.wrench[29:31, 0] == pytest.approx([0.0, 60.0])
        assert [f.code for f in s.findings] == codes


@pytest.mark.parametrize(
    ("row", "cell", "text", "words"),
    [
        (7, 2, "nan", ("line 9", "v [m/s]", '"nan"')),
        (7, 2, "", ("line 9", "v [m/s]", "blank")),
        (7, 1, "1,5", ("line 9",)),
        (7, 1, "fast", ("line 9", "u [m/s]", '"fast"')),
        (7, 0, "0.6", ("line 9", "t [s]", "twice the time")),
        (7, 0, "0.1", ("line 9", "t [s]", "before the last")),
        (7, 3, "inf", ("line 9", "dr [rad]")),
    ],
)
def test_a_bad_cell_is_named(tmp_path: Path, row: int, cell: int, text: str, words: tuple[str, ...]) -> None:
    rows = lines()
    rows[row][cell] = text
    with pytest.raises(InputError) as why:
        read_series(written(tmp_path, HEADER, rows), BODY)
    assert all(w in str(why.value) for w in ("motion.csv", *words))


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("t,u [m/s],v [m/s],dr [rad]", ("without unit", "t [s]")),
        ("t [s],u [m],v [m/s],dr [rad]", ("u [m]", "speed")),
        ("t [s],u [m/s],v [m/s],dr [m]", ("dr [m]", "angle")),
        ("time [s],t [s],v [m/s],dr [rad]", ("beside another t",)),
        ("t [s],V [m/s],v [m/s],dr [rad]", ("no column u",)),
        ("x [s],u [m/s],v [m/s],dr [rad]", ("no column t",)),
    ],
)
def test_a_bad_header_is_named(tmp_path: Path, header: str, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as why:
        read_series(written(tmp_path, header, lines()), BODY)
    assert all(w in str(why.value) for w in ("motion.csv, line 1", *words))


def test_too_short(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"{FEWEST - 1} rows"):
        read_series(written(tmp_path, HEADER, lines(FEWEST - 1)), BODY)


NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=30)
@given(data=st.data())
def test_any_finite_numbers_come_back(tmp_path: Path, data: st.DataObject) -> None:
    steps = data.draw(st.lists(st.floats(1e-3, 10.0), min_size=FEWEST, max_size=FEWEST + 10))
    time = np.cumsum(steps)
    values = [[data.draw(NUMBERS) for _ in range(2)] for _ in time]
    rows = [[repr(float(t)), repr(a), repr(b)] for t, (a, b) in zip(time, values, strict=True)]
    s = read_series(written(tmp_path, "t [s],u [m/s],r [rad/s]", rows), BODY)
    assert np.array_equal(s.time, time)
    assert np.array_equal(s.velocity[:, [0, 5]], np.array(values))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60)
@given(text=st.text(max_size=300))
def test_any_text_is_read_or_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "any.csv"
    path.write_text(text, encoding="utf-8", errors="surrogatepass" if text.isascii() else "replace")
    try:
        found = read_series(path, BODY).file
    except InputError as why:
        found = str(why)
    assert "any.csv" in found
