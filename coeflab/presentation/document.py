"""A report before it has a format: what HTML and PDF both render."""

from __future__ import annotations

from dataclasses import dataclass

from coeflab.model.table import Table


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
    """

    anchor: str
    svg: str
    title: str
    caption: str
    description: str


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
    """

    title: str
    subtitle: str
    sections: tuple[Section, ...]
    name: str = ""
    digest: str = ""
    works: tuple[tuple[str, str], ...] = ()
