from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.report.content import core, document
from coeflab.report.document import AnswerRow, Document, Section
from coeflab.report.figures.hull_outline import hull_figure
from coeflab.report.figures.hull_scene import hull_scene
from coeflab.report.formats import REPORTERS, Renderer
from coeflab.report.formats.html import Ends, bar_of, published, row_of
from coeflab.study.symmetry import zeros
from tests.report.studies import FEW, FULL, HALF, HOSTILE, small_study

BODY = read_body(shipped("geometry") / "suboff_bare_hull" / "body.toml")
VOID = {"meta", "link", "br", "hr", "img", "input"}


class Page(HTMLParser):
    """Elements with their attributes, and whether every one is closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.crossed: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.crossed.append(tag)

    def named(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


def text_of(study) -> str:
    return REPORTERS.load("html").render(document(study))["report.html"].decode()


def test_it_is_a_plugin():
    assert "html" in REPORTERS.names()
    assert isinstance(REPORTERS.load("html"), Renderer)


@pytest.mark.parametrize("angles", [FULL, HALF, FEW, [3.0]])
@pytest.mark.parametrize("published", [False, True])
def test_a_small_study_gives_a_well_formed_page(angles, published):
    page = Page(text_of(small_study(angles, published=published)))
    assert page.crossed == []
    assert page.open == []
    assert len(page.named("h1")) == 1
    assert page.named("html")[0]["lang"] == "en"
    identifiers = [a["id"] for _, a in page.elements if "id" in a]
    assert len(identifiers) == len(set(identifiers))


def test_equal_studies_give_equal_bytes():
    assert text_of(small_study(FULL)) == text_of(small_study(FULL))


def test_names_of_users_are_text():
    text = text_of(small_study(FULL, named=HOSTILE, published=True))
    assert {a["type"] for a in Page(text).named("script")} == {"application/json", "module"}
    assert "&lt;script&gt;" in text
    assert "<script>alert" not in text


def test_symbols_are_set_as_mathematics():
    text = text_of(small_study(FULL, published=True))
    assert "<i>Y</i><sub><i>v</i></sub><u><b>'</b></u></td>" in text
    assert "½ <i>ρ</i> <i>U</i><sup><b>^</b>2</sup> <i>L</i><sup><b>^</b>2</sup>" in text
    tables = "".join(re.findall(r"<tbody>.*?</tbody>", text, flags=re.DOTALL))
    assert re.findall(r">-\d|e-0\d|\^\d| deg<", tables) == []
    assert re.search(r"<title id=[^>]*>Yv&#x27;, tow: data", text)


def test_code_is_shown_as_it_is_typed():
    code = Section("again", "Again", code=("coeflab report Yv' --to a_b^2", "rho > -1e-05"))
    page = REPORTERS.load("html").render(Document("t", "s", (code,)))["report.html"].decode()
    assert "<code>coeflab report Yv&#39; --to a_b^2\nrho &gt; -1e-05</code>" in page


def test_no_character_of_a_user_steers_the_page():
    text = text_of(small_study(FULL, named="ab\u202edc\u2066\u200b \u05e9\u05dc", published=True))
    assert set("\u202e\u2066\u200b") & set(text) == set()
    assert "<bdi>abU+202EdcU+2066U+200B \u05e9\u05dc" in text


def test_numbers_of_figures_are_json_that_cannot_leave_its_element():
    text = text_of(small_study(FULL, named=HOSTILE))
    found = re.findall(r'<script type="application/json" class="numbers">(.*?)</script>', text, flags=re.DOTALL)
    assert len(found) == text.count('class="numbers"') >= 4
    read = [json.loads(f) for f in found]
    (data, *_) = (r for r in read if "data, curves" in r["title"])
    assert all("<" not in f and "&" not in f for f in found)
    assert any(HOSTILE in panel for panel in (r["title"] for r in read))
    points = data["panels"][0]["series"][0]
    assert points["x"] == pytest.approx([a for a in FULL if a != -10.0])
    assert len(points["notes"]) == len(points["x"]) == len(points["y"])


def test_the_policy_names_the_script_and_nothing_else():
    text = text_of(small_study(FULL))
    script = re.search(r'<script type="module">(.*?)</script>', text, flags=re.DOTALL)[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{digest}'" in text


def test_a_stated_centre_of_gravity_is_marked_in_the_outlines():
    plain, marked = hull_figure(BODY, "b").svg, hull_figure(BODY, "b", gravity=np.array([0.1, 0.0, 0.02])).svg
    assert "centre of gravity" not in plain
    assert "centre of gravity" in marked
    assert marked.count("<use") == plain.count("<use") + 3, "one a view and one in the legend"


def with_a_view() -> str:
    figure = hull_figure(BODY, "b")
    scene = hull_scene(BODY.name, BODY.require_shape(), (), pieces=BODY.pieces)
    twice = tuple(replace(figure, anchor=name, scene=scene) for name in ("b", "c"))
    return (
        REPORTERS.load("html").render(Document("t", "s", (Section("x", "X", figures=twice),)))["report.html"].decode()
    )


def test_three_js_stands_once_in_a_page_with_views_and_the_policy_names_it():
    text = with_a_view()
    assert text == with_a_view()
    scripts = re.findall(r'<script type="module">(.*?)</script>', text, flags=re.DOTALL)
    assert ["three.js" in s[:20] for s in scripts] == [True, False]
    assert "Permission is hereby granted" in scripts[0]
    digests = " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(s.encode()).digest()).decode()}'" for s in scripts)
    assert f'script-src {digests}"' in text
    assert len(scripts[0]) < 620_000
    assert "WebGLRenderer" not in text_of(small_study(FULL, published=True)).replace("THREE.WebGLRenderer", "")


def test_three_js_is_the_version_that_its_folder_names():
    folder = files("coeflab.report.formats") / "_html" / "three"
    version = json.loads((folder / "package.json").read_text())["devDependencies"]["three"]
    assert (folder / "three.min.js").read_text().startswith(f"/*! three.js {version},")
    used = set(
        re.findall(r"THREE\.(\w+)", "".join(f.read_text() for f in folder.parent.iterdir() if f.name.endswith(".js")))
    )
    given = (folder / "used.js").read_text().partition("globalThis.THREE = {")[2]
    assert used == set(re.findall(r"\w+", given))


@pytest.mark.parametrize("has_view", [False, True])
def test_nothing_is_loaded_from_elsewhere(has_view):
    text = with_a_view() if has_view else text_of(small_study(FULL, published=True))
    page = Page(text)
    for _, attributes in page.elements:
        for key in ("src", "srcset", "action", "data", "poster", "xlink:href"):
            assert key not in attributes
        assert re.match(r"#|data:,$", attributes.get("href") or "#")
    assert "@import" not in text
    assert re.findall(r"url\((?!#)", text) == []
    assert set(re.findall(r"https?://[\w./-]+", text)) <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xhtml"}


def test_links_inside_the_page_lead_somewhere():
    page = Page(text_of(small_study(FULL)))
    identifiers = {a["id"] for _, a in page.elements if "id" in a}
    assert {a["href"][1:] for _, a in page.elements if str(a.get("href", "")).startswith("#")} <= identifiers


def test_every_figure_is_described():
    text = text_of(small_study(FULL))
    figures = re.findall(r"<figure.*?</figure>", text, flags=re.DOTALL)
    assert len(figures) == 10 + 3  # slope, coefficients over the published ones, axes
    for figure in figures:
        assert 'role="img"' in figure
        for element in ("title", "desc"):
            assert re.search(rf"<{element}[^>]*>[^<]+</{element}>", figure)
        assert re.search(r"<figcaption[^>]*>.+</figcaption>", figure)


def test_every_figure_shows_its_title_before_its_caption():
    made = document(small_study(FULL))
    text = REPORTERS.load("html").render(made)["report.html"].decode()
    shown = re.findall(r"<figcaption><strong>(.*?)\.</strong> .+?</figcaption>", text)
    assert len(shown) == text.count("<figure") == len(set(shown))
    assert "<i>Y</i><sub><i>v</i></sub><u><b>'</b></u>, tow: data, curves and residuals" in shown


def test_the_contents_are_open_and_their_list_takes_the_keyboard():
    page = Page(text_of(small_study(FULL)))
    (contents,) = [a for a in page.named("details") if a.get("class") == "contents"]
    assert "open" in contents
    assert [a["tabindex"] for a in page.named("nav")] == ["0"]


def test_every_table_has_a_caption_and_column_headers():
    page = Page(text_of(small_study(FULL, published=True)))
    assert len(page.named("caption")) == len(page.named("table")) > 3
    assert all(a.get("scope") in ("col", "row") for a in page.named("th"))


def test_drawings_share_their_styles_and_keep_them():
    made = document(small_study(FULL, published=True))
    page = REPORTERS.load("html").render(made)["report.html"].decode()
    style = re.search(r"<style>(.*?)</style>", page, flags=re.DOTALL)[1]
    shared = dict(re.findall(r"^figure svg \.(s\d+) { (.*) }$", style, flags=re.MULTILINE))
    assert len(shared) > 10
    drawings = re.findall(r"<svg .*?</svg>", page, flags=re.DOTALL)
    left = [s for d in drawings for s in re.findall(r' style="([^"]*)"', d)]
    assert len(left) == len(set(left))
    again = [re.sub(r' class="(s\d+)"', lambda m: f' style="{shared[m[1]]}"', d) for d in drawings]
    for svg, own in zip((made.answer.slope.svg, made.answer.forest.svg), again, strict=False):
        for kind in (' d="', ' style="'):
            parts = [[re.sub(r"\s+", "", part) for part in re.findall(f'{kind}([^"]*)"', s)] for s in (svg, own)]
            assert parts[0] == parts[1]
    assert len(page.encode()) < 450_000


def test_the_first_mention_of_a_term_leads_to_its_definition():
    text = text_of(small_study(FULL, published=True))
    linked = re.findall(r'<a class="term" href="#(term-[^"]+)"', text)
    assert len(linked) == len(set(linked)) > 3
    assert all(f'<dt id="{anchor}">' in text for anchor in linked)


def test_a_row_of_the_answer_has_the_digits_of_its_u95():
    row = AnswerRow("Yv", -0.026224, 0.002682, published=(-0.0139, 0.02), difference=0.00161, agrees=True)
    made = row_of(row)
    assert (made.own, made.share, made.difference, made.against) == ("-0.0262 +- 0.0027", "10 %", "+0.0016", "+0.60")
    assert (made.verdict, bar_of(row)) == ("agrees", Ends(50.0, 15.0, False))
    assert [published(v) for v in row.shown] == [("-0.0139", 2), ("0.0200", 2)]
    exact = replace(row, printed=("-0.013910", "0.02"))
    assert [published(v) for v in exact.shown] == [("-0.013910", 0), ("0.02", 4)]
    far = replace(row, difference=-0.02, agrees=False)
    assert (row_of(far).verdict, bar_of(far)) == ("differs", Ends(0.0, 50.0, True))
    empty = AnswerRow("Yr", None, None)
    assert (row_of(empty).status, row_of(empty).verdict, bar_of(empty)) == ("no data", "missing", None)
    assert row_of(replace(row, value=1e-9)).share == "> 100 %"


def test_no_path_of_this_machine_is_in_it():
    assert str(Path.cwd()) not in text_of(small_study(FULL))


@pytest.mark.slow
def test_the_validation_makes_a_page_of_moderate_size(suboff, suboff_document, suboff_page):
    study, text = suboff, suboff_page.decode()
    assert len(text.encode()) < 3_300_000
    assert len(REPORTERS.load("html").render(core(suboff_document))["report.html"]) < 500_000
    drawings = re.findall(r"<svg.*?</svg>", text, flags=re.DOTALL)
    turned = {(s.campaign, s.symbol) for f in study.fits for s in f.sweeps if s.by_symmetry}
    tows = {t.campaign for t in study.plan.tows if t.added is not None}
    assert len(tows) == 3
    budgeted = [
        c for c in study.coefficients
        if c.symbol in study.plan.wanted and c.value is not None
        and (c.campaign, c.symbol) not in turned and c.campaign not in tows
    ]  # fmt: skip
    hulls = {h.body.name for h in study.hulls.values()}
    assert hulls == {"suboff_aff8", "suboff_bare_hull"}
    planes, sketches, first_page = 4, 3, 3
    motions = 4 * sum(not made.undetermined for made in study.manoeuvres)
    fitted = {campaign for f in study.fits for campaign in f.campaigns}
    turning = sum(rate in t.varies for t in study.tables if t.campaign in fitted for rate in "qr")
    settings = len(study.tables) + turning  # of every table, and the local incidence of those that turn
    by_symmetry = [{c.symbol for c in zeros(study, f.campaign, f.coefficients.coefficients)} for f in study.fits]
    sweeps = 2 * sum(
        s.symbol not in z and not s.by_symmetry and s.campaign not in tows
        for f, z in zip(study.fits, by_symmetry, strict=True)
        for s in f.sweeps
    )
    assert len(drawings) == sweeps + len(budgeted) + len(hulls) + planes + sketches + motions + settings + first_page
    assert text.count('class="space" hidden') == len(hulls)
    assert max(len(d.encode()) for d in drawings) < 60_000
    assert Page(text).crossed == []
    assert text == text_of(study)
