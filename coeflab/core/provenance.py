"""Where a number comes from: files by their sha256, sources by their citation."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path


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
