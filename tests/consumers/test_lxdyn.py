"""The export in the real xdyn: its motion is that of our own integration of the same equations."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.formats.xdyn import write as xdyn
from coeflab.law.transforms import force_transfer, velocity_transfer
from coeflab.motion.simulation import simulate
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.consumers.lxdyn_environment import PYTHON
from tests.formats.files import at_rest, control_force, full
from tests.formats.massed import ADDED, CENTRE, INERTIA, MASS, OWN, torpedo, with_mass
from tests.formats.of_a_vehicle import floating, quaternion, restoring
from tests.formats.test_coded_thrusters import COMMANDS, LIMIT, due
from tests.formats.test_coded_thrusters import file as driven_file
from tests.rigid_motion import Trajectory, motion, rotation

RUN = Path(__file__).with_name("run_lxdyn.py")
SECONDS, STEP = 60.0, 0.02  # s
pytestmark = pytest.mark.skipif(
    not PYTHON.exists(), reason="lxdyn is not installed; run python3 tests/consumers/lxdyn_environment.py"
)


def in_xdyn(folder: Path, text: str, seconds: float = SECONDS, step: float = STEP) -> tuple[np.ndarray, str]:
    """Rows t x y z u v w p q r qr qi qj qk, and what xdyn says."""
    (folder / "model.yml").write_text(text, encoding="utf-8")
    command = [str(PYTHON), str(RUN), "model.yml", str(seconds), str(step)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode:
        return np.empty((0, 14)), done.stderr
    return np.loadtxt(folder / "file.csv", delimiter=",", skiprows=1), done.stderr


def rendered(file: ParameterFile) -> str:
    return xdyn.render(file)["file.yml"].decode()


def ours(file: ParameterFile, times: np.ndarray, rudder: float) -> Trajectory:
    law, delta = force_law(file), np.array([[rudder, 0.0, 0.0]])
    start = velocity_transfer(-CENTRE) @ np.array([file.conditions.speed, 0, 0, 0, 0, 0])
    return motion(
        MASS, CENTRE, INERTIA, ADDED, lambda _, nu: law.force(nu) + control_force(file, nu, delta), start, times
    )


def apart(rows: np.ndarray, found: Trajectory) -> tuple[float, float]:
    """Largest difference of the way of the centre of gravity over its length, and of its velocities over the largest."""
    shift = np.array([rotation(q) @ CENTRE for q in found.attitude])
    way = found.position + shift - shift[0]
    velocity = found.velocity @ velocity_transfer(CENTRE).T
    length = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
    linear, angular = slice(0, 3), slice(3, 6)
    scales = [max(np.abs(velocity[:, s]).max(), 1e-3) for s in (linear, angular)]
    gaps = [np.abs(rows[:, 4:10] - velocity)[:, s].max() / scale for s, scale in zip((linear, angular), scales)]
    turned = np.abs(np.abs(np.sum(rows[:, 10:] * found.attitude, axis=1)) - 1.0).max()
    return float(np.abs(rows[:, 1:4] - way).max() / length), float(max(*gaps, turned))


@pytest.mark.slow
@pytest.mark.parametrize("rudder", [0.0, 0.15])
def test_a_minute_in_xdyn_is_our_own_integration(tmp_path: Path, rudder: float) -> None:
    file = torpedo()
    text = rendered(file).replace("values: [0.0]", f"values: [{rudder}]")
    rows, said = in_xdyn(tmp_path, text)
    assert "Warning" not in said
    assert rows[-1, 0] == pytest.approx(SECONDS)
    way, velocity = apart(rows[::10], ours(file, rows[::10, 0], rudder))
    assert way < 1e-5
    assert velocity < 1e-5
    heading = np.degrees(2.0 * np.arctan2(rows[-1, 13], rows[-1, 10]))
    assert abs(heading) > 20.0 if rudder else abs(heading) < 20.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "centre"), [(with_mass(full(7)), CENTRE), (with_mass(at_rest(), np.zeros(3)), np.zeros(3))]
)
def test_xdyn_computes_the_force_of_the_file(tmp_path: Path, file: ParameterFile, centre: np.ndarray) -> None:
    """Its own sum of forces at the first step: every kind of term, and damping matrices about a state of rest."""
    at_centre = np.array([1.2, 0.3, -0.2, 0.1, -0.15, 0.2])
    text = rendered(file)
    for name, value in zip("uvwpqr", at_centre, strict=True):
        unit = "m/s" if name in "uvw" else "rad/s"
        start = 1.5 if name == "u" else 0.0
        text = text.replace(f"{name}: {{value: {start}, unit: {unit}}}", f"{name}: {{value: {value}, unit: {unit}}}")
    sums = [f"{axis}(sum of forces,body_of_tow,body_of_tow)" for axis in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
    head, _, _ = text.partition("    data: ")
    text = head + "    data: [t, " + ", ".join(f"'{s}'" for s in sums) + "]\n"
    rows, _ = in_xdyn(tmp_path, text, 0.02)
    nu = (velocity_transfer(-centre) @ at_centre)[None, :]
    hydrodynamic = force_transfer(centre) @ force_law(file).force(nu)[0]
    v, w = at_centre[:3], at_centre[3:]
    rigid = np.concatenate([MASS * np.cross(w, v), np.cross(w, OWN @ w)])
    np.testing.assert_allclose(rows[0, 1:], hydrodynamic - rigid, rtol=2e-6, atol=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("roll", "pitch"), [(0.0, 0.0), (0.3, -0.2), (-1.1, 0.7)])
def test_weight_and_buoyancy_in_xdyn_are_those_of_the_file(tmp_path: Path, roll: float, pitch: float) -> None:
    """About the centre of gravity, from what its two models give at the first step."""
    head, _, _ = rendered(floating()).partition("    data: ")
    before, mark, after = head.partition("initial position")
    after = after.replace("phi: {value: 0,", f"phi: {{value: {roll},", 1)
    after = after.replace("theta: {value: 0,", f"theta: {{value: {pitch},", 1)
    sums = [
        f"{axis}({m},body_of_tow,body_of_tow)"
        for m in ("gravity", "buoyancy")
        for axis in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
    ]
    text = f"{before}{mark}{after}    data: [t, {', '.join(repr(s) for s in sums)}]\n"
    rows, said = in_xdyn(tmp_path, text, 0.02)
    assert said == ""
    expected = force_transfer(CENTRE) @ restoring(floating(), quaternion(roll, pitch))
    np.testing.assert_allclose(rows[0, 1:7] + rows[0, 7:], expected, rtol=2e-6, atol=2e-3)


def negated(text: str) -> str:
    """The file with its added mass turned over, as one that takes Xudot for the matrix."""
    head, mark, rest = text.partition("        added mass matrix")
    matrix, after, tail = rest.partition("    external forces:")
    rows = [line for line in matrix.splitlines() if "row" in line]
    for row in rows:
        values = [repr(-float(v)) for v in row.partition("[")[2].rstrip("]").split(",")]
        matrix = matrix.replace(row, f"{row.partition('[')[0]}[{', '.join(values)}]")
    return head + mark + matrix + after + tail


@pytest.mark.slow
def test_an_added_mass_of_the_wrong_sign_does_not_pass(tmp_path: Path) -> None:
    """xdyn 26.8 warns where the sum is not positive definite, and goes on; earlier ones stopped."""
    file = torpedo()
    heavier = file.model_copy(update={
        "added_mass": replace(file.added_mass, matrix=tuple(tuple(1.5 * v for v in r) for r in ADDED))
    })  # fmt: skip
    _, said = in_xdyn(tmp_path, rendered(heavier), 0.1)
    assert said == ""
    _, said = in_xdyn(tmp_path, negated(rendered(heavier)), 0.1)
    assert "is not symmetric definite positive" in said


@pytest.mark.slow
def test_without_inertia_xdyn_refuses_the_file(tmp_path: Path) -> None:
    """Which the exporter does first."""
    head, _, rest = rendered(torpedo()).partition("        rigid body inertia")
    rows, said = in_xdyn(tmp_path, head + "        added mass" + rest.partition("        added mass")[2], 0.1)
    assert len(rows) == 0
    assert "rigid body inertia matrix" in said


@pytest.mark.slow
@pytest.mark.parametrize(("expression", "read"), [("2*-3", -6.0), ("1+-u(t)", 1.0), ("2^3^2", 64.0), ("1e-5*1e5", 1.0)])
def test_what_xdyn_reads_of_an_expression(tmp_path: Path, expression: str, read: float) -> None:
    """A sign before a name ends the reading without a word: the reason why such expressions are refused here."""
    text = rendered(with_mass(full(7), np.zeros(3)))
    head, _, tail = text.partition("        X: ")
    text = head + f"        X: {expression}\n" + tail.partition("\n")[2]
    text = text.partition("    data: ")[0] + "    data: ['Fx(hydrodynamic_forces,body_of_tow,body_of_tow)', t]\n"
    rows, _ = in_xdyn(tmp_path, text, 0.02)
    assert rows[0, 0] == pytest.approx(read)


@pytest.mark.slow
@pytest.mark.parametrize("row", [0, 1, 2, 5])
def test_xdyn_pushes_with_thrusters_and_steers_within_limits(tmp_path: Path, row: int) -> None:
    """Its own sums at the first step: of the model of thrusters, and that a rudder beyond its limit acts as one at it."""
    file, (left, turning, _, tilt) = driven_file(), COMMANDS[row]
    text = rendered(file.model_copy(update={"name": "file"}))
    for name, value, unit in (
        ("left", left, "1"),
        ("turning", turning, "1"),
        ("turning_tilt", tilt, "rad"),
        ("dr", 1.0, "rad"),
    ):
        before = f"{name}: {{unit: {unit}, values: [0.0]}}"
        assert text.count(before) == 1
        text = text.replace(before, f"{name}: {{unit: {unit}, values: [{value}]}}")
    axes = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
    sums = [f"{a}({m},body_of_tow,body_of_tow)" for m in ("thrusters", "hydrodynamic_forces") for a in axes]
    head, _, _ = text.partition("    data: ")
    rows, said = in_xdyn(tmp_path, f"{head}    data: [t, {', '.join(map(repr, sums))}]\n", 0.02)
    assert said == ""
    at_centre = force_transfer(CENTRE)
    np.testing.assert_allclose(rows[0, 1:7], at_centre @ due(file)[row], rtol=2e-6, atol=1e-6)
    nu = velocity_transfer(-CENTRE) @ np.array([file.conditions.speed, 0, 0, 0, 0, 0])
    water = force_law(file).force(nu[None]) + control_force(file, nu[None], np.array([[LIMIT, 0.0, 0.0]]))
    np.testing.assert_allclose(rows[0, 7:], at_centre @ water[0], rtol=2e-6, atol=1e-5)


@pytest.mark.slow
def test_the_edits_of_the_page_make_our_own_turn(tmp_path: Path) -> None:
    """xdyn moves the centre of gravity, we the reference point."""
    file = read_parameter_file(shipped("cfd_data") / "remus100" / "remus100.parameters.json")
    page = (Path(__file__).parents[2] / "docs" / "simulators.md").read_text(encoding="utf-8")
    block = page.split("```yaml\n")[1].split("```")[0]
    text = xdyn.render(file)["remus100.yml"].decode().replace("filename: remus100.csv", "filename: file.csv")
    text = text.replace("commands:\n  - name", f"{block}commands:\n  - name")
    text = text.replace("dr: {unit: rad, values: [0.0]}", "dr: {unit: deg, values: [-10.0]}")
    rows, said = in_xdyn(tmp_path, text, 30.0)
    assert "Warning" not in said
    turn = {"rudder": float(np.radians(10.0)), "turns": 5.0, "longest": 30.0}
    ours = simulate(file, "turning_circle", turn).trajectory
    shift = np.array([rotation(q) @ [0.0, 0.0, 0.0196] for q in ours.attitude[[0, -1]]])
    way = ours.position[-1] + shift[1] - shift[0]
    np.testing.assert_allclose(rows[-1, 1:4], way, atol=1e-3)
