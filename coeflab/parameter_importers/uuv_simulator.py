"""URDF and xacro models for uuv_simulator and DAVE: the hydrodynamic model "fossen"."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coeflab.core.identifiers import one_line
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.xml import read_xml
from coeflab.kernels.kirchhoff import momentum_quadratics
from coeflab.model.check import Check, Severity
from coeflab.model.fossen_link import PLUGIN_DENSITY, FossenLink, read_fossen_link
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.second_order import SURGE, SecondOrder
from coeflab.model.stated_file import Stated, matrix_doubts, stated_file
from coeflab.model.stated_form import kept_matrix, stated_coefficients, stated_mass

summary = "uuv_simulator and DAVE: URDF or xacro with hydrodynamic_model fossen"
citations = ("fossen2011", "uuv_simulator")

BUOYANCY = (0.8, 1.25)


def read(
    path: Path, density: float | None = None, length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """Read a URDF, or a xacro file whose properties it defines itself.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where the file states none; else the plugin's own 1028 kg/m^3.
    length, speed : float, optional
        Of the primes, m and m/s; else the length of <box>, or 1 m, and 1 m/s, which the file says. Forces do not depend on
        them.

    Raises
    ------
    InputError
        No file with one hydrodynamic model of type fossen.
    """
    root = read_xml(path)
    link = read_fossen_link(root, path)
    notes = [
        "the plugin takes these numbers in x forward, y starboard, z down; reference point: the link's origin",
        "u v of linear_damping_forward_speed is read as U v: both agree on straight courses",
    ]
    rho = link.density if link.density is not None else density
    if rho is None:
        rho = PLUGIN_DENSITY
        notes.append(f"density {rho:g} kg/m^3: the file states none, this is the plugin's own (BuoyantObject.cc)")
    scaling = Scaling(
        *((length, "given length") if length else (link.length, "length of the box") if link.length else (1.0, "1 m"))
    )
    at = Conditions(rho, speed or 1.0)
    if scaling.length_name == "1 m":
        notes.append("lengths made dimensionless by 1 m: the file states none")
    if np.any(link.centre):
        notes.append(
            "the plugin's force acts at the centre of gravity: moments, and added mass, are moved to the link's origin"
        )
    matrix = link.arm @ link.added_mass
    notes += matrix_doubts(matrix)
    added = np.einsum("il,ljk->ijk", link.arm, momentum_quadratics(link.added_mass))
    name = one_line(root.get("name") or path.stem)[:200]
    stated = Stated(
        name=name,
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=stated_coefficients(_form(link), added, matrix, scaling, at),
        datum=f"origin of the link {one_line(link.link)}"[:200],
        matrix=kept_matrix(matrix),
        mass=stated_mass(link.mass, link.centre, link.inertia, notes),
        notes=tuple(notes),
    )
    return stated_file(stated, [InputFile(path.name, sha256_of(path))], citations)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    link = read_fossen_link(read_xml(path), path)
    out = []
    ignored = link.quadratic - np.diag(np.diag(link.quadratic))
    if np.any(ignored):
        out.append(_found(Severity.WARN, f"{np.count_nonzero(ignored)} off-diagonal entries in <quadratic_damping>",
                          "a diagonal matrix", "The plugin ignores them (HydrodynamicModel.cc, line 437)."))  # fmt: skip
    if np.any(link.centre):
        out.append(_found(Severity.WARN, f"centre of gravity {np.linalg.norm(link.centre):g} m from the link's origin",
                          "the origin in the centre of gravity",
                          "The plugin takes velocities at one and applies forces at the other."))  # fmt: skip
    if link.mass and link.volume:
        ratio = (link.density or PLUGIN_DENSITY) * link.volume / link.mass
        good = BUOYANCY[0] <= ratio <= BUOYANCY[1]
        out.append(_found(Severity.PASS if good else Severity.FAIL, f"rho V / m = {ratio:.4g}",
                          f"{BUOYANCY[0]:g} to {BUOYANCY[1]:g}",
                          "" if good else "Mass, volume and density are not of one system of units."))  # fmt: skip
    return tuple(out)


def _found(severity: Severity, statistic: str, rule: str, comment: str) -> Check:
    return Check("uuv_simulator", "URDF", severity, statistic, rule, comment)


def _form(link: FossenLink) -> SecondOrder:
    """The file's matrices as forces about the link's origin."""
    linear, forward = link.arm @ link.linear, link.arm @ link.forward
    signed, absolute = np.zeros((6, 6, 6)), np.zeros((6, 6, 6))
    signed[:, SURGE, SURGE] = forward[:, SURGE]
    plain = linear[:, 1:] == 0.0
    absolute[:, 1:, SURGE] = np.where(plain, forward[:, 1:], 0.0)
    signed[:, SURGE, 1:] = np.where(plain, 0.0, forward[:, 1:])
    for i in range(6):
        absolute[:, i, i] += link.arm[:, i] * link.quadratic[i, i]
    return SecondOrder(linear, signed, absolute)
