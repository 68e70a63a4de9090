"""Which test measures which coefficients, and what each test would take off the variance of a figure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.types import Array
from coeflab.law.symbols import ANGULAR, CONTROLS, derivative

RATES = {"p": "roll rate: rolling rig", "q": "pitch rate: arm or planar motion", "r": "yaw rate: arm or planar motion"}
CONTROL = {"dr": "rudder angles", "ds": "stern-plane angles", "db": "bow-plane angles"}
CHANCE = 3.0  # standard deviations of a share where there is no dependence
ROWS_A_TERM = 5  # members that a number of the regression needs


def test_of(symbol: str) -> str:
    """The test that a coefficient comes from: what of its variables takes the most special rig.

    Examples
    --------
    >>> test_of("Yv|v|'"), test_of("Xvr'"), test_of("Ndr'")
    ('drift angles', 'yaw rate: arm or planar motion', 'rudder angles')
    """
    factors = [f.strip("|") for f in derivative(symbol.removesuffix("'")).factors]
    if any(f.endswith("dot") for f in factors):
        return "accelerations: planar motion"
    if found := next((c for c in CONTROLS if c in factors), None):
        return CONTROL[found]
    if rates := [m for m in ANGULAR if m in factors]:
        return RATES[rates[-1]]
    across = {"v", "w"} & set(factors)
    return {frozenset("v"): "drift angles", frozenset("w"): "angles of attack"}.get(
        frozenset(across), "drift and attack together" if across else "straight runs"
    )


def tests_of(symbols: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Symbols by the test that measures them, in their order."""
    out: dict[str, list[str]] = {}
    for s in symbols:
        out.setdefault(test_of(s), []).append(s)
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
