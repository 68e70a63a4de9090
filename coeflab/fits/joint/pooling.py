"""Campaigns of a joint fit held against each other, one component at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.types import Array
from coeflab.core.wording import finite
from coeflab.fits.joint.components import Component, Constraint
from coeflab.fits.joint.unseen_rows import predicted
from coeflab.fits.results.out_of_sample import OutOfSample, errors_of
from coeflab.fits.results.pooling import CampaignShare, Pooling
from coeflab.fits.statistics.groups import UNTOLD, poolability
from coeflab.fits.statistics.linear_model import LinearFit, fit_linear


def poolings(
    parts: Sequence[Component], constraint: Constraint, fits: Sequence[LinearFit], thirds: Sequence[OutOfSample]
) -> list[Pooling]:
    """What every campaign adds to each component, and the test of one law.

    Parameters
    ----------
    parts : sequence of Component
        Tied by ``constraint``.
    constraint : Constraint
    fits : sequence of LinearFit
        Of every part, intercepts included.
    thirds : sequence of OutOfSample
        Prediction of every third point, a part each.
    """
    origin = np.concatenate([p.data.campaign for p in parts])
    guesses = predicted(parts, constraint, origin, own=False)
    return [_pooling(*each) for each in zip(parts, fits, guesses, thirds, strict=True)]


def _pooling(part: Component, fit: LinearFit, guess: Array, third: OutOfSample) -> Pooling:
    data, y = part.data, part.data.rows.y
    alone = {k: _alone(part, k) for k in data.present}
    shares = []
    for at, k in enumerate(data.present):
        rows, place = data.campaign == k, len(part.terms) + at
        intercept = float(fit.coefficients[place]) if part.own else float("nan")
        half = float(fit.half_width[place]) if part.own else float("nan")
        noise = np.ones(1) if part.errors is None else part.errors[rows]
        shares.append(
            CampaignShare(
                campaign=data.campaigns[k],
                n_points=int(rows.sum()),
                intercept=finite(intercept),
                half_width=finite(half),
                noise=float(np.sqrt(np.mean(noise**2))),
                rms=float(np.sqrt(np.mean(fit.residuals[rows] ** 2))),
                rms_alone=alone[k].rms,
                left_out=_left_out(data.campaigns[k], y[rows], guess[rows], own=part.own),
            )
        )
    if len(shares) == 1 or part.errors is None:
        return Pooling(part.name, tuple(shares), third, UNTOLD)
    apart = [np.where((data.campaign == k)[:, None], part.matrix, 0.0) for k in data.present]
    test = poolability(part.matrix, np.column_stack(apart), y, part.errors)
    return Pooling(part.name, tuple(shares), third, test, _values_alone(part, alone))


def _alone(part: Component, campaign: int) -> LinearFit:
    """The same terms fitted to one campaign."""
    rows = part.data.campaign == campaign
    errors = None if part.errors is None else part.errors[rows]
    return fit_linear(part.matrix[rows], part.data.rows.y[rows], errors)


def _left_out(campaign: str, y: Array, guess: Array, *, own: bool) -> OutOfSample:
    """Rows of a campaign predicted from the others; its own force at rest is free where campaigns have one."""
    known = np.isfinite(guess)
    constant = float(np.mean(y[known] - guess[known])) if own and np.any(known) else 0.0
    how = f"{campaign} left out" + (", but for one constant of its own" if own else "")
    return errors_of(how, y, guess + constant)


def _values_alone(
    part: Component, alone: dict[int, LinearFit]
) -> tuple[tuple[str, tuple[tuple[str, float, float], ...]], ...]:
    """Coefficients that at least two campaigns determine by themselves, with half-widths."""
    out = []
    for i, symbol in enumerate(part.symbols):
        values = tuple(
            (part.data.campaigns[k], float(f.coefficients[i]), float(f.half_width[i]))
            for k, f in alone.items()
            if np.isfinite(f.coefficients[i])
        )
        if len(values) > 1:
            out.append((symbol, values))
    return tuple(out)
