"""What an import accepted and no source states: it stands in campaign.toml and beside every number that hangs on it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tables.assumptions import CODE, INERTIA, assumed, carried, depends
from coeflab.tables.campaign import read_campaign
from coeflab.tables.raw_table import RawTable, Stated
from coeflab.tables.settings import Setting
from coeflab.tables.settings_in_files import overruled
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.cli.test_import import invoke, without_slopes
from tests.cli.test_import_half import case

__all__ = ["without_slopes"]
KNOWN = ("--set", "axes.frame=FRD", "--set", "axes.reference_point=-1 from nose", "--set", "scaling.length=2 m LOA",
         "--set", "table.contains_inertia=false")  # fmt: skip


def arm(folder: Path, unit: str = "rad/s") -> Path:
    """Turning rows at 1.5 m/s about a point that no word names: Yr' = .006, Nr' = -.004 by L = 2 m."""
    r = np.array([-0.3, -0.2, -0.1, 0.1, 0.2, 0.3])
    y, n = 0.5 * 1000 * 1.5 * 8 * 0.006 * r, -0.5 * 1000 * 1.5 * 16 * 0.004 * r
    shown = np.degrees(r) if unit == "deg/s" else r
    rows = [f"{a:.10g},1.5,{b:.8g},{c:.8g}" for a, b, c in zip(shown, y, n, strict=True)]
    file = folder / "arm.csv"
    file.write_text("\n".join([f"r [{unit}],U [m/s],Y [N],N [N*m]", *rows]) + "\n")
    return file


@pytest.mark.parametrize("unit", ["rad/s", "deg/s"])
def test_an_accepted_point_of_the_arm_stands_beside_every_coefficient_of_it(
    tmp_path: Path, coeflab: Callable[..., object], unit: str
) -> None:
    more = ("--set", "conditions.density=1000")
    done = invoke("import", arm(tmp_path, unit), "--out", tmp_path / "made", *KNOWN, *more, "--accept")
    assert done.exit_code == 0, done.output
    (table,) = read_campaign(tmp_path / "made" / "campaign.toml").tables
    assert table.assumed == ("table.arm_point",)
    found = json.loads(coeflab("fit", "made", "--json").stdout)  # type: ignore[attr-defined]
    flags = {c["symbol"]: c["assumed"] for c in found["coefficients"] if c["value"] is not None}
    assert flags["Yr'"] == flags["Nr'"] == ["table.arm_point"]
    (said,) = [f for f in found["findings"] if f["code"] == CODE]
    assert (said["code"], said["severity"], said["facts"]["symbols"][:2]) == ("assumed.key", "warn", ["Yr'", "Nr'"])
    assert "Yr' *" in coeflab("fit", "made").stdout  # type: ignore[attr-defined]
    assert coeflab("run", "made", "--out", "out").returncode == 0  # type: ignore[attr-defined]
    file = next((tmp_path / "out").glob("*.parameters.json"))
    (kept,) = [f for f in read_parameter_file(file).findings if f.code == CODE]
    assert (kept["key"], kept["symbols"][:2]) == ("table.arm_point", ("Yr'", "Nr'"))
    pages = [f.read_text() for f in (tmp_path / "out").glob("*.html")]
    assert pages
    assert all("table.arm_point" in page for page in pages)
    exported = json.loads(coeflab("export", file, "--to", "csv", "--out", "x", "--json").stdout)  # type: ignore[attr-defined]
    assert any("arm_point" in f["means"] and f["severity"] == "warn" for f in exported["findings"])


@pytest.mark.parametrize(
    ("more", "severity"),
    [
        ((), "warn"),
        (("source.kind=experiment",), "warn"),
        (("inertia.mass=40 kg", "inertia.centre_of_gravity=-1 from nose"), "note"),
        (("source.kind=cfd",), ""),
        (("table.contains_inertia=true", "inertia.mass=40 kg", "inertia.centre_of_gravity=-1 from nose"), ""),
    ],
)
def test_yr_of_a_balance_says_that_no_mass_checks_its_inertia(
    tmp_path: Path, coeflab: Callable[..., object], more: tuple[str, ...], severity: str
) -> None:
    keys = ("conditions.density=1000", "table.arm_point=reference point", *more)
    given = [*KNOWN, *(word for key in keys for word in ("--set", key))]
    assert invoke("import", arm(tmp_path), "--out", tmp_path / "made", *given, "--accept").exit_code == 0
    found = json.loads(coeflab("fit", "made", "--json").stdout)["findings"]  # type: ignore[attr-defined]
    said = {(f["severity"], *f["facts"]["symbols"][:2]) for f in found if f["code"] == INERTIA}
    assert said == ({(severity, "Yr'", "Nr'")} if severity else set())
    assert ("declared free" in coeflab("fit", "made").stdout) is (severity == "warn")  # type: ignore[attr-defined]


def test_a_point_that_a_person_states_is_no_assumption(tmp_path: Path) -> None:
    more = ("--set", "conditions.density=1000", "--set", "table.arm_point=reference point")
    assert invoke("import", arm(tmp_path), "--out", tmp_path / "made", *KNOWN, *more, "--accept").exit_code == 0
    assert read_campaign(tmp_path / "made" / "campaign.toml").tables[0].assumed == ()


def test_only_what_hangs_on_a_key_carries_it() -> None:
    point = assumed("axes.reference_point", "c/t.csv", "x")
    assert [s for s in ("Yv", "Nv", "Yr", "Mw", "Zw", "X0", "Nrdot") if depends(point, s)] == [
        "Nv",
        "Yr",
        "Mw",
        "Nrdot",
    ]
    unit = assumed("columns.dr", "c/t.csv", "deg")
    assert [s for s in ("Ydr", "Yv", "Nvdr") if depends(unit, s)] == ["Ydr", "Nvdr"]
    assert not depends(unit, "Ydr", "c/other.csv")
    assert carried([unit], []) == ()


@pytest.mark.parametrize(
    ("key", "stated", "same", "other"),
    [
        ("table.arm_point", "reference point", [-1.0, 0.0, 0.0], [-2.0, 0.0, 0.0]),
        ("table.contains_inertia", False, False, True),
        ("scaling.length", 2.0, "2000 mm", "2.2 m"),
        ("conditions.speed", 1.5, "1.5 m/s", "3 kn"),
        ("coefficients.area", 0.6, "0.6 m^2", "prime"),
        ("axes.frame", "CFD", ["aft", "starboard", "up"], "FLU"),
    ],
)
def test_a_key_that_the_source_states_cannot_be_overruled(
    key: str, stated: object, same: object, other: object
) -> None:
    raw = RawTable(Path("runs"), (), stated={key: Stated(stated, "0/U:6")})  # type: ignore[arg-type]
    about = {"axes.reference_point": Setting([-1.0, 0.0, 0.0], "confirmed")}
    assert overruled(raw, {**about, key: Setting(same, "confirmed")}) == []
    (why,) = overruled(raw, {**about, key: Setting(other, "confirmed")})
    assert isinstance(why, InputError)
    assert str(stated).casefold() in why.expected.casefold()
    assert "0/U:6" in why.expected
    offered = RawTable(Path("runs"), (), stated={key: Stated(stated, "line 1", offered=True)})  # type: ignore[arg-type]
    assert overruled(offered, {**about, key: Setting(other, "confirmed")}) == []


def test_velocities_at_the_point_of_the_moments_are_not_moved_to_another(tmp_path: Path) -> None:
    frame = "FoamFile {{ format ascii; }}\nMRF1 {{ cellZone all; active yes; origin (0 {} 0); axis (0 0 1); omega constant {}; }}\n"
    for k, radius in enumerate((5.0, 10.0, -5.0)):
        case(tmp_path / f"r{k}", 0.0, cut="", force=np.array([-9.0, 3.0 / radius, 0.0]))
        (tmp_path / f"r{k}/constant/MRFProperties").write_text(frame.format(radius, 1.0 / radius))
    words = ("import", tmp_path, "--set", "axes.frame=FRD", "--set", "scaling.length=1 m LOA")
    done = invoke(*words, "--out", tmp_path / "out", "--set", "table.arm_point=-0.5,0,0", "--accept")
    assert done.exit_code != 0
    assert "reference point" in str(done.exception)
    assert not (tmp_path / "out").exists()
