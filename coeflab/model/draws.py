"""Draws of what a parameter file is uncertain about, from its covariance; normal distributions throughout."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.symbols import derivative
from coeflab.kernels.groups import connected
from coeflab.model.frozen import locked
from coeflab.model.parameter_file import ParameterFile

Array = NDArray[np.float64]
CELLS = Sequence[Sequence[float | None]]
CORRELATED = 0.01
NEGATIVE = -1e-8
UNSTATED = "not varied: no uncertainty is stated"


@dataclass(frozen=True, slots=True, eq=False)
class Uncertain:
    """What is drawn.

    Attributes
    ----------
    symbols : tuple of str
        Coefficients, primed, and terms of fitted tables as ``response term``.
    values : (k,) array
        As the file states them.
    covariance : (k, k) array
        Of standard uncertainties.
    sources : tuple of str
        Campaign or work behind each.
    held : tuple of str
        What enters the motion but has no stated uncertainty.
    statements : tuple of str
    """

    symbols: tuple[str, ...]
    values: Array
    covariance: Array
    sources: tuple[str, ...]
    held: tuple[str, ...]
    statements: tuple[str, ...]

    def __post_init__(self) -> None:
        for name in ("values", "covariance"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def deviation(self) -> Array:
        """(k,) standard uncertainties."""
        return np.sqrt(np.diag(self.covariance))

    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Blocks of the covariance: symbols that are correlated by more than 0.01, directly or through others."""
        joined = np.abs(self._correlation()) > CORRELATED
        return tuple(tuple(sorted(g)) for g in connected(joined))

    def members(self, count: int, seed: int) -> Array:
        """(count, k) deviations from the values; the first rows are the same for every count.

        Parameters
        ----------
        count, seed : int
        """
        z = np.random.default_rng(seed).standard_normal((count, len(self.symbols)))
        return self._spread(z, self._correlation())

    def designed(self, z: Array) -> Array:
        """Deviations for standard normal rows (n, k), with the correlations inside of groups only."""
        kept = np.zeros((len(self.symbols),) * 2)
        for g in self.groups():
            kept[np.ix_(g, g)] = 1.0
        return self._spread(z, self._correlation() * kept)

    def _correlation(self) -> Array:
        scale = np.where(self.deviation > 0.0, self.deviation, 1.0)
        out = self.covariance / np.outer(scale, scale)
        np.fill_diagonal(out, 1.0)
        return np.asarray(out)

    def _spread(self, z: Array, correlation: Array) -> Array:
        # The symmetric root is the one that does not hang on the signs and the order of eigenvectors.
        size, vectors = np.linalg.eigh(correlation)
        root = (vectors * np.sqrt(np.clip(size, 0.0, None))) @ vectors.T
        # A product of matrices may round a row differently in a larger sample; this sum does not.
        return np.asarray(np.einsum("nj,kj->nk", z, root, optimize=False) * self.deviation)


def uncertain(parameters: ParameterFile, used: Iterable[str]) -> Uncertain:
    """What a parameter file is uncertain about.

    The covariance speaks first; where it is null, (U95 / 2)^2 stands in, independent of everything else. What has neither is
    held. Added mass and mass carry no uncertainty in a parameter file and are held; an acceleration derivative is varied.

    Parameters
    ----------
    parameters : ParameterFile
    used : iterable of str
        Names of the terms of the law, `coeflab.model.motion_terms.MotionTerm.symbol`: tables that it does not use are left out.

    Raises
    ------
    InputError
        The covariance is not positive semidefinite, or nothing at all is uncertain.
    """
    names = set(used)
    symbols, values, blocks, sources, held = [], [], [], [], []
    entries = [c for c in parameters.coefficients if c.value is not None]
    at = {s: i for i, s in enumerate(parameters.covariance.symbols)}
    order = [at.get(c.symbol) for c in entries]
    parts = [(parameters.covariance.matrix, order, [c.symbol for c in entries], [c.value for c in entries],
              [c.u95 for c in entries], [c.campaign or c.citation or c.origin for c in entries], "covariance")]  # fmt: skip
    for m in parameters.models:
        known = [(i, t) for i, t in enumerate(m.terms) if t.value is not None and f"{m.response} {t.symbol}" in names]
        parts.append(
            (m.covariance, [i for i, _ in known], [f"{m.response} {t.symbol}" for _, t in known],
             [t.value for _, t in known], [t.half_width_95 for _, t in known], [m.campaign] * len(known), f"models.{m.response}")
        )  # fmt: skip
    for matrix, rows, labels, numbers, halves, origins, column in parts:
        cells = _cells(matrix, rows, halves)
        stated = [i for i in range(len(labels)) if cells[i, i] > 0.0]
        if np.any(np.delete(cells, stated, axis=0)):
            stated = list(range(len(labels)))
        held += [labels[i] for i in range(len(labels)) if i not in stated]
        _semidefinite(cells[np.ix_(stated, stated)], [labels[i] for i in stated], column)
        symbols += [labels[i] for i in stated]
        values += [float(numbers[i] or 0.0) for i in stated]
        sources += [origins[i] for i in stated]
        blocks.append(cells[np.ix_(stated, stated)])
    if not symbols:
        raise InputError(
            "a parameter file without any stated uncertainty", "U95 or a covariance of some coefficient", column="covariance"
        )
    whole = np.zeros((len(symbols),) * 2)
    first = 0
    for b in blocks:
        whole[first : first + len(b), first : first + len(b)] = b
        first += len(b)
    return Uncertain(tuple(symbols), np.array(values), whole, tuple(sources), tuple(held), _said(parameters, held))


def _cells(matrix: CELLS, rows: Sequence[int | None], halves: Sequence[float | None]) -> Array:
    out = np.zeros((len(rows),) * 2)
    for i, r in enumerate(rows):
        for j, c in enumerate(rows):
            if r is not None and c is not None:
                out[i, j] = matrix[r][c] or 0.0
        if (r is None or matrix[r][r] is None) and halves[i] is not None:
            out[i, i] = (float(halves[i] or 0.0) / 2.0) ** 2
    return out


def _semidefinite(cells: Array, labels: Sequence[str], column: str) -> None:
    if not len(cells):
        return
    scale = np.sqrt(np.diag(cells))
    scale = np.where(scale > 0.0, scale, 1.0)
    low, vectors = np.linalg.eigh(cells / np.outer(scale, scale))
    if low[0] < NEGATIVE:
        worst = [labels[i] for i in np.argsort(-np.abs(vectors[:, 0]), kind="stable")[:3]]
        raise InputError(
            f"correlations with an eigenvalue of {low[0]:.3g}, mostly of {', '.join(worst)}", "a positive semidefinite covariance",
            column=column, advice="No random numbers have such a covariance; an entry was changed or rounded too far.",
        )  # fmt: skip


def _said(parameters: ParameterFile, held: Sequence[str]) -> tuple[str, ...]:
    accelerations = [
        c.symbol for c in parameters.coefficients if c.value is not None and derivative(c.symbol).text.endswith("dot")
    ]
    others = [*held, "mass, centre and inertia"]
    if parameters.added_mass is not None:
        others.append(
            f"computed added mass{', apart from the acceleration derivatives of the file' if accelerations else ''}"
        )
    return (
        "distribution: normal, standard uncertainty U95/2, correlated as the file's covariance says",
        f"{UNSTATED}: {', '.join(others)}",
    )
