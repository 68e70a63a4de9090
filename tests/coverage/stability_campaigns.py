"""Coverage of the interval of G_h on simulated hulls: drift and yaw sweeps of Y and N with curves of one sign, read by the estimator.

``python -m tests.coverage.stability_campaigns [HULLS] [SEED]`` writes ``stability_table.csv`` beside this file: 300 hulls a noise. A hull
has slopes within a third of those of a torpedo, m' of .01 to .016, and in each sweep a bend of .1 to 1 times the linear part at the
largest setting. U95 of each slope stands by itself, as the noise of Y and N is; the interval is that of a parameter file.
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
HEADER = "noise %,hulls,with interval,cover %,sign right of decided %,decided,mean half-width"


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


def row(count: int, noise: float, seed: int) -> str:
    """One line of the table."""
    inside, right, widths, decided = [], [], [], 0
    for slopes, m, found, half in zip(*hulls(count, noise, seed), strict=True):
        true = float(stability_index(*map(np.asarray, slopes), m, 0.0))
        held = derived(
            "G_h", "hull", float(stability_index(*map(np.asarray, found), m, 0.0)),
            lambda d, at=found, mass=m: stability_index(*(at + d).T, mass, 0.0), index_gradient(*found, m, 0.0), np.diag((half / 2.0) ** 2),
            [("Yv'", found[0], half[0]), ("Nr'", found[3], half[3])], ["Yv'", "Nv'", "Yr'", "Nr'"], DRAWS, 1,
        )  # fmt: skip
        if held.interval is None:
            continue
        low, high = held.interval
        inside.append(low <= true <= high)
        widths.append((high - low) / 2.0)
        if held.decided:
            decided += 1
            right.append((true > 0.0) == (low > 0.0))
    return (
        f"{100 * noise:g},{count},{len(inside)},{100 * np.mean(inside):.1f},{100 * np.mean(right) if right else np.nan:.1f},{decided},"
        f"{np.mean(widths):.3f}"
    )


def main(count: int, seed: int) -> None:
    """Write the table."""
    TABLE.write_text("\n".join([HEADER, *(row(count, noise, seed) for noise in NOISE)]) + "\n")


if __name__ == "__main__":
    asked = [*map(int, sys.argv[1:]), *(HULLS, SEED)[len(sys.argv) - 1 :]]
    main(asked[0], asked[1])
