"""What can be done in a report: values, switches, views in space, by mouse and keyboard alike; and without scripts."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

import pytest

ESTIMATORS = "#campaign-tow-yv-estimators"
DATA = "#campaign-tow-yv-data"
SPACE = "#campaign-huuv-synthetic-c-d-surface-space"
BODIES = ("#suboff-aff8-outline-space", "#urv-puma-parts-space")
SERIOUS = ("serious", "critical")
LUMINANCE = """names => {
  const channel = c => { const s = c / 255; return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4; };
  const brush = document.createElement('canvas').getContext('2d');
  const of = name => {
    brush.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const [r, g, b] = [1, 3, 5].map(i => channel(parseInt(brush.fillStyle.slice(i, i + 2), 16)));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const paper = of('--paper');
  return names.map(n => { const l = of(n); return (Math.max(l, paper) + 0.05) / (Math.min(l, paper) + 0.05); });
}"""


@pytest.fixture
def plain(visit, written):
    return visit(written("plain"))


@pytest.fixture(scope="module")
def models(browser, written):
    """Opened once; each test leaves it as it was."""
    page = browser.new_page(viewport={"width": 1440, "height": 900}, color_scheme="light")
    page.goto(written("models"))
    yield page
    page.close()


def shown(page, key, where=ESTIMATORS):
    """How many marks of a series are drawn."""
    return page.evaluate(
        """([where, key]) => [...document.querySelectorAll(`${where} .plot [data-series="${key}"]`)]
        .flatMap(a => [...a.querySelectorAll('use, path')]).filter(m => !m.closest('defs') && m.getClientRects().length).length""",
        [where, key],
    )


def test_a_legend_entry_hides_its_form_by_mouse_and_shows_it_by_keyboard(plain):
    button = plain.locator(f"{ESTIMATORS} .switches button").first
    assert button.inner_text() == "line"
    before = shown(plain, "form0")
    assert before > 2
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    assert shown(plain, "form0") == 0
    assert shown(plain, "form1") > 0
    button.focus()
    plain.keyboard.press("Space")
    assert button.get_attribute("aria-pressed") == "true"
    assert shown(plain, "form0") == before


def test_a_window_hides_its_estimates_in_both_panels(plain):
    buttons = plain.locator(f"{ESTIMATORS} .groups button")
    names = buttons.all_inner_texts()
    assert names == sorted(names, key=float)
    assert len(names) > 3
    whole = shown(plain, "form1")
    for name in names:
        plain.locator(f"{ESTIMATORS} .groups button", has_text=re.compile(f"^{re.escape(name)}$")).click()
    assert [shown(plain, f"form{i}") for i in range(4)] == [0, 0, 0, 0]
    buttons.last.focus()
    plain.keyboard.press("Enter")
    assert 0 < shown(plain, "form1") < whole


def test_the_keyboard_tells_value_unit_and_row(plain):
    probe = plain.locator(f"{DATA} [role=slider]")
    probe.focus()
    plain.keyboard.press("ArrowRight")
    plain.keyboard.press("Home")
    text = probe.get_attribute("aria-valuetext")
    assert re.match(r"points, sideslip asin v.? = −12 ?(deg|°), Y.? = 0\.00", text)
    assert text.endswith("tow 0")
    plain.keyboard.press("End")
    assert re.search(r" = 12 ?(deg|°)", probe.get_attribute("aria-valuetext"))
    assert plain.locator(f"{DATA} .said").is_visible()
    plain.keyboard.press("Escape")
    assert not plain.locator(f"{DATA} .said").is_visible()


def test_the_pointer_tells_the_point_under_it(plain):
    place = plain.evaluate(
        f"""() => {{ const m = document.querySelector('{DATA} [data-series="points"] use'); m.scrollIntoView();
        const b = m.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }}"""
    )
    plain.mouse.move(*place)
    said = plain.locator(f"{DATA} .said")
    assert said.is_visible()
    assert re.search(r"−12 ?(deg|°)", said.inner_text())
    assert "tow 0" in said.inner_text()


def test_a_hidden_series_is_not_told(plain):
    plain.locator(f"{DATA} .switches button").first.click()
    probe = plain.locator(f"{DATA} [role=slider]")
    probe.focus()
    plain.keyboard.press("Home")
    assert not probe.get_attribute("aria-valuetext").startswith("points")


def picture(page, where=SPACE):
    """A view is drawn when it is near what is seen."""
    page.locator(f"{where} canvas").scroll_into_view_if_needed()
    page.wait_for_function(f"() => document.querySelector('{where} canvas').width !== 300")
    return page.evaluate(f"document.querySelector('{where} canvas').toDataURL()")


def test_a_surface_turns_by_keyboard_button_and_mouse_and_comes_back(models):
    canvas = models.locator(f"{SPACE} canvas")
    canvas.scroll_into_view_if_needed()
    home = picture(models)
    seen = {home}
    canvas.focus()
    for key in ("ArrowLeft", "ArrowUp", "+"):
        models.keyboard.press(key)
        seen.add(picture(models))
    models.locator(f"{SPACE} button[aria-label='Closer']").click()
    models.locator(f"{SPACE} button[aria-label='Turn right']").click()
    seen.add(picture(models))
    box = canvas.bounding_box()
    models.mouse.move(box["x"] + 100, box["y"] + 100)
    models.mouse.down()
    models.mouse.move(box["x"] + 180, box["y"] + 120)
    models.mouse.up()
    seen.add(picture(models))
    assert len(seen) == 6
    models.locator(f"{SPACE} button", has_text="Reset").click()
    assert picture(models) == home


def test_layers_of_a_view_are_switches(models):
    home = picture(models)
    button = models.locator(f"{SPACE} .switches button", has_text="points")
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    assert picture(models) != home
    button.click()
    assert picture(models) == home


def test_a_view_follows_the_colours_of_the_reader(visit, written):
    page = visit(written("models"))
    light = picture(page)
    page.emulate_media(color_scheme="dark")
    page.wait_for_function(f"before => document.querySelector('{SPACE} canvas').toDataURL() !== before", arg=light)


def painted(page, where):
    """Share of a canvas that is not clear, and how many colours it has."""
    picture(page, where)
    return page.evaluate(
        f"""() => {{ const c = document.querySelector('{where} canvas'), d = new Uint32Array(c.getContext('2d')
        .getImageData(0, 0, c.width, c.height).data.buffer), on = d.filter(v => v >>> 24); return [on.length / d.length, new Set(on).size]; }}"""
    )


@pytest.mark.parametrize(("body", "scheme"), list(zip(BODIES, ("light", "dark"))))
def test_a_body_is_shaded_turns_and_is_silent(visit, written, body, scheme):
    page = visit(written("bodies"), scheme=scheme)

    def seen_from():
        """Place of the camera, its zoom, and what it looks at; pictures differ in the last digits of these."""
        return page.evaluate(f"""() => {{ const v = document.querySelector('{body}').closest('figure').view, c = v.camera;
            return [...c.position.toArray(), c.zoom, ...v.orbit.target.toArray()]; }}""")

    share, colours = painted(page, body)
    assert share > 0.05
    assert colours > 100
    home, first, canvas = picture(page, body), seen_from(), page.locator(f"{body} canvas")
    canvas.focus()
    seen = {home}
    for key in ("ArrowRight", "ArrowDown", "+", "Shift+ArrowLeft"):
        page.keyboard.press(key)
        seen.add(picture(page, body))
    box = canvas.bounding_box()
    for button in ("left", "right"):
        page.mouse.move(box["x"] + 100, box["y"] + 100)
        page.mouse.down(button=button)
        page.mouse.move(box["x"] + 160, box["y"] + 120)
        page.mouse.up(button=button)
        seen.add(picture(page, body))
    before = picture(page, body)
    page.mouse.wheel(0, -200)
    page.wait_for_function(f"before => document.querySelector('{body} canvas').toDataURL() !== before", arg=before)
    still = ""
    while (now := picture(page, body)) != still:  # one turn of the wheel comes as several events
        still = now
        page.wait_for_timeout(250)
    assert len(seen) == 7
    assert seen_from() != pytest.approx(first, abs=1e-3)
    page.keyboard.press("Home")
    assert seen_from() == pytest.approx(first, abs=1e-9)
    assert page.heard == []
    assert [url for url in page.fetched if not url.startswith(("file:", "data:"))] == []


def test_the_wheel_reads_on_until_a_view_was_chosen(visit, written):
    page = visit(written("bodies"))
    home, box = picture(page, BODIES[0]), page.locator(f"{BODIES[0]} canvas").bounding_box()
    before = page.evaluate("scrollY")
    page.mouse.move(box["x"] + 60, box["y"] + 60)
    page.mouse.wheel(0, 120)
    page.wait_for_function("before => scrollY > before", arg=before)
    assert picture(page, BODIES[0]) == home


def test_fingers_turn_a_body(visit, written):
    page = visit(written("bodies"), 390, has_touch=True)
    home = picture(page, BODIES[0])
    box = page.locator(f"{BODIES[0]} canvas").bounding_box()
    hand = page.context.new_cdp_session(page)
    for kind, x in (("touchStart", 100), ("touchMove", 130), ("touchMove", 170), ("touchEnd", None)):
        points = [] if x is None else [{"x": box["x"] + x, "y": box["y"] + 80}]
        hand.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    page.wait_for_function(f"home => document.querySelector('{BODIES[0]} canvas').toDataURL() !== home", arg=home)


def test_a_view_is_saved_as_it_stands(visit, written):
    page = visit(written("bodies"))
    picture(page, BODIES[0])
    with page.expect_download() as download:
        page.locator(f"{BODIES[0]} .save button", has_text="PNG").click()
    png = Path(download.value.path()).read_bytes()
    wide = page.evaluate(f"document.querySelector('{BODIES[0]} canvas').clientWidth")
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(png[16:20]) == 3 * wide
    assert len(png) > 10_000


def test_without_webgl_the_drawing_stands_alone(browser, written):
    page, heard = browser.new_page(), []
    page.on("console", lambda message: heard.append(message.text))
    page.on("pageerror", lambda error: heard.append(str(error)))
    page.add_init_script(
        """const own = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return /webgl/.test(kind) ? null : own.call(this, kind, ...more); };"""
    )
    page.goto(written("bodies"))
    assert page.locator("figure.space:visible").count() == 0
    assert page.locator("figure:not(.space) .plot > svg:visible").count() == 2
    assert heard == []
    page.close()


@pytest.mark.parametrize("kind", ["plain", "models"])
def test_without_scripts_everything_is_readable(visit, written, kind):
    page = visit(written(kind), java_script_enabled=False)
    assert page.locator("button, [role=slider]").count() == 0
    assert page.locator("canvas:visible").count() == 0
    drawn = page.locator("figure:visible svg")
    assert drawn.count() == page.locator("figure:not(.space)").count()
    if kind == "plain":
        assert page.locator(f"{ESTIMATORS} [data-legend] text").first.is_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_drawings_keep_their_contrast(visit, written, scheme):
    page = visit(written("plain"), scheme=scheme)
    for ratio in page.evaluate(LUMINANCE, ["--ink", "--muted", "--link", "--fig-ink", "--fig-muted"]):
        assert ratio >= 4.5
    for ratio in page.evaluate(LUMINANCE, [f"--fig-{c}" for c in "abcd"]):
        assert ratio >= 3.0


CONTRAST = "color-contrast"  # two thirds of axe's time; the only rule that depends on the scheme, and none of the width
ONLY_CONTRAST, ALL_ELSE = {"runOnly": [CONTRAST]}, {"rules": {CONTRAST: {"enabled": False}}}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "width", "scheme", "rules", "opened"),
    [
        ("suboff", 1440, "light", ALL_ELSE, False), ("plain", 1440, "light", ONLY_CONTRAST, True),
        ("plain", 1440, "dark", ONLY_CONTRAST, True), ("plain", 390, "light", {}, False), ("models", 1440, "dark", {}, True),
    ],
)  # fmt: skip
def test_axe_finds_no_serious_violation(visit, written, kind, width, scheme, rules, opened):
    """In a page as it loads, or with all its folds open."""
    from axe_playwright_python.sync_playwright import Axe

    page = visit(written(kind), width, scheme)
    if opened:
        page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    found = Axe().run(page, options={"resultTypes": ["violations"], **rules}).response["violations"]
    assert [(v["id"], v["nodes"][0]["html"][:200]) for v in found if v["impact"] in SERIOUS] == []


def test_legends_keep_their_italics_and_indices(visit, written):
    drawn = visit(written("plain"), java_script_enabled=False)
    words = "t => [t.textContent, ...[...t.querySelectorAll('[font-style]')].map(s => s.textContent)]"
    labels = "[data-legend] [data-label]"
    before = drawn.eval_on_selector_all(labels, f"all => all.map({words})")
    page = visit(written("plain"))
    slanted = "t => [t.textContent, ...[...t.querySelectorAll('i')].map(s => s.textContent)]"
    entries = ".plot ~ .switches:not(.groups) > :is(.switch, .entry), .switches:has(+ .plot) > :is(.switch, .entry)"
    after = page.eval_on_selector_all(entries, f"all => all.map({slanted})")
    assert [[t.strip() for t in b] for b in before] == [[t.strip() for t in a] for a in after]
    assert any(len(a) > 1 for a in after)


def test_an_index_of_a_legend_stands_below_and_a_power_above(plain):
    """Without the page around them: the words that the drawings of this study have are never raised."""
    source = (files("coeflab.report.formats") / "_html" / "figures.js").read_text().partition("class Plot")[0]
    made = plain.evaluate(
        f"""() => {{ {source}
          const text = document.createElementNS(SVG, 'text'), place = document.createElement('p');
          text.innerHTML = '<tspan font-style="italic">C</tspan><tspan font-size="0.72em" dy="0.306em">D</tspan>'
            + '<tspan dy="-0.22em"> of U</tspan><tspan font-size="0.72em" dy="-0.472em">n</tspan>';
          lettered(text, place);
          return [...place.children].map(c => c.outerHTML.replaceAll(' class=""', '')).join() + place.textContent;
        }}"""
    )
    assert made == "<i>C</i>,<sub>D</sub>,<sup>n</sup>CD of Un"


def test_figures_have_titles_of_their_own(models):
    page = models
    # The answer repeats figures of the report.
    titles = page.locator(".report figcaption > strong:first-child").all_inner_texts()
    assert len(titles) == page.locator(".report figure").count() > 5
    assert len(titles) == len(set(titles))
    weight = "e => getComputedStyle(e).fontWeight"
    assert int(page.locator("figcaption > strong").first.evaluate(weight)) >= 600


def test_every_picture_has_a_text(models):
    page = models
    for svg in page.locator("figure .plot > svg").all():
        assert svg.get_attribute("role") == "img"
        assert svg.evaluate(
            "s => s.getAttribute('aria-labelledby').split(' ').every(i => document.getElementById(i).textContent)"
        )
    for canvas in page.locator("canvas").all():
        assert len(canvas.get_attribute("aria-label")) > 40
