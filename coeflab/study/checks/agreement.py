"""Two campaigns of one body that give the same coefficient: do they agree within their uncertainties?"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check, plus_minus
from coeflab.law.symbols import primed

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "the same coefficient from two campaigns against the combined U95"
citations = ("ittc_uncertainty",)


def check(study: Study) -> Sequence[Check]:
    """One finding per pair of campaigns and coefficient."""
    out = []
    kinds = {t.campaign: t.source.kind for t in study.tables}
    for a, b in combinations(study.fits, 2):
        if a.campaign == b.campaign or a.body != b.body or a.coefficients.datum != b.coefficients.datum:
            continue
        if not np.allclose(a.coefficients.reference_point, b.coefficients.reference_point, atol=1e-9):
            continue
        for c in a.coefficients.coefficients:
            if c.symbol not in b.coefficients:
                continue
            d = b.coefficients.to_length(a.coefficients.scaling)[c.symbol]
            if c.parts.model_form is None or d.parts.model_form is None:
                continue
            if c.value is None or d.value is None or c.u95 is None or d.u95 is None:
                continue
            difference, combined = abs(c.value - d.value), float(np.hypot(c.u95, d.u95))
            agree = difference <= combined
            both_cfd = kinds.get(a.campaign) == kinds.get(b.campaign) == "cfd"
            cause = "agree" if agree else "cfd" if both_cfd else "tests"
            out.append(Check.of(
                "agreement.value", f"{primed(c.symbol)} {a.campaign}, {b.campaign}", Severity.PASS if agree else Severity.WARN,
                one=plus_minus(c.value, c.u95), other=plus_minus(d.value, d.u95), apart=difference, u95=combined, cause=cause,
            ))  # fmt: skip
    return out
