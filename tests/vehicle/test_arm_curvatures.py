"""What the ideal fluid adds by v r is taken off Xrr of runs that drift by one ratio to their rate."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.core.finding import Finding, Severity
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.vehicle.arm_curvatures import less_ideal_products

SCALING = Scaling(2.0, "LOA")
SWAY = 50.0  # kg: X gains + m22 v r, primed by rho L^3 / 2


def found(ratio: float) -> Finding:
    return Finding.of(
        "law.one_ratio", "arm Xrr'", Severity.NOTE, statistic=ratio, by="zero", symbol="Xrr", product="Xvr'", taken=0.0
    )


def coefficient(symbol: str, value: float) -> Coefficient:
    return Coefficient(symbol, value, 0.1, Status.FORM_ASSUMED, "auv", origin="fit")


@pytest.mark.parametrize("stated", [False, True])
def test_the_share_of_the_ideal_fluid_is_taken_off_unless_the_product_is_stated(stated: bool) -> None:
    hull = SimpleNamespace(matrix=np.diag([1.0, SWAY, SWAY, 0.0, 5.0, 5.0]), density=1000.0)
    every = [coefficient("Xrr", 0.001), *([coefficient("Xvr", 0.01)] if stated else [])]
    less, said = less_ideal_products(every, [found(-0.1)], hull, SCALING)  # type: ignore[arg-type]
    prime = SWAY / (0.5 * 1000.0 * 2.0**3)
    assert less[0].value == pytest.approx(0.001 if stated else 0.001 + 0.1 * prime)
    assert said[0]["by"] == ("zero" if stated else "ideal")
    assert said[0]["taken"] == pytest.approx(0.0 if stated else prime)


def test_without_added_mass_nothing_moves() -> None:
    every = [coefficient("Xrr", 0.001)]
    assert less_ideal_products(every, [found(-0.1)], None, SCALING) == (every, [found(-0.1)])
