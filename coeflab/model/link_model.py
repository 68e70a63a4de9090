"""A link with hydrodynamics as a parameter file: what SDF and URDF models share once their numbers are in FRD."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.datums import Datum
from coeflab.core.errors import InputError
from coeflab.core.identifiers import one_line
from coeflab.core.limits import positive_number
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.kernels.brief import brief
from coeflab.model.frozen import locked
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.second_order import SecondOrder
from coeflab.model.stated_file import Stated, matrix_doubts, stated_file
from coeflab.model.stated_form import kept_matrix, stated_coefficients, stated_mass

Array = NDArray[np.float64]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class LinkModel:
    """SI and FRD, about the link's origin.

    Attributes
    ----------
    model, link : str
        Names; the file's name stands in for an empty one.
    density : float
        kg/m^3.
    form : SecondOrder
        What the file writes.
    added : (6, 6, 6) array
        Quadratics that its simulator adds itself.
    matrix : (6, 6) array
        Added mass.
    mass : float or None
        kg.
    centre : (3,) array
        Centre of gravity, m.
    inertia : (3, 3) array or None
        About the centre of gravity, kg m^2.
    length : float or None
        m, where the file states one.
    length_name : str
    notes : tuple of str
    """

    model: str
    link: str
    density: float
    form: SecondOrder
    added: Array
    matrix: Array
    mass: float | None
    centre: Array
    inertia: Array | None
    length: float | None = None
    length_name: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("added", "matrix", "centre"):
            object.__setattr__(self, name, locked(getattr(self, name)))


def link_file(
    link: LinkModel, path: Path, citations: tuple[str, ...], length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """The parameter file of a link.

    Parameters
    ----------
    link : LinkModel
    path : path
        Of the model file.
    citations : tuple of str
    length, speed : float, optional
        Of the primes, m and m/s; else the file's own length, or 1 m, and 1 m/s, which the file says.

    Raises
    ------
    InputError
        A density or length that is not above zero; the numbers make no parameter file.
    """
    for what, value in (("density", link.density), (link.length_name, link.length)):
        if value is not None and (expected := positive_number(value)):
            raise InputError(f"{what} {value:g}", expected, file=path)
    notes = list(link.notes)
    if length:
        scaling = Scaling(length, "given length")
    elif link.length:
        scaling = Scaling(link.length, link.length_name)
    else:
        scaling = Scaling(1.0, "1 m")
        notes.append("lengths made dimensionless by 1 m: the file states none")
    at = Conditions(link.density, speed or 1.0)
    doubts = matrix_doubts(link.matrix)
    notes += doubts
    if doubts and np.any(link.added):
        notes.append("so the C_A(nu) nu of the simulator stands here product by product, not as an added mass")
    name = one_line(link.model or path.stem)[:200]
    stated = Stated(
        name=name,
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=stated_coefficients(link.form, link.added, link.matrix, scaling, at),
        datum=Datum(f"origin of the link {one_line(link.link)}"[:200]),
        matrix=kept_matrix(link.matrix),
        mass=stated_mass(link.mass, link.centre, link.inertia, notes),
        notes=tuple(notes),
    )
    return stated_file(stated, [InputFile(path.name, sha256_of(path))], citations)
