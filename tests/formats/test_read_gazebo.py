"""SDF models: read back to what was written, foreign ones by the system's own law, dangerous ones refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import FLU
from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.text.xml import read_xml
from coeflab.formats.gazebo import read as gazebo
from coeflab.formats.gazebo import write as fluid
from coeflab.formats.gazebo.law import read_gz_link
from coeflab.formats.gazebo_plugin import write as plugin
from coeflab.formats.model_files import read_model_file
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats import files as made
from tests.formats import of_second_order as second

GLIDER = Path(__file__).parent / "data" / "tethys_like.sdf"
BOTH = pytest.mark.parametrize("target", [fluid, plugin], ids=["gazebo", "gazebo_plugin"])
SAME = {"Y0'": "Yuu'", "Y|v|r'": "Yr|v|'"}


def round_trip(target: object, file: ParameterFile, folder: Path) -> ParameterFile:
    """The model read back; its world, which states the density itself, reads the same."""
    for name, content in target.render(file).items():
        (folder / name).write_bytes(content)
    at, model = file.conditions, next(iter(target.render(file)))
    known = {"length": file.scaling.length, "speed": at.speed}
    back = gazebo.read(folder / model, density=at.density, **known)
    assert gazebo.read(folder / "world.sdf", **known).coefficients == back.coefficients
    return back


def compare(back: ParameterFile, file: ParameterFile, lost: set[str]) -> int:
    """Every coefficient that a target of second order holds, to 1e-12."""
    seen = 0
    for c in file.coefficients:
        if c.value is None or c.symbol.removesuffix("'") in lost or c.symbol.endswith("dot'"):
            continue
        same = back.coefficient(SAME.get(c.symbol, c.symbol))
        assert same.value == pytest.approx(c.value, rel=1e-12), c.symbol
        assert same.law == c.law or "|" in c.symbol
        seen += 1
    return seen


@BOTH
def test_everything_that_is_held_comes_back(target: object, tmp_path: Path) -> None:
    file = second.golden()
    back = round_trip(target, file, tmp_path)
    lost = {h.split()[0] for h in plugin.not_held(file)}
    assert compare(back, file, lost) == 21  # two of them by a fin
    np.testing.assert_allclose(back.added_mass.matrix, file.added_mass.matrix, rtol=1e-12)
    np.testing.assert_allclose(back.mass.inertia_matrix, file.mass.inertia_matrix, atol=1e-13)
    np.testing.assert_allclose(back.mass.centre, file.mass.centre, atol=1e-15)


@BOTH
def test_the_vehicles_of_the_literature(target: object, tmp_path: Path) -> None:
    file = second.bluerov2_heavy()
    assert compare(round_trip(target, file, tmp_path), file, set()) == 9


@BOTH
@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull"])
def test_suboff(target: object, name: str, suboff: Study, tmp_path: Path) -> None:
    file = made.slopes_alone(suboff.parameter_files[name])
    back = round_trip(target, file, tmp_path)
    lost = {h.split()[0] for h in plugin.not_held(file)}
    assert compare(back, file, lost) >= 7
    nu = np.array([[2.0, 0.0, 0.0, 0.0, 0.0, 0.2]])
    np.testing.assert_allclose(force_law(back).force(nu)[:, [1, 5]], force_law(file).force(nu)[:, [1, 5]], rtol=1e-10)


@BOTH
def test_a_second_export_is_the_same_file(target: object, tmp_path: Path) -> None:
    back = round_trip(target, second.exact(4), tmp_path)
    nu = np.random.default_rng(0).normal(size=(30, 6))
    first = target.force(target.render(second.exact(4)), nu)
    np.testing.assert_allclose(target.force(target.render(back), nu), first, rtol=1e-10, atol=1e-8)


def test_a_foreign_model_keeps_the_systems_law() -> None:
    """Straight ahead with rates and drift: |u| v is read as U v, all else is exact, the reversed Coriolis among it."""
    link, file = read_gz_link(read_xml(GLIDER)), gazebo.read(GLIDER)
    assert file.conditions.density == 1025.0
    nu = np.random.default_rng(1).normal(size=(40, 6))
    nu[:, :3] = np.abs(nu[:, :1]) * [1.0, 0.0, 0.0]
    np.testing.assert_allclose(force_law(file).force(nu), link.force(nu * FLU) * FLU, rtol=1e-10, atol=1e-9)
    assert file.coefficient("Zq").law == "rest"
    assert file.coefficient("Zq").value_si == pytest.approx(1.5)
    assert file.mass.centre.tolist() == [0.1, 0.0, 0.02]


def test_what_the_format_lets_go_wrong(tmp_path: Path) -> None:
    found = gazebo.examine(GLIDER)
    assert [c.severity for c in found] == [Severity.PASS, Severity.WARN]
    assert found[0].subject == "density <uniform_fluid_density>"
    assert found[1].subject == "<disable_coriolis>"
    text = GLIDER.read_text(encoding="utf-8")
    text = text.replace("yVabsV", "yVV").replace("<mass>150", "<mass>100").replace(
        "</inertial>", "<fluid_added_mass><xx>5</xx></fluid_added_mass></inertial>"
    )  # fmt: skip
    bad = tmp_path / "bad.sdf"
    bad.write_text(text, encoding="utf-8")
    told = {c.subject: c.severity for c in gazebo.examine(bad)}
    assert told["<fluid_added_mass>"] is Severity.FAIL
    assert told["<yVV>"] is Severity.WARN
    assert told["<mass>"] is Severity.WARN


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("<xDotU>-5</xDotU>", "<xDotU>five</xDotU>", '"five"'),
        ("<xDotU>-5</xDotU>", "<xDotU>nan</xDotU>", '"nan"'),
        ("<xDotU>-5</xDotU>", "<xDotU>-5</xDotU><xDotU>-50</xDotU>", "<xDotU> 2 times"),
        ("<xDotU>-5</xDotU>", "<xDotU>-5", "mismatched"),
        ("<link_name>hull</link_name>", "", "no <link_name>"),
        ("gz::sim::systems::Hydrodynamics", "x", ""),
        ("gz-sim-hydrodynamics-system", "x", ""),
        ("1025", "no", '"no"'),
    ],
)
def test_unreadable_files_say_why(old: str, new: str, found: str, tmp_path: Path) -> None:
    path = tmp_path / "m.sdf"
    text = GLIDER.read_text(encoding="utf-8").replace(old, new)
    if not found:
        text = text.replace("ydrodynamics", "")
        found = "0 Hydrodynamics plugins"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        gazebo.read(path)
    assert found in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_density_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "m.sdf"
    written = next(iter(plugin.render(made.plain()).values())).decode()
    path.write_text(re.sub(r"<coeflab_density>.*</coeflab_density>", "", written), encoding="utf-8")
    with pytest.raises(InputError, match="no density"):
        gazebo.read(path)
    assert gazebo.read(path, density=999.0).conditions.density == 999.0


def test_our_own_model_states_density_and_length(tmp_path: Path) -> None:
    file = read_parameter_file(Path("remus100"))
    name = next(iter(fluid.render(file)))
    (tmp_path / name).write_bytes(fluid.render(file)[name])
    back = read_model_file(tmp_path / name).parameters
    assert back.conditions.density == file.conditions.density
    assert back.scaling == file.scaling
    yv, yuv = back.coefficient("Yuv"), file.coefficient("Yuv")
    assert yv.value == pytest.approx(yuv.value, rel=1e-9)
