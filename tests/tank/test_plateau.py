"""When a run may end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.histories import Convergence
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run
from coeflab.tables.run_summary import summarised
from coeflab.tank.job import lengths
from coeflab.tank.plateau import on_plateau, settling, until

ROWS = np.arange(400.0)
NOISE = np.random.default_rng(18)


def table(**columns: np.ndarray) -> RawTable:
    return RawTable(Path("run"), tuple(RawColumn(n, "N", v, means=n) for n, v in columns.items()))


def run(y: np.ndarray, ended: Ended = Ended.WHOLE, **patches: np.ndarray) -> Run:
    return Run(
        Path("run"), "run", table(X=np.full(len(y), -20.0), Y=y, N=3.0 * y),
        patches={n: table(X=np.full(len(v), -5.0), Y=v, N=v) for n, v in patches.items()}, ended=ended, why="wild" * (ended is Ended.DIVERGED),
    )  # fmt: skip


def noisy(values: np.ndarray, share: float = 0.002) -> np.ndarray:
    return values * (1.0 + share * NOISE.standard_normal(len(values)))


def test_a_history_that_stays_is_on_its_plateau_and_says_its_mean() -> None:
    verdict = on_plateau(run(noisy(np.full(400, 50.0)), hull=noisy(np.full(400, 30.0))))
    assert (verdict.settled, verdict.why, verdict.diverged) == (True, "", False)
    assert verdict.plateau.means["Y"].value == pytest.approx(50.0, abs=0.05)


def test_the_transient_alone_is_no_plateau() -> None:
    start = 50.0 + 40.0 * np.exp(-ROWS / 15.0)
    assert not on_plateau(run(start[:80])).settled
    assert on_plateau(run(start)).settled


def test_a_patch_that_still_decays_holds_the_run_even_where_the_sum_stays() -> None:
    sail = 20.0 + 8.0 * np.exp(-ROWS / 150.0)
    verdict = on_plateau(run(noisy(np.full(400, 50.0)), sail=sail, hull=50.0 - sail))
    assert not verdict.settled
    assert "Y(sail)" in verdict.why
    assert verdict.plateau.why == ""


def test_a_small_patch_matters_by_the_whole_body() -> None:
    # The force on a cap of a thousandth of the body's may still move by a tenth of itself.
    cap = 0.05 + 0.01 * np.exp(-ROWS / 200.0)
    cut = Run(Path("run"), "run", table(Y=noisy(np.full(400, 50.0))), patches={"cap": table(Y=cap)})
    assert on_plateau(cut).settled


@pytest.mark.parametrize("length", [0.0, 4.0])
def test_what_symmetry_makes_zero_is_judged_by_the_force_and_the_length(length: float) -> None:
    # A body straight ahead: its Y and N are the rounding of the mesh, and wander for ever.
    wander = 2e-4 * np.cumsum(NOISE.standard_normal(400))
    straight = Run(
        Path("run"), "run", table(X=noisy(np.full(400, -38.0)), Y=wander, N=wander),
        patches={"stern": table(X=noisy(np.full(400, -7.0)), Y=wander, N=wander)}, length=length,
    )  # fmt: skip
    verdict = on_plateau(straight)
    assert verdict.settled == (length > 0.0), verdict.why
    assert (summarised(straight, "straight").status is Convergence.CONVERGED) == (length > 0.0)
    # A moment that is one is judged by itself all the same.
    moving = on_plateau(replace(straight, history=table(X=np.full(400, -38.0), Y=wander, N=30.0 + 0.01 * ROWS)))
    assert "N" in moving.why


def test_shares_by_pressure_and_friction_are_no_patches() -> None:
    drifting = 20.0 + 0.1 * ROWS
    assert on_plateau(run(noisy(np.full(400, 50.0)), pressure=drifting, viscous=drifting)).settled


@pytest.mark.parametrize("ended", [Ended.WHOLE, Ended.DIVERGED])
def test_what_diverges_is_said(ended: Ended) -> None:
    grown = np.full(400, 50.0) if ended is Ended.DIVERGED else np.where(ROWS > 350, 1e9, 50.0)
    verdict = on_plateau(run(grown, ended))
    assert (verdict.settled, verdict.diverged, bool(verdict.why)) == (False, True, True)


def test_nothing_yet_is_neither() -> None:
    verdict = on_plateau(Run(Path("run"), "run", RawTable(Path("run"), ()), ended=Ended.EMPTY, why="no iteration yet"))
    assert (verdict.settled, verdict.diverged) == (False, False)


@pytest.mark.parametrize("decay", [30.0, 60.0, 90.0])
def test_a_geometric_approach_is_seen_to_its_limit(decay: float) -> None:
    values = 10.0 + 2.0 * np.exp(-np.arange(150) / decay)
    assert values.mean() + settling(values, 1e-9) == pytest.approx(10.0, abs=0.01)


def test_noise_approaches_nothing() -> None:
    generator = np.random.default_rng(3)
    seen = [settling(generator.standard_normal(150), 1.0 / np.sqrt(150)) != 0.0 for _ in range(400)]
    assert np.mean(seen) < 0.02


def first_settled(y: np.ndarray) -> tuple[int, float] | None:
    for rows in lengths(len(y)):
        verdict = on_plateau(until(run(y, hull=0.7 * y), rows))
        if verdict.settled:
            return rows, verdict.plateau.means["Y"].value
    return None


@pytest.mark.parametrize("tau", [30.0, 100.0, 150.0])
def test_a_smooth_approach_ends_where_its_last_quarter_stays_and_is_right(tau: float) -> None:
    found = first_settled(50.0 * (1.0 + 0.5 * np.exp(-np.arange(1000.0) / tau)))
    assert found[0] < 7.0 * max(tau, 40.0)  # a plateau from the first half on takes 8 of them
    assert found[1] == pytest.approx(50.0, rel=0.005)


@pytest.mark.parametrize("period", [150.0, 300.0, 400.0])
def test_the_crest_of_a_wave_is_no_plateau(period: float) -> None:
    turns = 2.0 * np.pi * np.arange(800.0) / period
    assert first_settled(50.0 + 1.5 * np.cos(turns)) is None
    assert first_settled(50.0 + 1.5 * np.sin(turns)) is None


def test_a_line_and_a_walk_are_no_plateau() -> None:
    assert first_settled(50.0 + 0.02 * np.arange(800.0)) is None
    assert first_settled(50.0 + 0.1 * np.cumsum(NOISE.standard_normal(800))) is None


def test_what_came_before_the_last_quarter_counts_for_nothing() -> None:
    decay = run(50.0 * (1.0 + 0.5 * np.exp(-np.arange(655.0) / 100.0)))
    verdict = on_plateau(decay)
    assert (verdict.settled, verdict.first) == (True, 655 - 655 // 4)
    assert summarised(until(decay, 655, verdict.first), "run").status is Convergence.CONVERGED
