"""Responses with too few usable rows: a finding on each, and the others keep their numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.law.symbols import primed

FEW_ROWS = "sweep.few"
MORE = "Run more points or ask for fewer terms."
Fitted = TypeVar("Fitted")


class TooFewRowsError(InputError):
    """Too few usable rows of a response for its terms.

    Attributes
    ----------
    response : str
    labels : tuple of str
        Of the rows.
    needed : int
        Rows at least.
    """

    def __init__(
        self, found: str, expected: str, response: str, labels: Sequence[str], needed: int, *, column: str, advice: str = MORE
    ) -> None:  # fmt: skip
        self.response, self.labels, self.needed = response, tuple(labels), needed
        super().__init__(found, expected, column=column, advice=advice)

    @classmethod
    def for_terms(
        cls, response: str, labels: Sequence[str], terms: int, column: str, what: str = "terms"
    ) -> TooFewRowsError:
        """No more rows than terms, or none at all."""
        if not labels:
            return cls(
                f"no usable rows for {response}", "rows in which only motions of its terms occur", response, (), terms + 1, column=column,
                advice="Add terms in the motions that the tables vary.",
            )  # fmt: skip
        found = f"{len(labels)} usable rows for {terms} {what} of {response}"
        return cls(found, "more rows than terms", response, labels, terms + 1, column=column)

    def finding(self, subject: str, symbols: Sequence[str] = ()) -> Finding:
        """The same of one response among several.

        Parameters
        ----------
        subject : str
            Campaign.
        symbols : sequence of str
            That have no value for it; the response unless given.
        """
        names = [primed(s) for s in symbols] or [self.response]
        return Finding.of(
            FEW_ROWS, subject, Severity.WARN, statistic=len(self.labels), threshold=self.needed, advice=self.response, by="terms",
            variable=self.response, combined=0, rows=self.labels, symbols=names,
        )  # fmt: skip


def each_with_rows(
    names: Sequence[str], make: Callable[[str], Fitted], subject: str
) -> tuple[tuple[Fitted, ...], tuple[Finding, ...]]:
    """What is made of each response, and findings on those with too few rows.

    Raises
    ------
    TooFewRowsError
        All of them have too few.
    """
    out, few = list[Fitted](), list[TooFewRowsError]()
    for name in names:
        try:
            out.append(make(name))
        except TooFewRowsError as why:
            few.append(why)
    if few and not out:
        raise few[0]
    return tuple(out), tuple(why.finding(subject) for why in few)
