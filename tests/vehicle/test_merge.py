"""A merge moves what it takes whole, counts a slope once under whatever names, and says what went."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import Status
from coeflab.report.sections.estimates import given
from coeflab.vehicle.comparison import coefficient_set, compare
from coeflab.vehicle.force_law import full_force, motion_law, points_of
from coeflab.vehicle.law_at_points import law_at_points
from coeflab.vehicle.matching import by_plain_names
from coeflab.vehicle.merge import merged
from coeflab.vehicle.own_numbers import imported_file, own_number, own_numbers, typed_file
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausibility import plausibility
from tests.vehicle.hybrid import hybrid

DENSITY = 1000.0  # of the added mass; the files' is another


def file(name: str, *numbers: str, about: str = "cg", **more: Any) -> ParameterFile:
    """Two metres, 1.5 m/s; all made up, slopes under two names too, which nobody may type."""
    one = typed_file(
        name, numbers[:1], length="2 m", length_name="LOA", speed="1.5 m/s", density="1025", about=about, **more
    )
    origin, read = one.reference_point.origin, [own_number(n) for n in numbers]
    every = imported_file(name, name, one.scaling, one.conditions, np.zeros(3), origin, read)
    return one.model_copy(update={"coefficients": every.coefficients, "covariance": every.covariance})


def at(made: ParameterFile, *point: float) -> ParameterFile:
    """With its reference point elsewhere and all else as it is."""
    return made.model_copy(update={"reference_point": made.reference_point.model_copy(update={"point": tuple(point)})})


def whole(*point: float) -> ParameterFile:
    """A file about a point, with all that a merge takes whole."""
    made = at(
        file(
            "other", "Yv'=-0.05 +- 0.004", about="nose", mass="46", cg="0,0,0.02", inertia="1,10,11", volume="0.045",
            cb="0.01,0,0", thrusters=["main; bollard=60 N; rate=720; place=-0.9,0.3,0"],
        ),
        *point,
    )  # fmt: skip
    hull = AddedMass(
        np.diag([3.0, 50.0, 55.0, 0.5, 12.0, 13.0]), np.array(point), made.reference_point.origin, "b", "panel",
        density=DENSITY, u95=np.diag([0.0, 5.0, 0.0, 0.0, 0.0, 1.0]),
    )  # fmt: skip
    return made.model_copy(update={"added_mass": hull})


def test_tables_alone_go_into_a_vehicle_of_their_point_and_length_and_no_other() -> None:
    """A law over incidence beside rates, mass and thrusters that somebody states: the force is that of one file with both."""
    law = hybrid(rates={}).model_copy(update={"mass": None, "thrusters": (), "added_mass": None})
    vehicle = hybrid(models=())
    done = merged(vehicle, law).parameters
    nu, still = np.array([[1.1, 0.2, -0.1, 0.0, 0.1, -0.3]]), np.zeros((1, 3))
    forces = [motion_law(p, tables=False)[0].force(nu, still) for p in (done, hybrid(), vehicle)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-12)
    assert forces[0][0, 1] != pytest.approx(forces[2][0, 1], rel=1e-3)
    assert done.thrusters == vehicle.thrusters
    assert any("the table of C_n" in n for n in done.provenance.notes)
    longer = law.model_copy(update={"scaling": replace(law.scaling, length=1.1 * law.scaling.length)})
    for other in (at(law, -0.2, 0.0, 0.0), longer):
        with pytest.raises(InputError, match="fitted tables by another length or about another point"):
            merged(vehicle, other)


def test_what_is_taken_whole_is_about_the_point_of_the_base() -> None:
    """From x = -1 to the nose, by hand: levers of -1 m."""
    done = merged(file("base", "Yv'=-0.05", "Nv'=-0.01", "Nr'=-0.01", about="nose"), whole(-1.0, 0.0, 0.0)).parameters
    hull, mass, afloat = done.added_mass, done.mass, done.hydrostatics
    assert hull.density == DENSITY
    assert (hull.matrix[5, 5], hull.matrix[1, 5], hull.matrix[4, 4], hull.matrix[2, 4]) == pytest.approx(
        (13.0 + 50.0, -50.0, 12.0 + 55.0, 55.0)
    )
    assert (hull.u95[5, 5], hull.u95[1, 5]) == pytest.approx((1.0 + 5.0, 5.0))
    assert mass.centre == pytest.approx(np.array([-1.0, 0.0, 0.02]))
    assert mass.mass_moment == pytest.approx(-46.0)
    assert mass.mass_moment_prime == pytest.approx(-46.0 / (0.5 * 1025.0 * 2.0**4))
    # I about the point: I_cg + m (d^2 1 - d d^T); inertia was typed about cg
    assert np.diag(mass.inertia_matrix) == pytest.approx([1.0 + 46 * 0.02**2, 10.0 + 46 * (1 + 0.02**2), 11.0 + 46])
    assert mass.inertia_matrix[0, 2] == pytest.approx(46 * 0.02)
    assert afloat.centre_of_buoyancy == pytest.approx((-0.99, 0.0, 0.0))
    assert done.thrusters[0].position == pytest.approx((-1.9, 0.3, 0.0))
    nv, nr = done.coefficient("Nv"), done.coefficient("Nr")
    # Munk: N = -(m22 - m11) u v; and N by r takes m26 u r
    assert nv.potential == pytest.approx(-(50.0 - 3.0) / (0.5 * DENSITY * 2.0**3))
    assert nr.potential == pytest.approx(50.0 / (0.5 * DENSITY * 2.0**4))
    assert ParameterFile.model_validate_json(done.to_json()) == done


def test_what_the_base_has_stays() -> None:
    base = whole(0.0, 0.0, 0.0)
    done = merged(base, whole(-1.0, 0.0, 0.0)).parameters
    parts = {"mass", "thrusters", "hydrostatics", "added_mass"}
    assert done.model_dump(include=parts) == base.model_dump(include=parts)


def test_a_mass_off_its_axis_moves_with_its_centre_or_is_left_out_by_name() -> None:
    base, other = file("base", "Yv'=-0.05", about="nose"), whole(0.0, 0.0, -0.1)
    mass = merged(base, other).parameters.mass
    assert mass.inertia_matrix is not None
    assert mass.centre == pytest.approx(np.array([0.0, 0.0, -0.08]))
    assert np.diag(mass.inertia_matrix) == pytest.approx([1.0 + 46 * 0.08**2, 10.0 + 46 * 0.08**2, 11.0])
    assert other.mass is not None
    bare = replace(other.mass, inertia=10.0, inertia_matrix=None, centre=None)
    done = merged(base, other.model_copy(update={"mass": bare})).parameters
    assert done.mass is None
    assert [n for n in done.provenance.notes if "mass properties of other" in n]


def test_points_from_another_datum_are_refused() -> None:
    other = whole(-1.0, 0.0, 0.0)
    with pytest.raises(ScalingMismatchError):
        merged(file("base", "Yv'=-0.05"), other)
    assert other.reference_point.origin == Datum.named("nose")


def numbers(made: ParameterFile) -> dict[str, float | None]:
    """Values by symbol."""
    return {c.symbol: c.value for c in made.coefficients}


@pytest.mark.parametrize("alone", [False, True])
@pytest.mark.parametrize("spelling", ["Yv'", "Yuv'", "Yv|u|'"])
def test_a_slope_of_the_base_under_two_names_gives_way_to_one_number(spelling: str, alone: bool) -> None:
    base = file("base", "Yv'=-0.03", "Yuv'=-0.02", "Nv'=-0.01", "Ydr'=0.01", "Yuudr'=0.002")
    done = merged(base, file("other", f"{spelling}=-0.05"), alone=alone)
    assert numbers(done.parameters) == {"Yv'": -0.05, "Nv'": -0.01, "Ydr'": 0.01, "Yuudr'": 0.002}
    assert [(r.symbol, r.after is None) for r in done.replaced] == [("Yv'", False), ("Yuv'", True)]


def but(made: ParameterFile, symbol: str, **other: Any) -> ParameterFile:
    """With one coefficient changed."""
    rows = tuple(replace(c, **other) if c.symbol == symbol else c for c in made.coefficients)
    return made.model_copy(update={"coefficients": rows})


@pytest.mark.parametrize("symbol", ["Yv'", "Yuv'"])
def test_a_sum_is_an_estimate_if_any_part_is_one(symbol: str) -> None:
    both = file("both", "Yv'=-0.03 +- 0.003", "Yuv'=-0.02 +- 0.004", "Nv'=-0.02")
    found, _ = by_plain_names(coefficient_set(but(both, symbol, status=Status.ESTIMATE, origin="estimate")))
    total = found["Yv"]
    assert (total.status, total.origin) == (Status.ESTIMATE, "estimate")
    assert (total.value, total.u95) == pytest.approx((-0.05, 0.005))
    done = merged(file("base", "Yv'=-0.06"), but(both, symbol, status=Status.ESTIMATE, origin="estimate"))
    assert numbers(done.parameters) == {"Yv'": -0.06, "Nv'": -0.02}


def test_a_sum_of_fits_names_the_tables_of_all_and_has_no_value_where_a_part_has_none() -> None:
    both = file("both", "Yv'=-0.03 +- 0.003", "Yuv'=-0.02 +- 0.004")
    fitted = {"status": Status.OK, "origin": "fit"}
    one = but(
        but(both, "Yv'", table="a/drift.csv", campaign="a", **fitted), "Yuv'", table="b/d.csv", campaign="b", **fitted
    )
    total = by_plain_names(coefficient_set(one))[0]["Yv"]
    assert (total.table, total.campaign, total.origin) == ("a/drift.csv, b/d.csv", "a, b", "fit")
    open_one = but(one, "Yuv'", value=None, u95=None, status=Status.NO_TABLE, origin="none")
    total = by_plain_names(coefficient_set(open_one))[0]["Yv"]
    assert (total.value, total.status) == (None, Status.NO_TABLE)


def test_a_sum_is_stated_as_one() -> None:
    both, one = file("both", "Yv'=-0.03", "Yuv'=-0.02"), file("one", "Yv'=-0.06")
    for found in (compare(one, both).statements, merged(one, both).parameters.provenance.notes):
        assert [s for s in found if "Yv' of both" in s and "Yuv'" in s and "sum" in s]
    assert not [s for s in compare(one, one).statements if "sum" in s]


def test_what_is_left_out_is_called_an_estimate_only_where_it_is_one() -> None:
    base = but(
        file("base", "Yv|v|'=-0.1", "Yvvv'=-0.2", "Nv'=-0.01"), "Yvvv'", status=Status.ESTIMATE, origin="estimate"
    )
    notes = merged(base, file("other", "Yvv|v|'=-0.3")).parameters.provenance.notes
    gone = {s: n.startswith("estimates") for n in notes if "left out" in n for s in n.rpartition(": ")[2].split(", ")}
    assert gone == {"Yv|v|'": False, "Yvvv'": True}


def test_damping_about_rest_is_no_other_name_of_a_slope() -> None:
    base = file("base", "Yv'=-0.03", "Yuv'=-0.02")
    rest = tuple(replace(c, law="rest") if c.symbol == "Yv'" else c for c in base.coefficients)
    done = merged(base.model_copy(update={"coefficients": rest}), file("other", "Yv'=-0.05"))
    assert numbers(done.parameters) == {"Yv'": -0.03, "Yuv'": -0.05}
    assert [(r.symbol, r.before and r.before.value) for r in done.replaced] == [("Yuv'", -0.02)]


@pytest.mark.parametrize(
    ("second", "severity"), [("Yuv'=-0.03", "fail"), ("Yv|u|'=-0.02", "warn"), ("Yvv'=-0.03", ""), ("Yrr'=-0.02", "")]
)
def test_a_slope_under_two_names_is_found_in_any_file(second: str, severity: str) -> None:
    """An equal number is one slope written twice; another is a sum, as a straight course feels it."""
    found = [c for c in plausibility(file("twice", "Yv'=-0.03", second)) if "one slope" in c.statistic]
    assert [str(c.severity) for c in found] == [severity] * bool(severity)


def test_a_slope_under_two_names_is_not_typed() -> None:
    with pytest.raises(InputError, match="Yuv' and Yv', which are one slope"):
        own_numbers(["Yuv=-65 N/(m/s)^2", "Nr'=-0.01", "Yv=-130 N/(m/s)"])
    assert len(own_numbers(["Yuv=-65 N/(m/s)^2", "Yvv=-130 N/(m/s)^2"])) == 2


def test_an_estimate_stays_where_it_brings_the_law_to_points_beyond_the_slope_and_the_range_grows() -> None:
    """A cubic to 12 deg: near zero the slope alone is nearer, at 12 deg Yv|v|' of the estimates halves the miss."""
    base = cf.vehicle("remus100", mass=30.5)
    bend = base["Yv|v|'"].value
    v = np.sin(np.radians(np.arange(-12.0, 13.0, 2.0)))
    force = 0.3 * bend * v + bend / 0.19 * v**3
    columns = {"v' [1]": v, "Y' [1]": force, "N' [1]": 0.3 * bend * v}
    drift = cf.read_table(
        columns, name="drift", frame="FRD", length=1.33, density=1000, speed=2.0, about="nose, 0.611 m aft", accept=True
    )
    slopes = cf.fit(drift)
    done = cf.vehicle("remus100", mass=30.5, coefficients=slopes)
    assert done["Yv|v|'"].value == bend
    alone = done.file.model_copy(
        update={"coefficients": tuple(c for c in done.file.coefficients if c.symbol != "Yv|v|'")}
    )
    (now,), (then,) = ([p for p in points_of(f) if p.component == "Y"] for f in (done.file, alone))
    assert now.worst_beyond < 0.5 * then.worst_beyond or not now.beyond
    high = next(h.high for h in done.file.law_holds if h.component == "Y")
    assert np.degrees(high) >= 8.0
    held = law_at_points(done.file.measured, done.file.law_holds, full_force(done.file), done.file.scaling.length)
    assert not [p.missed for p in held if p.component == "Y" and p.missed]


def test_an_estimate_goes_where_a_fitted_table_has_its_force() -> None:
    """And the same tables again take the place of themselves."""
    base = cf.vehicle("remus100", mass=30.5, centre_of_gravity=(-0.611, 0.0, 0.02)).file
    nothing = {"mass": None, "added_mass": None, "hydrostatics": None, "thrusters": ()}
    law = hybrid(rates={}).model_copy(
        update={**nothing, "scaling": base.scaling, "reference_point": base.reference_point}
    )
    done = merged(base, law)
    assert {"X0'", "Yv'", "Yv|v|'", "Nv'"} <= {r.symbol for r in done.replaced}
    at = np.array([[1.1, 0.2, 0.0, 0.0, 0.0, 0.0]])
    ratio = base.conditions.density / law.conditions.density
    np.testing.assert_allclose(full_force(done.parameters)(at)[0, :2], ratio * full_force(law)(at)[0, :2], rtol=5e-3)
    again = merged(done.parameters, law)
    assert len(again.parameters.models) == len(law.models)
    assert given(again) == f"{len(law.models)} fitted tables"
