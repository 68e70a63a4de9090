"""Tables as lines that fit: what folds, what goes, what goes on below."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.table import Table, as_printed, folded, percent, set_lines
from coeflab.core.wording import Verbatim

WORDS = st.lists(st.text("abcxyz_.", min_size=1, max_size=20), max_size=8).map(" ".join)
TABLES = st.integers(1, 7).flatmap(
    lambda n: st.builds(
        Table, WORDS, st.tuples(*[WORDS] * n), st.lists(st.tuples(*[WORDS] * n), min_size=1, max_size=5).map(tuple),
        st.lists(WORDS, max_size=3).map(tuple), st.frozensets(st.integers(0, n - 1)),
    )
)  # fmt: skip


def texts(table: Table, width: int) -> list[str]:
    return [line.text for line in set_lines(table, width)]


def test_a_table_that_fits_is_set_as_it_is() -> None:
    table = Table("T", ("", "value", "U95"), (("Yv'", "-0.0262", "0.0027"), ("Nv'", "-0.0147", "0.0019")), ("note",))
    assert texts(table, 40) == [
        "T", "         value     U95", "  Yv'  -0.0262  0.0027", "  Nv'  -0.0147  0.0019", "  note",
    ]  # fmt: skip


def test_text_folds_first_then_columns_go_in_their_order_and_are_named() -> None:
    row = ("Yv'", "-0.0262", "a sentence about how this was found", "12345", "67890")
    table = Table("T", ("", "value", "how", "b", "c"), (row,), (), frozenset({0, 2}), ("c", "b"))
    assert "Not shown" not in "".join(texts(table, 60))
    assert texts(table, 45)[-1] == "  Not shown: c; --wide shows all."
    assert texts(table, 40)[-1] == "  Not shown: c, b; --wide shows all."
    assert "67890" in "".join(texts(table, 200))


def test_what_still_does_not_fit_goes_on_below_and_nothing_is_lost() -> None:
    names = [f"column{i}" for i in range(12)]
    table = Table("T", ("", *names), (("first", *[f"{i}.2345" for i in range(12)]),))
    lines = texts(table, 40)
    assert max(map(len, lines)) <= 40
    assert lines.count("  more:") == 3
    assert all(name in " ".join(lines) for name in names)
    assert all(f" {i}.2345" in " ".join(lines) for i in range(12))


def test_what_goes_on_below_keeps_the_texts_that_tell_its_rows_apart() -> None:
    names = [f"column{i}" for i in range(8)]
    rows = tuple((force, campaign, *[f"{i}.2345" for i in range(8)]) for force in "YZ" for campaign in ("tank", "all"))
    lines = texts(Table("T", ("", "campaign", *names), rows, (), frozenset({0, 1})), 40)
    below = lines[lines.index("  more:") :]
    assert below[2].split()[:2] == ["Y", "tank"]
    assert below[3].split()[:2] == ["Y", "all"]
    assert max(map(len, lines)) <= 40


def test_what_all_rows_say_goes_below() -> None:
    rows = tuple((f"row{i}", "a/very/long/name/of/a/table.csv", "0.1234567", "0.1234567") for i in range(3))
    table = Table("T", ("", "table", "x", "y"), rows, (), frozenset({0, 1}))
    assert texts(table, 50)[-1] == "  All rows: table a/very/long/name/of/a/table.csv"
    assert texts(table, 80)[-1].startswith("  row2")


def test_a_number_keeps_its_unit_and_a_path_stays_whole() -> None:
    assert folded("found 10.5 % and 9.97 deg", 13) == ["found 10.5 %", "and 9.97 deg"]
    assert folded("value 0.12 +- 0.03 here", 12) == ["value", "0.12 +- 0.03", "here"]
    path = "/a/path/that/is/longer/than/a/line"
    assert folded(f"written to {path}", 20) == ["written to", path]


@given(TABLES, st.integers(50, 90))
def test_no_line_is_too_long_and_no_word_is_lost(table: Table, width: int) -> None:
    lines = texts(table, width)
    numbers = [c for row in table.rows for i, c in enumerate(row) if i not in table.left and len(c) > width // 2 - 6]
    if not numbers:  # a cell of numbers is never folded
        assert max(map(len, lines), default=0) <= width
    seen = set(" ".join(lines).split())
    for i, row in product(range(len(table.headers)), table.rows):
        assert set(row[i].split()) <= seen


@pytest.mark.parametrize(
    ("part", "of", "shown"),
    [
        (0.5, 1.0, "50.0 %"),
        (142.017, 1.0, "> 100 %"),
        (1.01, 1.0, "> 100 %"),
        (0.998, 1.0, "99.8 %"),
        (1.6e-7, -0.0027, "< 0.1 %"),
        (0.0, 1.0, "0.0 %"),
        (5.1e-4, 1.0, "0.1 %"),
        (1.0, 0.0, "-"),
    ],
)
def test_a_share_has_no_more_digits_than_it_means(part: float, of: float, shown: str) -> None:
    assert percent(part, of) == shown


@pytest.mark.parametrize(
    ("value", "printed"),
    [
        (0.0052, "0.0052"),
        (-0.01391, "-0.01391"),
        (-0.027834, "-0.027834"),
        (0.004, "0.0040"),
        (1.2e-6, "1.20e-06"),
        (None, "-"),
    ],
)
def test_a_published_coefficient_has_the_digits_of_its_source(value: float | None, printed: str) -> None:
    """0.005200 stood beside two digits of uncertainty."""
    assert as_printed(value) == printed


def test_a_zero_has_no_sign_but_in_a_users_own_text() -> None:
    cells = ("-0", "-0.00 .. 0.3", "-0.0012", "-0e+00 deg", "2020-01-0", "run-0")
    table = Table("T", tuple("abcdefg"), ((*cells, Verbatim("-0")),))
    assert table.rows == (("0", "0.00 .. 0.3", "-0.0012", "0e+00 deg", "2020-01-0", "run-0", "-0"),)
