"""Lists of oscillating runs: what is declared about them, and every complaint by file, line and column."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits.planar_motion import fit
from coeflab.tables.campaign import FILE
from coeflab.tables.importers import IMPORTERS, PlannedTable
from coeflab.tables.planar_motion import PlanarMotionTable
from coeflab.tables.reading import read_tables, suited_fit
from tests.fits.oscillating import law


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The sway runs and one of roll of the shipped campaign."""
    here = shipped("cfd_data") / "pmm_synthetic"
    shutil.copytree(here, tmp_path / "pmm")
    lines = (here / "runs.csv").read_text().splitlines()
    keep = [lines[0], *(line for line in lines if line.startswith(("sway_", "roll_1")))]
    (tmp_path / "pmm" / "runs.csv").write_text("\n".join(keep) + "\n")
    declared = (here / FILE).read_text().splitlines()
    kept = [line for line in declared if not line.startswith("sha256")]
    (tmp_path / "pmm" / FILE).write_text("\n".join(kept) + "\n")
    return tmp_path / "pmm"


def read(folder: Path) -> PlanarMotionTable:
    (table,) = read_tables(PlannedTable(folder, ()))
    assert isinstance(table, PlanarMotionTable)
    return table


def edited(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_shipped_files_are_what_the_script_makes() -> None:
    made = law().files()
    for name, content in made.items():
        assert (shipped("cfd_data") / name).read_bytes() == content, name
    assert sum(map(len, made.values())) < 200_000


def test_rows_are_means_that_no_steady_fit_uses(folder: Path) -> None:
    table = read(folder)
    assert len(table) == 7
    assert not any(np.any(mask) for mask in table.usable.values())
    assert table.labels[0] == "sway_1"
    assert table.components == ("Y", "K", "N")
    assert suited_fit(folder) == "planar_motion"
    assert suited_fit(shipped("cfd_data") / "suboff_roddy_2") == "slope_at_origin"


def test_a_list_of_runs_is_recognised_and_a_table_is_not(folder: Path, tmp_path: Path) -> None:
    pmm = IMPORTERS.load("pmm")
    assert pmm.recognises(folder / "runs.csv")
    assert not pmm.recognises(folder / "runs" / "sway_1.csv")
    assert not pmm.recognises(folder)
    (tmp_path / "odd").write_bytes(b"\xff\xfe\x00file")
    assert not pmm.recognises(tmp_path / "odd")


def test_axes_do_not_change_the_result(folder: Path) -> None:
    """The same runs in FLU: y, Y, N and psi flip, K and phi do not."""
    frd = read(folder)
    edited(folder / FILE, 'frame = "FRD"', 'frame = "FLU"')
    for file in (folder / "runs").glob("*.csv"):
        head, *rows = file.read_text().splitlines()
        names = [c.partition(" [")[0] for c in head.split(",")]
        sign = [-1.0 if n in ("y", "psi", "Y", "N", "z", "theta", "Z", "M") else 1.0 for n in names]
        turned = [",".join(f"{s * float(x):.6g}" for s, x in zip(sign, row.split(","), strict=True)) for row in rows]
        file.write_text("\n".join([head, *turned]) + "\n")
    flu = read(folder)
    assert "axes turned from FLU to FRD" in flu.notes
    one, other = (fit([t], t.scaling, {}).coefficients for t in (frd, flu))
    for a, b in zip(one.coefficients, other.coefficients, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-9)


@pytest.mark.parametrize(("frame", "turn"), [("FRD", 1.0), ("FLU", -1.0)])
def test_a_motion_that_is_declared_only_gives_the_same(folder: Path, frame: str, turn: float) -> None:
    """y = amplitude sin(2 pi f t + phase) in the list, no column y in the file; to port y is turned."""
    whole = read(folder)
    run = whole.runs[0]
    t, y = run.record.time, turn * run.record.displacements["y"]
    sin, cos = np.linalg.lstsq(np.column_stack([np.sin(run.omega * t), np.cos(run.omega * t)]), y, rcond=None)[0]
    forces = np.column_stack([t, turn * run.record.forces["Y"], turn * run.record.forces["N"]])
    rows = [",".join(f"{x:.9g}" for x in row) for row in forces]
    (folder / "runs" / "sway_1.csv").write_text("\n".join(["t [s],Y [N],N [N*m]", *rows]) + "\n")
    (folder / "runs.csv").write_text(
        "run,file,motion,frequency [Hz],y [m],phase [deg]\nsway_1,runs/sway_1.csv,sway,0.238732,"
        f"{np.hypot(sin, cos):.8g},{np.degrees(np.arctan2(cos, sin)):.8g}\n"
    )
    edited(folder / FILE, 'frame = "FRD"', f'frame = "{frame}"')
    one, other = (fit([t], t.scaling, {}).coefficients for t in (read(folder), replace(whole, runs=whole.runs[:1])))
    for symbol in ("Yv", "Yvdot", "Nv", "Nvdot"):
        assert one[symbol].value == pytest.approx(other[symbol].value, rel=2e-3), symbol


COMPLAINTS: list[tuple[str, str, str, str]] = [
    (FILE, "contains_inertia = true", "# nothing", "contains_inertia"),
    (FILE, "mass = ", "# mass = ", "mass"),
    (FILE, "\ninertia = ", "\n# inertia = ", "oscillating model is accelerated"),
    (FILE, "[planar_motion]", "[planar_motions]", "planar_motion"),
    (FILE, "Butterworth 2, 2 Hz", "Bessel 2, 2 Hz", "Butterworth 4, 5 Hz"),
    (FILE, '"Butterworth 2, 2 Hz"', '"lag 170 deg"', "at most 90 deg"),
    (FILE, ', motion = "none"', "", "no filter of motion"),
    (FILE, "filter = { forces", "filter = { force", "the channel"),
    (FILE, "restoring = ", "# restoring = ", "roll runs without restoring"),
    ("runs.csv", "sway_1,runs/sway_1.csv,sway", "sway_1,runs/sway_1.csv,swing", "one of sway, heave"),
    ("runs.csv", "0.238732", "0", "no frequency above zero"),
    ("runs.csv", "frequency [Hz]", "frequency [rad/s]", "unit of frequency"),
    ("runs.csv", "runs/sway_1.csv", "../sway_1.csv", "beside the list of runs"),
    ("runs.csv", "runs/sway_1.csv", "runs/sway_9.csv", "no file"),
    ("runs.csv", "run,file", "name,file", "unknown column"),
    ("runs/sway_1.csv", "t [s]", "time [s]", "unknown column"),
    ("runs/sway_1.csv", "y [m]", "y [deg]", "another dimension"),
    ("runs/sway_1.csv", "0.174533,", "0,", "a time that rises"),
]


@pytest.mark.parametrize(("file", "old", "new", "said"), COMPLAINTS)
def test_complaints(folder: Path, file: str, old: str, new: str, said: str) -> None:
    edited(folder / file, old, new)
    with pytest.raises(InputError, match=said) as why:
        read(folder)
    assert Path(file).name in str(why.value)


def test_half_models_and_air_runs_that_some_lack_are_refused(folder: Path) -> None:
    edited(folder / "runs.csv", "beta [deg]", "beta [deg],in_air")
    lines = (folder / "runs.csv").read_text().splitlines()
    (folder / "runs.csv").write_text(
        "\n".join([lines[0], lines[1] + ",runs/sway_1.csv", *(f"{line}," for line in lines[2:])]) + "\n"
    )
    with pytest.raises(InputError, match="in_air for every run"):
        read(folder)
    edited(folder / FILE, "contains_inertia = true", "contains_inertia = false")
    with pytest.raises(InputError, match="runs in air of forces without inertia"):
        read(folder)
    edited(folder / FILE, 'importer = "pmm"', 'importer = "pmm"\nhalf_model = true')
    with pytest.raises(InputError, match="half model"):
        read(folder)


def test_a_record_in_the_columns_of_simman_is_the_same_record(folder: Path) -> None:
    file = folder / "runs/sway_1.csv"
    (plain,) = (r.record for r in read(folder).runs if r.label == "sway_1")
    omega, zero = 1.5, np.zeros(len(plain.time))
    y = plain.displacements["y"]
    columns = {
        "Time": plain.time, "X": zero, "Y": plain.forces["Y"], "N": plain.forces["N"], "x": 1.5 * plain.time, "y": y,
        "psi": zero, "u": zero + 1.5, "v": omega * y, "r": zero, "udot": zero, "vdot": -(omega**2) * y, "rdot": zero,
    }  # fmt: skip
    rows = np.transpose(list(columns.values()))

    def written(names: list[str], mark: str) -> None:
        lines = [mark.join(names), *(mark.join(repr(float(v)) for v in row) for row in rows)]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")

    written(list(columns), " ")
    (simman,) = (r.record for r in read(folder).runs if r.label == "sway_1")
    np.testing.assert_array_equal(simman.time, plain.time)
    assert set(simman.displacements) == {"y", "psi"}
    for own, kind in ((plain.forces["Y"], simman.forces["Y"]), (-(omega**2) * y, simman.accelerations["v"])):
        np.testing.assert_allclose(kind, own, rtol=1e-12)
    with pytest.raises(InputError, match="time series of an oscillating test"):
        IMPORTERS.load("simman").raw(file, {})
    rows[3, 0] = rows[1, 0]
    written(list(columns), " ")
    with pytest.raises(InputError, match="a time that rises"):
        read(folder)
