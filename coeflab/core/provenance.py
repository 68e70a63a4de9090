"""Where a number comes from: files by their sha256, sources by their citation."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.toml import Section


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
        ``experiment``, ``cfd``, ``literature`` or ``synthetic``.
    stated_uncertainty : str
        What the source itself says of its uncertainty; empty if nothing.
    """

    citation: str
    place: str = ""
    how_obtained: str = ""
    kind: str = ""
    stated_uncertainty: str = ""


def read_source(section: Section, kinds: tuple[str, ...] = ()) -> Source:
    """A ``[source]`` table.

    Parameters
    ----------
    section : Section
    kinds : tuple of str, optional
        The kinds of source that are allowed; the kind is then required.

    Raises
    ------
    InputError
    """
    return Source(
        citation=section.text("citation"),
        place=section.text("place", ""),
        how_obtained=section.text("how_obtained", ""),
        kind=section.text("kind", choices=kinds) if kinds else section.text("kind", ""),
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
