from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core import errors
from coeflab.core.errors import CoeflabError, InputError, shown


def test_message_says_where_what_what_instead_and_what_to_do() -> None:
    why = InputError("5", "6", file=Path("a/b.csv"), line=3, column="Y [N]", advice="Count again.")
    assert str(why) == 'a/b.csv, line 3, column "Y [N]": found 5; expected 6. Count again.'
    assert why.args == (str(why),)


@pytest.mark.parametrize(
    ("place", "head"),
    [
        ({}, "found"),
        ({"file": "f"}, "f: found"),
        ({"file": "f", "column": "a.b"}, 'f, "a.b": found'),
        ({"column": "a.b"}, '"a.b": found'),
        ({"file": "f", "line": 2}, "f, line 2: found"),
    ],
)
def test_places(place: dict[str, object], head: str) -> None:
    assert str(InputError("x", "y", **place)) == f"{head} x; expected y."  # type: ignore[arg-type]


def test_one_tree() -> None:
    classes = [c for c in vars(errors).values() if isinstance(c, type) and issubclass(c, Exception)]
    assert len(classes) == 7
    assert all(issubclass(c, CoeflabError) for c in classes)
    assert errors.__doc__ is not None
    assert all(c.__name__ in errors.__doc__ for c in classes)


@pytest.mark.parametrize("text", ["a\nb", "\x1b[31m", "é" * 500, "\0", "a" * 10_000, "\u202e"])
def test_found_values_are_cut_and_harmless(text: str) -> None:
    quoted = shown(text)
    assert quoted.isprintable()
    assert len(quoted) <= 65
    assert (quoted[0], quoted[-1]) == ('"', '"')
