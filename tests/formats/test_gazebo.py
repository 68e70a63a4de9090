"""gz-sim: both ways of writing give the force of the file by the system's own law, and the real SDFormat takes them."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from xml.etree.ElementTree import tostring

import numpy as np
import pytest

from coeflab.core.text.xml import parse_xml
from coeflab.formats.export import export
from coeflab.formats.gazebo import write as gazebo
from coeflab.formats.gazebo.law import GzLink, read_gz_link
from coeflab.formats.gazebo_plugin import write as gazebo_plugin
from coeflab.law.rigid_body import ideal_force
from coeflab.motion.dynamics import rotations
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.model import parameter_file as huuv_file
from coeflab.published.huuv.model import read_huuv
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats import of_a_vehicle
from tests.formats import of_second_order as second
from tests.formats.massed import torpedo
from tests.motion.vehicles import made as steered
from tests.vehicle.test_force_law import HULL, Q, drifting, parameters

GOLDEN = Path(__file__).parent / "golden"
BOTH = pytest.mark.parametrize("target", [gazebo, gazebo_plugin], ids=["gazebo", "gazebo_plugin"])
ROTATION = np.diag([1.0, -1.0, -1.0])


def velocities(n: int = 60) -> np.ndarray:
    return np.random.default_rng(5).normal(size=(n, 6))


def content(target: ModuleType, file: ParameterFile) -> str:
    model, _ = target.render(file).values()
    return str(model.decode())


def tag(text: str, name: str) -> float | None:
    found = next(parse_xml(text).iter(name), None)
    return None if found is None else float(found.text or "nan")


@BOTH
def test_golden(target: ModuleType) -> None:
    """Regenerate by hand: write render(golden()) to golden/<target>.sdf and read the difference."""
    name = target.__name__.split(".")[-2]
    assert target.render(second.golden())["file.sdf"] == (GOLDEN / f"{name}.sdf").read_bytes()


@BOTH
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_its_force_is_the_files(target: ModuleType, seed: int) -> None:
    """Full random added mass, random motions in six degrees of freedom, every kind of term without U."""
    file, nu = second.with_mass(second.exact(seed)), velocities()
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(target.force(target.render(file), nu), expected, rtol=1e-11, atol=1e-8)
    assert target.not_held(file) == ()


@BOTH
def test_the_munk_moment_is_counted_once(target: ModuleType) -> None:
    """The measured Nv' alone, but for u in the place of U: 1 - cos(beta)."""
    beta, speed = 0.15, 2.0
    measured = parameters({"Nv": -0.014, "Yv": -0.03}, HULL)
    force = target.force(target.render(measured), drifting(beta, speed))[0]
    once = -0.014 * Q * 2.0 * speed**2 * np.sin(beta) * np.cos(beta)
    assert force[5] == pytest.approx(once, rel=1e-12)
    assert force[1] == pytest.approx(-0.03 * Q * speed**2 * np.sin(beta) * np.cos(beta), rel=1e-12)
    bare = target.force(target.render(parameters({"Yv": -0.03}, HULL)), drifting(beta, speed))[0]
    assert bare[5] == pytest.approx(-580.0 * speed**2 * np.sin(beta) * np.cos(beta), rel=1e-12)


def test_viscous_parts_beside_the_fluid_and_totals_beside_the_plugin() -> None:
    file = parameters({"Nv": -0.014, "Yr": 0.005}, HULL)
    fluid, plugin = content(gazebo, file), content(gazebo_plugin, file)
    assert tag(plugin, "nVabsU") == pytest.approx(-0.014 * Q * 2.0)
    assert tag(fluid, "nVabsU") == pytest.approx(-0.014 * Q * 2.0 + 580.0)
    assert tag(fluid, "yRabsU") == pytest.approx(0.005 * Q * 2.0 + 20.0)
    assert (tag(fluid, "yy"), tag(fluid, "yDotV")) == (600.0, None)
    assert (tag(plugin, "yy"), tag(plugin, "yDotV")) == (None, -600.0)
    for text in (fluid, plugin):
        assert parse_xml(text).find(".//disable_coriolis").text == "true"


@BOTH
def test_parity_by_turning_every_vector(target: ModuleType) -> None:
    """The link's own law in its own axes against the file's in FRD, vectors turned by half a turn about x."""
    file, nu = second.exact(7), velocities()
    link = read_gz_link(parse_xml(content(target, file)))
    turn = np.kron(np.eye(2), ROTATION)
    np.testing.assert_allclose(link.force(nu @ turn.T) @ turn, force_law(file).force(nu), rtol=1e-11, atol=1e-8)


def test_signs_in_the_link_frame() -> None:
    text = content(
        gazebo_plugin, parameters({"Yv": -0.03, "Nr": -0.004, "Mw": 0.01, "Kv": -0.001, "Z0": 2e-4, "X0": -1e-3})
    )
    assert [tag(text, t) > 0.0 for t in ("yVabsU", "nRabsU", "mWabsU", "kVabsU", "zUU", "xUabsU")] == [
        False, False, True, True, False, False,
    ]  # fmt: skip


def linked(matrix: np.ndarray, **more: object) -> GzLink:
    zero, cube = np.zeros((6, 6)), np.zeros((6, 6, 6))
    given = {"plugin_mass": zero, "fluid_mass": zero, "disable_coriolis": False, "disable_added_mass": False, **more}
    return GzLink(model="", link="", linear=zero, signed=cube, absolute=cube, mass=None, centre=np.zeros(3), inertia=None,
                  density=None, **given)  # fmt: skip


def test_the_plugins_coriolis_is_the_reverse_of_the_ideal_fluids() -> None:
    """Which is why it is disabled: HydrodynamicsUtils.hh, lines 43-70, in PreUpdate with two minus signs."""
    diagonal, nu = np.diag([20.0, 600.0, 580.0, 1.0, 70.0, 72.0]), velocities()
    np.testing.assert_allclose(linked(diagonal, plugin_mass=-diagonal).force(nu), -ideal_force(diagonal, nu), atol=1e-9)
    root = np.random.default_rng(1).normal(size=(6, 6))
    full = root @ root.T
    np.testing.assert_allclose(linked(full, fluid_mass=full).force(nu), ideal_force(full, nu), atol=1e-11)


def test_without_added_mass_totals_are_written() -> None:
    file = parameters({"Nv": -0.014})
    assert tag(content(gazebo, file), "nVabsU") == pytest.approx(-0.014 * Q * 2.0)
    assert tag(content(gazebo, file), "yy") is None
    assert any("no added mass is known" in c for c in gazebo.changes(file))


def test_acceleration_derivatives_make_a_matrix_that_counts_nothing_twice() -> None:
    values = {"Nv": -0.014, "Yv": -0.03, "Yvdot": -0.016, "Nrdot": -9e-4, "Yrdot": 4e-4, "Nvdot": 3.9e-4}
    file, nu = parameters(values), drifting(0.1, 2.0)
    text = content(gazebo, file)
    assert tag(text, "yy") == pytest.approx(0.016 * Q * 2.0)
    assert tag(text, "yr") == pytest.approx(-(4e-4 + 3.9e-4) / 2.0 * Q * 4.0)
    assert gazebo.force(gazebo.render(file), nu)[0, 5] == pytest.approx(force_law(file).force(nu)[0, 5] * np.cos(0.1))
    assert any("equal in theory" in c for c in gazebo.changes(file))


def test_a_matrix_without_its_diagonal_keeps_what_can_be_integrated() -> None:
    file = parameters({"Nv": -0.014, "Nrdot": -9e-4, "Yrdot": 4e-4})
    assert (tag(content(gazebo, file), "yr"), tag(content(gazebo, file), "rr")) == (0.0, pytest.approx(9e-4 * Q * 8.0))
    assert any("only its diagonal" in c for c in gazebo.changes(file))


@BOTH
def test_what_has_no_place_is_said(target: ModuleType) -> None:
    held = target.not_held(made.plain())
    assert {"Yvvv", "Yvrr"} <= set(held)
    assert not any(h.startswith("Ydr") for h in held)  # its fin has it
    assert not {"Yv", "Nv|v|", "Xvr"} & set(held)


@BOTH
@pytest.mark.parametrize("name", made.HOSTILE, ids=range(len(made.HOSTILE)))
def test_hostile_names(target: ModuleType, name: str) -> None:
    file, water = target.render(made.named(name))
    assert water == "world.sdf"
    assert file.removesuffix(".sdf").isidentifier()
    assert len(file) < 80
    assert read_gz_link(parse_xml(content(target, made.named(name)))).link == "base_link"
    plain = target.force(target.render(made.plain()), velocities())
    assert np.array_equal(target.force(target.render(made.named(name)), velocities()), plain)


def checked(path: Path) -> str:
    if shutil.which("ign") is None:
        pytest.skip("SDFormat's parser (ign sdf, Debian ignition-tools and libsdformat-dev) is not installed")
    command = ["ign", "sdf", "--check", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    return done.stdout + done.stderr.replace("Library error: libignition-tools-backward.so not found", "")


@pytest.mark.parametrize("file", [second.golden(), second.bluerov2_heavy(), made.named(made.HOSTILE[0])])
def test_the_real_parser_takes_sdf_1_9(file: ParameterFile, tmp_path: Path) -> None:
    path = tmp_path / "model.sdf"
    for written in gazebo_plugin.render(file).values():
        path.write_bytes(written)
        told = checked(path)
        assert "Valid" in told
        assert "Error" not in told
    twice = content(gazebo_plugin, file).replace("</link>", '</link><link name="base_link"/>')
    path.write_text(twice, encoding="utf-8")
    assert "Error" in checked(path)


@BOTH
def test_the_resistance_is_exact_on_every_course_ahead(target: ModuleType) -> None:
    """X0 U^2 in drift, trim and turning, from U/10 ahead on; by <xUabsU>, <xVV> and <xWW>, where <xUabsU> alone lacks sin^2(beta) of it."""
    file = parameters({"X0": -1.5e-3, "Xvv": 4e-3}, HULL)
    nu = velocities()
    nu[:, 0] = np.abs(nu[:, 0])
    nu = nu[nu[:, 0] > 0.11 * np.linalg.norm(nu[:, :3], axis=1)]
    theirs = target.force(target.render(file), nu)[:, 0]
    np.testing.assert_allclose(theirs, force_law(file).force(nu)[:, 0], rtol=1e-12, atol=1e-9)
    text = content(target, file)
    assert tag(text, "xWW") == tag(text, "xUabsU") == tag(text, "coeflab_x0")
    assert tag(text, "xWW") == pytest.approx(-1.5e-3 * Q)


@BOTH
@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull"])
def test_suboff_loses_nothing_in_surge(suboff: Study, target: ModuleType, name: str) -> None:
    file = made.slopes_alone(suboff.parameter_files[name])
    still = tuple(c for c in file.coefficients if not any(k in c.symbol for k in ("dr", "ds", "db")))
    file = file.model_copy(update={"coefficients": still})  # a LiftDrag pushes across the stream, which has a part in X
    loss = export(file, target.__name__.split(".")[-2]).loss
    assert loss.relative[0] < 1e-12
    assert "X0" not in " ".join(c for c in loss.changes if c.startswith("u stands for U"))


def floats(files: Mapping[str, bytes], attitude: np.ndarray) -> np.ndarray:
    """(n, 6) FRD about the link's origin, by gz-sim's Buoyancy and DART's weight, from the world alone.

    Buoyancy.cc: volume of a cylinder, in the place of the collision, with the world's density and gravity; the wrench is applied to
    the link's origin. gz-physics applies mass times gravity in the centre of gravity, whatever <gravity> of the link says.
    """
    world = parse_xml(files["world.sdf"].decode()).find("world")
    link = world.find("model/link")
    gravity = np.array([float(x) for x in world.findtext("gravity").split()])
    (buoyancy,) = [p for p in world.iter("plugin") if p.get("name") == "gz::sim::systems::Buoyancy"]
    density = float(buoyancy.findtext("uniform_fluid_density"))
    (hull,) = link.iter("collision")
    radius, length = (float(hull.findtext(f"geometry/cylinder/{t}")) for t in ("radius", "length"))
    at = np.array([float(x) for x in hull.findtext("pose").split()[:3]])
    centre = np.array([float(x) for x in (link.findtext("inertial/pose") or "0 0 0").split()[:3]])
    mass, out = float(link.findtext("inertial/mass") or 1.0), []
    for turned in rotations(attitude):
        along = ROTATION @ turned.T @ ROTATION @ gravity  # from the world, x north, y west, z up, to the link
        weight, push = mass * along, -density * np.pi * radius**2 * length * along
        out.append([*(ROTATION @ (weight + push)), *(ROTATION @ (np.cross(centre, weight) + np.cross(at, push)))])
    return np.array(out)


def attitudes() -> np.ndarray:
    turns = np.random.default_rng(6).normal(size=(20, 4))
    return np.vstack([[1.0, 0.0, 0.0, 0.0], turns / np.linalg.norm(turns, axis=1, keepdims=True)])


@BOTH
def test_weight_buoyancy_and_righting_moment_are_those_of_simulate(suboff: Study, target: ModuleType) -> None:
    """It sank: <gravity> false has no effect on a link with <fluid_added_mass>, and nothing carried its weight."""
    files = (
        of_a_vehicle.floating(),
        second.golden(),
        *suboff.parameter_files.values(),
        huuv_file(read_huuv()),
        torpedo(),
    )
    for file in files:
        moved = vehicle(file, free=("u", "v", "r")).restoring(attitudes())
        found = floats(target.render(file), attitudes())
        np.testing.assert_allclose(found, moved, atol=1e-12 * file.mass.mass * 9.81)
    assert abs(moved[0]).max() < 1e-9
    floating = floats(target.render(files[0]), attitudes())
    assert np.ptp(floating[:, 3]) > 10.0
    assert floating[0, 2] == pytest.approx((60.0 - 55.0) * of_a_vehicle.GRAVITY)


@BOTH
def test_what_the_file_does_not_weigh_floats_neutral_and_it_is_said(target: ModuleType) -> None:
    """Without mass the 1 kg of SDFormat floats, or the mass of the displaced water where that is known."""
    buoyant = made.plain().model_copy(update={"hydrostatics": of_a_vehicle.floating().hydrostatics})
    for file, said in (
        (made.plain(), "neither weight nor buoyancy"),
        (buoyant, "the file states no mass: 55 kg, neutral"),
    ):
        assert np.abs(floats(target.render(file), attitudes())).max() < 1e-9
        assert any(said in c for c in target.changes(file))
    assert any("sinks" in c for c in target.changes(buoyant))
    assert "hydrostatics" in target.holds


@BOTH
def test_the_world_holds_the_model_beside_it(target: ModuleType) -> None:
    for file in (second.golden(), made.named("world")):
        alone, world = (parse_xml(written.decode()) for written in target.render(file).values())
        flat = [
            tostring(root.find(path), encoding="unicode").split()
            for root, path in ((alone, "model"), (world, "world/model"))
        ]
        assert flat[0] == flat[1]
        assert alone.find(".//gravity") is None
        systems = {p.get("filename") for p in world.iterfind("world/plugin")}
        assert {"gz-sim-physics-system", "gz-sim-buoyancy-system"} <= systems
    assert list(target.render(made.named("world"))) == ["world.sdf", "world_of_water.sdf"]
    given = export(second.golden(), target.__name__.split(".")[-2])
    assert not any(c.startswith("files are called") for c in given.loss.changes)


def test_words_of_fins_only_where_there_are_fins() -> None:
    assert any("LiftDrag" in s for s in gazebo.changes(steered()))
    assert not any("LiftDrag" in s for s in gazebo.changes(steered({"X0": -4e-3, "Yv": -4e-2})))
