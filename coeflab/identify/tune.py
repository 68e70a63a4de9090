"""Numbers of a parameter file tuned to measured steady motions, through the vehicle's own equations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.files import write_all
from coeflab.core.finding import Finding
from coeflab.core.machine import one_thread
from coeflab.core.table import Check
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.texts import input_error, remark
from coeflab.core.types import Array, brief
from coeflab.core.wording import file_stem
from coeflab.identify.output_error import Estimate, by_likelihood, estimate
from coeflab.identify.output_problem import Problem, problem
from coeflab.identify.tuning import (
    TunedParameter,
    TunedQuantity,
    Tuning,
    damps,
    driving,
    statements,
    together_in_words,
    tuned_file,
    tuned_parameters,
)
from coeflab.identify.tuning_figures import agreement_figure
from coeflab.identify.tuning_plan import SteadyCases, TuningPlan, moved
from coeflab.motion.steady_state import differences, level_forces, steady_motions, wrenches
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausibility import plausibility

NUDGE = 1e-6  # of a size: central differences, errors of 1e-10 by rounding and less by curvature
UNITS = {"u": ("m/s", 1.0), "v": ("m/s", 1.0), "V": ("m/s", 1.0), "radius": ("m", 1.0),
         "r": ("deg/s", 180.0 / np.pi), "beta": ("deg", 180.0 / np.pi)}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True)
class Tuned:
    """What came out.

    Attributes
    ----------
    plan : TuningPlan
    tuning : Tuning
    parameters : ParameterFile
        The tuned set.
    """

    plan: TuningPlan
    tuning: Tuning
    parameters: ParameterFile

    @property
    def checks(self) -> tuple[Check, ...]:
        """What is implausible in the tuned set."""
        return plausibility(self.parameters)

    def files(self) -> dict[str, bytes]:
        """Everything to write, by file name."""
        name = file_stem(self.plan.name)
        figure = agreement_figure(self.tuning, f"{name}-agreement")
        return {
            f"{name}.parameters.json": self.parameters.to_json(),
            f"{name}.motions.csv": _motions(self.plan.cases, self.tuning),
            f"{name}.agreement.svg": figure.svg.encode(),
        }


@one_thread()
def tune(plan: TuningPlan) -> Tuned:
    """Fit, account for it, and make the tuned file.

    Raises
    ------
    InputError
        The vehicle settles nowhere in one of the cases, or the file gives no vehicle.
    """
    p = tuning_problem(plan)
    _settles(plan, p)
    try:
        if plan.from_residuals:
            groups = np.tile(np.arange(len(plan.cases.names)), len(plan.cases.lines))
            found, p = by_likelihood(p, groups)
        else:
            found = estimate(p)
    except ArithmeticError as why:
        raise InputError(str(why), "a start and bounds from which the fit can go on", file=plan.file) from None
    names = [f.name for f in plan.free]
    words = list(statements(p, found))
    if plan.from_residuals:
        words.insert(0, "Standard errors are those of the residuals (maximum likelihood); none were stated.")
    moved_parameters = tuned_parameters(names, [f.unit for f in plan.free], p, found)
    drives = _driving(plan, moved_parameters)
    words += [remark(f) for f in (*plan.findings, *drives)]
    tuning = Tuning(
        plan.name, moved_parameters, found.correlation, found.covariance,
        _quantities(plan.cases, p, found),
        tuple(together_in_words(names, c, found.parameters) for c in found.undetermined), found.singular, found.birge,
        found.freedom, found.converged, tuple(words),
    )  # fmt: skip
    return Tuned(plan, tuning, tuned_file(plan, tuning))


def _driving(plan: TuningPlan, parameters: Sequence[TunedParameter]) -> tuple[Finding, ...]:
    """Damping that came out driving, of all that is free."""
    out = []
    for f, p in zip(plan.free, parameters, strict=True):
        signs = {w.sign for w in f.places if damps(w, plan.parameters)}
        along = [replace(p, after=p.after * s) for s in sorted(signs)]
        out += [found for one in along[:1] if (found := driving(one, plan.cases.file.name)) is not None]
    return tuple(out)


def write(tuned: Tuned, folder: Path) -> list[Path]:
    """Write all files; none where one cannot be made."""
    return [folder / name for name in write_all(folder, tuned.files())]


def tuning_problem(plan: TuningPlan) -> Problem:
    """Measured quantities as outputs of the free parameters."""
    cases, free = plan.cases, plan.free

    def with_parameters(parameters: Array) -> Vehicle:
        values = {w: float(x) for f, x in zip(free, parameters, strict=True) for w in f.places}
        return vehicle(moved(plan.parameters, values), free=("u", "v", "r"))

    with_parameters(np.array([f.start for f in free]))  # from here on an error is one of values that the fit tries

    def possible(parameters: Array) -> Vehicle | None:
        """The vehicle; None where none can be, as with an effective mass that is not positive."""
        try:
            return with_parameters(parameters)
        except InputError:
            return None

    @lru_cache(maxsize=4)  # the derivatives are wanted where the outputs were just computed
    def settled_at(parameters: tuple[float, ...]) -> tuple[Vehicle | None, Array]:
        one = possible(np.array(parameters))
        if one is None:
            return None, np.full((len(cases.lines), 6), np.nan)
        return one, steady_motions(one, wrenches(one, cases.commands), cases.controls)[0]

    def operating(parameters: Array) -> tuple[Vehicle | None, Array]:
        return settled_at(tuple(parameters.tolist()))

    def one_set(parameters: Array) -> Array:
        return figures(operating(parameters)[1], cases).ravel()

    def jacobian(parameters: Array) -> Array:
        one, nu = operating(parameters)
        if one is None:
            return np.full((cases.measured.size, len(parameters)), np.nan)
        return _slopes(one, nu, possible, parameters, np.array([f.size for f in free]), cases)

    return problem(
        lambda sets: np.array([one_set(x) for x in sets]),
        cases.measured.ravel(), cases.errors.ravel(), np.array([f.start for f in free]),
        sizes=np.array([f.size for f in free]), prior_mean=np.array([f.prior_mean for f in free]),
        prior_error=np.array([f.prior_error for f in free]), low=np.array([f.low for f in free]),
        high=np.array([f.high for f in free]), jacobian=jacobian,
    )  # fmt: skip


def _slopes(
    one: Vehicle,
    nu: Array,
    possible: Callable[[Array], Vehicle | None],
    parameters: Array,
    sizes: Array,
    cases: SteadyCases,
) -> Array:
    """Derivatives of the outputs (implicit function theorem): how the balance of forces moves, and what restores it.

    NaN where a nudge leads to what cannot be a vehicle.
    """
    at = list(one.free_columns)
    x = nu[:, at]

    def balance(of: Vehicle, velocities: Array) -> Array:
        return level_forces(of, velocities, wrenches(of, cases.commands), cases.controls)

    yields = np.linalg.pinv(np.nan_to_num(differences(lambda v: balance(one, v), x)))
    moves = []
    for i, size in enumerate(sizes):
        step = np.zeros_like(parameters)
        step[i] = NUDGE * size
        more, less = possible(parameters + step), possible(parameters - step)
        moves.append(
            np.full_like(x, np.nan)
            if more is None or less is None
            else (balance(more, x) - balance(less, x)) / (2.0 * NUDGE * size)
        )
    shift = -np.einsum("nij,njp->nip", yields, np.stack(moves, axis=-1))
    out = np.empty((cases.measured.size, len(parameters)))
    for i in range(len(parameters)):
        aside = np.zeros_like(nu)
        aside[:, at] = shift[:, :, i]
        reach = NUDGE / np.maximum(np.max(np.abs(aside)), 1e-300)
        up, down = figures(nu + reach * aside, cases), figures(nu - reach * aside, cases)
        out[:, i] = ((up - down) / (2.0 * reach)).ravel()
    return out


def figures(nu: Array, cases: SteadyCases) -> Array:
    """(n, q) measured quantities of steady motions (n, 6), SI."""
    u, v, r = nu[:, 0], nu[:, 1], nu[:, 5]
    speed = np.hypot(u, v)
    turning = np.abs(r) > 0.0
    radius = np.where(turning, speed / np.where(turning, np.abs(r), 1.0), np.inf)
    beta = np.arcsin(np.clip(v / np.where(speed > 0.0, speed, 1.0), -1.0, 1.0))
    known = {"u": u, "v": v, "V": speed, "r": r, "beta": beta, "radius": radius}
    return np.column_stack([np.abs(known[n]) if n in cases.magnitudes else known[n] for n in cases.names])


def _settles(plan: TuningPlan, p: Problem) -> None:
    """Raise where a measured case has no output at the start."""
    wrong = ~np.isfinite(p.outputs(p.start)) & np.isfinite(p.measured)
    for at in np.flatnonzero(wrong):
        case, quantity = divmod(int(at), len(plan.cases.names))
        raise input_error(
            "identify.untuned_vehicle_under", plan.cases.file, plan.cases.lines[case], names=plan.cases.names[quantity],
        )  # fmt: skip


def _quantities(cases: SteadyCases, p: Problem, found: Estimate) -> tuple[TunedQuantity, ...]:
    shape = cases.measured.shape
    before, after = (p.outputs(x).reshape(shape) for x in (p.start, found.parameters))
    errors = p.errors.reshape(shape)
    out = []
    for k, name in enumerate(cases.names):
        unit, scale = UNITS[name]
        columns = (scale * a[:, k] for a in (cases.measured, before, after, errors))
        out.append(TunedQuantity(name, unit, *columns))
    return tuple(out)


def _motions(cases: SteadyCases, tuning: Tuning) -> bytes:
    """Every case: line, commands, measured, before and after."""
    commands = list(cases.commands[0])
    heads = [f"{q.name} {what} [{q.unit}]" for q in tuning.quantities for what in ("measured", "before", "after")]
    rows: list[list[object]] = [["line", *commands, *heads]]
    for i, line in enumerate(cases.lines):
        values = [a[i] for q in tuning.quantities for a in (q.measured, q.before, q.after)]
        shown = ["" if np.isnan(v) else f"{v:.6g}" for v in values]
        rows.append([line, *(f"{cases.commands[i][c]:g}" for c in commands), *shown])
    return csv_text(rows).encode()
