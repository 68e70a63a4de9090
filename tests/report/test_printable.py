from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.report.printable import BREAK, STEP, WORD, breakable, glyphs, runs_to_the_left, shortened, visible


def test_a_short_text_is_left_alone():
    assert breakable("suboff_roddy_2") == "suboff_roddy_2"
    assert shortened("two  words\n", 20) == "two words"


def test_a_long_word_breaks_after_separators_first():
    assert breakable("suboff_cfd_barehull/rotating_arm.csv").split(BREAK)[:3] == ["suboff_", "cfd_", "barehull/"]


@given(st.text(), st.integers(2, 40))
def test_shortening_keeps_the_beginning(text, longest):
    out = shortened(text, longest)
    assert len(out) <= longest
    assert " ".join(text.split()).startswith(out.removesuffix("…"))


@given(st.text(alphabet=st.characters(exclude_characters=BREAK, exclude_categories=["M"]), min_size=WORD))
def test_no_long_word_is_left_and_nothing_else_changes(text):
    out = breakable(text)
    assert out.replace(BREAK, "") == text
    assert all(len(part) <= max(STEP, WORD) for word in out.split() for part in word.split(BREAK))


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("Yv′ α β ṙ −5", "Yv′ α β ṙ −5"),
        ("a\u202eb", "aU+202Eb"),
        ("rocket 🚀", "rocket U+1F680"),
        ("船\x07", "U+8239U+0007"),
    ],
)
def test_what_the_fonts_lack_is_named(text, shown):
    assert glyphs(text) == shown


def test_right_to_left_letters_that_the_fonts_have_stay():
    assert glyphs("שלום مرحبا") == "שלום مرحبا"


@pytest.mark.parametrize("ch", ["\u202e", "\u2066", "\u200b", "\u00ad", "\x07", "\ud800", "\ue000"])
def test_characters_without_a_shape_are_seen(ch):
    assert visible(f"a{ch}b") == f"aU+{ord(ch):04X}b"


def test_letters_of_all_scripts_and_unbroken_spaces_stay():
    text = "Größe שלום 船体 x\u0307 1\u202f×\u00a02 🚢"
    assert visible(text) == text
    assert visible("a\u2028b\tc") == "a b c"


def test_some_scripts_run_to_the_left():
    assert runs_to_the_left("hull שלום")
    assert runs_to_the_left("مرحبا")
    assert not runs_to_the_left("Größe 船体 −1")
