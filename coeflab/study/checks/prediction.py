"""Whether a fitted model predicts a row that it has not seen better than the mean of the others does."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "left-out rows of fitted models against their own scatter"
citations = ("allen1974",)


def check(study: Study) -> Sequence[Check]:
    """A warning for every model that predicts left-out rows worse than their mean."""
    out = []
    for model in (m for f in study.fits for m in f.models):
        spread, error = float(np.std(model.y)), model.fit.press_rms
        if model.is_constant:  # a constant: without a row its mean always misses by more than the scatter
            continue
        if not isfinite(error) or not spread > 0.0 or error <= spread:
            continue
        subject = f"{model.campaign} {model.response}"
        out.append(Check.of("prediction.missed", subject, Severity.WARN, statistic=error / spread))
    return out
