"""OpenFOAM dictionaries: values, scopes of macros, arithmetic, what is not followed, and time that grows with length."""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.foam import FoamCase
from coeflab.core.text.foam_values import value_of


def case_of(folder: Path, files: Mapping[str, str]) -> FoamCase:
    for name, text in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return FoamCase(folder)


def codes(case: FoamCase) -> list[str]:
    return [f.code for f in case.findings]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("(1 2 wall)", [1, 2, "wall"]),
        ("((0 1) (1 b))", [[0, 1], [1, "b"]]),
        ("table ((0 1.5) (1 x))", ("table", [[0, 1.5], [1, "x"]])),
        ("3 ( a b c )", ["a", "b", "c"]),
        ("List<word> 1(wall)", ["wall"]),
        ('(1 "a b" 0)', [1, '"a b"', 0]),
        ("(1e-3 -2.5 +4 b)", [1e-3, -2.5, 4, "b"]),
        ("uniform (1 2 3)", [1, 2, 3]),
        ("nu [0 2 -1 0 0 0 0] 1e-06", 1e-6),
        ("[0 2 -1 0 0 0 0] 1e-06", 1e-6),
        ("1.1e-6 [m^2/s]", 1.1e-6),
        ("30 [rpm]", math.pi),
        ("180 [deg/s]", math.pi),
        ("(36 0 0) [km/hr]", [10.0, 0.0, 0.0]),
        ("5 [furlong]", None),
        ("[0 2 -1 0 0 0 0]", None),
        ("1e999", math.inf),
        ("yes", True),
        ("(1 2", None),
        ("1 2)", None),
        ("(" * 5000 + ")" * 5000, None),
        ("(1." + "3" * 400 + " 2 wall)", [4 / 3, 2, "wall"]),
    ],
)
def test_values(text: str, value: object) -> None:
    assert value_of(text) == (pytest.approx(value) if isinstance(value, float) else value)


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("$x", 2),
        ("$:x", 1),
        ("$!x", 1),
        ("$.x", 3),
        ("$..x", 2),
        ("$../x", 2),
        ("$...x", 1),
        ("${x}", 3),
        ("$y", 5),
        ("$other.x", 7),
        ("$:other/x", 7),
        ("(#neg $y 0 $x)", [-5, 0, 3]),
        ("#neg 2.5", -2.5),
        ('#calc "-$y*cos(degToRad(60))"', -2.5),
        ('#calc "$y/2.0"', 2.5),
        ('#calc "4/2"', 2),
        ('#calc "vector(-$y, 0, 2*$x)"', [-5, 0, 6]),
        ('#calc "Foam::sqrt(16.0) + std::pow(2, 3) - M_PI + constant::mathematical::pi"', 12.0),
        ("#calc #{ $y + 1 #}", 6),
        ("#eval{ $y / 2 }", 2.5),
        ('#eval "1/4"', 0.25),
        ("${{ 2*$y }}", 10),
        ('#calc "1/4"', None),  # zero in C++
        ('#calc "system(1)"', None),
        ('#calc "mesh().V()"', None),
        ('#calc "1/0.0"', None),
        ("#codeStream { code #{ os << 1; #}; }", None),
        ("$nowhere", None),
        ("#neg hull", None),
    ],
)
def test_macros_and_arithmetic(tmp_path: Path, written: str, value: Any) -> None:
    text = "x 1; y 5; other { x 7; }\na { x 2; b { x 3;\nasked " + (written if written != "$x" else "$z") + ";\n} }\n"
    text = text.replace("b { x 3", "z $x; b { x 3")
    case = case_of(tmp_path, {"d": text})
    found = case.value(case.read("d"), "a", "b", "asked")
    if value is None:
        assert found is None
        assert next(f["place"] for f in case.findings) == "d:3"
    else:
        assert found == (pytest.approx(value), "d:3")
        assert not case.notes


def test_a_macro_is_what_it_was_where_it_stands(tmp_path: Path) -> None:
    case = case_of(tmp_path, {"d": "x 1; a $x; x 2; b $x;"})
    assert [case.value(case.read("d"), n)[0] for n in "ab"] == [1, 2]  # type: ignore[index]


def test_dictionaries_are_taken_over_whole(tmp_path: Path) -> None:
    case = case_of(tmp_path, {"d": "base { type a; sub { k 1; } } one { $base; type b; } two $base; base { type c; }"})
    top = case.read("d")
    assert case.value(top, "one", "type") == ("b", "d:1")
    assert case.value(top, "one", "sub", "k") == (1, "d:1")
    assert case.value(top, "two", "type") == ("a", "d:1")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("a { x 1; } }\nb 2;", "foam.stray"),
        ("}\na { x 1; }\nb 2;", "foam.stray"),
        ("a { x 1; }\nb 2; )", "foam.stray"),
        ("b 2; a { x 1; ", "foam.unclosed"),
    ],
)
def test_a_stray_brace_survives_with_a_remark(tmp_path: Path, text: str, code: str) -> None:
    case = case_of(tmp_path, {"d": text})
    top = case.read("d")
    assert case.value(top, "a", "x") == (1, "d:" + str(1 + text[: text.index("x 1")].count("\n")))
    assert case.value(top, "b") is not None
    assert codes(case) == [code]


@pytest.mark.parametrize("text", ["a (1 2; }", "a [0 1) 2;", "a 1; /* b 2;", "a {" * 40, "a (" * 40])
def test_brackets_that_do_not_match_are_refused_with_their_line(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match="d, line 2"):
        case_of(tmp_path, {"d": "\n" + text}).read("d")


def test_files_of_the_case_alone_are_included(tmp_path: Path) -> None:
    (tmp_path / "outside").write_text("secret 1;")
    inside = tmp_path / "case"
    case = case_of(
        inside,
        {
            "0/U": '#include "include/initial"\n#include "../../outside"\n#include "/etc/hostname"\n#includeIfPresent "none"\n'
            '#include "link"\n#includeEtc "caseDicts/x"\n#include "none"\n$:FoamFile;\nvalue $speed;\n',
            "0/include/initial": "speed 3;",
        },
    )
    (inside / "0/link").symlink_to(tmp_path / "outside")
    top = case.read("0/U")
    assert list(top.entries) == ["speed", "value"]
    assert case.value(top, "value") == (3, "0/U:9")
    assert codes(case) == [
        "foam.outside",
        "foam.outside",
        "foam.outside",
        "foam.directive",
        "foam.missing",
        "foam.dictionary",
    ]
    assert case.files == [inside / "0/U", inside / "0/include/initial"]


def test_the_original_of_a_file_is_read_where_it_stands_alone(tmp_path: Path) -> None:
    case = case_of(tmp_path, {"0/U.orig": "x 1;"})
    assert case.value(case.read("0/U"), "x") == (1, "0/U.orig:1")


def test_of_a_field_the_list_is_passed_over(tmp_path: Path) -> None:
    rows = "(1 2 3)\n" * 100_000
    text = (
        f"internalField nonuniform List<vector>\n100000\n(\n{rows})\n;\n// nonuniform List<scalar> of nothing\nk 1;\n"
    )
    case = case_of(tmp_path, {"U": text})
    top = case.read("U")
    assert case.value(top, "k") == (1, "U:100007")
    assert case.value(top, "internalField") is None


HOSTILE = {
    "empty values": "b ;" + "".join(f"a{i} " + f"$a{i - 1} " * 900 + ";" for i in range(1, 12)) + "a0 ;",
    "copies": "d0 { x 1; y 2; } " + "".join(f"d{i} {{ a {{ $d{i - 1}; }} b {{ $d{i - 1}; }} }} " for i in range(1, 40)),
    "lists": "x nonuniform List<v>(" * 5000 + ";",
    "macros": "x " + "${" * 60_000 + ";",
    "texts": 'x "' * 60_000,
    "comments": "/*" * 100_000 + "*/",
    "dots": "x $" + "a." * 2000 + ";" + "y 1;" * 1000,
    "digits": "x " + "9" * 4000 + '; y #calc "' + "9*" * 1500 + '9"; z #calc "pow(9,9e9)";',
    "brackets": 'x #calc "' + "(" * 4000 + '";',
    "blanks": "x" + " " * 200_000 + ";",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_time_grows_with_length(tmp_path: Path, name: str) -> None:
    case = case_of(tmp_path, {"d": HOSTILE[name]})
    gc.freeze()  # what other tests of this process hold is not searched for garbage: 2 s of it for .1 s of reading
    begin = time.process_time()
    try:
        top = case.read("d")
        for key in list(top.entries if top is not None else ())[-20:]:
            case.value(top, key)
    except InputError:
        pass
    spent = time.process_time() - begin
    gc.unfreeze()
    assert spent < 1.5


def test_includes_of_includes_end(tmp_path: Path) -> None:
    files = {f"f{i}": f'#include "f{i + 1}"\n' * 300 for i in range(11)} | {"f11": "x 1;"}
    begin = time.process_time()
    with pytest.raises(InputError, match="includes without end"):
        case_of(tmp_path, files).read("f0")
    assert time.process_time() - begin < 1.5
