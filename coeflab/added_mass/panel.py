"""Panels on the real surface in unbounded fluid: potential formulation, three refinements, extrapolated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.machine import compiles, physical_memory, stage
from coeflab.core.options import bounded, one_of, parse_options
from coeflab.kernels.panel_added_mass import PanelSolution, memory_needed, panel_added_mass
from coeflab.kernels.panel_geometry import (
    panels_of,
    sharpness,
    slenderness,
    slivers,
    thin_share,
    unmatched_edges,
)
from coeflab.kernels.panel_refinement import Refinement, refined
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.mesh import TriangleMesh
from coeflab.model.mesh_family import family
from coeflab.model.mesh_volume import volume_gap
from coeflab.model.meshing import meshed

summary = "triangular panels on the surface, potential formulation, Richardson extrapolation with an error estimate"
citations = ("newman1977", "hess1967", "vanoosterom1983", "wilton1984", "roache1998", "cohensteiner2003")
reproducible: Mapping[str, str] = {"kernel": "numpy"}
takes_surface = True

Array = NDArray[np.float64]
FEWEST, MOST = 1_000, 32_000
THIN, THIN_SHARE, EDGED = 0.05, 0.5, 0.5
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
    edges = sharpness(gated.vertices, gated.faces) > EDGED
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
