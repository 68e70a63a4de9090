from __future__ import annotations

import re
from dataclasses import replace

import pytest

from coeflab.core.table import Check, Severity
from coeflab.formats.export import Export
from coeflab.motion.simulation import simulate
from coeflab.report.content import document
from coeflab.report.tables.results import works
from tests.motion.vehicles import made as vehicle_file
from tests.report.studies import FEW, FULL, HALF, HOSTILE, small_study


def flat(sections):
    for s in sections:
        yield s
        yield from flat(s.subsections)


def words(study, anchor):
    found = next(s for s in flat(document(study).sections) if s.anchor == anchor)
    return " ".join(found.paragraphs)


def test_sections_come_in_the_order_of_reading():
    anchors = [s.anchor for s in document(small_study(FULL, published=True)).sections]
    assert anchors == [
        "verdict",
        "comparison",
        "coefficients",
        "budget",
        "campaigns",
        "data-quality",
        "checks",
        "conventions",
        "provenance",
        "reproduce",
    ]


def test_without_published_values_there_is_no_verdict_and_no_comparison():
    study = small_study(FULL)
    assert "comparison" not in [s.anchor for s in document(study).sections]
    assert "no verdict" in words(study, "verdict")


def test_a_pass_says_what_it_means():
    text = words(small_study(FULL, published=True), "verdict")
    assert "all passed" in text
    assert "re-analysis" in text


def test_a_failure_is_named():
    study = small_study(FULL, published=True)
    first = replace(study.comparisons[0], passed=False)
    text = words(replace(study, comparisons=(first, *study.comparisons[1:])), "verdict")
    assert "1 of 2 comparisons" in text
    assert "Yv' of tow" in text
    assert "fails" in text


def test_failed_checks_reach_the_verdict():
    study = small_study(FULL).with_checks((Check("signs", "tow Yv'", Severity.FAIL, "Yv' > 0", "below zero", "axes"),))
    assert "1 failed" in words(study, "verdict")
    assert "fails" in words(study, "verdict")


def test_absent_coefficients_are_named_with_advice():
    assert "Nr' of tow" in words(small_study(FULL), "verdict")
    assert "No table varies this motion" in words(small_study(FULL), "verdict")


@pytest.mark.parametrize("angles", [FULL, HALF, FEW, [3.0]])
def test_anchors_are_unique_and_fit_for_links(angles):
    study = small_study(angles, named=HOSTILE)
    study = replace(study, fits=study.fits * 2)
    sections = list(flat(document(study).sections))
    anchors = [s.anchor for s in sections] + [f.anchor for s in sections for f in s.figures]
    assert len(anchors) == len(set(anchors))
    assert all(re.fullmatch(r"[a-z0-9-]+", a) for a in anchors)


def test_a_sweep_tells_which_points_it_leaves_out_and_why():
    assert f"tow 1 ({HOSTILE})" in words(small_study(FULL), "campaign-tow-yv")


def test_points_that_determine_nothing_are_drawn_without_estimators():
    found = next(s for s in flat(document(small_study(FEW)).sections) if s.anchor == "campaign-tow-yv")
    assert [f.anchor for f in found.figures] == ["campaign-tow-yv-data"]
    assert "No coefficient could be determined" in words(small_study(FEW), "verdict")


def test_works_of_exports_and_of_the_conventions_are_listed():
    made = Export("boat", "mss", {"boat.m": b""}, None, ("fossen2011", "mss"))
    keys = [k for k, _ in document(replace(small_study(FULL), exports=(made,))).works]
    assert {"mss", "fossen2011", "sname1950", "roddy1990"} <= set(keys)
    assert len(keys) == len(set(keys))
    assert "mss" not in [k for k, _ in document(small_study(FULL)).works]


def test_works_of_manoeuvres_and_their_simulator_are_listed():
    study = replace(small_study(FULL), manoeuvres=(simulate(vehicle_file(), "zigzag", {}, free=("u", "v", "r")),))
    keys = [k for k, _ in works(study)]
    assert {"imo_msc137", "ittc_free_running", "hindmarsh1983"} <= set(keys)
    assert len(keys) == len(set(keys))


def test_a_plan_without_a_file_gets_no_command():
    last = document(small_study(FULL)).sections[-1]
    assert last.code == ()
    assert "made by a program" in " ".join(last.paragraphs)
