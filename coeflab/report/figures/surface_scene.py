"""A fit over two variables as a surface in space, with its data points and their distances from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Axis, Layer, Scene
from coeflab.report.figures.panel import limits, tick_texts, ticks
from coeflab.report.figures.variables import moving, response_name, response_unit, shown_values, symbol_of, unit_of
from coeflab.report.texts import text_of

SCENE_GRID, EVERY = 33, 4


def surface_scene(model: FittedModel) -> Scene | None:
    """The surface inside the hull of the data; None where no value is determined there.

    Parameters
    ----------
    model : FittedModel
        Over two variables that fill an area.
    """
    names = moving(model)
    lines = [np.linspace(model.x[v].min(), model.x[v].max(), SCENE_GRID) for v in names]
    first, second = (m.ravel() for m in np.meshgrid(*lines, indexing="ij"))
    grid = dict(zip(names, (first, second), strict=True))
    rest = {v: np.zeros(SCENE_GRID * SCENE_GRID) for v in model.domain.variables if v not in grid}
    values, _, inside = model.evaluate({**grid, **rest})
    selected = inside & np.isfinite(values)
    if not np.any(selected):
        return None
    places = np.column_stack([shown_values(v, grid[v]) for v in names] + [np.where(selected, values, 0.0)])
    measured = np.column_stack([shown_values(v, model.x[v]) for v in names] + [model.y])
    fitted = np.column_stack([measured[:, :2], model.y - model.fit.residuals])
    layers = (
        Layer("fitted surface", "a", places, _triangles(selected)),
        Layer("lines of one angle" if _angles(names) else "grid lines", "ink", places, _lines(selected)),
        Layer("distances", "b", np.vstack([measured, fitted]), _pairs(len(measured))),
        Layer("points", "ink", measured, np.arange(len(measured)), notes=_notes(model, measured)),
    )
    name = response_name(model)
    title = f"{name}, {model.campaign}: surface in space"
    everything = np.vstack([places[selected], measured, fitted[np.isfinite(fitted).all(axis=1)]])
    flat = [
        _axis(symbol_of(v, model).removesuffix("_deg"), unit_of(v, model), everything[:, i])
        for i, v in enumerate(names)
    ]
    axes = (flat[0], flat[1], _axis(name, response_unit(model), everything[:, 2]))
    caption = text_of("surface_figure.scene", name=name, form=model.form, n_points=model.n_points)
    return Scene(title, caption, f"The surface of {model.n_points} points over {' and '.join(names)}.", layers, axes)


def _angles(names: tuple[str, ...]) -> bool:
    return all(n.startswith(("alpha", "beta")) for n in names)


def _axis(name: str, unit: str, values: Array) -> Axis:
    ends = limits(values, 0.03) or (-1.0, 1.0)
    marks = ticks(ends, 5)
    return Axis(name, "" if unit == "-" else unit, ends, tuple(map(float, marks)), tuple(tick_texts(marks)))


def _triangles(shown: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Two a cell of the grid, where all their corners are known."""
    at = np.arange(SCENE_GRID * SCENE_GRID).reshape(SCENE_GRID, SCENE_GRID)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    both = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return both[shown[both].all(axis=1)]


def _lines(shown: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Every fourth line of the grid."""
    at = np.arange(SCENE_GRID * SCENE_GRID).reshape(SCENE_GRID, SCENE_GRID)
    some = slice(None, None, EVERY)
    pairs = np.vstack(
        [
            np.column_stack([at[:-1, some].ravel(), at[1:, some].ravel()]),
            np.column_stack([at[some, :-1].ravel(), at[some, 1:].ravel()]),
        ]
    )
    return pairs[shown[pairs].all(axis=1)]


def _pairs(n: int) -> NDArray[np.int64]:
    return np.column_stack([np.arange(n), np.arange(n) + n])


def _notes(model: FittedModel, measured: Array) -> tuple[str, ...]:
    """Setting, value and row of every point."""
    names = [symbol_of(v, model).removesuffix("_deg") for v in moving(model)] + [response_name(model)]
    units = [unit_of(v, model) for v in moving(model)] + [response_unit(model)]
    return tuple(
        ", ".join(f"{n} {v:.4g}{'' if u == '-' else f' {u}'}" for n, v, u in zip(names, row, units, strict=True))
        + f"; point {label}"
        for row, label in zip(measured, model.labels, strict=True)
    )
