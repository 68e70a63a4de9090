"""What a check found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from coeflab.kernels.brief import brief


class Severity(StrEnum):
    """How much a finding matters; only `FAIL` makes the exit code 1."""

    PASS = "pass"
    NOTE = "note"
    WARN = "warn"
    FAIL = "fail"


@brief
@dataclass(frozen=True, slots=True)
class Check:
    """One finding.

    Attributes
    ----------
    name : str
        Plugin that made it.
    subject : str
        Campaign or parameter file, and symbol.
    severity : Severity
    statistic : str
        What was computed, with its number.
    rule : str
        What it was held against.
    comment : str
        What it means and what to do.
    """

    name: str
    subject: str
    severity: Severity
    statistic: str
    rule: str
    comment: str
