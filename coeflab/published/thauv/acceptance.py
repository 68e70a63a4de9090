"""THAUV, a twin-hull glider: steady glides, the published speeds, and two dive-and-surface cycles in time."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.machine import one_thread
from coeflab.core.text.bounded import own_text
from coeflab.glider.flight import Flown, fly
from coeflab.glider.glide import steady_glides
from coeflab.glider.glider import Glider, GliderPhase
from coeflab.glider.motion import unexplained_power
from coeflab.glider.steady_glide import glide
from coeflab.published.parameter_files import thauv_file
from coeflab.published.publication import Row, publication
from coeflab.published.thauv.figures import figures
from coeflab.published.thauv.in_space import compared_in_space, dive_files, flown_spiral, space_of
from coeflab.published.thauv.pitch_balance import GlideSpeed, calibrated, speed_of
from coeflab.report.acceptance import Acceptance, Basis, ComparedTable

PAPER = publication("thauv")


GAIN, SETTLED = 1.0, 1e-6
REPEATED = {"m3 - m1": ("kg", 0.05)} | dict.fromkeys(
    ("moment below", "moment ahead, 1", "moment ahead, 2"), ("N m", 0.0005)
)
FINE = 1e-8  # m; no finer than that, so that every machine says the same
STEADY_AFTER = 170.0  # s, as printed
STATES, SEED = 300, 20260101
VEHICLE = 66.35
SPIRALS = "02"


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper's text and Table 3 let us judge."""
    flown = fly(shipped("cfd_data") / "thauv", 1, {})
    gliders = {f.run.glider.name.rpartition("_")[2]: f for f in flown}
    spiral = flown_spiral(gliders[SPIRALS].run.glider)
    known = map(PAPER.text, ("calibrated", "assumed", "not_drawn"))
    return PAPER.acceptance(
        (*compared(gliders), *compared_in_space(gliders[SPIRALS].run.glider, spiral)),
        (*known, _munk(gliders), _damping(gliders), _radians(gliders), *_motion(gliders)),
        figures=tuple(figures(flown, spiral[0])),
        parameter_files=(*(thauv_file(f.run.glider) for f in flown), *dive_files([f.run.glider for f in flown])),
    )


def compared(gliders: dict[str, Flown]) -> tuple[ComparedTable, ...]:
    """Every number, of gliders that have flown their cycle, by case: 01, 02 and 03."""
    tables = (_engine, _steady, _speeds, _left_out, _constants, _cycle, _climbs, _settling, _gains, _power)
    return tuple(table(gliders) for table in tables)


def _published(table: str) -> list[dict[str, str]]:
    lines = own_text(shipped("cfd_data") / "thauv" / "published.csv").splitlines()
    return [row for row in csv.DictReader(lines) if row["table"] == table]


def _dive(glider: Glider, stage: str) -> GliderPhase:
    return next(p for p in glider.phases if p.name == f"dive, stage {stage}")


def _engine(gliders: dict[str, Flown]) -> ComparedTable:
    found = 2.0 * space_of(gliders["01"].run.glider)[0].masses.ballast(0.03)
    row = Row("piston at 0.03 m", "net mass, both engines", "kg", 0.483, found)
    return PAPER.table("engine", (row,))


def _steady(gliders: dict[str, Flown]) -> ComparedTable:
    rows = []
    for p in _published("steady_glide"):
        g = gliders[p["case"]].run.glider
        weight = _dive(g, p["stage"]).net_mass * g.gravity
        speed, zeta = glide(g.body.polar, weight, np.radians(float(p["alpha [deg]"])))
        case = f"case {p['case']}, {p['alpha [deg]']} deg"
        rows.append(Row(case, "V", "m/s", float(p["V [m/s]"]), float(speed)))
        rows.append(Row(case, "zeta", "deg", float(p["zeta [deg]"]), float(np.degrees(zeta))))
    return PAPER.table("steady_glides", rows)


def _speeds(gliders: dict[str, Flown]) -> ComparedTable:
    rows = []
    for p in _published("published_speed"):
        g = gliders[p["case"]].run.glider
        found = steady_glides(g, _dive(g, p["stage"]))
        speed = found[0].speed if len(found) == 1 else None
        rows.append(Row(_case(p), "V", "m/s", float(p["V [m/s]"]), speed))
    return PAPER.table("speeds", rows)


def _known(gliders: dict[str, Flown]) -> list[GlideSpeed]:
    out = []
    for p in _published("published_speed"):
        g = gliders[p["case"]].run.glider
        weight = _dive(g, p["stage"]).net_mass * g.gravity
        out.append(GlideSpeed(g.body.polar, weight, int(p["stage"]) - 1, float(p["V [m/s]"])))
    return out


def _left_out(gliders: dict[str, Flown]) -> ComparedTable:
    known, rows = _known(gliders), []
    for i, p in enumerate(_published("published_speed")):
        speed = speed_of(known[i], calibrated([*known[:i], *known[i + 1 :]]))
        found = speed if np.isfinite(speed) else None
        rows.append(Row(f"{_case(p)}, left out", "V", "m/s", known[i].speed, found))
    return PAPER.table("left_out", rows)


def _constants(gliders: dict[str, Flown]) -> ComparedTable:
    """The calibration once more: what the vehicle files state comes from nowhere else."""
    g, found = gliders["01"].run.glider, calibrated(_known(gliders))
    ahead = [g.body.moments(*_dive(g, stage).setting[:2])[0] for stage in ("1", "2")]
    stated = (g.body.munk, g.mass.moment_below, *ahead)
    rows = tuple(
        Row("all six speeds", name, unit, ours, float(again) if np.isfinite(again) else None, within)
        for (name, (unit, within)), ours, again in zip(REPEATED.items(), stated, found, strict=True)
    )
    return PAPER.table("constants", rows)


def _cycle(gliders: dict[str, Flown]) -> ComparedTable:
    rows: list[Row] = []
    settled: list[float] = []
    for p in _published("published_speed"):
        run = gliders[p["case"]].run
        index = next((i for i in range(len(run.ends)) if run.phase_of(i) == _dive(run.glider, p["stage"])), None)
        speed = None if index is None else float(run.speed[run.ends[index]])
        rows.append(Row(_case(p), "V at the end", "m/s", float(p["V [m/s]"]), speed))
        steady = None if index is None else run.nearest(index)
        if speed is not None and steady is not None:
            settled.append(abs(speed - steady.speed))
    far = max([SETTLED, *settled])  # no finer than that, so that every machine says the same
    return PAPER.table("cycle", rows, far=far)


def _climbs(gliders: dict[str, Flown]) -> ComparedTable:
    """A dive ends where its time does; the last climb ends at the surface, which only a glider that is light comes to."""
    rows = tuple(
        Row(f"case {case}", "depth after the second climb", "m", 0.0, max(abs(float(f.run.depth[-1])), FINE))
        for case, f in gliders.items()
    )  # fmt: skip
    return PAPER.table("climbs", rows)


def _settling(gliders: dict[str, Flown]) -> ComparedTable:
    times = [f.run.settling(0) for f in gliders.values()]
    slowest = max(t for t in times if t is not None) if None not in times else None
    mass, polar = gliders["01"].run.glider.mass, gliders["01"].run.glider.polar
    row = Row("slowest of three cases", "time until the dive is steady", "s", STEADY_AFTER, slowest)
    return PAPER.table("settling", (row,), damping=polar.pitch_damping, inertia=mass.pitch_inertia)


def _power(gliders: dict[str, Flown]) -> ComparedTable:
    draws = np.random.default_rng(SEED).uniform((-1.0, -0.6, -0.3, -0.2), (1.0, 0.6, 0.3, 0.2), (STATES, 4))
    rows = []
    for case, f in gliders.items():
        power, drift = unexplained_power(f.run.glider.body, _dive(f.run.glider, "1").setting, draws)
        moved = f"case {case}, {STATES} motions"
        rows += [
            Row.none(moved, "power without a force", "W", power),
            Row.none(moved, "velocity without a cause", "m/s", drift),
        ]
    return PAPER.table("power", rows)


def _gains(gliders: dict[str, Flown]) -> ComparedTable:
    known = {(p["case"], p["stage"]): float(p["V [m/s]"]) for p in _published("published_speed")}
    rows = []
    for stage, printed in (("1", 28.0), ("2", 25.58)):
        found = 100.0 * (known["02", stage] / known["01", stage] - 1.0)
        rows.append(Row(f"stage {stage}", "gain of the printed speeds", "%", printed, found))
        ours = [steady_glides(g, _dive(g, stage)) for g in (gliders[c].run.glider for c in ("01", "02"))]
        gain = 100.0 * (ours[1][0].speed / ours[0][0].speed - 1.0) if all(ours) else None
        rows.append(Row(f"stage {stage}", "gain of our steady speeds", "%", printed, gain, GAIN, Basis.CALIBRATION))
    return PAPER.table("gains", rows)


def _munk(gliders: dict[str, Flown]) -> str:
    munk, known = gliders["01"].run.glider.body.munk, _known(gliders)
    without = calibrated(known, 0.0)
    missed = max(abs(speed_of(k, without) - k.speed) for k in known)
    return PAPER.text("munk", munk=munk, times=munk / VEHICLE, vehicle=VEHICLE, missed=missed)


def _damping(gliders: dict[str, Flown]) -> str:
    """The least pitch damping with which every glide of the cycles is stable."""
    from scipy.optimize import brentq

    def growth(glider: Glider, phase: GliderPhase, damping: float) -> float:
        damped = replace(glider, polar=replace(glider.polar, pitch_damping=damping))
        return max(s.growth for s in steady_glides(damped, phase))

    pairs = [(f.run.glider, p) for f in gliders.values() for p in f.run.glider.phases]
    free = [growth(g, p, 0.0) for g, p in pairs]
    least = [brentq(lambda d, g=g, p=p: growth(g, p, d), 0.0, g.polar.pitch_damping, xtol=0.01) for g, p in pairs]
    used = gliders["01"].run.glider
    return PAPER.text(
        "damping", unstable=sum(v > 0.0 for v in free), count=len(free), inertia=used.mass.pitch_inertia, least=max(least),
        used=used.polar.pitch_damping,
    )  # fmt: skip


def _radians(gliders: dict[str, Flown]) -> str:
    g = gliders["01"].run.glider
    per_radian = replace(g, polar=replace(g.polar, angle_unit="rad"))
    alpha = np.linspace(-np.pi / 2, np.pi / 2, 1801)
    speed, _ = glide(per_radian.body.polar, _dive(g, "1").net_mass * g.gravity, alpha)
    return PAPER.text("radians", slowest=speed.min())


def _motion(gliders: dict[str, Flown]) -> tuple[str, ...]:
    words = dict.fromkeys(s for f in gliders.values() for s in f.run.statements)
    return tuple(cast("Sequence[str]", words))


def _case(published: dict[str, str]) -> str:
    return f"case {published['case']}, stage {published['stage']}"
