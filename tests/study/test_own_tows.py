"""Own tows beside published columns: none, some or all carried out, converged or not."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from coeflab.cli import show
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.report.as_json import studies as as_json
from coeflab.report.sections.budgets import tow_sections
from coeflab.report.tables.comparisons import by_campaign
from coeflab.report.tables.own_cfd import own_tow, tow_against
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.secants import OF_SECANT
from coeflab.study.study import Study
from coeflab.study.towed import NOT_RUN, NOT_TOWED, OPEN, SECANT, Towed, towed
from coeflab.study.validation import validations

HEAD = """
[study]
name = "tows"
reference_point = ["-6.6042 ft", 0.0, 0.0]
datum = "nose"
[scaling]
length = "13.9792 ft"
length_name = "LBP"
[[table]]
campaign = "suboff_roddy_2"
fits = ["slope_at_origin"]
[[table]]
campaign = "suboff_roddy_3"
fits = ["slope_at_origin"]
[[references]]
path = "published.toml"
"""


def tow_of_the_bare_hull(folder: Path, name: str, body: str, changed: Callable[[str], str] = lambda line: line) -> Path:
    """The shipped computation as another campaign, with a state in every row."""
    place = folder / name
    shutil.copytree(shipped("cfd_data") / "suboff_cfd_barehull", place)
    text = (place / "campaign.toml").read_text()
    text = text.replace('name = "suboff_cfd_barehull"', f'name = "{name}"').replace(
        'body = "suboff_bare_hull"', f'body = "{body}"'
    )
    text = text.replace('labels = ["grid"]', 'labels = ["grid", "status"]')
    lines = [line for line in text.splitlines() if not line.startswith(("sha256", "source_sha256"))]
    (place / "campaign.toml").write_text("\n".join(lines) + "\n")
    for file in ("drift.csv", "rotating_arm.csv"):
        head, *rows = (place / file).read_text().splitlines()
        rows = [changed(f"{row},converged,") for row in rows]
        (place / file).write_text("\n".join([f"{head},status,uncertain", *rows]) + "\n")
    return place


def late_arm(line: str) -> str:
    """Four of six runs of the arm on grid A, and one of drift, did not converge."""
    rate, grid = line.split(",")[:2]
    if grid == "A" and rate in ("0.1", "0.15", "0.2", "0.3", "12"):
        state = "diverged" if rate == "0.3" else "drifting"
        return line.replace("converged,", f"{state},X Y Z K M N")
    return line


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("tows")
    shutil.copy(shipped("cfd_data") / "suboff" / "published.toml", place)
    shipped_plan = (shipped("cfd_data") / "suboff" / "plan.toml").read_text()
    tows = shipped_plan[shipped_plan.index("[[tow]]") : shipped_plan.index("[[parameter_file]]")]
    (place / "plan.toml").write_text(
        HEAD + tows.replace('"../', '"').replace('"suboff_tow_hull_planes"', '"absent_planes"')
    )
    return place


@pytest.fixture(scope="module")
def study(folder: Path) -> Study:
    """Bare hull and AFF-8 towed, the hull with planes not; the arm of AFF-8 hardly converged."""
    tow_of_the_bare_hull(folder, "suboff_tow_bare_hull", "suboff_bare_hull")
    tow_of_the_bare_hull(folder, "suboff_tow_aff8", "suboff_aff8", late_arm)
    return run(read_plan(folder / "plan.toml"))


@pytest.fixture(scope="module")
def bodies(study: Study) -> tuple[Towed, ...]:
    return towed(study)


def test_every_body_has_every_wanted_coefficient(bodies: tuple[Towed, ...]) -> None:
    assert [t.tow.name for t in bodies] == ["bare hull", "hull with four planes, no sail", "AFF-8"]
    assert all([r.symbol for r in t.rows] == ["Yv", "Nv", "Zw", "Mw", "Yr", "Nr"] for t in bodies)
    assert [t.tow.campaign for t in bodies] == ["suboff_tow_bare_hull", "", "suboff_tow_aff8"]


def test_a_body_that_was_not_towed_says_so_in_every_row(bodies: tuple[Towed, ...]) -> None:
    planes = bodies[1]
    assert {(r.missing, r.why) for r in planes.rows} == {(NOT_TOWED, "there is no campaign absent_planes yet")}
    assert not planes.columns
    assert all(r.verdict is None and r.validation is None for r in planes.rows)


def test_attack_of_a_fourfold_body_is_stated_from_drift(bodies: tuple[Towed, ...]) -> None:
    by = {r.symbol: r for r in bodies[0].rows}
    assert by["Zw"].value == by["Yv"].value
    assert by["Mw"].value == -(by["Nv"].value or 0.0)
    assert (by["Zw"].u95, by["Zw"].u_grid) == (by["Yv"].u95, by["Yv"].u_grid)
    assert by["Mw"].why == "set equal to -Nv' by fourfold symmetry"
    assert by["Mw"].validation is None
    assert all(r.u_grid for r in by.values())


def test_a_verdict_needs_the_same_body_and_the_same_method(study: Study, bodies: tuple[Towed, ...]) -> None:
    bare = {r.symbol: r for r in bodies[0].rows}
    assert [s for s, r in bare.items() if r.verdict is not None] == ["Yv", "Nv"]
    assert bare["Yr"].why_none == "the test used another method, PMM"
    pmm = bare["Yr"].validation
    assert pmm.measured == pytest.approx(0.001811)
    assert pmm.u_measured == pytest.approx(0.0001811)
    assert pmm.error == pytest.approx((bare["Yr"].value or 0.0) - 0.001811)
    whole = {r.symbol: r for r in bodies[2].rows}
    assert whole["Yv"].validation.experiment == "suboff_roddy_2"
    assert whole["Yv"].validation.u_validation is not None
    assert whole["Yv"].verdict is None
    assert whole["Yv"].why_none == "the test is of another body, suboff_fully_appended"
    assert {v.body for v in validations(study, study.budgets)} == {"suboff_bare_hull"}


def test_published_columns_stand_beside_by_our_length(bodies: tuple[Towed, ...]) -> None:
    assert bodies[2].columns == ("experiment 1990, as quoted", "published CFD", "PMM CFD 2012")
    by = {r.symbol: r.published for r in bodies[2].rows}
    assert by["Yr"] == pytest.approx((0.0052, 0.0044, 0.0046), rel=1e-4)
    assert by["Mw"] == pytest.approx((0.0103, 0.0110, 0.0103), rel=1e-4)
    bare = {r.symbol: r.published for r in bodies[0].rows}
    assert bare["Nr"] == pytest.approx((-0.001597,), rel=1e-4)
    assert bare["Zw"] == (None,)


def test_what_did_not_converge_leaves_a_secant_and_its_reason(bodies: tuple[Towed, ...]) -> None:
    by = {r.symbol: r for r in bodies[2].rows}
    assert by["Yv"].value is not None
    assert by["Yr"].u95 >= OF_SECANT * abs(by["Yr"].value)
    assert not by["Yr"].is_result
    assert by["Yr"].missing == ""
    assert by["Yr"].why == f"{SECANT}; fitted to 2 of 6 turning runs; 1 diverged, 3 still drifting"
    assert by["Zw"].missing == NOT_RUN
    assert by["Zw"].why == "no run varies w"


def test_runs_left_out_are_counted_beside_a_value_too(bodies: tuple[Towed, ...]) -> None:
    by = {r.symbol: r for r in bodies[2].rows}
    assert by["Yv"].why == "fitted to 5 of 6 drift runs; 1 still drifting"


def test_a_tow_without_any_converged_run_has_its_reasons(folder: Path, tmp_path: Path) -> None:
    tow_of_the_bare_hull(
        tmp_path, "suboff_tow_aff8", "suboff_aff8", lambda line: line.replace("converged,", "drifting,X Y Z K M N")
    )
    text = (folder / "plan.toml").read_text()
    head = text[: text.index('[[table]]\ncampaign = "suboff_roddy_2"')]
    table = '[[table]]\ncampaign = "suboff_roddy_3"\nfits = ["slope_at_origin"]\n'
    aff8 = text[text.index('[[tow]]\nname = "AFF-8"') :]
    (tmp_path / "plan.toml").write_text(head + table + aff8)
    (found,) = towed(run(read_plan(tmp_path / "plan.toml")))
    by = {r.symbol: (r.missing, r.why) for r in found.rows}
    assert by["Nv"] == (OPEN, "no drift run used (of 6, 6 still drifting)")
    assert by["Nr"] == (OPEN, "no turning run used (of 6, 6 still drifting)")
    assert by["Zw"][0] == NOT_RUN


def test_without_any_tow_the_study_stands(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "published.toml", tmp_path)
    text = (folder / "plan.toml").read_text().replace('"suboff_tow_', '"no_tow_')
    (tmp_path / "plan.toml").write_text(text.replace('"suboff_cfd_barehull"', '"nothing"'))
    plan = read_plan(tmp_path / "plan.toml")
    assert [t.campaign for t in plan.tows] == ["", "", ""]
    assert len(plan.tables) == 2
    assert plan.tows[0].absent == ("no_tow_bare_hull", "nothing")


def test_a_tow_without_a_campaign_named_is_refused(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "published.toml", tmp_path)
    (tmp_path / "plan.toml").write_text(HEAD + '[[tow]]\nname = "a"\nbody = "b"\ncampaigns = []\n')
    with pytest.raises(InputError, match=r"tow\[0\]\.campaigns"):
        read_plan(tmp_path / "plan.toml")


def test_tables_of_tows_fit_80_columns(bodies: tuple[Towed, ...], capsys: pytest.CaptureFixture[str]) -> None:
    for one in bodies:
        show.table(own_tow(one))
        show.table(tow_against(one))
    shown = capsys.readouterr().out
    assert max(map(len, shown.splitlines())) <= 80
    assert "Own CFD: AFF-8" in shown
    assert "All: no value, there is no campaign absent_planes yet." in shown
    assert "no verdict" in shown


def test_report_and_json_hold_the_tows(study: Study) -> None:
    section = next(s for s in tow_sections(study))
    assert [t.title for t in section.tables][-2:] == ["Own CFD: AFF-8", "Own CFD against the test: AFF-8"]
    found = as_json.study(study, [])["tows"]
    assert [len(t["rows"]) for t in found] == [6, 6, 6]
    assert found[1]["rows"][0]["missing"] == NOT_TOWED
    assert found[0]["rows"][0]["within_u_validation"] in (True, False)


def test_tows_have_their_own_tables(study: Study) -> None:
    assert by_campaign(study).headers[1:] == ("suboff_roddy_2", "suboff_roddy_3")
