"""A fitted force law or table: terms, coefficients with covariance, domain, diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass, in_angles, locking
from coeflab.fits.results.set_aside import SetAside
from coeflab.fits.statistics.linear_model import LinearFit
from coeflab.fits.statistics.remainder import Remainder
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.law.domain import Domain
from coeflab.law.named_terms import canonical
from coeflab.law.symbols import ANGULAR
from coeflab.law.terms import Term, design
from coeflab.tables.force_table import AT_REST, SAME_SIZE

DIGITS = "rounding of printed digits"  # what a table leaves out behind its last digit


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
        angles, speeds, calibrations; under `DIGITS` the half-widths by `rounding`, which goes along with the scatter.
    not_assessed : tuple of str
        What may act and is in no half-width, in words; filled in by the budget.
    set_aside : SetAside or None
        Printed rows that are rejected or doubtful.
    remainder : Remainder or None
        What the residuals say of the form; None where it was not asked.
    rounding : (p,) array or None
        95 % half-widths by the last printed digit of the rows; None where these have all digits. The budget takes it into ``shared``.
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
    rounding: Array | None = None

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
        standard = np.hypot(self.fit.half_width, self.shared.get(DIGITS, 0.0)) / 2.0
        out = self.fit.correlation * np.outer(standard, standard)
        np.fill_diagonal(out, standard**2)
        if self.remainder is not None:
            out = out + self.remainder.covariance / 4.0
            out[self.remainder.rejected, :] = out[:, self.remainder.rejected] = np.nan
        for shift in (s for name, s in self.shared.items() if name != DIGITS):
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
