"""Names of people as names of files, functions and classes."""

from __future__ import annotations

import pytest

from coeflab.core.wording import file_stem, identifier, matlab, python


@pytest.mark.parametrize("name", ["sin", "class", "end", "max", "sqrt", "remus100", "npsauv", "Sin", "m2c"])
def test_functions_of_matlab_are_not_hidden(name: str) -> None:
    assert identifier(name, matlab()) == f"vehicle_{name}"


@pytest.mark.parametrize("name", ["class", "print", "None", "match", "math", "numpy", "random", "self"])
def test_words_of_python_are_not_hidden(name: str) -> None:
    assert identifier(name, python()) == f"vehicle_{name}"


@pytest.mark.parametrize("name", ["con", "NUL", "com1"])
def test_devices_of_windows_are_no_names(name: str) -> None:
    assert identifier(name) == f"vehicle_{name}"
    assert file_stem(name).startswith(f"vehicle_{name}_")


@pytest.mark.parametrize("name", ["suboff_bare_hull", "my vehicle 2", "a-b.c+d", "schiff_\u00fc"])
def test_plain_names_are_stems_as_they_are(name: str) -> None:
    assert file_stem(name) == name


def test_other_names_are_made_plain_and_kept_apart() -> None:
    hostile = [
        "../a",
        "..\\a",
        "a/",
        ".a",
        "a ",
        "a\nb",
        "a\u200db",
        "\U0001f6a2",
        "x" * 10_000,
        "x" * 10_001,
        "\u8239" * 80,
        "",
    ]
    stems = [file_stem(name) for name in hostile]
    assert len(set(stems)) == len(hostile)
    assert all(s.isascii() and s.isidentifier() and len(s) <= 63 for s in stems)
    assert stems == [file_stem(name) for name in hostile]
    assert file_stem("../a") == "a_61b4c98b"
