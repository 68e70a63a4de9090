"""Glide polar: L = (K_L0 + K_L a) V^2, D = (K_D0 + K_D a^2) V^2, M = (K_M0 + K_M a) V^2.

Equations 28-30 of the THAUV paper. D is along the relative flow and L upward, normal to it; M is positive nose up, about
the table's reference point; a is alpha = atan2(w, u). The paper does not say the unit of a. Its published speeds need
degrees (in radians the glide has no such speed) [derived], so the fit gives both and `angle_unit_of` tells which of
them a printed set is in.

Along the body axes, with s = w/V = sin(a), the polar is a series that every reader of derivatives has; for beta = 0 and without the
fifth order of s::

    X = V^2 [-D0 + L0 s + (L1 + D0/2 - D2) s^2 + (L1/6 + D0/8 + D2/6) s^4]
    Z = V^2 [-L0 - (L1 + D0) s + L0/2 s^2 + (L1/3 - D2) s^3]
    M = V^2 [M0 + M1 s + M1/6 s^3]

Coefficients that somebody printed, read from words and held against a fit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.options import measured, one_of, parse_options, words
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fit_result import FitResult, result_of
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.rows.only_moving import only_moving, without_blanks
from coeflab.fits.rows.regression import Rows, model_of, variable
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.law.domain import Domain, Extrapolation
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import FORCES, LINEAR
from coeflab.law.terms import Term, design
from coeflab.law.transforms import wind_errors, wind_forces
from coeflab.tables.force_table import ForceTable


def read_printed(items: Sequence[str], place: str) -> dict[str, float]:
    """``K_L=9.5`` as numbers.

    Raises
    ------
    InputError
        No finite number behind an equals sign.
    """
    out = {}
    for item in items:
        symbol, _, text = item.partition("=")
        try:
            out[symbol] = float(text)
        except ValueError:
            raise InputError(shown(item), "SYMBOL=NUMBER such as K_L=9.5281", column=place) from None
        if not np.isfinite(out[symbol]):
            raise InputError(shown(item), "a finite number", column=place)
    return out


def at_no_angle(symbol: str, printed: float, result: FitResult) -> tuple[bool, str]:
    """Whether a printed coefficient that no unit of the angle touches lies inside the fitted 95 % interval, and that in words.

    Parameters
    ----------
    symbol : str
        K_L0, K_D0 or K_M0.
    printed : float
        SI.
    result : FitResult
    """
    model = next((m for m in result.models if symbol in m.symbols), None)
    if model is None:
        return False, f"{symbol}: not fitted, so the printed {printed:g} is not compared."
    value, half = model.named(symbol)
    if not np.isfinite(half):
        return False, f"{symbol}: printed {printed:g}, fitted {value:.5g} without an interval."
    is_inside = abs(printed - value) <= half
    place = "inside" if is_inside else "outside"
    words = (
        f"{symbol}: printed {printed:g} is {place} the fitted {value:.5g} +- {half:.2g}; it has no unit of the angle."
    )
    return is_inside, words


summary = "lift, drag and pitching moment of a glider over angle of attack and speed, per degree and per radian"
citations = ("thauv", "fossen2011", "mackinnon1985", "bell2002")
POWERS = {"L": 1, "D": 2, "M": 1}
NEAR_ZERO = float(np.radians(0.3))
SAME_SPEED = 1e-3
UNLIKELY = 0.01
SLOPES = ("K_L", "K_D", "K_M")
FREER = "Fit a narrower range of angles, or a polynomial over alpha."
PRINTABLE = ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M")
SERIES = {
    "X0": (0.0, 0.0, -1.0, 0.0, 0.0, 0.0),
    "Xw": (1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    "Xww": (0.0, 1.0, 0.5, -1.0, 0.0, 0.0),
    "Xwwww": (0.0, 1.0 / 6.0, 0.125, 1.0 / 6.0, 0.0, 0.0),
    "Z0": (-1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    "Zw": (0.0, -1.0, -1.0, 0.0, 0.0, 0.0),
    "Zww": (0.5, 0.0, 0.0, 0.0, 0.0, 0.0),
    "Zwww": (0.0, 1.0 / 3.0, 0.0, -1.0, 0.0, 0.0),
    "M0": (0.0, 0.0, 0.0, 0.0, 1.0, 0.0),
    "Mw": (0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
    "Mwww": (0.0, 0.0, 0.0, 0.0, 0.0, 1.0 / 6.0),
}  # of L0 L1 D0 D2 M0 M1, per radian
MUNK = {"Mw": 1.0, "Mwww": -0.5}  # (m3 - m1) u w in powers of w/V


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    angle_unit : {"deg", "rad"}
        ``deg`` lists the models per degree, as the paper prints them, beside those per radian; ``rad`` the latter only.
    noise : {"square", "constant", "stated"}
        How the error of a force goes with V, which gives the weights: ``square`` for an error that is a share of the
        force, as in computations; ``constant`` for a balance; ``stated`` by the table's own standard errors. The intervals stand another noise, but are then wider
        than need be (``square``) or, with fewer rows that count, less sure (``constant``).
    printed : tuple of str
        Coefficients that somebody printed, such as ``K_L=9.5281 K_D=0.215``; the models then state their unit.
    munk : float
        Added mass along z less that along x, kg, where the table's M does not hold the Munk moment, as one from CFD or a tank does.
        (m3 - m1) u w is then added to Mw and Mwww, which state whole moments; the models stay without it.
    """

    angle_unit: str = one_of("deg", "deg", "rad")
    noise: str = one_of("square", "square", "constant", "stated")
    printed: tuple[str, ...] = words()
    munk: float = measured(0.0, -1e9, 1e9, "mass")


@dataclass(frozen=True, slots=True)
class AngleUnit:
    """The unit of a that printed coefficients mean.

    Attributes
    ----------
    unit : {"deg", "rad", ""}
        Empty where the printed coefficients do not say one and the same.
    statements : tuple of str
        One per coefficient compared.
    inside : int
        Printed coefficients inside the fitted 95 % interval.
    """

    unit: str
    statements: tuple[str, ...]
    inside: int = 0


def _forces(table: ForceTable) -> dict[str, tuple[Array, Array | None, NDArray[np.bool_]]]:
    """D, L and, where the table has it, M with their standard errors, where it states them, and the rows that are usable.

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
    flow = {c: table.forces.get(c, zero) for c in FORCES}
    drag, _, lift = wind_forces(alpha, beta, *flow.values())
    of_lift = of_drag = None
    if all(c in table.errors or not np.any(flow[c]) for c in FORCES):
        of_drag, _, of_lift = wind_errors(alpha, beta, *(table.errors.get(c, zero) for c in FORCES))
    out = {"L": (lift, of_lift, usable), "D": (drag, of_drag, usable)}
    if "M" in table.forces:
        out["M"] = (np.asarray(table.forces["M"]), table.errors.get("M"), np.array(table.usable["M"]))
    return out


def _rows(tables: Sequence[ForceTable], noise: str) -> dict[str, tuple[Rows, Array]]:
    """L, D and M over V^2 against alpha in radians, and V."""
    found: dict[str, list[tuple[ForceTable, Array, NDArray[np.intp]]]] = {}
    known: dict[str, list[Array]] = {}
    for t in tables:
        for name, (values, stated, usable) in _forces(t).items():
            found.setdefault(name, []).append((t, values, np.flatnonzero(usable)))
            known.setdefault(name, []).extend([] if stated is None else [stated[usable]])
    out = {}
    for name, parts in found.items():
        squares = [sum((np.square(t.motion[m][i]) for m in LINEAR), np.zeros(len(i))) for t, _, i in parts]
        square = np.concatenate(squares)
        if noise == "stated" and len(known[name]) < len(parts):
            raise input_error("fits.no_standard_errors", column="glide_polar.noise", name=name)
        weights = {"square": None, "constant": 1.0 / square}
        rows = Rows(
            x={"alpha": np.concatenate([variable(t, "alpha", 1.0)[i] for t, _, i in parts])},
            y=np.concatenate([values[i] for _, values, i in parts]) / square,
            errors=np.concatenate(known[name]) / square if noise == "stated" else weights[noise],
            labels=tuple(t.labels[k] for t, _, i in parts for k in i),
            response=f"{name}/V^2",
            tables=tuple(t.name for t, _, _ in parts),
            campaign=tables[0].campaign,
            body=tables[0].body,
        )
        out[name] = rows, np.sqrt(square)
    return out


def _check_angles(rows: Rows) -> None:
    """Raise unless there are rows and their angle of attack changes."""
    if not len(rows.y):
        raise input_error("fits.no_usable_row", column="glide_polar", response=rows.response, campaign=rows.campaign)
    if np.ptp(rows.x["alpha"]) <= NEAR_ZERO:
        raise input_error(
            "fits.one_angle_attack", column="glide_polar", degrees=np.degrees(rows.x["alpha"][0]), campaign=rows.campaign,
        )  # fmt: skip


def _fitted(rows: Rows, name: str, unit: str) -> FittedModel:
    """The law of one force; per degree it is a listing, whose domain stays in radians."""
    power, angle = POWERS[name], "alpha" if unit == "rad" else "alpha_deg"
    squared = "^2" if power > 1 else ""
    used = rows if unit == "rad" else replace(rows, x={angle: np.degrees(rows.x["alpha"]), **rows.x})
    symbols = (f"K_{name}0", f"K_{name} [1/{unit}{squared}]")
    form = f"{name} = (K_{name}0 + K_{name} a{squared}) V^2, a in {unit}, V in m/s"
    terms = (Term(), Term(((angle, power, False),)))
    model = model_of(used, terms, symbols, form, unit="N*m/(m/s)^2" if name == "M" else "N/(m/s)^2")
    statements = (*residuals_in_words(model, FREER), *model.statements)
    return replace(model, domain=Domain.of(rows.x, Extrapolation.REFUSE), x=used.x, statements=statements)


def _notes(model: FittedModel, name: str, speed: Array, errors: Array | None) -> tuple[str, ...]:
    """What K holds, and whether the force goes with the square of the speed."""
    held = f"K_{name}0 and K_{name} include the fluid's density and are not divided by an area."
    if np.ptp(speed) <= SAME_SPEED * speed.max():
        return held, f"All rows run at {speed.mean():.4g} m/s: that the force goes with V^2 is assumed, not tested."
    relative = speed / speed.mean() - 1.0
    extra = fit_linear(np.column_stack([design(model.terms, model.x), relative]), model.y, errors)
    error = float(np.sqrt(extra.covariance[-1, -1]))
    if not np.isfinite(extra.half_width[-1]) or error == 0.0:
        return held, "The rows do not show whether the force goes with V^2."
    chance = float(t_probability(float(extra.coefficients[-1]) / error, float(extra.freedom[-1])))
    where = f"with V from {speed.min():.4g} to {speed.max():.4g} m/s"
    if chance >= UNLIKELY:
        return held, f"{name}/V^2 shows no trend {where} (p = {chance:.2g}), as the law assumes."
    return held, f"{name}/V^2 changes {where} (p = {chance:.2g}): the force does not go with V^2 alone."


def _per_unit(result: FitResult, slope: str) -> dict[str, tuple[float, float]] | None:
    """Value and half-width of a slope per degree and per radian."""
    for m in result.models:
        found = next((s for s in m.symbols if s.startswith(f"{slope} [1/rad")), None)
        if found is not None:
            value, half = m.named(found)
            k = np.radians(1.0) ** POWERS[slope[-1]]
            return {"deg": (value * k, half * k), "rad": (value, half)}
    return None


def series(polar: Array, munk: float = 0.0) -> dict[str, float]:
    """The polar along the body axes: SI factors of V^2 and powers of w/V, by the symbols of derivatives; see the module.

    Parameters
    ----------
    polar : (6,) array
        L0, L1, D0, D2, M0, M1, per radian.
    munk : float
        m3 - m1 of a Munk moment that M does not hold, kg.
    """
    return {s: float(np.dot(row, polar)) + munk * MUNK.get(s, 0.0) for s, row in SERIES.items()}


def with_munk(table: ForceTable, munk: float) -> ForceTable:
    """The table with the Munk moment (m3 - m1) u w in its M; ``munk`` is m3 - m1, kg."""
    if not munk or "M" not in table.forces:
        return table
    whole = table.forces["M"] + munk * table.motion["u"] * table.motion["w"]
    return replace(table, forces={**table.forces, "M": whole})


def _derivatives(
    models: Sequence[FittedModel], scaling: Scaling, first: ForceTable, munk: float
) -> tuple[list[Coefficient], Array]:
    """The series of fitted models, primed, with what their scatter and form leave open; errors of two models are independent."""
    place = {f"{name}/V^2": slice(2 * i, 2 * i + 2) for i, name in enumerate("LDM")}
    polar, joint, scatter, statuses = (
        np.full(6, np.nan),
        np.zeros((6, 6)),
        np.zeros((6, 6)),
        [Status.NOT_DETERMINED] * 6,
    )
    for m in models:
        at = place[m.response]
        polar[at] = m.fit.coefficients
        joint[at, at], scatter[at, at] = (np.nan_to_num(f.covariance) for f in (m, replace(m, remainder=None)))
        statuses[at] = [m.worth(i)[1] for i in range(2)]
    known = {s: np.array(row) for s, row in SERIES.items() if np.isfinite(polar[np.flatnonzero(row)]).all()}
    values = series(np.nan_to_num(polar), munk)
    units = {s: scaling.unit(s, first.conditions.density) for s in known}
    rows = np.array([row / units[s] for s, row in known.items()])
    covariance, random = rows @ joint @ rows.T, rows @ scatter @ rows.T
    out = []
    for i, (symbol, row) in enumerate(known.items()):
        of = [statuses[k] for k in np.flatnonzero(row)]
        status = next((s for s in of if s is not Status.FORM_ASSUMED), Status.FORM_ASSUMED)
        half = 2.0 * np.sqrt(np.array([covariance[i, i], random[i, i]]))
        sure = status is Status.FORM_ASSUMED
        parts = (
            Parts(random=float(half[1]), model_form=float(np.sqrt(max(half[0] ** 2 - half[1] ** 2, 0.0))))
            if sure
            else Parts()
        )
        held = [m for m in models if any(row[place[m.response]])]
        out.append(
            Coefficient(
                symbol=symbol, value=values[symbol] / units[symbol], u95=float(half[0]) if sure else None, status=status,
                body=first.body, parts=parts, origin="fit", table=held[0].table,
                campaign=first.campaign, n_points=min(m.n_points for m in held), citation=first.source.citation,
                estimator=f"{' and '.join(m.response[0] for m in held)} of the polar along the body axes",
            )
        )  # fmt: skip
    return out, covariance


def angle_unit_of(printed: Mapping[str, float], result: FitResult) -> AngleUnit:
    """Whether printed coefficients of the polar are per degree or per radian, by the fit to the forces.

    A slope speaks for the unit whose fitted value is nearer to it in ratio: the two lie a factor of 57.3 (K_D: 3283)
    apart. It stays silent where its sign is not the fitted one or the fitted interval includes zero.

    Parameters
    ----------
    printed : mapping of symbol to float
        Some of K_L0 K_L K_D0 K_D K_M0 K_M; only slopes tell the unit, the others are compared with their intervals.
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
    statements, inside = [], 0
    for slope in (s for s in PRINTABLE if s in printed):
        if slope not in SLOPES:
            is_inside, words = at_no_angle(slope, printed[slope], result)
            inside += is_inside
            statements.append(words)
            continue
        fitted = _per_unit(result, slope)
        if fitted is None:
            statements.append(f"{slope}: not fitted, so the printed {printed[slope]:g} is not compared.")
            continue
        value, half = fitted["deg"]
        if not (np.isfinite(half) and abs(value) > half) or value * printed[slope] <= 0.0:
            statements.append(
                f"{slope}: printed {printed[slope]:g}, fitted {value:.4g} +- {half:.2g} per degree: of another sign, or the fit cannot distinguish it from zero; it does not decide the unit."
            )
            continue
        unit = min(fitted, key=lambda u: abs(float(np.log(printed[slope] / fitted[u][0]))))
        value, half = fitted[unit]
        is_inside = abs(printed[slope] - value) <= half
        inside += is_inside
        votes.add(unit)
        statements.append(
            f"{slope}: printed {printed[slope]:g} is per {unit}, {'inside' if is_inside else 'outside'} the fitted {value:.5g} +- {half:.2g}."
        )
    if len(votes) == 1:
        return AngleUnit(next(iter(votes)), tuple(statements), inside)
    why = "The slopes disagree about the unit of the angle." if votes else "No slope decides the unit of the angle."
    return AngleUnit("", (*statements, why), inside)


def printed_inside(result: FitResult) -> tuple[int, int]:
    """How many printed coefficients lie inside the fitted 95 % intervals, and how many are printed."""
    if not result.settings.get("printed"):
        return 0, 0
    printed = read_printed(result.settings["printed"].split(), "glide_polar.printed")
    return angle_unit_of(printed, result).inside, len(printed)


def munk_in_words(result: FitResult) -> str:
    """What Mw holds beside the fitted slope of M, where the options add a Munk moment; else nothing."""
    munk = float(result.settings.get("munk", 0.0))
    slope = _per_unit(result, "K_M")
    if not munk or slope is None:
        return ""
    fitted = slope["rad"][0]
    turned = ", which turns its sign" if fitted * (fitted + munk) < 0.0 else ""
    return f"Mw' is the fitted K_M, {fitted:.4g} per rad, and the Munk moment (m3 - m1) u w of {munk:g} kg that the plan adds{turned}."


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit lift, drag and pitching moment over the angle of attack and the speed.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point. Rows with drift, rotation or deflected controls are left out. One
        speed is enough; that the force goes with V^2 is then assumed, which the result says.
    scaling : Scaling
        Of the derivatives; the polar itself is dimensional.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Models of L/V^2, D/V^2 and, with a column M, M/V^2 over alpha in radians; then, unless they are not wanted, the
        same per degree, over the columns ``alpha_deg`` and (for the domain) ``alpha``. The coefficients are the polar along the
        body axes (see the module), primed, which simulations, exports and checks read.

    Raises
    ------
    InputError
        No X or Z, no row that can be used, one angle of attack only, or no more rows than terms.
    """
    chosen = parse_options(Options, without_blanks(options, "printed"), "glide_polar")
    printed = read_printed(chosen.printed, "glide_polar.printed")
    first = tables[0]
    used, left_out = only_moving([t.at_one_density() for t in tables], ("alpha",), scaling.length)
    radians, degrees = [], []
    for name, (rows, speed) in _rows(used, chosen.noise).items():
        _check_angles(rows)
        model = _fitted(rows, name, "rad")
        statements = (*_notes(model, name, speed, rows.errors), *left_out, *model.statements)
        radians.append(replace(model, statements=statements))
        degrees.append(_fitted(rows, name, "deg"))
    models = (*radians, *(degrees if chosen.angle_unit == "deg" else ()))
    settings = {"angle_unit": chosen.angle_unit, "noise": chosen.noise, "printed": " ".join(chosen.printed)}
    result = result_of(
        "glide_polar", first, scaling, *_derivatives(radians, scaling, first, chosen.munk), citations=citations,
        settings=settings | ({"munk": f"{chosen.munk!r}"} if chosen.munk else {}), models=models,
    )  # fmt: skip
    if not printed:
        return result
    answer = angle_unit_of(printed, result)
    verdict = f"The printed coefficients are per {answer.unit}." if answer.unit else "Their unit is not decided."
    noted = replace(models[0], statements=(*models[0].statements, *answer.statements, verdict))
    return replace(result, models=(noted, *models[1:]))
