from __future__ import annotations

import os
import threading
from functools import partial
from multiprocessing import get_all_start_methods

import pytest

from coeflab.core.errors import InputError
from coeflab.report import workers as in_parallel
from coeflab.report.workers import begun

copying = pytest.mark.skipif("fork" not in get_all_start_methods(), reason="this system has no fork")


def square(x):
    return x * x, os.getpid()


def test_results_come_in_the_order_of_the_jobs():
    with begun([partial(square, x) for x in range(7)]) as results:
        assert [y for y, _ in results()] == [x * x for x in range(7)]


@copying
def test_other_processes_do_the_work(monkeypatch):
    monkeypatch.setattr(in_parallel, "_safe", lambda: True)
    monkeypatch.setattr(in_parallel, "cores", lambda: 2)
    with begun([partial(square, 1), partial(square, 2)]) as results:
        assert os.getpid() not in {process for _, process in results()}


def test_beside_another_thread_the_work_is_done_here():
    stop = threading.Event()
    other = threading.Thread(target=stop.wait)
    other.start()
    try:
        with begun([partial(square, 1), partial(square, 2)]) as results:
            assert {process for _, process in results()} == {os.getpid()}
    finally:
        stop.set()
        other.join()


def test_no_jobs_give_no_results():
    with begun([]) as results:
        assert results() == []


def failing():
    raise InputError("this", "that")


def test_an_error_in_a_job_is_the_same_error_here():
    with begun([failing, partial(square, 1)]) as results, pytest.raises(InputError, match="this"):
        results()


@copying
def test_sizes_do_not_change_the_order_of_results(monkeypatch):
    monkeypatch.setattr(in_parallel, "_safe", lambda: True)
    monkeypatch.setattr(in_parallel, "cores", lambda: 2)
    with begun([partial(square, n) for n in (1, 2, 3)], [1, 3, 2]) as results:
        assert [value for value, _ in results()] == [1, 4, 9]
