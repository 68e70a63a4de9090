"""Start of the command line: `coeflab --help` against `python -c "import typer"`, whole processes, in pairs."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

PAIRS = 21


def seconds(command: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


def main() -> None:
    coeflab = [str(Path(sys.executable).with_name("coeflab")), "--help"]
    typer = [sys.executable, "-c", "import typer"]
    seconds(coeflab), seconds(typer)
    runs = [(seconds(coeflab), seconds(typer)) for _ in range(PAIRS)]
    print(f"coeflab --help          {1e3 * statistics.median(a for a, _ in runs):6.0f} ms")
    print(f'python -c "import typer" {1e3 * statistics.median(b for _, b in runs):5.0f} ms')
    print(
        f"ratio                   {statistics.median(a / b for a, b in runs):6.2f} (median of {PAIRS}; target: at most 2)"
    )


if __name__ == "__main__":
    main()
