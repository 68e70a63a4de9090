"""Straight runs: X0' of a resistance test, its scatter, its trend with the Reynolds number, and what a vehicle makes of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.fits import FITS
from coeflab.fits.rows.straight_runs import straight_runs
from coeflab.law.scaling import Conditions
from coeflab.study.checks.data_gate import check as data_gate
from coeflab.study.checks.straight_runs import check
from coeflab.study.run import run
from coeflab.study.study import Plan
from coeflab.tables.reading import table_at
from coeflab.vehicle.merge import merged
from tests.motion.vehicles import made
from tests.report.studies import small_study, small_table

SPEEDS = np.array([0.8, 1.0, 1.2, 1.5, 1.8, 2.0])
DENSITY, LENGTH, X0 = 998.2, 1.6, -2e-3
CAMPAIGN = f"""[campaign]
name = "drag"
title = "drag"
body = "hull"
[axes]
frame = "FRD"
datum = "origin"
reference_point = [0, 0, 0]
[scaling]
length = {LENGTH}
length_name = "LOA"
[conditions]
density = {DENSITY}
speed = 1.35
viscosity = 1e-6
[source]
kind = "synthetic"
citation = "synthetic"
[[table]]
file = "table.csv"
"""


def of_primes(primes, speeds=SPEEDS):
    """A synthetic table of straight runs with these X / (1/2 rho U^2 L^2)."""
    table, n = small_table([0.0] * len(speeds)), len(speeds)
    unit = 0.5 * DENSITY * np.asarray(speeds) ** 2 * LENGTH**2
    zero = np.zeros(n)
    return replace(
        table, motion={**dict.fromkeys("vwpqr", zero), "u": np.asarray(speeds)}, speed=np.asarray(speeds),
        forces={"X": np.asarray(primes) * unit}, usable={"X": np.ones(n, dtype=bool)}, exclusions=(),
        conditions=Conditions(DENSITY, 1.35, 1e-6),
    )  # fmt: skip


def fitted(table):
    found = FITS.load("slope_at_origin").fit([table], replace(table.scaling, length=LENGTH), {})
    return found, found.coefficients["X0"]


def test_the_mean_of_the_primes_is_x0_with_the_u95_of_its_scatter():
    """Of six runs that scatter by s the half-width is t(5) s / sqrt(6), 2.5706 s / 2.4495."""
    scatter = 2e-5 * np.array([1.0, -1.0, 1.0, 1.0, -1.0, -1.0])
    found, c = fitted(of_primes(X0 + scatter))
    assert c.value == pytest.approx(X0, rel=1e-12)
    assert c.u95 == pytest.approx(2.5706 * np.std(scatter, ddof=1) / np.sqrt(6.0), rel=1e-4)
    assert (c.parts.random, c.parts.model_form) == (c.u95, 0.0)
    assert "6 straight runs, 0.8 to 2 m/s, Reynolds number 1.28 to 3.2 million" in c.estimator
    assert np.sqrt(found.coefficients.covariance[0, 0]) == pytest.approx(c.u95 / 2.0)
    assert "no trend" in found.straight[0].changes


def test_a_force_as_the_square_of_the_speed_has_x0_and_no_trend():
    _, c = fitted(of_primes(np.full(6, X0)))
    assert c.value == pytest.approx(X0, rel=1e-12)
    assert c.u95 is None or c.u95 < 1e-9 * abs(X0)


def test_a_trend_with_the_reynolds_number_is_said_and_u95_holds_it():
    """ITTC 1957 friction, 0.075 / (log10 Re - 2)^2: a sixth less at Re 3.2 than at 1.3 million."""
    friction = 0.075 / (np.log10(SPEEDS * LENGTH / 1e-6) - 2.0) ** 2
    primes = X0 * friction / friction[2]
    table = of_primes(primes)
    found, c = fitted(table)
    (r,) = found.straight
    assert r.has_trend
    assert r.trend / r.value == pytest.approx(-np.ptp(friction) / friction.mean(), rel=0.05)
    assert "|X0'| falls by" in r.changes
    assert np.all(np.abs(primes - c.value) <= c.u95)
    assert c.parts.model_form > 10.0 * c.parts.random
    study = replace(small_study([]), tables=(table,), fits=(found,), checks=())
    said, *_ = check(study)
    assert str(said.severity) == "warn"
    assert "U95 holds the change over these speeds" in said.comment
    assert [f for f in data_gate(study) if "varies" in f.statistic] == []
    without, *_ = check(replace(study, fits=()))
    assert "leaves the change out" in without.comment


@pytest.mark.parametrize("speeds", [[1.0, 1.5], [1.0, 1.0, 1.0, 1.5], [1.0, 1.0, 1.0]])
def test_less_than_three_speeds_give_none(speeds):
    assert straight_runs(of_primes([X0] * len(speeds), speeds), LENGTH) is None


def test_runs_with_drift_and_runs_astern_are_none():
    table = of_primes(np.full(6, X0))
    drifting = replace(table, motion={**table.motion, "v": np.full(6, 0.1)})
    assert straight_runs(drifting, LENGTH) is None
    astern = replace(table, motion={**table.motion, "u": -SPEEDS})
    assert straight_runs(astern, LENGTH) is None


def folder(path: Path, primes) -> Path:
    rows = (
        f"{i},{u},{x * 0.5 * DENSITY * u**2 * LENGTH**2:.9g}"
        for i, (u, x) in enumerate(zip(SPEEDS, primes, strict=True))
    )
    path.mkdir()
    (path / "campaign.toml").write_text(CAMPAIGN)
    (path / "table.csv").write_text("\n".join(["point,u [m/s],X [N]", *rows]) + "\n")
    return path


def test_a_campaign_of_straight_runs_replaces_the_estimate_of_a_vehicle(tmp_path):
    place = folder(tmp_path / "drag", X0 * np.array([1.01, 0.99, 1.0, 1.01, 0.99, 1.0]))
    study = run(Plan("drag", "drag", (table_at(place, ("slope_at_origin", "tied_law")),)))
    (file,) = study.parameter_files.values()
    found = file.coefficient("X0'")
    assert found.value == pytest.approx(X0, rel=1e-9)
    assert found.origin == "fit"
    base = made({"X0": -4e-3, "Xu|u|": -1e-3, "Yv": -4e-2})
    prime = base.mass.mass / (0.5 * base.conditions.density * file.scaling.length**3)
    mass = replace(base.mass, mass_prime=prime)
    base = base.model_copy(update={"scaling": file.scaling, "reference_point": file.reference_point, "mass": mass})
    after = merged(base, file).parameters
    assert after.coefficient("X0'").value == pytest.approx(X0, rel=1e-9)
    assert after.coefficient("Yv'").value == -4e-2


def test_a_merge_says_what_the_other_file_lacks():
    """No estimate stands in it, so that the message may not speak of estimates."""
    base = made()
    bare = base.model_copy(
        update={"coefficients": (), "covariance": base.covariance.model_copy(update={"symbols": (), "matrix": ()})}
    )
    with pytest.raises(InputError, match="no coefficient in synthetic"):
        merged(base, bare)


def test_a_constant_is_measured_against_its_value(tmp_path):
    """One constant over six runs that scatter by 1 %: left-out rows are missed by about 1 % of it, not by half of their range."""
    table = of_primes(X0 * np.array([1.01, 0.99, 1.0, 1.01, 0.99, 1.0]))
    found = FITS.load("manoeuvring_model").fit(
        [table], replace(table.scaling, length=LENGTH), {"terms": "X0", "set": "none"}
    )
    (said,) = (s for s in found.models[0].statements if s.startswith("Every third point"))
    assert said.endswith("of the mean.")
    share = float(said.partition("predicted to ")[2].partition(" %")[0])
    assert 0.3 < share < 3.0
    from coeflab.study.checks.prediction import check as prediction

    assert prediction(replace(small_study([]), tables=(table,), fits=(found,))) == []
