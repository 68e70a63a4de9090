"""Coverage of the intervals of `coeflab tune` on simulated turns of a vehicle whose coefficients are planted, in the right form.

``python -m tests.coverage.tune_campaigns [SERIES]`` writes ``tune_table.csv`` beside this file: the eight turns of
`tests.identify.test_tune`, each series with noise of its own, of the errors that the plan states.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from coeflab.core.types import Array
from coeflab.identify.tune import tune
from coeflab.identify.tuning_plan import read_tuning_plan
from tests.identify.test_tune import ERRORS, FREE, HEAD, HUUV, PLANTED, table

TABLE = Path(__file__).with_name("tune_table.csv")
SERIES, SEED, DEVIATIONS = 300, 3, np.array([0.01, 0.3, 1.0])  # of u, beta and r
TRUE = tuple(dict.fromkeys(PLANTED.values()))  # the intercepts of both thrusters are one parameter


def series(rows: list[str], seed: int) -> str:
    """The turns of a table with noise on what was measured."""
    rng, out = np.random.default_rng((SEED, seed)), []
    for row in rows:
        cells = row.split(",")
        measured = np.array([float(x) for x in cells[2:]]) + DEVIATIONS * rng.normal(size=3)
        out.append(",".join([*cells[:2], *(f"{x:.12g}" for x in measured)]))
    return "\n".join(out) + "\n"


def covered(count: int) -> tuple[list[str], Array]:
    """Names of the parameters, and whether the interval of each holds the planted value, (series, parameter)."""
    head, *rows = table().splitlines()
    names, inside = [], []
    with TemporaryDirectory() as folder:
        plan = Path(folder) / "plan.toml"
        plan.write_text(HEAD.replace("PARAMETERS", str(HUUV / "huuv.parameters.json")) + ERRORS + FREE)
        for seed in range(count):
            (plan.parent / "turns.csv").write_text(f"{head}\n{series(rows, seed)}")
            found = tune(read_tuning_plan(plan)).tuning.parameters
            names = [p.name for p in found]
            inside.append([p.u95 is not None and abs(p.after - t) <= p.u95 for p, t in zip(found, TRUE, strict=True)])
    return names, np.array(inside, dtype=float)


def main(count: int) -> None:
    """Write the table."""
    names, inside = covered(count)
    lines = [f"{name},{count},{100.0 * share:.1f}" for name, share in zip(names, inside.mean(0), strict=True)]
    TABLE.write_text("\n".join(["parameter,series,cover %", *lines]) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else SERIES)
