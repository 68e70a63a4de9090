"""Positions and heading of a record against its velocities: what u, v, r follow from them, and whether those given are along the body.

Displacements over some windows are compared with integrals of the velocities, which averages the noise of positions; a mean difference is
a current. Earth axes are x north, y east, psi clockwise from x (Fossen 2011, section 2.2).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array

WINDOWS = 24  # of a record
TURNS = 0.1  # of the displacements: less variation, and no axes can be told apart
AGREES, DOUBTED = 0.3, 0.1  # misfit over the variation; from where on another reading is looked for
CLEARLY = 0.4  # of a better reading over that of body axes
DRIFTS, CERTAINLY = 0.02, 3.0  # a current over the speed, and over its error, that is named
FORWARD = 0.7  # cosine of the drift angle of a body that moves ahead, at least, as the median
RATES = {"deg": 180.0 / np.pi, "rad": np.pi / 180.0}
Columns = Mapping[str, Array]


class Reading(NamedTuple):
    """How velocities may be meant, and how far displacements are from them, over their variation."""

    name: str
    misfit: float


def rotated(c: Columns, psi: Array, v: Array) -> Array:
    """Velocities along x and y of the earth, (n, 2), of u, v, w along the body (Fossen 2011, equation 2.18)."""
    zero = np.zeros(len(psi))
    phi, theta, u, w = (c.get(name, zero) for name in ("phi", "theta", "u", "w"))
    ahead = np.cos(theta) * u + np.sin(theta) * (np.sin(phi) * v + np.cos(phi) * w)
    aside = np.cos(phi) * v - np.sin(phi) * w
    return np.column_stack([np.cos(psi) * ahead - np.sin(psi) * aside, np.sin(psi) * ahead + np.cos(psi) * aside])


def readings(c: Columns) -> tuple[Reading, ...]:
    """Misfits of what u and v may be, body axes first; empty where the path does not turn or columns are missing.

    Parameters
    ----------
    c : mapping of str to (n,) array
        t, x, y, psi, u, v and what else the record has, SI.
    """
    if not {"t", "x", "y", "psi", "u"} <= set(c):
        return ()
    time, psi = c["t"], np.unwrap(c["psi"])
    v = c.get("v", np.zeros(len(time)))
    ends = np.unique(np.linspace(0, len(time) - 1, WINDOWS + 1).astype(int))
    place = np.column_stack([c["x"], c["y"]])[ends]
    moved, spans = np.diff(place, axis=0), np.diff(time[ends])[:, None]
    varies = _size(moved, spans)
    if not varies > TURNS * float(np.sqrt(np.mean(np.sum((moved / spans) ** 2, axis=1)))):
        return ()
    kinds = {
        "body": rotated(c, psi, v), "earth": np.column_stack([c["u"], v]), "turned": rotated(c, -psi, v),
        "port": rotated(c, psi, -v), "north": rotated(c, psi, v)[:, ::-1],
    }  # fmt: skip
    return tuple(
        Reading(name, _size(moved - np.diff(_integral(x, time)[ends], axis=0), spans) / varies)
        for name, x in kinds.items()
    )


def _integral(x: Array, time: Array) -> Array:
    steps = np.diff(time)[:, None] * (x[1:] + x[:-1]) / 2.0
    return np.vstack([np.zeros((1, x.shape[1])), np.cumsum(steps, axis=0)])


def _size(moved: Array, spans: Array) -> float:
    """Root mean square of velocities about their mean, which may be a current."""
    rates = moved / spans
    return float(np.sqrt(np.mean(np.sum((rates - rates.mean(axis=0)) ** 2, axis=1))))


def contradicted(c: Columns, file: str) -> tuple[Finding, ...]:
    """What positions and heading say against u, v, r: failures where another reading explains them, else warnings.

    Parameters
    ----------
    c : mapping of str to (n,) array
        Columns of the record, SI.
    file : str
    """
    out = []
    if found := readings(c):
        body, best = found[0], min(found, key=lambda r: r.misfit)
        explained = body.misfit > DOUBTED and best.misfit < CLEARLY * body.misfit
        if body.misfit > AGREES or explained:
            out.append(
                Finding.of(
                    "record.velocities", file, Severity.FAIL if explained else Severity.WARN, statistic=body.misfit, threshold=AGREES,
                    reading=best.name if explained else "none", misfit=best.misfit,
                )
            )  # fmt: skip
    elif "psi" in c and {"u", "v"} <= set(c) and _follows_heading(c):
        out.append(Finding.of("record.velocities", file, Severity.FAIL, reading="course", misfit=0.0))
    return (*out, *_rate(c, file))


def drift(c: Columns, file: str) -> tuple[Finding, ...]:
    """The mean rate by which x and y move beyond u and v along the body, where it is more than chance: a current."""
    if not (found := readings(c)) or found[0].misfit > AGREES:
        return ()
    time, psi = c["t"], np.unwrap(c["psi"])
    along = rotated(c, psi, c.get("v", np.zeros(len(time))))
    ends = np.unique(np.linspace(0, len(time) - 1, WINDOWS + 1).astype(int))
    beyond = np.diff(np.column_stack([c["x"], c["y"]])[ends] - _integral(along, time)[ends], axis=0)
    rates = beyond / np.diff(time[ends])[:, None]
    current, error = rates.mean(axis=0), np.std(rates, axis=0, ddof=1) / np.sqrt(len(rates))
    size, speed = float(np.hypot(*current)), float(np.median(np.hypot(*along.T)))
    if size <= max(DRIFTS * speed, CERTAINLY * float(np.hypot(*error))):
        return ()
    return (
        Finding.of(
            "record.current", file, Severity.NOTE, statistic=size, north=float(current[0]), east=float(current[1]),
            share=size / speed,
        ),
    )  # fmt: skip


def _follows_heading(c: Columns) -> bool:
    """Whether the direction of (u, v) turns with the heading, which that of velocities along the body does not."""
    psi = np.unwrap(c["psi"])
    apart = np.unwrap(np.arctan2(c["v"], c["u"])) - psi
    return bool(np.std(psi) > 1.0 and np.std(apart) < AGREES * np.std(psi) and np.all(np.hypot(c["u"], c["v"]) > 0.0))


def _rate(c: Columns, file: str) -> tuple[Finding, ...]:
    """The turn of the heading over the integral of r, where it is not one."""
    if not {"t", "psi", "r"} <= set(c):
        return ()
    time, psi, zero = c["t"], np.unwrap(c["psi"]), np.zeros(len(c["t"]))
    phi, theta, q = (c.get(name, zero) for name in ("phi", "theta", "q"))
    turning = ((q * np.sin(phi) + c["r"] * np.cos(phi)) / np.cos(theta))[:, None]
    ends = np.unique(np.linspace(0, len(time) - 1, WINDOWS + 1).astype(int))
    by_rate, turned = np.diff(_integral(turning, time)[ends, 0]), np.diff(psi[ends])
    size, whole = float(by_rate @ by_rate), float(turned @ turned)
    if not (size > 0.0 and whole > np.radians(1.0) ** 2 * len(turned)):
        return ()
    ratio, alike = float(turned @ by_rate) / size, float(turned @ by_rate) / np.sqrt(size * whole)
    if abs(ratio - 1.0) < AGREES and alike > CLEARLY:
        return ()
    sign = "-" * (ratio < 0.0)
    unit = next((name for name, k in RATES.items() if abs(abs(ratio) * k - 1.0) < AGREES), "")
    known = abs(alike) > 1.0 - AGREES and (unit or abs(ratio + 1.0) < AGREES)
    return (
        Finding.of(
            "record.rate", file, Severity.FAIL if known else Severity.WARN, statistic=ratio, threshold=AGREES,
            advice=f"{sign}r [{unit or 'rad'}/s]" if known else "", reading="known" if known else "none",
        ),
    )  # fmt: skip


def sideways(c: Columns) -> float:
    """Median cosine of the drift angle: near 1 for a body that moves ahead, whose heading is what it is read as."""
    speed = np.hypot(c["u"], c["v"])
    return float(np.median(c["u"][speed > 0.0] / speed[speed > 0.0])) if np.any(speed > 0.0) else 1.0


def by_positions(c: Columns) -> dict[str, Array]:
    """Columns with u, v and r, where there are none, by central differences of x, y and psi; without the first and the last row.

    Even rows then share no noise of positions with odd ones.

    Parameters
    ----------
    c : mapping of str to (n,) array
        t, x, y, psi and what else the record has, SI.
    """
    time, psi = c["t"], np.unwrap(c["psi"])
    dx, dy, turn = (np.gradient(x, time) for x in (c["x"], c["y"], psi))
    new = {"u": np.cos(psi) * dx + np.sin(psi) * dy, "v": np.cos(psi) * dy - np.sin(psi) * dx, "r": turn}
    return {name: x[1:-1] for name, x in ({**new, **c, "psi": psi}).items()}
