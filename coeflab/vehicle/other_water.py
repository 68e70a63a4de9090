"""A parameter file for water of another density: primes, mass and volume stay; forces in SI, m' and buoyancy follow the density."""

from __future__ import annotations

from dataclasses import replace

from coeflab.core.finding import Finding, Severity
from coeflab.vehicle.law_at_points import MeasuredTable
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel

MISSES = ("largest", "allowed", "worst", "rms", "worst_beyond")  # N or N m
OTHER_WATER, THRUST_STAYS = "vehicle.other_water", "vehicle.thrust_stays"


def in_water(parameters: ParameterFile, density: float) -> ParameterFile:
    """The same vehicle in water of another density.

    Primes are kept: at another Reynolds number only as far as they do not depend on it. Mass, inertia and displaced volume are
    kept, so that weight less buoyancy changes. Curves of thrusters, in N, are kept. Findings say all of it. Its viscosity is not known.

    Parameters
    ----------
    parameters : ParameterFile
    density : float
        kg/m^3.

    Examples
    --------
    >>> from coeflab.published.huuv.model import parameter_file, read_huuv
    >>> in_water(parameter_file(read_huuv()), 1025.0).conditions.density
    1025.0
    """
    before = parameters.conditions.density
    if density == before:
        return parameters
    ratio, mass, afloat = density / before, parameters.mass, parameters.hydrostatics
    heavier = 0.0
    if mass is not None:
        heavier = mass.mass - (mass.mass if afloat is None else density * afloat.volume)
    found = [
        Finding.of(
            OTHER_WATER, parameters.name, Severity.WARN if abs(heavier) > 0.0 else Severity.NOTE, statistic=density, threshold=before,
            heavier=heavier, by="massless" if mass is None else "weighed",
        )
    ]  # fmt: skip
    if parameters.thrusters:
        names = tuple(t.name for t in parameters.thrusters)
        found.append(Finding.of(THRUST_STAYS, parameters.name, Severity.NOTE, statistic=ratio - 1.0, thrusters=names))
    update = {
        "conditions": replace(parameters.conditions, density=density, viscosity=None),
        "mass": None if mass is None else mass.primed(parameters.scaling, density),
        "coefficients": tuple(
            replace(c, value_si=None if c.value_si is None else c.value_si * ratio) for c in parameters.coefficients
        ),
        "models": tuple(m if m.unit == "1" else _table(m, ratio) for m in parameters.models),
        "measured": tuple(_measured(t, ratio) for t in parameters.measured),
        "law_at_points": tuple(
            held.model_copy(update={name: getattr(held, name) * ratio for name in MISSES})
            for held in parameters.law_at_points
        ),
        "findings": (*parameters.findings, *found),
    }
    return parameters.model_copy(update=update)


def _table(model: ParameterModel, ratio: float) -> ParameterModel:
    """A fitted table in N or N m, in proportion to the density."""

    def by(value: float | None, factor: float = ratio) -> float | None:
        return None if value is None else value * factor

    terms = tuple(
        t.model_copy(update={"value": by(t.value), "half_width_95": by(t.half_width_95)}) for t in model.terms
    )
    covariance = tuple(tuple(by(x, ratio**2) for x in row) for row in model.covariance)
    return model.model_copy(
        update={"terms": terms, "covariance": covariance, "rms": by(model.rms), "press_rms": by(model.press_rms)}
    )


def _measured(table: MeasuredTable, ratio: float) -> MeasuredTable:
    forces = tuple(
        f.model_copy(
            update={
                "values": tuple(None if x is None else x * ratio for x in f.values),
                "at_rest": tuple(x * ratio for x in f.at_rest),
                "scatter": None if f.scatter is None else f.scatter * ratio,
            }
        )
        for f in table.forces
    )
    return table.model_copy(update={"forces": forces})
