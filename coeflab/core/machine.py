"""What the machine has, how long work is told of on it, how many threads its linear algebra takes, and other machines by Dask."""

from __future__ import annotations

import importlib.util
import logging
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from coeflab.core.errors import InputError, shown

STAGE = "coeflab.stage"
PATIENCE = 10.0  # s that a Dask scheduler and its first worker have to answer
_ADDRESS = re.compile(r"(?:(?:tcp|tls|ws|wss)://)?(?:\[[0-9A-Fa-f:.%]+\]|[^\s:/\[\]]+):(?P<port>[0-9]{1,5})")


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


@contextmanager
def dask_client(scheduler: str, key: str) -> Iterator[Any]:
    """A client of a Dask scheduler that has one worker at least; closed afterwards.

    Parameters
    ----------
    scheduler : str
        Address.
    key : str
        What a person called it: an option, a key of a file. For messages.

    Raises
    ------
    InputError
        No distributed, no address, no scheduler that answers, or no worker.
    """
    try:
        import distributed
    except ImportError:
        found, advice = f"{key} without distributed", 'pip install "coeflab[dask]"'
        raise InputError(found, "the extra", column=key, advice=advice) from None
    expected = "the address of one that runs, such as tcp://host:8786"
    address = _ADDRESS.fullmatch(scheduler)
    # A client that fails on the text of its address goes on waiting for 20 s.
    if address is None or not 0 < int(address["port"]) < 1 << 16:
        raise InputError(f"no Dask scheduler at {shown(scheduler)}, which is no address", expected, column=key)
    connect: Any = distributed.Client
    try:
        client = connect(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as why:
        found = f"no Dask scheduler at {shown(scheduler)} ({type(why).__name__})"
        raise InputError(found, expected, column=key) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            found = "a Dask scheduler without workers"
            raise InputError(found, f"one at least within {PATIENCE:g} s", column=key) from None
        yield client
