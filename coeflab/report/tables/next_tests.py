"""Tests that would narrow a figure, and the settings of their runs, as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, plus_minus, with_u95
from coeflab.core.texts import remark
from coeflab.law.symbols import ANGULAR
from coeflab.report.texts import table_of

if TYPE_CHECKING:
    from coeflab.study.next_tests import NextTests, ProposedTest


def tables(found: NextTests) -> tuple[Table, ...]:
    """The tests, best first, and their runs."""
    ranked = [
        (
            str(t.kind), ", ".join(t.symbols), f"{100.0 * t.share:.0f} %",
            *((with_u95(found.value, t.wanted_then)[1], f"{100.0 * t.wanted_then / found.u95:.0f} %") if t.variable else (ABSENT, ABSENT)),
        )
        for t in found.tests
    ]  # fmt: skip
    tests = table_of("next_tests.tables_1", ranked, tuple(map(remark, found.findings)), wanted=found.wanted, value=plus_minus(found.value, found.u95))  # fmt: skip
    rows = [
        (_settings(t) if k == 0 else "", s, with_u95(found.value, before)[1], with_u95(found.value, then)[1], f"{100.0 * then / equal:.0f} %")
        for t in found.tests
        if t.variable
        for k, (s, (before, then), equal) in enumerate(zip(t.symbols, t.u95, t.equal, strict=True))
    ]  # fmt: skip
    if not rows:
        return (tests,)
    return tests, table_of("next_tests.tables_2", rows)


def _settings(test: ProposedTest) -> str:
    unit, values = (f"{test.variable}'", test.angles) if test.variable in ANGULAR else ("deg", np.degrees(test.angles))
    known: dict[str, int] = {}
    for x in values:
        text = f"{x:+.3g}" if x else "0"
        known[text] = known.get(text, 0) + 1
    each = " ".join(text if many == 1 else f"{many}x{text}" for text, many in known.items())
    return f"{test.kind}: {each} {unit}"
