"""Processes of this machine: whether one lives, what a session of them takes, and children that end with their parent."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from math import isnan, nan
from pathlib import Path

from coeflab.core.text.bounded import leading_bytes

PR_SET_PDEATHSIG = 1  # of Linux, <sys/prctl.h>
PROC = Path("/proc")
POLL = 0.05  # s


def started(process: int) -> float:
    """When a process began, clock ticks since the machine did; NaN where the system does not say, or it is gone."""
    found = _stat(process)
    return float(found[19]) if found else nan


def is_alive(process: int, since: float) -> bool:
    """Whether a process lives and is the one that began then.

    Parameters
    ----------
    process : int
    since : float
        As `started` gave it; NaN where that is unknown.
    """
    if process <= 0:
        return False
    found = _stat(process)
    if found:
        return found[0] not in "ZX" and (isnan(since) or float(found[19]) == since)
    if PROC.joinpath("self/stat").exists():
        return False
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _proc_file(process: int, name: str) -> str:
    return leading_bytes(PROC / str(process) / name, 1 << 16).decode("utf-8", "replace")


def _stat(process: int) -> list[str]:
    """Fields of /proc/PID/stat behind the name, the state first; empty where there are none."""
    try:
        return _proc_file(process, "stat").rpartition(")")[2].split()
    except OSError:
        return []


def of_session(session: int) -> Iterator[int]:
    """Living processes of a session; a launcher such as mpirun gives its ranks groups of their own, but no session."""
    with suppress(OSError), os.scandir(PROC) as listing:
        for entry in listing:
            if entry.name.isdigit():
                found = _stat(int(entry.name))
                if found and found[3] == str(session) and found[0] not in "ZX":
                    yield int(entry.name)


def memory(session: int) -> float:
    """Sum of the peaks of resident memory of a session's processes, bytes; 0 where the system does not say."""
    total = 0.0
    for process in of_session(session):
        with suppress(OSError, ValueError, IndexError):  # it ended meanwhile
            text = _proc_file(process, "status")
            total += 1024.0 * float(text.partition("VmHWM:")[2].split(maxsplit=1)[0])
    return total


def end_session(session: int, grace: float) -> None:
    """Ask all processes of a session to end, and kill those that still live after so many seconds."""
    _signal(session, signal.SIGTERM)
    until = time.monotonic() + grace
    while any(of_session(session)) and time.monotonic() < until:
        time.sleep(POLL)
    if sys.platform != "win32":
        _signal(session, signal.SIGKILL)


def _signal(session: int, what: signal.Signals) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(session, what)
    for process in of_session(session):
        with suppress(ProcessLookupError, PermissionError):
            os.kill(process, what)


def ends_with(parent: int) -> Callable[[], None]:
    """What a child calls first, to get SIGTERM when its parent is gone, however that ended. Linux; elsewhere nothing.

    Parameters
    ----------
    parent : int
        Number of that process: where it is gone already, the child ends at once.
    """
    prctl = ctypes.CDLL(None, use_errno=True).prctl if sys.platform == "linux" else None

    def call() -> None:
        if prctl is not None:
            prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
            if os.getppid() != parent:
                os._exit(128 + signal.SIGTERM)

    return call
