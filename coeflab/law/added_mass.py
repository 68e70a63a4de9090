"""The added-mass matrix of a body, and its part of a velocity derivative: total = potential + viscous.

A measured force in steady motion holds every entry of -C_A(nu) nu: the Munk moment in Nv and Mw, and shares of Yr, Nr, Zq,
Mq, Xvr and others. A simulator that adds C_A(nu) itself must be given the viscous part alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import Datum
from coeflab.core.cards import html_by
from coeflab.core.errors import InputError
from coeflab.core.missed import was_method
from coeflab.core.stored import Means, Name, Positive, Square6, Words, stored
from coeflab.core.types import in_angles, locked, locking
from coeflab.law.definiteness import Definiteness, definiteness
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.law.transforms import moved, velocity_transfer


@stored()
class OtherMethod(NamedTuple):
    """The same matrix by another method, to be compared with."""

    method: Annotated[Name, Means("name of the method")]
    matrix: Annotated[Square6, Means("as that of `added_mass`", "kg, kg m, kg m^2")]


@stored()
class NearWall(NamedTuple):
    """The same matrix at one distance from a wall."""

    wall: Annotated[Name, Means("bottom, or a free surface: surface_zero, surface_infinite, by its frequency")]
    distance: Annotated[Positive, Means("from the reference point to the wall", "m")]
    matrix: Annotated[Square6, Means("as that of `added_mass`", "kg, kg m, kg m^2")]


@stored("body method density matrix u95?? others? walls?? statements?")
@dataclass(frozen=True, slots=True, eq=False)
@locking("matrix reference_point")
class AddedMass:
    """M_A, positive, FRD, about the file's reference point; acceleration derivatives are its negatives.

    Where it is no file's it is about a point of its own. Xudot = -M_A[0, 0].

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
    density : float
        Of the water that it holds for, kg/m^3; NaN where nothing says so.
    others : tuple of OtherMethod
        In a parameter file: the same by other methods, about the same point.
    walls : tuple of NearWall
        The same near walls, about the same point, of one wall by rising distance; empty where none were asked for.
    u95 : (6, 6) array, optional
        95 % half-widths of the entries of a rough guide, kg, kg m, kg m^2.
    """

    matrix: Annotated[
        Square6,
        Means(
            "rows X Y Z K M N, columns of the accelerations du dv dw dp dq dr; symmetric, positive", "kg, kg m, kg m^2"
        ),
    ]
    reference_point: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    datum: Datum = field(default_factory=lambda: Datum("reference point"))
    body: Annotated[Words, Means("whose shape it was computed from")] = ""
    method: Annotated[Name, Means("how; stated where it was read from somebody's model")] = ""
    statements: Annotated[tuple[str, ...], Means("assumptions and limits of the method, in words")] = ()
    error: NDArray[np.float64] | None = None
    rough: bool = False
    density: Annotated[Positive, Means("density of the water that the matrix holds for", "kg/m^3")] = np.nan
    others: Annotated[tuple[OtherMethod, ...], Means("the same by other methods, to be compared with")] = ()
    walls: Annotated[tuple[NearWall, ...], Means("the same near walls, by distance", since="1.5")] = ()
    u95: Annotated[Square6 | None, Means("95 % half-widths of a rough guide", "kg, kg m, kg m^2", since="1.6")] = None

    def __post_init__(self) -> None:
        for name in ("error", "u95"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))
        if self.matrix.shape != (6, 6):
            raise InputError(f"a matrix of shape {self.matrix.shape}", "6 x 6")

    def __repr__(self) -> str:
        diagonal = ", ".join(f"{v:.4g}" for v in np.diag(self.matrix))
        return in_angles(self, f"{self.body} by {self.method}: diagonal {diagonal}{', rough' if self.rough else ''}")

    def _repr_html_(self) -> str:
        """The matrix, for notebooks."""
        return html_by("added_mass", self)

    def refuse(self) -> None:
        """Raise ValueError for what is no kinetic energy."""
        found = self.definiteness
        if not found.holds:
            raise ValueError(
                f"the added mass ({self.method}) gives the water a negative kinetic energy, or is not symmetric: asymmetric by "
                f"{found.asymmetry:.1e}, smallest scaled eigenvalue {found.smallest:.1e}"
            )

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
        matrix, lever = moved(self.matrix, shift), np.abs(velocity_transfer(-shift))
        error, u95 = (None if half is None else lever.T @ half @ lever for half in (self.error, self.u95))
        others = tuple(OtherMethod(o.method, moved(o.matrix, shift)) for o in self.others)
        # The distance of a table near walls is from its reference point: it moves with that along z, down.
        walls = tuple(
            NearWall(w.wall, w.distance - shift[2] * (1.0 if w.wall == "bottom" else -1.0), moved(w.matrix, shift))
            for w in self.walls
        )
        return replace(
            self, matrix=matrix, reference_point=np.asarray(point), error=error, u95=u95, others=others, walls=walls
        )

    def near(self, wall: str, distance: float) -> NDArray[np.float64]:
        """(6, 6) matrix at a distance from a wall, of its table.

        Between distances by a cubic in the cube of one over the distance, by which an image's effect falls; beyond the
        last, the effect there falls by that cube to nothing.

        Raises
        ------
        InputError
            No table for that wall, or nearer than its first distance.
        """
        known = sorted((w for w in self.walls if w.wall == wall), key=lambda w: w.distance)
        if not known or distance < known[0].distance * (1.0 - 1e-12):
            found = f"no table near {wall}" if not known else f"{distance:g} m from {wall}"
            expected = "added mass computed near it" if not known else f"{known[0].distance:g} m and more"
            raise InputError(found, expected, advice="Compute it with coeflab added-mass --wall and --distance.")
        from scipy.interpolate import PchipInterpolator

        at = [0.0, *(w.distance**-3 for w in reversed(known))]
        values = np.stack([self.matrix, *(w.matrix for w in reversed(known))])
        return np.asarray(PchipInterpolator(at, values, axis=0)(min(distance**-3, at[-1])))

    @property
    def derivatives(self) -> dict[str, float]:
        """All 36 acceleration derivatives, SI: Xudot, ..., Nrdot."""
        every = {
            f"{force}{motion}dot": -float(self.matrix[i, j])
            for i, force in enumerate(COMPONENTS)
            for j, motion in enumerate(MOTIONS)
        }
        return was_method("derivatives", every)

    def primed(self, symbol: str, scaling: Scaling, density: float) -> float:
        """One acceleration derivative, primed: Yvdot' by 1/2 rho L^3, Nrdot' by 1/2 rho L^5 (SNAME 1950)."""
        return self.derivatives[symbol] / scaling.unit(symbol, density)


def potential_part(symbol: str, added_mass: AddedMass, scaling: Scaling, density: float) -> float | None:
    """The potential part of a primed derivative.

    Parameters
    ----------
    symbol : str
        With or without prime. Terms of the first order are derivatives at straight motion with u = U.
    added_mass : AddedMass
        About the point that the derivative is about.
    scaling : Scaling
    density : float
        That the added mass was computed with, kg/m^3.

    Returns
    -------
    float or None
        Zero for terms in |v| and of the third order: an ideal fluid has products of two velocities only. None for controls
        and accelerations, of which it is no part.

    Notes
    -----
    In primes u is sqrt(1 - v'^2 - w'^2), so a product u v written in v' alone has a tail, -v'^3 / 2 and on. It is not
    booked: a target that adds u v itself differs by it, 1 - cos(beta) of the potential part, as its loss report shows.
    """
    d = derivative(symbol)
    if any(f not in MOTIONS for f in d.factors):
        return None
    if "|" in d.text or len(d.factors) > 2:
        return 0.0
    force = COMPONENTS.index(d.component)
    quadratics = ideal_quadratics(added_mass.matrix)[force]
    at = [MOTIONS.index(f) for f in d.factors]
    if not at:
        value = quadratics[0, 0]
    elif len(at) == 1:
        value = 2.0 * quadratics[0, at[0]]
    else:
        value = quadratics[at[0], at[1]] * (1.0 if at[0] == at[1] else 2.0)
    return float(value / scaling.unit(symbol, density))
