from __future__ import annotations

import unicodedata
from dataclasses import replace
from functools import cache

import pymupdf
import pytest

from coeflab.api.documents import report_of
from coeflab.core.errors import OutputError
from coeflab.core.finding import Severity
from coeflab.core.table import Table
from coeflab.core.version import VERSION
from coeflab.report.content import document
from coeflab.report.document import Answer, AnswerRow, Chip, Document, Figure, Section
from coeflab.report.formats import REPORTERS, Renderer, pdf
from tests.report.studies import FEW, FULL, HALF, HOSTILE, small_study

LONG = "".join(chr(ord("a") + i % 26) for i in range(5000))
NAMES = {
    "script": HOSTILE,
    "typst": '#panic("no") #import "x.typ" *bold* _it_ $ x^2 $ @ref <label> [a] `raw` // end',
    "latex": r"\input{/etc/passwd} \(x_1\) $\frac{1}{2}$ % end",
    "right to left": "שלום مرحبا",
    "steering": "a\u202etxt.exe\u200fb\x07",
    "emoji": "rocket 🚀 👩‍🚀 flag 🇳🇴",
    "long": LONG,
    "words": "five thousand letters " * 230,
    "lines": "one\ntwo\ttab\rthree",
}


def opened(what: Document) -> pymupdf.Document:
    return pymupdf.open(stream=pdf.render(what)["report.pdf"], filetype="pdf")


@cache
def small(published: bool = False) -> tuple[Document, pymupdf.Document]:
    """The report of one small study and its pages, typeset once for all who read in it."""
    whole = document(small_study(FULL, published=published))
    return whole, opened(whole)


def text_of(made: pymupdf.Document) -> str:
    """All text without breaks and spaces, compatible letters made equal."""
    whole = "".join(page.get_text() for page in made)
    return "".join(c for c in unicodedata.normalize("NFKC", whole) if not c.isspace() and c != "\u00ad")


def squeezed(text: str) -> str:
    return "".join(unicodedata.normalize("NFKC", text).split())


def flaws(made: pymupdf.Document) -> list[str]:
    """Missing glyphs, and text beyond the margins of its page."""
    out = []
    for page in made:
        frame = pymupdf.Rect(41, 30, page.rect.x1 - 41, page.rect.y1 - 30)
        for span in page.get_texttrace():
            out += [f"page {page.number + 1}: no glyph for U+{c[0]:04X}" for c in span["chars"] if c[1] == 0]
            box = pymupdf.Rect(span["bbox"]) * page.rotation_matrix
            if span["dir"] == (1.0, 0.0) and (box.x0 < frame.x0 or box.x1 > frame.x1 or box.y1 > page.rect.y1):
                words = "".join(chr(c[0]) for c in span["chars"])
                out.append(f"page {page.number + 1}: {words!r} at {box}")
    return out


def with_table(table: Table) -> Document:
    return Document("Tables", "", (Section("one", "One", tables=(table,)),))


def test_it_is_a_plugin():
    assert "pdf" in REPORTERS.names()
    assert isinstance(REPORTERS.load("pdf"), Renderer)


@pytest.mark.slow
@pytest.mark.parametrize("angles", [FULL, HALF, FEW, [3.0]])
@pytest.mark.parametrize("published", [False, True])
def test_a_small_study_is_typeset_without_flaws(angles, published):
    assert flaws(opened(document(small_study(angles, published=published)))) == []


def test_equal_studies_give_equal_bytes():
    first, second = (pdf.render(document(small_study(FULL)))["report.pdf"] for _ in range(2))
    assert first == second


def test_metadata_names_the_study_and_no_time():
    _, made = small()
    assert made.metadata["title"] == "Study tow"
    assert made.metadata["author"] == f"coeflab {VERSION}"
    assert not made.metadata["creationDate"]
    assert not made.metadata["modDate"]


def test_it_is_tagged_and_in_english():
    _, made = small()
    catalog = made.xref_object(made.pdf_catalog())
    assert "/StructTreeRoot" in catalog
    assert "/Lang (en)" in catalog


def test_all_sections_are_bookmarks_in_order():
    whole, made = small()
    titles = [title for _, title, _ in made.get_toc()]
    at = [next(i for i, t in enumerate(titles) if t.endswith(s.title)) for s in whole.sections]
    assert at == sorted(at)


def test_text_is_found_by_a_search():
    text = text_of(small(published=True)[1])
    assert "Yv′" in text
    assert "−0.0" in text
    assert "Modelsandvelocitiesrefertothepoint" not in text
    assert "Momentsandvelocitiesrefertothepoint" in text


def test_a_hash_is_copied_as_it_is():
    """Long words may break over lines, by nothing that stands in the text."""
    digest = "0123456789abcdef" * 4
    made = opened(with_table(Table("Inputs", ("file", "sha256"), (("drift_of_the_bare_hull.csv", digest),))))
    text = "".join(page.get_text() for page in made)
    assert "\u200b" not in text
    assert digest in "".join(text.split())


def test_every_page_says_what_it_belongs_to():
    whole, made = small()
    assert len(whole.digest) == 16
    for page in made:
        text = squeezed(page.get_text())
        assert "small" in text
        assert whole.digest in text
        assert f"{page.number + 1}of{len(made)}" in text


def figures_of(section: Section) -> list[Figure]:
    return [*section.figures, *(f for s in section.subsections for f in figures_of(s))]


def first_page(whole: Document) -> list[Figure]:
    a = whole.answer
    return [] if a is None else [f for f in (a.slope, a.forest, a.axes) if f is not None]


def tables_of(section: Section) -> list[Table]:
    return [*section.tables, *(t for s in section.subsections for t in tables_of(s))]


def test_every_figure_and_table_is_there_and_numbered():
    whole, made = small(published=True)
    text = text_of(made)
    figures = [*first_page(whole), *(f for s in whole.sections for f in figures_of(s))]
    tables, elsewhere = on_paper(whole)
    assert len(tables) + len(elsewhere) == sum(1 for s in whole.sections for _ in tables_of(s))
    assert len(figures) >= 6
    for word, n in (("Figure", len(figures)), ("Table", len(tables))):
        for i in range(1, n + 1):
            assert f"{word}{i}" in text
        assert f"{word}{n + 1}" not in text


def test_figures_are_vectors():
    _, made = small()
    assert sum(len(page.get_images()) for page in made) == 0
    assert max(len(page.get_drawings()) for page in made) > 30


@pytest.mark.parametrize("kind", NAMES)
def test_names_of_users_are_text_and_stay_inside_the_page(kind):
    name = NAMES[kind]
    table = Table(name, ("", name, "value"), ((name, name, "1.0"), ("a", "b", "2.0")), (name,), frozenset({0, 1}))
    svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 340 93"><path d="M0 0L340 93"/></svg>'
    part = Section("part", name, (name,), (table,), (Figure("f", svg, name, name, name),), code=(name,))
    made = opened(Document(name, name, (Section("verdict", name, (name,), subsections=(part,)), part), name, "0" * 16))
    assert flaws(made) == []
    assert len(made) < 14


@pytest.mark.parametrize("kind", ["script", "typst", "latex", "right to left"])
def test_names_of_users_are_found_as_they_were_written(kind):
    name = NAMES[kind]
    text = text_of(opened(Document("Title", "", (Section("a", "A", (name,)),))))
    if kind == "right to left":
        assert all(c in text for c in squeezed(name))
    else:
        plain = text.replace("’", "'").replace("‘", "'").replace("“", '"').replace("”", '"')
        assert squeezed(name) in plain


def test_a_table_that_is_too_wide_is_continued_with_its_first_column():
    headers = ("row", *(f"column {i}" for i in range(60)))
    rows = tuple((f"row {r}", *(f"{r}.{i:06d}" for i in range(60))) for r in range(3))
    made = opened(with_table(Table("Wide", headers, rows)))
    text = text_of(made)
    assert flaws(made) == []
    assert text.count("row2") > 1
    assert all(f"2.{i:06d}" in text for i in range(60))
    assert "(continued)" in text
    assert "Table2" not in text


def test_a_table_a_little_too_wide_lies_across_the_page():
    headers = tuple(f"number {i}" for i in range(15))
    rows = tuple(tuple(f"{r}.{i:09d}" for i in range(15)) for r in range(4))
    made = opened(with_table(Table("Wide", headers, rows)))
    assert flaws(made) == []
    assert any(page.rect.width > page.rect.height for page in made)
    assert "(continued)" not in text_of(made)


@pytest.mark.parametrize("alike", [False, True])
def test_an_estimator_that_rows_share_is_explained_once(alike: bool):
    words = ("calibrated slope", "least squares beyond the slopes, the form by AICc")
    rows = tuple((f"row {r}", "1.0", words[0 if alike else r // 3]) for r in range(6))
    made = opened(with_table(Table("Shared", ("name", "value", "estimator"), rows, left=frozenset({0, 2}))))
    text = text_of(made)
    assert flaws(made) == []
    assert text.count(squeezed(words[0])) == 1
    assert squeezed("estimator of all: " if alike else f"estimator b: {words[1]}.") in text
    assert text.count("estimator") == (1 if alike else 3)


def test_a_long_table_repeats_its_head():
    rows = tuple((f"row {r}", f"{r}.0") for r in range(200))
    made = opened(with_table(Table("Long", ("name", "magnitude"), rows)))
    assert len(made) > 2
    assert flaws(made) == []
    assert all("magnitude" in page.get_text() for page in made)


def test_an_empty_document_is_a_page():
    assert len(opened(Document("", "", ()))) == 1


def test_works_are_listed():
    text = text_of(opened(Document("T", "", (), works=(("a", "First work, 1990."), ("b", "Second work.")))))
    assert "WorksusedFirstwork,1990.Secondwork." in text


def test_what_cannot_be_typeset_is_an_error():
    bad = Figure("f", '<svg viewBox="0 0 10 10"><unclosed></svg>', "", "", "")
    with pytest.raises(OutputError, match="could not be typeset"):
        pdf.render(Document("T", "", (Section("a", "A", figures=(bad,)),)))


def test_a_summary_of_a_small_study_has_one_page():
    made = opened(report_of(small_study(FULL, published=True), short=True).document)
    assert len(made) == 1
    assert flaws(made) == []
    assert "Yv′" in text_of(made)


def answered() -> Document:
    """A core whose answer has every kind of row."""
    made = document(small_study(FULL, published=True), full=False)
    rows = (
        AnswerRow("Yv", -0.0262, 0.0027, "", "tow", (-0.0278, -0.0281, None), 0.0016, True),
        AnswerRow("Nv", -0.0147, 0.0019, "", "tow", (-0.0136, -0.014, -0.0131), -0.0081, False),
        AnswerRow("Zw", -0.0131, None, "form rejected", "tow", (-0.0139, None, None), 0.0008, None),
        AnswerRow("Nr", None, None, "no data", "", (-0.0044, None, None)),
    )
    columns = ("experiment", "steady CFD", "PMM CFD")
    chips = tuple(Chip(f"Chip {s}", "six words", s) for s in Severity)
    drawn = small(published=True)[0]
    figures = [f for s in drawn.sections for f in figures_of(s)]
    answer = Answer("One sentence.", columns, "experiment", rows, chips, *figures[:3], notes=("A note.",))
    return replace(made, answer=answer)


def test_the_first_page_is_the_answer():
    whole = answered()
    made = opened(whole)
    assert flaws(made) == []
    first, second = (squeezed(made[i].get_text()) for i in (0, 1))
    for text in (
        "Onesentence.",
        "steadyCFD",
        "−0.0262±0.0027",
        "10.3%",
        "formrejected",
        "nodata",
        "Chipwarn",
        "Anote.",
        "Figure2",
    ):
        assert text in first, text
    assert "Verdict2Checks2Howtoreproduce3" in first
    assert second.partition("Verdict")[0].endswith("1")
    bars = [d for d in made[0].get_drawings() if d["fill"] and d["rect"].height < 5 and d["rect"].width > 2]
    colours = {tuple(round(255 * c) for c in d["fill"]) for d in bars}
    assert {(0, 122, 88), (179, 38, 30)} <= colours


def test_the_bar_is_as_long_as_its_share_of_u95():
    """The shade is U95 to both sides; a difference of half of it fills half of one side."""
    row = AnswerRow("Yv", 1.0, 0.2, "", "", (0.9,), 0.1, True)
    made = opened(Document("T", "", (), answer=Answer("S", ("experiment",), "experiment", (row,))))
    drawn = [d for d in made[0].get_drawings() if d["fill"] and d["rect"].height < 10]
    shade = next(d["rect"] for d in drawn if round(255 * d["fill"][0]) == 228)
    bar = next(d["rect"] for d in drawn if tuple(round(255 * c) for c in d["fill"]) == (0, 122, 88))
    assert bar.width / shade.width == pytest.approx(0.25, abs=0.01)
    assert bar.x0 == pytest.approx((shade.x0 + shade.x1) / 2.0, abs=0.3)


def test_a_value_and_its_unit_stay_on_one_line():
    """Wherever the line ends: one word more in front of it moves the break by a few letters."""
    for n in range(40):
        text = f"{'of ' * 25}{'i' * n} at 3.34 m/s, 65.1 kg m^2 and 25 % of (12 kg/m^3) it."
        made = opened(Document("T", "", (Section("one", "One", (text,)),)))
        lines = [line for page in made for line in page.get_text().splitlines()]
        assert any("3.34 m/s" in line for line in lines), lines
        assert any("65.1 kg m" in line for line in lines), lines
        assert any("25 %" in line for line in lines), lines
        assert any("12 kg/m" in line for line in lines), lines
    assert pdf.MEASURED.findall("version 3 runs, 14 fits with 7 m of it, 9 min") == ["7 m"]


def test_one_line_above_a_table_stays_with_it():
    """A head with a line of words is not left at the foot of a page."""
    rows = tuple((f"row {i}", "found", "a rule of some length") for i in range(30))
    table = Table("Failures", ("check", "found", "meaning"), rows, (), frozenset({0, 1, 2}))
    for n in range(20, 60, 2):
        before = Section("before", "Before", ("A line. " * 10,) * n)
        made = opened(Document("T", "", (before, Section("checks", "Checks", ("0 fail, 17 warn.",), (table,)))))
        (at,) = [i for i, page in enumerate(made) if "0 fail, 17 warn." in page.get_text()]
        assert "row0" in squeezed(made[at].get_text()), n
        assert "Failures" in made[at].get_text(), n


def test_the_heads_of_the_first_page_have_their_subscripts():
    row = AnswerRow("Yv", 1.0, 0.2, "", "", (0.9,), 0.1, True)
    made = opened(Document("T", "", (), answer=Answer("S", ("experiment",), "experiment", (row,))))
    spans = [s for b in made[0].get_text("dict")["blocks"] for line in b.get("lines", ()) for s in line["spans"]]
    assert not any("U95" in s["text"] for s in spans)
    assert sum(s["text"].strip().startswith("95") and s["size"] < 8.0 for s in spans) >= 3


def test_an_appendix_begins_on_a_page_of_its_own():
    made = opened(small(published=True)[0])
    (at,) = [i for i, page in enumerate(made) if "Appendix" in page.get_text()]
    assert at > 2
    assert "Uncertaintybudget" in squeezed(made[at].get_text())


@pytest.mark.slow
def test_the_core_of_the_validation_has_twelve_pages(suboff):
    whole = document(suboff, full=False)
    made = opened(whole)
    assert flaws(made) == []
    assert len(made) <= 12
    texts = [p for s in every(whole.sections) for p in (*s.texts, *(n for t in s.tables for n in t.notes))]
    assert max(map(len, texts)) <= 240
    coefficients = next(s for s in whole.sections if s.anchor == "coefficients")
    zero = [n for t in coefficients.tables for n in t.notes if n.startswith("Zero by symmetry")]
    assert zero == [
        "Zero by symmetry, and zero within U95: Kv', Kr', Kv|v|' and Kvvv'; |value| + U95 is at most 1.9e-06."
    ]


def every(sections):
    for s in sections:
        yield s
        yield from every(s.subsections)


@pytest.mark.slow
def test_the_validation_is_printed_whole(suboff, suboff_document):
    whole = suboff_document
    made = opened(whole)
    assert flaws(made) == []
    assert len(made) < 110
    text = text_of(made)
    figures = [*first_page(whole), *(f for s in whole.sections for f in figures_of(s))]
    tables, elsewhere = on_paper(whole)
    assert f"Figure{len(figures)}" in text
    assert f"Table{len(tables)}" in text
    assert len(elsewhere) > 10
    assert all(f"atableof{t['count']}rows,intheHTMLofthisreport" in text for t in elsewhere)
    short = opened(report_of(suboff, short=True).document)
    assert len(short) == 1
    assert flaws(short) == []


def on_paper(whole):
    """Tables that are printed, and long ones that the paper only names."""
    tables = [t for part in pdf.content(whole)["parts"] for t in part["tables"]]
    return [t for t in tables if not t["elsewhere"]], [t for t in tables if t["elsewhere"]]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["huuv", "flyingfish", "thauv"])
def test_publications_are_printed(name, publication):
    found = publication(name)
    core = report_of(found).document
    content = pdf.render(core)["report.pdf"]
    made = pymupdf.open(stream=content, filetype="pdf")
    assert flaws(made) == []
    assert len(made) <= 12
    whole = report_of(found, full=True).document
    printed = opened(whole)
    assert flaws(printed) == []
    assert f"Table{len(found.tables)}" in text_of(printed)
    short = opened(report_of(found, short=True).document)
    assert len(short) == 1
    assert flaws(short) == []
    assert pdf.render(replace(core, title="Another"))["report.pdf"] != content
