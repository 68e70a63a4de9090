"""What was found about a number, as data: a code, numbers and names. The words stand in `coeflab.core.texts`, found by the code."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any, NamedTuple

from coeflab.core.stored import Choice, Finite, Means, Name, Words, stored
from coeflab.core.types import in_angles


class Severity(StrEnum):
    """How much a finding matters; only `FAIL` makes the exit code 1."""

    PASS = "pass"
    NOTE = "note"
    WARN = "warn"
    FAIL = "fail"


@stored()
class Fact(NamedTuple):
    """A number or a name that a finding is about."""

    name: Annotated[Name, Means("which")]
    value: Annotated[float | int | str | tuple[float | int | str, ...], Means("number, name, or several", "SI")]


@stored("code subject severity statistic? threshold? advice? facts?")
@dataclass(frozen=True, slots=True)
class Finding:
    """What was found, as data.

    Attributes
    ----------
    code : str
        ``subject.what``: key of its words in ``coeflab/core/texts/<subject>.toml``.
    subject : str
        What it is about: a coefficient, table, body, file or target.
    severity : Severity
    statistic, threshold : float or None
        What was computed, and what it was held against.
    advice : str
        What to type to mend it: a key with its value, an option, a command. Never a sentence.
    facts : tuple of Fact
        Further numbers and names.

    Examples
    --------
    >>> found = Finding.of("finding.example", "drift", Severity.WARN, statistic=0.19, threshold=0.05, rows=(80, 81))
    >>> found["rows"]
    (80, 81)
    """

    code: Annotated[Name, Means("subject.what: which finding")]
    subject: Annotated[Words, Means("what it is about: a coefficient, table, body, file or target")]
    severity: Annotated[Severity, Choice(tuple(Severity), Severity), Means("pass, note, warn or fail")]
    statistic: Annotated[Finite | None, Means("what was computed", "of its code, SI")] = None
    threshold: Annotated[Finite | None, Means("what it was held against", "as the statistic")] = None
    advice: Annotated[str, Means("what to type to mend it")] = ""
    facts: Annotated[tuple[Fact, ...], Means("further numbers and names")] = ()

    @classmethod
    def of(
        cls,
        code: str,
        subject: str,
        severity: Severity,
        *,
        statistic: float | None = None,
        threshold: float | None = None,
        advice: str = "",
        **facts: Any,
    ) -> Finding:
        """A finding with its facts by keyword; lists become tuples.

        Parameters
        ----------
        code, subject, severity, statistic, threshold, advice
            As the fields.
        **facts
            Numbers, names, or several of them.
        """
        held = tuple(Fact(name, tuple(value) if isinstance(value, list) else value) for name, value in facts.items())
        return cls(code, subject, severity, statistic, threshold, advice, held)

    def __getitem__(self, name: str) -> Any:
        """A fact by its name."""
        for fact in self.facts:
            if fact.name == name:
                return fact.value
        raise KeyError(name)

    def __repr__(self) -> str:
        return in_angles(self, f"{self.severity}, {self.code}: {self.subject}")


def worst(found: Iterable[Finding]) -> Severity:
    """The gravest severity; `PASS` of none.

    Examples
    --------
    >>> str(worst([]))
    'pass'
    """
    order = list(Severity)
    return max((f.severity for f in found), key=order.index, default=Severity.PASS)
