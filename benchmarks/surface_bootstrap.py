"""Pairs bootstrap of a surface of 15 terms: all replicates at once against one statsmodels OLS per replicate.

Work: the 231 settings of the synthetic HUUV campaign, total degree 4 in attack and drift (15 terms), 10,000 resamples
of rows, first for one response, then for the five that the campaign has. Both sides refit the same resamples, and the
script checks that they agree. The statsmodels loop runs on a tenth of the resamples and its time is multiplied by ten.
Threads of the linear algebra are left at their default, as a user has them; the loop, which is bound by Python, neither
gains nor loses by them.
"""

from __future__ import annotations

import statistics
import time

import numpy as np
import statsmodels.api as sm

from coeflab.core.types import Array
from coeflab.fits.statistics.diagnostics import draw_counts, pairs
from coeflab.fits.statistics.least_squares import factorise
from coeflab.law.terms import design, power_terms

REPLICATES = 10_000
SHARE = 10
REPEATS = 5
SEED = 7


def surface() -> tuple[Array, Array]:
    """Design in radians and five synthetic coefficients with noise, columns C_D C_S C_L C_m C_n."""
    alpha, beta = np.meshgrid(np.radians(np.arange(-25.0, 25.1, 2.5)), np.radians(np.arange(0.0, 25.1, 2.5)))
    a, b = alpha.ravel(), beta.ravel()
    terms = power_terms(("alpha", "beta"), 4, "total", {})
    values = (
        0.3 + 1.2 * a**2 + 0.9 * b**2 + 2.0 * a**2 * b**2,
        -1.1 * b - 2.4 * b**3,
        a + 1.8 * a**3,
        0.35 * a - 0.3 * a**3,
        -0.4 * b + 0.5 * b**3,
    )
    noise = 0.002 * np.random.default_rng(1).standard_normal((len(a), len(values)))
    return design(terms, {"alpha": a, "beta": b}), np.column_stack(values) + noise


def loop(matrix: Array, y: Array) -> tuple[Array, float]:
    """Coefficients of the first resamples by sm.OLS, one response after another, and the seconds for all of them."""
    drawn = np.random.default_rng(SEED).integers(0, len(y), size=(REPLICATES, len(y)))[: REPLICATES // SHARE]
    out = np.empty((len(drawn), matrix.shape[1], y.shape[1]))
    start = time.perf_counter()
    for k, chosen in enumerate(drawn):
        for j in range(y.shape[1]):
            out[k, :, j] = sm.OLS(y[chosen, j], matrix[chosen]).fit().params
    return out, SHARE * (time.perf_counter() - start)


def main() -> None:
    matrix, all_responses = surface()
    for count in (1, all_responses.shape[1]):
        y = all_responses[:, :count]
        ours = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            found = pairs(factorise(matrix), y, draw_counts(len(y), REPLICATES, SEED))
            ours.append(time.perf_counter() - start)
        peer, theirs = loop(matrix, y)
        size = np.abs(peer).max(axis=0)
        np.testing.assert_allclose(found[: len(peer)] / size, peer / size, rtol=0, atol=1e-8)
        mine = statistics.median(ours)
        print(f"{count} response{'s' if count > 1 else ''} of {matrix.shape[1]} terms, {REPLICATES} replicates")
        print(f"  at once          {mine:8.4f} s (median of {REPEATS})")
        print(f"  statsmodels loop {theirs:8.4f} s (measured on {REPLICATES // SHARE} replicates, times {SHARE})")
        print(f"  ratio            {theirs / mine:8.0f} (target: at least 50)")


if __name__ == "__main__":
    main()
