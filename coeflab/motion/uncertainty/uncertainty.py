"""The uncertainty of a parameter file carried through a manoeuvre: what is asked for, how members are moved, and what came out."""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import MEMBERS
from coeflab.core.machine import compiles, cores, one_thread, stage
from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass, locking
from coeflab.core.version import VERSION
from coeflab.law.symbols import MOTIONS
from coeflab.motion.approach import in_current, undetermined_at_once
from coeflab.motion.manoeuvre import Figure, Manoeuvre
from coeflab.motion.manoeuvres import MANOEUVRES
from coeflab.motion.marching import KERNELS, chosen_step, march_by_tolerance
from coeflab.motion.trajectory import Ended, Trajectory
from coeflab.motion.uncertainty.batches import Batch, Setup, Store, carried_out, figures_of, prepared, run_batch
from coeflab.motion.uncertainty.drawn_stability import drawn_stability
from coeflab.motion.uncertainty.drawn_vehicles import drawn, unfelt
from coeflab.motion.uncertainty.draws import Uncertain
from coeflab.motion.uncertainty.sobol import SobolDesign, known_share, share_noise, sobol_design, sobol_indices
from coeflab.motion.uncertainty.spread import MOST_LACKING, Importance, Spread, shares, spread
from coeflab.motion.uncertainty.tests import group_share, tests_of
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.inertia import MEASURED, WaterInertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES

FEWEST_MEMBERS = 40


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked for.

    Attributes
    ----------
    manoeuvre : str
    options : mapping
        Of the manoeuvre.
    members : int
        40 to a million.
    seed : int
    sobol : bool
        Whether independent groups get Sobol indices: as many rows as the largest power of two within ``members``, each of
        2 + groups further runs.
    free, hold : sequence of str
    tables : bool
    accelerations : {"measured", "computed"}
    current : (float, float, float)
    kernel : str
        Of the march: auto, numpy or compiled.
    """

    manoeuvre: str
    options: Mapping[str, int | float | str]
    members: int = 1000
    seed: int = 1
    sobol: bool = False
    free: Sequence[str] = ()
    hold: Sequence[str] = ()
    tables: bool = False
    accelerations: str = MEASURED
    current: tuple[float, float, float] = (0.0, 0.0, 0.0)
    kernel: str = "auto"

    def __post_init__(self) -> None:
        if not FEWEST_MEMBERS <= self.members <= MEMBERS:
            raise InputError(
                f"{self.members} members", f"{FEWEST_MEMBERS} to {MEMBERS:,}", column="--members",
                advice="A percentile of fewer is no interval." if self.members < FEWEST_MEMBERS else "",
            )  # fmt: skip
        if self.seed < 0:
            raise InputError(f"a seed of {self.seed}", "a whole number from 0", column="--seed")
        if self.kernel not in KERNELS:
            raise InputError(shown(self.kernel), f"one of {', '.join(KERNELS)}", column="--kernel")


@dataclass(frozen=True, slots=True, eq=False)
@locking("deviations values")
class Carried:
    """What came out.

    Attributes
    ----------
    question : Question
    vehicle : str
    length : float
    varied : Uncertain
    deviations : (members, k) array
    names : tuple of str
        Figures of the manoeuvre.
    values : (members, figures) array
        Not a number where a member does not have the figure.
    spreads : tuple of Spread
        Figures of the manoeuvre, then stability indices.
    importances : tuple of Importance
    water : WaterInertia
        Which accelerations were chosen.
    runs : int
        Motions that were computed, those for Sobol indices too.
    rows : int
        Of the Sobol design; zero where there is none.
    statements : tuple of str
    undetermined : str
        Why no figure of the manoeuvre has a value at the values of the file, so that no member was moved.
    """

    question: Question
    vehicle: str
    length: float
    varied: Uncertain
    deviations: Array
    names: tuple[str, ...]
    values: Array
    spreads: tuple[Spread, ...]
    importances: tuple[Importance, ...]
    water: WaterInertia
    runs: int
    rows: int
    statements: tuple[str, ...]
    undetermined: str = ""

    def sample(self, name: str) -> Array:
        """(n,) values of the members that have a figure of the manoeuvre."""
        column = self.values[:, self.names.index(name)]
        return np.asarray(column[np.isfinite(column)])


# Members marched together: enough for arrays to pay, few enough to lose little to a kill; their records stay within MEMORY.
BATCH, LEAST_BATCH, MEMORY = 100, 5, 128 << 20
STATE_BYTES = 14 * 8
CHUNK = 2000  # members whose eigenvalues are taken at once, for memory's sake
TRIED = 5  # draws until one has a plan
SEEN = 0.005  # of the variance: less shows as 0 % in whole per cent
# Of a figure, fixed steps against the adaptive integrator: far below any interval that is worth its members.
STEPPED = 1e-3
EACH = "every member starts in an equilibrium of its own: its thrust is that of its straight run at the approach speed"
LOGGER = logging.getLogger("coeflab.uncertainty")


@one_thread()
def uncertainty(
    parameters: ParameterFile, question: Question, workers: int = 1, scheduler: str = "", store: Path | None = None
) -> Carried:
    """Draw, run, and read intervals off.

    Where no figure of the manoeuvre has a value at the values of the file, no member is moved: a figure without value has no
    interval. The reason is `Carried.undetermined`, and the stability indices keep theirs.

    The numbers hang on file, question, release and kernel (compiled where numba is installed, which agrees to 1e-12), not on
    workers, scheduler or on what was stored before.

    Parameters
    ----------
    parameters : ParameterFile
    question : Question
    workers : int
        Local processes; 0: one a core.
    scheduler : str
        Of Dask, in place of local processes.
    store : Path, optional
        Folder that finished batches are kept in, so that a run that was stopped goes on.

    Raises
    ------
    InputError
        Wrong options, a covariance that is not positive semidefinite, a scheduler that does not answer.
    OutputError
        The store cannot be written.
    """
    if workers < 0:
        raise InputError(f"{workers} workers", "a number from 0; 0: one a core", column="--cores")
    setup, plan = _setup(parameters, question)
    _, body, varied = prepared(setup)
    members = varied.members(question.members, question.seed)
    setup = replace(setup, record=min(plan.duration / 100.0, 0.1 * body.length / body.speed))
    exact, how, still_at_file = _at_the_file(setup, plan)
    if all(f.value is None for f in exact):
        return _stability_alone(
            parameters, question, body, varied, members, undetermined_at_once(body, plan, exact) or _reasons(exact)
        )
    resting = _resting(setup, still_at_file, members)
    still = unfelt(body, varied.symbols, _ordered(plan), resting)
    felt = frozenset() if any(question.current) else still
    sampled = sobol_design(varied, question.members, question.seed, felt) if question.sobol else None
    every = np.vstack([members, *(sampled.to_run if sampled else ())])
    setup = replace(setup, step=_step(setup, plan, every))
    (nominal, ended), *_ = figures_of(setup, np.zeros((1, len(varied.symbols))))
    names = tuple(f.name for f in nominal)
    whole = _run(setup, plan, question, names, every, workers or cores(), scheduler, store)
    count = len(members)
    spreads, importances = [], []
    for k, figure in enumerate(nominal):
        spreads.append(spread(figure, whole.values[:count, k], [s[k] for s in whole.statuses[:count]]))
        found = sampled.spread_out(whole.values[count:, k]) if sampled else ()
        importances.append(_importance(spreads[-1], whole.values[:count, k], members, varied, felt, sampled, found))
    for name, (figure, values, why) in drawn_stability(parameters, varied, members).items():
        spreads.append(spread(figure, values, ["ok"] * count, why))
        found = tuple(
            drawn_stability(parameters, varied, rows)[name][1] for rows in (sampled.samples if sampled else ())
        )
        others = frozenset(varied.symbols) - {str(s) for s in INDICES[name][:4]}
        importances.append(_importance(spreads[-1], values, members, varied, others, sampled, found))
    statements = (*body.statements, *plan.statements, *in_current(np.array(setup.current)), EACH)
    statements += (*varied.statements, *_missed(setup, nominal, ended, exact, how), *_notes(whole.ended[:count], ended))
    if sampled:
        statements += (sampled.statement,)
    if felt:
        statements += (f"without effect on this motion: {', '.join(s for s in varied.symbols if s in felt)}",)
    return Carried(
        question, body.name, body.length, varied, members, names, whole.values[:count], tuple(spreads), tuple(importances),
        body.water, len(every), sampled.base if sampled else 0, tuple(dict.fromkeys(statements)),
    )  # fmt: skip


def _setup(parameters: ParameterFile, question: Question) -> tuple[Setup, Manoeuvre]:
    kernel = question.kernel if question.kernel != "auto" else "compiled" if compiles() else "numpy"
    setup = Setup(
        VERSION,
        parameters.to_json().decode(), question.manoeuvre, tuple(sorted(question.options.items())), tuple(question.free),
        tuple(question.hold), question.tables, question.accelerations, question.current, kernel=kernel,
    )  # fmt: skip
    plugin = MANOEUVRES.load(question.manoeuvre)
    return setup, plugin.plan(prepared(setup)[1], dict(question.options))


def _ordered(plan: Manoeuvre) -> set[str]:
    return {name for orders in (plan.orders, *(p.orders for p in plan.phases)) for name in orders}


def _step(setup: Setup, plan: Manoeuvre, every: Array) -> float:
    """One step for all members, whatever batch they are in."""
    parameters, body, varied = prepared(setup)
    parts = np.array_split(every, -(-len(every) // CHUNK))
    current = np.array(setup.current)
    return min(
        chosen_step(drawn(body, parameters, varied.symbols, rows, setup.tables), plan, current) for rows in parts
    )


def _at_the_file(setup: Setup, plan: Manoeuvre) -> tuple[tuple[Figure, ...], str, frozenset[str]]:
    """Figures at the values of the file by the adaptive integrator, how its motion ended, and free motions that stayed zero."""
    _, body, _ = prepared(setup)
    motion = march_by_tolerance(body, plan, setup.record, current=np.array(setup.current)).trajectory()
    return (
        tuple(MANOEUVRES.load(setup.manoeuvre).figures(motion, body, dict(setup.options))),
        motion.ended.value,
        _zeros(body, motion),
    )


def _zeros(body: Vehicle, motion: Trajectory) -> frozenset[str]:
    nu = np.asarray(motion.velocity)
    return frozenset(m for i, m in enumerate(MOTIONS) if m in body.free and not np.any(nu[:, i]))


def _resting(setup: Setup, zeros: frozenset[str], members: Array) -> frozenset[str]:
    """Of motions that stay zero at the values of the file those that a draw of all coefficients leaves at zero, too.

    A draw deviates in every coefficient, so that what could start such a motion does. Empty where no draw has a plan.
    """
    if not zeros:
        return zeros
    parameters, body, varied = prepared(setup)
    plugin, current = MANOEUVRES.load(setup.manoeuvre), np.array(setup.current)
    for rows in members[:TRIED, None]:
        member = drawn(body, parameters, varied.symbols, rows, setup.tables).member(0)
        try:
            plan = plugin.plan(member, dict(setup.options))
        except InputError:
            continue
        return zeros & _zeros(member, march_by_tolerance(member, plan, setup.record, current=current).trajectory())
    return frozenset()


def _reasons(figures: tuple[Figure, ...]) -> str:
    """Why figures have no value, each reason once."""
    return "; ".join(dict.fromkeys(f.why or f.status for f in figures)) + "."


def _stability_alone(
    parameters: ParameterFile, question: Question, body: Vehicle, varied: Uncertain, members: Array, why: str
) -> Carried:
    """What draws say of the stability indices, where the manoeuvre has no figure that an interval could be of."""
    spreads, importances = [], []
    for name, (figure, values, reason) in drawn_stability(parameters, varied, members).items():
        spreads.append(spread(figure, values, ["ok"] * len(members), reason))
        others = frozenset(varied.symbols) - {str(s) for s in INDICES[name][:4]}
        importances.append(_importance(spreads[-1], values, members, varied, others, None, ()))
    none = np.empty((len(members), 0))
    return Carried(
        question, body.name, body.length, varied, members, (), none, tuple(spreads), tuple(importances), body.water, 0, 0,
        tuple(dict.fromkeys((*body.statements, *varied.statements))), why,
    )  # fmt: skip


def _missed(setup: Setup, nominal: tuple[Figure, ...], ended: str, exact: tuple[Figure, ...], how: str) -> list[str]:
    """Figures at the values of the file that fixed steps do not find as the adaptive integrator does, in words."""
    _, body, _ = prepared(setup)
    time = body.length / body.speed
    sizes = {"m": body.length, "s": time, "m/s": body.speed, "rad/s": 1.0 / time}
    missed = [
        f"{e.name} ({_digits(f.value)} for {_digits(e.value)} {e.unit})"
        for f, e in zip(nominal, exact, strict=True)
        if (f.value is None) != (e.value is None)
        or (
            (f.value is not None and e.value is not None)
            and abs(f.value - e.value) > STEPPED * max(abs(e.value), sizes.get(e.unit, 0.1))
        )
    ]
    if ended != how:
        missed.append(f"the end ({ended} for {how})")
    if not missed:
        return []
    return [text_of("motion.step_too_long", step=setup.step, missed=", ".join(missed))]


def _digits(value: float | None) -> str:
    return "none" if value is None else f"{value:.5g}"


def _run(
    setup: Setup, plan: Manoeuvre, question: Question, names: tuple[str, ...], every: Array, workers: int, scheduler: str,
    store: Path | None,
) -> Batch:  # fmt: skip
    """Every row, in batches, those that the store has not run again."""
    size = int(np.clip(MEMORY / (STATE_BYTES * (plan.duration / setup.record + 2.0)), LEAST_BATCH, BATCH))
    parts = [every[i : i + size] for i in range(0, len(every), size)]
    selected = None if store is None else Store(store, _key(setup, question, names, size))
    done: dict[int, Batch] = {}
    for index, rows in enumerate(parts):
        found, wrong = (None, "") if selected is None else selected.load(index, len(rows), len(names))
        if found is not None:
            done[index] = found
        elif selected is not None and wrong:
            LOGGER.info("%s: %s and is run again", selected.path(index), wrong)
    if selected is not None and done:
        LOGGER.info("%d of %d batches were found in %s", len(done), len(parts), selected.path(0).parent)
    tasks = {i: (setup, names, rows) for i, rows in enumerate(parts) if i not in done}
    stage(f"{len(done)} of {len(parts)} batches of {size} motions")
    for index, batch in carried_out(run_batch, tasks, workers, scheduler):
        done[index] = batch
        if selected is not None:
            selected.save(index, batch)
        stage(f"{len(done)} of {len(parts)} batches of {size} motions")
    ordered = [done[i] for i in range(len(parts))]
    return Batch(
        np.vstack([b.values for b in ordered]), tuple(s for b in ordered for s in b.statuses),
        tuple(e for b in ordered for e in b.ended),
    )  # fmt: skip


def _key(setup: Setup, question: Question, names: tuple[str, ...], size: int) -> str:
    content = [np.__version__, asdict(setup), names, question.members, question.seed, question.sobol, size]
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _importance(
    found: Spread, values: Array, members: Array, varied: Uncertain, still: frozenset[str],
    sampled: SobolDesign | None, results: tuple[Array, ...],
) -> Importance:  # fmt: skip
    name = found.figure.name
    if found.status != "ok":
        return Importance(name, (), why=found.why)
    felt = [k for k, s in enumerate(varied.symbols) if s not in still]
    share = known_share(members[:, felt], values)
    least = max(SEEN, share_noise(len(members)))
    pairs = [(varied.symbols[k], float(v)) for k, v in zip(felt, share, strict=True) if v > least]
    known = tuple(sorted(pairs, key=lambda p: -p[1]))
    columns = {s: members[:, [k]] for k, s in enumerate(varied.symbols) if k in set(felt)}
    by_test = [
        (t, group_share(np.hstack([columns[s] for s in those]), values))
        for t, those in tests_of(tuple(columns)).items()
    ]
    tests = tuple(sorted(((t, v) for t, v in by_test if v > least), key=lambda p: -p[1]))
    if sampled is None:
        return Importance(name, known, tests=tests)
    indices = sobol_indices(results[0], results[1], np.array(results[2:]))
    lacking = 1.0 - indices.rows / sampled.base
    if lacking > MOST_LACKING:
        return Importance(name, known, (), indices.rows, f"{100.0 * lacking:.3g} % of the rows lack the figure", tests)
    if not np.isfinite(indices.first).all():
        return Importance(name, known, (), indices.rows, "the figure does not vary", tests)
    return Importance(name, known, shares(indices, sampled.groups, sampled.sources), indices.rows, tests=tests)


def _notes(ended: tuple[str, ...], how: str) -> list[str]:
    stopped = [e for e in ended if e != Ended.COMPLETE.value]
    out = []
    if stopped:
        counts = ", ".join(f"{e} {stopped.count(e)}" for e in sorted(set(stopped)))
        out.append(f"motions that ended early: {len(stopped)} of {len(ended)} ({counts})")
    if how != Ended.COMPLETE.value:
        out.append(f"the motion at the values of the file ended early: {how}")
    return out
