"""Added mass as the parameter file holds it, since version 1.2."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import model_validator

from coeflab.core.datums import Datum
from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.kernels.composition import definiteness
from coeflab.model.added_mass import AddedMass
from coeflab.model.schema_types import Finite, Name, Positive, Strict, Words, told
from coeflab.model.triangulation import Triangulation

Row = tuple[Finite, Finite, Finite, Finite, Finite, Finite]
Matrix = tuple[Row, Row, Row, Row, Row, Row]


class OtherMethod(Strict):
    """The same matrix by another method, to be compared with."""

    method: Annotated[Name, told("name of the method")]
    matrix: Annotated[Matrix, told("as that of `added_mass`", "kg, kg m, kg m^2")]


class ParameterAddedMass(Strict):
    """M_A, positive, FRD, about the file's reference point; acceleration derivatives are its negatives."""

    body: Annotated[Words, told("whose shape it was computed from")]
    method: Annotated[Name, told("how; stated where it was read from somebody's model")]
    density: Annotated[Positive, told("density of the water that the matrix holds for", "kg/m^3")]
    matrix: Annotated[
        Matrix,
        told(
            "rows X Y Z K M N, columns of the accelerations du dv dw dp dq dr; symmetric, positive", "kg, kg m, kg m^2"
        ),
    ]
    others: Annotated[tuple[OtherMethod, ...], told("the same by other methods, to be compared with")] = ()
    statements: Annotated[tuple[str, ...], told("assumptions and limits of the method, in words")] = ()

    @model_validator(mode="after")
    def _kinetic_energy(self) -> ParameterAddedMass:
        found = definiteness(np.array(self.matrix))
        if not found.holds:
            raise ValueError(
                f"the added mass by {self.method} is no kinetic energy: asymmetric by {found.asymmetry:.1e}, smallest "
                f"scaled eigenvalue {found.smallest:.1e}"
            )
        return self

    def as_noun(self, point: Sequence[float], datum: Datum) -> AddedMass:
        """The matrix in use, about the file's reference point."""
        return AddedMass(np.array(self.matrix), np.array(point), datum, self.body, self.method, self.statements)


def added_mass_record(found: Triangulation, point: np.ndarray, datum: Datum, vehicle: str = "") -> ParameterAddedMass:
    """The added mass of a file, the recommended method and the others about its reference point.

    Parameters
    ----------
    found : Triangulation
    point : (3,) array
    datum : Datum
        Of the file.
    vehicle : str
        Whose body the shape is; empty: that of its own name.

    Raises
    ------
    ScalingMismatchError
        The body measures points from another datum.
    """
    chosen, *others = found.ordered
    if chosen.datum != datum:
        raise ScalingMismatchError(
            f"the added mass of {chosen.body} is stated from {shown(chosen.datum.id)}, the parameter file from {shown(datum.id)}; "
            "give both the same datum."
        )
    return ParameterAddedMass.model_validate(
        {
            "body": vehicle or chosen.body,
            "method": chosen.method,
            "density": found.density,
            "matrix": _rows(chosen, point),
            "others": tuple({"method": o.method, "matrix": _rows(o, point)} for o in others if o.definiteness.holds),
            "statements": chosen.statements,
        }
    )


def _rows(found: AddedMass, point: np.ndarray) -> tuple[tuple[float, ...], ...]:
    """Symmetric, to ten digits of the diagonal: what is below differs from one machine to the next."""
    matrix = found.about(point).matrix
    diagonal = np.diag(matrix)
    cut = 1e-10 * np.sqrt(np.outer(diagonal, diagonal))
    return tuple(
        tuple(float(f"{v:.10g}") if abs(v) > c else 0.0 for v, c in zip(row, least, strict=True))
        for row, least in zip((matrix + matrix.T) / 2.0, cut, strict=True)
    )
