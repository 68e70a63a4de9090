"""Draws of what a parameter file is uncertain about, from its covariance; normal distributions throughout."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from scipy.linalg import block_diag

from coeflab.core.errors import shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass, locking
from coeflab.law.symbols import derivative
from coeflab.vehicle.parameter_file import ParameterFile

CELLS = Sequence[Sequence[float | None]]
CORRELATED = 0.1  # a shared variance of 1 %: below it two coefficients are counted as sources of their own
NEGATIVE = -1e-8  # eigenvalue of a correlation matrix: rounding of what files print
UNSTATED = "not varied: no uncertainty is stated"


@dataclass(frozen=True, slots=True, eq=False)
@locking("values covariance")
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

    @property
    def deviation(self) -> Array:
        """(k,) standard uncertainties."""
        return np.sqrt(np.diag(self.covariance))

    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Blocks of the covariance: symbols that are correlated by more than 0.1, directly or through others."""
        from scipy.sparse.csgraph import connected_components

        _, label = connected_components(np.abs(self._correlation()) > CORRELATED, directed=False)
        return tuple(tuple(int(i) for i in np.flatnonzero(label == k)) for k in dict.fromkeys(label))

    def left_out(self) -> float:
        """Largest correlation between groups, which `designed` leaves out."""
        apart = np.abs(self._correlation())
        for g in self.groups():
            apart[np.ix_(g, g)] = 0.0
        return float(np.max(apart))

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
        selected = np.zeros((len(self.symbols),) * 2)
        for g in self.groups():
            selected[np.ix_(g, g)] = 1.0
        return self._spread(z, self._correlation() * selected)

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
        Names of the terms of the law, `coeflab.law.force_law.ForceTerm.in_file`: tables that it does not use are left out.

    Raises
    ------
    InputError
        The covariance is not positive semidefinite, or nothing at all is uncertain.
    """
    parts = [p for p in (_of_coefficients(parameters), *_of_tables(parameters, set(used))) if p.symbols]
    drawn = [_stated(p) for p in parts]
    if not any(len(chosen) for chosen, _ in drawn):
        raise input_error("motion.no_uncertainty", name=shown(parameters.name))
    held = [
        p.symbols[i]
        for p, (chosen, _) in zip(parts, drawn, strict=True)
        for i in range(len(p.symbols))
        if i not in chosen
    ]
    at = [(p, i) for p, (chosen, _) in zip(parts, drawn, strict=True) for i in chosen]
    return Uncertain(
        symbols=tuple(p.symbols[i] for p, i in at), values=np.array([p.values[i] for p, i in at]),
        covariance=block_diag(*(cells for chosen, cells in drawn if chosen)), sources=tuple(p.sources[i] for p, i in at),
        held=tuple(held), statements=_notes(parameters, held),
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Part:
    """Coefficients with one covariance: those of the file, or the terms of a table; ``rows`` are places in the matrix."""

    column: str
    matrix: CELLS
    rows: tuple[int | None, ...]
    symbols: tuple[str, ...]
    values: tuple[float, ...]
    halves: tuple[float | None, ...]
    sources: tuple[str, ...]


def _of_coefficients(parameters: ParameterFile) -> _Part:
    at = {s: i for i, s in enumerate(parameters.covariance.symbols)}
    known = [c for c in parameters.coefficients if c.value is not None]
    return _Part(
        "covariance", parameters.covariance.matrix, tuple(at.get(c.symbol) for c in known), tuple(c.symbol for c in known),
        tuple(float(c.value or 0.0) for c in known), tuple(c.u95 for c in known),
        tuple(c.campaign or c.citation or c.origin for c in known),
    )  # fmt: skip


def _of_tables(parameters: ParameterFile, used: set[str]) -> Iterator[_Part]:
    for m in parameters.models:
        known = [(i, t) for i, t in enumerate(m.terms) if t.value is not None and f"{m.response} {t.symbol}" in used]
        yield _Part(
            f"models.{m.response}", m.covariance, tuple(i for i, _ in known),
            tuple(f"{m.response} {t.symbol}" for _, t in known), tuple(float(t.value or 0.0) for _, t in known),
            tuple(t.half_width_95 for _, t in known), (m.campaign,) * len(known),
        )  # fmt: skip


def _stated(part: _Part) -> tuple[list[int], Array]:
    """Places of what has an uncertainty, and its covariance."""
    cells = _cells(part.matrix, part.rows, part.halves)
    _semidefinite(cells, part.symbols, part.column)
    chosen = [i for i in range(len(part.symbols)) if cells[i, i] > 0.0]
    return chosen, cells[np.ix_(chosen, chosen)]


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
    scale = np.sqrt(np.diag(cells))
    scale = np.where(scale > 0.0, scale, 1.0)
    low, vectors = np.linalg.eigh(cells / np.outer(scale, scale))
    if low[0] < NEGATIVE:
        worst = [labels[i] for i in np.argsort(-np.abs(vectors[:, 0]), kind="stable")[:3]]
        raise input_error("motion.correlations_not_definite", column=column, low=low[0], worst=", ".join(worst))


def _notes(parameters: ParameterFile, held: Sequence[str]) -> tuple[str, ...]:
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
