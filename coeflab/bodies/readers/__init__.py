"""Readers of bodies: one plugin a file, what a plugin is, and a body by its body.toml."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path
from typing import Protocol, runtime_checkable

from coeflab.bodies.body import Body
from coeflab.core.registry import Plugin, Registry
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import quoted, read_toml
from coeflab.core.texts import input_error

MESHES = (".stl", ".obj", ".ply", ".glb")


def _mesh_body(path: Path) -> str:
    """A body.toml for a mesh."""
    name = re.sub(r"[^A-Za-z0-9_.+-]+", "_", path.stem)
    return own_text(files("coeflab.bodies.readers") / "mesh_body.toml.txt").format(
        name=quoted(name), path=quoted(path.name)
    )


def read_body(path: Path) -> Body:
    """A body, by the reader that its body.toml names.

    Raises
    ------
    InputError
        A mesh without its body.toml, with the lines of one to copy; what the reader raises.
    """
    if path.suffix.lower() in MESHES:
        why = input_error("bodies.body_toml_says", path, name=path.name)
        why.example = _mesh_body(path)
        raise why
    head = read_toml(path).content.get("body")
    named = head.get("reader") if isinstance(head, dict) else None
    reader = named if isinstance(named, str) else "particulars"
    with BODIES.guarded(reader):
        return BODIES.load(reader).read(path)


@runtime_checkable
class BodyReader(Plugin, Protocol):
    """Reads a body.

    A reader may have ``File``, the declaration of its body.toml: the published JSON Schema holds it.
    """

    def read(self, path: Path) -> Body:
        """The body of a file.

        Parameters
        ----------
        path : Path
            Of its body.toml.
        """
        ...


BODIES = Registry("coeflab.bodies", "body reader", BodyReader, __name__)  # type: ignore[type-abstract]
