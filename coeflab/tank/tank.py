"""A tank: what is towed, in which water, by which solver, in which conditions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.types import Array, brief, locked
from coeflab.law.scaling import Conditions, Scaling
from coeflab.tank.test_matrix import TowCondition


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """One grid of a family.

    Attributes
    ----------
    name : str
    size : float
        Edge of every cell over that of the grid ``medium``.
    """

    name: str
    size: float


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Tank:
    """Everything that a tank.toml says, with what the body's symmetry adds.

    Attributes
    ----------
    name, title : str
    body : Path
        Of its body.toml.
    datum : Datum
    reference_point : (3,) array
        Of velocities and moments, m, FRD, from the datum.
    scaling : Scaling
    conditions : Conditions
        Density, viscosity, speed.
    matrix : tuple of TowCondition
    grids : tuple of Grid
        Among them ``medium``.
    solver : str
        Name of the plugin.
    options : mapping
        Of the solver, as its declaration read them: ``SOLVERS.load(solver).options(**options)`` is that declaration.
    cores : int
        That one run takes.
    by_symmetry : tuple of str
        What is stated instead of being run, in words: ``attack from drift by fourfold symmetry``.
    symmetry : tuple of str
        port-starboard, up-down, fourfold as far as the matrix makes use of them: ``campaign.symmetry`` of what is collected.
    runner : str
        Name of the plugin.
    runner_options : mapping
        As `options`, of the runner.
    """

    name: str
    title: str
    body: Path
    datum: Datum
    reference_point: Array
    scaling: Scaling
    conditions: Conditions
    matrix: tuple[TowCondition, ...]
    grids: tuple[Grid, ...] = (Grid("medium", 1.0),)
    solver: str = "openfoam"
    options: Mapping[str, Any] = field(default_factory=dict)
    cores: int = 1
    by_symmetry: tuple[str, ...] = ()
    symmetry: tuple[str, ...] = ()
    runner: str = "local"
    runner_options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "reference_point", locked(np.asarray(self.reference_point, dtype=float)))
        for name in ("options", "runner_options"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def grid(self, name: str) -> Grid:
        """The grid of that name.

        Raises
        ------
        KeyError
            The tank has none.
        """
        for grid in self.grids:
            if grid.name == name:
                return grid
        raise KeyError(name)
