"""Panels on the real surface in unbounded fluid or beside a wall: potential formulation, three refinements, extrapolated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.family import family
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.ring_sheets import ring_sheets
from coeflab.bodies.outline import RingWing
from coeflab.bodies.panel_solver import influence
from coeflab.bodies.panel_solver.panels import (
    bisected,
    panels_of,
    sharpness,
    side_of,
    slenderness,
    slivers,
    split_in_four,
    thin_share,
    unmatched_edges,
)
from coeflab.bodies.panel_solver.refinement import Refinement, refined
from coeflab.bodies.panel_solver.solve import PanelSolution, memory_needed, panel_added_mass
from coeflab.bodies.panel_solver.volume_gap import volume_gap
from coeflab.bodies.panel_solver.wall import WALL_NAMES, WALLS, Wall
from coeflab.bodies.recognition import of_mesh
from coeflab.bodies.shape import Part, Parts, Plate, Shape
from coeflab.bodies.volume_moments import displaced
from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.machine import compiles, physical_memory, stage
from coeflab.core.options import bounded, measured, one_of, parse_options, share
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.law.added_mass import AddedMass

summary = "triangular panels on the surface, potential formulation, Richardson extrapolation with an error estimate"
citations = ("newman1977", "hess1967", "vanoosterom1983", "wilton1984", "roache1998", "cohensteiner2003")
reproducible: Mapping[str, str] = {"kernel": "numpy"}
takes_surface = takes_sheets = True
places: Mapping[str, int] = {"": 1}
FEWEST_PANELS, MOST_PANELS = 1_000, 32_000
OVERSHOOT = 1.1
THIN, THIN_SHARE, SHARP = 0.05, 0.5, 0.5
RESOLVED, RAISED = 0.05, 2.0  # of the surface may be left thinner than panels that were raised; by how much at a time
COMPILE_FROM = 5_000
MOST_SHEETS, RATIO, INSIDE = 4_096, 4, 2.0 * np.pi
SAME, NOISE = 1e-6, 2e-3
FEW_CORNERS = 200
NAMES = ("Xudot", "Yvdot", "Zwdot", "Kpdot", "Mqdot", "Nrdot")
FASTER = 2.0  # of the panels: a quarter of the error at second order, half at first
MATTERS = 0.01  # of a diagonal entry: nobody needs less


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the method.

    Attributes
    ----------
    panels : int
        On the finest mesh, about; 32,000 need 4.2 GiB. A body that is thinner than they are large on most of its surface gets
        more, up to 32,000 or what memory holds.
    error : float
        Raise the panels, up to 32,000 or what memory holds, until the error estimate of every diagonal entry is below this
        share of it; 0: the panels as asked.
    extrapolate : str
        ``yes``: with meshes of a quarter and a sixteenth of the panels. ``no``: the one mesh, error unknown.
    kernel : str
        ``numpy``, ``numba`` (compiled; the extra "fast"), or ``auto``: numba where it is installed and there are more
        than 5,000 panels. Both give the same numbers to 1e-6.
    wall : str
        ``bottom``: a flat bottom below. ``surface_zero`` and ``surface_infinite``: a free surface above, at zero and at
        infinite frequency. ``none``: unbounded fluid.
    distance : float
        From the body's reference point to the wall.
    """

    panels: int = bounded(6_000, FEWEST_PANELS, MOST_PANELS)
    error: float = share(0.0, 0.0, 0.5)
    extrapolate: str = one_of("yes", "yes", "no")
    kernel: str = one_of("auto", "auto", "numpy", "numba")
    wall: str = one_of("none", "none", *WALLS)
    distance: float = measured(0.0, 0.0, 1e4, "length")


@brief
@dataclass(frozen=True, slots=True)
class _Panelled:
    """A body as panels: from the finest on, closed surfaces and sheets without thickness; and what stands for it whole."""

    meshes: tuple[tuple[Array, Array], ...]
    gated: TriangleMesh | None
    edges: bool

    @property
    def finest(self) -> Array:
        return np.concatenate(self.meshes[0])

    @property
    def count(self) -> int:
        return len(self.finest)

    @property
    def sheeted(self) -> int:
        return len(self.meshes[0][1])


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass by the panel method, about the body's reference point.

    Parameters
    ----------
    body : Body
        Of any closed shape; plates among its parts, and sheets of a mesh, are dipole panels without thickness.
    density : float
        kg/m^3.
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        No shape, an open surface, a degenerate face, a body too thin, one that reaches to the wall, more panels than
        memory, or no numba where it was asked for.
    """
    chosen = parse_options(Options, options or {}, "panel")
    shape = body.require_shape()
    if isinstance(shape, TriangleMesh) and (rings := _rings_alone(shape)):
        return _of_sheets(body, shape, ring_sheets(rings), density, options or {})
    panelled = _resolved(shape, chosen)
    _fits(panelled.count)
    while True:
        found, worst = _found(body, shape, panelled, density, chosen)
        if chosen.error == 0.0 or worst <= chosen.error:
            return found
        finer = _finer(shape, panelled, worst / chosen.error, chosen)
        if finer is None:
            words = (
                f"ERROR NOT REACHED: {chosen.error:.2g} was asked for, {worst:.2g} is left at {panelled.count:,} panels"
            )
            return replace(found, statements=(words, *found.statements))
        panelled = finer


def _rings_alone(shape: TriangleMesh) -> tuple[RingWing, ...]:
    """The rings of a mesh that is nothing else, with a wall thinner than the smallest panels; none of another."""
    if not len(shape.faces) or len(shape.sheets):
        return ()
    area = shape.integrals.area
    if 2.0 * shape.volume / area > side_of(area, MOST_PANELS):
        return ()
    seen = of_mesh(shape)
    return seen.rings if not (seen.hulls or seen.foils or seen.bluff) else ()


def _of_sheets(body: Body, shape: Shape, sheets: TriangleMesh, density: float, options: Mapping[str, Any]) -> AddedMass:
    """Added mass of a wall by its middle surface; what the thickness moves is in the error as the water that it displaces."""
    found = added_mass(replace(body, shape=sheets), density, options)
    thick = displaced(shape, density, found.reference_point)
    error = np.zeros((6, 6)) if found.error is None else found.error
    words = "a wall thinner than its panels: dipoles on its middle surface, the water in its thickness is in the error"
    root = np.sqrt(thick)
    return replace(found, error=error + np.outer(root, root), statements=(words, *found.statements))


def _finer(shape: Shape, panelled: _Panelled, above: float, chosen: Options) -> _Panelled | None:
    """Panels for an error so many times smaller, at first order; None where the machine or the method ends."""
    if not np.isfinite(above):
        return None
    return _more(shape, panelled, float(np.clip(above**2, 1.5, 4.0)), chosen)


def _more(shape: Shape, panelled: _Panelled, factor: float, chosen: Options) -> _Panelled | None:
    """So many times the panels; None where the machine or the method ends."""
    there = physical_memory()
    most = MOST_PANELS if there is None else min(MOST_PANELS, int(np.sqrt(max(there - memory_needed(0), 0) / 4.0)))
    wanted = min(int(panelled.count * factor), most)
    if wanted < 1.2 * panelled.count:
        return None
    finer = _panelled(shape, wanted, chosen)
    # A family of similar meshes overshoots where panels are halved in sets of equals.
    return finer if 1.2 * panelled.count <= finer.count <= OVERSHOOT * most else None


def _resolved(shape: Shape, chosen: Options) -> _Panelled:
    """Panels as asked; more where the body is thinner than they are large on most of its surface, as a tube or a ring is.

    So too where no coarser mesh can be made of these, which alone would leave the error unknown.
    """
    panelled = _panelled(shape, chosen.panels, chosen)
    most = THIN_SHARE
    while _thin_share(panelled) > most or (len(panelled.meshes) == 1 and chosen.extrapolate == "yes"):
        finer = _more(shape, panelled, RAISED, chosen)
        if finer is None:
            break
        panelled, most = finer, RESOLVED if _thin_share(panelled) > most else most
    return panelled


def _thin_share(panelled: _Panelled) -> float:
    closed = panelled.meshes[0][0]
    return thin_share(panels_of(closed)) if len(closed) else 0.0


def _found(body: Body, shape: Shape, panelled: _Panelled, density: float, chosen: Options) -> tuple[AddedMass, float]:
    """The matrix, and its largest relative error on the diagonal."""
    wall = _wall(body, panelled, chosen)
    closed = [closed for closed, _ in panelled.meshes]
    thin = _thin(panelled)
    # On the axis of a body of revolution, so that turning about it stays apart from all else.
    centre = shape.centre_of_volume
    solutions = []
    for corners, sheets in panelled.meshes:
        stage(f"flow about {len(corners) + len(sheets):,} panels")
        fast = _compiled(chosen.kernel, len(corners))
        solutions.append(panel_added_mass(corners, centre, fast, sheets, wall))
    found = refined([s.matrix for s in solutions], [s.count for s in solutions], panelled.edges, panelled.sheeted > 0)
    gaps: tuple[str, ...] = ()
    if panelled.gated is not None:
        gap = volume_gap(body, panelled.gated, closed)
        short = gap.cost(found.matrix)
        if panelled.edges and isinstance(shape, TriangleMesh) and shape.remade is None:
            short = short + gap.hidden(found.matrix, found.used)
        found, gaps = replace(found, error=found.error + short), (gap.summary,)
    alike = _alike(shape, panelled, centre, wall, found.matrix)
    found = replace(found, matrix=alike.applied(found.matrix), error=alike.largest(found.error))
    judged, worst = _judged(found, len(panelled.meshes), chosen.extrapolate == "yes")
    fast = _compiled(chosen.kernel, len(closed[0]))
    statements = (*_notes(solutions, panelled, fast, thin), *gaps, *judged)
    if wall is not None:
        near = wall.distance(panelled.finest.reshape(-1, 3))
        statements = (
            f"near a wall: {WALL_NAMES[chosen.wall]}, {chosen.distance:g} m from the reference point, {near:.3g} m from the body",
            *statements,
        )
    error = None if len(panelled.meshes) == 1 else density * found.error
    unconverged = any(not s.converged for s in solutions)
    own = AddedMass(
        density * found.settled, centre, body.datum, body.name, "panel", statements, error, rough=unconverged
    )
    there = own.about(body.reference_point)
    matrix = alike.about(body.reference_point).applied((there.matrix + there.matrix.T) / 2.0)
    return replace(there, matrix=matrix), worst


def _wall(body: Body, panelled: _Panelled, chosen: Options) -> Wall | None:
    if chosen.wall == "none":
        return None
    side, factor = WALLS[chosen.wall]
    point = body.reference_point + np.array([0.0, 0.0, side * chosen.distance])
    wall = Wall(point, np.array([0.0, 0.0, side]), factor)
    reach = float(np.max((panelled.finest.reshape(-1, 3) - body.reference_point) @ wall.normal))
    if reach >= chosen.distance:
        raise input_error("bodies.wall_reference_point", column="panel.distance", distance=chosen.distance, reach=reach)
    return wall


def _panelled(shape: Shape, panels: int, chosen: Options) -> _Panelled:
    """Families of closed parts and of sheets; what of a sheet lies within a closed part is left out."""
    most = 3 if chosen.extrapolate == "yes" else 1
    solid, sheets = _split(shape)
    area = float(panels_of(sheets).area.sum()) if len(sheets) else 0.0
    if solid is None:
        alone = _sheets(sheets, min(panels // 2, MOST_SHEETS), most)
        return _Panelled(tuple((np.zeros((0, 3, 3)), t) for t in alone), None, False)
    gated = solid if isinstance(solid, TriangleMesh) else meshed(solid, panels)
    _gate(gated, remeshed=gated is not solid)
    edges = sharpness(gated.vertices, gated.faces) > SHARP
    if not len(sheets):
        closed = family(solid, panels, most)
        return _Panelled(tuple((c, sheets) for c in closed), gated, edges)
    part = min(max(int(2.0 * panels * area / (gated.integrals.area + 2.0 * area)), panels // 20), MOST_SHEETS)
    pairs = zip(family(solid, max(panels - part, panels // 2), most), _sheets(sheets, part, most), strict=False)
    return _Panelled(tuple((c, t[~_within(t, c)]) for c, t in pairs), gated, edges)


def _split(shape: Shape) -> tuple[Shape | None, Array]:
    """What displaces water, and the triangles of what has no thickness, (n, 3, 3)."""
    if isinstance(shape, TriangleMesh):
        return (shape if len(shape.faces) else None), shape.vertices[shape.sheets]
    if not isinstance(shape, Parts):
        return shape, np.zeros((0, 3, 3))
    flat = [p for p in shape.parts if isinstance(p.form, Plate)]
    solid = tuple(p for p in shape.parts if not isinstance(p.form, Plate))
    sheets = [_rectangle(p) for p in flat]
    return (Parts(solid) if solid else None), np.concatenate(sheets) if sheets else np.zeros((0, 3, 3))


def _rectangle(part: Part) -> Array:
    """Right triangles of a plate, about as long as wide, four to each cell."""
    form = part.form
    if not isinstance(form, Plate):
        raise InputError(f"the part {shown(part.name)}", "a plate")
    short = min(form.chord, form.span)
    number = [max(1, round(side / short)) for side in (form.chord, form.span)]
    x, y = (np.linspace(-0.5, 0.5, n + 1) * s for n, s in zip(number, (form.chord, form.span), strict=True))
    out = []
    for i in range(number[0]):
        for j in range(number[1]):
            ring = [(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])]
            middle = np.mean(ring, axis=0)
            out += [[ring[k], ring[(k + 1) % 4], middle] for k in range(4)]
    flat = np.array(out)
    local = np.concatenate([flat, np.zeros((len(flat), 3, 1))], axis=2)
    return np.asarray(local @ part.rotation.T + part.centre)


def _sheets(corners: Array, count: int, most: int) -> list[Array]:
    """Sheets at up to three counts, each a quarter of the one before; the rims stay where they are."""
    coarse = bisected(corners, count // RATIO**2)
    out = [coarse]
    while len(out) < 3 and len(out[0]) * RATIO <= max(count * 2, len(coarse)):
        out.insert(0, split_in_four(out[0]))
    return out[:most]


def _within(sheets: Array, closed: Array) -> NDArray[np.bool_]:
    """Which panels of a sheet lie inside closed surfaces, by the solid angle of these."""
    return np.asarray(influence.seen_by(sheets.mean(axis=1), panels_of(closed))[0].sum(axis=1) > INSIDE)


def _gate(mesh: TriangleMesh, remeshed: bool) -> None:
    """Refuse what the method cannot do; faces without area where parts that we meshed were united are just left out."""
    flat = int(np.count_nonzero(slivers(mesh.vertices[mesh.faces])))
    if flat and not remeshed:
        raise InputError(f"{flat} faces without area", "triangles", advice="Clean the mesh of degenerate faces.")
    torn = unmatched_edges(mesh.faces)
    if torn:
        raise input_error("bodies.edges_shared_two", torn=torn)
    ratio = slenderness(mesh.integrals.second_moments)
    if ratio < THIN:
        raise input_error("bodies.body_whose_smallest", ratio=ratio, thin=THIN)


def _thin(panelled: _Panelled) -> float:
    """Share of the surface on which panels are larger than the body is thick."""
    share = _thin_share(panelled)
    if share > THIN_SHARE:
        raise input_error(
            "bodies.body_thinner_than", column="panels", share=share, count=panelled.count, thin_share=THIN_SHARE
        )
    return share


def _compiled(kernel: str, panels: int) -> bool:
    if kernel == "numba" and not compiles():
        raise input_error("bodies.compiled_kernel_without")
    return (kernel == "numba" or (kernel == "auto" and panels > COMPILE_FROM)) and compiles()


def _fits(panels: int) -> None:
    """Refuse more panels than the machine's memory holds, where the system tells that."""
    there = physical_memory()
    needed = memory_needed(panels)
    if there is not None and needed > there:
        raise input_error(
            "bodies.panels_need_gib", column="panels", panels=panels, needed=needed / 2**30, there=there / 2**30
        )


def _notes(solutions: Sequence[PanelSolution], panelled: _Panelled, compiled: bool, thin: float) -> list[str]:
    counts = " and ".join(f"{s.count:,}" for s in solutions)
    kernel = "compiled (numba)" if compiled else "plain (numpy)"
    out = [
        f"{counts} flat panels, direct formulation, kernel {kernel}; asymmetry before symmetrising "
        f"{solutions[0].asymmetry:.1e} of the largest entry"
    ]
    if panelled.sheeted:
        out.append(f"{panelled.sheeted:,} of them dipole panels of plates and sheets, without thickness")
    unconverged = [s for s in solutions if not s.converged]
    if unconverged:
        out.append(
            f"NOT CONVERGED: {unconverged[0].count:,} panels left a residual of {unconverged[0].residual:.1e}; do not use it"
        )
    if thin > 0.0:
        out.append(
            f"on {thin:.1%} of the surface the body is thinner than its panels are large: thin parts and sharp edges are less exact"
        )
    return out


def _judged(found: Refinement, meshes: int, asked: bool) -> tuple[list[str], float]:
    """What the refinements say, in words; and the largest relative error on the diagonal."""
    if meshes == 1:
        return [
            "one mesh: its error is unknown" + ("; ask for more panels to have coarser ones" if asked else "")
        ], np.inf
    live = ~found.void & (np.diag(found.matrix) > 0.0)
    relative = np.where(live, np.diag(found.error) / np.where(live, np.diag(found.matrix), 1.0), 0.0)
    worst = float(relative.max(initial=0.0))
    estimate = f"error estimate at most {worst:.2g} of a diagonal entry"
    estimate += f", that of {NAMES[int(relative.argmax())]}" if np.any(live) else ""
    if found.used is None:
        out = [f"the differences between meshes barely shrink: not extrapolated, {estimate}"]
    elif found.observed is None:
        out = [f"extrapolated with order {found.used:.2g} from two meshes, order not observed, {estimate}"]
    else:
        edged = (
            "" if found.used == 2.0 else ", as with edges: the error does not fall as the square of the panels' size"
        )
        out = [f"extrapolated with order {found.used:.2g}, {estimate}; observed order {found.observed:.1f}{edged}"]
    void = found.void & (np.diag(found.error) > 0.0)
    if np.any(void):
        names = ", ".join(np.array(list("uvwpqr"))[void])
        out.append(f"set to zero, below its error: {names}")
    return out, worst


@dataclass(frozen=True, slots=True)
class _Alike:
    """Mirrors that leave the body and its walls as they are: what they make vanish is zero, and pairs are equal.

    Attributes
    ----------
    centre : (3,) array
        A point on all of them, m.
    mirrors : tuple of (3, 3) arrays
        Reflections along the axes and in the planes between two of them.
    size : float
        m.
    """

    centre: Array
    mirrors: tuple[Array, ...]
    size: float

    def about(self, point: Array) -> _Alike:
        """Those of them that another point lies on."""
        off = point - self.centre
        selected = tuple(g for g in self.mirrors if np.max(np.abs(g @ off - off)) <= 1e-9 * self.size)
        return _Alike(point, selected, self.size)

    def applied(self, matrix: Array) -> Array:
        """The mean of the matrix and its mirror image, for one mirror after the other; sums of opposites are exact zeros."""
        out = matrix
        for g in self.mirrors:
            six = _six(g)
            out = (out + six.T @ out @ six) / 2.0
        return self._equalled(out)

    def largest(self, error: Array) -> Array:
        """Errors of entries that change places: the larger of both."""
        out = error
        for g in self.mirrors:
            six = np.abs(_six(g))
            out = np.maximum(out, six.T @ out @ six)
        return np.asarray(out)

    def _equalled(self, matrix: Array) -> Array:
        """With two swaps of axes all three are alike: their mean, so that they are equal to the last digit."""
        if sum(abs(np.trace(g) - 1.0) < 1e-12 and g[0, 0] * g[1, 1] * g[2, 2] == 0.0 for g in self.mirrors) < 2:
            return matrix
        out = matrix.copy()
        for k in (slice(0, 3), slice(3, 6)):
            np.fill_diagonal(out[k, k], np.diag(matrix[k, k]).mean())
        return np.asarray(out)


def _six(mirror: Array) -> Array:
    """(6, 6) what a mirror does to velocities and, as axial vectors, to rates."""
    out = np.zeros((6, 6))
    out[:3, :3], out[3:, 3:] = mirror, float(np.linalg.det(mirror)) * mirror
    return np.round(out)


def _alike(shape: Shape, panelled: _Panelled, centre: Array, wall: Wall | None, matrix: Array) -> _Alike:
    """Mirrors that take every corner of the body, as it is or as it is meshed, to another one.

    A surface whose corners do not pair, as scanners and triangulators leave it, is held to its moments of volume and to
    the matrix, and only for the planes of the axes.
    """
    from scipy.spatial import cKDTree

    from coeflab.bodies.mirror_planes import mirrors

    given = panelled.gated if panelled.gated is not None and not panelled.sheeted else None
    corners = given.vertices if given is not None else np.unique(panelled.finest.reshape(-1, 3), axis=0)
    away = corners - centre
    size = float(np.ptp(away, axis=0).max())
    tree = cKDTree(away)
    moments = mirrors(shape) if given is not None else (False, False, False)
    few = away[:: max(1, len(away) // FEW_CORNERS)]

    def pairs(g: Array) -> bool:
        """Whether every corner's image is a corner; a few tell most that it is not."""
        return all(
            float(tree.query(some @ g.T, distance_upper_bound=2.0 * SAME * size)[0].max()) <= SAME * size
            for some in (few, away)
        )

    out = []
    for k in range(3):
        g = np.eye(3)
        g[k, k] = -1.0
        six, root = _six(g), np.sqrt(np.abs(np.diag(matrix)))
        small = np.abs(matrix - six.T @ matrix @ six) <= 2.0 * NOISE * np.outer(root, root)
        if pairs(g) or (moments[k] and np.all(small)):
            out.append(g)
    for k in range(3):
        g = np.eye(3)[[k, (k + 2) % 3, (k + 1) % 3]][np.argsort([k, (k + 1) % 3, (k + 2) % 3])]
        if pairs(g):
            out.append(g)
    if wall is not None:
        out = [g for g in out if np.allclose(g @ wall.normal, wall.normal)]
    return _Alike(centre, tuple(out), size)


def finer(found: AddedMass, given: Mapping[str, Any]) -> Finding | None:
    """What about half of the error costs; None where the error is unknown, or below 1 %.

    Parameters
    ----------
    found : AddedMass
    given : mapping
        Options of the method as they were typed.

    Notes
    -----
    At first order, the lowest, half the error takes panels half as long: four times as many, 16 times the time and memory.
    """
    if found.error is None:
        return None
    own, half = np.diag(found.matrix), np.diag(found.error)
    live = own > half
    worst = float(np.max(np.divide(half, own, out=np.zeros_like(own), where=live), initial=0.0))
    if worst <= MATTERS:
        return None
    panels = parse_options(Options, dict(given), "panel").panels
    more = min(int(panels * FASTER**2), MOST_PANELS)
    if more <= panels:
        return Finding.of("added_mass.finest", found.body, Severity.NOTE, statistic=worst, panels=panels)
    left = worst * float(np.sqrt(panels / more))
    return Finding.of(
        "added_mass.finer", found.body, Severity.NOTE, statistic=worst, advice=f"--method panel --panels {more}",
        panels=more, left=left, times=float((more / panels) ** 2), memory=memory_needed(more) / 2**30,
    )  # fmt: skip
