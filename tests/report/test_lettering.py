from __future__ import annotations

import re
from html import unescape
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.report.markup import cell_html, drawn, html, label, unit_html, unit_label

PRIMED = "Yv'"
CONTROLS = "\u202e\u202d\u2066\u200b\x00\x1b"


def said(markup: str) -> str:
    """The text that stands in the elements: what is heard, found and copied."""
    return unescape(re.sub(r"<[^>]*>", "", markup))


@pytest.mark.parametrize(
    ("text", "markup"),
    [
        ("Yv'", "<i>Y</i><sub><i>v</i></sub><u><b>'</b></u>"),
        ("v'^3", "<i>v</i><u><b>'</b></u><sup><b>^</b>3</sup>"),
        ("Yvdot'", '<i>Y</i><sub><i class="dot">v<b>dot</b></i></sub><u><b>\'</b></u>'),
        ("Y|v|r'", "<i>Y</i><sub>|<i>v</i>|<i>r</i></sub><u><b>'</b></u>"),
        ("Xvv'", "<i>X</i><sub><i>vv</i></sub><u><b>'</b></u>"),
        ("Ydr'", "<i>Y</i><sub><i>δ</i><sub>r</sub></sub><u><b>'</b></u>"),
        ("G_h = -1.56e-05", "<i>G</i><sub><b>_</b>h</sub> = −1.56\u202f×\u202f10<sup><b>^</b>−5</sup>"),
        ("U95 of 3 deg", "<i>U</i><sub>95</sub> of 3°"),
        ("use `coeflab fit F --to a&Yv`", "use <code>coeflab fit F --to a&amp;Yv</code>"),
        ("a < b & 'c'", "a &lt; b &amp; &#x27;c&#x27;"),
    ],
)
def test_html_of_a_text(text, markup):
    assert html(text) == markup


@pytest.mark.parametrize("text", ["Yv'", "v'^3", "Yvdot' and Nr|r|'", "G_h, U95, m', xG' m'", "U^2 L^3", "(x, y)"])
def test_html_says_what_was_written(text):
    assert said(html(text)) == text


def test_cells_and_units():
    assert cell_html("Yv") == "<i>Y</i><sub><i>v</i></sub>"
    assert cell_html("dr") == "<i>δ</i><sub>r</sub>"
    assert (cell_html("-"), cell_html("deg")) == ("–", "°")
    assert unit_html("N*m*s^2") == "N·m·s<sup><b>^</b>2</sup>"
    assert (unit_html("N"), unit_html("deg/s")) == ("N", "°/s")
    assert (unit_label("kg*m^2"), unit_label("deg")) == ("kg·m²", "°")


@pytest.mark.parametrize(
    ("text", "letters"),
    [
        ("v' + v'^3", "v′ + v′³"),
        ("Yv' at beta = -2 deg", "Yv′ at β = −2°"),
        ("Yvdot', Ydr', dr'", "Yv\u0307′, Yδr′, δr′"),
        ("1.5e-05", "1.5\u202f×\u202f10⁻⁵"),
        ("G_h, U95, L^k", "G_h, U95, L^k"),
        ("C_D_alpha^2 beta", "C_Dα²β"),
        ("sideslip asin v'  [deg]", "sideslip asin v′  [°]"),
    ],
)
def test_a_label_is_letters_alone(text, letters):
    assert label(text) == letters


def test_a_drawing_sets_symbols_in_its_text():
    found = ET.fromstring("<text>" + drawn(f"{PRIMED} & G_h < 10^-3") + "</text>")
    assert "".join(found.itertext()) == "Yv′ & Gh < 10⁻³"
    y, v, *_ = ET.fromstring(f"<text>{drawn(PRIMED)}</text>")
    assert (y.text, y.get("font-style"), y.get("dy")) == ("Y", "italic", None)
    assert (v.text, v.get("font-style"), v.get("font-size")) == ("v", "italic", "0.72em")


@pytest.mark.parametrize("text", ["Yv'", "Y|v|dr' and G_h", "U^n x", "v'^2 dr'", "C_D_alpha^2"])
def test_a_drawing_comes_back_to_its_line(text):
    level = 0.0
    for part in ET.fromstring(f"<text>{drawn(f'{text} end')}</text>"):
        size = float(part.get("font-size", "1em").removesuffix("em"))
        level += size * float(part.get("dy", "0em").removesuffix("em"))
    assert level == pytest.approx(0.0, abs=0.005)


@pytest.mark.parametrize("control", CONTROLS)
def test_controls_are_seen_and_act_nowhere(control):
    text = f"tow{control}<b>fdp.exe"
    for made in (html(text), cell_html(text), label(text), drawn(text), unit_html(text)):
        assert control not in made
        assert f"U+{ord(control):04X}" in made
    assert "<b>" not in html(text)
    assert "<b>" not in drawn(text)


def test_letters_from_right_to_left_stay_and_are_isolated():
    assert html("שלום") == "<bdi>שלום</bdi>"
    assert cell_html("مرحبا 3 deg") == "<bdi>مرحبا 3°</bdi>"
    assert "bdi" not in html("Größe, β, −1")


@pytest.mark.slow
@given(st.text())
def test_no_text_of_a_user_becomes_markup(text):
    for made in (html(text), cell_html(text), unit_html(text)):
        found = ET.fromstring(f"<p>{made}</p>")
        assert {e.tag for e in found.iter()} <= {"p", "i", "b", "u", "sub", "sup", "bdi"}
        assert {k for e in found.iter() for k in e.attrib} <= {"class"}
    assert {e.tag for e in ET.fromstring(f"<text>{drawn(text)}</text>").iter()} <= {"text", "tspan"}
    assert label(text).replace("\u202f", "").replace("\u00a0", "").isprintable()
