"""Lists of OpenFOAM dictionaries that foamlib would cut in every way there is: read at once, and as foamlib reads short ones."""

from __future__ import annotations

import pytest
from foamlib import FoamFile

from coeflab.core.text import foam


@pytest.mark.parametrize("digits", [12, 20, 400])
def test_a_long_number_before_a_word_takes_no_time(digits: int) -> None:
    """foamlib 1.7 takes 13 s for 22 digits, and twice as long for each more."""
    number = "1." + "3" * digits
    assert foam._value(f"({number} 2 wall)") == [float(number), 2, "wall"]
    assert foam._value(f"({number} (2 3) )") == [float(number), [2, 3]]


@pytest.mark.parametrize(
    "text",
    [
        "(1 2 wall)",
        "(0.5 (2 3) b)",
        "((0 1) (1 b))",
        "table ((0 1.5) (1 x))",
        "3(a b c)",
        '(1 "a b" 0)',
        "(1e-3 -2.5 +4 b)",
        "(p.x wall_0)",
    ],
)
def test_short_lists_are_those_of_foamlib(text: str) -> None:
    value = FoamFile.loads(f"x {text};".encode())["x"]  # type: ignore[index]
    assert foam._list_of_all_sorts(text) == foam._plain(value) == foam._value(text)


@pytest.mark.parametrize("text", ["(1.23456789012345 [0 1])", "(1.23456789012345 {a})"])
def test_what_is_no_list_of_numbers_and_words_has_no_value(text: str) -> None:
    assert foam._value(text) is None
