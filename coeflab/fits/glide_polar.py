"""Glide polar: L = (K_L0 + K_L a) V^2, D = (K_D0 + K_D a^2) V^2, M = (K_M0 + K_M a) V^2.

Equations 28-30 of the THAUV paper. D is along the relative flow and L upward, normal to it; M is positive nose up, about
the table's reference point; a is alpha = atan2(w, u). The paper does not say the unit of a. Its published speeds need
degrees (in radians the glide has no such speed) [derived], so the fit gives both and `angle_unit_of` tells which of
them a printed set is in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.options import one_of, parse_options, words
from coeflab.core.symbols import ANGULAR, LINEAR
from coeflab.kernels.terms import Term
from coeflab.kernels.wind_axes import wind_forces
from coeflab.model.coefficient import CoefficientSet
from coeflab.model.fit_result import FitResult
from coeflab.model.fitted_model import FittedModel
from coeflab.model.force_table import ForceTable
from coeflab.model.regression import Rows, model_of, variable
from coeflab.model.scaling import Scaling

summary = "lift, drag and pitching moment of a glider over angle of attack and speed, per degree and per radian"
citations = ("thauv", "fossen2011", "mackinnon1985", "bell2002")

Array = NDArray[np.float64]
POWERS = {"L": 1, "D": 2, "M": 1}
DEGREES = float(np.degrees(1.0))
NEAR_ZERO = float(np.radians(0.3))
SLOPES = ("K_L", "K_D", "K_M")
PRINTABLE = ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M")


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    angle_unit : {"deg", "rad"}
        Unit of a in the models; the other one is in their statements.
    printed : tuple of str
        Coefficients that somebody printed, such as ``K_L=9.5281 K_D=0.215``; the models then state their unit.
    """

    angle_unit: str = one_of("deg", "deg", "rad")
    printed: tuple[str, ...] = words()


@dataclass(frozen=True, slots=True)
class AngleUnit:
    """The unit of a that printed coefficients mean.

    Attributes
    ----------
    unit : {"deg", "rad", ""}
        Empty where the printed coefficients do not say one and the same.
    statements : tuple of str
        One per slope compared.
    """

    unit: str
    statements: tuple[str, ...]


def _steady(table: ForceTable) -> NDArray[np.bool_]:
    """Rows without drift, rotation or deflected controls."""
    keep = np.abs(variable(table, "beta", 1.0)) <= NEAR_ZERO
    for m in ANGULAR:
        keep &= table.motion[m] == 0.0
    for angle in table.controls.values():
        keep &= angle == 0.0
    return keep


def _forces(table: ForceTable) -> dict[str, tuple[Array, NDArray[np.bool_]]]:
    """D, L and, where the table has it, M with the rows that are usable.

    Raises
    ------
    InputError
        X or Z is not there.
    """
    for c in ("X", "Z"):
        if c not in table.forces:
            raise InputError(f"no {c} in {table.name}", "columns X [N] and Z [N], which lift and drag need", column=c)
    alpha, beta = variable(table, "alpha", 1.0), variable(table, "beta", 1.0)
    zero = np.zeros(len(table))
    usable = table.usable["X"] & table.usable["Z"]
    drag, _, lift = wind_forces(alpha, beta, table.forces["X"], table.forces.get("Y", zero), table.forces["Z"])
    out = {"L": (lift, usable), "D": (drag, usable)}
    if "M" in table.forces:
        out["M"] = (np.asarray(table.forces["M"]), np.array(table.usable["M"]))
    return out


def _rows(tables: Sequence[ForceTable]) -> dict[str, Rows]:
    """V in m/s and alpha in radians against L, D and M of all tables."""
    found: dict[str, list[tuple[ForceTable, Array, NDArray[np.intp]]]] = {}
    for t in tables:
        steady = _steady(t)
        for name, (values, usable) in _forces(t).items():
            found.setdefault(name, []).append((t, values, np.flatnonzero(steady & usable)))
    out = {}
    for name, parts in found.items():
        speed = [np.sqrt(sum(np.square(t.motion[m][i]) for m in LINEAR)) for t, _, i in parts]
        out[name] = Rows(
            x={
                "V": np.concatenate(speed),
                "alpha": np.concatenate([variable(t, "alpha", 1.0)[i] for t, _, i in parts]),
            },
            y=np.concatenate([values[i] for _, values, i in parts]),
            errors=None,
            labels=tuple(t.labels[k] for t, _, i in parts for k in i),
            response=name,
            tables=tuple(t.name for t, _, _ in parts),
            campaign=tables[0].campaign,
            body=tables[0].body,
        )
    return out


def _check_angles(rows: Rows) -> None:
    """Raise unless there are rows and their angle of attack changes."""
    if not len(rows.y):
        raise InputError(
            f"no usable row of {rows.campaign} without drift, rotation and deflected controls",
            "a sweep of the angle of attack", column="glide_polar",
        )  # fmt: skip
    if np.ptp(rows.x["alpha"]) <= NEAR_ZERO:
        raise InputError(
            f"one angle of attack, {np.degrees(rows.x['alpha'][0]):.3g} degrees, on every row of {rows.campaign}",
            "alpha [deg] with several angles, or w [m/s] beside u [m/s]", column="glide_polar",
        )  # fmt: skip


def _fitted(rows: Rows, unit: str) -> FittedModel:
    name, power = rows.response, POWERS[rows.response]
    angle = f"alpha [{unit}]"
    used = replace(rows, x={"V": rows.x["V"], angle: rows.x["alpha"] * (DEGREES if unit == "deg" else 1.0)})
    square = ("V", 2, False)
    symbols = (f"K_{name}0", f"K_{name} [1/{unit}{'^2' if power > 1 else ''}]")
    form = f"{name} = (K_{name}0 + K_{name} a{'^2' if power > 1 else ''}) V^2, a in {unit}, V in m/s"
    terms = (Term((square,)), Term(((angle, power, False), square)))
    return model_of(used, terms, symbols, form, unit="N*m" if name == "M" else "N")


def _other_unit(model: FittedModel, unit: str) -> str:
    """The slope in the other unit of angle, in words."""
    power = POWERS[model.response]
    value, half = model.named(model.symbols[1])
    other, k = ("rad", DEGREES**power) if unit == "deg" else ("deg", DEGREES**-power)
    symbol = model.symbols[1].replace(unit, other)
    return f"The same slope in the other unit: {symbol} = {value * k:.6g} +- {half * k:.3g}."


def _said(model: FittedModel, unit: str) -> tuple[str, ...]:
    out = [
        f"K_{model.response}0 and K_{model.response} times V^2 give {model.unit}: they hold the fluid's density and are "
        "not divided by an area.",
        _other_unit(model, unit),
    ]
    if np.ptp(model.x["V"]) <= 1e-3 * model.x["V"].max():
        out.append(
            f"All rows run at {model.x['V'].mean():.4g} m/s: that the force goes with V^2 is assumed, not tested."
        )
    return tuple(out)


def _per_unit(result: FitResult, slope: str) -> tuple[dict[str, tuple[float, float]], int] | None:
    """Value and half-width of a slope per degree and per radian, and the power of the angle."""
    for m in result.models:
        if f"K_{m.response}" == slope:
            power = POWERS[m.response]
            value, half = m.named(m.symbols[1])
            k = DEGREES**power
            if result.settings["angle_unit"] == "deg":
                return {"deg": (value, half), "rad": (value * k, half * k)}, power
            return {"deg": (value / k, half / k), "rad": (value, half)}, power
    return None


def angle_unit_of(printed: Mapping[str, float], result: FitResult) -> AngleUnit:
    """Whether printed coefficients of the polar are per degree or per radian, by the fit to the forces.

    A slope speaks for the unit whose fitted value is nearer to it in ratio: the two lie a factor of 57.3 (K_D: 3283)
    apart. It stays silent where its sign is not the fitted one or the fitted interval includes zero.

    Parameters
    ----------
    printed : mapping of symbol to float
        Some of K_L0 K_L K_D0 K_D K_M0 K_M; only slopes tell anything.
    result : FitResult
        Of this fit.

    Returns
    -------
    AngleUnit
        Undecided (``unit`` empty) where no slope speaks or two of them disagree.

    Raises
    ------
    InputError
        A symbol that is not one of the polar.
    """
    if wrong := [s for s in printed if s not in PRINTABLE]:
        raise InputError(shown(wrong[0]), f"one of {', '.join(PRINTABLE)}", column="glide_polar.printed")
    votes: set[str] = set()
    said = []
    for slope in (s for s in SLOPES if s in printed):
        fitted = _per_unit(result, slope)
        if fitted is None:
            said.append(f"{slope}: not fitted, so the printed {printed[slope]:g} is not compared.")
            continue
        both, _ = fitted
        value, half = both["deg"]
        if not (np.isfinite(half) and abs(value) > half) or value * printed[slope] <= 0.0:
            said.append(
                f"{slope}: printed {printed[slope]:g}, fitted {value:.4g} +- {half:.2g} per degree: of another sign, or "
                "the fit does not tell it from zero; it says nothing about the unit."
            )
            continue
        unit = min(both, key=lambda u: abs(float(np.log(printed[slope] / both[u][0]))))
        value, half = both[unit]
        place = "inside" if abs(printed[slope] - value) <= half else "outside"
        votes.add(unit)
        said.append(f"{slope}: printed {printed[slope]:g} is per {unit}, {place} the fitted {value:.5g} +- {half:.2g}.")
    if len(votes) == 1:
        return AngleUnit(next(iter(votes)), tuple(said))
    why = "The slopes disagree about the unit of the angle." if votes else "No slope tells the unit of the angle."
    return AngleUnit("", (*said, why))


def _printed(items: Sequence[str]) -> dict[str, float]:
    """``K_L=9.5`` as numbers."""
    out = {}
    for item in items:
        symbol, _, text = item.partition("=")
        try:
            out[symbol] = float(text)
        except ValueError:
            raise InputError(shown(item), "SYMBOL=NUMBER such as K_L=9.5281", column="glide_polar.printed") from None
        if not np.isfinite(out[symbol]):
            raise InputError(shown(item), "a finite number", column="glide_polar.printed")
    return out


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit lift, drag and pitching moment over the angle of attack and the speed.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point. Rows with drift (beyond 0.3 degrees), rotation or deflected controls
        are left out. One speed is enough; that the force goes with V^2 is then assumed, which the result says.
    scaling : Scaling
        Kept with the (empty) set of SNAME coefficients; the polar is dimensional.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Models ``L``, ``D`` [N] and, with a column M, ``M`` [N m], over V [m/s] and alpha.

    Raises
    ------
    InputError
        No X or Z, no row that can be used, one angle of attack only, or no more rows than terms.
    """
    chosen = parse_options(Options, options, "glide_polar")
    printed = _printed(chosen.printed)
    first = tables[0]
    models = []
    for rows in _rows(tables).values():
        _check_angles(rows)
        model = _fitted(rows, chosen.angle_unit)
        models.append(replace(model, statements=(*_said(model, chosen.angle_unit), *model.statements)))
    result = FitResult(
        fit="glide_polar",
        campaign=first.campaign,
        body=first.body,
        coefficients=CoefficientSet(
            (), np.zeros((0, 0)), scaling, first.reference_point, first.datum, first.body
        ),
        sweeps=(),
        citations=citations,
        settings={"angle_unit": chosen.angle_unit, "printed": " ".join(chosen.printed)},
        models=tuple(models),
    )  # fmt: skip
    if not printed:
        return result
    answer = angle_unit_of(printed, result)
    verdict = f"The printed coefficients are per {answer.unit}." if answer.unit else "Their unit is not decided."
    noted = replace(models[0], statements=(*models[0].statements, *answer.statements, verdict))
    return replace(result, models=(noted, *models[1:]))
