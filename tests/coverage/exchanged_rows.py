"""Exchanged rows: how many of 54 swaps the data gate names, and how many clean campaigns it warns of.

``python -m tests.coverage.exchanged_rows`` writes ``tests/coverage/exchanged_table.csv``. Swaps: six one-sided sweeps of 5 to 9 settings, two
shipped ones and four simulated, neighbours and next neighbours. Clean: campaigns of `tests.study.test_data_gate` and short one-sided sweeps.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.provenance import Source
from coeflab.core.table import Check
from coeflab.fits.slope_at_origin import fit
from coeflab.fits.uncertainty.budget import budgets_of, open_parts
from coeflab.study.checks.data_gate import findings
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.coverage.slope_campaigns import FAMILIES
from tests.study.test_data_gate import clean_campaign, table_of

TABLE = Path(__file__).with_name("exchanged_table.csv")
NOISE = (0.01, 0.003, 0.001, 0.0001)
CLEAN, SEED = 200, 2026


def swapped(table: ForceTable, a: int, b: int) -> ForceTable:
    """Forces of two rows, errors and all, in each other's place."""
    turn = np.arange(len(table))
    turn[[a, b]] = b, a
    return replace(
        table, forces={c: f[turn] for c, f in table.forces.items()}, errors={c: e[turn] for c, e in table.errors.items()},
        usable={c: u[turn] for c, u in table.usable.items()},
    )  # fmt: skip


def with_grids(table: ForceTable, rng: np.random.Generator, noise: float) -> ForceTable:
    """A computation with two coarser grids at a setting in the middle, errors of second order, scatter as of the sweep."""
    at, n = len(table) // 2, len(table)
    turn = np.array([*range(n), at, at])
    size = np.array([2.0, 4.0])
    forces = {}
    for c, f in table.forces.items():
        coarse = f[at] * (1.0 + 0.02 * size**2) + noise * np.abs(f).max() * rng.standard_normal(2)
        forces[c] = np.append(f, coarse)
    used = np.arange(n + 2) < n
    return replace(
        table, motion={m: v[turn] for m, v in table.motion.items()}, speed=table.speed[turn], forces=forces,
        usable=dict.fromkeys(forces, used), labels=tuple(str(i + 1) for i in range(n + 2)), lines=tuple(range(3, n + 5)),
        cells=np.append(np.full(n, 8e6), 8e6 / size**3), source=Source("solver", kind="cfd"),
    )  # fmt: skip


def short_sweep(rng: np.random.Generator, noise: float | None = None) -> ForceTable:
    """X, Y and N of two families over 5 to 9 settings from rest to 6 to 20 degrees, one side."""
    n, reach = int(rng.integers(5, 10)), float(np.sin(np.radians(rng.uniform(6.0, 20.0))))
    v = np.linspace(0.0, reach, n)
    first, second = rng.choice(list(FAMILIES), 2)
    scatter = float(rng.choice(NOISE)) if noise is None else noise
    primed = {"X": -0.0025 + 0.006 * v**2, "Y": FAMILIES[first].curve(v), "N": 0.4 * FAMILIES[second].curve(v)}
    table = table_of(v, {c: y + scatter * np.abs(y).max() * rng.standard_normal(n) for c, y in primed.items()})
    return with_grids(table, rng, scatter)


def campaigns() -> Iterator[tuple[str, ForceTable, list[int]]]:
    """Name, table and rows in the order of their settings."""
    for t in read_tables(PlannedTable(shipped("cfd_data") / "suboff_cfd_barehull", (), {})):
        used = np.flatnonzero(t.usable["Y"])
        yield t.name, t, [int(i) for i in used[np.argsort(t.motion[t.varies[-1]][used])]]
    rng = np.random.default_rng(SEED)
    for noise in NOISE:
        t = short_sweep(rng, noise)
        yield f"simulated, noise {noise:g}", t, list(range(len(t) - 2))


def pairs(rows: list[int]) -> list[tuple[int, int]]:
    """Neighbours, then rows two settings apart."""
    return [*pairwise(rows), *zip(rows, rows[2:], strict=False)]


def warned(tables: list[ForceTable]) -> list[Check]:
    """Warnings of the gate on a campaign."""
    return [c for c in findings(tables, tables[0].scaling.length) if c.severity is Severity.WARN]


def names_both(table: ForceTable, pair: tuple[int, int], found: list[Check]) -> bool:
    """Whether the warnings name both rows."""
    said = " ".join(c.subject.partition(table.name)[2] for c in found).replace(",", " ").split()
    names = [str(table.lines[i]) if table.lines else table.labels[i] for i in pair]
    return all(name in said for name in names)


def clean(count: int, seed: int, short: bool) -> Iterator[tuple[str, list[str]]]:
    """Warnings of clean campaigns, one by one: of the gate, and of the budgets of the slopes."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        name, table = ("short", short_sweep(rng)) if short else clean_campaign(rng)
        budgets = budgets_of(fit([table], table.scaling, {}), {table.name: table}) if short else ()
        of_budgets = [f"{f.code} {f.subject}" for f in open_parts(budgets) if f.severity is Severity.WARN]
        yield name, [*(f"{_kind(c)} {c.subject} | {c.statistic}" for c in warned([table])), *of_budgets]


def _kind(c: Check) -> str:
    """The code of a new warning; ``reading`` of those on single readings, whose rate docs/data_gate.md has."""
    new = {"in each other's place": "data_gate.exchanged_rows", "of other grids": "data_gate.grid_rows_elsewhere"}
    return next((code for words, code in new.items() if words in c.statistic), "reading")


def main() -> None:
    """Measure, and write the table."""
    rows, tried, hit = ["campaign,what,tried,found"], 0, 0
    for name, table, order in campaigns():
        for what, chosen in (
            ("neighbours", pairs(order)[: len(order) - 1]),
            ("two apart", pairs(order)[len(order) - 1 :]),
        ):
            found = sum(names_both(table, p, warned([swapped(table, *p)])) for p in chosen)
            rows.append(f'"{name}",{what} exchanged: both rows named,{len(chosen)},{found}')
            tried, hit = tried + len(chosen), hit + found
    rows.append(f"all,exchanged: both rows named,{tried},{hit}")
    for short in (False, True):
        every = list(clean(CLEAN, SEED, short))
        name = "short one-sided sweeps with a grid study" if short else "sweeps of every design"
        single = sum(any(w.startswith("reading") for w in found) for _, found in every)
        new = sum(any(not w.startswith("reading") for w in found) for _, found in every)
        rows += [
            f"{name},clean: a reading warned of,{CLEAN},{single}",
            f"{name},clean: any other warning,{CLEAN},{new}",
        ]
        for which, found in every:
            sys.stderr.writelines(f"{which} | {w}\n" for w in found)
    TABLE.write_text("\n".join(rows) + "\n", encoding="utf-8")
    sys.stdout.write(TABLE.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
