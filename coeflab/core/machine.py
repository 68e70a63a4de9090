"""What the machine has, how long work is told of on it, and how many threads its linear algebra takes."""

from __future__ import annotations

import importlib.util
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager

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


@contextmanager
def one_thread() -> Iterator[None]:
    """Linear algebra (OpenBLAS, MKL, BLIS) and OpenMP on one thread; as a decorator, throughout a function.

    A product or a solution that several threads share is summed in another order: its last digits, and with them the
    bytes of what is written, would depend on the machine and on OPENBLAS_NUM_THREADS, OMP_NUM_THREADS or
    MKL_NUM_THREADS. What was set before holds again afterwards.
    """
    # The libraries must be there to be set: numpy and scipy each bring one of their own.
    import numpy as np  # noqa: F401
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield


def end_with_parent() -> None:
    """Let this process, a worker of `multiprocessing`, end as soon as the one that started it is gone, killed or not.

    A worker whose parent was killed would wait for work for ever, and keep the memory that it has.
    """
    from multiprocessing import parent_process
    from threading import Thread

    parent = parent_process()

    def watch() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    Thread(target=watch, daemon=True).start()
