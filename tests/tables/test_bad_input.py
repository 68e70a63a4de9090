"""Whatever a person hands in gives one clear error that says where, what, what instead, and what to do."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from coeflab.core.errors import AxesError, CoeflabError, InputError, UnitsError
from coeflab.tables.campaign import read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.conftest import SECTIONS

Read = Callable[..., ForceTable]
Write = Callable[..., Path]


def refused(read: Callable[[], object], *said: str, kind: type[CoeflabError] = InputError) -> str:
    with pytest.raises(CoeflabError) as caught:
        read()
    assert isinstance(caught.value, kind)
    message = str(caught.value)
    for line in message.split("\n"):
        assert "found " in line
        assert len(line) < 800
    for text in said:
        assert text in message, message
    return message


GOOD = "beta [deg],Y [N]\n"
ROWS = [
    ("", ["table.csv: found an empty file", "expected a header line with units"]),
    ("# only a comment\n", ["comments only"]),
    (GOOD, ["line 2: found a header and no rows", "rows of numbers"]),
    (GOOD + ",\n,\n", ["line 2: found a header and no rows"]),
    (GOOD + "1,nan\n", ['line 2, column "Y [N]"', 'found "nan"', "expected a finite number", '"uncertain"']),
    (GOOD + "1,1\n2,inf\n", ['line 3, column "Y [N]"', 'found "inf"', "expected a finite number"]),
    (GOOD + "1,1\n2,-Infinity\n", ['line 3, column "Y [N]"', 'found "-Infinity"']),
    (GOOD + "1,five\n", ['line 2, column "Y [N]"', 'found "five"', "expected a finite number"]),
    (GOOD + "1,1e400\n", ['line 2, column "Y [N]"', 'found "1e400"', "expected a finite number"]),
    (GOOD + "1,-0.01327?\n", ['found "-0.01327?"', 'name the column under "uncertain"']),
    (GOOD + "1,1_000\n", ['found "1_000"']),
    (GOOD + '1,"1,5"\n', ['found "1,5"', "Write a point for the decimals"]),
    ("beta [deg],Y [kN]\n1,1e307\n", ['line 2, column "Y [kN]"', 'found "1e307"', "1e+18 in SI units"]),
    ("beta [deg],Y [N],Y [kN]\n1,1,1\n", ["line 1", 'found the column "Y" twice', "expected every column once"]),
    ("beta [deg],Y [N],Y' [-]\n1,1,1\n", ["line 1", "found Y [N] and Y' [-]", "expected one of them"]),
    ("beta [deg],Y [N],\n1,1,\n", ["line 1", "header of column 3", 'column names such as "Y [N]"']),
    (GOOD + "1,1\n2\n", ["line 3: found 1 cell;", "expected 2 as in the header"]),
    (GOOD + "1,1,9\n2,2\n", ["line 2: found 3 cells", "expected 2 as in the header"]),
    (GOOD + "1,1,\n2,2,\n", ["line 2: found 3 cells"]),
    (GOOD + "1,1\n\n2,2\n", ["line 3: found an empty line", "expected 2 cells", "Remove it"]),
    ("beta [deg];Y [N]\n1;1\n", ["line 1: found semicolons between columns", "expected commas", "Save"]),
    ("beta [deg]\tY [N]\n1\t1\n", ["line 1: found tabs between columns", "expected commas"]),
    (GOOD + "1;1\n", ["line 2: found 1 cell;", "semicolons; write commas"]),
    (GOOD + '1,"1\n2,2\n', ["line 2", "a row that cannot be read", "quotation mark that is not closed"]),
    (GOOD + '1,"1\n"\n2,2\n', ["line 2", "a line break inside quotation marks"]),
    ('"beta [deg],Y [N]\n1,1\n', ["line 1", "a header that cannot be read"]),
    ("beta,Y [N]\n1,1\n", ["line 1", 'column "beta"', "a header without unit", 'such as "beta [deg]"']),
    ("v' [-],N\n0,1\n", ["line 1", 'column "N"', 'such as "N [N*m]"']),
    ("v',N [N*m]\n0,1\n", ['column "v\'"', 'such as "v\' [-]"']),
    ("beta [deg],Z (N)\n1,1\n", ['the unknown column "Z (N)"', "expected one of alpha, beta, U"]),
    ("beta [deg],torque [N]\n1,1\n", ["line 1", 'the unknown column "torque [N]"', "labels or ignore"]),
    ("beta [deg],point\n1,1\n", ["line 1: found no force column", "at least one of X Y Z K M N"]),
    ("beta [rad],Y [N]\n1,1\n4,1\n", ["line 3", 'column "beta [rad]"', "angle of 4 rad", "half a turn", "beta [deg]"]),
    ("delta_r [rad],Y [N]\n15,1\n", ["line 2", 'column "delta_r [rad]"', "write delta_r [deg]"]),
    ("U [m/s],Y [N]\n1,1\n0,1\n", ["line 3", 'column "U [m/s]"', "a speed of 0 m/s", "a speed above zero"]),
    ("U [m/s],Y [N]\n,1\n", ["line 2", 'column "U [m/s]"', "a blank cell", "a speed above zero"]),
    ("beta [deg],v [m/s],Y [N]\n1,1,1\n", ["line 1", "angles and v", "one or the other"]),
]


@pytest.mark.parametrize(("csv", "said"), ROWS, ids=range(len(ROWS)))
def test_tables(read_table: Read, csv: str, said: list[str]) -> None:
    refused(lambda: read_table(csv), "table.csv", *said)


UNITS = [
    ("Y [smoot]", ['the unknown unit "smoot"', "a unit of force, such as N"]),
    ("Y [N*m]", ["[N*m], a unit of another dimension", "a unit of force"]),
    ("N [N]", ["[N], a unit of another dimension", "a unit of moment"]),
    ("N [N*m/deg]", ["[N*m/deg]", "a unit of moment"]),
    ("Y [lb]", ["[lb], a unit of another dimension"]),
    ("Y [-]", ["found [-]", "a unit of force", "nondimensional (prime) form write Y' [-]"]),
    ("Y []", ["found []", "a unit of force"]),
    ("Y' [N]", ["a pure number", "A primed column has the unit [-]", "write Y [...]"]),
    ("Y [N*]", ['the unreadable unit "N*"']),
    ("Y [(N]", ['the unreadable unit "(N"']),
    ("Y [9**9**9]", ['the unreadable unit "9**9**9"']),
    ("Y [N^9^9^9]", ['the unreadable unit "N^9^9^9"']),
    ("Y [__import__('os')]", ["the unreadable unit", "__import__"]),
    (f"Y [{'N' * 10_000}]", ["the unreadable unit", "NNN..."]),
    ("r [1/s]", ["found [1/s]", "a unit of rate", "Write rad/s, deg/s or rpm"]),
    ("r [Hz]", ["found [Hz]", "Write rad/s, deg/s or rpm"]),
    ("alpha [-]", ["found [-]", "a unit of angle, such as rad or deg"]),
    ("alpha [steradian]", ["found [steradian]", "a unit of angle"]),
    ("Y' [dB]", ["a pure number"]),
]


@pytest.mark.parametrize(("header", "said"), UNITS, ids=[u[0][:20] for u in UNITS])
def test_units(read_table: Read, header: str, said: list[str]) -> None:
    start = time.perf_counter()
    message = refused(lambda: read_table(f"beta [deg],{header}\n1,1\n"), "table.csv, line 1, column", *said)
    assert time.perf_counter() - start < 5.0
    assert f'column "{header[:10]}' in message


RAW = [
    (b"beta [deg],Y [\xb5N]\n1,1\n", ["line 1", "the byte 0xb5", "UTF-8 text", "Save the file as UTF-8"]),
    (GOOD.encode() + b"1,1\n2,2\n3,3\n4,\xff\n", ["line 5", "the byte 0xff", "Save the file as UTF-8"]),
    (("﻿" + GOOD + "1,1\n").encode("utf-16-le"), ["line 1", "UTF-16 text", "Save the file as UTF-8"]),
    ((GOOD + "1,1\n").encode("utf-16-be"), ["line 1", "binary content"]),
    (GOOD.encode() + b"1,1\0\n", ["line 2", "binary content (a NUL byte)"]),
    (b"beta\0 [deg],Y [N]\n1,1\n", ["line 1", "binary content (a NUL byte)"]),
    ((GOOD + "1,1\n").replace("\n", "\r").encode(), ["line 1", "a carriage return", "Unix or Windows line ends"]),
    (GOOD.encode() + b"1,1\r2,2\r", ["line 2", "a carriage return"]),
    (b"\x1b[31mbeta [deg],Y [N]\n1,1\n", ["line 1", "\\x1b"]),
    (bytes(range(1, 256)) * 50, ["line 1"]),
]


@pytest.mark.parametrize(("content", "said"), RAW, ids=range(len(RAW)))
def test_bytes_that_are_no_csv(read_table: Read, content: bytes, said: list[str]) -> None:
    message = refused(lambda: read_table(content), "table.csv", *said)
    assert message.isprintable()


def test_header_of_100_000_columns(read_table: Read) -> None:
    header = ",".join(f"c{i} [N]" for i in range(100_000))
    refused(lambda: read_table(header + "\n"), "line 1", "a line longer than 65536 bytes", "expected a CSV table")


@pytest.mark.parametrize("kind", ["sparse binary", "one line", "many lines", "blank lines"])
def test_200_megabytes_of_something_else(write_campaign: Write, kind: str) -> None:
    folder = write_campaign(GOOD)
    with (folder / "table.csv").open("ab") as stream:
        if kind == "sparse binary":
            stream.truncate(200_000_000)
        else:
            block = {"one line": b"lorem ipsum ", "many lines": b"lorem, ipsum, dolor\n", "blank lines": b"\n"}[kind]
            block *= 1_000_000 // len(block)
            for _ in range(200):
                stream.write(block)
    said = {
        "sparse binary": ["line 2", "binary content"],
        "one line": ["line 2", "a line longer than"],
        "many lines": ["line 2", "3 cells"],
        "blank lines": ["1001 empty lines", "Remove them"],
    }[kind]
    tracemalloc.start()
    start = time.perf_counter()
    refused(lambda: read_tables(PlannedTable(folder, ())), "table.csv", *said)
    seconds, peak = time.perf_counter() - start, tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    (folder / "table.csv").unlink()
    assert seconds < 2.0
    assert peak < 100e6


def test_a_time_series_is_no_table_of_steady_forces(read_table: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.core.text.delimited.CSV_CELLS", 1000)
    assert len(read_table(GOOD + "1,1\n" * 500)) == 500
    refused(lambda: read_table(GOOD + "1,1\n" * 501), "line 502", "more than 1000 cells", "Average time series first")


def test_places_without_a_table(write_campaign: Write, tmp_path: Path) -> None:
    folder = write_campaign()
    (folder / "table.csv").unlink()
    refused(lambda: read_tables(PlannedTable(folder, ())), "table.csv: found no such file; expected a CSV file")
    (folder / "table.csv").mkdir()
    refused(lambda: read_tables(PlannedTable(folder, ())), "table.csv: found a folder; expected a CSV file")
    (folder / "campaign.toml").unlink()
    refused(lambda: read_tables(PlannedTable(folder, ())), "no campaign.toml in", "declares axes", "coeflab new")
    refused(lambda: read_tables(PlannedTable(tmp_path / "nowhere", ())), "no campaign.toml in")
    refused(lambda: read_campaign(tmp_path / "nowhere" / "campaign.toml"), "no such file", "a file that exists")
    refused(lambda: read_campaign(tmp_path), "found a folder; expected a file")


def in_axes(old: str, new: str) -> dict[str, str]:
    assert old in SECTIONS["axes"]
    return {"axes": SECTIONS["axes"].replace(old, new)}


CAMPAIGNS: list[tuple[dict[str, str], list[str]]] = [
    (
        in_axes('beta = "v = -U sin(beta)"\n', ""),
        ['"axes.beta"', "no declared sign", '"v = +U sin(beta)"', "two signs"],
    ),
    (in_axes('"v = -U sin(beta)"', '"positive"'), ['"axes.beta"', 'found "positive"']),
    (in_axes('"v = -U sin(beta)"', "-1"), ['"axes.beta"', 'found "-1"', "a text"]),
    (in_axes('"FRD"', '["forward", "port", "down"]'), ['"axes.frame"', "left-handed axes", "usually mean FLU"]),
    (in_axes('"FRD"', '["forward", "aft", "down"]'), ['"axes.frame"', "right angles"]),
    (in_axes('"FRD"', '"NED"'), ['"axes.frame"', 'found "NED"', '"FRD", "FLU", "CFD"']),
    (in_axes('frame = "FRD"\n', ""), ['"axes.frame"', '"FRD", "FLU", "CFD"']),
    (in_axes("[-2.0, 0.0, 0.0]", "[1, 2]"), ['"axes.reference_point"', "a point [x, y, z] in metres"]),
    (in_axes("[-2.0, 0.0, 0.0]", '["1 kg", 2, 3]'), ['"axes.reference_point"', "a unit of length"]),
    ({"conditions": "speed = 0\ndensity = 1000"}, ['"conditions.speed"', 'found "0"', "above zero"]),
    ({"conditions": "speed = 2\ndensity = -1000"}, ['"conditions.density"', 'found "-1000"', "above zero"]),
    ({"conditions": "speed = 2"}, ['"conditions.density"', "found nothing", "a density", "Add conditions.density"]),
    ({"conditions": "speed = true\ndensity = 1000"}, ['"conditions.speed"', 'found "True"', "a number in m/s"]),
    ({"conditions": "speed = inf\ndensity = 1000"}, ['"conditions.speed"', 'found "inf"', "a finite number"]),
    ({"conditions": 'speed = "2 kg"\ndensity = 1000'}, ['"conditions.speed"', "[kg], a unit of another dimension"]),
    ({"conditions": 'speed = "fast"\ndensity = 1000'}, ['"conditions.speed"', 'found "fast"', '"2.5 m/s"']),
    ({"conditions": f"speed = 1{'0' * 400}\ndensity = 1000"}, ['"conditions.speed"', "a finite number"]),
    ({"conditions": f'speed = "{"1" * 5000}\\n"\ndensity = 1000'}, ['"conditions.speed"']),
    ({"scaling": "length = 0\nlength_name = 'L'"}, ['"scaling.length"', "above zero"]),
    ({"scaling": "lenght = 4.0\nlength_name = 'L'"}, ['"scaling.length"', "found nothing"]),
    (
        {"scaling": SECTIONS["scaling"] + "\nlengthname = 'L'"},
        ["scaling.lengthname", "Did you mean scaling.length_name?"],
    ),
    ({"campaign": 'title = 7\nbody = "b"'}, ['"campaign.title"', 'found "7"', "expected a text"]),
    ({"campaign": SECTIONS["campaign"] + '\nhalf_model = "yes"'}, ['"campaign.half_model"', "true or false"]),
    ({"source": 'citation = "c"\nkind = "guess"'}, ['"source.kind"', 'found "guess"', '"experiment" or "cfd"']),
    ({"table": "contains_inertia = 1"}, ['"table[0].contains_inertia"', "true or false"]),
    ({"table": "labels = [1]"}, ['"table[0].labels"', "a list of texts"]),
    ({"table": "colour = 1"}, ['"table[0].colour"', "an unknown key"]),
    ({"inertia": "mass = -1\ncentre_of_gravity = [0, 0, 0]\ninertia = [1, 1, 1]"}, ['"inertia.mass"', "above zero"]),
    (
        {"inertia": "mass = 1\ncentre_of_gravity = [0, 0, 0]\ninertia = [1, 1]"},
        ['"inertia.inertia"', "three numbers [x, y, z] of inertia"],
    ),
    ({"inertia": "mass = 1\ncentre_of_gravity = [0, 0, 0]\ninertia = [1, 'x', 1]"}, ['"inertia.inertia"', 'found "x"']),
    ({"root": "surprise = 1\n"}, ['"surprise"', "an unknown key"]),
    ({"root": "a = = 1\n"}, ["a TOML error", "line 1", "valid TOML"]),
    ({"root": "table = 3\n[[other]]\n"}, ["a TOML error"]),
    ({"root": "a = " + "[" * 5000 + "\n"}, ["valid TOML"]),
    ({"source": 'citation = "c"'}, ['"source.kind"', "found nothing"]),
    ({"source": ""}, ['"source"', "found nothing", "a table", "Add source"]),
]


@pytest.mark.parametrize(("pieces", "said"), CAMPAIGNS, ids=range(len(CAMPAIGNS)))
def test_campaigns(read_table: Read, pieces: dict[str, str], said: list[str]) -> None:
    refused(lambda: read_table(**pieces), "campaign.toml", *said)


def test_moments_of_inertia_may_be_absent_only_of_rows_that_turn_about_one_axis(read_table: Read) -> None:
    more = {"inertia": "mass = 2000\ncentre_of_gravity = [-1.9, 0.1, 0]", "table": "contains_inertia = true"}
    one = "beta [deg],q [rad/s],r [rad/s],Y [N],N [N*m]\n1,0,0.2,1,1\n1,0.2,0,1,1\n"
    whole = more | {"inertia": more["inertia"] + "\ninertia = [3, 20, 30]"}
    alone, known = (read_table(one, **said).forces for said in (more, whole))
    assert all(alone[n].tolist() == known[n].tolist() for n in alone)
    two = one.replace("1,0,0.2", "1,0.1,0.2")
    refused(lambda: read_table(two, **more), "campaign.toml", "inertia.inertia", "found no inertia", "two axes at once")


def test_kinds_of_errors(read_table: Read) -> None:
    refused(lambda: read_table("beta [m],Y [N]\n1,1\n"), kind=UnitsError)
    refused(lambda: read_table(**in_axes('"FRD"', '["forward", "port", "down"]')), kind=AxesError)


def test_campaign_that_is_no_text(write_campaign: Write) -> None:
    path = write_campaign() / "campaign.toml"
    text = path.read_bytes()
    path.write_bytes(text + b"# caf\xe9\n")
    line = text.count(b"\n") + 1
    refused(lambda: read_campaign(path), f"campaign.toml, line {line}", "the byte 0xe9", "Save the file as UTF-8")
    path.write_bytes(b" \n")
    refused(lambda: read_campaign(path), "found an empty file")
    path.write_bytes(b"#" * (1 << 21))
    refused(lambda: read_campaign(path), "2097152 bytes", "at most 1048576 bytes")
    path.write_text("[campaign]\ntitle = 'x'\n")
    refused(lambda: read_campaign(path), '"axes"', "found nothing")


def test_campaign_without_a_table(write_campaign: Write) -> None:
    path = write_campaign() / "campaign.toml"
    path.write_text(path.read_text().partition("[[table]]")[0])
    refused(lambda: read_campaign(path), '"table"', "no [[table]]", 'Add [[table]] with file = "table.csv"')
