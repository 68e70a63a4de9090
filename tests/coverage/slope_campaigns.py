"""Coverage of `coeflab.fits.statistics.origin_slope` on simulated campaigns whose slope is known.

``python tests/coverage/slope_campaigns.py WORK [ROUNDS]`` runs 50 rounds of 20 campaigns per cell (family, noise,
design), each round with settings of its own; a round that is already in WORK is not run again. After each round it
writes ``slope_table.csv`` beside this file, with the campaigns so far. Seeds are (2026, design, round).

``cover %`` counts what is printed, value +- U95; ``lower to upper %`` the ends with the same tail beyond each.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from scipy import stats

from coeflab.core.types import Array
from coeflab.fits.statistics.slope_mixture import Slopes, estimate_many, prepare

NOISE = (0.03, 0.01, 0.001, 0.0001, 0.00001)
DESIGNS = ("even", "uneven", "one-sided", "replicated")
ROUNDS, CAMPAIGNS, STUDIED = 50, 20, 1
TABLE = Path(__file__).with_name("slope_table.csv")
Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Truth:
    """A force curve, its slope at the origin and the columns of its true form (kinks known)."""

    curve: Curve
    slope: float
    form: tuple[Curve, ...]


def one(v: Array) -> Array:
    return np.ones_like(v)


def line(v: Array) -> Array:
    return v


def square(v: Array) -> Array:
    return v * v


def vv(v: Array) -> Array:
    return v * np.abs(v)


def cube(v: Array) -> Array:
    return v**3


def kink(at: float, power: int = 1) -> Curve:
    return lambda v: np.sign(v) * np.maximum(np.abs(v) - at, 0.0) ** power


def tanh(v: Array) -> Array:
    return np.tanh(v / 0.2)


def sine(v: Array) -> Array:
    return np.sin(v / 0.12)


def starboard(v: Array) -> Array:
    return np.maximum(v - 0.1, 0.0)


def soft(v: Array) -> Array:
    return v / (1.0 + (v / 0.16) ** 4)


def sums(*terms: tuple[float, Curve], slope: float) -> Truth:
    return Truth(lambda v: np.asarray(sum(c * f(v) for c, f in terms)), slope, tuple(f for _, f in terms))


FAMILIES = {
    "linear": sums((-0.028, line), slope=-0.028),
    "cubic": sums((-0.028, line), (-0.3, cube), slope=-0.028),
    "v|v|": sums((-0.028, line), (-0.06, vv), slope=-0.028),
    "v|v| + v3": sums((-0.028, line), (-0.05, vv), (-0.2, cube), slope=-0.028),
    "small slope": sums((-0.006, line), (-0.03, vv), (-0.15, cube), slope=-0.006),
    "opposed signs": sums((-0.012, line), (0.05, vv), (-0.12, cube), slope=-0.012),
    "tanh": sums((-0.0056, tanh), slope=-0.028),
    "sine": sums((-0.0024, sine), slope=-0.02),
    "v5": sums((-0.02, line), (-6.0, lambda v: v**5), slope=-0.02),
    "stall": sums((-0.028, line), (-0.05, vv), (0.25, kink(0.2)), slope=-0.028),
    "soft stall": sums((-0.028, soft), slope=-0.028),
    "onset": sums((-0.028, line), (-0.5, kink(0.07, 2)), slope=-0.028),
    "late kink": sums((-0.028, line), (-0.08, kink(0.12)), slope=-0.028),
    "offset": sums((0.0008, one), (-0.02, line), (-0.08, vv), slope=-0.02),
    "asymmetric": sums((-0.02, line), (-0.03, square), (-0.1, cube), (-0.05, starboard), slope=-0.02),
    "even part": sums((0.0003, one), (-0.025, line), (0.02, square), (-0.04, vv), (0.1, lambda v: v**4), slope=-0.025),
}
STUDY = ("tanh", "stall", "onset")


def settings(design: str, rng: np.random.Generator) -> Array:
    """Nine to 23 settings to 10 to 18 degrees; with replicates 8 to 12 settings, each two or three times."""
    n, reach = int(rng.integers(9, 24)), float(np.sin(np.radians(rng.uniform(10.0, 18.0))))
    if design == "even":
        return np.linspace(-reach, reach, n)
    if design == "uneven":
        return np.sort(rng.uniform(-reach, reach, n))
    if design == "one-sided":
        return np.linspace(0.0, reach, n)
    return np.repeat(np.linspace(-reach, reach, int(rng.integers(8, 13))), int(rng.integers(2, 4)))


def true_form_u95(truth: Truth, x: Array, y: Array) -> Array:
    """U95 (b,) of a least-squares fit of the true form; NaN where the settings do not determine it."""
    columns = np.stack([f(x) for f in truth.form], 1)
    h = np.array([-1e-7, 1e-7])
    to_slope = np.array([float(np.diff(f(h))[0]) / 2e-7 for f in truth.form])
    used = np.abs(columns).max(0) > 0.0
    columns, to_slope = columns[:, used], to_slope[used]
    freedom = len(x) - columns.shape[1]
    if freedom < 1 or np.linalg.matrix_rank(columns) < columns.shape[1]:
        return np.full(len(y), np.nan)
    q, r = np.linalg.qr(columns)
    sd = np.sqrt(((y - y @ q @ q.T) ** 2).sum(1) / freedom)
    return np.asarray(stats.t.ppf(0.975, freedom) * sd * np.linalg.norm(np.linalg.solve(r.T, to_slope)))


def study_u95(x: Array, y: Array) -> float:
    """U95 of the earlier study: x|x|, x^3 and a cubic spline (p = 0), sizes in half decades, flat odds."""
    n, reach = len(x), np.abs(x).max()
    t = x / reach
    a = np.abs(t)
    m, big = np.minimum(a[:, None], a[None, :]), np.maximum(a[:, None], a[None, :])
    spline = np.sign(t)[:, None] * np.sign(t)[None, :] * (m**2 * big / 2.0 - m**3 / 6.0) * 3.0
    kernels = np.stack([np.outer(t * a, t * a), np.outer(t**3, t**3), spline])
    sizes = np.array(list(product(np.r_[0.0, 10.0 ** np.arange(-0.5, 5.01, 0.5)], repeat=3)))
    columns = np.stack([np.ones(n), t, *([t**2] if x.min() < 0.0 < x.max() else [])], 1)
    covariance = np.eye(n) * (1.0 + 1e-9) + np.einsum("ki,iab->kab", sizes**2, kernels)
    factor = np.linalg.cholesky(covariance)
    both = np.linalg.solve(
        factor, np.broadcast_to(np.column_stack([columns, y]), (len(sizes), n, columns.shape[1] + 1))
    )
    white, target = both[:, :, :-1], both[:, :, -1:]
    normal = np.swapaxes(white, 1, 2) @ white
    b = np.linalg.solve(normal, np.swapaxes(white, 1, 2) @ target)
    squares, nu = ((target - white @ b) ** 2).sum((1, 2)), n - columns.shape[1]
    log = -np.log(np.einsum("kii->ki", factor)).sum(1) - 0.5 * np.linalg.slogdet(normal)[1] - nu / 2 * np.log(squares)
    w = np.exp(log - log.max())
    se, mean = np.sqrt(squares / nu * np.linalg.inv(normal)[:, 1, 1]), b[:, 1, 0]
    keep = w > 1e-6 * w.sum()
    w, se, mean = w[keep] / w[keep].sum(), se[keep], mean[keep]
    low, high = np.full(2, (mean - 60 * se).min()), np.full(2, (mean + 60 * se).max())
    for _ in range(60):
        z = 0.5 * (low + high)
        right = (w * stats.t.cdf((z[:, None] - mean) / se, nu)).sum(1) < np.array([0.025, 0.975])
        low, high = np.where(right, z, low), np.where(right, high, z)
    return float((high[1] - high[0]) / 2.0 / reach)


def held(found: Slopes, slope: float) -> tuple[Array, Array]:
    """Whether value +- U95, which is printed, and [lower, upper] hold the true slope, (b,) each."""
    return np.abs(found.value - slope) <= found.u95, (found.lower <= slope) & (slope <= found.upper)


def run_round(design: str, number: int, campaigns: int, studied: int, families: tuple[str, ...]) -> Array:
    """(family, noise, campaign, 5): inside value +- U95, U95, U95 of the true form, U95 of the study, inside [lower, upper]."""
    rng = np.random.default_rng((2026, DESIGNS.index(design), number))
    x = settings(design, rng)
    prepared = prepare(x)
    out = np.full((len(families), len(NOISE), campaigns, 5), np.nan)
    for i, name in enumerate(families):
        truth = FAMILIES[name]
        force = truth.curve(x)
        shocks = rng.standard_normal((len(NOISE), campaigns, len(x))) * np.abs(force).max()
        for j, noise in enumerate(NOISE):
            y = force + noise * shocks[j]
            s = estimate_many(prepared, y)
            out[i, j, :, 0], out[i, j, :, 4] = held(s, truth.slope)
            out[i, j, :, 1], out[i, j, :, 2] = s.u95, true_form_u95(truth, x, y)
            if name in STUDY:
                out[i, j, :studied, 3] = [study_u95(x, row) for row in y[:studied]]
    return out


NOT_ODD = ("offset", "asymmetric", "even part")
DECLARED = ("six", "even", "uneven")


def declared_round(design: str, number: int, campaigns: int, families: Sequence[str]) -> Array:
    """(family, noise, campaign, 3) of one side of a force that is odd by declaration.

    Inside value +- U95, U95 over the slope, inside [lower, upper].
    ``six`` has the angles of the tow tank's default, 2 to 12 degrees; none has a row at rest, which says nothing of an odd force.
    """
    rng = np.random.default_rng((2026, 18, DECLARED.index(design), number))
    n, reach = int(rng.integers(9, 24)), float(np.sin(np.radians(rng.uniform(10.0, 18.0))))
    x = np.sin(np.radians(np.arange(2.0, 13.0, 2.0)))
    if design != "six":
        x = np.linspace(0.0, reach, n)[1:] if design == "even" else np.sort(rng.uniform(0.02 * reach, reach, n))
    prepared = prepare(x, odd=True)
    out = np.full((len(families), len(NOISE), campaigns, 3), np.nan)
    for i, name in enumerate(families):
        truth = FAMILIES[name]
        force = truth.curve(x)
        for j, noise in enumerate(NOISE):
            shocks = rng.standard_normal((campaigns, len(x))) * np.abs(force).max()
            s = estimate_many(prepared, force + noise * shocks)
            out[i, j, :, 0], out[i, j, :, 2] = held(s, truth.slope)
            out[i, j, :, 1] = s.u95 / abs(truth.slope)
    return out


def table(rounds: dict[str, list[Array]]) -> list[dict[str, object]]:
    """One row per cell."""
    out: list[dict[str, object]] = []
    for (i, name), design, (j, noise) in product(enumerate(FAMILIES), DESIGNS, enumerate(NOISE)):
        cell = np.concatenate([r[i, j] for r in rounds[design]])
        slope, cover = abs(FAMILIES[name].slope), 100.0 * float(cell[:, 0].mean())
        known = np.isfinite(cell[:, 2])
        studied = cell[np.isfinite(cell[:, 3])]
        out.append({
            "family": name, "design": design, "noise %": f"{100.0 * noise:g}", "campaigns": len(cell),
            "no value": int(np.isnan(cell[:, 1]).sum()), "cover %": f"{cover:.1f}",
            "lower to upper %": f"{100.0 * float(cell[:, 4].mean()):.1f}",
            "median U95 %": f"{100.0 * np.median(cell[:, 1]) / slope:.4g}",
            "median U95 / true form": f"{np.median(cell[known, 1] / cell[known, 2]):.2f}" if known.any() else "",
            "median U95 / study p = 0": f"{np.median(studied[:, 1]) / np.median(studied[:, 3]):.2f}" if len(studied) else "",
            "remark": "below 90" if cover < 90.0 else "conservative" if cover > 99.0 else "",
        })  # fmt: skip
    return out


def main(work: Path, count: int) -> None:
    """Run what is missing, write the table after each round."""
    work.mkdir(parents=True, exist_ok=True)
    rounds: dict[str, list[Array]] = {d: [] for d in DESIGNS}
    for number in range(count):
        for design in DESIGNS:
            path = work / f"{design}_{number}.npy"
            if not path.exists():
                np.save(work / "part.npy", run_round(design, number, CAMPAIGNS, STUDIED, tuple(FAMILIES)))
                (work / "part.npy").rename(path)
            rounds[design].append(np.load(path))
        rows = table(rounds)
        lines = [",".join(rows[0]), *(",".join(str(v) for v in row.values()) for row in rows)]
        TABLE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else ROUNDS)
