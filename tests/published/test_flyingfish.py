"""The shipped data of the TJ-FlyingFish."""

from __future__ import annotations

import runpy
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.formats.export import export
from coeflab.motion.vehicle import vehicle
from coeflab.published.flyingfish.equations import aerial_wrench, body_rates, damping, dash, earth_rates, rise
from coeflab.published.flyingfish.model import CONSTANTS, MEDIA, Medium, read_flyingfish, thrusters
from coeflab.published.flyingfish.rotors import rotor_wrench
from coeflab.published.parameter_files import flyingfish_file as published_file
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.vehicle.parameter_file import read_parameter_file
from coeflab.vehicle.plausibility import plausibility
from tests.motion.trimmed import flyingfish_file


def test_table_1_as_printed_but_for_row_three() -> None:
    fish = read_flyingfish()
    assert fish.motion.shape == (10, 5)
    assert fish.motion[2] == pytest.approx([0.35355, 0.35355, 0.0, 0.0, np.pi / 4.0])
    assert fish.motion[9] == pytest.approx([0.5, 0.06, np.radians(20.0), 0.0, 0.0])
    assert np.degrees(fish.angles[6]) == pytest.approx([72.89, -80.05, -43.75, 32.18])
    assert fish.speeds[4] == pytest.approx([2172.57, 2094.28, 2569.76, 2405.14])
    assert len(fish.errata) == 7


def test_thrusters_in_a_vehicle_push_as_the_corrected_equations_say() -> None:
    fish = read_flyingfish()
    craft = vehicle(flyingfish_file(fish, fish.constants))
    constants = dict(zip(CONSTANTS, fish.constants.values(), strict=True))
    angles, speeds = fish.angles[6], fish.speeds[6]
    orders = {f"rotor{i + 1}": float(speeds[i]) for i in range(4)}
    orders |= {f"rotor{i + 1}.tilt": float(angles[i]) for i in range(4)}
    thrust, torque = (f[0] * speeds + f[1] * speeds**2 for f in (fish.rotors.thrust, fish.rotors.torque))
    rows = (angles[None, :], thrust[None, :], torque[None, :])
    wanted = rotor_wrench(*rows, constants["arm_length"], constants["rotor_height"], -1.0)[0]
    assert craft.wrench(orders) == pytest.approx(wanted, abs=1e-12)
    assert [t.name for t in thrusters(fish)] == ["rotor1", "rotor2", "rotor3", "rotor4"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("thrust = [6.0355e-4, 2.5604e-7]", "thrust = [6.0355e-4]", "2 numbers"),
        ("largest_speed = 3000.0", "largest_speed = -1.0", "above zero"),
        ("net_weight = -1.6661\n", "", "net_weight"),
    ],
)
def test_a_spoiled_file_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    folder = tmp_path / "f"
    shutil.copytree(shipped("cfd_data") / "flyingfish", folder)
    file = folder / "vehicle.toml"
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=said):
        read_flyingfish(folder)


@pytest.mark.parametrize("medium", MEDIA)
def test_shipped_files_are_what_their_maker_writes(medium: Medium) -> None:
    fish = read_flyingfish()
    file = shipped("cfd_data") / "flyingfish" / f"flyingfish_{medium}.parameters.json"
    assert file.read_bytes() == published_file(fish, medium).to_json()
    assert read_parameter_file(Path(f"flyingfish_{medium}")).name == f"flyingfish_{medium}"


@pytest.mark.parametrize("medium", MEDIA)
def test_shipped_bench_tests_are_what_their_maker_writes(medium: Medium) -> None:
    made = runpy.run_path(str(shipped("cfd_data") / "make_flyingfish.py"))["bench"](read_flyingfish(), medium)
    assert (shipped("cfd_data") / "flyingfish_bench_synthetic" / f"{medium}.csv").read_bytes() == made


def test_thrust_in_air_by_hand() -> None:
    """Equation 45 at 6000 rpm, 1.1587e-7 36e6 + 2.8619e-5 6000 = 4.343034 N, and equations 31 to 34 in both readings."""
    thrust = 1.1587e-7 * 6000.0**2 + 2.8619e-5 * 6000.0
    torque = 1.6430e-9 * 6000.0**2 + 2.5078e-6 * 6000.0
    craft = vehicle(published_file(read_flyingfish(), "air"))
    for rotor, place in (
        ("rotor1", (1.0, 0.0)),
        ("rotor2", (-1.0, 0.0)),
        ("rotor3", (0.0, 1.0)),
        ("rotor4", (0.0, -1.0)),
    ):
        y, x = place
        spin = torque if y else -torque
        found = craft.wrench({rotor: 6000.0})
        assert found == pytest.approx([0.0, 0.0, -thrust, -thrust * 0.22649 * y, thrust * 0.22649 * x, spin], abs=1e-12)
    t, q = np.array([[4.0, 3.0, 2.0, 1.0]]), np.array([[0.4, 0.3, 0.2, 0.1]])
    printed, corrected = (aerial_wrench(t, q, 0.5, as_printed=p)[0] for p in (True, False))
    assert printed == pytest.approx([0.0, 0.0, 10.0, 0.5, 0.5, 0.4])
    assert corrected == pytest.approx([0.0, 0.0, -10.0, -0.5, 0.5, 0.4])


def test_equations_of_motion_by_hand() -> None:
    """Equations 1 to 12 and 19 to 24 at one state each, worked out apart."""
    nu, angles = np.array([[1.0, 2.0, 3.0, 0.1, 0.2, 0.3]]), np.array([[np.pi / 2.0, 0.0, 0.0]])
    assert earth_rates(nu, angles)[0] == pytest.approx([1.0, -3.0, 2.0, 0.1, -0.3, 0.2])
    push, drag, inertia = np.array([[2.0, 4.0, 6.0, 0.1, 0.2, 0.3]]), np.zeros((1, 6)), np.array([1.0, 2.0, 4.0])
    air = body_rates(nu, angles[:, :2], push, drag, 2.0, inertia, 10.0)[0]
    assert air == pytest.approx(
        [1.0 + 0.6 - 0.6, 2.0 + 0.3 - 0.3 + 10.0, 3.0 + 0.2 - 0.2, 0.1 - 0.12, (0.2 + 0.09) / 2.0, (0.3 - 0.02) / 4.0]
    )
    wet = body_rates(nu, angles[:, :2], push, drag, 2.0, inertia, 10.0, 22.0, -0.5)[0]
    assert wet - air == pytest.approx([0.0, -11.0, 0.0, -0.5, 0.0, 0.0])
    assert damping(np.array([1.0]), np.array([2.0]), np.array([[-3.0]])) == pytest.approx(-21.0)


def test_closed_form_dash_and_rise() -> None:
    """Without linear damping s = s1 tanh(t / tau), x = s1 tau log cosh(t / tau); upward m/(2b) log(1 + b s^2 / F)."""
    time, speed = dash(8.0, 0.0, 2.0, 3.0, 1.0)
    tau = 3.0 / 4.0
    assert speed == pytest.approx(2.0 * np.tanh(time / tau))
    assert 2.0 * tau * np.log(np.cosh(time / tau)) == pytest.approx(1.0)
    up, height = rise(8.0, 0.0, 2.0, 3.0, 2.0)
    assert height == pytest.approx(0.75 * np.log(2.0))
    assert up == pytest.approx(tau * np.arctan(1.0))


@pytest.mark.parametrize("medium", MEDIA)
def test_simulators_get_the_files_as_far_as_they_hold_them(medium: Medium) -> None:
    file = read_parameter_file(Path(f"flyingfish_{medium}"))
    for target in ("xdyn", "mss"):
        made = export(file, target)
        assert made.files
        assert [x.what for x in made.loss.lost] == [
            "added mass: the file has none; the vehicle accelerates as if in air"
        ]
    with pytest.raises(InputError, match="no added mass"):
        export(file, "mujoco")


@pytest.mark.slow
def test_a_plan_goes_from_sweeps_to_motions_in_one_command(tmp_path: Path) -> None:
    """Damping from the tables; mass, buoyancy and rotors from the shipped file."""
    plan = read_plan(shipped("cfd_data") / "flyingfish_water_synthetic" / "plan.toml")
    study = run(plan)
    made, base = study.parameter_files["flyingfish_water_fitted"], read_parameter_file(Path("flyingfish_water"))
    assert (made.hydrostatics, made.thrusters) == (base.hydrostatics, base.thrusters)
    assert made.mass.mass == pytest.approx(2.2297)
    fitted, stated = (p.coefficient("Xu|u|") for p in (made, base))
    assert fitted.u95 is not None
    assert fitted.value == pytest.approx(stated.value, rel=0.01)
    assert fitted.value != stated.value
    assert [s.manoeuvre.name for s in study.manoeuvres] == ["steady_motion", "medium_change"]
    assert all(s.trajectory.ended == "complete" for s in study.manoeuvres)
    text = (shipped("cfd_data") / "flyingfish_water_synthetic" / "plan.toml").read_text()
    wrong = tmp_path / "plan.toml"
    wrong.write_text(
        text.replace('campaign = "."', 'campaign = "flyingfish_water_synthetic"').replace(
            '"flyingfish_water"', '"flyingfisch"'
        )
    )
    with pytest.raises(InputError, match="flyingfish_water"):
        read_plan(wrong)


def test_a_file_in_air_is_plausible_and_one_in_water_with_that_density_is_not() -> None:
    air, wet = (read_parameter_file(Path(f"flyingfish_{medium}")) for medium in ("air", "water"))
    assert {c.severity.value for c in plausibility(air)} <= {"pass", "warn"}
    between = wet.model_copy(update={"conditions": replace(wet.conditions, density=1.6)})
    assert any("No density of water" in c.comment for c in plausibility(between))
