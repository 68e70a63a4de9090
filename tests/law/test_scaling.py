"""Primes, lengths and SI, held to numbers that are printed or derived elsewhere."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.scaling import Conditions, Scaling
from tests.sources import PACKAGE, nodes

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


# rho = 900 kg/m^3, U = 5 m/s, L = 3 m: 1/2 rho = 450 kg/m^3, in N, m, s, kg and rad.
UNITS_BY_HAND = {
    "X": 101250.0, "Y": 101250.0, "Z": 101250.0, "K": 303750.0, "M": 303750.0, "N": 303750.0,
    "X0": 101250.0, "Xuu": 4050.0, "Yv": 20250.0, "Zw": 20250.0, "Yr": 60750.0, "Nv": 60750.0, "Nr": 182250.0,
    "Kp": 182250.0, "Xvv": 4050.0, "Y|v|v": 4050.0, "Xvr": 12150.0, "Xrr": 36450.0, "Nr|r|": 109350.0,
    "Nvvr": 7290.0, "Yvvv": 810.0, "Nvvv": 2430.0, "Nrrr": 65610.0, "Ydr": 101250.0, "Nds": 303750.0, "Xdrdr": 101250.0,
    "Yvdr": 20250.0, "Yvdot": 12150.0, "Yrdot": 36450.0, "Nvdot": 36450.0, "Nrdot": 109350.0, "Kpdot": 109350.0,
    "u": 5.0, "v": 5.0, "w": 5.0, "p": 5.0 / 3.0, "q": 5.0 / 3.0, "r": 5.0 / 3.0, "vdot": 25.0 / 3.0, "rdot": 25.0 / 9.0,
    "dr": 1.0, "ds": 1.0, "db": 1.0, "m": 12150.0, "I": 109350.0, "Iy": 109350.0, "Ixy": 109350.0,
}  # fmt: skip


@pytest.mark.parametrize("symbol", UNITS_BY_HAND)
def test_units_by_hand(symbol: str) -> None:
    scaling = Scaling(3.0, "L")
    for spelled in (symbol, f"{symbol}'"):
        assert scaling.unit(spelled, 900.0, 5.0) == pytest.approx(UNITS_BY_HAND[symbol], rel=1e-15)
    assert type(scaling.unit(symbol, 900.0, 5.0)) is float


def test_unit_without_a_speed_is_that_of_the_product_of_velocities() -> None:
    """1/2 rho L^b, whatever the power of U: Y = 1/2 rho L^2 Yv' v U, N = 1/2 rho L^4 Nr' r U."""
    scaling = Scaling(3.0, "L")
    by_hand = {
        "X0": 4050.0,
        "Yv": 4050.0,
        "Yvvv": 4050.0,
        "Nr": 36450.0,
        "Nrrr": 328050.0,
        "Yvdot": 12150.0,
        "m": 12150.0,
    }
    assert {s: scaling.unit(s, 900.0) for s in by_hand} == by_hand


def test_unit_at_many_speeds() -> None:
    scaling, speed = Scaling(3.0, "L"), np.array([0.5, 1.0, 5.0])
    for symbol in UNITS_BY_HAND:
        each = [scaling.unit(symbol, 900.0, float(u)) for u in speed]
        np.testing.assert_array_equal(scaling.unit(symbol, 900.0, speed) * np.ones(3), each, symbol)


def test_unit_balances_the_equation_of_motion() -> None:
    """m vdot is a force and I rdot a moment; so are Yvdot vdot, Yv v and Nr r."""
    scaling = Scaling(3.7, "L")
    unit = {s: scaling.unit(s, 1025.0, 2.3) for s in UNITS_BY_HAND}
    for force in (
        unit["m"] * unit["vdot"],
        unit["Yvdot"] * unit["vdot"],
        unit["Yv"] * unit["v"],
        unit["Yr"] * unit["r"],
    ):
        assert force == pytest.approx(unit["Y"], rel=1e-14)
    for moment in (
        unit["I"] * unit["rdot"],
        unit["Nrdot"] * unit["rdot"],
        unit["Nr"] * unit["r"],
        unit["m"] * 3.7 * unit["vdot"],
    ):
        assert moment == pytest.approx(unit["N"], rel=1e-14)


@pytest.mark.parametrize("symbol", ["", "0", "mass", "Q", "Yx", "y", "C_D"])
def test_no_unit_of_what_is_no_symbol(symbol: str) -> None:
    with pytest.raises(InputError, match="SNAME derivative"):
        Scaling(3.0, "L").unit(symbol, 900.0)


# Products of density, one half and a power of a length that are no unit of the prime system: lines, reason.
NO_PRIMES = {
    "vehicle/criteria.py": (1, "half rho L^3 of a righting moment, which no SNAME symbol has"),
    "tables/low_aspect.py": (1, "forces of a table that is not read yet: its columns, before there is a Scaling"),
    "tables/mapping.py": (1, "dynamic pressure on the reference area that a person states for a coefficient"),
    "tables/openfoam_forces.py": (1, "dynamic pressure on the Aref that forceCoeffs states, at its magUInf"),
    "law/scaling.py": (1, "the unit itself"),
    "bodies/closed_forms/ellipsoid.py": (1, "a closed form of a body alone, printed in primes"),
    "tank/solvers/openfoam.py": (1, "a bound on forces beyond which a run has diverged"),
    "fits/rows/regression.py": (
        1,
        "dynamic pressure on the reference area of a coefficient: frontal, wetted or a wing's",
    ),
    "estimates/propeller.py": (1, "side area of a propeller in oblique flow, m^2"),
    "estimates/unseen.py": (1, "dynamic pressure on an area that no method sees"),
    "bodies/hull_flow.py": (1, "dynamic pressure on a wetted surface, a frontal or base area"),
    "estimates/crossflow.py": (2, "dynamic pressure on strips of a hull"),
    "estimates/bluff.py": (1, "dynamic pressure on projected areas"),
    "estimates/fins.py": (2, "dynamic pressure on a fin's area"),
    "estimates/ring_wing.py": (1, "dynamic pressure on a ring wing's area"),
    "vehicle/sizes.py": (2, "half rho s^2, s the cube root of the displaced volume: sizes judged without a length"),
    "vehicle/force_law.py": (1, "dynamic pressure on the reference area of a fitted table"),
    "fits/uncertainty/input_parts.py": (1, "relative errors of density, speed and length: factors near one"),
    "formats/mss/m_file.py": (
        1,
        "recognises r2 = rho L^2 / 2 of a foreign file in the units of that file, slug and foot too",
    ),
    "formats/stonefish/drags.py": (2, "form drag of Stonefish, on the panels of its mesh"),
    "formats/holoocean/torpedo.py": (2, "dynamic pressure of HoloOcean's drag law, on its own area"),
    "formats/holoocean/write.py": (1, "the same, where a given drag is turned into it"),
    "arm/compiled.py": (1, "dynamic pressure on the drag area of a vehicle"),
    "arm/kane.py": (1, "dynamic pressure on the drag area of a vehicle"),
    "arm/thrusters.py": (1, "dynamic pressure on the area of a propeller's blades"),
    "published/huuv/five_dof.py": (1, "dynamic pressure on the reference area of the paper's coefficients"),
    "published/huuv/five_dof_file.py": (1, "the same, of the elevators in the parameter file"),
    "published/urv/acceptance.py": (3, "dynamic pressure on a drag area, as printed and as corrected"),
    "published/urv/model.py": (1, "drag of a strip, written apart from the kernel"),
    "published/urv/theory.py": (3, "drag in closed form, dynamic pressure on areas"),
}


def _parts(node: ast.expr) -> Iterator[ast.expr]:
    """What a product or quotient is made of."""
    if isinstance(node, ast.UnaryOp):
        yield from _parts(node.operand)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        yield from _parts(node.left)
        yield from _parts(node.right)
    else:
        yield node


def _word(node: ast.expr) -> str:
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
        return str(node.slice.value)
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def hand_written(within: Iterable[ast.AST]) -> list[int]:
    """Lines of products that hold two of: a density, one half, a power of a length."""
    found = set()
    for node in within:
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
            parts = list(_parts(node))
            density = any(_word(p).lower() in {"density", "rho", "water", "water_density"} for p in parts)
            half = any(isinstance(p, ast.Constant) and p.value in {0.5, 2} for p in parts)
            powers = [p for p in parts if isinstance(p, ast.BinOp) and isinstance(p.op, ast.Pow)]
            length = any(_word(p.left).lower() in {"length", "l"} for p in powers)
            if density + half + length > 1:
                found.add(node.lineno)
    return sorted(found)


def test_no_prime_factor_is_written_by_hand() -> None:
    """`Scaling.unit` is the only place that says 1/2 rho U^a L^b."""
    found = {p.relative_to(PACKAGE).as_posix(): hand_written(within) for p, within in nodes().items()}
    known = {name: lines for name, lines in found.items() if name in NO_PRIMES}
    new = {name: lines for name, lines in found.items() if lines and name not in NO_PRIMES}
    assert not new, "use Scaling.unit, or say in NO_PRIMES why it is no unit of the prime system"
    here = {
        name: n for name, (n, _) in NO_PRIMES.items() if (PACKAGE / name).parent.exists()
    }  # the core may stand alone
    assert {name: len(lines) for name, lines in known.items()} == here


@pytest.mark.parametrize(
    "line",
    [
        "0.5 * at.density * s.scaling.length**3", "half = 0.5 * conditions.density", "q = rho * U**2 / 2.0 * L**2",
        "-value / (0.5 * density * length ** d.powers[1])", "volume / (0.5 * file.scaling.length**3)",
        'pressure = 0.5 * chosen["density"] * chosen["length"] ** 2', "c.value * 0.5 * density * length ** d.powers[1]",
    ],
)  # fmt: skip
def test_hand_written_factors_are_found(line: str) -> None:
    assert hand_written(ast.walk(ast.parse(line))) == [1]
    assert hand_written(ast.walk(ast.parse("unit = scaling.unit(symbol, density) * length / 2.0"))) == []


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
