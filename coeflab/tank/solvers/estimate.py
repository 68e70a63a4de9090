"""Estimates from the shape as a solver of the tow tank: the whole table at once, without runs; its kind is ``estimate``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.declarations import Declaration
from coeflab.core.errors import InputError
from coeflab.core.version import VERSION
from coeflab.estimates import Estimates, Water, estimated
from coeflab.law.coefficient import CoefficientSet
from coeflab.law.symbols import COMPONENTS, MOMENTS
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tank.solvers import Installation
from coeflab.tank.tank import Tank
from coeflab.tank.towed_body import TowedBody

summary = "estimates from the shape by semi-empirical methods, at once; no measurement and no CFD"
citations = ("whicker1958", "pitts1957", "hopkins1951", "allen1951", "ittc1957")

NAME = "estimates.csv"


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimated(Declaration):
    """``[solver.estimate]``: what the estimates need beside the tank.

    Attributes
    ----------
    roughness : float
        Height on the surface, m; smooth unless given.
    """

    roughness: Annotated[takes.Length, takes.ZERO_OR_MORE] = 0.0


options = Estimated


def installed() -> Installation:
    """Nothing is needed."""
    return Installation(f"estimates of coeflab {VERSION}")


def known(tank: Tank, body: TowedBody) -> CoefficientSet:
    """The estimated coefficients with their U95, primed by the tank's length, about its point.

    Parameters
    ----------
    tank : Tank
    body : TowedBody

    Raises
    ------
    InputError
        As `table`.
    """
    return _estimated(tank, body).coefficients


def _estimated(tank: Tank, body: TowedBody) -> Estimates:
    at = tank.conditions
    if at.viscosity is None:
        raise InputError("no viscosity", "the kinematic viscosity, m^2/s", column="conditions.viscosity")
    seen = replace(body.body, reference_point=tank.reference_point, scaling=tank.scaling)
    water = Water(at.density, at.viscosity, at.speed, float(tank.options.get("roughness", 0.0)))
    return estimated(seen, water, towed=True)


def table(tank: Tank, body: TowedBody, folder: Path) -> RawTable:
    """The estimated forces of every condition, in SI, whole body, FRD, about the reference point.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    folder : Path
        Of the tow.

    Raises
    ------
    InputError
        The body has no outline, or the tank no viscosity.
    """
    nu = np.array([[*c.velocity, *c.rates] for c in tank.matrix], dtype=float)
    names = dict.fromkeys(name for c in tank.matrix for name in c.controls)
    angles = {name: np.array([c.controls.get(name, 0.0) for c in tank.matrix]) for name in names}
    forces = _estimated(tank, body).forces(nu, angles)
    columns = tuple(
        RawColumn(c, "N*m" if c in MOMENTS else "N", forces[:, i], means=c) for i, c in enumerate(COMPONENTS)
    )
    return RawTable(
        path=folder / NAME,
        columns=columns,
        header_line=1,
        lines=np.arange(len(nu), dtype=np.int64) + 2,
        row_labels=tuple(c.name for c in tank.matrix),
        files=(),
        stated={
            "source.how_obtained": Stated(f"estimates from the shape by coeflab {VERSION}", NAME),
            "source.kind": Stated("estimate", NAME),
        },
    )
