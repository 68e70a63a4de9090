"""Numbers of a parameter file by name: read, moved, refused."""

from __future__ import annotations

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.identify.tuning_plan import moved, place, value_at
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

HUUV = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
PLACES = {
    "C_S beta": (-64.71 / 281.25, "1"),
    "N r|r|": (-1.0, "N*m"),
    "mass": (19.0, "kg"),
    "added_mass Yvdot": (-17.0, "kg"),
    "added_mass Yrdot": (-0.95, "kg m"),
    "added_mass Nrdot": (-0.6, "kg m^2"),
    "thruster left ahead c0": (-2.338, "N"),
    "thruster right ahead c1": (0.1654, "N/%"),
    "thruster left astern c0": (1.9096, "N"),
    "thruster left y": (-0.1, "m"),
    "-thruster left y": (0.1, "m"),
}


@pytest.mark.parametrize("text", PLACES)
def test_what_stands_there_and_what_is_put_there(text: str) -> None:
    value, unit = PLACES[text]
    where = place(text, HUUV)
    assert where.unit == unit
    assert value_at(HUUV, where) == pytest.approx(value, rel=1e-9)
    changed = moved(HUUV, {where: 1.07 * value})
    assert value_at(changed, where) == pytest.approx(1.07 * value, rel=1e-12)
    others = [place(t, HUUV) for t in PLACES if t.removeprefix("-") != text.removeprefix("-")]
    assert [value_at(changed, w) for w in others] == [value_at(HUUV, w) for w in others]
    assert ParameterFile.model_validate(changed.model_dump()).name == "huuv"


def test_an_added_mass_stays_symmetric() -> None:
    matrix = moved(HUUV, {place("added_mass Nvdot", HUUV): -0.5}).added_mass.matrix  # type: ignore[union-attr]
    assert (matrix[1][5], matrix[5][1]) == (0.5, 0.5)


def test_the_dead_zone_ends_where_the_thrust_begins() -> None:
    changed = moved(HUUV, {place("thruster left ahead c0", HUUV): -3.308})
    curve = changed.thrusters[0].curve
    assert curve.segments[1].low == pytest.approx(20.0)
    assert curve.at(19.9) == 0.0
    assert curve.at(20.0) == pytest.approx(0.0, abs=1e-12)
    assert changed.thrusters[1] == HUUV.thrusters[1]


@pytest.mark.parametrize(("c0", "end"), [(1.5, -14.0), (2.778, -20.0)])
def test_a_step_at_the_end_of_the_dead_zone_stays_and_a_wrong_push_does_not(c0: float, end: float) -> None:
    """The printed branch astern has a step."""
    astern = moved(HUUV, {place("thruster left astern c0", HUUV): c0}).thrusters[0].curve
    assert astern.segments[0].high == pytest.approx(end)
    assert astern.at(-15.0) <= 0.0


@pytest.mark.parametrize(
    "text", ["C_S", "C_S gamma", "Yv'", "thruster stern ahead c0", "thruster left ahead c9", "thruster left sideways c0",
             "thruster left ahead", "added_mass Yv", "", "-"],
)  # fmt: skip
def test_no_such_place(text: str) -> None:
    with pytest.raises(InputError, match="C_S beta"):
        place(text, HUUV)


def test_no_such_derivative() -> None:
    with pytest.raises(InputError, match="SNAME"):
        place("added_mass Qdot", HUUV)
