"""Results without a history are final values: a run each, and zero is a number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.histories import Convergence
from tests.tables.runs_as_text import collect

LINE = "-" * 20
ZONES = "Zone      Pressure      Viscous      Total      Pressure      Viscous      Total"


def report(file: Path, what: str, vector: tuple[float, float, float], repeated: int = 1) -> None:
    """A force report of Fluent as it prints one."""
    centre = " - Moment Center (0.3 0 0.02)" if what == "Moments" else ""
    unit = "[N m]" if what == "Moments" else "[N]"
    whole, zero = f"({vector[0]} {vector[1]} {vector[2]})", "(0 0 0)"
    row = f"{whole} {zero} {whole} {whole} {zero} {whole}"
    one = f"{what}{centre}\n      {what} {unit}        Coefficients\n{ZONES}\nhull {row}\n{LINE} {LINE}\nNet {row}\n\n"
    file.write_text('    "Force Report"\n\n' + one * repeated)


@pytest.mark.parametrize("repeated", [1, 3])
def test_reports_of_one_value_are_runs_and_zero_is_not_empty(tmp_path: Path, repeated: int) -> None:
    for a in (-4, -2, 0, 2, 4):
        report(tmp_path / f"M_a{a}", "Moments", (0.0, 0.5 * a, 0.0), repeated)
    found = collect(tmp_path, names="M_a{alpha:deg}")
    assert [r.status for r in found.runs] == [Convergence.FINAL] * 5
    np.testing.assert_allclose(np.sort(found.table.column("Moments y total").values), [-2.0, -1.0, 0.0, 1.0, 2.0])
    assert set(next(c for c in found.table.columns if c.name == "uncertain").texts) == {""}
    assert not [c for c in found.table.columns if c.name.startswith("se_")]


@pytest.mark.parametrize(("at", "status"), [(2000, Convergence.FINAL), (1, Convergence.TOO_SHORT)])
def test_one_row_of_a_late_iteration_is_a_final_value_and_the_first_is_none(
    tmp_path: Path, at: int, status: Convergence
) -> None:
    for a in (0, 4):
        head = '"Inner_Iter",    "CFx",    "CFz"\n'
        (tmp_path / f"a{a}").mkdir()
        (tmp_path / f"a{a}" / "history.csv").write_text(f"{head}{at}, 0.02, {0.1 * a}\n")
    found = collect(tmp_path, names="a{alpha:deg}")
    assert {r.status for r in found.runs} == {status}
