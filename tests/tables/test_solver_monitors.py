"""Monitors of STAR-CCM+, Fluent, CFX and SU2: the samples, and the states in which runs leave their files."""

from __future__ import annotations

import math
import re
import shutil
import time
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import Ended, Run

SAMPLES = Path(__file__).parent / "samples"
# One sample of every layout with rows: file, first column of forces.
LAYOUTS = {
    "starccm": (SAMPLES / "starccm/forces.csv", 1),
    "fluent": (SAMPLES / "fluent/forces-rset.out", 2),
    "fluent old": (SAMPLES / "fluent/cd-history.out", 1),
    "cfx": (SAMPLES / "cfx/monitors.csv", 1),
    "su2": (SAMPLES / "su2/v8_drift/history.csv", 10),
    "su2 6": (SAMPLES / "su2/v6_incidence/history.csv", 1),
}
EACH = pytest.mark.parametrize("layout", LAYOUTS)


def read(layout: str, path: Path) -> Run:
    return IMPORTERS.load(layout.split(maxsplit=1)[0]).run(path, {})


def lines_of(layout: str) -> tuple[list[str], int]:
    """Lines of a sample, and the number of its header lines."""
    lines = LAYOUTS[layout][0].read_text("utf-8").splitlines(keepends=True)
    return lines, next(i for i, line in enumerate(lines) if line.strip()[0].isdigit())


def written(tmp_path: Path, layout: str, text: str) -> Path:
    path = tmp_path / LAYOUTS[layout][0].name
    path.write_bytes(text.encode())
    return path


def same(a: Run, b: Run) -> bool:
    return len(a.history.columns) == len(b.history.columns) and all(
        np.array_equal(x.values, y.values, equal_nan=True) and (x.name, x.unit, x.means) == (y.name, y.unit, y.means)
        for x, y in zip(a.history.columns, b.history.columns, strict=True)
    )


def plain(path: Path) -> np.ndarray:
    """All numbers of a sample by its last header line, read another way."""
    return np.array([[float(c) for c in re.split(r"[,\s]+", line.strip())] for line in path.read_text("utf-8").splitlines() if line.strip()[0].isdigit()])  # fmt: skip


@EACH
def test_every_number_of_a_whole_file(layout: str) -> None:
    path, _ = LAYOUTS[layout]
    run = read(layout, path)
    assert run.ended is Ended.WHOLE
    assert run.why == ""
    assert np.array_equal(np.column_stack([c.values for c in run.history.columns]), plain(path))
    assert run.history.meaning("iteration") is not None
    assert len(run.history.lines) == len(run.history)
    assert path.read_text("utf-8").splitlines()[run.history.lines[-1] - 1].split(",")[0].split()[0] == str(
        int(run.history.columns[0].values[-1] if layout != "su2" else 0)
    )


def test_star_names_units_and_times() -> None:
    run = read("starccm", SAMPLES / "starccm/forces.csv")
    assert [(c.name, c.unit, c.means) for c in run.history.columns][:2] == [
        ("Iteration", "", "iteration"),
        ("Drag Monitor", "N", ""),
    ]
    assert run.history.column("Yaw Moment Monitor").unit == "N*m"
    timed = read("starccm", SAMPLES / "starccm/oscillation.csv").history
    assert (timed.columns[0].means, timed.columns[0].unit) == ("time", "s")
    assert (timed.column("CL Monitor").unit, timed.column("rotation Monitor: Expression").unit) == ("-", "deg")
    chinese = read("starccm", SAMPLES / "starccm/fz_chinese.csv").history
    assert (chinese.columns[0].means, chinese.column("Pitch_Moment Monitor").unit) == ("time", "N*m")
    assert not run.conditions


def test_star_repeated_iterations_and_resaved_files() -> None:
    assert [c.name for c in read("starccm", SAMPLES / "starccm/his.csv").history.columns] == [
        "Iteration", "CL", "Body 2.CD", "Cm",
    ]  # fmt: skip
    resaved = read("starccm", SAMPLES / "starccm/resaved_semicolon.csv").history
    forces = read("starccm", SAMPLES / "starccm/forces.csv").history
    assert np.array_equal(resaved.column("Drag Monitor").values, forces.column("Drag Monitor").values[:30])


def test_star_decimal_marks_are_not_mixed(tmp_path: Path) -> None:
    path = tmp_path / "drag.csv"
    path.write_text('"Iteration";"Drag Monitor: Drag Monitor (N)"\n1;1.250,5\n2;3.5\n3;4,5\n')
    with pytest.raises(InputError, match="one decimal mark"):
        read("starccm", path)


def test_star_cells_are_counted_by_their_commas(tmp_path: Path) -> None:
    path = tmp_path / "drag.csv"
    path.write_text('"Iteration","A Monitor: A (N)","B Monitor: B (N)"\n1,2,3\n2 5,,6\n3,,7\n4,8,9\n')
    run = read("starccm", path)
    assert np.array_equal(run.history.columns[0].values, [1.0, 3.0, 4.0])
    assert np.array_equal(run.history.columns[1].values, [2.0, np.nan, 8.0], equal_nan=True)  # a blank is no divergence
    assert run.ended is Ended.WHOLE
    assert any('drag.csv:3: "2 5"' in r for r in run.history.remarks)


def test_star_files_of_one_run(tmp_path: Path) -> None:
    run = read("starccm", SAMPLES / "starccm/run_b06")
    assert [c.name for c in run.history.columns] == ["Iteration", "Fx Monitor", "Fy Monitor", "Mz Monitor"]
    assert [f.name for f in run.history.files] == ["forces.csv", "moments.csv"]
    shutil.copytree(SAMPLES / "starccm/run_b06", tmp_path / "run")
    moments = tmp_path / "run/moments.csv"
    lines = moments.read_text().splitlines(keepends=True)
    moments.write_text("".join(lines[:21]) + "21,-2")
    short = read("starccm", tmp_path / "run")
    assert len(short.history) == 20
    assert any("20 lines at steps that the other files lack" in r for r in short.history.remarks)
    shutil.copy(tmp_path / "run/forces.csv", tmp_path / "run/b08.csv")  # several runs, not one
    assert not IMPORTERS.load("starccm").recognises(tmp_path / "run")
    with pytest.raises(InputError, match="one run"):
        read("starccm", tmp_path / "run")


def test_fluent_files_of_one_run_and_restarts(tmp_path: Path) -> None:
    run = read("fluent", SAMPLES / "fluent/steady")
    assert [c.name for c in run.history.columns] == ["Iteration", "fx", "fy", "mz"]
    assert all(c.means in ("", "iteration") and c.unit == "" for c in run.history.columns)
    restarted = read("fluent", SAMPLES / "fluent/restarted").history
    assert np.array_equal(restarted.columns[0].values, np.arange(1.0, 46.0))
    later = plain(SAMPLES / "fluent/restarted/fx-rfile_1_1.out")
    assert np.array_equal(restarted.column("fx").values[20:], later[:, 1])
    shutil.copy(SAMPLES / "fluent/steady/fx-rfile.out", tmp_path / "b02.out")
    shutil.copy(SAMPLES / "fluent/steady/fx-rfile.out", tmp_path / "b04.out")
    assert not IMPORTERS.load("fluent").recognises(tmp_path)


def test_fluent_force_report() -> None:
    run = read("fluent", SAMPLES / "fluent/forces.frp")
    total = {m: run.history.meaning(m) for m in "XYZ"}
    assert {m: (float(c.values[0]), c.unit) for m, c in total.items() if c} == {
        "X": (18.135, "N"), "Y": (-41.361, "N"), "Z": (2.109, "N"),
    }  # fmt: skip
    assert set(run.patches) == {"hull", "sail", "rudder_s"}
    for means in "XYZ":  # the zones add up to Net, and pressure and viscous parts to the total
        parts = [c.values[0] for t in run.patches.values() if (c := t.meaning(means))]
        assert sum(parts) == pytest.approx(run.history.meaning(means).values[0], abs=1e-12)
    hull = run.patches["hull"]
    assert hull.column("Forces x pressure").values + hull.column("Forces x viscous").values == pytest.approx(16.935)
    moments = read("fluent", SAMPLES / "fluent/moments.frp").history
    assert moments.stated["axes.reference_point"].value == (1.05, 0.0, 0.0)
    assert moments.stated["axes.reference_point"].place == "moments.frp:3"
    assert (moments.meaning("N").unit, float(moments.meaning("N").values[0])) == ("N*m", 0.8436)


def test_fluent_reports_along_directions(tmp_path: Path) -> None:
    text = (SAMPLES / "fluent/report_forces.txt").read_text()
    run = read("fluent", SAMPLES / "fluent/report_forces.txt")
    assert (float(run.history.meaning("X").values[0]), float(run.history.meaning("Y").values[0])) == (18.135, -41.361)
    path = tmp_path / "report.txt"
    path.write_text(text.replace("(1 0 0)", "(-1 0 0)").replace("(0 1 0)", "(0.6 0.8 0)"))
    turned = read("fluent", path).history
    assert float(turned.meaning("X").values[0]) == -18.135
    assert any("X is minus the number along (-1 0 0)" in r for r in turned.remarks)
    assert [c.means for c in turned.columns if c.means] == ["iteration", "X"]  # (0.6 0.8 0) is no axis
    path.write_text(text + text)
    twice = read("fluent", path).history
    assert np.array_equal(twice.meaning("iteration").values, [1.0, 2.0])
    path.write_text(text[: text.rindex("Net")])
    cut = read("fluent", path)
    assert cut.ended is Ended.CRASHED
    assert "no row Net" in cut.why


def test_cfx_names_hold_commas_and_quotation_marks() -> None:
    run = read("cfx", SAMPLES / "cfx/monitors.csv")
    assert [(c.name, c.unit, c.means) for c in run.history.columns] == [
        ("ACCUMULATED TIMESTEP", "", "iteration"),
        ("Fx hull", "", ""),
        ("Fy hull", "", ""),
        ('P1,D1,"x= 4.65E-02,y= 4.16E-01,z= 0.00E+00",Pressure', "", ""),
    ]


def test_su2_coefficients_in_the_axes_of_the_mesh() -> None:
    run = read("su2", SAMPLES / "su2/v8_drift")
    means = {c.means: c.name for c in run.history.columns if c.means}
    assert means == {
        "iteration": "Inner_Iter", "X": "CFx", "Y": "CFy", "Z": "CFz", "K": "CMx", "M": "CMy", "N": "CMz",
    }  # fmt: skip
    assert {c.unit for c in run.history.columns if c.name.startswith("C")} == {"-"}
    stated = {k: (s.value, s.place) for k, s in run.history.stated.items()}
    assert stated["coefficients.length"] == (2.1, "hull.cfg:19")
    assert stated["coefficients.area"] == (4.41, "hull.cfg:20")
    assert stated["axes.reference_point"] == ((1.05, 0.0, 0.0), "hull.cfg:16, 17, 18")
    assert stated["conditions.density"] == (998.2, "hull.cfg:12")


def test_su2_incompressible_velocity_by_hand() -> None:
    """Water that flows along +x (aft) and +y (starboard): the body moves ahead and to port."""
    run = read("su2", SAMPLES / "su2/v8_drift/history.csv")
    u, v, w, speed = (run.conditions[k].value for k in ("u", "v", "w", "U"))
    assert (u, v, w) == (-1.98904379, -0.20905693, 0.0)
    assert speed == pytest.approx(2.0, rel=1e-9)
    # In FRD x and z are turned and y is not: v' = -sin(6 deg) although the water's own angle is +6 deg.
    assert v / speed == pytest.approx(-math.sin(math.radians(6.0)), rel=1e-7)
    assert run.conditions["v"].place == "hull.cfg:13"


def test_su2_angles_of_compressible_flow_by_hand() -> None:
    """AOA lifts the water from x towards z, SIDESLIP_ANGLE turns it towards y: both as written, in radians."""
    run = read("su2", SAMPLES / "su2/v6_incidence")
    alpha, beta = run.conditions["alpha"].value, run.conditions["beta"].value
    assert (alpha, beta) == (math.radians(4.0), math.radians(-2.5))
    flow = np.array([math.cos(alpha) * math.cos(beta), math.sin(beta), math.sin(alpha) * math.cos(beta)])
    # With x aft, y starboard, z up the body's velocity in FRD is (+x, -y, +z) of the flow.
    frd = np.array([flow[0], -flow[1], flow[2]])
    assert math.atan2(frd[2], frd[0]) == pytest.approx(alpha)  # w = +U sin(alpha)
    assert math.asin(frd[1]) == pytest.approx(-beta)  # v = -U sin(beta)
    last = run.history.columns
    force = np.array([next(c.values[-1] for c in last if c.name == n) for n in ("CFx", "CFy", "CFz")])
    assert np.isfinite(force).all()
    assert "U" not in run.conditions
    assert any("REF_AREA 0" in r for r in run.history.remarks)


def test_su2_rotating_frame_by_hand() -> None:
    """0.2 rad/s about +z (up) round a point 12 m to port: 2.4 m/s ahead (-x), to port, r negative in FRD."""
    run = read("su2", SAMPLES / "su2/v7_rotating_arm")
    got = {k: s.value for k, s in run.conditions.items()}
    assert got == pytest.approx({"p": 0.0, "q": 0.0, "r": 0.2, "u": -2.4, "v": 0.0, "w": 0.0, "U": 2.4})
    assert run.history.stated["table.contains_inertia"].value is False
    assert set(run.patches) == {"hull", "sail"}
    whole = run.history.meaning("Y").values
    assert np.allclose(
        run.patches["hull"].meaning("Y").values + run.patches["sail"].meaning("Y").values, whole, atol=1e-10
    )


def test_su2_coefficients_by_another_speed_are_those_of_the_run(tmp_path: Path) -> None:
    """Twice the reference speed of the run: coefficients a quarter of its own, by 1/2 rho U^2."""
    shutil.copytree(SAMPLES / "su2/v7_rotating_arm", tmp_path / "run")
    config = tmp_path / "run/arm.cfg"
    first = read("su2", tmp_path / "run")
    config.write_text(config.read_text().replace("INC_VELOCITY_REF= 2.4", "INC_VELOCITY_REF= 4.8"))
    run = read("su2", tmp_path / "run")
    for table, one in ((run.history, first.history), (run.patches["sail"], first.patches["sail"])):
        assert np.allclose(table.meaning("Y").values, 4.0 * one.meaning("Y").values, rtol=1e-12)
    assert np.array_equal(run.history.column("CEff").values, first.history.column("CEff").values)
    assert any(
        "arm.cfg:7, 8: coefficients by 998.2 kg/m^3 and 4.8 m/s multiplied by 4" in r for r in run.history.remarks
    )
    config.write_text(config.read_text().replace("REFERENCE_VALUES", "INITIAL_VALUES"))  # of a stream that rests
    assert any("not by density and speed of the run" in r for r in read("su2", tmp_path / "run").history.remarks)


def test_su2_unsteady_keeps_the_last_inner_iteration() -> None:
    run = read("su2", SAMPLES / "su2/v7_unsteady_tecplot")
    assert np.array_equal(run.history.column("Time_Iter").values, np.arange(1.0, 25.0))
    assert set(run.history.column("Inner_Iter").values) == {19.0}
    assert run.history.meaning("time").values[-1] == 0.12
    assert run.history.remarks == ("conditions not read: no .cfg file beside history.dat",)


def test_su2_tecplot_and_csv_of_one_run_are_equal() -> None:
    assert same(read("su2", SAMPLES / "su2/v6_tecplot"), read("su2", SAMPLES / "su2/v6_incidence"))


def test_su2_two_config_files(tmp_path: Path) -> None:
    shutil.copytree(SAMPLES / "su2/v8_drift", tmp_path / "run")
    (tmp_path / "run/other.cfg").write_text("SOLVER= INC_RANS\nCONV_FILENAME= other\n")
    assert read("su2", tmp_path / "run").conditions["U"].place == "hull.cfg:13"
    (tmp_path / "run/other.cfg").write_text("SOLVER= INC_RANS\n")
    both = read("su2", tmp_path / "run")
    assert not both.conditions
    assert any("CONV_FILENAME does not show" in r for r in both.history.remarks)


def test_su2_refusals(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    path.write_text('"Time_Iter","Outer_Iter","Inner_Iter","rms[P]"\n0,0,0,-3\n')
    with pytest.raises(InputError, match="AERO_COEFF"):
        read("su2", path)
    shutil.copytree(SAMPLES / "su2/v8_drift", tmp_path / "run")
    config = tmp_path / "run/hull.cfg"
    config.write_text(config.read_text().replace("REF_LENGTH= 2.1", "REF_LENGTH= two"))
    with pytest.raises(InputError, match=r'hull.cfg, line 19, "REF_LENGTH": found "two"; expected a number'):
        read("su2", tmp_path / "run")


# ------------------------------------------------------------------------------------------------- what runs leave


@EACH
def test_a_cut_last_line_is_a_crash(layout: str, tmp_path: Path) -> None:
    lines, _ = lines_of(layout)
    path = written(tmp_path, layout, "".join(lines[:-1]) + re.match(r"\s*\d+[,\s]", lines[-1])[0])
    run = read(layout, path)
    assert len(run.history) == len(read(layout, LAYOUTS[layout][0]).history) - 1
    assert run.ended is Ended.CRASHED
    assert f"{path.name}:{len(lines)}" in run.why


@EACH
def test_a_last_line_without_end_may_be_cut(layout: str, tmp_path: Path) -> None:
    lines, _ = lines_of(layout)
    run = read(layout, written(tmp_path, layout, "".join(lines)[:-1]))
    assert len(run.history) == len(read(layout, LAYOUTS[layout][0]).history) - 1
    assert run.ended is Ended.WHOLE
    assert any("no line end" in r for r in run.history.remarks)


@EACH
def test_nan_to_the_end_is_divergence(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    column = LAYOUTS[layout][1]
    for i in range(len(lines) - 4, len(lines)):
        cells = re.split(r"([,\s]+)", lines[i].strip())
        cells[2 * column] = ("nan", "-nan", "inf", "-nan(ind)")[i % 4]
        lines[i] = "".join(cells) + "\n"
    path = written(tmp_path, layout, "".join(lines))
    run = read(layout, path)
    assert run.ended is Ended.DIVERGED
    assert f"{path.name}:{len(lines) - 3}" in run.why
    assert np.isnan(run.history.columns[column].values[-4:]).all()
    recovered = "".join([*lines[: header + 3], *lines[-4:], *lines[header + 8 : -4]])
    assert read(layout, written(tmp_path, layout, recovered)).ended is Ended.WHOLE


@EACH
def test_a_restart_overlaps_with_its_header_again(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    again = [line.replace(".0", ".5", 1) for line in lines[header + 5 : header + 20]]
    text = "".join([*lines[: header + 12], *lines[:header], *again])
    run = read(layout, written(tmp_path, layout, text))
    assert len(run.history) == 20
    expected = read(layout, written(tmp_path, layout, "".join([*lines[: header + 5], *again])))
    assert same(run, expected)
    assert any("the header again" in r for r in run.history.remarks)
    assert any("7 earlier ones left out" in r for r in run.history.remarks)


@EACH
def test_iterations_that_start_anew_and_twice(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    first = read(layout, LAYOUTS[layout][0])
    assert same(read(layout, written(tmp_path, layout, "".join([*lines, *lines[header:]]))), first)
    doubled = "".join([*lines[: header + 4], lines[header + 3], *lines[header + 4 :]])
    assert same(read(layout, written(tmp_path, layout, doubled)), first)


@EACH
def test_a_line_that_a_crash_broke_amid_the_file(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    broken = (
        lines[header + 9][: len(lines[header + 9]) // 2] + lines[header + 9]
    )  # the restart goes on where it stopped
    run = read(layout, written(tmp_path, layout, "".join([*lines[: header + 9], broken, *lines[header + 10 :]])))
    assert len(run.history) == len(lines) - header - 1
    assert run.ended is Ended.WHOLE
    assert any(f":{header + 10}: " in r and "line left out" in r for r in run.history.remarks)


@EACH
def test_mostly_broken_is_refused(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    text = "".join(lines[:header]) + "".join(f"{i} oh dear{i}\n" for i in range(40))
    with pytest.raises(InputError, match=f"line {header + 1}.*lines are broken"):
        read(layout, written(tmp_path, layout, text))


@EACH
def test_long_digits_take_no_time(layout: str, tmp_path: Path) -> None:
    """A number that cannot be one is refused in time proportional to its length: 60,000 digits took minutes."""
    lines, header = lines_of(layout)
    long = lines[header].replace("1", "1" * 30_000 + "x", 1)
    start = time.process_time()
    run = read(layout, written(tmp_path, layout, "".join([*lines[:header], long, *lines[header + 1 :]])))
    assert time.process_time() - start < 0.5
    assert len(run.history) == len(lines) - header - 1


@EACH
def test_line_ends_and_marks_of_order(layout: str, tmp_path: Path) -> None:
    text = "".join(lines_of(layout)[0])
    first = read(layout, LAYOUTS[layout][0])
    mixed = "".join(line + ("\r\n" if i % 2 else "\n") for i, line in enumerate(text.split("\n")[:-1]))
    for changed in (
        text.replace("\n", "\r\n"),
        mixed,
        text.replace("\n", "\r"),
        "\ufeff" + text,
        text.replace("\n", "\n\n"),
    ):
        assert same(read(layout, written(tmp_path, layout, changed)), first)


@EACH
def test_no_rows_and_an_empty_file(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    for text in ("".join(lines[:header]), ""):
        run = read(layout, written(tmp_path, layout, text))
        assert run.ended is Ended.EMPTY
        assert run.why
        assert len(run.history) == 0


@EACH
def test_other_columns_after_a_restart_are_refused(layout: str, tmp_path: Path) -> None:
    lines, header = lines_of(layout)
    other = lines[header - 1] if layout.startswith("fluent") else lines[0]
    quoted = re.findall(r'"[^"]*"', other)[-1]
    text = "".join([*lines, other.replace(quoted, '"another"'), *lines[header:]])
    with pytest.raises(InputError, match="Split the file where the columns change"):
        read(layout, written(tmp_path, layout, text))


@EACH
def test_long_files_are_read_block_by_block(layout: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = read(layout, LAYOUTS[layout][0])
    monkeypatch.setattr("coeflab.tables.monitors.BLOCK", 700)
    assert same(read(layout, LAYOUTS[layout][0]), first)


def test_conditions_are_not_made_up() -> None:
    for layout in ("starccm", "fluent"):
        for path in (SAMPLES / layout).iterdir():
            run = read(layout, path)
            assert not run.conditions
            assert not set(run.history.stated) - {"axes.reference_point"}
