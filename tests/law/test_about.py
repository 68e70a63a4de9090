"""Change of the reference point, of sets and of tables, against formulas and brute force."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.axes import Datum
from coeflab.law.coefficient import CoefficientSet, Status
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.tables.force_table import ForceTable
from tests.law.test_scaling import coefficients, values

HORIZONTAL = {"Yv": -0.03, "Yr": 0.005, "Nv": -0.014, "Nr": -0.0045, "Ydr": 0.006, "Ndr": -0.002}
UNIT = Scaling(1.0, "L")


@given(st.floats(-3.0, 3.0).filter(lambda x: abs(x) > 1e-6))
def test_formulas_of_conventions(dx: float) -> None:
    moved = coefficients(HORIZONTAL, UNIT).about(np.array([dx, 0.0, 0.0]))
    yv, yr, nv, nr = (HORIZONTAL[s] for s in ("Yv", "Yr", "Nv", "Nr"))
    expected = {
        "Yv": yv, "Nv": nv - dx * yv, "Yr": yr - dx * yv, "Nr": nr - dx * (nv + yr) + dx**2 * yv,
        "Ydr": 0.006, "Ndr": -0.002 - dx * 0.006,
    }  # fmt: skip
    assert values(moved) == pytest.approx(expected, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("dot", ["", "dot"])
def test_all_thirty_six_by_brute_force(dot: str) -> None:
    rng = np.random.default_rng(5)
    d, shift = rng.normal(size=(6, 6)), np.array([0.7, -0.3, 0.2])
    names = {c + m + dot: float(d[i, j]) for i, c in enumerate(COMPONENTS) for j, m in enumerate(MOTIONS)}
    moved = coefficients(names, UNIT).about(shift)
    for j, m in enumerate(MOTIONS):
        new = np.zeros(6)
        new[j] = 1.0
        old = np.concatenate([new[:3] - np.cross(new[3:], shift), new[3:]])
        force = d @ old
        expected = np.concatenate([force[:3], force[3:] - np.cross(shift, force[:3])])
        got = [moved[c + m + dot].value for c in COMPONENTS]
        assert got == pytest.approx(list(expected), rel=1e-12, abs=1e-12)


def test_there_and_back_and_in_si() -> None:
    start = coefficients(HORIZONTAL, Scaling(4.0, "L"))
    point = np.array([-1.5, 0.0, 0.0])
    back = start.about(point).about(start.reference_point)
    assert values(back) == pytest.approx(values(start), rel=1e-12)
    np.testing.assert_allclose(back.covariance, start.covariance, rtol=1e-9, atol=1e-20)
    conditions = Conditions(1000.0, 2.0)
    one, other = start.to_si(conditions).about(point), start.about(point).to_si(conditions)
    assert values(one) == pytest.approx(values(other), rel=1e-12)
    np.testing.assert_allclose(one.covariance, other.covariance, rtol=1e-9)
    assert start.about(start.reference_point) is start


def test_covariance_by_monte_carlo() -> None:
    start = coefficients(HORIZONTAL, UNIT)
    moved = start.about(np.array([0.6, 0.0, 0.0]))
    rng = np.random.default_rng(2)
    draws = rng.multivariate_normal(list(HORIZONTAL.values()), start.covariance, size=200_000)
    yv, yr, nv, nr, ydr, ndr = draws.T
    dx = 0.6
    sampled = np.cov(np.array([yv, yr - dx * yv, nv - dx * yv, nr - dx * (nv + yr) + dx**2 * yv, ydr, ndr - dx * ydr]))
    scale = np.sqrt(np.outer(np.diag(sampled), np.diag(sampled)))
    np.testing.assert_allclose(moved.covariance / scale, sampled / scale, atol=0.015)
    np.testing.assert_array_equal(moved.covariance, moved.covariance.T)
    for i, c in enumerate(moved.coefficients):
        assert c.u95 == pytest.approx(2.0 * np.sqrt(sampled[i, i]), rel=0.015)
    assert moved["Yv"].parts.random == 1e-3
    assert moved["Nr"].parts.random is None


def known(s: CoefficientSet) -> set[str]:
    return {c.symbol for c in s.coefficients if c.value is not None}


def test_what_an_unknown_derivative_takes_along() -> None:
    start = coefficients({"Yv": -0.03, "Nv": -0.014, "Yr": None, "Nr": -0.0045, "Xrr": 0.001, "X0": -0.002})
    moved = start.about(np.array([0.5, 0.0, 0.0]))
    assert known(moved) == {"Yv", "Nv", "X0"}
    assert moved["Nr"].status is Status.NOT_DETERMINED
    assert moved["Xrr"].status is Status.NOT_DETERMINED
    assert moved["Yr"].status is Status.NO_TABLE
    assert (moved["Nr"].u95, moved["Nr"].parts.random) == (None, None)
    assert np.all(np.isnan(moved.covariance[3]))
    assert np.all(np.isfinite(moved.covariance[:2, :2]))


def test_derivatives_that_symmetry_makes_zero_are_not_missing() -> None:
    """A vertical shift couples Yr with Yp, which is there or not, but never with Yu or Yq."""
    start = coefficients({"Zw": -0.014, "Mw": 0.01})
    moved = start.about(np.array([0.5, 0.0, 0.0]))
    assert known(moved) == {"Zw", "Mw"}
    aside = start.about(np.array([0.0, 0.0, 0.5]))
    assert aside["Mw"].status is Status.NOT_DETERMINED


def test_a_value_without_interval_gives_values_without_interval() -> None:
    start = coefficients(HORIZONTAL, UNIT)
    covariance = np.array(start.covariance)
    covariance[0, :] = covariance[:, 0] = np.nan
    bare = CoefficientSet(start.coefficients, covariance, UNIT, start.reference_point, Datum("nose"), "b")
    moved = bare.about(np.array([0.5, 0.0, 0.0]))
    assert moved["Nv"].value is not None
    assert moved["Nv"].u95 is None
    assert moved["Ndr"].u95 is not None


ALL = "u [m/s],v [m/s],w [m/s],p [rad/s],q [rad/s],r [rad/s],X [N],Y [N],Z [N],K [N*m],M [N*m],N [N*m]"


def random_table(read_table: Callable[..., ForceTable]) -> ForceTable:
    rows = np.random.default_rng(4).normal(size=(6, 12))
    rows[:, 0] += 5.0
    text = "\n".join([ALL, *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n"
    return read_table(text, table="contains_inertia = false")


def test_table_by_power_and_rigid_motion(read_table: Callable[..., ForceTable]) -> None:
    table = random_table(read_table)
    point = np.array([-1.2, 0.4, -0.3])
    moved = table.about(point)
    shift = point - table.reference_point
    for i in range(len(table)):
        v, w, f, k = (np.array([t[c][i] for c in names]) for t, names in (
            (table.motion, "uvw"), (table.motion, "pqr"), (table.forces, "XYZ"), (table.forces, "KMN")
        ))  # fmt: skip
        assert [moved.motion[c][i] for c in "uvw"] == pytest.approx(list(v + np.cross(w, shift)))
        assert [moved.forces[c][i] for c in "KMN"] == pytest.approx(list(k - np.cross(shift, f)))
    assert sum(moved.forces[c] * moved.motion[m] for c, m in zip(COMPONENTS, MOTIONS, strict=True)) == pytest.approx(
        sum(table.forces[c] * table.motion[m] for c, m in zip(COMPONENTS, MOTIONS, strict=True))
    )
    back = moved.about(table.reference_point)
    for c in COMPONENTS:
        np.testing.assert_allclose(back.forces[c], table.forces[c], rtol=1e-12, atol=1e-12)
    assert "moments moved by (+0.8, +0.4, -0.3) m" in moved.notes


def test_table_and_set_move_alike(read_table: Callable[..., ForceTable]) -> None:
    """Slopes of a moved table are the moved slopes."""
    rows = ["v [m/s],r [rad/s],Y [N],N [N*m]"]
    rows += [
        f"{v},{r},{-30 * v + 5 * r},{-14 * v - 4 * r}" for v, r in ((0.1, 0.0), (0.0, 0.1), (0.2, -0.1), (0.1, 0.3))
    ]
    table = read_table("\n".join(rows) + "\n", table="contains_inertia = false")
    point = table.reference_point + np.array([0.6, 0.0, 0.0])
    moved = table.about(point)
    design = np.column_stack([moved.motion["v"], moved.motion["r"]])
    slopes = {
        c + m: float(s)
        for c in "YN"
        for m, s in zip("vr", np.linalg.lstsq(design, moved.forces[c], rcond=None)[0], strict=True)
    }
    start = coefficients({"Yv": -30.0, "Yr": 5.0, "Nv": -14.0, "Nr": -4.0}, UNIT, tuple(table.reference_point))
    assert slopes == pytest.approx(values(start.about(point)), rel=1e-9)


def test_exclusions_travel_with_the_force(read_table: Callable[..., ForceTable]) -> None:
    table = read_table("beta [deg],Y [N],N [N*m],uncertain\n1,1,2,Y\n2,3,4,N\n3,5,6,\n4,,7,Y\n")
    moved = table.about(np.zeros(3))
    assert list(moved.usable["N"]) == [False, False, True, False]
    reasons = {(e.line, e.component): e.reason for e in moved.exclusions}
    assert reasons[2, "N"] == 'Y: digit doubtful in the source ("uncertain")'
    assert reasons[5, "N"] == "Y: blank in the source"
    unusable = {(row + 2, c) for c in "YN" for row in np.flatnonzero(~moved.usable[c])}
    assert unusable == set(reasons)
    assert list(moved.with_uncertain_cells().usable["N"]) == [True, True, True, False]
    assert list(table.with_uncertain_cells().about(np.zeros(3)).usable["N"]) == [True, True, True, False]


def test_a_moment_without_its_force_cannot_move(read_table: Callable[..., ForceTable]) -> None:
    table = read_table("beta [deg],N [N*m],X [N],uncertain\n1,2,3,N\n")
    moved = table.about(np.zeros(3))
    assert set(moved.forces) == {"X"}
    assert moved.exclusions == ()
    assert len(moved.with_uncertain_cells()) == 1


def test_standard_errors_of_moments_are_bounded(read_table: Callable[..., ForceTable]) -> None:
    csv = "beta [deg],Y [N],N [N*m],se_Y [N],se_N [N*m]\n1,1,2,0.5,0.25\n"
    moved = read_table(csv).about(np.zeros(3))
    assert moved.errors["N"][0] == pytest.approx(0.25 + 2.0 * 0.5)
    assert "N" not in read_table(csv.replace(",se_Y [N]", "").replace(",0.5", "")).about(np.zeros(3)).errors
