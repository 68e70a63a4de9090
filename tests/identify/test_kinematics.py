"""Positions, heading and velocities of one motion hold together; what a record without names says once its columns are named."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.identify.identify import _shared
from coeflab.identify.kinematics import by_positions, contradicted, drift, readings
from coeflab.identify.series import read_series
from coeflab.motion.vehicle import vehicle
from tests.motion.vehicles import made

BODY = vehicle(made(), free=("u", "v", "r"))
T = np.arange(0.0, 60.0, 0.1)
R = 0.15 * np.cos(0.2 * T)
PSI = 0.3 + 0.75 * np.sin(0.2 * T)  # its derivative is R
U, V = 1.4 + 0.05 * np.sin(0.4 * T), -0.2 * np.cos(0.2 * T)
CURRENT = (0.3, -0.2)


def path() -> dict[str, np.ndarray]:
    """The record by itself: the path by fine integration, not by the module's own."""
    fine = np.linspace(0.0, T[-1], 40 * (len(T) - 1) + 1)
    psi = 0.3 + 0.75 * np.sin(0.2 * fine)
    u, v = 1.4 + 0.05 * np.sin(0.4 * fine), -0.2 * np.cos(0.2 * fine)
    rates = (np.cos(psi) * u - np.sin(psi) * v + CURRENT[0], np.sin(psi) * u + np.cos(psi) * v + CURRENT[1])
    step = fine[1]
    x, y = (np.concatenate([[0.0], np.cumsum((a[1:] + a[:-1]) * step / 2.0)])[::40] for a in rates)
    return {"t": T, "x": x, "y": y, "psi": PSI, "u": U, "v": V, "r": R}


def test_velocities_along_the_body_agree_in_a_current_with_noise_and_a_heading_that_wraps() -> None:
    c = path()
    noise = np.random.default_rng(1).normal(size=(2, len(T)))
    c |= {"x": c["x"] + 0.05 * noise[0], "y": c["y"] + 0.05 * noise[1], "psi": np.mod(c["psi"], 2.0 * np.pi)}
    assert not contradicted(c, "run.csv")
    assert readings(c)[0].misfit < 0.1


def test_a_current_between_positions_and_velocities_is_named() -> None:
    (found,) = drift(path(), "run.csv")
    assert (found.code, found.severity) == ("record.current", Severity.NOTE)
    assert (found["north"], found["east"]) == pytest.approx(CURRENT, abs=0.002)
    still = path()
    still |= {"x": still["x"] - CURRENT[0] * T, "y": still["y"] - CURRENT[1] * T}
    assert not drift(still, "run.csv")
    noise = np.random.default_rng(2).normal(size=(2, len(T)))
    assert not drift(still | {"x": still["x"] + noise[0], "y": still["y"] + noise[1]}, "run.csv")


def earth(c: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    cos, sin = np.cos(c["psi"]), np.sin(c["psi"])
    return c | {"u": cos * c["u"] - sin * c["v"], "v": sin * c["u"] + cos * c["v"]}


@pytest.mark.parametrize(
    ("change", "reading"),
    [
        (earth, "earth"),
        (lambda c: {k: v for k, v in earth(c).items() if k not in "xy"}, "course"),
        (lambda c: c | {"psi": -c["psi"], "r": -c["r"]}, "turned"),
        (lambda c: c | {"v": -c["v"]}, "port"),
        (lambda c: c | {"x": c["y"], "y": c["x"]}, "north"),
        (lambda c: c | {"r": np.degrees(c["r"])}, "known"),
        (lambda c: c | {"r": -c["r"]}, "known"),
    ],
)
def test_another_reading_that_explains_the_path_is_a_failure(change, reading: str) -> None:  # type: ignore[no-untyped-def]
    c = path()
    if reading == "course":  # a turn by more than a radian
        c |= {"psi": 3.0 * c["psi"], "r": 3.0 * c["r"]}
    (found,) = contradicted(change(c), "run.csv")
    assert (found.severity, found["reading"]) == (Severity.FAIL, reading)


def test_what_no_reading_explains_warns_and_a_straight_run_says_nothing() -> None:
    c = path()
    (found,) = contradicted(c | {"x": 3.0 * c["x"]}, "run.csv")
    assert (found.severity, found["reading"]) == (Severity.WARN, "none")
    still = {"psi": 0.0 * T, "r": 0.0 * T, "x": 1.4 * T, "y": 0.0 * T, "u": np.full(len(T), 1.4), "v": 0.0 * T, "t": T}
    assert not contradicted(still, "run.csv")


def test_velocities_follow_of_positions_and_heading() -> None:
    c = path()
    del c["u"], c["v"], c["r"]
    found = by_positions(c)
    cos, sin = np.cos(PSI)[1:-1], np.sin(PSI)[1:-1]
    np.testing.assert_allclose(found["u"], U[1:-1] + cos * CURRENT[0] + sin * CURRENT[1], atol=2e-4)
    np.testing.assert_allclose(found["v"], V[1:-1] - sin * CURRENT[0] + cos * CURRENT[1], atol=2e-4)
    np.testing.assert_allclose(found["r"], R[1:-1], atol=2e-5)


def text(folder: Path, c: dict[str, np.ndarray], separator: str, head: str = "") -> Path:
    file = folder / "run.txt"
    rows = "\n".join(separator.join(f"{x:.9g}" for x in row) for row in zip(*c.values(), strict=True))
    file.write_text(f"{head}\n{rows}\n".removeprefix("\n"))
    return file


@pytest.mark.parametrize("separator", [" ", "\t", ";", ","])
def test_columns_of_a_file_without_names_are_named(tmp_path: Path, separator: str) -> None:
    c = path() | {"psi": -np.degrees(PSI)}
    file = text(tmp_path, {k: c[k] for k in ("t", "x", "y", "psi", "u")}, separator)
    found = read_series(file, BODY, "t [s], x [m], y [m], -psi [deg], -")
    np.testing.assert_allclose(found.velocity[:, 5], R[1:-1], atol=1e-4)
    assert [f.code for f in found.findings] == ["record.derived"]
    assert found.findings[0]["columns"] == ("u", "v", "r")
    with pytest.raises(InputError, match="4 names for 5 columns"):
        read_series(file, BODY, "t [s], x [m], y [m], psi [deg]")
    with pytest.raises(InputError, match="sideways"):
        read_series(file, BODY, "t [s], y [m], x [m], psi [deg], -")
    with pytest.raises(InputError, match="miss"):
        read_series(file, BODY, "t [s], x [m], y [m], psi [deg], u [m/s]")


def test_easting_northing_and_heading_are_positions(tmp_path: Path) -> None:
    c = path()
    named = {"t [s]": c["t"], "easting [m]": c["y"], "northing [m]": c["x"], "heading [rad]": c["psi"]}
    found = read_series(text(tmp_path, named, ",", ",".join(named)), BODY)
    np.testing.assert_allclose(found.velocity[:, 5], R[1:-1], atol=1e-4)


def test_a_bad_cell_of_a_file_without_names_has_its_line(tmp_path: Path) -> None:
    file = text(tmp_path, {k: path()[k] for k in ("t", "u")}, ",")
    rows = file.read_text().split("\n")
    rows[20] = rows[20].partition(",")[0] + ",nan"
    file.write_text("\n".join(rows))
    with pytest.raises(InputError, match=r"line 21.*nan"):
        read_series(file, BODY, "t [s], u [m/s]")


def test_what_would_give_intervals_is_what_the_file_can_have() -> None:
    """Rows of u, v, r that follow of positions are filtered by that: no unfiltered ones can be given."""
    derived = Finding.of("record.derived", "log.csv", Severity.NOTE, columns=("u", "r"), places=("x", "y", "psi"))
    (of_places,), (recorded,) = (_shared(("u", "v"), [SimpleNamespace(findings=found)]) for found in ((derived,), ()))
    assert of_places.endswith(
        "u follow of x, y and psi, so there are no unfiltered rows of them: give recorded ones, of a speed log or a rate gyro."
    )
    assert recorded.endswith("Use unfiltered rows, or thin them.")
    assert _shared((), [SimpleNamespace(findings=(derived,))]) == ()
