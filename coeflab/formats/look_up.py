"""Fitted models read off on a regular grid, for simulators that look forces up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief, locked, locking
from coeflab.vehicle.parameter_model import ParameterModel

# Per axis by the number of axes: about a thousand cells at the most.
POINTS = {1: 41, 2: 21, 3: 11}
FEWEST = 5


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("values half_widths")
class LookUp:
    """One response over a grid that spans the box of its data.

    Attributes
    ----------
    model : ParameterModel
    axes : tuple of (n,) array
        Values of each variable, in the order of the model's.
    values, half_widths : array of shape (len(axis) for each axis)
        95 % half-widths of the mean; NaN where the model may not be read or is not determined.
    inside : array of bool
        Within the convex hull of the data.
    """

    model: ParameterModel
    axes: tuple[Array, ...]
    values: Array
    half_widths: Array
    inside: NDArray[np.bool_]

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", tuple(locked(a) for a in self.axes))

    @property
    def rows(self) -> list[tuple[float | bool, ...]]:
        """Variables, value, half-width and inside of every point, the last variable fastest."""
        points = np.meshgrid(*self.axes, indexing="ij")
        columns = [*(p.ravel() for p in points), self.values.ravel(), self.half_widths.ravel()]
        inside = self.inside.ravel()
        return [(*map(float, row), bool(inside[i])) for i, row in enumerate(zip(*columns, strict=True))]


def look_up(model: ParameterModel) -> LookUp:
    """Evaluate a fitted model on a grid: 41 values of one variable, 21 x 21 of two, 11 or fewer each of more.

    A variable that the data hold at one value has one value. Zero, where it lies within, is a value of the grid.
    """
    d = len(model.variables)
    count = POINTS.get(d, FEWEST)
    axes = tuple(_axis(low, high, count) for low, high in zip(model.domain.low, model.domain.high, strict=True))
    points = np.meshgrid(*axes, indexing="ij")
    columns = {name: p.ravel() for name, p in zip(model.names, points, strict=True)}
    values, half, inside = model.evaluate(columns)
    shape = tuple(len(a) for a in axes)
    return LookUp(model, axes, values.reshape(shape), half.reshape(shape), inside.reshape(shape))


def _axis(low: float, high: float, count: int) -> Array:
    if low == high:
        return np.array([low])
    values = np.linspace(low, high, count)
    if low < 0.0 < high and not np.any(values == 0.0):
        values[np.argmin(np.abs(values[1:-1])) + 1] = 0.0
    return values
