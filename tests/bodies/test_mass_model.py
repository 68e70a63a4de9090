"""Mass models: shells, solids, ballast and flooded rooms against closed forms; what is no mass."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.mass_model import MassModel, MassPart
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.vehicle.from_shape import Stated, weighed

R, T, RHO = 0.5, 0.02, 2700.0
HEAD = """
[body]
name = "ball"
reader = "primitives"
datum = "centre"
datum_note = "of the sphere"
reference_point = [0.1, 0.0, 0.0]
[source]
citation = "synthetic"
kind = "synthetic"
[[part]]
name = "hull"
form = "sphere"
radius = 0.5
centre = [0.0, 0.0, 0.0]
"""
SHELL = '[[mass]]\nname = "shell"\nmaterial = "aluminium"\nof = "hull"\nthickness = 0.02\nu95 = 3.0\n'
BALLAST = '[[mass]]\nname = "lead"\nballast = true\ncentre = [0.0, 0.0, 0.3]\nu95 = 0.4\n'
ROD = '[[mass]]\nname = "rod"\nmass = 12.0\nform = "cylinder"\nradius = 0.05\nlength = 0.4\ncentre = [0.2, 0.0, 0.0]\n'


def body(folder: Path, *tables: str) -> Body:
    path = folder / "body.toml"
    path.write_text(HEAD + "".join(tables))
    return read_body(path)


def model(folder: Path, *tables: str) -> MassModel:
    found = body(folder, *tables).mass_model
    assert found is not None
    return found


def test_shell_of_a_sphere(tmp_path: Path) -> None:
    """4/3 pi (R^3 - r^3), and 2/5 m (R^5 - r^5)/(R^3 - r^3), Goldstein's table; the facets cut off .1 %."""
    inner = R - T
    mass = RHO * 4.0 / 3.0 * np.pi * (R**3 - inner**3)
    inertia = 0.4 * mass * (R**5 - inner**5) / (R**3 - inner**3)
    found = model(tmp_path, SHELL)
    assert found.mass == pytest.approx(mass, rel=3e-3)
    assert found.inertia == pytest.approx(inertia * np.eye(3), rel=4e-3, abs=1e-3)
    assert found.u95 == pytest.approx(3.0)


def test_cylinder_and_parallel_axis(tmp_path: Path) -> None:
    """About the reference point .1 m ahead of the datum, .1 m behind the rod's centre."""
    found = body(tmp_path, ROD)
    mass = found.configurations[0].mass
    own = 12.0 * np.array([0.05**2 / 2.0, *[0.05**2 / 4.0 + 0.4**2 / 12.0] * 2])
    assert mass.centre == pytest.approx([0.1, 0.0, 0.0])
    assert mass.inertia_matrix == pytest.approx(np.diag(own + 12.0 * 0.1**2 * np.array([0.0, 1.0, 1.0])))


def test_two_points_turn_about_their_common_centre(tmp_path: Path) -> None:
    """Masses 3 and 1 at distance d: m1 m2 / (m1 + m2) d^2 about every axis across, and its product of inertia."""
    points = "".join(
        f'[[mass]]\nname = "{name}"\nmass = {mass}\ncentre = {at}\n'
        for name, mass, at in (("a", 3.0, [0.2, 0.0, 0.0]), ("b", 1.0, [-0.1, 0.0, 0.4]))
    )
    found = model(tmp_path, points)
    d = np.array([0.3, 0.0, -0.4])
    assert found.centre == pytest.approx([0.125, 0.0, 0.1])
    assert found.inertia == pytest.approx(0.75 * (d @ d * np.eye(3) - np.outer(d, d)), abs=1e-12)


def test_a_turned_cylinder_turns_its_inertia(tmp_path: Path) -> None:
    found = model(tmp_path, ROD + 'rotation = ["0 deg", "0 deg", "90 deg"]\n')
    slender = 12.0 * (0.05**2 / 4.0 + 0.4**2 / 12.0)
    assert np.diag(found.inertia) == pytest.approx([slender, 12.0 * 0.05**2 / 2.0, slender])


def test_ballast_makes_it_neutral_and_the_centre_hangs_below(tmp_path: Path) -> None:
    found = model(tmp_path, SHELL, ROD, BALLAST)
    assert found.net == pytest.approx(0.0, abs=1e-9)
    assert found.trim is not None
    pitch, roll = found.trim
    x, _, z = found.bg
    assert np.tan(pitch) == pytest.approx(-x / z)
    assert pitch < 0.0  # the rod lies ahead: bow down
    assert roll == pytest.approx(0.0, abs=1e-12)
    assert found.u95 is None  # the rod's is not stated


def test_uncertainty_of_the_centre_by_moments(tmp_path: Path) -> None:
    found = model(tmp_path, SHELL, BALLAST)
    z = found.centre[2]
    assert found.centre_u95[2] == pytest.approx(np.hypot(3.0 * (0.0 - z), 0.4 * (0.3 - z)) / found.mass, rel=1e-3)


def test_no_trim_far_from_neutral(tmp_path: Path) -> None:
    found = model(tmp_path, SHELL)
    assert found.trim is None
    assert any("no trim" in line for line in found.words())


def test_flooded_room_weighs_its_water(tmp_path: Path) -> None:
    room = '[[mass]]\nname = "bay"\nflooded = true\nform = "box"\nlength = 0.2\nwidth = 0.3\nheight = 0.1\ncentre = [-0.1, 0.0, 0.0]\n'
    found = model(tmp_path, SHELL, room, "[water]\ndensity = 1025.0\n")
    assert found.mass - found.dry == pytest.approx(1025.0 * 0.006)


def test_upside_down_is_said() -> None:
    part = MassPart("lump", "point", 10.0, np.array([0.0, 0.0, -0.1]), np.zeros((3, 3)))
    found = MassModel((part,), 1000.0, 0.01, np.zeros(3))
    assert found.trim == pytest.approx((0.0, np.pi))
    assert any("turns over" in line for line in found.words())


def test_shipped_vehicle_is_neutral_and_level() -> None:
    found = read_body(shipped("geometry") / "myring_auv" / "body.toml").mass_model
    assert abs(found.net) < 1e-6
    assert abs(np.degrees(found.trim[0])) < 1.0
    assert json.loads(json.dumps(found.as_json()))["mass"]["value"] == pytest.approx(found.mass)


@pytest.mark.parametrize(
    ("table", "column", "said"),
    [
        ('[[mass]]\nname = "a"\nmass = -1.0\ncentre = [0.0, 0.0, 0.0]\n', "mass[0].mass", "above zero"),
        ('[[mass]]\nname = "a"\nmass = 1.0\ncentre = [0.0, 0.0, 0.0]\ninertia = [1.0, 1.0, 3.0]\n', "mass[0].inertia", "larger than"),
        ('[[mass]]\nname = "a"\nflooded = true\nform = "sphere"\nradius = 0.6\ncentre = [0.0, 0.0, 0.0]\n', "mass[0].flooded", "at most"),
        (ROD + ROD.replace('"rod"', '"other"'), "mass[1].centre", "shares"),
        (SHELL.replace("0.02", "0.6"), "mass[0].thickness", "leaves nothing"),
        (SHELL.replace('"hull"', '"sail"'), "mass[0].of", "no piece"),
        (BALLAST + BALLAST.replace('"lead"', '"more"'), "mass[1].ballast", "second ballast"),
        (SHELL.replace("thickness = 0.02\n", "") + BALLAST, "mass[1].ballast", "heavier"),
        ('[[mass]]\nname = "a"\ncentre = [0.0, 0.0, 0.0]\n', "mass[0].mass", "nothing that gives"),
        ('[[mass]]\nname = "a"\ndensity = 1000.0\ncentre = [0.0, 0.0, 0.0]\n', "mass[0].form", "a point"),
        ('[[mass]]\nname = "a"\nmass = 1.0\n', "mass[0].centre", "neither"),
    ],
    ids=["negative", "triangle", "flooded", "overlap", "thick", "piece", "ballasts", "heavy", "no mass", "point", "no place"],
)  # fmt: skip
def test_what_is_no_mass(tmp_path: Path, table: str, column: str, said: str) -> None:
    with pytest.raises(InputError) as why:
        body(tmp_path, table)
    assert column in str(why.value)
    assert said in str(why.value)


def test_water_that_nobody_stated_is_said(tmp_path: Path) -> None:
    for table, assumed in (("", True), ("[water]\ndensity = 1025.0\n", False)):
        made = body(tmp_path, SHELL, BALLAST, table).mass_model
        assert made.assumed == assumed
        assert ("assumed: no [water] density" in made.words()[0]) == assumed
        assert made.as_json()["density_assumed"] == assumed


def test_ballast_for_other_water_than_the_vehicles_is_said(tmp_path: Path) -> None:
    for density, said in ((998.2, False), (1025.0, True)):
        lines = weighed(body(tmp_path, SHELL, BALLAST), Stated(), density).statements
        assert any("ballast and flooded rooms are for water of 998.2 kg/m^3, assumed" in x for x in lines) == said
