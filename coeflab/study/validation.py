"""Validation of a computation against an experiment: comparison error against validation uncertainty.

ASME V&V 20-2009, section 1-5; ITTC 7.5-03-01-01: E = S - D, U_V^2 = U_D^2 + U_SN^2 + U_input^2. When |E| lies within
U_V, a modelling error cannot be told from the uncertainties; otherwise E is about the modelling error, known to U_V.

There is no verdict where U_V lacks the numerical error of the grid, nor on a force of friction at another Reynolds number, nor
on what the symmetry of the body makes zero: its computation predicts nothing, and what was measured is a bias of the test.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.types import brief
from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.law.friction_line import FRICTION_APART, friction_line
from coeflab.law.symbols import derivative
from coeflab.study.symmetry import zeros
from coeflab.tables.force_table import STUDIES, ForceTable
from coeflab.vehicle.stability import INDICES, index_gradient, stability_index

if TYPE_CHECKING:
    from coeflab.fits.uncertainty.budget import Budget, OpenGrid
    from coeflab.law.coefficient import CoefficientSet
    from coeflab.study.study import Study
    from coeflab.vehicle.published_values import Reference


@brief
@dataclass(frozen=True, slots=True)
class PrintedIndex:
    """A stability index as its source prints it, and made anew of the derivatives that it prints beside.

    Attributes
    ----------
    name, reference, parameter_file : str
        The mass is that of the parameter file.
    printed, found : float
    allowed : float
        What rounding of the printed digits can do, half of the last one of each.
    """

    name: str
    reference: str
    parameter_file: str
    printed: float
    found: float
    allowed: float

    @property
    def holds(self) -> bool:
        """Whether rounding explains the difference."""
        return abs(self.found - self.printed) <= self.allowed


def printed_indices(study: Study) -> tuple[PrintedIndex, ...]:
    """Every index that a re-analysed source prints with all its derivatives, by the mass of its body's parameter file."""
    out = []
    for r in study.references:
        file = next(
            (
                p for p in study.parameter_files.values()
                if p.body == r.body and p.mass is not None and {c.campaign for c in p.coefficients} & set(r.campaigns)
            ),
            None,
        )  # fmt: skip
        stated = {v.symbol: v for v in (*r.values, *(v for kind in r.literature for v in kind.values))}
        for index in r.indices:
            *symbols, sign = INDICES[index.symbol]
            chosen = [
                v for s in symbols if (v := stated.get(str(s).removesuffix("'"))) is not None and v.value is not None
            ]
            if file is None or file.mass is None or index.value is None or len(chosen) < len(symbols):
                continue
            slope, lever, rate, moment_rate = (float(v.value or 0.0) for v in chosen)
            mass, moment = float(sign) * file.mass.mass_prime, file.mass.mass_moment_prime
            gradient = np.abs(index_gradient(slope, lever, rate, moment_rate, mass, moment))
            places = np.array([_half_a_digit(v.printed) for v in chosen])
            allowed = gradient @ places + gradient[2] * places[2] + _half_a_digit(index.printed)  # m' as Yr'
            value = stability_index(
                np.array(slope), np.array(lever), np.array(rate), np.array(moment_rate), mass, moment
            )
            out.append(PrintedIndex(index.symbol, r.name, file.name, index.value, float(value), float(allowed)))
    return tuple(out)


def _half_a_digit(printed: str) -> float:
    """Half of the last digit of a number without exponent."""
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


def in_millions(reynolds: float) -> str:
    """A Reynolds number as ``8.49e6``."""
    return f"{1e-6 * reynolds:.3g}e6"


NUMERICAL = ("random", "grid", STUDIES["domain"], STUDIES["iterations"])
MODEL = STUDIES["turbulence"]
REDUCTION = ("model form", "random and model form")
WIDE = 0.25  # of the measured or published value: a wider uncertainty passes what a reader would call a difference
AS_PRINTED = ", as printed"


@brief
@dataclass(frozen=True, slots=True)
class Validation:
    """One coefficient computed and measured.

    Attributes
    ----------
    symbol, body, simulation, experiment : str
    computed, measured : float
        S and D, primed by one length.
    u_measured : float or None
        U_D.
    u_numerical : float
        U_SN: grid, domain, iterations and their noise, as far as they were assessed; no turbulence model, which E is about.
    u_reduction : float
        Of drawing a slope through computed points: the model form.
    u_input : float or None
        Inputs of the computation.
    lacking, lacking_measured : tuple of str
        What U_V does not hold of the computation and of the experiment.
    reynolds : tuple of 2 floats or None
        Reynolds numbers of computation and experiment on one length; None where a campaign does not tell.
    zero : bool
        Whether the body's symmetry makes the coefficient zero, and the computation finds it zero.
    method : str
        Of a measured side that is a printed derivative by another method, such as ``PMM``; empty for our fit to a steady test.
    open_grid : OpenGrid or None
        Of the computation, as `Budget` has it.
    """

    symbol: str
    body: str
    simulation: str
    experiment: str
    computed: float
    measured: float
    u_measured: float | None
    u_numerical: float
    u_reduction: float
    u_input: float | None
    lacking: tuple[str, ...]
    lacking_measured: tuple[str, ...]
    reynolds: tuple[float | None, float | None] = (None, None)
    zero: bool = False
    method: str = ""
    open_grid: OpenGrid | None = None

    @property
    def error(self) -> float:
        """Comparison error E = S - D."""
        return self.computed - self.measured

    @property
    def u_validation(self) -> float | None:
        """U_V; None where the measurement has no U95."""
        if self.u_measured is None:
            return None
        return float(
            np.sqrt(self.u_measured**2 + self.u_numerical**2 + self.u_reduction**2 + (self.u_input or 0.0) ** 2)
        )

    @property
    def beyond(self) -> bool:
        """Whether the error is larger than U_V as far as that is known, verdict or not."""
        return self.u_validation is not None and abs(self.error) >= self.u_validation

    @property
    def why_none(self) -> str:
        """Why there is no verdict; empty where there is one."""
        reasons = (
            "zero by symmetry" if self.zero else "",
            f"the test used another method, {self.method}" if self.method else "",
            "the test has no U95" if self.u_measured is None else "",
            self.open_grid.reason if self.open_grid else "",
            self._friction(),
        )
        return "; ".join(filter(None, reasons))

    @property
    def reasons(self) -> tuple[str, ...]:
        """The same as clauses of a sentence, without the Reynolds numbers."""
        state = None if self.open_grid is None else self.open_grid.study
        grid = "grid study diverged" if state is Convergence.DIVERGENT else f"no error from the grid study: {state}"
        if state is None:
            grid = "" if self.open_grid is None else self.open_grid.reason
        clauses = (
            "zero by symmetry, and the test has a bias" if self.zero else "",
            f"the test used another method, {self.method}" if self.method else "",
            "the test has no U95" if self.u_measured is None else "",
            grid,
            self._friction("the two Reynolds numbers"),
        )
        return tuple(filter(None, clauses))

    def _friction(self, between: str = "") -> str:
        """Why drag has no verdict at these Reynolds numbers; empty for other coefficients and where it has one."""
        if self.symbol[:1] != "X" or set(derivative(self.symbol).factors) - {"u"}:
            return ""
        computed, measured = self.reynolds
        if computed is None or measured is None:
            return "Re of both sides not known"
        ratio = friction_line(computed) / friction_line(measured) - 1.0
        if abs(ratio) <= FRICTION_APART:
            return ""
        between = between or f"Re {in_millions(computed)} and {in_millions(measured)}"
        return f"friction differs by {100.0 * abs(ratio):.0f} % between {between}, ITTC 1957"

    @property
    def within(self) -> bool | None:
        """The verdict: whether the error lies within U_V; None where there is none."""
        return None if self.why_none else not self.beyond

    @property
    def share(self) -> str:
        """U_V over the measured value, in words for tables."""
        u_v = self.u_validation
        return "" if u_v is None or not self.measured else f"{100.0 * u_v / abs(self.measured):.0f} %"

    @property
    def weak(self) -> bool:
        """Whether the error lies within a U_V of more than a quarter of the measured value."""
        return self.within is True and (self.u_validation or 0.0) > WIDE * abs(self.measured)

    @property
    def statement(self) -> str:
        """The verdict in words."""
        if self.why_none:
            text = f"no verdict: {self.why_none}"
        elif self.within:
            text = "|E| < U_V: no modelling error can be shown at this level of uncertainty"
        else:
            low, high = (self.error + sign * (self.u_validation or 0.0) for sign in (-1.0, 1.0))
            text = f"|E| > U_V: modelling error, or parts that U_V lacks, between {low:.3g} and {high:.3g}"
        for side, names in (("computation", self.lacking), ("experiment", self.lacking_measured)):
            text += f"; not in U_V, {side}: {', '.join(names)}" if names else ""
        return text


def validations(study: Study, found: Sequence[Budget]) -> tuple[Validation, ...]:
    """Every pair of a computed and a measured coefficient of one body about one reference point, printed ones by another method too."""
    sets = {f.campaign: f.coefficients for f in study.fits if f.sweeps}
    out = []
    for s in found:
        for d in found:
            if s.kind != "cfd" or d.kind != "experiment" or s.symbol != d.symbol or s.body != d.body:
                continue
            if not _alike(sets[s.campaign], sets[d.campaign]):
                continue
            length = sets[s.campaign].scaling.length
            reynolds = (reynolds_of(study, s.campaign, length), reynolds_of(study, d.campaign, length))
            one = validation(s, d, sets[d.campaign].scaling.ratio(d.symbol, sets[s.campaign].scaling), reynolds)
            own = next(c for c in sets[s.campaign].coefficients if c.symbol == s.symbol.removesuffix("'"))
            out.append(replace(one, zero=bool(zeros(study, s.campaign, (own,)))))
        if s.kind == "cfd":
            printed = (against_printed(s, r, sets[s.campaign]) for r in study.references if r.body == s.body)
            out += [v for v in printed if v is not None]
    return tuple(out)


def against_printed(s: Budget, reference: Reference, among: CoefficientSet) -> Validation | None:
    """S against the derivative that a source prints by another method, with the uncertainty that it states; None without one.

    Parameters
    ----------
    s : Budget
        Of the computation.
    reference : Reference
    among : CoefficientSet
        Of the computation: its length and reference point.
    """
    symbol, point = s.symbol.removesuffix("'"), reference.reference_point
    if point is not None and not np.allclose(point, among.reference_point, atol=1e-6):
        return None
    for kind in reference.literature:
        for v in kind.values:
            if v.symbol == symbol and v.value is not None:
                half = abs(v.value) * kind.uncertainty
                d = replace(
                    s, campaign=f"{reference.name}, {kind.method}{AS_PRINTED}", value=v.value, u95=half, parts=(), unassessed=(), kind="literature",
                )  # fmt: skip
                return replace(validation(s, d, reference.scaling.ratio(symbol, among.scaling)), method=kind.method)
    return None


def by_measured_number(found: Sequence[Validation]) -> tuple[tuple[Validation, ...], ...]:
    """Comparisons with a verdict, those of one measured number together; it counts once, and holds where every one does."""
    groups: dict[tuple[str, str], list[Validation]] = {}
    for v in found:
        if v.within is not None:
            groups.setdefault((v.experiment, v.symbol), []).append(v)
    return tuple(map(tuple, groups.values()))


def reynolds_of(study: Study, campaign: str, length: float) -> float | None:
    """Median over the rows of a campaign, on that length; the number that its source states where the viscosity is not known."""
    tables: list[ForceTable] = [t for t in study.tables if t.campaign == campaign]
    rows = [r for t in tables if (r := t.reynolds(length)) is not None]
    return float(np.median(np.concatenate(rows))) if rows else None


def validation(
    s: Budget, d: Budget, ratio: float = 1.0, reynolds: tuple[float | None, float | None] = (None, None)
) -> Validation:
    """S against D; ``ratio`` brings D to the length that S is primed by; Reynolds numbers of both as in `Validation`."""
    return Validation(
        symbol=s.symbol,
        body=s.body,
        simulation=s.campaign,
        experiment=d.campaign,
        computed=s.value,
        measured=d.value * ratio,
        u_measured=None if d.u95 is None else d.u95 * abs(ratio),
        u_numerical=s.joined(*NUMERICAL),
        u_reduction=s.joined(*REDUCTION),
        u_input=s.input,
        lacking=(*s.unassessed, *([] if s.model_spread is None else [MODEL])),
        lacking_measured=d.unassessed,
        reynolds=reynolds,
        open_grid=s.open_grid,
    )


def _alike(a: CoefficientSet, b: CoefficientSet) -> bool:
    return a.datum == b.datum and bool(np.allclose(a.reference_point, b.reference_point, atol=1e-6))
