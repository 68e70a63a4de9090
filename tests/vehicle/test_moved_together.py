"""Two campaigns of one body about a point that is not the vehicle's: Yr', Nr' and U95 by the congruence, written out by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.api.vehicle import Vehicle
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.law.coefficient import Status
from coeflab.study.estimated_vehicle import given_by
from coeflab.study.run import run
from coeflab.vehicle.merge import merged
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.parameter_file import ParameterFile

LENGTH, DENSITY, SPEED = 1.33, 1000.0, 2.0
TRUTH = {"Yv": -0.03, "Nv": -0.014, "Yr": 0.005, "Nr": -0.0045}
SHIFTS = (0.007, 0.3)
HEAD = """
[campaign]
name = "{name}"
title = "{name}"
body = "remus100"
[axes]
frame = "FRD"
datum = "nose"
reference_point = [0.0, 0.0, 0.0]
[scaling]
length = "1.33 m"
length_name = "LOA"
[conditions]
speed = "2 m/s"
density = "1000 kg/m^3"
[source]
citation = "none"
place = "made up"
kind = "synthetic"
how_obtained = "written by a test"
[[table]]
file = "table.csv"
contains_inertia = false
arm_point = [0.0, 0.0, 0.0]
"""


def columns(rate: str) -> dict[str, np.ndarray]:
    """A sweep of thirteen rows about the nose, with scatter of 1 %."""
    scatter = np.random.default_rng(7 if rate == "v" else 8).normal(size=(2, 13))
    x, forces = np.linspace(-0.4, 0.4, 13), 0.5 * DENSITY * SPEED**2 * LENGTH**2
    prime = x / SPEED if rate == "v" else x * LENGTH / SPEED
    unit = "[m/s]" if rate == "v" else "[rad/s]"
    size = np.max(np.abs(prime))
    y, n = (TRUTH[f"{c}{rate}"] * (prime + 0.01 * size * s) for c, s in zip("YN", scatter, strict=True))
    return {f"{rate} {unit}": x, "Y [N]": forces * y, "N [N m]": forces * LENGTH * n}


def table(rate: str, **words: str) -> cf.Table:
    """The sweep as a table of its own campaign."""
    arm = {} if rate == "v" else {"contains_inertia": False, "arm_point": "reference point"}
    return cf.read_table(
        columns(rate), name="drift" if rate == "v" else "yaw", frame="FRD", length=LENGTH, density=DENSITY, speed=SPEED,
        about="nose", **arm, **words,
    )  # fmt: skip


@pytest.fixture(scope="module")
def result() -> cf.Result:
    """Both sweeps, fitted each by itself about the nose."""
    return cf.fit([table("v"), table("r")])


@pytest.fixture
def campaigns(tmp_path: Path) -> str:
    """The same as two folders, named with a comma between."""
    for name, rate in (("drift", "v"), ("yaw", "r")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "campaign.toml").write_text(HEAD.format(name=name))
        held = columns(rate)
        rows = "\n".join(",".join(f"{x!r}" for x in map(float, row)) for row in zip(*held.values(), strict=True))
        (tmp_path / name / "table.csv").write_text(f"{','.join(held).replace('N m', 'N*m')}\n{rows}\n")
    return f"{tmp_path / 'drift'},{tmp_path / 'yaw'}"


def by_hand(shift: float, rows_moved: bool) -> tuple[dict[str, float], np.ndarray]:
    """Values and covariance of Yv' Nv' Yr' Nr' about a point ``shift`` m aft of the nose; dx = -shift / L.

    A plan moves the rows of the drift sweep before it fits them: their Yv' and Nv' are about the point already, and lend from there.
    """
    order, dx = ("Yv", "Nv", "Yr", "Nr"), -shift / LENGTH
    drift = table("v")
    result = cf.fit([drift.about(np.array([-shift, 0.0, 0.0])) if rows_moved else drift]), cf.fit([table("r")])
    own = [[1, 0, 0, 0], [-dx, 1, 0, 0], [-dx, 0, 1, 0], [dx**2, -dx, -dx, 1]]
    moved = [[1, 0, 0, 0], [0, 1, 0, 0], [-dx, 0, 1, 0], [0, -dx, -dx, 1]]
    move = np.array(moved if rows_moved else own, dtype=float)
    values, covariance = move @ [result[i // 2][s].value for i, s in enumerate(order)], np.zeros((4, 4))
    for i, found in enumerate(result):
        rows = [found.symbols.index(f"{s}'") for s in order[2 * i : 2 * i + 2]]
        covariance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = found.covariance[np.ix_(rows, rows)]
    return dict(zip(order, values, strict=True)), move @ covariance @ move.T


def holds(file: ParameterFile, shift: float, rows_moved: bool = False) -> None:
    """Value, U95 and covariance of all four."""
    values, covariance = by_hand(shift, rows_moved)
    at = [file.covariance.symbols.index(f"{s}'") for s in values]
    there = np.array(file.covariance.matrix, dtype=float)[np.ix_(at, at)]
    scale = np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    np.testing.assert_allclose(there / scale, covariance / scale, atol=1e-9)
    for (symbol, value), own in zip(values.items(), np.diag(covariance), strict=True):
        found = next(c for c in file.coefficients if c.symbol == f"{symbol}'")
        assert found.value == pytest.approx(value, rel=1e-9), symbol
        assert found.u95 == pytest.approx(2.0 * np.sqrt(own), rel=1e-9), symbol
        assert found.status is not Status.ESTIMATE


def body(shift: float) -> cf.Body:
    """The shape about a point aft of its nose."""
    return replace(cf.read_body("remus100"), reference_point=np.array([-shift, 0.0, 0.0]))


def base(shift: float) -> ParameterFile:
    """Numbers of one's own about a point aft of the nose; all four are another's estimates."""
    made = typed_file(
        "base", [f"{s}'={2 * v} +- 0.001" for s, v in TRUTH.items()], length="1.33 m", length_name="LOA", speed="2 m/s",
        density="1000", about="nose",
    )  # fmt: skip
    point = made.reference_point.model_copy(update={"point": (-shift, 0.0, 0.0)})
    estimates = tuple(replace(c, status=Status.ESTIMATE) for c in made.coefficients)
    return made.model_copy(update={"reference_point": point, "coefficients": estimates})


@pytest.mark.parametrize("shift", SHIFTS)
def test_from_python(result: cf.Result, shift: float) -> None:
    holds(cf.vehicle(body(shift), mass=30.5, coefficients=result).file, shift)


@pytest.mark.parametrize("shift", SHIFTS)
def test_by_campaigns_and_by_files(campaigns: str, shift: float) -> None:
    """`vehicle --campaign A,B` and `merge BASE A,B` are one path; files one after the other, about the nose, another."""
    together, own = given_by(campaigns, base(shift), run)
    assert own.length == LENGTH
    joined = merged(base(shift), together).parameters
    holds(joined, shift, rows_moved=True)
    one_by_one = base(shift)
    for name in campaigns.split(","):
        one_by_one = merged(one_by_one, given_by(name, one_by_one, run)[0]).parameters
    holds(one_by_one, shift, rows_moved=True)
    assert [f.code for f in joined.findings if f.code == "move.left_out"] == []


def test_a_table_about_cg_is_told_where_the_vehicles_lies(campaigns: str, tmp_path: Path) -> None:
    """From the datum: the vehicle's point 0.3 m aft of the nose and G 0.05 m ahead of it, 0.02 m below."""
    drift = Path(campaigns.split(",", maxsplit=1)[0])
    (tmp_path / "table.csv").write_text((drift / "table.csv").read_text())
    (tmp_path / "campaign.toml").write_text((drift / "campaign.toml").read_text().replace('"nose"', '"cg"'))
    vehicle = base(0.3)
    heavy = cf.vehicle("remus100", mass=30.5).file.mass
    vehicle = vehicle.model_copy(update={"mass": replace(heavy, centre=(0.05, 0.0, 0.02), mass_moment=0.05 * 30.5)})
    with pytest.raises(
        ScalingMismatchError, match=r"centre of gravity of base lies at \[-0.25, 0, 0.02\] from the nose"
    ):
        given_by(str(tmp_path), vehicle, run)
    with pytest.raises(ScalingMismatchError, match=r"that of a mesh is its origin\.$"):
        given_by(str(tmp_path), base(0.3), run)


@pytest.mark.parametrize("shift", SHIFTS)
def test_by_a_plan(campaigns: str, shift: float, tmp_path: Path) -> None:
    plan = tmp_path / "plan.toml"
    text = f'[study]\nname = "both"\nreference_point = [{-shift}, 0.0, 0.0]\ndatum = "nose"\n'
    plan.write_text(
        text + "".join(f'[[table]]\ncampaign = "{n}"\nfits = ["slope_at_origin"]\n' for n in ("drift", "yaw"))
    )
    study = run(plan)
    holds(next(iter(study.parameter_files.values())), shift, rows_moved=True)
    assert {f.code for fit in study.fits for f in fit.findings} == {"move.lent"}


@pytest.mark.parametrize("shift", SHIFTS)
def test_what_cannot_be_moved_is_named_and_fails(shift: float) -> None:
    """N alone over drift gives Nv' and no Yv', which the move of every other takes."""
    drift = table("v")
    lone = replace(drift, forces={"N": drift.forces["N"]}, usable={"N": drift.usable["N"]})
    straight = cf.fit([table("r"), replace(lone, campaign="moments", name="moments")])
    with pytest.raises(InputError, match="needs Yv'"):
        cf.vehicle(body(shift), mass=30.5, coefficients=straight)
    auv = cf.vehicle(body(shift), mass=30.5, coefficients=Vehicle(typed_file(
        "own", ["Yvv'=-0.1 +- 0.01", "Nr'=-0.004 +- 0.001"], length="1.33 m", length_name="LOA", speed="2", density="1000", about="nose",
    )))  # fmt: skip
    assert str(auv["Nr'"].status) == "estimate"
    lost = next(f for f in auv.file.findings if f.code == "move.stays")
    assert (lost["symbols"], lost["stays"]) == (("Nr'",), ("Nr'",))
    assert set(lost["needs"]) == {"Yr'", "Nv'", "Yv'"}
    assert lost.statistic == pytest.approx(shift)
    assert [c for c in auv.checks if str(c.severity) == "fail" and c.subject == "own"]
