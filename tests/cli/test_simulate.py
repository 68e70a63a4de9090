"""``coeflab simulate`` as a real process: options explained, what is drawn, input that cannot be."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from coeflab.cli.simulate import of_manoeuvre
from coeflab.core.errors import InputError
from coeflab.motion.manoeuvres import MANOEUVRES
from tests.cli.conftest import Run, flat
from tests.motion.uncertain import with_uncertainty
from tests.motion.vehicles import STABLE, made, rudder_covered

FREE = ("--free", "u,v,r")


@pytest.fixture
def torpedo(tmp_path: Path) -> Path:
    path = tmp_path / "torpedo.parameters.json"
    path.write_bytes(made().to_json())
    return path


@pytest.mark.parametrize("command", ["simulate", "uncertainty"])
def test_options_of_a_manoeuvre_are_explained(coeflab: Run, torpedo: Path, command: str) -> None:
    done = coeflab(command, torpedo, "--manoeuvre", "zigzag", "--help-options")
    assert (done.returncode, done.stderr) == (0, "")
    assert "Options of zigzag" in flat(done.stdout)
    assert "executes" in flat(done.stdout)


def test_a_current_is_said(coeflab: Run, torpedo: Path) -> None:
    done = coeflab("simulate", torpedo, *FREE, "--current", "0.3,-0.2,0", "--rudder", "10 deg")
    assert (done.returncode, done.stderr) == (0, "")
    assert "current of 0.3 north, -0.2 east m/s" in flat(done.stdout)


def test_a_bare_angle_is_in_degrees_and_refused_where_it_may_be_in_radians(coeflab: Run, torpedo: Path) -> None:
    zigzag = ("simulate", torpedo, "--manoeuvre", "zigzag", *FREE, "--json")
    bare = coeflab(*zigzag, "--rudder", "20", "--heading", "0")
    assert bare.returncode in (0, 1), bare.stderr
    assert bare.stdout == coeflab(*zigzag, "--rudder", "20 deg").stdout
    refused = coeflab(*zigzag, "--rudder", "0.35")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert '"zigzag.rudder": found 0.35, an angle without a unit; expected degrees, at least 1.6' in refused.stderr
    assert '"0.35 rad"' in refused.stderr
    assert coeflab(*zigzag, "--rudder", "0.35 rad").returncode in (0, 1)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--step", "0.01"), "a step of 0.01 s for the adaptive integrator"),
        (("--current", "1,2"), "three numbers in m/s"),
        (("--manoeuvre", "loop"), "Known: depth_change"),
        (("--manoeuvre", "free_decay"), "p held"),
        (("--commands", "left.tilt=10"), "one of thrust"),
    ],
)
def test_what_cannot_be_is_one_message(coeflab: Run, torpedo: Path, words: tuple[str, ...], says: str) -> None:
    done = coeflab("simulate", torpedo, *FREE, *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("error:") == 1
    assert says in done.stderr


@pytest.mark.parametrize("command", ["simulate", "uncertainty"])
def test_what_a_file_determines_nothing_of_is_said_once(coeflab: Run, tmp_path: Path, command: str) -> None:
    """The README's own zigzag drew an empty figure, leaked four warnings of Python, and ran 1000 draws for six empty rows."""
    path = tmp_path / "unstable.parameters.json"
    path.write_bytes(with_uncertainty(rudder_covered(np.radians(15.0), 1.0), {"Nr'": 1e-3}, {}).to_json())
    done = coeflab(command, path, "--manoeuvre", "zigzag", "--rudder", "20 deg", *FREE, "--out", "zigzag")
    assert (done.returncode, done.stderr) == (1, "")
    assert (
        "rudder angle = -20.00 deg is outside the data, -15.00 to 15.00 deg. The vehicle is unstable, and the turn goes beyond the data: by the file's own law"
        in flat(done.stdout)
    )
    assert "not determined" not in flat(done.stdout)
    assert not (tmp_path / "zigzag").exists()
    within = coeflab("simulate", path, "--manoeuvre", "zigzag", "--rudder", "10 deg", *FREE, "--out", "zigzag")
    assert (within.returncode, within.stderr) == (0, "")
    drawing = (tmp_path / "zigzag" / "zigzag.svg").read_text(encoding="utf-8")
    assert "<desc>no added mass is known</desc>" in drawing
    path.write_bytes(with_uncertainty(rudder_covered(np.radians(15.0)), {"Nr'": 1e-3}, {}).to_json())
    said = set()
    for manoeuvre in ("zigzag", "turning_circle"):
        bare = coeflab(command, path, "--manoeuvre", manoeuvre, "--rudder", "10 deg", *FREE, "--json")
        assert bare.returncode == 1, manoeuvre
        said.add(json.loads(bare.stdout)["undetermined"])
    assert said == {
        "The vehicle is unstable, and no data on r': by the file's own law the turn ends at 44.7 deg of drift and r' 4.2."
    }


def test_without_control_surfaces_the_way_out_exists(coeflab: Run, tmp_path: Path) -> None:
    path = tmp_path / "bare.parameters.json"
    path.write_bytes(made({k: v for k, v in STABLE.items() if k[1:] not in ("dr", "ds")}).to_json())
    done = coeflab("simulate", path, *FREE)
    assert done.returncode == 2
    assert "neither control surfaces nor thrusters: the manoeuvres stop and straight_run need none" in done.stderr
    huuv = Path(__file__).parents[2] / "cfd_data" / "huuv" / "huuv.parameters.json"
    told = coeflab("simulate", huuv).stderr
    assert '--commands "left=100 right=100", unequal' in told
    assert coeflab("simulate", huuv, "--commands", "left=40 right=100").returncode == 0


def test_what_sinks_and_what_nothing_rights_is_said(coeflab: Run, tmp_path: Path) -> None:
    """REMUS 100 with 2 % less volume than weight, and with its centre of gravity in that of buoyancy; as shipped neither."""
    content = json.loads(
        (Path(__file__).parents[2] / "cfd_data" / "remus100" / "remus100.parameters.json").read_bytes()
    )
    place = tmp_path / "heavy.parameters.json"
    run = ("--manoeuvre", "straight_run", "--duration", "5")
    place.write_text(json.dumps(content))
    done = coeflab("simulate", place, *run)
    assert "buoyancy" not in done.stdout, done.stdout
    content["hydrostatics"]["volume"] *= 0.98
    content["hydrostatics"]["centre_of_buoyancy"] = content["mass"]["centre"]
    place.write_text(json.dumps(content))
    done = coeflab("simulate", place, *run)
    assert "more than buoyancy (2 %): it sinks" in flat(done.stdout)
    assert "nothing rights it in roll and pitch" in flat(done.stdout)


STEADY = ("simulate", "remus100", "--manoeuvre", "steady_motion", *FREE, "--speed", "1.2", "--starts", "0", "--json")


def test_a_bare_rate_is_in_degrees_a_second(coeflab: Run) -> None:
    """3 is 3 deg/s as in `trim`, not 3 rad/s; what may be rad/s is refused."""
    bare = coeflab(*STEADY, "--yaw-rate", "3")
    assert bare.returncode == 0, bare.stderr
    assert bare.stdout == coeflab(*STEADY, "--yaw-rate", "3 deg/s").stdout
    radius = next(f for f in json.loads(bare.stdout)["figures"] if f["name"] == "radius")["value"]
    assert radius == pytest.approx(1.2 / np.radians(3.0), rel=1e-3)
    refused = coeflab(*STEADY, "--yaw-rate", "0.05")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert '"steady_motion.yaw_rate": found 0.05, a rate without a unit; expected deg/s' in refused.stderr
    assert '"0.05 rad/s"' in refused.stderr


def test_no_manoeuvre_takes_a_rate_of_turn_bare_in_radians() -> None:
    for name in MANOEUVRES.usable():
        for option in fields(MANOEUVRES.load(name).Options):
            assert option.metadata["unit"] not in ("rad", "rad/s") or option.metadata["bare"].startswith("deg"), option


def test_orders_of_angles_are_in_degrees() -> None:
    turned = of_manoeuvre("turning_circle", ["--commands", "left=60 dr=10"])["commands"]
    assert turned == f"left=60 dr={math.radians(10.0)!r}"
    assert of_manoeuvre("turning_circle", ["--commands", "a.tilt=0.5rad,b.tilt=1deg"])["commands"].startswith(
        "a.tilt=0.5 "
    )
    with pytest.raises(InputError, match=r"dr=0\.2deg"):
        of_manoeuvre("turning_circle", ["--commands", "dr=0.2"])


def test_a_steady_motion_finds_what_is_not_named_as_trim_does(coeflab: Run) -> None:
    """In a turn of REMUS 100 sway cannot be zero: held there, no rudder kept the motion."""
    words = ("--speed", "1.2", "--yaw-rate", "3")
    steady = coeflab("simulate", "remus100", "--manoeuvre", "steady_motion", *words, "--duration", "2", "--json")
    assert steady.returncode == 0, steady.stderr
    said = json.loads(steady.stdout)
    found = {
        u["name"]: u["value"] for u in json.loads(coeflab("trim", "remus100", *words, "--json").stdout)["unknowns"]
    }
    figures = {f["name"]: f["value"] for f in said["figures"]}
    assert abs(found["v"]) > 0.01
    assert figures["radius"] == pytest.approx(np.hypot(1.2, found["v"]) / np.radians(3.0), rel=1e-3)
    assert figures["departure of the velocity"] < 1e-3
    told = "sway, heave, roll, pitch found by the trim: at zero, where they stand unless named, no commands keep this motion"
    assert told in said["statements"]


def test_a_file_with_u95_names_the_command_that_says_how_sure(coeflab: Run, tmp_path: Path) -> None:
    file = tmp_path / "own.parameters.json"
    new = (
        "params",
        "new",
        "own",
        "--about",
        "cg",
        "--length",
        "2 m",
        "--speed",
        "1 m/s",
        "--density",
        "1000",
        "--mass",
        "40 kg",
    )
    values = ("X0'=-0.003", "Yv'=-0.03 +- 0.003", "Nv'=-0.007", "Yr'=0.005", "Nr'=-0.006", "Ydr'=0.01", "Ndr'=-0.005")
    assert (
        coeflab(*new, "--inertia", "12", "--out", file.parent, *(w for v in values for w in ("--set", v))).returncode
        == 0
    )
    asked = (file, "--manoeuvre", "straight_run", "--free", "u,v,r", "--speed", "2 kn")
    done = coeflab("simulate", *asked)
    typed = flat(done.stdout.replace("\\\n", " ")).partition("How sure, and why: ")[2]
    assert typed.startswith("coeflab uncertainty ")
    assert "--manoeuvre straight_run --free u,v,r --speed '2 kn'" in typed
    assert "How sure" not in coeflab("simulate", "remus100", "--manoeuvre", "straight_run").stdout
