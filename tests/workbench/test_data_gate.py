"""The gate for data: one corrupted cell is a warning, a clean campaign is none.

``python tests/workbench/test_data_gate.py COUNT SEED`` prints how many of COUNT clean campaigns get a warning, and which.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.table import Check, Severity
from coeflab.core.types import Array
from coeflab.study.checks.data_gate import findings
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable, read_tables
from tests.coverage.slope_campaigns import FAMILIES

TEMPLATE = Path(__file__).parents[2] / "coeflab" / "cli" / "template" / "campaign"
FACTORS = (10.0, -1.0, 1.5)
NOISE = (0.03, 0.01, 0.003, 0.001, 0.0001)
FORMS = {"X": (0, 2), "Y": (0, 1, 3), "N": (0, 1, 3)}


@cache
def demo() -> tuple[ForceTable, ...]:
    return read_tables(PlannedTable(TEMPLATE, (), {}))


def with_cell(table: ForceTable, component: str, row: int, factor: float) -> ForceTable:
    y = np.array(table.forces[component])
    y[row] *= factor
    return replace(table, forces={**table.forces, component: y})


def warnings(tables: tuple[ForceTable, ...]) -> list[Check]:
    return [c for c in findings(tables, tables[0].scaling.length) if c.severity is Severity.WARN]


def scatter(table: ForceTable, component: str) -> float:
    """Standard deviation of the residuals about the form that the demo was made with."""
    x = table.primed_motion("v" if "v" in table.varies else "r", table.scaling.length)
    columns = np.stack([x**k for k in FORMS[component]], 1)
    y = table.forces[component]
    left = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
    return float(np.sqrt(left @ left / (len(x) - columns.shape[1])))


def clean_campaign(rng: np.random.Generator) -> tuple[str, ForceTable]:
    """X, Y and N over drift of two families, 5 to 25 rows to 6 to 20 degrees."""
    table = demo()[0]
    n, reach = int(rng.integers(5, 26)), float(np.sin(np.radians(rng.uniform(6.0, 20.0))))
    design = ("even", "uneven", "one-sided", "replicated")[int(rng.integers(4))]
    v = {
        "even": np.linspace(-reach, reach, n),
        "uneven": np.sort(rng.uniform(-reach, reach, n)),
        "one-sided": np.linspace(0.0, reach, n),
        "replicated": np.repeat(np.linspace(-reach, reach, max(n // 2, 3)), 2),
    }[design]
    first, second = rng.choice(list(FAMILIES), 2)
    noise = float(rng.choice(NOISE))
    primed = {
        "X": -0.0025 + 0.006 * v**2 + float(rng.choice([0.0, 0.02])) * np.maximum(np.abs(v) - 0.12, 0.0),
        "Y": FAMILIES[first].curve(v),
        "N": 0.4 * FAMILIES[second].curve(v),
    }
    primed = {c: y + noise * np.abs(y).max() * rng.standard_normal(len(v)) for c, y in primed.items()}
    return f"{design} {len(v)} {first} {second} {noise:g}", table_of(v, primed)


def table_of(v: Array, primed: dict[str, Array]) -> ForceTable:
    table, zero, n = demo()[0], np.zeros(len(v)), len(v)
    speed = np.full(n, 2.0)
    return replace(
        table,
        motion={"u": 2.0 * np.sqrt(1.0 - v**2), "v": 2.0 * v, "w": zero, "p": zero, "q": zero, "r": zero},
        speed=speed,
        forces={c: y * table.scaling.unit(c, 1025.0, speed) for c, y in primed.items()},
        usable={c: np.ones(n, bool) for c in primed},
        labels=tuple(str(i + 1) for i in range(n)),
        lines=tuple(range(3, n + 3)),
    )


@pytest.mark.slow
def test_every_corrupted_cell_of_the_demo_is_one_warning_with_the_value_without_it() -> None:
    missed, tried = [], 0
    for k, table in enumerate(demo()):
        for component in table.forces:
            least = 5.0 * scatter(table, component)
            for row in range(len(table)):
                for factor in FACTORS:
                    if abs((factor - 1.0) * table.forces[component][row]) <= least:
                        continue
                    tried += 1
                    tables = [*demo()]
                    tables[k] = with_cell(table, component, row, factor)
                    found = warnings(tuple(tables))
                    where, cell = f"{table.name} line {table.lines[row]}", f"{component} = "
                    if [c.subject for c in found] != [where] or not (
                        cell in found[0].statistic and "without it" in found[0].statistic
                    ):
                        missed.append((where, component, factor, found))
    assert tried > 140
    assert missed == []


def count_false(count: int, seed: int) -> list[tuple[str, Check]]:
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        name, table = clean_campaign(rng)
        out += [(name, c) for c in warnings((table,))[:1]]
    return out


if __name__ == "__main__":
    failed = count_false(int(sys.argv[1]), int(sys.argv[2]))
    for name, c in failed:
        sys.stdout.write(f"{name} | {c.statistic} | {c.comment}\n")
    sys.stdout.write(f"{len(failed)} of {sys.argv[1]} {Counter(n.split()[0] for n, _ in failed)}\n")
