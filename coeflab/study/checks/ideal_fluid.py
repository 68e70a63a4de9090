"""Whether estimates of the ideal fluid and the added mass of their parameter file are one body's."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.wording import listed
from coeflab.law.symbols import derivative

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.vehicle.parameter_file import ParameterFile

summary = "estimates of the ideal fluid against the potential part that the added mass gives"
citations = ("lamb1932", "fossen2011")

ROUNDING, WHOLE = 1e-6, 1e-6


def check(study: Study) -> Sequence[Check]:
    """Value and potential part of every estimate that is ideal fluid alone.

    A body of bluff parts takes both from one matrix. Of a hull with fins they are two estimates, by sections and by the added
    mass of the whole, and agree within U95.
    """
    if study.shape is None:
        return []
    from coeflab.estimates import every_way

    seen = study.shape.weighed.body.outline
    one = seen is not None and every_way(seen)
    shares = study.shape.estimates.shares
    return [c for p in study.parameter_files.values() for c in _of_file(p, shares, one)]


def _of_file(parameters: ParameterFile, shares: dict[str, dict[str, float]], one: bool) -> list[Check]:
    from coeflab.estimates import IDEAL

    found, apart = [], []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or c.potential is None or c.status != "estimate" or "|" in d.text or d.text not in shares:
            continue
        ideal = sum(v for part, v in shares[d.text].items() if part.endswith(f", {IDEAL}"))
        if abs(ideal - c.value) > WHOLE * abs(c.value):
            continue
        found.append(c.symbol)
        if abs(c.value - c.potential) > (ROUNDING * abs(c.potential) if one else c.u95 or 0.0):
            apart.append(f"{c.symbol} = {c.value:.4g}, potential {c.potential:.4g}")
    if not found:
        return []
    bad = Severity.FAIL if one else Severity.WARN
    return [Check.of(
        "ideal_fluid.one_matrix", parameters.name, bad if apart else Severity.PASS, apart=listed(apart or [""]), symbols=listed(found),
        match="bad" if apart else "good", within="" if one else " within U95",
    )]  # fmt: skip
