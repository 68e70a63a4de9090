"""Coverage of the interval of G_h on simulated hulls: drift and yaw sweeps of Y and N with curves of one sign, read by the estimator.

``python -m tests.coverage.stability_campaigns [HULLS] [SEED]`` writes ``stability_table.csv`` beside this file: 300 hulls a noise. A hull
has slopes within a third of those of a torpedo, m' of .01 to .016, and in each sweep a bend of .1 to 1 times the linear part at the
largest setting. U95 of each slope stands by itself, as the noise of Y and N is; the interval is that of a parameter file. Where its width
comes from: the root mean square of the errors over half of U95, of the four slopes and of G_h; and what the same draws cover where U95 of
each slope is scaled to twice the errors that occurred.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.slope_mixture import estimate_many, prepare
from coeflab.vehicle.stability import DRAWS, derived, index_gradient, stability_index
from tests.coverage.one_signed_campaigns import BENT, power

TABLE = Path(__file__).with_name("stability_table.csv")
NOISE, HULLS, SEED = (0.01, 0.003), 300, 5
SLOPES = np.array([-0.028, -0.013, 0.006, -0.0045])  # Yv', Nv', Yr', Nr'
DRIFT, RATES = np.sin(np.radians(12.0)) * np.linspace(-1.0, 1.0, 13), 0.5 * np.linspace(-1.0, 1.0, 11)
HEADER = "noise %,hulls,with interval,cover %,sign right of decided %,decided,mean half-width,error of slopes,error,cover by errors %"


def hulls(count: int, noise: float, seed: int) -> tuple[Array, Array, Array, Array]:
    """Slopes (n, 4), m' (n,), values (n, 4) and U95 (n, 4) as read."""
    rng = np.random.default_rng((seed, NOISE.index(noise)))
    truth = SLOPES * rng.uniform(2.0 / 3.0, 4.0 / 3.0, (count, 4))
    mass = rng.uniform(0.010, 0.016, count)
    values, u95 = np.empty((count, 4)), np.empty((count, 4))
    for k in range(4):
        x = DRIFT if k < 2 else RATES
        t = x / x[-1]
        bend = np.exp(rng.uniform(np.log(0.1), 0.0, count)) * rng.choice([-1.0, 1.0], count)
        curved = np.stack([BENT["three powers"](rng, t) if rng.random() < 0.5 else power(t, 2.0) for _ in range(count)])
        force = truth[:, k : k + 1] * x[-1] * (t + bend[:, None] * curved)
        scatter = noise * np.abs(force).max(1, keepdims=True) * rng.standard_normal(force.shape)
        found = [estimate_many(prepare(x), force[i : i + 20] + scatter[i : i + 20]) for i in range(0, count, 20)]
        values[:, k] = np.concatenate([f.value for f in found])
        u95[:, k] = np.concatenate([f.u95 for f in found])
    return truth, mass, values, u95


def indices(slopes: Array, mass: Array) -> Array:
    """G_h of slopes (..., 4)."""
    return np.asarray(stability_index(slopes[..., 0], slopes[..., 1], slopes[..., 2], slopes[..., 3], mass, 0.0))


def intervals(mass: Array, values: Array, u95: Array) -> tuple[Array, Array]:
    """G_h (n,) and its interval (n, 2) by the draws of a parameter file; NaN where none is given."""
    middle, out = indices(values, mass), np.full((len(mass), 2), np.nan)
    for i, (m, found, half) in enumerate(zip(mass, values, u95, strict=True)):
        parts = [("Yv'", found[0], half[0]), ("Nr'", found[3], half[3])]
        gradient = index_gradient(found[0], found[1], found[2], found[3], m, 0.0)

        def moved(d: Array, at: Array = found, m: Array = m) -> Array:
            return indices(at + d, m)

        held = derived(
            "G_h", "hull", float(middle[i]), moved, gradient, np.diag((half / 2.0) ** 2), parts, ["Yv'", "Nv'", "Yr'", "Nr'"], DRAWS, 1
        )  # fmt: skip
        if held.interval is not None:
            out[i] = held.interval
    return middle, out


def row(count: int, noise: float, seed: int) -> str:
    """One line of the table."""
    truth, mass, values, u95 = hulls(count, noise, seed)
    true, error = indices(truth, mass), np.sqrt(np.mean((2.0 * (values - truth) / u95) ** 2, axis=0))
    middle, ends = intervals(mass, values, u95)
    there = np.isfinite(ends[:, 0])
    inside, right = ((ends[there, 0] <= true[there]) & (true[there] <= ends[there, 1])), (middle > 0.0) == (true > 0.0)
    decided = there & (ends[:, 0] * ends[:, 1] > 0.0)
    half = (ends[there, 1] - ends[there, 0]) / 2.0
    off = np.sqrt(np.mean((2.0 * (middle - true)[there] / half) ** 2))
    scaled = intervals(mass, values, u95 * error)[1]
    some = np.isfinite(scaled[:, 0])
    by_errors = (scaled[some, 0] <= true[some]) & (true[some] <= scaled[some, 1])
    return (
        f"{100 * noise:g},{count},{there.sum()},{100 * inside.mean():.1f},{100 * right[decided].mean():.1f},{decided.sum()},"
        f"{half.mean():.3f},{' '.join(f'{e:.2f}' for e in error)},{off:.2f},{100 * by_errors.mean():.1f}"
    )


def main(count: int, seed: int) -> None:
    """Write the table."""
    TABLE.write_text("\n".join([HEADER, *(row(count, noise, seed) for noise in NOISE)]) + "\n")


if __name__ == "__main__":
    asked = [*map(int, sys.argv[1:]), *(HULLS, SEED)[len(sys.argv) - 1 :]]
    main(asked[0], asked[1])
