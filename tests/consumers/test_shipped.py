"""Shipped vehicles in every code target, run: turned to either side, and from ahead to astern and back, each as `simulate` moves it.

Octave's function and the class are marched by Runge and Kutta here, as docs/simulators.md does; C, FMPy and xdyn march by themselves. Where a
target holds the lag of a thruster, all have one but HUUV's, whose thrust jumps at the end of a dead zone: on the way through, steps of .01 s miss by
2.4e-3.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.formats import EXPORTERS, BuiltExporter
from coeflab.formats.export import export
from coeflab.formats.xdyn.actuators import command_names
from coeflab.law.symbols import MOTIONS
from coeflab.law.transforms import velocity_transfer
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.simulators import rigid_body
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import ParameterThruster
from tests.consumers.lxdyn_environment import PYTHON
from tests.consumers.test_lxdyn import in_xdyn

pytestmark = pytest.mark.slow
STEP, LIMIT = 0.05, 1e-3  # s; of the peak of the translations, of the rotations
LAG, LATE = 0.4, ("python_vehicle_simulator", "c", "c++", "fmi")  # s, in targets with a place for it
OCTAVE = shutil.which("octave-cli")
PUSH = {  # of a vehicle whose file states no thruster
    "name": "push", "position": (0.0, 0.0, 0.0), "direction": (1.0, 0.0, 0.0),
    "curve": {"command": "thrust", "unit": "N", "segments": [{"low": -1e3, "high": 1e3, "coefficients": [0.0, 1.0]}]},
}  # fmt: skip


class Run(NamedTuple):
    """Speed at the start, and (seconds, orders) one after the other; whether it comes to go astern."""

    speed: float
    phases: tuple[tuple[float, dict[str, float]], ...]
    astern: bool = True


def _doublet(control: str, angle: float, ahead: dict[str, float], back: dict[str, float]) -> Run:
    at, to, no = {control: angle}, {control: -angle}, {control: 0.0}
    return Run(1.0, ((3.0, at | ahead), (3.0, to | ahead), (11.0, no | back), (13.0, no | ahead)))


RUNS = {
    "remus100": _doublet("dr", 0.1, {"push": 6.0}, {"push": -9.0}),
    "suboff": Run(1.0, ((2.0, {"dr": 0.2, "push": 100.0}), (2.0, {"dr": -0.2, "push": 0.0}), (2.5, {"dr": 0.0, "push": -800.0}),
                        (3.5, {"push": 700.0}))),
    # Astern it is unstable: from a straight course, and not for long.
    "huuv": Run(1.0, ((3.0, {"left": 70.0, "right": 50.0}), (3.0, {"left": 50.0, "right": 70.0}), (6.0, {"left": 60.0, "right": 60.0}),
                      (3.5, {"left": -100.0, "right": -100.0}), (14.5, {"left": 80.0, "right": 80.0}))),
    "huuv_5dof": _doublet("db", 0.5, {"left": 70.0, "right": 60.0}, {"left": -100.0, "right": -100.0}),
    "thauv_case_01_dive_1": Run(0.5, ((5.0, {"left": 9.0, "right": 3.0}), (10.0, {"left": -10.0, "right": -10.0})), False),
    "flyingfish_water": Run(1.0, (
        (3.0, {"rotor1": 1500.0, "rotor1.tilt": 1.4, "rotor2": 1200.0, "rotor2.tilt": -1.4, "rotor3": 500.0, "rotor3.tilt": 0.3}),
        (3.0, {"rotor1": 1200.0, "rotor2": 1500.0})), False),
}  # fmt: skip


@cache
def _shipped(name: str) -> ParameterFile:
    return read_parameter_file(Path(name))


def file_of(name: str, request: pytest.FixtureRequest, lag: float | None = None) -> ParameterFile:
    if name == "suboff":
        study: Study = request.getfixturevalue("suboff")
        found = study.parameter_files["suboff_fully_appended"]
    else:
        found = _shipped(name)
    thrusters = found.thrusters or (ParameterThruster.model_validate(PUSH),)
    late = tuple(t.model_copy(update={"lag": lag}) for t in thrusters)
    return found.model_copy(update={"name": "file", "thrusters": late})


def moved(file: ParameterFile) -> Vehicle:
    """With the motions that programs move: those whose inertia the file states."""
    mass = file.mass
    turning = "pqr" if mass.inertia_matrix is not None else "qr" if mass.inertia is not None else ""
    return vehicle(file, free=tuple("uvw" + turning))


def due(name: str, file: ParameterFile) -> tuple[np.ndarray, np.ndarray]:
    """Times and velocities (n, 6) of `simulate`."""
    run, v = RUNS[name], moved(file)
    phases = tuple(Phase(f"phase {k}", orders, seconds) for k, (seconds, orders) in enumerate(run.phases))
    start = np.array([run.speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    plan = Manoeuvre("doublet and reversal", phases, start, orders=run.phases[0][1])
    found = rigid_body.simulate(v, plan, {"record": STEP, "tolerance": 1e-10})
    times, first = np.unique(np.round(found.time, 9), return_index=True)
    if run.astern:
        assert found.velocity[:, 0].min() < -0.5, name
        assert found.velocity[-1, 0] > 0.5, name
    return times, found.velocity[first]


def rows_of(name: str, file: ParameterFile) -> np.ndarray:
    """A row a step: dr ds db, a command of each thruster, a tilt of each."""
    standing: dict[str, float] = {}
    keys = ["dr", "ds", "db", *(t.name for t in file.thrusters), *(f"{t.name}.tilt" for t in file.thrusters)]
    out = []
    for seconds, orders in RUNS[name].phases:
        standing |= orders
        out += [[standing.get(k, 0.0) for k in keys]] * round(seconds / STEP)
    return np.array(out)


def written(file: ParameterFile, target: str, folder: Path) -> dict[str, bytes]:
    plugin = EXPORTERS.load(target)
    files = dict(plugin.render(file))
    files = dict(plugin.built(files)) if isinstance(plugin, BuiltExporter) else files
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return files


MSS = """1;
L = dlmread('orders.txt');
[~, MA, h] = file(zeros(6,1));
S = @(a) [0 -a(3) a(2); a(3) 0 -a(1); -a(2) a(1) 0];
if isfield(h, 'I11'), I = [h.I11 h.I12 h.I13; h.I21 h.I22 h.I23; h.I31 h.I32 h.I33]; free = 1:6;
else, I = diag([0 h.I_transverse h.I_transverse]); free = [1 2 3 5 6]; end
if isfield(h, 'zG'), c = [h.xG; h.yG; h.zG]; else, c = [h.mxG/h.m; 0; 0]; end
if isfield(h, 'volume'), b = [h.xB; h.yB; h.zB]; W = h.m*h.g; B = h.rho*h.volume*h.g; else, b = c; W = 0; B = 0; end
MRB = [h.m*eye(3), -h.m*S(c); h.m*S(c), I];
CRB = @(w) [h.m*S(w), -h.m*S(w)*S(c); h.m*S(c)*S(w), -S(I*w)];
down = @(q) [2*(q(2)*q(4) - q(1)*q(3)); 2*(q(3)*q(4) + q(1)*q(2)); q(1)^2 - q(2)^2 - q(3)^2 + q(4)^2];
n = columns(L) - 3;  M = MRB + MA;
function d = rate(s, tau, M, CRB, down, W, B, c, b, S, free)
  q = s(1:4)/norm(s(1:4));  w = s(8:10);  nu = zeros(6,1);  z = down(q);
  k = tau + [(W - B)*z; S(c*W - b*B)*z] - CRB(w)*s(5:10);
  nu(free) = M(free,free) \\ k(free);
  d = [-0.5*q(2:4)'*w; 0.5*(q(1)*w + cross(q(2:4), w)); nu];
end
s = [1; 0; 0; 0; START; zeros(5,1)];  dt = STEP;
printf('%.12g ', s(5:10)); printf('\\n');
for j = 1:rows(L)
  f = @(s) rate(s, file(s(5:10), L(j,1:3)', L(j,4:end)'), M, CRB, down, W, B, c, b, S, free);
  k1 = f(s);  k2 = f(s + dt/2*k1);  k3 = f(s + dt/2*k2);  k4 = f(s + dt*k3);
  s = s + dt/6*(k1 + 2*k2 + 2*k3 + k4);  s(1:4) = s(1:4)/norm(s(1:4));
  printf('%.12g ', s(5:10)); printf('\\n');
end
"""


def by_octave(name: str, file: ParameterFile, folder: Path) -> np.ndarray:
    written(file, "mss", folder)
    np.savetxt(folder / "orders.txt", rows_of(name, file))
    script = MSS.replace("START", repr(RUNS[name].speed)).replace("STEP", repr(STEP))
    (folder / "run.m").write_text(script, encoding="utf-8")
    done = subprocess.run(
        [str(OCTAVE), "--norc", "--quiet", "run.m"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])


CLASS = """
import json, math, sys
import numpy as np
sys.path.insert(0, sys.argv[1])
from file import file
v, (rows, speed, h) = file(), json.load(sys.stdin)
def rate(s, u):
    # dynamics() gives one step of Euler's: of one second, its rates; without a rate of angles the orders are the angles
    q, nu = s[:4] / np.linalg.norm(s[:4]), s[4:]
    eta = np.zeros(6)
    eta[3] = math.atan2(2 * (q[2]*q[3] + q[0]*q[1]), 1 - 2 * (q[1]**2 + q[2]**2))
    eta[4] = math.asin(max(-1.0, min(1.0, 2 * (q[0]*q[2] - q[1]*q[3]))))
    nu_dot = v.dynamics(eta, nu, u, u, 1.0)[0] - nu
    w = nu[3:]
    return np.concatenate([[-0.5 * q[1:] @ w], 0.5 * (q[0] * w + np.cross(q[1:], w)), nu_dot])
s = np.array([1.0, 0, 0, 0, speed, 0, 0, 0, 0, 0])
out = [s[4:].tolist()]
actual, turned = None, getattr(v, "turned", lambda before, order, seconds: order)  # of a class with a lag or a rate
for row in rows:
    u = np.array([*row[:3], 0.0, *row[3:3 + v.dimU - 4]])
    actual = u if actual is None else np.array([*u[:4], *actual[4:]])  # thrusters alone are on their way
    now, middle, after = (turned(actual, u, t) for t in (0.0, h/2, h))
    a = rate(s, now); b = rate(s + h/2*a, middle); c = rate(s + h/2*b, middle)
    s = s + h/6 * (a + 2*b + 2*c + rate(s + h*c, after))
    actual = after
    s[:4] /= np.linalg.norm(s[:4])
    out.append(s[4:].tolist())
print(json.dumps(out))
"""


def by_class(name: str, file: ParameterFile, folder: Path) -> np.ndarray:
    written(file, "python_vehicle_simulator", folder)
    done = subprocess.run(
        [sys.executable, "-I", "-c", CLASS, str(folder)], capture_output=True, text=True, check=False,
        input=json.dumps([rows_of(name, file).tolist(), RUNS[name].speed, STEP]),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return np.array(json.loads(done.stdout))


MAIN = """#include "file.h"
#include <stdio.h>
#define N %(n)d
int main(void)
{
    file_state s = {{0, 0, 0}, {1, 0, 0, 0}, {%(speed)r, 0, 0, 0, 0, 0}, {0, 0, 0}};
    double row[3 + 2 * N], actual[N], external[6];
    int k, first = 1;
    for (;;) {
        for (k = 0; k < 6; k++) printf("%%.12g ", s.nu[k]);
        printf("\\n");
        for (k = 0; k < 3 + 2 * N; k++) if (scanf("%%lf", &row[k]) != 1) return 0;
        for (k = 0; k < N && first; k++) actual[k] = row[3 + k];
        first = 0;
        for (k = 0; k < 5; k++) {
            file_spin(row + 3, %(step)r / 2, actual);
            file_thrust(actual, row + 3 + N, external);
            if (file_step(&s, row, external, %(step)r)) return 1;
            file_spin(row + 3, %(step)r / 2, actual);
        }
    }
}
"""


def by_c(name: str, file: ParameterFile, folder: Path, compiler: str = "gcc") -> np.ndarray:
    written(file, "c", folder)
    main = MAIN % {"n": len(file.thrusters), "speed": RUNS[name].speed, "step": STEP / 5.0}
    (folder / "main.c").write_text(main, encoding="utf-8")
    command = [compiler, "-std=c99", "-Wall", "-Werror", "-pedantic", "-O2", "file.c", "main.c", "-lm", "-o", "run"]
    if compiler == "g++":
        command = [compiler, "-x", "c++", "-std=c++17", "-Wall", "-Werror", "-O2", "file.c", "main.c", "-o", "run"]
    built = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    rows = "\n".join(" ".join(map(repr, r)) for r in rows_of(name, file).tolist())
    done = subprocess.run([str(folder / "run")], input=rows, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])


def by_cpp(name: str, file: ParameterFile, folder: Path) -> np.ndarray:
    return by_c(name, file, folder, "g++")


def by_fmpy(name: str, file: ParameterFile, folder: Path) -> np.ndarray:
    fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed (dependency group test)")
    written(file, "fmi", folder)
    orders = rows_of(name, file)
    inputs = ["control.dr", "control.ds", "control.db", *(f"thruster.{t.name}" for t in file.thrusters)]
    inputs += [f"tilt.{t.name}" for t in file.thrusters]
    rows = np.zeros(len(orders), dtype=[("time", float), *((n, float) for n in inputs)])
    rows["time"] = STEP * np.arange(len(orders))
    for k, n in enumerate(inputs):
        rows[n] = orders[:, k]
    found = fmpy.simulate_fmu(
        str(folder / "file.fmu"), stop_time=STEP * len(orders), step_size=STEP, output_interval=STEP, input=rows,
        fmi_type="CoSimulation", start_values={"start.u": RUNS[name].speed},
    )  # fmt: skip
    return np.column_stack([found[f"velocity.{m}"] for m in MOTIONS])


def by_xdyn(name: str, file: ParameterFile, folder: Path) -> np.ndarray:
    if not PYTHON.exists():
        pytest.skip("lxdyn is not installed; run python3 tests/consumers/lxdyn_environment.py")
    text = written(file, "xdyn", folder)["file.yml"].decode()
    orders = rows_of(name, file)
    at = [0.0, *(x for k in np.cumsum([s for s, _ in RUNS[name].phases])[:-1] for x in (k - 1e-6, k, k + 1e-6))]
    keys = ["dr", "ds", "db", *command_names(file), *(f"{n}_tilt" for n in command_names(file))]
    for k, key in enumerate(keys):
        before, mark, after = text.partition(f"    {key}: {{unit: ")
        if not mark:
            continue
        values = []
        for t in at:  # half way at the very step, which is alike to both of its sides where the force is near a line
            i, j = int((t - 1e-7) / STEP), int((t + 1e-7) / STEP)
            values.append(float(orders[max(i, 0), k] + orders[j, k]) / 2.0)
        text = before + mark + after.replace("values: [0.0]", f"values: {values}", 1)
    text = text.replace("    t: [0.0]", f"    t: {[float(t) for t in at]}")
    start = f"u: {{value: {file.conditions.speed!r}, unit: m/s}}"
    assert text.count(start) == 1
    text = text.replace(start, f"u: {{value: {RUNS[name].speed!r}, unit: m/s}}")
    rows, said = in_xdyn(folder, text, STEP * len(orders), STEP / 5.0)
    assert len(rows), said
    mass = file.mass
    assert mass.centre is not None
    return rows[::5, 4:10] @ velocity_transfer(-np.array(mass.centre)).T


Ran = Callable[[str, ParameterFile, Path], np.ndarray]
TARGETS: dict[str, Ran] = {
    "mss": by_octave,
    "python_vehicle_simulator": by_class,
    "c": by_c,
    "c++": by_cpp,
    "fmi": by_fmpy,
    "xdyn": by_xdyn,
}
REFUSED = {("huuv", "xdyn"): "mass.centre", ("huuv_5dof", "xdyn"): "mass.inertia_matrix"}


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", RUNS)
def test_doublet_and_reversal(name: str, target: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    file = file_of(name, request, LAG if target in LATE and not name.startswith("huuv") else None)
    if (name, target) in REFUSED:
        with pytest.raises(InputError) as refused:
            export(file, target, accept_loss=True)
        assert refused.value.column == REFUSED[name, target]
        return
    program = {"mss": OCTAVE, "c": shutil.which("gcc"), "c++": shutil.which("g++")}
    if program.get(target, "here") is None:
        pytest.skip(f"no program for {target}")
    times, ours = due(name, file)
    theirs = TARGETS[target](name, file, tmp_path)[: len(ours)]
    assert len(theirs) == len(ours)
    steps = np.cumsum([s for s, _ in RUNS[name].phases])
    apart_from_steps = ~np.isclose(times[:, None], steps).any(axis=1)  # xdyn is half way there
    ours, theirs = ours[apart_from_steps], theirs[apart_from_steps]
    peak = np.abs(ours).max(axis=0)
    group = np.repeat([peak[:3].max(), max(peak[3:].max(), 1e-3)], 3)
    apart = np.abs(theirs - ours).max(axis=0) / group
    assert apart.max() < LIMIT, dict(zip(MOTIONS, apart, strict=True))


@pytest.mark.parametrize("name", RUNS)
def test_sdformat_takes_it(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """Model and world; the force in them is the loss report's matter."""
    if shutil.which("ign") is None:
        pytest.skip("SDFormat's parser (ign sdf) is not installed")
    for written_as in written(file_of(name, request), "gazebo", tmp_path):
        done = subprocess.run(
            ["ign", "sdf", "--check", str(tmp_path / written_as)],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert "Valid" in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("name", RUNS)
def test_mujoco_takes_it_or_it_is_refused(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """MuJoCo makes its forces of an ellipsoid, which needs added masses along all three axes."""
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (dependency group test)")
    file = file_of(name, request)
    if name in ("huuv", "flyingfish_water"):
        with pytest.raises(InputError, match="no added mass along x, y and z"):
            written(file, "mujoco", tmp_path)
        return
    (model_file,) = (n for n in written(file, "mujoco", tmp_path) if n.endswith(".xml"))
    model = mujoco.MjModel.from_xml_path(str(tmp_path / model_file))
    data = mujoco.MjData(model)
    assert model.body_mass.sum() == pytest.approx(file.mass.mass)
    data.qvel[0] = file.conditions.speed
    mujoco.mj_step(model, data, round(2.0 / model.opt.timestep))
    assert np.all(np.isfinite(data.qpos))
    assert (
        0.0 < data.qpos[0] < 2.0 * file.conditions.speed + 1e-9
    )  # all drag of huuv_5dof is in tables, which MuJoCo has not
