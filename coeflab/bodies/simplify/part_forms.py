"""Which simple form a closed surface resembles, and the form's dimensions; arrays in, arrays out.

A thin body as a rectangular plate; arrays in, arrays out.

Simple forms of a piece's volume: cylinders, ellipsoids and boxes in given axes; arrays in, arrays out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.oriented_box import oriented_box, smallest_rectangle
from coeflab.bodies.mesh.silhouettes import Outline, convex_outline, mesh_outline
from coeflab.bodies.mesh.solids import Solid, Surface, form_solid, revolved, surface
from coeflab.bodies.shape import Bar, Box, Cylinder, Ellipsoid, Form, Plate, Tube, Turned, shadow
from coeflab.bodies.simplify.round_hull import round_hull
from coeflab.core.types import Array, brief
from coeflab.law.transforms import about_axis, relabelled

ALIKE = 0.02
MAKES: dict[str, Any] = {
    "cylinder": Cylinder, "tube": Tube, "plate": Plate, "ellipsoid": Ellipsoid, "box": Box, "bar": Bar,
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A closed surface and what its fits need of it.

    Attributes
    ----------
    vertices : (n, 3) array
        m.
    areas : (m, 3) array
        Area vectors of its faces, m^2.
    volume : float
        m^3.
    centre : (3,) array
        Of the volume, m.
    spread : (3, 3) array
        Second moments of the volume about its centre, over the volume, m^2.
    """

    vertices: Array
    areas: Array
    volume: float
    centre: Array
    spread: Array

    @classmethod
    def of(cls, surface: Surface) -> Piece:
        """From vertices and faces."""
        vertices, faces = surface
        whole = mesh_integrals(vertices, faces)
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        return cls(
            vertices, np.cross(b - a, c - a) / 2.0, whole.volume, whole.centre, whole.second_moments / whole.volume
        )

    def extents(self, turn: Array) -> Array:
        """(3,) sizes along the columns of ``turn``, m."""
        return np.asarray(np.ptp(self.vertices @ turn, axis=0))

    def projected(self, turn: Array) -> Array:
        """(3,) projected areas along the columns of ``turn``, m^2."""
        return np.asarray(np.abs(self.areas @ turn).sum(axis=0) / 2.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A form about its own axes.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``tube`` (radius, inner radius, length), ``ellipsoid`` (semi-axes) or ``box`` (sides).
    sizes : tuple of float
        m.
    rotation : (3, 3) array
        Columns are its axes.
    """

    form: str
    sizes: tuple[float, ...]
    rotation: Array

    @property
    def extents(self) -> Array:
        """(3,) sizes along its own axes, m."""
        if self.form == "cylinder":
            radius, length = self.sizes
            return np.array([length, 2.0 * radius, 2.0 * radius])
        if self.form == "tube":
            return np.array([self.sizes[2], 2.0 * self.sizes[0], 2.0 * self.sizes[0]])
        return np.array(self.sizes) * (2.0 if self.form == "ellipsoid" else 1.0)

    @property
    def projected(self) -> Array:
        """(3,) projected areas along its own axes, m^2."""
        x, y, z = self.extents
        if self.form == "cylinder":
            return np.array([np.pi / 4.0 * y * z, x * z, x * y])
        if self.form == "tube":
            return np.array([shadow(Tube(*self.sizes), axis) for axis in np.eye(3)])
        return np.array([y * z, x * z, x * y]) * (np.pi / 4.0 if self.form == "ellipsoid" else 1.0)

    def misfit(self, of: Piece) -> float:
        """Error of the length over the length, plus errors of the three projected areas over their sum.

        The volume has none. Length is the largest extent of the piece along the form's own axes.
        """
        extents, areas = of.extents(self.rotation), of.projected(self.rotation)
        longest = int(np.argmax(extents))
        length = abs(float(self.extents[longest] / extents[longest]) - 1.0)
        return length + float(np.abs(self.projected - areas).sum() / areas.sum())


def cylinders(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """About every axis of the frames: of the piece's volume and extent, and of its volume and area across the axis."""
    for frame in frames:
        for axis in frame.T:
            turn = about_axis(axis)
            length = float(of.extents(turn)[0])
            yield Fit("cylinder", (float(np.sqrt(of.volume / (np.pi * length))), length), turn)
            across = float(of.projected(turn)[1:].mean())
            radius = 2.0 * of.volume / (np.pi * across)
            yield Fit("cylinder", (radius, across / (2.0 * radius)), turn)


def ellipsoids(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """Of the piece's volume, length and largest projected area; round ones of its volume and length."""
    spread, principal = np.linalg.eigh(of.spread)
    unit = 3.0 * of.volume / (4.0 * np.pi)
    if spread[2] < (1.0 + ALIKE) * spread[0]:
        yield Fit("ellipsoid", (float(np.cbrt(unit)),) * 3, np.eye(3))
        return
    round_about = [k for k, i, j in ((2, 0, 1), (0, 1, 2)) if spread[j] < (1.0 + ALIKE) * spread[i]]
    if round_about:
        turn = about_axis(principal[:, round_about[0]])
        along, across = float(of.extents(turn)[0]) / 2.0, float(of.extents(turn)[1:].mean()) / 2.0
        along, across = (along, np.sqrt(unit / along)) if along > across else (unit / across**2, across)
        yield Fit("ellipsoid", (along, float(across), float(across)), turn)
        return
    for frame in frames:
        turn = relabelled(frame)
        areas, half = of.projected(turn), of.extents(turn) / 2.0
        sizes = _triple(half, areas / np.pi, unit)
        yield Fit("ellipsoid", sizes, turn)


def boxes(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """Of the piece's volume, length and largest projected area."""
    for frame in frames:
        turn = relabelled(frame)
        yield Fit("box", _triple(of.extents(turn), of.projected(turn), of.volume), turn)


def _triple(extents: Array, areas: Array, product: float) -> tuple[float, ...]:
    """Three sizes: the longest as given, its product with the next as the largest area, and all three as ``product``."""
    thin = int(np.argmax(areas))
    long = int(np.argmax(np.where(np.arange(3) == thin, 0.0, extents)))
    sizes = np.empty(3)
    sizes[thin], sizes[long], sizes[3 - thin - long] = product / areas[thin], extents[long], areas[thin] / extents[long]
    return tuple(float(s) for s in sizes)


STRIP, ACROSS, PREFERRED = 0.1, 0.3, 0.02


@brief
@dataclass(frozen=True, slots=True, eq=False)
class PlateFit:
    """Chord and span, m; attitude with the normal as third column; centre, m."""

    chord: float
    span: float
    rotation: Array
    centre: Array


def plate_fit(of: Surface, turn: Array) -> PlateFit:
    """The rectangle of the span and of the area, hence of the aspect ratio, that a body projects along its normal.

    The span is that at the middle of the area, so that a root that follows a tapering hull counts with its mean. The
    centre is that of the projected area, at the height of the volume's. The chord lies fore and aft unless another
    attitude covers 2 % more of the area: the principal axes, as of swept struts, or those of the smallest rectangle.

    Parameters
    ----------
    of : (vertices, faces)
        m.
    turn : (3, 3) array
        Its third column is the normal.
    """
    vertices, faces = of
    # Outlines are cut on a grid of fixed pitch, so that a small body is drawn large first.
    unit = float(np.max(np.ptp(vertices, axis=0)))
    found = _fitted((vertices / unit, faces), turn)
    return PlateFit(found.chord * unit, found.span * unit, found.rotation, found.centre * unit)


def _fitted(of: Surface, turn: Array) -> PlateFit:
    vertices, faces = of
    normal = turn[:, 2]
    local = vertices @ turn
    a, b, c = (local[faces[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    weight = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 4.0
    area, total = float(weight.sum()), a + b + c
    middle = weight @ total / (3.0 * area)
    second = sum((p - middle).T @ ((p - middle) * weight[:, None]) for p in (a, b, c))
    second = (second + (total - 3.0 * middle).T @ ((total - 3.0 * middle) * weight[:, None])) / (12.0 * area)
    centre = turn[:, :2] @ middle + normal * float(normal @ mesh_integrals(vertices, faces).centre)
    best, most = PlateFit(0.0, 0.0, turn, centre), -PREFERRED
    for flat in _attitudes(second, turn, vertices):
        axes = relabelled(np.column_stack([turn[:, :2] @ flat, normal]), normal=True)
        outline = mesh_outline(*of, axes[:, :2].T)
        at = centre @ axes[:, :2]
        span = _span(outline, at)
        if not span > 0.0:  # nothing there: a body bent about its own centre
            continue
        chord = area / span
        share = float((outline ^ _rectangle(at, chord, span)).area()) / area
        if share > most + PREFERRED:
            best, most = PlateFit(chord, span, axes, centre), share
    return best


def _rectangle(at: Array, chord: float, span: float) -> Outline:
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * [chord / 2.0, span / 2.0]
    return convex_outline(np.asarray(at) + corners, np.eye(2))


def _span(outline: Outline, at: Array) -> float:
    """Mean span of an outline over a strip of a tenth of its chord about a station, m."""
    low, _, high, top = outline.bounds()
    width = STRIP * (high - low)
    return float((outline ^ _rectangle(at, width, 4.0 * (top - outline.bounds()[1]))).area() / width)


def _attitudes(second: Array, turn: Array, vertices: Array) -> list[Array]:
    """(2, 2) axes within a plate, in the first two columns of ``turn``: fore and aft (athwart on a plate across x), the
    principal axes of its second moments, and the sides of the smallest rectangle.
    """
    ahead = turn[:, :2].T @ np.array([1.0, 0.0, 0.0])
    if np.linalg.norm(ahead) < ACROSS:
        ahead = turn[:, :2].T @ np.array([0.0, 1.0, 0.0])
    ahead /= np.linalg.norm(ahead)
    along = smallest_rectangle(vertices @ turn[:, :2])[0]
    return [np.column_stack([v, [-v[1], v[0]]]) for v in (ahead, np.linalg.eigh(second)[1][:, 1], along)]


def tubes(of: Piece, frames: list[Array]) -> Iterator[Fit]:
    """About every axis of the frames: of the piece's volume, and of its extents along and across the axis."""
    for frame in frames:
        for axis in frame.T:
            turn = about_axis(axis)
            length, *across = of.extents(turn)
            outer = float(np.mean(across)) / 2.0
            inner = outer**2 - of.volume / (np.pi * length)
            if inner > (HOLE * outer) ** 2:
                yield Fit("tube", (outer, float(np.sqrt(inner)), float(length)), turn)


def turned_form(of: Surface, piece: Piece) -> tuple[Turned, Array, Array] | None:
    """The body of revolution with a piece's volume, its rotation and its centre; None where the piece is not round.

    The radius at each station is that in which most of 72 rays from the axis meet the surface (`round_hull`), with as few
    stations as keep every other within 0.2 % of the largest radius.
    """
    spread = np.sqrt(np.linalg.eigvalsh(piece.spread))
    if min(spread[1] / spread[0], spread[2] / spread[1]) > OVAL:
        return None
    hull = round_hull(*of)
    if hull is None or hull.roundness < ROUND:
        return None
    along = (piece.vertices - hull.point) @ hull.rotation[:, 0]
    x = np.concatenate([[along.min()], hull.x, [along.max()]])
    radius = np.concatenate([hull.radius[:1], hull.radius, hull.radius[-1:]])
    selected = np.concatenate([[True], np.diff(x) > APART * np.ptp(x)])
    x, radius = _few(x[selected], radius[selected], CLOSE * float(radius.max()))
    rough, _ = Turned.about_its_centre(x, radius)
    scale = float(np.sqrt(piece.volume / rough.volume))
    if abs(scale - 1.0) > SAME:
        return None
    turn = about_axis(hull.rotation[:, 0])
    if turn[:, 0] @ hull.rotation[:, 0] < 0.0:
        x, radius = -x[::-1], radius[::-1]
    turned, middle = Turned.about_its_centre(x, radius * scale)
    return turned, turn, hull.point + turn[:, 0] * middle


def _few(x: Array, y: Array, within: float) -> tuple[Array, Array]:
    """The points that keep all others within a distance in y of the straight lines between them (Douglas & Peucker 1973)."""
    selected, stack = {0, len(x) - 1}, [(0, len(x) - 1)]
    while stack:
        low, high = stack.pop()
        if high - low < 2:
            continue
        off = np.abs(y[low : high + 1] - np.interp(x[low : high + 1], x[[low, high]], y[[low, high]]))
        worst = low + int(np.argmax(off))
        if off[worst - low] > within:
            selected.add(worst)
            stack += [(low, worst), (worst, high)]
    chosen = sorted(selected)
    return x[chosen], y[chosen]


HOLE, OVAL, ROUND, APART, CLOSE, SAME = 0.2, 1.1, 0.9, 1e-4, 2e-3, 0.03
PLAIN, BAR = 0.02, 5.0
THIN = 0.2
MISFIT, SHARED = 0.1, 0.8
ROUND_PLATE, PLATE_SHARED, FULL = 0.02, 0.6, 0.5
BETTER = 1e-4


@brief
@dataclass(frozen=True, slots=True)
class Likeness:
    """A form and the numbers that chose it.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``tube`` (radius, inner radius, length), ``plate`` (chord, span), ``ellipsoid``
        (semi-axes), ``box`` or ``bar`` (sides), or ``revolution``.
    sizes : tuple of float
        m; of a revolution its stations, then its radii.
    rotation : (3, 3) array
        From the form's axes to the outer ones.
    centre : (3,) array
        m.
    clear : bool
        False where no form is good: the one of least misfit is named, and the piece stays a mesh.
    reason : str
        The test that held, or why none did, in words and numbers.
    shared : float
        Share of the volume within the form; of a plate within its outline.
    misfit : float, optional
        Of a solid form.
    """

    form: str
    sizes: tuple[float, ...]
    rotation: Array
    centre: Array
    clear: bool
    reason: str
    shared: float
    misfit: float | None = None

    @property
    def kind(self) -> str:
        """The form, or ``mesh``."""
        return self.form if self.clear else "mesh"

    @property
    def built(self) -> Form:
        """The form itself."""
        if self.form == "revolution":
            half = len(self.sizes) // 2
            return Turned(self.sizes[:half], self.sizes[half:])
        found: Form = MAKES[self.form](*self.sizes)
        return found


def likeness(of: Solid) -> Likeness:
    """Classify a solid and fit the form.

    Notes
    -----
    A tube where the piece has a hole and a tube of its extents and volume has a misfit of at most 0.1.
    A plate where the mean thickness, volume over area projected along the normal, is under 0.2 of the shorter of mean
    chord and span, whatever its sections and taper, if 0.6 of the volume lies within the plate's outline (a triangle's
    0.69 does, a ring's does not) and it fills half of its convex hull (a frame does not); a disc that a cylinder fits with a misfit under 0.02 is a cylinder.
    Else the cylinder, ellipsoid or box of the piece's volume with the least misfit: error of the length, plus errors of
    the three projected areas over their sum (`Fit.misfit`). Their axes are the principal ones and those of the oriented
    box. A misfit over 0.1, or a form that shares less than 0.8 of the volume with the piece, is no likeness. Where the misfit is
    over 0.02 and the piece is round, the body of revolution that follows its sections is taken if its misfit is less than half.
    A box more than five times as long as wide is a bar.
    """
    piece = Piece.of(surface(of))
    principal = np.linalg.eigh(piece.spread)[1]
    frames = [principal, oriented_box(piece.vertices, principal)[0]]
    if of.genus() > 0:
        hollow = list(tubes(piece, frames))
        if hollow:
            tube, misfit = _least(piece, hollow)
            inside = (of ^ form_solid("tube", tube.sizes, tube.rotation, piece.centre)).volume() / piece.volume
            if misfit <= MISFIT and inside >= SHARED:
                why = f"misfit tube {misfit:.3f}; shares {inside:.0%} of the volume"
                return Likeness("tube", tube.sizes, tube.rotation, piece.centre, True, why, inside, misfit)
    best = [_least(piece, list(fits(piece, frames))) for fits in (cylinders, ellipsoids, boxes)]
    flat = _thin(of, piece, principal[:, ::-1])
    if flat is not None and best[0][1] > ROUND_PLATE:
        thickness = piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span))
        sides = (flat.chord, flat.span, float(piece.extents(flat.rotation)[2]) * 2.0)
        within = (of ^ form_solid("box", sides, flat.rotation, flat.centre)).volume() / piece.volume
        reason = f"mean thickness {thickness:.3f} of the shorter of mean chord and span, under {THIN:g}"
        full = piece.volume / of.hull().volume()
        if within < PLATE_SHARED:
            reason += f"; only {within:.0%} of the volume within its outline, under {PLATE_SHARED:.0%}"
        if full < FULL:
            reason += f"; fills only {full:.0%} of its convex hull, under {FULL:.0%}"
        clear = within >= PLATE_SHARED and full >= FULL
        return Likeness("plate", sides[:2], flat.rotation, flat.centre, clear, reason, within)
    fit, misfit = min(best, key=lambda scored: round(scored[1] / BETTER))
    shared = (of ^ form_solid(fit.form, fit.sizes, fit.rotation, piece.centre)).volume() / piece.volume
    clear = misfit <= MISFIT and shared >= SHARED
    reason = (
        "misfit " + ", ".join(f"{f.form} {value:.3f}" for f, value in best) + f"; shares {shared:.0%} of the volume"
    )
    if not clear or misfit > PLAIN:
        turned = _turned(of, piece, reason)
        if turned is not None and turned.misfit is not None and turned.misfit < (misfit / 2.0 if clear else np.inf):
            return turned
    if not clear:
        reason += f"; bounds {MISFIT:g} and {SHARED:.0%}"
    longest, next_one = sorted(fit.extents)[:0:-1]
    form = "bar" if fit.form == "box" and longest > BAR * next_one else fit.form
    if form == "bar":
        fit = Fit("box", tuple(np.sort(fit.sizes)[::-1]), relabelled_by_length(fit))
    return Likeness(form, fit.sizes, fit.rotation, piece.centre, clear, reason, shared, misfit)


def relabelled_by_length(fit: Fit) -> Array:
    """The axes of a box in the order of its sides, the longest first, right-handed, the first two ahead, starboard or up."""
    first, second = fit.rotation[:, np.argsort(-np.array(fit.sizes), kind="stable")[:2]].T
    x = about_axis(first)[:, 0]
    y = second * np.sign(second[int(np.argmax(np.abs(second) > np.abs(second).max() - 1e-6))])
    return np.column_stack([x, y, np.cross(x, y)])


def _turned(of: Solid, piece: Piece, reason: str) -> Likeness | None:
    """The body of revolution that a piece is, where it is one."""
    found = turned_form(surface(of), piece)
    if found is None:
        return None
    form, turn, centre = found
    areas = piece.projected(turn)
    own = np.array([shadow(form, axis) for axis in np.eye(3)])
    misfit = float(np.abs(own - areas).sum() / areas.sum())
    shared = (of ^ revolved(np.array(form.stations), np.array(form.radii), turn, centre)).volume() / piece.volume
    if misfit > MISFIT or shared < SHARED:
        return None
    reason = f"revolution {misfit:.3f}, shares {shared:.0%} of the volume; {reason}"
    return Likeness("revolution", (*form.stations, *form.radii), turn, centre, True, reason, min(shared, 1.0), misfit)


def _thin(of: Solid, piece: Piece, turn: Array) -> PlateFit | None:
    """The plate across the third column of ``turn``, if it is thin; of equal area, a square has the longest short side."""
    if piece.volume / float(piece.projected(turn)[2]) ** 1.5 >= THIN:
        return None
    flat = plate_fit(surface(of), turn)
    if not flat.span > 0.0:
        return None
    return flat if piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span)) < THIN else None


def _least(piece: Piece, fits: list[Fit]) -> tuple[Fit, float]:
    """The fit of least misfit, the first of those that are as good."""
    scored = [(fit, fit.misfit(piece)) for fit in fits]
    return min(scored, key=lambda pair: round(pair[1] / BETTER))
