"""The first screen of a report: what it holds at each width, what can be saved from it, and a closer look at its figures."""

from __future__ import annotations

import csv
import io
import json
import re
import zipfile
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pymupdf
import pytest

from coeflab.report.content import document
from coeflab.report.document import AnswerRow
from coeflab.report.formats import REPORTERS
from tests.report.studies import FULL, small_study

SLOPE = "#answer-slope"
# What has to be seen without scrolling: lower and right edges.
EDGES = """() => ['#answer h2', '#answer table', '#answer .chips', '#answer .downloads', '#answer-slope', '#answer-forest'].map(s => {
  const b = document.querySelector(s).getBoundingClientRect(); return [s, b.bottom, b.right]; })"""
COVERED = """() => [...document.querySelectorAll('#answer tbody tr')].filter(r => !r.matches('.missing')).map(r =>
  ['.own', '.compared', '.against'].map(s => { const b = r.querySelector(s).getBoundingClientRect(); return [b.left, b.right, b.top, b.bottom]; }))"""


@pytest.fixture
def plain(visit, written):
    return visit(written("plain"))


@pytest.mark.parametrize("kind", ["plain", pytest.param("suboff", marks=pytest.mark.slow)])
def test_the_first_screen_holds_the_answer(visit, written, kind):
    page = visit(written(kind))
    for what, bottom, right in page.evaluate(EDGES):
        assert bottom <= 900, what
        assert right <= 1440, what


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """A page with published columns, of invented numbers."""
    made = document(small_study(FULL, published=True))
    row = AnswerRow("Yv", -0.02624, 0.00268, "", "tow", (-0.027834, -0.0281, None), 0.0016, True)
    rows = (
        row,
        replace(row, symbol="Nv", difference=-0.009, agrees=False),
        AnswerRow("Yr", None, None, "no data", published=(0.0052, None, None)),
        AnswerRow("Nr", -0.0031, 0.0034, "", "tow", (-0.0044, -0.0040, -0.0042), 0.0013, True),
    )
    columns = ("experiment 1990", "steady CFD", "PMM CFD")
    made = replace(made, answer=replace(made.answer, rows=rows, columns=columns, compared=columns[0]))
    path = tmp_path_factory.mktemp("compared") / "report.html"
    path.write_bytes(REPORTERS.load("html").render(made)["report.html"])
    return path.as_uri()


def test_a_bar_leaves_the_band_where_the_difference_exceeds_u95(visit, compared):
    page = visit(compared)
    bars = page.evaluate("""() => [...document.querySelectorAll('.bar')].map(b => { const o = b.getBoundingClientRect(),
      i = b.querySelector('i').getBoundingClientRect(); return [(i.left - o.left) / o.width, (i.right - o.left) / o.width]; })""")
    assert len(bars) == 3
    assert bars[0] == pytest.approx([0.5, 0.5 + 0.25 * 0.0016 / 0.00268], abs=0.01)
    assert bars[1] == pytest.approx([0.0, 0.5], abs=0.01)


def test_a_phone_shows_ours_and_the_published_value_together(visit, compared):
    page = visit(compared, 390)
    assert page.evaluate("document.scrollingElement.scrollWidth") <= 390
    right = page.evaluate("document.querySelector('#answer caption').getBoundingClientRect().right")
    assert right < 390
    shares = page.evaluate(
        "[...document.querySelectorAll('#answer .share')].map(s => [s.innerText, getComputedStyle(s, '::after').content])"
    )
    assert [text.count("%") for text, _ in shares] == [1, 1, 0, 1]
    assert {more for _, more in shares} == {"none"}
    rows = page.evaluate(COVERED)
    assert rows
    for own, published, against in rows:
        assert max(own[1], published[1], against[1]) <= right
        assert min(own[0], published[0], against[0]) >= 0
        assert published[3] - own[2] < 60
        assert own[1] <= against[0] or own[3] <= against[2]


def test_on_paper_the_answer_comes_before_the_contents(visit, written):
    page = visit(written("plain"), java_script_enabled=False)
    sheets = pymupdf.open(stream=page.pdf(prefer_css_page_size=True), filetype="pdf")
    first = " ".join(sheets[0].get_text().split())
    assert page.locator("#answer h2").inner_text()[:30] in first
    assert "Contents" not in first
    assert "Contents" in sheets[1].get_text()


def saved(page, button, tmp_path):
    with page.expect_download() as coming:
        button.click()
    path = tmp_path / coming.value.suggested_filename
    coming.value.save_as(path)
    return path


def rows_of(path):
    return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))


def buttons(page, name, where="#answer"):
    return {b.inner_text(): b for b in page.locator(f"{where} .save").filter(has_text=name).get_by_role("button").all()}


def test_a_figure_is_saved_as_svg_png_pdf_and_numbers(plain, tmp_path):
    figure = buttons(plain, "Left figure")
    assert list(figure) == ["SVG", "PNG", "PDF", "CSV"]
    svg = saved(plain, figure["SVG"], tmp_path).read_text()
    drawn = ElementTree.fromstring(svg)
    wide, tall = (float(v) for v in drawn.get("viewBox").split()[2:])
    assert (drawn.get("width"), drawn.get("height")) == (f"{wide:g}pt", f"{tall:g}pt")
    assert "var(" not in svg
    assert "class=" not in svg
    assert "stroke: #" in svg
    assert "fitted curve" in "".join(drawn.itertext())
    png = saved(plain, figure["PNG"], tmp_path).read_bytes()
    image = pymupdf.Pixmap(png)
    assert (image.width, image.height) == (round(wide * 600 / 72), round(tall * 600 / 72))
    assert (image.xres, image.yres) == (600, 600)
    (sheet,) = pymupdf.open(stream=saved(plain, figure["PDF"], tmp_path).read_bytes(), filetype="pdf")
    assert (sheet.rect.width, sheet.rect.height) == (wide, tall)
    words = sheet.get_text()
    assert "fitted curve" in words
    assert "\u2032" in words
    assert "\ufffd" not in words
    assert len(sheet.get_drawings()) > 8
    lines = rows_of(saved(plain, figure["CSV"], tmp_path))
    known = json.loads(plain.locator(f"{SLOPE} script.numbers").text_content())["panels"][0]["series"]
    assert len(lines) == sum(len(s["x"]) for s in known)
    assert [float(v) for v in list(lines[0].values())[1:3]] == [known[0]["x"][0], known[0]["y"][0]]


def test_a_hidden_series_is_not_saved(plain, tmp_path):
    whole = saved(plain, buttons(plain, "Left figure")["PDF"], tmp_path).read_bytes()
    plain.locator(f"{SLOPE} .switches button").first.click()
    assert len(saved(plain, buttons(plain, "Left figure")["PDF"], tmp_path).read_bytes()) < len(whole)


def test_the_table_is_saved_with_its_digits_and_for_a_paper(plain, tmp_path):
    table = buttons(plain, "Table")
    lines = rows_of(saved(plain, table["CSV"], tmp_path))
    first = plain.locator("#answer tbody tr").first
    assert [r["symbol"] for r in lines] == [
        t.split()[0].replace("\u2032", "'") for t in plain.locator("#answer tbody th").all_text_contents()
    ]
    value = float(lines[0]["value"])
    assert first.locator(".own").inner_text().startswith(f"{value:.6f}".replace("-", "\u2212")[:5])
    assert len(lines[0]["value"]) > 10
    tex = saved(plain, table["LaTeX"], tmp_path).read_text()
    assert "\\toprule" in tex
    assert "$Y_{v}'$" in tex
    assert "\\pm" in tex
    assert set(re.findall(r"[^\x00-\x7f]", tex)) == set()
    assert len({row.count("&") - row.count("\\&") for row in tex.splitlines() if row.endswith("\\\\")}) == 1


def test_everything_is_saved_in_one_archive_equal_each_time(plain, tmp_path):
    (tmp_path / "again").mkdir()
    first, second = (saved(plain, buttons(plain, "All")["ZIP"], p).read_bytes() for p in (tmp_path, tmp_path / "again"))
    assert first == second
    archive = zipfile.ZipFile(io.BytesIO(first))
    assert archive.testzip() is None
    names = archive.namelist()
    assert len(names) == len(set(names)) > 10
    assert len([n for n in names if n.endswith(".svg")]) == plain.locator("figure:not(.space)").count()
    assert all(Path(n).parts[0] in ("figures", "tables") for n in names)
    sheets = [list(csv.reader(io.StringIO(archive.read(n).decode()))) for n in names if n.endswith(".csv")]
    assert all(len({len(row) for row in sheet}) == 1 for sheet in sheets)
    assert any("," in cell for sheet in sheets for row in sheet for cell in row)


def looked_at(page):
    return page.evaluate(f"document.querySelector('{SLOPE} .plot > svg').outerHTML")


def axes_of(page):
    """Pixels a unit of both axes of the slope's figure, and what stands at x = 0 and y = 0 of the screen, by their numbers."""
    marks = page.evaluate(
        f"""() => [...document.querySelectorAll('{SLOPE} .plot > svg text')].filter(t => t.style.display !== 'none' &&
        /^[\u2212-]?[0-9.]+$/.test(t.textContent)).map(t => {{ const b = t.getBoundingClientRect();
        return [Number(t.textContent.replace('\u2212', '-')), b.x + b.width / 2, b.y + b.height / 2]; }})"""
    )
    below = max(m[2] for m in marks)
    out = []
    for k, of in ((1, [m for m in marks if m[2] > below - 2]), (2, [m for m in marks if m[2] <= below - 2])):
        rate = (of[-1][k] - of[0][k]) / (of[-1][0] - of[0][0])
        out.append((rate, of[0][0] - of[0][k] / rate))
    return out


def test_a_figure_is_looked_at_closely_by_wheel_and_keys_and_comes_back(plain):
    probe, home = plain.locator(f"{SLOPE} .probe"), looked_at(plain)
    box = probe.bounding_box()
    plain.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 3)
    plain.mouse.wheel(0, -100)
    plain.wait_for_timeout(50)
    assert looked_at(plain) == home
    plain.evaluate("scrollTo(0, 0)")
    plain.mouse.down()
    plain.mouse.up()
    whole = axes_of(plain)
    plain.mouse.wheel(0, -200)
    plain.wait_for_function("s => document.querySelector(s + ' .back')", arg=SLOPE)
    assert plain.evaluate("scrollY") == 0
    near = looked_at(plain)
    places = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    for (rate, zero), (closer, start), place in zip(whole, axes_of(plain), places, strict=True):
        assert closer / rate > 1.2
        assert start + place / closer == pytest.approx(zero + place / rate, abs=abs(2.0 / rate))
    probe.press("+")
    assert looked_at(plain) not in (home, near)
    probe.press("0")
    shown = re.sub(r' style="display: none;"|<circle[^>]*>(</circle>)?| style=""', "", looked_at(plain))
    assert shown == re.sub(r' style="display: none;"|<circle[^>]*>(</circle>)?| style=""', "", home)


def test_values_are_told_where_they_are_seen_in_a_closer_look(plain):
    probe = plain.locator(f"{SLOPE} .probe")
    probe.focus()
    probe.press("+")
    probe.press("+")
    ticks = plain.evaluate(
        f"""() => [...document.querySelectorAll('{SLOPE} .plot > svg text')].filter(t => t.style.display !== 'none' &&
        /^[0-9.]+$/.test(t.textContent)).map(t => [Number(t.textContent), t.getBoundingClientRect().x + t.getBoundingClientRect().width / 2])"""
    )
    probe.press("Home")
    said, ring = probe.get_attribute("aria-valuetext"), plain.locator(f"{SLOPE} .ring").bounding_box()
    value = float(re.search(r"= ([0-9.]+)", said)[1])
    (a, at_a), (b, at_b) = ticks[0], ticks[-1]
    assert ring["x"] + ring["width"] / 2 == pytest.approx(at_a + (value - a) * (at_b - at_a) / (b - a), abs=1.5)
