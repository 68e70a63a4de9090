"""Numbers that cannot be those of a body in water are found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.published.huuv.model import parameter_file as huuv_file
from coeflab.published.huuv.model import read_huuv
from coeflab.study.study import Study
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.plausibility import plausibility
from coeflab.vehicle.plausible_added_mass import stated_matrix
from tests.formats import of_second_order as second
from tests.formats.massed import ADDED
from tests.formats.of_a_vehicle import floating
from tests.vehicle.test_force_law import HULL, LENGTH, parameters

DERIVATIVES = {"Yv": -0.03, "Yvdot": -0.016, "Nrdot": -9e-4, "Xudot": -4e-4}


def found(file: ParameterFile, severity: Severity = Severity.FAIL) -> dict[str, str]:
    return {c.subject: c.comment for c in plausibility(file) if c.severity is severity}


def test_real_vehicles_pass(suboff: Study) -> None:
    for file in (second.bluerov2_heavy(), second.golden(), *suboff.parameter_files.values()):
        assert found(file) == {}, file.name


def test_a_thruster_that_pushes_astern_is_named() -> None:
    """36 N at 3000 rpm ahead, 9 N astern, the axis that of the jet; the other way round it brakes, and none is named."""
    file = typed_file(
        "mine", ["Yv'=-0.03"], length="1 m", length_name="LOA", speed="1 m/s", density="1000", about="cg",
        thrusters=[f"{n}; bollard = 36 N; rate = 3000; bollard_astern = {b} N; place = -1, 0, 0; axis = {x}, 0, 0"
                   for n, b, x in (("ahead", 9, 1), ("back", 9, -1), ("brake", 40, -1))],
    )  # fmt: skip
    named = [c.subject for c in plausibility(file) if c.severity is Severity.NOTE and c.subject.startswith("thruster")]
    assert named == ["thruster back"]


@pytest.mark.parametrize("density", [1.94, 64.0, 1.2, 998000.0])
def test_a_density_that_is_none_of_water(density: float) -> None:
    file = second.bluerov2_heavy()
    wrong = file.model_copy(update={"conditions": replace(file.conditions, density=density)})
    assert "density" in found(wrong)
    assert ("Convert to SI" in found(wrong)["density"]) == (density in (1.94, 64.0))


def test_slugs_and_feet_beside_a_density_in_si() -> None:
    """The torpedo of the reference vehicles: 1.97 slug, added masses in slug and slug ft^2, called SI."""
    file = second.bluerov2_heavy()
    matrix = np.diag([0.35, 1.48, 1.32, 0.025, 0.41, 0.38]).tolist()
    hull = replace(file.added_mass, matrix=matrix)
    mass = replace(file.mass, mass=1.97)
    told = found(file.model_copy(update={"added_mass": hull, "mass": mass}))
    assert any("one system of units" in c for c in told.values())


def test_asymmetry_by_its_size() -> None:
    slight = parameters({**DERIVATIVES, "Yrdot": 4.000e-4, "Nvdot": 4.001e-4})
    assert "M_A Yr and Nv" in found(slight, Severity.WARN)
    assert found(slight) == {}
    gross = parameters({**DERIVATIVES, "Yrdot": 4e-4, "Nvdot": -4e-4})
    assert "M_A Yr and Nv" in found(gross)
    alone = parameters({**DERIVATIVES, "Yrdot": 4e-4})
    assert found(alone) == {}


def test_negative_and_indefinite_added_mass() -> None:
    assert set(found(parameters({**DERIVATIVES, "Yvdot": 0.016}))) == {"M_A Yv"}
    assert set(found(parameters({**DERIVATIVES, "Yrdot": 9e-3, "Nvdot": 9e-3}))) == {"M_A"}
    missing = parameters({"Yv": -0.03, "Nrdot": -9e-4, "Yrdot": 4e-4, "Nvdot": 4e-4})
    assert found(missing) == {}
    assert set(found(missing, Severity.WARN)) == {"M_A", "N tow/table.csv"}  # N of the table, no Nv' in the law
    assert "added mass" in found(parameters({"Yv": -0.03}), Severity.WARN)


def test_the_matrix_of_derivatives_knows_what_is_not_stated() -> None:
    matrix = stated_matrix(parameters(DERIVATIVES))
    assert matrix[1, 1] == pytest.approx(0.016 * 0.5 * 1000.0 * 8.0)
    assert np.isnan(matrix[1, 5])
    assert np.array_equal(stated_matrix(parameters({"Yv": -0.03}, HULL)), HULL.matrix)


@pytest.mark.parametrize("symbol", ["X0", "Xu", "Xu|u|", "Yv", "Yv|v|", "Yvvv", "Zw", "Kp", "Mq", "Nr", "Nr|r|"])
def test_damping_that_drives(symbol: str) -> None:
    assert set(found(parameters({symbol: 1e-3}, HULL))) == {f"{symbol}'"}
    assert found(parameters({symbol: -1e-3}, HULL)) == {}


@pytest.mark.parametrize(
    ("symbol", "factor", "fails"), [("Yv|v|'", 1.0, False), ("Yv|v|'", 100.0, True), ("Yv'", -1.0, True)]
)
def test_a_law_that_says_where_it_holds_is_judged_by_its_whole_force(
    suboff: Study, symbol: str, factor: float, fails: bool
) -> None:
    """Of the computed hull Yv|v|' alone is above zero; with Yv' and Yvvv' the side force damps over all of its drift."""
    file = suboff.parameter_files["suboff_bare_hull_cfd"]
    changed = tuple(
        replace(c, value=factor * c.value, value_si=factor * c.value_si)
        if c.symbol == symbol and c.value is not None and c.value_si is not None
        else c
        for c in file.coefficients
    )
    assert any(c.symbol == symbol and (c.value or 0.0) * factor > 0.0 for c in file.coefficients)
    driving = [n for n in found(file.model_copy(update={"coefficients": changed})) if symbol in n.split(", ")]
    assert bool(driving) == fails


def test_what_is_no_damping_has_any_sign() -> None:
    assert found(parameters({"Yr": 5e-3, "Nv": 1e-3, "Mw": 1e-2, "Kv": 1e-3, "Zq": 1e-3, "Yv": -0.03}, HULL)) == {}
    assert "damping" in found(parameters({"Nv": -1e-2}, HULL), Severity.WARN)


def test_a_square_in_the_place_of_damping() -> None:
    assert "Yvv'" in found(parameters({"Yvv": -0.1, "Nr": -1e-3}, HULL), Severity.WARN)


def afloat(**changed: object) -> ParameterFile:
    file = floating()
    return file.model_copy(update={"hydrostatics": file.hydrostatics.model_copy(update=changed)})


def test_a_volume_that_does_not_belong_to_the_mass() -> None:
    """60 kg displace about 0.06 m^3, which is 2.1 cubic feet."""
    assert found(floating()) == {}
    assert "the volume in cubic feet" in found(afloat(volume=0.06 / 0.3048**3))["mass and hydrostatics.volume"]
    assert "do not belong together" in found(afloat(volume=0.6))["mass and hydrostatics.volume"]
    assert "Gravity in ft/s^2" in found(afloat(gravity=32.174))["hydrostatics.gravity"]


def test_a_centre_of_buoyancy_below_that_of_gravity_turns_over() -> None:
    """The centre of gravity is at z = 0.03 m, down."""
    key = "hydrostatics.centre_of_buoyancy"
    assert key not in found(afloat(centre_of_buoyancy=(0.0, 0.0, 0.029)), Severity.WARN)
    assert "z is down" in found(afloat(centre_of_buoyancy=(0.0, 0.0, 0.05)), Severity.WARN)[key]


def tabled(slope: float, contains: bool = False) -> ParameterFile:
    """The torpedo whose yaw moment is a table over v', of that slope, in place of its derivatives."""
    file = floating()
    table = ParameterModel.model_validate({
        "response": "N'", "unit": "1", "form": "line", "variables": [{"name": "v", "unit": "1"}],
        "terms": [{"symbol": "Nv", "factors": [{"variable": "v", "power": 1}], "value": slope, "half_width_95": None}],
        "covariance": [[None]], "n_points": 9, "rms": 0.0, "press_rms": None, "table": "t.csv", "campaign": "c",
        "contains_potential": contains,
        "domain": {"low": [-0.3], "high": [0.3], "half_spaces": [[1.0, -0.3], [-1.0, -0.3]], "extrapolation": "clamp"},
    })  # fmt: skip
    others = tuple(c for c in file.coefficients if not c.symbol.startswith("N"))
    return file.model_copy(update={"coefficients": others, "models": (table,)})


def test_a_table_that_is_said_to_lack_the_munk_moment_but_has_it() -> None:
    """Munk moment (Yvdot - Xudot) u v = (3 - 55) u v: a table of that slope is taken for a total, one of the reverse is not."""
    munk = (ADDED[0, 0] - ADDED[1, 1]) / (0.5 * 1000.0 * LENGTH.length**3)
    said = found(tabled(0.8 * munk))["models of N"]
    assert said.startswith("Munk moment twice: ")
    assert "models of N" not in found(tabled(0.8 * munk, contains=True))
    for slope in (-0.8 * munk, 0.2 * munk, 3.0 * munk):
        assert "models of N" not in found(tabled(slope))
    assert "models of N" not in found(floating())
    assert "models of N" not in found(huuv_file(read_huuv()))


@pytest.mark.parametrize("name", ["huuv", "huuv_5dof"])
def test_tables_damp_where_no_derivative_does(name: str) -> None:
    file = read_parameter_file(shipped("cfd_data") / name / f"{name}.parameters.json")
    [told] = [c for c in plausibility(file) if c.subject == "damping"]
    assert told.severity is Severity.PASS
    assert {"X against u", "Y against v", "N against r"} <= set(told.statistic.removeprefix("tables: ").split(", "))
    assert ("M against q" in told.statistic) == (name == "huuv_5dof")
    drag = [m for m in file.models if m.response == "C_S"]
    turned = [
        m.model_copy(update={"terms": tuple(t.model_copy(update={"value": -t.value}) for t in m.terms)}) for m in drag
    ]
    driven = found(file.model_copy(update={"models": tuple(turned)}), Severity.WARN)
    assert driven["damping"].startswith("The tables drive")
    assert found(file.model_copy(update={"models": ()}), Severity.WARN)["damping"] == "Nothing damps."


def typed(*numbers: str) -> ParameterFile:
    return typed_file("auv", numbers, length="2 m", length_name="LOA", speed="1.5 m/s", density="1000", about="cg")


@pytest.mark.parametrize("symbol", ["Xuu", "Xu|u|"])
def test_a_drag_ahead_is_below_zero_by_either_name(symbol: str) -> None:
    """8.3 kg/m pushes ahead at any speed u > 0; what of Xuu drives astern is no reason to fail the one that resists ahead."""
    assert "drives the motion" in found(typed(f"{symbol}=8.3 N/(m/s)^2"))[f"{symbol}'"]
    assert found(typed(f"{symbol}=-8.3 N/(m/s)^2")) == {}


def test_products_with_u_damp() -> None:
    """Yuv and Nur are Yv and Nr ahead: two terms damp, where nothing damped; a moment of sway alone still damps nothing."""

    def damping(*numbers: str) -> list[str]:
        return [c.statistic for c in plausibility(typed(*numbers)) if c.subject == "damping"]

    assert damping("Yuv'=-0.03", "Nur'=-0.003", "Nuv'=-0.01") == ["2 terms of a motion on itself"]
    assert damping("Nuv'=-0.01") == ["none of X0', Xu, Yv, Zw, Kp, Mq, Nr"]
    assert damping("Yuv'=0.03") == []  # its own finding fails
