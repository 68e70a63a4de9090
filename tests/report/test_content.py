from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.wording import Verbatim, in_sentences, listed
from coeflab.formats.export import Export
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.motion.simulation import simulate
from coeflab.report.content import core, document, three_lines
from coeflab.report.sections.coefficients import form_not_assessed, shorter_ranges
from coeflab.report.tables import comparisons
from coeflab.report.tables.results import works
from coeflab.study.symmetry import is_zero
from tests.motion.vehicles import made as vehicle_file
from tests.report.studies import FEW, FULL, HALF, HOSTILE, small_study


def flat(sections):
    for s in sections:
        yield s
        yield from flat(s.subsections)


def words(study, anchor):
    found = next(s for s in flat(document(study).sections) if s.anchor == anchor)
    return " ".join(found.texts)


CORE = ["verdict", "comparison", "coefficients", "checks", "conventions", "provenance", "reproduce"]


def test_the_core_comes_first_and_then_the_appendix():
    sections = document(small_study(FULL, published=True)).sections
    assert [s.anchor for s in sections if not s.appendix] == CORE
    assert [s.anchor for s in sections] == [*CORE, "budget", "data-quality", "campaigns"]


def test_the_core_has_no_appendix_and_says_what_that_holds():
    study = small_study(FULL, published=True)
    made = document(study, full=False)
    assert [s.anchor for s in made.sections] == CORE
    assert not any(s.appendix for s in flat(made.sections))
    last = made.sections[0].texts[-1]
    assert "--full` adds the appendix" in last
    assert "1 fit with every point and curve" in last
    assert last not in document(study).sections[0].texts


@pytest.mark.parametrize("angles", [FULL, HALF, FEW])
def test_nothing_in_the_core_is_longer_than_three_lines(angles):
    checks = (Check("signs", "tow Yv'", Severity.FAIL, "Yv' > 0", "below zero", "axes"),)
    study = replace(small_study(angles, published=True), parameter_files={"boat": vehicle_file()}).with_checks(checks)
    for section in flat(document(study, full=False).sections):
        notes = [n for t in section.tables for n in t.notes]
        for text in (*section.texts, *notes, *(f.caption for f in section.figures)):
            assert len(text) <= 240, text


def test_three_lines_lose_no_word_and_leave_what_users_wrote():
    long = "One sentence of a few words; and a part of it. See p. 19 of R. F. Roddy, Fig. 12. " * 6
    pieces = three_lines((long.strip(), "short"))
    assert max(map(len, pieces)) <= 240
    assert " ".join(pieces) == f"{long}short"
    assert three_lines((Verbatim(long),)) == (long,)


def test_a_paragraph_ends_with_a_sentence():
    listing = ", ".join(["a list that goes on (only; here)"] * 20) + "."
    pieces = three_lines((f"A sentence, of parts; first. {'Another, and more. ' * 14}{listing} The last.",))
    assert all(p.endswith(".") for p in pieces)
    assert listing in pieces
    assert all(
        not p.endswith(("p. 19", "p.", "F.", "Fig."))
        for p in three_lines(("See p. 19 and Fig. 2 of R. F. Roddy " * 20,))
    )


def test_a_long_listing_is_several_sentences_and_a_short_one_is_one():
    names = [f"campaign {i}" for i in range(60)]
    said = in_sentences("Not found: ", names, join=listed)
    assert said.startswith("Not found: campaign 0, ")
    pieces = three_lines((said,))
    assert len(pieces) > 1
    assert max(map(len, pieces)) <= 240
    assert all(p.startswith("Not found: ") and p.endswith(".") for p in pieces)
    assert all(f"{n}" in said for n in names)
    assert in_sentences("Not found: ", names[:3], join=listed) == "Not found: campaign 0, campaign 1 and campaign 2."
    assert in_sentences("Of ", ["a", "b"], end=" no value.") == "Of a; b no value."


def test_an_answer_leads_to_sections_that_are_there():
    study = small_study(FULL)
    made = document(study, full=False)
    known = {s.anchor for s in flat(made.sections)}
    lost = replace(made.answer.rows[0], anchor="campaign-tow-yv")
    again = core(replace(made, answer=replace(made.answer, rows=(lost, *made.answer.rows[1:]))))
    assert again.answer.rows[0].anchor == "coefficients"
    assert {a for a in (r.anchor for r in made.answer.rows) if a} <= known


@pytest.mark.parametrize(
    ("symbol", "symmetry", "zero"),
    [("Kv", "up-down", True), ("Kv|v|'", "up-down", True), ("Kr", "up-down", True), ("Yv", "up-down", False),
     ("Zvv", "up-down", True), ("Yw", "port-starboard", True), ("Xvv", "port-starboard", False),
     ("Xv|v|", "port-starboard", True), ("Nrdot", "up-down", False), ("Kdr", "up-down", True), ("Z0", "fourfold", True)],
)  # fmt: skip
def test_what_symmetry_makes_zero(symbol, symmetry, zero):
    assert is_zero(symbol, frozenset({symmetry})) is zero


def symmetric(value, u95):
    """The study of a body that declares itself its image upside down, with one such moment of roll."""
    study = small_study(FULL)
    fit = study.fits[0]
    roll = replace(fit.coefficients["Yv"], symbol="Kv", value=value, u95=u95)
    of = replace(fit.coefficients, coefficients=(*fit.coefficients.coefficients, roll))
    sweeps = (*fit.sweeps, replace(fit.sweeps[0], symbol="Kv", component="K"))
    table = replace(study.tables[0], symmetry=("up-down",))
    return replace(study, tables=(table,), fits=(replace(fit, coefficients=of, sweeps=sweeps),))


def test_what_is_zero_by_symmetry_has_one_line_and_no_section():
    study = symmetric(1e-6, 2e-6)
    made = document(study)
    table = next(s for s in made.sections if s.anchor == "coefficients").tables[0]
    assert "Kv'" not in [row[0] for row in table.rows]
    assert table.notes[0] == "Zero by symmetry, and zero within U95: Kv'; |value| + U95 is at most 3.0e-06."
    campaign = next(s for s in flat(made.sections) if s.anchor == "campaign-tow")
    assert table.notes[0] in campaign.paragraphs
    assert [s.anchor for s in campaign.subsections] == ["campaign-tow-yv", "campaign-tow-nv"]


def test_terms_of_a_force_law_that_ends_before_the_slope_are_named_with_its_end():
    """12 deg as radians; a rate, whose range is another, is compared with its own slope alone."""
    slope = Coefficient("Kv", 1.0, 0.1, Status.OK, "b", window=(-0.3, 0.3))
    rate = Coefficient("Kr", 1.0, 0.1, Status.OK, "b", window=(-0.6, 0.6))
    short = replace(slope, symbol="Kv|v|", window=(-0.2, np.radians(12.0)))
    whole, turning = (
        replace(slope, symbol="Kvvv", window=(-0.299, 0.29)),
        replace(rate, symbol="Kr|r|", window=(-0.4, 0.5)),
    )
    found = [slope, rate, short, whole, turning]
    said = shorter_ranges(found, {"Kv|v|", "Kvvv", "Kr|r|"})
    assert said == "Fitted to a shorter range: Kv|v|', up to 12 deg; Kr|r|', up to |r'| = 0.5."
    assert shorter_ranges([slope, rate, whole], {"Kvvv"}) == ""


def test_a_term_whose_form_is_not_assessed_is_named_below_the_core_table():
    study = symmetric(1e-4, 1e-5)
    fit = study.fits[0]
    (*others, roll) = fit.coefficients.coefficients
    tied = replace(roll, symbol="Yv|v|", status=Status.FORM_ASSUMED, parts=Parts(random=1e-5))
    both = replace(fit.coefficients, coefficients=(*others, tied))
    study = replace(study, fits=(replace(fit, coefficients=both, sweeps=fit.sweeps[:-1]),))
    table = next(s for s in document(study).sections if s.anchor == "coefficients").tables[0]
    said = [n for n in table.notes if "assumed force law" in n]
    assert said == ["U95 of Yv|v|' includes only the random and slope parts, not the error of the assumed force law."]
    assert form_not_assessed([replace(tied, parts=Parts(random=1e-5, model_form=0.0))]) == ""


def test_a_measured_asymmetry_keeps_its_row_and_its_section():
    made = document(symmetric(3e-6, 2e-6))
    table = next(s for s in made.sections if s.anchor == "coefficients").tables[0]
    assert "Kv'" in [row[0] for row in table.rows]
    assert any(s.anchor == "campaign-tow-kv" for s in flat(made.sections))


def test_without_published_values_there_is_no_verdict_and_no_comparison():
    study = small_study(FULL)
    assert "comparison" not in [s.anchor for s in document(study).sections]
    assert "no verdict" in words(study, "verdict")


def test_a_pass_says_what_it_means():
    text = words(small_study(FULL, published=True), "verdict")
    assert "The study passes: no re-analysis failed." in text
    assert "2 of 2 coefficients agree with the authors' own evaluation of their data, within U95." in text
    assert "The data are the authors' own" in text


@pytest.mark.parametrize(("share", "is_weak"), [(0.26, True), (-0.26, True), (0.24, False)])
def test_a_pass_by_a_wide_interval_is_called_weak(share, is_weak):
    study = small_study(FULL, published=True)
    others = tuple(replace(c, combined=0.01 * abs(c.published)) for c in study.comparisons[1:])
    first = replace(study.comparisons[0], passed=True, published=0.02 / share, combined=0.02)
    text = words(replace(study, comparisons=(first, *others)), "verdict")
    joined = "our U95 and the source's uncertainty together exceed 25 % of the published value"
    assert (f"Weak, as {joined}: Yv' of tow (26 %)." in text) == is_weak
    failed = replace(study, comparisons=(replace(first, passed=False), *others))
    assert "weak" not in words(failed, "verdict").lower()


def test_a_failure_is_named():
    study = small_study(FULL, published=True)
    first = replace(study.comparisons[0], passed=False)
    text = words(replace(study, comparisons=(first, *study.comparisons[1:])), "verdict")
    assert "The study fails: 1 of 2 re-analyses failed." in text
    assert "1 of 2 coefficients agrees with" in text
    assert "Beyond U95, a failure: Yv' of tow." in text


def test_failed_checks_reach_the_verdict():
    study = small_study(FULL).with_checks((Check("signs", "tow Yv'", Severity.FAIL, "Yv' > 0", "below zero", "axes"),))
    assert words(study, "verdict").startswith("The study fails: 1 of 1 check failed.")
    both = replace(study, comparisons=(replace(small_study(FULL, published=True).comparisons[0], passed=False),))
    assert words(both, "verdict").startswith("The study fails: 1 of 1 re-analysis and 1 of 1 check failed.")
    warned = small_study(FULL).with_checks((Check("signs", "tow Yv'", Severity.WARN, "Yv' > 0", "small", "axes"),))
    assert words(warned, "verdict").startswith("The study passes: no check failed. 1 of 1 check gave a warning.")


def test_absent_coefficients_are_named_with_advice():
    text = words(small_study(FULL), "verdict")
    assert "Nr' of tow (no run varies r)." in text
    assert "Runs that vary r, of body of tow." in text


@pytest.mark.parametrize("angles", [FULL, HALF, FEW, [3.0]])
def test_anchors_are_unique_and_fit_for_links(angles):
    study = small_study(angles, named=HOSTILE)
    study = replace(study, fits=study.fits * 2)
    sections = list(flat(document(study).sections))
    anchors = [s.anchor for s in sections] + [f.anchor for s in sections for f in s.figures]
    assert len(anchors) == len(set(anchors))
    assert all(re.fullmatch(r"[a-z0-9-]+", a) for a in anchors)


def test_a_sweep_tells_which_points_it_leaves_out_and_why():
    found = next(s for s in flat(document(small_study(FULL)).sections) if s.anchor == "campaign-tow-yv")
    left_out = next(t for t in found.tables if t.title == "Points left out of Yv'")
    assert [(row[0], row[-1]) for row in left_out.rows] == [("tow 1", HOSTILE)]


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
    last = next(s for s in document(small_study(FULL)).sections if s.anchor == "reproduce")
    assert last.code == ()
    assert "made by a program" in " ".join(last.paragraphs)


def test_campaigns_stand_with_body_and_source_where_there_are_several():
    study = small_study(FULL)
    assert not comparisons.campaigns(study).rows
    first = study.tables[0]
    other = replace(first, campaign="other", body="another hull", source=replace(first.source, kind="cfd"))
    found = comparisons.campaigns(replace(study, tables=(first, other)))
    assert [(*row[:3], row[-1]) for row in found.rows] == [
        ("tow", "body of tow", first.source.kind, "-"), ("other", "another hull", "cfd", "-"),
    ]  # fmt: skip
    turned = replace(
        first, by_symmetry=first.name, motion={**first.motion, "w": first.motion["v"], "v": 0.0 * first.motion["v"]}
    )
    (row, _) = comparisons.campaigns(replace(study, tables=(first, turned, other))).rows
    assert (first.varies, row[3]) == (("v",), "v' (by symmetry w')")
    assert (
        document(replace(study, tables=(first, other)), full=False).sections[1].tables[0].title
        == "What was tested and computed"
    )
