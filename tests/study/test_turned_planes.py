"""A quarter of a turn that a campaign declares, beside the body of the plan: what its shape has, and what it has not."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.images import is_fourfold
from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.law.coefficient import Status
from coeflab.report.tables.nouns import with_status
from coeflab.report.tables.results import headline
from coeflab.study.checks import symmetry
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study

GEOMETRY = Path(__file__).parents[2] / "geometry"


@pytest.mark.parametrize(
    ("body", "has"),
    [("tow_spheroid", True), ("suboff_hull_planes", True), ("suboff_bare_hull", True), ("suboff_aff8", False), ("finned_spheroid", False)],
)  # fmt: skip
def test_a_sail_or_rudders_without_planes_are_no_quarter_of_a_turn(body: str, has: bool) -> None:
    assert is_fourfold(read_body(GEOMETRY / body / "body.toml"), np.zeros(3)) is has


def test_about_a_point_off_its_axis_no_body_has_it() -> None:
    assert is_fourfold(read_body(GEOMETRY / "tow_spheroid" / "body.toml"), np.array([0.0, 0.0, 0.05])) is False


def carried_out(folder: Path, body: str = "", about: str = "") -> Study:
    named = about + (f'[body]\npath = "{body}"\n' if body else "")
    plan = folder / "plan.toml"
    plan.write_text(
        f'[study]\nname = "turned"\n{named}[[table]]\ncampaign = "tank_spheroid"\nfits = ["slope_at_origin"]\n'
    )
    return run(replace(read_plan(plan), exports=(), manoeuvres=()))


def test_without_a_body_the_number_says_that_its_symmetry_is_assumed(tmp_path: Path) -> None:
    study = carried_out(tmp_path)
    (fit,) = study.fits
    assert headline(study).count("(symmetry assumed)") == 2  # Zw' and Mw'
    assert fit.coefficients["Yv"].status is not Status.SYMMETRY_ASSUMED
    assert fit.coefficients["Zw"].status is Status.SYMMETRY_ASSUMED
    assert with_status(fit.coefficients["Zw"])[1].endswith(", symmetry assumed")


def test_a_body_that_has_it_takes_the_word_away(tmp_path: Path) -> None:
    study = carried_out(tmp_path, "tow_spheroid")
    (fit,) = study.fits
    assert fit.coefficients["Zw"].status is fit.coefficients["Yv"].status
    assert "assumed" not in headline(study)
    assert "turned by symmetry" in fit.coefficients["Zw"].estimator


def test_a_body_that_has_it_not_withdraws_the_rows(tmp_path: Path) -> None:
    text = (GEOMETRY / "finned_spheroid" / "body.toml").read_text().replace('"finned_spheroid"', '"tow_spheroid"')
    (tmp_path / "body.toml").write_text(text)
    study = carried_out(tmp_path, "body.toml")
    (fit,) = study.fits
    assert "Yv" in fit.coefficients
    assert "Zw" not in fit.coefficients
    assert [t.name.rpartition("/")[2] for t in study.tables] == ["drift.csv"]
    (found,) = (c for c in symmetry.check(study) if "quarter of a turn" in str(c.statistic))
    assert found.severity is Severity.WARN


def test_a_point_of_the_plan_off_the_axis_withdraws_nothing(tmp_path: Path) -> None:
    """Rows were turned about the campaign's own point."""
    study = carried_out(tmp_path, "tow_spheroid", 'datum = "centre"\nreference_point = [0.0, 0.0, 0.02]\n')
    (fit,) = study.fits
    assert fit.coefficients["Zw"].status is fit.coefficients["Yv"].status


def test_a_joint_fit_has_no_rows_that_the_body_rules_out(tmp_path: Path) -> None:
    text = (GEOMETRY / "finned_spheroid" / "body.toml").read_text().replace('"finned_spheroid"', '"tow_spheroid"')
    (tmp_path / "body.toml").write_text(text)
    shutil.copytree(shipped("cfd_data") / "tank_spheroid", tmp_path / "again")
    campaign = tmp_path / "again" / "campaign.toml"
    campaign.write_text(campaign.read_text().replace('name = "tank_spheroid"', 'name = "again"'))
    (tmp_path / "plan.toml").write_text(
        '[study]\nname = "turned"\n[body]\npath = "body.toml"\n[[joint]]\nfit = "manoeuvring_model"\n'
        'campaigns = ["tank_spheroid", "again"]\noptions = { terms = ["Yv", "Yv|v|"] }\n'
    )
    study = run(replace(read_plan(tmp_path / "plan.toml"), exports=(), manoeuvres=()))
    assert {t.name.rpartition("/")[2] for t in study.tables} == {"drift.csv"}
    assert "symmetry.body" in [f.code for f in study.fits[0].findings]
