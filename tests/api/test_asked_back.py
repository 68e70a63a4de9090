"""What a person gets wrong from Python is asked back in the words of Python: keywords, no options of the shell, the near name."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import coeflab as cf
from coeflab.core.errors import InputError, OutputError
from coeflab.core.keywords import in_shell, option, spoken

V = np.linspace(-0.3, 0.3, 9)
KNOWN = {"frame": "FRD", "length": 2.0, "length_name": "LOA", "density": 1000, "speed": 2.0, "about": "nose"}
ARM = {"contains_inertia": False, "arm_point": "reference point"}
DRIFT = {"v [m/s]": V, "Y [N]": -120.0 * V, "N [N m]": -60.0 * V}
YAW = {"r [rad/s]": V, "Y [N]": 20.0 * V, "N [N m]": -60.0 * V}


def table(columns: dict[str, Any] = DRIFT, **words: Any) -> cf.Table:
    return cf.read_table(columns, **{**KNOWN, **words})


def without(keyword: str, columns: dict[str, Any]) -> cf.Table:
    return cf.read_table(columns, **{k: v for k, v in KNOWN.items() if k != keyword})


def mesh(folder: Path) -> str:
    ball = trimesh.creation.icosphere(subdivisions=2)
    ball.apply_scale([1.0, 0.2, 0.2])
    ball.export(folder / "hull.stl")
    return str(folder / "hull.stl")


DRIFT_ANGLES = {"beta [deg]": V, "Y [N]": -120.0 * V}
ASKED: dict[str, tuple[Callable[[], Any], str]] = {
    "rudder of twin screws": (
        lambda: cf.simulate("huuv", "turning_circle"),
        'commands={"left": 100, "right": 100}, unequal',
    ),
    "a misspelt keyword": (lambda: table(lenght=2), "Did you mean length?"),
    "a symbol": (lambda: table(rho=1000), "Did you mean density?"),
    "units": (lambda: table({"v [m/s]": V, "Fy": V}), 'columns={"Fy": "Y [kN]"}'),
    "a length": (lambda: without("length", DRIFT_ANGLES) and None, "4.3 m LOA"),
    "a sign": (lambda: without("frame", DRIFT_ANGLES), 'beta="+" if y is starboard, else beta="-"'),
    "inertia": (lambda: table(YAW), "with mass, centre_of_gravity"),
    "a text": (lambda: table(DRIFT | {"Y [N]": ["a"] * 9}), "no cell is a number"),
    "a term": (lambda: cf.fit(table(), terms=["Yq"]), "Yq zero on every row"),
    "a campaign": (lambda: cf.estimate("suboff_roddy_2"), "shipped campaign"),
    "a body": (lambda: cf.fit("spheroid_example"), "shipped body"),
    "degrees of a manoeuvre": (lambda: cf.simulate("remus100", "zigzag", rudder=20), '"20 deg"'),
    "degrees of a motion": (lambda: cf.trim("remus100", speed=1.5, roll=5), '"5 deg"'),
    "degrees of a command": (lambda: cf.trim("remus100", speed=1.5, commands={"dr": 10}), '"10 deg"'),
    "degrees of a test": (lambda: cf.next_tests("suboff_bare_hull", angle=15), '"15 deg"'),
    "draws": (lambda: cf.fit(table()).samples(-1), "from 1"),
    "no motion": (lambda: cf.trim("remus100"), "a yaw rate"),
    "a point twice": (lambda: cf.fit([table(), table()]), "twice"),
    "an ending": (lambda: cf.read_vehicle("remus100").save("x.txt"), "ends in .json"),
}


@pytest.mark.parametrize("case", ASKED)
def test_it_is_asked_back_in_words_of_python(case: str) -> None:
    call, words = ASKED[case]
    with pytest.raises(InputError) as caught:
        call()
    assert words in str(caught.value)
    assert " --" not in str(caught.value)


def test_a_mass_is_complained_of_by_its_keyword() -> None:
    with pytest.raises(InputError) as caught:
        cf.vehicle("remus100", mass=3000)
    assert caught.value.column == "mass"


def test_no_accept_settles_whether_forces_contain_inertia() -> None:
    with pytest.raises(InputError, match="contains_inertia"):
        table(YAW, accept=True)


def test_both_names_of_axes_and_units_are_taken(tmp_path: Path) -> None:
    words = {k: v for k, v in KNOWN.items() if k != "frame"}
    assert cf.read_table(DRIFT, axes="FRD", unit="SI", **words).varies == ("v",)
    path = mesh(tmp_path)
    assert cf.read_body(path, units="m", frame="FRD").volume == cf.read_body(path, unit="m", axes="FRD").volume


def test_a_mesh_says_how_its_tables_name_the_middle(tmp_path: Path) -> None:
    hull = cf.read_body(mesh(tmp_path), unit="m", axes="FRD")
    with pytest.raises(InputError, match='about="nose, 1 m aft"'):
        cf.vehicle(hull, coefficients=cf.fit(table(about="mid-length")))


def test_tables_that_nobody_named_are_told_apart() -> None:
    both = cf.fit([table(), table(YAW, **ARM)])
    assert [f.campaign for f in both.fits] == ["table_v", "table_r"]
    changed = DRIFT | {"Y [N]": -121.0 * V}
    assert [f.campaign for f in cf.fit([table(), table(changed)]).fits] == ["table_1", "table_2"]
    assert cf.fit(table()).fits[0].campaign == "table"


ROOT = Path(cf.__file__).parent
# What the front door has no verb for: commands, reports as files, whole applications, programs of others.
ELSEWHERE = re.compile(r"(?:cli|identify|glider|arm|published|report|tank|bodies/simplify)/|core/table|.*/commands/")


def test_every_option_that_a_message_names_is_a_keyword_in_python() -> None:
    taken = {k for f in (ROOT / "api").glob("*.py") for k in re.findall(r"(\w+):", f.read_text())}
    taken |= {
        k
        for kind in ("motion", "formats", "vehicle", "tank")
        for f in (ROOT / kind).rglob("*.py")
        for k in re.findall(r"(\w+):", f.read_text())
    }
    named = set()
    for file in ROOT.rglob("*.py"):
        if not ELSEWHERE.match(file.relative_to(ROOT).as_posix()) and "--" in (text := file.read_text()):
            named |= set(re.findall(r"(?<![\w`-])--[a-z][a-z-]*", re.sub(r"#.*|coeflab [a-z-]+[^`;\"']*", "", text)))
    assert len(named) > 40
    assert not {n for n in named if re.split(r"\W", spoken(n))[0] not in taken}
    for made in (InputError("a", "--hold u", column="--accept-loss", advice="--as x"), OutputError("--out")):
        assert "--" not in str(made)
    with in_shell():
        assert str(InputError("a", "--hold u", column=option("wanted"))) == '"--for": found a; expected --hold u.'


@pytest.mark.parametrize(
    ("more", "column"),
    [
        ({"numbers": {"Yv": 3.0}}, "numbers"), ({"numbers": {"Yzz'": 3}}, "numbers"), ({"rudder": "25"}, "rudder"),
        ({"stern_planes": "25 kg"}, "stern_planes"), ({"thrusters": "main; bolard = 3 N"}, "thruster"),
        ({"thrusters": ["a; bollard = 3 N; rate = 3"] * 2}, "thruster"),
    ],
)  # fmt: skip
def test_numbers_fins_and_thrusters_of_a_vehicle(more: dict[str, Any], column: str) -> None:
    with pytest.raises(InputError) as why:
        cf.vehicle("spheroid_example", mass=390, method="ellipsoid", **more)
    assert why.value.column == column


def test_a_vehicle_of_a_shape_is_steered_and_driven_by_numbers() -> None:
    own = {"Ydr'": 0.008, "Ndr'": "-0.004 +- 0.001", "Yv": "-300 N/(m/s) constant"}
    auv = cf.vehicle(
        "spheroid_example", mass=390, method="ellipsoid", numbers=own, rudder="25 deg, 20 deg/s",
        thrusters=["main; bollard = 60 N; rate = 720; lag = 0.3 s"],
    )  # fmt: skip
    assert (auv["Ndr'"].value, auv["Ndr'"].u95, auv["Yv'"].law) == (-0.004, 0.001, "rest")
    assert [(s.control, round(np.degrees(s.limit)), round(np.degrees(s.rate or 0.0))) for s in auv.file.surfaces] == [
        ("dr", 25, 20)
    ]
    assert [(t.name, t.lag, round(t.curve.at(720.0), 9)) for t in auv.file.thrusters] == [("main", 0.3, 60.0)]
    turn = auv.simulate("turning_circle", rudder="10 deg").frame().iloc[-1]
    assert turn["r [rad/s]"] * turn["dr [rad]"] < 0.0  # Ndr < 0: dr > 0 turns to port
