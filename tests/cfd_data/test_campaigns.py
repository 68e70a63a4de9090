"""The shipped campaigns: hashes, counts, printed values, doubtful cells, and how the tables were converted."""

from __future__ import annotations

import importlib.util
import tomllib
from functools import cache
from types import ModuleType

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.provenance import sha256_of, works
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

CFD_DATA = shipped("cfd_data")
CAMPAIGNS = sorted(p.parent.name for p in CFD_DATA.glob("*/campaign.toml"))
TABLES = [
    (c, t["file"]) for c in CAMPAIGNS for t in tomllib.loads((CFD_DATA / c / "campaign.toml").read_text())["table"]
]
SUBOFF_ROWS = {
    ("suboff_roddy_1", "table.csv"): 64,
    ("suboff_roddy_2", "table.csv"): 60,
    ("suboff_roddy_3", "table.csv"): 24,
    ("suboff_cfd_barehull", "drift.csv"): 9,
    ("suboff_cfd_barehull", "rotating_arm.csv"): 8,
}


@cache
def table(campaign: str, file: str) -> ForceTable:
    return read_tables(PlannedTable(CFD_DATA / campaign, (), only=file))[0]


def test_the_suboff_campaigns_are_there() -> None:
    assert set(SUBOFF_ROWS) <= set(TABLES)


@pytest.mark.parametrize(("campaign", "file"), TABLES)
def test_every_shipped_table(campaign: str, file: str) -> None:
    declared = tomllib.loads((CFD_DATA / campaign / "campaign.toml").read_text())
    (entry,) = [t for t in declared["table"] if t["file"] == file]
    assert entry["sha256"] == sha256_of(CFD_DATA / campaign / file)
    read = table(campaign, file)
    assert len(read) > 0
    assert read.forces
    ours = declared["source"]["kind"] == "cfd" and declared["source"]["citation"].startswith("coeflab tow of ")
    assert declared["source"]["citation"] in works() or ours or declared["source"]["kind"] == "synthetic"
    if declared["source"]["kind"] == "synthetic":
        assert "synthetic" in campaign
        assert "synthetic" in declared["campaign"]["title"].lower()


@pytest.mark.parametrize(("where", "rows"), SUBOFF_ROWS.items())
def test_counts_of_rows(where: tuple[str, str], rows: int) -> None:
    assert len(table(*where)) == rows


@pytest.mark.parametrize(
    ("campaign", "point", "motion", "degrees", "printed"),
    [
        ("suboff_roddy_1", "10", "w", 13.94, {"X": -9.715e-4, "Z": -6.829e-3, "M": 1.621e-3}),
        ("suboff_roddy_1", "14", "w", -1.04, {"X": -1.291e-3, "Z": 4.008e-4, "M": -8.269e-5, "K": 8.821e-6}),
        ("suboff_roddy_2", "67", "v", 0.0, {"X": -1.259e-3, "Y": -7.860e-5, "N": 1.055e-4, "M": 3.709e-5}),
        ("suboff_roddy_2", "78", "v", 16.03, {"X": -1.631e-4, "Y": 1.290e-2, "N": 2.717e-3, "K": 2.298e-4}),
        ("suboff_roddy_3", "164", "v", 18.11, {"X": -6.696e-4, "Y": 7.355e-3, "N": 2.986e-3, "K": -2.101e-6}),
    ],
)
def test_printed_values(campaign: str, point: str, motion: str, degrees: float, printed: dict[str, float]) -> None:
    """Roddy prints primes by LBP; v' = -sin(beta), w' = +sin(alpha)."""
    read = table(campaign, "table.csv")
    row = read.labels.index(point)
    length = 13.9792 * 0.3048
    for component, value in printed.items():
        assert read.primed_force(component, length)[row] == pytest.approx(value, rel=1e-12)
    sign = -1.0 if motion == "v" else 1.0
    assert read.primed_motion(motion, length)[row] == pytest.approx(sign * np.sin(np.radians(degrees)), abs=1e-15)
    assert read.motion["u"][row] == pytest.approx(6.5 * 1852 / 3600 * np.cos(np.radians(degrees)), rel=1e-14)
    assert np.all(read.motion["w" if motion == "v" else "v"] == 0.0)
    assert read.reference_point[0] == pytest.approx(-2.013, abs=5e-5)


def test_signs_make_sense() -> None:
    """Side force opposes sway, the Munk moment turns the bow away from the flow, in towing tank and CFD alike."""
    for where in (
        ("suboff_roddy_2", "table.csv"),
        ("suboff_roddy_3", "table.csv"),
        ("suboff_cfd_barehull", "drift.csv"),
    ):
        read = table(*where)
        straight = (
            np.all([a == 0.0 for a in read.controls.values()], axis=0) if read.controls else np.full(len(read), True)
        )
        v = read.motion["v"]
        assert np.polyfit(v[straight], read.forces["Y"][straight], 1)[0] < 0.0
        assert np.polyfit(v[straight], read.forces["N"][straight], 1)[0] < 0.0
    arm = table("suboff_cfd_barehull", "rotating_arm.csv")
    assert np.polyfit(arm.motion["r"], arm.forces["N"], 1)[0] < 0.0
    assert np.polyfit(arm.motion["r"], arm.forces["Y"], 1)[0] > 0.0
    assert np.all(arm.motion["v"] == 0.0)
    vertical = table("suboff_roddy_1", "table.csv")
    straight = vertical.controls["ds"] == 0.0
    z, m = (vertical.forces[c][straight] for c in "ZM")
    assert np.polyfit(vertical.motion["w"][straight], z, 1)[0] < 0.0
    assert np.polyfit(vertical.motion["w"][straight], m, 1)[0] > 0.0


def test_cfd_by_hand() -> None:
    drift = table("suboff_cfd_barehull", "drift.csv")
    row = 4
    assert drift.motion["v"][row] == pytest.approx(-2.0 * np.sin(np.radians(8.0)))
    assert (drift.forces["Y"][row], drift.forces["N"][row], drift.errors["Y"][row]) == (49.166, 276.91, 0.34)
    assert drift.primed_force("Y", 4.26086)[row] == pytest.approx(49.166 / (0.5 * 998 * 4 * 4.26086**2))
    assert [e.reason for e in drift.exclusions] == ["grid B: grid study only", "grid C: grid study only"]
    arm = table("suboff_cfd_barehull", "rotating_arm.csv")
    assert arm.primed_motion("r", 4.26086)[1] == pytest.approx(0.1 * 4.26086 / 2.0)
    assert list(arm.usable["N"]) == [True] * 6 + [False] * 2
    assert [f["key"] for f in arm.findings] == ["table.arm_point"]


@pytest.mark.parametrize("campaign", ["suboff_roddy_1", "suboff_roddy_2", "suboff_roddy_3"])
def test_doubtful_cells_are_excluded_with_their_reasons(campaign: str) -> None:
    read = table(campaign, "table.csv")
    lines = (CFD_DATA / campaign / "table.csv").read_text().splitlines()
    header = [h.partition("'")[0].partition(" ")[0] for h in lines[0].split(",")]
    expected = {}
    for number, line in enumerate(lines[1:], start=2):
        cells = line.split(",")
        for name in cells[-1].split():
            blank = not cells[header.index(name)]
            expected[number, name] = "blank in the source" if blank else 'digit doubtful in the source ("uncertain")'
    assert expected
    assert {(e.line, e.component): e.reason for e in read.exclusions} == expected
    for (line, name), reason in expected.items():
        assert not read.usable[name][line - 2]
        assert np.isnan(read.forces[name][line - 2]) == (reason == "blank in the source")
    unusable = sum(int(np.sum(~mask)) for mask in read.usable.values())
    assert unusable == len(expected)


@pytest.fixture(scope="module")
def converter() -> ModuleType:
    path = CFD_DATA / "convert_suboff.py"
    spec = importlib.util.spec_from_file_location("convert_suboff", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


SOURCE = """# a transcription
point,deltar_deg,beta_deg,X,Y,uncertain
80,0,18.07,-2.811E-4,1.536E-2,YX
81,0,18.06,nan,1.520E-2,X
82,0,1.00,-1E-4,1E-3,
"""


def test_conversion_touches_no_number(converter: ModuleType) -> None:
    assert converter.converted(SOURCE) == (
        "point,delta_r [deg],beta [deg],X' [-],Y' [-],uncertain\n"
        "80,0,18.07,-2.811E-4,1.536E-2,Y X\n"
        "81,0,18.06,,1.520E-2,X\n"
        "82,0,1.00,-1E-4,1E-3,\n"
    )
    cfd = "beta [deg],grid,Y [N]\n2,A,8.4902\n"
    assert converter.converted(cfd) == cfd


def test_hashes_are_entered_under_their_table(converter: ModuleType) -> None:
    text = 'file = "a.csv"\nsha256 = ""\nsource_sha256 = ""\n\nfile = "b.csv"\nsha256 = "0"\nsource_sha256 = "1"\n'
    changed = converter.with_hashes(text, "b.csv", "aa", "bb")
    assert changed == text.replace('"0"', '"bb"').replace('"1"', '"aa"')
    with pytest.raises(SystemExit, match=r"no place for the hashes of c\.csv"):
        converter.with_hashes(text, "c.csv", "aa", "bb")


def test_conversion_of_a_folder(converter: ModuleType, tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    source, here = tmp_path / "source", tmp_path / "here"
    for _, folder, _ in converter.JOBS:
        (here / folder).mkdir(parents=True, exist_ok=True)
    (source / "cfd").mkdir(parents=True)
    for name, folder, file in converter.JOBS:
        (source / name).write_text(SOURCE)
        with (here / folder / "campaign.toml").open("a") as stream:
            stream.write(f'file = "{file}"\nsha256 = ""\nsource_sha256 = ""\n')
    monkeypatch.setattr(converter, "HERE", here)
    converter.main(source)
    for name, folder, file in converter.JOBS:
        text = (here / folder / "campaign.toml").read_text()
        assert f'sha256 = "{sha256_of(here / folder / file)}"\nsource_sha256 = "{sha256_of(source / name)}"' in text
