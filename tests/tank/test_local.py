"""Jobs as processes of this machine: budget, needs, failures, Ctrl-C and kill -9."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core.declarations import validated
from coeflab.core.errors import CoeflabError, InputError, OutputError
from coeflab.tank.jobs import STATE, Job, JobState, outstanding, progress
from coeflab.tank.runners import RUNNERS, local
from coeflab.tank.states import states_of
from tests.tank.slow_solver import prepared, rows, solvers_in, wait

pytestmark = pytest.mark.usefixtures("slow")


def nothing() -> None:
    """Look at nothing."""


def test_it_is_a_runner() -> None:
    runner = RUNNERS.load("local")
    assert runner.carry_out is local.carry_out
    assert validated(runner.options, {"cores": 2}) == local.Local(cores=2)
    with pytest.raises(InputError, match="from 0 to 19"):
        validated(runner.options, {"nice": 30})


@pytest.mark.slow
def test_jobs_run_beside_each_other_within_their_budget_and_one_that_fails_ends_what_needs_it(tmp_path: Path) -> None:
    jobs = [
        prepared(tmp_path, "mesh/good"),
        prepared(tmp_path, "mesh/bad", fails="crash"),
        prepared(tmp_path, "on_bad", ("mesh/bad",)),
        prepared(tmp_path, "on_good", ("mesh/good",)),
        prepared(tmp_path, "crashes", ("mesh/good",), fails="crash"),
    ]
    most, early = 0, []

    def look() -> None:
        nonlocal most
        states = {row.job.name: row.progress.state for row in states_of(tmp_path)}
        most = max(most, sum(state is JobState.RUNNING for state in states.values()))
        if states["mesh/good"] is not JobState.FINISHED:
            early.extend(n for n in ("on_good", "crashes") if states[n] is not JobState.WAITING)

    local.carry_out(jobs, tmp_path, local.Local(cores=2), look)
    assert {row.job.name: row.progress.state.value for row in states_of(tmp_path)} == {
        "mesh/bad": "crashed", "mesh/good": "finished", "crashes": "crashed", "on_bad": "waiting", "on_good": "finished",
    }  # fmt: skip
    assert most <= 2
    assert early == []
    assert [job.name for job in outstanding(jobs)] == ["mesh/bad", "on_bad", "crashes"]


def test_what_fits_begins_and_what_is_too_large_for_the_memory_runs_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local, "physical_memory", lambda: 1000.0)
    a, b, c = (prepared(tmp_path, n, cores=k) for n, k in (("a", 2), ("b", 1), ("c", 1)))
    startable: Callable[..., object] = local._startable
    assert list(startable([a, b, c], [], 3)) == [a, b]
    assert list(startable([b, c], [a], 2)) == []
    large = [replace(job, memory=950.0, cores=1) for job in (a, b)]
    assert list(startable(large, [], 3)) == large[:1]
    assert list(startable([c], large[:1], 3)) == []
    needy = replace(c, needs=("a",))
    assert list(startable([needy], [a], 9)) == []


def test_every_job_that_fits_begins_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[str] = []

    class Alive:
        def poll(self) -> None:
            return None

    def began(job: Job, _nice: int) -> Alive:
        begun.append(job.name)
        return Alive()

    def look() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(local, "_begun", began)
    monkeypatch.setattr(local, "_end", lambda _processes: None)
    with pytest.raises(KeyboardInterrupt):
        local.carry_out([prepared(tmp_path, n) for n in "abcd"], tmp_path, local.Local(cores=3), look)
    assert begun == ["a", "b", "c"]


@pytest.mark.slow
def test_ctrl_c_lets_every_job_write_and_leaves_no_process(tmp_path: Path) -> None:
    jobs = [prepared(tmp_path, n, iterations=100_000, pause=0.02, fields=100_000) for n in "ab"]

    def look() -> None:
        if all(rows(job.folder) > 3 for job in jobs):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        local.carry_out(jobs, tmp_path, local.Local(cores=2), look)
    for job in jobs:
        assert progress(job).state is JobState.STOPPED
        assert (job.folder / "fields").read_text() == str(rows(job.folder))
        assert solvers_in(job.folder) == []


@pytest.mark.slow
def test_kill_9_of_the_runner_stops_its_jobs(tmp_path: Path) -> None:
    job = prepared(tmp_path, iterations=100_000, pause=0.02)
    code = (
        "import sys; from pathlib import Path; from coeflab.tank.jobs import read_job; from coeflab.tank.runners import local;"
        "local.carry_out([read_job(Path(sys.argv[1]))], Path(sys.argv[1]), local.Local(), lambda: None)"
    )
    runner = subprocess.Popen([sys.executable, "-c", code, str(job.folder)])
    wait(lambda: rows(job.folder) > 3)
    os.kill(runner.pid, signal.SIGKILL)
    runner.wait()
    wait(lambda: progress(job).state is JobState.STOPPED)
    wait(lambda: not solvers_in(job.folder))


def test_a_job_that_takes_more_cores_than_there_are(tmp_path: Path) -> None:
    job = prepared(tmp_path, cores=3)
    with pytest.raises(InputError, match="3 cores for run; expected at most 2"):
        local.carry_out([job], tmp_path, local.Local(cores=2), nothing)
    assert not (job.folder / STATE).exists()


def test_on_a_full_disk_nothing_is_begun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(local, "disk_is_full", lambda _folder: True)
    job = prepared(tmp_path)
    with pytest.raises(OutputError, match="is full"):
        local.carry_out([job], tmp_path, local.Local(), nothing)
    assert progress(job).state is JobState.WAITING


def test_a_job_that_cannot_be_carried_out_is_said_at_the_end(tmp_path: Path) -> None:
    job, other = prepared(tmp_path, "a"), prepared(tmp_path, "b", ("a",))
    (job.folder / STATE).write_text("nonsense")
    with pytest.raises(CoeflabError, match=r"^a: .*state\.json, "):
        local.carry_out([job, other], tmp_path, local.Local(), nothing)
    assert progress(other).state is JobState.WAITING
