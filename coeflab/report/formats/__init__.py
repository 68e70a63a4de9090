"""From studies to reports: one plugin a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

import numpy as np

from coeflab.core.registry import Plugin, Registry
from coeflab.report.document import Document

REPORTERS = Registry(__name__, "report format", Renderer)  # type: ignore[type-abstract]


@runtime_checkable
class Renderer(Plugin, Protocol):
    """Renders a report in a format."""

    def render(self, document: Document) -> Mapping[str, bytes]:
        """Contents by file name.

        Parameters
        ----------
        document : Document
        """
        ...
