"""The force law of a parameter file: primes at any speed, nothing counted twice, nothing known left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.shape import Box, Part, Parts
from coeflab.bodies.triangulation import Triangulation
from coeflab.core.axes import Datum
from coeflab.core.provenance import Source
from coeflab.fits.results.fit_result import FitResult
from coeflab.formats.loss import covered_grid
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.rigid_body import ideal_force
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.parameter_file import ParameterFile
from tests.report.studies import FULL, small_table

LENGTH, AT = Scaling(2.0, "LOA"), Conditions(1000.0, 1.5)
HULL = AddedMass(np.diag([20.0, 600.0, 580.0, 1.0, 70.0, 72.0]), np.zeros(3), Datum("nose"), "body of tow", "ellipsoid")
Q = 0.5 * AT.density * LENGTH.length**2


def parameters(values: dict[str, float], hull: AddedMass | None = None, **more: object) -> ParameterFile:
    coefficients = tuple(
        Coefficient(s, v, None, Status.SINGLE_ESTIMATOR, "body of tow", origin="fit", campaign="tow", **more)
        for s, v in values.items()
    )
    among = CoefficientSet(
        coefficients, np.full((len(values), len(values)), np.nan), LENGTH, np.zeros(3), Datum("nose"), "body of tow"
    )
    fit = FitResult("slope_at_origin", "tow", "body of tow", among, (), (), {})
    group = PlannedParameterFile("file", "body of tow", ("tow",), ())
    given = None
    if hull is not None:
        box = Part("hull", Box(2.0, 0.5, 0.5), np.zeros(3), np.eye(3))
        body = Body(hull.body, "", Datum("nose"), np.zeros(3), {}, (), Source("synthetic"), (), shape=Parts((box,)))
        given = Triangulation(body, AT.density, (hull,), {}, ())
    return assemble(group, "study", [fit], [small_table(FULL)], [], [], None, AT, [], given)


def drifting(beta: float, speed: float) -> np.ndarray:
    return np.array([[speed * np.cos(beta), speed * np.sin(beta), 0.0, 0.0, 0.0, 0.0]])


@pytest.mark.parametrize("speed", [0.5, 1.5, 3.0])
def test_primes_hold_at_any_speed(speed: float) -> None:
    law = force_law(parameters({"Y0": 1e-4, "Yv": -0.03, "Yv|v|": -0.1, "Yvvv": -0.2, "Nr": -0.004}))
    v = np.sin(0.2)
    force = law.force(drifting(0.2, speed))[0]
    assert force[1] == pytest.approx(Q * speed**2 * (1e-4 - 0.03 * v - 0.1 * v * abs(v) - 0.2 * v**3))
    turning = law.force(np.array([[speed, 0.0, 0.0, 0.0, 0.0, 0.3]]))[0]
    assert turning[5] == pytest.approx(-0.004 * Q * LENGTH.length**2 * speed * 0.3)


def test_damping_at_rest_does_not_scale_with_the_speed() -> None:
    file = parameters({"Yv": -0.03, "Yv|v|": -0.1}, law="rest")
    slope = -0.03 * Q * AT.speed
    for speed in (0.0, 4.0):
        force = force_law(file).force(np.array([[speed, 0.2, 0.0, 0.0, 0.0, 0.0]]))[0]
        assert force[1] == pytest.approx(slope * 0.2 - 0.1 * Q * 0.04)


def test_the_munk_moment_is_counted_once() -> None:
    """With a measured Nv the added mass adds nothing in drift; without, its Munk moment is there."""
    measured = force_law(parameters({"Nv": -0.014}, HULL))
    assert measured.force(drifting(0.1, 2.0))[0, 5] == pytest.approx(-0.014 * Q * LENGTH.length * 4.0 * np.sin(0.1))
    bare = force_law(parameters({"Yv": -0.03}, HULL))
    munk = -(600.0 - 20.0) * 4.0 * np.sin(0.1) * np.cos(0.1)
    assert bare.force(drifting(0.1, 2.0))[0, 5] == pytest.approx(munk)


def test_without_measured_terms_it_is_the_ideal_fluid() -> None:
    nu = np.random.default_rng(2).normal(size=(20, 6))
    file = parameters({"Yv|v|": 0.0}, HULL)
    np.testing.assert_allclose(force_law(file).force(nu), ideal_force(HULL.matrix, nu), atol=1e-9)


def test_total_is_potential_and_viscous() -> None:
    file = parameters({"Nv": -0.014, "Nr": -0.004, "Yr": 0.005, "Nv|v|": -0.01, "Ndr": -0.006}, HULL)
    held = {c.symbol: c.potential for c in file.coefficients}
    assert held["Nv'"] == pytest.approx(-(600.0 - 20.0) / (0.5 * 1000.0 * 8.0))
    assert held["Yr'"] == pytest.approx(-20.0 / (0.5 * 1000.0 * 8.0))
    assert held["Nr'"] == 0.0
    assert held["Nv|v|'"] == 0.0
    assert held["Ndr'"] is None
    law = force_law(file)
    assert law.left_out == ("Ndr",)
    nv = next(t for t in law.terms if t.symbol == "Nv")
    assert nv.potential == pytest.approx(-580.0)


def test_another_body_is_named() -> None:
    file = parameters({"Nv": -0.014}, replace(HULL, body="without the ring"))
    assert any("without the ring" in n for n in file.provenance.notes)


def test_the_file_comes_back() -> None:
    file = parameters({"Nv": -0.014}, HULL)
    assert ParameterFile.model_validate_json(file.to_json()) == file


def test_a_potential_part_that_the_added_mass_does_not_give_is_refused() -> None:
    content = parameters({"Nv": -0.014}, HULL).model_dump()
    content["coefficients"][0]["potential"] = 0.0
    with pytest.raises(ValueError, match="potential 0; expected that of the added mass"):
        ParameterFile.model_validate(content)
    content["added_mass"] = None
    with pytest.raises(ValueError, match="without an added mass"):
        ParameterFile.model_validate(content)


def test_a_rate_that_no_campaign_covers_is_tried_all_the_same() -> None:
    nu, words = covered_grid(parameters({"Yv": -0.03, "Nr": -0.004}))
    assert "r' -0.2 to 0.2 (assumed: no data on it)" in words
    assert np.ptp(nu[:, 5]) > 0.0
    assert not np.any(nu[:, [2, 3, 4]])
