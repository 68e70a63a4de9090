"""Where a number comes from: files by their sha256, sources by their citation.

Works that formulas and data come from; reports print those that were used.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Annotated

from coeflab.core.declarations import Declaration, Text, Words, one_of
from coeflab.core.stored import Means, Within, stored
from coeflab.core.text.bounded import own_text, stream_of
from coeflab.core.text.toml import own_toml

TABLE_KINDS = ("experiment", "cfd", "literature", "synthetic", "estimate", "unstated")
BODY_KINDS = (*TABLE_KINDS, "computed")


@dataclass(frozen=True, slots=True)
class Source(Declaration):
    """Origin of a table or value.

    Attributes
    ----------
    citation : str
        Key of a work of `coeflab.core.provenance`, such as roddy1990, or free text.
    place : str
        Pages or table in the source.
    how_obtained : str
        Printed, computed, read from a figure, synthetic ...
    kind : str
        What the source is; a body may leave it out.
    stated_uncertainty : str
        What the source itself says of its uncertainty; empty if nothing.
    """

    citation: Text
    place: Words = ""
    how_obtained: Words = ""
    kind: Annotated[str, one_of(*BODY_KINDS)] = ""
    stated_uncertainty: Words = ""


@stored()
@dataclass(frozen=True, slots=True)
class InputFile:
    """A file that went in.

    Attributes
    ----------
    name : str
        As written in the plan.
    sha256 : str
    """

    name: Annotated[str, Means("file name")]
    sha256: Annotated[str, Within((("pattern", "^[0-9a-f]{64}$"),)), Means("of its bytes, hexadecimal")]


def sha256_of(path: Path, read: Iterable[Path] = ()) -> str:
    """Hexadecimal sha256 of a file's bytes; of a folder, of the paths in it and the sha256 of what was read there.

    Parameters
    ----------
    path : Path
    read : iterable of Path, optional
        Files of the folder.
    """
    digest = hashlib.sha256()
    if path.is_dir():
        for file in sorted(read):
            place = file.relative_to(path) if file.is_relative_to(path) else file
            digest.update(f"{place.as_posix()} {sha256_of(file)}\n".encode())
        return digest.hexdigest()
    with stream_of(path) as stream:
        for block in iter(lambda: stream.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


@cache
def works() -> dict[str, str]:
    """Full references by the keys that code, campaigns and reports cite them by: works.toml."""
    return own_toml(own_text(files("coeflab.core") / "works.toml"))


def work(key: str) -> str:
    """Full reference of a key; a text that is no key is returned as it is."""
    return works().get(key, key)
