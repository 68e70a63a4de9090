"""Members of an uncertainty run in batches: how one batch is computed, in whatever process, and how it is kept.

Work spread over this process, local processes, or a Dask cluster; results come as they are finished.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

import numpy as np

from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.files import write_atomically
from coeflab.core.limits import JSON_BYTES
from coeflab.core.machine import dask_client, end_with_parent, one_thread
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass
from coeflab.core.version import VERSION
from coeflab.law.symbols import CONTROLS
from coeflab.motion.ensemble import Ensemble
from coeflab.motion.manoeuvre import Figure, Manoeuvre
from coeflab.motion.manoeuvres import MANOEUVRES
from coeflab.motion.marching import march
from coeflab.motion.simulation import moved
from coeflab.motion.uncertainty.drawn_vehicles import drawn
from coeflab.motion.uncertainty.draws import Uncertain, uncertain
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_file import ParameterFile

NO_PLAN = "no start"
# The compiled kernel takes all cores itself and does not stand two callers in one process, as a Dask worker may have.
ONE_AT_A_TIME = Lock()


@dataclass(frozen=True, slots=True)
class Setup:
    """What every process needs to know, picklable and hashable.

    Attributes
    ----------
    release : str
        Of coeflab: every process must have the same.
    parameters : str
        The parameter file, JSON.
    manoeuvre : str
    options : tuple of (str, value)
        Of the manoeuvre.
    free, hold : tuple of str
    tables : bool
    accelerations : str
        Measured or computed.
    current : (float, float, float)
    step, record : float
    kernel : str
    """

    release: str
    parameters: str
    manoeuvre: str
    options: tuple[tuple[str, int | float | str], ...]
    free: tuple[str, ...]
    hold: tuple[str, ...]
    tables: bool
    accelerations: str
    current: tuple[float, float, float]
    step: float = 0.0
    record: float = 0.0
    kernel: str = "numpy"


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Figures of some members.

    Attributes
    ----------
    values : (m, f) array
        Not a number where a member does not have the figure.
    statuses : tuple of tuple of str
        Of every member and figure.
    ended : tuple of str
        How every member's motion ended.
    """

    values: Array
    statuses: tuple[tuple[str, ...], ...]
    ended: tuple[str, ...]


@lru_cache(maxsize=2)
def prepared(setup: Setup) -> tuple[ParameterFile, Vehicle, Uncertain]:
    """File, vehicle and what is uncertain of it."""
    parameters = ParameterFile.model_validate_json(setup.parameters)
    how = {"tables": setup.tables, "accelerations": setup.accelerations}
    body = moved(parameters, setup.manoeuvre, setup.free, setup.hold, **how)
    return parameters, body, uncertain(parameters, [t.in_file for t in body.law.terms])


@one_thread()
def figures_of(setup: Setup, deviations: Array) -> list[tuple[tuple[Figure, ...], str]]:
    """Figures of every member and how its motion ended; no figures for one that cannot even start.

    Parameters
    ----------
    setup : Setup
    deviations : (m, k) array
        Of `Uncertain.symbols`.
    """
    parameters, body, varied = prepared(setup)
    plugin, options = MANOEUVRES.load(setup.manoeuvre), dict(setup.options)
    whole = drawn(body, parameters, varied.symbols, deviations, setup.tables)
    members = [whole.member(i) for i in range(whole.count)]
    plans = [_plan(plugin, m, options) for m in members]
    out: list[tuple[tuple[Figure, ...], str]] = [((), NO_PLAN)] * whole.count
    alike: dict[Any, list[int]] = {}
    for i, p in enumerate(plans):
        if p is not None:
            alike.setdefault(_steered(p), []).append(i)
    for chosen in alike.values():
        part = Ensemble(
            body, whole.coefficients[chosen], None if whole.added is None else whole.added[chosen],
            None if whole.ideal is None else whole.ideal[chosen],
        )  # fmt: skip
        orders = [p for i in chosen if (p := plans[i]) is not None]
        with ONE_AT_A_TIME:
            found = march(part, orders, setup.step, setup.record, setup.kernel, np.array(setup.current))
        for k, i in enumerate(chosen):
            figures = plugin.figures(found.trajectory(k), members[i], options)
            out[i] = figures, found.ended[k].value
    return out


def _plan(plugin: Any, member: Vehicle, options: dict[str, Any]) -> Manoeuvre | None:
    try:
        plan: Manoeuvre = plugin.plan(member, options)
    except InputError:
        return None  # the file's own values have a plan, so it is the draw: no resistance, a rudder without effect
    return plan


def _steered(plan: Manoeuvre) -> tuple[Any, ...]:
    """What members have to share to be marched together."""
    return tuple((tuple((c, p.orders[c]) for c in CONTROLS if c in p.orders), p.longest, p.until) for p in plan.phases)


@one_thread()
def run_batch(setup: Setup, names: Sequence[str], deviations: Array) -> Batch:
    """Values and statuses of the named figures.

    Parameters
    ----------
    setup : Setup
    names : sequence of str
        Of the figures, in the order of the columns.
    deviations : (m, k) array
        Of `Uncertain.symbols`.

    Raises
    ------
    InputError
        This process has another release of coeflab than the one that asks.
    """
    if setup.release != VERSION:
        raise InputError(f"coeflab {VERSION} in a worker", f"{setup.release} as in the process that asks")
    rows, statuses, ended = [], [], []
    for figures, how in figures_of(setup, deviations):
        known = {f.name: f for f in figures}
        values = [known[n].value if n in known else None for n in names]
        rows.append([math.nan if v is None else v for v in values])
        statuses.append(tuple(known[n].status if n in known else how for n in names))
        ended.append(how)
    return Batch(np.array(rows, dtype=np.float64), tuple(statuses), tuple(ended))


@dataclass(frozen=True, slots=True)
class Store:
    """Finished batches in a folder of their own run, one file each, with a checksum.

    Attributes
    ----------
    folder : Path
    key : str
        Hash of everything that the numbers hang on.
    """

    folder: Path
    key: str

    def path(self, index: int) -> Path:
        """File of a batch."""
        return self.folder / self.key[:16] / f"batch_{index:05d}.json"

    def save(self, index: int, batch: Batch) -> None:
        """Keep a batch; the file is there whole or not at all.

        Raises
        ------
        OutputError
            The folder cannot be written.
        """
        values = [[None if math.isnan(v) else v for v in row] for row in batch.values.tolist()]
        content = {"key": self.key, "batch": index, "values": values, "statuses": batch.statuses, "ended": batch.ended}
        text = json.dumps(content, allow_nan=False)
        write_atomically(self.path(index), f"{_digest(text)}\n{text}\n".encode())

    def load(self, index: int, members: int, figures: int) -> tuple[Batch | None, str]:
        """A batch that was kept, or none and, where there is a file, what is wrong with it.

        Parameters
        ----------
        index : int
        members, figures : int
            Shape that the batch must have.
        """
        path = self.path(index)
        if not path.is_file():
            return None, ""
        try:
            digest, text, rest = whole_bytes(path, JSON_BYTES).decode().split("\n")
            if rest or digest != _digest(text):
                return None, "it is damaged"
            content = parse_json(text, path)
            if content["key"] != self.key or content["batch"] != index:
                return None, "it belongs to another run"
            values = [[math.nan if v is None else v for v in row] for row in content["values"]]
            found = np.array(values, dtype=np.float64)
            statuses, ended = tuple(tuple(row) for row in content["statuses"]), tuple(content["ended"])
        except (InputError, ValueError, KeyError, TypeError):
            return None, "it is damaged"
        if found.shape != (members, figures) or len(statuses) != members or len(ended) != members:
            return None, "it belongs to another run"
        return Batch(found, statuses, ended), ""


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


Result = TypeVar("Result")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def carried_out(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], workers: int, scheduler: str = ""
) -> Iterator[tuple[int, Result]]:
    """(index, result) of every task, in the order in which they are finished.

    Parameters
    ----------
    work : callable
        Of a module, so that other processes find it.
    tasks : mapping of index to its arguments
    workers : int
        Local processes; one: this one.
    scheduler : str
        Address of a Dask scheduler, whose workers have coeflab installed; then ``workers`` says nothing.

    Raises
    ------
    InputError
        No distributed, or no scheduler answers.
    CoeflabError
        A process was killed.
    """
    if scheduler:
        yield from _on_dask(work, tasks, scheduler)
    elif min(workers, len(tasks)) <= 1:
        for index, arguments in tasks.items():
            yield index, work(*arguments)
    else:
        yield from _on_processes(work, tasks, min(workers, len(tasks)))


def _on_processes(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], workers: int
) -> Iterator[tuple[int, Result]]:
    with _one_thread(), ProcessPoolExecutor(workers, get_context("spawn"), initializer=end_with_parent) as pool:
        waiting: dict[Future[Result], int] = {pool.submit(work, *a): index for index, a in tasks.items()}
        try:
            for done in as_completed(waiting):
                yield waiting[done], done.result()
        except BrokenProcessPool:
            raise CoeflabError(text_of("motion.worker_killed")) from None
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def _one_thread() -> Iterator[None]:
    """New processes compute on one core each: the processes are the parallel part."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _on_dask(
    work: Callable[..., Result], tasks: Mapping[int, tuple[Any, ...]], scheduler: str
) -> Iterator[tuple[int, Result]]:
    with dask_client(scheduler, "--scheduler") as client:
        import distributed

        finished: Any = distributed.as_completed
        try:
            waiting = {client.submit(work, *a, pure=False): index for index, a in tasks.items()}
            for done in finished(list(waiting), loop=client.loop):
                yield waiting[done], done.result()
                done.release()
        except ModuleNotFoundError as why:
            raise CoeflabError(
                f"A Dask worker has no module {why.name}: install this release of coeflab there."
            ) from None
        except distributed.KilledWorker as why:
            raise CoeflabError(
                f"Dask workers were killed ({why}). Finished batches are kept where there is a store: start again."
            ) from None
