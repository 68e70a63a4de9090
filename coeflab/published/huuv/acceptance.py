"""HUUV: everything that the paper's equations and its Fig. 17 let us judge, in the horizontal plane and in five degrees of freedom."""

from __future__ import annotations

import numpy as np

from coeflab.core.machine import one_thread
from coeflab.motion.tune.tuning import Tuning, largest_correlations
from coeflab.published.huuv.figures import CANNOT, paper_figures, tuning_figures
from coeflab.published.huuv.five_dof import read_five_dof
from coeflab.published.huuv.five_dof_file import five_dof_file
from coeflab.published.huuv.five_dof_rows import dived, moving_rows, stated_rows
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, parameter_file, read_huuv
from coeflab.published.huuv.tuning import (
    ERRORS,
    IN_WORDS,
    hidden_rows,
    origin_rows,
    pool_rows,
    tuned,
    tuned_rows,
)
from coeflab.published.huuv.turns import simulated_rows, turned
from coeflab.report.acceptance import Acceptance

CONVENTIONS = (
    "Reference point: the centre of buoyancy. Steady turns are of u, v and r alone; the tables in five degrees of freedom free heave and "
    "pitch too, and hold the roll.",
    "Turns to port have r < 0 and v > 0, so beta > 0; the tables of the paper and of this report give sizes.",
    "The paper's triad, x forward, y port, z down, is left-handed. What it computes fits x forward, y port, z up; port and starboard "
    "mirror each other, so v, r, Y and N change sign together and no coefficient does.",
    "Drag, side force and yaw moment of the hull are coefficients times V^2, with beta in rad and the area and density in them: "
    "N over (m/s)^2, N m over (m/s)^2. C_D points against the velocity, C_S across it.",
    "The Coriolis terms of the added mass stand beside C_m(beta), as in the paper: what the Munk moment counts twice is among the "
    "errata.",
    "Thruster commands are per cent of the largest; a larger right one turns to port.",
)


@one_thread()
def acceptance() -> Acceptance:
    """Both models, their parameter files, tables and figures."""
    huuv = read_huuv()
    file, five = parameter_file(huuv), read_five_dof(huuv)
    whole = five_dof_file(five)
    dives = dived(whole)
    halves = {source: tuned(huuv, source) for source in (MATLAB, TRACKER)}
    return Acceptance(
        "huuv",
        "HUUV: five degrees of freedom, turns under two thrusters, and coefficients tuned to them",
        (
            *turned(huuv, file),
            simulated_rows(huuv),
            origin_rows(huuv),
            tuned_rows(halves[MATLAB]),
            pool_rows(halves[TRACKER]),
            hidden_rows(huuv, halves[MATLAB]),
            *stated_rows(five, whole),
            *moving_rows(five, dives),
        ),
        huuv.errata,
        _statements(huuv, halves),
        ("huuv2025",),
        (*tuning_figures(huuv, halves), *paper_figures(five, dives)),
        CONVENTIONS,
        (file, whole),
    )


def _statements(huuv: Huuv, halves: dict[str, Tuning]) -> tuple[str, ...]:
    pairs = ", ".join(f"{IN_WORDS[a]} with {IN_WORDS[b]} {r:+.2f}" for a, b, r in largest_correlations(halves[MATLAB]))
    reach = max(float(np.degrees(np.nanmax(t.figures[:, 1]))) for t in huuv.turns.values())
    return (
        "m_x, m_y, m_yr, the thruster arm and the moments of inertia are chosen: the paper prints none of them.",
        f"Incidence reaches {reach:.3g} deg; the paper's tables end at 25 deg. Astern the hull is its own mirror image.",
        f"Standard errors of u, beta and radius are chosen, about what the fits leave: {_weights()}. No turn was left out.",
        f"Correlations on the MATLAB half: {pairs}.",
        "The paper scaled C_S, C_m and M_mr by 2 by hand; here they are least squares with intervals where there are any.",
        "Five degrees of freedom: C_L, C_m(alpha), M_mq, elevators, z_CG, buoyancy and geometry are assumed, see five_dof.toml.",
        *(f"Cannot be made. {text}" for text in CANNOT),
    )


def _weights() -> str:
    return "; ".join(
        f"{source} {u:g} m/s, {np.degrees(beta):.2g} deg, {radius:g} m" for source, (u, beta, radius) in ERRORS.items()
    )
