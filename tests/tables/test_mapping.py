"""What a column is, in words; and one physical table that many people wrote down differently."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from coeflab.cli import app
from coeflab.core.axes import FRAMES, Axes, parse_axes
from coeflab.core.errors import InputError
from coeflab.tables.column_company import proposals
from coeflab.tables.column_map import read_column_map, unturned
from coeflab.tables.evidence import evidence
from coeflab.tables.force_table import ForceTable
from coeflab.tables.form import Group, screen
from coeflab.tables.importers import PlannedTable
from coeflab.tables.interpretation import interpreted
from coeflab.tables.mapping import assigned, entry_of, with_unit
from coeflab.tables.parts import Part
from coeflab.tables.proposals import proposed
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.reading import importer_of, read_raw, read_tables, recognised
from coeflab.tables.several_tables import form_together
from tests.cli.test_import import without_slopes
from tests.conftest import SECTIONS
from tests.tables.raw_files import NAME, plain_stub, raw

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

__all__ = ["plain_stub", "without_slopes"]
FOOT, POUND_FORCE, POUND, KNOT = 0.3048, 4.4482216152605, 0.45359237, 1852.0 / 3600.0
RHO, SPEED, LENGTH, AREA = 1000.0, 2.0, 4.0, 0.31
MOTIONS, FORCES = "uvwpqr", "XYZKMN"
PLANTED = {  # primed, about (-2, 0, 0) m from the nose: linear, cubic
    "Yv": (-0.0278, -0.19), "Nv": (-0.0136, 0.041), "Yr": (0.0052, 0.011), "Nr": (-0.0044, -0.006),
    "Zw": (-0.0139, -0.23), "Mw": (0.0104, -0.035), "Zq": (-0.0076, -0.012), "Mq": (-0.0037, -0.004),
}  # fmt: skip
SIX = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
POINTS = (0.0, 0.37)  # how far the table's point lies forward of the planted one
AXES = {**FRAMES, "odd": ("starboard", "aft", "down")}
SYSTEMS = ("SI", "US", "primes", "coefficients")


def physics(forward: float) -> np.ndarray:
    """u v w p q r X Y Z K M N, SI and FRD, about a point so far forward of the planted one."""
    sweep = np.linspace(-0.21, 0.21, 9)
    rows = np.zeros((36, 12))
    for k, column in enumerate((1, 2, 4, 5)):
        rows[9 * k : 9 * k + 9, column] = sweep * SPEED / (LENGTH if column > 2 else 1.0)
    rows[:, 0] = np.sqrt(SPEED**2 - rows[:, 1] ** 2 - rows[:, 2] ** 2)
    force, moment = 0.5 * RHO * SPEED**2 * LENGTH**2, 0.5 * RHO * SPEED**2 * LENGTH**3
    rows[:, 6] = -0.0012 * force * (1.0 - 0.4 * rows[:, 1] ** 2)
    rows[:, 9] = 0.0003 * moment * rows[:, 1]
    for symbol, (linear, cubic) in PLANTED.items():
        x = rows[:, MOTIONS.index(symbol[1])] / SPEED * (LENGTH if symbol[1] in "qr" else 1.0)
        column = 6 + FORCES.index(symbol[0])
        rows[:, column] += (linear * x + cubic * x**3) * (moment if symbol[0] in "MN" else force)
    at = rows.copy()
    at[:, 1] += rows[:, 5] * forward
    at[:, 2] -= rows[:, 4] * forward
    at[:, 11] -= rows[:, 7] * forward
    at[:, 10] += rows[:, 8] * forward
    return at


def in_axes(rows: np.ndarray, directions: tuple[str, str, str]) -> np.ndarray:
    turn = Axes(directions).rotation
    return np.hstack([rows[:, 3 * i : 3 * i + 3] @ turn for i in range(4)])


def written(folder: Path, axes: str, system: str, forward: float) -> tuple[Path, dict[str, str], dict[str, str]]:
    """A file as a tool might write it, what its columns are, and sections of its campaign.toml."""
    frd = physics(forward)
    own = in_axes(frd, AXES[axes])
    speed = np.linalg.norm(frd[:, :3], axis=1)
    beta, alpha = np.arcsin(frd[:, 1] / speed), np.arctan2(frd[:, 2], frd[:, 0])
    sign = -1.0 if axes in ("FRD", "odd") else 1.0
    dynamic = 0.5 * RHO * speed**2
    names = [f"F{i}" for i in "xyz"] + [f"M{i}" for i in "xyz"]
    columns: dict[str, tuple[np.ndarray, str, str]] = {"Run": (np.arange(36.0), "", "point")}
    if system == "SI":
        columns |= {f"vel {m}": (own[:, i], "m/s" if i < 3 else "rad/s", m) for i, m in enumerate(MOTIONS)}
        columns |= {n: (own[:, 6 + i], "N" if i < 3 else "Nm", FORCES[i]) for i, n in enumerate(names)}
    elif system == "US":
        columns["Speed"] = (speed / KNOT, "kn", "U")
        columns["Drift"] = (np.degrees(sign * beta), "deg", "beta")
        columns["Attack"] = (-np.degrees(alpha), "deg", "-alpha")
        columns |= {f"rate {m}": (np.degrees(own[:, 3 + i]), "deg/s", m) for i, m in enumerate("pqr")}
        columns |= {
            n: (
                own[:, 6 + i] / POUND_FORCE / (1.0 if i < 3 else FOOT),
                "",
                f"{FORCES[i]} [{'lbf' if i < 3 else 'ft*lbf'}]",
            )
            for i, n in enumerate(names)
        }
    else:
        columns["U"] = (speed, "m/s", "U")
        columns |= {
            f"{m}*": (own[:, i] / speed * (LENGTH if i > 2 else 1.0), "", f"{m}' [-]") for i, m in enumerate(MOTIONS)
        }
        area = AREA if system == "coefficients" else LENGTH**2
        for i, n in enumerate(names):
            by = f"coefficient A={AREA} m^2" + f" L={LENGTH / FOOT!r} ft" * (i > 2)
            said = f"{FORCES[i]} [{by}]" if system == "coefficients" else f"{FORCES[i]}'"
            turned = -1.0 if n == "Fz" else 1.0
            columns[f"C{n}"] = (
                turned * own[:, 6 + i] / (dynamic * area * (LENGTH if i > 2 else 1.0)), "", f"{'-' * (turned < 0)}{said}"
            )  # fmt: skip
    lines = [",".join(f"{n} ({u})" if u else n for n, (_, u, _) in columns.items())]
    lines += [",".join(repr(float(v[row])) for v, _, _ in columns.values()) for row in range(36)]
    file = folder / "test.raw"
    file.write_text("# a tool\n" + "\n".join(lines) + "\n", encoding="utf-8")
    frame = repr(list(AXES[axes])).replace("'", '"') if axes == "odd" else f'"{axes}"'
    at = -2.0 + forward
    point = f'["{at / FOOT!r} ft", 0.0, 0.0]' if system == "US" else f"[{at!r}, 0.0, 0.0]"
    settings = {
        "axes.frame": frame, "axes.datum": '"nose"', "axes.reference_point": point, "scaling.length_name": '"LBP"',
        "scaling.length": f'"{LENGTH / FOOT!r} ft"' if system == "US" else repr(LENGTH),
        "conditions.density": f'"{RHO * FOOT**3 / POUND!r} lb/ft^3"' if system == "US" else repr(RHO),
        "conditions.speed": "2.0", "source.kind": '"synthetic"', "source.citation": '"synthetic"',
        "table.contains_inertia": "false", "table.arm_point": point,
    }  # fmt: skip
    if system == "US":
        settings |= {"axes.beta": f'"v = {"-" if sign < 0 else "+"}U sin(beta)"', "axes.alpha": '"w = +U sin(alpha)"'}
    return file, {n: said for n, (_, _, said) in columns.items()}, settings


def by_columns(file: Path, said: Mapping[str, str], settings: Mapping[str, str]) -> ForceTable:
    sections: dict[str, list[str]] = {"campaign": [f'title = "T"\nbody = "b"\nimporter = "{NAME}"']}
    for key, text in settings.items():
        section, _, name = key.partition(".")
        sections.setdefault(section, []).append(f"{name} = {text}")
    table = f'[[table]]\nfile = "{file.name}"\n' + "\n".join(sections.pop("table"))
    text = "".join(f"[{name}]\n" + "\n".join(keys) + "\n\n" for name, keys in sections.items())
    text += "[columns]\n" + "\n".join(f'"{n}" = "{s}"' for n, s in said.items()) + "\n\n" + table + "\n"
    (file.parent / "campaign.toml").write_text(text, encoding="utf-8")
    return read_tables(PlannedTable(file.parent, ()))[0]


def by_import(file: Path, said: Mapping[str, str], settings: Mapping[str, str]) -> ForceTable:
    out = file.parent / "imported"
    arguments = [a for n, s in said.items() for a in ("--map", f"{n}={s}")]
    arguments += [a for k, s in settings.items() for a in ("--set", f"{k}={s}")]
    done = CliRunner().invoke(app, ["import", str(file), "--out", str(out), *arguments])
    assert done.exit_code == 0, done.output + str(done.exception)
    return read_tables(PlannedTable(out, ()))[0]


def derivatives(table: ForceTable) -> dict[str, float]:
    """Linear parts, primed, about the planted point, by least squares of the planted form."""
    about = table.about(np.array([-2.0, 0.0, 0.0]))
    out = {}
    for component, motions in (("Y", "vr"), ("N", "vr"), ("Z", "wq"), ("M", "wq")):
        basis = [about.motion[m] ** power for m in motions for power in (1, 3)]
        fitted = np.linalg.lstsq(np.column_stack(basis), about.forces[component], rcond=None)[0]
        for m, slope in zip(motions, fitted[::2], strict=True):
            unit = 0.5 * RHO * SPEED * LENGTH ** (2 + (component in "MN") + (m in "qr"))
            out[component + m] = slope / unit
    return out


CASES = [pytest.param(*case, id="-".join(map(str, case))) for case in itertools.product(AXES, SYSTEMS, POINTS)]


@pytest.mark.parametrize(("axes", "system", "forward"), CASES)
def test_one_physical_table_has_one_set_of_derivatives(tmp_path: Path, axes: str, system: str, forward: float) -> None:
    """Four axes, three unit systems and coefficients by an area, two points; in place by [columns], and imported."""
    file, said, settings = written(tmp_path, axes, system, forward)
    for table in (by_columns(file, said, settings), by_import(file, said, settings)):
        found = derivatives(table)
        assert len(table) == 36
        for symbol in SIX:
            assert found[symbol] == pytest.approx(PLANTED[symbol][0], rel=1e-10), symbol


def test_a_sign_word_turns_a_column(tmp_path: Path) -> None:
    file, said, settings = written(tmp_path, "FRD", "SI", 0.0)
    found = derivatives(by_columns(file, said | {"Fy": "-Y [N]"}, settings))
    assert found["Yv"] == pytest.approx(-PLANTED["Yv"][0], rel=1e-10)
    assert found["Nv"] == pytest.approx(PLANTED["Nv"][0], rel=1e-10)


FORMS = ["Y [N]", "-Y [lbf]", "r' [-]", "se_N [ft*lbf]", "Y [coefficient A=1.2 m^2]", "label", "beta [deg]", "R [m]",
         "N [coefficient A=1.2 m^2 L=4.0 m]", "U [kn]", "density [kg/m^3]", "dr [deg]", "beta"]  # fmt: skip


@pytest.mark.parametrize("text", FORMS)
def test_what_a_column_is_reads_as_it_is_written(text: str) -> None:
    assert str(read_column_map(text)) == text


@pytest.mark.parametrize(("text", "said"), [
    ("Y [deg]", "found [deg], a unit of another dimension; expected a unit of force"),
    ("Q [N]", 'the unknown name "Q"'),
    ("-label", "label without sign, prime and unit"),
    ("beta' [-]", "a prime of X Y Z K M N u v w p q r drag side lift only"),
    ("Y' [N]", "Leave out ' for a dimensional column"),
    ("Y [-]", "Y [coefficient A=1.2 m^2]"),
    ("N [coefficient A=1 m^2]", "N [coefficient A=1.2 m^2 L=4.26 m]"),
    ("Y [coefficient A=1 m^2 L=3 m]", "L is no part of a force's"),
    ("Y [coefficient A=-1 m^2]", "above zero"),
    ("se_beta [deg]", "se_ before one of X Y Z K M N"),
    ("2*Y [N]", "expected what the column is"),
    ("", "expected what the column is"),
])  # fmt: skip
def test_what_no_column_is(text: str, said: str) -> None:
    with pytest.raises(InputError) as why:
        read_column_map(text)
    assert said in str(why.value)


SIMPLE = {
    "axes.frame": '"FRD"', "axes.beta": '"v = -U sin(beta)"', "axes.datum": '"nose"', "axes.reference_point": "[-2, 0, 0]",
    "scaling.length": "4.0", "scaling.length_name": '"LBP"', "conditions.density": "1000.0", "conditions.speed": "2.0",
    "source.kind": '"synthetic"', "source.citation": '"synthetic"', "table.contains_inertia": "false",
}  # fmt: skip


def in_wind_axes(frd: np.ndarray) -> np.ndarray:
    """Drag, side force and lift of rows of `physics`: minus the part along the motion, that to starboard, that upwards."""
    along = frd[:, :3] / np.linalg.norm(frd[:, :3], axis=1)[:, None]
    up = np.cross(along, [0.0, 1.0, 0.0])
    up *= -np.sign(up[:, 2:]) / np.linalg.norm(up, axis=1)[:, None]
    starboard = np.cross(along, up)
    return np.column_stack([np.sum(frd[:, 6:9] * axis, axis=1) for axis in (-along, starboard, up)])


@pytest.mark.parametrize("side", [True, False], ids=["side", "Y"])
@pytest.mark.parametrize("frame", ["FRD", "CFD"])
@pytest.mark.parametrize("by", ["velocities", "angles"])
def test_lift_and_drag_give_the_six_derivatives(tmp_path: Path, frame: str, by: str, side: bool) -> None:
    """In place and imported, with a side force or with Y of the body, by a coefficient and in newtons."""
    frd = physics(0.0)
    if by == "angles":  # combined incidences; rates stay out of a table by angles of these axes
        frd = frd[:18] + 0.0
    own, wind = in_axes(frd, AXES[frame]), in_wind_axes(frd)
    assert wind[np.abs(frd[:, 1]) + np.abs(frd[:, 2]) < 1e-12, 0] == pytest.approx(
        0.0012 * 0.5 * RHO * SPEED**2 * LENGTH**2
    )
    area = 0.5 * RHO * SPEED**2 * AREA
    columns: dict[str, tuple[np.ndarray, str]] = {
        "CD": (wind[:, 0] / area, f"drag [coefficient A={AREA} m^2]"), "Lift": (-wind[:, 2], "-lift [N]"),
        "Side": (wind[:, 1], "side [N]") if side else (own[:, 7], "Y [N]"),
        "Mx": (own[:, 9], "K [N*m]"), "My": (own[:, 10], "M [N*m]"), "Mz": (own[:, 11], "N [N*m]"),
    }  # fmt: skip
    if by == "angles":
        columns |= {
            "a": (np.arctan2(frd[:, 2], frd[:, 0]), "alpha [rad]"),
            "b": (-np.arcsin(frd[:, 1] / SPEED), "beta [rad]"),
        }
    else:
        columns |= {f"v{m}": (own[:, i], f"{m} [{'m/s' if i < 3 else 'rad/s'}]") for i, m in enumerate(MOTIONS)}
    file = tmp_path / "test.raw"
    lines = [
        ",".join(columns),
        *(",".join(repr(float(v[row])) for v, _ in columns.values()) for row in range(len(frd))),
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    settings = SIMPLE | {"axes.frame": f'"{frame}"', "axes.alpha": '"w = +U sin(alpha)"'}
    if by == "velocities":
        settings = {key: said for key, said in settings.items() if key not in ("axes.alpha", "axes.beta")}
        settings |= {"table.arm_point": "[-2, 0, 0]"}
    said = {name: text for name, (_, text) in columns.items()}
    for table in (by_columns(file, said, settings), by_import(file, said, settings)):
        assert table.forces["X"] == pytest.approx(frd[:, 6], rel=1e-10)
        found = derivatives(table)
        for symbol in SIX if by == "velocities" else ("Yv", "Nv", "Zw", "Mw"):
            assert found[symbol] == pytest.approx(PLANTED[symbol][0], rel=1e-10), symbol
        assert any("turned to body axes" in note for note in table.notes)


def test_lift_and_drag_at_incidence_and_drift_together(tmp_path: Path) -> None:
    """The nine cosines by hand, at angles where no part of them is small, with errors and a doubtful lift."""
    a, b, drag, side, lift = np.radians(20.0), np.radians(-30.0), 3.0, 5.0, 11.0
    text = (
        "a,b,D,se_D,C,L,se_L,which\n" + f"20,30,{drag},0.1,{side},{lift},0.2,\n20,30,{drag},0.1,{side},{lift},0.2,L\n"
    )
    (tmp_path / "t.raw").write_text(text)
    said = {"a": "alpha [deg]", "b": "beta [deg]", "D": "drag [N]", "se_D": "se_drag [N]", "C": "side [N]", "L": "lift [N]",
            "se_L": "se_lift [N]", "which": "uncertain"}  # fmt: skip
    table = by_columns(tmp_path / "t.raw", said, SIMPLE | {"axes.alpha": '"w = +U sin(alpha)"'})
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
    expected = {"X": -drag * ca * cb - side * ca * sb + lift * sa, "Y": -drag * sb + side * cb,
                "Z": -drag * sa * cb - side * sa * sb - lift * ca}  # fmt: skip
    for part, force in expected.items():
        assert table.forces[part][0] == pytest.approx(force, rel=1e-12)
        assert table.usable[part].tolist() == [True, part == "Y"]
    assert not table.errors  # the side force has none


@pytest.mark.parametrize(("head", "row", "found"), [
    ("alpha [deg],lift [N]", "4,1", "lift without drag"),
    ("beta [deg],lift [N],drag [N]", "4,1,1", "lift without alpha"),
    ("alpha [deg],side [N],drag [N]", "4,1,1", "side without beta"),
    ("alpha [deg],drag [N],Y [N]", "4,1,1", "drag without lift at alpha = 4 deg"),
    ("beta [deg],drag [N]", "4,1", "drag without side at beta = 4 deg"),
    ("beta [deg],drag [N],side [N],Y [N]", "4,1,1,1", "drag and side beside Y"),
    ("alpha [deg],drag [N],lift [N],Z [N]", "4,1,1,1", "drag and lift beside Z"),
    ("r [rad/s],drag [N]", "0,1", "drag without a direction of the flow"),
])  # fmt: skip
def test_lift_and_drag_that_cannot_be_turned(write_campaign: object, head: str, row: str, found: str) -> None:
    """Tables in our own names: one clear error."""
    with pytest.raises(InputError) as why:
        read_tables(PlannedTable(write_campaign(f"{head}\n{row}\n"), ()))  # type: ignore[operator]
    assert f"found {found}" in str(why.value)
    assert not why.value.others


def test_a_lift_that_is_called_a_body_force_is_a_warning(tmp_path: Path) -> None:
    said = {"aoa": "alpha [deg]", "CL": "-Z [coefficient A=0.2 m^2]", "CD": "-X [coefficient A=0.2 m^2]"}
    (tmp_path / "t.raw").write_text("aoa,CL,CD\n-4,-0.1,0.03\n0,0,0.02\n4,0.1,0.03\n")
    settings = SIMPLE | {"axes.alpha": '"w = +U sin(alpha)"'}
    warned = [n for n in by_columns(tmp_path / "t.raw", said, settings).notes if n.startswith("warning")]
    assert [n.partition(" is read")[0] for n in warned] == ['warning: "CL"', 'warning: "CD"']
    assert "call it lift [coefficient A=0.2 m^2]" in warned[0]
    exact = {n: s.replace("-Z", "lift").replace("-X", "drag") for n, s in said.items()}
    assert not any(n.startswith("warning") for n in by_columns(tmp_path / "t.raw", exact, settings).notes)
    known = assigned(raw(tmp_path / "t.raw", {}), {n: read_column_map(s) for n, s in exact.items()})
    assert [(e.key, e.value) for e in evidence(known)] == [("axes.alpha", "w = +U sin(alpha)")]


def read_raw_text(folder: Path, text: str, said: Mapping[str, str], **more: str) -> ForceTable:
    file = folder / "test.raw"
    file.write_text(text, encoding="utf-8")
    return by_columns(file, said, SIMPLE | more)


def test_all_complaints_about_columns_come_at_once(tmp_path: Path) -> None:
    text = "# x\nDrift,Fy (N),Fz,Mz (N),My (Nm),Cx (-),K\n1,2,3,4,5,6,7\n"
    said = {"Drift": "beta", "Fy": "Y [lbf]", "Fz": "Z", "Mz": "N", "My": "M", "Fx": "X [N]", "Cx": "M [Nm]"}
    with pytest.raises(InputError) as why:
        read_raw_text(tmp_path, text, said)
    lines = str(why.value).splitlines()
    assert len(lines) == 7
    assert all("test.raw, line 2" in line for line in lines)
    for part in (
        'column "Drift": found no unit; expected a unit of angle. Write "Drift" = "beta [deg]" under [columns].',
        'column "Fy [N]": found [N] in the file, [lbf] in the mapping',
        'column "Fz": found no unit; expected a unit of force',
        'column "Mz [N]": found [N], a unit of another dimension',
        'column "Cx [-]": found "My" and "Cx" as M; expected one of them',
        'column "K": found the unidentified column "K"',
        'found no column "Fx"; expected one of "Drift", "Fy"',
    ):
        assert any(part in line for line in lines), part


def test_entries_of_columns_that_are_none_come_with_their_lines(tmp_path: Path) -> None:
    with pytest.raises(InputError) as why:
        read_raw_text(tmp_path, "a,b\n1,2\n", {"a": "beta [N]", "b": "Q [N]"})
    lines = str(why.value).splitlines()
    toml = (tmp_path / "campaign.toml").read_text().splitlines()
    at = toml.index('"a" = "beta [N]"') + 1
    assert f'campaign.toml, line {at}, "columns.a": found [N], a unit of another dimension' in lines[0]
    assert f'line {at + 1}, "columns.b": found the unknown name "Q"' in lines[1]


def test_cells_without_a_number_are_excluded_and_rows_without_a_setting_left_out(tmp_path: Path) -> None:
    text = "Drift (deg),Fy (N),Mz (Nm)\n-4,-1,2\n0,nan,0\n2,1e30,0\n4,diverged,nan\n,7,8\n8,2,-4\n"
    table = read_raw_text(tmp_path, text, {"Drift": "beta", "Fy": "Y", "Mz": "N"})
    assert [(e.line, e.component) for e in table.exclusions] == [(3, "Y"), (4, "Y"), (5, "Y"), (5, "N")]
    none = "no number in the source"
    assert [e.reason for e in table.exclusions] == [none, none, '"diverged" is no number', none]
    assert table.usable["Y"].tolist() == [True, False, False, False, True]
    assert table.lines == (2, 3, 4, 5, 7)
    assert "left out, no Drift: line 6" in table.notes


def test_cells_and_labels_and_standard_errors(tmp_path: Path) -> None:
    text = "Case,Set,Drift (deg),Fy (N),SE (N),Grid\na,A,-4,-1,0.1,1e6\nb,B,4,1,0.1,2e6\n"
    said = {"Case": "point", "Set": "label", "Drift": "beta", "Fy": "Y", "SE": "se_Y", "Grid": "cells"}
    table = read_raw_text(tmp_path, text, said, **{"table.select": '{ Set = "A", reason = "other grid" }'})
    assert table.labels == ("a", "b")
    assert table.cells.tolist() == [1e6, 2e6]
    assert table.errors["Y"].tolist() == [0.1, 0.1]
    assert [(e.row, e.reason) for e in table.exclusions] == [(1, "Set B: other grid")]


def test_columns_belong_to_raw_importers_only(write_campaign: object) -> None:
    folder = write_campaign(columns='Fy = "Y [N]"')  # type: ignore[operator]
    with pytest.raises(InputError, match=r'\[columns\] with importer = "csv"'):
        read_tables(PlannedTable(folder, ()))
    assert SECTIONS


PROPOSED = [
    ("Fy", "N", "Y [N]"), ("Fx", "lbf", "X [lbf]"), ("Force Z", "kN", "Z [kN]"), ("Mz", "N-m", "N [N*m]"),
    ("Moment_x", "N m", "K [N m]"), ("Yaw moment", "Nm", "N [Nm]"), ("Querkraft", "N", "Y [N]"), ("CY", "-", "Y [coefficient A=?]"),
    ("CN", "", "N [coefficient A=? L=?]"), ("Y'", "", "Y' [-]"), ("r'", "-", "r' [-]"), ("N_prime", "", "N' [-]"),
    ("Beta", "°", "beta [deg]"), ("Drift angle", "deg", "beta [deg]"), ("β", "Grad", "beta [deg]"), ("Angle d'attaque", "deg", "alpha [deg]"),
    ("yaw rate", "1/s", "r [rad/s]"), ("Speed", "kn", "U [kn]"), ("Fy", "", "Y [?]"), ("Fy", "m", "Y [?]"), ("Drag", "N", "drag [N]"),
    ("CL", "", "lift [coefficient A=?]"), ("Cd", "-", "drag [coefficient A=?]"), ("Lift", "lbf", "lift [lbf]"), ("drag", "", "drag [?]"),
    ("Cl", "", "lift [coefficient A=?]"), ("se_CD", "-", "se_drag [coefficient A=?]"), ("se_Fy", "N", "se_Y [N]"), ("Fy std", "N", ""), ("Cells", "", "cells"), ("Run", "", "point"), ("Comment", "", "ignore"),
    ("Geschw", "m/s", "U [m/s]"), ("Geschwindigkeit", "m/s", "U [m/s]"), ("velocity", "kn", "U [kn]"), ("Yaw Mom", "ft*lbf", "N [ft*lbf]"),
    ("Zeit", "s", "ignore"), ("time", "s", "ignore"), ("V", "m/s", ""),
    ("Rudder angle", "deg", "dr [deg]"), ("what", "", ""), ("y+", "", ""), ("x", "m", ""),
]  # fmt: skip


@pytest.mark.parametrize(("name", "unit", "text"), PROPOSED)
def test_proposals_by_the_names_that_people_use(name: str, unit: str, text: str) -> None:
    assert proposed(RawColumn(name, unit, np.array([1.0, 2.0]))).text == text


def test_proposals_are_certain_only_where_nobody_can_mean_otherwise() -> None:
    one = np.array([0.1, 2.0])
    assert proposed(RawColumn("Y", "N", one)).certain
    assert proposed(RawColumn("Force on hull", "N", one, means="Y")).certain
    assert not proposed(RawColumn("Fy", "N", one)).certain
    assert not proposed(RawColumn("Y", "", one)).whole
    assert proposed(RawColumn("drift", "", np.array([-12.0, 12.0]))).text == "beta [deg]"
    assert proposed(RawColumn("drift", "", one)).text == "beta [?]"
    assert proposed(RawColumn("Fy mean", "N", np.array([np.nan]), ("diverged",))).text == ""


def test_a_capital_v_is_the_speed_beside_an_angle_or_a_radius_alone() -> None:
    one = np.array([1.0, 2.0])

    def offer(*columns: tuple[str, str]) -> tuple[str, str]:
        made = proposals(RawTable(Path("t.csv"), tuple(RawColumn(n, u, one) for n, u in columns)))[0]
        return made.text, made.why

    assert offer(("V", "m/s"), ("Drift", "deg"))[0] == "U [m/s]"
    assert offer(("V", "kn"), ("R", "m"))[0] == "U [kn]"
    assert offer(("V", "m/s"), ("Drift", "deg"), ("U", "m/s"))[0] == ""
    assert offer(("V", "m/s"), ("Fy", "N")) == ("", "no known name; m/s: U, u, v, w, or ignore")
    assert offer(
        ("what", "Nm"),
    ) == ("", "no known name; Nm: K, M, N, or ignore")
    assert offer(
        ("what", "widgets"),
    ) == ("", "no known name")
    assert offer(("se_Rig Monitor", "N"))[1] == "no known name; N: se_X, se_Y, se_Z, or ignore"
    assert "z up (CFD, FLU), to port" in offer(("yaw rate", "deg/s"))[1]


@pytest.mark.parametrize(("name", "unit", "what"), [
    ("Driftwinkel β", "°", "beta [deg]"), ("Geschw. V", "m/s", "U [m/s]"), ("Querkraft Y", "N", "Y [N]"), ("Querkraft X", "N", ""),
    ("Geschw. v", "m/s", ""), ("Anstellwinkel β", "deg", ""), ("Drehrate r", "deg/s", "r [deg/s]"),
    ("Z1000", "", "Z' [1e-3]"), ("1000 Y'", "", "Y' [1e-3]"), ("N' x 1000", "-", "N' [1e-3]"), ("Z1000", "N", ""),
])  # fmt: skip
def test_a_name_with_its_symbol_behind_it(name: str, unit: str, what: str) -> None:
    assert proposed(RawColumn(name, unit, np.array([1.0, 2.0]))).text == what


@pytest.mark.parametrize(("name", "unit", "what", "size"), [
    *((name, "", "M' [1e-3]", 1e-3) for name in (
        "1000 M'", "M' x1000", "M' x 10^3", "M'x1000", "M'X1000", "M'*1000", "M′·10³", "M' ×1e3", "M'E3", "M', x1000", "10^3 M'", "1000xM'")),
    ("M'", "x10^-3", "M' [1e-3]", 1e-3), ("M' (10^-3)", "", "M' [1e-3]", 1e-3), ("M'", "10^3", "M' [1e3]", 1e3),
    ("CX x 1000", "", "X [coefficient A=2.0 m^2]", 1e-3), ("10^3 CX", "-", "X [coefficient A=2.0 m^2]", 1e-3),
    ("se_M' x1000", "", "se_M' [1e-3]", 1e-3), ("r' x 100", "", "r' [1e-2]", 1e-2), ("M x", "Nm", "K [Nm]", 1.0),
])  # fmt: skip
def test_a_factor_at_a_symbol_is_what_its_numbers_are_counted_in(name: str, unit: str, what: str, size: float) -> None:
    """``M' x1000`` was the roll moment, by its letters M and x."""
    column = RawColumn(name, unit, np.array([1.0, 2.0]))
    offer = proposed(column, {"coefficients.area": "2 m^2"})
    assert offer.text == what
    assert not (unit == "" and offer.certain)  # a factor in a name waits for a person
    assert with_unit(RawTable(Path("table.csv"), ()), column, read_column_map(offer.text)).factor == pytest.approx(
        size, rel=1e-12
    )


@pytest.mark.parametrize(("name", "unit"), [
    ("M' x 10^-3", ""), ("M' (x1e3)", ""), ("M'", "x10^3"), ("M' x 500", ""), ("M x1000", "N m"), ("10^-3 M'", ""),
])  # fmt: skip
def test_a_factor_that_reads_both_ways_is_asked(name: str, unit: str) -> None:
    column = RawColumn(name, unit, np.array([1.0, 2.0]))
    offer = proposed(column)
    assert (offer.text, offer.why.partition(":")[2]) == (
        "",
        " M' [1e-3] or [1e3] if it is a prime; else rename the column",
    )
    raw = RawTable(Path("table.csv"), ())
    if unit != "N m":
        with pytest.raises(InputError, match="power of ten"):
            with_unit(raw, column, read_column_map("M' [-]"))
        assert with_unit(raw, column, read_column_map("M' [1e-3]")).factor == 1e-3


@pytest.mark.parametrize("name", ["M' x y", "M'_x100", "M x 1000 y"])
def test_a_prime_and_a_factor_are_no_words_of_a_name(name: str) -> None:
    assert not proposed(RawColumn(name, "", np.array([1.0, 2.0]))).text.startswith("K")


@pytest.mark.parametrize("words", [
    "Kräfte im körperfesten System, Momente um Hauptspant", "forces, body-fixed", "Forces in body axes", "efforts, repère lié",
])  # fmt: skip
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_resistance_under_words_of_body_axes_is_x_of_the_body(tmp_path: Path, words: str, sign: float) -> None:
    file = tmp_path / "tank.csv"
    rows = "".join(f"{b};{sign * (50 + b * b)};{12 * b}\n" for b in (-4, -2, 0, 2, 4))
    file.write_text(f"{words};;\n;;\nDriftwinkel;Widerstand;Querkraft\n[deg];[N];[N]\n{rows}", encoding="utf-8")
    table = read_raw(file, "table")
    offers = proposals(table)
    assert [o.text for o in offers] == ["beta [deg]", "-X [N]" if sign > 0 else "X [N]", "Y [N]"]
    assert offers[1].note.startswith("X of the body" + ", reversed" * (sign > 0) + ': line 1: "')
    assert offers[1].note.endswith("; drag [N] if it is along the flow")
    shows = interpreted(table, {}, {}).shows
    assert not any("its name is that of drag" in e.text for e in shows)
    file.write_text(file.read_text(encoding="utf-8").replace(words, "Schleppversuche"), encoding="utf-8")
    assert proposals(read_raw(file, "table"))[1].text == "drag [N]"


def test_a_drag_beside_a_side_force_of_the_body_is_confirmed_with_its_other_reading(tmp_path: Path) -> None:
    """Turned by beta though it is X of the body, Xvv' takes Yv' and may change its sign."""
    file = tmp_path / "star.csv"
    file.write_text("beta [deg],Drag [N],Side Force [N],Lift [N]\n-4,50,12,1\n0,48,0,1\n4,50,-12,1\n")
    assert not proposals(read_raw(file, "table"))[1].note, "with lift beside it, along the flow"
    file.write_text("beta [deg],Drag [N],Side Force [N]\n-4,50,12\n0,48,0\n4,50,-12\n")
    table = read_raw(file, "table")
    line = next(
        one for one in form_together([Part("", table, "", {})], [interpreted(table, {}, {})], {}) if one.key == "Drag"
    )
    assert (line.group, line.value, line.pending) == (Group.GRAVE, "drag [N]", True)
    assert "Side Force is Y of the body" in line.why
    assert "-X [N] where x points forward, X [N] where aft" in line.why
    assert "Side Force is Y of the body" in " ".join(" ".join(screen([line])).split())


@pytest.mark.parametrize("frame", ["FRD", "CFD", "FLU"])
def test_evidence_says_where_the_force_acts_in_words_of_the_body(frame: str) -> None:
    """A side force 0.5 m forward of the point has N = +0.5 m Y in FRD; in axes with z up N turns, in CFD Y does not."""
    side = np.array([-3.0, -1.0, 1.0, 3.0])
    turned = {"FRD": (1.0, 1.0), "CFD": (1.0, -1.0), "FLU": (-1.0, -1.0)}[frame]
    values = {"beta [deg]": side, "Y [N]": turned[0] * side, "N [N*m]": turned[1] * 0.5 * side}
    table = RawTable(Path("t"), tuple(RawColumn(n.partition(" ")[0], "", v) for n, v in values.items()))
    known = assigned(table, {n.partition(" ")[0]: read_column_map(n) for n in values})
    texts = [e.text for e in evidence(known, parse_axes(frame))]
    hull = "that of a bare hull without large fins acts forward of midships"
    assert f"N / Y: the force acts forward of the reference point (x = 0.5 m); {hull}" in texts
    own = [e.text for e in evidence(known)]
    assert f"N / Y: the force acts toward {'+' if turned[0] * turned[1] > 0 else '-'}x of the reference point" in own


def test_evidence_says_to_which_side_a_rate_turns() -> None:
    table = RawTable(Path("t"), (RawColumn("r", "", np.array([0.1, 0.2])), RawColumn("Y", "", np.array([1.0, 2.0]))))
    known = assigned(table, {"r": read_column_map("r [rad/s]"), "Y": read_column_map("Y [N]")})
    for frame, side in (("FRD", "starboard"), ("CFD", "port"), ("FLU", "port")):
        assert any(e.text.startswith(f"r > 0 turns to {side}") for e in evidence(known, parse_axes(frame)))


@pytest.mark.parametrize("axes", AXES)
def test_evidence_finds_the_signs_of_angles_once_the_axes_are_known(tmp_path: Path, axes: str) -> None:
    file, said, settings = written(tmp_path, axes, "US", 0.0)
    table = raw(file, {})
    known = assigned(table, {name: read_column_map(what) for name, what in said.items()})
    shows = evidence(known, parse_axes(list(AXES[axes])))
    assert {e.key: f'"{e.value}"' for e in shows if e.key} == {k: settings[k] for k in ("axes.alpha", "axes.beta")}
    assert not any(e.key for e in evidence(known))
    texts = " | ".join(e.text for e in shows)
    assert "disagree" not in texts
    damped = {"M and q", "N and r"} if axes != "odd" else {"K and p", "N and r"}
    assert all(f"{pair} have opposite signs, as damping has" in texts for pair in damped)
    flipped = assigned(
        table, {name: read_column_map("-N [ft*lbf]" if what.startswith("N ") else what) for name, what in said.items()}
    )
    texts = " | ".join(e.text for e in evidence(flipped, parse_axes(list(AXES[axes]))))
    assert "N and r have the same sign: no damping of a slender body" in texts


def test_a_general_reader_gives_way_and_two_claims_are_a_question(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "test.raw"
    file.write_text("beta (deg),Y (N)\n1,2\n2,3\n3,4\n")
    assert recognised(file) == (NAME,)
    monkeypatch.setattr("coeflab.tables.reading.GENERAL", "nobody")
    with pytest.raises(InputError, match=f"something that {NAME} and table read; expected --as {NAME} or --as table"):
        importer_of(file)
    assert importer_of(file, "table") == "table"


@settings(max_examples=200)
@given(st.text(max_size=30) | st.from_regex(r"-?(se_)?[A-Za-z]{1,5}'?( \[[A-Za-z0-9^*/=. ]{0,20}\])?", fullmatch=True))
def test_any_text_is_a_column_or_a_clear_refusal(text: str) -> None:
    try:
        said = read_column_map(text)
    except InputError:
        return
    assert read_column_map(str(said)) == said


@pytest.mark.parametrize(
    ("unit", "size"), [("1e-3", 1e-3), ("10^-3", 1e-3), ("10⁻³", 1e-3), ("x 1e-3", 1e-3), ("%", 1e-2), ("-", 1.0)]
)
@pytest.mark.parametrize("by", ["row of units", "mapping"])
def test_primes_are_counted_in_what_the_row_of_units_says(write_campaign, by: str, unit: str, size: float) -> None:
    """A factor of 1000 that nobody saw: the row ``- | deg | 1e-3`` was read as data."""
    rows = [(-4.0, -1.5, 0.8), (0.0, 0.0, 0.0), (4.0, 1.5, -0.8)]
    row = unit if by == "row of units" else "-"
    text = f"Case;Drift;CY;CN\n-;deg;{row};{row}\n" + "".join(f"D{b:g};{b};{y};{n}\n" for b, y, n in rows)
    said = f" [{unit}]" if by == "mapping" else ""
    columns = f'\n[columns]\nCase = "label"\nDrift = "beta"\nCY = "Y\'{said}"\nCN = "N\'{said}"\n'
    by_table = SECTIONS["campaign"] + '\nimporter = "table"'
    folder = write_campaign(text, campaign=by_table, source=SECTIONS["source"] + "\n" + columns)
    (table,) = read_tables(PlannedTable(folder, ()))
    force = 0.5 * RHO * SPEED**2 * LENGTH**2
    np.testing.assert_allclose(table.forces["Y"], [size * force * y for _, y, _ in rows], rtol=1e-12, atol=1e-12)


def test_monitors_with_two_names_are_known_by_the_one_that_both_say() -> None:
    """STAR-CCM+ writes NAME OF THE MONITOR: NAME OF THE REPORT; where they differ a person says which."""
    offers = [proposed(RawColumn(name, unit, np.ones(2))) for name, unit in (
        ("Side Force Monitor: Fy", "kN"), ("se_Yaw Moment Monitor: Mz", "kN*m"), ("Drag Monitor: Fx", "kN"), ("Monitor 1: heat", "kN"),
    )]  # fmt: skip
    assert [o.text for o in offers] == ["Y [kN]", "se_N [kN*m]", "", ""]
    assert "drag or X by its name" in offers[2].why


@pytest.mark.parametrize("name", ["Moment um Hochachse", "Giermoment", "Moment de lacet"])
def test_german_and_french_words_that_end_as_a_standard_error_does(name: str) -> None:
    assert proposed(RawColumn(name, "Nm", np.ones(2))).text == "N [Nm]"


def test_a_unit_of_primes_that_cannot_be_read_is_refused(write_campaign) -> None:
    text = "Drift [deg];CY [E3x];CN [-]\n-4;1;1\n0;0;0\n4;-1;-1\n"
    columns = '\n[columns]\nDrift = "beta"\nCY = "Y\'"\nCN = "N\'"\n'
    by_table = SECTIONS["campaign"] + '\nimporter = "table"'
    folder = write_campaign(text, campaign=by_table, source=SECTIONS["source"] + "\n" + columns)
    with pytest.raises(InputError, match="1e-3"):
        read_tables(PlannedTable(folder, ()))
    with pytest.raises(InputError, match=r"\[%\] in the file, \[1e-3\] in the mapping"):
        with_unit(RawTable(folder, ()), RawColumn("CY", "%", np.ones(2)), read_column_map("Y' [1e-3]"))
    with pytest.raises(InputError, match="power of ten"):
        read_column_map("Y' [N]")


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("Lift Monitor", "lift"), ("Drag Monitor 1", "drag"), ("cl-report", "lift"), ("drag-force-report", "drag"), ("Total lift of model", "lift"),
        ("Gesamter Widerstand Modell", "drag"), ("Crossflow force", "side"), ("Fx Monitor", "X"), ("Side Force Monitor", "Y"), ("drag and lift", ""),
        ("cd of rig", ""),
    ],
)  # fmt: skip
def test_a_force_along_the_flow_is_known_by_a_word_and_warned_of_as_a_force_of_the_body(name: str, read: str) -> None:
    found = proposals(RawTable(Path("t.csv"), (RawColumn(name, "N", np.array([1.0, 2.0])),)))[0]
    assert found.text == (f"{read} [N]" if read else "")
    assert bool(unturned(name, read_column_map("-Z [N]"))) == (read in ("lift", "drag", "side"))


@pytest.mark.parametrize("half", ["", "starboard"])
def test_a_form_says_that_forces_are_of_the_whole_body_unless_a_half_is_declared(half: str, tmp_path: Path) -> None:
    """Forces of a half whose other half nobody doubled are wrong by a factor of two."""
    file = tmp_path / "attack.csv"
    file.write_text("alpha [deg],Z [N],M [N m]\n" + "".join(f"{a},{-3 * a},{2 * a}\n" for a in range(-6, 8, 2)))
    more = ["--set", f"campaign.half_model={half}"] if half else []
    said = CliRunner().invoke(app, ["import", str(file), "--out", str(tmp_path / "out"), *more]).output
    assert ("whole body" in said) == (not half)


@pytest.mark.parametrize(
    ("typed", "error"), [("drag [N]", "se_drag"), ("-Y [N]", "se_Y"), ("ignore", "ignore"), ("", "se_X")]
)
def test_a_standard_error_follows_its_force_when_a_format_names_both(typed: str, error: str) -> None:
    """Forces of a mesh that was turned in the flow are drag and side force: se_X of the case is then that of the drag."""
    values = np.ones(3)
    columns = (RawColumn("Fx", "N", values, means="X"), RawColumn("se_X", "N", values, means="se_X"))
    said = {"Fx": read_column_map(typed)} if typed else {}
    found = entry_of(columns[1], said, columns)
    assert found is not None
    assert found.plain == error
