"""Readers of bodies: one plugin a file, what a plugin is, and a body by its body.toml."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol, runtime_checkable

from coeflab.bodies.body import Body
from coeflab.core.registry import Plugin, Registry
from coeflab.core.text.toml import read_toml


def read_body(path: Path) -> Body:
    """A body, by the reader that its body.toml names."""
    head = read_toml(path).section("body")
    reader = head.text("reader", "particulars")
    with BODIES.guarded(reader):
        return BODIES.load(reader).read(path)


@runtime_checkable
class BodyReader(Plugin, Protocol):
    """Reads a body."""

    def read(self, path: Path) -> Body:
        """The body of a file.

        Parameters
        ----------
        path : Path
            Of its body.toml.
        """
        ...


BODIES = Registry("coeflab.bodies", "body reader", BodyReader, __name__)  # type: ignore[type-abstract]
