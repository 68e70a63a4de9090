"""A report before it has a format: what HTML and PDF both render."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.finding import Severity
from coeflab.core.table import ABSENT, Table, as_printed, with_u95
from coeflab.core.types import dataclass, in_angles, locked
from coeflab.law.symbols import primed
from coeflab.report.bench import BenchData
from coeflab.tables.assumptions import FLAG

Range = tuple[float, float]


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


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a scene: name, unit, ends, and the values marked on it with their texts."""

    name: str
    unit: str
    ends: Range
    marks: tuple[float, ...] = ()
    texts: tuple[str, ...] = ()


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

    def _repr_html_(self) -> str:
        """The drawing, for notebooks."""
        return html_by("figure", self)


@dataclass(frozen=True, slots=True)
class AnswerRow:
    """One wanted coefficient beside the published ones.

    Attributes
    ----------
    symbol : str
        Without prime.
    value, u95 : float or None
        Primed; None where there is none.
    status : str
        In the place of a value or of its U95, "no data", "not determined", "form rejected"; empty with both.
    source : str
        Campaign of the value, or of the literature that stands in for it.
    published : tuple of float or None
        In the order of `Answer.columns`, primed by our length.
    difference : float or None
        Ours minus the column that `Answer.compared` names.
    agrees : bool or None
        Whether it lies within U95, where a verdict is allowed; None without one.
    anchor : str
        Of the section that derives it; empty without one.
    printed : tuple of str
        The published values with the digits of their sources, empty for None; without these, as `as_printed` has them.
    assumed : tuple of str
        Keys that the value hangs on and that no source states: its name bears a star.
    """

    symbol: str
    value: float | None
    u95: float | None
    status: str = ""
    source: str = ""
    published: tuple[float | None, ...] = ()
    difference: float | None = None
    agrees: bool | None = None
    anchor: str = ""
    printed: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The symbol with its prime, and a star where the value hangs on something that no source states."""
        return f"{primed(self.symbol)}{FLAG * bool(self.assumed)}"

    @property
    def shown(self) -> tuple[str | None, ...]:
        """The published values for people, in the digits of their sources; None where a column has none."""
        texts = self.printed or tuple(as_printed(p) for p in self.published)
        return tuple(None if p is None else text for p, text in zip(self.published, texts, strict=True))

    @property
    def share(self) -> float | None:
        """Difference over U95, with its sign: the length of the bar."""
        return self.difference / self.u95 if self.difference is not None and self.u95 else None

    @property
    def apart(self) -> tuple[str, str]:
        """The difference with its sign and the digits of U95, and over U95."""
        sign = "+" * (self.difference is not None and self.difference > 0.0)
        share = (
            ABSENT if self.share is None else f"{self.share:+.2f}" if abs(self.share) < 10.0 else f"{self.share:+.0f}"
        )
        return sign + with_u95(self.difference, self.u95)[0], share


@dataclass(frozen=True, slots=True)
class Chip:
    """One of stability, largest uncertainty, warnings, exports: a name, at most six words, how grave, where it leads."""

    name: str
    text: str
    severity: Severity
    anchor: str = ""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a reader wants first: one sentence, the wanted coefficients beside published ones, two pictures, chips.

    Terminal, notebook, HTML, PDF and summary show this one object.

    Attributes
    ----------
    sentence : str
        The verdict, at most 160 letters.
    columns : tuple of str
        Of published values: experiment, steady CFD, PMM CFD where there are such.
    compared : str
        The one that differences are to; empty without one.
    rows : tuple of AnswerRow
        One a wanted coefficient, missing ones too.
    chips : tuple of Chip
    slope, forest, axes : Figure or None
        Y'/v' against the size of v' with its band; every row over the published value; the axes and signs. Of a publication
        its first figure, and how much of the tolerance its tables use; of models two figures of the first; of a vehicle the track, the
        shares of its variance and the outline.
    notes : tuple of str
        What the columns are and what is not compared; at most four lines.
    table : Table or None
        What stands in the place of rows: the tables of a publication, fitted models.
    """

    sentence: str
    columns: tuple[str, ...] = ()
    compared: str = ""
    rows: tuple[AnswerRow, ...] = ()
    chips: tuple[Chip, ...] = ()
    slope: Figure | None = None
    forest: Figure | None = None
    axes: Figure | None = None
    notes: tuple[str, ...] = ()
    table: Table | None = None

    def __repr__(self) -> str:
        return in_angles(self, self.sentence)

    def _repr_html_(self) -> str:
        """Sentence, rows, pictures and chips, for notebooks."""
        return html_by("answer", self)


@dataclass(frozen=True, slots=True)
class Topic:
    """Sentences on one matter, with its name in the margin.

    Attributes
    ----------
    name : str
        One to three words.
    texts : tuple of str
        Paragraphs of plain text.
    """

    name: str
    texts: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Section:
    """Paragraphs, then topics, figures, tables and subsections.

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
    appendix : bool
        Only in the whole report.
    topics : tuple of Topic
    plates : bool
        Figures as large as half a page, two a page on paper.
    """

    anchor: str
    title: str
    paragraphs: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    figures: tuple[Figure, ...] = ()
    subsections: tuple[Section, ...] = ()
    code: tuple[str, ...] = ()
    appendix: bool = False
    topics: tuple[Topic, ...] = ()
    plates: bool = False

    @property
    def texts(self) -> tuple[str, ...]:
        """Its paragraphs and those of its topics."""
        return (*self.paragraphs, *(text for t in self.topics for text in t.texts))


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
    answer : Answer or None
        The first page; None where a document has none.
    bench : BenchData or None
        What a workbench page computes with.
    """

    title: str
    subtitle: str
    sections: tuple[Section, ...]
    name: str = ""
    digest: str = ""
    works: tuple[tuple[str, str], ...] = ()
    verbatim: tuple[str, ...] = ()
    answer: Answer | None = None
    bench: BenchData | None = None


def every(sections: Iterable[Section]) -> Iterator[Section]:
    """Sections and all that stand in them, in the order of reading."""
    for section in sections:
        yield section
        yield from every(section.subsections)
