"""Coefficients identified from motions, beside those of a parameter file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import hypot

from coeflab.core.finding import Finding
from coeflab.core.types import brief

HOW = "Interval: 95 %, the scatter over stretches of the series (jackknife, Student) and the effect of one more term of the library. It leaves out what a wrong mass, inertia or thrust would change. In simulated series with white noise of 1 to 5 % such intervals contained the true value in 94 to 97 of 100 cases where the terms were given (docs/fixed_forms.md)."


class Outcome(StrEnum):
    """What the motions say of a term."""

    IDENTIFIED = "identified"
    BIASED = "biased"
    EXCHANGEABLE = "exchangeable"
    NOT_NEEDED = "not needed"
    NOT_IDENTIFIABLE = "not identifiable"

    @property
    def meaning(self) -> str:
        """In words."""
        return {
            Outcome.IDENTIFIED: "needed, and no other term of the library does as well",
            Outcome.BIASED: "needed, but neighbouring rows share their noise, and the value has its bias",
            Outcome.EXCHANGEABLE: "needed, but another term does as well, so the value is not the term's alone, and the other values of its component depend on the choice",
            Outcome.NOT_NEEDED: "excited, but zero within three times its scatter beside the other terms",
            Outcome.NOT_IDENTIFIABLE: "the series do not excite it, or only together with another term",
        }[self]


class Verdict(StrEnum):
    """An identified value against that of the file."""

    WITHIN = "within U95"
    WITHIN_BOTH = "within both"
    OUTSIDE = "outside"
    NO_U95 = "no U95 in the file"
    NOT_IN_FILE = "not in the file"
    NONE = ""


@brief
@dataclass(frozen=True, slots=True)
class IdentifiedTerm:
    """One candidate.

    Attributes
    ----------
    symbol : str
        SNAME, with prime.
    component : str
    outcome : Outcome
    why : str
        Of the outcome, in words; may be empty.
    value : float or None
        Primed by the file's scaling; None where the motions give none.
    low, high : float or None
        See `HOW`; None where there are too few stretches, or another term does as well in its place.
    frequency : float or None
        Share of the resamples whose sparse fit keeps the term; None where it was not among those fitted.
    file_value, file_u95 : float or None
    file_source : str
        ``fit``, ``literature`` or ``ideal fluid``.
    """

    symbol: str
    component: str
    outcome: Outcome
    why: str = ""
    value: float | None = None
    low: float | None = None
    high: float | None = None
    frequency: float | None = None
    file_value: float | None = None
    file_u95: float | None = None
    file_source: str = ""

    @property
    def half(self) -> float | None:
        """Half of the interval."""
        return None if self.low is None or self.high is None else (self.high - self.low) / 2.0

    @property
    def verdict(self) -> Verdict:
        """Only for what was identified by itself."""
        if self.outcome is not Outcome.IDENTIFIED or self.value is None:
            return Verdict.NONE
        if self.file_value is None:
            return Verdict.NOT_IN_FILE
        if self.file_u95 is None:
            return Verdict.NO_U95
        apart = abs(self.value - self.file_value)
        if apart <= self.file_u95:
            return Verdict.WITHIN
        return Verdict.WITHIN_BOTH if self.half and apart <= hypot(self.file_u95, self.half) else Verdict.OUTSIDE


@dataclass(frozen=True, slots=True)
class Balanced:
    """How one component came out.

    Attributes
    ----------
    component : str
    threshold : float or None
        Of the sparse fit, scaled; None where there was nothing to fit.
    left : float or None
        Root mean square of the unexplained force over that of the force, free of noise.
    stretches : int
        Of time, which the resamples are drawn from.
    """

    component: str
    threshold: float | None
    left: float | None
    stretches: int


@brief
@dataclass(frozen=True, slots=True)
class Identified:
    """Everything that came out.

    Attributes
    ----------
    name : str
        Of the parameter file.
    series : tuple of str
        Names of the files.
    method : str
        ``weak form`` or ``derivative form``.
    half : float
        Half of a window, s.
    seed, resamples : int
    terms : tuple of IdentifiedTerm
    balances : tuple of Balanced
    statements : tuple of str
    findings : tuple of Finding
        Fitted tables of the file that are not used, for terms that were tried speak of the same.
    """

    name: str
    series: tuple[str, ...]
    method: str
    half: float
    seed: int
    resamples: int
    terms: tuple[IdentifiedTerm, ...]
    balances: tuple[Balanced, ...]
    statements: tuple[str, ...]
    findings: tuple[Finding, ...] = ()

    def __getitem__(self, symbol: str) -> IdentifiedTerm:
        wanted = symbol.removesuffix("'") + "'"
        return next(t for t in self.terms if t.symbol == wanted)

    @property
    def found(self) -> tuple[IdentifiedTerm, ...]:
        """Terms with a value."""
        return tuple(t for t in self.terms if t.value is not None)

    @property
    def failed(self) -> bool:
        """Whether no term has a value of its own: none has any, or those needed are biased."""
        outcomes = {t.outcome for t in self.found}
        return Outcome.IDENTIFIED not in outcomes and (Outcome.BIASED in outcomes or not outcomes)


def together_in_words(symbols: Sequence[str]) -> str:
    """Terms that do as well in the place of one."""
    return f"{' or '.join(symbols)} would do as well"
