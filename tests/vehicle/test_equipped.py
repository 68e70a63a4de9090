"""A plan's body with [[mass]] and [[thruster]] in the parameter file of its coefficients, or a word that it is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import coeflab as cf

BODY = """[body]
name = "petrel"
title = "Own craft"
reader = "primitives"
datum = "midship"
reference_point = [0.0, 0.0, 0.0]
[source]
citation = "own numbers"
kind = "synthetic"
[prime]
length = 0.5
length_name = "hull"
[[part]]
name = "hull"
form = "box"
length = 0.3
width = 0.1
height = 0.1
centre = [0.0, 0.0, 0.0]
[[mass]]
name = "all"
mass = "3.1 kg"
form = "box"
length = 0.3
width = 0.3
height = 0.08
centre = [0.0, 0.0, 0.012]
[[thruster]]
name = "rotor1"
place = [0.21, 0.19, -0.04]
axis = [0.0, 0.0, -1.0]
bollard = "9 N"
rate = 3000.0
tilt_axis = [0.0, 1.0, 0.0]
tilt_limit = "180 deg"
"""
PLAN = """[study]
name = "petrel"
[body]
path = "body.toml"
[[table]]
campaign = "sweeps"
fits = ["linear_quadratic_damping"]
[[parameter_file]]
name = "petrel"
body = "{body}"
campaigns = ["sweeps"]
"""
CAMPAIGN = """[campaign]
name = "sweeps"
title = "Own sweeps"
body = "{body}"
[axes]
frame = "FRD"
datum = "midship"
reference_point = [0.0, 0.0, 0.0]
[scaling]
length = 0.5
length_name = "hull"
[conditions]
density = 1000.0
speed = 1.0
[source]
citation = "own numbers"
kind = "synthetic"
how_obtained = "computed"
[[table]]
file = "table.csv"
"""


@pytest.mark.parametrize("of", ["petrel", "petrel_in_air"])
def test_masses_and_thrusters_of_a_plans_body(tmp_path: Path, of: str) -> None:
    (tmp_path / "sweeps").mkdir()
    rows = [f"{i},{u},{-(0.2 + 12 * abs(u)) * u}" for i, u in enumerate(np.linspace(-1.0, 1.0, 8))]
    (tmp_path / "sweeps" / "table.csv").write_text("\n".join(["point,u [m/s],X [N]", *rows]) + "\n")
    (tmp_path / "sweeps" / "campaign.toml").write_text(CAMPAIGN.format(body=of))
    (tmp_path / "body.toml").write_text(BODY)
    (tmp_path / "plan.toml").write_text(PLAN.format(body=of))
    file = cf.run(tmp_path / "plan.toml").vehicle().file
    left_out = [f for f in file.findings if f.code == "parameter_file.unequipped"]
    if of != "petrel":
        assert (file.mass, file.thrusters) == (None, ())
        assert [(f["lacks"], f.advice) for f in left_out] == [(("mass", "1 thruster"), 'campaign.body = "petrel"')]
        return
    assert left_out == []
    assert (file.mass.mass, tuple(file.mass.centre), file.hydrostatics.volume) == (
        3.1,
        (0.0, 0.0, 0.012),
        pytest.approx(0.003),
    )
    (rotor,) = file.thrusters
    assert (rotor.position, rotor.direction, rotor.tilt_axis) == (
        (0.21, 0.19, -0.04),
        (0.0, 0.0, -1.0),
        (0.0, 1.0, 0.0),
    )
    assert rotor.curve.segments[-1].coefficients[-1] == pytest.approx(9.0 / 3000.0**2)
