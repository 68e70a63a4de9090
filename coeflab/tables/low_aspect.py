"""The slope of a side force held against that of a lifting surface as deep as the body: primes by another area stand out by it.

A surface of small aspect ratio has the lift slope pi/2 times its aspect ratio (Jones 1946), so its force is 1/2 rho U^2 (pi/2) b^2 v' for a
span b whatever its chord. A body in deep water has its depth as span: Yv' = -(pi/2) (D/L)^2. One at the surface has its image as well, twice the
draught of which half is wet: -pi (T/L)^2. Sails, keels and fins add to it; three times as much no body of that depth has.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from coeflab.core.axes import Axes, parse_axes
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import words
from coeflab.core.types import Array
from coeflab.core.units import quantity
from coeflab.tables.evidence import Evidence, frd_column
from coeflab.tables.mapping import Assigned
from coeflab.tables.settings import Settings

LARGEST = 3.0
SMALL = np.radians(8.0)  # drift up to which the slope is taken


def low_aspect_slope(size: str, depth: float, length: float) -> float:
    """|Yv'| by L^2 of a surface of low aspect ratio.

    Parameters
    ----------
    size : str
        ``T``, a draught below the surface of the water, or ``D``, a depth in deep water.
    depth, length : float
        m.

    Examples
    --------
    >>> round(low_aspect_slope("T", 0.25, 4.0), 5), round(low_aspect_slope("D", 0.508, 4.356), 5)
    (0.01227, 0.02136)
    """
    return float((np.pi if size == "T" else np.pi / 2.0) * (depth / length) ** 2)


def above_low_aspect(
    columns: Sequence[Assigned],
    frame: Axes | None,
    sizes: Mapping[str, float],
    places: Mapping[str, str],
    settings: Settings,
) -> Iterator[Evidence]:
    """A warning where Yv' is larger than any body of the stated draught or diameter has.

    Parameters
    ----------
    columns : sequence of Assigned
    frame : Axes, optional
    sizes, places : mappings
        Of the body by their letters, and the words that say them.
    settings : mapping of str to Setting
    """
    depths = {name: sizes[name] for name in ("T", "D") if name in sizes}
    slope = _slope(columns, frame or parse_axes("FRD"), settings)
    if slope is None or not depths or "L" not in sizes:
        return
    size, limit = max(((n, low_aspect_slope(n, d, sizes["L"])) for n, d in depths.items()), key=lambda one: one[1])
    if abs(slope) <= LARGEST * limit:
        return
    found = Finding.of(
        "prime_basis.above_low_aspect", "table", Severity.WARN, statistic=abs(slope), threshold=LARGEST * limit,
        advice="--set coefficients.area=", length=sizes["L"], limit=limit, depth=depths[size], words=places[size],
        size={"T": "draught", "D": "diameter"}[size],
    )  # fmt: skip
    text = words(found)
    yield Evidence(f"{text.statement}. {text.advice}", warns=True)


def _slope(columns: Sequence[Assigned], frame: Axes, settings: Settings) -> float | None:
    """Yv' by L^2 through the rows of small drift; None without such rows or sizes."""
    side = frd_column(columns, "Y", frame)
    drift = next((c for c in columns if c.meaning.name == "beta"), None) or frd_column(columns, "v", frame)
    if side is None or drift is None or "scaling.length" not in settings:
        return None
    try:
        length = quantity(settings["scaling.length"].value, "length")
        y = side.values
        unit: Array | float = 1.0
        if side.meaning.area:
            unit = length**2 / side.meaning.area
        elif not side.meaning.pure:
            unit = (
                0.5
                * _of(columns, "density", "conditions.density", settings)
                * _of(columns, "U", "conditions.speed", settings) ** 2
                * length**2
            )
        x = np.sin(drift.values) if drift.meaning.name == "beta" else drift.values
        if drift.meaning.name != "beta" and not drift.meaning.primed:
            x = x / _of(columns, "U", "conditions.speed", settings)
    except (InputError, KeyError):
        return None
    y = y / unit
    rows = np.isfinite(x) & np.isfinite(y) & (np.abs(x) <= np.sin(SMALL))
    if np.count_nonzero(rows) < 2 or not np.ptp(x[rows]) > 0.0:
        return None
    return float(np.polyfit(x[rows], y[rows], 1)[0])


def _of(columns: Sequence[Assigned], name: str, key: str, settings: Settings) -> Array | float:
    """A column in SI, else the number of the campaign."""
    column = next((c for c in columns if c.meaning.name == name), None)
    return column.values if column is not None else quantity(settings[key].value, {"U": "speed"}.get(name, name))
