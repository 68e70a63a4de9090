"""Outlines made by hand: a spheroid, a hull with sail and cross tail, boxes."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.outline import Bluff, Foil, Outline, Propeller, RingWing, Sections
from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.estimates import Estimates, Water, estimated

WATER = Water(998.0, 1.0e-6, 3.0)
LENGTH, RADIUS = 4.0, 0.25
UP, STARBOARD, DOWN, PORT = (0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)


def hull(radius_at: object = None, length: float = LENGTH, radius: float = RADIUS, name: str = "hull") -> Sections:
    """A spheroid of revolution, from x = 0 to -length."""
    s = np.cos(np.pi * np.arange(401) / 400)
    x = (s - 1.0) * length / 2.0
    r = radius * np.sqrt(np.clip(1.0 - s**2, 0.0, None))
    return Sections(name, x, np.pi * r**2, 2 * r, 2 * r, 2 * np.pi * r, np.zeros((len(x), 2)), True)


def cut_hull(share: float) -> Sections:
    """The same, cut off where its area has fallen to a share of the largest: a blunt base."""
    whole = hull()
    keep = (whole.x > -LENGTH / 2.0) | (whole.area >= share * whole.area.max())
    return Sections(
        "hull", *(getattr(whole, n)[keep] for n in ("x", "area", "breadth", "depth", "girth", "centre")), True
    )


def foil(name: str, way: tuple[float, float], x: float, root: float, tip: float, chord: float, control: str = "",
         sign: float = 1.0, flap: float = 1.0) -> Foil:  # fmt: skip
    """A rectangular foil that stands on the axis."""
    w = np.array(way)
    return Foil(
        name,
        np.array([x, *(root * w)]),
        np.array([x, *(tip * w)]),
        chord,
        chord,
        0.15,
        np.zeros(2),
        control,
        flap,
        sign,
    )


def tail() -> tuple[Foil, ...]:
    """Four alike on the stern; rudders by dr, planes by ds."""
    return (
        foil("upper", UP, -3.5, 0.1, 0.25, 0.2, "dr", -1.0), foil("starboard", STARBOARD, -3.5, 0.1, 0.25, 0.2, "ds"),
        foil("lower", DOWN, -3.5, 0.1, 0.25, 0.2, "dr", 1.0), foil("port", PORT, -3.5, 0.1, 0.25, 0.2, "ds", -1.0),
    )  # fmt: skip


SAIL = foil("sail", UP, -1.2, 0.25, 0.45, 0.4)
RING = RingWing("ring", np.array([-3.9, 0.0, 0.0]), 0.24, 0.2, 0.1)


SCREW = Propeller("screw", np.array([-4.05, 0.0, 0.0]), 0.3, 3, 1.0, 0.5)


def outline(*foils: Foil, rings: tuple[RingWing, ...] = (), hulls: tuple[Sections, ...] | None = None,
            bluff: tuple[Bluff, ...] = (), propellers: tuple[Propeller, ...] = ()) -> Outline:  # fmt: skip
    return Outline((hull(),) if hulls is None else hulls, foils, rings, bluff, 4.0, 0.5, propellers=propellers)


def box(name: str = "box", centre: tuple[float, float, float] = (0.0, 0.0, 0.0), size: float = 0.5) -> Bluff:
    return Bluff(name, "box", np.array(centre), np.eye(3), np.full(3, size / 2.0), np.full(3, size**2))


@functools.cache
def plain() -> Body:
    """A shipped body, for its names and source; datum at the nose, reference point amidships."""
    body = read_body(Path(shipped("geometry")) / "suboff_bare_hull" / "body.toml")
    return replace(
        body, name="made", reference_point=np.array([-LENGTH / 2.0, 0.0, 0.0]), scaling=None, shape=None, outlined=None
    )


def body_of(seen: Outline, point: tuple[float, float, float] = (-LENGTH / 2.0, 0.0, 0.0)) -> Body:
    return replace(plain(), outlined=lambda: seen, reference_point=np.array(point))


def estimates_of(seen: Outline, point: tuple[float, float, float] = (-LENGTH / 2.0, 0.0, 0.0)) -> Estimates:
    return estimated(body_of(seen, point), WATER)
