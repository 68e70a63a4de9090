"""Pound, slug and foot give themselves away by density, gravity, weight and displacement. Synthetic models throughout."""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.formats.gazebo import read as gazebo
from coeflab.formats.model_files import read_model_file
from coeflab.formats.mss import read as mss
from coeflab.formats.uuv_simulator import read as uuv_simulator
from coeflab.vehicle.imported_numbers import displaced, gravity, gyration, water, weight

DATA = Path(__file__).parent / "data"
LAUV = (DATA / "lauv.urdf.xacro").read_text(encoding="utf-8")
GLIDER = (DATA / "tethys_like.sdf").read_text(encoding="utf-8")
TORPEDO = (DATA / "torpedo_imperial.m").read_text(encoding="utf-8")


def failing(path: Path) -> dict[str, Check]:
    return {c.subject: c for c in read_model_file(path).findings if c.severity is Severity.FAIL}


def written(folder: Path, name: str, content: str) -> Path:
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("density", "said"),
    [(1.94, "slug/ft^3, 999.8"), (1.99, "slug/ft^3, 1026"), (62.4, "lb/ft^3, 999.6"), (64.0, "lb/ft^3, 1025"),
     (1.025, "t/m^3, 1025"), (1.2, "No density of water")],
)  # fmt: skip
def test_densities(density: float, said: str) -> None:
    found = water("x", density)
    assert found.severity is Severity.FAIL
    assert said in found.comment


@pytest.mark.parametrize(
    ("mass", "volume", "said"),
    [(1.97, 1.016, "slug and the volume in cubic feet"), (63.4, 1.016, "pounds and the volume in cubic feet"),
     (63.4, 0.02877, "the mass in pounds"), (1.97, 0.02877, "the mass in slug"), (28.77, 1.016, "the volume in cubic feet"),
     (28.77, 0.1, "do not belong together")],
)  # fmt: skip
def test_displacement_of_one_torpedo_in_mixed_units(mass: float, volume: float, said: str) -> None:
    (found,) = displaced("x", mass, volume, 1000.0, "key")
    assert (found.severity, found.subject) == (Severity.FAIL, "key")
    assert said in found.comment


def test_gravity_weight_and_gyration() -> None:
    assert gravity("x", -32.174, "g")[0].severity is Severity.FAIL
    assert gravity("x", 9.81, "g") == ()
    assert "slug" in weight("x", 63.32, 1.97, "W and m")[0].comment
    assert "pounds" in weight("x", 63.32, 63.32, "W and m")[0].comment
    assert weight("x", 53400.0, 5443.0, "W and m") == ()
    assert weight("x", 1.0, 0.0, "W and m") == ()
    (found,) = gyration("x", 1.97, 1000.0, 1.48, 0.38)
    assert "mass 1.97, Yvdot -1.48, Nrdot -0.38" in found.statistic
    assert gyration("x", 0.0, 1000.0, 1.48, 0.38) == ()


def test_a_xacro_in_slug_and_foot(tmp_path: Path) -> None:
    feet = LAUV.replace('default="1028.0"', 'default="1.99"').replace("0.017551374956865266", "0.62")
    told = failing(written(tmp_path, "m.xacro", feet))
    assert "slug/ft^3" in told["density <fluid_density>"].comment
    assert "density" not in told
    g = LAUV.replace("<link name", '<xacro:property name="g" value="32.2"/><link name', 1)
    assert set(failing(written(tmp_path, "m.xacro", g))) == {'<xacro:property name="g">'}
    pounds = LAUV.replace('name="mass" value="18"', 'name="mass" value="39.7"')
    assert "the mass in pounds" in failing(written(tmp_path, "m.xacro", pounds))["<mass> and <volume>"].comment


def test_an_sdf_in_slug_and_foot(tmp_path: Path) -> None:
    told = failing(written(tmp_path, "m.sdf", GLIDER.replace(">1025<", ">1.99<")))
    assert "slug/ft^3" in told["density <uniform_fluid_density>"].comment
    fall = GLIDER.replace('<world name="water">', '<world name="water"><gravity>0 0 -32.17</gravity>')
    assert set(failing(written(tmp_path, "m.sdf", fall))) == {"<gravity>"}
    shape = "<collision name='c'><geometry><cylinder><radius>0.15</radius><length>2.07</length></cylinder></geometry></collision>"
    hull = GLIDER.replace("</link>", shape + "</link>")
    assert failing(written(tmp_path, "m.sdf", hull)) == {}
    told = failing(written(tmp_path, "m.sdf", hull.replace("<mass>150", "<mass>330.7")))
    assert "the mass in pounds" in told["<mass> and <collision>"].comment
    rough = shape.replace("0.15", "0.3")
    buoyed = failing(
        written(tmp_path, "m.sdf", GLIDER.replace("</link>", rough + "</link>"))
    )  # its world has a Buoyancy
    assert set(buoyed) == {"mass and hydrostatics.volume"}


def test_a_torpedo_in_slug_and_foot_that_says_so(tmp_path: Path) -> None:
    found = mss.examine(DATA / "torpedo_imperial.m")
    assert [(c.subject, c.severity) for c in found if "slug" in c.rule] == [("density rho", Severity.NOTE)]
    assert failing(DATA / "torpedo_imperial.m") == {}
    alone = TORPEDO.replace("rho = 1.94;", "")
    by_gravity = read_model_file(written(tmp_path, "m.m", alone), 1000.0).parameters
    assert by_gravity.coefficient("Xudot").value_si == pytest.approx(-0.35 * 14.593902937206)


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [("rho = 1.94;", "rho = 62.4;", "density rho"), ("rho = 1.94;", "rho = 1.025;", "density rho"),
     ("rho = 1.94;", "rho = 1000;", "g"), ("rho = 1.94;", "rho = 1000; W = 63.32;", "W and m")],
)  # fmt: skip
def test_a_torpedo_in_mixed_units(old: str, new: str, key: str, tmp_path: Path) -> None:
    told = failing(written(tmp_path, "m.m", TORPEDO.replace(old, new)))
    assert key in told
    assert "Convert" in told[key].comment


def test_slugs_without_any_tell_but_their_size(tmp_path: Path) -> None:
    silent = TORPEDO.replace("rho = 1.94;", "rho = 1000;").replace("g = 32.174;", "")
    assert any("one system of units" in c.comment for c in failing(written(tmp_path, "m.m", silent)).values())


@pytest.mark.parametrize(
    ("importer", "name", "text"),
    [(uuv_simulator, "m.xacro", LAUV.replace('name="mass" value="18"', 'name="mass" value="-18"')),
     (gazebo, "m.sdf", GLIDER.replace("<mass>150", "<mass>0")), (mss, "m.m", TORPEDO.replace("m = 1.97", "m = -1.97"))],
)  # fmt: skip
def test_a_mass_that_is_none(importer: object, name: str, text: str, tmp_path: Path) -> None:
    assert any("No body has it" in c.comment for c in importer.examine(written(tmp_path, name, text)))


def test_primes_read_as_si(tmp_path: Path) -> None:
    told = failing(written(tmp_path, "m.m", "rho = 1025; L = 5; Yvdot = -0.03; Zwdot = -0.03; Yv = -1;"))
    assert "Primes read as SI?" in told["M_A Yv, Zw"].comment
