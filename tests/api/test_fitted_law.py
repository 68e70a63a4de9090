"""Laws of a fit through the front door: read at angles with units, refused beyond their data, never an empty result."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import coeflab as cf

ALPHA = np.arange(-10.0, 11.0, 2.0)


@pytest.fixture(scope="module")
def result() -> cf.Result:
    polar = cf.read_table(
        {"alpha [deg]": ALPHA, "C_D": 0.02 + 0.5 * np.radians(ALPHA) ** 2, "C_L": 0.1 * ALPHA}, name="polar", frame="FRD", length=2.0, density=1000,
        speed=2.0, about="nose, 1.0 m aft", alpha="+", columns={c: f"{n} [coefficient A=0.1 m^2]" for c, n in (("C_D", "drag"), ("C_L", "lift"))},
    )  # fmt: skip
    return cf.fit(polar, "polynomial", variable="alpha", degree=2, responses=["C_D"], area=0.1, area_name="frontal")


@pytest.mark.parametrize("seven", ["7 deg", np.radians(7.0), float(np.radians(7.0))])
def test_one_angle_gives_one_number(result: cf.Result, seven: str | float) -> None:
    found = result.laws["C_D"].evaluate(alpha=seven)
    assert isinstance(found.value, float)
    assert found.value == pytest.approx(0.02 + 0.5 * np.radians(7.0) ** 2)


@pytest.mark.parametrize(
    "several",
    [["2 deg", "-4 deg"], np.radians([2.0, -4.0]), pd.Series(np.radians([2.0, -4.0])), (0.034906585, -0.06981317)],
)
def test_several_give_an_array(result: cf.Result, several: object) -> None:
    found = result.laws["C_D"].evaluate(alpha=several)
    np.testing.assert_allclose(found.value, 0.02 + 0.5 * np.radians([2.0, 4.0]) ** 2, rtol=1e-6)
    assert np.shape(found.u95) == (2,)


def test_beyond_the_data_only_where_asked(result: cf.Result) -> None:
    law = result.laws["C_D"]
    with pytest.raises(cf.InputError) as why:
        law.evaluate(alpha=["2 deg", "77 deg"])
    assert why.value.found == "alpha 77 deg"
    assert law.evaluate(alpha="77 deg", extrapolate=True).value == pytest.approx(0.02 + 0.5 * np.radians(77.0) ** 2)


@pytest.mark.parametrize(
    "variables", [{"beta": 0.1}, {}, {"alpha": 0.1, "beta": 0.1}, {"alpha": 7.0}, {"alpha": "7 kg"}]
)
def test_other_variables_and_units_are_refused(result: cf.Result, variables: dict[str, object]) -> None:
    with pytest.raises(cf.InputError):
        result.laws["C_D"].evaluate(**variables)


def test_a_result_of_laws_is_not_empty(result: cf.Result) -> None:
    assert list(result.frame().index.get_level_values(0).unique()) == ["C_D"]
    assert result.frame()["value"].iloc[-1] == pytest.approx(0.5)
    assert len(result.summary().rows) == 3
    assert "C_D" in repr(result)
    with pytest.raises(KeyError, match=r"result\.laws"):
        result["C_D"]
    assert len(result.plot().lines) > 0
    assert result.plot("C_D").get_ylabel() == result.plot().get_ylabel()


def test_several_laws_are_asked_by_name() -> None:
    result = cf.fit("suboff_roddy_2", "polynomial", variable="beta", degree=2)
    with pytest.raises(cf.InputError):
        result.plot()
    assert "X'" in result.laws
