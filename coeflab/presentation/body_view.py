"""One orthographic view of a body on paper: parts solid and shaded, the mesh behind them, over them and as an outline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from coeflab.kernels import silhouette
from coeflab.kernels.brief import brief
from coeflab.kernels.form_facets import normals
from coeflab.kernels.solids import Surface
from coeflab.model.shape import Parts
from coeflab.presentation.part_facets import COLOUR_OF, form_name, is_poor, part_facets
from coeflab.presentation.svg import COLOURS

Array = NDArray[np.float64]
LIGHT = np.array([-0.35, 0.65, 0.67]) / np.linalg.norm([-0.35, 0.65, 0.67])
SHADES, SHADE = (0.15, 0.3, 0.45, 0.6, 0.75, 0.9), 0.1
BEHIND, FILM = 0.45, 0.3
EDGE_ON = 1e-6
PALE, HATCH, STRIPE = 0.5, 8.0, 2.0  # the last two in points


@brief
@dataclass(frozen=True, slots=True, eq=False)
class View:
    """A direction to look in.

    Attributes
    ----------
    title : str
    axes : (3, 3) array
        Rows are the picture's right, up and toward the viewer, in FRD.
    """

    title: str
    axes: Array


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A view at its place on the paper.

    Attributes
    ----------
    axes : Axes
        Whose units are points.
    view : View
    scale : float
        Points per metre.
    move : (2,) array
        What is added to scaled coordinates, points.
    extent : float
        Largest size of what is drawn, m.
    """

    axes: Axes
    view: View
    scale: float
    move: Array
    extent: float

    @property
    def frame(self) -> Array:
        """(2, 3) from metres in FRD to points right and up."""
        return np.asarray(self.view.axes[:2] * self.scale)

    def on_paper(self, points: Array) -> Array:
        """(..., 2) places of (..., 3) points."""
        return np.asarray(points @ self.frame.T + self.move)

    def body(self, shape: Parts, mesh: Surface | None) -> None:
        """Draw the mesh and the parts, those nearer to the viewer later."""
        outline = None if mesh is None else silhouette.mesh_outline(*mesh, self.frame)
        if outline is not None:
            self._fill(outline, "band", BEHIND)
        depth = [round(float(p.centre @ self.view.axes[2]), 9) for p in shape.parts]
        for i in sorted(range(len(depth)), key=lambda i: (depth[i], i)):
            part = shape.parts[i]
            self._part(part_facets(part), COLOUR_OF[form_name(part.form)], is_poor(part))
        if outline is not None:
            self._fill(outline, "band", FILM)
            self._line(outline, "ink", 0.9)

    def outline(self, mesh: Surface) -> None:
        """Draw a surface as a filled outline."""
        outline = silhouette.mesh_outline(*mesh, self.frame)
        self._fill(outline, "band", BEHIND)
        self._line(outline, "ink", 0.9)

    def _part(self, facets: Array, colour: str, poor: bool) -> None:
        whole = silhouette.convex_outline(facets.reshape(-1, 3), self.frame)
        if whole.area() <= EDGE_ON * (self.scale * self.extent) ** 2:
            ends = self.on_paper(facets.reshape(-1, 3))
            along = ends @ np.linalg.eigh(np.cov(ends.T))[1][:, 1]
            far = ends[[int(np.argmin(along)), int(np.argmax(along))]]
            self.axes.plot(*far.T, color=COLOURS[colour], linewidth=2.2, solid_capstyle="butt", zorder=2)
            if poor:
                self.axes.plot(*far.T, color=COLOURS["ink"], linewidth=2.2, linestyle=(0.0, (1.0, 1.5)), zorder=2)
            return
        if poor:
            self._fill(whole, colour, PALE)
            self._fill(silhouette.hatched(whole, HATCH, STRIPE), "ink", 1.0)
            self._line(whole, "ink", 1.6)
            return
        self._fill(whole, colour, 1.0)
        outward = normals(facets) @ self.view.axes.T
        dark = 1.0 - np.clip(outward @ LIGHT, 0.0, 1.0)
        for level in SHADES:
            seen = facets[(outward[:, 2] > 1e-9) & (dark > level)]
            if len(seen):
                self._fill(silhouette.facets_outline(seen @ self.frame.T), "ink", SHADE)
        self._line(whole, colour, 0.8)

    def _fill(self, outline: Any, colour: str, alpha: float) -> None:
        path = outline_path(outline, self.move)
        if path is not None:
            self.axes.add_patch(PathPatch(path, facecolor=COLOURS[colour], edgecolor="none", alpha=alpha, zorder=2))

    def _line(self, outline: Any, colour: str, width: float) -> None:
        path = outline_path(outline, self.move)
        if path is not None:
            style: dict[str, Any] = {"facecolor": "none", "edgecolor": COLOURS[colour], "linewidth": width}
            self.axes.add_patch(PathPatch(path, zorder=2, **style))


def outline_path(outline: Any, move: Array | tuple[float, float] = (0.0, 0.0)) -> Path | None:
    """An outline as a path, moved by so much; None where there is none."""
    rings = [np.round(ring + move, 2) for ring in silhouette.polygons(outline)]
    return Path.make_compound_path(*(Path(np.vstack([r, r[:1]]), closed=True) for r in rings)) if rings else None
