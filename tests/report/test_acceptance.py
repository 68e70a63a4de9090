import math

import pytest

from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable


@pytest.mark.parametrize(
    ("published", "found", "tolerance", "how", "holds"),
    [
        (2.0, 2.1, 0.11, {}, True),
        (2.0, 2.1, 0.09, {}, False),
        (2.0, None, 9.0, {}, False),
        (200.0, 201.0, 0.01, {"relative": True}, True),
        (200.0, 203.0, 0.01, {"relative": True}, False),
        (-200.0, -201.0, 0.01, {"relative": True}, True),
        (0.007, 0.0059, 0.0, {"at_most": True}, True),
        (0.007, 0.0071, 0.0, {"at_most": True}, False),
        (1.0, math.nan, 1.0, {}, False),
    ],
)
def test_agreement(published: float, found: float | None, tolerance: float, how: dict[str, bool], holds: bool) -> None:
    row = Compared("case", "q", "m", published, found, tolerance, Basis.VERIFICATION, **how)
    assert row.holds is holds
    table = ComparedTable("k", "t", (row,), "Table 1")
    assert Acceptance("n", "t", (table,), (), (), ()).holds is holds


def test_a_relative_difference_of_zero_is_absolute() -> None:
    assert Compared("case", "q", "deg", 0.0, 1e-4, 1e-3, Basis.VERIFICATION, relative=True).difference == 1e-4
