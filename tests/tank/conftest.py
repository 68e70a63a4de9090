"""The slow solver as a plugin of this process, and of those that it starts."""

from __future__ import annotations

import pytest

from coeflab.tank.solvers import SOLVERS
from tests.tank import slow_solver


@pytest.fixture(scope="session")
def slow_environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Variables of processes that know the slow solver."""
    return slow_solver.environment(tmp_path_factory.mktemp("site"))


@pytest.fixture
def slow(slow_environment: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Every solver is the slow one, here and in the processes that are started."""
    monkeypatch.setattr(SOLVERS, "load", lambda _name: slow_solver)
    for name, value in slow_environment.items():
        monkeypatch.setenv(name, value)
