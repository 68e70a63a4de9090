"""From studies to reports: one plugin a file."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Mapping

    from jinja2 import Environment

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


def page_environment(templates: Mapping[str, str] | None = None) -> Environment:
    """Of the templates of pages: everything is escaped, nothing may be missing."""
    from jinja2 import DictLoader, Environment, StrictUndefined

    loader = DictLoader(templates or {})
    return Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )  # fmt: skip


def inside_a_page(content: Any, *, ascii_only: bool = False) -> str:
    """JSON without the characters that could end a script element."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=ascii_only, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
