"""Findings and checks for machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coeflab.core.finding import Finding
from coeflab.core.table import Check
from coeflab.core.texts import remark


def finding_as_data(f: Finding) -> dict[str, Any]:
    """A finding as data, and its words."""
    return {
        "code": f.code, "subject": f.subject, "severity": str(f.severity), "statistic": f.statistic, "threshold": f.threshold,
        "advice": f.advice, "facts": {name: list(v) if isinstance(v, tuple) else v for name, v in f.facts}, "words": remark(f),
    }  # fmt: skip


def findings(found: Sequence[Check]) -> list[dict[str, str]]:
    """Findings of `coeflab params check`."""
    return [
        {"severity": str(c.severity), "what": c.subject, "found": c.statistic, "expected": c.rule, "means": c.comment}
        for c in found
    ]


def finding(c: Check) -> dict[str, str]:
    """One finding of a check."""
    return {
        "check": c.name, "subject": c.subject, "severity": c.severity.value, "found": c.statistic, "rule": c.rule,
        "comment": c.comment,
    }  # fmt: skip
