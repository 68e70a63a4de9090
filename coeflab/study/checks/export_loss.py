"""Exports whose force is further from the parameter file's than no force at all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.wording import listed

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "components of an export that are further from the parameter file than no force at all"
citations = ("fossen2011",)


def check(study: Study) -> Sequence[Check]:
    """A warning for each export with such a component; an export that loses less is told of beside its files."""
    return [
        Check.of(
            "export_loss.worse", f"{result.parameters} for {result.target}", Severity.WARN, target=result.target,
            components=listed(result.loss.worse_than_nothing),
        )
        for result in study.exports
        if result.loss is not None and result.loss.worse_than_nothing
    ]  # fmt: skip
