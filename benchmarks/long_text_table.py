"""A long text table: 2,000,000 lines of 7 columns read as they are, against csv.reader with float on the same file.

Ours finds the dialect, names every row left out and keeps the line of every row; the peer makes one array. Three dialects: plain
comma CSV, semicolons with decimal commas, and one with a cell without number every hundred lines. Peak memory is the largest
resident size of a process of its own that reads the file, the interpreter with its imports included.
"""

from __future__ import annotations

import csv
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np

from coeflab.core.types import Array
from coeflab.tables.importers.table import raw

LINES, COLUMNS, REPEATS = 2_000_000, 7, 3
NAMES = ("t", "X", "Y", "Z", "K", "M", "N")


def write(path: Path, delimiter: str, decimal: str, hole: bool) -> None:
    """Synthetic rows of seven digits, 20,000 of them again and again."""
    lines = []
    for i, row in enumerate(np.random.default_rng(1).standard_normal((20_000, COLUMNS))):
        cells = [f"{x:.6e}".replace(".", decimal) for x in row]
        if hole and i % 100 == 50:
            cells[3] = "nan"
        lines.append(delimiter.join(cells) + "\n")
    with path.open("w") as stream:
        stream.write(delimiter.join(NAMES) + "\n")
        for _ in range(LINES // len(lines)):
            stream.writelines(lines)


def peer(path: Path, delimiter: str, decimal: str) -> Array:
    """What a person would write in ten lines."""
    with path.open(newline="") as stream:
        rows = csv.reader(stream, delimiter=delimiter)
        next(rows)
        if decimal == ",":
            return np.array([[float(c.replace(",", ".")) for c in row] for row in rows])
        return np.array([[float(c) for c in row] for row in rows])


def seconds(path: Path, delimiter: str, decimal: str) -> float:
    """Median ratio of ours to the peer, taken in turn."""
    ratios = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        table = raw(path, {})
        ours = time.perf_counter() - start
        mine = np.column_stack([c.values for c in table.columns])
        del table
        start = time.perf_counter()
        other = peer(path, delimiter, decimal)
        ratios.append(ours / (time.perf_counter() - start))
        np.testing.assert_array_equal(mine, other)
        del mine, other
    return statistics.median(ratios)


def peak(path: Path) -> float:
    """Largest resident size in MB of a process that reads the file."""
    done = subprocess.run([sys.executable, __file__, str(path)], capture_output=True, text=True, check=True)
    return float(done.stdout)


def main() -> None:
    if len(sys.argv) > 1:
        raw(Path(sys.argv[1]), {})
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)
        return
    print(f"{LINES:,} lines x {COLUMNS} columns: time / (csv.reader + float), peak memory")
    dialects = {"comma": (",", ".", False), "semicolon": (";", ",", False), "nan cells": ("\t", ".", True)}
    with tempfile.TemporaryDirectory() as folder:
        paths = {name: Path(folder) / f"{name}.txt" for name in dialects}
        for name, (delimiter, decimal, hole) in dialects.items():
            write(paths[name], delimiter, decimal, hole)
        # First, as a process begins with the peak of the one that starts it.
        peaks = {name: peak(path) for name, path in paths.items()}
        for name, (delimiter, decimal, _) in dialects.items():
            print(f"{name:10} {seconds(paths[name], delimiter, decimal):5.2f}  {peaks[name]:5.0f} MB", flush=True)


if __name__ == "__main__":
    main()
