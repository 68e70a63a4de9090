from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from coeflab.report.document import Document
from coeflab.report.first_page import answer
from coeflab.report.formats import REPORTERS
from coeflab.report.gallery import listing
from coeflab.report.gallery.listing import Shelf
from coeflab.report.printable import visible
from coeflab.report.reproduction import digest_of
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.cli.test_compare import VALUES, made
from tests.report.gallery.conftest import report
from tests.report.studies import ENDLESS, FULL, HOSTILE, small_study


def test_reports_say_title_study_and_digest_and_stand_with_their_pdf(folder):
    (found,) = Shelf(folder).listing().reports
    assert (found.title, found.study, found.digest) == ("Tow of a boat", "boat", "0123456789abcdef")
    assert found.keys == (("HTML", "boat/report.html"), ("PDF", "boat/report.pdf"))


def test_parameter_files_say_body_symbols_and_version(folder):
    found = {e.path: e for e in Shelf(folder).listing().parameters}
    assert set(found) == {"a.parameters.json", "alias.parameters.json", "b.parameters.json"}
    entry = found["b.parameters.json"]
    assert (entry.name, entry.body, entry.length, entry.fault) == ("second", "hull", "LBP 4.26086 m", "")
    assert entry.symbols == tuple(VALUES)
    assert entry.version == made(VALUES).schema_version


PAGE = """<!DOCTYPE html><meta name="generator" content="coeflab"><title>Tow</title>
<p class="subtitle digest">Study <bdi>tow</bdi>, inputs {digest}</p>
<h2 id="answer-heading">Both agree within <i>U</i><sub>95</sub></h2><p class="lead">no verdict</p>
<figure><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 3 2" role="img"><path d="M0 0"/></svg></figure>
<script type="application/json" class="rows">{rows}</script>"""
HUUV = shipped("cfd_data") / "huuv" / "huuv.parameters.json"
ROWS = [{"symbol": "Yv'", "value": -0.026, "U95": 0.003, "status": "", "from": "tank"},
        {"symbol": "Nr'", "value": None, "U95": None, "status": "no data", "from": ""}]  # fmt: skip


WRITTEN = json.dumps({"rows": ROWS})


def written(folder, rows=WRITTEN, digest="d" * 16):
    (folder / "boat" / "report.html").write_text(PAGE.format(rows=rows, digest=digest))
    return Shelf(folder).listing().reports[0]


def test_a_card_says_verdict_day_and_where_its_picture_is(folder):
    place = folder / "boat" / "report.html"
    assert Shelf(folder).listing().reports[0].verdict == "Fine."
    written(folder)
    os.utime(place, (0, 86400 * 365))
    found = Shelf(folder).listing().reports[0]
    assert (found.verdict, found.written, found.picture) == (
        "Both agree within U95", "1971-01-01", "boat/report.html",
    )  # fmt: skip
    assert Shelf(folder).drawing(found.picture).startswith("<svg")
    assert [(c.symbol, c.value_text) for c in found.coefficients] == [("Yv'", "-0.0260 +- 0.0030"), ("Nr'", "no data")]


def test_a_picture_keeps_the_looks_that_the_page_of_its_report_has_as_classes(tmp_path):
    """Without them curves are filled black and texts start where they should end."""
    study = small_study(FULL)
    page = REPORTERS.load("html").render(Document("Tow", "", (), answer=answer(study)))["report.html"]
    (tmp_path / "report.html").write_bytes(page)
    svg = Shelf(tmp_path).drawing("report.html")
    assert b'class="s0"' in page
    assert " class=" not in svg
    assert svg.count("text-anchor: end") > 2
    assert svg.count("fill: none") > 3


@pytest.mark.parametrize(
    "rows",
    [
        "",
        "{}",
        '{"rows": 1}',
        '{"rows": [1]}',
        '{"rows": [{"symbol": "Yv"}]}',
        "[" * 100_000,
        "null",
        '{"rows": {"a": 1}}',
    ],
)
def test_rows_that_no_report_writes_are_none(folder, rows):
    assert written(folder, rows).coefficients == ()


def test_a_search_finds_coefficients_in_files_and_reports(folder):
    written(folder)
    found = Shelf(folder).listing()
    hits = found.coefficients("yv")
    assert [(c.symbol, e.path) for c, e in hits] == [
        ("Yv'", "a.parameters.json"), ("Yv'", "alias.parameters.json"), ("Yv'", "b.parameters.json"), ("Yv'", "boat/report.html"),
    ]  # fmt: skip
    assert [(c.value_text, e.called) for c, e in found.coefficients("YV' second")] == [("-0.0400 +- 0.0020", "second")]
    assert [e.path for _, e in found.coefficients("tank yv'")] == ["boat/report.html"]
    assert {c.symbol for c, _ in found.coefficients("Y")} == set()
    assert found.coefficients("boat") == ()


def test_parameter_files_of_the_same_inputs_stand_with_their_report(folder):
    shutil.copy(HUUV, folder / "boat")
    digest = digest_of(read_parameter_file(HUUV).provenance.inputs)
    report_of = written(folder, digest=digest)
    assert len(digest) == 16
    assert [e.path for e in Shelf(folder).listing().files_of(report_of)] == ["boat/huuv.parameters.json"]
    assert Shelf(folder).listing().files_of(written(folder)) == ()


def test_bad_files_stand_there_with_one_line(folder):
    (folder / "broken.parameters.json").write_text('{"schema_version": "1.0",\n "name": }')
    (folder / "report.html").write_text("<p>another page")
    (folder / "report.pdf").write_text("no pdf")
    (folder / "other.json").write_text('{"speed": 1}')
    (folder / "page.html").write_text("<p>another page")
    found = Shelf(folder).listing()
    faults = {e.path: e.fault for e in (*found.reports, *found.parameters) if e.fault}
    assert set(faults) == {"broken.parameters.json", "report.html"}
    assert faults["broken.parameters.json"].startswith("line 2")
    assert not any("\n" in f or str(folder) in f for f in faults.values())
    assert not {"other.json", "page.html"} & {e.path for e in (*found.reports, *found.parameters)}


def test_a_locked_file_is_listed_as_such(folder, monkeypatch):
    """By a stand-in for the system, because root may read everything."""
    whole = Path.open

    def refuse(path, *args, **kwargs):
        if path.name == "a.parameters.json":
            raise PermissionError(13, "Permission denied")
        return whole(path, *args, **kwargs)

    monkeypatch.setattr(Path, "open", refuse)
    assert any("Permission" in e.fault for e in Shelf(folder).listing().parameters)


def test_a_search_wants_every_word_in_any_case(folder):
    found = Shelf(folder).listing()
    assert [e.path for e in found.having("BOAT tow").reports] == ["boat/report.html"]
    assert [e.path for e in found.having("0123456789ABCDEF").reports] == ["boat/report.html"]
    assert found.having("boat nowhere").reports == ()
    assert [e.name for e in found.having("hull yr' second").parameters] == ["second"]


def test_a_changed_file_is_read_again_and_an_unchanged_one_is_not(folder, monkeypatch):
    shelf = Shelf(folder)
    shelf.listing()
    read = []
    plain = listing.read_parameter_file
    monkeypatch.setattr(listing, "read_parameter_file", lambda path: read.append(path.name) or plain(path))
    shelf.listing()
    assert read == []
    (folder / "b.parameters.json").write_bytes(made(VALUES, name="renamed").to_json())
    assert "renamed" in [e.name for e in shelf.listing().parameters]
    assert read == ["b.parameters.json"]
    (folder / "b.parameters.json").unlink()
    assert "b.parameters.json" not in [e.path for e in shelf.listing().parameters]


def test_a_folder_of_many_files_is_cut_and_says_so(folder, monkeypatch):
    monkeypatch.setattr(listing, "MOST_FILES", 3)
    found = Shelf(folder).listing()
    assert found.more
    assert len(found.reports) + len(found.parameters) <= 3


@pytest.mark.parametrize("title", [HOSTILE, ENDLESS])
def test_titles_come_out_with_every_character_seen_but_not_endless(folder, title):
    (folder / "boat" / "report.html").write_bytes(report(title))
    (found,) = Shelf(folder).listing().reports
    assert len(found.title) <= listing.LONGEST
    assert visible(title)[:40] in found.title
