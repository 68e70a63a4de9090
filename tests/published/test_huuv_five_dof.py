"""HUUV in five degrees of freedom: constants and laws by their numbers, the shipped file, geometry, motions."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.simulation import simulate
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.figures import mast_drag, straight_speeds
from coeflab.published.huuv.five_dof import (
    FiveDof,
    assumed_body,
    elevator_laws,
    hull_damping,
    hull_laws,
    inertia,
    read_five_dof,
    restoring,
    simple_masses,
    steady,
    thrusts,
    turning_laws,
)
from coeflab.published.huuv.five_dof_file import SOURCES, five_dof_file
from coeflab.published.huuv.five_dof_rows import FREE, stated_rows, with_masses
from coeflab.published.huuv.model import MATLAB, read_huuv
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

FILE = shipped("cfd_data") / "huuv_5dof" / "huuv_5dof.parameters.json"


@pytest.fixture(scope="module")
def five() -> FiveDof:
    return read_five_dof(read_huuv())


@pytest.fixture(scope="module")
def file(five: FiveDof) -> ParameterFile:
    return five_dof_file(five)


def test_every_row_without_a_motion_in_time_holds(five: FiveDof, file: ParameterFile) -> None:
    tables = stated_rows(five, file)
    assert [r.quantity for t in tables for r in t.rows if not r.holds] == []
    assert [len(t.rows) for t in tables] == [23, 9, 9]


def test_the_shipped_file_is_what_its_maker_writes(file: ParameterFile) -> None:
    assert FILE.read_bytes() == file.to_json()
    folder = shipped("cfd_data") / "huuv"
    recorded = {r.name: r.sha256 for r in read_parameter_file(FILE).provenance.inputs}
    assert {n: recorded[n] for n in SOURCES} == {
        n: hashlib.sha256((folder / n).read_bytes()).hexdigest() for n in SOURCES
    }


def test_what_the_file_holds(five: FiveDof, file: ParameterFile) -> None:
    """Weight, buoyancy, elevators, and both sets of masses beside each other."""
    made = vehicle(file, free=FREE)
    assert made.weight == pytest.approx(19.0 * 9.80665)
    assert made.buoyancy - made.weight == pytest.approx(0.05 * 9.80665)
    assert made.centre == pytest.approx([0.0, 0.0, 0.05])
    assert [(s.control, s.limit) for s in file.surfaces] == [("db", pytest.approx(np.radians(30.0)))]
    stated, (other,) = file.added_mass.matrix, file.added_mass.others
    assert (stated[0, 0], stated[1, 1], stated[1, 5]) == (5.0, 17.0, 0.95)
    assert (other.matrix[0, 0], other.matrix[1, 1], other.matrix[1, 5]) == pytest.approx((3.3134378, 18.99721, 0.0))
    assert stated[2, 2] == other.matrix[2, 2] == pytest.approx(19.961366)
    said = " ".join(file.provenance.notes)
    assert all(word in said for word in ("assumed", "synthetic", "p stays zero"))
    geometry = five_dof_file(replace(five, masses="geometry"))
    assert geometry.added_mass.matrix == pytest.approx(five.geometry)
    assert geometry.name == "huuv_5dof_geometry"


def test_mass_matrix_by_its_numbers(five: FiveDof) -> None:
    m = inertia(five)
    assert np.diag(m) == pytest.approx([24.0, 36.0, 38.9613656, 2.0300799, 1.6])
    assert m[0, 3] == pytest.approx(19.0 * 0.05 - 0.186 * 1000.0 * np.pi * 0.05**2 * 0.2)
    assert m[2, 3] == pytest.approx(-0.25 * 2.0 * 0.7569 * np.pi / 4.0 * 1000.0 * 0.1**2 * 0.2)
    assert m[1, 4] == 0.95
    assert m[2, 3] * m[1, 4] < 0.0  # signs apart: erratum 5
    assert np.linalg.eigvalsh(m)[0] > 0.0


def test_vertical_laws_are_the_horizontal_ones_before_the_factor_of_two(five: FiveDof) -> None:
    a, none = np.radians([-20.0, 5.0, 25.0]), np.zeros(3)
    attack, drift = hull_laws(five, a, none), hull_laws(five, none, a)
    assert attack["C_L"] == pytest.approx(drift["C_S"] / 2.0)
    assert attack["C_D"] == pytest.approx(drift["C_D"])
    assert attack["C_m alpha"][1] == pytest.approx(14.8763656 * a[1] - 15.43 * a[1] ** 3)
    both = hull_laws(five, a, a)["C_D"]
    assert both == pytest.approx(attack["C_D"] + drift["C_D"] - 20.80)  # erratum 9: C_D(0) once
    pitching, yawing = turning_laws(five, np.array([-0.8]), np.array([-0.8]))
    assert (pitching[0], yawing[0]) == pytest.approx((-0.32, -0.64))


def test_lift_rises_the_side_force_opposes_and_the_bow_turns_to_the_flow(five: FiveDof) -> None:
    """Against the motion: Z up and M down where the flow comes from below, Y to port in a drift to starboard."""
    x, y, z, m, n = hull_damping(five, np.array([[1.0, 0.1, 0.1, 0.0, 0.0]]))[0]
    assert min(x, y, z, m) > 0.0
    assert n < 0.0
    assert x < 20.8 * 1.02  # lift and side force pull ahead: errata of equation 5
    astern = hull_damping(five, np.array([[-1.0, 0.0, 0.0, 0.0, 0.0]]))[0]
    assert astern[0] == pytest.approx(-20.8 * (1.0 + 18.76 / 20.8 * np.radians(25.0) ** 2), rel=0.35)
    assert astern[0] < 0.0  # atan2: drag opposes the motion astern too
    assert not hull_damping(five, np.zeros((1, 5))).any()


def test_elevators_by_their_numbers(five: FiveDof) -> None:
    drag, lift, moment = (float(v[0]) for v in elevator_laws(five, np.array([0.2])))
    assert (drag, lift, moment) == pytest.approx((0.074, -0.468, 0.0876))
    c = five.constants
    assert (c["area"], c["length"], c["lever"]) == (0.04, 0.2, 0.25)


def test_weight_and_buoyancy_right_the_vehicle(five: FiveDof) -> None:
    x, _, z, m, _ = restoring(five, np.array([0.1]))[0]
    light = -0.05 * 9.80665
    assert (x, z) == pytest.approx((light * np.sin(0.1), -light * np.cos(0.1)))
    assert m == pytest.approx(0.05 * 19.0 * 9.80665 * np.sin(0.1))


def test_equations_30_and_31_are_not_as_printed(five: FiveDof) -> None:
    found = simple_masses(assumed_body(), 1000.0)
    printed = 1000.0 * np.pi * 0.086**2 * 0.75 + 2.0 * 0.7569 * np.pi * 1000.0 * 0.2**2 * 0.1**3 / 4.0
    assert found["m_z"] - printed > 2.0
    assert found["J_y"] == pytest.approx(1.02506, abs=1e-5)


def test_steady_motions_and_the_same_in_time(five: FiveDof, file: ParameterFile) -> None:
    """The trim of a light vehicle at 60 %: it rises slowly on an even keel."""
    push = thrusts(five, np.array([60.0]), np.array([60.0]))
    found, growth = steady(five, np.zeros(1), push, np.array([[0.85, 0.0, 0.0, 0.0, 0.0]]))
    assert found[0, :3] == pytest.approx([0.85407, 0.0, -0.010797], abs=1e-5)
    assert growth[0] < 0.0
    options = {"commands": ["left=60", "right=60"], "duration": 120.0}
    end = simulate(file, "straight_run", options, free=FREE).trajectory.velocity[-1]
    assert end[[0, 1, 2]] == pytest.approx(found[0, :3], abs=1e-4)


def test_bow_planes_change_the_depth_of_a_vehicle_that_has_no_others(file: ParameterFile) -> None:
    found = simulate(file, "depth_change", {})
    assert found.vehicle.free == ("u", "w", "q")
    said = " ".join(found.manoeuvre.statements)
    assert "first bow planes +10 deg, to dive" in said
    assert "whose positive db turns the bow down" in said
    value = {f.name: f.value for f in found.figures}
    assert value["time to execute"] == pytest.approx(1.036, rel=1e-3)
    assert value["overshoot of depth"] == pytest.approx(0.07133, rel=1e-3)
    assert found.trajectory.position[:, 2].max() > 0.1


def test_the_file_says_that_its_elevators_turn_against_the_rule_of_bodies(file: ParameterFile) -> None:
    alone = {
        m.response: sum(
            t.value * np.radians(30.0) ** t.factors[0].power for t in m.terms if {f.variable for f in t.factors} == {"db"}
        )
        for m in file.models if "db" in {v.name for v in m.variables}
    }  # fmt: skip
    assert (alone["C_L"], alone["C_m"]) == pytest.approx((-0.074, -0.021), abs=5e-4)
    [said] = [note for note in file.provenance.notes if note.startswith("Sense of db")]
    assert "trailing edge up" in said
    assert "turns the bow down" in said


def test_the_geometrys_masses_change_the_turns_and_the_turns_tell_only_differences(five: FiveDof) -> None:
    turns = five.level.turns[MATLAB]
    left = {how: with_masses(five, how, turns) - turns.figures for how in ("stated", "geometry", "moved")}
    rms = {how: float(np.sqrt(np.mean(d[:, 2] ** 2))) for how, d in left.items()}
    assert rms == pytest.approx({"stated": 0.034, "geometry": 0.67, "moved": 0.033}, abs=0.005)


def test_straight_runs_with_and_without_the_mast(five: FiveDof) -> None:
    commands = np.array([60.0, 100.0])
    assert straight_speeds(five.level, commands) == pytest.approx([0.8541, 1.1686], rel=1e-3)
    assert mast_drag(1000.0) == pytest.approx(0.5 * 1000.0 * 2.0 * 0.05 * 0.2)
    assert np.all(straight_speeds(five.level, commands, mast_drag(1000.0)) > straight_speeds(five.level, commands))


def test_bad_input_is_named(five: FiveDof, tmp_path) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match="stated or geometry"):
        read_five_dof(five.level, "printed")  # type: ignore[arg-type]
    text = (shipped("cfd_data") / "huuv" / "five_dof.toml").read_text()
    (tmp_path / "five_dof.toml").write_text(text.replace('displaced = "0.01905 m^3"', 'displaced = "0.01905 kg"'))
    with pytest.raises(InputError, match=r"five_dof\.toml.*weight\.displaced"):
        read_five_dof(five.level, folder=tmp_path)
