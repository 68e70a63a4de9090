"""The gallery in a real browser."""

from __future__ import annotations

from threading import Thread

import pytest

from coeflab.report.content import document
from coeflab.report.formats import REPORTERS
from coeflab.report.gallery.server import GalleryServer
from tests.browser.test_interaction import ONLY_CONTRAST, SERIOUS
from tests.cli.test_compare import VALUES, changed, made
from tests.report.studies import ENDLESS, FULL, HOSTILE, small_study


@pytest.fixture(scope="module")
def gallery(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gallery")
    for name in ("tow", HOSTILE, ENDLESS):
        place = folder / f"study {len(list(folder.iterdir()))}"
        place.mkdir()
        report = document(small_study(FULL, named=name, published=True))
        (place / "report.html").write_bytes(REPORTERS.load("html").render(report)["report.html"])
    (folder / "report.html").write_text("<p>another page")
    (folder / "a.parameters.json").write_bytes(made(VALUES).to_json())
    second = made(changed(Yv=(-0.040, 0.002)), name=HOSTILE, body=ENDLESS[:200])
    (folder / "b<script>.parameters.json").write_bytes(second.to_json())
    (folder / f"c{'x' * 200}.parameters.json").write_bytes(made(VALUES, name="x" * 200).to_json())
    (folder / "d.parameters.json").write_text("{}")
    with GalleryServer(folder, 0) as server:
        thread = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
        thread.start()
        yield server.address
        server.shutdown()
        thread.join(5.0)


ALL = "compare?" + "&".join(f"file={k}" for k in ("a.parameters.json", "b%253Cscript%253E.parameters.json",
                                                  f"c{'x' * 200}.parameters.json"))  # fmt: skip
PAGES = ["", "?q=tow", "?q=nothing+like+it", ALL, "compare?file=a.parameters.json"]


@pytest.mark.parametrize("page", PAGES)
def test_pages_are_silent_load_nothing_else_and_do_not_scroll_sideways(visit, gallery, page):
    seen = visit(gallery + page)
    assert seen.heard == []
    more = [url for url in seen.fetched if not url.startswith("data:") and url != seen.url]
    assert [url for url in more if not url.startswith(f"{gallery}picture/")] == []
    for width in (1440, 390):
        seen.set_viewport_size({"width": width, "height": 900})
        assert seen.evaluate("document.scrollingElement.scrollWidth <= window.innerWidth")
    assert seen.evaluate("getComputedStyle(document.body).maxWidth") == "1216px"


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("page", PAGES)
def test_axe_finds_no_serious_violation(visit, gallery, page, scheme):
    from axe_playwright_python.sync_playwright import Axe

    rules = ONLY_CONTRAST if scheme == "dark" else {}
    found = (
        Axe()
        .run(visit(gallery + page, scheme=scheme), options={"resultTypes": ["violations"], **rules})
        .response["violations"]
    )
    assert [(v["id"], v["nodes"][0]["html"][:200]) for v in found if v["impact"] in SERIOUS] == []


@pytest.mark.parametrize("scripts", [True, False])
def test_search_and_comparison_by_keyboard(visit, gallery, scripts):
    page = visit(gallery, java_script_enabled=scripts)
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.get_by_label("Search studies, bodies, parameter files").focus()
    page.keyboard.type(["parameters.json", "hull lbp"][0])
    page.keyboard.press("Enter")
    page.wait_for_url("**/?q=parameters.json")
    boxes = page.get_by_role("checkbox")
    assert boxes.count() == 3
    for i in (0, 1):
        boxes.nth(i).focus()
        page.keyboard.press("Space")
    page.get_by_role("button", name="Compare the chosen files").focus()
    page.keyboard.press("Enter")
    page.wait_for_url("**/compare?**")
    assert page.get_by_role("cell", name="apart").count() == 1
    assert page.get_by_role("cell", name="within").count() == 3


def test_a_report_works_in_its_sandbox_and_can_fetch_nothing(visit, gallery):
    page = visit(gallery)
    page.locator(".cards h3 a").first.click()
    page.wait_for_url("**/file/**")
    assert page.locator(".switch").count() > 0
    switch = page.locator(".switch[aria-pressed]").first
    before = switch.get_attribute("aria-pressed")
    switch.click()
    assert switch.get_attribute("aria-pressed") != before
    assert page.heard == []
    said = page.evaluate("fetch('/').then(() => 'fetched', () => 'refused')")
    assert said == "refused"
