"""A published column that nothing of the study stands beside is named, with the key that keeps it apart."""

from __future__ import annotations

from dataclasses import replace

import pytest

from coeflab.core.finding import Severity
from coeflab.study.checks.published_columns import check
from coeflab.study.study import Study
from coeflab.vehicle.published_values import Relation


def test_the_shipped_columns_all_stand_beside_something(suboff: Study) -> None:
    assert check(suboff) == []


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"campaigns": ("suboff_roddy_9",)}, 'Write campaigns = ["suboff_roddy_'),
        ({"relation": Relation.CROSS_BODY, "body": "another"}, 'Write body = "suboff_'),
    ],
)
def test_the_key_is_named(suboff: Study, changed: dict[str, object], says: str) -> None:
    """Before: "no published evaluation of these data", and nothing else."""
    odd = next(r for r in suboff.references if r.relation is Relation.RE_ANALYSIS)
    odd = replace(odd, name="odd", **changed)
    (found,) = check(replace(suboff, references=(*suboff.references, odd)))
    assert (found.subject, found.severity) == ("odd", Severity.WARN)
    assert found.comment.startswith(says)
