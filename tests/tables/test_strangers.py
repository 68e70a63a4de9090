"""Six files as strangers have them, from the file to first slopes: one command and two lines on a terminal, two commands elsewhere.

All synthetic: the slopes below are planted, with noise of a stated seed, and have to lie inside the printed U95.
"""

from __future__ import annotations

import fcntl
import os
import pty
import re
import shlex
import struct
import subprocess
import termios
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import COEFLAB
from tests.cli.test_import import command_of, invoke, left_open, table_of, without_slopes

__all__ = ["without_slopes"]

YV, NV, YR, NR = -0.0231, -0.0118, 0.0042, -0.0036  # planted
RHO, U, L = 998.2, 2.0, 4.0
Q = 0.5 * RHO * U**2 * L**2
BETA = np.array([-12.0, -9, -6, -4, -2, 0, 2, 4, 6, 9, 12])


def primes(beta: np.ndarray, r: float | np.ndarray = 0.0, seed: int = 17) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """X', Y', N' in FRD, v' = -sin(beta)."""
    v, noise = -np.sin(np.radians(beta)), np.random.default_rng(seed).normal(0.0, 1.0, (2, len(beta)))
    y = YV * v - 0.05 * v * np.abs(v) + YR * r + 2e-5 * noise[0]
    n = NV * v + 0.01 * v * np.abs(v) + NR * r + 8e-6 * noise[1]
    return -0.0026 - 0.004 * v**2 + 0.0 * y, y, n


def german(folder: Path) -> str:
    """Semicolons, decimal commas, cp1252; lines over the table say all but which way the axes point."""
    x, y, n = primes(BETA)
    rows = [f"{i};{b:g};{Q * x[i]:.2f};{Q * y[i]:.2f};{Q * L * n[i]:.2f};" for i, b in enumerate(BETA)]
    head = "Schlepptank Nordhafen;;;;;\nv = 2,0 m/s; Lpp = 4,0 m; Wassertemperatur 20 °C;;;\nMomente um Hauptspant;;;;;\n\n"
    names = "Versuch;Driftwinkel;Kraft längs;Kraft quer;Moment um Hochachse;Bemerkung\n-;Grad;N;N;Nm;-\n"
    (folder / "Schräg.csv").write_bytes((head + names + "\n".join(rows).replace(".", ",") + "\n").encode("cp1252"))
    return "Schräg.csv"


def starccm(folder: Path) -> str:
    """A table of reports, x aft, y to starboard, z up; drag positive, the unit behind each name."""
    x, y, n = primes(BETA)
    head = '"Drift Angle (deg)","Force X Monitor: Force X (N)","Side Force Monitor: Fy (N)","Yaw Moment Monitor: Mz (N-m)","Cells"\n'
    rows = [f"{b:.1f},{-Q * x[i]:.8e},{Q * y[i]:.8e},{-Q * L * n[i]:.8e},4200000" for i, b in enumerate(BETA)]
    (folder / "reports.csv").write_text(head + "\n".join(rows) + "\n")
    return "reports.csv"


def openfoam(folder: Path) -> str:
    """A case an angle; only the names of the folders say which."""
    x, y, n = primes(BETA)
    for i, b in enumerate(BETA):
        case = folder / "sweep" / f"drift_{'m' if b < 0 else 'p'}{abs(b):g}" / "postProcessing" / "forces" / "0"
        case.mkdir(parents=True)
        for name, values in (("force", (-Q * x[i], Q * y[i], 0.0)), ("moment", (0.0, 0.0, -Q * L * n[i]))):
            wobble = np.random.default_rng(i).normal(0.0, 0.002 * Q * 0.01, (120, 3))
            lines = "\n".join(
                f"{t}\t" + "\t".join(f"{v:.8e}" for v in row) for t, row in enumerate(np.array(values) + wobble, 1)
            )
            head = f"# {name.title()}\n# CofR : (2.0e+00 0.0e+00 0.0e+00)\n#\n# Time\ttotal_x\ttotal_y\ttotal_z\n"
            (case / f"{name}.dat").write_text(head + lines + "\n")
    return "sweep"


def coefficients(folder: Path) -> str:
    """CX, CZ and CMy over an area in the axes of a mesh with y up: the side force is along z, the yaw about y."""
    x, y, n = primes(BETA)
    area = 0.5
    head = f"# coefficients, Aref = {area} m^2, Lref = 4.0 m; axes: x forward, y up, z starboard\nbeta,CX,CZ,CMy\n"
    by = L**2 / area
    rows = [f"{b:g},{by * x[i]:.6f},{by * y[i]:.6f},{-by * n[i]:.6f}" for i, b in enumerate(BETA)]
    (folder / "coeffs.csv").write_text(head + "\n".join(rows) + "\n")
    return "coeffs.csv"


def arm(folder: Path) -> str:
    """A rotating arm with R and U, drift and turn; the balance carries the model, 300 kg, centre of gravity 0.1 m ahead."""
    radius = np.repeat([8.0, 10.0, 13.0, 18.0, 27.0], 5)
    beta = np.tile([-8.0, -4.0, 0.0, 4.0, 8.0], 5)
    r = L / radius
    x, y, n = primes(beta, r)
    v, omega = -U * np.sin(np.radians(beta)), U / radius
    u = U * np.cos(np.radians(beta))
    mass, ahead = 300.0, 0.1
    fy = Q * y - mass * u * omega
    mz = Q * L * n - mass * ahead * u * omega
    fx = Q * x + mass * (v * omega + ahead * omega**2)
    rows = [f"{i + 1},{radius[i]:g},{U:g},{beta[i]:g},{fx[i]:.3f},{fy[i]:.3f},{mz[i]:.3f}" for i in range(len(beta))]
    (folder / "arm.csv").write_text("Run,R (m),U (m/s),Drift (deg),Fx (N),Fy (N),Mz (Nm)\n" + "\n".join(rows) + "\n")
    return "arm.csv"


def marked(folder: Path) -> str:
    """A tank's table with a column of marks, a starred run and a starred number; the marked rows are far off."""
    x, y, n = primes(BETA)
    rows = []
    for i, b in enumerate(BETA):
        off = 40.0 * (i in (3, 8))
        star = "*" * (i == 3)
        rows.append(
            f"{i + 1}{star}\t{b:g}\t{Q * x[i]:.2f}\t{Q * y[i] + off:.2f}\t{Q * L * n[i]:.2f}{'*' * (i == 6)}\t{'*' * (i == 8)}"
        )
    (folder / "tank.txt").write_text("run\tdrift\tX\tY\tN\tmark\n-\tdeg\tN\tN\tNm\t\n" + "\n".join(rows) + "\n")
    return "tank.txt"


@dataclass(frozen=True)
class Stranger:
    """A file and what its owner knows beside it."""

    write: Callable[[Path], str]
    knows: dict[str, str]
    slopes: dict[str, float]


DRIFT = {"Yv": YV, "Nv": NV}
SIZES = {"scaling.length": "4 LOA", "conditions.density": "998.2", "conditions.speed": "2"}
STRANGERS = {
    "german": Stranger(german, {"axes.frame": "FRD"}, DRIFT),
    "starccm": Stranger(starccm, {"axes.frame": "CFD", "axes.reference_point": "midship", **SIZES}, DRIFT),
    "openfoam": Stranger(openfoam, {"axes.frame": "CFD", **SIZES}, DRIFT),
    "coefficients": Stranger(coefficients, {"axes.reference_point": "cg"}, DRIFT),
    "arm": Stranger(
        arm,
        {"axes.frame": "FRD", "axes.reference_point": "midship", "scaling.length": "4 LOA", "conditions.density": "998.2",
         "table.contains_inertia": "true", "inertia.mass": "300", "inertia.centre_of_gravity": "0.1"},
        {**DRIFT, "Yr": YR, "Nr": NR},
    ),
    "marked": Stranger(marked, {"axes.frame": "FRD", "axes.reference_point": "-2 from nose", **SIZES}, DRIFT),
}  # fmt: skip


def on_a_terminal(folder: Path, command: list[str], answers: list[str]) -> tuple[int, str]:
    """Run a command on a pseudo-terminal of 80 columns with everything typed ahead, and the end of input behind it."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 80, 0, 0))
    with subprocess.Popen(command, cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, close_fds=True) as process:
        os.close(theirs)
        os.write(ours, ("\n".join(answers) + "\n\x04").encode())
        seen = b""
        while True:
            try:
                block = os.read(ours, 4096)
            except OSError:  # the terminal of a process that ended
                break
            if not block:
                break
            seen += block
    os.close(ours)
    return process.returncode, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", seen.decode().replace("\r\n", "\n"))


@pytest.mark.parametrize("name", STRANGERS)
def test_two_commands_without_a_terminal(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The form leaves open what its owner knows and the file does not; the command below it, filled in, is the second."""
    one = STRANGERS[name]
    monkeypatch.chdir(tmp_path)
    form = invoke("import", one.write(tmp_path), "--out", "out")
    asked = left_open(form)
    assert set(asked) <= set(one.knows)
    assert max(map(len, form.output.splitlines())) <= 80
    assert len(form.output.splitlines()) <= 60
    words = [f"{key}={one.knows[key]}" if (key := w.partition("=")[0]) in asked else w for w in command_of(form.output)]
    beside = [a for key, value in one.knows.items() if key not in asked for a in ("--set", f"{key}={value}")]
    done = invoke(*words, *beside)
    assert done.exit_code == 0, done.output
    assert len(table_of(tmp_path / "out")) >= len(BETA)


@pytest.mark.slow
@pytest.mark.parametrize("name", STRANGERS)
def test_one_command_and_two_lines_on_a_terminal(name: str, tmp_path: Path) -> None:
    one = STRANGERS[name]
    file = one.write(tmp_path)
    line = "; ".join(f"{key}={value}" for key, value in one.knows.items())
    code, said = on_a_terminal(tmp_path, [str(COEFLAB), "import", file, "--out", "out"], [line, ""])
    assert code == 0, said
    assert said.count("N ? explains") == 2  # prompts: what the owner knows, then an empty line
    for symbol, planted in one.slopes.items():
        found = re.search(rf"{symbol}'(?: \*)? +(\S+) +(\S+) ", said.partition("First slopes")[2])
        assert found, said
        assert abs(float(found[1]) - planted) <= float(found[2]), (symbol, found[0], planted)
    if name == "marked":
        assert "4*, 9: marked uncertain in the file; 7 N: blank in the source." in " ".join(said.split())
    assert shlex.split(said.rpartition("Next: ")[2])[:2] == ["coeflab", "fit"]
