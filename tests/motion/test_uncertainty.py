"""Uncertainty through a manoeuvre: analytic where the figure is linear, the same numbers wherever and however it runs."""

from __future__ import annotations

import json
import logging
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError, OutputError
from coeflab.motion.uncertainty.uncertainty import Carried, Question, uncertainty
from coeflab.report.tables.uncertainty import members_csv, ranking
from tests.formats.massed import VALUES, with_mass
from tests.motion.uncertain import uncertain_torpedo, with_uncertainty
from tests.motion.vehicles import STABLE, made
from tests.vehicle.test_force_law import parameters

HELD = ("u", "w", "p", "q")
SHORT = Question("zigzag", {"executes": 2, "longest": 60.0}, members=60, hold=HELD, kernel="compiled")
BATCH = 20
LINEAR = {"X0": -2e-4, "Yv": -4e-2, "Yr": 1.2e-2, "Nv": -2e-3, "Nr": -1e-2, "Ydr": 1e-2, "Ndr": -5e-3}
U95 = {"Ydr'": 2e-3, "Ndr'": 6e-4}
CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, protocol="tcp", host="127.0.0.1", dashboard_address=":0"
    ) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def small_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.motion.uncertainty.uncertainty.BATCH", BATCH)


def numbers(carried: Carried) -> tuple[object, ...]:
    return members_csv(carried), carried.spreads, carried.importances, ranking(carried), carried.statements


def small_turn(u95: dict[str, float], correlation: dict[tuple[str, str], float], **asked: object) -> Carried:
    """Steady turns at a rudder of 0.01 deg with the speed held, which are linear in the coefficients of the rudder."""
    file = with_uncertainty(with_mass(parameters(LINEAR), np.zeros(3)), u95, correlation)
    options = {"rudder": "0.01 deg", "longest": 60.0}
    return uncertainty(file, Question("turning_circle", options, hold=HELD, **asked))  # type: ignore[arg-type]


def steady_rate(carried: Carried) -> tuple[np.ndarray, float, np.ndarray]:
    """Values of the steady yaw rate by the linear equations: members, that of the file, gradient."""
    at = parameters(LINEAR)
    speed, density = at.conditions.speed, at.conditions.density
    mass = with_mass(at, np.zeros(3)).mass
    m = mass.mass_prime
    length = at.scaling.length
    matrix = np.array([[LINEAR["Yv"], LINEAR["Yr"] - m], [LINEAR["Nv"], LINEAR["Nr"]]])
    angle = np.radians(0.01)
    sign = -1.0  # a negative rudder turns to starboard, since Ndr is negative
    inverse = np.linalg.inv(matrix)
    unit = -inverse[1] * sign * angle * speed / length  # yaw rate of unit Ydr', Ndr'
    assert density > 0.0
    columns = [carried.varied.symbols.index(s) for s in ("Ydr'", "Ndr'") if s in carried.varied.symbols]
    base = np.array([LINEAR["Ydr"], LINEAR["Ndr"]])
    return (base + carried.deviations[:, columns]) @ unit, float(base @ unit), unit


@pytest.mark.slow
def test_a_linear_figure_has_the_analytic_interval() -> None:
    carried = small_turn(U95, {("Ydr'", "Ndr'"): 0.5}, members=200)
    members, nominal, unit = steady_rate(carried)
    k = carried.names.index("steady yaw rate")
    np.testing.assert_allclose(carried.values[:, k], members, rtol=1e-4)
    found = carried.spreads[k]
    assert found.figure.value == pytest.approx(nominal, rel=1e-4)
    cells = np.diag([U95["Ydr'"], U95["Ndr'"]]) / 2.0
    u95 = 2.0 * float(np.sqrt(unit @ cells @ np.array([[1.0, 0.5], [0.5, 1.0]]) @ cells @ unit))
    assert found.low == pytest.approx(nominal - u95, abs=3.0 * found.low_error)
    assert found.high == pytest.approx(nominal + u95, abs=3.0 * found.high_error)
    assert found.low_error < 0.2 * u95


@pytest.mark.slow
def test_sobol_indices_of_a_linear_figure_are_its_parts() -> None:
    carried = small_turn(U95, {}, members=128, sobol=True)
    _, _, unit = steady_rate(carried)
    parts = (unit * [U95["Ydr'"], U95["Ndr'"]]) ** 2
    wanted = dict(zip(("Ydr'", "Ndr'"), parts / parts.sum(), strict=True))
    found = carried.importances[carried.names.index("steady yaw rate")]
    assert carried.runs == 128 + 128 * 4
    for share in found.shares:
        (symbol,) = share.symbols
        assert share.first == pytest.approx(wanted[symbol], abs=0.04)
        assert share.total == pytest.approx(wanted[symbol], abs=0.04)
        assert dict(found.known)[symbol] == pytest.approx(wanted[symbol], abs=0.15)


@pytest.mark.slow
def test_correlated_coefficients_are_one_group() -> None:
    carried = small_turn(U95, {("Ydr'", "Ndr'"): 0.5}, members=64, sobol=True)
    (share,) = carried.importances[carried.names.index("steady yaw rate")].shares
    assert set(share.symbols) == {"Ydr'", "Ndr'"}
    assert share.first == pytest.approx(1.0, abs=0.05)
    assert share.total == pytest.approx(1.0, abs=0.05)


def test_indices_of_stability_are_those_of_the_draws() -> None:
    carried = uncertainty(uncertain_torpedo(), SHORT)
    named = {s.figure.name: s for s in carried.spreads}
    deviations = dict(zip(carried.varied.symbols, carried.deviations.T, strict=True))
    file = uncertain_torpedo()
    yv, nv, yr, nr = (VALUES[s] + deviations.get(f"{s}'", 0.0) for s in ("Yv", "Nv", "Yr", "Nr"))
    index = 1.0 - nv * (yr - file.mass.mass_prime) / (yv * (nr - file.mass.mass_moment_prime))
    assert named["G_h"].median == pytest.approx(float(np.median(index)))
    assert named["G_v"].why == "a coefficient in it has no U95"


@pytest.mark.slow
def test_seed_and_numbers() -> None:
    first, again = (uncertainty(uncertain_torpedo(), SHORT) for _ in range(2))
    assert numbers(first) == numbers(again)
    assert not any("ended early" in s for s in first.statements)
    plain = uncertainty(uncertain_torpedo(), replace(SHORT, kernel="numpy"))
    np.testing.assert_allclose(plain.values, first.values, rtol=1e-9)
    other = uncertainty(uncertain_torpedo(), Question("zigzag", SHORT.options, 60, seed=2, hold=HELD))
    assert members_csv(other) != members_csv(first)


@pytest.mark.slow
def test_batches_and_processes_do_not_move_a_number(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = uncertain_torpedo()
    alone = uncertainty(file, SHORT)
    monkeypatch.setattr("coeflab.motion.uncertainty.uncertainty.BATCH", 60)
    assert numbers(uncertainty(file, SHORT)) == numbers(alone)
    monkeypatch.setattr("coeflab.motion.uncertainty.uncertainty.BATCH", 20)
    assert numbers(uncertainty(file, SHORT, workers=2)) == numbers(alone)
    assert numbers(uncertainty(file, SHORT, workers=2, store=tmp_path)) == numbers(alone)
    assert numbers(uncertainty(file, SHORT, store=tmp_path)) == numbers(alone)


@pytest.fixture
def scheduler() -> Iterator[str]:
    """Address of a Dask scheduler of our own, with one worker."""
    command = [sys.executable, "-c", CLUSTER]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield process.stdout.readline().strip()
        process.communicate("")


@pytest.mark.slow
def test_dask_gives_the_same_numbers(scheduler: str) -> None:
    file = uncertain_torpedo()
    assert numbers(uncertainty(file, SHORT, scheduler=scheduler)) == numbers(uncertainty(file, SHORT))


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.core.machine.PATIENCE", 1.0)
    with pytest.raises(InputError, match="no Dask scheduler"):
        uncertainty(uncertain_torpedo(), SHORT, scheduler="tcp://127.0.0.1:9")


@pytest.mark.slow
def test_a_damaged_or_foreign_batch_is_run_again(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    file = uncertain_torpedo()
    whole = uncertainty(file, SHORT, store=tmp_path)
    first, second, _ = sorted(tmp_path.rglob("batch_*.json"))
    untouched, content = first.read_bytes(), second.read_bytes()
    for spoilt, word in (
        (content[:-40], "damaged"),
        (content.replace(b"0.", b"1.", 1), "damaged"),
        (b"", "damaged"),
        (b"\xff\xfe\n\n", "damaged"),
        (untouched, "another run"),
    ):
        second.write_bytes(spoilt)
        stamp = first.stat().st_mtime_ns
        caplog.clear()
        with caplog.at_level(logging.INFO, "coeflab.uncertainty"):
            assert numbers(uncertainty(file, SHORT, store=tmp_path)) == numbers(whole)
        assert f"{second.name}: it " in caplog.text
        assert word in caplog.text
        assert "2 of 3 batches were found" in caplog.text
        assert second.read_bytes() == content
        assert first.stat().st_mtime_ns == stamp


@pytest.mark.slow
def test_other_inputs_are_another_run(tmp_path: Path) -> None:
    uncertainty(uncertain_torpedo(), SHORT, store=tmp_path)
    for changed in ({"seed": 2}, {"members": 61}, {"options": {"executes": 3, "longest": 60.0}}):
        asked = {"manoeuvre": "zigzag", "options": SHORT.options, "members": 60, "hold": HELD, **changed}
        uncertainty(uncertain_torpedo(), Question(**asked), store=tmp_path)  # type: ignore[arg-type]
    assert len(list(tmp_path.iterdir())) == 4


def test_members_that_cannot_start_are_counted() -> None:
    """With a resistance of 0 +- itself half of the draws have none, and no thrust holds their speed."""
    file = uncertain_torpedo({"X0'": 20.0}, {})
    carried = uncertainty(file, Question("zigzag", {"executes": 2}, members=100, hold=("w", "p", "q"), kernel="numpy"))
    assert {s.status for s in carried.spreads} == {"no interval"}
    (line,) = [s for s in carried.statements if "ended early" in s]
    assert "no start" in line
    assert not any(i.known for i in carried.importances)


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"members": 0}, "0 members"),
        ({"members": -5}, "-5 members"),
        ({"seed": -1}, "seed"),
        ({"manoeuvre": "loop"}, "loop"),
        ({"options": {"ruder": 1.0}}, "ruder"),
        ({"kernel": "fast"}, "fast"),
    ],
)
def test_wrong_questions(asked: dict[str, object], word: str) -> None:
    whole = {"manoeuvre": "zigzag", "options": {}, "members": 100, **asked}
    with pytest.raises(Exception, match=word) as caught:
        uncertainty(uncertain_torpedo(), Question(**whole))  # type: ignore[arg-type]
    assert caught.type.__module__ == "coeflab.core.errors"


def test_a_store_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(OutputError, match="cannot write"):
        uncertainty(uncertain_torpedo(), SHORT, store=tmp_path / "file")


def test_what_is_kept_is_readable(tmp_path: Path) -> None:
    uncertainty(uncertain_torpedo(), SHORT, store=tmp_path)
    text = next(tmp_path.rglob("batch_00000.json")).read_text().splitlines()[1]
    assert set(json.loads(text)) == {"key", "batch", "values", "statuses", "ended"}


def test_the_interval_of_g_h_is_that_of_the_report() -> None:
    """Against the Latin hypercube of `coeflab.vehicle.stability.stability`, within the error of both."""
    from coeflab.vehicle.stability import stability

    file = uncertain_torpedo()
    found = next(s for s in uncertainty(file, replace(SHORT, members=100)).spreads if s.figure.name == "G_h")
    (report,) = [d for d in stability(file) if d.name == "G_h"]
    assert found.figure.value == pytest.approx(report.value)
    assert found.low == pytest.approx(report.result.low, abs=4.0 * (found.low_error or 0.0))
    assert found.high == pytest.approx(report.result.high, abs=4.0 * (found.high_error or 0.0))


@pytest.mark.slow
def test_a_motion_that_fixed_steps_do_not_stand_is_said() -> None:
    """Damping by r|r| does not show at the start, which chooses the step; in the turn its rate is 2000 1/s."""
    asked = Question("turning_circle", {"longest": 20.0}, members=40, hold=("w", "p", "q"))
    stiff = with_uncertainty(made({**STABLE, "Nr|r|": -1e3}), {"Ndr'": 5e-4}, {})
    (said,) = (s for s in uncertainty(stiff, asked).statements if "fixed steps" in s)
    assert "are too long for this motion" in said
    sound = with_uncertainty(made(), {"Ndr'": 5e-4}, {})
    for manoeuvre in ("turning_circle", "pull_out"):
        found = uncertainty(sound, replace(asked, manoeuvre=manoeuvre, options={}))
        assert not any("fixed steps" in s for s in found.statements)


@pytest.mark.parametrize("offset", [False, True])
def test_a_motion_that_never_occurs_earns_its_coefficients_no_recommendation(offset: bool) -> None:
    """X0' and Xvv' come of one method and go together; on a straight coast-down there is no v for Xvv' to act on."""
    values = LINEAR | {"X0": -4e-2, "Xvv": -1e-2} | ({"Y0": 1e-4} if offset else {})
    u95 = {"X0'": 8e-3, "Xvv'": 2e-3} | ({"Y0'": 5e-5} if offset else {})
    file = with_uncertainty(with_mass(parameters(values), np.zeros(3)), u95, {("X0'", "Xvv'"): 0.9})
    found = uncertainty(
        file, Question("stop", {"astern": 0.0, "remaining": 0.8}, members=40, free=("u", "v", "r"), kernel="numpy")
    )
    share = dict(found.importances[found.names.index("stopping time")].known)
    assert share["X0'"] > 0.8
    assert ("Xvv'" in share) == offset
    assert any("without effect on this motion: " in s and "Xvv'" in s for s in found.statements) != offset
