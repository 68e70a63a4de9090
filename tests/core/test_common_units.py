"""Factors that stand in a table are those of the units library, bit by bit."""

from __future__ import annotations

import pytest

from coeflab.core import units


@pytest.mark.parametrize("dimension", units.SI)
def test_common_units_are_the_librarys(dimension: str, monkeypatch: pytest.MonkeyPatch) -> None:
    common = units._COMMON.get(dimension, {})
    monkeypatch.setattr(units, "_COMMON", {})
    assert {unit: units.factor.__wrapped__(unit, dimension) for unit in common} == common
