"""The added-mass matrix of a body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.model.frozen import locked


@dataclass(frozen=True, slots=True, eq=False)
class AddedMass:
    """M_A in FRD about a named point; acceleration derivatives are its negatives (Xudot = -M_A[0, 0]).

    Attributes
    ----------
    matrix : (6, 6) array
        kg, kg m, kg m^2.
    reference_point : (3,) array
        m, FRD, from the datum.
    datum, body, method : str
    """

    matrix: NDArray[np.float64]
    reference_point: NDArray[np.float64]
    datum: str
    body: str
    method: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", locked(self.matrix))
        object.__setattr__(self, "reference_point", locked(self.reference_point))
        if self.matrix.shape != (6, 6):
            raise InputError(f"a matrix of shape {self.matrix.shape}", "6 x 6")
