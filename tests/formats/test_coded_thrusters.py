"""Thrusters and limits of angles as code: Octave and the vehicle class, run, give the file's; each over dead zone, limits, tilt, torque."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from coeflab.formats.export import export
from coeflab.formats.model_files import read_model_file
from coeflab.formats.mss import write as mss
from coeflab.formats.python_vehicle_simulator import write as pvs
from coeflab.formats.xdyn import write as xdyn
from coeflab.formats.xdyn.actuators import command_names
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterSurface, ParameterThruster
from tests.formats import files as made
from tests.formats.files import control_force
from tests.formats.of_a_vehicle import driven

OCTAVE = shutil.which("octave-cli")
LIMIT, RATE = 0.3, 0.2
# Dead zone from -10 to 14 with a step at its end, another slope behind 40; held beyond -100 and 100.
LEFT = {
    "name": "left", "position": (-1.0, 0.2, 0.05), "direction": (1.0, 0.0, 0.0), "handedness": -1,
    "curve": {"command": "duty", "unit": "%", "segments": [
        {"low": -100.0, "high": -10.0, "coefficients": [1.0, 0.1]}, {"low": 14.0, "high": 40.0, "coefficients": [-1.9, 0.1654]},
        {"low": 40.0, "high": 100.0, "coefficients": [-1.9, 0.1654, 0.0, 1e-5]}]},
    "torque_curve": {"command": "duty", "unit": "%", "segments": [{"low": -100.0, "high": 100.0, "coefficients": [0.0, 0.01]}]},
}  # fmt: skip
TURNING = {
    "name": "turning", "position": (0.8, -0.1, 0.0), "direction": (0.0, 0.6, 0.8), "tilt_axis": (0.0, 0.0, 1.0), "tilt_low": -0.5,
    "tilt_high": 1.0, "curve": {"command": "rate", "unit": "rpm", "segments": [{"low": -9.0, "high": 9.0, "coefficients": [0.0, 1.0, 0.0, 0.2]}]},
}  # fmt: skip
COMMANDS = np.array([
    [50.0, 2.0, 0.3, 0.3], [14.0, -3.0, 0.0, 0.7], [13.9, 20.0, 0.0, 3.0], [-10.0, -20.0, 0.0, -3.0], [200.0, 0.0, 0.0, 1.0],
    [-200.0, 1.0, 0.0, 0.0], [-9.0, 0.5, 0.0, -0.2], [0.0, 0.0, 0.0, 0.0],
])  # fmt: skip


def file(*names: str) -> ParameterFile:
    """With a rudder that turns slowly to either side and planes that turn at once."""
    two = [ParameterThruster.model_validate(t) for t in (LEFT, TURNING)]
    two = [t.model_copy(update={"name": n}) for t, n in zip(two, names or ("left", "turning"), strict=True)]
    surfaces = (ParameterSurface(control="dr", limit=LIMIT, rate=RATE), ParameterSurface(control="ds", limit=0.2))
    return driven().model_copy(update={"thrusters": tuple(two), "surfaces": surfaces, "name": "driven_one"})


def due(p: ParameterFile) -> np.ndarray:
    v = vehicle(p)
    return np.array([v.wrench({"left": c[0], "turning": c[1], "turning.tilt": c[3]}) for c in COMMANDS])


def test_what_is_due_by_hand() -> None:
    """50 %: -1.9 + .1654 * 50 + 1e-5 * 50^3 = 7.62 N at y = .2, z = .05; 2 + 1.6 = 3.6 N turned by .3 about z; torque -.5 N m."""
    ahead, side = 7.62, 3.6
    turned = side * np.array([-0.6 * np.sin(0.3), 0.6 * np.cos(0.3), 0.8])
    x, y, z = turned
    hand = [
        ahead + x, y, z, -0.5 - 0.1 * z, 0.05 * ahead - 0.8 * z, -0.2 * ahead + 0.8 * y + 0.1 * x,
    ]  # fmt: skip
    np.testing.assert_allclose(due(file())[0], hand, rtol=1e-12)


@pytest.mark.skipif(OCTAVE is None, reason="no Octave")
def test_octave_gives_thrust_and_limits(tmp_path: Path) -> None:
    p = file()
    (tmp_path / "driven_one.m").write_bytes(mss.render(p)["driven_one.m"])
    nu = [1.2, 0.1, -0.2, 0.1, 0.05, -0.1]
    script = ["1;", f"nu = {nu}';", f"C = [{'; '.join(' '.join(map(repr, r)) for r in COMMANDS.tolist())}];"]
    script += ["show = @(x) printf('%.17g ', x);", "plain = driven_one(nu);"]
    script += ["for k = 1:rows(C), show(driven_one(nu, zeros(3,1), C(k,:)') - plain); printf('\\n'); end"]
    script += ["for d = [-1 -.3 .1 .3 1], show(driven_one(nu, [d; 0; 0]) - plain); printf('\\n'); end"]
    (tmp_path / "run.m").write_text("\n".join(script), encoding="utf-8")
    done = subprocess.run(
        [str(OCTAVE), "--norc", "--quiet", "run.m"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
    np.testing.assert_allclose(found[: len(COMMANDS)], due(p), rtol=1e-11, atol=1e-11)
    turned = np.zeros((5, 3))
    turned[:, 0] = [-LIMIT, -LIMIT, 0.1, LIMIT, LIMIT]
    steered = control_force(p, np.tile(nu, (5, 1)), turned)
    np.testing.assert_allclose(found[len(COMMANDS) :], steered, rtol=1e-10, atol=1e-10)


CLASS = """
import json, sys
import numpy as np
sys.path.insert(0, sys.argv[1])
module = __import__(sys.argv[2])
asked = json.load(sys.stdin)
v = getattr(module, sys.argv[2])()
out = {"wrench": [module.driven(v.thrusters, v.segments, c).tolist() for c in asked["commands"]], "dim": v.dimU,
       "start": v.stepInput(0.0).tolist(), "controls": v.controls, "angles": []}
nu, actual = v.nu_0, np.zeros(v.dimU)
for order in asked["orders"]:
    u = np.zeros(v.dimU)
    u[0], u[1], u[4] = order, order, 50.0
    nu, actual = v.dynamics(np.zeros(6), nu, actual, u, 0.1)
    out["angles"].append(actual[:2].tolist())
out["last"] = actual[4]
rest = np.zeros(6)
idle = v.dynamics(rest, rest, np.zeros(v.dimU), np.zeros(v.dimU), 1.0)[0]
out["pushed"] = (v.dynamics(rest, rest, np.array([0, 0, 0, 0, *asked["commands"][0]]), np.zeros(v.dimU), 1.0)[0] - idle).tolist()
out["steered"] = [v.hydrodynamics(np.array([1.0, 0, 0, 0, 0, 0]), (d, 0.0, 0.0)).tolist() for d in (-1.0, -0.3)]
print(json.dumps(out))
"""


def test_the_class_gives_thrust_limits_and_rates(tmp_path: Path) -> None:
    p = file()
    (tmp_path / "driven_one.py").write_bytes(pvs.render(p)["driven_one.py"])
    orders = [1.0] * 20 + [-1.0]
    done = subprocess.run(
        [sys.executable, "-I", "-c", CLASS, str(tmp_path), "driven_one"], capture_output=True, text=True, check=False,
        input=json.dumps({"commands": COMMANDS.tolist(), "orders": orders}),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    out = json.loads(done.stdout)
    np.testing.assert_allclose(out["wrench"], due(p), rtol=1e-12, atol=1e-12)
    assert out["dim"] == len(out["controls"]) == len(out["start"]) == 8
    dr, ds = np.array(out["angles"]).T
    np.testing.assert_allclose(dr, [*np.minimum(RATE * 0.1 * np.arange(1, 21), LIMIT), LIMIT - RATE * 0.1])
    np.testing.assert_allclose(ds, [*[0.2] * 20, -0.2])
    assert out["last"] == 50.0
    moved = vehicle(p)
    np.testing.assert_allclose(out["pushed"], np.linalg.solve(moved.effective_mass, due(p)[0]), rtol=1e-9, atol=1e-12)
    assert out["steered"][0] == out["steered"][1]


@pytest.mark.parametrize("target", ["mss", "python_vehicle_simulator", "xdyn", "c"])
def test_what_is_held_is_no_loss(target: str) -> None:
    loss = export(file(), target).loss
    said = [x.what for x in loss.lost]
    assert not [s for s in said if "thruster" in s]
    assert [s for s in said if s.startswith("rates of dr")] == (
        ["rates of dr: angles are taken at once"] if target in ("mss", "xdyn") else []
    )
    assert loss.forces.furthest[1] < 1e-9
    assert loss.rare.furthest[1] < 1e-9


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_of_thrusters_that_hurt(name: str) -> None:
    """No line more in the class, which still compiles; in the function they stand in comments alone."""
    p = file(name, "turning")
    plain = pvs.render(file())["driven_one.py"].decode().splitlines()
    source = pvs.render(p)["driven_one.py"]
    compile(source, "driven_one.py", "exec")
    assert len(source.decode().splitlines()) == len(plain)
    theirs, ours = (mss.render(x)["driven_one.m"].decode().split("\n") for x in (p, file()))
    assert len(theirs) == len(ours)
    assert {a for a, b in zip(theirs, ours, strict=True) if a != b and not a.startswith("%")} == set()


def test_expressions_of_xdyn_are_the_curves() -> None:
    p = file()
    given = {"left": COMMANDS[:, 0], "turning": COMMANDS[:, 1], "turning_tilt": COMMANDS[:, 3]}
    np.testing.assert_allclose(xdyn.wrench(xdyn.render(p), given), due(p), rtol=1e-9, atol=1e-8)


def test_angles_in_xdyn_are_held_at_their_limits() -> None:
    p = file()
    nu = np.tile([1.2, 0.1, -0.2, 0.1, 0.05, -0.1], (5, 1))
    asked, held = np.zeros((2, 5, 3))
    asked[:, 0], held[:, 0] = [-1.0, -0.3, 0.1, 0.3, 1.0], [-LIMIT, -LIMIT, 0.1, LIMIT, LIMIT]
    files = xdyn.render(p)
    steered = xdyn.steered_force(files, nu, asked) - xdyn.force(files, nu)
    np.testing.assert_allclose(steered, control_force(p, nu, held), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", [*made.HOSTILE, "left_tilt", "thruster_0", "X", "u", "rho", "t"])
def test_names_of_thrusters_that_hurt_in_xdyn(name: str) -> None:
    """The expressions are of the writer's own names, and a name that it has itself is another's no more."""
    p = file(name, "left")
    (first, second) = command_names(p)
    assert first != second
    files = xdyn.render(p)
    given = {first: COMMANDS[:, 0], second: COMMANDS[:, 1], f"{second}_tilt": COMMANDS[:, 3]}
    np.testing.assert_allclose(xdyn.wrench(files, given), due(file()), rtol=1e-9, atol=1e-8)
    text = files["driven_one.yml"].decode()
    assert len(text.splitlines()) == len(xdyn.render(file())["driven_one.yml"].decode().splitlines())


@pytest.mark.parametrize("target", [mss, xdyn], ids=["mss", "xdyn"])
def test_limits_come_back_and_thrusters_are_named_as_left_out(target: ModuleType, tmp_path: Path) -> None:
    p = file()
    for written, content in target.render(p).items():
        (tmp_path / written).write_bytes(content)
        back = read_model_file(tmp_path / written).parameters
    assert {s.control: s.limit for s in back.surfaces} == {"dr": LIMIT} | ({"ds": 0.2} if target is mss else {})
    assert back.coefficient("Ydr").value_si == pytest.approx(p.coefficient("Ydr").value_si, rel=1e-12)
    assert [f for f in back.findings if f.code == "model.left_out" and any("thrusters" in n for n in f["names"])]
