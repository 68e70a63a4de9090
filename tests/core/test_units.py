from __future__ import annotations

import math
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError, UnitsError
from coeflab.core.units import SI, factor, parse_header, quantity

EXACT = [
    ("ft", "length", 0.3048),
    ("in", "length", 0.0254),
    ("mm", "length", 1e-3),
    ("nmi", "length", 1852.0),
    ("kn", "speed", 1852.0 / 3600.0),
    ("kt", "speed", 1852.0 / 3600.0),
    ("knot", "speed", 1852.0 / 3600.0),
    ("km/h", "speed", 1.0 / 3.6),
    ("ft/s", "speed", 0.3048),
    ("deg", "angle", math.pi / 180.0),
    ("°", "angle", math.pi / 180.0),
    ("rad", "angle", 1.0),
    ("deg/s", "rate", math.pi / 180.0),
    ("rpm", "rate", math.pi / 30.0),
    ("rad s^-1", "rate", 1.0),
    ("lbf", "force", 4.4482216152605),
    ("kN", "force", 1e3),
    ("kgf", "force", 9.80665),
    ("ft*lbf", "moment", 0.3048 * 4.4482216152605),
    ("ft-lbf", "moment", 0.3048 * 4.4482216152605),
    ("Nm", "moment", 1.0),
    ("N·m", "moment", 1.0),
    ("lb/ft^3", "density", 0.45359237 / 0.3048**3),
    ("g/cm**3", "density", 1e3),
    ("m^2/s", "viscosity", 1.0),
    ("cSt", "viscosity", 1e-6),
    ("lb", "mass", 0.45359237),
    ("kg*m^2", "inertia", 1.0),
    ("ft^3", "volume", 0.3048**3),
    ("ft^2", "area", 0.3048**2),
    ("-", "none", 1.0),
    ("", "none", 1.0),
    ("percent", "none", 0.01),
    ("kg/m3", "density", 1.0),
    ("kg m-3", "density", 1.0),
    ("g/cm3", "density", 1e3),
    ("m2", "area", 1.0),
    ("m²", "area", 1.0),
    ("ft2", "area", 0.3048**2),
    ("m/s2", "acceleration", 1.0),
    ("m2/s", "viscosity", 1.0),
    ("rad s-1", "rate", 1.0),
    ("deg.s⁻¹", "rate", math.pi / 180.0),
    ("N.m", "moment", 1.0),
    ("kN.m", "moment", 1e3),
    *[
        (f"kN{between}m", "moment", 1e3)
        for between in ("", " ", "-", " - ", "_", "*", "·", "⋅", "•", "∙", "×", " x ", "\u2010", "\u2011")
    ],
    *[(f"N{between}m", "moment", 1.0) for between in (" ", "-", "_", "*", "×")],
    ("MNm", "moment", 1e6),
    ("MN-m", "moment", 1e6),
    ("Nmm", "moment", 1e-3),
    ("N-mm", "moment", 1e-3),
    ("lbf-ft", "moment", 0.3048 * 4.4482216152605),
    ("lbf.ft", "moment", 0.3048 * 4.4482216152605),
    ("lbf-in", "moment", 0.0254 * 4.4482216152605),
    ("in-lbf", "moment", 0.0254 * 4.4482216152605),
    ("kgf-m", "moment", 9.80665),
    ("kg.m2", "inertia", 1.0),
]


@pytest.mark.parametrize(("unit", "dimension", "expected"), EXACT)
def test_factors(unit: str, dimension: str, expected: float) -> None:
    assert factor(unit, dimension) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("unit", "dimension"),
    [
        ("-", "angle"), ("", "angle"), ("deg", "none"), ("rad", "none"), ("1/s", "rate"), ("rev", "none"),
        ("N*m/rad", "moment"), ("N/rad", "force"), ("rad*m/s", "speed"), ("sr", "angle"), ("rad^2", "angle"),
        ("kn", "force"), ("kN", "speed"), ("degC", "length"), ("N", "moment"), ("dB", "none"), ("m**0", "none"), ("m0", "none"), ("N2", "force"), ("m-", "length"), ("kN-s", "moment"), ("kNxm", "moment"), ("N--m", "moment"), ("m9", "volume"),
    ],
)  # fmt: skip
def test_refused(unit: str, dimension: str) -> None:
    with pytest.raises(UnitsError, match=r"expected (a unit of|\[-\])"):
        factor(unit, dimension)


@pytest.mark.parametrize("dimension", SI)
def test_si_units_are_themselves(dimension: str) -> None:
    assert factor(SI[dimension], dimension) == 1.0


@pytest.mark.parametrize(
    ("unit", "dimension", "meant"),
    [("MM", "length", "mm"), ("DEG", "angle", "deg"), ("KG", "length", ""), ("zz", "length", "")],
)
def test_capitals_count(unit: str, dimension: str, meant: str) -> None:
    with pytest.raises(UnitsError) as why:
        factor(unit, dimension)
    assert why.value.advice == (f"Did you mean {meant}? Capitals count." if meant else "")


@settings(max_examples=300, deadline=2000)
@given(st.text(alphabet="Nmkgsradeft*/^()-1290 ._·°'\"[]\\;µ", max_size=60), st.sampled_from(sorted(SI)))
def test_any_text_gives_a_factor_or_one_error(unit: str, dimension: str) -> None:
    message = ""
    try:
        value = factor(unit, dimension)
    except UnitsError as why:
        value, message = 1.0, str(why)
    assert "\n" not in message
    assert len(message) < 300
    assert 0.0 < value < math.inf


UNITS = [(unit, dimension) for unit, dimension, _ in EXACT if unit]


@given(st.floats(-1e12, 1e12), st.sampled_from(UNITS))
def test_texts_of_toml_round_trip(number: float, written: tuple[str, str]) -> None:
    unit, dimension = written
    si = quantity(f"{number!r} {unit}" if unit != "-" else number, dimension)
    assert si == pytest.approx(number * factor(unit, dimension), rel=1e-15)
    assert quantity(si, dimension) == si


NAMES = st.from_regex(r"[A-Za-z_][A-Za-z0-9_|]{0,12}'?", fullmatch=True)


@given(NAMES, st.sampled_from([u for u, _ in UNITS]), st.sampled_from(["", " ", "  ", "\t"]))
def test_headers_round_trip(name: str, unit: str, gap: str) -> None:
    header = parse_header(f" {name}{gap}[{gap}{unit}{gap}]{gap}")
    assert (header.name, header.unit) == (name, unit)
    assert parse_header(name).unit is None


@pytest.mark.parametrize("text", ["Y [N] [N]", "Y N]", "[N]", "Y [[N]]", "Y [N]x"])
def test_odd_brackets_are_no_unit(text: str) -> None:
    header = parse_header(text)
    assert (header.name, header.unit) == (text, None)


@pytest.mark.parametrize("value", [True, None, [1.0], {}, "", "ft", "1e", "1 2 ft", "nan", math.nan, math.inf, 10**400])
def test_values_that_are_no_quantity(value: object) -> None:
    with pytest.raises(InputError, match=re.escape('a.toml, "k": found')) as caught:
        quantity(value, "length", file="a.toml", key="k")
    assert "expected a" in str(caught.value)
