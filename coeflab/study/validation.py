"""Validation of a computation against an experiment: comparison error against validation uncertainty.

ASME V&V 20-2009, section 1-5; ITTC 7.5-03-01-01: E = S - D, U_V^2 = U_D^2 + U_SN^2 + U_input^2. When |E| lies within
U_V, a modelling error cannot be told from the uncertainties; otherwise E is about the modelling error, known to U_V.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import brief
from coeflab.fits.uncertainty.budget import Budget
from coeflab.law.coefficient import CoefficientSet
from coeflab.study.study import Study
from coeflab.tables.force_table import STUDIES
from coeflab.vehicle.derived import INDICES, index_gradient, stability_index


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


NUMERICAL = ("random", "grid", STUDIES["domain"], STUDIES["iterations"])
MODEL = STUDIES["turbulence"]
REDUCTION = ("model form", "random and model form")
WIDE = 0.25  # of the measured or published value: a wider uncertainty passes what a reader would call a difference


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
    def within(self) -> bool | None:
        """Whether the error lies within U_V; None where there is no U_V."""
        return None if self.u_validation is None else abs(self.error) < self.u_validation

    @property
    def is_weak(self) -> bool:
        """Whether the error lies within a U_V so wide that a value far from the measured one would do so, too."""
        return bool(self.within) and (self.u_validation or 0.0) > WIDE * abs(self.measured)

    @property
    def statement(self) -> str:
        """The verdict in words."""
        if self.u_validation is None:
            return "no verdict: the measurement has no U95"
        if self.within:
            text = "|E| < U_V: no modelling error can be shown at this level of uncertainty"
        else:
            low, high = self.error - self.u_validation, self.error + self.u_validation
            text = f"|E| > U_V: modelling error, or parts that U_V lacks, between {low:.3g} and {high:.3g}"
        for side, names in (("computation", self.lacking), ("experiment", self.lacking_measured)):
            text += f"; not in U_V, {side}: {', '.join(names)}" if names else ""
        return text


def validations(study: Study, found: Sequence[Budget]) -> tuple[Validation, ...]:
    """Every pair of a computed and a measured coefficient of one body about one reference point."""
    sets = {f.campaign: f.coefficients for f in study.fits if f.sweeps}
    out = []
    for s in found:
        for d in found:
            if s.kind != "cfd" or d.kind != "experiment" or s.symbol != d.symbol or s.body != d.body:
                continue
            if not _alike(sets[s.campaign], sets[d.campaign]):
                continue
            out.append(validation(s, d, sets[d.campaign].scaling.ratio(d.symbol, sets[s.campaign].scaling)))
    return tuple(out)


def validation(s: Budget, d: Budget, ratio: float = 1.0) -> Validation:
    """S against D; ``ratio`` brings D to the length that S is primed by."""
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
        lacking=(*s.unassessed, *([] if s.part(MODEL) is None else [MODEL])),
        lacking_measured=d.unassessed,
    )


def _alike(a: CoefficientSet, b: CoefficientSet) -> bool:
    return a.datum == b.datum and bool(np.allclose(a.reference_point, b.reference_point, atol=1e-6))
