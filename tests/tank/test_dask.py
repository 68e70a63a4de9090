"""Jobs on the workers of a Dask scheduler: their order and cores, a worker that dies, a tow that is interrupted."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from coeflab.core.errors import CoeflabError, InputError
from coeflab.tank.jobs import JOB, Job, JobState, progress, read_progress
from coeflab.tank.runners.dask import Dask, carry_out
from tests.consumers.one_node_slurm import kill_all
from tests.tank.slow_solver import prepared

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("slow")]
CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(
        n_workers=2, threads_per_worker=2, processes=True, protocol="tcp", host="127.0.0.1", dashboard_address=":0",
        resources={"cores": 2}
    ) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


@pytest.fixture
def scheduler(slow: None) -> Iterator[str]:
    """Address of a Dask scheduler of our own, with two workers of two cores."""
    with subprocess.Popen(
        [sys.executable, "-c", CLUSTER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:  # fmt: skip
        yield process.stdout.readline().strip()
        kill_all(psutil.Process(process.pid))


def nothing() -> None:
    """To look at."""


def runs(job: Job) -> bool:
    """Whether its solver has begun to write."""
    return (job.folder / "fields").exists() and read_progress(job.folder).state is JobState.RUNNING


def test_jobs_on_workers(scheduler: str, tmp_path: Path) -> None:
    chosen = Dask(scheduler=scheduler)
    mesh, broken = prepared(tmp_path, "mesh/m", cores=2), prepared(tmp_path, "mesh/f", fails="crash")
    behind, damaged = prepared(tmp_path, "behind", ("mesh/f",)), prepared(tmp_path, "damaged")
    (damaged.folder / JOB).unlink()
    run = prepared(tmp_path, "run", ("mesh/m",), pause=0.01, fields=5)
    killed: list[int] = []

    def kill() -> None:
        """The worker that carries out the run, once."""
        if not killed and runs(run):
            worker = psutil.Process(read_progress(run.folder).process).parent()
            killed.append(worker.pid)
            worker.kill()

    with pytest.raises(CoeflabError, match=r"damaged: .*found no job\.json"):
        carry_out([mesh, broken, behind, run, damaged], tmp_path, chosen, kill)
    found = {job.name: progress(job) for job in (mesh, broken, behind, run)}
    assert [one.state for one in found.values()] == [
        JobState.FINISHED, JobState.CRASHED, JobState.WAITING, JobState.FINISHED
    ], found  # fmt: skip
    assert killed
    assert found["run"].resumed_from >= 5.0
    assert (found["run"].plateau, found["run"].means) == (found["mesh/m"].plateau, found["mesh/m"].means)

    long = prepared(tmp_path, "long", pause=0.2, fields=1)

    def interrupt() -> None:
        if runs(long):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        carry_out([long], tmp_path, chosen, interrupt)
    until = time.monotonic() + 20.0
    while read_progress(long.folder).state is JobState.RUNNING and time.monotonic() < until:
        time.sleep(0.1)
    assert progress(long).state is JobState.STOPPED

    with pytest.raises(InputError, match="found 3 cores for large; expected at most 2, the resource cores"):
        carry_out([prepared(tmp_path, "large", cores=3)], tmp_path, chosen, nothing)


def test_no_scheduler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.core.machine.PATIENCE", 1.0)
    for address, said in (("", "which is no address"), ("tcp://127.0.0.1:9", "no Dask scheduler at")):
        with pytest.raises(InputError, match=said):
            carry_out([], tmp_path, Dask(scheduler=address), nothing)
