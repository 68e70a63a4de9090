"""From tables to coefficients: one plugin a file."""

from coeflab.core.registry import Registry
from coeflab.ports import Fit

FITS = Registry(__name__, "fit", Fit)  # type: ignore[type-abstract]
