"""The acceptance figures of the TJ-FlyingFish."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.core.provenance import works
from coeflab.motion.trim.operating_point import Outcome
from coeflab.published.flyingfish.model import calibrated, read_flyingfish
from coeflab.published.flyingfish.trims import trim
from coeflab.report.acceptance import Acceptance, ComparedTable
from coeflab.report.as_json import studies as as_json


@pytest.fixture(scope="module")
def made(publication: Callable[[str], Acceptance]) -> Acceptance:
    return publication("flyingfish")


def table(made: Acceptance, key: str) -> ComparedTable:
    return next(t for t in made.tables if t.key == key)


def furthest(made: Acceptance, key: str, unit: str) -> float:
    return max(abs(r.difference or 0.0) for r in table(made, key).rows if r.unit == unit)


@pytest.mark.slow
def test_every_table_holds_and_says_what_is_calibrated(made: Acceptance) -> None:
    assert made.holds
    assert {t.key: len(t.rows) for t in made.tables} == {
        "constants": 5, "residuals": 60, "predicted": 36, "nearest": 80, "families": 6, "cold": 18, "corrected": 8,
        "laws": 28, "marched": 21, "air": 6, "equations_water": 4, "equations_air": 5, "hovering": 6, "both_readings": 90,
        "third": 2, "tracks": 10, "surface": 6, "bench": 4,
    }  # fmt: skip
    assert all(r.found is not None for t in made.tables for r in t.rows)
    assert {r.basis for r in table(made, "nearest").rows} == {"calibration"}
    assert any("calibrated" in s for s in made.statements)
    assert len(made.errata) == 7
    assert set(made.citations) <= set(works())


@pytest.mark.slow
def test_residuals_at_the_printed_rows(made: Acceptance) -> None:
    assert 1e-4 < furthest(made, "residuals", "N") < 5e-4
    assert 1e-5 < furthest(made, "residuals", "N m") < 1.5e-4


@pytest.mark.slow
def test_constants_that_the_table_implies(made: Acceptance) -> None:
    found = {r.quantity: r.found for r in table(made, "constants").rows}
    assert found["net weight"] == pytest.approx(-1.6661, abs=5e-5)
    assert found["mass"] == pytest.approx(2.2297, abs=5e-5)
    assert found["buoyancy moment"] == pytest.approx(-0.3949, abs=5e-5)
    assert found["arm length"] == pytest.approx(0.22649, abs=5e-6)
    assert found["rotor height"] == pytest.approx(-0.01520, abs=5e-6)


@pytest.mark.slow
def test_four_rows_predict_the_other_six(made: Acceptance) -> None:
    assert furthest(made, "predicted", "N") == pytest.approx(3.5e-4, abs=5e-6)
    assert furthest(made, "predicted", "N m") == pytest.approx(6.1e-4, abs=5e-6)


@pytest.mark.slow
def test_trims_nearest_to_the_rows_and_from_cold_starts(made: Acceptance) -> None:
    assert furthest(made, "nearest", "deg") < 0.01
    assert furthest(made, "nearest", "rpm") < 0.1
    assert furthest(made, "cold", "deg") < 0.005
    assert furthest(made, "cold", "rpm") < 0.071
    assert all("One solution" in s for s in table(made, "cold").statements[:3])


@pytest.mark.slow
def test_the_corrected_yaw_equation(made: Acceptance) -> None:
    found = [r.found for r in table(made, "corrected").rows]
    assert found[:4] == pytest.approx([79.869, -75.109, 0.051, 0.146], abs=1.5e-3)
    assert found[4:] == pytest.approx([2075.18, 2082.07, 624.00, 250.51], abs=0.01)


def test_saturated_rotors_are_named_with_the_surge_equation() -> None:
    fish = read_flyingfish()
    constants = calibrated(fish.rotors, fish.motion, fish.angles, fish.speeds)
    got = trim(fish, constants, 0, starts=4, fastest=1500.0)
    assert got.outcome is Outcome.INFEASIBLE
    assert got.violated[0].name == "surge force X, equation 51"
    assert {u.name for u, _ in got.saturated} == {"omega1", "omega2"}
    both = 2.0 * (2.5604e-7 * 1500.0**2 + 6.0355e-4 * 1500.0)
    assert got.residuals["surge force X, equation 51"] == pytest.approx(both - 4.60545, abs=5e-3)


def test_least_effort_needs_no_more_than_the_printed_trim() -> None:
    fish = read_flyingfish()
    constants = calibrated(fish.rotors, fish.motion, fish.angles, fish.speeds)
    got = trim(fish, constants, 9, starts=3)
    assert got.outcome is Outcome.FAMILY
    assert got.dimension == 2
    assert np.sum(got.found.point[4:] ** 2) < np.sum(fish.speeds[9] ** 2)


@pytest.mark.slow
def test_drawings_hold_the_printed_and_the_found_numbers(made: Acceptance) -> None:
    drawn = dict(made.figures)
    assert list(drawn) == [
        "flyingfish_operating_points", "flyingfish_thrust_over_tilt", "flyingfish_tilt", "flyingfish_rotors",
        "flyingfish_bench_water", "flyingfish_bench_air", "flyingfish_damping", "flyingfish_damping_air", "flyingfish_level",
        "flyingfish_oblique", "flyingfish_curves", "flyingfish_surface",
    ]  # fmt: skip
    tilt, apart, speed, slower = drawn["flyingfish_operating_points"].panels
    by_name = {s.name: s.y for panel in (tilt, speed) for s in panel.series}
    assert tilt.series[0].y[:2] == (79.72, 77.58)
    assert by_name["rotor 4, printed"][0] == 250.03
    assert max(abs(y) for s in apart.series for y in s.y) <= 0.01
    assert max(abs(y) for s in slower.series for y in s.y) <= 0.1


@pytest.mark.slow
def test_drawn_laws_are_the_printed_ones(made: Acceptance) -> None:
    """Equations 47 and 48 at 2000 rpm; equation 50 for surge near 0.5 m/s: 0.0998 u + 18.2222 u^2."""
    drawn = dict(made.figures)
    thrust, torque = drawn["flyingfish_rotors"].panels
    assert np.interp(2000.0, thrust.series[0].x, thrust.series[0].y) == pytest.approx(1.2071 + 1.02416, rel=1e-3)
    assert np.interp(2000.0, torque.series[0].x, torque.series[0].y) == pytest.approx(0.0208566, rel=2e-3)
    surge = drawn["flyingfish_damping"].panels[0].series[0]
    near = int(np.argmin(np.abs(np.array(surge.x) - 0.5)))
    speed = surge.x[near]
    assert speed == pytest.approx(0.5, abs=0.05)
    assert surge.y[near] == pytest.approx(-(0.0998 * speed + 18.2222 * speed**2), rel=1e-4)
    one = drawn["flyingfish_thrust_over_tilt"].panels[0].series[0]
    assert (one.x[0], one.notes[0]) == (79.72, "motion 1")
    assert one.y[0] == pytest.approx(6.0355e-4 * 2056.42 + 2.5604e-7 * 2056.42**2, rel=1e-5)


@pytest.mark.slow
def test_both_readings_of_the_yaw_equation_and_of_motion_3(made: Acceptance) -> None:
    """The printed rows leave twice the lever term where the sign is corrected: 0.015 N m in motion 1, 0.096 N m at most."""
    left = [r.found for r in table(made, "both_readings").rows if r.quantity.startswith("N left")]
    assert left[0] == pytest.approx(0.0146, abs=5e-5)
    assert max(abs(x or 0.0) for x in left) > 0.09
    assert furthest(made, "third", "m/s") < 1e-5
    assert "leaves -2.29 N along x and 3.09 N along z" in table(made, "third").statements[1]


@pytest.mark.slow
def test_drawn_tracks_are_those_of_constant_velocities(made: Acceptance) -> None:
    """Motion 9 comes back to its start after 72 s on a circle of 5.73 m; motion 10 sinks by 2.16 m in two turns; motion 8 sinks."""
    drawn = dict(made.figures)
    above, down = drawn["flyingfish_curves"].panels
    circle = above.series[0]
    assert max(circle.x) == pytest.approx(2.0 * 0.5 / np.radians(5.0), rel=1e-3)
    assert (circle.x[-1], circle.y[-1]) == pytest.approx((0.0, 0.0), abs=1e-3)
    assert down.series[1].y[-1] == pytest.approx(2.16, abs=1e-3)
    depths = {s.name: s.y[-1] for s in drawn["flyingfish_oblique"].panels[0].series}
    assert depths["motion 4"] == pytest.approx(-20.0 * 0.5 * np.sin(np.radians(5.0)), rel=1e-4)
    assert depths["motion 5"] == pytest.approx(10.0, rel=1e-4)
    level = {s.name: s.y for s in drawn["flyingfish_level"].panels[0].series}
    assert set(level["motion 1"]) | set(level["motion 3"]) == {0.0}


@pytest.mark.slow
def test_figures_that_are_not_made_are_named_with_a_reason(made: Acceptance) -> None:
    said = " ".join(made.statements)
    for number in ("1 (structure)", "2 (tilting mechanism)", "4 (bench)", "6 and 7"):
        assert number in said


@pytest.mark.slow
def test_json_of_every_table(made: Acceptance, capsys: pytest.CaptureFixture[str]) -> None:
    show.json_object(as_json.acceptance(made))
    assert json.loads(capsys.readouterr().out)["passed"] is True
