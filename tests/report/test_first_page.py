"""The first page: what its rows, verdicts, sentence, pictures and table say."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.cli.show import plain_lines
from coeflab.core.finding import Severity
from coeflab.core.table import Check, in_digits_of, percent, with_u95
from coeflab.law.coefficient import Coefficient, Status
from coeflab.report import first_page
from coeflab.report.acceptance import Basis
from coeflab.report.answer_table import answer_table
from coeflab.report.content import document
from coeflab.report.document import Answer, AnswerRow, Document, Section
from coeflab.report.figures.artists import text_width
from coeflab.report.figures.first_page import axes_figure, forest_figure, renamed, share_text, slope_figure
from coeflab.report.figures.panel import SIZE
from coeflab.report.first_page import answer, study_summary
from coeflab.report.first_page_notes import _several
from coeflab.report.formats import html, pdf
from coeflab.report.sections import acceptance as acceptance_document
from coeflab.report.sections.verdict import verdict
from coeflab.study.checks import coverage
from coeflab.study.lines import NAME, line
from coeflab.study.study import PlannedTow, Study
from coeflab.study.towed import Towed, TowedRow
from coeflab.tables.assumptions import assumed as key
from coeflab.tables.assumptions import carried
from coeflab.vehicle.published_values import PublishedValue, Reference, Relation, compare_set
from tests.report.studies import ENDLESS, FEW, FULL, HALF, HOSTILE, LENGTH, small_study
from tests.report.test_acceptance_document import DRAWN, found


def reference(relation: Relation, values: dict[str, str], name: str, **changes) -> Reference:
    made = {
        "name": name, "citation": "synthetic", "place": "Table 4, column 2", "body": "body of tow", "relation": relation,
        "campaigns": ("tow",) if relation is Relation.RE_ANALYSIS else (), "scaling": LENGTH, "other_scaling": None, "note": "",
        "values": tuple(PublishedValue(s, v, float(v)) for s, v in values.items()), "literature": (), "uncertainties": {},
        "reference_point": None,
    }  # fmt: skip
    return Reference(**(made | changes))


def compared(*references: Reference) -> Study:
    """The small study beside published columns."""
    study = small_study(FULL)
    made = compare_set(study.fits[0].coefficients, references)
    return replace(study, references=references, comparisons=made)


def every(sections: Sequence[Section]) -> list[Section]:
    return [s for one in sections for s in (one, *every(one.subsections))]


REPORT = reference(Relation.RE_ANALYSIS, {"Yv": "-0.029834", "Nv": "-0.0128"}, "report")
QUOTED = reference(Relation.QUOTED, {"Yv": "-0.0298", "Nv": "-0.0128", "Nr": "-0.0044"}, "experiment 1990")
OTHER = reference(Relation.CROSS_BODY, {"Yv": "-0.0303", "Nr": "-0.0040"}, "steady CFD", body="another hull")


@pytest.fixture(scope="module")
def beside() -> Answer:
    return answer(compared(OTHER, REPORT, QUOTED))


def test_the_experiment_is_the_first_column_and_the_one_compared(beside: Answer):
    assert (beside.columns, beside.compared) == (("experiment 1990", "steady CFD"), "experiment 1990")
    assert [r.symbol for r in beside.rows] == ["Yv", "Nv", "Nr"]
    assert beside.rows[2].published == (-0.0044, -0.0040)
    assert beside.rows[1].published == (-0.0128, None)


def test_a_column_about_another_point_is_compared_there_and_the_page_says_so():
    """Before: "no published evaluation of these data", while the comparison stood further down."""
    study = compared(reference(Relation.RE_ANALYSIS, {"Yv": "-0.03"}, "old", reference_point=(9.0, 0.0, 0.0)))
    assert "old: compared about another point" in answer(study).sentence


def test_a_quoted_column_has_the_digits_of_the_report_that_it_rounds(beside: Answer):
    assert beside.rows[0].published[0] == -0.029834
    rounded_otherwise = reference(Relation.RE_ANALYSIS, {"Yv": "-0.0271"}, "report")
    assert answer(compared(rounded_otherwise, QUOTED), drawn=False).rows[0].published[0] == -0.0298


def test_published_values_keep_the_digits_of_their_sources_wherever_they_are_shown(beside: Answer):
    """No digits of our U95, which would make -0.0303 and -0.0040 other numbers."""
    assert [r.shown for r in beside.rows] == [("-0.029834", "-0.0303"), ("-0.0128", None), ("-0.0044", "-0.0040")]
    assert [row[2:4] for row in answer_table(beside).rows] == [
        ("-0.029834", "-0.0303"), ("-0.0128", "-"), ("-0.0044", "-0.0040"),
    ]  # fmt: skip
    made = document(compared(OTHER, REPORT, QUOTED))
    rows = pdf.content(made)["answer"]["rows"]
    said = [[None if p is None else "".join(p).replace("\u2212", "-") for p in r["published"]] for r in rows]
    assert said == [["-0.029834", "-0.0303"], ["-0.0128", None], ["-0.0044", "-0.0040"]]
    page = html.render(made)["report.html"].decode()
    cells = re.findall(r'<td role="cell" class="published[^>]*>(.*?)</td>', page)
    texts = [re.sub("<[^>]+>", "", c).replace("\u2212", "-") for c in cells]
    assert texts == ["-0.029834", "-0.0303", "-0.0128", "no data", "-0.0044", "-0.0040"]


@pytest.mark.parametrize(
    ("value", "printed", "shown"),
    [(-0.01391, "-0.013910", "-0.013910"), (-0.0281 * 1.045, "-0.0281", "-0.0294"), (-1.9e-5, "-0.000019", "-1.9e-05"),
     (0.0, "0.000", "0.000"), (0.02, "+0.0200", "0.0200"), (0.5, ".5", "0.5")],
)  # fmt: skip
def test_digits_of_a_source(value: float, printed: str, shown: str):
    assert in_digits_of(value, printed) == shown


def test_a_u95_above_the_value_has_one_text_everywhere():
    row = AnswerRow("Yr", -0.00173, 0.01087)
    made = Answer("One sentence.", rows=(row,))
    page = Document("T", "", (), answer=made)
    assert percent(row.u95, row.value) == share_text(row.u95 / row.value) == "> 100 %"
    assert "(> 100 %)" in answer_table(made).rows[0][1]
    assert pdf.content(page)["answer"]["rows"][0]["within"] == [{"whole": ["> 100 %"]}]
    assert html.row_of(row).share == "> 100 %"
    assert percent(0.999, 1.0) == "99.9 %"


def test_names_of_one_source_are_one_name():
    assert _several("Roddy configuration", ["1", "2"]) == "Roddy, configurations 1 and 2"
    assert _several("Roddy", ["1", "2"]) == "Roddy 1 and Roddy 2"
    assert _several("Smith body", ["A", "B"]) == "Smith body A and Smith body B"


def test_difference_share_and_verdict_belong_together(beside: Answer):
    yv, nv, nr = beside.rows
    for row in (yv, nv):
        assert row.difference == row.value - row.published[0]
        assert row.agrees is (abs(row.share) <= 1.0)
    assert (yv.agrees, nv.agrees) == (True, False)
    assert (nr.value, nr.status, nr.difference, nr.share, nr.agrees) == (None, "no data", None, None, None)


def test_only_a_re_analysis_gives_a_verdict():
    made = answer(compared(QUOTED, OTHER), drawn=False)
    assert made.rows[0].difference is not None
    assert [r.agrees for r in made.rows] == [None, None, None]
    assert "within" not in made.sentence
    assert "differ" not in made.sentence


def test_a_quoted_column_of_other_derivatives_hides_no_verdict():
    """An arm test that is quoted for Nr' alone stood before the report that Nv' differs from, and the answer was silent."""
    arm = reference(Relation.QUOTED, {"Nr": "-0.0044"}, "arm test")
    made = answer(compared(arm, REPORT), drawn=False)
    assert (made.compared, made.columns) == (REPORT.name, (REPORT.name, "arm test"))
    assert [r.agrees for r in made.rows if r.agrees is not None] == [
        r.agrees for r in answer(compared(REPORT), drawn=False).rows if r.agrees is not None
    ]


def test_a_quoted_column_of_some_derivatives_hides_no_verdict_on_the_others():
    some = reference(Relation.QUOTED, {"Yv": "-0.0298"}, "experiment 1990")
    made = answer(compared(some, REPORT), drawn=False)
    assert made.compared == REPORT.name
    assert sum(r.agrees is not None for r in made.rows) == 2


def test_no_verdict_on_a_value_that_was_moved_for_it():
    """A comparison about the point of its source is not one of the value that the row shows."""
    away = replace(REPORT, reference_point=np.array([-0.5, 0.0, 0.0]))
    made = answer(compared(away), drawn=False)
    assert all(r.published == (None,) and r.difference is None and r.agrees is None for r in made.rows)


def test_published_values_are_primed_by_our_length():
    longer = replace(QUOTED, scaling=replace(LENGTH, length=4.0, length_name="LBP"))
    made = answer(compared(longer, OTHER), drawn=False)
    assert made.rows[0].published[0] == pytest.approx(-0.0298 * 4.0)  # (4 m / 2 m)^2
    assert made.rows[2].published[0] == pytest.approx(-0.0044 * 16.0)


def test_one_reading_in_the_column_the_other_in_a_note():
    twice = replace(OTHER, other_scaling=replace(LENGTH, length=2.2, length_name="LWL"))
    made = answer(compared(QUOTED, twice), drawn=False)
    assert made.rows[0].published[1] == -0.0303
    assert any("LOA assumed, not stated (if LWL: Yv' +21.0 %, Nr' +46.4 %)" in note for note in made.notes)


@pytest.mark.parametrize(
    ("references", "sentence"),
    [
        ((REPORT, QUOTED), "Study tow: our fits to the data of experiment 1990 differ from its Nv' by more than U95 (one of two static derivatives); no rotating-arm data."),
        ((reference(Relation.RE_ANALYSIS, {"Yv": "-0.0298"}, "report"),),
         "Study tow: our fits to the data of report reproduce its Yv' within U95; no rotating-arm data."),
        ((reference(Relation.RE_ANALYSIS, {"Yv": "-0.0298", "Nv": "-0.0138"}, "report"),),
         "Study tow: our fits to the data of report reproduce its Yv' and Nv' within U95; no rotating-arm data."),
        ((), "Study tow: two of three wanted coefficients found, each with U95; no rotating-arm data."),
    ],
)  # fmt: skip
def test_sentence(references: tuple[Reference, ...], sentence: str):
    assert answer(compared(*references), drawn=False).sentence == sentence


@pytest.mark.parametrize("angles", [FULL, HALF, FEW])
@pytest.mark.parametrize("named", ["tow", HOSTILE, ENDLESS])
def test_any_name_and_any_sweep(angles: list[float], named: str):
    made = answer(small_study(angles, named=named), drawn=False)
    assert len(made.sentence) <= 160
    assert all(len(note) <= 244 for note in made.notes)
    assert len(made.notes) <= 4
    assert [c.name for c in made.chips] == [
        "Stability",
        "Warnings",
        "Exports to simulators",
    ]
    assert all(len(c.text.split()) <= 6 for c in made.chips)
    folded = replace(answer_table(made), notes=())
    assert max(map(len, plain_lines(folded))) <= 80


def test_a_bar_of_one_u95_and_one_beyond():
    rows = (
        AnswerRow("Yv", -0.0262, 0.0027, published=(-0.0278, -0.0281, -0.0303), difference=0.0027, agrees=True),
        AnswerRow("Nv", -0.0147, 0.0019, published=(-0.0136, -0.0140, -0.0131), difference=-0.0057, agrees=False),
        AnswerRow("Nr", -0.0028, 0.0010, published=(-0.0044, -0.0040, -0.0042), difference=0.0016),  # no verdict
    )
    made = answer_table(Answer("S", ("experiment 1990", "steady CFD", "PMM CFD 2012"), "experiment 1990", rows))
    assert made.headers == ("", "ours +- U95", "experiment", "steady CFD", "PMM CFD", "diff./U95")
    assert [row[-1] for row in made.rows] == ["+1.00 ######", "-3.00 ######!", "+1.60 ######"]
    assert made.rows[1][1:5] == ("-0.0147 +- 0.0019 (13 %)", "-0.0136", "-0.0140", "-0.0131")
    assert plain_lines(made)[1].split()[-1] == "diff./U95"
    assert max(map(len, plain_lines(made))) <= 79


def test_why_there_is_no_value():
    made = answer(small_study(FEW), drawn=False)
    assert [r.status for r in made.rows] == ["too few points", "too few points", "no data"]
    assert "too few points" in made.sentence


def test_campaigns_of_one_hull_under_two_bodies_are_no_lack_of_data():
    """Each body has what the other lacks: mostly two imports, which write the names of their folders."""
    study = small_study(FULL)
    (fit,) = study.fits
    first, second = (
        replace(
            fit, campaign=name, body=name, sweeps=(),
            coefficients=replace(
                fit.coefficients, body=name,
                coefficients=tuple(replace(c, campaign=name, body=name) for c in fit.coefficients.coefficients if c.symbol in own),
            ),
        )
        for name, own in (("drift", ("Yv",)), ("attack", ("Nv",)))
    )  # fmt: skip
    two = replace(study, fits=(first, second), missing=())
    assert set(two.by_body) == {"drift", "attack"}
    rows = {r.symbol: r.status for r in answer(two).rows if r.value is None}
    of_other = {s for s in two.by_body["attack"] if s in rows}
    assert of_other
    assert {rows[s] for s in of_other} == {"fitted for body attack"}
    (warned,) = coverage._bodies(two)
    assert warned.severity is Severity.WARN
    assert "give its campaigns one campaign.body" in warned.comment
    one = replace(two, fits=(first, replace(second, body="drift", coefficients=replace(second.coefficients, body="drift",
        coefficients=tuple(replace(c, body="drift") for c in second.coefficients.coefficients)))))  # fmt: skip
    assert not one.by_body
    assert not study.by_body


def test_a_rejected_form_has_a_value_and_no_interval():
    study = small_study(FULL)
    fit = study.fits[0]
    rejected = tuple(
        replace(c, status=Status.FORM_REJECTED) if c.symbol == "Yv" else c for c in fit.coefficients.coefficients
    )
    study = replace(study, fits=(replace(fit, coefficients=replace(fit.coefficients, coefficients=rejected)),))
    row = answer(study, drawn=False).rows[0]
    assert (row.u95, row.status) == (None, "form rejected")
    assert "form rejected" in answer_table(answer(study, drawn=False)).rows[0][1]


def test_an_own_tow_stands_in_for_what_no_test_gives(monkeypatch: pytest.MonkeyPatch, beside: Answer):
    study = compared(OTHER, REPORT, QUOTED)
    tow = PlannedTow("AFF-8", "AFF-8", campaign="own_tow", columns=("experiment 1990",))
    value = Coefficient("Nr", -0.0041, 0.0003, Status.OK, "AFF-8", campaign="own_tow")
    rows = tuple(
        TowedRow(s, value if s == "Nr" else None, None, "", "", (None,), verdict=True) for s in study.plan.wanted
    )
    monkeypatch.setattr(first_page, "towed", lambda _: (Towed(tow, "AFF-8", ("experiment 1990",), rows),))
    made = answer(replace(study, plan=replace(study.plan, tows=(tow,))), drawn=False)
    row = made.rows[2]
    assert (row.value, row.u95, row.source, row.agrees) == (-0.0041, 0.0003, "own_tow", None)
    assert row.difference == pytest.approx(0.0003)
    for mine, before in zip(made.rows[:2], beside.rows[:2], strict=True):
        assert (mine.value, mine.u95, mine.agrees) == (before.value, before.u95, before.agrees)
        assert mine.published[: len(before.published)] == before.published
        own = [t for t in study.tables if t.campaign == mine.source]
        assert mine.published[-1] == line(own, mine.symbol, study.fits[0].coefficients.scaling.length)
    assert made.columns == (*beside.columns, NAME)
    assert max(len(text) for text in show.plain_lines(answer_table(made))) <= 80
    wide = replace(rows[2], coefficient=replace(value, u95=0.0019))
    monkeypatch.setattr(
        first_page, "towed", lambda _: (Towed(tow, "AFF-8", ("experiment 1990",), (*rows[:2], wide, *rows[3:])),)
    )
    open_row = answer(replace(study, plan=replace(study.plan, tows=(tow,))), drawn=False).rows[2]
    assert (open_row.value, open_row.status) == (None, "no result")
    assert "Nr': our CFD own_tow; no verdict." in made.notes
    assert "no rotating-arm data" not in made.sentence


def test_the_slope_figure_shows_quotients_and_where_they_end(beside: Answer):
    study = small_study(FULL)
    sweep = study.fits[0].sweep("Yv")
    (panel,) = beside.slope.panels
    shown = {(s.key, s.is_curve): s for s in panel.series}
    mine = sweep.x > 0.0
    np.testing.assert_allclose(shown["plus", False].x, sweep.x[mine], rtol=1e-5)
    np.testing.assert_allclose(shown["plus", False].y, (sweep.y[mine] - sweep.at_rest[0]) / sweep.x[mine], rtol=1e-5)
    np.testing.assert_allclose(shown["minus", False].x, -sweep.x[sweep.x < 0.0], rtol=1e-5)
    assert shown["plus", True].y[0] == pytest.approx(sweep.value, rel=1e-5)
    np.testing.assert_allclose(shown["value", True].y, beside.rows[0].value, rtol=1e-5)
    assert set(shown["published", True].y) == {-0.029834}
    assert panel.up[0] < min(s for series in panel.series for s in series.y)


def test_the_band_of_the_slope_is_that_of_the_row(beside: Answer):
    """Its U95 may hold more than scatter and form: the grid of a computation."""
    study = compared(REPORT)
    wide = answer(study).slope.svg
    doubled = replace(beside.rows[0], u95=3.0 * beside.rows[0].u95)
    assert slope_figure(study.fits[0].sweep("Yv"), doubled).svg != wide


def test_a_point_that_does_not_carry_the_slope_is_a_cross():
    study = small_study(FULL)
    sweep = replace(study.fits[0].sweep("Yv"), wrong=np.array([2]))
    made = slope_figure(sweep, AnswerRow("Yv", sweep.value, sweep.u95))
    shown = {(s.key, s.is_curve): s for s in made.panels[0].series}
    assert shown["wrong", False].notes == (f"point {sweep.labels[2]}",)
    assert len(shown["minus", False].x) == int(np.sum(sweep.x < 0.0)) - 1
    assert f"Without point {sweep.labels[2]}" in made.caption


def test_the_forest_is_over_the_compared_column(beside: Answer):
    (panel,) = beside.forest.panels
    shown = {s.key: s for s in panel.series}
    yv, nv, _ = beside.rows
    assert shown["ours"].x == pytest.approx((yv.value / yv.published[0], nv.value / nv.published[0]), rel=1e-5)
    assert shown["column0"].x == (1.0, 1.0, 1.0)
    assert shown["column1"].x == pytest.approx((0.0303 / 0.029834, 0.0040 / 0.0044), rel=1e-5)
    assert shown["column1"].y == (3.0, 1.0)
    assert panel.across[0] < (yv.value + yv.u95) / yv.published[0]
    assert "no data" in beside.forest.svg


def test_a_forest_says_what_lies_outside():
    far = AnswerRow("Yv", -0.9, 0.01, published=(-0.02,))
    assert "Ours lies outside the frame: Yv'." in forest_figure((far,), ("experiment",), "experiment").caption
    assert forest_figure((replace(far, published=(None,)),), ("experiment",), "experiment") is None


@pytest.mark.parametrize(("value", "way"), [(-0.1, "><"), (-9e-3, "")])
def test_a_bar_cut_at_the_frame_has_an_arrow(value: float, way: str):
    half = {"><": 0.35, "": 1e-3}[way]
    made = forest_figure((AnswerRow("Yv", value, half),), (), "")
    assert ("the bar goes on" in made.caption) == bool(way)
    plain = forest_figure((AnswerRow("Yv", value, half / 1e4),), (), "")
    assert (made.svg.count("<use ") - plain.svg.count("<use ")) == len(way)


def test_a_value_whose_interval_contains_zero_has_an_open_sign():
    study = small_study(FULL)
    fit = study.fits[0]
    wide = tuple(replace(c, u95=2.0 * abs(c.value)) if c.symbol == "Nv" else c for c in fit.coefficients.coefficients)
    open_ = replace(study, fits=(replace(fit, coefficients=replace(fit.coefficients, coefficients=wide)),))
    said = answer(open_, drawn=False).sentence
    assert (
        said
        == "Study tow: two of three wanted coefficients found, each with U95, sign open of Nv'; no rotating-arm data."
    )


@pytest.mark.parametrize("wanted", [(), ("Yv", "Kv")])
def test_a_headline_names_an_open_roll_moment_only_where_it_is_asked_for(wanted: tuple[str, ...]):
    study = small_study(FULL)
    (fit,) = study.fits
    rolls = tuple(
        replace(c, symbol="Kv", u95=2.0 * abs(c.value)) if c.symbol == "Nv" else c
        for c in fit.coefficients.coefficients
    )
    swept = tuple(replace(s, symbol="Kv", component="K") if s.symbol == "Nv" else s for s in fit.sweeps)
    turned = replace(fit, sweeps=swept, coefficients=replace(fit.coefficients, coefficients=rolls))
    said = answer(replace(study, plan=replace(study.plan, wanted=wanted), fits=(turned,)), drawn=False)
    assert [r.symbol for r in said.rows] == ["Yv", "Kv"]
    assert ("sign open of Kv'" in said.sentence) == bool(wanted)


def test_values_from_a_table_that_fails_a_check_are_not_counted():
    """A wrong length failed the checks of every table, and the sentence counted all of their coefficients."""
    study = small_study(FULL)
    campaign = study.fits[0].campaign
    bad = Check("sizes", "tow X", Severity.FAIL, "10 m", "1 m", "", campaign, f"{campaign}/table.csv")
    said = answer(replace(study, checks=(*study.checks, bad)), drawn=False).sentence
    assert said.startswith("Study tow: none of three wanted coefficients found, two from tables that fail a check;")
    one = answer(replace(study, checks=(*study.checks, replace(bad, symbol="Yv"))), drawn=False).sentence
    assert one.startswith(
        "Study tow: one of three wanted coefficients found, each with U95, one from tables that fail a check;"
    )
    other = replace(study, checks=(*study.checks, replace(bad, campaign="other", subject=campaign)))
    assert answer(other, drawn=False).sentence.startswith(
        "Study tow: two of three wanted coefficients found, each with U95;"
    )


def test_without_published_values_the_forest_is_over_ours():
    (panel,) = answer(small_study(FULL)).forest.panels
    assert panel.series[0].x == (1.0, 1.0)


def test_senses_in_the_sketch():
    """Right-handed: r turns x to y and p turns y to z, both drawn downwards; q turns z to x, up to the axis ahead."""
    svg = axes_figure().svg
    for text in ("from above", "from starboard", "from astern"):
        assert text in svg
    place = {said: float(y) for y, said in re.findall(r'<text [^>]*?y="([\d.]+)"[^>]*>(?:<tspan[^>]*>)?(\w)', svg)}
    assert set("xyzpqr") <= set(place)
    tips = re.findall(r'<path d="M [\d.]+ ([\d.]+) \nL [^"]*z\n"[^>]*fill: var\(--fig-a', svg)
    r, q, p = map(float, tips)
    assert min(r, p) > place["x"] + 20.0
    assert q < place["x"] + 15.0


def test_every_document_has_its_answer():
    study = compared(OTHER, REPORT, QUOTED)
    whole = document(study)
    assert study_summary(study).answer.rows == tuple(replace(r, anchor="") for r in whole.answer.rows)
    assert whole.answer.sentence == answer(study).sentence
    linked = {*(r.anchor for r in whole.answer.rows), *(c.anchor for c in whole.answer.chips)} - {""}
    assert linked <= {s.anchor for s in every(whole.sections)}
    assert "campaign-tow-yv" in linked
    made = found(2.05)
    published = acceptance_document.document(made)
    assert published.answer == answer(made)


def test_a_publication_has_its_tables_in_the_place_of_rows():
    made = answer(found(2.5))
    assert (
        made.sentence
        == "Boat: 1 of 3 numbers outside the tolerance; none of them is validation: verification and calibration only."
    )
    assert made.rows == ()
    assert (
        [(r[0], *r[2:]) for r in made.table.rows]
        == [r[:4] for r in answer_table(made).rows]
        == [
            ("verification", "2 of 2", "50 %", "pass"),
            ("calibration", "0 of 1", "500 %", "fail"),
        ]
    )
    assert [c.severity.value for c in made.chips] == ["fail", "note", "note", "note"]
    assert made.slope.anchor == "answer-figure"
    assert answer(found(2.05)).sentence.startswith("Boat: all 3 numbers within the tolerance;")
    assert "arrow" in made.forest.caption
    assert "Turns: 5.00" in made.forest.description
    assert "arrow" not in answer(found(2.05)).forest.caption


def test_what_a_number_is_compared_with_stands_below_on_a_terminal():
    made = answer(found(2.05), drawn=False)
    assert made.table.rows[1][1] == "our model was fitted to these numbers, so agreement proves nothing"
    assert f"calibration: {made.table.rows[1][1]}" in answer_table(made).notes
    assert max(map(len, plain_lines(answer_table(made)))) <= 80


def test_a_number_that_is_met_twice_counts_once_by_basis():
    made = found(2.05)
    again = replace(made.tables[0], key="again", repeats="turns_a")
    made = answer(replace(made, tables=(*made.tables, again)), drawn=False)
    assert [r[2] for r in made.table.rows] == ["2 of 2", "1 of 1"]
    assert made.table.notes == ("3 more comparisons repeat these numbers in another way: 3 within the tolerance.",)


def test_bars_of_the_tables_have_names_of_their_own_width():
    """A name stands above its bar, whole where it fits; the line of the tolerance keeps clear of the counts."""
    long = found(2.05)
    long = replace(long, tables=(*long.tables, replace(long.tables[0], title="Steady turns " * 12)))
    figure = answer(long).forest
    assert "Turns<" in figure.svg
    assert "Steady turns Steady turns" in figure.svg
    (panel,) = figure.panels
    tolerance = panel.frame[0] + panel.frame[2] / panel.across[1]
    counts = [float(x) for x in re.findall(r'<text [^>]*text-anchor: end[^>]*x="([\d.]+)"[^>]*>3 of 3', figure.svg)]
    assert len(counts) == 2
    assert tolerance + text_width("3 of 3", SIZE) < min(counts)


def test_a_drawing_under_another_anchor_refers_to_itself():
    svg = '<svg aria-labelledby="a-b-title a-b-desc"><path id="a-b-0"/><use href="#a-b-0"/><g clip-path="url(#a-b-1)"/></svg>'
    made = renamed(replace(DRAWN, svg=svg), "answer-figure").svg
    assert "a-b" not in made.replace("answer-figure", "")
    assert made.count("answer-figure-0") == 2


@pytest.mark.slow
def test_suboff(suboff: Study):
    made = answer(suboff)
    found = verdict(suboff)
    assert found.paragraphs[0].startswith("The study passes: no re-analysis and no check failed.")
    said = {t.name: t.texts for t in found.topics}
    assert list(said) == [
        "Re-analyses", "Predictions", "Recomputed", "Other bodies", "Stability", "Coefficients", "No value", "Measure next"
    ]  # fmt: skip
    assert said["Re-analyses"][:2] == (
        "12 of 12 coefficients agree with the authors' own evaluation of their data, within U95.",
        "Weak, as our U95 and the source's uncertainty together exceed 25 % of the published value: Zw' of "
        "suboff_roddy_1 (44 %), Yv' of suboff_roddy_3 (53 %) and Kv' of suboff_roddy_3 (45 %).",
    )
    assert said["Predictions"] == (
        "2 of 2 coefficients agree with the test of the same body, within the validation uncertainty U_V. Only predictions are independent evidence.",
        "4 comparisons judge them; a coefficient of several campaigns passes if all of its comparisons do.",
        "Weak predictions (U_V above 25 % of the measured value): Yv' of suboff_cfd_barehull (86 %) and Yv' of suboff_tow_bare_hull (82 %).",
        "No verdict on Kv' (zero by symmetry, and the test has a bias), X0' (grid study diverged; friction differs by 9 % between the two Reynolds "
        "numbers, ITTC 1957), Xvv' (grid study diverged). No verdict on Yr' and Nr' (the test used another method, PMM; grid study diverged in "
        "suboff_tow_bare_hull).",
        "Of these, beyond U_V (difference in % of the measured value): Kv', Yr' (-70 %) and Nr' (-46 %) of suboff_cfd_barehull; "
        "Yr' (-62 %) and Nr' (-41 %) of suboff_tow_bare_hull.",
        "Yv' (-57 %) of suboff_tow_aff8 differs from the test by more than U_V. We do not count it: the test was of another body "
        "(suboff_fully_appended).",
        "Nr' (-37 %) of suboff_tow_aff8 differs from the test by more than U_V. We do not count it: the test was of another body "
        "(suboff_fully_appended); the test used another method, PMM.",
    )
    assert said["Recomputed"][0].startswith("3 of 3 stability indices of the test report follow")
    assert (
        made.sentence
        == "DARPA SUBOFF: our fits to the data of experiment 1990 reproduce its Yv', Nv', Zw' and Mw' within U95."
    )
    assert made.columns == ("experiment 1990", "published CFD", "PMM CFD 2012", "our line")
    assert [r.source for r in made.rows] == ["suboff_roddy_2"] * 2 + ["suboff_roddy_1"] * 2 + ["suboff_tow_aff8"] * 2
    assert [r.agrees for r in made.rows] == [True] * 4 + [None] * 2
    assert [r.published[0] for r in made.rows] == [-0.027834, -0.013648, -0.01391, 0.010324, 0.005251, -0.004444]
    lines = plain_lines(replace(answer_table(made), notes=()))
    assert max(map(len, lines)) <= 79
    assert lines[2].split() == [
        "Yv'",
        "-0.0262",
        "+-",
        "0.0027",
        "-0.027834",
        "-0.0281",
        "-0.0303",
        "-0.0301",
        "+0.59",
        "#",
    ]
    assert lines[6].split() == ["Yr'", "no", "result", "0.005251", "0.0044", "0.0046", "0.0030", "-"]


@pytest.mark.parametrize(("second", "shown", "severity"), [(2.05, "1 of 1 pass", "pass"), (2.5, "0 of 1 pass", "fail")])
def test_the_chip_of_validation_fails_with_what_it_counts(second: float, shown: str, severity: str):
    """It said pass for a count of numbers, whatever came out of them."""
    made = found(second)
    table = made.tables[0]
    rows = (*table.rows[:1], replace(table.rows[1], basis=Basis.VALIDATION), *table.rows[2:])
    chip = next(c for c in answer(replace(made, tables=(replace(table, rows=rows),))).chips if c.name == "Validation")
    assert (chip.text, str(chip.severity)) == (shown, severity)


def test_numbers_of_a_section_are_about_one_point_or_both_are_named():
    """The value of a sweep about x = -0.3 m stands beside that of the study's point, with both points."""
    study = small_study(FULL)
    (fit,) = study.fits
    here = replace(
        fit, coefficients=fit.coefficients.about(fit.coefficients.reference_point + np.array([0.3, 0.0, 0.0])),
        settings={"swept about": "x = -0.3 m from nose"},
    )  # fmt: skip
    moved = replace(study, fits=(here,))
    parts = {s.title: " ".join(s.paragraphs) for s in every(document(moved, full=True).sections)}
    swept = fit.coefficients["Nv"]
    ours = here.coefficients["Nv"]
    assert abs(ours.value - swept.value) > 3.0 * swept.u95
    value, u95 = with_u95(swept.value, swept.u95)
    assert f"Nv' about x = -0.3 m from nose = {value} +- {u95}: the value of this sweep" in parts["Nv'"]
    assert f"= {with_u95(ours.value, ours.u95)[0]} +- " in parts["Nv'"].partition(":")[0]
    assert "the value of this sweep" not in parts["Yv'"]  # no shift forward moves it
    drawn = answer(moved, drawn=True).slope
    assert drawn is not None
    assert drawn.title.startswith("Yv'")
    rows = replace(moved, plan=replace(moved.plan, wanted=("Nv",)))
    assert answer(rows, drawn=True).slope is None


def test_the_first_page_stars_what_no_source_states():
    study = small_study(FULL)
    (fit,) = study.fits
    here = replace(
        fit,
        findings=carried(
            [key("axes.beta", fit.coefficients["Nv"].table, "v = -U sin(beta)")], [fit.coefficients["Nv"]]
        ),
    )
    found = answer(replace(study, fits=(here,)), drawn=True)
    assert {r.symbol: r.name for r in found.rows} == {"Yv": "Yv'", "Nv": "Nv' *", "Nr": "Nr'"}
    line = "* assumed, not stated by the source: axes.beta (see Checks)."
    assert line in found.notes
    shown = answer_table(found)
    assert [row[0] for row in shown.rows] == ["Yv'", "Nv' *", "Nr'"]
    assert not any(r.assumed for r in answer(study).rows)


def test_a_value_of_open_sign_does_not_squeeze_the_bars_of_the_others():
    rows = (AnswerRow("Yv", -0.03, 0.003), AnswerRow("Nv", -0.01, 0.002), AnswerRow("Kv", 1e-9, 4e-8))
    frame = forest_figure(rows, (), "").panels[0].across
    assert frame == pytest.approx((0.8 - 0.06 * 0.4, 1.2 + 0.06 * 0.4))
    alone = forest_figure(rows[2:], (), "").panels[0].across
    assert alone == pytest.approx((-1.0 - 0.24, 3.0 + 0.24))
