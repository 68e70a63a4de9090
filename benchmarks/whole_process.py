"""Whole processes, CPU seconds, over the imports that they cannot do without: python benchmarks/whole_process.py [ROUNDS]

Runs alternate, so that a busy machine slows both sides; the median of the ratios is printed, then peak memory. Modules are
compiled once before, in a folder of the benchmark's own, on both sides. Last, `cf.fit` of nine rows after the imports, fresh tables.
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


NINE = """
import statistics, time
import numpy as np
import coeflab as cf
v = np.linspace(-.3, .3, 9)
def drift(k):
    return cf.read_table({"v [m/s]": v, "Y [N]": (-120 - k) * v - 90 * v * abs(v), "N [N m]": (-60 - k) * v},
        name=f"drift{k}", frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft")
cf.fit(drift(0))
spent = []
for k in range(1, 8):
    table = drift(k)
    start = time.process_time()
    cf.fit(table)
    spent.append(time.process_time() - start)
print(f"{1e3 * statistics.median(spent):.0f} ms CPU")
"""


def cost(words: list[str], folder: str) -> tuple[float, float]:
    """CPU seconds and peak memory, MB, of a process."""
    child = subprocess.Popen(
        [sys.executable, *words],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment(folder),
    )
    _, _, used = os.wait4(child.pid, 0)
    child.returncode = 0
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0


def environment(folder: str) -> dict[str, str]:
    """One thread; compiled modules are kept."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return kept | {"PYTHONPYCACHEPREFIX": f"{folder}/compiled", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def main(rounds: int) -> None:
    """Print a line a case."""
    with tempfile.TemporaryDirectory() as folder:
        for name, (words, base, aim) in CASES.items():
            cost(words, folder), cost(["-c", base], folder)
            pairs = [(cost(words, folder), cost(["-c", base], folder)) for _ in range(rounds)]
            ratio = statistics.median(a[0] / b[0] for a, b in pairs)
            memory = max(a[1] for a, _ in pairs)
            print(f"{name:<42} {ratio:5.2f} times its imports (aim {aim:g}), {memory:.0f} MB")
        nine = subprocess.run(
            [sys.executable, "-c", NINE], env=environment(folder), capture_output=True, text=True, check=True
        )
        print(f"{'cf.fit of nine rows, after imports':<42} {nine.stdout.strip()} (aim 60)")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
