"""What a person does on the page: keyboard, pointer, screen reader, a saved figure; nothing from elsewhere."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.report.document import Document
from coeflab.report.formats import REPORTERS
from tests.workbench_page.conftest import settled

SHOWN = 'document.querySelector("#bench .big").textContent'


@pytest.fixture
def opened(visit, address):
    def at(width=1440, scheme="light", **more):
        page = visit(address, width, scheme, **more)
        if more.get("java_script_enabled", True):
            settled(page)
        return page

    return at


def test_a_document_without_sweeps_has_no_bench():
    with pytest.raises(InputError, match="slopes at the origin"):
        REPORTERS.load("workbench").render(Document("t", "s", ()))


def test_equal_studies_give_equal_pages(bench):
    first, second = (REPORTERS.load("workbench").render(Document("t", "s", (), bench=bench)) for _ in range(2))
    assert first == second
    assert len(first["workbench.html"]) < 300_000


def test_a_bar_goes_on_while_the_zigzag_is_computed(opened):
    page = opened()
    assert not page.locator("#bench progress").is_visible()
    page.evaluate("""() => {
      const bar = document.querySelector("#bench progress");
      window.parts = [];
      new MutationObserver(() => window.parts.push([bar.value, getComputedStyle(bar).visibility])).observe(bar, { attributes: true });
    }""")
    page.focus("#bench-limit")
    page.keyboard.press("ArrowLeft")
    settled(page)
    parts = page.evaluate("window.parts")
    values = [value for value, seen in parts if seen == "visible"]
    assert values[0] == 0.0
    assert values == sorted(values)
    assert 0.5 < values[-1] <= 1.0
    assert parts[-1][1] == "hidden"


def test_keyboard_alone_changes_value_and_brings_it_back(opened):
    page = opened()
    before = page.evaluate(SHOWN)
    assert page.locator("#bench-limit").get_attribute("aria-valuetext") == "14°: 14 of 14 points"
    page.focus("#bench-limit")
    page.keyboard.press("ArrowLeft")
    assert page.locator("#bench-limit").get_attribute("aria-valuetext") == "12°: 13 of 14 points"
    page.focus("#bench-point-3")
    page.keyboard.press("Space")
    assert page.evaluate("document.activeElement.id") == "bench-point-3"
    assert page.locator("#bench-limit").get_attribute("aria-valuetext") == "14°: 13 of 14 points"
    settled(page)
    assert page.evaluate(SHOWN) != before
    assert page.get_by_text("U95 does not include the effect of your choice of points.").is_visible()
    page.get_by_role("button", name="Reset", exact=True).press("Enter")
    settled(page)
    assert page.evaluate(SHOWN) == before
    assert page.heard == []


def test_a_click_on_a_point_leaves_it_out_and_the_others_follow_when_asked(opened):
    page = opened()
    page.locator("circle[data-at='0']").click()
    settled(page)
    assert not page.locator("#bench-point-0").is_checked()
    page.get_by_role("button", name="Same for Nv′").click()
    page.select_option("#bench-coefficient", label="Nv′ of boat")
    settled(page)
    assert not page.locator("#bench-point-0").is_checked()


def test_without_settings_nothing_is_determined(opened):
    page = opened()
    page.evaluate("""() => { const { edits, changed, data } = document.getElementById("bench").bench;
        edits[0] = { limit: data.sweeps[0].choices[0].limit, dropped: null }; changed(); }""")
    settled(page)
    assert page.evaluate(SHOWN) == "no value"
    text = page.locator(".values").inner_text()
    assert "cannot be separated" in text
    assert "Yv' has no value" in text
    assert "no motion: Yv′ has no value" in text


def test_a_slope_that_is_not_known_is_said_with_the_zigzag(visit, bench, tmp_path):
    noise = 3e-3 * np.random.default_rng(1).standard_normal(len(bench.sweeps[0]["y"]))
    noisy = bench.sweeps[0] | {"y": (bench.sweeps[0]["y"] + noise).tolist()}
    made = Document("t", "s", (), bench=replace(bench, sweeps=(noisy, *bench.sweeps[1:])))
    path = tmp_path / "workbench.html"
    path.write_bytes(REPORTERS.load("workbench").render(made)["workbench.html"])
    page = visit(path.as_uri())
    page.evaluate("""() => { const { edits, changed, data } = document.getElementById("bench").bench;
        const { limit, dropped } = data.sweeps[0].choices.find((c) => c.value !== null && Math.abs(c.value) <= c.fit);
        edits[0] = { limit, dropped }; changed(); }""")
    settled(page)
    row = page.evaluate('document.getElementById("bench").bench.shown.row')
    assert abs(row["value"]) <= row["u95"]
    words = "U95 of Yv′ includes zero: the slope is not known"
    assert words in page.locator(".motion").inner_text()
    assert "U95 of Yv′ includes zero" in page.locator(".zigzag svg").text_content()
    assert "able, but U95 of Yv′ includes zero" in page.locator(".index").inner_text()


def test_on_a_phone_the_slider_and_the_curve_are_seen_together(opened):
    page = opened(390)
    top, slider, curve = (
        page.locator(p).bounding_box() for p in ("#bench .big >> nth=0", "#bench-limit", "#bench svg >> nth=0")
    )
    assert top["y"] < slider["y"] < curve["y"]
    assert curve["y"] + curve["height"] - slider["y"] < 600


def test_the_figure_is_saved_as_a_drawing_of_its_own(opened):
    page = opened(accept_downloads=True)
    with page.expect_download() as waiting:
        page.get_by_role("button", name="Save SVG").first.click()
    saved = Path(waiting.value.path()).read_text(encoding="utf-8")
    assert waiting.value.suggested_filename == "boat Yv.svg"
    assert saved.startswith("<svg")
    assert "var(" not in saved
    assert "#0067a8" in saved


@pytest.mark.parametrize(("width", "scheme"), [(1440, "light"), (390, "dark")])
def test_axe_finds_no_serious_violation_and_nothing_is_fetched(opened, width, scheme):
    from axe_playwright_python.sync_playwright import Axe

    page = opened(width, scheme)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    found = [v for v in Axe().run(page).response["violations"] if v["impact"] in ("serious", "critical")]
    assert [(v["id"], [n["html"][:200] for n in v["nodes"]]) for v in found] == []
    assert [url for url in page.fetched if not re.match(r"(file|blob|data):", url)] == []
    assert page.heard == []


def test_first_screen_holds_value_figure_and_index(opened):
    page = opened()
    for place in ("#bench .big >> nth=0", "#bench svg >> nth=0", "#bench svg >> nth=1", "text=Course stability"):
        page.locator(place).wait_for()  # the list of indices is drawn anew when the zigzag is computed
        box = page.locator(place).bounding_box()
        assert box["y"] + box["height"] <= 900, place


def test_without_scripts_the_study_is_told(opened):
    page = opened(java_script_enabled=False)
    assert page.locator("table >> text=Yv'").is_visible()
    assert page.locator("h1").inner_text() == "A boat <b>"
