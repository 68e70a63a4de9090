"""HUUV: drag, side force and yaw moment over sideslip, as worked out and as tuned to both halves of Fig. 17."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from coeflab.core.wording import listed
from coeflab.kernels.least_squares import Array
from coeflab.model.huuv import MATLAB, TRACKER, Huuv
from coeflab.model.tuning import Tuning
from coeflab.presentation.document import Figure
from coeflab.presentation.laws_figure import Plot, Trace, laws_figure
from coeflab.studies.validations.huuv_fit import TOLD

FINE = 57
LAWS = (
    ("drag / V^2  [N/(m/s)^2]", ("d0", "d2"), (0, 2)),
    ("side force / V^2  [N/(m/s)^2]", ("s1", "s3"), (1, 3)),
    ("yaw moment / V^2  [N m/(m/s)^2]", ("n1", "n3"), (1, 3)),
)
CAPTION = (
    "Constants of the steady turns, and the two fits to Fig. 17, each as far as its turns reach: {reach}. All turns are to port; the "
    "other side is their mirror image. Where turns do not determine a coefficient the curve is one of many that fit them: {open}. "
    "C_S is known only up to the mass, C_m only up to the arm and m_y - m_x. The paper draws C_D over "
    "alpha and beta in Fig. 12 without printing numbers, and all turns lie at alpha = 0: the data allow these curves and no drag "
    "surface."
)


def forces_figure(huuv: Huuv, halves: Mapping[str, Tuning]) -> Figure:
    """Three laws over sideslip, three sets of constants.

    Parameters
    ----------
    huuv : Huuv
    halves : mapping of str to Tuning
        The fits to the paper's simulation and to the pool.
    """
    ends = {source: float(np.degrees(np.nanmax(turns.figures[:, 1]))) for source, turns in huuv.turns.items()}
    sets = {
        "steady turns": (dict(huuv.constants), ends[MATLAB]),
        "tuned to the simulation": (_values(huuv, halves[MATLAB]), ends[MATLAB]),
        "tuned to the pool": (_values(huuv, halves[TRACKER]), ends[TRACKER]),
    }
    plots = [
        Plot(
            name, "sideslip beta  [deg]",
            tuple(
                Trace(label, beta, _law(c, keys, powers, beta), i)
                for i, (label, (c, end)) in enumerate(sets.items())
                for beta in [np.linspace(-end, end, FINE)]
            ),
            112.0, is_scaled=k == len(LAWS) - 1,
        )
        for k, (name, keys, powers) in enumerate(LAWS)
    ]  # fmt: skip
    reach = f"{ends[MATLAB]:.3g} deg in the simulation, {ends[TRACKER]:.3g} deg in the pool"
    return laws_figure(
        "huuv-forces", "Drag, side force and yaw moment over sideslip", CAPTION.format(reach=reach, open=_open(halves)),
        "Three panels over sideslip: even curves of drag, odd curves of side force and yaw moment, for three sets of constants.",
        plots,
    )  # fmt: skip


def _open(halves: Mapping[str, Tuning]) -> str:
    """What has no interval, of both fits."""
    told = {MATLAB: "simulation", TRACKER: "pool"}
    drawn = {key for _, keys, _ in LAWS for key in keys}
    return "; ".join(
        f"{told[source]}: {listed([TOLD[p.name] for p in fit.parameters if p.name in drawn and p.u95 is None])}"
        for source, fit in halves.items()
        if any(p.name in drawn and p.u95 is None for p in fit.parameters)
    )


def _values(huuv: Huuv, fit: Tuning) -> dict[str, float]:
    return dict(huuv.constants) | {p.name: p.after for p in fit.parameters}


def _law(constants: Mapping[str, float], keys: tuple[str, str], powers: tuple[int, int], beta: Array) -> Array:
    x = np.radians(beta)
    return np.asarray(sum(constants[k] * x**n for k, n in zip(keys, powers, strict=True)))
