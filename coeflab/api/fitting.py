"""`fit`: coefficients of tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.api.questions import above_zero
from coeflab.api.reading import read_tables
from coeflab.api.result import Result
from coeflab.core.errors import InputError
from coeflab.core.machine import one_thread
from coeflab.core.texts import input_error
from coeflab.fits import FITS, JOINT, USUAL
from coeflab.fits.joint.one_point import one_length
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.scaling import Scaling, require_hull
from coeflab.study.fitting import fitted, refuse_empty, rejoined
from coeflab.tables.force_table import ForceTable
from coeflab.tables.planar_motion import PlanarMotionTable
from coeflab.tables.reading import suited_fit

ARRAYS_NAME = "table"  # of arrays that nobody named


def fit(
    tables: str | Path | ForceTable | Sequence[str | Path | ForceTable],
    by: str = "",
    *,
    length: float | str | None = None,
    length_name: str | None = None,
    include_uncertain: bool = False,
    **options: Any,
) -> Result:
    """Coefficients of one table or several, with U95.

    Parameters
    ----------
    tables : Table, str, Path or sequence of these
        From `coeflab.read_table`, or what that reads without keywords.
    by : str
        Name of the fit; by default ``slope_at_origin``, the recommended slopes, of each campaign by itself: two campaigns that both
        give Yv' are not pooled, ``result.of("drift")["Yv'"]`` is that of one. ``terms=[...]`` or ``"manoeuvring_model"`` fits all tables
        jointly. Names: ``cf.plugins("fits")``.
    length : float or str, optional
        Of the primes, m; the tables' own unless given.
    length_name : str, optional
        Of that length, such as LOA.
    include_uncertain : bool
        Use cells that the source marks as doubtful.
    **options
        Of the fit, as ``cf.plugins("slope_at_origin")`` lists them, angles in degrees or with a unit: ``cf.fit(drift, largest_angle="6 deg")``,
        ``cf.fit(drift, "polynomial", variable="beta", degree=3)``, ``cf.fit(drift, terms=["Yv", "Yv|v|"])``. A list of
        terms trusts its form: of six rates Yr' may have a U95 of 5 %, where the recommended slope, which holds every smooth
        form, has 37 %.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        Too few points, an option that the fit has not, tables of other kinds.
    ScalingMismatchError
        Tables of other lengths or points in a joint fit.

    Examples
    --------
    >>> import numpy as np
    >>> import coeflab as cf
    >>> v = np.linspace(-0.3, 0.3, 9)
    >>> drift = cf.read_table(
    ...     {"v [m/s]": v, "Y [N]": -120.0 * v, "N [N m]": -60.0 * v}, name="drift",
    ...     frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft",
    ... )
    >>> round(cf.fit(drift)["Yv'"].value, 6)
    -0.03
    """
    every = (
        [tables] if isinstance(tables, str | Path | ForceTable) or not isinstance(tables, Sequence) else list(tables)
    )
    if not every:
        raise InputError("no table", "a table, or several", column="tables")
    read: list[ForceTable] = [t for one in every for t in read_tables(one)]
    read = _distinct(read)
    names = [t.name for t in read]
    if twice := next((n for n in names if names.count(n) > 1), None):
        raise input_error("front_door.table_twice", column="tables", twice=twice)
    if include_uncertain:
        read = [t.with_uncertain_cells() for t in read]
    by = by or (JOINT if "terms" in options else _suited(every))
    given = {k: list(v) if isinstance(v, tuple) else v for k, v in options.items()}
    scaling = None
    if (length is None) != (length_name is None):
        raise InputError(
            "length without its name" if length else "length_name alone", "length and length_name", column="length"
        )
    if length is not None:
        require_hull(length, "length")
        scaling = Scaling(above_zero(length, "length", "length"), str(length_name))
    with one_thread():
        if FITS.load(by).joins_campaigns:
            return _given([fitted(by, read, scaling or one_length(read), given)[0]], read)
        by_campaign = [[t for t in read if t.campaign == c] for c in dict.fromkeys(t.campaign for t in read)]
        asked = [(by, own, scaling or own[0].scaling, given) for own in by_campaign]
        return _given(rejoined([fitted(*one)[0] for one in asked], asked, unnamed_alike=True), read)


def _given(fits: Sequence[FitResult], read: Sequence[ForceTable]) -> Result:
    refuse_empty(fits)
    return Result(tuple(fits), tuple(read))


def _distinct(tables: Sequence[ForceTable]) -> list[ForceTable]:
    """Tables of arrays that nobody named, by what they vary, else by their number; one that stands twice stays twice."""
    unnamed = f"{ARRAYS_NAME}/{ARRAYS_NAME}"
    nameless = [t for t in tables if t.name == unnamed]
    if len(nameless) < 2 or any(_alike(a, b) for i, a in enumerate(nameless) for b in nameless[:i]):
        return list(tables)
    over = ["_".join(t.varies) for t in nameless]
    tails = over if len(set(over)) == len(over) else [str(i) for i in range(1, len(over) + 1)]
    own = iter(tails)
    out = []
    for t in tables:
        called = f"{ARRAYS_NAME}_{next(own)}" if t.name == unnamed else ""
        out.append(replace(t, campaign=called, name=f"{called}/{called}") if called else t)
    return out


def _alike(a: ForceTable, b: ForceTable) -> bool:
    """Whether two tables hold the same rows."""
    both = ({**a.motion, **a.forces, **a.controls}, {**b.motion, **b.forces, **b.controls})
    return both[0].keys() == both[1].keys() and all(
        np.array_equal(x, both[1][k], equal_nan=True) for k, x in both[0].items()
    )


def _suited(every: Sequence[Any]) -> str:
    """The fit that the first campaign is for, as its importer says."""
    from coeflab.core.files import located

    first = every[0]
    if isinstance(first, PlanarMotionTable):
        return next(name for name in FITS.usable() if FITS.load(name).reads_series)
    return suited_fit(located(first, "cfd_data")) if isinstance(first, str | Path) else USUAL
