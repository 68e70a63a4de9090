"""From fitted models to those of a parameter file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.wording import finite
from coeflab.law.symbols import ANGULAR, CONTROLS, FLOW_ANGLES, LINEAR
from coeflab.law.terms import Factor
from coeflab.vehicle.parameter_model import ModelArea, ModelDomain, ModelTerm, ModelVariable, ParameterModel

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel


ANGLES = ("alpha", "beta")


def _variable_unit(name: str, unit: str) -> str:
    """Angles in radians; velocities and rates primed in a nondimensional model, SI in a dimensional one; else 1."""
    if name in LINEAR:
        return "1" if unit == "1" else "m/s"
    if name in ANGULAR:
        return "1" if unit == "1" else "rad/s"
    return "rad" if name in (*ANGLES, *CONTROLS) else "1"


def record(model: FittedModel, area: ModelArea | None = None) -> ParameterModel:
    """A fitted model as the parameter file holds it.

    The covariance is that of standard uncertainties, half_width_95 / 2, as everywhere in the file. A half-width of a
    point is then twice the root of its variance, and for one term alone the term's own.
    """
    names = model.domain.variables
    return ParameterModel.model_validate(
        {
            "response": model.response,
            "unit": model.unit,
            "form": model.form,
            "variables": tuple(
                ModelVariable.model_validate({"name": v, "unit": _variable_unit(v, model.unit)}) for v in names
            ),
            "terms": tuple(
                ModelTerm(
                    symbol=s, factors=tuple(Factor(*f) for f in t.factors), value=finite(c), half_width_95=finite(h)
                )
                for s, t, c, h in zip(model.symbols, model.terms, model.fit.coefficients, model.half_width, strict=True)
            ),
            "holds": ("random", *(("model form",) if model.remainder is not None else ()), *model.shared),
            "covariance": tuple(tuple(finite(x) for x in row) for row in model.covariance),
            "domain": ModelDomain(
                low=tuple(map(float, model.domain.low)),
                high=tuple(map(float, model.domain.high)),
                half_spaces=tuple(tuple(map(float, row)) for row in model.domain.spaces),
                extrapolation=model.domain.rule.value,
            ),
            "n_points": model.n_points,
            "rms": model.fit.rms,
            "press_rms": finite(model.fit.press_rms),
            "table": model.table,
            "campaign": model.campaign,
            "post_selection": model.post_selection,
            "statements": (*model.statements, *(f"{FLOW_ANGLES[v]}." for v in names if v in FLOW_ANGLES)),
            "area": area,
        }
    )


def recorded(fits: Sequence[FitResult]) -> tuple[tuple[ParameterModel, ...], list[str]]:
    """The models of some fits, and notes on those that repeat a response over the same variables.

    Of such models the earliest in the plan counts, as with coefficients. A fit of area coefficients names the area in
    its settings ``area`` (m^2) and ``area_name``.
    """
    out: dict[tuple[str, tuple[str, ...]], ParameterModel] = {}
    notes = []
    for f in fits:
        area = None
        if "area" in f.settings:
            area = ModelArea(value=float(f.settings["area"]), name=f.settings["area_name"])
        for model in f.models:
            key = (model.response, model.domain.variables)
            if key in out:
                selected = out[key]
                notes.append(
                    f"{model.response} over {', '.join(key[1])}: {selected.form} of {selected.campaign} is kept, {model.form} of "
                    f"{model.campaign} is in the report only"
                )
            else:
                out[key] = record(model, area if model.unit == "1" else None)
    return tuple(out.values()), notes
