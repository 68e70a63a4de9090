"""The bare hull of DARPA SUBOFF from its equations: bow, parallel middle body, afterbody and cap.

Source: Groves, Huang & Chang, DTRC/SHD-1298-01 (1989), Tables 1-3; feet, x aft of the nose. Sail, stern planes and ring
wings are not part of it.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.axisymmetric import graded_nodes
from coeflab.model.body import Body, Configuration
from coeflab.model.body_file import open_body_file
from coeflab.model.shape import Revolution

summary = "the SUBOFF bare hull from the equations of Groves, Huang and Chang"
citations = ("groves1989",)

Array = NDArray[np.float64]
FOOT = 0.3048
LARGEST_RADIUS = 5.0 / 6.0
BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END = 3.333333, 10.645833, 13.979167, 14.291667
CAP_RADIUS, K0, K1 = 0.1175, 10.0, 44.6244
NODES, GRADING = 96, 4

_X = Polynomial([0.0, 1.0])
_BOW = (
    1.126395101 * _X * (0.3 * _X - 1.0) ** 4
    + 0.442874707 * _X**2 * (0.3 * _X - 1.0) ** 3
    + 1.0
    - (0.3 * _X - 1.0) ** 4 * (1.2 * _X + 1.0)
)
_R2, _RK = CAP_RADIUS**2, CAP_RADIUS * K0
_AFTERBODY = Polynomial(
    [
        _R2,
        0.0,
        _RK,
        20.0 - 20.0 * _R2 - 4.0 * _RK - K1 / 3.0,
        -45.0 + 45.0 * _R2 + 6.0 * _RK + K1,
        36.0 - 36.0 * _R2 - 4.0 * _RK - K1,
        -10.0 + 10.0 * _R2 + _RK + K1 / 3.0,
    ]
)(Polynomial([AFTERBODY_END / 3.333333, -1.0 / 3.333333]))
_CAP = _R2 * (1.0 - Polynomial([-44.733333, 3.2]) ** 2)


def _bow(x: Array) -> tuple[Array, Array]:
    """(R/Rmax)^2 and half its slope; the power 1/2.1 makes the slope infinite at the nose itself."""
    p = np.clip(_BOW(x), 0.0, None)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.where(p > 0.0, p ** (1.0 / 1.05 - 1.0) * _BOW.deriv()(x) / 2.1, np.inf)
    return p ** (1.0 / 1.05), half


def _rest(x: Array, square: Polynomial) -> tuple[Array, Array]:
    return np.clip(square(x), 0.0, None), square.deriv()(x) / 2.0


def _piece(x: Array, end: float) -> tuple[Array, Array]:
    if end == BOW_END:
        return _bow(x)
    square = {MIDDLE_END: Polynomial([1.0]), AFTERBODY_END: _AFTERBODY, CAP_END: _CAP}[end]
    return _rest(x, square)


def radius(aft: float) -> float:
    """Radius of the bare hull, m.

    Parameters
    ----------
    aft : float
        Distance aft of the nose, m, from 0 to 4.3561 (14.291667 ft).

    Raises
    ------
    InputError
        Ahead of the nose or aft of the tail.
    """
    x = aft / FOOT
    if not -1e-12 <= x <= CAP_END + 1e-12:
        raise InputError(f"x = {aft:g} m aft of the nose", f"0 to {CAP_END * FOOT:.4f} m, where the equations hold")
    end = next((e for e in (BOW_END, MIDDLE_END, AFTERBODY_END) if x <= e), CAP_END)
    square, _ = _piece(np.array([x]), end)
    return float(FOOT * LARGEST_RADIUS * np.sqrt(square[0]))


def meridian(nodes: int = NODES) -> Revolution:
    """The hull by Gauss-Legendre stations, ``nodes`` on each of the four pieces, graded to the ends of each."""
    joints = (0.0, BOW_END, MIDDLE_END, AFTERBODY_END, CAP_END)
    pieces = []
    for start, end in pairwise(joints):
        stations, weights = graded_nodes(start, end, nodes, GRADING)
        pieces.append((stations, weights, *_piece(stations, end)))
    x, weight, square, half = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return Revolution(
        x=-FOOT * x,
        weight=FOOT * weight,
        radius=FOOT * LARGEST_RADIUS * np.sqrt(square),
        radius_slope=-FOOT * LARGEST_RADIUS**2 * half,
        axis=np.zeros(2),
        length=FOOT * CAP_END,
    )


def read(path: Path) -> Body:
    """Read a body.toml whose shape is the SUBOFF bare hull.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    opened = open_body_file(path, "groves")
    hull = meridian()
    computed = Configuration(
        name="by_equations",
        title="integrals of the equations",
        volume=hull.volume,
        wetted_surface=hull.integrals.wetted_surface,
        centre_of_buoyancy=hull.centre_of_volume,
        mass=None,
    )
    return opened.body(hull, computed)
