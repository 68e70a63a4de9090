"""From tables to coefficients: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from coeflab.fits.results.fit_result import FitResult
    from coeflab.law.scaling import Scaling
    from coeflab.tables.force_table import ForceTable


@runtime_checkable
class Fit(Plugin, Protocol):
    """Turns the tables of one campaign into coefficients.

    Attributes
    ----------
    joins_campaigns : bool
        Whether the tables may be of several campaigns.
    reads_series : bool
        Whether it takes oscillating runs, and nothing else.
    """

    joins_campaigns: bool = False
    reads_series: bool = False

    def fit(self, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
        """Coefficients with their uncertainty.

        Parameters
        ----------
        tables : sequence of ForceTable
        scaling : Scaling
            Length of the primes.
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...


@runtime_checkable
class CompletingFit(Fit, Protocol):
    """A fit of what another one leaves out; ``completes`` names that, and a study hands over its result."""

    completes: str

    def complete(
        self, found: FitResult, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]
    ) -> FitResult:
        """As `fit`, with the result of the other fit over the same tables.

        Parameters
        ----------
        found : FitResult
        tables : sequence of ForceTable
        scaling : Scaling
        options : mapping of str to value
        """
        ...


FITS = Registry("coeflab.fits", "fit", Fit, __name__)  # type: ignore[type-abstract]
