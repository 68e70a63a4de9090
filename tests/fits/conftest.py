from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

import pytest


@pytest.fixture
def one_thread() -> Iterator[None]:
    """Several BLAS threads on matrices of 40 rows cost more than they save."""
    with import_module("threadpoolctl").threadpool_limits(1):
        yield
