"""From studies to reports: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Renderer

REPORTERS = Registry(__name__, "report format", Renderer)  # type: ignore[type-abstract]
