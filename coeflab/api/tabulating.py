"""`tabulated`: fitted tables of a vehicle over a grid of their variables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.vehicle.parameter_model import ANGLE_OF, ParameterModel, chosen, from_angles

__all__ = ["ParameterModel", "Tabulated", "chosen", "tabulated", "units_of"]
CHUNK = 65_536


class Tabulated(NamedTuple):
    """Points of a grid, the last variable fastest.

    Attributes
    ----------
    settings : mapping of str to (n,) array
        As given: angles in degrees.
    values : tuple of ((n,) array, (n,) array)
        Of each model the response and its U95; NaN where the model refuses.
    inside : (n,) boolean array
        Whether every model has data about the point.
    """

    settings: Mapping[str, Array]
    values: tuple[tuple[Array, Array], ...]
    inside: NDArray[np.bool_]


def units_of(models: Sequence[ParameterModel]) -> dict[str, str]:
    """Units of what models take, and of the flow angles that stand for v' and w'."""
    return dict.fromkeys(ANGLE_OF, "rad") | {v.name: v.unit for m in models for v in m.variables}


def tabulated(models: Sequence[ParameterModel], given: Mapping[str, Array]) -> Iterator[Tabulated]:
    """Models over all combinations of values, in pieces of at most `CHUNK` points.

    Parameters
    ----------
    models : sequence of ParameterModel
        Of one parameter file; `chosen` gives those of the variables.
    given : mapping of str to (k,) array
        Values of every variable: angles in degrees, primes as such.

    Examples
    --------
    >>> import coeflab as cf
    >>> models = chosen(cf.read_vehicle("huuv").file.models, "C_D", ("beta",))
    >>> grid = next(tabulated(models, {"beta": np.array([0.0, 5.0])}))
    >>> len(grid.inside), bool(grid.values[0][0][1] > grid.values[0][0][0])
    (2, True)
    """
    units, shape = units_of(models), tuple(len(x) for x in given.values())
    total = math.prod(shape)
    for start in range(0, total, CHUNK):
        index = np.unravel_index(np.arange(start, min(start + CHUNK, total)), shape)
        settings = {v: x[i] for (v, x), i in zip(given.items(), index, strict=True)}
        columns = {v: np.radians(x) if units[v] == "rad" else x for v, x in settings.items()}
        found = [m.evaluate(from_angles(m, columns)) for m in models]
        inside = np.all([within for *_, within in found], axis=0)
        yield Tabulated(settings, tuple((value, half) for value, half, _ in found), inside)
