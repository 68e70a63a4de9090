"""What a workbench page needs of a study: sweeps to change, and what follows from their slopes.

Slopes on fewer points are computed here; the page adds up budgets, indices and motions as `coeflab.fits`,
`coeflab.vehicle.stability` and `coeflab.motion` do. A zigzag
takes the file's law with the changed slopes in it; terms that were tied to these follow them, nothing else is fitted again.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import FitResult, Sweep
from coeflab.fits.rows.sweeps import one_size
from coeflab.fits.slope_at_origin import NODES
from coeflab.fits.statistics import origin_slope, slopes
from coeflab.fits.statistics.many_rows import EACH_ROW
from coeflab.fits.uncertainty.budget import Budget
from coeflab.law.coefficient import transfer_matrix
from coeflab.law.symbols import ANGULAR, CONTROLS, MOTIONS, primed
from coeflab.motion.dynamics import FIRST, SECOND
from coeflab.motion.ensemble import alone
from coeflab.motion.manoeuvre import Manoeuvre
from coeflab.motion.manoeuvres import zigzag
from coeflab.motion.marching import chosen_step
from coeflab.motion.orders import orders_of
from coeflab.motion.simulation import moved
from coeflab.motion.trajectory import covered_ranges
from coeflab.motion.turn_limits import WITH, linear_growth, open_in_general, open_turn, speaks_of_turning
from coeflab.motion.vehicle import Vehicle
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES

COMPONENTS = "YNZMK"
RUDDERS = (10.0, 20.0)  # deg: the zigzags of IMO MSC.137(76)
PUBLISHED = 4  # values drawn beside ours


@dataclass(frozen=True, slots=True)
class BenchData:
    """What a workbench page computes with; every part as JSON takes it, arrays as lists.

    Attributes
    ----------
    sweeps : tuple of mapping
        Those that give a slope: points, labels, the study's value and U95, published values, relative parts of studies.
    campaigns : mapping of str to mapping
        Indices of its sweeps, declared inputs with their half-widths, and how a shift of the reference point moves its
        coefficients (first and second order, by the length).
    files : tuple of mapping
        Parameter files: stability indices and zigzags, or why there are none.
    left_out : tuple of str
        What of the study is not on the page, and why, in words.
    """

    sweeps: tuple[Mapping[str, Any], ...]
    campaigns: Mapping[str, Mapping[str, Any]]
    files: tuple[Mapping[str, Any], ...]
    left_out: tuple[str, ...] = ()

    def content(self) -> dict[str, Any]:
        """All of it, every sweep with what it gives on fewer of its points."""
        return {
            "nodes": NODES,
            "sameLevel": slopes.SAME_LEVEL,
            "sweeps": [{**s, "choices": _choices(s)} for s in self.sweeps],
            "campaigns": dict(self.campaigns),
            "files": list(self.files),
            "leftOut": list(self.left_out),
        }


def bench_of(study: Study) -> BenchData | None:
    """The bench of a study; None where no sweep of it gives a slope."""
    fits = [f for f in study.fits if any(_usable(s) for s in f.sweeps)]
    moved_back = [f.campaign for f in fits if "swept about" in f.settings]
    fits = [f for f in fits if "swept about" not in f.settings]
    chosen = [(f, s) for f in fits for s in f.sweeps if _usable(s)]
    if not chosen:
        return None
    budgets = {(b.campaign, b.symbol): b for b in study.budgets}
    sweeps = tuple(_sweep(study, s, budgets.get((s.campaign, s.symbol))) for _, s in chosen)
    place = {(s.campaign, s.symbol): i for i, (_, s) in enumerate(chosen)}
    campaigns = {f.campaign: _campaign(study, f, place) for f in fits}
    files = tuple(_file(study, p, place, [s for _, s in chosen]) for p in study.parameter_files.values())
    many = [f"{primed(s.symbol)} of {s.campaign}" for f in fits for s in f.sweeps if _slope(s) and len(s.x) > EACH_ROW]
    left_out = [f"{name}: swept about another point and moved back" for name in moved_back]
    left_out += [f"{name}: over {EACH_ROW} rows" for name in many]
    lags = [p.name for p in study.parameter_files.values() if any(t.lag is not None for t in p.thrusters)]
    left_out += [f"{name}: lag of its thrusters" for name in lags]
    return BenchData(sweeps, campaigns, files, tuple(left_out))


def _slope(s: Sweep) -> bool:
    return s.parity == "odd" and s.component in COMPONENTS and s.value is not None and s.u95 is not None


def _usable(s: Sweep) -> bool:
    return _slope(s) and len(s.x) <= EACH_ROW


def _choices(sweep: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The sweep up to each smaller setting, and without each of its points."""
    size = np.abs(np.array(sweep["x"]))
    levels, begun = [], -np.inf
    for value in np.unique(size[size > 0.0]).tolist():
        if value - begun > slopes.SAME_LEVEL * size.max():
            levels.append(value)
            begun = value
        levels[-1] = value
    shorter = [(limit, None, size <= limit * (1.0 + slopes.SAME_LEVEL)) for limit in levels[:-1]]
    without = [(None, i, np.arange(len(size)) != i) for i in range(len(size))]
    return [
        {"limit": limit, "dropped": i} | _on(sweep, np.flatnonzero(selected))
        for limit, i, selected in (*shorter, *without)
    ]


def _on(sweep: Mapping[str, Any], rows: NDArray[np.intp]) -> dict[str, Any]:
    """The slope on some points of a sweep, as the study finds it on all; curves to eight digits."""
    x, y = (np.array(sweep[axis])[rows] for axis in "xy")
    se = None if sweep["se"] is None else np.array(sweep["se"])[rows]
    found = origin_slope.estimate(x, y, se, odd=sweep["odd"])
    refused = one_size(x, sweep["variable"], np.ones(len(x)))
    out = {
        "kept": rows.tolist(), "value": None, "reason": refused or found.reason, "status": found.status.value, "removed": [],
    }  # fmt: skip
    if found.design is None or refused:
        return out
    value, u95, moved = slopes.determined(found, "x", None, (0.0, 0.0))
    over = float(np.abs(x).max()) * np.linspace(-1.0, 1.0, NODES)
    mean, half = origin_slope.curve(found, np.concatenate([x, over]))
    by_row = np.zeros(len(x))
    by_row[found.used] = moved
    random = 2.0 * found.noise * float(np.linalg.norm(moved * np.sqrt(found.design.variance)))
    return out | {
        "value": value, "fit": u95, "random": min(random, u95 or 0.0), "removed": rows[np.logical_not(found.used)].tolist(),
        "reach": float(np.abs(x).max()), "curve": _short(mean[len(x) :]), "half": _short(half[len(x) :]),
        "misfit": _short(by_row * (y - mean[: len(x)])),
    }  # fmt: skip


def _short(values: Array) -> list[float]:
    return [float(f"{v:.8g}") for v in values]


def _sweep(study: Study, s: Sweep, budget: Budget | None) -> dict[str, Any]:
    """One sweep; labels that repeat are numbered, so that each names its row across the sweeps of a table."""
    seen: Counter[str] = Counter()
    keys = []
    for label in s.labels:
        seen[label] += 1
        keys.append(label if seen[label] == 1 else f"{label} ({seen[label]})")
    among = next(f for f in study.fits if any(own is s for own in f.sweeps)).coefficients
    found = among[s.symbol]
    studies: list[tuple[str, float, str]] = []
    if budget is not None:
        grid = budget.grid
        if grid is not None and grid.convergence.relative is not None:
            studies.append(("grid", grid.convergence.relative, f"{grid.table} {grid.component} {grid.setting}"))
        studies += [(v.name, v.relative, f"{v.table} {v.component} {v.setting}") for v in budget.studies]
    published = [
        (f"{c.reference}, by {c.reading}", c.published)
        for c in study.comparisons
        if c.coefficient.symbol == s.symbol and c.coefficient.campaign == s.campaign
    ]
    return {
        "symbol": s.symbol, "variable": s.variable, "component": s.component, "campaign": s.campaign, "table": s.table,
        "body": s.body, "readings": s.by_symmetry or s.table, "wanted": s.symbol in study.plan.wanted,
        "x": s.x.tolist(), "y": s.y.tolist(), "se": None if s.se is None else s.se.tolist(), "labels": keys,
        "odd": bool(s.symmetry), "oneSided": s.one_sided, "offset": s.offset, "value": s.value, "u95": found.u95,
        "status": found.status.value, "across": s.angle_name,
        "leftOut": [(p.x, finite(p.y), p.label, p.reason) for p in s.left_out if isfinite(p.x)],
        "base": {
            "at": s.curve[0].tolist(), "curve": s.curve[1].tolist(), "half": s.curve[2].tolist(), "fit": s.u95, "random": s.random,
            "misfit": (s.by_row * (s.y - s.fitted)).tolist(), "removed": s.wrong.tolist(), "reason": s.reason,
        },
        "studies": studies, "published": list(dict.fromkeys(published))[:PUBLISHED],
    }  # fmt: skip


def _campaign(study: Study, fit: FitResult, place: Mapping[tuple[str, str], int]) -> dict[str, Any]:
    own = [s for s in fit.sweeps if (fit.campaign, s.symbol) in place and _usable(s)]
    everything = tuple(s.symbol for s in fit.sweeps if s.value is not None)
    length = fit.coefficients.scaling.length
    both = [transfer_matrix(everything, frozenset(everything), np.array([d / length, 0.0, 0.0])) for d in (1.0, -1.0)]
    known = (both[0][1] & both[1][1])[:, None]
    at = [everything.index(s.symbol) for s in own]
    first = np.where(known, 0.5 * (both[0][0] - both[1][0]), 0.0)[np.ix_(at, at)]
    second = np.where(known, 0.5 * (both[0][0] + both[1][0]) - np.eye(len(everything)), 0.0)[np.ix_(at, at)]
    table = next((t for t in study.tables if t.name in {s.table for s in fit.sweeps if s.value is not None}), None)
    declared = None if table is None else table.uncertainty
    names = () if declared is None else declared.declared
    return {
        "sweeps": [place[fit.campaign, s.symbol] for s in own],
        "inputs": {name: float(getattr(declared, name)) for name in names},
        "first": first.tolist(),
        "second": second.tolist(),
    }


def _file(
    study: Study, file: ParameterFile, place: Mapping[tuple[str, str], int], sweeps: Sequence[Sweep]
) -> dict[str, Any]:
    sources = {
        c.symbol: at
        for c in file.coefficients
        if (at := place.get((c.campaign or "", c.symbol.removesuffix("'")), -1)) >= 0 and c.value == sweeps[at].value
    }
    planned = [m.options for m in study.plan.manoeuvres if (m.parameter_file, m.name) == (file.name, zigzag.NAME)]
    both = [{"rudder": float(np.radians(angle))} for angle in RUDDERS]
    zigzags, why = [], ""
    for options in [*(o for o in planned if o), *both]:
        try:
            zigzags.append(_zigzag(study, file, options, sources))
        except InputError as refused:
            why = f"{refused.found}; expected {refused.expected}"
    return {"name": file.name, "body": file.body, "indices": _indices(file, sources), "zigzags": zigzags, "why": why}


def _indices(file: ParameterFile, sources: Mapping[str, int]) -> list[dict[str, Any]]:
    out = []
    rows = {s: i for i, s in enumerate(file.covariance.symbols)}
    for name, (*symbols, sign) in INDICES.items():
        chosen = [c for s in symbols if (c := file.coefficient(str(s))) is not None and c.value is not None]
        if file.mass is None or len(chosen) < len(symbols):
            continue
        at = [rows.get(c.symbol) for c in chosen]
        cells = [[None if i is None or j is None else file.covariance.matrix[i][j] for j in at] for i in at]
        out.append(
            {
                "name": name, "symbols": [c.symbol for c in chosen], "values": [c.value for c in chosen],
                "origins": [c.campaign or c.origin for c in chosen], "sources": [sources.get(c.symbol, -1) for c in chosen],
                "covariance": cells, "mass": float(sign) * file.mass.mass_prime, "moment": file.mass.mass_moment_prime,
            }
        )  # fmt: skip
    return out


def _zigzag(
    study: Study, file: ParameterFile, options: Mapping[str, Any], sources: Mapping[str, int]
) -> dict[str, Any]:
    """A zigzag as arrays.

    Raises
    ------
    InputError
        The file cannot make it.
    """
    vehicle = moved(file, zigzag.NAME)
    manoeuvre = zigzag.plan(vehicle, options)
    execute = next(abs(p.until.value) for p in manoeuvre.phases if p.until is not None)
    angle = max(abs(v) for p in manoeuvre.phases for v in p.orders.values())
    turns = "dr" in manoeuvre.phases[0].orders
    name = f"{np.degrees(angle):g}/{np.degrees(execute):g}" if turns else f"thrusters, {np.degrees(execute):g} deg"
    return _arrays(vehicle, manoeuvre) | {
        "name": name,
        "execute": execute,
        "links": _links(study, vehicle, file, sources),
    }


def _links(
    study: Study, vehicle: Vehicle, file: ParameterFile, sources: Mapping[str, int]
) -> list[tuple[int, int, float]]:
    """Term, sweep, and what the term's SI coefficient changes with the primed slope: itself, or a term tied to it."""
    out = []
    tied = [f for f in study.fits if f.tied is not None]
    for i, term in enumerate(vehicle.law.terms):
        if term.kind != "prime":
            continue
        if (at := sources.get(primed(term.symbol))) is not None:
            out.append((i, at, term.per_prime))
        c = file.coefficient(primed(term.symbol))
        for f in tied:
            if c is None or f.tied is None or c.campaign != f.campaign or term.symbol not in f.coefficients.symbols:
                continue
            moves = f.tied.moves[f.coefficients.symbols.index(term.symbol)]
            for symbol, move in zip(f.tied.symbols, moves, strict=True):
                if move and (source := sources.get(primed(symbol))) is not None and primed(symbol) != c.symbol:
                    out.append((i, source, term.per_prime * float(move)))
    return out


def _arrays(vehicle: Vehicle, manoeuvre: Manoeuvre) -> dict[str, Any]:
    """A vehicle and a manoeuvre as `coeflab.motion.marching` marches them."""
    at_once = tuple(t.model_copy(update={"lag": None}) for t in vehicle.thrusters)  # the page's march has no lag
    vehicle = replace(vehicle, thrusters=at_once)
    ensemble, orders = alone(vehicle), orders_of(vehicle, manoeuvre)
    dynamics, law = ensemble.dynamics(np.zeros(3)), vehicle.law
    start = np.concatenate(
        [np.zeros(3), manoeuvre.attitude / np.linalg.norm(manoeuvre.attitude), manoeuvre.velocity, [0.0]]
    )
    speed = float(np.linalg.norm(manoeuvre.velocity[:3]))
    named = {name for p in manoeuvre.phases for name in p.orders} | set(manoeuvre.orders)
    return {
        "motions": list(MOTIONS),
        "controls": [c for c in CONTROLS if c in named or c in {s.control for s in vehicle.surfaces}],
        "length": vehicle.length,
        "step": chosen_step(ensemble, manoeuvre),
        "fastest": min(1e3, 100.0 * max(speed, vehicle.speed)),
        "start": start.tolist(),
        "orders": {
            "angles": orders.angles.tolist(), "begin": orders.begin.tolist(), "rate": [finite(r) for r in orders.rate],
            "wrench": orders.wrench.tolist(), "watched": [w >= 0 for w in orders.watched.tolist()],
            "sign": orders.sign.tolist(), "value": orders.value.tolist(), "longest": orders.longest.tolist(),
        },
        "law": {
            "coefficient": law.coefficient.tolist(), "component": law.component.tolist(), "powers": law.powers.tolist(),
            "rows": [[row for row in rows if row] for rows in law.gathered.T.tolist()], "source": law.source.tolist(),
            "prime": law.prime.tolist(), "low": [finite(v) for v in law.low], "high": [finite(v) for v in law.high],
            "tabled": law.tabled.tolist(), "angled": law.angled,
        },
        "quadratics": [
            (int(i), int(FIRST[k]), int(SECOND[k]), float(dynamics.quadratics[i, k])) for i, k in np.argwhere(dynamics.quadratics)
        ],
        "inverse": dynamics.inverse.tolist(),
        "excess": float(dynamics.excess[0]),
        "lever": dynamics.lever[:, 0].tolist(),
        "ranges": [(name, ranges) for name, ranges in covered_ranges(vehicle).items()],
        "limits": [_limit(vehicle, rate, speed) for rate in "rq" if rate in vehicle.free],
    }  # fmt: skip


def _limit(vehicle: Vehicle, rate: str, speed: float) -> dict[str, Any]:
    """Whether a turn is determined as far as the data go, and what `linear_growth` needs where it is not."""
    other, components, _ = WITH[rate]
    stable = linear_growth(vehicle, (other, rate), speed) <= 0.0
    at = [MOTIONS.index(m) for m in (other, rate) if m in vehicle.free]
    held = replace(vehicle, free=tuple(MOTIONS[i] for i in at))
    return {
        "rate": rate,
        "limited": speaks_of_turning(vehicle, rate, components) if stable else open_turn(vehicle, rate, speed) is None,
        "at": at,
        "scale": [speed / vehicle.length if MOTIONS[i] in ANGULAR else speed for i in at],
        "inverse": held.inverse_inertia().tolist(),
        "words": open_in_general(vehicle, rate),
    }
