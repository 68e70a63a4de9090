from __future__ import annotations

from dataclasses import replace

from coeflab.core.provenance import InputFile
from coeflab.report import acceptance as acceptance_tables
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.document import Figure
from coeflab.report.first_page import acceptance_summary
from coeflab.report.sections import acceptance as acceptance_document

DRAWN = Figure("a-b", '<svg viewBox="0 0 340 100"></svg>', "A & B", "cap", "two lines")


def found(second: float, **changes) -> Acceptance:
    rows = (
        Compared("case 1", "u", "m/s", 1.0, 1.05, 0.1, Basis.VERIFICATION),
        Compared("case 2", "u", "m/s", 2.0, second, 0.1, Basis.CALIBRATION),
        Compared("case 3", "rms", "1", 0.5, 0.1, 0.0, Basis.VERIFICATION, at_most=True),
    )
    table = ComparedTable("turns_a", "Turns", rows, "Table 1", ("a statement",))
    made = {
        "errata": ("one",),
        "statements": ("know this",),
        "citations": ("huuv2025",),
        "figures": (("a_b", DRAWN),),
        "conventions": ("y points to port in the paper.",),
    }
    return Acceptance("boat", "Boat", (table,), **(made | changes))


def test_all_parts_are_there():
    document = acceptance_document.document(found(2.05), (InputFile("boat/a.csv", "0" * 64),))
    assert [s.anchor for s in document.sections] == [
        "verdict",
        "figures",
        "compared",
        "statements",
        "errata",
        "conventions",
        "provenance",
        "reproduce",
    ]
    assert document.name == "boat"
    assert len(document.digest) == 16
    assert document.works[0][0] == "huuv2025"
    (figure,) = document.sections[1].figures
    assert figure == DRAWN
    assert document.sections[2].subsections[0].anchor == "table-turns-a"
    assert "y points to port in the paper." in document.sections[5].paragraphs
    assert [f.anchor for f in document.sections[5].figures] == ["axes-plan", "axes-profile", "axes-triad"]
    assert document.sections[6].tables[0].rows == (("boat/a.csv", "0" * 64),)
    assert document.sections[7].code == ("coeflab report boat --to html,pdf",)


def test_parts_without_content_are_left_out():
    document = acceptance_document.document(found(2.05, errata=(), statements=(), figures=()))
    assert [s.anchor for s in document.sections] == ["verdict", "compared", "conventions", "reproduce"]
    assert document.digest == ""


def test_the_verdict_counts_and_names_what_fails():
    assert acceptance_document.verdict(found(2.05)).paragraphs[0] == (
        "3 of the 3 compared numbers lie within their tolerance: verification 2 of 2; calibration 1 of 1."
    )
    failed = acceptance_document.verdict(found(2.5))
    assert failed.paragraphs[0].startswith("2 of the 3 compared numbers lie within their tolerance: ")
    assert (
        failed.paragraphs[1] == "Nothing here is validation: nothing is compared with a measurement that was not used."
    )
    assert failed.paragraphs[2] == "Outside, Turns: u of case 2."
    assert failed.paragraphs[3:] == (
        "Verification: published: computed by its authors from the same equations or data.",
        "Calibration: our model was fitted to these numbers, so agreement proves nothing.",
    )


def test_numbers_met_another_way_count_once():
    """25 turns three ways were "all 100 numbers of HUUV"."""
    made = found(2.05)
    again = replace(made.tables[0], key="again", repeats="turns_a")
    first, second = acceptance_document.headline(replace(made, tables=(*made.tables, again)))
    assert first.startswith("3 of the 3 compared numbers lie within")
    assert first.endswith(
        "3 more comparisons repeat these numbers in another way and do not count; 3 of them lie within."
    )
    assert second == "Nothing here is validation: nothing is compared with a measurement that was not used."
    failing = replace(again, rows=(*again.rows, Compared("case 4", "u", "m/s", 1.0, 2.0, 0.1, Basis.VERIFICATION)))
    assert not replace(made, tables=(*made.tables, failing)).holds


def test_a_number_is_called_validation_only_where_it_is_measured():
    """Basis beside every number; no column says paper, and a report without measurements says so."""
    (shown,) = acceptance_tables.tables(found(2.05))
    assert shown.headers[2:5] == ("reference", "basis", "found")
    assert [row[2:4] for row in shown.rows] == [
        ("1", "verification"),
        ("2", "calibration"),
        ("at most 0.5", "verification"),
    ]
    assert b"held_against" in acceptance_tables.acceptance_csv(found(2.05)).splitlines()[0]
    none = "Nothing here is validation: nothing is compared with a measurement that was not used."
    measured = replace(found(2.05).tables[0], rows=(Compared("case", "u", "m/s", 1.0, 1.05, 0.1, Basis.VALIDATION),))
    assert none not in acceptance_document.verdict(replace(found(2.05), tables=(measured,))).paragraphs
    rows = (Compared("case", "mass", "kg", 2.2297, 2.2297, 5e-5, Basis.CONSISTENCY),)
    made = Acceptance("boat", "Boat", (ComparedTable("t", "T", rows, "Table 1"),), (), (), ())
    said = acceptance_document.verdict(made)
    assert none in said.paragraphs
    assert said.figures[0].panels[0].series[0].notes == (
        "case, mass: reference 2.2297 kg (consistency), found 2.2297 kg",
    )
    assert all("paper " not in note for p in said.figures[0].panels for s in p.series for note in s.notes)


def test_the_overview_shows_how_much_of_the_allowance_is_used():
    assert acceptance_document.overview(found(2.08)).rows == (("Turns", "Table 1", "3 of 3", "80 %", "pass"),)
    assert acceptance_document.overview(found(2.5)).rows[0][2:] == ("2 of 3", "500 %", "fail")


def test_a_limit_that_is_nearly_reached_shows_in_the_overview():
    rows = (Compared("case", "rms", "1", 0.5, 0.45, 0.0, Basis.VERIFICATION, at_most=True),)
    made = Acceptance("boat", "Boat", (ComparedTable("t", "T", rows, "Table 1"),), (), (), ())
    assert acceptance_document.overview(made).rows[0][2:] == ("1 of 1", "90 %", "pass")


def test_the_summary_is_the_first_page_without_links():
    made = found(2.05)
    whole = acceptance_document.document(made)
    short = acceptance_summary(made, whole)
    assert (short.sections, short.works, short.name) == ((), (), "boat")
    assert short.answer.sentence == whole.answer.sentence
    assert {c.anchor for c in short.answer.chips} == {""}
    assert any(c.anchor for c in whole.answer.chips)
