"""What stands out in a study: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Checker

CHECKS = Registry(__name__, "check", Checker)  # type: ignore[type-abstract]
