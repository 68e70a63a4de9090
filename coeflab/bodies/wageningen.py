"""Open-water thrust and torque of Wageningen B-series propellers, and thrust over speed of rotation on a course ahead.

M. M. Bernitsas, D. Ray, P. Kinley, University of Michigan, report 237 (1981).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.types import Array

PITCHES, AREAS, BLADES = (0.5, 1.4), (0.30, 1.05), (2, 7)
POINTS = 9  # of a curve of thrust
# Coefficient, powers of J, P/D, A_E/A_0 and Z; Re 2e6 (Bernitsas, Ray & Kinley 1981, table 1).
THRUST = np.array([
    (0.00880496, 0, 0, 0, 0), (-0.204554, 1, 0, 0, 0), (0.166351, 0, 1, 0, 0), (0.158114, 0, 2, 0, 0),
    (-0.147581, 2, 0, 1, 0), (-0.481497, 1, 1, 1, 0), (0.415437, 0, 2, 1, 0), (0.0144043, 0, 0, 0, 1),
    (-0.0530054, 2, 0, 0, 1), (0.0143481, 0, 1, 0, 1), (0.0606826, 1, 1, 0, 1), (-0.0125894, 0, 0, 1, 1),
    (0.0109689, 1, 0, 1, 1), (-0.133698, 0, 3, 0, 0), (0.00638407, 0, 6, 0, 0), (-0.00132718, 2, 6, 0, 0),
    (0.168496, 3, 0, 1, 0), (-0.0507214, 0, 0, 2, 0), (0.0854559, 2, 0, 2, 0), (-0.0504475, 3, 0, 2, 0),
    (0.010465, 1, 6, 2, 0), (-0.00648272, 2, 6, 2, 0), (-0.00841728, 0, 3, 0, 1), (0.0168424, 1, 3, 0, 1),
    (-0.00102296, 3, 3, 0, 1), (-0.0317791, 0, 3, 1, 1), (0.018604, 1, 0, 2, 1), (-0.00410798, 0, 2, 2, 1),
    (-0.000606848, 0, 0, 0, 2), (-0.0049819, 1, 0, 0, 2), (0.0025983, 2, 0, 0, 2), (-0.000560528, 3, 0, 0, 2),
    (-0.00163652, 1, 2, 0, 2), (-0.000328787, 1, 6, 0, 2), (0.000116502, 2, 6, 0, 2), (0.000690904, 0, 0, 1, 2),
    (0.00421749, 0, 3, 1, 2), (0.0000565229, 3, 6, 1, 2), (-0.00146564, 0, 3, 2, 2),
])  # fmt: skip
TORQUE = np.array([
    (0.00379368, 0, 0, 0, 0), (0.00886523, 2, 0, 0, 0), (-0.032241, 1, 1, 0, 0), (0.00344778, 0, 2, 0, 0),
    (-0.0408811, 0, 1, 1, 0), (-0.108009, 1, 1, 1, 0), (-0.0885381, 2, 1, 1, 0), (0.188561, 0, 2, 1, 0),
    (-0.00370871, 1, 0, 0, 1), (0.00513696, 0, 1, 0, 1), (0.0209449, 1, 1, 0, 1), (0.00474319, 2, 1, 0, 1),
    (-0.00723408, 2, 0, 1, 1), (0.00438388, 1, 1, 1, 1), (-0.0269403, 0, 2, 1, 1), (0.0558082, 3, 0, 1, 0),
    (0.0161886, 0, 3, 1, 0), (0.00318086, 1, 3, 1, 0), (0.015896, 0, 0, 2, 0), (0.0471729, 1, 0, 2, 0),
    (0.0196283, 3, 0, 2, 0), (-0.0502782, 0, 1, 2, 0), (-0.030055, 3, 1, 2, 0), (0.0417122, 2, 2, 2, 0),
    (-0.0397722, 0, 3, 2, 0), (-0.00350024, 0, 6, 2, 0), (-0.0106854, 3, 0, 0, 1), (0.0010903, 3, 3, 0, 1),
    (-0.000313912, 0, 6, 0, 1), (0.0035985, 3, 0, 1, 1), (-0.00142121, 0, 6, 1, 1), (-0.00383637, 1, 0, 2, 1),
    (0.0126803, 0, 2, 2, 1), (-0.00318278, 2, 3, 2, 1), (0.00334268, 0, 6, 2, 1), (-0.00183491, 1, 1, 0, 2),
    (0.000112451, 3, 2, 0, 2), (-0.0000297228, 3, 6, 0, 2), (0.000269551, 1, 0, 1, 2), (0.00083265, 2, 0, 1, 2),
    (0.00155334, 0, 2, 1, 2), (0.000302683, 0, 6, 1, 2), (-0.0001843, 0, 0, 2, 2), (-0.000425399, 0, 3, 2, 2),
    (0.0000869243, 3, 3, 2, 2), (-0.0004659, 0, 6, 2, 2), (0.0000554194, 1, 6, 2, 2),
])  # fmt: skip


def open_water(advance: Array, pitch: float, area: float, blades: int) -> tuple[Array, Array]:
    """K_T and K_Q of the series at Re 2e6.

    Parameters
    ----------
    advance : (n,) array
        J = V_A / (n D).
    pitch, area : float
        P/D from 0.5 to 1.4, A_E/A_0 from 0.30 to 1.05.
    blades : int
        2 to 7.

    Returns
    -------
    K_T, K_Q : (n,) array
        T / (rho n^2 D^4), Q / (rho n^2 D^5).

    Raises
    ------
    InputError
        Outside the series.
    """
    for name, value, (low, high) in (("P/D", pitch, PITCHES), ("A_E/A_0", area, AREAS), ("Z", blades, BLADES)):
        if not low <= value <= high:
            raise InputError(f"{name} = {value:g}", f"{low:g} to {high:g}, as the series has it")
    j = np.asarray(advance, dtype=float)[:, None]
    result = []
    for terms in (THRUST, TORQUE):
        c, s, t, u, v = terms.T
        result.append(np.asarray(np.sum(c * j**s * pitch**t * area**u * float(blades) ** v, axis=1)))
    return result[0], result[1]


def thrust_over_speed(
    diameter: float, pitch: float, area: float, blades: int, highest: float, ahead: float, density: float
) -> Array:
    """(n, 2) speeds of rotation, 1/s, and thrusts, N, at one speed ahead; no thrust where the series has none.

    Parameters
    ----------
    diameter, pitch, area : float
        m, P/D, A_E/A_0.
    blades : int
    highest, ahead, density : float
        1/s, m/s of the water into the propeller, kg/m^3.

    Raises
    ------
    InputError
        Outside the series, or no thrust at the highest speed of rotation.
    """
    advance = np.linspace(0.0, 2.0 * PITCHES[1], 2801)
    idle = float(advance[np.argmax(open_water(advance, pitch, area, blades)[0] <= 0.0)])
    found = over_speed(
        lambda j, n: open_water(j, pitch, area, blades)[0] * density * n**2 * diameter**4,
        idle,
        diameter,
        highest,
        ahead,
    )
    return np.column_stack([found[:, 0], np.maximum.accumulate(found[:, 1])])


def over_speed(
    value: Callable[[Array, Array], Array], idle: float, diameter: float, highest: float, ahead: float
) -> Array:
    """(n, 2) speeds of rotation, 1/s, and thrusts or torques at one speed ahead; nothing where the advance is beyond ``idle``.

    Parameters
    ----------
    value : callable
        (n,) advance J = V/(n D) and speed of rotation, 1/s -> value.
    idle, diameter, highest, ahead : float
        J, m, 1/s, m/s of the water into the propeller.

    Raises
    ------
    InputError
        Nothing at the highest speed of rotation.
    """
    least = ahead / (idle * diameter)
    if not highest > least:
        found = f"a propeller of {60.0 * highest:.4g} rpm at {ahead:g} m/s"
        raise InputError(found, f"more than {60.0 * least:.4g} rpm, below which it brakes", column="highest_rpm")
    turns = np.concatenate([[0.0], np.linspace(least, highest, POINTS)])
    own = np.divide(ahead, turns * diameter, out=np.full_like(turns, idle), where=turns > 0.0)
    values = value(own, turns)
    values[:2] = 0.0
    return np.column_stack([turns, values])
