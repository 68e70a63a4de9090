"""Where a number comes from: files by their sha256, sources by their citation."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.toml import Section

TABLE_KINDS = ("experiment", "cfd", "literature", "synthetic")
BODY_KINDS = (*TABLE_KINDS, "computed")


@dataclass(frozen=True, slots=True)
class Source:
    """Origin of a table or value.

    Attributes
    ----------
    citation : str
        Key in `coeflab.core.citations` or free text.
    place : str
        Pages or table in the source.
    how_obtained : str
        Printed, computed, read from a figure, synthetic ...
    kind : str
        One of `TABLE_KINDS` or `BODY_KINDS`; empty where a body says nothing.
    stated_uncertainty : str
        What the source itself says of its uncertainty; empty if nothing.
    """

    citation: str
    place: str = ""
    how_obtained: str = ""
    kind: str = ""
    stated_uncertainty: str = ""


def read_source(section: Section, kinds: tuple[str, ...] = BODY_KINDS, required: bool = False) -> Source:
    """A ``[source]`` table.

    Parameters
    ----------
    section : Section
    kinds : tuple of str, optional
        The kinds of source that are allowed.
    required : bool
        Whether a kind must be named.

    Raises
    ------
    InputError
        No citation, no kind where one is required, or a kind of no such name.
    """
    return Source(
        citation=section.text("citation"),
        place=section.text("place", ""),
        how_obtained=section.text("how_obtained", ""),
        kind=section.text("kind", choices=kinds) if required or section.has("kind") else "",
        stated_uncertainty=section.text("stated_uncertainty", ""),
    )


@dataclass(frozen=True, slots=True)
class InputFile:
    """A file that a study read: its name as written in the plan, and its sha256."""

    name: str
    sha256: str


def sha256_of(path: Path) -> str:
    """Hexadecimal sha256 of a file's bytes."""
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        for block in iter(lambda: stream.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()
