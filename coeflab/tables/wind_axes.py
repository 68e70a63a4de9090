"""Lift, drag and side force along and across the flow, as X, Y, Z along the body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from coeflab.core.axes import Axes
from coeflab.core.errors import InputError, together
from coeflab.core.types import Array
from coeflab.law.symbols import LINEAR
from coeflab.tables.column_map import WIND
from coeflab.tables.columns import Columns, first_row
from coeflab.tables.force_table import FEWEST_SPEEDS

STRAIGHT, SIDEWAYS = 1e-12, 1e-3  # sine of an angle that is none; cosine of one beyond which Y says nothing of C


def in_body_axes(columns: Columns, axes: Axes, linear: Array) -> Columns:
    """Lift, drag and side force as X, Y, Z in the declared axes, by the flow of each row.

    With L up, D aft and C to starboard, across and along the flow, and a, b of u = U cos(a) cos(b), v = U sin(b),
    w = U sin(a) cos(b), in FRD::

        X = -D cos(a) cos(b) - C cos(a) sin(b) + L sin(a)
        Y = -D sin(b)        + C cos(b)
        Z = -D sin(a) cos(b) - C sin(a) sin(b) - L cos(a)

    Where the table has Y of the body in the place of C, C = (Y + D sin(b)) / cos(b). The flow is that of the row's angles
    or velocities, before they are moved to another point. Standard errors become the bound sum |coefficient| se, which
    holds for any correlation.

    Notes
    -----
    The matrix of flow (wind) to body axes of the Society of Flight Test Engineers, Reference Handbook (2013), 6.2.3, applied
    to (-D, C, -L).

    Raises
    ------
    InputError
        A part that X, Y or Z needs is missing: drag, lift at an incidence, the side force (or Y) at a drift angle, or the
        flow itself; X or Z of the body beside drag, or Y beside side.
    """
    sources = axes.columns
    if complaints := list(_wind_complaints(columns, {c: s for c, (s, _) in sources.items()})):
        raise together(complaints)
    u, sin_b, w = (linear / np.linalg.norm(linear, axis=1)[:, None]).T
    cos_b = np.hypot(u, w)
    inclined = cos_b > 0.0
    cos_a, sin_a = (np.divide(part, cos_b, out=np.full(len(columns), rest), where=inclined) for part, rest in ((u, 1.0), (w, 0.0)))  # fmt: skip
    result, (y, y_sign) = {"X": "drag", "Y": "side", "Z": "lift"}, sources["Y"]
    parts: dict[str, dict[str, Array]] = {
        "X": {"drag": -cos_a * cos_b, "side": -cos_a * sin_b, "lift": sin_a},
        "Y": {"drag": -sin_b, "side": cos_b},
        "Z": {"drag": -sin_a * cos_b, "side": -sin_a * sin_b, "lift": -cos_a},
    }
    if "side" not in columns.forces and y in columns.forces:
        if (row := first_row(cos_b < SIDEWAYS)) is not None:
            raise columns.fail("tables.flow_from_the_side", row=row)
        for part, along in (("X", cos_a), ("Z", sin_a)):
            of_y = {"drag": -along / cos_b, y: -y_sign * along * sin_b / cos_b}
            parts[part] = of_y | {"lift": parts[part]["lift"]}
    moved = {name: value for name, value in columns.forces.items() if name not in WIND}
    read = (columns.errors, columns.rounding)
    errors, rounding = ({name: value for name, value in x.items() if name not in WIND} for x in read)
    headers, doubtful = dict(columns.headers), [set(words) for words in columns.doubtful]
    for part, of in result.items():
        if of not in columns.forces:
            continue
        needed = {name: k for name, k in parts[part].items() if np.any(np.abs(k) > STRAIGHT)}
        if (lacking := next((n for n in needed if n not in columns.forces), "")) and lacking in WIND:
            angle, row = ("alpha", np.abs(sin_a)) if lacking == "lift" else ("beta", np.abs(sin_b))
            raise columns.fail(
                "tables.wind_part_lacks", row=int(np.argmax(row)), name=of, of=of, lacking=lacking, angle=angle,
                degrees=np.degrees(np.arcsin(min(row.max(), 1.0))), or_body=f", or {y} of the body" * (lacking == "side"), part=part,
            )  # fmt: skip
        own, sign = sources[part]
        moved[own] = sign * np.asarray(sum(k * columns.forces[name] for name, k in needed.items()))
        for moved_errors, known in zip((errors, rounding), read, strict=True):
            if all(name in known for name in needed):
                moved_errors[own] = np.asarray(sum(np.abs(k) * known[name] for name, k in needed.items()))
        headers[own] = headers.get(of, of)
        for row, words in enumerate(columns.doubtful):
            doubtful[row] |= {own} if words & set(needed) else set()
    return replace(
        columns,
        forces=moved,
        errors=errors,
        rounding=rounding,
        headers=headers,
        doubtful=tuple(map(frozenset, doubtful)),
    )


def _wind_complaints(columns: Columns, own: Mapping[str, str]) -> Iterator[InputError]:
    """What is missing or doubled beside lift, drag and side force; ``own`` maps FRD components to the table's columns."""
    wind = [c for c in WIND if c in columns.forces]
    if "drag" not in wind:
        yield columns.fail("tables.wind_without_drag", name=wind[0], wind=" and ".join(wind))
    for part, wind_part in (("X", "drag"), ("Z", "drag"), ("Y", "side")):
        if own[part] in columns.forces and wind_part in wind:
            yield columns.fail(
                "tables.wind_beside_body_axes", name=own[part], wind=" and ".join(wind), own=own[part], beside=wind_part
            )
    moving = [c for c in LINEAR if c in columns.velocity]
    for force, angle in (("lift", "alpha"), ("side", "beta")):
        if force in wind and angle not in columns.angles and not moving:
            yield columns.fail("tables.wind_without_angle", name=force, force=force, angle=angle)
    resistance = not columns.settings and np.unique(columns.speed).size >= FEWEST_SPEEDS
    if wind == ["drag"] and not columns.angles and not moving and not resistance:
        yield columns.fail("tables.drag_without_direction", name="drag")
