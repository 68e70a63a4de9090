from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, MOMENTS, MOTIONS, derivative, primed

FACTORS = (*MOTIONS, *CONTROLS, *(f"{m}dot" for m in MOTIONS))
SYMBOLS = st.builds(
    lambda c, f: (c, f),
    st.sampled_from(COMPONENTS),
    st.lists(st.tuples(st.sampled_from(FACTORS), st.booleans()), max_size=5),
)


def spelled(component: str, factors: list[tuple[str, bool]]) -> str:
    return component + ("".join(f"|{f}|" if bars else f for f, bars in factors) or "0")


@given(SYMBOLS)
def test_symbols_round_trip(parts: tuple[str, list[tuple[str, bool]]]) -> None:
    component, factors = parts
    symbol = spelled(component, factors)
    for written in (symbol, symbol + "'", primed(symbol)):
        d = derivative(written)
        assert (d.component, d.factors, d.text) == (component, tuple(f for f, _ in factors), symbol)
    assert primed(primed(symbol)) == symbol + "'"


@given(SYMBOLS)
def test_powers_make_a_force_or_a_moment(parts: tuple[str, list[tuple[str, bool]]]) -> None:
    """Unit of 1/2 rho U^a L^b times the factors is that of the component, in kg, m and s."""
    component, factors = parts
    speed, length, density = powers_of(spelled(component, factors))
    kg, metre, second = density, -3 * density + speed + length, -speed
    for f, _ in factors:
        metre += 1 if f.removesuffix("dot") in LINEAR else 0
        if f not in CONTROLS:
            second -= 2 if f.endswith("dot") else 1
    assert (kg, metre, second) == (1, 2 if component in MOMENTS else 1, -2)


@pytest.mark.parametrize(
    ("symbol", "speed", "length", "unit"),
    [
        ("Yv", 1, 2, "N/(m/s)"), ("Yr", 1, 3, "N/(rad/s)"), ("Nv", 1, 3, "N*m/(m/s)"), ("Nr", 1, 4, "N*m/(rad/s)"),
        ("X0", 2, 2, "N"), ("M0", 2, 3, "N*m"), ("Yvdot", 0, 3, "N/(m/s^2)"), ("Nrdot", 0, 5, "N*m/(rad/s^2)"),
        ("Yrdot", 0, 4, "N/(rad/s^2)"), ("Nvdot", 0, 4, "N*m/(m/s^2)"), ("Ydr", 2, 2, "N/(rad)"),
        ("Ndr", 2, 3, "N*m/(rad)"), ("Xvv", 0, 2, "N/(m/s)^2"), ("Xvr", 0, 3, "N/(m/s)/(rad/s)"),
        ("Y|v|v", 0, 2, "N/(m/s)^2"), ("Yvvv", -1, 2, "N/(m/s)^3"), ("Xrr", 0, 4, "N/(rad/s)^2"),
    ],
)  # fmt: skip
def test_powers_of_conventions(symbol: str, speed: int, length: int, unit: str) -> None:
    assert powers_of(symbol) == (speed, length, 1)
    assert derivative(symbol + "'").unit == unit


@given(SYMBOLS)
def test_port_starboard_parity_by_mirroring(parts: tuple[str, list[tuple[str, bool]]]) -> None:
    """Mirror the flow: v p r dr and Y K N change sign; a factor inside bars does not."""
    component, factors = parts
    sign = -1.0 if component in "YKN" else 1.0
    for f, bars in factors:
        if f.removesuffix("dot") in ("v", "p", "r", "dr") and not bars:
            sign = -sign
    assert derivative(spelled(component, factors)).odd_in_port_starboard == (sign < 0.0)


@pytest.mark.parametrize(
    "text", ["", "'", "Y", "v", "Vy", "Yx", "Y|v", "Yv|", "Y0v", "Yv0", "Ydot", "Yd", "Yvvvvvv", "Y v", "Yv''", "Y||v"]
)
def test_no_symbols(text: str) -> None:
    with pytest.raises(InputError, match="expected a SNAME derivative such as Yv'"):
        derivative(text)


def test_near_symbols_are_named() -> None:
    with pytest.raises(InputError, match=r"Did you mean .*Yv'"):
        derivative("Yvx")
    with pytest.raises(InputError) as caught:
        derivative("Y" * 10_000)
    assert len(str(caught.value)) < 300


def test_rooms_of_symbols_do_not_overlap() -> None:
    assert set(LINEAR + ANGULAR) == set(MOTIONS)
    assert not set(MOTIONS) & set(CONTROLS)
