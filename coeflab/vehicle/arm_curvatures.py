"""Xrr and Xqq of a rotating arm off the file's point, where nothing but the ideal fluid says what Xvr and Xwq are.

Runs about one other point drift by one ratio k to their rate, so that they give Xrr + k Xvr alone (`coeflab.fits.tied_law`). A file
with added mass adds Xvr by the ideal fluid: its share is taken off Xrr, and the law meets the runs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from coeflab.core.finding import Finding
from coeflab.fits.tied_law import ONE_RATIO
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.coefficient import Coefficient
from coeflab.law.scaling import Scaling


def less_ideal_products(
    coefficients: Sequence[Coefficient], findings: Sequence[Finding], hull: AddedMass | None, scaling: Scaling
) -> tuple[list[Coefficient], list[Finding]]:
    """Coefficients without what the ideal fluid makes of the products of drift and rate, and the findings that say so.

    Parameters
    ----------
    coefficients : sequence of Coefficient
        Primed.
    findings : sequence of Finding
        Of the fits.
    hull : AddedMass or None
        About the point of the coefficients.
    scaling : Scaling
    """
    stated = {c.symbol.removesuffix("'") for c in coefficients if c.value is not None}
    taken: dict[str, float] = {}
    out = []
    for f in findings:
        if f.code != ONE_RATIO or hull is None or f["product"].removesuffix("'") in stated or f["symbol"] not in stated:
            out.append(f)
            continue
        ideal = potential_part(f["product"], hull, scaling, hull.density) or 0.0
        taken[f["symbol"]] = float(f.statistic or 0.0) * ideal
        out.append(
            Finding.of(
                f.code,
                f.subject,
                f.severity,
                statistic=f.statistic,
                by="ideal",
                symbol=f["symbol"],
                product=f["product"],
                taken=ideal,
            )
        )
    less = [
        c if c.value is None or c.symbol not in taken else replace(c, value=c.value - taken[c.symbol])
        for c in coefficients
    ]
    return less, out
