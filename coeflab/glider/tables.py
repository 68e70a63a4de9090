"""Glides as tables: steady ones, spirals, the phases of a motion, and where the numbers of a glider come from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, number
from coeflab.glider.steady_glide import shallowest

if TYPE_CHECKING:
    from coeflab.glider.glide import GlideRun, SteadyGlide
    from coeflab.glider.glider import Glider
    from coeflab.glider.space import Spiral


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
