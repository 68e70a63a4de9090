"""The shipped data of the TJ-FlyingFish."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.vehicle import vehicle
from coeflab.published.flyingfish.model import CONSTANTS, read_flyingfish, rotor_wrench, thrusters
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
