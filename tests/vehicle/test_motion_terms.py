"""Derivatives and tables that say the same move a vehicle alike; nothing is counted twice."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.law.symbols import CONTROLS
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from tests.formats.massed import with_mass
from tests.vehicle.test_force_law import HULL, parameters

VALUES = {"X0": -2e-3, "Yv": -4e-2, "Yr": 1e-2, "Nv": -2e-2, "Nr": -1e-2, "Ydr": 1e-2, "Ndr": -5e-3}
STILL = np.zeros((1, len(CONTROLS)))


def table(response: str, terms: dict[str, float], variables: tuple[str, ...] = ("v",), **more: Any) -> ParameterModel:
    """Linear terms over primes; the symbol ``0`` is the constant."""
    reach = len(variables)
    spaces = [[*(float(i == k) * s for i in range(reach)), -0.4] for k in range(reach) for s in (1.0, -1.0)]
    return ParameterModel.model_validate({
        "response": response, "unit": "1", "form": "linear", "variables": [{"name": v, "unit": "1"} for v in variables],
        "terms": [
            {
                "symbol": response[0] + k, "value": value, "half_width_95": None,
                "factors": [] if k == "0" else [{"variable": k, "power": 1}],
            }
            for k, value in terms.items()
        ],
        "covariance": [[None] * len(terms)] * len(terms), "n_points": 9, "rms": 0.0, "press_rms": None, "table": "t.csv",
        "campaign": "c", **more,
        "domain": {"low": [-0.4] * reach, "high": [0.4] * reach, "half_spaces": spaces, "extrapolation": "clamp"},
    })  # fmt: skip


def with_tables(*models: ParameterModel, without: str = "N") -> ParameterFile:
    """The file with tables in place of the velocity derivatives of one component."""
    file = with_mass(parameters(VALUES, HULL))
    kept = tuple(c for c in file.coefficients if c.symbol[0] != without or "dr" in c.symbol)
    return file.model_copy(update={"coefficients": kept, "models": models})


def moved(file: ParameterFile, **how: Any) -> np.ndarray:
    nu = np.array([[2.0, 0.3, 0.0, 0.0, 0.0, 0.1], [1.0, -0.2, 0.0, 0.0, 0.0, 0.05]])
    return vehicle(file, ("u", "v", "r"), **how).force(nu, np.repeat(STILL, 2, axis=0))


def test_a_table_of_whole_moments_has_its_munk_moment_once() -> None:
    by_derivatives = moved(with_mass(parameters(VALUES, HULL)))
    whole = table("N'", {"v": VALUES["Nv"], "r": VALUES["Nr"]}, ("v", "r"))
    assert moved(with_tables(whole)) == pytest.approx(by_derivatives, rel=1e-12)


def test_a_table_of_viscous_moments_gets_it_on_top() -> None:
    viscous = table("N'", {"v": VALUES["Nv"]}, contains_potential=False)
    whole = table("N'", {"v": VALUES["Nv"]})
    apart = moved(with_tables(viscous)) - moved(with_tables(whole))
    munk = (HULL.matrix[0, 0] - HULL.matrix[1, 1]) * np.array([2.0 * 0.3, 1.0 * -0.2])
    assert apart[:, 5] == pytest.approx(munk)
    assert apart[:, :5] == pytest.approx(0.0)


def test_derivatives_speak_first_unless_tables_are_asked_for() -> None:
    file = with_mass(parameters(VALUES, HULL)).model_copy(update={"models": (table("N'", {"v": 1.0}),)})
    assert moved(file) == pytest.approx(moved(with_mass(parameters(VALUES, HULL))))
    assert not np.allclose(moved(file, tables=True)[:, 5], moved(file)[:, 5])


def test_rudder_derivatives_stay_beside_tables() -> None:
    file = with_mass(parameters(VALUES, HULL)).model_copy(update={"models": (table("N'", {"v": 1.0}),)})
    symbols = [t.in_file for t in motion_law(file, tables=True)[0].terms]
    assert "Ndr'" in symbols
    assert "Nv'" not in symbols


def test_two_tables_with_a_constant_of_one_force_are_refused() -> None:
    file = with_tables(table("N'", {"0": 1e-4, "v": -2e-2}), table("N'", {"0": 1e-4, "r": -1e-2}, ("r",)))
    with pytest.raises(InputError, match="both with a force of N at rest of its own"):
        vehicle(file, ("u", "v", "r"))


def test_a_table_of_a_rate_leaves_the_drift_products_open() -> None:
    over_rate = motion_law(with_tables(table("N'", {"r": -1e-2}, ("r",))), tables=False)[0].ideal
    assert over_rate[5, 0, 1] == pytest.approx((HULL.matrix[0, 0] - HULL.matrix[1, 1]) / 2.0)
    assert over_rate[5, 0, 5] == 0.0
