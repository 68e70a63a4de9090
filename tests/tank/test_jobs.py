"""Jobs: their files, one job carried out to every end that it can have, and kill -9 at any moment."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core import files
from coeflab.core.errors import InputError, OutputError
from coeflab.tables.raw_table import Run
from coeflab.tank import job as carried
from coeflab.tank import jobs
from coeflab.tank.job import carry_out, lengths, main
from coeflab.tank.jobs import (
    STATE,
    JobState,
    Progressed,
    only_one,
    outstanding,
    progress,
    read_job,
    read_progress,
    write_job,
    write_progress,
)
from coeflab.tank.plateau import until
from coeflab.tank.processes import is_alive, of_session, started
from coeflab.tank.states import states_of, time_left
from tests.tank import slow_solver
from tests.tank.slow_solver import prepared, rows, solvers_in, wait


@pytest.fixture(autouse=True)
def _often(slow: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """The slow solver is looked at often."""
    monkeypatch.setattr(carried, "NOTICE", 0.01)
    monkeypatch.setattr(carried, "EARLIEST", 0.02)
    monkeypatch.setattr(carried, "SHARE", 1.0)


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[bytes]]]:
    """Start the process of a job; none is left behind."""
    begun: list[subprocess.Popen[bytes]] = []

    def call(folder: Path, *more: str) -> subprocess.Popen[bytes]:
        command = (sys.executable, "-m", "coeflab.tank.job", str(folder), *more)
        begun.append(subprocess.Popen(command, stderr=subprocess.PIPE))
        return begun[-1]

    yield call
    for process in begun:
        process.kill()
        process.communicate()


# --- files -----------------------------------------------------------------------------------------------------------


def test_a_job_comes_back_from_its_file_wherever_the_tow_was_moved(tmp_path: Path) -> None:
    job = prepared(tmp_path / "x", "mesh/medium", cores=2)
    assert read_job(job.folder) == job
    (tmp_path / "x").rename(tmp_path / "y")
    assert read_job(tmp_path / "y/mesh/medium").folder == tmp_path / "y/mesh/medium"


def test_a_job_is_written_once(tmp_path: Path) -> None:
    job = prepared(tmp_path)
    assert not write_job(job)
    assert write_job(replace(job, key="other"))


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "{}", '{"kind": "coeflab job 9"}', '{"kind": "coeflab job 1", "steps": 3}']
)
def test_what_is_no_job_is_said_with_its_file(tmp_path: Path, text: str) -> None:
    (tmp_path / "job.json").write_text(text)
    with pytest.raises(InputError, match=r"job\.json"):
        read_job(tmp_path)


def test_a_state_comes_back_from_its_file(tmp_path: Path) -> None:
    said = Progressed(
        JobState.CRASHED,
        "k",
        "slow",
        3.0,
        1.5,
        2e6,
        7,
        "host",
        8.0,
        9.0,
        {"Y": 1.0},
        {"Y": float("nan")},
        5,
        2.0,
        "why",
        ("a",),
    )
    write_progress(tmp_path, said)
    assert repr(read_progress(tmp_path)) == repr(said)
    assert json.loads((tmp_path / STATE).read_text())["errors"] == {"Y": None}


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"state": "finished"}'])
def test_what_is_no_state_is_said_with_its_file(tmp_path: Path, text: str) -> None:
    (tmp_path / STATE).write_text(text)
    with pytest.raises(InputError, match=r"state\.json.*Delete the file"):
        read_progress(tmp_path)


def test_on_a_full_disk_a_state_goes_into_the_place_of_the_last_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    write_progress(tmp_path, Progressed(JobState.RUNNING, why="long " * 20))
    monkeypatch.setattr(files, "_staged", full)
    write_progress(tmp_path, Progressed(JobState.CRASHED, why="the disk is full"))
    assert read_progress(tmp_path).state is JobState.CRASHED
    with pytest.raises(OutputError, match="No space left"):
        write_progress(tmp_path / "new", Progressed(JobState.RUNNING))


# --- states ----------------------------------------------------------------------------------------------------------


def test_a_finished_job_is_kept_as_long_as_its_key_is_the_same(tmp_path: Path) -> None:
    job = prepared(tmp_path)
    assert progress(job).state is JobState.WAITING
    for state in (JobState.FINISHED, JobState.UNCONVERGED, JobState.DIVERGED):
        write_progress(job.folder, Progressed(state, "k"))
        assert outstanding([job]) == ()
    changed = replace(job, key="another key")
    assert outstanding([changed]) == (changed,)
    assert progress(changed).state is JobState.CHANGED
    assert "another" in progress(changed).why
    for state in (JobState.CRASHED, JobState.STOPPED, JobState.WAITING):
        write_progress(job.folder, Progressed(state, "k"))
        assert outstanding([job]) == (job,)


def test_a_number_that_another_process_got_shows_nobody_at_work(tmp_path: Path) -> None:
    me, host = os.getpid(), socket.gethostname()
    job = prepared(tmp_path)
    write_progress(job.folder, Progressed(JobState.RUNNING, "k", process=me, host=host, started=started(me)))
    assert progress(job).state is JobState.RUNNING
    write_progress(job.folder, Progressed(JobState.RUNNING, "k", process=me, host=host, started=started(me) - 100.0))
    assert progress(job).state is JobState.STOPPED
    assert not is_alive(2**22 + 1, float("nan"))


def test_a_job_of_another_machine_runs_while_it_gives_signs_of_life(tmp_path: Path) -> None:
    job = prepared(tmp_path)
    write_progress(job.folder, Progressed(JobState.RUNNING, "k", process=1, host="node7"))
    assert progress(job).state is JobState.RUNNING
    with pytest.raises(InputError, match="process 1 on node7"):
        carry_out(job.folder)
    os.utime(job.folder / STATE, (0, time.time() - 1000.0))
    assert progress(job).state is JobState.STOPPED


def test_the_rows_of_a_tow_say_what_holds_a_run_up_and_how_long_it_takes(tmp_path: Path) -> None:
    meshes = [prepared(tmp_path, f"mesh/{name}") for name in ("fine", "medium")]
    prepared(tmp_path, "drift_+10", ("mesh/medium",))
    prepared(tmp_path, "drift_+2", ("mesh/medium",))
    prepared(tmp_path, "arm", ("mesh/fine",))
    write_progress(meshes[0].folder, Progressed(JobState.CRASHED, "k"))
    write_progress(meshes[1].folder, Progressed(JobState.FINISHED, "k"))
    found = states_of(tmp_path)
    assert [r.job.name for r in found] == ["mesh/fine", "mesh/medium", "arm", "drift_+2", "drift_+10"]
    assert [r.progress.why for r in found if r.job.name == "arm"] == ["mesh/fine is crashed"]
    assert [r.left for r in found] == [1.0, 0.0, 0.0, 1.0, 1.0]
    assert time_left(found, 1) == 3.0
    assert time_left(found, 2) == 1.5
    with pytest.raises(InputError, match="no jobs"):
        states_of(tmp_path / "mesh/fine")


def test_what_finished_runs_took_is_expected_of_the_others(tmp_path: Path) -> None:
    meshes = [prepared(tmp_path, f"mesh/{name}") for name in ("fine", "medium")]
    for name in ("drift_+2", "drift_+4", "drift_+6"):
        prepared(tmp_path, name, ("mesh/medium",))
    prepared(tmp_path, "arm", ("mesh/fine",))
    write_progress(meshes[1].folder, Progressed(JobState.FINISHED, "k", seconds=3.0))
    write_progress(tmp_path / "drift_+2", Progressed(JobState.FINISHED, "k", seconds=2.5))
    write_progress(tmp_path / "drift_+4", Progressed(JobState.FINISHED, "k"))  # taken over: nobody ran it here
    left = {row.job.name: row.left for row in states_of(tmp_path)}
    assert left == {"mesh/fine": 3.0, "mesh/medium": 0.0, "arm": 2.5, "drift_+2": 0.0, "drift_+4": 0.0, "drift_+6": 2.5}


# --- one job ---------------------------------------------------------------------------------------------------------


def test_a_run_that_ends_on_its_plateau_says_its_forces(tmp_path: Path) -> None:
    job = prepared(tmp_path)
    found = carry_out(job.folder)
    assert found.state is JobState.FINISHED
    assert 100 < found.plateau < found.iteration <= 400.0
    assert found.means["Y"] == pytest.approx(10.0, abs=4.0 * found.errors["Y"])
    assert found.remarks == ("a remark",)
    assert repr(read_progress(job.folder)) == repr(found)
    mark = (job.folder / STATE).stat().st_mtime_ns
    carry_out(job.folder)
    assert (job.folder / STATE).stat().st_mtime_ns == mark


def test_a_run_is_stopped_on_its_plateau_and_its_result_does_not_depend_on_when_it_was_seen(tmp_path: Path) -> None:
    whole = carry_out(prepared(tmp_path, "whole").folder)
    stopped = carry_out(prepared(tmp_path, "stopped", iterations=100_000, pause=0.001).folder)
    assert whole.plateau <= stopped.iteration < 2000.0
    assert (stopped.state, stopped.plateau, dict(stopped.means)) == (whole.state, whole.plateau, dict(whole.means))


def test_a_run_of_a_study_of_iterations_makes_them_all(tmp_path: Path) -> None:
    usual = prepared(tmp_path, "usual", pause=0.001)
    whole = replace(prepared(tmp_path, "whole", pause=0.0005), to_the_end=True)
    write_job(whole)
    stopped, found = carry_out(usual.folder), carry_out(whole.folder)
    assert stopped.iteration < 400.0
    assert (found.state, found.iteration, found.plateau) == (JobState.FINISHED, 400.0, 400)
    assert dict(found.means) != dict(stopped.means)


def test_a_history_is_not_read_before_it_has_the_next_length(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    looks, read = [], slow_solver.history

    def counted(folder: Path) -> Run:
        looks.append(rows(folder))
        return read(folder)

    monkeypatch.setattr(slow_solver, "history", counted)
    found = carry_out(prepared(tmp_path, iterations=150, pause=0.005).folder)
    assert found.state is JobState.UNCONVERGED
    assert len(looks) < 3 * len(list(lengths(150)))  # without waiting for rows one every 0.02 s: about 40


def test_a_run_that_diverges_is_ended_and_said_to(tmp_path: Path) -> None:
    job = prepared(tmp_path, iterations=100_000, pause=0.005, fails="diverge")
    found = carry_out(job.folder)
    assert found.state is JobState.DIVERGED
    assert "grew" in found.why
    assert not found.means
    assert solvers_in(job.folder) == []


@pytest.mark.parametrize(
    ("fails", "state", "why"),
    [
        ("crash", JobState.CRASHED, r"exit code 1; log\.slow:2: .FATAL: no matrix."),
        ("kill", JobState.CRASHED, "slow: ended by SIGKILL, as by a system without memory$"),
        ("zero", JobState.DIVERGED, "slow: ended by SIGFPE"),
        ("unsound", JobState.CRASHED, "^unsound$"),
    ],
)
def test_a_crash_is_said_with_what_shows_it(tmp_path: Path, fails: str, state: JobState, why: str) -> None:
    found = carry_out(prepared(tmp_path, fails=fails).folder)
    assert found.state is state
    assert re.search(why, found.why)
    if fails == "crash":
        assert found.iteration == 59.0
        assert main([str(tmp_path / "run")]) == carried.FAILED


@pytest.mark.parametrize(
    ("log", "line", "text"),
    [
        ("Time = 1\n\n\n--> FOAM FATAL IO ERROR: \nUnknown symmetric matrix solver type GAMGG\n\nValid types :\n\n2\n(\n"
         "GAMG\n)\n\nfile: fvSolution.solvers.p at line 20 to 25.\n\nFOAM exiting\n", 5,
         "Unknown symmetric matrix solver type GAMGG"),
        ("--> FOAM FATAL ERROR: Unknown patch hull\n    From function x\nFOAM exiting\n", 1, "Unknown patch hull"),
        ("[0] --> FOAM FATAL ERROR: (openfoam-2312)\n[0] cannot find file\n[0]\nFOAM parallel run exiting\n", 2,
         "cannot find file"),
        ("Time = 1\nFOAM exiting\n", 0, ""),
    ],
)  # fmt: skip
def test_a_fatal_error_of_openfoam_is_said_by_what_it_says(log: str, line: int, text: str) -> None:
    found, said = carried.fatal_error(log.splitlines())
    assert found == line
    assert said.startswith(text)
    assert "exiting" not in said


def test_a_run_without_a_plateau_is_unconverged(tmp_path: Path) -> None:
    found = carry_out(prepared(tmp_path, iterations=70).folder)
    assert found.state is JobState.UNCONVERGED
    assert "on the plateau" in found.why


def test_a_program_that_is_not_there(tmp_path: Path) -> None:
    job = prepared(tmp_path)
    write_job(replace(job, steps=(replace(job.steps[0], command=("no_such_program",)),)))
    found = carry_out(job.folder)
    assert found.state is JobState.CRASHED
    assert found.why == "no_such_program cannot be started: No such file or directory"


def test_a_full_disk_is_the_reason_of_a_crash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(carried, "disk_is_full", lambda _folder: True)
    assert carry_out(prepared(tmp_path, fails="crash").folder).why == "the disk is full (slow: exit code 1)"


def test_a_solver_that_does_not_listen_is_killed_and_its_result_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(carried, "GRACE", 0.1)
    job = prepared(tmp_path, iterations=100_000, pause=0.001, deaf=True)
    found = carry_out(job.folder)
    assert found.state is JobState.FINISHED
    assert "did not end within 0.1 s" in found.remarks[-1]
    assert solvers_in(job.folder) == []


def test_two_processes_do_not_carry_out_one_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "PATIENCE", 0.1)
    job = prepared(tmp_path)
    with only_one(job.folder, "job"), pytest.raises(InputError, match=f"a job that process {os.getpid()} on"):
        carry_out(job.folder)
    assert not (job.folder / STATE).exists()
    carry_out(job.folder)


def test_lengths_do_not_depend_on_the_rows_that_there_are() -> None:
    assert list(lengths(49)) == []
    assert list(lengths(2000))[: len(list(lengths(300)))] == list(lengths(300))
    assert list(lengths(95)) == [50, 60, 70, 80, 90]


def test_a_shortened_run_ends_at_one_iteration_in_all_its_patches(tmp_path: Path) -> None:
    job = prepared(tmp_path, iterations=60)
    carry_out(job.folder)
    run = until(slow_solver.history(job.folder), 51)
    assert [len(run.history), len(run.patches["hull"])] == [51, 51]
    assert run.history.columns[0].values[-1] == 51.0
    late = until(run, 51, 20)
    assert [t.columns[0].values[0] for t in (late.history, late.patches["hull"])] == [21.0, 21.0]


# --- killed ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_kill_9_shows_and_the_next_attempt_goes_on_to_the_same_result(
    tmp_path: Path, start: Callable[..., subprocess.Popen[bytes]]
) -> None:
    whole = carry_out(prepared(tmp_path, "whole").folder)
    job = prepared(tmp_path, pause=0.005)
    process = start(job.folder)
    wait(lambda: rows(job.folder) > 120)
    assert progress(job).state is JobState.RUNNING
    assert outstanding([job]) == (job,)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    wait(lambda: not solvers_in(job.folder))
    now = progress(job)
    assert now.state is JobState.STOPPED
    assert f"process {process.pid}" in now.why
    found = carry_out(job.folder)
    assert found.state is JobState.FINISHED
    assert found.resumed_from in (100.0, 150.0)
    assert (found.plateau, dict(found.means)) == (whole.plateau, dict(whole.means))
    assert (job.folder / "log.slow.1").exists()


@pytest.mark.slow
def test_sigterm_lets_the_solver_write_what_it_has(
    tmp_path: Path, start: Callable[..., subprocess.Popen[bytes]]
) -> None:
    job = prepared(tmp_path, iterations=100_000, pause=0.02, fields=100_000)
    process = start(job.folder)
    wait(lambda: rows(job.folder) > 5)
    process.terminate()
    assert process.wait() == carried.STOPPED
    now = progress(job)
    assert now.state is JobState.STOPPED
    assert slow_solver.resumed(job)[1] == rows(job.folder)
    assert now.seconds > 0.1


@pytest.mark.slow
def test_a_signal_to_the_whole_tree_stops_a_job_even_where_the_solver_dies_first(
    tmp_path: Path, start: Callable[..., subprocess.Popen[bytes]]
) -> None:
    job = prepared(tmp_path, iterations=100_000, pause=0.02)
    process = start(job.folder)
    wait(lambda: rows(job.folder) > 5)
    for solver in solvers_in(job.folder):
        os.kill(solver, signal.SIGTERM)
    wait(lambda: not solvers_in(job.folder))
    process.terminate()
    assert process.wait() == carried.STOPPED
    assert progress(job).state is JobState.STOPPED


def test_a_solver_that_alone_is_ended_by_a_signal_crashed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(carried, "TOGETHER", 0.05)
    job = prepared(tmp_path)
    write_job(replace(job, steps=(replace(job.steps[0], command=("sh", "-c", "kill -TERM $$")),)))
    found = carry_out(job.folder)
    assert found.state is JobState.CRASHED
    assert "ended by SIGTERM" in found.why


@pytest.mark.slow
def test_a_job_stops_when_its_parent_is_killed(tmp_path: Path) -> None:
    job = prepared(tmp_path, iterations=100_000, pause=0.02)
    call = f"import os, subprocess, sys; subprocess.run([{sys.executable!r}, '-m', 'coeflab.tank.job', {str(job.folder)!r}, '--end-with', str(os.getpid())])"
    parent = subprocess.Popen([sys.executable, "-c", call])
    wait(lambda: rows(job.folder) > 5)
    parent.kill()
    parent.wait()
    wait(lambda: progress(job).state is JobState.STOPPED)
    wait(lambda: not solvers_in(job.folder))
    assert progress(job).why == "asked to end"


@pytest.mark.slow
def test_a_killed_job_is_not_taken_up_before_its_solver_has_ended(
    tmp_path: Path, start: Callable[..., subprocess.Popen[bytes]], monkeypatch: pytest.MonkeyPatch
) -> None:
    job = prepared(tmp_path)
    deaf = ("sh", "-c", "trap '' TERM; touch begun; until [ -e enough ]; do sleep .05; done")
    write_job(replace(job, steps=(replace(job.steps[0], name="deaf", command=deaf),)))
    process = start(job.folder)
    wait((job.folder / "begun").exists)
    process.kill()
    process.wait()
    monkeypatch.setattr(jobs, "PATIENCE", 0.2)
    with pytest.raises(InputError, match=f"a job that process {process.pid} on"):
        carry_out(job.folder)
    monkeypatch.setattr(jobs, "PATIENCE", 20.0)
    (job.folder / "enough").touch()
    assert carry_out(job.folder).state is JobState.FINISHED


def test_memory_is_that_of_all_processes_of_a_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hold = f"{sys.executable} -S -E -c 'x = bytearray(60_000_000); import time; time.sleep(.6)'"
    job = prepared(tmp_path)
    write_job(replace(job, steps=(replace(job.steps[0], command=("sh", "-c", f"{hold} & {hold} & wait")),)))
    assert 120e6 < carry_out(job.folder).memory < 200e6
    assert list(of_session(2**22 + 1)) == []


def test_the_command_refuses_a_folder_without_a_job(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == carried.REFUSED
    assert "found no job.json" in capsys.readouterr().err
