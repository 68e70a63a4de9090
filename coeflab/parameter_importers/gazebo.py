"""SDF models for gz-sim: the Hydrodynamics plugin and <fluid_added_mass>."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.identifiers import one_line
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.xml import read_xml
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.model.check import Check, Severity
from coeflab.model.gz_link import FORCES, VELOCITIES, GzLink, read_gz_link
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.second_order import FLU, SecondOrder
from coeflab.model.stated_file import Array, Stated, matrix_doubts, stated_file
from coeflab.model.stated_form import kept_matrix, stated_coefficients, stated_mass

summary = "gz-sim SDF: Hydrodynamics plugin and <fluid_added_mass>, link frame FLU to FRD"
citations = ("fossen2011", "gz_sim")

SQUARES = tuple(FORCES[i] + VELOCITIES[i] * 2 for i in range(6))


def read(
    path: Path, density: float | None = None, length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """Read an SDF model.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where the file states none.
    length, speed : float, optional
        Of the primes, m and m/s; 1 m and 1 m/s where not given, which the file says. Forces do not depend on them.

    Raises
    ------
    InputError
        No SDF with one Hydrodynamics plugin, or no density.
    """
    link = read_gz_link(read_xml(path), path)
    rho = link.density if link.density is not None else density
    if rho is None:
        raise InputError(
            "no density", "the density of the water", file=path,
            advice="The plugin needs none, primes do: give it (--density 1025), or write <uniform_fluid_density>.",
        )  # fmt: skip
    notes = [
        "axes turned from the link frame (x forward, y port, z up) to FRD; reference point: the link's origin",
        "|u| v is read as U v: both agree on straight courses",
    ]
    notes += [] if length else ["lengths made dimensionless by 1 m: the file states none"]
    scaling, at = Scaling(length or 1.0, "given length" if length else "1 m"), Conditions(rho, speed or 1.0)
    matrix, form = _added_mass(link), _form(link)
    notes += matrix_doubts(matrix)
    name = one_line(link.model or path.stem)[:200]
    stated = Stated(
        name=name,
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=stated_coefficients(form, _coriolis(link), matrix, scaling, at),
        datum=f"origin of the link {one_line(link.link)}"[:200],
        matrix=kept_matrix(matrix),
        mass=stated_mass(link.mass, link.centre * FLU[:3] + 0.0, _inertia(link), notes),
        notes=tuple(notes),
    )
    return stated_file(stated, [InputFile(path.name, sha256_of(path))], citations)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    link = read_gz_link(read_xml(path), path)
    own = link.plugin_mass if not link.disable_added_mass else np.zeros((6, 6))
    out = []
    if np.any(link.fluid_mass) and np.any(own):
        out.append(_found(Severity.FAIL, "<fluid_added_mass> and <xDotU> ...", "one of the two",
                          "Added mass counts twice. Remove the plugin's."))  # fmt: skip
    if np.any(own) and not link.disable_coriolis:
        out.append(_found(Severity.WARN, "<xDotU> ... without <disable_coriolis>", "no Coriolis of the plugin",
                          "The plugin adds +C_A(nu) nu, the reverse of the ideal fluid's. Disable it."))  # fmt: skip
    squares = [t for i, t in enumerate(SQUARES) if link.signed[i, i, i]]
    if squares:
        bars = ", ".join(f"<{t[:2]}abs{t[2]}>" for t in squares)
        out.append(_found(Severity.WARN, ", ".join(f"<{t}>" for t in squares), "damping that changes sign with the motion",
                          f"A square pushes in one of the two directions since gz-sim 7; {bars} is meant."))  # fmt: skip
    if link.mass is not None and (heaviest := float(-own.diagonal()[:3].min())) >= link.mass:
        out.append(_found(Severity.WARN, f"added mass {heaviest:g} kg, link {link.mass:g} kg", "added mass below the link's",
                          "The plugin integrates it explicitly, which is unstable. Use <fluid_added_mass>."))  # fmt: skip
    return tuple(out)


def _found(severity: Severity, statistic: str, rule: str, comment: str) -> Check:
    return Check("gazebo", "SDF", severity, statistic, rule, comment)


def _added_mass(link: GzLink) -> Array:
    own = np.zeros((6, 6)) if link.disable_added_mass else -link.plugin_mass
    return np.asarray((link.fluid_mass + own) * np.outer(FLU, FLU))


def _inertia(link: GzLink) -> Array | None:
    return None if link.inertia is None else link.inertia * np.outer(FLU[:3], FLU[:3]) + 0.0


def _form(link: GzLink) -> SecondOrder:
    once = np.triu(link.signed) + np.triu(np.swapaxes(link.signed, 1, 2), 1)
    return SecondOrder(link.linear, once, link.absolute).turned(FLU)


def _coriolis(link: GzLink) -> Array:
    """What gz-sim adds of its own, FRD: the ideal fluid's of <fluid_added_mass>, the reverse of it for <xDotU>."""
    out = ideal_quadratics(link.fluid_mass * np.outer(FLU, FLU))
    if not link.disable_coriolis:
        out = out - ideal_quadratics(-np.diag(np.diag(link.plugin_mass)))
    return out
