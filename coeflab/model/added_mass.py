"""The added-mass matrix of a body."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.datums import Datum
from coeflab.core.errors import InputError
from coeflab.core.symbols import COMPONENTS, MOTIONS
from coeflab.kernels.brief import brief
from coeflab.kernels.composition import Definiteness, definiteness, moved
from coeflab.kernels.transforms import velocity_transfer
from coeflab.model import noun_tables
from coeflab.model.frozen import locked
from coeflab.model.scaling import Scaling


@brief
@dataclass(frozen=True, slots=True, eq=False)
class AddedMass:
    """M_A in FRD about a named point; acceleration derivatives are its negatives (Xudot = -M_A[0, 0]).

    Attributes
    ----------
    matrix : (6, 6) array
        kg, kg m, kg m^2.
    reference_point : (3,) array
        m, FRD, from the datum.
    datum : Datum
    body, method : str
    statements : tuple of str
        What the method assumed, in words.
    error : (6, 6) array, optional
        Estimate of the numerical error of each entry, at least zero, where the method gives one.
    rough : bool
        The method itself says that it is only a rough guide for this body.
    """

    matrix: NDArray[np.float64]
    reference_point: NDArray[np.float64]
    datum: Datum
    body: str
    method: str
    statements: tuple[str, ...] = ()
    error: NDArray[np.float64] | None = None
    rough: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", locked(self.matrix))
        object.__setattr__(self, "reference_point", locked(self.reference_point))
        if self.error is not None:
            object.__setattr__(self, "error", locked(self.error))
        if self.matrix.shape != (6, 6):
            raise InputError(f"a matrix of shape {self.matrix.shape}", "6 x 6")

    def _repr_html_(self) -> str:
        """The matrix, for notebooks."""
        return noun_tables.matrix(self)._repr_html_()

    @property
    def definiteness(self) -> Definiteness:
        """Whether the matrix is symmetric and positive semidefinite."""
        return definiteness(self.matrix)

    @property
    def verdict(self) -> str:
        """The same in words."""
        found = self.definiteness
        if found.holds:
            return "symmetric, positive semidefinite"
        if not np.isfinite(found.smallest):
            return "no kinetic energy: a zero, negative or infinite diagonal entry; do not use it"
        return (
            f"asymmetric by {found.asymmetry:.1e}, smallest scaled eigenvalue {found.smallest:.1e}: no kinetic energy; "
            "do not use it"
        )

    def about(self, point: NDArray[np.float64]) -> AddedMass:
        """The same about another point, m, FRD, from the datum; errors add up as if all had the worst sign."""
        shift = np.asarray(point, dtype=float) - self.reference_point
        matrix, error = moved(self.matrix, shift), None
        if self.error is not None:
            lever = np.abs(velocity_transfer(-shift))
            error = lever.T @ self.error @ lever
        return replace(self, matrix=matrix, reference_point=np.asarray(point), error=error)

    def derivatives(self) -> dict[str, float]:
        """All 36 acceleration derivatives, SI: Xudot, ..., Nrdot."""
        return {
            f"{force}{motion}dot": -float(self.matrix[i, j])
            for i, force in enumerate(COMPONENTS)
            for j, motion in enumerate(MOTIONS)
        }

    def primed(self, symbol: str, scaling: Scaling, density: float) -> float:
        """One acceleration derivative, primed: Yvdot' by 1/2 rho L^3, Nrdot' by 1/2 rho L^5 (SNAME 1950)."""
        return self.derivatives()[symbol] * Scaling(1.0, "1 m").ratio(symbol, scaling) / (0.5 * density)
