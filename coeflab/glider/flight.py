"""Glides of one or several gliders: steady ones, a motion in time, and the files of both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.files import located
from coeflab.core.machine import one_thread
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.types import brief
from coeflab.glider.glide import GlideRun, SteadyGlide, steady_glides, steady_spirals
from coeflab.glider.glider import GliderPhase
from coeflab.glider.glider_file import gliders_at
from coeflab.glider.motion import Setting
from coeflab.glider.space import Spiral
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.trajectory import Ended

TIMES = ("time [s]", "x [m]", "depth [m]", "V [m/s]", "alpha [deg]", "theta [deg]", "u [m/s]", "w [m/s]", "q [deg/s]")
ORDERS = ("net_mass [kg]", "position [m]", "phase [-]")
ASIDE = (
    "y [m]", "phi [deg]", "psi [deg]", "v [m/s]", "p [deg/s]", "r [deg/s]", "roller [deg]", "right [N]", "left [N]",
)  # fmt: skip
POLAR = ("net_mass [kg]", "alpha [deg]", "zeta [deg]", "theta [deg]", "V [m/s]", "ahead [m/s]", "sinking [m/s]")


@brief
@dataclass(frozen=True, slots=True)
class Flown:
    """One glider.

    Attributes
    ----------
    run : GlideRun
    steady : tuple of SteadyGlide
        Straight, of all phases, those of equal orders once.
    spirals : tuple of (str, Spiral)
        What the straight glides of a phase become under its roller and thrusters, with the name of the phase.
    """

    run: GlideRun
    steady: tuple[SteadyGlide, ...]
    spirals: tuple[tuple[str, Spiral], ...] = ()

    @property
    def complete(self) -> bool:
        """Whether the motion came to its end."""
        return self.run.trajectory.ended is Ended.COMPLETE


@one_thread()
def fly(name: str | Path, cycles: int, options: Mapping[str, Any], roller: float = 0.0) -> tuple[Flown, ...]:
    """Fly a glider file, every one of a folder, or a shipped glider.

    Parameters
    ----------
    name : str or path
    cycles : int
        How often the phases of the file are flown, from 1.
    options : mapping
        Of the simulator ``glider``.
    roller : float
        Angle of the roller in every phase, rad; zero: as the file orders.

    Raises
    ------
    InputError
        Nothing there, a file or an option that cannot be used, a roller that the file does not have.
    """
    simulator = SIMULATORS.load("glider")
    out = []
    for read in gliders_at(located(name, "cfd_data")):
        g = read.rolled(roller) if roller else read
        run = GlideRun(g, simulator.simulate(g, g.manoeuvre(cycles), options))
        distinct: dict[Setting, GliderPhase] = {}
        for phase in g.phases:
            distinct.setdefault(phase.setting, phase)
        turns = tuple((p.name, s) for p in distinct.values() if p.turns for s in steady_spirals(g, p))
        out.append(Flown(run, tuple(s for p in distinct.values() for s in steady_glides(g, p)), turns))
    return tuple(out)


def files(flown: Sequence[Flown]) -> dict[str, bytes]:
    """CSV of steady glides, polar and motion of every glider, and the figures."""
    from coeflab.glider.figures import motion_figure, polar_figure
    from coeflab.report.figures.series import STYLES

    out: dict[str, bytes] = {}
    for f in flown:
        glider = f.run.glider
        out[f"{glider.name}_motion.csv"] = motion_csv(f.run)
        out[f"{glider.name}_polar.csv"] = polar_csv(f)
        out[f"{glider.name}_steady.csv"] = steady_csv(f)
        if any(p.net_mass for p in glider.phases):
            out[f"{glider.name}_polar.svg"] = polar_figure(glider, f.steady, glider.name).svg.encode()
    for i in range(0, len(flown), len(STYLES)):
        some = [f.run for f in flown[i : i + len(STYLES)]]
        number = "" if len(flown) <= len(STYLES) else f"_{i // len(STYLES) + 1}"
        out[f"motion{number}.svg"] = motion_figure(some, f"motion{number}").svg.encode()
    return out


def _csv(header: Sequence[str], columns: Iterable[Any]) -> bytes:
    rows = ([f"{v:.9g}" for v in row] for row in zip(*columns, strict=True))
    return csv_text([header, *rows]).encode()


def motion_csv(run: GlideRun) -> bytes:
    """The motion, one row a time; alpha is empty at rest."""
    t = run.trajectory
    columns: tuple[Any, ...] = (
        run.time, run.x, run.depth, run.speed, np.degrees(run.alpha), np.degrees(run.theta), t.velocity[:, 0],
        t.velocity[:, 2], np.degrees(t.velocity[:, 4]), t.controls["net_mass"], t.controls["position"], t.phase,
    )  # fmt: skip
    names: tuple[str, ...] = (*TIMES, *ORDERS)
    if "roller" in t.controls:
        angles, nu, c = np.degrees(t.angles), t.velocity, t.controls
        names = (*names, *ASIDE)
        columns = (
            *columns, t.position[:, 1], angles[:, 0], np.degrees(t.heading), nu[:, 1], np.degrees(nu[:, 3]), np.degrees(nu[:, 5]),
            np.degrees(c["roller"]), c["right"], c["left"],
        )  # fmt: skip
    return _csv(names, columns).replace(b",nan,", b",,")


def steady_csv(flown: Flown) -> bytes:
    """The steady glides; ``growth`` is below zero where one is stable."""
    rows = [
        (
            s.net_mass,
            np.degrees(s.alpha),
            np.degrees(s.zeta),
            np.degrees(s.theta),
            s.speed,
            s.ahead,
            s.sinking,
            s.growth,
        )
        for s in flown.steady
    ]
    return _csv((*POLAR, "growth [1/s]"), zip(*rows, strict=True))


def polar_csv(flown: Flown) -> bytes:
    """Speed and glide angle over the angle of attack for the net masses of the phases."""
    from coeflab.glider.figures import curve

    glider, parts = flown.run.glider, []
    for mass in dict.fromkeys(p.net_mass for p in glider.phases if p.net_mass):
        alpha, zeta, speed = curve(glider, mass)
        degrees = (np.degrees(a) for a in (alpha, zeta, zeta + alpha))
        parts.append([np.full_like(alpha, mass), *degrees, speed, speed * np.cos(zeta), -speed * np.sin(zeta)])
    return _csv(POLAR, np.hstack(parts) if parts else [[] for _ in POLAR])
