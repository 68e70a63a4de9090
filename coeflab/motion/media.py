"""One motion through two media: a march ends at the surface, and another begins there with the forces of the other medium.

The change is an event that the integrators locate inside their step; no step has the forces of both media. Position, attitude
and velocity go on unchanged: a craft at a point, wetted in no time, without the impulse of an added mass that it sheds.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.motion.dynamics import rotations
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.trajectory import Ended, Trajectory
from coeflab.motion.vehicle import Vehicle

Move = Callable[[Vehicle, Manoeuvre], Trajectory]
ON_SURFACE = 1e-6  # m


def through_media(vehicle: Vehicle, manoeuvre: Manoeuvre, move: Move) -> Trajectory:
    """The motion as far as it goes.

    Parameters
    ----------
    vehicle : Vehicle
        In the medium of the start.
    manoeuvre : Manoeuvre
        With ``others``. Orders are those that a medium's first phase names; none is carried over the surface.
    move : callable
        Moves one vehicle through a manoeuvre in one medium.

    Returns
    -------
    Trajectory
        Complete where every phase was carried out, or where the surface was not reached in time. Out of range where a
        stretch lies beyond the surface: the craft floats there, or a step passed the surface twice.

    Raises
    ------
    InputError
        Media that are not two in turn, or a change of medium that is not at the surface.
    """
    stretches = [tuple(phases) for _, phases in groupby(manoeuvre.phases, lambda p: p.medium)]
    _check(vehicle, manoeuvre, stretches)
    media = (vehicle, *manoeuvre.others)
    below = manoeuvre.surface < 0.0
    parts: list[Trajectory] = []
    start = replace(manoeuvre, others=())
    for number, phases in enumerate(stretches):
        part, surface = _stretch(media[phases[0].medium], start, phases, move, parts)
        side = 1.0 if below == (number % 2 == 0) else -1.0
        beyond = _first_beyond(part, surface, side)
        if beyond is not None:
            part = _stopped(part, beyond, media[phases[0].medium].name)
        parts.append(part)
        if part.ended is not Ended.COMPLETE or (number + 1 < len(stretches) and part.reached[-1] is None):
            break
        start = replace(
            start, velocity=part.velocity[-1], attitude=part.attitude[-1], orders={}, statements=(),
        )  # fmt: skip
    return _joined(parts, manoeuvre, len(stretches))


def _check(vehicle: Vehicle, manoeuvre: Manoeuvre, stretches: Sequence[tuple[Phase, ...]]) -> None:
    if len(manoeuvre.others) != 1 or {p.medium for p in manoeuvre.phases} - {0, 1} or manoeuvre.phases[0].medium:
        raise InputError("other media than two", "two, from that of the start", column="medium")
    if abs(manoeuvre.surface) <= ON_SURFACE:
        raise InputError("a start on the surface", "one in the first medium", column="depth")
    if vehicle.free != manoeuvre.others[0].free:
        raise InputError(
            f"{' '.join(manoeuvre.others[0].free)} free in the other medium", " ".join(vehicle.free), column="free"
        )
    down = manoeuvre.surface > 0.0
    for number, phases in enumerate(stretches):
        for phase in phases:
            last = phase is phases[-1] and number + 1 < len(stretches)
            at = phase.until
            if at is not None and at.quantity != "depth":
                raise InputError(f"{phase.name} until {at.quantity}", "a depth, or a time", column="medium")
            there = at is not None and abs(at.value - manoeuvre.surface) <= ON_SURFACE
            if last and not (there and at is not None and at.rises == (down == (number % 2 == 0))):
                where = "by time" if at is None else f"at a depth of {at.value:g} m"
                raise input_error(
                    "motion.change_medium_after", column="medium", name=phase.name, where_2=where, surface=manoeuvre.surface,
                )  # fmt: skip


def _stretch(
    body: Vehicle, start: Manoeuvre, phases: tuple[Phase, ...], move: Move, parts: Sequence[Trajectory]
) -> tuple[Trajectory, float]:
    """One medium, and the depth of the surface from where this stretch begins."""
    sunk = sum(float(p.position[-1, 2]) for p in parts)

    def local(until: Until | None) -> Until | None:
        return None if until is None else replace(until, value=until.value - sunk)

    here = tuple(replace(p, until=local(p.until), medium=0) for p in phases)
    return move(body, replace(start, phases=here)), start.surface - sunk


def _first_beyond(part: Trajectory, surface: float, side: float) -> int | None:
    """The first row at or before which the craft is beyond the surface of its medium; between rows by cubics of depth."""
    height = side * (np.asarray(part.position)[:, 2] - surface)
    rate = side * np.einsum("nj,nj->n", rotations(np.asarray(part.attitude))[:, 2, :], part.velocity[:, :3])
    if len(height) > 1:
        height = np.append(height[:1], np.minimum(height[1:], _lowest(np.asarray(part.time), height, rate)))
    # Rounding of the crossing itself is no stretch beyond it.
    found = np.flatnonzero(height < -ON_SURFACE)
    return int(found[0]) if len(found) else None


def _lowest(time: Array, height: Array, rate: Array) -> Array:
    """(n - 1,) lowest value inside each step of the cubic with these values and rates at its ends."""
    step = np.diff(time)
    y, m, n = height[:-1], step * rate[:-1], step * rate[1:]
    rise = np.diff(height)
    cubic, square = m + n - 2.0 * rise, 3.0 * rise - 2.0 * m - n
    share = np.linspace(0.0, 1.0, 33)[:, None]
    return np.asarray(np.min(y + share * (m + share * (square + share * cubic)), axis=0))


def _stopped(part: Trajectory, row: int, name: str) -> Trajectory:
    """The motion up to where it is beyond the surface."""
    when = float(part.time[row])
    selected = part.until(float(part.time[max(row - 1, 0)]))
    return replace(
        selected, ended=Ended.OUT_OF_RANGE,
        reached=tuple(t if t is not None and t <= float(selected.time[-1]) else None for t in part.reached),
        why=f"stopped before {when:.6g} s of this stretch: beyond the surface with the forces of {name}. the craft floats in the "
        "surface, or a step passed it twice; a shorter --step or --record tells which",
    )  # fmt: skip


def _joined(parts: Sequence[Trajectory], manoeuvre: Manoeuvre, stretches: int) -> Trajectory:
    """All stretches in one; the row at the surface belongs to the medium that begins there."""
    selected = [slice(None, -1) if number + 1 < len(parts) else slice(None) for number in range(len(parts))]
    pairs = list(zip(parts, selected, strict=True))
    begin = np.concatenate([[0.0], np.cumsum([p.time[-1] for p in parts])])
    place = np.vstack([np.zeros(3), np.cumsum([p.position[-1] for p in parts], axis=0)])
    turned = np.concatenate([[0.0], np.cumsum([p.heading[-1] for p in parts])])
    first = np.concatenate([[0], np.cumsum([len(p.phases) for p in parts])])
    reached = [None if t is None else t + float(begin[i]) for i, p in enumerate(parts) for t in p.reached]
    counts = [len(p.time[k]) for p, k in pairs]
    last = parts[-1]
    words = [s for p in parts for s in p.statements]
    if last.ended is Ended.COMPLETE and len(parts) < stretches:
        words.append(
            f"the surface was not reached within {last.time[-1]:g} s of the last stretch: no further change of medium"
        )
    names = [p.name for p in manoeuvre.phases]
    return Trajectory(
        time=np.concatenate([p.time[k] + begin[i] for i, (p, k) in enumerate(pairs)]),
        position=np.concatenate([p.position[k] + place[i] for i, (p, k) in enumerate(pairs)]),
        attitude=np.concatenate([p.attitude[k] for p, k in pairs]),
        velocity=np.concatenate([p.velocity[k] for p, k in pairs]),
        heading=np.concatenate([p.heading[k] + turned[i] for i, (p, k) in enumerate(pairs)]),
        phase=np.concatenate([p.phase[k] + first[i] for i, (p, k) in enumerate(pairs)]),
        controls=_filled([p.controls for p in parts], counts),
        phases=tuple(names),
        reached=(*reached, *(None for _ in names[len(reached) :])),
        outside={name: x > 0.0 for name, x in _filled([p.outside for p in parts], counts).items()},
        ended=last.ended,
        why=last.why,
        statements=tuple(dict.fromkeys(words)),
    )  # fmt: skip


def _filled(parts: Sequence[Mapping[str, Any]], counts: Sequence[int]) -> dict[str, Array]:
    """Columns of all stretches; zero where one has no such column."""
    names = dict.fromkeys(name for p in parts for name in p)
    return {
        name: np.concatenate([p[name][:n] if name in p else np.zeros(n) for p, n in zip(parts, counts, strict=True)])
        for name in names
    }
