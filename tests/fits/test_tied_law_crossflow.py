"""Drift and attack together in the tied law: planted terms come back, in groups, and nothing comes in where nothing is planted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.tied_law import fit
from tests.report.studies import CONDITIONS, LENGTH, small_table

GRID = np.array([(a, b) for a in range(-12, 13, 4) for b in range(-12, 13, 4)], dtype=float)
PLANTED = {
    "Y": {"v": -0.03, "v|v|": -0.1, "v|w|": -0.08}, "N": {"v": -0.012, "v|v|": 0.02, "v|w|": 0.03}, "K": {"vw": 0.004},
    "Z": {"w": -0.03, "w|w|": -0.1, "w|v|": -0.06, "vv": 0.02}, "M": {"w": 0.012, "w|w|": -0.02, "w|v|": -0.03},
}  # fmt: skip
NOISE = {"Y": 5e-5, "Z": 5e-5, "N": 2e-5, "M": 2e-5, "K": 5e-6}


def value(terms: dict[str, float], v: np.ndarray, w: np.ndarray) -> np.ndarray:
    factors = {
        "v": v, "w": w, "v|v|": v * np.abs(v), "w|w|": w * np.abs(w), "v|w|": v * np.abs(w), "w|v|": w * np.abs(v), "vw": v * w, "vv": v * v,
        "vww": v * w * w,
    }  # fmt: skip
    return sum((c * factors[t] for t, c in terms.items()), np.zeros(len(v)))


def found(
    planted: dict[str, dict[str, float]], grid: np.ndarray = GRID, seed: int = 4, noise: float = 1.0
) -> FitResult:
    alpha, beta = np.radians(grid).T
    v, w = np.sin(beta), np.sin(alpha) * np.cos(beta)
    rng, speed, n = np.random.default_rng(seed), CONDITIONS.speed, len(grid)
    q = 0.5 * CONDITIONS.density * speed**2 * LENGTH.length**2
    forces = {
        c: q
        * (LENGTH.length if c in "KMN" else 1.0)
        * (value(planted.get(c, {}), v, w) + noise * NOISE[c] * rng.standard_normal(n))
        for c in "YZKMN"
    }
    first = small_table(list(range(n)))
    motion = dict.fromkeys("pqr", np.zeros(n)) | {
        "u": speed * np.sqrt(1.0 - v**2 - w**2),
        "v": speed * v,
        "w": speed * w,
    }
    table = replace(
        first, forces=forces, motion=motion, exclusions=(), usable={c: np.ones(n, dtype=bool) for c in forces},
        labels=tuple(map(str, range(n))), speed=np.full(n, speed),
    )  # fmt: skip
    return fit([table], LENGTH, {})


@pytest.fixture(scope="module")
def combined() -> FitResult:
    return found(PLANTED)


@pytest.mark.parametrize(
    ("symbol", "due"),
    [("Yv|w|", -0.08), ("Nv|w|", 0.03), ("Kvw", 0.004), ("Zw|v|", -0.06), ("Zvv", 0.02), ("Mw|v|", -0.03)],
)
def test_what_drift_and_attack_do_together_comes_back(combined: FitResult, symbol: str, due: float) -> None:
    c = combined.coefficients[symbol]
    assert c.value == pytest.approx(due, abs=c.u95)
    assert c.u95 < 0.25 * abs(due)


def test_a_group_comes_in_whole_although_neither_of_it_is_sure_alone() -> None:
    """Much noise: v|w| and v w^2 each have an interval with zero in it or next to it, and together they are no chance."""
    both = found({"Y": {"v": -0.03, "v|w|": -0.02, "vww": -0.1}}, noise=3.0)
    crossed = [c for c in both.coefficients.coefficients if c.symbol in ("Yv|w|", "Yvww", "Yvw")]
    assert crossed
    v, w = np.sin(0.2), np.sin(0.2)
    due = -0.02 * v * w - 0.1 * v * w * w
    total = sum(c.value * value({c.symbol[1:]: 1.0}, np.array([v]), np.array([w]))[0] for c in crossed)
    assert total == pytest.approx(due, rel=0.25)


def test_nothing_comes_in_where_nothing_is_planted() -> None:
    plain = {c: {t: x for t, x in terms.items() if t in ("v", "w", "v|v|", "w|w|")} for c, terms in PLANTED.items()}
    came = 0
    for seed in range(6):
        symbols = {c.symbol for c in found(plain, seed=seed).coefficients.coefficients}
        came += len({s for s in symbols if "v" in s and "w" in s[1:] and s[0] != "X"})
    assert came <= 4  # of 30 choices at two units of AICc


def test_rows_of_one_plane_at_a_time_leave_the_law_as_it_was() -> None:
    apart = GRID[(GRID[:, 0] == 0.0) | (GRID[:, 1] == 0.0)]
    symbols = {c.symbol for c in found(PLANTED, apart).coefficients.coefficients}
    assert not {s for s in symbols if "v" in s and "w" in s}
