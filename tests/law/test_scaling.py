"""Primes, lengths and SI, held to numbers that are printed or derived elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.scaling import Conditions, Scaling

LOA, LBP = Scaling(4.356, "LOA"), Scaling(4.26086, "LBP")
# Steady-CFD column of Table 4.
TABLE_4 = {"Yv": -0.0281, "Nv": -0.0140, "Zw": -0.0150, "Mw": 0.0110, "Yr": 0.0044, "Nr": -0.0040}


def coefficients(
    values: dict[str, float | None], scaling: Scaling = LOA, point: tuple[float, ...] = (0, 0, 0)
) -> CoefficientSet:
    k = len(values)
    half = np.random.default_rng(1).normal(size=(k, k)) * 1e-4
    covariance = half @ half.T
    known = np.array([v is not None for v in values.values()])
    covariance[~known, :] = covariance[:, ~known] = np.nan
    return CoefficientSet(
        coefficients=tuple(
            Coefficient(
                s, v, None if v is None else float(2.0 * np.sqrt(covariance[i, i])),
                Status.NO_TABLE if v is None else Status.OK, "b", Parts(random=None if v is None else 1e-3),
                window=(-0.1, 0.3),
            )
            for i, (s, v) in enumerate(values.items())
        ),
        covariance=covariance,
        scaling=scaling,
        reference_point=np.array(point, dtype=float),
        datum=Datum("nose"),
        body="b",
    )  # fmt: skip


def values(s: CoefficientSet) -> dict[str, float | None]:
    return {c.symbol: c.value for c in s.coefficients}


def test_loa_read_as_lbp() -> None:
    """Errata of the paper: the same forces divided by the other length."""
    moved = values(coefficients(TABLE_4).to_length(LBP))
    expected = {"Yv": -0.02937, "Nv": -0.01496, "Zw": -0.01568, "Mw": 0.01175, "Yr": 0.00470, "Nr": -0.00437}
    assert moved == pytest.approx(expected, abs=5.1e-6)


def test_dimensional_values_at_two_metres_a_second() -> None:
    si = coefficients(TABLE_4).to_si(Conditions(1000.0, 2.0))
    expected = {"Yv": -533.2, "Nv": -1157.2, "Zw": -284.6, "Mw": 909.2, "Yr": 363.7, "Nr": -1440.2}
    assert values(si) == pytest.approx(expected, rel=1e-3)
    per_radian = {s: 2.0 * expected[s] for s in ("Yv", "Nv")}
    assert per_radian == pytest.approx({"Yv": -1066.4, "Nv": -2314.3}, rel=1e-4)
    assert [c.unit for c in si.coefficients] == [
        "N/(m/s)", "N*m/(m/s)", "N/(m/s)", "N*m/(m/s)", "N/(rad/s)", "N*m/(rad/s)",
    ]  # fmt: skip


SYMBOLS = ("X0", "Yv", "Nr", "Xvv", "Ydr", "Yvdot", "Nrdot", "Mq", "Xrr")
POSITIVE = st.floats(0.1, 1e3)


@given(POSITIVE, POSITIVE, POSITIVE, POSITIVE)
def test_round_trips(density: float, speed: float, one: float, other: float) -> None:
    a, b = Scaling(one, "a"), Scaling(other, "b")
    start = coefficients(dict.fromkeys(SYMBOLS, 0.3), a)
    for back in (
        start.to_si(Conditions(density, speed)).to_prime(),
        start.to_length(b).to_length(a),
        start.to_si(Conditions(density, speed)).to_prime(b).to_length(a),
    ):
        assert back.scaling == a
        assert back.conditions is None
        assert values(back) == pytest.approx(values(start), rel=1e-13)
        np.testing.assert_allclose(back.covariance, start.covariance, rtol=1e-12)
        for c, d in zip(back.coefficients, start.coefficients, strict=True):
            assert c.u95 == pytest.approx(d.u95, rel=1e-13)
            assert c.parts.random == pytest.approx(1e-3, rel=1e-13)
            assert c.window == pytest.approx(d.window, rel=1e-13)
            assert c.unit == "1"


def test_factors_by_hand() -> None:
    scaling, conditions = Scaling(3.0, "L"), Conditions(900.0, 5.0)
    half_rho = 450.0
    by_hand = {
        "X0": half_rho * 25 * 9, "Yv": half_rho * 5 * 9, "Yr": half_rho * 5 * 27, "Nv": half_rho * 5 * 27,
        "Nr": half_rho * 5 * 81, "Yvdot": half_rho * 27, "Nrdot": half_rho * 243, "Ydr": half_rho * 25 * 9,
    }  # fmt: skip
    for symbol, expected in by_hand.items():
        assert scaling.factor(symbol, conditions) == pytest.approx(expected, rel=1e-15), symbol


def test_intervals_stay_positive_and_rate_windows_follow_the_length() -> None:
    moved = coefficients({"Yr": 0.1, "Yv": -0.1}).to_length(LBP)
    assert all(c.u95 is not None and c.u95 > 0.0 for c in moved.coefficients)
    assert moved["Yr'"].window == pytest.approx((-0.1 * 4.26086 / 4.356, 0.3 * 4.26086 / 4.356))
    assert moved["Yv"].window == (-0.1, 0.3)


def test_mixing_is_refused() -> None:
    LBP.require(Scaling(4.26086 * (1 + 1e-12), "LBP"))
    with pytest.raises(ScalingMismatchError, match=r"LBP 4\.26086 m and by LOA 4\.356 m do not mix"):
        LBP.require(LOA)
    with pytest.raises(ScalingMismatchError):
        LBP.require(Scaling(4.26086, "LOA"))
    primed = coefficients(TABLE_4)
    si = primed.to_si(Conditions(1000.0, 2.0))
    for wrong in (primed.to_prime, lambda: si.to_length(LBP), lambda: si.to_si(Conditions(1.0, 1.0))):
        with pytest.raises(ScalingMismatchError):
            wrong()


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan")])
def test_conditions_above_zero(bad: float) -> None:
    for make in (lambda: Conditions(bad, 1.0), lambda: Conditions(1.0, bad), lambda: Conditions(1.0, 1.0, bad)):
        with pytest.raises(InputError, match="above zero"):
            make()
    with pytest.raises(InputError, match="above zero"):
        Scaling(bad, "L")


def test_lookup() -> None:
    s = coefficients(TABLE_4)
    assert "Yv'" in s
    assert "Kv" not in s
    assert s["Nr'"] is s["Nr"]
    with pytest.raises(KeyError, match="Kv"):
        s["Kv"]
