"""What simpleFoam makes of the cases: forces on a spheroid, stopped and killed runs that go on."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.raw_table import Ended, Run
from coeflab.tank.jobs import Job
from coeflab.tank.processes import of_session
from coeflab.tank.solvers import openfoam
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half
from tests.tank import spheroid as towed

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        shutil.which("simpleFoam") is None, reason="OpenFOAM is not installed: apt-get install openfoam"
    ),
]
ITERATIONS = 120
Jobs = Callable[[Tank], dict[str, Job]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a tow, with its meshes."""
    folder = tmp_path_factory.mktemp("tow")
    for half in Half:
        towed.meshed(towed.mesh_of(folder, "medium", half).folder, half)
    return folder


@pytest.fixture(scope="module")
def made(folder: Path) -> Jobs:
    """Cases of a tank beside the meshes, whose zone of all cells is made."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(openfoam, "mesh_job", lambda _t, _b, grid, half, *_: towed.mesh_of(folder, grid.name, half))
        patch.setattr(openfoam, "expected_cells", lambda _: float(towed.CELLS))
        for job in openfoam.jobs(towed.tank(*towed.MATRIX), towed.surface(), folder):
            if not job.needs:
                towed.carried_out(job)

    def jobs(tank: Tank) -> dict[str, Job]:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(openfoam, "mesh_job", lambda _t, _b, grid, half, *_: towed.mesh_of(folder, grid.name, half))
            patch.setattr(openfoam, "expected_cells", lambda _: float(towed.CELLS))
            return {j.name: j for j in openfoam.jobs(tank, towed.surface(), folder)}

    return jobs


@pytest.fixture(scope="module")
def runs(made: Jobs) -> dict[str, Run]:
    """All conditions, to the end."""
    out = {}
    for name, job in made(towed.tank(*towed.MATRIX, options={"iterations": ITERATIONS})).items():
        if job.needs:
            towed.carried_out(job)
            assert openfoam.ended(job)[1] == ""
            out[name] = openfoam.history(job.folder)
    return out


def test_the_history_says_the_condition(runs: dict[str, Run]) -> None:
    for condition in towed.MATRIX:
        found = runs[condition.name].conditions
        said = [float(str(found[n].value)) if n in found else 0.0 for n in "uvwpqr"]
        np.testing.assert_allclose(said, [*condition.velocity, *condition.rates], atol=1e-12)


def test_patches_add_up_to_the_body(runs: dict[str, Run]) -> None:
    for run in runs.values():
        parts = [last(run, patch) for patch in ("hull", "stern")]
        for name, value in last(run).items():
            assert parts[0][name] + parts[1][name] == pytest.approx(value, rel=1e-5, abs=1e-3)


def test_drift_to_port_is_pushed_to_starboard_and_turned_away(runs: dict[str, Run]) -> None:
    force = last(runs["drift"])
    assert force["X"] < 0.0
    assert force["Y"] > 0.0
    # Munk's moment -(m_yy - m_xx) u v destabilises: v < 0 gives N > 0; viscous stern flow takes some of it away.
    added = towed.added_mass()
    munk = -(added[1] - added[0]) * towed.DRIFT[0] * towed.DRIFT[1]
    assert 0.4 * munk < force["N"] < munk
    assert abs(force["Z"]) < 1e-3 * force["Y"]


def test_the_arm_is_damped_and_its_forces_hold_no_inertia_of_the_frame(runs: dict[str, Run]) -> None:
    force, straight = last(runs["arm"]), last(runs["straight"])
    assert force["X"] == pytest.approx(straight["X"], rel=0.1)
    assert force["N"] * towed.YAW[2] < 0.0
    # In potential flow Y = -m_xx u r; the inertia of a frame would add the displaced mass, twelve times as much.
    displaced = towed.DENSITY * np.pi / 6.0 * towed.LENGTH * towed.DIAMETER**2
    assert abs(force["Y"]) < 0.1 * displaced * 1.0 * towed.YAW[2]


def test_an_arm_that_hardly_turns_is_straight_tow(runs: dict[str, Run]) -> None:
    turning, straight = last(runs["hardly_turning"]), last(runs["drift"])
    for name in "XYN":
        assert turning[name] == pytest.approx(straight[name], rel=0.003)


def test_drift_and_yaw_together_are_nearly_their_sum(runs: dict[str, Run]) -> None:
    both, drift, arm = (last(runs[n]) for n in ("combined", "drift", "arm"))
    assert both["N"] == pytest.approx(drift["N"] + arm["N"], abs=0.1 * abs(arm["N"]))
    assert both["Y"] == pytest.approx(drift["Y"] + arm["Y"], abs=0.1 * abs(drift["Y"]))


def test_a_half_is_the_whole(runs: dict[str, Run]) -> None:
    for half, whole in (("drift_upper", "drift"), ("arm_upper", "arm")):
        found, expected = last(runs[half]), last(runs[whole])
        assert set(found) == set("XYN")
        for name in found:
            assert found[name] == pytest.approx(expected[name], rel=0.01, abs=2e-3 * abs(expected["X"]))


def test_attack_is_drift_a_quarter_of_a_turn_on(runs: dict[str, Run]) -> None:
    attack, drift = last(runs["attack_port"]), last(runs["drift"])
    for mine, its, sign in (("X", "X", 1), ("Z", "Y", -1), ("M", "N", 1)):
        assert attack[mine] == pytest.approx(sign * drift[its], rel=0.01)


def test_a_run_that_is_stopped_goes_on_to_the_same_end(made: Jobs, runs: dict[str, Run]) -> None:
    job = made(towed.tank(replace(towed.MATRIX[6], name="stopped"), options={"iterations": ITERATIONS}))["stopped"]
    with started(job) as process:
        waited(lambda: rows(job) > 20)
        openfoam.stop(job.folder)
        assert process.wait(60) == 0
    first = rows(job)
    steps, at = openfoam.resumed(job)
    assert at == first < ITERATIONS
    towed.carried_out(replace(job, steps=steps))
    end = openfoam.history(job.folder)
    assert (len(end.history), end.ended) == (ITERATIONS, Ended.WHOLE)
    for name, value in last(runs["combined"]).items():
        assert last(end)[name] == pytest.approx(value, rel=1e-6, abs=1e-4)


def test_a_killed_run_of_two_processes_goes_on_as_one_from_what_it_wrote_last(
    made: Jobs, runs: dict[str, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMPI_MCA_mpi_yield_when_idle", "1")  # tests share the cores
    tank = towed.tank(replace(towed.MATRIX[1], name="killed"), options={"iterations": 40, "checkpoint": 5}, cores=2)
    job = made(tank)["killed"]
    with started(job):
        waited((job.folder / "processor1/10").is_dir)
    assert [s.name for s in openfoam.resumed(job)[0]] == ["simpleFoam"]
    job = made(replace(tank, cores=1))["killed"]
    steps, at = openfoam.resumed(job)
    assert [s.name for s in steps] == ["reconstructPar", "cleanProcessors", "simpleFoam"]
    assert at in {5.0, 10.0, 15.0, 20.0, 25.0}
    towed.carried_out(replace(job, steps=steps))
    assert f"Time = {at + 1:g}\n" in (job.folder / "log.simpleFoam").read_text()
    for name, value in last(runs["drift"], row=39).items():
        assert last(openfoam.history(job.folder))[name] == pytest.approx(value, rel=2e-3, abs=0.02)


@pytest.mark.parametrize("wall", ["functions", "resolved"])
@pytest.mark.parametrize("turbulence", ["k-omega SST", "realizable k-epsilon", "Spalart-Allmaras"])
def test_every_model_starts(made: Jobs, turbulence: str, wall: str) -> None:
    given = {"turbulence": turbulence, "wall": wall, "iterations": 15, "simplec": False}
    job = made(towed.tank(replace(towed.MATRIX[5], name="turbulent"), options=given, viscosity=1e-5))["turbulent"]
    towed.carried_out(job)
    assert openfoam.ended(job)[1] == ""
    assert last(openfoam.history(job.folder))["X"] < 0.0


def test_a_sphere_that_turns_slowly_has_the_torque_of_stokes(tmp_path: Path) -> None:
    # K = -8 pi mu R^3 p (Lamb, Hydrodynamics, 334), from R to 10 R.
    rate, viscosity = 0.01, 0.1
    mesh = towed.meshed(tmp_path / "mesh/medium", scale="(1 1 1)")
    condition = towed.condition("turning", (0, 0, 0), (rate, 0, 0))
    tank = towed.tank(condition, viscosity=viscosity, options={"iterations": 100})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(openfoam, "mesh_job", lambda *_: towed.job_of(mesh))
        patch.setattr(openfoam, "expected_cells", lambda _: float(towed.CELLS))
        for job in openfoam.jobs(tank, towed.surface(), tmp_path):
            towed.carried_out(job)
    force = last(openfoam.history(tmp_path / "turning"))
    stokes = -8.0 * np.pi * towed.DENSITY * viscosity * rate
    assert force["K"] == pytest.approx(stokes, rel=0.05)
    assert np.hypot.reduce([force[n] for n in "XYZMN"]) < 1e-3 * abs(stokes)


def last(run: Run, patch: str = "", row: int = -1) -> dict[str, float]:
    table = run.patches[patch] if patch else run.history
    return {c.means: float(c.values[row]) for c in table.columns if c.means in set("XYZKMN")}


def rows(job: Job) -> int:
    return len(openfoam.history(job.folder).history)


@contextmanager
def started(job: Job) -> Iterator[subprocess.Popen[bytes]]:
    """The solver, after the steps before it, in a session of its own; what is left of it is killed."""
    towed.carried_out(replace(job, steps=tuple(s for s in job.steps if not s.watched)))
    solver = next(s for s in job.steps if s.watched)
    with (job.folder / "log.simpleFoam").open("w") as log:
        process = subprocess.Popen(solver.command, cwd=job.folder, stdout=log, stderr=log, start_new_session=True)
    try:
        yield process
    finally:
        for each in (process.pid, *of_session(process.pid)):  # mpirun and the processes that it started
            with suppress(ProcessLookupError):
                os.kill(each, signal.SIGKILL)
        process.wait(60)


def waited(until: Callable[[], bool]) -> None:
    end = time.monotonic() + 120.0
    while not until():
        assert time.monotonic() < end, "not within two minutes"
        time.sleep(0.02)
