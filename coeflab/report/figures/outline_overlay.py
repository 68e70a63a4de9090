"""What estimates see of a body, drawn over its views: hulls, foils, rings and bluff parts by name, and what no method sees."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from coeflab.bodies.outline import Foil, Outline, RingWing, Sections
from coeflab.core.types import Array
from coeflab.report.figures.body_view import Sheet
from coeflab.report.figures.palette import COLOURS

STYLES = {  # colour, line, words
    "hull": ("a", "-", "hull"),
    "foil": ("c", "-", "foil"),
    "ring": ("d", "-", "ring"),
    "bluff": ("b", "--", "bluff part"),
    "unseen": ("b", ":", "seen by no method"),
}
STEP = 7.5  # points between names that would stand on each other
AROUND = np.linspace(0.0, 2.0 * np.pi, 49)


class Drawn(NamedTuple):
    """A part as closed or open lines in space, m, FRD."""

    name: str
    kind: str
    lines: tuple[Array, ...]


def drawn(outline: Outline) -> Iterator[Drawn]:
    """Every part of an outline as lines in space.

    Parameters
    ----------
    outline : Outline
    """
    for hull in outline.hulls:
        yield Drawn(hull.name, "hull", _hull(hull))
    for foil in outline.foils:
        yield Drawn(foil.name, "foil", (_foil(foil),))
    for ring in outline.rings:
        yield Drawn(ring.name, "ring", _ring(ring))
    for part in outline.bluff:
        yield Drawn(part.name, "bluff", _box(part.centre, part.half_extents, part.rotation))
    for one in outline.unseen:
        half = (
            np.sqrt(np.maximum(np.roll(one.areas, 1) * np.roll(one.areas, -1), 0.0) / np.maximum(one.areas, 1e-12))
            / 2.0
        )
        largest = np.sqrt(float(one.areas.max())) / 2.0
        yield Drawn(one.name, "unseen", _box(one.centre, np.minimum(half, 2.0 * largest), np.eye(3)))


def overlay(one: Sheet, outline: Outline, names: bool) -> None:
    """Draw an outline over a view; names where they are asked for, each above what has one already.

    Parameters
    ----------
    one : Sheet
    outline : Outline
    names : bool
    """
    taken: list[tuple[float, float]] = []
    for part in drawn(outline):
        colour, dash, _ = STYLES[part.kind]
        for line in part.lines:
            one.axes.plot(*one.on_paper(line).T, color=COLOURS[colour], linewidth=0.9, linestyle=dash)
        if not names:
            continue
        x, y = one.on_paper(np.concatenate(part.lines)).mean(axis=0)
        while any(abs(x - a) < 60.0 and abs(y - b) < STEP for a, b in taken):
            y -= STEP
        taken.append((x, y))
        one.axes.text(x, y, part.name, fontsize=6.5, ha="center", va="center", color=COLOURS[colour])


def _hull(hull: Sections) -> tuple[Array, ...]:
    """Its keel and deck line, both water lines, and its largest section."""
    out = []
    for axis, wide in ((1, hull.depth), (0, hull.breadth)):
        for sign in (1.0, -1.0):
            edge = hull.centre.copy()
            edge[:, axis] += sign * wide / 2.0
            out.append(np.column_stack([hull.x, edge]))
    k = int(np.argmax(hull.area))
    around = np.column_stack([hull.breadth[k] * np.cos(AROUND), hull.depth[k] * np.sin(AROUND)]) / 2.0 + hull.centre[k]
    out.append(np.column_stack([np.full(len(around), hull.x[k]), around]))
    return tuple(out)


def _foil(foil: Foil) -> Array:
    ends = []
    for at, chord, order in ((foil.root, foil.root_chord, (0.25, -0.75)), (foil.tip, foil.tip_chord, (-0.75, 0.25))):
        ends += [at + np.array([share * chord, 0.0, 0.0]) for share in order]
    return np.array([*ends, ends[0]])


def _ring(ring: RingWing) -> tuple[Array, ...]:
    circle = (
        ring.diameter / 2.0 * np.column_stack([np.zeros(len(AROUND)), np.cos(AROUND), np.sin(AROUND)]) + ring.centre
    )
    fore, aft = (circle + np.array([share * ring.chord, 0.0, 0.0]) for share in (0.25, -0.75))
    return fore, aft, *(np.array([fore[k], aft[k]]) for k in (0, 12, 24, 36))


def _box(centre: Array, half: Array, rotation: Array) -> tuple[Array, ...]:
    """Six faces of a box."""
    out = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            ring = np.zeros((5, 3))
            ring[:, axis] = sign
            ring[:, (axis + 1) % 3] = [1.0, -1.0, -1.0, 1.0, 1.0]
            ring[:, (axis + 2) % 3] = [1.0, 1.0, -1.0, -1.0, 1.0]
            out.append(centre + (ring * half) @ rotation.T)
    return tuple(out)
