"""X0' of one Reynolds number in a file of another speed says so."""

from __future__ import annotations

from dataclasses import replace
from math import log10

import pytest

from coeflab.core.finding import Severity
from coeflab.core.texts import remark
from coeflab.study.study import Study
from coeflab.vehicle.drag_reynolds import drag_elsewhere


def test_the_computed_drag_of_suboff_is_of_another_speed(suboff: Study) -> None:
    """ITTC 1957 by hand: 0.075/(log10 Re - 2)^2."""
    (found,) = (
        f for f in suboff.parameter_files["suboff_bare_hull_cfd"].findings if f.code == "law.drag_of_another_reynolds"
    )
    (table, *_) = (t for t in suboff.tables if t.campaign == "suboff_cfd_barehull")
    measured = 2.0 * 13.9792 * 0.3048 / 1e-6  # 2 m/s on LBP
    ahead = measured * 6.5 * 1852.0 / 3600.0 / float(table.speed[0])
    by_hand = ((log10(measured) - 2.0) / (log10(ahead) - 2.0)) ** 2 - 1.0
    assert (found.severity, found["measured"]) == (Severity.NOTE, pytest.approx(measured))
    assert found["here"] == pytest.approx(ahead, rel=1e-6)
    assert found.statistic == pytest.approx(by_hand, rel=1e-4)
    assert -0.12 < by_hand < -0.05
    assert "same water" in remark(found)


def test_drag_at_its_own_speed_says_nothing(suboff: Study) -> None:
    file = suboff.parameter_files["suboff_fully_appended"]
    assert not [f for f in file.findings if f.code == "law.drag_of_another_reynolds"]
    (table, *_) = (t for t in suboff.tables if t.campaign == "suboff_roddy_2")
    slow = replace(file.conditions, speed=file.conditions.speed / 3.0)
    drag = [c for c in file.coefficients if c.symbol == "X0'"]
    assert [c.campaign for c in drag] == [table.campaign]
    (found,) = drag_elsewhere(drag, [table], slow, file.scaling.length)
    assert found.statistic > 0.15  # a third of the speed has more friction
