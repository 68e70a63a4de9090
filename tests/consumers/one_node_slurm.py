"""A Slurm of one node without systemd: munged, slurmctld and slurmd in a folder of their own, started and ended by a test."""

from __future__ import annotations

import getpass
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import psutil

NODE = socket.gethostname()  # under which mpirun knows that it is there
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch")
MISSING = [p for p in PROGRAMS if shutil.which(p, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin") is None]
# A requeued job waits for AuthInfo's cred_expire; a dead node is noticed after SlurmdTimeout.
CONFIGURATION = """\
ClusterName={node}
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdTimeout=60
SlurmctldTimeout=60
KillWait=2
BatchStartTimeout=1
MessageTimeout=3
MinJobAge=300
NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={daemon} Sockets=1 CoresPerSocket=2 ThreadsPerCore=1 RealMemory=1000 State=UNKNOWN
PartitionName=towing Nodes={node} Default=YES MaxTime=INFINITE State=UP
"""


def free_port() -> int:
    """A port that nobody listens on."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return int(listening.getsockname()[1])


@dataclass
class OneNodeSlurm:
    """Daemons and files of the cluster.

    Attributes
    ----------
    folder : Path
        Short: the path of a socket has at most 107 letters.
    """

    folder: Path
    daemons: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)
    node: str = NODE

    @property
    def configuration(self) -> Path:
        return self.folder / "slurm.conf"

    @property
    def environment(self) -> dict[str, str]:
        """In which sbatch and its like find the cluster."""
        path = f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin"
        return {**os.environ, "SLURM_CONF": str(self.configuration), "PATH": path}

    def start(self, name: str, *command: str) -> None:
        with (self.folder / f"{name}.out").open("ab") as out:
            streams = {"stdin": subprocess.DEVNULL, "stdout": out, "stderr": out}
            self.daemons[name] = subprocess.Popen([name, *command], env=self.environment, cwd=self.folder, **streams)

    def start_node(self) -> None:
        self.start("slurmd", "-D", "-b", "-N", NODE, "-f", str(self.configuration))

    def kill_node(self) -> None:
        """As a node goes that loses its power: its daemon first, so that nothing is reported, then all that runs there."""
        ended(self.daemons["slurmd"])
        for step in [p for p in psutil.process_iter() if self._is_step(p)]:
            kill_all(step)

    def _is_step(self, process: psutil.Process) -> bool:
        with suppress(psutil.Error):
            return process.name() == "slurmstepd" and process.cwd() == str(self.folder)
        return False

    def ask(self, *command: str) -> str:
        """What sinfo, squeue or scontrol answer."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=20, check=False)
        return done.stdout + done.stderr

    def wait_for(self, node_state: str, seconds: float = 30.0) -> None:
        """Until the node has that state."""
        end = time.monotonic() + seconds
        while (found := self.ask("sinfo", "--noheader", "--format=%T").strip()) != node_state:
            assert time.monotonic() < end, f"{found}, not {node_state}\n{self.logs()}"
            time.sleep(0.1)

    def logs(self) -> str:
        """The last lines that the daemons wrote."""
        files = sorted((*self.folder.glob("*.log"), *self.folder.glob("*.out")))
        return "\n".join(f"== {f.name}\n{f.read_text(errors='replace')[-3000:]}" for f in files)

    def stop(self) -> None:
        """End everything."""
        if "slurmd" in self.daemons:
            self.kill_node()
        for daemon in self.daemons.values():
            ended(daemon)


def kill_all(process: psutil.Process) -> None:
    """A process, then its children and theirs."""
    with suppress(psutil.NoSuchProcess):
        children = process.children(recursive=True)
        process.kill()
        for child in children:
            with suppress(psutil.NoSuchProcess):
                child.kill()
        psutil.wait_procs(children, timeout=5)


def ended(daemon: subprocess.Popen[bytes]) -> None:
    """Killed, where it is not yet, and waited for."""
    if daemon.poll() is None:
        kill_all(psutil.Process(daemon.pid))
    daemon.wait(timeout=5)


@contextmanager
def one_node_slurm(folder: Path) -> Iterator[OneNodeSlurm]:
    """A cluster with one idle node of two cores, gone afterwards with everything on it."""
    cluster = OneNodeSlurm(folder)
    (folder / "state").mkdir()
    (folder / "spool").mkdir()
    ports = {"controller": free_port(), "daemon": free_port()}
    text = CONFIGURATION.format(node=NODE, host=socket.gethostname(), user=getpass.getuser(), folder=folder, **ports)
    cluster.configuration.write_text(text)
    (folder / "munge.key").write_bytes(os.urandom(128))
    (folder / "munge.key").chmod(0o600)
    files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "log-file": "log", "seed-file": "seed"}
    try:
        cluster.start("munged", "--foreground", "--force", *(f"--{k}={folder}/munge.{v}" for k, v in files.items()))
        end = time.monotonic() + 5.0
        while not (folder / "munge.socket").exists():
            assert time.monotonic() < end, cluster.logs()
            time.sleep(0.05)
        cluster.start("slurmctld", "-D", "-i", "-f", str(cluster.configuration))
        cluster.start_node()
        cluster.wait_for("idle")
        yield cluster
    finally:
        cluster.stop()
