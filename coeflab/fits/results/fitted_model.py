"""A fitted force law or table: terms, coefficients with covariance, domain, diagnostics.

Rows that a source prints and no fit uses: rejected or doubtful, kept for pictures.

What the form of a fitted model misses, in words: residuals that are not random, and the next term in a motion.

What a model is worth on rows that it has not seen, as a share of the response's range.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from itertools import combinations
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass, in_angles, locking
from coeflab.fits.statistics.groups import predict_left_out, thirds
from coeflab.fits.statistics.linear_model import LinearFit, fit_linear
from coeflab.fits.statistics.remainder import Remainder
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.law.domain import Domain
from coeflab.law.named_terms import canonical
from coeflab.law.symbols import ANGULAR, MOTIONS
from coeflab.law.terms import Term, design
from coeflab.tables.force_table import AT_REST, SAME_SIZE, ForceTable


@dataclass(frozen=True, slots=True, eq=False)
@locking("x y")
class SetAside:
    """Points beside a fit.

    Attributes
    ----------
    x : mapping of variable to (n,) array
        As the rows of the fit.
    y : (n,) array
    labels : tuple of str
    """

    x: Mapping[str, Array]
    y: Array
    labels: tuple[str, ...]

    def only(self, keep: NDArray[np.bool_]) -> SetAside:
        """Some of the points."""
        labels = tuple(t for t, k in zip(self.labels, keep, strict=True) if k)
        return SetAside({v: x[keep] for v, x in self.x.items()}, self.y[keep], labels)


def joined(parts: list[SetAside]) -> SetAside | None:
    """The points of several tables over the same variables; None where there are none."""
    found = [p for p in parts if len(p.y)]
    if not found:
        return None
    return SetAside(
        {v: np.concatenate([p.x[v] for p in found]) for v in found[0].x},
        np.concatenate([p.y for p in found]),
        tuple(t for p in found for t in p.labels),
    )


def readmitted(table: ForceTable) -> ForceTable:
    """The table with every printed cell in use that its file or its declaration turns away.

    Rows that a fit leaves out of its own accord, as another variable moves in them, have no line of a file and stay out.
    """
    usable = {c: np.isfinite(values) for c, values in table.forces.items()}
    for e in table.exclusions:
        if not e.line:
            for component in [e.component] if e.component else usable:
                usable[component][e.row] = False
    return replace(table, usable=usable)


@dataclass(frozen=True, slots=True, eq=False)
@locking("x shared y")
class FittedModel:
    """One response as a linear combination of terms.

    Attributes
    ----------
    response : str
        ``C_D``, ``Y'``, ``X [N]`` ...
    unit : str
        ``1`` or SI.
    form : str
        In words: ``polynomial of degree 3, odd``.
    symbols : tuple of str
        Name of every coefficient.
    terms : tuple of Term
    fit : LinearFit
    domain : Domain
    table, campaign, body : str
    n_points : int
    x : mapping of variable to (n,) array
    y : (n,) array
    labels : tuple of str
    statements : tuple of str
        What the data do not determine, collinearity, accuracy: in words.
    post_selection : bool
        True when the terms were chosen by looking at the same data; intervals are then too narrow.
    shared : mapping of str to (p,) array
        Errors that all rows share, each as the signed 95 % shift that it gives to every coefficient: the grid, declared
        angles, speeds, calibrations.
    not_assessed : tuple of str
        What may act and is in no half-width, in words; filled in by the budget.
    set_aside : SetAside or None
        Printed rows that are rejected or doubtful.
    remainder : Remainder or None
        What the residuals say of the form; None where it was not asked.
    """

    response: str
    unit: str
    form: str
    symbols: tuple[str, ...]
    terms: tuple[Term, ...]
    fit: LinearFit
    domain: Domain
    table: str
    campaign: str
    body: str
    x: Mapping[str, Array]
    y: Array
    labels: tuple[str, ...]
    statements: tuple[str, ...] = ()
    post_selection: bool = False
    shared: Mapping[str, Array] = field(default_factory=dict)
    not_assessed: tuple[str, ...] = ()
    set_aside: SetAside | None = None
    remainder: Remainder | None = None

    @property
    def n_points(self) -> int:
        """Rows used."""
        return len(self.y)

    @property
    def is_constant(self) -> bool:
        """Whether it has constants alone, so that the range of the response is its scatter."""
        return not any(t.factors for t in self.terms)

    @property
    def covariance(self) -> Array:
        """(p, p), of standard uncertainties, half-width / 2: scatter by its correlation, form and shared errors in full.

        NaN where there is no half-width.
        """
        standard = self.fit.half_width / 2.0
        out = self.fit.correlation * np.outer(standard, standard)
        np.fill_diagonal(out, standard**2)
        if self.remainder is not None:
            out = out + self.remainder.covariance / 4.0
            out[self.remainder.rejected, :] = out[:, self.remainder.rejected] = np.nan
        for shift in self.shared.values():
            out = out + np.outer(shift, shift) / 4.0
        return np.asarray((out + out.T) / 2.0)

    @property
    def half_width(self) -> Array:
        """(p,) 95 % half-widths of the coefficients, scatter, form and shared errors; NaN where there is none."""
        form = np.zeros(len(self.terms)) if self.remainder is None else self.remainder.half_width
        out = np.sqrt(self.fit.half_width**2 + form**2 + sum(s**2 for s in self.shared.values()))
        return np.asarray(out if self.remainder is None else np.where(self.remainder.rejected, np.nan, out))

    @property
    def rejected(self) -> tuple[str, ...]:
        """Symbols that have a value and, as their form is wrong, no half-width."""
        if self.remainder is None:
            return ()
        return tuple(s for s, r in zip(self.symbols, self.remainder.rejected, strict=True) if r)

    def one_size(self, i: int) -> str:
        """Why a coefficient is no derivative, in words: its rows turn at one |r'|, a rotating arm's one radius.

        There r', r'|r'| and r'^3 are one column, and a term of one of them stands for all. Empty for any other coefficient.
        """
        variables = {v for v, *_ in canonical(self.terms[i])}
        v = min(variables) if len(variables) == 1 else ""
        if v not in ANGULAR or v not in self.x:
            return ""
        sizes = np.abs(self.x[v])[np.abs(self.x[v]) > AT_REST]
        if not len(sizes) or float(np.ptp(sizes)) > SAME_SIZE * float(sizes.max()):
            return ""
        return text_of("fits.one_rate", v=v, sizes=np.median(sizes), symbols=self.symbols[i])

    @property
    def secants(self) -> tuple[str, ...]:
        """What `one_size` says, of every coefficient that it speaks of, a sentence each."""
        words = [self.one_size(i) for i in range(len(self.terms)) if np.isfinite(self.fit.coefficients[i])]
        return tuple(f"{s[0].upper()}{s[1:]}." for s in words if s)

    def recommended(self, i: int) -> float | None:
        """The value of a coefficient; None where it is open, or no derivative."""
        value = float(self.fit.coefficients[i])
        return value if np.isfinite(value) and not self.one_size(i) else None

    def worth(self, i: int, unknown: Status = Status.NOT_DETERMINED) -> tuple[float | None, Status, Parts]:
        """U95 of a coefficient without shared errors, its status (``unknown`` without a value), and what makes U95 up."""
        value, scatter = float(self.fit.coefficients[i]), float(self.fit.half_width[i])
        if not np.isfinite(value):
            return None, unknown, Parts()
        if self.one_size(i):
            return None, Status.NOT_DETERMINED, Parts()
        if not np.isfinite(scatter):
            return None, Status.SINGLE_ESTIMATOR, Parts()
        form = None if self.remainder is None else float(self.remainder.half_width[i])
        parts = Parts(random=scatter, model_form=form)
        if self.remainder is not None and self.remainder.rejected[i]:
            return None, Status.FORM_REJECTED, parts
        return float(np.hypot(scatter, form or 0.0)), Status.FORM_ASSUMED, parts

    def evaluate(self, columns: Mapping[str, Array]) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Values, 95 % half-widths of the mean, and whether each point lies inside the domain.

        The half-widths join those of the coefficients by their covariance, shared errors included. A point that needs a coefficient which
        the data leave open has the value NaN.

        Parameters
        ----------
        columns : mapping of variable to (n,) array
            Same variables and units as `x`.
        """
        rows = design(self.terms, columns)
        known = np.isfinite(self.fit.coefficients)
        values = np.where(np.any(rows[:, ~known] != 0.0, axis=1), np.nan, rows[:, known] @ self.fit.coefficients[known])
        bare = known & ~np.isfinite(self.half_width)
        joint = np.nan_to_num(self.covariance)
        spread = 2.0 * np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", rows, joint, rows), 0.0))
        sure = np.isfinite(values) & ~np.any(rows[:, bare] != 0.0, axis=1)
        return (
            values,
            np.where(sure, spread, np.nan),
            self.domain.contains(np.column_stack([columns[v] for v in self.domain.variables])),
        )

    def __repr__(self) -> str:
        over = " ".join(self.domain.variables)
        return in_angles(
            self, f"{self.response} [{self.unit}] over {over}, {self.form}: {len(self.terms)} terms, {self.campaign}"
        )

    def _repr_html_(self) -> str:
        """Its figure and terms, for notebooks."""
        return html_by("model", self)

    def named(self, symbol: str) -> tuple[float, float]:
        """Value and 95 % half-width of one coefficient."""
        i = self.symbols.index(symbol)
        return float(self.fit.coefficients[i]), float(self.half_width[i])


def coefficient_of(
    model: FittedModel, i: int, citation: str, unknown: Status = Status.NOT_DETERMINED, **more: Any
) -> Coefficient:
    """One coefficient of a model as `FittedModel.worth` has it, with where it comes from.

    Parameters
    ----------
    model : FittedModel
    i : int
    citation : str
    unknown : Status
        Without a value.
    **more
        Of `Coefficient`, beside these or in their place.
    """
    u95, status, parts = model.worth(i, unknown)
    own = {
        "symbol": model.symbols[i], "value": model.recommended(i), "u95": u95, "status": status, "body": model.body, "parts": parts,
        "origin": "fit", "table": model.table, "campaign": model.campaign, "n_points": model.n_points, "citation": citation,
    }  # fmt: skip
    return Coefficient(**{**own, **more})


COLLINEAR = 0.98  # the half-width is five times that of either term alone: 1 / sqrt(1 - 0.98^2)
MOST_PAIRS = 3
MOST_DIRECTIONS, MOST_MIXED = 4, 6
FEWEST_DIGITS = 7.0  # half of a double's
SEEN = 0.05  # of the largest part: less is not named


def _only_together(parts: list[tuple[str, float]]) -> str:
    """Terms that a direction of the coefficients mixes; of many, the heaviest."""
    heaviest = sorted(parts, key=lambda p: -abs(p[1]))[:MOST_MIXED]
    shown = [p for p in parts if p in heaviest]
    more = f" and {len(parts) - len(shown)} more" if len(parts) > len(shown) else ""
    names = ", ".join(s for s, _ in shown)
    mix = " ".join(f"{d:+.2g} [{s}]" for s, d in shown) + (" ..." if more else "")
    return f"{names}{more} are determined only in combination: adding any multiple of {mix} (each scaled by its column) changes no prediction."


def in_words(fit: LinearFit, symbols: tuple[str, ...]) -> tuple[str, ...]:
    """What the rows do not determine, which coefficients move together, and how exact the arithmetic is."""
    out = []
    for direction in fit.open_directions[:MOST_DIRECTIONS]:
        largest = float(np.max(np.abs(direction)))
        parts = [(s, float(d) / largest) for s, d in zip(symbols, direction, strict=True) if abs(d) > SEEN * largest]
        if len(parts) == 1:
            out.append(f"{parts[0][0]} is not determined: its term is zero on these data.")
        else:
            out.append(_only_together(parts))
    if len(fit.open_directions) > MOST_DIRECTIONS:
        out.append(
            f"{len(fit.open_directions) - MOST_DIRECTIONS} more combinations are not determined: "
            f"{fit.rank} of {len(symbols)} terms can be separated. Ask for fewer."
        )
    pairs = [(abs(fit.correlation[i, j]), i, j) for i, j in combinations(range(len(symbols)), 2)]
    close = sorted((pair for pair in pairs if pair[0] > COLLINEAR), reverse=True)
    for _, i, j in close[:MOST_PAIRS]:
        out.append(f"{symbols[i]} and {symbols[j]} are nearly collinear (correlation {fit.correlation[i, j]:.3f}).")
    if len(close) > MOST_PAIRS:
        out.append(f"{len(close) - MOST_PAIRS} more pairs are nearly collinear (beyond {COLLINEAR}).")
    if fit.digits < FEWEST_DIGITS:
        out.append(
            f"Only {max(fit.digits, 0):.0f} digits of the coefficients are reliable: the terms are nearly dependent."
        )
    return tuple(out)


UNLIKELY = 0.01  # a false alarm in one of a hundred sound fits
ROUNDING = 1e-10  # residuals of an exact form, over the largest value


def chance(probability: float) -> str:
    """A probability as a reader wants it: ``p = 0.042``, ``p < 0.001``."""
    return "p < 0.001" if probability < 1e-3 else f"p = {probability:.2g}"


def residuals_in_words(model: FittedModel, way_out: str = "") -> tuple[str, ...]:
    """What the residuals say against the form: a remainder that they show, else signs that are not random.

    Signs are taken in the order of the rows (Wald & Wolfowitz 1940).

    Parameters
    ----------
    model : FittedModel
    way_out : str
        A sentence on what to do about a form that misses something.

    Returns
    -------
    tuple of str
        Empty where there is probably no remainder and the runs test is not below 0.01, or where the residuals are
        rounding.
    """
    fit = model.fit
    if model.remainder is not None and model.remainder.likeliest:
        return (f"{_remainder_in_words(model, model.remainder)} {way_out}".rstrip(),)
    exact = fit.rms <= ROUNDING * float(np.max(np.abs(model.y), initial=0.0))
    if exact or not fit.runs_probability < UNLIKELY:
        return ()
    signs = fit.residuals[fit.residuals != 0.0] > 0.0
    up = int(signs.sum())
    expected = 1.0 + 2.0 * up * (len(signs) - up) / len(signs)
    found = f"The residuals are not random (runs test, {chance(fit.runs_probability)})"
    if 1 + int(np.count_nonzero(signs[1:] != signs[:-1])) > expected:
        return (f"{found}: they change sign more often than by chance, and the intervals cannot be trusted.",)
    words = f"{found}: the form misses something, and the intervals cannot be trusted."
    return (f"{words} {way_out}".rstrip(),)


def _remainder_in_words(model: FittedModel, found: Remainder) -> str:
    right = "below 0.001" if found.none < 1e-3 else f"{found.none:.2g}"
    held = next((t for t in model.terms if found.likeliest == f"a term {t}"), None)
    likeliest = found.likeliest if held is None else f"a coefficient of {held} that no equation holds"
    words = f"The residuals are not random: the form misses something, most likely {likeliest}; probability that it misses nothing: {right}."
    without = model.rejected
    if not without:
        return f"{words} U95 includes what that may change."
    have = "has" if len(without) == 1 else "have"
    return f"{words} It is rejected for {', '.join(without)}, which {have} no U95; that of the others includes what it may change."


def _own_powers(model: FittedModel, variable: str) -> list[tuple[int, bool]]:
    """Power and oddness of the terms in one variable alone."""
    keys = [canonical(t) for t in model.terms]
    return [(k[0][1], k[0][2]) for k in keys if len(k) == 1 and k[0][0] == variable]


def _next(model: FittedModel, variable: str) -> Term | None:
    """x|x| after a line in x; x^3 after x|x| where the residuals are not random; None otherwise."""
    odd = {n for n, is_odd in _own_powers(model, variable) if is_odd}
    if odd == {1}:
        return Term(((variable, 1, False), (variable, 1, True)))
    if odd == {1, 2} and residuals_in_words(model):
        return Term(((variable, 3, False),))
    return None


def next_terms_in_words(
    model: FittedModel, errors: Array | None, asked: str, set_aside: Array | None = None
) -> tuple[str, ...]:
    """Curvature in a motion that the rows show and the terms lack.

    After a line in a motion the next term is x|x|, after x|x| it is x^3 (the latter where the residuals are not random).
    The t test of its coefficient stands unequal noise (HC2, Bell & McCaffrey 2002).

    Parameters
    ----------
    model : FittedModel
        Over SNAME motions, its coefficients free.
    errors : (n,) array or None
        Standard errors that weighed the rows.
    asked : str
        Set of terms that was asked for, as advice needs it; empty for none.
    set_aside : (n, k) array, optional
        Columns that were fitted beside the terms.

    Returns
    -------
    tuple of str
        One sentence a term below 0.01, with what it does to the slope.
    """
    matrix, out = design(model.terms, model.x), []
    matrix = matrix if set_aside is None else np.column_stack([matrix, set_aside])
    lines = {canonical(t): s for t, s in zip(model.terms, model.symbols, strict=True)}
    if model.fit.rms <= ROUNDING * float(np.max(np.abs(model.y))) or len(model.y) <= matrix.shape[1] + 1:
        return ()
    for variable in (v for v in model.x if v in MOTIONS):
        term, slope = _next(model, variable), lines.get(((variable, 1, True),), "")
        if term is None or not np.isfinite(model.named(slope)[0]):
            continue
        wider = fit_linear(np.column_stack([matrix, term.evaluate(model.x)]), model.y, errors)
        error = float(np.sqrt(wider.covariance[-1, -1]))
        value, moved = float(wider.coefficients[-1]), float(wider.coefficients[model.symbols.index(slope)])
        if not np.isfinite([value, moved, wider.half_width[-1]]).all() or error == 0.0:
            continue
        probability = float(t_probability(value / error, float(wider.freedom[-1])))
        if probability >= UNLIKELY:
            continue
        name = model.response + term.suffix
        with_set = f" beside set = {asked}" if asked else ""
        out.append(
            f"The terms miss curvature in {variable}: with {name} ({chance(probability)}) {slope} goes from "
            f"{model.named(slope)[0]:.3g} to {moved:.3g}. Add {name} to terms{with_set}."
        )
    return tuple(out)


RANGE = "the response's range"


@dataclass(frozen=True, slots=True)
class OutOfSample:
    """Prediction errors of left-out rows.

    Attributes
    ----------
    how : str
        Which rows are left out.
    rms, largest : float
        Share of the response's range; NaN if no row could be predicted.
    predicted, rows : int
        Rows that the others determine, and all rows.
    of : str
        What the errors are shares of.
    """

    how: str
    rms: float
    largest: float
    predicted: int
    rows: int
    of: str = RANGE

    @property
    def is_known(self) -> bool:
        """Whether the others determine at least half of the rows, so that an error can be given."""
        return 2 * self.predicted >= max(self.rows, 1) and not isnan(self.rms)

    def __str__(self) -> str:
        if not self.predicted:
            return f"{self.how}: the remaining rows do not determine the model, so nothing can be predicted."
        if isnan(self.rms):
            return f"{self.how}: the left-out rows do not vary, so no error is given as a share of their range."
        missing = self.rows - self.predicted
        if not self.is_known:
            return text_of("fits.too_few_rows_left", how=self.how, predicted=self.predicted, rows=self.rows)
        rest = f"; {missing} of {self.rows} rows are not determined by the others" if missing else ""
        return (
            f"{self.how}: the left-out rows are predicted to {100 * self.rms:.2f} % rms, {100 * self.largest:.2f} % at "
            f"most, of {self.of}{rest}."
        )


def errors_of(how: str, response: Array, predicted: Array, *, constant: bool = False) -> OutOfSample:
    """Compare predictions, NaN where there is none, with what was measured; of a constant as shares of its mean."""
    known = np.isfinite(predicted)
    size = abs(float(np.mean(response))) if constant else float(np.ptp(response))
    size = size or float("nan")
    error = np.abs(predicted[known] - response[known]) / size
    rms = float(np.sqrt(np.mean(error**2))) if error.size else float("nan")
    of = "the mean" if constant else RANGE
    largest = float(error.max()) if error.size else float("nan")
    return OutOfSample(how, rms, largest, int(known.sum()), len(response), of)


def every_third_point(model: FittedModel) -> OutOfSample:
    """Leave every third point out, each point once: rows sorted by the motion variables, ends included."""
    fold = thirds(list(model.x.values()))
    predicted = predict_left_out(design(model.terms, model.x), model.y, fold)
    return errors_of("Every third point left out", model.y, predicted, constant=model.is_constant)
