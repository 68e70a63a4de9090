"""`FittedLaw`: a polynomial or surface over angles, motions and controls, read at angles with their unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coeflab.api.questions import si
from coeflab.core.errors import InputError, shown
from coeflab.core.missed import suggesting
from coeflab.core.texts import input_error
from coeflab.core.types import Array, in_angles
from coeflab.law.domain import Extrapolation
from coeflab.law.symbols import CONTROLS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from coeflab.fits.results.fitted_model import FittedModel

ANGLES = ("alpha", "beta", *CONTROLS)


class Evaluated(NamedTuple):
    """Values of a law.

    Attributes
    ----------
    value : (n,) array, or float where all that was given are single numbers
        In the law's `unit`; NaN where a coefficient that acts is open.
    u95 : the same shape
        Of the mean; NaN where a term has none.
    """

    value: Array | float
    u95: Array | float


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class FittedLaw:
    """A law that a fit found, ``result.laws["C_D"]``.

    Attributes
    ----------
    model : FittedModel
        Terms, coefficients with covariance, the rows, the domain of the data.

    Examples
    --------
    >>> import numpy as np
    >>> import coeflab as cf
    >>> alpha = np.arange(-10.0, 11.0, 2.0)
    >>> polar = cf.read_table(
    ...     {"alpha [deg]": alpha, "C_D": 0.02 + 0.5 * np.radians(alpha) ** 2, "C_L": 0.1 * alpha}, name="polar", frame="FRD", length=2.0, density=1000,
    ...     speed=2.0, about="nose, 1.0 m aft", alpha="+", columns={c: f"{n} [coefficient A=0.1 m^2]" for c, n in (("C_D", "drag"), ("C_L", "lift"))},
    ... )
    >>> found = cf.fit(polar, "polynomial", variable="alpha", degree=2, responses=["C_D"], area=0.1, area_name="frontal")
    >>> law = found.laws["C_D"]
    >>> round(law.evaluate(alpha="7 deg").value, 6)
    0.027463
    """

    model: FittedModel

    def __repr__(self) -> str:
        over = ", ".join(self.variables)
        return in_angles(self, f"{self.response} [{self.unit}] of {over}: {len(self.model.terms)} terms")

    @property
    def response(self) -> str:
        """What it gives, such as C_D."""
        return self.model.response

    @property
    def unit(self) -> str:
        """Of the response."""
        return self.model.unit

    @property
    def variables(self) -> tuple[str, ...]:
        """What it is a law of: alpha, beta and controls in rad, motions primed."""
        return self.model.domain.variables

    def evaluate(self, *, extrapolate: bool = False, **variables: float | str | ArrayLike) -> Evaluated:
        """Values and U95 at given angles or motions.

        Parameters
        ----------
        extrapolate : bool
            Read it beyond its data, whatever the fit's ``extrapolation`` is.
        **variables : float, str or (n,) array
            Every one of `variables`: an angle in rad or as "7 deg", a motion primed.

        Raises
        ------
        InputError
            Another variable, or one missing; a point outside of the data.
        """
        if set(variables) != set(self.variables):
            wrong = next((v for v in variables if v not in self.variables), None)
            found = (
                f"no {', '.join(v for v in self.variables if v not in variables)}" if wrong is None else shown(wrong)
            )
            raise InputError(found, f"{', '.join(self.variables)} of {self.response}", column="variables")
        given = {v: _numbers(variables[v], v) for v in self.variables}
        single = all(x.ndim == 0 for x in given.values())
        rows = np.broadcast_arrays(*(np.atleast_1d(x) for x in given.values()))
        columns = dict(zip(given, rows, strict=True))
        value, u95, within = self.model.evaluate(columns)
        domain = self.model.domain
        if not extrapolate and domain.rule is Extrapolation.REFUSE and not np.all(within):
            row = int(np.argmin(within))
            at = ", ".join(f"{v} {_words(x[row], v)}" for v, x in columns.items())
            data = ", ".join(
                f"{v} {_words(low, v)} to {_words(high, v)}"
                for v, low, high in zip(domain.variables, domain.low, domain.high, strict=True)
            )
            raise input_error("front_door.within_data", column=self.response, found=at, data=data)
        return Evaluated(float(value[0]), float(u95[0])) if single else Evaluated(value, u95)

    def frame(self) -> pd.DataFrame:
        """A row a term: value and U95.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.fit("suboff_roddy_2", "polynomial", variable="beta", degree=2).laws["X'"].frame().columns.tolist()
        ['value', 'u95']
        """
        import pandas as pd

        values = {"value": np.array(self.model.fit.coefficients), "u95": np.array(self.model.half_width)}
        return pd.DataFrame(values, index=pd.Index(self.model.symbols, name="term"))

    def plot(self, variable: str = "", ax: Axes | None = None) -> Axes:
        """The law along one of its variables with its points, the others at rest.

        Parameters
        ----------
        variable : str
            By default the first along which three rows lie.
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> _ = cf.fit("suboff_roddy_2", "polynomial", variable="beta", degree=2).laws["X'"].plot()
        """
        from coeflab.report.plots import plot_along

        return plot_along(self.model, variable, ax)


def _numbers(value: float | str | ArrayLike, variable: str) -> Array:
    """SI numbers of one value or several, a text with its unit each."""
    if isinstance(value, str | int | float):
        return np.array(si(value, "angle", variable) if variable in ANGLES else float(value))
    several = np.asarray(value)
    if several.dtype.kind in "iuf" and variable not in ANGLES:
        return np.asarray(several, dtype=np.float64)
    flat = [
        si(x if isinstance(x, str) else float(x), "angle", variable) if variable in ANGLES else float(x)
        for x in several.ravel()
    ]
    return np.array(flat, dtype=np.float64).reshape(several.shape)


def _words(value: float, variable: str) -> str:
    return f"{np.degrees(value):.4g} deg" if variable in ANGLES else f"{value:.4g}"
