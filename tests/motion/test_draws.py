"""Draws have the covariance that the file states, and the same seed gives the same numbers."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.uncertainty.draws import Uncertain, uncertain
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import ParameterCovariance
from tests.formats.massed import torpedo
from tests.motion.uncertain import CORRELATION, RELATIVE, uncertain_torpedo, with_uncertainty


def of(file: ParameterFile) -> Uncertain:
    return uncertain(file, [c.symbol for c in file.coefficients])


def test_draws_have_the_stated_covariance() -> None:
    varied = of(uncertain_torpedo())
    assert set(varied.symbols) == set(RELATIVE)
    sample = np.cov(varied.members(200_000, 1).T)
    scale = np.outer(varied.deviation, varied.deviation)
    np.testing.assert_allclose(sample / scale, varied.covariance / scale, atol=0.01)
    i, j = varied.symbols.index("Ydr'"), varied.symbols.index("Ndr'")
    assert varied.covariance[i, j] / scale[i, j] == pytest.approx(CORRELATION["Ydr'", "Ndr'"])


def test_first_members_are_the_same_in_a_larger_sample() -> None:
    varied = of(uncertain_torpedo())
    np.testing.assert_array_equal(varied.members(37, 5), varied.members(1000, 5)[:37])
    assert not np.array_equal(varied.members(37, 5), varied.members(37, 6))


def test_an_interval_without_covariance_is_two_standard_uncertainties() -> None:
    file = uncertain_torpedo()
    empty = ParameterCovariance(symbols=(), matrix=())
    varied = of(file.model_copy(update={"covariance": empty}))
    halves = {c.symbol: c.u95 for c in file.coefficients}
    np.testing.assert_allclose(2.0 * varied.deviation, [halves[s] for s in varied.symbols])
    assert np.count_nonzero(varied.covariance) == len(varied.symbols)


def test_what_has_no_uncertainty_is_held_and_listed() -> None:
    varied = of(uncertain_torpedo())
    assert "Kp'" in varied.held
    (line,) = [s for s in varied.statements if "no uncertainty is stated" in s]
    for word in ("Kp'", "mass", "computed added mass"):
        assert word in line


def test_groups_are_the_blocks_of_the_covariance() -> None:
    varied = of(uncertain_torpedo())
    named = {frozenset(varied.symbols[i] for i in g) for g in varied.groups()}
    assert {frozenset({"Ydr'", "Ndr'"}), frozenset({"Yv'", "Nv'"}), frozenset({"Nr'"})} <= named
    weak = of(uncertain_torpedo(correlation={("Ydr'", "Ndr'"): 0.05}))
    assert all(len(g) == 1 for g in weak.groups())
    assert weak.left_out() == pytest.approx(0.05)


def test_the_design_keeps_the_covariance_of_each_group() -> None:
    varied = of(uncertain_torpedo())
    z = np.random.default_rng(2).standard_normal((100_000, len(varied.symbols)))
    scale = np.outer(varied.deviation, varied.deviation)
    np.testing.assert_allclose(np.cov(varied.designed(z).T) / scale, varied.covariance / scale, atol=0.015)


def test_a_covariance_that_is_none_is_refused() -> None:
    values = {"Yv'": 1e-3, "Nv'": 1e-3, "Nr'": 1e-3}
    pairs = {("Yv'", "Nv'"): 0.9, ("Yv'", "Nr'"): 0.9, ("Nv'", "Nr'"): -0.9}
    with pytest.raises(InputError, match="positive semidefinite") as caught:
        of(with_uncertainty(torpedo(), values, pairs))
    assert "Yv'" in str(caught.value)


def test_a_perfect_correlation_is_drawn() -> None:
    varied = of(with_uncertainty(torpedo(), {"Yv'": 2e-3, "Nv'": 4e-4}, {("Yv'", "Nv'"): 1.0}))
    drawn = varied.members(50, 1)
    np.testing.assert_allclose(drawn[:, 1], 0.2 * drawn[:, 0], atol=1e-10)


def test_nothing_uncertain_is_an_error() -> None:
    with pytest.raises(InputError, match='found "file", a parameter file without any stated uncertainty'):
        of(with_uncertainty(torpedo(), {}, {}))


def test_terms_of_tables_are_drawn_where_the_law_uses_them() -> None:
    """The HUUV's drag with half-widths and a covariance that it does not have; synthetic."""
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    drag, *others = file.models
    terms = tuple(t.model_copy(update={"half_width_95": 0.2 * abs(t.value or 0.0)}) for t in drag.terms)
    a, b = (0.1 * abs(t.value or 0.0) for t in terms)
    cells = ((a * a, -0.5 * a * b), (-0.5 * a * b, b * b))
    changed = drag.model_copy(update={"terms": terms, "covariance": cells})
    file = file.model_copy(update={"models": (changed, *others)})
    names = [f"{m.response} {t.symbol}" for m in file.models for t in m.terms]
    varied = uncertain(file, names)
    assert varied.symbols == ("C_D 1", "C_D beta^2")
    np.testing.assert_allclose(varied.covariance, cells)
    assert set(varied.held) == set(names) - set(varied.symbols)
    with pytest.raises(InputError, match="without any"):
        uncertain(file, [n for n in names if not n.startswith("C_D")])
