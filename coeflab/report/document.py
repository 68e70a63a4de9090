"""A report before it has a format: what HTML and PDF both render."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.table import Table
from coeflab.core.types import brief, locked

Range = tuple[float, float]


@brief
@dataclass(frozen=True, slots=True)
class Series:
    """Points or a curve of a drawing, as numbers.

    Attributes
    ----------
    key : str
        What it belongs to: the drawing marks all artists of one key, so that a page can show and hide them together.
    name : str
        As the legend says it.
    x, y : tuple of float
        In the units of the panel.
    notes : tuple of str
        One a point, such as the row of the table or a half-width; empty for a curve.
    groups : tuple of str
        One a point: the window of an estimate, by which a page can show and hide points as well.
    is_curve : bool
    """

    key: str
    name: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    notes: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    is_curve: bool = False


@brief
@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes of a drawing, and what stands in it.

    Attributes
    ----------
    frame : (left, top, width, height)
        In the units of the drawing's ``viewBox``, from its upper left corner.
    across, up : (float, float)
        Values at the left and right, lower and upper edge of the frame, in the units below.
    name_across, unit_across, name_up, unit_up : str
    series : tuple of Series
    grouped_by : str
        What the groups of its points are, such as ``window``.
    bars : str
        ``across`` or ``up`` where the points are ends of bars that lie or stand. Lying ones have no upright quantity, each
        note names its bar.
    """

    frame: tuple[float, float, float, float]
    across: Range
    up: Range
    name_across: str
    unit_across: str
    name_up: str
    unit_up: str
    series: tuple[Series, ...]
    grouped_by: str = ""
    bars: str = ""


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """Triangles, lines or points of a scene.

    Attributes
    ----------
    name : str
        As the legend says it; layers of one name are one entry.
    colour : str
        A name of `coeflab.report.figures.svg.COLOURS`.
    places : (n, 3) array
        x, y, z in the units of the scene.
    index : (m, 3), (m, 2) or (m,) int array
        Corners of triangles, ends of lines, or points.
    opacity : float
    label : str
        Written beside points.
    notes : tuple of str
        One a point.
    """

    name: str
    colour: str
    places: NDArray[np.float64]
    index: NDArray[np.int64]
    opacity: float = 1.0
    label: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", locked(self.places))
        object.__setattr__(self, "index", locked(self.index, int))


@brief
@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a scene: name, unit, ends, and the values marked on it with their texts."""

    name: str
    unit: str
    ends: Range
    marks: tuple[float, ...] = ()
    texts: tuple[str, ...] = ()


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Something to be turned in space; the figure that holds it is what stands where that cannot be.

    Attributes
    ----------
    title, caption, description : str
    layers : tuple of Layer
    axes : (Axis, Axis, Axis)
    is_body : bool
        A body: FRD in m at one scale on all axes, z drawn down. Otherwise a graph in a box, z up.
    """

    title: str
    caption: str
    description: str
    layers: tuple[Layer, ...]
    axes: tuple[Axis, Axis, Axis]
    is_body: bool = False


@brief
@dataclass(frozen=True, slots=True)
class Figure:
    """A drawing.

    Attributes
    ----------
    anchor : str
        Unique in the document; letters, digits and hyphens.
    svg : str
        One ``<svg>`` element without prolog. Colours are ``var(--fig-NAME, #RRGGBB)``, so that a page sets them and
        a renderer without style sheets takes the colours after the commas.
    title : str
        A short name for screen readers.
    caption : str
    description : str
        What the drawing shows, for readers who cannot see it.
    panels : tuple of Panel
        The numbers behind the drawing, for renderers that can tell them.
    scene : Scene or None
        The same matter in space, for renderers that can turn it.
    """

    anchor: str
    svg: str
    title: str
    caption: str
    description: str
    panels: tuple[Panel, ...] = ()
    scene: Scene | None = None


@brief
@dataclass(frozen=True, slots=True)
class Section:
    """Paragraphs, then figures, then tables, then subsections.

    Attributes
    ----------
    anchor, title : str
    paragraphs : tuple of str
        Plain text.
    tables : tuple of Table
    figures : tuple of Figure
    subsections : tuple of Section
    code : tuple of str
        Commands to type, one per line.
    """

    anchor: str
    title: str
    paragraphs: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    figures: tuple[Figure, ...] = ()
    subsections: tuple[Section, ...] = ()
    code: tuple[str, ...] = ()


@brief
@dataclass(frozen=True, slots=True)
class Document:
    """A whole report.

    Attributes
    ----------
    title, subtitle : str
    sections : tuple of Section
    name : str
        Of the study, for the head of a page.
    digest : str
        Sixteen hexadecimal digits of the sha256 over all inputs; empty where there are none.
    works : tuple of (str, str)
        Key and text of every work that it rests on.
    verbatim : tuple of str
        Texts of users in it, which renderers set as they stand.
    """

    title: str
    subtitle: str
    sections: tuple[Section, ...]
    name: str = ""
    digest: str = ""
    works: tuple[tuple[str, str], ...] = ()
    verbatim: tuple[str, ...] = ()
