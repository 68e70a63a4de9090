"""Hand-over to an autopilot: depth, heading and lag as states, several speeds, files; A and B against differences of simulated motions."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from scipy.linalg import expm

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.motion.dynamics import from_euler
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.marching import march_by_tolerance
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.trim.linear_model import LinearModel, content, linear_model
from coeflab.motion.trim.steady_motion import MOTION
from coeflab.motion.trim.trim import Trim, trim
from coeflab.motion.vehicle import vehicle
from coeflab.report.tables.linear_model import schedule_table
from coeflab.vehicle.parameter_file import read_parameter_file

TIME = 0.8  # s, near one time constant of the fastest motion
WHAT = ("u", "v", "w", "p", "q", "r")
SMALL = 1e-4


def simulated(found: Trim, model: LinearModel, state: str = "", command: str = "") -> np.ndarray:
    """(n,) derivative of the states after `TIME` by a state at the start or by a command, by central differences of two simulations."""
    ends = []
    for side in (SMALL, -SMALL):
        nu, lean = found.motion.state(found.point.found.point)
        orders = {k: v for k, v in found.point.values.items() if k not in MOTION}
        if state in WHAT:
            nu[WHAT.index(state)] += side
        elif state in ("roll", "pitch"):
            lean[int(state == "pitch")] += side
        heading = side if state == "heading" else 0.0
        if command:
            orders[command] += side
        plan = Manoeuvre("beside", (Phase("on", {}, TIME),), nu, from_euler(*lean, heading), orders)
        run = march_by_tolerance(found.motion.vehicle, plan, record=TIME, tolerance=1e-11).trajectory()
        ends.append([_state(run, s.name, heading) for s in model.states])
    return (np.array(ends[0]) - np.array(ends[1])) / (2.0 * SMALL)


def _state(run: Trajectory, name: str, start: float) -> float:
    if name in WHAT:
        return float(run.velocity[-1, WHAT.index(name)])
    if name in ("roll", "pitch"):
        return float(run.angles[-1, int(name == "pitch")])
    return float(run.position[-1, 2]) if name == "depth" else float(run.heading[-1]) + start


@pytest.fixture(scope="module")
def climbing() -> Trim:
    """REMUS 100 in a climbing turn: no symmetry makes an entry vanish."""
    return trim(vehicle(read_parameter_file(Path("remus100"))), {"u": 1.5, "yaw_rate": 0.1, "pitch": 0.05}, starts=2)


def test_a_and_b_are_those_of_simulated_motions(climbing: Trim) -> None:
    model = linear_model(climbing, ("depth", "heading"))
    n, m = model.B.shape
    assert [s.name for s in model.states[-2:]] == ["depth", "heading"]
    later = expm(np.block([[model.A, model.B], [np.zeros((m, n + m))]]) * TIME)
    for k, state in enumerate(model.states):
        if state.name != "depth":
            assert simulated(climbing, model, state.name) == pytest.approx(later[:n, k], abs=3e-5), state.name
    for k, command in enumerate(model.commands):
        assert simulated(climbing, model, "", command.name) == pytest.approx(later[:n, n + k], abs=3e-5), command.name
    assert np.max(np.abs(later[n - 2 : n, : n - 2])) > 0.1


def test_a_lagged_command_acts_late() -> None:
    """The answer to a step of the rudder is that to the rudder's own exponential."""
    at_once = cf.read_vehicle("remus100").linear(speed=1.5, yaw_rate=0.0, free="uvr")
    late = cf.read_vehicle("remus100").linear(speed=1.5, yaw_rate=0.0, free="uvr", lags={"dr": 0.4})
    assert [s.name for s in late.states] == ["u", "v", "r", "dr_lagged"]
    assert late.states[-1].unit == "rad"
    assert late.rate_units[-1] == "rad/s"
    step = expm(np.block([[late.A, late.B], [np.zeros((2, 6))]]) * TIME)[:4, 5]
    assert step[3] == pytest.approx(1.0 - np.exp(-TIME / 0.4))
    times = np.linspace(0.0, TIME, 4001)
    rudder = 1.0 - np.exp(-times / 0.4)
    answers = np.array([expm(at_once.A * (TIME - t)) @ at_once.B[:, 1] for t in times[::40]])
    summed = np.trapezoid(answers * rudder[::40, None], times[::40], axis=0)
    assert step[:3] == pytest.approx(summed, abs=2e-4)
    assert abs(step[2]) > 0.1
    assert np.linalg.eigvals(late.A).min() < -2.4


@pytest.mark.parametrize(
    ("more", "column"),
    [
        ({"also": ("depth",)}, "also"),
        ({"also": ("north",)}, "also"),
        ({"lags": {"left": 0.2}}, "lag"),
        ({"lags": {"dr": 0.0}}, "lag"),
        ({"lags": {"dr": np.nan}}, "lag"),
    ],
)
def test_states_that_nothing_moves_and_lags_of_nothing(more: dict[str, object], column: str) -> None:
    with pytest.raises(InputError) as refused:
        cf.read_vehicle("remus100").linear(speed=1.5, free="uvr", **more)
    assert refused.value.column == column


def test_a_schedule_is_the_models_of_its_speeds() -> None:
    auv = cf.read_vehicle("remus100")
    found = auv.linear(speed=[1.0, "2 m/s"], yaw_rate=0.0, free="uvr", also=("heading",))
    assert found.speeds == (1.0, 2.0)
    assert (found.A.shape, found.B.shape) == ((2, 4, 4), (2, 4, 2))
    one = auv.linear(speed=2.0, yaw_rate=0.0, free="uvr", also=("heading",))
    assert found.A[1].tolist() == one.A.tolist()
    # Forces by the square of the speed alone: velocities' slopes grow with it, the rudder's with its square.
    assert found.A[1, 1:3, 1:3] == pytest.approx(2.0 * found.A[0, 1:3, 1:3], rel=1e-8)
    assert found.B[1, :, 1] == pytest.approx(4.0 * found.B[0, :, 1], rel=1e-8)
    frame = found.frame()
    assert frame.index.tolist() == [1.0, 2.0]
    assert frame["B_r_dr"].tolist() == found.B[:, 2, 1].tolist()


@pytest.mark.parametrize("speeds", [None, (1.0, 2.0)])
def test_files_read_back(tmp_path: Path, speeds: tuple[float, ...] | None) -> None:
    auv = cf.read_vehicle("remus100")
    model = auv.linear(speed=list(speeds) if speeds else 1.0, yaw_rate=0.0, free="uvr", also=("heading",))
    first = model if speeds is None else model.models[0]
    arrays = np.load(model.save(tmp_path / "auv.npz"))
    assert arrays["A"].tolist() == model.A.tolist()
    assert arrays["states"].tolist() == ["u", "v", "r", "heading"]
    assert arrays["command_units"].tolist() == ["N", "rad"]
    told = json.loads(model.save(tmp_path / "auv.json").read_text())
    assert (told if speeds is None else told["models"][0])["a"] == first.A.tolist()
    mat = scipy.io.loadmat(io.BytesIO(model.save(tmp_path / "auv.mat").read_bytes()))
    for key in ("A", "B", "C", "D", "at_commands"):  # one layout in both, as in Python, and its axes by name
        assert mat[key].reshape(arrays[key].shape).tolist() == arrays[key].tolist()
        named = [{"speeds": 2, "states": 4, "commands": 2}[axis] for axis in arrays[f"{key}_axes"]]
        assert arrays[key].shape == tuple(named)
        assert [str(x[0]) for x in mat[f"{key}_axes"][:, 0]] == arrays[f"{key}_axes"].tolist()
    assert mat["A"].tolist() == model.A.tolist()
    assert [str(x[0]) for x in mat["states"][:, 0]] == ["u", "v", "r", "heading"]
    assert mat["at_states"][0, 0] == 1.0
    models = (model,) if speeds is None else model.models
    for ending in (".npz", ".mat", ".json"):
        assert (tmp_path / f"auv{ending}").read_bytes() == content(models, ending, speeds)
    assert b"Created on" not in (tmp_path / "auv.mat").read_bytes()
    with pytest.raises(InputError, match=r"\.mat"):
        model.save(tmp_path / "auv.txt")


def test_octave_loads_the_schedule(tmp_path: Path) -> None:
    if shutil.which("octave-cli") is None:
        pytest.skip("GNU Octave (octave-cli) is not installed")
    found = cf.read_vehicle("remus100").linear(speed=[1.0, 2.0], yaw_rate=0.0, free="uvr")
    found.save(tmp_path / "auv.mat")
    ask = "s = load('auv.mat'); printf('%.17g\\n', s.A(2, 3, 2), s.speeds(2)); printf('%s\\n', s.states{:})"
    done = subprocess.run(
        ["octave-cli", "--norc", "--quiet", "--eval", ask], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True
    )  # fmt: skip
    first, *others = done.stdout.split()
    assert float(first) == found.A[1, 2, 1]
    assert others == ["2", "u", "v", "r"]


def test_a_climb_that_is_asked_for_is_an_equation_and_each_model_names_its_steady_motion() -> None:
    auv = vehicle(read_parameter_file(Path("remus100")))
    free, level, rising = (
        trim(auv, {"u": 1.5, "yaw_rate": 0.0, "roll": 0.0, **more}, starts=2)
        for more in ({"pitch": 0.05}, {"climb": 0.0}, {"climb": 0.1})
    )
    nu, (roll, pitch) = rising.motion.state(rising.point.found.point)
    (across, down), (sin, cos) = nu[1:3], (np.sin(roll), np.cos(roll))
    assert np.sin(pitch) * nu[0] - np.cos(pitch) * (across * sin + down * cos) == pytest.approx(0.1, abs=1e-9)
    assert rising.figures["climb"][0] == pytest.approx(0.1, abs=1e-9)
    assert (free.depth_is_kept, level.depth_is_kept, rising.depth_is_kept) == (False, True, False)
    assert len(level.point.equations) == len(free.point.equations) + 1
    words = linear_model(free).state
    assert words.startswith("steady motion at u = 1.500 m/s: pitch 2.865 deg, climb ")
    assert words.endswith("depth not kept")  # its pitch is given: no climb could be asked for
    assert linear_model(level).state.endswith(", depth kept")
    assert linear_model(rising).state.endswith("climb 0.1000 m/s, depth not kept")
    assert linear_model(level).state in json.loads(content([linear_model(level)], ".json"))["statements"]


def test_over_the_speed_stands_what_stands_at_one() -> None:
    auv = vehicle(read_parameter_file(Path("remus100")), ("u", "w", "q"), "vertical")
    trims = [trim(auv, {"u": u, "pitch": 0.05}, starts=2) for u in (1.0, 2.0)]
    table = schedule_table([1.0, 2.0], trims, [linear_model(t) for t in trims])
    at = [table.headers.index(name) for name in ("pitch [deg]", "climb [m/s]")]
    assert [[float(row[i]) for i in at] for row in table.rows] == [
        pytest.approx([np.degrees(0.05), t.figures["climb"][0]], rel=1e-3) for t in trims
    ]
    assert any(note.startswith("Depth is not kept.") for note in table.notes)
    for found in trims:
        assert all(any(words in note for note in table.notes) for words in found.point.doubts())
    held = replace(trims[0].point.found, held=np.array([u.name == "ds" for u in trims[0].point.unknowns]))
    bound = replace(trims[0], point=replace(trims[0].point, found=held))
    notes = schedule_table([1.0], [bound], [linear_model(bound)]).notes
    assert any("ds is held at its bound of" in note for note in notes)
