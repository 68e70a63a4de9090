"""A publication beside what we find: what a number is held against, what comes out, and whether it holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Protocol

from coeflab.kernels.brief import brief

Basis = Literal["printed", "derived", "in-sample"]
BASES: dict[Basis, str] = {
    "printed": "a number that the paper prints",
    "derived": "worked out independently from what the paper prints, or by theory; the paper does not print it",
    "in-sample": "the model was calibrated on this very number, so that meeting it proves nothing new",
}


@brief
@dataclass(frozen=True, slots=True)
class Compared:
    """One number of ours and what it is held against.

    Attributes
    ----------
    case, quantity : str
        Row and column of the table, for example ``0, 60 %`` and ``u``.
    unit : str
        ``1`` for numbers without one.
    against : float
        What it is held against; ``basis`` says where that comes from.
    found : float or None
        None where the computation gave no number.
    tolerance : float
        Largest difference that counts as agreement: of ``unit``, or a ratio where ``relative``.
    basis : {"printed", "derived", "in-sample"}
    relative : bool
    at_most : bool
        Whether ``against`` is a limit that ``found`` must not exceed.
    """

    case: str
    quantity: str
    unit: str
    against: float
    found: float | None
    tolerance: float
    basis: Basis = "printed"
    relative: bool = False
    at_most: bool = False

    @property
    def difference(self) -> float | None:
        """Found less what it is held against; over that where ``relative``."""
        if self.found is None:
            return None
        apart = self.found - self.against
        return apart / abs(self.against) if self.relative and self.against else apart

    @property
    def holds(self) -> bool:
        """Whether the difference is no larger than the tolerance, for a limit to the upper side only."""
        if self.difference is None:
            return False
        return (self.difference if self.at_most else abs(self.difference)) <= self.tolerance


@brief
@dataclass(frozen=True, slots=True)
class ComparedTable:
    """Rows of one published table or figure.

    Attributes
    ----------
    key : str
        Short, for JSON: ``steady_turns``.
    title : str
    rows : tuple of Compared
    source : str
        Table, figure or equation of the publication.
    statements : tuple of str
        What a reader has to know, in words.
    """

    key: str
    title: str
    rows: tuple[Compared, ...]
    source: str
    statements: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether every row does."""
        return all(r.holds for r in self.rows)


class Drawing(Protocol):
    """A figure as the report knows it; here it is only handed on."""

    @property
    def anchor(self) -> str:
        """Unique in the report."""

    @property
    def svg(self) -> str:
        """One ``<svg>`` element."""

    @property
    def title(self) -> str:
        """A short name."""

    @property
    def caption(self) -> str:
        """What it shows."""

    @property
    def description(self) -> str:
        """The same for readers who cannot see it."""

    @property
    def panels(self) -> tuple[Any, ...]:
        """The numbers behind it."""


@brief
@dataclass(frozen=True, slots=True)
class Acceptance:
    """A publication reproduced.

    Attributes
    ----------
    name, title : str
    tables : tuple of ComparedTable
    errata : tuple of str
        Errors of the publication, each with what stands in their place.
    statements : tuple of str
    citations : tuple of str
    figures : tuple of (str, Drawing)
        File name without ending, and the drawing.
    conventions : tuple of str
        Axes, signs and units of its own, beside those that hold for every report.
    """

    name: str
    title: str
    tables: tuple[ComparedTable, ...]
    errata: tuple[str, ...]
    statements: tuple[str, ...]
    citations: tuple[str, ...]
    figures: tuple[tuple[str, Drawing], ...] = ()
    conventions: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether every table does."""
        return all(t.holds for t in self.tables)
