"""The report in a real browser."""

from __future__ import annotations

import os
import shutil

import pytest

from coeflab.core.files import shipped
from coeflab.model.plan import read_plan
from coeflab.model.study import Plan, PlannedTable
from coeflab.presentation.content import document
from coeflab.reporting import REPORTERS
from coeflab.workbench import run
from tests.presentation.studies import FULL, HOSTILE, small_study

FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--no-first-run", "--disable-dev-shm-usage",
]  # fmt: skip
WIDTHS = [1440, 390]
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


def _missing(why: str) -> None:
    if os.environ.get("COEFLAB_FORBID_SKIPS"):
        pytest.fail(why)
    pytest.skip(why)


@pytest.fixture(scope="module")
def browser():
    path = shutil.which("chromium")
    if path is None:
        _missing("chromium is not installed")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        _missing("playwright is not installed")
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield opened
        opened.close()


def _study(kind: str):
    if kind == "suboff":
        return run(read_plan(shipped("cfd_data") / "suboff" / "plan.toml"))
    if kind == "models":
        planned = [("huuv_synthetic", "surface"), ("thauv_case_01_synthetic", "glide_polar"),
                   ("suboff_cfd_barehull", "manoeuvring_model")]  # fmt: skip
        tables = tuple(PlannedTable(shipped("cfd_data") / c, (f,), {}) for c, f in planned)
        return run(Plan(name="models", title="Fitted models", tables=tables))
    return small_study(FULL, named=HOSTILE if kind == "hostile" else "tow", published=True)


@pytest.fixture(scope="module", params=["plain", "hostile", "models", pytest.param("suboff", marks=pytest.mark.slow)])
def address(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    study = _study(request.param)
    path.write_bytes(REPORTERS.load("html").render(document(study))["report.html"])
    return path.as_uri()


@pytest.fixture
def opened(browser, address):
    pages = []

    def open_page(width: int, scheme: str = "light"):
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
        page.heard, page.fetched = [], []
        page.on("console", lambda message: page.heard.append(message.text))
        page.on("pageerror", lambda error: page.heard.append(str(error)))
        page.on("request", lambda request: page.fetched.append(request.url))
        page.goto(address)
        pages.append(page)
        return page

    yield open_page
    for page in pages:
        page.close()


@pytest.mark.parametrize("width", WIDTHS)
def test_the_page_is_silent_and_loads_nothing_else(opened, address, width):
    page = opened(width)
    assert page.heard == []
    assert [url for url in page.fetched if not url.startswith("data:")] == [address]


@pytest.mark.parametrize("width", WIDTHS)
def test_the_page_does_not_scroll_sideways(opened, width):
    page = opened(width)
    page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    assert page.evaluate("document.scrollingElement.scrollWidth <= window.innerWidth")


@pytest.mark.parametrize("width", WIDTHS)
def test_no_drawing_is_cut_off_and_no_text_lies_on_another(opened, width):
    page = opened(width)
    assert page.locator("figure svg").count() >= 4
    assert page.evaluate(CLIPPED) == []
    assert page.evaluate(OVERLAPPING) == []


def test_text_of_drawings_is_readable_on_a_phone(opened):
    page = opened(390)
    assert page.evaluate(SMALLEST) >= 10.0


def test_dark_and_light_differ_in_paper_and_ink(opened):
    seen = {}
    for scheme in ("light", "dark"):
        page = opened(1440, scheme)
        seen[scheme] = page.evaluate(
            "[getComputedStyle(document.body).backgroundColor, "
            "getComputedStyle(document.querySelector('figure svg text')).fill]"
        )
    assert seen["light"][0] != seen["dark"][0]
    assert seen["light"][1] != seen["dark"][1]


def test_the_keyboard_reaches_the_skip_link_first(opened):
    page = opened(1440)
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    assert page.evaluate("document.activeElement.getBoundingClientRect().top") >= 0
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"


def test_print_shows_all_tables(opened):
    page = opened(1440)
    page.emulate_media(media="print")
    assert page.evaluate(
        "[...document.querySelectorAll('details table')].every(t => t.getBoundingClientRect().height > 10)"
    )
