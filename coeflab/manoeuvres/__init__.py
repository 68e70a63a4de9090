"""Standard manoeuvres: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import ManoeuvrePlugin

MANOEUVRES = Registry(__name__, "manoeuvre", ManoeuvrePlugin)  # type: ignore[type-abstract]
