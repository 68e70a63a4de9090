"""What the front door returns in words names keywords, not options of the shell."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from types import SimpleNamespace
from typing import Any

import coeflab as cf
from coeflab.core.finding import Finding, Severity
from coeflab.core.keywords import in_shell
from coeflab.core.table import Table, as_check

OPTION = re.compile(r"(?<![\w`-])--[a-z]")
COMMAND = re.compile(r"`?coeflab [a-z-]+[^`;]*")


def texts(value: Any, depth: int = 2) -> Iterator[str]:
    """Texts of a value, of its fields, and of what these hold."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple | list):
        for one in value:
            yield from texts(one, depth)
    elif is_dataclass(value) and depth:
        for f in fields(value):
            yield from texts(getattr(value, f.name), depth - 1)


def options(value: Any) -> list[str]:
    return [t for t in texts(value) if OPTION.search(COMMAND.sub("", t))]


def test_tables_and_checks_speak_keywords_in_python_and_options_in_a_shell() -> None:
    table = Table("t", ("a",), (("--hold u",),), ("Tables come first with --tables.",))
    check = as_check(
        "law", Finding.of("law.table_unused", "X", Severity.NOTE, component="X", by=["Xu'"], advice="--tables")
    )
    assert "--" not in str(table)
    assert "--" not in table._repr_html_()
    assert check.spoken().comment == "Tables come first with tables=True."
    with in_shell():
        assert "--tables" in str(table)
        assert "--hold u" in table._repr_html_()
        assert check.spoken() == replace(check)


def test_statements_of_motions_steady_motions_and_vehicles() -> None:
    raw = ("Not used: the table of X. Tables come first with --tables.", "Write `coeflab trim FILE --linear`.")
    held: Any = SimpleNamespace(statements=raw, remarks=raw, narrowed=())
    trim = object.__new__(cf.Trim)
    object.__setattr__(trim, "point", held)
    for found in (cf.Motion(held).statements, cf.Vehicle(held).remarks, trim.statements):
        assert found == (raw[0].replace("--tables", "tables=True"), raw[1])
    with in_shell():
        assert cf.Motion(held).statements == raw


def test_no_shipped_noun_speaks_options() -> None:
    nouns = {
        "table": cf.read_table("suboff_roddy_2"), "vehicle": cf.read_vehicle("huuv").remarks, "compare": cf.compare("remus100", "huuv").statements,
    }  # fmt: skip
    assert {name: options(noun) for name, noun in nouns.items() if options(noun)} == {}
