"""Jobs under a Slurm of one node: arrays behind their meshes, a node that dies, the wall time, a tow that is interrupted."""

from __future__ import annotations

import json
import re
import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from coeflab.core.declarations import validated
from coeflab.core.errors import CoeflabError, InputError
from coeflab.tank.job import carry_out as carried_out
from coeflab.tank.jobs import Job, JobState, Progressed, Step, progress, read_progress, write_job, write_progress
from coeflab.tank.runners import slurm
from coeflab.tank.runners.slurm import Slurm, arrays, carry_out
from tests.consumers.one_node_slurm import MISSING, OneNodeSlurm
from tests.tank.slow_solver import CASE, FIELDS, HISTORY, prepared

needs_slurm = pytest.mark.skipif(
    bool(MISSING), reason=f"{', '.join(MISSING)} not installed: apt-get install slurm-wlm munge"
)


@pytest.fixture(autouse=True)
def _plugins(slow: None) -> None:
    """The slow solver, before a cluster takes the environment over."""


def nothing() -> None:
    """To look at."""


def interrupted() -> None:
    raise KeyboardInterrupt


def ids(tow: Path) -> dict[str, str]:
    return {name: given["id"] for name, given in json.loads((tow / ".runner/slurm.json").read_text()).items()}


@dataclass
class Fate:
    """What happens to a run: its node dies, comes back, and then its wall time is over. Afterwards the run is quick."""

    cluster: OneNodeSlurm
    run: Job
    died: float = 0.0
    wrote: float = 0.0
    back: bool = False
    attempts: list[Progressed] = field(default_factory=list)

    def look(self) -> None:
        found = read_progress(self.run.folder)
        if found.state is JobState.RUNNING and found.step == "slow":
            if not self.attempts or self.attempts[-1].process != found.process:
                self.attempts.append(found)
            history = self.run.folder / HISTORY
            if not self.died and history.is_file() and len(history.read_text().splitlines()) > 7:
                self.cluster.kill_node()
                self.wrote = float((self.run.folder / FIELDS).read_text())
                self.died = time.monotonic()
        # slurmctld misses a job on a node that comes back BatchStartTimeout + MessageTimeout after it gave it the job
        if self.died and not self.back and time.monotonic() - self.died > 3.0:
            self.cluster.start_node()
            self.back = True
        if found.state is JobState.STOPPED:
            (self.run.folder / CASE).write_text(json.dumps({"pause": 0.0}))


@needs_slurm
@pytest.mark.slow
def test_a_run_whose_node_dies_and_whose_wall_time_ends_goes_on_from_what_it_wrote(
    cluster: OneNodeSlurm, tmp_path: Path
) -> None:
    tow = tmp_path / "x"
    mesh, quick = prepared(tow, "mesh/medium"), prepared(tow, "straight", ("mesh/medium",))
    run = prepared(tow, "drift +4", ("mesh/medium",), pause=0.3, fields=5)
    broken, behind = prepared(tow, "mesh/fine", fails="crash"), prepared(tow, "fine", ("mesh/fine",))
    jobs = [replace(job, memory=1e8) for job in (mesh, broken, run, quick, behind)]
    # Slurm looks at wall times every 30 s and is up to as early: never before an attempt has run for 5 s
    chosen = Slurm(wall_time=60.0, notice=25.0)
    with pytest.raises(KeyboardInterrupt):
        carry_out(jobs, tow, chosen, interrupted)
    given = ids(tow)
    fate = Fate(cluster, run)
    carry_out(jobs, tow, chosen, fate.look)

    assert ids(tow) == given  # found again in the queue, not given to it twice
    array, element = given["drift +4"].split("_")
    assert (given["straight"], element) == (f"{array}_1", "0")
    states = {job.name: progress(job) for job in jobs}
    assert [states[job.name].state for job in jobs] == [
        JobState.FINISHED, JobState.CRASHED, JobState.FINISHED, JobState.FINISHED, JobState.WAITING
    ]  # fmt: skip

    alone = prepared(tmp_path, "alone")
    carried_out(alone.folder)
    rows = {job.name: (job.folder / HISTORY).read_text().splitlines() for job in (run, quick, alone)}
    settled = read_progress(alone.folder).plateau
    for name in ("drift +4", "straight"):
        assert (states[name].plateau, states[name].means) == (settled, read_progress(alone.folder).means)
        assert rows[name][:settled] == rows["alone"][:settled]

    # from the start, from the fields of a node that died, and from what the end of the wall time made it write
    last = (*fate.attempts, states["drift +4"])[-1].resumed_from
    assert len({attempt.process for attempt in fate.attempts}) >= 2
    assert fate.attempts[1].resumed_from == fate.wrote >= 5.0
    assert fate.attempts[1].resumed_from < last == states["drift +4"].resumed_from
    log = (tow / ".runner/slurm" / f"{given['drift +4']}_0_log.out").read_text()
    assert len(re.findall("Starting with JobEnvironment", log)) == 3
    assert len(re.findall("Calling checkpoint method", log)) == 1
    assert len(list(run.folder.glob("log.slow*"))) == 3


@needs_slurm
@pytest.mark.slow
def test_a_job_gets_its_cores_and_jobs_that_changed_or_are_given_up_leave_the_queue(
    cluster: OneNodeSlurm, tmp_path: Path
) -> None:
    shell = Step("ask", ("sh", "-c", "echo $SLURM_NTASKS $SLURM_JOB_NUM_NODES $TOWED > tasks"))
    wide = replace(prepared(tmp_path / "wide", "run", cores=2), steps=(shell,))
    write_job(wide)
    carry_out([wide], tmp_path / "wide", Slurm(setup=("export TOWED=yes",)), nothing)
    assert (wide.folder / "tasks").read_text().split() == ["2", "1", "yes"]  # mpirun finds as many slots

    cluster.ask("scontrol", "update", f"NodeName={cluster.node}", "State=DRAIN", "Reason=test")
    job = prepared(tmp_path / "x", "run")
    with pytest.raises(InputError, match=r"refuses.*invalid partition specified: nowhere"):
        carry_out([job], tmp_path / "x", Slurm(partition="nowhere"), nothing)

    def queued(job: Job, **chosen: bool) -> tuple[str, dict[str, str]]:
        with pytest.raises(KeyboardInterrupt):
            carry_out([job], tmp_path / "x", Slurm(**chosen), interrupted)
        lines = cluster.ask("squeue", "--noheader", "--states=all", "--format=%i %T").splitlines()
        return ids(tmp_path / "x")["run"], dict(line.split() for line in lines)

    first, states = queued(job)
    assert states[first] == "PENDING"
    assert queued(job)[0] == first
    second, states = queued(replace(job, key="other"))
    assert (states[first], states[second]) == ("CANCELLED", "PENDING")
    assert queued(replace(job, key="other"), cancel=True)[1][second] == "CANCELLED"


def test_jobs_that_need_the_same_make_an_array(tmp_path: Path) -> None:
    meshes = [prepared(tmp_path, "m1"), prepared(tmp_path, "m2")]
    runs = [prepared(tmp_path, f"r{i}", (f"m{1 + i % 2}",), cores=1 + (i == 3)) for i in range(4)]
    found = arrays([meshes[0], runs[0], meshes[1], *runs[1:]])
    assert [[job.name for job in group] for group in found] == [["m1", "m2"], ["r0", "r2"], ["r1"], ["r3"]]


def test_what_slurm_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tow = tmp_path / "a tow, 1"
    (tmp_path / "srun").touch()
    (tmp_path / "squeue").touch()
    (tmp_path / "sbatch").write_text('#!/bin/sh\ncat "$1" >> asked; echo Submitted batch job $(grep -c ^exec asked)0\n')
    for name in ("srun", "sbatch", "squeue"):
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.chdir(tmp_path)
    mesh = replace(prepared(tow, "mesh/m", cores=4), memory=2e9)
    runs = [replace(prepared(tow, name, ("mesh/m", "kept")), memory=1e9) for name in ("a", "b")]
    extra = {"qos": "long", "exclusive": True, "hold": False}
    chosen = Slurm(
        partition="cpu", account="naval", wall_time=5400.0, notice=90.0, at_once=1, setup=("echo on",), extra=extra
    )
    with pytest.raises(KeyboardInterrupt):
        carry_out([mesh, *runs], tow, chosen, interrupted)
    _, first, second = (tmp_path / "asked").read_text().split("#!/bin/bash")
    common = {"time=90", "signal=B:USR2@90", "partition=cpu", "account=naval", "qos=long"}
    common |= {"requeue", "exclusive", "kill-on-invalid-dep=yes", "open-mode=append", "nodes=1"}
    asked = [set(re.findall("^#SBATCH --(.*)", one, re.MULTILINE)) for one in (first, second)]
    for found, own in zip(
        asked, ({"ntasks=4", "mem=3000M"}, {"ntasks=1", "mem=1500M", "array=0-1%1", "dependency=afterok:10"})
    ):
        assert {line for line in found if not line.startswith(("output=", "job-name="))} == common | own
        assert any(re.fullmatch("job-name=coeflab_a_tow__1_[0-9a-f]{6}", line) for line in found)
    assert second.index("echo on") < second.index(f"exec {sys.executable} -u -m submitit")
    assert ids(tow) == {"mesh/m": "10", "a": "20_0", "b": "20_1"}


@pytest.mark.parametrize(("state", "ended", "said"), [
    ("TIMEOUT", JobState.STOPPED, "TIMEOUT; `coeflab tow --continue`"),
    ("OUT_OF_MEMORY", JobState.CRASHED, "set memory in"),
])  # fmt: skip
def test_a_job_that_slurm_ended_says_so(tmp_path: Path, state: str, ended: JobState, said: str) -> None:
    job = prepared(tmp_path, "run")
    write_progress(job.folder, Progressed(JobState.RUNNING, job.key, host="another", iteration=7.0))
    slurm._ended(job, "12_0", state)
    found = read_progress(job.folder)
    assert (found.state, found.iteration) == (ended, 7.0)
    assert f"Slurm, job 12_0: {state}" in found.why
    assert said in found.why


def test_a_job_that_never_began_says_where_to_look(tmp_path: Path) -> None:
    job = prepared(tmp_path, "run")
    slurm._ended(job, "12_0", "CANCELLED")
    assert progress(job).state is JobState.WAITING
    slurm._ended(job, "12_0", "FAILED")
    assert "before it began; see .runner/slurm/12_0_0_log.out" in progress(job).why


def test_what_tank_toml_may_say() -> None:
    chosen = validated(Slurm, {"wall_time": "2 h", "extra": {"qos": "long"}, "attempts": 3})
    assert (chosen.wall_time, chosen.extra["qos"], chosen.attempts) == (7200.0, "long", 3)
    with pytest.raises(InputError, match="less than the wall time of 60 s"):
        validated(Slurm, {"wall_time": "1 min", "notice": "90 s"})
    with pytest.raises(InputError, match="a whole number above zero"):
        validated(Slurm, {"attempts": 0})


def test_no_slurm_or_one_that_does_not_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="no sbatch; expected Slurm on this machine"):
        carry_out([], tmp_path, Slurm(), nothing)
    for name in ("sbatch", "srun", "squeue"):
        (tmp_path / name).write_text("#!/bin/sh\necho 'slurm_load_jobs error: no controller' >&2; exit 1\n")
        (tmp_path / name).chmod(0o755)
    (tmp_path / ".runner").mkdir()
    (tmp_path / ".runner/slurm.json").write_text('{"run": {"id": "1", "key": "k"}}')
    with pytest.raises(CoeflabError, match="squeue says: slurm_load_jobs error: no controller"):
        carry_out([prepared(tmp_path, "run")], tmp_path, Slurm(), nothing)
