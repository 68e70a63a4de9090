"""Hydrodynamic coefficients: one with its uncertainty and origin, and a set with covariance and reference point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE, Datum
from coeflab.core.cards import html_by
from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.missed import suggesting
from coeflab.core.stored import Choice, Count, Finite, Means, NotNegative, RefusedError, stored
from coeflab.core.table import percent, plus_minus
from coeflab.core.types import Array, in_angles, locking
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import ANGULAR, COMPONENTS, MOTIONS, derivative, primed
from coeflab.law.transforms import derivative_transfer

COVERS = "scatter, smooth curvature, onset of stall at an unknown angle"  # of the U95 of a slope at the origin


class Status(StrEnum):
    """What a coefficient's number is worth, with advice."""

    OK = "ok"
    SIGN_OPEN = "sign_open"
    NO_TABLE = "no_table"
    TOO_FEW_POINTS = "too_few_points"
    SINGLE_ESTIMATOR = "single_estimator"
    NOT_DETERMINED = "not_determined"
    STATED = "stated"
    ESTIMATE = "estimate"
    FORM_ASSUMED = "form_assumed"
    FORM_REJECTED = "form_rejected"
    SYMMETRY_ASSUMED = "symmetry_assumed"

    @property
    def advice(self) -> str:
        """What to do about it."""
        return {
            Status.OK: "",
            Status.SIGN_OPEN: "The 95 % interval contains zero: the sign is open. `coeflab next TABLE` names the runs that "
            "narrow it most.",
            Status.NO_TABLE: "No table varies this motion. Add a campaign that does.",
            Status.TOO_FEW_POINTS: "Too few different settings to determine it. Run more angles or rates.",
            Status.SINGLE_ESTIMATOR: "Only one form could be fitted, so its model-form error is unknown and no U95 "
            "is given. Run more angles, some on the other side.",
            Status.NOT_DETERMINED: "The data, or the derivatives that a change of reference point needs, leave it open.",
            Status.STATED: "Stated as it is, by the literature or by whoever wrote the file, the uncertainty too.",
            Status.ESTIMATE: "From the shape by semi-empirical methods. Replace it with a computation or a measurement.",
            Status.FORM_ASSUMED: "U95 holds the scatter and what the residuals show that the form leaves out. A misfit of "
            "the size of the noise does not show.",
            Status.FORM_REJECTED: "The residuals show that the form is wrong, and another would move the value by more than "
            "half of it: no U95. Add the missing term or fit a narrower range.",
            Status.SYMMETRY_ASSUMED: "Not run: rows of another plane, turned by a symmetry that is declared and that neither runs nor a body "
            "of the plan checks. U95 is that of those rows. Run some in this plane, or name the body.",
        }[self]


# What a file has in the place of others: there the interval says that a sign is open, and the estimator what the form assumes.
FILED = {Status.SIGN_OPEN: Status.OK, Status.SYMMETRY_ASSUMED: Status.FORM_ASSUMED}
NAMED_STATUSES = (Status.FORM_REJECTED, Status.SYMMETRY_ASSUMED)  # beside a value, wherever it stands
IN_FILES = tuple(s for s in Status if s not in FILED)


@stored()
@dataclass(frozen=True, slots=True)
class Parts:
    """95 % half-widths that make up U95; null where not assessed.

    Attributes
    ----------
    random : float or None
        Scatter of the points: of a slope at the origin what the noise of single readings does through the fixed
        mixture; of other fits HC2 with Bell-McCaffrey degrees of freedom.
    model_form : float or None
        Slopes at the origin: what the unknown form of the curve adds, the rest of U95 in quadrature.
        Fixed forms: what a remainder that the residuals show would move.
    window : float or None
        Reserved for a separately assessed window part.
    input : float or None
        What enters from outside the points: declared uncertainty of angle, speed, calibration, lengths, and the grid
        error of a computation with a grid study; the rounding of printed digits; in a term tied to a slope, that of the slope.
    """

    random: Annotated[NotNegative | None, Means("scatter of the points", "1")] = None
    model_form: Annotated[NotNegative | None, Means("what other forms of the curve would give", "1")] = None
    window: Annotated[NotNegative | None, Means("choice of the window, where it is assessed by itself", "1")] = None
    input: Annotated[
        NotNegative | None,
        Means("declared uncertainty of angle, speed, calibration and length; grid error; printed digits", "1"),
    ] = None


WITHOUT_VALUE = (Status.NO_TABLE, Status.TOO_FEW_POINTS, Status.NOT_DETERMINED)


@suggesting
@stored(
    "symbol value u95 unit value_si unit_si status origin parts table? campaign? estimator? window? n_points? citation? law? "
    "potential?"
)
@dataclass(frozen=True, slots=True)
class Coefficient:
    """One coefficient.

    Attributes
    ----------
    symbol : str
        SNAME symbol, in a parameter file with its prime, elsewhere without.
    value : float or None
        None unless the status says that it is one to use.
    u95 : float or None
        95 % half-width.
    parts : Parts
    status : Status
    origin : str
        ``fit``, ``literature``, ``estimate``, ``stated`` or ``none``.
    unit : str
        ``1`` when primed, else SI.
    table, campaign, body : str or None
    estimator : str
        How the value was made.
    window : (float, float) or None
        Range of the motion variable used: v' and w' as angles in radians, rates as r' = r L/U.
    window_over : str
        That variable; empty where the symbol names it, which a force at rest does not.
    n_points : int
    citation : str
    law : str
        ``motion``: the force scales with the speed of the motion, 1/2 rho U^(2-n) for n motion variables, as the prime
        system has it. ``rest``: damping about a state of rest, whose SI value multiplies the velocities whatever U is.
    value_si, unit_si : float or None, str
        In a parameter file, at its conditions.
    potential : float or None
        In a parameter file: the part that its added mass gives.
    """

    symbol: Annotated[
        str, Means("SNAME symbol with prime, for example Yv'; |v| is an absolute value, Nrdot' an acceleration")
    ]
    value: Annotated[Finite | None, Means("total, potential part included; null where the status gives none", "1")]
    u95: Annotated[NotNegative | None, Means("95 % half-width of the value; null where it is not known", "1")]
    status: Annotated[
        Status,
        Choice(IN_FILES, Status),
        Means(
            "ok: fitted with U95; single_estimator: fitted, its model-form error unknown; form_assumed (since 1.2): U95 holds "
            "the scatter and what the residuals show that the form leaves out; form_rejected (since 1.4): the residuals show "
            "that the form is wrong, no U95; stated: given as it is, by the literature or by whoever wrote the file; estimate (since 1.5): from the shape by semi-empirical methods; no_table, too_few_points, not_determined: no value"
        ),
    ]
    body: str = ""
    parts: Annotated[Parts, Means("what makes up U95")] = Parts()
    origin: Annotated[
        str,
        Choice(("fit", "literature", "estimate", "stated", "none")),
        Means("where the value comes from; stated (since 1.5): a number of whoever wrote the file"),
    ] = "none"
    unit: Annotated[str, Choice(("1",)), Means("1: nondimensional by the prime system of `scaling`")] = "1"
    table: Annotated[str | None, Means("file of the table that it was fitted to")] = None
    campaign: Annotated[str | None, Means("campaign of that table")] = None
    estimator: Annotated[str, Means("how the value was made, in words")] = ""
    window: Annotated[
        tuple[Finite, Finite] | None,
        Means("range of the motion that was used: angles in radians, rates as r' = r L/U", "rad or 1"),
    ] = None
    window_over: str = ""
    n_points: Annotated[Count, Means("points in that range")] = 0
    citation: Annotated[str, Means("keys of works, separated by commas")] = ""
    law: Annotated[
        Literal["motion", "rest"],
        Means(
            "motion: the force goes with 1/2 rho U^(2-n) for n motion variables; rest: value_si times the velocities "
            "whatever U is, damping about a state of rest",
            since="1.2",
        ),
    ] = "motion"
    value_si: Annotated[Finite | None, Means("the value at the density and speed of `conditions`", "see unit_si")] = (
        None
    )
    unit_si: Annotated[str, Means("SI unit of `value_si`, for example N/(m/s)")] = ""
    potential: Annotated[
        Finite | None,
        Means("part of the value that -C_A(nu) nu gives, by `added_mass`; the rest is viscous", "1", since="1.2"),
    ] = None

    @property
    def said(self) -> str:
        """Symbol, value and U95, or why there is none: ``Yv' = -0.0262 +- 0.0027``."""
        name = primed(self.symbol) if self.unit == "1" else self.symbol
        if self.value is None:
            return f"{name}: {self.status.replace('_', ' ')}"
        assumed = " (symmetry assumed)" if self.status is Status.SYMMETRY_ASSUMED else ""
        return f"{name} = {plus_minus(self.value, self.u95)}{'' if self.unit == '1' else f' {self.unit}'}{assumed}"

    def __repr__(self) -> str:
        share = f" ({percent(self.u95, self.value)})" if self.u95 is not None else ""
        come = self.campaign or self.citation
        return in_angles(self, f"{self.said}{share}{f', {come}' if come else ''}")

    def _repr_html_(self) -> str:
        """Value and interval, for notebooks."""
        return html_by("one_coefficient", self)

    def refuse(self) -> None:
        """Raise RefusedError for a coefficient that no parameter file may hold."""
        try:
            derivative(self.symbol)
        except InputError as why:
            raise RefusedError(why.found, why.expected, why.advice, ("symbol",)) from None
        if not self.symbol.endswith("'"):
            raise RefusedError(
                f"{shown(self.symbol)}, a symbol without prime",
                f"{self.symbol}', as the file holds primes",
                where=("symbol",),
            )
        if (self.value is None) != (self.status in WITHOUT_VALUE):
            raise RefusedError(
                f"{self.symbol}: value {'null' if self.value is None else f'{self.value:g}'} does not go with status {self.status}",
                f"null with {', '.join(WITHOUT_VALUE)}, a value with any other",
            )
        if self.u95 is not None and self.value is None:
            raise RefusedError(
                f"{self.symbol}: an interval without a value", "u95 null where value is null", where=("u95",)
            )

    def scaled(self, factor: float, unit: str) -> Coefficient:
        """Value and uncertainties times a factor."""

        def times(x: float | None, k: float = abs(factor)) -> float | None:
            return None if x is None else x * k

        p = self.parts
        parts = Parts(times(p.random), times(p.model_form), times(p.window), times(p.input))
        return replace(self, value=times(self.value, factor), u95=times(self.u95), parts=parts, unit=unit)

    @property
    def window_is_rate(self) -> bool:
        """Whether the window is one of p', q' or r', not of an angle."""
        return any(f in ANGULAR for f in (self.window_over, *derivative(self.symbol).factors))

    def with_rates(self, longer: float) -> Coefficient:
        """With the window of a rate, r' = r L / U, for a length ``longer`` times the old one."""
        if self.window is None or not self.window_is_rate:
            return self
        return replace(self, window=(self.window[0] * longer, self.window[1] * longer))


@dataclass(frozen=True, slots=True, eq=False)
@locking("covariance reference_point")
class CoefficientSet:
    """Coefficients of one body, one scaling, one reference point.

    Attributes
    ----------
    coefficients : tuple of Coefficient
    covariance : (k, k) array
        Of standard uncertainties (U95 / 2); NaN rows where a U95 is not given.
    scaling : Scaling
        Length of the primes, also kept when the set is dimensional.
    conditions : Conditions or None
        Density and speed of a dimensional set; None when primed.
    reference_point : (3,) array
        m, FRD, from the datum.
    datum : Datum
    body : str
    """

    coefficients: tuple[Coefficient, ...]
    covariance: Array
    scaling: Scaling
    reference_point: Array
    datum: Datum
    body: str
    conditions: Conditions | None = None

    def __repr__(self) -> str:
        by = f"primed by {self.scaling.length_name}" if self.conditions is None else "SI"
        return in_angles(self, f"{self.body}, {by}: {', '.join(c.said for c in self.coefficients)}")

    def _repr_html_(self) -> str:
        """Values and intervals, for notebooks."""
        return html_by("coefficients", self)

    def counted_from(self, datum: Datum, point: Array) -> CoefficientSet:
        """The set about a point, where its numbers hold about every point; else as it is."""
        return replace(self, datum=datum, reference_point=point) if self.datum == ANYWHERE else self

    def __getitem__(self, symbol: str) -> Coefficient:
        name = symbol.removesuffix("'")
        for c in self.coefficients:
            if c.symbol == name:
                return c
        raise KeyError(f"no {shown(symbol)} among {', '.join(c.symbol for c in self.coefficients)}")

    def __contains__(self, symbol: str) -> bool:
        return any(c.symbol == symbol.removesuffix("'") for c in self.coefficients)

    @property
    def symbols(self) -> tuple[str, ...]:
        """Symbols in order."""
        return tuple(c.symbol for c in self.coefficients)

    def _scaled(self, factors: Array, units: list[str], scaling: Scaling, to: Conditions | None) -> CoefficientSet:
        rows = zip(self.coefficients, factors, units, strict=True)
        longer = scaling.length / self.scaling.length
        changed = tuple(c.scaled(float(k), unit).with_rates(longer) for c, k, unit in rows)
        covariance = self.covariance * np.outer(factors, factors)
        return replace(self, coefficients=changed, covariance=covariance, scaling=scaling, conditions=to)

    def to_length(self, scaling: Scaling) -> CoefficientSet:
        """Prime by another length.

        Raises
        ------
        ScalingMismatchError
            The set is dimensional.
        """
        if self.conditions is not None:
            raise ScalingMismatchError("a dimensional set has no length to change; call to_prime first.")
        factors = np.array([self.scaling.ratio(s, scaling) for s in self.symbols])
        return self._scaled(factors, ["1"] * len(factors), scaling, None)

    def to_si(self, conditions: Conditions) -> CoefficientSet:
        """Dimensional at a density and speed."""
        if self.conditions is not None:
            raise ScalingMismatchError("the set is dimensional already; call to_prime first.")
        factors = np.array([self.scaling.unit(s, conditions.density, conditions.speed) for s in self.symbols])
        return self._scaled(factors, [derivative(s).unit for s in self.symbols], self.scaling, conditions)

    def to_prime(self, scaling: Scaling | None = None) -> CoefficientSet:
        """Primed by a length, from a dimensional set."""
        if self.conditions is None:
            raise ScalingMismatchError("the set is primed already; call to_length to change its length.")
        by = scaling or self.scaling
        factors = np.array([1.0 / by.unit(s, self.conditions.density, self.conditions.speed) for s in self.symbols])
        return self._scaled(factors, ["1"] * len(factors), by, None)

    def about(self, point: Array) -> CoefficientSet:
        """The set about another point (m, FRD, same datum), with its covariance.

        First-order velocity and acceleration derivatives go through the 6 x 6 congruence transform, control
        derivatives through its force half. A coefficient that needs an unknown one becomes `Status.NOT_DETERMINED`;
        so do higher-order rate terms, whose transfer needs terms that steady sweeps do not give.
        """
        if not np.any(np.asarray(point, dtype=float) - self.reference_point):
            return self
        return moved_together((self,), self.covariance, point).sets[0]

    @property
    def unit_of_length(self) -> float:
        """m: what a shift is divided by, the length of a primed set and one metre of one in SI."""
        return self.scaling.length if self.conditions is None else 1.0

    @property
    def available(self) -> frozenset[str]:
        """Symbols with a value."""
        return frozenset(c.symbol for c in self.coefficients if c.value is not None)


class Lacking(NamedTuple):
    """A coefficient that was not moved: ``symbol`` of the set ``of``, ``needs`` what nobody gives; empty where nothing would do."""

    of: int
    symbol: str
    needs: tuple[str, ...]


class MovedSets(NamedTuple):
    """Several sets about one point, the covariance of all their coefficients one after the other, and what was not moved.

    ``lent`` are pairs: which set was moved by numbers of which other.
    """

    sets: tuple[CoefficientSet, ...]
    covariance: Array
    lacking: tuple[Lacking, ...]
    lent: frozenset[tuple[int, int]]


def moved_together(sets: Sequence[CoefficientSet], covariance: Array, point: Array) -> MovedSets:
    """Sets of one body about one point: what a move of one needs and it has not, the others lend, about its own point.

    A yaw sweep knows no Yv', which the move of its Yr' takes: that of a drift sweep serves. The first that has it lends.

    Parameters
    ----------
    sets : sequence of CoefficientSet
        Of one datum and one length, about any points.
    covariance : (n, n) array
        Of all their coefficients one after the other; NaN rows where a U95 is not known.
    point : (3,) array
        m, FRD, from the datum.

    Examples
    --------
    >>> from coeflab.core.axes import Datum
    >>> body = (Scaling(2.0, "LOA"), np.zeros(3), Datum("nose"), "auv")
    >>> drift = CoefficientSet((Coefficient("Yv", -0.03, 0.002, Status.OK, "auv"),), np.array([[1e-6]]), *body)
    >>> yaw = CoefficientSet((Coefficient("Yr", 0.005, 0.001, Status.OK, "auv"),), np.array([[2.5e-7]]), *body)
    >>> moved = moved_together((drift, yaw), np.diag([1e-6, 2.5e-7]), np.array([-1.0, 0.0, 0.0]))
    >>> round(moved.sets[1]["Yr"].value, 6)  # 0.005 - dx' Yv', dx' = -1.0 / 2.0
    -0.01
    """
    ends = np.cumsum([0, *(len(s.coefficients) for s in sets)])
    moves = np.zeros((ends[-1], ends[-1]))
    known = np.ones(ends[-1], dtype=bool)
    lacking: list[Lacking] = []
    lent: set[tuple[int, int]] = set()
    for i, s in enumerate(sets):
        left, right = derivative_transfer((np.asarray(point, dtype=float) - s.reference_point) / s.unit_of_length)
        own = {c.symbol: k for k, c in enumerate(s.coefficients, ends[i]) if c.value is not None}
        loans: dict[str, tuple[int, Array]] = {}
        for k, c in enumerate(s.coefficients, ends[i]):
            needs = []
            for name, weight in _transferred(c.symbol, left, right).items():
                if name in own:
                    moves[k, own[name]] += weight
                elif c.value is not None and not _vanishes(name):
                    if name not in loans and (loan := _loan(sets, i, name)) is not None:
                        row = np.zeros(ends[-1])
                        row[ends[loan[0]] : ends[loan[0] + 1]] = loan[1]
                        loans[name] = loan[0], row
                    if name in loans:
                        moves[k] += weight * loans[name][1]
                        lent.add((i, loans[name][0]))
                    else:
                        needs.append(name)
            known[k] = c.value is not None and not needs
            if needs:
                lacking.append(Lacking(i, c.symbol, tuple(n for n in needs if n)))
    values = np.array([0.0 if c.value is None else c.value for s in sets for c in s.coefficients])
    moved, void = moves @ values, np.isnan(np.diag(covariance))
    spread = moves @ np.nan_to_num(covariance) @ moves.T
    spread = 0.5 * (spread + spread.T)
    undetermined = (moves != 0.0) @ void | ~known
    spread[undetermined, :] = spread[:, undetermined] = np.nan
    out = []
    for s, start, end in zip(sets, ends[:-1], ends[1:], strict=True):
        changed = []
        for k, c in enumerate(s.coefficients, start):
            if not known[k]:
                status = Status.NOT_DETERMINED if c.value is not None else c.status
                changed.append(replace(c, value=None, u95=None, parts=Parts(), status=status))
            elif np.count_nonzero(moves[k]) == 1:
                changed.append(c)
            else:
                u95 = None if undetermined[k] else float(2.0 * np.sqrt(spread[k, k]))
                changed.append(replace(c, value=float(moved[k]), u95=u95, parts=Parts()))
        out.append(replace(
            s, coefficients=tuple(changed), covariance=spread[start:end, start:end], reference_point=np.asarray(point, dtype=float)
        ))  # fmt: skip
    return MovedSets(tuple(out), spread, tuple(lacking), frozenset(lent))


def _loan(sets: Sequence[CoefficientSet], to: int, name: str) -> tuple[int, Array] | None:
    """Which other set gives a derivative about the point of set ``to``, and its row over that set's coefficients."""
    for j, s in enumerate(sets):
        if j == to or name not in s.available:
            continue
        matrix, known = transfer_matrix(
            s.symbols, s.available, (sets[to].reference_point - s.reference_point) / s.unit_of_length
        )
        k = s.symbols.index(name)
        if known[k]:
            return j, matrix[k]
    return None


def _transferred(symbol: str, left: Array, right: Array) -> dict[str, float]:
    """Which derivatives about the old point make one about the new, with their weights; "" for what no sweep gives."""
    d = derivative(symbol)
    row = COMPONENTS.index(d.component)
    if len(d.factors) == 1 and (motion := d.factors[0].removesuffix("dot")) in MOTIONS:
        column, dot = MOTIONS.index(motion), d.factors[0].removeprefix(motion)
        return {
            component + variable + dot: float(weight)
            for k, component in enumerate(COMPONENTS)
            for j, variable in enumerate(MOTIONS)
            if (weight := left[row, k] * right[j, column]) != 0.0
        }
    if all(f not in ("p", "q", "r") and not f.endswith("dot") for f in d.factors):
        return {c + symbol[1:]: float(left[row, k]) for k, c in enumerate(COMPONENTS) if left[row, k] != 0.0}
    return {symbol: 1.0} if np.array_equal(left, np.eye(6)) else {symbol: 1.0, "": 1.0}


def transfer_matrix(
    symbols: tuple[str, ...], available: frozenset[str], shift: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Matrix T with new = T @ old over ``symbols``, and which rows are determined by the available ones."""
    left, right = derivative_transfer(shift)
    index = {s: i for i, s in enumerate(symbols)}
    matrix = np.zeros((len(symbols), len(symbols)))
    known = np.ones(len(symbols), dtype=bool)
    for i, symbol in enumerate(symbols):
        for name, weight in _transferred(symbol, left, right).items():
            if name in index and name in available:
                matrix[i, index[name]] = weight
            elif not _vanishes(name):
                known[i] = False
    return matrix, known


def _vanishes(symbol: str) -> bool:
    """True for derivatives that port-starboard symmetry makes zero."""
    return bool(symbol) and derivative(symbol).odd_in_port_starboard
