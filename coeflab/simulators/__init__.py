"""From parameter files to motions: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Simulator

SIMULATORS = Registry(__name__, "simulator", Simulator)  # type: ignore[type-abstract]
