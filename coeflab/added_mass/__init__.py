"""From bodies to added-mass matrices: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import AddedMassMethod

ADDED_MASS = Registry(__name__, "added-mass method", AddedMassMethod)  # type: ignore[type-abstract]
