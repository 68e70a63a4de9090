"""From studies to reports: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Mapping

    from coeflab.report.document import Document


@runtime_checkable
class Renderer(Plugin, Protocol):
    """Renders a report in a format.

    Attributes
    ----------
    suffix : str
        Of a file's name that asks for this format; empty where none does.
    """

    suffix: str = ""

    def render(self, document: Document) -> Mapping[str, bytes]:
        """Contents by file name.

        Parameters
        ----------
        document : Document
        """
        ...


REPORTERS = Registry("coeflab.reporting", "report format", Renderer, __name__)  # type: ignore[type-abstract]
