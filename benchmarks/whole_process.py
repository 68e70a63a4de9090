"""Whole processes, CPU seconds, over the imports that they cannot do without: python benchmarks/whole_process.py [ROUNDS]

Runs alternate, so that a busy machine slows both sides; the median of the ratios is printed, then peak memory.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile

CASES = {
    "coeflab fit suboff_roddy_2 --symbol Yv": (
        ["-m", "coeflab", "fit", "suboff_roddy_2", "--symbol", "Yv"], "import numpy, scipy.stats, pandas", 1.6
    ),
    "cf.fit('suboff_roddy_2')": (["-c", "import coeflab as cf; cf.fit('suboff_roddy_2')"], "import numpy, scipy.stats, pandas", 1.6),
    "coeflab validate suboff": (
        ["-m", "coeflab", "validate", "suboff"], "import numpy, scipy.stats, pandas, matplotlib.figure, trimesh", 5.0
    ),
}  # fmt: skip


def cost(words: list[str], folder: str) -> tuple[float, float]:
    """CPU seconds and peak memory, MB, of a process."""
    child = subprocess.Popen([sys.executable, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(child.pid, 0)
    child.returncode = 0
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0


def main(rounds: int) -> None:
    """Print a line a case."""
    with tempfile.TemporaryDirectory() as folder:
        for name, (words, base, aim) in CASES.items():
            pairs = [(cost(words, folder), cost(["-c", base], folder)) for _ in range(rounds)]
            ratio = statistics.median(a[0] / b[0] for a, b in pairs)
            memory = max(a[1] for a, _ in pairs)
            print(f"{name:<42} {ratio:5.2f} times its imports (aim {aim:g}), {memory:.0f} MB")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
