"""Independent parts of a report, drawn on other cores while this one goes on."""

from __future__ import annotations

import gc
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import current_process, get_all_start_methods, get_context
from typing import TypeVar

from coeflab.core.machine import cores, end_with_parent

Part = TypeVar("Part")
MOST = 4
_JOBS: list[Callable[[], object]] = []


@contextmanager
def begun(jobs: Sequence[Callable[[], Part]], sizes: Sequence[int] = ()) -> Iterator[Callable[[], list[Part]]]:
    """Start jobs; the yielded function waits for what they return, in their own order.

    Copies of this process do the work, so that a job may hold anything; what it returns is pickled. Where copying is not
    to be had or not safe (a second Python thread might hold a lock), the jobs are done here, with the same result.

    Parameters
    ----------
    jobs : sequence of callable
        Pure, and of numpy and matplotlib alone: libraries with threads of their own do not survive the copying.
    sizes : sequence of int, optional
        How much each has to do; the largest begins.
    """
    workers = min(MOST, len(jobs), cores())
    if workers < 2 or _JOBS or not _safe():
        yield lambda: [job() for job in jobs]
        return
    _JOBS.extend(jobs)
    try:
        with ProcessPoolExecutor(workers, get_context("fork"), initializer=_prepare) as pool:
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message=".*fork", category=DeprecationWarning)
                order = sorted(range(len(jobs)), key=lambda i: -sizes[i] if sizes else i)
                waiting = {i: pool.submit(_done, i) for i in order}

            def results() -> list[Part]:
                try:
                    return [waiting[i].result() for i in range(len(jobs))]  # type: ignore[misc]
                except BrokenProcessPool:
                    return [job() for job in jobs]

            yield results
    finally:
        _JOBS.clear()


def _prepare() -> None:
    """What a copy does first."""
    end_with_parent()
    # What was there before the copying is not searched for garbage again and again.
    gc.freeze()


def _done(index: int) -> object:
    return _JOBS[index]()


def _safe() -> bool:
    forks = "fork" in get_all_start_methods() and sys.platform != "darwin"  # whose system libraries do not survive it
    return forks and not current_process().daemon and threading.active_count() == 1
