"""One validator: every complaint of a file in one message, each with line and key."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest

from coeflab.core.declarations import (
    ABOVE_ZERO,
    Anything,
    Declaration,
    Flag,
    Length,
    OrEmpty,
    Point,
    Pure,
    Text,
    Texts,
    Words,
    declared,
    numbers,
    one_of,
)
from coeflab.core.errors import MOST_LISTED, InputError, UnitsError
from coeflab.core.text.toml import read_toml


@dataclass(frozen=True, slots=True, kw_only=True)
class Inner(Declaration):
    """A table.

    Attributes
    ----------
    low, high : float
        Ends.
    class : str
        A word of Python.
    """

    low: Length
    high: Length = 9.0
    class_: Words = ""

    def check(self) -> None:
        if self.low > self.high:
            raise InputError(f"{self.low:g}", "no more than high", column="low")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outer(Declaration):
    """A file."""

    name: Text
    title: Words = ""
    yes: Flag = False
    depth: Annotated[Length, ABOVE_ZERO] | None = None
    point: Point | None = None
    sizes: Annotated[tuple[float, ...], numbers(2, "mass", "two masses")] | None = None
    words: Texts = ()
    kind: Annotated[str, one_of("round", "flat")] = "round"
    notes: Anything = None
    by_name: dict[str, Annotated[Pure, ABOVE_ZERO]] = field(default_factory=dict)
    inner: Inner
    spare: Annotated[Inner | None, OrEmpty()] = None
    many: tuple[Inner, ...] = ()


GOOD = """\
name = "n"
yes = true
depth = "2 ft"
point = [1, "2 ft",
  3]
sizes = ["1 g", 2]
words = ["a", "b"]
notes = { any = [1, "thing"] }
by_name = { a = 1.0, "b.c" = 2 }

[inner]
low = 1
class = "x"

[spare]

[[many]]
low = 2

[[many]]
low = "3 ft"  # the second
"""


def read(folder: Path, text: str) -> Outer:
    (folder / "f.toml").write_text(text)
    return declared(Outer, read_toml(folder / "f.toml"))


def test_values(tmp_path: Path) -> None:
    file = read(tmp_path, GOOD)
    assert (file.name, file.title, file.yes, file.words, file.kind) == ("n", "", True, ("a", "b"), "round")
    assert file.depth == pytest.approx(0.6096)
    np.testing.assert_allclose(file.point, [1.0, 0.6096, 3.0])  # type: ignore[arg-type]
    assert file.sizes == (1e-3, 2.0)
    assert file.notes == {"any": [1, "thing"]}
    assert file.by_name == {"a": 1.0, "b.c": 2.0}
    assert (file.inner.low, file.inner.class_, file.spare) == (1.0, "x", None)
    assert [m.low for m in file.many] == [2.0, pytest.approx(0.9144)]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('name = "n"', "name = 3", 'line 1, "name": found "3"; expected a text.'),
        ('name = "n"', 'name = " "', 'line 1, "name": found " "; expected a text.'),
        ('name = "n"', "", '"name": found nothing; expected a text. Add name.'),
        ('name = "n"', 'nam = "n"\nname = "n"', "expected one of by_name, depth, inner, kind, many, name"),
        ("yes = true", "yes = 1", 'line 2, "yes": found "1"; expected true or false.'),
        ("2 ft", "2 kg", 'line 3, "depth": found [kg], a unit of another dimension; expected a unit of length'),
        ('"2 ft"\n', "true\n", "expected a number in m or a text with its unit"),
        ('"2 ft"\n', "-2.0\n", 'line 3, "depth": found "-2.0"; expected a value above zero.'),
        ('"2 ft"\n', "inf\n", 'found "inf"; expected a finite number'),
        ("  3]", "]", 'line 4, "point": found "[1, \'2 ft\']"; expected a point [x, y, z] in metres'),
        ('["1 g", 2]', '["1 m", 2]', 'line 6, "sizes": found [m], a unit of another dimension'),
        ('["a", "b"]', "[1]", 'line 7, "words": found "[1]"; expected a list of texts.'),
        ("yes = true", 'kind = "rond"', 'line 2, "kind": found "rond"; expected "round" or "flat".'),
        ("a = 1.0", "a = -1.0", 'line 9, "by_name.a": found "-1.0"; expected a value above zero.'),
        ('"b.c" = 2', '"b.c" = 0', 'line 9, "by_name.b.c": found "0"'),
        ("low = 1\n", "", 'line 11, "inner.low": found nothing; expected a length. Add inner.low.'),
        ('class = "x"', 'clas = "x"', 'line 13, "inner.clas": found an unknown key; expected one of class, high, low. '
         "Did you mean inner.class?"),
        ('class = "x"', 'class_ = "x"', 'line 13, "inner.class_": found an unknown key'),
        ("[inner]", "[hinner]", '"inner": found nothing; expected a table. Add inner.'),
        ("[inner]", "[[inner]]", 'line 11, "inner": found "[{\'low\': 1, \'class\': \'x\'}]"; expected a table [inner].'),
        ("low = 1\n", "low = 1\nhigh = 0\n", 'line 12, "inner.low": found 1; expected no more than high.'),
        ("[[many]]\nlow = 2\n\n[[many]]", "[many]", 'line 17, "many": found "{'),
        ('"3 ft"', '"3 s"', 'line 21, "many[1].low": found [s]'),
        ('"3 ft"', '"3 ft"\nhigh = 0', 'line 21, "many[1].low": found 0.9144; expected no more than high.'),
    ],
)  # fmt: skip
def test_one_complaint(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in GOOD
    with pytest.raises(InputError) as caught:
        read(tmp_path, GOOD.replace(old, new, 1))
    assert any(line.startswith(str(tmp_path / "f.toml")) and said in line for line in caught.value.lines), caught.value


def test_all_complaints_in_one_message_by_line(tmp_path: Path) -> None:
    spoiled = (
        GOOD.replace("2 ft", "2 kg", 1).replace("true", "3").replace("low = 2", "lwo = 2").replace("low = 1\n", "")
    )
    with pytest.raises(UnitsError) as caught:
        read(tmp_path, spoiled.replace("yes = 3\n", "").replace("low = 1", "low = 1"))
    with pytest.raises(InputError) as caught:
        read(tmp_path, spoiled)
    assert [line.partition(": found")[0].removeprefix(f"{tmp_path}/f.toml, ") for line in caught.value.lines] == [
        'line 2, "yes"', 'line 3, "depth"', 'line 11, "inner.low"', 'line 16, "many[0].low"', 'line 17, "many[0].lwo"',
    ]  # fmt: skip
    assert str(caught.value) == "\n".join(caught.value.lines)


def test_a_file_full_of_faults_says_so_in_a_few_lines(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, GOOD + "[[many]]\nlow = true\n" * 1000)
    assert len(caught.value.lines) == MOST_LISTED + 2
    assert caught.value.lines[-1] == f"{1000 - 1 - MOST_LISTED} more"


@pytest.mark.parametrize("value", ['"""\na\n\nb"""', "'''\n[inner]\n'''", "[\n  1, # one\n\n  2,\n]", "{ a = 1 }"])
def test_lines_behind_values_of_any_form(tmp_path: Path, value: str) -> None:
    text = f"\n\nname = 1\nnotes = {value}\n[ 'inner' ]\nlow = 3 # three\n\n[[many]]\nclass = 1\n[[many]]\nlow = 1"
    (tmp_path / "f.toml").write_text(text)
    file = read_toml(tmp_path / "f.toml")
    places: list[tuple[Any, ...]] = [("name",), ("notes",), ("inner", "low"), ("many", 0, "class"), ("many", 1, "low")]
    lines = text.split("\n")
    found = [lines[(file.line(place) or 0) - 1] for place in places]
    assert found == ["name = 1", f"notes = {value}".split("\n")[0], "low = 3 # three", "class = 1", "low = 1"]
