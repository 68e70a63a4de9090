"""Readers of bodies: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import BodyReader

BODIES = Registry(__name__, "body reader", BodyReader)  # type: ignore[type-abstract]
