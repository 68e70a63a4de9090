"""The report in a real browser."""

from __future__ import annotations

import io

import matplotlib.pyplot as plt
import numpy as np
import pytest

from coeflab.report.content import core
from coeflab.report.formats import REPORTERS

CLIPPED = """() => {
  const out = [];
  for (const svg of document.querySelectorAll('figure svg')) {
    const frame = svg.getBoundingClientRect();
    for (const text of svg.querySelectorAll('text')) {
      const box = text.getBoundingClientRect();
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1
          || box.bottom > frame.bottom + 1) out.push(svg.querySelector('title').textContent + ': ' + text.textContent);
    }
    for (const shape of svg.querySelectorAll('path, use')) {
      if (shape.closest('[clip-path]') || shape.closest('defs')) continue;
      const box = shape.getBoundingClientRect();
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1
          || box.bottom > frame.bottom + 1) out.push(svg.querySelector('title').textContent + ': a shape');
    }
  }
  return out;
}"""
REGIONS = """() => [...document.querySelectorAll('[role=region], section[aria-labelledby], nav')].map(r => r.ariaLabel ||
  r.getAttribute('aria-labelledby').split(' ').map(i => document.getElementById(i).textContent).join(' / '))"""
COLOURS = """() => [getComputedStyle(document.body).backgroundColor,
  getComputedStyle(document.querySelector('figure svg text')).fill]"""
SMALLEST = """() => Math.min(...[...document.querySelectorAll('figure svg text')].map(t => {
  const m = t.getScreenCTM();
  return parseFloat(getComputedStyle(t).fontSize) * Math.hypot(m.a, m.b);
}))"""
OVERLAPPING = """() => {
  const out = [];
  for (const svg of document.querySelectorAll('figure svg')) {
    const boxes = [...svg.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()]);
    for (let i = 0; i < boxes.length; i++) for (let j = 0; j < i; j++) {
      const [a, p] = boxes[i], [b, q] = boxes[j];
      const across = Math.min(p.right, q.right) - Math.max(p.left, q.left);
      const up = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
      if (across > 1 && up > 4) out.push(a + ' / ' + b);
    }
  }
  return out;
}"""


def drawn_whole(page):
    """Nothing of a drawing is cut off, no text lies on another, nothing scrolls sideways."""
    assert page.evaluate(CLIPPED) == []
    assert page.evaluate(OVERLAPPING) == []
    page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    assert page.evaluate("document.scrollingElement.scrollWidth <= window.innerWidth")


def silent(page, address):
    """It says nothing and loads nothing but itself."""
    assert page.heard == []
    assert [url for url in page.fetched if not url.startswith("data:")] == [address]


def test_a_page_on_a_wide_screen(opened, address):
    """Opened once: silence, scripts, keyboard, regions, colours, drawings, and all tables in print."""
    page = opened(1440)
    silent(page, address)
    views = page.locator("script.space").count() > 0  # they bring three.js, a script of its own
    assert page.evaluate(
        "[...document.querySelectorAll('script')].map(s => s.type).filter(t => t !== 'application/json')"
    ) == ["module"] * (1 + views)
    assert page.locator("[onload], [onclick], [onerror], iframe, object, embed").count() == 0
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    assert page.evaluate("document.activeElement.getBoundingClientRect().top") >= 0
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"
    names = page.evaluate(REGIONS)
    assert len(names) > 3
    assert sorted(names) == sorted(set(names))
    assert page.locator("figure svg").count() >= 4
    light = page.evaluate(COLOURS)
    page.emulate_media(color_scheme="dark")
    dark = page.evaluate(COLOURS)
    assert light[0] != dark[0]
    assert light[1] != dark[1]
    page.emulate_media(color_scheme="light")
    drawn_whole(page)
    page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = false; })")
    page.emulate_media(media="print")
    assert page.evaluate(
        "[...document.querySelectorAll('details table')].every(t => t.getBoundingClientRect().height > 10)"
    )


def test_a_page_on_a_phone(opened, address):
    page = opened(390)
    silent(page, address)
    assert page.locator("figure svg").count() >= 4
    assert page.evaluate(SMALLEST) >= 10.0
    drawn_whole(page)


# A4 less the margins of the page rule, at 96 pixels an inch.
def test_a_page_on_paper(opened):
    page = opened(673)
    page.emulate_media(media="print")
    assert page.evaluate("[...document.querySelectorAll('figure')].every(f => f.getBoundingClientRect().right <= 674)")
    assert page.evaluate("Math.max(...[...document.querySelectorAll('figure svg')].map(f => f.clientHeight))") < 980
    assert page.evaluate(CLIPPED) == []
    assert page.locator("canvas:visible, .probe:visible").count() == 0
    # A browser shrinks the whole print to the widest line.
    wide = page.evaluate(
        """() => [...document.querySelectorAll('table, caption, pre, p, h1, h2, h3, h4, nav')].filter(
        e => e.getBoundingClientRect().right > 674).map(e => e.tagName + ' ' + e.textContent.slice(0, 60))"""
    )
    assert wide == []
    assert page.locator(".up:visible").count() == 0
    assert page.locator("nav:visible").count() == page.locator("#answer").count()
    assert page.pdf(prefer_css_page_size=True).startswith(b"%PDF")


@pytest.mark.slow
def test_the_suboff_report_is_small_and_painted_within_a_second(browser, suboff_document, tmp_path):
    """`coeflab report suboff`. Processor time of the page's own thread, as a busy machine changes it little; the least of three."""
    path = tmp_path / "report.html"
    path.write_bytes(REPORTERS.load("html").render(core(suboff_document))["report.html"])
    assert path.stat().st_size < 1_500_000
    taken = []
    for _ in range(3):
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable", {"timeDomain": "threadTicks"})
        page.goto(path.as_uri())
        page.wait_for_function("() => performance.getEntriesByName('first-contentful-paint').length")
        known = {m["name"]: m["value"] for m in session.send("Performance.getMetrics")["metrics"]}
        taken.append(known["TaskDuration"])  # parsing, script, style and layout are tasks: all until the page is loaded
        page.close()
    assert 0.0 < min(taken) < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("width", [1280, 1440])
def test_tables_of_the_text_show_their_last_column(visit, written, width):
    page = visit(written("suboff"), width)
    hidden = page.evaluate(
        """() => [...document.querySelectorAll('.scroll:has(> table)')].filter(s => !s.closest('.fold') &&
        s.scrollWidth > s.clientWidth + 1).map(s => s.querySelector('caption').textContent)"""
    )
    assert [name for name in hidden if width == 1440 or not name.startswith("Primes")] == []


def test_on_a_phone_a_wide_table_is_a_block_a_row_that_names_its_cells(visit, written):
    page = visit(written("plain"), 390)
    boxes = page.evaluate(
        """() => [...document.querySelectorAll('.scroll:has(> table)')].filter(s => s.clientWidth).map(s => [
        s.scrollWidth <= s.clientWidth + 1, s.classList.contains('stacked')])"""
    )
    assert all(fits for fits, _ in boxes)
    assert any(stacked for _, stacked in boxes)
    shown = page.locator(".stacked").first.evaluate(
        """s => { const t = s.querySelector('table'); return [t.role, t.rows[1].role, [...t.tHead.rows[0].cells].map(c => c.textContent),
        [...t.rows[1].cells].map(c => c.dataset.name ?? '')]; }"""
    )
    assert shown[:2] == ["table", "row"]
    assert [n.strip() for n in shown[2][1:]] == shown[3][1:]
    page.set_viewport_size({"width": 1440, "height": 900})
    page.wait_for_function("() => !document.querySelector('.stacked')")
    page.set_viewport_size({"width": 700, "height": 390})
    page.set_viewport_size({"width": 390, "height": 700})  # a phone that is turned
    page.wait_for_function(
        "() => [...document.querySelectorAll('.scroll:has(> table)')].every(s => s.scrollWidth <= s.clientWidth + 1)"
    )


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_table_that_scrolls_has_a_shadow_at_the_edge_that_hides_something(visit, written, scheme):
    page = visit(written("plain"), 390, scheme)
    box = page.locator(".scroll:has(> table)").first
    box.evaluate("s => s.classList.remove('stacked')")
    assert box.evaluate("s => s.scrollWidth > s.clientWidth + 20")

    def edges() -> list[float]:
        image = plt.imread(io.BytesIO(box.screenshot(animations="disabled")))[:, :, :3]
        top = image[2:-4, :, :].reshape(-1, image.shape[1], 3)
        ground = np.median(top, axis=(0, 1))
        return [float(np.median(np.abs(top[:, x] - ground).sum(axis=1))) for x in (1, -2)]

    left, right = edges()
    assert left < 0.02 < right
    box.evaluate("s => { s.scrollLeft = s.scrollWidth; }")
    left, right = edges()
    assert right < 0.02 < left
