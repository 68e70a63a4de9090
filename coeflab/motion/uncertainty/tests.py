"""Which test measures which coefficients, and what each test would take off the variance of a figure."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from coeflab.core.types import Array
from coeflab.law.symbols import derivative

CHANCE = 3.0  # standard deviations of a share where there is no dependence
ROWS_A_TERM = 5  # members that a number of the regression needs


class Kind(StrEnum):
    """A test, by what its runs vary."""

    DRIFT = "drift"
    ATTACK = "angle of attack"
    YAW = "rotating arm, yaw"
    PITCH = "rotating arm, pitch"
    ROLL = "roll"
    RUDDER = "rudder"
    STERN = "stern planes"
    BOW = "bow planes"
    RESISTANCE = "resistance"
    ADDED_MASS = "accelerations"
    OTHER = "several motions at once"


OF_VARIABLE = {
    "v": Kind.DRIFT, "w": Kind.ATTACK, "r": Kind.YAW, "q": Kind.PITCH, "dr": Kind.RUDDER, "ds": Kind.STERN, "db": Kind.BOW,
}  # fmt: skip


def kind_of(symbol: str) -> tuple[Kind, str]:
    """The test that gives a coefficient, and the variable of its settings; none of a test of several."""
    factors = derivative(symbol).factors
    if any(f.endswith("dot") for f in factors):
        return Kind.ADDED_MASS, ""
    if not factors or set(factors) <= {"u"}:
        return Kind.RESISTANCE, ""
    moving = {f for f in factors if f != "u"}
    if len(moving) > 1:
        return Kind.OTHER, ""
    variable = moving.pop()
    if variable == "p":
        return Kind.ROLL, ""
    return OF_VARIABLE.get(variable, Kind.OTHER), variable if variable in OF_VARIABLE else ""


def tests_of(symbols: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Symbols by the test that measures them, in their order."""
    out: dict[str, list[str]] = {}
    for s in symbols:
        out.setdefault(str(kind_of(s.removesuffix("'"))[0]), []).append(s)
    return {name: tuple(those) for name, those in out.items()}


def group_share(inputs: Array, result: Array) -> float:
    """Share of the variance of a result that goes if several inputs are known together: at most Var(E[y | x]) / Var(y).

    A quadratic of their principal components, of the largest where the rows are few, adjusted for the numbers of the fit; zero where chance alone would show as much. Inputs may be correlated, among
    themselves and with others.

    Parameters
    ----------
    inputs : (n, k) array
    result : (n,) array
        Rows that are not finite are left out.
    """
    selected = np.isfinite(result)
    x, y = inputs[selected], result[selected]
    y = y - np.mean(y) if len(y) else y
    spread = np.std(x, axis=0) if len(y) else np.zeros(inputs.shape[1])
    if not len(y) or not y.any() or not spread.any():
        return 0.0
    scaled = (x - np.mean(x, axis=0))[:, spread > 0.0] / spread[spread > 0.0]
    left, size, _ = np.linalg.svd(scaled, full_matrices=False)
    parts = left[:, size > 1e-6 * size[0]] * len(y) ** 0.5
    k = parts.shape[1]
    curved = max((q for q in range(k + 1) if ROWS_A_TERM * (k + q * (q + 1) // 2) <= len(y)), default=0)
    pairs = [parts[:, i] * parts[:, j] for i in range(curved) for j in range(i, curved)]
    terms = np.column_stack([parts, *pairs])
    basis, _ = np.linalg.qr(np.column_stack([np.ones(len(y)), terms]))
    count = basis.shape[1] - 1
    if len(y) <= count + 1:
        return 0.0
    rest = max(float(y @ y) - float(np.sum((basis.T @ y) ** 2)), 0.0) / float(y @ y)
    share = 1.0 - rest * (len(y) - 1) / (len(y) - 1 - count)
    return share if share > CHANCE * (2.0 * count) ** 0.5 / len(y) else 0.0
