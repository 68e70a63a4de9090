"""``coeflab params new --from``: sheets of coefficients that people keep."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.vehicle.coefficient_list import read_coefficient_list, with_sheet
from coeflab.vehicle.own_numbers import typed_file
from tests.cli.test_import import invoke
from tests.tables.test_excel import rows, workbook

SI = "name,value,unit,U95\nm,46,kg,\nYv,-120.5,N/(m/s),6\nN_v,-40,N*m/(m/s) constant,\nKv,0.4,N*m/(m/s),\nXu|u|,-3.2,N/(m/s)^2,\n"
PRIMES = "Coefficient;Value;+/-\nYv';-0,0278;0,0014\nNr';-0,0044;\n"


def sheet(folder: Path, text: str, axes: str = "FRD") -> dict[str, tuple[float, float | None, bool, str]]:
    (folder / "sheet.csv").write_text(text)
    found = read_coefficient_list(folder / "sheet.csv", axes).numbers
    return {n.symbol: (n.value, n.u95, n.si, n.over_speed) for n in found}


def test_a_row_a_symbol_with_units_and_u95(tmp_path: Path) -> None:
    assert sheet(tmp_path, SI) == {
        "Yv'": (-120.5, 6.0, True, ""), "Nv'": (-40.0, None, True, "constant"), "Kv'": (0.4, None, True, ""),
        "Xu|u|'": (-3.2, None, True, ""),
    }  # fmt: skip
    assert read_coefficient_list(tmp_path / "sheet.csv", "FRD").left[0] == "m (line 2, no derivative)"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (PRIMES, {"Yv'": (-0.0278, 0.0014, False, ""), "Nr'": (-0.0044, None, False, "")}),
        ("symbol,prime\nY_v,-0.0278\n", {"Yv'": (-0.0278, None, False, "")}),
        ("symbol,value,unit\nYv,-0.0278,1\n", {"Yv'": (-0.0278, None, False, "")}),
        ("symbol,SI\nYv,-35.5\n", {"Yv'": (-35.5, None, True, "")}),
        ("Yv',Nr'\n-0.0278,-0.0044\n", {"Yv'": (-0.0278, None, False, ""), "Nr'": (-0.0044, None, False, "")}),
    ],
)
def test_primes_of_sheets(tmp_path: Path, text: str, found: dict[str, tuple[float, float | None, bool, str]]) -> None:
    assert sheet(tmp_path, text) == found


def test_flu_turns_roll_by_drift_and_nothing_of_the_planes(tmp_path: Path) -> None:
    turned = sheet(tmp_path, SI + "Zw|w|,-9,N/(m/s)^2,\nYp,2,N/(rad/s),\nZ0,1.5,N,\nNuv,-7,N*m/(m/s)^2,\n", "FLU")
    assert {s: v[0] for s, v in turned.items()} == {
        "Yv'": -120.5, "Nv'": -40.0, "Kv'": -0.4, "Xu|u|'": -3.2, "Zw|w|'": -9.0, "Yp'": -2.0, "Z0'": -1.5, "Nuv'": -7.0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("text", "axes", "said"),
    [
        ("name,value\nYv,-0.03\n", "FRD", "line 2: found Yv with neither a prime nor a unit"),
        ("name,low,high\nYv',-0.03,-0.02\n", "FRD", 'columns of numbers "low" and "high"'),
        ("name,value\na,1\nb,2\n", "FRD", "no column of symbols"),
        ("name,value,unit\nYv,-30,kg\n", "FRD", 'line 2: found Yv with the unit "kg"'),
        ("name,value,unit\nYv',-30,N/(m/s)\n", "FRD", "beside the prime Yv'"),
        ("name,value,unit\nYdr,3,N/deg\n", "FLU", "found Ydr' in FLU"),
        (PRIMES, "", "no axes"),
        (PRIMES, "CFD", "FRD or FLU"),
    ],
)
def test_what_a_sheet_leaves_open_is_asked(tmp_path: Path, text: str, axes: str, said: str) -> None:
    with pytest.raises(InputError) as why:
        sheet(tmp_path, text, axes)
    assert said in str(why.value)


def test_a_spreadsheet_becomes_a_parameter_file_with_its_hash_and_what_is_left(tmp_path: Path) -> None:
    cells = (("Parameter", "Value", "Unit"), ("Iz", 12, "kg*m^2"), ("Yv", -25.5, "N/(m/s)"), ("Nr", -8, "N*m/(rad/s)"))
    book = workbook(tmp_path / "book.xlsx", Model=rows(*cells), Old=rows(*cells))
    known = (
        "--about",
        "cg",
        "--length",
        "2.5 m",
        "--speed",
        "1.5 m/s",
        "--density",
        "1000",
        "--axes",
        "FRD",
        "--out",
        tmp_path,
    )
    done = invoke("params", "new", "mine", "--from", book, "--option", "sheet=Model", "--set", "Nv'=-0.001", *known)
    assert done.exit_code == 0, done.output
    assert "not taken of book.xlsx: Iz (line 2, no derivative)" in " ".join(done.output.split())
    with pytest.raises(InputError):
        read_coefficient_list(book, "FRD")
    found = read_coefficient_list(book, "FRD", {"sheet": "Model"})
    file = typed_file("mine", found.numbers, length="2.5 m", length_name="LOA", speed="1.5", density="1000", about="cg")
    written = with_sheet(file, found, book)
    assert [c.value for c in written.coefficients] == pytest.approx([-25.5 / 4687.5, -8.0 / 29296.875])
    assert written.provenance.inputs[0].name == "book.xlsx"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("symbol,value,unit,U95 [%]\nYv,-3500,N/(m/s),5\n", (-3500.0, 175.0)),
        ("symbol,SI,unit\nNr,-30,N*m/(deg/s)\n", (-30.0 * 180.0 / np.pi, None)),
        ("symbol,value,page\nYv',-0.0300±0.0020,12\n", 'columns of numbers "page"'),
        ("symbol,1000 x value\nYv',-30\n", 'columns of numbers "1000 x value"'),
        ("symbol,value [-],unit\nYv,-0.03,N/(m/s)\n", 'the unit "N/(m/s)" beside values in "-"'),
        ("symbol,value,unit,U95 [kN/(m/s)]\nYv,-3500,N/(m/s),5\n", "U95 in"),
    ],
)
def test_units_of_a_sheet_do_not_contradict_each_other(tmp_path: Path, text: str, found: Any) -> None:
    (tmp_path / "own.csv").write_text(text, encoding="utf-8")
    if isinstance(found, str):
        with pytest.raises(InputError, match=re.escape(found)):
            read_coefficient_list(tmp_path / "own.csv", "FRD")
        return
    number = read_coefficient_list(tmp_path / "own.csv", "FRD").numbers[0]
    assert number.value == pytest.approx(found[0])
    assert number.u95 == (None if found[1] is None else pytest.approx(found[1]))


def test_columns_beside_symbols_over_one_row_are_named(tmp_path: Path) -> None:
    (tmp_path / "own.csv").write_text("Yv',Yv' U95,Nv',comment\n-0.03,0.002,-0.01,hello\n", encoding="utf-8")
    assert read_coefficient_list(tmp_path / "own.csv", "FRD").left == ("columns Yv' U95, comment",)
