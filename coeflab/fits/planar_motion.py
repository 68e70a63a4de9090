"""Added mass and damping from oscillating runs: harmonic regression of every run, then zero amplitude.

With s = s_a cos(theta) the velocity of the motion (v of sway, r of yaw ...), sdot = -omega s_a sin(theta) and the fluid's force
F = F0 + F_s s + F_s|s| s|s| + F_sdot sdot, the fundamental of F is

    in phase with s:     F_s s_a + 8/(3 pi) F_s|s| s_a^2        (of F_sss s^3 instead: 3/4 F_sss s_a^3)
    in quadrature:       -omega s_a F_sdot

(Gertler 1959, the planar motion mechanism; ITTC 7.5-02-06-02, captive model tests; equivalent linear damping as in ITTC
7.5-02-07-04.5). What is recorded is the filter's gain times the fluid's force less the model's inertia, M_RB nudot + C_RB(nu) nu
about the reference point, less weight and buoyancy: each is taken out before the forces are primed. A steady derivative is
the limit at zero frequency; values here are those of the runs' own frequencies unless an interval of w' is named over which
they go as a + b w'^2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import FitResult, result_of
from coeflab.fits.results.oscillation import Explained, OscillatedForce, Oscillation, describing
from coeflab.fits.rows.oscillating import oscillated
from coeflab.fits.statistics.harmonics import CUBIC, QUADRATIC, SAME, AtZero, RunScatter, at_zero_amplitude
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.law.scaling import Scaling
from coeflab.tables.force_table import ForceTable
from coeflab.tables.planar_motion import VARIABLES, PlanarMotionTable

summary = "added mass and damping from oscillating runs (PMM), with what amplitude and frequency do to them"
citations = ("gertler1959", "ittc_captive", "ittc_roll_decay", "liang_zeger1986", "schwarz1978")
reads_series = True

SAME_SPEED = 0.02
FEWEST = 3  # runs that carry an extrapolation to rest
LEAST_WEIGHT = 0.05  # of a form that is not rejected
FORMS = {"{0}|{0}|": "{0}|{0}|", "{0}^3": "{0}{0}{0}"}


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    harmonics : int
        Highest harmonic of the regression.
    steady_below : float
        Largest w' = omega L/U up to which coefficients are taken to go as a + b w'^2: only runs up to it are used, and the values
        are those of w' = 0. Zero for no extrapolation: the values are those of the runs' frequencies.
    """

    harmonics: int = bounded(3, 1, 5)
    steady_below: float = bounded(0.0, 0.0, 100.0)


def _oscillation(
    motion: str, component: str, rows: list[tuple[OscillatedForce, tuple[float, float], int]], below: float
) -> Oscillation | None:
    """One component over its runs; None where all of them drift."""
    if below:
        rows = [
            (f, v, n) if f.frequency <= below * (1.0 + SAME) else (replace(f, used=False), v, n) for f, v, n in rows
        ]
    used_rows = [r for r in rows if r[0].used]
    if not used_rows:
        return None
    forces = [f for f, _, _ in used_rows]
    amplitude, frequency = (np.array([getattr(f, n) for f in forces]) for n in ("amplitude", "frequency"))
    freedom = np.array([n if np.isfinite(v[0]) else 0 for _, v, n in used_rows], dtype=float)
    # Runs are weighed as if the scatter of one cycle's force were the same in all.
    assumed = 1.0 / (np.array([f.cycles for f in forces]) * amplitude**2)
    shapes: tuple[Mapping[str, Array | None], ...] = (
        {"{0}|{0}|": QUADRATIC * amplitude, "{0}^3": CUBIC * amplitude**2},
        {"no amplitude": None, "|{0}|": amplitude},
    )
    found: list[AtZero] = []
    for i, columns in enumerate(shapes):
        y = np.array([(f.damping, f.inertia)[i][0] for f in forces])
        own = np.array([v[i] for _, v, _ in used_rows])
        scatter = RunScatter(own, freedom, assumed / (frequency**2 if i else 1.0))
        found.append(at_zero_amplitude(y, scatter, columns, frequency, bool(below)))
    span = (0.0, float(frequency.max())) if below else None
    return Oscillation(motion, VARIABLES[motion], component, tuple(f for f, _, _ in rows), found[0], found[1], span)


def _refuse_mixed(table: PlanarMotionTable) -> None:
    for motion in VARIABLES:
        speeds = [r.speed for r in table.runs if r.motion == motion]
        if speeds and max(speeds) > (1.0 + SAME_SPEED) * min(speeds):
            odd = next(r for r in table.runs if r.motion == motion and r.speed == max(speeds))
            raise odd.fail(
                f"{motion} runs at {min(speeds):g} and {max(speeds):g} m/s", "one speed a motion", column="U",
                advice="Make another campaign of the runs at another speed: Reynolds and Froude number change with it.",
            )  # fmt: skip


def _grouped(
    table: PlanarMotionTable, scaling: Scaling, chosen: Options
) -> dict[tuple[str, str], list[tuple[OscillatedForce, tuple[float, float], int]]]:
    out: dict[tuple[str, str], list[tuple[OscillatedForce, tuple[float, float], int]]] = {}
    for run in table.runs:
        forces, variances, freedom = oscillated(table, run, scaling, chosen.harmonics)
        for c, force in forces.items():
            out.setdefault((run.motion, c), []).append((force, variances[c], freedom))
    return out


def _coefficients(o: Oscillation, table: PlanarMotionTable) -> list[Coefficient]:
    """Damping, acceleration derivative, and the coefficient of x|x| where runs of several amplitudes speak for it."""
    low, high = (f(r.frequency for r in o.used) for f in (min, max))
    where = f"w' = {low:.3g}" if high <= low * (1.0 + SAME) else f"w' {low:.3g} to {high:.3g}"
    where = f"taken to w' = 0 from {where}" if o.interval else where

    def coefficient(symbol: str, value: float, half: float, parts: Parts, how: str, status: Status) -> Coefficient:
        amplitudes = sorted({r.amplitude for r in o.used})
        return Coefficient(
            symbol=symbol,
            value=value,
            u95=finite(half),
            status=status,
            body=table.body,
            parts=parts,
            origin="fit",
            table=table.name,
            campaign=table.campaign,
            estimator=f"PMM, {o.motion}, {how}, {where}",
            window=(0.0 if "zero" in how else amplitudes[0], amplitudes[-1])
            if o.variable in "pqr" and not symbol.endswith("dot")
            else None,
            n_points=len(o.used),
            citation=table.source.citation,
        )

    out = []
    for symbol, at in ((o.symbol, o.damping), (f"{o.symbol}dot", o.inertia)):
        bounded = at.at_zero and np.isfinite(at.half_width)
        how = f"zero amplitude by {at.likeliest.name.format(o.variable)}" if at.at_zero else "at one amplitude"
        if symbol != o.symbol:
            how = "mean of the runs" if at.likeliest.name == "no amplitude" else how
        parts = Parts(random=finite(at.random), model_form=finite(at.form)) if bounded else Parts()
        status = Status.FORM_ASSUMED if bounded else Status.SINGLE_ESTIMATOR
        out.append(coefficient(symbol, at.value, at.half_width if bounded else np.nan, parts, how, status))
    quadratic = next((f for f in o.damping.forms if f.name == "{0}|{0}|"), None)
    if quadratic is not None:
        known = np.isfinite(quadratic.slope_half) and quadratic.weight >= LEAST_WEIGHT
        status = Status.FORM_ASSUMED if known else Status.SINGLE_ESTIMATOR
        if quadratic.weight < LEAST_WEIGHT:
            status = Status.FORM_REJECTED
        half = quadratic.slope_half if known else np.nan
        symbol = f"{o.symbol}|{o.variable}|"
        parts = Parts(random=finite(half))
        out.append(
            coefficient(
                symbol, quadratic.slope, half, parts, f"slope over amplitude, form {o.variable}|{o.variable}|", status
            )
        )
    return out


def _covariance(oscillations: Sequence[Oscillation], coefficients: Sequence[Coefficient]) -> Array:
    """(U95/2)^2 on the diagonal; a slope and its x|x| oppose each other. Components and motions are taken as independent."""
    out = np.diag([np.nan if c.u95 is None else (c.u95 / 2.0) ** 2 for c in coefficients])
    at = {c.symbol: i for i, c in enumerate(coefficients)}
    for o in oscillations:
        quadratic = next((f for f in o.damping.forms if f.name == "{0}|{0}|"), None)
        j = at.get(f"{o.symbol}|{o.variable}|")
        if quadratic is None or j is None:
            continue
        i = at[o.symbol]
        pair = quadratic.correlation * quadratic.weight * np.sqrt(out[i, i] * out[j, j])
        out[i, j] = out[j, i] = pair
    return out


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit added mass and damping of the motions that the runs of one campaign have.

    Parameters
    ----------
    tables : sequence of ForceTable
        `PlanarMotionTable`, of one campaign.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Coefficients with U95 and the runs behind them (``oscillations``). A value at a single amplitude has no U95, as what
        amplitude does to it is unknown. Declared uncertainty of inputs is not in U95.

    Raises
    ------
    InputError
        A record that is too short or too coarse, a motion that is not the declared one or not pure, mixed speeds, or two
        lists of runs of one motion.
    """
    chosen = parse_options(Options, options, "planar_motion")
    found: dict[str, Oscillation] = {}
    coefficients: list[Coefficient] = []
    series_of = [t for t in tables if isinstance(t, PlanarMotionTable)]
    if not series_of:
        raise InputError("tables without runs over time", 'importer = "pmm" and a list of runs', column="planar_motion")
    for table in series_of:
        _refuse_mixed(table)
        for (motion, component), rows in _grouped(table, scaling, chosen).items():
            if _starved(rows, chosen.steady_below):
                coefficients += _too_few(f"{component}{VARIABLES[motion]}", motion, chosen.steady_below, table)
                continue
            o = _oscillation(motion, component, rows, chosen.steady_below)
            if o is None:
                continue
            if o.symbol in found:
                raise InputError(f"two lists of {motion} runs", "one list of the runs of a motion", file=table.name)
            found[o.symbol] = o
            coefficients += _coefficients(o, table)
    if not found and not coefficients:
        raise input_error("fits.no_run_without_mean", file=series_of[0].name)
    first, each = series_of[0], tuple(found.values())
    result = result_of(
        "planar_motion", replace(first, reference_point=first.point), scaling, coefficients, _covariance(each, coefficients), citations=citations,
        settings={"harmonics": str(chosen.harmonics), "steady_below": f"{chosen.steady_below:g}", **_taken_out(first)},
        oscillations=each,
    )  # fmt: skip
    return replace(result, coefficients=result.coefficients.about(first.reference_point))


def _starved(rows: list[tuple[OscillatedForce, tuple[float, float], int]], below: float) -> bool:
    """Whether the runs inside an interval of w' do not carry an extrapolation to rest: three of two frequencies do."""
    inside = [f.frequency for f, _, _ in rows if f.used and f.frequency <= below * (1.0 + SAME)]
    return bool(below) and (len(inside) < FEWEST or max(inside) <= min(inside) * (1.0 + SAME))


def _too_few(symbol: str, motion: str, below: float, table: PlanarMotionTable) -> list[Coefficient]:
    how = f"PMM, {motion}: needs {FEWEST} runs of two frequencies up to w' = {below:g}"
    return [
        Coefficient(
            s, None, None, Status.TOO_FEW_POINTS, table.body, origin="fit", table=table.name, campaign=table.campaign,
            estimator=how, citation=table.source.citation,
        )
        for s in (symbol, f"{symbol}dot")
    ]  # fmt: skip


def _taken_out(table: PlanarMotionTable) -> dict[str, str]:
    """What stood between the water and the records, as settings."""
    out = {f"filter of {c}": f.text for c, f in table.filters.items()}
    in_air = any(r.in_air is not None for r in table.runs)
    model = "by the runs in air" if in_air else "none" if table.inertia is None else f"m = {table.inertia.mass:g} kg"
    out["model inertia subtracted"] = model
    if table.restoring is not None:
        out["restoring moments subtracted"] = "K {:g}, M {:g} N m/rad".format(*table.restoring)
    return out


def against_steady(fit: FitResult, others: Sequence[FitResult]) -> tuple[Explained, ...]:
    """Oscillating runs beside the steady fits of the same body: the largest run of every motion by the steady law.

    Predicted: C + 8/(3 pi) C|x| a + 3/4 Cxxx a^2 with the steady coefficients C at the amplitude a of the run.

    Parameters
    ----------
    fit : FitResult
        Of oscillating runs.
    others : sequence of FitResult
    """
    out = []
    steady = [f for f in others if f.body == fit.body and not f.oscillations]
    laws = list(dict.fromkeys((f.campaign, f.law) for f in steady))
    for o in fit.oscillations:
        run = o.largest
        for campaign, law in laws:
            found = {
                c.symbol: c
                for f in steady if (f.campaign, f.law) == (campaign, law)
                for c in f.coefficients.to_length(fit.coefficients.scaling).coefficients
            }  # fmt: skip
            slope = found.get(o.symbol)
            if slope is None or slope.value is None or not _same_point(fit, steady, campaign):
                continue
            parts = [
                (describing(n, run.amplitude), c)
                for n, s in FORMS.items()
                if (c := found.get(f"{o.component}{s.format(o.variable)}")) is not None and c.value is not None
            ]
            change = sum(k * c.value for k, c in parts if c.value is not None) if parts else np.nan
            halves = [k * (np.nan if c.u95 is None else c.u95) for k, c in parts]
            half = float(np.sqrt(np.sum(np.square(halves)))) if parts else np.nan
            own = (slope.value, np.nan if slope.u95 is None else slope.u95)
            out.append(
                Explained(o.symbol, run.amplitude, run.damping, own, float(change), half, f"{campaign} by {law}")
            )
    return tuple(out)


def _same_point(fit: FitResult, steady: Sequence[FitResult], campaign: str) -> bool:
    """Whether the coefficients refer to one point: a plan without one leaves every campaign at its own."""
    mine = fit.coefficients
    own = [f.coefficients for f in steady if f.campaign == campaign]
    return all(c.datum == mine.datum and np.allclose(c.reference_point, mine.reference_point, atol=1e-9) for c in own)
