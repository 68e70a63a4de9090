"""Work spread over this process, local processes, or a Dask cluster; results come as they are finished."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Any, TypeVar

from coeflab.core.errors import CoeflabError, InputError, shown
from coeflab.core.machine import end_with_parent

Result = TypeVar("Result")
PATIENCE = 10.0
_ADDRESS = re.compile(r"(?:(?:tcp|tls|ws|wss)://)?(?:\[[0-9A-Fa-f:.%]+\]|[^\s:/\[\]]+):(?P<port>[0-9]{1,5})")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def carried_out(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], workers: int, scheduler: str = ""
) -> Iterator[tuple[int, Result]]:
    """(index, result) of every task, in the order in which they are finished.

    Parameters
    ----------
    work : callable
        Of a module, so that other processes find it.
    tasks : mapping of index to its arguments
    workers : int
        Local processes; one: this one.
    scheduler : str
        Address of a Dask scheduler, whose workers have coeflab installed; then ``workers`` says nothing.

    Raises
    ------
    InputError
        No distributed, or no scheduler answers.
    CoeflabError
        A process was killed.
    """
    if scheduler:
        yield from _on_dask(work, tasks, scheduler)
    elif min(workers, len(tasks)) <= 1:
        for index, arguments in tasks.items():
            yield index, work(*arguments)
    else:
        yield from _on_processes(work, tasks, min(workers, len(tasks)))


def _on_processes(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], workers: int
) -> Iterator[tuple[int, Result]]:
    with _one_thread(), ProcessPoolExecutor(workers, get_context("spawn"), initializer=end_with_parent) as pool:
        waiting: dict[Future[Result], int] = {pool.submit(work, *a): index for index, a in tasks.items()}
        try:
            for done in as_completed(waiting):
                yield waiting[done], done.result()
        except BrokenProcessPool:
            raise CoeflabError(
                "A worker process was killed, perhaps for want of memory. Finished batches are kept where there is a store: "
                "start again, with fewer --workers."
            ) from None
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def _one_thread() -> Iterator[None]:
    """New processes compute on one core each: the processes are the parallel part."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _on_dask(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], scheduler: str
) -> Iterator[tuple[int, Result]]:
    try:
        import distributed
    except ImportError:
        raise InputError(
            "--scheduler without distributed", "the extra", column="--scheduler", advice='pip install "coeflab[dask]"'
        ) from None
    address = _ADDRESS.fullmatch(scheduler)
    # A client that fails on the text of its address goes on waiting for 20 s.
    if address is None or not 0 < int(address["port"]) < 1 << 16:
        raise InputError(
            f"no Dask scheduler at {shown(scheduler)}, which is no address", "the address of one that runs, such as "
            "tcp://host:8786", column="--scheduler",
        )  # fmt: skip
    connect: Any = distributed.Client
    finished: Any = distributed.as_completed
    try:
        client = connect(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as why:
        raise InputError(
            f"no Dask scheduler at {shown(scheduler)} ({type(why).__name__})", "the address of one that runs, such as "
            "tcp://host:8786", column="--scheduler",
        ) from None  # fmt: skip
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
            waiting = {client.submit(work, *a, pure=False): index for index, a in tasks.items()}
            for done in finished(list(waiting), loop=client.loop):
                yield waiting[done], done.result()
                done.release()
        except TimeoutError:
            raise InputError(
                "a Dask scheduler without workers", f"one at least within {PATIENCE:g} s", column="--scheduler"
            ) from None
        except ModuleNotFoundError as why:
            raise CoeflabError(
                f"A Dask worker has no module {why.name}: install this release of coeflab there."
            ) from None
        except distributed.KilledWorker as why:
            raise CoeflabError(
                f"Dask workers were killed ({why}). Finished batches are kept where there is a store: start again."
            ) from None
