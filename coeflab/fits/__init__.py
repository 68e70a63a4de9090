"""From tables to coefficients: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

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
    printed_inside : callable or None
        ``printed_inside(result)``: how many coefficients that its options name as printed lie inside the fitted 95 % intervals,
        and how many are printed.
    """

    joins_campaigns: bool = False
    reads_series: bool = False
    printed_inside: Callable[[FitResult], tuple[int, int]] | None = None

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

# What fits a table, and several campaigns together, where nobody names a fit. No attribute of the plugins: an installed package
# must not change the numbers of a plan that names none.
USUAL = "slope_at_origin"
BY_DEFAULT = (USUAL, "tied_law")
JOINT = "manoeuvring_model"
