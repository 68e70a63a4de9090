"""Foreign patterns: what Python's own matcher says, in linear time."""

from __future__ import annotations

import re
import time
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.text.patterns import PatternProblem, pattern

PIECES = ["a", "b", ".", "*", "+", "?", "|", "(", ")", "[ab]", "[^a]", "{1,2}", "{2}", "{2,}", "\\w", "\\.", "(?:"]


@settings(max_examples=100)
@given(st.lists(st.sampled_from(PIECES), max_size=8).map("".join), st.text("ab.", max_size=6))
def test_as_python_matches(written: str, text: str) -> None:
    if re.search(r"[*+?}]\+", written):
        return  # Python's possessive marks; in POSIX a repeated repetition
    try:
        theirs = re.compile(written)
    except re.error:
        return
    assert pattern(written).matches(text) == (theirs.fullmatch(text) is not None)


@pytest.mark.parametrize("written", ["(a|aa)+", "(a*)*b", "(a+)+$", "((a{1,9}){1,9}){1,3}"])
def test_what_backtracks_takes_no_time(written: str) -> None:
    begin = time.process_time()
    with suppress(PatternProblem):
        assert not pattern(written).matches("a" * 2000 + "c")
    assert time.process_time() - begin < 1.0


@pytest.mark.parametrize("written", ["(a)\\1", "(?=a)", "a{1000}", "(" * 50, "[a", "a)", "*", "a{2}{2}{2}{2}{2}{2}{2}"])
def test_what_is_not_matched_is_refused(written: str) -> None:
    with pytest.raises(PatternProblem):
        pattern(written)
