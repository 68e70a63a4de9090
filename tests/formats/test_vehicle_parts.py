"""Hydrostatics, thrusters and surfaces of a parameter file: written where a target has a place for them, else a loss."""

from __future__ import annotations

import tomllib
from xml.etree import ElementTree

import numpy as np
import pytest

from coeflab.core.text.yaml import parse_yaml
from coeflab.formats import EXPORTERS, SimulatorExporter
from coeflab.formats.export import export
from coeflab.formats.missing_parts import Kind
from coeflab.formats.mss import read as mss_reader
from coeflab.formats.toml import write as toml
from coeflab.formats.uuv_simulator import write as uuv_simulator
from coeflab.formats.xdyn import read as xdyn_reader
from coeflab.formats.xdyn import write as xdyn
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.massed import CENTRE, MASS, torpedo
from tests.formats.of_a_vehicle import BUOYANT, GRAVITY, VOLUME, driven, floating, quaternion, restoring
from tests.rigid_motion import rotation

pytestmark = pytest.mark.usefixtures("few_states")

TARGETS = [n for n in EXPORTERS.names() if isinstance(EXPORTERS.load(n), SimulatorExporter)]
DRIVES = {
    "gazebo",
    "gazebo_plugin",
    "c",
    "fmi",
    "mss",
    "python_vehicle_simulator",
    "xdyn",
}  # with thrusters and limits of fins
TIMELESS = {"mss", "xdyn"}  # and without their rates
HOLD = {"c", "fmi", "gazebo", "gazebo_plugin", "mss", "python_vehicle_simulator", "uuv_simulator", "xdyn"}
each_target = pytest.mark.parametrize("target", TARGETS)


def unheld(file: ParameterFile, target: str) -> list[str]:
    loss = export(file, target).loss
    return [x.what for x in loss.lost if x.kind is Kind.NOT_HELD]


@each_target
def test_thrusters_and_limits_that_are_not_held_are_losses(target: str) -> None:
    said = unheld(driven(), target)
    assert ("thruster propeller: add its force yourself" in said) == (target not in DRIVES)
    assert ("limits and rates of dr: angles are taken as given" in said) == (target not in DRIVES)
    assert ("rates of dr: angles are taken at once" in said) == (target in TIMELESS)
    assert target in DRIVES - TIMELESS or not export(driven(), target).lossless
    assert unheld(torpedo(), target) == []


@each_target
def test_hydrostatics_are_held_or_lost_and_never_denied(target: str) -> None:
    said = [s for s in unheld(floating(), target) if s.startswith("hydrostatics: 0.055 m^3 at (0.09, 0.02, -0.05) m")]
    assert len(said) == (target not in HOLD)
    for name, content in export(floating(), target).files.items():
        if not name.endswith(".fmu"):
            text = content.decode()
            assert "states neither" not in text
            assert "states no buoyancy" not in text


# HoloOcean's damping of roll and pitch is a share of the critical one: none without a righting moment.
@pytest.mark.parametrize("target", [t for t in TARGETS if t != "holoocean"])
def test_the_force_of_the_water_does_not_hold_them(target: str) -> None:
    nu, to = np.random.default_rng(4).normal(size=(9, 6)), EXPORTERS.load(target)
    np.testing.assert_array_equal(to.force(to.render(floating()), nu), to.force(to.render(torpedo()), nu))


def test_xdyn_writes_its_gravity_and_buoyancy_in_the_centre_of_buoyancy() -> None:
    (text,) = xdyn.render(floating()).values()
    content = parse_yaml(text.decode(), "file.yml")
    assert content["environmental constants"]["g"]["value"] == GRAVITY
    weight, buoyancy = content["bodies"][0]["external forces"][:2]
    assert weight == {"model": "gravity"}
    assert buoyancy["volume"] == VOLUME
    at = [buoyancy["reference frame"][axis]["value"] for axis in "xyz"]
    np.testing.assert_allclose(at, np.array(BUOYANT) - CENTRE, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("target", "reader"), [("xdyn", xdyn_reader), ("mss", mss_reader)])
def test_what_is_read_back_is_the_same_law(target: str, reader: object, tmp_path: object) -> None:
    ((name, content),) = EXPORTERS.load(target).render(floating()).items()
    (tmp_path / name).write_bytes(content)
    nu = np.random.default_rng(5).normal(size=(9, 6))
    back = reader.read(tmp_path / name)
    np.testing.assert_allclose(force_law(back).force(nu), force_law(floating()).force(nu), rtol=1e-10, atol=1e-9)
    assert target != "xdyn" or "Left out, weight and buoyancy: gravity and buoyancy." in back.remarks


def test_uuv_simulator_has_volume_and_centre_from_the_centre_of_gravity_in_its_own_axes() -> None:
    (text,) = uuv_simulator.render(floating()).values()
    link = ElementTree.fromstring(text).find("gazebo/plugin/link")
    assert link.findtext("neutrally_buoyant") == "0"
    assert float(link.findtext("volume")) == VOLUME
    at = np.array(link.findtext("center_of_buoyancy").split(), dtype=float)
    np.testing.assert_allclose(at, [0.05, -0.03, 0.08], atol=1e-15)


def test_uuv_simulator_floats_and_rights_as_simulate_does() -> None:
    """BuoyantObject.cc, ApplyBuoyancyForce: density, volume and gravity, upward in the centre of buoyancy; weight in the origin."""
    (text,) = uuv_simulator.render(floating()).values()
    plugin = ElementTree.fromstring(text).find("gazebo/plugin")
    buoyancy = float(plugin.findtext("fluid_density")) * float(plugin.findtext("link/volume")) * GRAVITY
    at = np.array(plugin.findtext("link/center_of_buoyancy").split(), dtype=float) * [1.0, -1.0, -1.0]
    for roll, pitch in ((0.0, 0.0), (0.3, -0.2), (-1.1, 0.7)):
        turn = quaternion(roll, pitch)
        down = rotation(turn).T @ np.array([0.0, 0.0, 1.0])
        force = (MASS * GRAVITY - buoyancy) * down
        moment = np.cross(at, -buoyancy * down) + np.cross(CENTRE, force)
        np.testing.assert_allclose([*force, *moment], restoring(floating(), turn), atol=1e-10)


def test_mss_has_the_numbers_that_its_gvect_asks_for() -> None:
    (text,) = EXPORTERS.load("mss").render(floating()).values()
    for line in ("h.volume = 0.055;", "h.g = 9.7;", "h.xB = 0.09;", "h.yB = 0.02;", "h.zB = -0.05;"):
        assert line in text.decode()


def test_tables_have_them_too() -> None:
    (text,) = toml.render(driven()).values()
    found = tomllib.loads(text.decode())
    assert found["hydrostatics"] == {"volume": VOLUME, "centre_of_buoyancy": list(BUOYANT), "gravity": GRAVITY}
    assert [t["name"] for t in found["thruster"]] == ["propeller"]
    assert found["thruster"][0]["curve"]["segments"] == [{"low": -1.0, "high": 1.0, "coefficients": [0.0, 20.0]}]
    assert found["surface"] == [{"control": "dr", "limit": 0.4, "rate": 0.2}]
