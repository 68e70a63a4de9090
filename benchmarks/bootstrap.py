"""Pairs bootstrap of six derivatives: all replicates in closed form against one statsmodels OLS per replicate.

Work: two designs (a drift and an attack sweep of 20 runs), three force components each, a line through each, 10,000
resamples of rows. Both sides refit the same resamples, and the script checks that they agree. The statsmodels loop runs
on a tenth of the resamples and its time is multiplied by ten.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import time

import numpy as np
import statsmodels.api as sm

from coeflab.core.types import Array
from coeflab.fits.statistics.diagnostics import draw_counts, pairs
from coeflab.fits.statistics.least_squares import factorise

REPLICATES = 10_000
SHARE = 10
ROWS = 20
REPEATS = 5
SLOPES = ((-0.028, -0.0136, -6e-4), (-0.0139, 0.0103, 1e-5))


def designs() -> list[tuple[Array, Array]]:
    """Two sweeps of -18 to 18 degrees with noise, (design, responses) each."""
    rng = np.random.default_rng(1)
    made = []
    for slopes in SLOPES:
        x = np.sin(np.radians(np.linspace(-18.0, 18.0, ROWS)))
        responses = np.outer(x, slopes) + 1e-4 * rng.standard_normal((ROWS, 3))
        made.append((np.column_stack([np.ones(ROWS), x]), responses))
    return made


def closed_form(work: list[tuple[Array, Array]]) -> list[Array]:
    return [pairs(factorise(d, None), y, draw_counts(ROWS, REPLICATES, k)) for k, (d, y) in enumerate(work)]


def loop(work: list[tuple[Array, Array]], resamples: list[Array]) -> list[Array]:
    """The slope of every response in every resample, by sm.OLS."""
    out = []
    for (design, responses), drawn in zip(work, resamples, strict=True):
        slopes = np.empty((len(drawn), responses.shape[1]))
        for b, rows in enumerate(drawn):
            for k in range(responses.shape[1]):
                slopes[b, k] = sm.OLS(responses[rows, k], design[rows]).fit().params[1]
        out.append(slopes)
    return out


def main() -> None:
    work = designs()
    resamples = [
        np.random.default_rng(k).integers(0, ROWS, size=(REPLICATES, ROWS))[: REPLICATES // SHARE]
        for k in range(len(work))
    ]
    closed_form(work)
    ours = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        found = closed_form(work)
        ours.append(time.perf_counter() - start)
    start = time.perf_counter()
    peer = loop(work, resamples)
    theirs = SHARE * (time.perf_counter() - start)
    for a, b in zip(found, peer, strict=True):
        np.testing.assert_allclose(a[: len(b), 1], b, rtol=0, atol=1e-10)
    mine = statistics.median(ours)
    print(f"closed form      {mine:8.4f} s for {REPLICATES} replicates of 6 derivatives (median of {REPEATS})")
    print(f"statsmodels loop {theirs:8.4f} s (measured on {REPLICATES // SHARE} replicates, times {SHARE})")
    print(f"ratio            {theirs / mine:8.0f} (target: at least 100)")


if __name__ == "__main__":
    main()
