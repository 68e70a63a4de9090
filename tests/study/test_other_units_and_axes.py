"""The same physics written by another person: other names, lengths, units, axes, angle sign and reference point."""

from __future__ import annotations

import csv
import re
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from coeflab.report.rendered import rendered
from coeflab.study.plan import read_plan
from coeflab.study.run import run

FOOT, POUND = 0.3048, 4.4482216152605
TEMPLATE = files("coeflab.cli") / "template"
NAMES = ("plan.toml", "body.toml", "campaign/campaign.toml", "campaign/drift.csv", "campaign/rotating_arm.csv")


def write_template(folder: Path) -> Path:
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(TEMPLATE.joinpath(*name.split("/")).read_bytes())
    return folder / "plan.toml"


def rows(name: str) -> list[dict[str, str]]:
    lines = TEMPLATE.joinpath("campaign", name).read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def write_imperial(folder: Path, at: float) -> Path:
    """The template in feet, pounds-force, knots and CFD axes (x aft, y starboard, z up), moments ``at`` metres."""
    write_template(folder)
    shift = at + 0.80
    drift = ["point,beta [deg],X [lbf],Y [lbf],N [ft*lbf]"]
    for r in rows("drift.csv"):
        x, y, n = (float(r[k]) for k in ("X [N]", "Y [N]", "N [N*m]"))
        n -= shift * y
        drift.append(f"{r['point']},{-float(r['beta [deg]'])!r},{-x / POUND!r},{y / POUND!r},{-n / POUND / FOOT!r}")
    arm = ["point,U [ft/s],v [ft/s],r [deg/s],u [ft/s],Y [lbf],N [ft*lbf]"]
    for r in rows("rotating_arm.csv"):
        rate, y, n = (float(r[k]) for k in ("r [rad/s]", "Y [N]", "N [N*m]"))
        n -= shift * y
        v = rate * shift
        cells = (np.hypot(2.0, v) / FOOT, v / FOOT, -np.degrees(rate), -2.0 / FOOT, y / POUND, -n / POUND / FOOT)
        arm.append(r["point"] + "," + ",".join(repr(float(c)) for c in cells))
    (folder / "campaign" / "drift.csv").write_text("\n".join(drift) + "\n")
    (folder / "campaign" / "rotating_arm.csv").write_text("\n".join(arm) + "\n")
    campaign = folder / "campaign" / "campaign.toml"
    text = campaign.read_text()
    for old, new in {
        'frame = "FRD"': 'frame = "CFD"',
        'beta = "v = -U sin(beta)"': 'beta = "v = +U sin(beta)"',
        "reference_point = [-0.80, 0.0, 0.0]": f'reference_point = ["{at / FOOT!r} ft", 0.0, 0.0]',
        "arm_point = [-0.80, 0.0, 0.0]": f'arm_point = ["{at / FOOT!r} ft", 0.0, 0.0]',
        "length = 1.60\n": f'length = "{1.6 / FOOT!r} ft"\n',
        "density = 1025.0": f'density = "{1025.0 * FOOT**3 / 0.45359237!r} lb/ft^3"',
        "speed = 2.0 ": f'speed = "{2.0 / 1852 * 3600!r} kn" ',
        'name = "my_campaign"': 'name = "Tow 7"',
    }.items():
        assert old in text, old
        text = text.replace(old, new)
    campaign.write_text(text)
    return folder / "plan.toml"


@pytest.mark.parametrize("at", [-0.80, -1.10])
def test_imperial_cfd_axes_give_the_same_derivatives(tmp_path: Path, at: float) -> None:
    metric = run(read_plan(write_template(tmp_path / "si")))
    imperial = run(read_plan(write_imperial(tmp_path / "imperial", at)))
    ours = {c.symbol: c for c in metric.coefficients if c.value is not None}
    theirs = {c.symbol: c for c in imperial.coefficients if c.value is not None}
    assert ours.keys() == theirs.keys() >= {"Yv", "Nv", "Yr", "Nr", "X0"}
    for symbol, c in ours.items():
        assert c.value is not None
        assert c.u95 is not None
        assert theirs[symbol].value == pytest.approx(c.value, rel=1e-10, abs=1e-14), symbol
        assert theirs[symbol].u95 == pytest.approx(c.u95, rel=1e-8), symbol


@pytest.mark.slow
def test_a_study_renders_the_same_bytes_twice(tmp_path: Path) -> None:
    plan = read_plan(write_template(tmp_path))
    assert rendered(run(plan)) == rendered(run(plan))


def test_each_parameter_file_has_the_water_and_the_speed_of_its_own_campaigns(tmp_path: Path) -> None:
    """Two bodies of one plan: the second had its SI values in the water of the first."""
    for name, density, speed in (("sea", 1025.0, 2.0), ("lake", 998.2, 3.0), ("more", 1020.0, 2.0)):
        write_template(tmp_path / name)
        place = tmp_path / name / "campaign" / "campaign.toml"
        text = re.sub(r"(?m)^density = [\d.]+", f"density = {density}", place.read_text())
        text = re.sub(r"(?m)^speed = [\d.]+", f"speed = {speed}", text)
        if name == "sea":  # drift alone: its rates are those of the third, of another water
            text = "[[table]]".join(text.split("[[table]]")[:2])
        body = "lake" if name == "lake" else "sea"
        text = re.sub(r'(?m)^body = "\w+"', f'body = "{body}"', text)
        place.write_text(re.sub(r'(?m)^name = "\w+"', f'name = "{name}"', text))
    plan = tmp_path / "plan.toml"
    plan.write_text(
        '[study]\nname = "both"\n' + "".join(f'[[table]]\ncampaign = "{n}/campaign"\n' for n in ("sea", "lake", "more"))
    )
    study = run(read_plan(plan))
    at = {n: (p.conditions.density, p.conditions.speed) for n, p in study.parameter_files.items()}
    assert at == {"sea": (1025.0, 2.0), "lake": (998.2, 3.0)}
    for file in study.parameter_files.values():
        yv = file.coefficient("Yv")
        assert yv is not None
        assert yv.value is not None
        unit = 0.5 * file.conditions.density * file.conditions.speed * file.scaling.length**2
        assert yv.value_si == pytest.approx(yv.value * unit)
    assert [
        c.subject for c in study.checks if "SI values at 1025 kg/m^3, of campaigns at more 1020" in str(c.statistic)
    ] == ["sea density"]
