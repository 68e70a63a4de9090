"""One physical table as every tool writes it: the same six derivatives, to all digits and to those that the tool prints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from coeflab.cli import app
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.cli.test_import import without_slopes
from tests.tables.test_excel import rows as sheet_rows
from tests.tables.test_excel import workbook
from tests.tables.test_mapping import AXES, LENGTH, MOTIONS, PLANTED, RHO, SIX, derivatives, in_axes, physics

__all__ = ["without_slopes"]

AREA, ITERATIONS = 0.31, 60
POINT = 2.0  # where moments count, aft of the nose: x of the solver's axes
OWN = in_axes(physics(0.0), AXES["CFD"])  # x aft, y starboard, z up, as meshes have it
FORCES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
MEANT = ("X", "Y", "Z", "K", "M", "N")
HEAD = "FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {};\n    object {};\n}}\n"
Digits = Callable[[float], str]
Said = list[str]


def vector(values: np.ndarray) -> str:
    return f"({' '.join(repr(float(v)) for v in values)})"


def run_list(folder: Path, names: list[str]) -> Path:
    """Conditions that the files do not state, in the axes of the solver."""
    units = ("m/s",) * 3 + ("rad/s",) * 3
    head = ["run", *(f"{m} [{u}]" for m, u in zip(MOTIONS, units, strict=True))]
    lines = [",".join([n, *(repr(float(v)) for v in row[:6])]) for n, row in zip(names, OWN, strict=True)]
    path = folder / "runs.csv"
    path.write_text("\n".join([",".join(head), *lines]) + "\n", encoding="utf-8")
    return path


def text_table(folder: Path, digits: Digits, mark: str = ";", decimal: str = ",") -> tuple[Path, Said]:
    names = [*(f"vel {m}" for m in MOTIONS), *FORCES]
    units = ["m/s"] * 3 + ["rad/s"] * 3 + ["N"] * 3 + ["Nm"] * 3
    lines = [mark.join(names), mark.join(units)]
    # What is set is exact, what is measured is printed.
    lines += [mark.join([*(repr(float(v)) for v in r[:6]), *map(digits, r[6:])]).replace(".", decimal) for r in OWN]
    path = folder / "tests.txt"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    said = [a for n, m in zip(names, [*MOTIONS, *MEANT], strict=True) for a in ("--map", f"{n}={m}")]
    return path, said


def tabs(folder: Path, digits: Digits) -> tuple[Path, Said]:
    return text_table(folder, digits, "\t", ".")


def sheet(folder: Path, digits: Digits) -> tuple[Path, Said]:
    names = [f"{f} ({'N' if i < 3 else 'Nm'})" for i, f in enumerate(FORCES) if f in ("Fy", "Fz", "My", "Mz")]
    places = [6 + FORCES.index(n[:2]) for n in names]
    moving = [1, 2, 4, 5]
    head = (*(f"vel {MOTIONS[i]} ({'m/s' if i < 3 else 'rad/s'})" for i in moving), *names)
    cells = [(*(float(r[i]) for i in moving), *(float(digits(r[k])) for k in places)) for r in OWN]
    path = workbook(folder / "tests.xlsx", Tests=sheet_rows(("Captive tests",), head, *cells))
    said = [a for i in moving for a in ("--map", f"vel {MOTIONS[i]}={MOTIONS[i]}")]
    return path, said + [a for n in names for a in ("--map", f"{n[:2]}={MEANT[FORCES.index(n[:2])]}")]


def openfoam(folder: Path, digits: Digits) -> tuple[Path, Said]:
    for k, row in enumerate(OWN):
        case = folder / "cases" / f"run{k:02d}"
        flow, rate = -row[:3], row[3:6]
        files = {
            "system/controlDict": HEAD.format("dictionary", "controlDict")
            + f"application simpleFoam;\nendTime {ITERATIONS};\nfunctions\n{{\n  forces\n  {{\n    type forces;\n    libs (forces);\n"
            f"    patches (hull);\n    rho rhoInf;\n    rhoInf {RHO!r};\n    CofR ({POINT!r} 0 0);\n  }}\n}}\n",
            "system/fvSchemes": HEAD.format("dictionary", "fvSchemes") + "ddtSchemes\n{\n    default steadyState;\n}\n",
            "constant/transportProperties": HEAD.format("dictionary", "transportProperties")
            + "transportModel Newtonian;\nnu 1e-06;\n",
        }
        if np.any(rate):
            size = float(np.linalg.norm(rate))
            # omega x (CofR - origin) is the velocity of the body.
            origin = np.array([POINT, 0.0, 0.0]) - np.cross(row[:3], rate) / size**2
            files["constant/MRFProperties"] = HEAD.format("dictionary", "MRFProperties") + (
                f"whole\n{{\n    cellZone all;\n    nonRotatingPatches (far);\n    origin {vector(origin)};\n"
                f"    axis {vector(rate / size)};\n    omega {size!r};\n}}\n"
            )
            flow = np.zeros(3)
        files["0/U"] = HEAD.format("volVectorField", "U") + (
            f"dimensions [0 1 -1 0 0 0 0];\ninternalField uniform {vector(flow)};\nboundaryField\n{{\n    far\n    {{\n"
            f"        type freestreamVelocity;\n        freestreamValue uniform {vector(flow)};\n    }}\n}}\n"
        )
        for i, (name, kind) in enumerate((("force", "Force"), ("moment", "Moment"))):
            total = " ".join(map(digits, row[6 + 3 * i : 9 + 3 * i]))
            zero = " ".join([digits(0.0)] * 3)
            head = f"# {kind}\n# CofR : ({POINT!r} 0 0)\n#\n# Time \ttotal_x total_y total_z\tpressure_x pressure_y pressure_z\tviscous_x viscous_y viscous_z\n"
            files[f"postProcessing/forces/0/{name}.dat"] = head + "".join(
                f"{t}\t{total}\t{total}\t{zero}\n" for t in range(1, ITERATIONS + 1)
            )
        for name, content in files.items():
            path = case / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")
    return folder / "cases", []


def su2(folder: Path, digits: Digits) -> tuple[Path, Said]:
    scale = 0.5 * RHO * 4.0 * AREA
    for k, row in enumerate(OWN):
        case = folder / "cases" / f"run{k:02d}"
        case.mkdir(parents=True)
        flow, rate, motion = -row[:3], row[3:6], ""
        if np.any(rate):
            origin = np.array([POINT, 0.0, 0.0]) - np.cross(row[:3], rate) / float(rate @ rate)
            numbers = [" ".join(repr(float(v)) for v in x) for x in (origin, rate)]
            motion = f"GRID_MOVEMENT= ROTATING_FRAME\nMOTION_ORIGIN= {numbers[0]}\nROTATION_RATE= {numbers[1]}\n"
            flow = np.zeros(3)
        (case / "hull.cfg").write_text(
            f"SOLVER= INC_RANS\nSYSTEM_MEASUREMENTS= SI\nINC_DENSITY_INIT= {RHO!r}\n"
            f"INC_VELOCITY_INIT= ( {', '.join(repr(float(v)) for v in flow)} )\nINC_NONDIM= REFERENCE_VALUES\n"
            f"INC_DENSITY_REF= {RHO!r}\nINC_VELOCITY_REF= 2.0\n{motion}REF_ORIGIN_MOMENT_X= {POINT!r}\n"
            f"REF_ORIGIN_MOMENT_Y= 0.0\nREF_ORIGIN_MOMENT_Z= 0.0\nREF_LENGTH= {LENGTH!r}\nREF_AREA= {AREA!r}\n",
            encoding="utf-8",
        )
        values = row[6:] / scale / np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])
        shown = ", ".join(map(digits, [*values[3:], *values[:3]]))
        head = ['"Time_Iter"', '"Outer_Iter"', '"Inner_Iter"', '    "rms[P]"    ']
        head += [f'"C{n}"' for n in ("Mx", "My", "Mz", "Fx", "Fy", "Fz")]
        lines = [f"0, 0, {t}, {-3.0 - 0.1 * t:.3f}, {shown}" for t in range(ITERATIONS)]
        (case / "history.csv").write_text("\n".join([",".join(head), *lines]) + "\n", encoding="utf-8")
    return folder / "cases", []


def monitors(folder: Path, head: Callable[[int], str], row_of: Callable[[int, list[str]], str], digits: Digits, end: str) -> list[str]:  # fmt: skip
    names = []
    for k, row in enumerate(OWN):
        name = f"run{k:02d}"
        texts = [digits(v) for v in row[6:]]
        lines = [head(k), *(row_of(t, texts) for t in range(1, ITERATIONS + 1))]
        path = folder / "cases" / f"{name}{end}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        names.append(name)
    return names


def starccm(folder: Path, digits: Digits) -> tuple[Path, Said]:
    units = ["N"] * 3 + ["N-m"] * 3
    shown = [f'"{f} Monitor: {f} Monitor ({u})"' for f, u in zip(FORCES, units, strict=True)]
    head = ",".join(['"Iteration"', *shown])
    names = monitors(folder, lambda _: head, lambda t, v: ",".join([str(t), *v]), digits, ".csv")
    said = [a for f, m in zip(FORCES, MEANT, strict=True) for a in ("--map", f"{f} Monitor={m}")]
    return folder / "cases", ["--runs", str(run_list(folder, names)), *said]


def fluent(folder: Path, digits: Digits) -> tuple[Path, Said]:
    said = [a for f, m in zip(FORCES, MEANT, strict=True) for a in ("--map", f"{f.lower()}={m} [{'N' if m in 'XYZ' else 'N*m'}]")]  # fmt: skip
    names = " ".join(f'"{f.lower()}"' for f in FORCES)
    head = f'"forces-rfile"\n"Iteration" "fx etc.."\n("Iteration" {names})'
    made = monitors(folder, lambda _: head, lambda t, v: " ".join([str(t), *v]), digits, "/forces-rfile.out")
    return folder / "cases", ["--runs", str(run_list(folder, made)), *said]


def cfx(folder: Path, digits: Digits) -> tuple[Path, Said]:
    said = [a for f, m in zip(FORCES, MEANT, strict=True) for a in ("--map", f"{f}={m} [{'N' if m in 'XYZ' else 'N*m'}]")]  # fmt: skip
    head = ",".join(['"ACCUMULATED TIMESTEP"', *(f'"USER POINT,{f}"' for f in FORCES)])
    made = monitors(folder, lambda _: head, lambda t, v: ",".join([str(t), *v]), digits, ".csv")
    return folder / "cases", ["--runs", str(run_list(folder, made)), *said]


def simman(folder: Path, digits: Digits) -> tuple[Path, Said]:
    """Horizontal and vertical tests are of one layout: what a heaving ship would be has no columns there."""
    names = ["Time", "X", "Y", "N", "psi", "u", "v", "r", "udot", "vdot", "rdot", "Z", "M", "w", "q"]
    lines = [" ".join(names)]
    for row in OWN:
        own = dict(zip([*MOTIONS, *MEANT], row, strict=True))
        lines.append(" ".join(digits(own[n]) if n in MEANT else repr(float(own.get(n, 0.0))) for n in names))
    path = folder / "tests.dat"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    more = [a for n, u in (("Z", "N"), ("M", "N*m"), ("w", "m/s"), ("q", "rad/s")) for a in ("--map", f"{n}={n} [{u}]")]
    return path, [*more, "--set", "axes.frame=CFD"]


FORMATS = (text_table, tabs, sheet, pytest.param(openfoam, marks=pytest.mark.slow), su2, starccm, fluent, cfx, simman)
SETTINGS = {
    "axes.frame": "CFD", "axes.datum": "nose", "axes.reference_point": f"[{-POINT}, 0, 0]", "scaling.length_name": "LBP",
    "scaling.length": repr(LENGTH), "conditions.density": repr(RHO), "conditions.speed": "2.0", "source.kind": "synthetic",
    "source.citation": "synthetic", "table.contains_inertia": "false",
}  # fmt: skip
# Digits of each tool's own output, and what they leave of a derivative.
PRINTED = {"openfoam": "{:.6e}", "su2": "{:.10g}", "cfx": "{:.8e}"}


def imported(folder: Path, write: Callable[[Path, Digits], tuple[Path, Said]], digits: Digits) -> dict[str, float]:
    path, said = write(folder, digits)
    out = folder / "imported"
    settings = [a for key, text in SETTINGS.items() for a in ("--set", f"{key}={text}")]
    done = CliRunner().invoke(app, ["import", str(path), "--out", str(out), "--yes", *said, *settings])
    assert done.exit_code == 0, done.output + str(done.exception)
    (table,) = read_tables(PlannedTable(out, ()))
    assert len(table) == len(OWN)
    return derivatives(table)


@pytest.mark.parametrize("write", FORMATS, ids=lambda w: w.__name__)
def test_every_format_gives_the_six_derivatives_to_all_digits(
    tmp_path: Path, write: Callable[..., tuple[Path, Said]]
) -> None:
    found = imported(tmp_path, write, lambda v: repr(float(v)))
    for symbol in SIX:
        assert found[symbol] == pytest.approx(PLANTED[symbol][0], rel=1e-10), symbol


@pytest.mark.parametrize("write", FORMATS, ids=lambda w: w.__name__)
def test_as_the_tool_prints_it_the_derivatives_are_those_of_the_printed_digits(
    tmp_path: Path, write: Callable[..., tuple[Path, Said]]
) -> None:
    shape = PRINTED.get(write.__name__, "{:.7g}")
    found = imported(tmp_path, write, lambda v: shape.format(float(v)))
    for symbol in SIX:
        assert found[symbol] == pytest.approx(PLANTED[symbol][0], rel=3e-6), symbol
