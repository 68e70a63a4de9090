"""Nouns as they show themselves in a notebook: a line and a card, well formed, escaped, with their numbers and a picture."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.cli.show import plain_lines
from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.several import ByName, Several
from coeflab.core.table import Check, Table
from coeflab.fits import FITS
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import COVERS, Coefficient, Parts, Status
from coeflab.motion.simulation import simulate
from coeflab.report.first_page import answer
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables import results
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.motion.vehicles import made
from tests.report.studies import FULL, HOSTILE, LENGTH, small_study

VOID = {"meta", "br", "img"}


class Closed(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.ids = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        self.tags.append(tag)
        self.ids += [value for name, value in attrs if name == "id"]

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.ids += [value for name, value in attrs if name == "id"]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def nouns():
    """Every noun that shows itself, what its line begins with, and what its card has to say."""
    tables = read_tables(PlannedTable(shipped("cfd_data") / "suboff_roddy_2", (), {}))
    result = FITS.load("polynomial").fit(tables, LENGTH, {"variable": "v", "degree": 3, "responses": "Y"})
    file, study = made(), small_study(FULL, named=HOSTILE, published=True)
    run = simulate(file, "straight_run", {"duration": 2.0}, free=("u",))
    matrix = AddedMass(np.diag([1.0, 20.0, 20.0, 0.0, 5.0, 5.0]), np.zeros(3), Datum(HOSTILE), "body", "panel")
    body = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    fit = study.fits[0]
    checks = Several((Check("symmetry", HOSTILE, Severity.PASS, "even", "", "as it should be"),
                      Check("signs", f"{HOSTILE} Yv'", Severity.FAIL, "Yv' = 0.1", "below zero", "axes")))  # fmt: skip
    return {
        "study": (study, "<Study small: ", "<svg"),
        "answer": (answer(study), "<Answer ", "<svg"),
        "coefficient": (fit.coefficients["Yv"], "<Coefficient Yv' = -0.02981 +- 0.00032 (1.1 %), ", "<svg"),
        "set": (fit.coefficients, "<CoefficientSet body of ", "<svg"),
        "fit": (fit, "<FitResult slope_at_origin of ", "<svg"),
        "models": (result, "<FitResult polynomial of suboff_roddy_2: 1 models", "<svg"),
        "model": (result.models[0], "<FittedModel Y", "<svg"),
        "force table": (study.tables[0], "<ForceTable ", "<svg"),
        "body": (body, "<Body spheroid_example: ", "<svg"),
        "added mass": (matrix, "<AddedMass body by panel: diagonal 1, 20, 20, 0, 5, 5>", "background: color-mix"),
        "parameters": (file, "<ParameterFile ", "0.0400"),
        "trajectory": (run.trajectory, "<Trajectory 2 s in ", "<svg"),
        "simulation": (run, "<Simulation straight_run of ", "<svg"),
        "figure": (answer(study).slope, "Figure(", "<svg"),
        "check": (checks[1], "<Check fail, signs: ", "axes"),
        "budget": (study.budgets[0], "<Budget Yv' = -0.02981 +- 0.00032 by 2 parts, most of it ", "<svg"),
        "coefficients": (study.coefficients, "<Several ", "<svg"),
        "tables": (study.tables, "<Several 1 ForceTable: ", "<svg"),
        "checks": (checks, "<Several 2 Check: symmetry, signs>", "below zero"),
        "budgets": (study.budgets, "<Several ", "not assessed"),
        "fits": (study.fits, "<Several 1 FitResult: ", "FitResult slope_at_origin"),
        "files": (ByName({file.name: file}), "<ByName 1 ParameterFile: ", "coefficients with a value"),
        "nothing": (Several(), "()", "0 together"),
    }


NAMES = ("study", "answer", "coefficient", "set", "fit", "models", "model", "force table", "body", "added mass",
         "parameters", "trajectory", "simulation", "figure", "check", "budget", "coefficients", "tables", "checks", "budgets",
         "fits", "files", "nothing")  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_noun_is_a_line_and_a_card(nouns, name):
    noun, line, expected = nouns[name]
    assert repr(noun).startswith(line)
    assert len(repr(noun)) < 500
    assert "\n" not in repr(noun)
    text = noun._repr_html_()
    page = Closed(text)
    assert expected in text
    assert "<script" not in text
    assert len(page.ids) == len(set(page.ids))
    assert text == noun._repr_html_()


def test_every_noun_of_the_contract_is_here(nouns):
    assert set(nouns) == set(NAMES)


@pytest.mark.parametrize("name", ["check", "budget", "coefficients", "tables", "checks", "budgets", "fits", "files"])
def test_what_a_study_holds_prints_a_short_line(nouns, name):
    assert len(repr(nouns[name][0])) < 200


def test_nouns_together_are_asked_by_name_and_stay_a_tuple(nouns):
    study = nouns["study"][0]
    assert isinstance(study.coefficients, tuple)
    assert study.coefficients["Yv"] is study.coefficients["Yv'"] is study.fits[0].coefficients["Yv"]
    assert study.coefficients[0] is study.coefficients[:1][0]
    assert "Yv" in study.coefficients
    assert study.coefficients[0] in study.coefficients
    assert "Zw" not in study.coefficients
    assert study.tables[HOSTILE] is study.tables[0]
    assert study.fits["slope_at_origin"] is study.fits[0]
    twice = Several((*study.coefficients, *study.coefficients))
    assert len(twice.of("Yv'")) == 2
    with pytest.raises(KeyError, match=r"2 go by .Yv.: \.of\(.*Yv.*\) has them all"):
        twice["Yv"]
    with pytest.raises(KeyError, match=r"no .Zw. among Yv, Nv"):
        study.coefficients["Zw"]
    both = (*nouns["checks"][0], *study.budgets)
    assert "Several" not in repr(both[:0])
    assert "symmetry" in Several(both)._repr_html_()


def test_nouns_by_name_cannot_be_changed(nouns):
    files = nouns["files"][0]
    (name,) = files
    assert dict(files) == {name: files[name]}
    with pytest.raises(KeyError, match=r"no .x. among "):
        files["x"]
    with pytest.raises(TypeError):
        files["x"] = files[name]
    assert files.get("x") is None
    assert repr(ByName({})) == "{}"


def test_cards_of_one_notebook_share_no_id(nouns):
    """An id that two outputs share would let one drawing be clipped by the frame of the other."""
    ids = [set(Closed(nouns[name][0]._repr_html_()).ids) for name in ("study", "fit", "force table", "trajectory")]
    for i, one in enumerate(ids):
        assert one
        assert not any(one & other for other in ids[i + 1 :])


def test_every_reference_of_a_card_is_to_an_id_in_it(nouns):
    for name in NAMES:
        text = nouns[name][0]._repr_html_()
        wanted = set(re.findall(r'(?:href="#|url\(#)([^")]+)', text))
        assert wanted <= set(Closed(text).ids), name


def test_a_value_without_one_says_why_and_an_open_sign_crosses_zero(nouns):
    study = nouns["study"][0]
    assert repr(study.missing[0]) == f"<Coefficient Nr': no table, {HOSTILE}>"
    assert "no table" in study.missing[0]._repr_html_()
    c = nouns["set"][0]["Yv"]
    assert "the sign is settled" in c._repr_html_()
    assert "the sign is open" in replace(c, u95=2.0 * abs(c.value))._repr_html_()


def test_text_columns_are_flush_left_and_numbers_flush_right():
    text = Table("t", ("a", "b"), (("x", "1"),))._repr_html_()
    assert '<td style="text-align: left">x</td><td style="text-align: right">1</td>' in text
    hostile = Table(HOSTILE, ("a", HOSTILE), (("1", HOSTILE),), (HOSTILE,))._repr_html_()
    assert "table" in Closed(hostile).tags
    assert "&lt;script&gt;" in hostile
    assert "<script" not in hostile


def test_coefficients_fit_80_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    """Columns go in the stated order, what has no table stands on one line, nothing of a kept row is cut."""
    headers = ("", "value", "U95", "U95 %", "random", "form", "input", "window", "n", "campaign", "estimator")
    row = (
        "-0.0262",
        "0.0027",
        "10.2 %",
        "3.6 %",
        "9.6 %",
        "-",
        "-18.1 .. 13.4 deg",
        "28",
        "tank_of_a_long_name",
        "calibrated slope",
    )
    none = ("no table", *["-"] * 7, "tank_of_a_long_name", "-")
    notes = ("U95: half-width.",)
    rows = (("Yv'", *row), ("Zw'", *none), ("Mw'", *none))

    def built(study: object, chosen: list[Coefficient]) -> Table:
        of = {c.symbol for c in chosen}
        these = tuple(r for r in rows if r[0].removesuffix("'") in of)
        return Table("Coefficients, primed", headers, these, notes, frozenset({0, 7, 9, 10}))

    monkeypatch.setattr(results, "_coefficients", built)
    absent = [Coefficient(s, None, None, Status.NO_TABLE) for s in ("Zw", "Mw")]
    study = SimpleNamespace(coefficients=[Coefficient("Yv", -0.0262, 0.0027, Status.OK), *absent])
    shown = results.coefficients_in(study)  # type: ignore[arg-type]
    assert shown.title == "Coefficients of tank_of_a_long_name, primed"
    assert shown.rows == (("Yv'", *row[:5], row[6], row[7]),)
    assert shown.notes == (
        "U95: half-width.", "No table of the campaign varies the motion of Zw', Mw'.", "Not shown: estimator, campaign, input; --wide shows all.",
    )  # fmt: skip
    assert max(map(len, plain_lines(shown))) <= 80
    assert results.coefficients_in(study, 200).headers == headers  # type: ignore[arg-type]
    study.coefficients = absent
    assert results.coefficients_in(study).rows[0][:2] == ("Zw'", "no table")  # type: ignore[arg-type]


SLOPE = Coefficient("Yv", -0.02, 0.002, Status.OK, parts=Parts(0.001, 0.0017), origin="fit")
OPEN = replace(SLOPE, symbol="Xvv", u95=0.03, status=Status.SIGN_OPEN)
FIXED = replace(SLOPE, symbol="Nv", status=Status.FORM_ASSUMED)


def test_u95_of_a_fixed_form_is_not_said_to_be_that_of_a_slope():
    only = noun_tables.coefficients([FIXED])
    assert not any(COVERS in note or "slope at the origin" in note for note in only.notes)
    assert only.notes[0].startswith("U95 of a fixed form:")
    assert only.notes[-1].startswith("form assumed: ")
    both = noun_tables.coefficients([SLOPE, FIXED])
    assert COVERS in both.notes[0]
    assert both.notes[1].startswith("U95 of a fixed form:")
    at = both.headers.index("status")
    assert [row[at] for row in both.rows] == ["-", "form assumed"]
    assert at in both.left
    assert all(len(row) == len(both.headers) for row in both.rows)
    slopes = noun_tables.coefficients([SLOPE, OPEN])
    assert "status" not in slopes.headers
    assert COVERS in slopes.notes[0]
    assert len(slopes.notes) == 2


def test_the_note_on_an_open_sign_names_its_rows():
    assert noun_tables.coefficients([SLOPE, OPEN]).notes[-1].startswith("sign open (Xvv'): The 95 % interval")
