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
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.family import family, volume_gap
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.panels.added_mass import PanelSolution, memory_needed, panel_added_mass
from coeflab.bodies.panels.influence import panels_of, sharpness, slenderness, slivers, thin_share, unmatched_edges
from coeflab.core.errors import InputError
from coeflab.core.machine import compiles, physical_memory, stage
from coeflab.core.options import bounded, one_of, parse_options
from coeflab.core.types import Array, brief
from coeflab.law.added_mass import AddedMass

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
FEWEST, MOST = 1_000, 32_000
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

    panels: int = bounded(6_000, FEWEST, MOST)
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
        f"{counts} flat panels, direct formulation, kernel {kernel}; asymmetry before it was taken out "
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
        out = [f"the differences between meshes hardly shrink: not extrapolated, {estimate}"]
    elif found.observed is None:
        out = [f"extrapolated with order {found.used:.2g} from two meshes, order not observed, {estimate}"]
    else:
        edged = (
            "" if found.used == 2.0 else ", as with edges: the error does not fall as the square of the panels' size"
        )
        out = [f"extrapolated with order {found.used:.2g}, {estimate}; observed order {found.observed:.1f}{edged}"]
    if not np.all(live):
        names = ", ".join(np.array(list("uvwpqr"))[found.void])
        out.append(f"set to zero, being below its error: {names}")
    return out
