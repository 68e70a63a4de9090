"""Bodies given by their particulars: principal lengths, volume, centres and mass, as a report prints them."""

from __future__ import annotations

from pathlib import Path

from coeflab.bodies.body import Body
from coeflab.bodies.body_file import BodyFile
from coeflab.core.declarations import declared
from coeflab.core.text.toml import read_toml

summary = "principal dimensions, volume, centres and mass from a body.toml"
citations = ("sname1950",)
File = BodyFile


def read(path: Path) -> Body:
    """Read a body.toml.

    Raises
    ------
    InputError
        Everything missing, unknown or of the wrong unit, by file, line and key.
    """
    return declared(BodyFile, read_toml(path)).build(path)
