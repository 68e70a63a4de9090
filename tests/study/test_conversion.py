"""Roddy's configuration 2 in pounds and feet about another point: every conversion to primes must give his primes back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.types import Array
from coeflab.law import transforms
from coeflab.law.scaling import Scaling
from coeflab.study.checks.conversion import WITHIN, differences
from coeflab.study.plan import read_plan
from coeflab.study.run import conversions, settled
from coeflab.study.study import Conversion, PlannedConversion
from coeflab.tables import force_table, reading
from coeflab.tables.reading import table_at

PLAN = read_plan(shipped("cfd_data") / "suboff" / "plan.toml")


def pair() -> Conversion:
    tables = [settled(t, PLAN) for t in reading.read_tables(table_at(shipped("cfd_data") / "suboff_roddy_2"))]
    (found,) = conversions(PLAN.conversions[0], PLAN, tables)
    return found


def failed(found: Conversion) -> set[str]:
    return {f.subject.split()[-1] for f in differences(found) if f.severity is Severity.FAIL}


def test_the_copy_gives_the_primes_of_the_original() -> None:
    found = list(differences(pair()))
    assert {f.subject.split()[-1] for f in found} >= {"X'", "Y'", "Z'", "K'", "M'", "N'", "v'", "dr'"}
    assert all(f.severity is Severity.PASS and f.statistic is not None and f.statistic < WITHIN for f in found)


def test_moments_over_the_square_of_the_length_are_noticed() -> None:
    unit = Scaling.unit

    def wrong(self: Scaling, symbol: str, density: float | Array, speed: float | Array) -> float | Array:
        return unit(self, symbol, density, speed) / (self.length if symbol[0] in "KMN" else 1.0)

    with patch.object(Scaling, "unit", wrong):
        assert failed(pair()) == {"K'", "M'", "N'"}


@pytest.mark.parametrize("sign", [-1.0, 0.0, 1.05])
def test_a_wrong_lever_of_moments_is_noticed(sign: float) -> None:
    right: Callable[[Array], Array] = transforms.force_transfer
    with patch.object(force_table, "force_transfer", lambda shift: right(sign * np.asarray(shift))):
        assert failed(pair()) == {"K'", "M'", "N'"}


def test_a_wrong_axis_or_density_is_noticed() -> None:
    good = pair()
    turned = {c: -v if c in "YN" else v for c, v in good.copy.forces.items()}
    assert failed(Conversion(replace(good.copy, forces=turned), good.original)) == {"Y'", "N'"}
    denser = replace(good.copy, conditions=replace(good.copy.conditions, density=998.0))
    assert failed(Conversion(denser, good.original)) == {f"{c}'" for c in "XYZKMN"}


def test_a_copy_of_no_campaign_of_the_plan_is_refused() -> None:
    with pytest.raises(InputError, match="suboff_roddy_9"):
        list(conversions(PlannedConversion(PLAN.conversions[0].campaign, "suboff_roddy_9"), PLAN, []))
