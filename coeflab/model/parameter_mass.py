"""Mass properties as the parameter file holds them."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import model_validator

from coeflab.kernels.rigid_body import inertia_doubt
from coeflab.model.schema_types import Finite, Positive, Strict, told

Triple = tuple[Finite, Finite, Finite]


class ParameterMass(Strict):
    """Mass properties about the reference point."""

    mass: Annotated[Positive, told("mass m of the body", "kg")]
    mass_moment: Annotated[Finite, told("x_G m, positive forward", "kg m")]
    inertia: Annotated[Positive | None, told("transverse, Iy = Iz", "kg m^2")] = None
    mass_prime: Annotated[Positive, told("m / (1/2 rho L^3)", "1")]
    mass_moment_prime: Annotated[Finite, told("x_G m / (1/2 rho L^4)", "1")]
    centre: Annotated[
        Triple | None, told("centre of gravity from the reference point, x y z, FRD", "m", since="1.2")
    ] = None
    inertia_matrix: Annotated[
        tuple[Triple, Triple, Triple] | None,
        told("about the reference point, FRD; products with their sign in the matrix", "kg m^2", since="1.2"),
    ] = None

    @model_validator(mode="after")
    def _of_a_body(self) -> ParameterMass:
        if self.inertia_matrix is not None and self.centre is None:
            raise ValueError("an inertia matrix without the centre of gravity")
        if self.centre is not None:
            moment = self.mass * self.centre[0]
            if not math.isclose(moment, self.mass_moment, rel_tol=1e-6, abs_tol=1e-9 * self.mass):
                raise ValueError(f"mass_moment {self.mass_moment:g} is not m x_G, {moment:g}")
        if self.inertia_matrix is not None and self.centre is not None:
            why = inertia_doubt(self.mass, np.array(self.centre), np.array(self.inertia_matrix))
            if why:
                raise ValueError(why)
        return self
