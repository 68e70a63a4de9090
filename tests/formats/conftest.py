"""Losses of exports over a few of the states that `covered_grid` tries."""

from __future__ import annotations

import pytest

from coeflab.core.types import Array
from coeflab.formats import loss
from coeflab.vehicle.parameter_file import ParameterFile


@pytest.fixture
def few_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of 41 of the grid, of which the law of Gazebo takes a second: it is evaluated one state after the other."""
    whole = loss.covered_grid

    def few(parameters: ParameterFile) -> tuple[Array, str]:
        nu, words = whole(parameters)
        return nu[::41], words

    monkeypatch.setattr(loss, "covered_grid", few)
