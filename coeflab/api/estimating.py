"""`estimate`: coefficients of a shape alone."""

from __future__ import annotations

from pathlib import Path

from coeflab.api.body import read_body
from coeflab.api.questions import above_zero
from coeflab.api.result import Result
from coeflab.bodies import body as plain
from coeflab.core.files import stem
from coeflab.core.machine import one_thread
from coeflab.law.water import conditions_of
from coeflab.study.estimated_vehicle import estimated
from coeflab.study.study import Plan
from coeflab.vehicle.from_shape import Stated


@one_thread()
def estimate(
    body: str | Path | plain.Body,
    *,
    density: float | str | None = None,
    speed: float | str | None = None,
    method: str = "all",
) -> Result:
    """Coefficients of a shape by semi-empirical methods, each with U95 and status ``estimate``.

    Parameters
    ----------
    body : Body, str or Path
        With a shape.
    density, speed : float or str, optional
        Of the water and of reference; fresh water and 2 m/s unless given.
    method : str
        Of added mass.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        A body without a shape, or nothing that can be estimated.

    Examples
    --------
    >>> import coeflab as cf
    >>> found = cf.estimate("remus100")
    >>> found["Yv'"].value < 0, str(found["Yv'"].status)
    (True, 'estimate')
    """
    hull = read_body(body)
    conditions, unstated = conditions_of(
        None if density is None else above_zero(density, "density", "density"),
        None if speed is None else above_zero(speed, "speed", "speed"),
    )
    result = estimated(
        Plan(stem(hull.name), hull.title or hull.name, (), conditions=conditions, method=method),
        hull,
        Stated(unstated=unstated),
    )
    return Result(tuple(result.fits))
