"""One choice of the water's inertia: measured derivatives where they leave one, completed by the computed matrix."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.law.rigid_body import ideal_force
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.inertia import against_computed, water_inertia, with_accelerations
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats.massed import ADDED, VALUES, torpedo, with_mass
from tests.vehicle.test_force_law import parameters

MEASURED = {"Yvdot": -1.2e-2, "Nvdot": -6e-4, "Yrdot": -4e-4, "Nrdot": -7e-4, "Zqdot": 5e-4}
REMUS = shipped("cfd_data") / "remus100" / "remus100.parameters.json"
UNIT = 0.5 * 1000.0 * 2.0**3  # 1/2 rho L^3 of the torpedo, kg


def accelerating(values: dict[str, float] = MEASURED, hull: bool = True) -> ParameterFile:
    """The torpedo with derivatives that somebody measured."""
    file = with_mass(parameters({**VALUES, **values}))
    return file.model_copy(update={"added_mass": torpedo().added_mass}) if hull else file


def test_measured_entries_stand_and_the_computed_matrix_completes_them() -> None:
    """Entries by hand: -Yvdot' 1/2 rho L^3, the mean of -Yrdot' and -Nvdot' by L^4, Zqdot' for its mirror image too."""
    found = water_inertia(accelerating())
    wanted = ADDED.copy()
    wanted[1, 1] = 1.2e-2 * UNIT
    wanted[1, 5] = wanted[5, 1] = 5e-4 * UNIT * 2.0
    wanted[5, 5] = 7e-4 * UNIT * 4.0
    wanted[2, 4] = wanted[4, 2] = -5e-4 * UNIT * 2.0
    np.testing.assert_allclose(found.matrix, wanted, rtol=1e-12)
    assert (found.asked, found.used) == ("measured", "measured")
    (campaign,) = {c.campaign for c in accelerating().coefficients if "dot" in c.symbol}
    assert f"Yvdot', Nvdot', Yrdot', Nrdot', Zqdot' (fit, {campaign})" in found.source
    (said,) = found.warnings
    wanted = "Yrdot and Nvdot are equal in theory, but -3.2 and -4.8 kg m in the file, 6.9 % of sqrt(Yvdot Nrdot) apart; their mean is used"
    assert said == wanted
    # 2e-4 by L^4 of 4000 kg m a unit, over the root of 1.2e-2 (4000 kg) and 7e-4 (16000 kg m^2)


def test_a_computed_added_mass_far_from_the_stated_one_is_said() -> None:
    """The matrix of the torpedo over -Yvdot' and -Nrdot' of the file; within a tenth nothing is said."""
    said = against_computed(accelerating())
    over = {"Yvdot'": ADDED[1, 1] / (1.2e-2 * UNIT), "Nrdot'": ADDED[5, 5] / (7e-4 * UNIT * 4.0)}
    assert said.startswith("diagonal entries computed by the ")
    for name, ratio in over.items():
        assert (f"{name} {100.0 * (ratio - 1.0):+.0f} %" in said) is bool(abs(ratio - 1.0) > 0.1)
    same = {"Yvdot": -ADDED[1, 1] / UNIT * 1.05, "Nrdot": -ADDED[5, 5] / UNIT / 4.0}
    assert against_computed(accelerating(same)) == ""


def test_accelerations_say_where_they_come_from() -> None:
    """Prestero's values of REMUS, which nobody here measured, were called measured."""
    said = water_inertia(read_parameter_file(REMUS)).source
    assert "measured" not in said
    assert "(literature, prestero2001)" in said


def test_computed_is_the_file_without_its_derivatives() -> None:
    file = accelerating()
    found = water_inertia(file, "computed")
    np.testing.assert_array_equal(found.matrix, ADDED)
    assert (found.asked, found.used, found.warnings) == ("computed", "computed", ())
    bare = with_accelerations(file, "computed")
    np.testing.assert_array_equal(water_inertia(bare).matrix, ADDED)
    assert with_accelerations(file, "measured") is file


@pytest.mark.parametrize(
    ("symbol", "value", "why"),
    [("Nvdot", -0.06, "M + M_A is not positive definite"), ("Zwdot", 5e-3, "the added mass of w is -20, below zero")],
)
def test_derivatives_that_leave_no_inertia_give_way_with_a_warning(symbol: str, value: float, why: str) -> None:
    """A yaw-sway coupling of 480 kg m at 108 kg and 31 kg m^2; a heave of the wrong sign, though 60 kg of mass still exceed it."""
    file = accelerating({**MEASURED, symbol: value})
    found = water_inertia(file)
    np.testing.assert_array_equal(found.matrix, ADDED)
    assert (found.asked, found.used) == ("measured", "computed")
    (said,) = found.warnings
    assert said.startswith("accelerations computed, not those of the file: with Yvdot', ")
    assert said.endswith(why)
    moved = vehicle(file)
    assert said in moved.statements
    np.testing.assert_array_equal(moved.added, ADDED)


def test_derivatives_alone() -> None:
    """No computed matrix: nothing completes them, computed ones cannot be had, and no inertia at all is refused."""
    file = accelerating(hull=False)
    found = water_inertia(file, "computed")
    assert found.used == "measured"
    assert any("no computed added mass" in w for w in found.warnings)
    np.testing.assert_array_equal(found.matrix, water_inertia(file).matrix)
    assert found.matrix[0, 0] == 0.0
    coupled = water_inertia(accelerating({"Nrdot": -7e-4, "Yrdot": -0.06}, hull=False))
    np.testing.assert_array_equal(coupled.matrix, np.diag(np.diag(coupled.matrix)))
    assert any("only its diagonal" in w for w in coupled.warnings)
    with pytest.raises(InputError, match="wrong sign"):
        water_inertia(accelerating({"Yvdot": 0.1}, hull=False))
    with pytest.raises(InputError, match='"guessed"'):
        water_inertia(file, "guessed")


@pytest.mark.parametrize("accelerations", ["measured", "computed"])
def test_the_ideal_fluid_has_the_inertia_that_is_integrated(accelerations: str) -> None:
    """Without measured velocity terms the law is -C_A(nu) nu of M_A, which takes no power from the motion it accelerates."""
    file = accelerating()
    file = file.model_copy(update={"coefficients": tuple(c for c in file.coefficients if "dot" in c.symbol)})
    moved, nu = (
        vehicle(file, tuple("uvwpqr"), accelerations=accelerations),
        np.random.default_rng(2).normal(size=(9, 6)),
    )
    force = moved.force(nu, np.zeros((9, 3)))
    np.testing.assert_allclose(force, ideal_force(moved.added, nu), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.einsum("ni,ni->n", force, nu), 0.0, atol=1e-10)
