"""One orthographic view of a body on paper: parts solid and shaded, the mesh behind them, over them and as an outline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from coeflab.bodies.mesh import silhouettes
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.shape import Parts
from coeflab.core.types import Array, dataclass
from coeflab.report.figures import form_facets, part_pictures
from coeflab.report.figures.palette import COLOURS

LIGHT = np.array([-0.35, 0.65, 0.67]) / np.linalg.norm([-0.35, 0.65, 0.67])
SHADES, SHADE = (0.15, 0.3, 0.45, 0.6, 0.75, 0.9), 0.1
BEHIND, FILM = 0.45, 0.3
EDGE_ON = 1e-6
PALE, HATCH, STRIPE = 0.5, 8.0, 2.0  # the last two in points


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


def oblique(title: str, azimuth: float, elevation: float) -> View:
    """Seen from so many degrees to starboard of ahead, and so many above."""
    a, e = np.radians(azimuth), np.radians(elevation)
    toward = np.cos(e) * np.array([np.cos(a), np.sin(a), 0.0]) + np.sin(e) * np.array([0.0, 0.0, -1.0])
    right = np.array([np.sin(a), -np.cos(a), 0.0])
    return View(title, np.array([right, np.cross(toward, right), toward]))


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
        outline = None if mesh is None else silhouettes.mesh_outline(*mesh, self.frame)
        if outline is not None:
            self._fill(outline, "band", BEHIND)
        depth = [round(float(p.centre @ self.view.axes[2]), 9) for p in shape.parts]
        for i in sorted(range(len(depth)), key=lambda i: (depth[i], i)):
            part = shape.parts[i]
            self.part(
                part_pictures.part_facets(part),
                part_pictures.COLOUR_OF[part_pictures.form_name(part.form)],
                part_pictures.is_poor(part),
                part_pictures.is_convex(part.form),
            )
        if outline is not None:
            self._fill(outline, "band", FILM)
            self._line(outline, "ink", 0.9)

    def outline(self, mesh: Surface) -> None:
        """Draw a surface as a filled outline."""
        draw_outline(self.axes, mesh, self.frame, self.move)

    def part(self, facets: Array, colour: str, poor: bool, convex: bool) -> None:
        """Draw (n, 4, 3) facets, those that look toward the viewer; poor ones striped, convex ones by their outline."""
        if convex:
            whole = silhouettes.convex_outline(facets.reshape(-1, 3), self.frame)
        else:
            toward = form_facets.normals(facets) @ self.view.axes[2] > 1e-9
            whole = silhouettes.facets_outline(facets[toward] @ self.frame.T)
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
            self._fill(silhouettes.hatched(whole, HATCH, STRIPE), "ink", 1.0)
            self._line(whole, "ink", 1.6)
            return
        self._fill(whole, colour, 1.0)
        outward = form_facets.normals(facets) @ self.view.axes.T
        dark = 1.0 - np.clip(outward @ LIGHT, 0.0, 1.0)
        for level in SHADES:
            seen = facets[(outward[:, 2] > 1e-9) & (dark > level)]
            if len(seen):
                self._fill(silhouettes.facets_outline(seen @ self.frame.T), "ink", SHADE)
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


def draw_outline(
    axes: Axes, surface: Surface, frame: Array, move: Array | tuple[float, float] = (0.0, 0.0), palette: Mapping[str, str] = COLOURS,
    digits: int = 2, sense: Sequence[float] = (1.0, 1.0),
) -> None:  # fmt: skip
    """A surface as a filled outline.

    Parameters
    ----------
    axes : Axes
    surface : Surface
        Vertices, m, FRD, and faces.
    frame : (2, 3) array
        From metres to what the axes count, across and up.
    move : (2,) array
        Added to it.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    digits : int
        To which places are rounded.
    sense : (2,) sequence of float
        Of what the axes are called: -1 where it grows against the frame.
    """
    path = outline_path(silhouettes.mesh_outline(*surface, frame), move, digits, sense)
    if path is not None:
        fill: dict[str, Any] = {"facecolor": palette["band"], "edgecolor": "none", "alpha": BEHIND}
        line: dict[str, Any] = {"facecolor": "none", "edgecolor": palette["ink"], "linewidth": 0.9}
        for look in (fill, line):
            axes.add_patch(PathPatch(path, zorder=2, **look))


def outline_path(
    outline: Any, move: Array | tuple[float, float] = (0.0, 0.0), digits: int = 2, sense: Sequence[float] = (1.0, 1.0)
) -> Path | None:
    """An outline as a path, moved by so much; None where there is none."""
    rings = [np.round((ring + move) * sense, digits) for ring in silhouettes.polygons(outline)]
    return Path.make_compound_path(*(Path(np.vstack([r, r[:1]]), closed=True) for r in rings)) if rings else None
