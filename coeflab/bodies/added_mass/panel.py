"""Panels on the real surface in unbounded fluid: potential formulation, three refinements, extrapolated.

Added mass at vanishing panel size from two or three refinements, with an estimate of what is left.

Richardson extrapolation (Roache 1998) with one of two orders that theory knows: 2 on a smooth body, 4/3 where a
right-angled edge makes the potential grow as the power 2/3 of the distance from it. What three refinements show decides;
on a body with edges it is 4/3 at the most, and what the other order would have given is within the estimate.
What is left is estimated by the difference of the extrapolations from the finer and from the coarser pair. Were the true
order p, that would be 2^p - 1 times the error when panels are halved: at least the error itself for every p from 1 on;
below 1 the rest is made up for, and Roache's factor of 1.25 is kept. Two refinements show no order: his factor of 3 on
the correction. It is never taken below a quarter of the correction,
nor below a tenth of the largest of a diagonal entry, each over its size: differences can cross zero by chance. Of two
refinements, which cannot tell, no entry has less than the median.

Meshes of one body at three panel counts, as similar to each other as they can be had.

How far the volume of panels is from that of the body they stand for, and what that may cost its added mass.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.decimation import decimated
from coeflab.bodies.mesh.mesh import TriangleMesh, enclosed, facet_deficit, mesh_integrals
from coeflab.bodies.mesh.meshing import FEWEST, meshed
from coeflab.bodies.mesh.solids import divided, solid, surface
from coeflab.bodies.mesh.topology import crossing_faces
from coeflab.bodies.panels.added_mass import PanelSolution, memory_needed, panel_added_mass
from coeflab.bodies.panels.influence import (
    bisected,
    panels_of,
    sharpness,
    side_of,
    slenderness,
    slivers,
    split_in_four,
    thin_share,
    unfit_share,
    unmatched_edges,
)
from coeflab.bodies.shape import Shape
from coeflab.core.errors import InputError
from coeflab.core.machine import compiles, physical_memory, stage
from coeflab.core.options import bounded, one_of, parse_options
from coeflab.core.types import Array, brief
from coeflab.law.added_mass import AddedMass

RATIO = 4  # of panels from rung to rung: panels half as long
RUNGS, LEAST_STEP = 28, 3
LEAST, HIGHEST = 0.6, 1.1
PRICE = 0.1  # of fewer panels at the top, in units of a ratio that is off by one e-fold
MOST_UNFIT, MOST_SPLIT, CHANGE = 0.2, 40, 0.08


def family(shape: Shape, panels: int, most: int = 3) -> tuple[Array, ...]:
    """Corners of one to three meshes, the finest first, each with about a quarter of the panels of the one before.

    Parameters
    ----------
    shape : Shape
    panels : int
        Of the finest, about: from 0.6 to 1.1 times that, so that the coarser ones can be similar. Of a mesh, a quarter
        and more of as many facets are kept, and much fewer divided, to up to twice as many, where they are compact;
        else long facets are split, and what comes of that is decimated.
    most : int
        1 for the finest alone, which is then not chosen for its likeness to others; or 3.

    Returns
    -------
    tuple of (n, 3, 3) arrays
        Panel, corner, component, m. Fewer than three where no coarser mesh can be made.

    Raises
    ------
    InputError
        The shape cannot be meshed.
    """
    if isinstance(shape, TriangleMesh) and shape.remade is None:
        return _of_mesh(shape, panels, most)
    finest = meshed(shape, panels)
    if most == 1:
        return (_corners(finest),)
    ladder = {len(finest.faces): finest}
    for count in np.geomspace(max(panels / 1.5 / RATIO**2, FEWEST), panels, RUNGS).astype(int):
        try:
            rung = meshed(shape, int(count))
        except InputError:
            continue
        ladder[len(rung.faces)] = rung
    return tuple(_corners(ladder[n]) for n in _best(sorted(ladder, reverse=True), panels))


def _corners(mesh: TriangleMesh) -> Array:
    """Of the faces that have an area; decimation can leave others, which are nothing to integrate over."""
    corners = mesh.vertices[mesh.faces]
    return np.asarray(corners[~slivers(corners)])


def _best(counts: list[int], panels: int) -> tuple[int, ...]:
    """Three counts in steps of four; a slightly smaller finest one is a price worth paying for exact steps."""

    def miss(steps: tuple[int, ...]) -> float:
        ratios = np.array(steps[:-1]) / np.array(steps[1:])
        return float(np.abs(np.log(ratios / RATIO)).sum() + PRICE * np.log(panels / steps[0]))

    fine = [n for n in counts if LEAST * panels <= n <= HIGHEST * panels] or counts[:1]
    triples = [t for t in product(fine, counts, counts) if t[0] >= LEAST_STEP * t[1] >= LEAST_STEP**2 * t[2]]
    if triples:
        return min(triples, key=miss)
    pairs = [p for p in product(fine, counts) if p[0] >= LEAST_STEP * p[1]]
    return min(pairs, key=miss) if pairs else (fine[0],)


def _of_mesh(mesh: TriangleMesh, panels: int, most: int) -> tuple[Array, ...]:
    """Its own facets where they are fit for panels, divided or as they are; else, and for all that is coarser, others."""
    stage(f"panels from {len(mesh.faces):,} faces")
    own = _corners(mesh)
    if len(own) * RATIO**2 <= panels:
        coarse = bisected(own, panels // RATIO**2)
        if unfit_share(coarse) <= MOST_UNFIT:
            middle = split_in_four(coarse)
            return (split_in_four(middle), middle, coarse)[:most]
    elif panels <= RATIO * len(own) <= RATIO * panels and unfit_share(own) <= MOST_UNFIT:
        found = (own, *_coarser(mesh, most - 1))
        if len(found) == most:
            return found
    finest = meshed(_split(mesh, panels), panels)
    return _corners(finest), *_coarser(finest, most - 1)


def _split(mesh: TriangleMesh, panels: int) -> TriangleMesh:
    """The same surface without long facets, which decimation would leave long; itself where it is not closed as a solid."""
    try:
        whole = solid(mesh.vertices, mesh.faces)
    except ValueError:
        return mesh
    parted = divided(whole, side_of(mesh.integrals.area, panels), MOST_SPLIT * panels)
    return TriangleMesh(*surface(parted), mesh.exact_volume)


def _coarser(mesh: TriangleMesh, most: int) -> list[Array]:
    """Decimations to a quarter and a sixteenth; fewer where the body does not bear it, or parts would come to cross."""
    vertices, faces, out = mesh.vertices, mesh.faces, list[Array]()
    while len(out) < most:
        before = len(faces)
        vertices, faces = decimated(vertices, faces, max(before // RATIO, FEWEST))
        if LEAST_STEP * len(faces) > before or abs(mesh_integrals(vertices, faces).volume / mesh.volume - 1.0) > CHANGE:
            break
        if crossing_faces(vertices, faces):
            break
        corners = vertices[faces]
        out.append(np.asarray(corners[~slivers(corners)]))
    return out


STRONGEST, SAME_BODY = 2.0, 0.05


@dataclass(frozen=True, slots=True)
class VolumeGap:
    """Volume of panels over that of the body, less one.

    Attributes
    ----------
    finest : float
        Of the finest panels as they are.
    left : float
        Of all panels, extrapolated as the square of their size: what no refinement of these panels takes away.
    body : str
        Whose volume that is, in words.
    meshes : int
        How many there were; one alone has no error estimate.
    step : float
        Of the second mesh, less that of the finest; 0 where there is one.
    ratio : float
        Of the panels' sizes in these two.
    """

    finest: float
    left: float
    body: str
    meshes: int
    step: float
    ratio: float

    def cost(self, matrix: Array) -> Array:
        """(6, 6) what may be missing from an added mass: twice what is left of the volume, of the size of each entry.

        Of a long spheroid that is too thin all over, the entry along x goes with the square of the volume, those across
        with the volume itself; of one that is too small all over, the moments with its power 5/3.
        """
        root = np.sqrt(np.abs(np.diag(matrix)))
        return np.asarray(STRONGEST * abs(self.left) * np.outer(root, root))

    def hidden(self, matrix: Array, order: float | None) -> Array:
        """(6, 6) what thinning may hide: with its edges a coarse mesh loses volume, against what its large panels add.

        As `cost`, of the step in volume, and carried on as the extrapolation of this order carries differences.

        Parameters
        ----------
        matrix : (6, 6) array
        order : float or None
            None where there is no extrapolation; 1 is taken then.
        """
        if self.meshes == 1:
            return np.zeros((6, 6))
        root = np.sqrt(np.abs(np.diag(matrix)))
        carried = self.ratio ** (order or 1.0) - 1.0
        return np.asarray(STRONGEST * abs(self.step) / carried * np.outer(root, root))

    @property
    def said(self) -> str:
        """The same in words."""
        out = f"volume of the finest panels {self.finest:+.2%} from {self.body}"
        if self.meshes == 1:
            return out
        return f"{out}, {self.left:+.2%} once extrapolated: included in the error estimate"


def volume_gap(body: Body, mesh: TriangleMesh, meshes: Sequence[Array]) -> VolumeGap:
    """Hold panels against the volume of the body's equations; else as stated, within 5 %; else as its facets suggest.

    Parameters
    ----------
    body : Body
    mesh : TriangleMesh
        The body's own, or one made of its shape.
    meshes : sequence of (n, 3, 3) arrays
        Panel, corner, component, m; the finest first.
    """
    volumes = [enclosed(corners) for corners in meshes]
    whole, name = _whole(body, mesh)
    step, ratio = 0.0, 1.0
    if len(meshes) > 1:
        step, ratio = (volumes[1] - volumes[0]) / whole, float(np.sqrt(len(meshes[0]) / len(meshes[1])))
    finest = volumes[0] / whole - 1.0
    left = finest - step / (ratio**2 - 1.0) if len(meshes) > 1 else finest
    return VolumeGap(finest, left, name, len(meshes), step, ratio)


def _whole(body: Body, mesh: TriangleMesh) -> tuple[float, str]:
    if mesh.exact_volume is not None:
        return mesh.exact_volume, "the body's by its equations"
    # The first configuration is computed from the shape itself; the others were stated.
    stated = [(abs(mesh.volume / c.volume - 1.0), c.volume, c.name) for c in body.configurations[1:] if c.volume]
    if body.shape is mesh and stated:
        off, volume, name = min(stated)
        if off <= SAME_BODY:
            return volume, f"that of {name}"
    smooth = mesh.volume + facet_deficit(mesh.vertices, mesh.faces)
    return smooth, "a smooth surface through the corners of its facets, estimated by the angles between these"


SMOOTH, EDGED = 2.0, 4.0 / 3.0
BETWEEN, LOWEST = 1.25, 0.5
LEAST_SHARE, LEAST_OF_WORST, ROUNDING = 0.25, 0.1, 1e-5
SUBSTANTIAL, NOISE = 0.01, 1e-7
SAFETY, TWO_ONLY, FINEST_ONLY = 1.25, 3.0, 3.0


@brief
@dataclass(frozen=True, slots=True)
class Refinement:
    """What a sequence of panel counts says.

    Attributes
    ----------
    matrix : (6, 6) array
        Extrapolated, or of the most panels where the differences do not shrink.
    error : (6, 6) array
        Estimate for each entry; NaN from a single count.
    observed : float or None
        Order of three counts, over all entries; None from fewer.
    used : float or None
        Order of the extrapolation; None where there is none.
    """

    matrix: Array
    error: Array
    observed: float | None
    used: float | None

    @property
    def void(self) -> NDArray[np.bool_]:
        """(6,) bool: motions whose own entry is below its error.

        So it is with a body of revolution turning about its axis: only the facets move water.
        """
        return np.asarray(np.diag(self.matrix) <= np.nan_to_num(np.diag(self.error)))

    @property
    def settled(self) -> Array:
        """The matrix with zeros in the rows and columns of such motions, and for what is rounding."""
        noise = np.abs(self.matrix) <= NOISE * _scale(self.matrix)
        return np.where(noise | np.logical_or.outer(self.void, self.void), 0.0, self.matrix)


def refined(matrices: Sequence[Array], counts: Sequence[int], edges: bool = False) -> Refinement:
    """Judge one to three matrices.

    Parameters
    ----------
    matrices : sequence of (6, 6) arrays
        About one point, from the most panels to the fewest.
    counts : sequence of int
        Panels of each.
    edges : bool
        Whether the body has sharp edges: the order is not 2 then, whatever three refinements show.
    """
    finest = matrices[0]
    if len(matrices) == 1:
        return Refinement(finest, np.full((6, 6), np.nan), None, None)
    scale = _scale(finest)
    # Sizes of panels go with the root of their number.
    ratios = [float(np.sqrt(a / b)) for a, b in pairwise(counts)]
    changes = [a - b for a, b in pairwise(matrices)]
    if len(matrices) == 2:
        used = EDGED if edges else SMOOTH
        correction = changes[0] / (ratios[0] ** used - 1.0)
        limit = finest + correction
        return Refinement(limit, _floored(TWO_ONLY * np.abs(correction), limit, scale, like_most=True), None, used)
    # A motion that only facets resist would drown the order of the others.
    live = np.abs(np.diag(changes[0])) < 0.5 * np.diag(finest)
    if not np.any(live):
        return Refinement(finest, _floored(FINEST_ONLY * np.abs(changes[0]), finest, scale), None, None)
    shared = np.logical_and.outer(live, live)
    gain = np.linalg.norm((changes[1] / scale)[shared]) / np.linalg.norm((changes[0] / scale)[shared])
    observed = _order(float(gain), ratios)
    if observed < LOWEST:
        return Refinement(finest, _floored(FINEST_ONLY * np.abs(changes[0]), finest, scale), observed, None)
    used = SMOOTH if observed >= BETWEEN and not edges else EDGED
    limit, coarser = (m + c / (r**used - 1.0) for m, c, r in zip(matrices, changes, ratios, strict=False))
    spread = SAFETY * np.abs(limit - coarser) / (2.0 ** min(observed, 1.0) - 1.0)
    error = np.maximum(spread, LEAST_SHARE * np.abs(limit - finest))
    if edges:
        error = np.maximum(error, np.abs(limit - finest - changes[0] / (ratios[0] ** SMOOTH - 1.0)))
    return Refinement(limit, _floored(error, limit, scale), observed, used)


def _order(gain: float, ratios: Sequence[float]) -> float:
    """Order at which the coarser of two differences is ``gain`` times the finer; within 12, beyond which it says nothing."""
    from scipy.optimize import brentq

    first, second = np.log(ratios)

    def short(order: float) -> float:
        return float(np.expm1(order * second) / -np.expm1(-order * first)) - gain

    small, large = 1e-9, 12.0
    if short(small) > 0.0:
        return 0.0
    return large if short(large) < 0.0 else float(brentq(short, small, large))


def _floored(error: Array, limit: Array, scale: Array, like_most: bool = False) -> Array:
    """Errors not below a share of the largest relative one of entries that matter, nor below the integrals' own."""
    size = np.abs(np.diag(limit))
    live = (size > SUBSTANTIAL * np.diag(scale)) & (np.diag(error) < size)
    relative = np.diag(error)[live] / size[live]
    least = LEAST_OF_WORST * float(np.max(relative, initial=0.0))
    if like_most and len(relative):
        least = max(least, float(np.median(relative)))
    root = np.sqrt(size)
    return np.maximum(np.maximum(error, least * np.outer(root, root)), ROUNDING * scale)


def _scale(matrix: Array) -> Array:
    """(6, 6) size of an entry of each unit: from the mean of the three masses and that of the three inertias."""
    root = np.sqrt(np.abs(np.repeat([np.trace(matrix[:3, :3]), np.trace(matrix[3:, 3:])], 3)) / 3.0)
    return np.asarray(np.outer(root, root))


summary = "triangular panels on the surface, potential formulation, Richardson extrapolation with an error estimate"
citations = ("newman1977", "hess1967", "vanoosterom1983", "wilton1984", "roache1998", "cohensteiner2003")
reproducible: Mapping[str, str] = {"kernel": "numpy"}
takes_surface = True
FEWEST_PANELS, MOST_PANELS = 1_000, 32_000
THIN, THIN_SHARE, SHARP = 0.05, 0.5, 0.5
COMPILE_FROM = 5_000


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the method.

    Attributes
    ----------
    panels : int
        On the finest mesh, about; 32,000 need 4.2 GiB.
    extrapolate : str
        ``yes``: with meshes of a quarter and a sixteenth of the panels. ``no``: the one mesh, error unknown.
    kernel : str
        ``numpy``, ``numba`` (compiled; the extra "fast"), or ``auto``: numba where it is installed and there are more
        than 5,000 panels. Both give the same numbers to 1e-6.
    """

    panels: int = bounded(6_000, FEWEST_PANELS, MOST_PANELS)
    extrapolate: str = one_of("yes", "yes", "no")
    kernel: str = one_of("auto", "auto", "numpy", "numba")


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass by the panel method, about the body's reference point.

    Parameters
    ----------
    body : Body
        Of any closed shape.
    density : float
        kg/m^3.
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        No shape, a plate, an open surface, a degenerate face, a body too thin, more panels than memory, or no numba
        where it was asked for.
    """
    chosen = parse_options(Options, options or {}, "panel")
    shape = body.require_shape()
    gated = shape if isinstance(shape, TriangleMesh) else meshed(shape, chosen.panels)
    _gate(gated, made=gated is not shape)
    edges = sharpness(gated.vertices, gated.faces) > SHARP
    meshes = family(shape, chosen.panels, 3 if chosen.extrapolate == "yes" else 1)
    _fits(len(meshes[0]))
    thin = _thin(meshes[0])
    compiled = [_compiled(chosen.kernel, len(corners)) for corners in meshes]
    # On the axis of a body of revolution, so that turning about it stays apart from all else.
    centre = shape.centre_of_volume
    solutions = []
    for corners, fast in zip(meshes, compiled, strict=True):
        stage(f"flow about {len(corners):,} panels")
        solutions.append(panel_added_mass(corners, centre, fast))
    found = refined([s.matrix for s in solutions], [s.count for s in solutions], edges)
    gap = volume_gap(body, gated, meshes)
    found = replace(found, error=found.error + gap.cost(found.matrix))
    if edges and isinstance(shape, TriangleMesh) and shape.remade is None:
        found = replace(found, error=found.error + gap.hidden(found.matrix, found.used))
    judged = _judged(found, len(meshes), chosen.extrapolate == "yes")
    statements = (*_said(solutions, compiled[0], thin), gap.said, *judged)
    error = None if len(meshes) == 1 else density * found.error
    lost = any(not s.converged for s in solutions)
    own = AddedMass(density * found.settled, centre, body.datum, body.name, "panel", statements, error, rough=lost)
    there = own.about(body.reference_point)
    return replace(there, matrix=(there.matrix + there.matrix.T) / 2.0)


def _gate(mesh: TriangleMesh, made: bool) -> None:
    """Refuse what the method cannot do; faces without area where parts that we meshed were united are just left out."""
    flat = int(np.count_nonzero(slivers(mesh.vertices[mesh.faces])))
    if flat and not made:
        raise InputError(f"{flat} faces without area", "triangles", advice="Clean the mesh of degenerate faces.")
    torn = unmatched_edges(mesh.faces)
    if torn:
        raise InputError(
            f"{torn} edges that are not shared by two faces wound alike",
            "a closed surface whose faces look outward",
            advice="Close the holes, merge the vertices, and wind all faces alike.",
        )
    ratio = slenderness(mesh.integrals.second_moments)
    if ratio < THIN:
        raise InputError(
            f"a body whose smallest side is {ratio:.3g} of the next",
            f"a ratio of at least {THIN:g} for panels on both faces",
            advice="Describe it as a plate for the method primitives, whose formulas hold for zero thickness.",
        )


def _thin(corners: Array) -> float:
    """Share of the surface on which panels are larger than the body is thick."""
    share = thin_share(panels_of(corners))
    if share > THIN_SHARE:
        raise InputError(
            f"a body thinner than its panels are large on {share:.0%} of its surface",
            f"at most {THIN_SHARE:.0%} of such surface",
            column="panels",
            advice="Ask for more panels, or describe thin parts as plates for the method primitives.",
        )
    return share


def _compiled(kernel: str, panels: int) -> bool:
    if kernel == "numba" and not compiles():
        raise InputError(
            "the compiled kernel without numba", "numba", advice='Install "coeflab[fast]", or use the kernel numpy.'
        )
    return (kernel == "numba" or (kernel == "auto" and panels > COMPILE_FROM)) and compiles()


def _fits(panels: int) -> None:
    """Refuse more panels than the machine's memory holds, where the system tells that."""
    there = physical_memory()
    needed = memory_needed(panels)
    if there is not None and needed > there:
        raise InputError(
            f"{panels} panels, which need {needed / 2**30:.1f} GiB",
            f"at most the {there / 2**30:.1f} GiB of this machine",
            column="panels",
            advice="Memory grows with the square of the panels: ask for fewer; extrapolation makes up for them.",
        )


def _said(solutions: Sequence[PanelSolution], compiled: bool, thin: float) -> list[str]:
    counts = " and ".join(f"{s.count:,}" for s in solutions)
    kernel = "compiled (numba)" if compiled else "plain (numpy)"
    out = [
        f"{counts} flat panels, direct formulation, kernel {kernel}; asymmetry before symmetrising "
        f"{solutions[0].asymmetry:.1e} of the largest entry"
    ]
    lost = [s for s in solutions if not s.converged]
    if lost:
        out.append(f"NOT CONVERGED: {lost[0].count:,} panels left a residual of {lost[0].residual:.1e}; do not use it")
    if thin > 0.0:
        out.append(
            f"on {thin:.1%} of the surface the body is thinner than its panels are large: thin parts and sharp edges are less exact"
        )
    return out


def _judged(found: Refinement, meshes: int, asked: bool) -> list[str]:
    """What the refinements say, in words."""
    if meshes == 1:
        return ["one mesh: its error is unknown" + ("; ask for more panels to have coarser ones" if asked else "")]
    live = ~found.void
    worst = float(np.max(np.diag(found.error)[live] / np.diag(found.matrix)[live], initial=0.0))
    estimate = f"error estimate at most {worst:.2g} of a diagonal entry"
    if found.used is None:
        out = [f"the differences between meshes barely shrink: not extrapolated, {estimate}"]
    elif found.observed is None:
        out = [f"extrapolated with order {found.used:.2g} from two meshes, order not observed, {estimate}"]
    else:
        edged = (
            "" if found.used == 2.0 else ", as with edges: the error does not fall as the square of the panels' size"
        )
        out = [f"extrapolated with order {found.used:.2g}, {estimate}; observed order {found.observed:.1f}{edged}"]
    if not np.all(live):
        names = ", ".join(np.array(list("uvwpqr"))[found.void])
        out.append(f"set to zero, below its error: {names}")
    return out
