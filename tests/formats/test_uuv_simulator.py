"""uuv_simulator: the plugin's own law gives the force of the file, wherever the centre of gravity is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.text.xml import parse_xml
from coeflab.formats.uuv_simulator import write as uuv_simulator
from coeflab.formats.uuv_simulator.law import FossenLink, read_fossen_link
from coeflab.law.rigid_body import ideal_force
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats import of_second_order as second
from tests.vehicle.test_force_law import HULL, Q, drifting, parameters

GOLDEN = Path(__file__).parent / "golden" / "uuv_simulator.urdf"


def velocities(n: int = 60) -> np.ndarray:
    return np.random.default_rng(5).normal(size=(n, 6))


def link_of(file: ParameterFile) -> FossenLink:
    (content,) = uuv_simulator.render(file).values()
    return read_fossen_link(parse_xml(content.decode()))


def test_golden() -> None:
    """Regenerate by hand: write render(golden()) to golden/uuv_simulator.urdf and read the difference."""
    assert uuv_simulator.render(second.golden()) == {"file.urdf": GOLDEN.read_bytes()}


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_its_force_is_the_files(seed: int) -> None:
    """Full random added mass, random motions, every product with u and quadratic damping on the diagonal."""
    file, nu = second.exact(seed, {**second.FORWARD, "Yv|v|": -0.1, "Kp|p|": -1e-5, "Nr|r|": -1e-3}), velocities()
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(uuv_simulator.force(uuv_simulator.render(file), nu), expected, rtol=1e-11, atol=1e-8)
    assert uuv_simulator.not_held(file) == ()


@pytest.mark.parametrize("seed", [1, 2])
def test_moved_to_a_centre_of_gravity_ahead_it_is_the_same_force(seed: int) -> None:
    """Along x the old u is the new one, so nothing is lost."""
    file, nu = second.exact(seed, second.FORWARD), velocities()
    moved = second.with_mass(file, np.array([0.15, 0.0, 0.0]))
    assert np.any(link_of(moved).reference)
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(uuv_simulator.force(uuv_simulator.render(moved), nu), expected, rtol=1e-10, atol=1e-8)


def test_below_the_reference_point_products_of_rates_alone_are_lost() -> None:
    """With the centre of gravity at z the old u is u + z q, whose product with another rate has no place."""
    file, z = parameters({"Nur": -4e-3}), 0.05
    moved, nu = second.with_mass(file, np.array([0.0, 0.0, z])), velocities()
    apart = force_law(file).force(nu) - uuv_simulator.force(uuv_simulator.render(moved), nu)
    lost = -4e-3 * Q * 4.0 * -z * nu[:, 4] * nu[:, 5]
    np.testing.assert_allclose(apart[:, 5], lost, atol=1e-9)


def test_the_munk_moment_is_counted_once() -> None:
    beta, speed = 0.15, 2.0
    file = parameters({"Nv": -0.014, "Yv": -0.03}, HULL)
    force = uuv_simulator.force(uuv_simulator.render(file), drifting(beta, speed))[0]
    assert force[5] == pytest.approx(-0.014 * Q * 2.0 * speed**2 * np.sin(beta) * np.cos(beta), rel=1e-12)
    assert link_of(file).forward[5, 1] == pytest.approx(-0.014 * Q * 2.0 + 580.0)


def test_the_law_of_the_plugin() -> None:
    """Off-diagonal quadratic entries do nothing; forces act at the centre of gravity; -C_A is the ideal fluid's."""
    r = np.random.default_rng(3)
    root, nu, centre = r.normal(size=(6, 6)), velocities(), np.array([0.2, -0.1, 0.3])
    zero, mass = np.zeros((6, 6)), root @ root.T
    nothing = {"density": None, "mass": None, "volume": None, "length": None, "inertia": None, "reference": np.zeros(3)}
    inert = FossenLink("a", zero, zero, zero, r.normal(size=(6, 6)), np.zeros(3), **nothing)
    np.testing.assert_allclose(inert.force(nu), np.diag(inert.quadratic) * nu * np.abs(nu))
    ideal = FossenLink("a", mass, zero, zero, zero, centre, **nothing)
    at_centre = ideal_force(mass, nu)
    np.testing.assert_allclose(ideal.force(nu)[:, :3], at_centre[:, :3], atol=1e-12)
    moments = at_centre[:, 3:] + np.cross(centre, at_centre[:, :3])
    np.testing.assert_allclose(ideal.force(nu)[:, 3:], moments, atol=1e-12)


def test_damping_at_rest_and_what_has_no_place() -> None:
    link = link_of(second.bluerov2_heavy())
    np.testing.assert_allclose(np.diag(link.linear), [-13.7, 0.0, -33.0, 0.0, -0.8, 0.0])
    np.testing.assert_allclose(np.diag(link.quadratic), [-141.0, -217.0, -190.0, -1.19, -0.47, -1.5])
    assert not np.any(link.forward)
    held = set(uuv_simulator.not_held(made.plain()))
    assert {"Xvv", "Xvr", "Nv|v|", "Y|v|r", "Yvvv"} <= held
    assert not {"Yv", "Yv|v|", "Nuv"} & held


@pytest.mark.parametrize("name", made.HOSTILE, ids=range(len(made.HOSTILE)))
def test_hostile_names(name: str) -> None:
    (file,) = uuv_simulator.render(made.named(name))
    assert file.removesuffix(".urdf").isidentifier()
    assert len(file) < 80
    assert link_of(made.named(name)).link == "base_link"
