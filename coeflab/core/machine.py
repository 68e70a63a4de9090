"""What the machine has, and how long work is told of on it."""

from __future__ import annotations

import importlib.util
import logging
import os

STAGE = "coeflab.stage"


def physical_memory() -> int | None:
    """Bytes, where the system tells that."""
    if not hasattr(os, "sysconf"):
        return None
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compiles() -> bool:
    """Whether numba is installed; it is not imported, which takes a second."""
    return importlib.util.find_spec("numba") is not None


def stage(what: str) -> None:
    """Say what is being done now; the command line shows it on a terminal once work takes long."""
    logging.getLogger(STAGE).info(what)
