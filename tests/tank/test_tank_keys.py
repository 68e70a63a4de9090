"""tank.toml: what it says becomes a tank, and everything that is wrong with it is said with its line."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.core.errors import InputError, PluginError
from coeflab.tank.tank_file import declared_body, default_tank, default_text, read_tank
from coeflab.tank.test_matrix import Half, Kind
from tests.tank.towed_bodies import BODY_FILE, LENGTH, with_mirrors

WATER = '[conditions]\nspeed = "2 m/s"\ndensity = 998.0\nviscosity = 1e-6\n'


@pytest.fixture
def tank_file(tmp_path: Path) -> Path:
    return tmp_path / "tank.toml"


def written(path: Path, text: str, head: str = '[tank]\nsolver = "external"\n') -> Path:
    path.write_text(head + text, encoding="utf-8")
    return path


def refused(path: Path, text: str, **more: str) -> InputError:
    with pytest.raises(InputError) as why:
        read_tank(written(path, text, **more), with_mirrors("y"), body_file=BODY_FILE)
    assert why.value.file == path
    return why.value


def test_the_shortest_file_takes_the_rest_from_the_body(tank_file: Path) -> None:
    tank = read_tank(written(tank_file, WATER), with_mirrors("yz4"), body_file=BODY_FILE)
    assert (tank.name, tank.body) == ("suboff_bare_hull", BODY_FILE.resolve())
    assert tank.datum.id == "nose"
    assert tank.reference_point.tolist() == pytest.approx([-2.01296, 0.0, 0.0], abs=1e-5)
    assert (tank.scaling.length_name, tank.scaling.length) == ("LBP", pytest.approx(LENGTH, rel=1e-5))
    assert (tank.conditions.speed, tank.conditions.density, tank.conditions.viscosity) == (2.0, 998.0, 1e-6)
    assert [g.name for g in tank.grids] == ["coarse", "medium", "fine"]
    assert tank.grid("medium").size == 1.0
    assert tank.symmetry == ("port-starboard", "up-down", "fourfold")
    assert len(tank.matrix) == 13
    assert (tank.solver, tank.runner, tank.cores) == ("external", "local", 1)


def test_what_the_file_says_is_what_is_towed(tank_file: Path) -> None:
    text = """
[scaling]
length = "4.356 m"
length_name = "LOA"
[matrix]
drift = ["2 deg", "-4 deg"]
attack = []
yaw = [0.2]
pitch = [-0.1]
speeds = ["1 m/s"]
combined = [{ drift = "4 deg", yaw = 0.2 }]
control = [{ name = "delta_r", angles = ["5 deg"] }, { name = "dr", angles = ["-5 deg"] }]
[[grid]]
name = "fine"
size = 0.8
[[grid]]
name = "finest"
size = 0.6
[[study]]
of = ["yaw+0.2"]
grid = ["fine", "finest"]
iterations = [2000]
[solver.external]
made_by = "tank X"
"""
    head = '[tank]\nname = "mine"\ntitle = "Mine"\nbody = "suboff_bare_hull"\nsolver = "external"\ncores = 2\n'
    head += 'reference_point = ["-2 m", 0, 0]\n'
    tank = read_tank(written(tank_file, WATER + text, head), with_mirrors("y"))
    assert [c.name for c in tank.matrix] == [
        "straight", "straight_port", "drift+2", "drift-4", "yaw+0.2", "pitch-0.1", "drift+4_yaw+0.2", "dr+5", "dr-5",
        "speed+1", "yaw+0.2_grid_fine", "yaw+0.2_grid_finest", "yaw+0.2_iterations_2000",
    ]  # fmt: skip
    arm = next(c for c in tank.matrix if c.name == "yaw+0.2")
    assert arm.rates[2] == pytest.approx(0.2 * 2.0 / 4.356)
    assert [g.name for g in tank.grids] == ["medium", "fine", "finest"]
    assert tank.reference_point.tolist() == [-2.0, 0.0, 0.0]
    assert (tank.name, tank.title, tank.cores) == ("mine", "Mine", 2)
    assert tank.options["made_by"] == "tank X"
    assert declared_body(tank_file) == BODY_FILE


def test_symmetry_can_be_refused(tank_file: Path) -> None:
    head = '[tank]\nsolver = "external"\nsymmetry = false\n'
    tank = read_tank(written(tank_file, WATER, head), with_mirrors("yz4"), body_file=BODY_FILE)
    assert {c.half for c in tank.matrix} == {Half.WHOLE}
    assert tank.symmetry == tank.by_symmetry == ()
    drift = [c.velocity[1] for c in tank.matrix if c.kind is Kind.DRIFT]
    assert min(drift) < 0.0 < max(drift)


def test_without_a_surface_the_whole_body_is_towed_on_both_sides(tank_file: Path) -> None:
    tank = read_tank(written(tank_file, WATER), body_file=BODY_FILE)
    assert tank.symmetry == ()
    assert {c.half for c in tank.matrix} == {Half.WHOLE}
    assert tank.scaling.length == pytest.approx(LENGTH, rel=1e-5)


def test_a_body_without_a_file_has_the_tank_of_the_default_text(tank_file: Path) -> None:
    body = with_mirrors("yz4")
    default = default_tank(BODY_FILE, body, solver="external")
    text = default_text(body)
    assert set(tomllib.loads(text)) == {"tank", "conditions", "matrix"}
    assert '"4.26086' in text
    tank_file.write_text(text)
    again = read_tank(tank_file, body, body_file=BODY_FILE, solver="external")
    assert [c.name for c in again.matrix] == [c.name for c in default.matrix]
    assert again.conditions == default.conditions
    assert default.conditions.viscosity == 1.0034e-6


@pytest.mark.parametrize("mirrors", ["", "y", "yz4"])
def test_the_comments_of_the_default_text_can_be_switched_on(tank_file: Path, mirrors: str) -> None:
    """What stands behind # is no prose only: with the signs taken away it is a tank.toml of this body, with its defaults."""
    body = with_mirrors(mirrors, nose=3.0, stern=-6.0)
    default = default_tank(BODY_FILE, body, solver="external")
    text = "\n".join(
        line.removeprefix("# ") if line.startswith("# ") and (" = " in line or line.startswith("# [")) else line
        for line in default_text(body).splitlines()
        if not line.startswith("# symmetry")
    )
    tank_file.write_text(text)
    tank = read_tank(tank_file, body, body_file=BODY_FILE, solver="external")
    assert sum(c.kind is Kind.COMBINED for c in tank.matrix) == 1
    assert sum(c.grid == "fine" for c in tank.matrix) == 2
    swept = {c.name: (*c.velocity, *c.rates) for c in tank.matrix if c.kind is not Kind.COMBINED and c.grid == "medium"}
    assert swept == {c.name: pytest.approx((*c.velocity, *c.rates)) for c in default.matrix}
    assert tank.scaling == default.scaling


def test_the_default_text_turns_controls_that_the_body_has(tank_file: Path) -> None:
    assert "# control = []" in default_text(with_mirrors("y"))
    body = with_mirrors("y")
    turned = replace(body, body=replace(body.body, controls=(SimpleNamespace(name="dr"),)))  # type: ignore[arg-type]
    line = next(line for line in default_text(turned).splitlines() if line.startswith("# control"))
    tank_file.write_text(f'[tank]\nsolver = "external"\n{WATER}[matrix]\n{line.removeprefix("# ")}\n')
    tank = read_tank(tank_file, turned, body_file=BODY_FILE)
    assert sum(c.kind is Kind.CONTROL for c in tank.matrix) == 4


@pytest.mark.parametrize(
    ("text", "words", "line"),
    [
        (WATER + "[matrix]\ndrift = [2]\n", "an angle without a unit", 8),
        (WATER + '[matrix]\ndrift = ["2 rad"]\n', "below 60 deg", 8),
        (WATER + "[matrix]\ndrift = 2\n", "a list of different angles", 8),
        (WATER + '[matrix]\nyaw = [0.1, "0.1"]\n', "twice", 8),
        (WATER + "[matrix]\nyaw = [0, 0.1]\n", "straight runs are added", 8),
        (WATER + "[matrix]\nyaw = [4]\n", "up to 3", 8),
        (WATER + "[matrix]\nspeeds = [-1]\n", "numbers above zero", 8),
        (WATER + "[matrix]\ndrft = []\n", "Did you mean matrix.drift", 8),
        (WATER + '[matrix]\ndrift = ["2 deg", "-2 deg"]\n', "symmetry = false", 7),
        (WATER + '[matrix]\ncombined = [{ drift = "2 deg" }]\n', "two motions at once", 8),
        (WATER + '[matrix]\ncontrol = [{ name = "flap", angles = [] }]\n', "delta_r", 8),
        (WATER + '[[study]]\nof = ["drift+2"]\n', "nothing to vary", 7),
        (WATER + '[[study]]\nof = []\ngrid = ["fine"]\n', "no condition", 8),
        (WATER + '[[study]]\nof = ["drift+3"]\ngrid = ["fine"]\n', "a condition of the matrix", 8),
        (WATER + '[[study]]\nof = ["drift+2"]\ngrid = ["huge"]\n', "one of coarse, fine", 9),
        (WATER + '[[grid]]\nname = "medium"\nsize = 2\n', "over that of medium", 9),
        (WATER + '[[grid]]\nname = "a/b"\nsize = 2\n', "it names folders", 8),
        (WATER + "[solver.external]\nspeling = 1\n", "solver.external.speling", 8),
        (WATER + "[solver.nothing]\na = 1\n", "external", 7),
        (WATER + "[runner.nothing]\na = 1\n", "local", 7),
        ('[conditions]\nspeed = "2 m/s"\ndensity = 998\n', "Add conditions.viscosity", 3),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tank_file: Path, text: str, words: str, line: int) -> None:
    why = refused(tank_file, text)
    assert words in str(why)
    assert why.line == line


def test_everything_wrong_is_said_at_once(tank_file: Path) -> None:
    why = refused(tank_file, '[conditions]\nspeed = 0\ndensity = "2 m"\n[matrix]\nyaw = 1\n')
    assert len(why.others) == 3


def test_body_solver_and_cores(tank_file: Path) -> None:
    assert "Add tank.body" in str(_raised(written(tank_file, WATER), None))
    head = '[tank]\nsolver = "external"\nbody = "remus100"\n'
    assert "the body that is to be towed" in str(_raised(written(tank_file, WATER, head), BODY_FILE))
    assert "one of" in str(_raised(written(tank_file, WATER, '[tank]\nsolver = "magic"\n'), BODY_FILE))
    assert "from 1 to" in str(_raised(written(tank_file, WATER, "[tank]\ncores = 0\n"), BODY_FILE))
    with pytest.raises(PluginError, match="magic"):
        read_tank(written(tank_file, WATER), body_file=BODY_FILE, solver="magic")


def _raised(path: Path, body_file: Path | None) -> InputError:
    with pytest.raises(InputError) as why:
        read_tank(path, body_file=body_file)
    return why.value


def test_rates_reach_as_far_as_the_ends_allow(tank_file: Path) -> None:
    tank = read_tank(written(tank_file, WATER), with_mirrors("yz"), body_file=BODY_FILE)
    rates = np.array([c.rates[2] for c in tank.matrix if c.kind is Kind.ARM]) * tank.scaling.length / 2.0
    assert rates.max() <= np.sin(np.radians(12.0)) * tank.scaling.length / 2.343 + 1e-9
