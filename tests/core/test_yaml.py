"""YAML: plain data, and numbers as their writers meant them."""

from __future__ import annotations

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.yaml import number, parse_yaml


@pytest.mark.parametrize(
    ("text", "value"),
    [("1e-3", 1e-3), ("1E6", 1e6), ("-.5", -0.5), ("+2.", 2.0), ("3", 3.0), ("6.02e+23", 6.02e23), ("'7'", 7.0)],
)
def test_numbers_as_meant(text: str, value: float) -> None:
    assert number(parse_yaml(f"a: {text}")["a"]) == value


@pytest.mark.parametrize("text", ["yes", "null", "[1]", ".inf", ".nan", "1e999", "0x10z", "1,5", "2001-01-01", "a"])
def test_no_numbers(text: str) -> None:
    assert number(parse_yaml(f"a: {text}")["a"]) is None


@pytest.mark.parametrize("key", ["X", "Y", "N", "y", "n"])
def test_letters_stay_letters(key: str) -> None:
    """YAML 1.1 has y and n for truth values; the reader does not."""
    assert parse_yaml(f"{key}: 1") == {key: 1}


def test_an_error_has_its_line() -> None:
    with pytest.raises(InputError) as caught:
        parse_yaml("a: 1\nb: !!python/name:os.system x\n", "m.yml")
    assert caught.value.line == 2
    with pytest.raises(InputError) as caught:
        parse_yaml("a:\n  - {b: 1,\n     b: 2}\n", "m.yml")
    assert caught.value.line == 3


def test_equal_keys_of_different_mappings_are_fine() -> None:
    assert parse_yaml("a: {x: 1, y: [{x: 2}, {x: 3}]}\nx: {a: 1}") == {
        "a": {"x": 1, "y": [{"x": 2}, {"x": 3}]},
        "x": {"a": 1},
    }
