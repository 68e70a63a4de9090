"""The body.toml of a vehicle with an arm: what it makes, and every complaint by file, line and key."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.arm import kane
from coeflab.arm.arm_file import is_arm, read_arm, read_chain
from coeflab.arm.thrusters import TorqueThruster, VoltageThruster
from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Parts
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from tests.arm.chains import dry, puma

FILE = shipped("geometry") / "urv_puma" / "body.toml"
TEXT = FILE.read_text()
NEGATIVE = np.diag([1.0, 2.0, -3.0, 0.1, 0.1, 0.1]).tolist()


def refused(folder: Path, old: str, new: str) -> InputError:
    assert old in TEXT
    file = folder / "body.toml"
    file.write_text(TEXT.replace(old, new, 1))
    with pytest.raises(InputError) as raised:
        read_chain(file)
    assert raised.value.file == file
    assert raised.value.line
    return raised.value


@pytest.mark.parametrize(
    ("old", "new", "key", "said"),
    [
        ('alpha = "-90 deg"\n', "", "link[0].alpha", "an angle"),
        ("a = 0\n", "", "link[0].a", "a length"),
        ("d = 0\n", "", "link[0].d", "a length"),
        ("theta = 0\n", "", "link[0].theta", "an angle"),
        ('low = "-160 deg"', 'low = "170 deg"', "link[0].low", "low below high"),
        ('home = "0.3 rad"', 'home = "3 rad"', "link[0].home", "found 171.887 deg; expected -160 to 160 deg"),
        ('mass = "12.96 kg"\n', "", "link[0].mass", "a mass"),
        ('mass = "12.96 kg"', "mass = 0", "link[0].mass", "above zero"),
        ("[1.09809, 0.0, 0.0]", "[3.09809, 0.0, 0.0]", "link[0].inertia_matrix", "one larger than the others' sum"),
        ('alpha = "-90 deg"', "alpha = -90", "link[0].alpha", "without a unit"),
        ('low = "-160 deg"', 'low = "-1 m"', "link[0].low", "angle"),
        ('fastest = "60 deg/s"', "fastest = 0", "link[0].fastest", "above zero"),
        ("axis = [0, 1, 0]", "axis = [0, 0, 0]", "link[0].cylinder[0].axis", "without a direction"),
        ("semi_axes = [1.0, 0.4, 0.4]", "semi_axes = [1.0, 0.0, 0.4]", "vehicle.semi_axes", "above zero"),
        ('joint = "revolute"', 'joint = "ball"', "link[0].joint", "prismatic"),
        ('name = "upper_arm"', 'name = "shoulder"', "link", "one name for each"),
        ('joints = ["40 deg", "-60 deg", "80 deg"]', 'joints = ["40 deg"]', "phase[0].joints", "3, one for each"),
        ('joints = ["40 deg", "-60 deg", "80 deg"]', 'joints = ["4 m", 0, 0]', "phase[0].joints", "angle"),
        ('joints = ["40 deg", "-60 deg", "80 deg"]', 'joints = [0, 0, "300 deg"]', "phase[0].joints", "-45 to 225 deg, the limits of joint forearm"),
        ('joints = ["40 deg", "-60 deg", "80 deg"]', 'torque = ["1 m", 0, 0]', "phase[0].torque", "moment"),
        ("[[0.403567, 0.0, 0.0]", "[[0.403567, 0.1, 0.0]", "link[1].inertia_matrix", "the same numbers on both sides of the diagonal"),
        ('mass = "12.96 kg"', f'mass = "12.96 kg"\nadded_mass = {NEGATIVE}', "link[0].added_mass", "smallest eigenvalue -3"),
        ('mass = "100 kg"', f'mass = "100 kg"\nadded_mass = {NEGATIVE}', "vehicle.added_mass", "smallest eigenvalue -3"),
        ("end = [0.75", "torque = [1.0, 0.0, 0.0]\nend = [0.75", "phase[2].torque", "one of joints, end and torque"),
        ('"link.mass" = "printed', '"link.mass" = "guessed', "basis.link.mass", "printed, derived"),
    ],
)  # fmt: skip
def test_wrong_input(tmp_path: Path, old: str, new: str, key: str, said: str) -> None:
    why = refused(tmp_path, old, new)
    assert why.column == key
    assert said in str(why)


def test_all_complaints_at_once(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    file.write_text(TEXT.replace('alpha = "-90 deg"\n', "").replace('mass = "22.37 kg"\n', ""))
    with pytest.raises(InputError) as raised:
        read_chain(file)
    assert len(raised.value.lines) == 2


def test_another_kind_of_body_is_no_arm() -> None:
    other = shipped("geometry") / "huuv"
    assert is_arm(FILE)
    assert is_arm(FILE.parent)
    assert not is_arm(other)
    with pytest.raises(InputError, match="a vehicle with an arm"):
        read_chain(other)


def test_what_the_shipped_file_makes() -> None:
    chain = puma()
    strip = chain.links[0].strips[0]
    np.testing.assert_allclose([strip.start, strip.end], [[0.0, 0.3088 - 0.33, 0.0389], [0.0, 0.3088 + 0.33, 0.0389]])
    assert (strip.diameter, strip.coefficient) == (0.18, 1.1)
    np.testing.assert_allclose(chain.displaced[0], [0.1, 0.01296, 0.02237, 0.00501])  # neutral: section 4.5
    down = np.array([0.0, 0.0, 1.0])
    np.testing.assert_allclose(
        kane.weight(chain, chain.home, down) + kane.buoyancy(chain, chain.home, down), 0.0, atol=1e-9
    )


def test_points_from_a_datum_elsewhere(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    moved = TEXT.replace("centre_of_mass = [0.0, 0.0, 0.0]", "centre_of_mass = [-1.0, 0.0, 0.5]", 1)
    moved = moved.replace("centre = [0.0, 0.0, 0.0]", "centre = [-1.0, 0.0, 0.5]", 1)
    moved = moved.replace("attachment = [0.5, 0.0, -0.2]", "attachment = [-0.5, 0.0, 0.3]", 1)
    file.write_text(moved)
    q = puma().home
    np.testing.assert_allclose(kane.mass_matrix(read_chain(file), q), kane.mass_matrix(puma(), q), atol=1e-12)


def test_stated_values_take_the_place_of_assumed_ones(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    rows = str((np.diag([1.0, 2.0, 3.0, 0.4, 0.5, 0.6])).tolist())
    stated = f'added_mass = {rows}\nvolume = "0.02 m^3"\ncentre_of_buoyancy = [0.0, 0.3, 0.1]\nmass = "12.96 kg"'
    turning = 'low = "-160 deg"\nhigh = "160 deg"\nhome = "0.3 rad"\nfastest = "60 deg/s"\nstrongest = "97.6 N*m"'
    assert turning in TEXT
    text = TEXT.partition("[[phase]]")[0].replace('joint = "revolute"', 'joint = "prismatic"', 1)
    text = text.replace(turning, 'low = "-2 cm"\nhigh = 0.3\nstrongest = "40 N"')
    file.write_text(text.replace('mass = "12.96 kg"', stated))
    first = read_chain(file).links[0]
    np.testing.assert_allclose(np.diag(first.added_mass), [1.0, 2.0, 3.0, 0.4, 0.5, 0.6])
    assert first.volume == 0.02
    np.testing.assert_allclose(first.centre_of_buoyancy, [0.0, 0.3, 0.1])
    assert not first.joint.turns
    assert (first.joint.low, first.joint.high, first.joint.strongest) == (-0.02, 0.3, 40.0)


def test_thrusters_that_lose_a_direction_are_named(tmp_path: Path) -> None:
    head, *thrusters = TEXT.partition("[[phase]]")[0].split("[[thruster]]")
    file = tmp_path / "body.toml"
    file.write_text("[[thruster]]".join([head, *thrusters[:4]]))
    chain = read_chain(file)
    assert chain.assumed[-1] == "The thrusters make no heave, no roll, no pitch."
    assert chain.statements[-1] == chain.assumed[-1]
    assert len(puma().assumed) == 2


def test_voltage_thrusters_and_their_limits(tmp_path: Path) -> None:
    keys = "damping = 1, drive = 50, load = 5, radius = 0.1, pitch = '30 deg', lift = 1.75, drag = 1.2, column = 0.2, momentum = 0.5"
    torque = 'torque = {alpha = 0.05, beta = 50.0, thrust = 0.02, strongest = "5 N*m"}'
    assert torque in TEXT
    file = tmp_path / "body.toml"
    file.write_text(TEXT.replace(torque, f"voltage = {{{keys}, strongest = 24}}", 1))
    first, second = read_chain(file).thrusters[:2]
    assert first.model == VoltageThruster(1.0, 50.0, 5.0, 0.1, np.radians(30.0), 1.75, 1.2, 0.2, 0.5, 24.0)
    assert second.model == TorqueThruster(0.05, 50.0, 0.02, 5.0)
    assert refused(tmp_path, torque, f"{torque}\nvoltage = {{{keys}}}").column == "thruster[0].voltage"


def test_a_cylinder_away_from_the_centre_of_mass(tmp_path: Path) -> None:
    """What it moves has a moment about the centre of mass: centre x A v."""
    file = tmp_path / "body.toml"
    file.write_text(TEXT.replace("centre = [0.0, 0.3088, 0.0389]\naxis", "centre = [0.2, 0.3088, -0.1611]\naxis", 1))
    water, v = read_chain(file).links[0].added_mass, np.array([0.3, -0.4, 0.7])
    own = np.diag(puma().links[0].added_mass)[:3] * v
    np.testing.assert_allclose(water[:3, :3] @ v, own, atol=1e-12)
    np.testing.assert_allclose(water[3:, :3] @ v, np.cross([0.2, 0.0, -0.2], own), atol=1e-12)


def test_cylinders_with_their_ends(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    file.write_text(TEXT.replace("drag_coefficient = 1.1", 'drag_coefficient = 1.1\nadded_mass = "ends"', 1)
                    .replace("axis = [1, 0, 0]\n", 'axis = [1, 0, 0]\nadded_mass = "none"\n'))  # fmt: skip
    first, second, third = (link.added_mass for link in read_chain(file).links)
    whole = puma().links[0].added_mass
    assert 0.5 * whole[0, 0] < first[0, 0] < whole[0, 0]  # water goes round the ends
    assert first[1, 1] > whole[1, 1] == 0.0
    assert not second.any()
    assert third.any()


def test_it_is_a_body_too() -> None:
    """At home, as one rigid body: mass and added mass of the chain."""
    body, chain = read_body(FILE), puma()
    home, rigid = body.configurations[0].mass, kane.mass_matrix(dry(chain), chain.home)
    water = kane.mass_matrix(chain, chain.home) - rigid
    assert home.mass == pytest.approx(rigid[0, 0])
    np.testing.assert_allclose(home.inertia_matrix, rigid[3:6, 3:6], atol=1e-9)
    found = ADDED_MASS.load("primitives").added_mass(body, 1000.0, {"cylinder_ends": "huuv"}).matrix
    # There a tenth of a cylinder's displaced mass moves along its axis, which the URV paper leaves out.
    along = np.zeros((6, 6))
    for link, turn in zip(chain.links, kane.pose(chain, chain.home).rotation[1:], strict=True):
        axis = turn @ link.strips[0].axis
        along[:3, :3] += 0.1 * np.max(np.diag(link.added_mass)[:3]) * np.outer(axis, axis)
    np.testing.assert_allclose(found[:3, :3], (water[:6, :6] + along)[:3, :3], atol=1e-9)


def test_a_cylinder_lies_along_its_own_axis(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    file.write_text(TEXT.replace("axis = [1, 0, 0]", "axis = [1, 2, 0.5]"))
    chain, shape = read_chain(file), read_body(file).require_shape()
    assert isinstance(shape, Parts)
    at = kane.pose(chain, chain.home)
    for link, part, turn, origin in zip(chain.links, shape.parts[1:], at.rotation[1:], at.origin[1:], strict=True):
        strip = link.strips[0]
        assert abs(part.rotation[:, 0] @ turn @ strip.axis) == pytest.approx(1.0)
        np.testing.assert_allclose(part.centre, origin + turn @ (strip.start + strip.end) / 2.0)


def test_a_displaced_volume_other_than_the_hull_s_is_said(tmp_path: Path) -> None:
    """4/3 pi 1.0 0.4 0.4 = 0.6702 m^3."""
    assert puma().assumed[1] == (
        "The vehicle displaces 0.1 m^3, 100 kg, its mass over the density; its ellipsoid holds 0.6702 m^3, 670.2 kg of "
        "water; added mass is that of the whole ellipsoid."
    )
    assert puma().assumed[1] in puma().statements
    file = tmp_path / "body.toml"
    stated = 'mass = "100 kg"\nvolume = "{} m^3"'
    file.write_text(TEXT.replace('mass = "100 kg"', stated.format(0.05)))
    assert "displaces 0.05 m^3, 50 kg, as stated; its ellipsoid holds 0.6702 m^3" in read_chain(file).assumed[1]
    file.write_text(TEXT.replace('mass = "100 kg"', stated.format(0.67)))
    assert len(read_chain(file).assumed) == 1


def test_units_of_rates_torques_and_commands(tmp_path: Path) -> None:
    """Bare numbers are SI, as before."""
    file = tmp_path / "body.toml"
    start = '[start]\nvelocity = ["1 kn", 0, 0, 0, 0, "9 deg/s"]\nrates = ["18 deg/s", 0.5, "0 rad/s"]\n'
    eight = ["2 N*m", 3, *["0"] * 6]
    phase = f'[[phase]]\nname = "p"\nlasts = 1\ntorque = ["1000 N*mm", 2, "0 N*m"]\ncommands = {eight}\n'.replace(
        '"0"', "0"
    )
    file.write_text(
        TEXT.partition("[[phase]]")[0].replace("'", '"') + phase.replace("'", '"').replace('"0"', "0") + start
    )
    motion = read_arm(file)[1]
    np.testing.assert_allclose(motion.velocity, [1852.0 / 3600.0, 0, 0, 0, 0, np.pi / 20.0])
    assert motion.orders["shoulder.rate"] == pytest.approx(np.pi / 10.0)
    assert motion.orders["upper_arm.rate"] == 0.5
    orders = motion.phases[0].orders
    assert (orders["shoulder.torque"], orders["upper_arm.torque"]) == (1.0, 2.0)
    assert (orders["fore_port"], orders["fore_starboard"]) == (2.0, 3.0)
