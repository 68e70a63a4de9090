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
from coeflab.fits.statistics import origin_slope, slopes
from tests.coverage.slope_campaigns import FAMILIES

TABLE = Path(__file__).with_name("rounding_table.csv")
CURVES = ("linear", "v|v|", "v|v| + v3", "opposed signs", "tanh", "even part")
DESIGNS = (("even", 7), ("even", 9), ("even", 13), ("one-sided", 9))
NOISE, DIGITS = (0.0, 0.01), (0.01, 0.02, 0.05, 0.1, 0.2)  # of the largest force
CELLS = tuple(product(DESIGNS, NOISE, DIGITS))
CAMPAIGNS = 400
HEADER = "design,rows,noise %,digit %,campaigns,cover %,without %,median U95 / without"


def campaigns(cell: int, count: int) -> Array:
    """(campaign, 3) of a cell: error, U95 before the part of the last digit, and with it; slopes, ranges and offsets are drawn."""
    (design, n), noise, digit = CELLS[cell]
    rng, out = np.random.default_rng((2026, 40, cell)), np.zeros((count, 3))
    for k in range(count):
        truth, reach = FAMILIES[CURVES[k % len(CURVES)]], float(np.sin(np.radians(rng.uniform(8.0, 18.0))))
        x = np.linspace(0.0 if design == "one-sided" else -reach, reach, n)
        size = rng.uniform(0.6, 1.4)
        force = size * truth.curve(x)
        force = force + rng.uniform(-0.025, 0.025) * np.max(np.abs(force))
        largest = float(np.max(np.abs(force)))
        unit = digit * largest
        y = unit * np.round((force + noise * largest * rng.standard_normal(n)) / unit)
        o = origin_slope.estimate(x, y)
        part = slopes.by_digits(x, y, None, np.full(n, unit / 12.0**0.5), "x", o.noise, False, False, o.value, o.u95)
        out[k] = abs(o.value - size * truth.slope), o.u95, np.hypot(o.u95, part)
    return out


def main(count: int) -> None:
    """Write the table, cell by cell."""
    lines = [HEADER]
    for cell, ((design, n), noise, digit) in enumerate(CELLS):
        error, before, after = campaigns(cell, count).T
        cover, without = (f"{100.0 * float(np.mean(error <= u)):.1f}" for u in (after, before))
        wider = float(np.median(after / np.maximum(before, 1e-300)))
        lines.append(f"{design},{n},{100 * noise:g},{100 * digit:g},{count},{cover},{without},{wider:.2f}")
        print(lines[-1], flush=True)
    TABLE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CAMPAIGNS)
