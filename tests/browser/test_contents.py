"""Finding one's way in a report: contents beside it or in a fold, the section in view, names of regions, paper."""

from __future__ import annotations

import pytest

WIDE, NARROW = 1440, 390
PLACES = """() => {
  const box = s => { const b = document.querySelector(s).getBoundingClientRect(); return [b.left, b.right, b.top, b.bottom]; };
  return {contents: box('details.contents nav'), main: box('.report')};
}"""


@pytest.fixture
def plain(visit, written):
    return lambda width=WIDE, **more: visit(written("plain"), width, **more)


@pytest.mark.parametrize("scripts", [True, False])
def test_on_a_wide_screen_the_contents_stay_beside_the_report(plain, scripts):
    page = plain(java_script_enabled=scripts)
    for _ in range(2):
        seen = page.evaluate(PLACES)
        assert seen["contents"][1] <= seen["main"][0]
        assert seen["contents"][3] > 0
        assert page.get_by_role("link", name="Verdict").is_visible()
        page.evaluate("scrollTo(0, 3000)")  # a wheel turned before the first frame is lost
        page.wait_for_function("scrollY > 2000")
    assert seen["main"][2] < -1500


def test_the_section_in_view_is_marked_and_no_other(plain):
    page = plain()
    for anchor in ("verdict", "coefficients", "campaign-tow-yv", "provenance"):
        page.evaluate(f"document.getElementById('{anchor}').scrollIntoView()")
        page.wait_for_function(
            f"() => [...document.querySelectorAll('[aria-current]')].map(a => a.hash).join() === '#{anchor}'"
        )
        assert page.locator("[aria-current]").get_attribute("aria-current") == "location"


def test_without_scripts_the_contents_are_a_plain_list(plain):
    page = plain(java_script_enabled=False)
    assert page.locator("[aria-current]").count() == 0
    assert page.locator("details.contents summary").is_hidden()


def test_the_marked_entry_stays_in_sight_in_a_low_window(plain):
    page = plain()
    page.set_viewport_size({"width": WIDE, "height": 320})
    page.evaluate("document.getElementById('provenance').scrollIntoView()")
    page.wait_for_function(
        """() => { const a = document.querySelector('[aria-current]'); if (a?.hash !== '#provenance') return false;
        const b = a.getBoundingClientRect(); return b.top >= 0 && b.bottom <= innerHeight; }"""
    )


def test_the_list_beside_the_report_is_open_and_can_be_scrolled_by_keyboard(plain):
    page = plain()
    assert page.evaluate("document.querySelector('details.contents').open")
    page.set_viewport_size({"width": WIDE, "height": 320})
    page.locator("details.contents nav").focus()
    page.keyboard.press("End")
    page.wait_for_function("() => document.querySelector('details.contents nav').scrollTop > 20")


def test_the_fold_keeps_what_its_reader_chose(plain):
    page = plain(NARROW)
    open_ = "document.querySelector('details.contents').open"
    assert not page.evaluate(open_)
    for width, wanted in ((WIDE, True), (NARROW, False)):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_function(f"() => {open_} === {str(wanted).lower()}")
    page.locator("details.contents summary").click()
    for width in (WIDE, NARROW):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_function(f"() => {open_} && innerWidth === {width}")
        assert page.locator("details.contents summary").is_visible() == (width == NARROW)


def test_without_scripts_the_contents_are_open_on_a_phone_too(plain):
    page = plain(NARROW, java_script_enabled=False)
    assert page.get_by_role("link", name="Verdict").is_visible()
    assert page.locator("details.contents summary").is_visible()


def test_on_a_phone_the_contents_are_a_fold(plain):
    page = plain(NARROW)
    assert page.get_by_role("link", name="Verdict").count() == 0
    page.locator("details.contents summary").focus()
    page.keyboard.press("Enter")
    page.get_by_role("link", name="Provenance").focus()
    page.keyboard.press("Enter")
    page.wait_for_function("document.getElementById('provenance').getBoundingClientRect().top < innerHeight")


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_there_is_a_way_to_the_top_once_one_has_left_it(plain, width):
    page = plain(width)
    up = page.get_by_role("link", name="To the top")
    page.wait_for_function("document.querySelector('.up').hidden")
    page.evaluate("scrollTo(0, 4000)")
    up.wait_for()
    up.focus()
    page.keyboard.press("Enter")
    page.wait_for_function("scrollY < 100")


def test_nothing_glides_for_who_wants_no_motion(plain):
    page = plain(reduced_motion="reduce")
    assert page.evaluate("getComputedStyle(document.documentElement).scrollBehavior") == "auto"
    assert page.evaluate("document.getAnimations().length") == 0


def test_on_paper_a_caption_takes_one_line_where_there_is_room(visit, written):
    page = visit(written("plain"), 673)
    page.emulate_media(media="print")
    tall = page.evaluate(
        """() => [...document.querySelectorAll('.scroll caption')].filter(c => !c.closest('.fold') && c.textContent.length < 50)
        .map(c => [c.textContent, c.getBoundingClientRect().height / parseFloat(getComputedStyle(c).fontSize)])"""
    )
    assert len(tall) > 3
    assert [t for t, lines in tall if lines > 2.6] == []
