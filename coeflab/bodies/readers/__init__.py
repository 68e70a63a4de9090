"""Readers of bodies: one plugin a file, what a plugin is, and a body by its body.toml."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol, runtime_checkable

from coeflab.bodies.body import Body
from coeflab.core.registry import Plugin, Registry
from coeflab.core.text.toml import read_toml


def read_body(path: Path) -> Body:
    """A body, by the reader that its body.toml names."""
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
