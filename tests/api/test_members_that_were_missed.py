"""What a person looked for on the nouns of the front door, and what it holds: numbers against those that stood elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError


@pytest.mark.parametrize("method", ["ellipsoid", "strip", "panel", "all"])
def test_an_added_mass_says_of_which_water(method: str) -> None:
    body = cf.read_body("spheroid_example")
    salt, fresh = body.added_mass(method, density=1025.0), body.added_mass(method)
    assert (salt.density, round(fresh.density, 1)) == (1025.0, 998.2)
    np.testing.assert_allclose(salt.matrix / salt.density, fresh.matrix / fresh.density, rtol=1e-9, atol=1e-12)


def test_added_mass_is_a_frame() -> None:
    added = cf.read_body("spheroid_example").added_mass("ellipsoid")
    frame = added.frame()
    np.testing.assert_array_equal(frame.to_numpy(), added.matrix)
    assert frame.loc["N", "r_dot"] == added.matrix[5, 5]


def test_a_body_says_what_it_displaces() -> None:
    """4/3 pi a b^2 of a spheroid."""
    body = cf.read_body("spheroid_example")
    a, b = body.shape.length / 2.0, body.shape.volume / (2.0 / 3.0 * np.pi * body.shape.length)
    assert body.volume == pytest.approx(4.0 / 3.0 * np.pi * a * b, rel=1e-6)
    assert body.displaced_mass(1025) == pytest.approx(1025.0 * body.volume)
    with pytest.raises(InputError, match="g/cm"):
        body.displaced_mass(1.025)


def test_a_trim_gives_its_commands() -> None:
    trim = cf.trim("remus100", speed=1.5)
    assert set(trim.commands) == {"thrust", "dr", "ds"}
    assert trim.commands["thrust"] == pytest.approx(1.62 * 1.5**2, rel=1e-6)  # Xu|u| of the file, -1.62 N/(m/s)^2
    frame = trim.frame()
    assert (frame.loc["thrust", "value"], frame.loc["thrust", "unit"]) == (trim.commands["thrust"], "N")
    assert set(frame.index) == {*trim.figures, *trim.commands}


def test_eigenvalues_are_those_of_the_modes() -> None:
    linear = cf.read_vehicle("remus100").linear(speed=1.5)
    assert sorted(linear.eigenvalues.real) == pytest.approx(sorted(m.eigenvalue.real for m in linear.modes), abs=1e-9)


def test_a_comparison_is_summed_up() -> None:
    found = cf.compare("remus100", "remus100")
    assert len(found.summary(wide=True).rows) == len(found.rows)


def test_a_motion_has_units_and_the_names_that_people_use() -> None:
    run = cf.simulate("remus100", "zigzag", rudder="20 deg")
    frame = run.frame()
    assert all("[" in name for name in frame.columns)
    speed = np.sqrt((frame[["u [m/s]", "v [m/s]", "w [m/s]"]] ** 2).sum(axis=1))
    np.testing.assert_allclose(frame["speed [m/s]"], speed, rtol=1e-12)
    assert np.max(np.abs(frame["dr [rad]"])) == pytest.approx(np.radians(20.0))
    for name, same in (("rudder", "dr"), ("yaw", "heading"), ("yaw rate", "r"), ("speed", "speed")):
        drawn, known = (run.plot(n).lines[0].get_ydata() for n in (name, same))
        np.testing.assert_array_equal(drawn, known)
    huuv = cf.simulate("huuv", "straight_run").frame()
    assert "thrust [N]" in huuv.columns


def test_manoeuvres_and_shipped_names_are_listed() -> None:
    assert "zigzag" in [row[0] for row in cf.manoeuvres().rows]
    for name in (row[0] for row in cf.manoeuvres().rows):
        assert cf.manoeuvres(name).title
    names = cf.shipped_names()
    for vehicle in names["vehicles"]:
        assert cf.read_vehicle(vehicle).name
    assert {"remus100", "huuv"} <= set(names["vehicles"])
    assert "suboff_bare_hull" in names["bodies"]


def test_points_and_picture_of_the_resistance_of_straight_runs() -> None:
    speed = np.linspace(1.0, 3.0, 6)
    force = -10.0 * speed**2 * (1.0 + 0.01 * np.sin(5.0 * speed))
    table = cf.read_table(
        {"u [m/s]": speed, "X [N]": force}, name="drag", frame="FRD", length=2.0, density=1000, about="nose, 1.0 m aft"
    )
    result = cf.fit(table)
    x, y, used, labels = result.points("X0'")
    np.testing.assert_allclose(x, speed)
    np.testing.assert_allclose(y, force / (500.0 * speed**2 * 4.0))
    assert (used.all(), len(labels)) == (True, 6)
    axes = result.plot("X0'")
    np.testing.assert_allclose(axes.lines[0].get_ydata(), y)
    assert axes.lines[1].get_ydata()[0] == pytest.approx(result["X0'"].value)
    low, high = np.sort(axes.collections[0].get_paths()[0].vertices[:, 1])[[0, -1]]
    assert (high - low) / 2.0 == pytest.approx(result["X0'"].u95)


def test_what_one_campaign_alone_determines_stands_once() -> None:
    """Drift, and an arm of three drift angles that does not determine Yv'."""
    at = {"frame": "FRD", "length": 2.0, "density": 1000, "speed": 2.0, "about": "nose, 1 m aft", "beta": "+"}
    beta, rate = np.radians(np.arange(-12.0, 13.0, 3.0)), np.repeat(np.linspace(-0.3, 0.3, 5), 3)
    drift = cf.read_table({"beta [deg]": np.degrees(beta), "Y [N]": -480.0 * np.sin(beta)}, name="drift", **at)
    across = np.tile(np.radians([-4.0, 0.0, 4.0]), 5)
    arm = {"beta [deg]": np.degrees(across), "r [rad/s]": rate, "Y [N]": 20.0 * rate - 480.0 * np.sin(across)}
    result = cf.fit([drift, cf.read_table(arm, name="arm", contains_inertia=False, arm_point="reference point", **at)])
    assert result.symbols == ("Yv'", "Yr'")
    assert result.frame().loc["Yv'", "value"] == pytest.approx(-480.0 / (0.5 * 1000 * 4 * 4))
    assert result.covariance.shape == (2, 2)
    np.testing.assert_allclose(2.0 * np.sqrt(np.diag(result.covariance)), [result[s].u95 for s in result.symbols])
    assert [f["symbols"] for f in result._given_elsewhere()] == [("Yv'",)]
    twice = cf.fit(
        [drift, cf.read_table({"beta [deg]": np.degrees(beta), "Y [N]": -500.0 * np.sin(beta)}, name="again", **at)]
    )
    assert [row[-1] for row in twice.summary().rows] == ["drift", "again"]
