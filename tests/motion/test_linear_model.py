"""The linear model about a steady motion: by hand, against Octave, at knots and bounds."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.motion.small_motions import modes, participation, slopes
from coeflab.motion.trim.linear_model import LinearModel, linear_model
from coeflab.motion.trim.trim import trim
from coeflab.motion.vehicle import vehicle
from coeflab.report.tables.linear_model import files, mode_table, senses
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.motion.test_trim import MASS, PLANE, TURNING, thruster
from tests.motion.trimmed import parameter_file

HORIZONTAL = ("u", "v", "r")
OPEN = np.full(1, np.inf)


@pytest.fixture(scope="module")
def remus() -> ParameterFile:
    return read_parameter_file(Path("remus100"))


def straight(file: ParameterFile, *free: str, **motion: float) -> LinearModel:
    return linear_model(trim(vehicle(file, free), {"u": 1.5, "yaw_rate": 0.0} | motion, starts=2))


def by_hand(file: ParameterFile, u: float) -> tuple[np.ndarray, np.ndarray]:
    """(v, r) by dr straight ahead: M x_dot = D x + B d with M = m - Y_vdot and so on, D holding -m u in Y_r."""
    c = {x.symbol.removesuffix("'"): x.value_si for x in file.coefficients}
    m, inertia, x_g = file.mass.mass, file.mass.inertia_matrix[2][2], file.mass.centre_of_gravity[0]
    mass = np.array([[m - c["Yvdot"], m * x_g - c["Yrdot"]], [m * x_g - c["Nvdot"], inertia - c["Nrdot"]]])
    damping = u * np.array([[c["Yuv"], c["Yur"] - m], [c["Nuv"], c["Nur"] - m * x_g]])
    rudder = u**2 * np.array([c["Ydr"], c["Ndr"]]) / file.conditions.speed**2
    return np.linalg.solve(mass, damping), np.linalg.solve(mass, rudder)


def test_remus_in_the_horizontal_plane(remus: ParameterFile) -> None:
    """REMUS 100 at 1.5 m/s: the numbers of finite differences of its MSS function in Octave, and its coefficients by hand."""
    model = straight(remus, *HORIZONTAL)
    assert [(s.name, s.unit) for s in model.states] == [("u", "m/s"), ("v", "m/s"), ("r", "rad/s")]
    assert [c.name for c in model.commands] == ["thrust", "dr"]
    a, b = model.a.matrix[1:, 1:], model.b.matrix[1:, 1]
    assert a == pytest.approx(np.array([[-0.7819, -0.5888], [-4.5029, -0.4966]]), abs=5e-5)
    assert b == pytest.approx(np.array([0.2821, -1.5958]), abs=5e-5)
    damping, rudder = by_hand(remus, 1.5)
    assert a == pytest.approx(damping, rel=1e-9)
    assert b == pytest.approx(rudder, rel=1e-9)
    found = [m.eigenvalue.real for m in model.modes]
    assert [found[0], found[2]] == pytest.approx([0.9953, -2.2738], abs=1e-4)  # of differences with a v|v| in them
    assert [found[0], found[2]] == pytest.approx(sorted(np.linalg.eigvals(damping), reverse=True), rel=1e-9)
    assert model.modes[0].doubles == pytest.approx(np.log(2.0) / found[0])
    assert model.modes[2].halves == pytest.approx(np.log(2.0) / -found[2])
    assert model.modes[0].halves is None
    assert senses(model) == ("dr > 0: turns to port",)


def test_eigenvalues_are_those_of_the_trim(remus: ParameterFile) -> None:
    found = trim(vehicle(remus), {"u": 1.5, "yaw_rate": 0.0, "pitch": 0.0}, starts=2)
    model = linear_model(found)
    assert [s.name for s in model.states] == ["u", "v", "w", "p", "q", "r", "roll", "pitch"]
    assert tuple(m.eigenvalue for m in model.modes) == found.point.modes
    assert modes(model.a.matrix) == pytest.approx(np.array(found.point.modes))
    named = {max(m.shares, key=lambda n, m=m: m.shares[n]) for m in model.modes if abs(m.eigenvalue.imag) > 1.0}
    assert named <= {"p", "roll"}
    pitching = model.modes[1]
    assert pitching.eigenvalue == pytest.approx(0.4190 + 0.2053j, abs=5e-5)
    assert pitching.period == pytest.approx(2.0 * np.pi / 0.20527, rel=1e-4)
    assert "pitch 50 %" in mode_table(model).rows[1][-1]


def test_b_is_what_a_small_step_of_a_command_does(remus: ParameterFile) -> None:
    """In a turn with thrust, rudder and stern plane off zero, A and B give the rates beside the trim to first order."""
    found = trim(vehicle(remus), {"u": 1.5, "yaw_rate": 0.1, "pitch": 0.02}, starts=2)
    model, x = linear_model(found), found.point.found.point
    rng = np.random.default_rng(3)
    d, c = 1e-4 * rng.normal(size=8), 1e-4 * rng.normal(size=3)
    nearby = np.concatenate([x[:6], x[6:] + c])
    rates = found.motion.rates(nearby, found.motion.departed(x) + d)
    assert rates == pytest.approx(model.a.matrix @ d + model.b.matrix @ c, abs=2e-6)
    assert np.max(np.abs(rates)) > 1e-4


def test_octave_returns_the_same(remus: ParameterFile, tmp_path: Path) -> None:
    if shutil.which("octave-cli") is None:
        pytest.skip("GNU Octave (octave-cli) is not installed")
    model = straight(remus, *HORIZONTAL)
    for name, content in files(model).items():
        (tmp_path / name).write_bytes(content)
    script = (
        "[A, B, names, at] = linear(); printf('%.17g\\n', A', B', at.states, at.commands);"
        "printf('%s\\n', names.states{:}, names.state_units{:}, names.commands{:}, names.command_units{:});"
    )
    (tmp_path / "ask.m").write_text(script)
    done = subprocess.run(
        ["octave-cli", "--norc", "--quiet", "ask.m"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = done.stdout.split()
    expected = [*model.a.matrix.ravel(), *model.b.matrix.ravel(), *(v.value for v in (*model.states, *model.commands))]
    assert [float(t) for t in said[: len(expected)]] == expected
    assert said[len(expected) :] == ["u", "v", "r", "m/s", "m/s", "rad/s", "thrust", "dr", "N", "rad"]


def test_csv_reads_back(remus: ParameterFile) -> None:
    model = straight(remus, *HORIZONTAL)
    for name, matrix in (("A.csv", model.a.matrix), ("B.csv", model.b.matrix)):
        head, *rows = files(model)[name].decode().splitlines()
        assert head.startswith("rate,")
        assert np.array([[float(v) for v in row.split(",")[1:]] for row in rows]) == pytest.approx(matrix, abs=0.0)
    assert head == "rate,thrust [N],dr [rad]"
    assert [row.partition(",")[0] for row in rows] == ["u_dot [m/s^2]", "v_dot [m/s^2]", "r_dot [rad/s^2]"]


def test_a_thruster_at_its_bound_is_differentiated_inwards() -> None:
    pair = [thruster("left", -0.3), thruster("right", 0.3)]
    craft = vehicle(parameter_file(PLANE, MASS, TURNING, thrusters=pair), HORIZONTAL)
    at_bound = linear_model(trim(craft, {}, {"left": 100.0, "right": 100.0}, starts=2))
    below = linear_model(trim(craft, {}, {"left": 50.0, "right": 50.0}, starts=2))
    assert at_bound.b.matrix == pytest.approx(below.b.matrix, rel=1e-9)
    assert [c.unit for c in at_bound.commands] == ["%", "%"]


def test_no_trim_has_no_linear_model(remus: ParameterFile) -> None:
    found = trim(vehicle(remus, HORIZONTAL), {"u": 1.5, "yaw_rate": 3.0, "v": 0.0}, starts=1)
    assert not found.point.outcome.solved
    with pytest.raises(InputError, match="no steady motion"):
        linear_model(found)


def test_slopes_of_v_abs_v_are_exact_and_a_knot_is_seen() -> None:
    def function(x: np.ndarray) -> np.ndarray:
        return np.array([x[0] * abs(x[0]), abs(x[0]) + 3.0 * x[0], np.sin(x[0])])

    found = slopes(function, np.zeros(1), np.ones(1), -OPEN, OPEN)
    assert found.matrix[:, 0] == pytest.approx([0.0, 3.0, 1.0], abs=1e-9)
    assert found.kinks[:, 0].tolist() == [False, True, False]
    ahead = slopes(function, np.zeros(1), np.ones(1), np.zeros(1), OPEN)
    assert ahead.matrix[:, 0] == pytest.approx([0.0, 4.0, 1.0], abs=1e-9)
    assert np.max(found.error) < 1e-9


def test_participation_does_not_depend_on_units() -> None:
    matrix = np.array([[-1.0, 2.0, 0.0], [0.5, -3.0, 0.0], [0.0, 0.0, -7.0]])
    scale = np.diag([1.0, 1e3, 1e-2])
    same = participation(np.linalg.solve(scale, matrix @ scale))
    assert same == pytest.approx(participation(matrix))
    assert np.sum(same, axis=1) == pytest.approx(np.ones(3))
    assert same[2] == pytest.approx([0.0, 0.0, 1.0])
    defective = participation(np.array([[0.0, 1.0], [0.0, 0.0]]))
    assert np.sum(defective, axis=1) == pytest.approx(np.ones(2))
