"""Nouns as they show themselves in a notebook: well formed, escaped, with their numbers."""

from __future__ import annotations

from html.parser import HTMLParser

import numpy as np
import pytest

from coeflab.cli.show import plain_lines
from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.table import Table
from coeflab.fits import FITS
from coeflab.law.added_mass import AddedMass
from coeflab.motion.simulation import simulate
from coeflab.report.tables import results
from coeflab.tables.importers import PlannedTable
from coeflab.workbench import read_tables
from tests.motion.vehicles import made
from tests.report.studies import FULL, HOSTILE, LENGTH, small_study


class Closed(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.tags = [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.tags.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def nouns():
    tables = read_tables(PlannedTable(shipped("cfd_data") / "suboff_roddy_2", (), {}))
    result = FITS.load("polynomial").fit(tables, LENGTH, {"variable": "v", "degree": 3, "responses": "Y"})
    file = made()
    matrix = AddedMass(np.diag([1.0, 20.0, 20.0, 0.0, 5.0, 5.0]), np.zeros(3), Datum(HOSTILE), "body", "panel")
    return {
        "table": (Table(HOSTILE, ("a", HOSTILE), (("1", HOSTILE),), (HOSTILE,)), "&lt;script&gt;"),
        "fit": (small_study(FULL, named=HOSTILE).fits[0], "Yv&#x27;"),
        "models": (result, "polynomial"),
        "model": (result.models[0], "polynomial"),
        "added mass": (matrix, "20.00"),
        "parameters": (file, "-0.040000"),
        "trajectory": (simulate(file, "straight_run", {"duration": 2.0}, free=("u",)).trajectory, "ended: complete"),
    }


@pytest.mark.parametrize("name", ["table", "fit", "models", "model", "added mass", "parameters", "trajectory"])
def test_a_noun_is_a_table_in_a_notebook(name):
    noun, expected = nouns()[name]
    text = noun._repr_html_()
    assert "table" in Closed(text).tags
    assert expected in text
    assert "<script" not in text


def test_text_columns_are_flush_left_and_numbers_flush_right():
    text = Table("t", ("a", "b"), (("x", "1"),))._repr_html_()
    assert '<td style="text-align: left">x</td><td style="text-align: right">1</td>' in text


def test_coefficients_fit_80_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    """Columns go in the stated order, what has no table stands on one line, nothing of a kept row is cut."""
    headers = ("", "value", "U95", "U95", "random", "form", "input", "window", "n", "campaign", "estimator")
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
    notes = ("U95: half-width.", "no table: No table varies this motion.")
    rows = (("Yv'", *row), ("Zw'", *none), ("Mw'", *none))
    monkeypatch.setattr(
        results,
        "coefficients",
        lambda study: Table("Coefficients, primed", headers, rows, notes, frozenset({0, 7, 9, 10})),
    )
    shown = results.coefficients_in(None)  # type: ignore[arg-type]
    assert shown.title == "Coefficients of tank_of_a_long_name, primed"
    assert shown.rows == (("Yv'", *row[:5], row[6], row[7]),)
    assert shown.notes == (
        "U95: half-width.", "No table of the campaign varies the motion of Zw', Mw'.", "Not shown: estimator, campaign, input; --wide shows all.",
    )  # fmt: skip
    assert max(map(len, plain_lines(shown))) <= 80
    assert results.coefficients_in(None, 200).headers == headers  # type: ignore[arg-type]
    rows = (("Zw'", *none),)
    assert results.coefficients_in(None).rows[0][:2] == ("Zw'", "no table")  # type: ignore[arg-type]
