"""Plateau, standard error and drift of histories whose truth is known: first-order autoregressions with a transient."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.special import stdtrit

from coeflab.core.provenance import works
from coeflab.core.types import Array
from coeflab.tables.histories import (
    CALIBRATED_ROWS,
    CITATIONS,
    LEAST_BATCHES,
    TIMES_A_BATCH,
    Convergence,
    Plateau,
    is_cycle,
    long_run_variance,
    mean_of,
    plateau,
    plateau_start,
)

MEAN = 0.7
TRUTH = 30.0  # times the noise; a drift within 1 % of it is small


def noise(rng: np.random.Generator, n: int, phi: float, many: int) -> Array:
    """Stationary noise of unit variance, shape (many, n)."""
    steps = rng.normal(size=(many, n)) * np.sqrt(1.0 - phi**2)
    steps[:, 0] = rng.normal(size=many)
    return lfilter([1.0], [1.0, -phi], steps, axis=1)


def judged(rows: Array) -> list[Plateau]:
    return [plateau({"Y": row}) for row in rows]


def covers(found: Plateau, truth: float) -> bool:
    mean = found.means["Y"]
    reach = stdtrit(mean.freedom, 0.975) if mean.freedom else 2.0
    return abs(mean.value - truth) <= reach * mean.error


def share(found: list[Plateau], status: Convergence) -> float:
    return sum(p.status is status for p in found) / len(found)


@pytest.mark.parametrize(("n", "phi"), [(200, 0.0), (500, 0.5), (1000, 0.8), (2000, 0.9), (5000, 0.98), (1000, 0.99)])
@pytest.mark.parametrize("transient", [0.0, 10.0])
def test_means_and_errors_are_calibrated(n: int, phi: float, transient: float) -> None:
    rng = np.random.default_rng([n, int(100 * phi), int(transient)])
    rows = MEAN + noise(rng, n, phi, 120) + transient * np.exp(-np.arange(n) / (n / 20.0))
    found = judged(rows)
    converged = [p for p in found if p.status is Convergence.CONVERGED]
    wrong = sum(not covers(p, MEAN) for p in converged)
    assert wrong <= 0.1 * len(found)
    assert sum(covers(p, MEAN) for p in found) >= 0.9 * len(found)
    assert share(found, Convergence.DRIFTING) <= 0.05
    enough = n * (1.0 - phi) / (1.0 + phi) >= 45.0
    assert share(found, Convergence.CONVERGED) >= (0.6 if enough else 0.0)
    if not enough:
        assert share(found, Convergence.TOO_SHORT) >= 0.9


@pytest.mark.parametrize(("n", "phi"), [(200, 0.0), (1000, 0.5), (5000, 0.9)])
def test_planted_drift_is_found(n: int, phi: float) -> None:
    rng = np.random.default_rng([n, int(100 * phi)])
    rows = MEAN + noise(rng, n, phi, 60) + 3.0 * np.arange(n) / n
    assert share(judged(rows), Convergence.DRIFTING) >= 0.85


def test_few_independent_rows_are_seldom_called_converged() -> None:
    """22 independent rows, in 200: what Geyer's sequence alone calls converged in a quarter of the cases, a third of it wrong."""
    found = judged(MEAN + noise(np.random.default_rng(1), 200, 0.8, 120))
    assert share(found, Convergence.CONVERGED) <= 0.15


def test_six_components_raise_no_more_false_alarms_than_one() -> None:
    rng = np.random.default_rng(6)
    runs = [{c: MEAN + row for c, row in zip("XYZKMN", noise(rng, 500, 0.5, 6), strict=True)} for _ in range(120)]
    assert share([plateau(run) for run in runs], Convergence.DRIFTING) <= 0.05


def test_small_drift_does_not_matter() -> None:
    rng = np.random.default_rng(3)
    rows = TRUTH + 0.01 * noise(rng, 2000, 0.5, 20) + np.linspace(0.0, 0.2, 2000)
    assert share(judged(rows), Convergence.CONVERGED) == 1.0
    assert share(judged(rows + np.linspace(0.0, 0.4, 2000)), Convergence.DRIFTING) == 1.0


def test_settling_to_the_end_is_no_plateau() -> None:
    n = np.arange(400.0)
    found = plateau({"Y": 10.0 * (1.0 - np.exp(-n / 300.0))})
    assert found.status is Convergence.DRIFTING
    assert "Y" in found.why


def test_smooth_and_settled_is_converged() -> None:
    n = np.arange(400.0)
    found = plateau({"Y": 10.0 * (1.0 - np.exp(-n / 20.0))})
    assert found.status is Convergence.CONVERGED
    assert abs(found.means["Y"].value - 10.0) <= 2.0 * found.means["Y"].error <= 0.01


def test_plateau_begins_behind_the_transient() -> None:
    y = np.where(np.arange(1000) < 200, 5.0, 1.0) + 0.1 * np.random.default_rng(1).normal(size=1000)
    start, found = plateau_start(y)
    assert 200 <= start <= 410
    assert found
    assert plateau({"Y": y}).start == start


def test_components_share_the_latest_plateau() -> None:
    rng = np.random.default_rng(5)
    late = np.where(np.arange(1000) < 200, 20.0, 10.0) + 0.05 * rng.normal(size=1000)
    found = plateau({"X": 40.0 + 0.05 * rng.normal(size=1000), "Y": late, "Z": np.linspace(0.0, 1e-3, 1000)})
    assert found.start >= 200
    assert found.status is Convergence.CONVERGED  # Z is a ten-thousandth of the force, wherever it goes
    assert abs(found.means["X"].value - 40.0) < 4.0 * found.means["X"].error


def test_errors_of_independent_rows_are_the_textbook_ones() -> None:
    rows = noise(np.random.default_rng(7), 2000, 0.0, 40)
    variances, times = zip(*map(long_run_variance, rows), strict=True)
    assert 1.0 <= np.mean(variances) <= 1.1  # the initial sequence errs to the safe side
    assert 1.0 <= np.mean(times) <= 1.1
    variances, times = zip(*map(long_run_variance, noise(np.random.default_rng(8), 20_000, 0.9, 20)), strict=True)
    assert np.mean(times) == pytest.approx(19.0, rel=0.1)  # (1 + phi)/(1 - phi)
    assert np.mean(variances) == pytest.approx(19.0, rel=0.1)


def test_an_oscillation_has_no_smaller_error_than_it_earns() -> None:
    """A mean over broken periods is off by up to A T/(pi m)."""
    rng = np.random.default_rng(9)
    for period in (17.3, 61.7):
        y = 5.0 + np.sin(2.0 * np.pi * np.arange(1000) / period + rng.random()) + 0.01 * rng.normal(size=1000)
        assert mean_of(y, 0.0, 0.0).error >= period / (np.pi * 1000.0) / 2.0


def test_the_cycles_of_a_steady_solver_are_known_to_their_range_however_long_they_last() -> None:
    """Histories of OpenFOAM 1912: a laminar run to its end, and the same one interrupted at iteration 85, alternate from row to
    row and differ by 6e-5 N, where batch means gave errors of 3e-5 and 8e-6."""
    whole = np.tile([0.234841, 0.234754], 60)
    other = np.tile([0.235142, 0.234552], 60)
    found = [plateau({"Y": y}).means["Y"] for y in (whole, other)]
    assert [m.steady_error for m in found] == pytest.approx([8.7e-5 / 2.0, 5.9e-4 / 2.0], rel=1e-6)
    assert abs(found[0].value - found[1].value) <= np.hypot(found[0].steady_error, found[1].steady_error)
    assert abs(found[0].value - found[1].value) > 3.0 * np.hypot(found[0].error, found[1].error)


def test_a_cycle_of_iterations_is_told_from_noise_and_from_a_smooth_approach() -> None:
    rng = np.random.default_rng(11)
    t = np.arange(150)
    settling = np.exp(-t / 15.0)
    for cycle in ([1.0, -1.0], [1.0, -0.3, 0.99, -0.29], [1.0, -1.0, 0.2]):
        y = 40.0 + 1e-4 * np.resize(cycle, 150)
        assert is_cycle(y)
        assert is_cycle(y + 1e-6 * rng.normal(size=150))
    for y in (settling, np.full(150, 3.0), rng.normal(size=150), np.sin(t / 5.0), 40.0 + 1e-4 * t, t[:30] % 2.0):
        assert not is_cycle(y)
    assert not any(is_cycle(row) for row in noise(rng, 200, -0.5, 50))


def test_short_constant_and_single_histories() -> None:
    assert plateau({"Y": np.ones(20) + 1e-3 * np.arange(20)}).status is Convergence.TOO_SHORT
    single = plateau({"Y": np.ones(1)})
    assert single.status is Convergence.TOO_SHORT
    assert np.isnan(single.means["Y"].error)
    constant = plateau({"Y": np.full(100, 3.0)})
    assert constant.status is Convergence.CONVERGED
    assert 0.0 < constant.means["Y"].error < 3e-6


@pytest.mark.parametrize(
    ("values", "status"),
    [
        ([], Convergence.EMPTY),
        ([np.nan] * 5, Convergence.DIVERGED),
        ([1.0, 2.0, np.inf, 3.0], Convergence.DIVERGED),
        (np.where(np.arange(200) < 150, 1.0, 1.0 * 2.0 ** np.arange(-150, 50)), Convergence.DIVERGED),
    ],
)
def test_histories_without_numbers(values: Array, status: Convergence) -> None:
    found = plateau({"Y": np.asarray(values, dtype=float)})
    assert (found.status, found.start, dict(found.means)) == (status, -1, {})
    assert found.why


@pytest.mark.parametrize(("times", "diverged"), [(990.0, False), (1010.0, True)])
def test_a_thousandfold_force_has_diverged(times: float, diverged: bool) -> None:
    found = plateau({"Y": np.where(np.arange(200) < 150, 1.0, times)})
    assert (found.status is Convergence.DIVERGED) == diverged


def test_zero_is_a_number() -> None:
    found = plateau({c: np.zeros(100) for c in "KMN"})
    assert found.status is Convergence.CONVERGED
    assert {m.value for m in found.means.values()} == {0.0}


def test_blanks_at_the_beginning_are_left_out() -> None:
    y = np.r_[np.full(7, np.nan), 2.0 + 0.01 * np.random.default_rng(1).normal(size=300)]
    found = plateau({"Y": y})
    assert found.status is Convergence.CONVERGED
    assert found.start >= 7


def test_unequal_steps_weigh_by_their_time() -> None:
    """A solver that takes small steps while the force is high; the mean of the rows is 2.5."""
    high = np.arange(2000) // 10 % 2 == 0
    time = np.cumsum(np.where(high, 0.01, 0.03))
    y = np.where(high, 3.0, 2.0) + 0.02 * np.random.default_rng(2).normal(size=2000)
    found = plateau({"Y": y}, time)
    mean = np.trapezoid(y, time) / (time[-1] - time[0])
    assert 2.2 < mean < 2.3
    assert found.means["Y"].value == pytest.approx(mean, abs=0.02)
    assert plateau({"Y": y}).means["Y"].value == pytest.approx(2.5, abs=0.02)


def test_long_histories_are_averaged_in_blocks() -> None:
    y = 3.0 + noise(np.random.default_rng(4), 200_003, 0.5, 1)[0]
    found = plateau({"Y": y})
    mean = found.means["Y"]
    assert found.status is Convergence.CONVERGED
    assert found.start + found.rows == len(y)
    assert mean.error == pytest.approx(np.sqrt(3.0 / found.rows), rel=0.3)
    assert abs(mean.value - y[found.start :].mean()) < 1e-10


def test_works_are_known() -> None:
    assert set(CITATIONS) <= set(works())


def test_what_a_short_history_lacks_is_what_decides() -> None:
    """The rows said to be needed are the least that the rule takes: eight whole batches."""
    smooth = lfilter(np.ones(6) / 6.0, [1.0], np.random.default_rng(12).normal(size=1000))[6:]
    ends = set()
    for rows in range(150, 700, 10):
        found = plateau({"Y": 1.0 + smooth[:rows]})
        time = found.means["Y"].correlation
        needed = LEAST_BATCHES * int(np.ceil(TIMES_A_BATCH * time))
        if found.status is Convergence.TOO_SHORT:
            assert found.why == (
                f"Y spans more than 1 % and is correlated over {time:.3g} rows: {found.rows} on the plateau, {needed} needed"
            )
            assert found.rows < needed
            assert found.unsure == {"Y": found.rows >= CALIBRATED_ROWS}
        else:
            assert found.rows >= needed
            assert not found.unsure
        ends.add(found.status)
    assert len(ends) == 2
