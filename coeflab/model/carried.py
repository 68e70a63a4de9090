"""Uncertainty carried through a manoeuvre: what is asked for, and what came out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import MEMBERS
from coeflab.kernels.brief import brief
from coeflab.model.draws import Uncertain
from coeflab.model.frozen import locked
from coeflab.model.inertia import MEASURED, WaterInertia
from coeflab.model.marching import KERNELS
from coeflab.model.spread import Importance, Spread

Array = NDArray[np.float64]
FEWEST_MEMBERS = 40


@brief
@dataclass(frozen=True, slots=True)
class Question:
    """What is asked for.

    Attributes
    ----------
    manoeuvre : str
    options : mapping
        Of the manoeuvre.
    members : int
        40 to a million.
    seed : int
    sobol : bool
        Whether independent groups get Sobol indices: as many rows as the largest power of two within ``members``, each of
        2 + groups further runs.
    free, hold : sequence of str
    tables : bool
    accelerations : {"measured", "computed"}
    current : (float, float, float)
    kernel : str
        Of the march: auto, numpy or compiled.
    """

    manoeuvre: str
    options: Mapping[str, int | float | str]
    members: int = 1000
    seed: int = 1
    sobol: bool = False
    free: Sequence[str] = ()
    hold: Sequence[str] = ()
    tables: bool = False
    accelerations: str = MEASURED
    current: tuple[float, float, float] = (0.0, 0.0, 0.0)
    kernel: str = "auto"

    def __post_init__(self) -> None:
        if not FEWEST_MEMBERS <= self.members <= MEMBERS:
            raise InputError(
                f"{self.members} members", f"{FEWEST_MEMBERS} to {MEMBERS:,}", column="--members",
                advice="A percentile of fewer is no interval." if self.members < FEWEST_MEMBERS else "",
            )  # fmt: skip
        if self.seed < 0:
            raise InputError(f"a seed of {self.seed}", "a whole number from 0", column="--seed")
        if self.kernel not in KERNELS:
            raise InputError(shown(self.kernel), f"one of {', '.join(KERNELS)}", column="--kernel")


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Carried:
    """What came out.

    Attributes
    ----------
    question : Question
    vehicle : str
    length : float
    varied : Uncertain
    deviations : (members, k) array
    names : tuple of str
        Figures of the manoeuvre.
    values : (members, figures) array
        Not a number where a member does not have the figure.
    spreads : tuple of Spread
        Figures of the manoeuvre, then stability indices.
    importances : tuple of Importance
    water : WaterInertia
        Which accelerations were chosen.
    runs : int
        Motions that were computed, those for Sobol indices too.
    rows : int
        Of the Sobol design; zero where there is none.
    statements : tuple of str
    undetermined : str
        Why no figure of the manoeuvre has a value at the values of the file, so that no member was moved.
    """

    question: Question
    vehicle: str
    length: float
    varied: Uncertain
    deviations: Array
    names: tuple[str, ...]
    values: Array
    spreads: tuple[Spread, ...]
    importances: tuple[Importance, ...]
    water: WaterInertia
    runs: int
    rows: int
    statements: tuple[str, ...]
    undetermined: str = ""

    def __post_init__(self) -> None:
        for name in ("deviations", "values"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def sample(self, name: str) -> Array:
        """(n,) values of the members that have a figure of the manoeuvre."""
        column = self.values[:, self.names.index(name)]
        return np.asarray(column[np.isfinite(column)])
