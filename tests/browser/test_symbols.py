"""Symbols in a page: what is drawn, heard, found and copied."""

from __future__ import annotations

import pytest

CELL = "#coefficients tbody tr"


@pytest.fixture
def page(visit, written):
    return visit(written("plain"))


def copied(page, selector, kind="text/plain"):
    """What a copy of an element puts on the clipboard."""
    return page.evaluate(
        """([selector, kind]) => {
          getSelection().selectAllChildren(document.querySelector(selector));
          const event = new ClipboardEvent("copy", {clipboardData: new DataTransfer(), bubbles: true, cancelable: true});
          document.dispatchEvent(event);
          return event.defaultPrevented ? event.clipboardData.getData(kind) : null;
        }""",
        [selector, kind],
    )


def test_a_derivative_is_set_and_copied_as_it_is_typed(page):
    cell = page.locator(f"{CELL} td").first
    assert cell.inner_html() == "<i>Y</i><sub><i>v</i></sub><u><b>'</b></u>"
    assert page.evaluate("s => getComputedStyle(document.querySelector(s), '::after').content", f"{CELL} u").startswith(
        '"′"'
    )
    assert copied(page, f"{CELL} td") == "Yv'"
    assert page.evaluate('() => { getSelection().removeAllRanges(); return find("Yv\'"); }')


def test_numbers_are_copied_for_other_programs(page):
    assert "−" in page.locator(CELL).first.inner_text()
    row = copied(page, CELL).split("\t")
    assert row[0] == "Yv'"
    assert float(row[1]) < 0.0
    assert "−" not in copied(page, CELL, "text/html")


def test_powers_of_ten_are_copied_as_one_number(page):
    page.evaluate(
        "h => { document.querySelector('#main p').innerHTML = h }",
        "−1.56\u202f×\u202f10<sup><b>^</b>−5</sup> of <i>U</i><sup><b>^</b>2</sup>",
    )
    assert copied(page, "#main p") == "-1.56e-5 of U^2"
    assert copied(page, "#main p", "text/html") == "-1.56e-5 of <i>U</i><sup><b>^</b>2</sup>"


def test_lines_keep_their_height_and_a_dot_stands_over_its_letter(page):
    page.evaluate(
        "h => { document.querySelector('#main p').innerHTML = h }",
        '<span>plain</span><br><span>set <i>Y</i><sub><i class="dot">v<b>dot</b></i></sub><u><b>\'</b></u><sup><b>^</b>2</sup></span>',
    )
    plain, spelled = (s.bounding_box() for s in page.locator("#main p > span").all())
    assert spelled["height"] == pytest.approx(plain["height"], abs=1.0)
    assert copied(page, "#main p > span:last-child") == "set Yvdot'^2"
    dot = page.evaluate(
        "() => { const s = getComputedStyle(document.querySelector('.dot'), '::before'); return [s.position, s.borderRadius]; }"
    )
    assert dot == ["absolute", "50%"]
