"""Plain assignments of .m files; identifiers."""

from __future__ import annotations

import keyword
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.wording import identifier, one_line
from coeflab.formats.mss.assignments import assignments


def pairs(text: str) -> list[tuple[int, str, str]]:
    return [(a.line, a.target, a.expression) for a in assignments(text)]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("a = 1; b=2, c = 3", [(1, "a", "1"), (1, "b", "2"), (1, "c", "3")]),
        ("a = [1, 2;\n 3, 4]; b = 5", [(1, "a", "[1, 2;  3, 4]"), (2, "b", "5")]),
        ("a = 1 + ... tail\n  2;\nb = 3", [(1, "a", "1 +    2"), (3, "b", "3")]),
        ("a = 1 % b = 2\n# c = 3\nd = 4", [(1, "a", "1"), (3, "d", "4")]),
        ("%{\na = 1\n%{\nb = 1\n%}\n%}\nc = 2", [(7, "c", "2")]),
        ("s = 'a; b = 1 % x'; c = x'; d = [1 2]'; e = 2", [(1, "s", "'a; b = 1 % x'"), (1, "c", "x'"), (1, "d", "[1 2]'"), (1, "e", "2")]),
        ('s = "a; b = 1"; c = 2', [(1, "s", '"a; b = 1"'), (1, "c", "2")]),
        ("if a == 1, b = 2; end", [(1, "b", "2")]),
        ("h.x.y = 3; f(2) = 4; [a, b] = g(1)", [(1, "h.x.y", "3")]),
        ("\n\n", []),
    ],
)  # fmt: skip
def test_assignments(text: str, found: list[tuple[int, str, str]]) -> None:
    assert pairs(text) == found


def test_quoted_texts() -> None:
    assert [a.quoted for a in assignments("a = 'it''s'; b = 2; c = 'x' + 1")] == ["it's", None, None]


@given(st.text(max_size=80))
def test_any_text_is_read(text: str) -> None:
    assert all(a.expression for a in assignments(text))


@given(st.text(max_size=80))
def test_any_name_becomes_an_identifier(text: str) -> None:
    name = identifier(text, frozenset(keyword.kwlist))
    assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,62}", name)
    assert not keyword.iskeyword(name)
    assert one_line(text).isprintable()


@pytest.mark.parametrize(
    ("text", "name"),
    [("suboff bare-hull", "suboff_bare_hull"), ("", "vehicle"), ("2x", "vehicle_2x"), ("for", "vehicle_for")],
)
def test_identifiers(text: str, name: str) -> None:
    assert identifier(text, frozenset({"for"})) == name
