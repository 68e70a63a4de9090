from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.provenance import works
from coeflab.report.glossary import definitions_html, linked_html, markdown, mentions, terms
from coeflab.report.markup import html
from coeflab.report.notation import keeping

ROOT = Path(__file__).resolve().parents[2]


def named(text: str) -> list[str]:
    return [term.name for _, _, term in mentions(text)]


def test_the_page_in_docs_is_made_from_the_terms():
    found = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    assert found == markdown(), (
        'python -c "from coeflab.report.glossary import markdown; print(markdown(), end=\\"\\")" > docs/glossary.md'
    )


def test_every_term_has_an_anchor_a_source_that_exists_and_a_page_that_exists():
    assert len({t.anchor for t in terms()}) == len(terms())
    assert not [t.name for t in terms() if set(t.sources) - set(works())]
    assert not [t.name for t in terms() if t.page and not (ROOT / "docs" / t.page).is_file()]
    spelled = [word for t in terms() for word in (t.name, *t.spellings)]
    assert len(set(spelled)) == len(spelled)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("U95 covers noise; added mass by panels", ["U95", "added mass", "panel method"]),
        ("Added mass in unbounded fluid", ["added mass"]),
        ("the Munk moment, not the munk moment", ["Munk moment"]),
        ("slopes at the origin, primed by LBP", ["slope at the origin", "prime", "LBP"]),
        ("a form of PMMs, in advance, loss of speed, my-U95, U95.csv, cfd/U95", []),
        ("|E| < U_V, C_A(nu) nu", ["U_V", "C_A(nu)"]),
    ],
)
def test_terms_are_found_as_words(text, names):
    assert named(text) == names


def test_the_first_mention_is_linked_once_and_symbols_stay():
    seen: set[str] = set()
    out = linked_html("U95 of Yv' by GCI, U95 again", seen)
    assert out.count('<a class="term"') == 2
    assert out.startswith('<a class="term" href="#term-u95" title="Half-width')
    assert f">{html('U95')}</a>" in out
    assert html("Yv'") in out
    assert seen == {"term-u95", "term-gci"}
    assert "<a" not in linked_html("U95 and GCI", seen)


def test_without_a_term_it_is_the_plain_setting():
    for text in ("Yv' = -0.0273 at beta = 2 deg", "a < b & c", "$x_1$ of 2e-05"):
        assert linked_html(text, set()) == html(text)


def test_a_symbol_is_not_cut_and_users_words_are_not_linked():
    seen: set[str] = set()
    assert linked_html("|E|' of U95_fine", seen) == html("|E|' of U95_fine")
    with keeping(["GCI study of mine"]):
        assert linked_html("GCI study of mine, with GCI", seen).count("<a ") == 1
    assert seen == {"term-gci"}


def test_in_a_page_without_definitions_a_term_shows_its_own():
    seen: set[str] = set()
    out = linked_html("U95 and U95", seen, listed=False)
    assert out.count("<abbr") == 1
    assert 'title="Half-width' in out
    assert "href" not in out
    assert seen == {"term-u95"}


def test_definitions_are_those_that_were_linked():
    seen: set[str] = set()
    linked_html("zigzag by the added mass", seen)
    out = definitions_html(seen)
    assert out.count("<dt") == 2
    assert out.index('id="term-added-mass"') < out.index('id="term-zigzag"')
    assert definitions_html(()) == ""
