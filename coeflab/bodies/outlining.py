"""Outlines of shapes that are known by equations: hulls of revolution, simple parts, straight tapered foils on them.

Of an exposed foil the root lies at the mean distance at which the lines of equal chord share leave the hull, and its chords
are scaled so that the trapezoid has the exposed area.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from coeflab.bodies.forms import CLASSES, Cylinder, Ellipsoid, Finned, Plate, Tube, Turned, shadow
from coeflab.bodies.mesh.meshing import dense_meridian, surface_of
from coeflab.bodies.outline import Bluff, Foil, Outline, Propeller, RingWing, Sections
from coeflab.bodies.pieces import HULL, Control
from coeflab.bodies.shape import Part, Parts, Revolution
from coeflab.bodies.thrusters import Thruster
from coeflab.core.texts import input_error
from coeflab.core.types import Array

STATIONS, SHARES, STEPS = 121, 33, 257
SLENDER = 1.5  # length over breadth and depth: from here a part along x is a hull
ALONG = np.cos(np.radians(15.0))  # a part's axis along x within
ACROSS, OWN_SPAN = 0.2, 0.9  # cosine between a hinge and the span: below it turns nothing, above it turns all
REACH = 1.25  # of the hull's radius: an appendage that begins within stands on it
LIKE = {"bar": "box", "tube": "cylinder", "revolution": "ellipsoid", "finned": "mesh"}  # kinds of bluff parts
NEAR = 0.03  # of the length: fins at one station
WING = 1.5  # span over chord of a plate that stands on nothing and is a foil all the same

Radius = Callable[[Array], Array]


def stations(fore: float, aft: float) -> Array:
    """Stations along x from the fore end to the aft end, dense at both."""
    at = (fore + aft) / 2.0 + (fore - aft) / 2.0 * np.cos(np.pi * np.arange(STATIONS) / (STATIONS - 1))
    at[[0, -1]] = fore, aft
    return at


def ellipse_girth(breadth: Array, depth: Array) -> Array:
    """Of ellipses, Ramanujan's second formula."""
    a, b = breadth / 2.0, depth / 2.0
    total = np.maximum(a + b, np.finfo(float).tiny)
    h = ((a - b) / total) ** 2
    return np.asarray(np.pi * (a + b) * (1.0 + 3.0 * h / (10.0 + np.sqrt(4.0 - 3.0 * h))))


def round_hull(shape: Revolution, name: str = HULL) -> Sections:
    """Sections of a body of revolution.

    Parameters
    ----------
    shape : Revolution
    name : str
        Of the hull.
    """
    rising, radii = dense_meridian(shape)
    x = stations(rising[-1], rising[0])
    radius = np.interp(x, rising, radii)
    axis = np.broadcast_to(shape.axis, (len(x), 2))
    return Sections(name, x, np.pi * radius**2, 2.0 * radius, 2.0 * radius, 2.0 * np.pi * radius, axis, True)


def radius_towards(hull: Sections, way: Array) -> Radius:
    """How far the hull reaches from its centres along a direction, as if its sections were ellipses.

    Parameters
    ----------
    hull : Sections
    way : (2,) array
        Direction, y and z.
    """
    across = np.hypot(way[0] * hull.depth, way[1] * hull.breadth)
    reach = np.divide(hull.breadth * hull.depth, 2.0 * across, out=np.zeros_like(across), where=across > 0.0)
    return lambda x: np.interp(x, hull.x[::-1], reach[::-1], left=0.0, right=0.0)


@dataclass(frozen=True, slots=True)
class Trapezoid:
    """A straight tapered planform from root to tip, distances from an axis; m.

    Attributes
    ----------
    root, tip : float
        Distances of its ends from the axis.
    chords : (float, float)
    trailing_edges : (float, float)
        x there, FRD.
    """

    root: float
    tip: float
    chords: tuple[float, float]
    trailing_edges: tuple[float, float]

    def at(self, distance: Array | float) -> tuple[Array, Array]:
        """Chord and x of the trailing edge at distances from the axis."""
        share = (np.asarray(distance) - self.root) / (self.tip - self.root)
        (a, b), (c, d) = self.chords, self.trailing_edges
        return a + (b - a) * share, c + (d - c) * share

    def exposed(self, radius: Radius) -> tuple[float, float]:
        """Where it leaves a hull, mean over the chord, and its area outside; 0 m^2 where it lies within."""
        share = (np.arange(SHARES) + 0.5) / SHARES
        out = np.linspace(self.root, self.tip, STEPS)
        chord, end = self.at(out)
        gap = out[:, None] - radius(end[:, None] + chord[:, None] * (1.0 - share))
        inside = gap <= 0.0
        last = np.where(inside.any(axis=0), STEPS - 1 - inside[::-1].argmax(axis=0), -1)
        after = np.clip(last + 1, 1, STEPS - 1)
        low, high = np.take_along_axis(gap, np.array([after - 1, after]), axis=0)
        between = np.divide(-low, high - low, out=np.zeros_like(low), where=high > low)
        foot = np.where(
            last < 0, self.root, np.where(last == STEPS - 1, self.tip, out[after - 1] + between * (out[1] - out[0]))
        )
        area = (self.tip - foot) * (self.at(foot)[0] + self.chords[1]) / 2.0
        return float(foot.mean()), float(area.mean())

    def foil(self, name: str, way: Array, stand: Array, thickness: float, radius: Radius | None = None) -> Foil | None:
        """What of it stands out of a hull; None where nothing does.

        Parameters
        ----------
        name : str
        way : (2,) array
            Where it points: y and z, a unit vector.
        stand : (2,) array
            y and z of the axis.
        thickness : float
            Over the chord.
        radius : callable, optional
            Of the hull, at x; without it the foil stands alone.
        """
        foot, area = (self.root, -1.0) if radius is None else self.exposed(radius)
        if foot >= self.tip or area == 0.0:
            return None
        (root_chord, tip_chord), (root_end, tip_end) = ((float(v) for v in pair) for pair in zip(
            *((self.at(at)) for at in (foot, self.tip)), strict=True))  # fmt: skip
        fit = 1.0 if area < 0.0 else 2.0 * area / ((root_chord + tip_chord) * (self.tip - foot))

        def quarter(at: float, chord: float, end: float) -> Array:
            return np.array([end + 0.75 * chord, *(stand + way * at)])

        root = quarter(foot, root_chord, root_end)
        return Foil(
            name, root, quarter(self.tip, tip_chord, tip_end), fit * root_chord, fit * tip_chord, thickness,
            root[1:] if radius is None else stand,
        )  # fmt: skip


def with_controls(foils: Iterable[Foil], controls: Iterable[Control]) -> tuple[tuple[Foil, ...], tuple[str, ...]]:
    """The foils with what turns them, and what of the controls no method sees.

    Parameters
    ----------
    foils : iterable of Foil
        Named as the pieces that they are, or as these followed by ``_image``.
    controls : iterable of Control
    """
    result: list[Foil] = []
    left: list[str] = []
    known = tuple(controls)
    aside: dict[str, list[str]] = {}
    for foil in foils:
        way = (foil.tip - foil.root)[1:] / foil.span
        turns: dict[str, float] = {}
        for one in (c for c in known if foil.name.removesuffix("_image") in c.parts):
            sign = float(one.axis[1:] @ way)
            if abs(sign) < ACROSS:
                raise input_error(
                    "bodies.axis_across_span", column="control.axis", triple=_triple(one.axis), name=one.name, name_2=foil.name,
                    triple_2=_triple(np.array([0.0, *way]) * (np.sign(way[1 if one.name == "dr" else 0]) or 1.0)),
                )  # fmt: skip
            if one.name in turns:
                left.append(f"{foil.name} turns by {one.name} twice, and counts once")
                continue
            turns[one.name] = sign
            if abs(sign) < OWN_SPAN:
                aside.setdefault(one.name, []).append(f"{foil.name} by {abs(sign):.2f}")
        (name, sign), *other_controls = turns.items() or (("", 1.0),)
        result.append(replace(foil, control=name, sign=sign, other_controls=tuple(other_controls)) if turns else foil)
    left += [
        f"all of a turn by {name}, whose axis is not along the span: it turns {', '.join(parts)} of the angle; a [[control]] "
        f"{name} a fin, with its axis along the span, turns it by all"
        for name, parts in aside.items()
    ]
    named = {foil.name.removesuffix("_image") for foil in result}
    left += [f"{part}, which {c.name} turns, is no foil" for c in known for part in c.parts if part not in named]
    return tuple(result), tuple(left)


def _triple(v: Array) -> str:
    return f"[{', '.join(f'{x + 0.0:.3g}' for x in v)}]"


def with_propellers(outline: Outline, thrusters: Iterable[Thruster]) -> Outline:
    """The outline with the open propellers along x of a body with a hull; of the others why no method sees them.

    Parameters
    ----------
    outline : Outline
    thrusters : iterable of Thruster
    """
    result: list[Propeller] = []
    left: list[str] = []
    for one in thrusters if outline.hulls else ():
        if abs(one.axis[0]) < ALONG:
            continue
        screw = one.screw
        if screw is None:
            left.append(f"{one.name}: force across of its propeller, without [thruster.propeller]")
        elif any(_within(ring, one.place) for ring in outline.rings):
            left.append(f"{one.name}: force across of its propeller, which turns in a duct")
        else:
            result.append(
                Propeller(one.name, one.place, screw.diameter, screw.blades, screw.pitch_ratio, screw.area_ratio)
            )
    return (
        replace(outline, propellers=tuple(result), left_out=(*outline.left_out, *left)) if result or left else outline
    )


def _within(ring: RingWing, place: Array) -> bool:
    """Whether a place lies in a ring."""
    aside = float(np.hypot(*(place - ring.centre)[1:]))
    return aside < 0.25 * ring.diameter and abs(float(place[0] - ring.centre[0]) + ring.chord / 4.0) < ring.chord


def of_revolution(shape: Revolution) -> Outline:
    """The outline of a bare hull of revolution; discs that close its ends are wetted.

    Parameters
    ----------
    shape : Revolution
    """
    hull = round_hull(shape)
    wetted = shape.integrals.wetted_surface + float(hull.area[0] + hull.area[-1])
    return Outline((hull,), (), (), (), wetted, shape.volume)


def of_parts(shape: Parts, controls: tuple[Control, ...] = ()) -> Outline:
    """Hulls are cylinders, ellipsoids and bodies of revolution along x; foils are plates along x that stand on them, and fins.

    Tubes along x are ring wings; the rest is bluff.

    Parameters
    ----------
    shape : Parts
    controls : tuple of Control
    """
    hulls = tuple(found for part in shape.parts if (found := _hull(part)) is not None)
    names = {hull.name for hull in hulls}
    foils: list[Foil] = []
    rings, bluff = [], []
    for part in shape.parts:
        if part.name in names:
            continue
        form = part.form
        own = (
            _plate(part, form, hulls)
            if isinstance(form, Plate)
            else _fins(part, form)
            if isinstance(form, Finned)
            else ()
        )
        foils += own
        if isinstance(form, Tube) and abs(part.rotation[0, 0]) >= ALONG:
            rings.append(_ring(part, form))
        elif not own:
            bluff.append(_bluff(part))
    turned, left = with_controls(foils, controls)
    wetted = sum(surface_of(part.form) for part in shape.parts)
    if len(shape.parts) > 1:
        left = (*left, "overlaps of parts: their volume and surface count twice")
    return Outline(hulls, turned, tuple(rings), tuple(bluff), wetted, shape.volume, left)


def _hull(part: Part) -> Sections | None:
    """The part as sections, if it is long and lies along x."""
    form, turn = part.form, part.rotation
    half = form.half_extents(turn)
    if not isinstance(form, Cylinder | Ellipsoid | Turned) or half[0] < SLENDER * max(half[1:]):
        return None
    lean = np.zeros(2)
    if isinstance(form, Turned):
        if abs(turn[0, 0]) < ALONG:
            return None
        places, radii = np.sign(turn[0, 0]) * np.array(form.stations), np.array(form.radii)
        order = np.argsort(places)
        x = stations(places.max(), places.min())
        across, lean = np.eye(2), turn[1:, 0] / turn[0, 0]
        cut = np.interp(x, places[order], radii[order])
    elif isinstance(form, Cylinder):
        if abs(turn[0, 0]) < ALONG:
            return None
        across, lean = np.eye(2) * form.radius**2, turn[1:, 0] / turn[0, 0]
        x = stations(form.length / 2.0, -form.length / 2.0)
        cut = np.ones(STATIONS)
    else:
        if max(abs(turn[0])) < ALONG:
            return None
        across = (turn @ np.diag(form.axes**2) @ turn.T)[1:, 1:]
        x = stations(half[0], -half[0])
        cut = np.sqrt(np.clip(1.0 - (x / half[0]) ** 2, 0.0, None))
    breadth, depth = (2.0 * np.sqrt(across[i, i]) * cut for i in (0, 1))
    short, long = 2.0 * np.sqrt(np.linalg.eigvalsh(across))
    return Sections(
        part.name,
        part.centre[0] + x,
        np.pi / 4.0 * short * long * cut**2,
        breadth,
        depth,
        ellipse_girth(long * cut, short * cut),
        part.centre[1:] + x[:, None] * lean,
        bool(np.isclose(long, short, rtol=1e-9) and np.allclose(lean, 0.0)),
    )


def _plate(part: Part, form: Plate, hulls: tuple[Sections, ...]) -> tuple[Foil, ...]:
    """A plate along x as one foil, or two where it passes through a hull; none where it stands on nothing and is no wing."""
    turn = part.rotation
    along = int(np.argmax(abs(turn[0, :2])))
    if abs(turn[0, along]) < ALONG:
        return ()
    chord, span = (form.chord, form.span) if along == 0 else (form.span, form.chord)
    thick = part.fit.thickness if part.fit is not None and part.fit.thickness is not None else 0.0
    thickness = thick * min(chord, span) / chord
    way = turn[1:, 1 - along] / np.linalg.norm(turn[1:, 1 - along])
    end = float(part.centre[0]) - chord / 2.0

    def half(name: str, way: Array, first: float, tip: float, stand: Array, hull: Sections | None) -> tuple[Foil, ...]:
        if tip <= first:
            return ()
        flat = Trapezoid(first, tip, (chord, chord), (end, end))
        foil = flat.foil(name, way, stand, thickness, None if hull is None else radius_towards(hull, way))
        return () if foil is None else (foil,)

    for hull in hulls:
        if not hull.x[-1] - chord / 2.0 <= part.centre[0] <= hull.x[0]:
            continue
        at = np.clip(part.centre[0], hull.x[-1], hull.x[0])
        axis = np.array([np.interp(at, hull.x[::-1], hull.centre[::-1, i]) for i in (0, 1)])
        offset = part.centre[1:] - axis
        way = way if offset @ way >= 0.0 else -way
        middle = float(offset @ way)
        aside = offset - middle * way
        within = float(radius_towards(hull, way)(np.array([at]))[0])
        if max(middle - span / 2.0, float(np.linalg.norm(aside))) > REACH * within:
            continue
        stand = axis + aside
        return (
            *half(part.name, way, max(0.0, middle - span / 2.0), middle + span / 2.0, stand, hull),
            *half(f"{part.name}_image", -way, 0.0, span / 2.0 - middle, stand, hull),
        )
    if span < WING * chord:
        return ()
    stand = part.centre[1:]
    return (
        *half(part.name, way, 0.0, span / 2.0, stand, None),
        *half(f"{part.name}_image", -way, 0.0, span / 2.0, stand, None),
    )


def _fins(part: Part, form: Finned) -> tuple[Foil, ...]:
    """Fins alike about an axis along x; none where it lies otherwise."""
    if abs(part.rotation[0, 0]) < ALONG:
        return ()
    end = float(part.centre[0]) - form.chord / 2.0
    flat = Trapezoid(form.radius / 2.0, form.semi_span, (form.chord, form.chord), (end, end))
    found = []
    for k in range(form.count):
        way = (1.0, 1.0, -1.0, -1.0)[k if form.count == 4 else 2 * k] * part.rotation[
            1:, 1 + k % 2 if form.count == 4 else 1
        ]
        way = way / np.linalg.norm(way)
        foil = flat.foil(
            f"{part.name}_{k + 1}",
            way,
            part.centre[1:],
            form.thickness / form.chord,
            lambda x: np.full_like(x, form.radius),
        )
        found += [] if foil is None else [foil]
    return tuple(found)


def _ring(part: Part, form: Tube) -> RingWing:
    """A tube along x."""
    centre = part.centre + np.array([form.length / 4.0, 0.0, 0.0])
    thickness = (form.radius - form.inner_radius) / form.length
    return RingWing(part.name, centre, form.radius + form.inner_radius, form.length, thickness)


def _bluff(part: Part) -> Bluff:
    areas = np.array([shadow(part.form, axis) for axis in part.rotation])
    extents = part.form.half_extents(np.eye(3))
    kind = CLASSES[type(part.form)]
    return Bluff(part.name, LIKE.get(kind, kind), part.centre, part.rotation, extents, areas)


@dataclass(frozen=True, slots=True)
class FinsAlong:
    """Where fins stand along the hull.

    Attributes
    ----------
    words : str
        Such as ``4 fins at x = -1.22 m, 87 % of the length from the bow``.
    ahead : bool
        All ahead of the hull's middle.
    """

    words: str
    ahead: bool


def fins_along(outline: Outline) -> FinsAlong | None:
    """Where the fins of a hull stand, by their middle quarter-chord points; None without hull or fins.

    Parameters
    ----------
    outline : Outline
    """
    if not outline.hulls or not outline.foils:
        return None
    bow, stern = max(h.x[0] for h in outline.hulls), min(h.x[-1] for h in outline.hulls)
    at = sorted((float(f.root[0] + f.tip[0]) / 2.0 for f in outline.foils), reverse=True)
    groups: list[list[float]] = []
    for x in at:
        if groups and groups[-1][-1] - x < NEAR * (bow - stern):
            groups[-1].append(x)
        else:
            groups.append([x])
    words = []
    for g in groups:
        x = sum(g) / len(g)
        many = f"{len(g)} fins" if len(g) > 1 else "1 fin"
        words.append(f"{many} at x = {x:.3g} m, {100.0 * (bow - x) / (bow - stern):.0f} % of the length from the bow")
    return FinsAlong("; ".join(words), min(at) > (bow + stern) / 2.0)
