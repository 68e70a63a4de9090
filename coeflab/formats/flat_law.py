"""The law of a parameter file as plain numbers, for targets that are programs: terms, tables with their hulls, actuators, inertia.

The nearest point of a hull is one of a few feet, each an affine map of the point: those on the faces, edges and corners of the hull,
found here, once, so that a program needs no solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import comb
from typing import Any

import numpy as np

from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.law.domain import SLACK, Domain, Extrapolation
from coeflab.law.force_law import BASE, EVERYWHERE, WIND, ForceLaw, ForceTerm, Reading
from coeflab.law.rigid_body import rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.inertia import known_mass, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile

RULES = (Extrapolation.CLAMP, Extrapolation.TAPER, Extrapolation.REFUSE)  # by their number in the code
MOST_CORNERS = 2_000_000
Factors = tuple[tuple[int, int, bool], ...]


def place_at(place: int, wind: Sequence[Sequence[Any]]) -> tuple[str, tuple[bool, bool, bool]]:
    """Component and `ForceTerm.into` of a place that `coeflab.law.force_law.place_of` gives."""
    if place < len(COMPONENTS):
        return COMPONENTS[place], EVERYWHERE
    group, which = divmod(place - len(COMPONENTS), len(WIND))
    one, two, three = map(bool, wind[group])
    return WIND[which], (one, two, three)


Readings = tuple[tuple[str, Reading], ...]


def table_of(
    key: str, names: tuple[str, ...], box: tuple[Any, Any], spaces: Any, rule: int, primes: Sequence[float], boxed: bool
) -> tuple[Domain, Readings]:
    """Hull and readings of a table by the numbers that a program has of it.

    Parameters
    ----------
    key : str
        Of the table, for readings outside of a box.
    names : tuple of str
        Its variables.
    box : two (d,) sequences
        Low and high ends.
    spaces : (m, d + 1) array
    rule : int
        Of `RULES`.
    primes : (d,) sequence
    boxed : bool
        Whether every variable is held by itself.
    """
    low, high = (np.array(end, dtype=float) for end in box)
    each = zip(names, primes, low, high, strict=True)
    readings = (
        (v, Reading(float(p), float(a), float(b), True) if boxed else Reading(float(p), table=key))
        for v, p, a, b in each
    )
    return Domain(names, low, high, np.array(spaces, dtype=float).reshape(-1, len(names) + 1), RULES[rule]), tuple(
        readings
    )


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FlatTable:
    """A table of the law.

    Attributes
    ----------
    name : str
    terms : tuple of ForceTerm
        SI coefficients.
    hull : Domain
    base : tuple of int
        Which of `coeflab.law.force_law.BASE` each variable is.
    prime : tuple of float
        The variable is times this over U; 0: as it is.
    faces : (m, d + 1) array
        Unit normal and bound of every half-space, in widths of the box from its low corner.
    maps : (k, d, d + 1) array
        Foot of a point, both in widths: matrix and constant.
    """

    name: str
    terms: tuple[ForceTerm, ...]
    hull: Domain
    base: tuple[int, ...]
    prime: tuple[float, ...]
    faces: Array
    maps: Array

    @property
    def boxed(self) -> bool:
        """Whether every variable is held by itself."""
        return self.hull.is_box and self.hull.rule != "taper"

    @property
    def size(self) -> Array:
        """(d,) widths of the box; 1 where there is none."""
        return np.where(self.hull.high > self.hull.low, self.hull.high - self.hull.low, 1.0)

    @property
    def rests(self) -> bool:
        """Whether it has no force at rest, where it then refuses nothing."""
        return all(t.speed_power > 0 for t in self.terms)

    def factors(self, term: ForceTerm) -> Factors:
        """Number of the variable, power, absolute."""
        return tuple((self.hull.variables.index(v), n, a) for v, n, a in term.term.factors)


def feet(hull: Domain) -> tuple[Array, Array]:
    """Faces and maps of `FlatTable`.

    Raises
    ------
    InputError
        A hull of too many corners.
    """
    d = len(hull.variables)
    size = np.where(hull.high > hull.low, hull.high - hull.low, 1.0)
    normals = hull.spaces[:, :d] * size
    length = np.linalg.norm(normals, axis=1)
    normals, length = normals[length > 0.0], length[length > 0.0]
    bounds = -(hull.spaces[:, d] + hull.spaces[:, :d] @ hull.low)[: len(length)] / length
    normals = normals / length[:, None]
    if comb(len(normals), min(d, len(normals))) > MOST_CORNERS:
        raise input_error("formats.hull_of_many_corners", column="models", count=len(normals), d=d)
    touched: list[frozenset[int]] = []
    for rows in combinations(range(len(normals)), d):
        at = list(rows)
        if abs(np.linalg.det(normals[at])) > 1e-9:
            corner = np.linalg.solve(normals[at], bounds[at])
            away = normals @ corner - bounds
            if np.all(away <= SLACK):
                touched.append(frozenset(np.flatnonzero(away >= -SLACK).tolist()))
    chosen = {rows for near in touched for k in range(1, d + 1) for rows in combinations(sorted(near), k)}
    if not touched:
        chosen = {rows for k in range(1, d + 1) for rows in combinations(range(len(normals)), k)}
    maps = []
    for several in sorted(chosen, key=lambda rows: (len(rows), rows)):
        a, b = normals[list(several)], bounds[list(several)]
        if np.linalg.matrix_rank(a, tol=1e-9) == len(several):
            back = np.linalg.pinv(a)
            maps.append(np.column_stack([np.eye(d) - back @ a, back @ b]))
    return np.column_stack([normals, bounds]), np.array(maps).reshape(-1, d, d + 1)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FlatLaw:
    """A file as numbers.

    Attributes
    ----------
    law : ForceLaw
    coefficients : tuple of ForceTerm
    tables : tuple of FlatTable
    ideal : tuple of (force, motion, motion, value)
        Products of the ideal fluid that no source speaks of.
    free : tuple of int
        Motions with a known inertia.
    rigid, inverse : (6, 6) arrays
        M_RB; accelerations of unit forces, zero for what is held.
    excess : float
        Weight less buoyancy, N.
    lever : (3,) array
        W r_G - B r_B, N m.
    """

    law: ForceLaw
    coefficients: tuple[ForceTerm, ...]
    tables: tuple[FlatTable, ...]
    ideal: tuple[tuple[int, int, int, float], ...]
    free: tuple[int, ...]
    rigid: Array
    inverse: Array
    excess: float
    lever: Array


def flat_tables(law: ForceLaw) -> tuple[FlatTable, ...]:
    """The tables of a law."""
    groups: dict[int, list[ForceTerm]] = {}
    for t in law.terms:
        if t.hull is not None:
            groups.setdefault(id(t.hull), []).append(t)
    out = []
    for terms in groups.values():
        hull, readings = terms[0].hull, dict(terms[0].readings)
        assert hull is not None
        faces, maps = feet(hull)
        base = tuple(BASE.index(v) for v in hull.variables)
        name = f"{terms[0].symbol.split(' ')[0]} over {' and '.join(hull.variables)}"
        out.append(
            FlatTable(name, tuple(terms), hull, base, tuple(readings[v].prime for v in hull.variables), faces, maps)
        )
    return tuple(out)


def flat_law(parameters: ParameterFile) -> FlatLaw:
    """The law of a file, its inertia, weight and buoyancy as numbers.

    Parameters
    ----------
    parameters : ParameterFile

    Raises
    ------
    InputError
        M + M_A is not positive definite.
    """
    law = motion_law(parameters)[0]
    mass, h = parameters.mass, parameters.hydrostatics
    rigid, inverse, lever, excess = np.zeros((6, 6)), np.zeros((6, 6)), np.zeros(3), 0.0
    _, free = known_mass(parameters)
    if mass is not None:
        moments = np.diag([0.0, *[mass.inertia or 0.0] * 2]) if mass.inertia_matrix is None else mass.inertia_matrix
        rigid = rigid_body_inertia(mass.mass, mass.centre_of_gravity, np.array(moments))
        at = np.ix_(free, free)
        whole = (rigid + water_inertia(parameters).matrix)[at]
        if not np.linalg.eigvalsh((whole + whole.T) / 2.0)[0] > 0.0:
            raise input_error("formats.inertia_of_c_not_positive", column="added_mass")
        inverse[at] = np.linalg.inv(whole)
        if h is not None:
            weight, lift = mass.mass * h.gravity, parameters.conditions.density * h.gravity * h.volume
            excess = weight - lift
            lever = weight * mass.centre_of_gravity - lift * np.array(h.centre_of_buoyancy)
    ideal = tuple(
        (i, j, k, float(law.ideal[i, j, k] * (1.0 if j == k else 2.0)))
        for i in range(6) for j in range(6) for k in range(j, 6) if law.ideal[i, j, k]
    )  # fmt: skip
    selected = tuple(t for t in law.terms if t.hull is None)
    return FlatLaw(law, selected, flat_tables(law), ideal, tuple(free), rigid, inverse, excess, lever)


def free_motions(law: FlatLaw) -> str:
    """Letters of the motions that a program moves."""
    return "".join(MOTIONS[k] for k in law.free)
