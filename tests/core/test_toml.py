from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.toml import Section, read_toml
from coeflab.law.symbols import symbol_at

TEXT = """
name = "n"
empty = " "
yes = true
count = 3
big = 1e3
length = "2 ft"
below = -2.0
point = [1, "2 ft", 3]
words = ["a", "b"]
[inner]
x = 1
[[many]]
y = 2
[[many]]
"""


@pytest.fixture
def root(tmp_path: Path) -> Section:
    (tmp_path / "f.toml").write_text(TEXT)
    return read_toml(tmp_path / "f.toml")


def test_values(root: Section) -> None:
    assert root.text("name") == "n"
    assert root.text("absent", "d") == "d"
    assert root.flag("yes") is True
    assert root.flag("absent", False) is False
    assert root.integer("count", 1, 0, 5) == 3
    assert root.integer("absent", 1, 0, 5) == 1
    assert root.quantity("length", "length") == pytest.approx(0.6096)
    assert root.optional_quantity("absent", "length") is None
    assert root.optional_positive("absent", "length") is None
    np.testing.assert_allclose(root.point("point"), [1.0, 0.6096, 3.0])
    assert root.texts("words") == ("a", "b")
    assert root.texts("absent") == ()
    assert root.section("inner").quantity("x", "none") == 1.0
    assert root.section("absent", required=False).content == {}
    assert [s.name for s in root.sections("many")] == ["many[0]", "many[1]"]


FAULTS: list[tuple[Callable[[Section], object], str]] = [
    (lambda s: s.text("count"), '"count": found "3"; expected a text'),
    (lambda s: s.text("empty"), '"empty": found " "; expected a text'),
    (lambda s: s.text("absent"), '"absent": found nothing; expected a text. Add absent.'),
    (lambda s: s.text("name", choices=("a", "b")), '"name": found "n"; expected "a" or "b"'),
    (lambda s: s.flag("count"), "expected true or false"),
    (lambda s: s.integer("yes", 1, 0, 5), "expected a whole number from 0 to 5"),
    (lambda s: s.integer("big", 1, 0, 5000), "expected a whole number"),
    (lambda s: s.integer("count", 1, 4, 5), "expected a whole number from 4 to 5"),
    (lambda s: s.quantity("yes", "length"), "expected a number in m"),
    (lambda s: s.positive("below", "length"), '"below": found "-2.0"; expected a value above zero'),
    (lambda s: s.point("words"), "a point [x, y, z] in metres"),
    (lambda s: s.triple("words", "mass"), "three numbers [x, y, z] of mass"),
    (lambda s: s.texts("point"), "a list of texts"),
    (lambda s: s.section("name"), "expected a table [name]"),
    (lambda s: s.sections("inner"), "expected tables [[inner]]"),
    (lambda s: s.section("inner").text("x"), '"inner.x"'),
    (lambda s: symbol_at(s, "words", "Qv"), '"words": found "Qv"; expected a SNAME derivative'),
]


@pytest.mark.parametrize(("ask", "said"), FAULTS, ids=range(len(FAULTS)))
def test_faults(root: Section, ask: Callable[[Section], object], said: str) -> None:
    with pytest.raises(InputError) as caught:
        ask(root)
    assert "f.toml" in str(caught.value)
    assert said in str(caught.value)


def test_unread_keys_are_unknown_keys(root: Section) -> None:
    inner = root.section("inner")
    inner.raw("xx")
    with pytest.raises(
        InputError, match=r'"inner.x": found an unknown key; expected one of xx. Did you mean inner.xx\?'
    ):
        inner.finish()
    inner.raw("x")
    inner.finish()


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a = 1\nb = = 2\n", "at line 2, column 5"),
        (b"a = 1\na = 2\n", "a TOML error"),
        (b"a = " + b"[" * 100_000, "valid TOML"),
        (b"a = 1\nb = '\xff'\n", "line 2: found the byte 0xff; expected UTF-8 text"),
        (b"", "found an empty file"),
        (b"a = '\0'", "a TOML error"),
    ],
)
def test_no_toml(tmp_path: Path, content: bytes, said: str) -> None:
    (tmp_path / "f.toml").write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_toml(tmp_path / "f.toml")
    assert said in str(caught.value)


def test_a_bom_is_harmless(tmp_path: Path) -> None:
    (tmp_path / "f.toml").write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert read_toml(tmp_path / "f.toml").content == {"a": 1}
