"""Coverage of the slope at the origin where few digits are printed: a staircase of readings, with and without noise.

``python tests/coverage/rounding_campaigns.py [CAMPAIGNS]`` writes ``rounding_table.csv`` beside this file. Seeds are (2026, 40, cell).
``cover %`` counts value +- U95 with the part of the last digit; ``without %`` U95 before it.
"""

from __future__ import annotations

import sys
from itertools import product
from pathlib import Path

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.printed_digits import UNIFORM
from coeflab.fits.statistics.slope_mixture import estimate_many, prepare
from coeflab.fits.statistics.slopes import UNSEEN
from tests.coverage.slope_campaigns import FAMILIES

TABLE = Path(__file__).with_name("rounding_table.csv")
CURVES = ("linear", "v|v|", "v|v| + v3", "opposed signs", "tanh", "even part")
DESIGNS = (("even", 7), ("even", 9), ("even", 13), ("one-sided", 9))
NOISE, DIGITS = (0.0, 0.01), (0.01, 0.02, 0.05, 0.1, 0.2)  # of the largest force
CELLS = tuple(product(DESIGNS, NOISE, DIGITS))
CAMPAIGNS, ROUND = 400, 20
HEADER = "design,rows,noise %,digit %,campaigns,cover %,without %,median U95 / without"


def campaigns(cell: int, count: int) -> tuple[Array, Array, Array]:
    """Settings (r, n), readings (r, 20, n) and true slopes (r, 20) of rounds of 20 campaigns: slopes, ranges and offsets are drawn."""
    (design, n), noise, digit = CELLS[cell]
    rng, x, y, slopes = np.random.default_rng((2026, 40, cell)), [], [], []
    for _ in range(count // ROUND):
        reach = float(np.sin(np.radians(rng.uniform(8.0, 18.0))))
        x.append(np.linspace(0.0 if design == "one-sided" else -reach, reach, n))
        truths = [FAMILIES[CURVES[k % len(CURVES)]] for k in rng.permutation(ROUND)]
        size = rng.uniform(0.6, 1.4, ROUND)
        force = size[:, None] * np.array([t.curve(x[-1]) for t in truths])
        force = force + rng.uniform(-0.025, 0.025, (ROUND, 1)) * np.max(np.abs(force), axis=1, keepdims=True)
        largest = np.max(np.abs(force), axis=1, keepdims=True)
        force = force + noise * largest * rng.standard_normal(force.shape)
        y.append(digit * largest * np.round(force / (digit * largest)))
        slopes.append(size * np.array([t.slope for t in truths]))
    return np.array(x), np.array(y), np.array(slopes)


def run(cell: int, count: int) -> Array:
    """(campaign, 3) of a cell: error, U95 before the part of the last digit, and with it, as `slopes.by_digits` has it."""
    out = []
    for x, y, true in zip(*campaigns(cell, count), strict=True):
        design = prepare(x)
        found = estimate_many(design, y)
        error = CELLS[cell][2] * np.max(np.abs(y), axis=1) / UNIFORM
        told = estimate_many(design, y, error**2)
        reach = np.where(error > UNSEEN * found.noise, np.hypot(told.value - found.value, told.u95), 0.0)
        out.append(np.stack([np.abs(found.value - true), found.u95, np.maximum(found.u95, reach)], 1))
    return np.concatenate(out)


def main(count: int) -> None:
    """Write the table, cell by cell."""
    lines = [HEADER]
    for cell, ((design, n), noise, digit) in enumerate(CELLS):
        error, before, after = run(cell, count).T
        cover, without = (f"{100.0 * float(np.mean(error <= u)):.1f}" for u in (after, before))
        wider = float(np.median(after / np.maximum(before, 1e-300)))
        lines.append(f"{design},{n},{100 * noise:g},{100 * digit:g},{count},{cover},{without},{wider:.2f}")
    TABLE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CAMPAIGNS)
