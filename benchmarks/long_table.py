"""A long table: factorise and solve 1,000,000 rows by 20 terms, against numpy.linalg.qr of the same matrix.

Ours gives coefficients, leverage, condition and rank beside the factors; the peer gives Q and R only. Peak memory is the
largest resident size of a process of its own that does one of them, less that of the process with the matrix alone.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import resource
import statistics
import subprocess
import sys
import time

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.least_squares import factorise, solve

ROWS, TERMS = 1_000_000, 20
REPEATS = 5


def problem() -> tuple[Array, Array]:
    """Synthetic rows with a known answer."""
    rng = np.random.default_rng(1)
    matrix = np.empty((ROWS, TERMS))
    rng.standard_normal(out=matrix)
    return matrix, matrix @ np.arange(1.0, TERMS + 1.0) + 0.01 * rng.standard_normal(ROWS)


def seconds() -> tuple[list[float], list[float]]:
    """Times of ours and of the peer, taken in turn."""
    matrix, y = problem()
    ours, theirs = [], []
    for _ in range(REPEATS):
        start = time.perf_counter()
        found, _ = solve(factorise(matrix), y)
        ours.append(time.perf_counter() - start)
        start = time.perf_counter()
        q, r = np.linalg.qr(matrix)
        theirs.append(time.perf_counter() - start)
        np.testing.assert_allclose(found, np.linalg.solve(r, q.T @ y), rtol=1e-10)
    return ours, theirs


def peak(what: str) -> float:
    """Largest resident size in bytes of a process that does ``what``: nothing, ours or qr."""
    done = subprocess.run([sys.executable, __file__, what], capture_output=True, text=True, check=True)
    return float(done.stdout)


def alone(what: str) -> None:
    matrix, y = problem()
    if what == "ours":
        solve(factorise(matrix), y)
    elif what == "qr":
        np.linalg.qr(matrix)
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)


def main() -> None:
    size = 8.0 * ROWS * TERMS
    bare = peak("nothing")
    memory = {what: 1.0 + (peak(what) - bare) / size for what in ("ours", "qr")}
    ours, theirs = seconds()
    mine, peers = statistics.median(ours), statistics.median(theirs)
    ratio = statistics.median(a / b for a, b in zip(ours, theirs, strict=True))
    print(f"factorise + solve {mine:7.3f} s for {ROWS:,} rows x {TERMS} terms (median of {REPEATS})")
    print(f"numpy.linalg.qr   {peers:7.3f} s")
    print(f"ratio             {ratio:7.2f} (target: at most 1.5)")
    print(f"peak memory       {memory['ours']:7.2f} design matrices, itself included (target: below 3)")
    print(f"that of qr        {memory['qr']:7.2f}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        alone(sys.argv[1])
    else:
        main()
