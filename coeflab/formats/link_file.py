"""A link with hydrodynamics as a parameter file: what SDF and URDF models share once their numbers are in FRD."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import positive_number
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.types import Array, brief, locking
from coeflab.core.wording import one_line
from coeflab.formats.stated_coefficients import Coefficients, matrix_doubts, stated_coefficients, valid_matrix
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.rigid_body import MassProperties, inertia_doubt
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.transforms import skew
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface, ParameterThruster
from coeflab.vehicle.second_order import SecondOrder


def stated_mass(
    mass: float | None, centre: Array, inertia: Array | None, findings: list[Finding], subject: str
) -> MassProperties | None:
    """Mass properties about the link's origin, FRD.

    Parameters
    ----------
    mass : float or None
    centre : (3,) array
        From the link's origin.
    inertia : (3, 3) array or None
        About the centre of gravity; left out, with a finding, where no body has it.
    findings : list of Finding
        Extended in place.
    subject : str
        Name of the model in findings.
    """
    if mass is None or mass <= 0.0:
        return None
    about = None
    if inertia is not None:
        arm = skew(centre)
        about = inertia - mass * arm @ arm
        doubt = inertia_doubt(mass, centre, about)
        if doubt:
            findings.append(Finding.of("model.no_inertia", subject, Severity.FAIL, why=doubt))
            about = None
    equal = about is not None and abs(about[1, 1] - about[2, 2]) <= 1e-9 * abs(about[1, 1])
    transverse = float(about[1, 1]) if about is not None and equal else None
    return MassProperties(mass, mass * float(centre[0]), transverse, centre, about)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("added matrix centre")
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
    findings : tuple of Finding
        What the file holds and this does not.
    hydrostatics, thrusters, surfaces
        As of `Stated`.
    controls : mapping of symbol to float
        Such as Ydr, of U^2, SI.
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
    findings: tuple[Finding, ...] = ()
    hydrostatics: ParameterHydrostatics | None = None
    thrusters: tuple[ParameterThruster, ...] = ()
    surfaces: tuple[ParameterSurface, ...] = ()
    controls: Mapping[str, float] = field(default_factory=dict)


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
        notes.append("so the C_A(nu) nu of the simulator is written product by product, not as an added mass")
    name = one_line(link.model or path.stem)[:200]
    findings = list(link.findings)
    mass = stated_mass(link.mass, link.centre, link.inertia, findings, name)
    controls: Coefficients = {
        symbol: (x / scaling.unit(symbol, at.density), "motion") for symbol, x in link.controls.items() if x
    }
    stated = Stated(
        name=name,
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=stated_coefficients(link.form, link.added, link.matrix, scaling, at) | controls,
        datum=Datum(f"origin of the link {one_line(link.link)}"[:200]),
        matrix=valid_matrix(link.matrix),
        mass=mass,
        hydrostatics=link.hydrostatics,
        thrusters=link.thrusters,
        surfaces=link.surfaces,
        notes=tuple(notes),
        findings=tuple(findings),
    )
    return stated_file(stated, [InputFile(path.name, sha256_of(path))], citations)
