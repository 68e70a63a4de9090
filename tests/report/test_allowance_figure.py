"""Numbers of a publication as marks: where each stands, and that every one is there."""

from __future__ import annotations

import math

import pytest

from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.sections.acceptance import allowance_figure, share


def shown(*rows: Compared):
    return allowance_figure(Acceptance("b", "B", (ComparedTable("t", "T", rows, "Table 1"),), (), (), ()), "a")


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        (Compared("c", "u", "m/s", 2.0, 2.05, 0.1, Basis.VERIFICATION), 0.5),
        (Compared("c", "u", "m/s", 2.0, 1.9, 0.1, Basis.VERIFICATION), -1.0),
        (Compared("c", "u", "m/s", 2.0, 1.9, 0.1, Basis.VERIFICATION, relative=True), -0.5),
        (Compared("c", "rms", "1", 0.5, 0.1, 0.0, Basis.VERIFICATION, at_most=True), 0.2),
        (Compared("c", "rms", "1", 0.5, 0.3, 0.2, Basis.VERIFICATION, relative=True, at_most=True), 0.5),
        (Compared("c", "n", "1", 3.0, 3.0, 0.0, Basis.VERIFICATION), 0.0),
        (Compared("c", "n", "1", 3.0, 2.0, 0.0, Basis.VERIFICATION), -math.inf),
    ],
)
def test_a_mark_stands_at_its_share_of_the_allowance(row: Compared, expected: float) -> None:
    assert share(row) == pytest.approx(expected)


def test_what_holds_lies_within_and_what_does_not_is_marked_outside() -> None:
    figure = shown(
        Compared("1", "u", "m/s", 2.0, 2.05, 0.1, Basis.VERIFICATION), Compared("2", "u", "m/s", 2.0, 3.0, 0.1, Basis.VERIFICATION),
        Compared("3", "u", "m/s", 2.0, None, 0.1, Basis.VERIFICATION), Compared("4", "u", "m/s", 2.0, 2.02, 0.1, Basis.CALIBRATION),
        Compared("5", "u", "m/s", 2.0, 2.11, 0.1, Basis.VERIFICATION),
    )  # fmt: skip
    series = {s.name: s for s in figure.panels[0].series}
    assert figure.title == "2 of 5 comparisons within the tolerance"
    assert series["verification"].x == pytest.approx((0.5,))
    assert series["calibration"].x == pytest.approx((0.2,))
    # Ten times the allowance and no number at all stand at the edge, where their places are no values to tell.
    assert series["outside"].x == pytest.approx((1.1,))
    assert series["outside"].y == (5.0,)
    assert "found 2.11" in series["outside"].notes[0]
    assert 'data-series="outside"' in figure.svg


def test_every_number_is_one_mark() -> None:
    rows = tuple(Compared(str(i), "u", "1", 1.0, 1.0 + 0.001 * i, 0.1, Basis.VERIFICATION) for i in range(101))
    (panel,) = shown(*rows).panels
    assert sum(len(s.x) for s in panel.series) == 101
    assert {n.split(",")[0] for s in panel.series for n in s.notes} == {str(i) for i in range(101)}


def test_equal_results_give_equal_bytes() -> None:
    row = Compared("1", "u", "m/s", 2.0, 2.05, 0.1, Basis.VERIFICATION)
    assert shown(row) == shown(row)
