"""Motions and their figures as tables and as CSV.

Tables of glides: steady ones, the phases of a motion, and where the numbers of a glider come from.

A tuning as tables: parameters, quantities, correlations and what stays open.

What was identified from motions as tables and as CSV.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, with_u95
from coeflab.core.text.csv_rows import csv_text
from coeflab.law.symbols import CONTROLS
from coeflab.report.tables.nouns import NO_VALUE

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.motion.glider.glide import GlideRun, SteadyGlide
    from coeflab.motion.glider.glider import Glider
    from coeflab.motion.glider.space import Spiral
    from coeflab.motion.identify.identification import Identified, IdentifiedTerm
    from coeflab.motion.manoeuvre import Figure
    from coeflab.motion.trajectory import Trajectory
    from coeflab.motion.tune.tuning import Tuning

DEGREES = {"rad": "deg", "rad/s": "deg/s"}

ROUNDING = 1e-10  # of a length, a radian, a second, the unit of a ratio: less is printed as 0
NOTHING = 1e-3  # mm, deg, N: less is not printed


def figure_table(figures: tuple[Figure, ...], title: str, length: float) -> Table:
    """Value, unit, the value in body lengths, interval, status and definition of every figure."""
    rows = []
    bounded = any(f.low is not None for f in figures)
    for f in figures:
        factor, unit = (180.0 / np.pi, DEGREES[f.unit]) if f.unit in DEGREES else (1.0, f.unit)
        lengths = f"{round(f.value / length, 3) + 0.0:.3f}" if f.value is not None and f.unit == "m" else ""
        dust = f.value is not None and abs(f.value) < ROUNDING * (length if f.unit == "m" else 1.0)
        value = ABSENT if f.value is None else "0" if dust else f"{f.value * factor:.5g}"
        interval = "" if f.low is None or f.high is None else f"{f.low * factor:.4g} .. {f.high * factor:.4g}"
        rows.append(
            (f.name, value, "" if unit == "1" else unit, lengths, *((interval,) if bounded else ()), NO_VALUE if f.status == "not determined" else f.status,
             f.definition)
        )  # fmt: skip
    headers = ("quantity", "value", "unit", "in L", *(("95 % interval",) if bounded else ()), "status", "definition")
    reasons: dict[str, list[str]] = {}
    for f in figures:
        if f.why:
            reasons.setdefault(f.why, []).append(f.name)
    notes = tuple(f"{_listed(names, len(figures))}: {why}" for why, names in reasons.items())
    if any(row[3] for row in rows):
        notes += (f"in L: over the reference length L = {length:.4g} m",)
    return Table(
        title, headers, tuple(rows), notes, frozenset({0, 2, len(headers) - 2, len(headers) - 1}), ("definition",)
    )


def _listed(names: list[str], everything: int) -> str:
    return "All quantities" if len(names) == everything > 1 else ", ".join(names)


def columns(trajectory: Trajectory) -> dict[str, Array]:
    """Every column with its unit in the name, in the order of the CSV."""
    t, x, nu, angles = trajectory, trajectory.position, trajectory.velocity, trajectory.angles
    out: dict[str, Array] = {"t [s]": t.time}
    for i, name in enumerate(("north", "east", "down")):
        out[f"{name} [m]"] = x[:, i]
    for i, name in enumerate(("phi", "theta", "psi")):
        out[f"{name} [rad]"] = angles[:, i]
    out["heading [rad]"] = t.heading
    for i, (name, unit) in enumerate(zip("uvwpqr", ("m/s",) * 3 + ("rad/s",) * 3, strict=True)):
        out[f"{name} [{unit}]"] = nu[:, i]
    for name, values in t.controls.items():
        unit = "rad" if name in CONTROLS or name.endswith(".tilt") else "command" if name != "thrust" else "N"
        out[name if name.endswith("]") else f"{name} [{unit}]"] = values
    outside = np.zeros(len(t.time), dtype=bool)
    for flags in t.outside.values():
        outside |= flags
    out["phase [-]"] = t.phase.astype(float)
    out["outside [-]"] = outside.astype(float)
    return out


def motion_csv(trajectory: Trajectory) -> bytes:
    """One row a time, seventeen digits at most, so that reading gives back the numbers."""
    named = columns(trajectory)
    whole = {"phase [-]", "outside [-]"}
    rows = [
        [f"{int(v)}" if k in whole else repr(float(v)) for k, v in zip(named, row, strict=True)]
        for row in zip(*named.values(), strict=True)
    ]
    return csv_text([list(named), *rows]).encode()


def motion_parquet(trajectory: Trajectory) -> bytes:
    """The same columns as Parquet.

    Raises
    ------
    ImportError
        No pyarrow.
    """
    import pandas as pd

    buffer = io.BytesIO()
    pd.DataFrame(columns(trajectory)).to_parquet(buffer, index=False, engine="pyarrow")
    return buffer.getvalue()


def arm_phases(trajectory: Trajectory, name: str) -> Table:
    """Vehicle, end effector and joints of an arm where the motion begins and where each phase ends; largest torques within it."""
    t, rows = trajectory, []
    ends = [int(np.flatnonzero(t.phase == k)[-1]) for k in range(len(t.phases)) if np.any(t.phase == k)]
    at = [0, *ends]
    rows.append(("time", "s", *(f"{t.time[i]:.4g}" for i in at)))
    for k, axis in enumerate(("north", "east", "down")):
        rows.append((f"vehicle, {axis}", "m", *(f"{t.position[i, k]:.4f}" for i in at)))
    for k, angle in enumerate(("roll", "pitch", "yaw")):
        rows.append((f"vehicle, {angle}", "deg", *(f"{np.degrees(t.angles[i, k]) + 0.0:.2f}" for i in at)))
    for key, values in t.controls.items():
        what, _, unit = key.removesuffix("]").partition(" [")
        if what.endswith(".wanted"):
            continue
        if what.startswith("end."):
            rows.append((f"end effector, {what[4:]}", unit, *(f"{values[i]:.4f}" for i in at)))
        elif what.endswith((".torque", ".force")):
            joint, _, effort = what.rpartition(".")
            most = [f"{np.max(np.abs(values[t.phase == k])):.3g}" for k in range(len(ends))]
            rows.append((f"{joint}, largest {effort}", unit, "", *most))
        elif "." not in what and unit in ("rad", "m"):
            factor, shown = (180.0 / np.pi, "deg") if unit == "rad" else (1.0, unit)
            rows.append((what, shown, *(f"{factor * values[i]:.2f}" for i in at)))
    if "end.north.wanted [m]" in t.controls:
        rows += [
            (name, unit, "", *(_largest(values[t.phase == k]) for k in range(len(ends))))
            for name, unit, values in _missed(t)
        ]
    headers = ("", "unit", "start", *(f"after {t.phases[k]}" for k in range(len(ends))))
    notes = (
        "vehicle, north, east, down: of its centre of mass, the arm not counted; places count from where that began.",
    )
    return Table(f"Motion of {name}", headers, tuple(rows), notes, frozenset({0, 1}))


def _missed(t: Trajectory) -> tuple[tuple[str, str, Array], ...]:
    """How far a vehicle under control is from its station, its end effector from its track, and what that takes."""
    wanted = [
        t.controls[f"end.{axis}.wanted [m]"] - t.controls[f"end.{axis} [m]"] for axis in ("north", "east", "down")
    ]
    turned = 2.0 * np.degrees(np.arccos(np.clip(np.abs(t.attitude @ t.attitude[0]), 0.0, 1.0)))
    names = [key.removesuffix(".wanted [N]") for key in t.controls if key.endswith(".wanted [N]")]
    thrusts = [np.abs(t.controls[f"{name} [N]"]) for name in names]
    return (
        ("off station, largest", "mm", 1e3 * np.linalg.norm(t.position - t.position[0], axis=1)),
        ("turned off, largest", "deg", turned),
        ("end effector off its track, largest", "mm", 1e3 * np.linalg.norm(wanted, axis=0)),
        ("thrust, largest", "N", np.max(thrusts, axis=0)),
    )


def _largest(values: Array) -> str:
    if not np.isfinite(values).any():
        return ""
    most = float(np.nanmax(values))
    return f"{most:.3g}" if most > NOTHING else f"below {NOTHING:g}"


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle):.3f}"


def steady(glider: Glider, glides: Sequence[SteadyGlide]) -> Table:
    """Steady glides on the orders of the phases."""
    rows = tuple(
        (
            g.phase,
            f"{g.net_mass:.5f}",
            number(g.position),
            f"{g.speed:.4f}",
            _degrees(g.alpha),
            _degrees(g.zeta),
            _degrees(g.theta),
            f"{g.ahead:.4f}",
            f"{g.sinking:.4f}",
            f"{abs(g.lift) / g.drag:.3f}",
            f"{g.drag * g.speed:.4f}",
            f"{'stable' if g.stable else 'unstable'}, {g.growth:.3g}",
        )
        for g in glides
    )
    from coeflab.motion.glider.motion import shallowest

    low, high = np.degrees(glider.polar.searched)
    dive, climb = np.degrees(shallowest(glider.body.polar))
    notes = [
        f"zeta = theta - alpha, below zero on a dive. Shallowest glides of this polar: {dive:.2f} and {climb:.2f} deg. "
        f"Angles of attack searched: {low:.4g} to {high:.4g} deg. Growth: largest real part of the eigenvalues, 1/s."
    ]
    for phase in glider.phases:
        count = sum((g.net_mass, g.position) == phase.setting[:2] for g in glides)
        if count != 1:
            notes.append(f"{phase.name}: {count or 'no'} steady glide{'s' if count > 1 else ''} ahead.")
    return Table(
        f"{glider.title}: steady glides",
        (
            "phase", "m0 kg", "position m", "V m/s", "alpha deg", "zeta deg", "theta deg", "ahead m/s", "sinking m/s",
            "L/D", "power W", "growth 1/s",
        ),
        rows or ((glider.phases[0].name, *([ABSENT] * 11)),),
        tuple(notes),
        frozenset({0, 11}),
        ("power W", "L/D", "position m", "ahead m/s", "sinking m/s"),
    )  # fmt: skip


def spirals(glider: Glider, turns: Sequence[tuple[str, Spiral]]) -> Table:
    """Steady turns on the orders of the phases."""
    rows = tuple(
        (
            phase, f"{s.speed:.4f}", _degrees(s.alpha), _degrees(s.beta), _degrees(s.phi), _degrees(s.theta), _degrees(s.zeta),
            _degrees(s.turn), f"{s.radius:.2f}", f"{s.sinking:.4f}",
        )
        for phase, s in turns
    )  # fmt: skip
    return Table(
        f"{glider.title}: steady spirals",
        (
            "phase",
            "V m/s",
            "alpha deg",
            "beta deg",
            "roll deg",
            "theta deg",
            "zeta deg",
            "turn deg/s",
            "radius m",
            "sinking m/s",
        ),
        rows or ((glider.phases[0].name, *([ABSENT] * 9)),),
        ("Equilibrium of forces and moments, solved without a motion in time; turn above zero to starboard.",),
        frozenset({0}),
        ("beta deg", "theta deg", "sinking m/s"),
    )


def phases(run: GlideRun) -> Table:
    """How every phase of a motion ended."""
    rows = []
    for i, row in enumerate(run.ends):
        near = run.steady_speed(i)
        rows.append(
            (
                run.phase_of(i).name,
                f"{run.time[row]:.1f}",
                "time" if run.trajectory.reached[i] is None else "depth",
                f"{round(float(run.depth[row]), 2) + 0.0:.2f}",
                f"{run.x[row]:.2f}",
                f"{run.speed[row]:.4f}",
                ABSENT if near is None else f"{near:.4f}",
                "yes" if run.settled(i) else "no",
            )
        )
    return Table(
        f"{run.glider.title}: phases in time",
        ("phase", "ends s", "by", "depth m", "x m", "V m/s", "steady V m/s", "settled"),
        tuple(rows),
        ("settled: within 1 % of the speed of a steady glide, the engine at rest.", *run.statements),
        frozenset({0, 2, 7}),
    )


def basis(glider: Glider) -> Table:
    """Where the numbers come from."""
    return Table(f"{glider.title}: basis", ("of", "what it rests on"), glider.basis, (), frozenset({0, 1}))


def parameters(tuning: Tuning) -> Table:
    """Every parameter from where to where, with its interval or why there is none."""
    from coeflab.motion.tune.tuning import STATUSES, WORDS

    rows = tuple(
        (
            p.name,
            p.unit,
            number(p.before, 5),
            *((number(p.after, 5), ABSENT) if p.u95 is None else with_u95(p.after, p.u95)),
            ABSENT if p.u95 is None else f"{100.0 * p.prior_share:.0f} %",
            WORDS[p.status],
        )
        for p in tuning.parameters
    )
    used = dict.fromkeys(p.status for p in tuning.parameters)
    notes = (*(f"{WORDS[s]}: {STATUSES[s]}." for s in used), *tuning.statements)
    headers = ("parameter", "unit", "before", "after", "U95", "prior", "status")
    return Table(f"{tuning.name}: parameters", headers, rows, notes, frozenset({0, 1, 6}))


def quantities(tuning: Tuning) -> Table:
    """Root mean squares before and after."""
    rows = tuple(
        (q.name, q.unit, str(q.count), number(q.rms(after=False), 3), number(q.rms(), 3), number(q.worst, 3))
        for q in tuning.quantities
    )
    headers = ("quantity", "unit", "cases", "rms before", "rms after", "largest after")
    return Table(f"{tuning.name}: model less data", headers, rows, (), frozenset({0, 1}))


def correlations(tuning: Tuning) -> Table:
    """Pairs of parameters with a correlation of 0.7 and more; without rows where there are none."""
    from coeflab.motion.tune.tuning import largest_correlations

    rows = tuple((a, b, f"{r:+.2f}") for a, b, r in largest_correlations(tuning))
    return Table(f"{tuning.name}: correlations", ("parameter", "with", "correlation"), rows, (), frozenset({0, 1}))


def together(tuning: Tuning) -> Table:
    """What the data determine only together; without rows where there is nothing."""
    rows = tuple((text,) for text in tuning.together)
    return Table(f"{tuning.name}: what the data do not determine", ("combination",), rows)


PER_CENT = 100.0


def terms(found: Identified) -> Table:
    """Every candidate beside the file's value."""
    rows = tuple(
        (
            t.symbol,
            coefficient(t.value),
            _interval(t),
            ABSENT if t.frequency is None else f"{PER_CENT * t.frequency:.0f} %",
            *with_u95(t.file_value, t.file_u95),
            t.file_source,
            t.verdict.value,
            t.outcome.value,
            t.why,
        )
        for t in found.terms
    )
    used = dict.fromkeys(t.outcome for t in found.terms)
    notes = (*(f"{o.value}: {o.meaning}." for o in used), *found.statements)
    headers = (
        "term", "identified", "2.5 .. 97.5 % of resamples", "kept in", "file", "U95 of file", "source", "verdict", "outcome", "why",
    )  # fmt: skip
    return Table(
        f"{found.name}: identified from {', '.join(found.series)}", headers, rows, notes, frozenset({0, 6, 7, 8, 9})
    )


def balances(found: Identified) -> Table:
    """Every component: rows, and what is left unexplained."""
    rows = tuple(
        (
            b.component,
            str(b.stretches),
            number(b.threshold, 2),
            number(None if b.left is None else PER_CENT * b.left, 2),
        )
        for b in found.balances
    )
    title = f"{found.name}: balances, {found.method}, windows of {2.0 * found.half:.3g} s"
    headers = ("component", "stretches", "threshold", "unexplained [%]")
    return Table(title, headers, rows, ("Unexplained: root mean square over that of the force, the noise taken out.",))


def terms_csv(found: Identified) -> bytes:
    """One row a candidate; blank where there is no number."""
    rows = [
        ["term", "identified [-]", "low [-]", "high [-]", "inclusion frequency [-]", "file [-]", "U95 of file [-]",
         "source", "verdict", "outcome", "why"]
    ]  # fmt: skip
    for t in found.terms:
        numbers = (t.value, t.low, t.high, t.frequency, t.file_value, t.file_u95)
        cells = ["" if x is None else f"{x:.9g}" for x in numbers]
        rows.append([t.symbol, *cells, t.file_source, t.verdict.value, t.outcome.value, t.why])
    return csv_text(rows).encode()


def _interval(t: IdentifiedTerm) -> str:
    return ABSENT if t.low is None or t.high is None else f"{coefficient(t.low)} .. {coefficient(t.high)}"
