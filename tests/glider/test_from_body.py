"""A glider file of a polar and a body through the shell: masses by hand, its glide by equations written out here."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
from scipy.optimize import fsolve

import coeflab as cf
from coeflab.core.files import shipped
from coeflab.glider.glider_file import read_glider
from tests.cli.conftest import flat

Run = Callable[..., CompletedProcess[str]]
DENSITY, G = 1025.0, 9.80665
L0, L1, D0, D2, M0, M1 = 0.5, 70.0, 4.0, 60.0, 0.2, -12.0  # of V^2, per radian
BATTERY, ELECTRONICS = (9.0, -0.78, 0.03), (12.0, -0.6, 0.02)  # kg, x and z from the nose
LEAD = 0.015  # z; along x it brings the centre of gravity into the plane of the centre of buoyancy
BODY = f"""[body]
name = "soar"
title = "Own glider"
reader = "finned"
datum = "nose"
reference_point = [-0.8, 0.0, 0.0]
[source]
citation = "own numbers"
kind = "synthetic"
[prime]
length = 1.8
length_name = "LOA"
[hull]
kind = "myring"
nose = 0.3
middle = 1.0
tail = 0.5
diameter = 0.22
exponent = 2.0
tail_angle = "20 deg"
[[fin]]
name = "wing_starboard"
section = "NACA 0012"
roll = "0 deg"
root = 0.0
tip = 0.6
root_chord = 0.16
tip_chord = 0.1
trailing_edge = -0.95
[[fin]]
name = "wing_port"
section = "NACA 0012"
roll = "180 deg"
root = 0.0
tip = 0.6
root_chord = 0.16
tip_chord = 0.1
trailing_edge = -0.95
[water]
density = {DENSITY}
""" + "".join(
    f'[[mass]]\nname = "{name}"\n{mass}\ncentre = [{x}, 0.0, {z}]\n'
    for name, mass, x, z in (
        ("battery", f'mass = "{BATTERY[0]} kg"', *BATTERY[1:]), ("electronics", f'mass = "{ELECTRONICS[0]} kg"', *ELECTRONICS[1:]),
        ("lead", "ballast = true", "LEAD_AT", LEAD),
    )
)  # fmt: skip
CAMPAIGN = """[campaign]
name = "soar_polar"
title = "Own polar"
body = "soar"
[axes]
frame = "FRD"
alpha = "w = +U sin(alpha)"
datum = "{datum}"
reference_point = [{point}, 0.0, 0.0]
[scaling]
length = 1.8
length_name = "LOA"
[conditions]
density = 1025.0
speed = 0.5
[source]
citation = "own numbers"
kind = "synthetic"
how_obtained = "computed"
[[table]]
file = "table.csv"
contains_inertia = false
"""
ASKED = (
    "--engine", "0.5 kg", "--net-mass", "300 g", "--sliding", "battery", "--travel", "8 cm", "--shift", "0.07", "--pitch-damping", "7", "--depth", "40",
    "--method", "strip", "--out", "mine",
)  # fmt: skip


def polar(folder: Path, middle: float, datum: str = "cb", lever: float = 0.0) -> Path:
    """The planted polar about the centre of buoyancy; the table's moments are about a point ``lever`` ahead of it."""
    rows = ["point,U [m/s],alpha [deg],X [N],Z [N],M [N*m]"]
    for speed in (0.3, 0.5):
        for degrees in range(-8, 9, 2):
            a, q = np.radians(degrees), speed**2
            lift, drag, pitch = (L0 + L1 * a) * q, (D0 + D2 * a * a) * q, (M0 + M1 * a) * q
            x, z = -drag * np.cos(a) + lift * np.sin(a), -drag * np.sin(a) - lift * np.cos(a)
            rows.append(
                f"{len(rows)},{speed},{degrees},{x!r},{z!r},{pitch + lever * z!r}".replace("np.float64(", "").replace(
                    ")", ""
                )
            )
    folder.mkdir()
    (folder / "table.csv").write_text("\n".join(rows) + "\n")
    (folder / "campaign.toml").write_text(CAMPAIGN.format(datum=datum, point=repr(middle + lever)))
    return folder


@pytest.fixture
def body(tmp_path: Path) -> Path:
    file = tmp_path / "body.toml"
    file.write_text(BODY.replace("LEAD_AT", "-0.8"))
    x_b = middle_of(file)
    arms = sum(mass * (x - x_b) for mass, x, _ in (BATTERY, ELECTRONICS))
    file.write_text(BODY.replace("LEAD_AT", repr(x_b - arms / lead_of(file))))
    return file


def lead_of(body: Path) -> float:
    return DENSITY * float(cf.read_body(body).mass_model.volume) - BATTERY[0] - ELECTRONICS[0]


def middle_of(body: Path) -> float:
    return float(cf.read_body(body).mass_model.centre_of_buoyancy[0])


def test_masses_are_those_of_the_parts_and_the_glide_that_of_the_equations(
    coeflab: Run, body: Path, tmp_path: Path
) -> None:
    """The polar is given about the nose's datum, 0.1 m ahead of the centre of buoyancy: the file has it about that centre."""
    hull, x_b = cf.read_body(body), middle_of(body)
    done = coeflab("glider", polar(tmp_path / "polar", x_b, "nose", 0.1), "--body", body, *ASKED)
    assert (done.returncode, done.stderr) == (0, "")
    assert "coeflab glide mine/soar.glider.toml" in flat(done.stdout)
    found = read_glider(tmp_path / "mine" / "soar.glider.toml")
    water = hull.added_mass("strip", DENSITY).about(np.array([x_b, 0.0, 0.0])).matrix
    lead, lead_at = lead_of(body), next(p.centre[0] for p in hull.mass_model.parts if p.name == "lead")
    others = (ELECTRONICS, (lead, lead_at, LEAD))
    mass = lead + ELECTRONICS[0]
    assert (found.mass.surge, found.mass.heave) == pytest.approx((mass + water[0, 0], mass + water[2, 2]), rel=1e-9)
    ahead, below = (G * sum(m * (at[k] - (x_b, 0.0)[k]) for m, *at in others) for k in (0, 1))
    assert (found.mass.moment_ahead, found.mass.moment_below) == pytest.approx((ahead, below), rel=1e-9)
    turning = sum(m * ((x - x_b) ** 2 + z**2) for m, x, z in others)
    assert found.mass.pitch_inertia == pytest.approx(turning + water[4, 4], rel=1e-9)
    p = found.polar.per_radian
    assert (*p.lift, *p.drag, *p.moment) == pytest.approx((L0, L1, D0, D2, M0, M1), rel=1e-6)

    def left(x: np.ndarray, way: float) -> list[float]:
        v, a, pitch = x
        weight, q, flight = way * 0.3 * G, v * v, pitch - a
        moved = ahead + BATTERY[0] * G * (BATTERY[1] - x_b + way * 0.07)
        under = below + BATTERY[0] * G * BATTERY[2]
        return [
            (L0 + L1 * a) * q - weight * np.cos(flight), (D0 + D2 * a * a) * q + weight * np.sin(flight),
            (M0 + M1 * a) * q - moved * np.cos(pitch) - under * np.sin(pitch),
        ]  # fmt: skip

    told = json.loads(coeflab("glide", tmp_path / "mine" / "soar.glider.toml", "--json").stdout)["gliders"][0]
    assert [(p["met_depth"], p["depth"]) for p in told["phases"]] == [
        (True, pytest.approx(40.0)),
        (True, pytest.approx(0.0, abs=1e-6)),
    ]
    assert [s["phase"] for s in told["steady_glides"]] == ["dive", "climb"]
    for glide, way in zip(told["steady_glides"], (1.0, -1.0), strict=True):
        due = fsolve(left, [0.5, way * 0.05, -way * 0.5], args=(way,), xtol=1e-12)
        assert [glide["speed"], glide["alpha"], glide["theta"]] == pytest.approx(due, rel=1e-5)


def test_a_munk_moment_of_no_hull_is_warned_of(coeflab: Run, tmp_path: Path) -> None:
    own = (shipped("cfd_data") / "slocum" / "slocum.toml").read_text()
    assert [f.code for f in read_glider(shipped("cfd_data") / "thauv" / "case_01.toml").findings] == ["glider.munk"]
    for heave, share in (("110 kg", None), ("160 kg", 115.0 / 45.0), ("40 kg", -5.0 / 45.0)):
        (tmp_path / "own.toml").write_text(own.replace('heave = "110 kg"', f'heave = "{heave}"'))
        found = read_glider(tmp_path / "own.toml").findings
        assert [f.statistic for f in found] == ([] if share is None else [pytest.approx(share)])
    done = coeflab("glide", "own.toml", "--json")
    assert [f["code"] for f in json.loads(done.stdout)["gliders"][0]["findings"]] == ["glider.munk"]
    assert "warn" in coeflab("glide", "own.toml").stdout


@pytest.mark.parametrize(
    ("change", "asked", "words"),
    [
        ("ballast = true", (), "the same within"),
        ("", ("--sliding", "wings"), "battery, electronics, lead"),
        ("", ("--net-mass", "0.7"), "--net-mass"),
        ("", ("--shift", "9 cm"), "--shift"),
        ("", ("--engine", "x"), "--engine"),
    ],
)
def test_what_it_refuses(
    coeflab: Run, body: Path, tmp_path: Path, change: str, asked: tuple[str, ...], words: str
) -> None:
    campaign = polar(tmp_path / "polar", middle_of(body), "nose")
    if change == "ballast = true":
        body.write_text(body.read_text().replace(change, 'mass = "10 kg"'))
    given = dict(zip(ASKED[::2], ASKED[1::2], strict=True)) | dict(zip(asked[::2], asked[1::2], strict=True))
    words_typed = [word for pair in given.items() for word in pair]
    done = coeflab("glider", campaign, "--body", body, *words_typed)
    assert (done.returncode, done.stdout) == (2, "")
    assert words in done.stderr
    assert not (tmp_path / "mine").exists()
