"""Coverage of U95 on curves of one sign, drawn at random, and the least length that any honest interval can have at a line.

``python -m tests.coverage.one_signed_campaigns WORK [ROUNDS] [SEED]`` runs 50 rounds of 20 campaigns a cell (family, design, noise), each
with curves of its own; a round that is already in WORK is not run again. After each it writes ``one_signed_seedN.csv`` into WORK. Seeds
are (seed, family, design, noise, round), of uneven settings (seed, design, round); 50 rounds take an hour of a core. The constants of
`coeflab.fits.statistics.one_signed` were chosen with seed 1 and fixed families. Committed are 60 campaigns a cell of seed 2 (drawn at
once) and 40 of seed 3.

``python -m tests.coverage.one_signed_campaigns WORK more`` asks further where these 100 leave the bound open or cover less than 97 %: 100
more at a time, of seed 4, until the Clopper-Pearson interval of 99.5 % of all campaigns lies on one side of the bound (ten looks at most:
95 % together), and to 1,000 where it is missed. It goes on where it stopped, and writes ``one_signed_table.csv`` beside this file: per cell all
campaigns, and how many of them are later ones, whose coverage no choice of the cell has moved.

Of a cell ``line`` is by how many standard deviations the noiseless curve rules a line out, the median over its campaigns. Burst families
(drag crisis) are outside of the class and named for what they are.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from scipy import stats

from coeflab.core.types import Array
from coeflab.fits.statistics.slope_mixture import estimate_many, prepare

NOISE = (0.03, 0.01, 0.003, 0.001, 0.0003)
DESIGNS = ("even 13", "even 19", "uneven", "one-sided", "replicated", "odd 7")
ROUNDS, CAMPAIGNS, SEED = 50, 20, 3
TABLE = Path(__file__).with_name("one_signed_table.csv")
FIRST = [TABLE.with_name(f"one_signed_seed{seed}.csv") for seed in (2, 3)]
BOUNDS, RULED_OUT, MOST, LOOK, LATER = (
    (85.0, 90.0),
    5.0,
    1000,
    0.995,
    4,
)  # where a line is possible, and where it is ruled out
CRISIS = float(np.sin(np.radians(8.0)))
Draw = Callable[[np.random.Generator, Array], Array]  # a bent curve over t, one at t = 1


def power(t: Array, p: float) -> Array:
    return np.asarray(np.sign(t) * np.abs(t) ** p)


def single(rng: np.random.Generator, t: Array) -> Array:
    return power(t, rng.uniform(1.7, 4.0))


def slow(rng: np.random.Generator, t: Array) -> Array:
    return power(t, rng.uniform(1.7, 1.9))


def several(rng: np.random.Generator, t: Array) -> Array:
    return np.asarray(sum(w * power(t, p) for w, p in zip(rng.dirichlet(np.ones(3)), rng.uniform(1.7, 4.0, 3))))


def saturating(rng: np.random.Generator, t: Array) -> Array:
    k = 0.5 / rng.uniform(0.1, 1.0)
    return power(t, 2.0) * (1.0 + 1.0 / k) / (1.0 + np.abs(t) / k)


def late(rng: np.random.Generator, t: Array) -> Array:
    at, size = rng.uniform(0.6, 0.8), rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 2.0)
    return power(t, rng.uniform(1.7, 3.0)) + size * np.sign(t) * np.maximum(np.abs(t) - at, 0.0)


def crisis(rng: np.random.Generator, t: Array) -> Array:
    at = CRISIS / float(np.sin(np.radians(15.0)))
    return power(t, 2.0) * (1.0 - 0.65 / (1.0 + np.exp(-(np.abs(t) - at) / 0.04)))


BENT: dict[str, Draw] = {
    "one power": single, "slow power": slow, "three powers": several, "saturating": saturating, "late bend": late, "crisis": crisis,
}  # fmt: skip
FAMILIES = ("line", *(f"{name}, {how}" for name in BENT for how in ("along", "opposed")))
OUTSIDE = ("crisis, along", "crisis, opposed")


def settings(design: str, rng: np.random.Generator) -> tuple[Array, bool]:
    """Over the largest, and whether the curve is odd by declaration."""
    if design.startswith("even"):
        return np.linspace(-1.0, 1.0, int(design[5:])), False
    if design == "uneven":
        return np.sort(rng.uniform(-1.0, 1.0, 14)), False
    if design == "one-sided":
        return np.linspace(0.0, 1.0, 12), False
    if design == "replicated":
        return np.repeat(np.linspace(-1.0, 1.0, 9), 2), False
    return np.linspace(0.0, 1.0, 8)[1:], True


def line_deviation(t: Array, odd: bool) -> float:
    """Standard deviation of the slope of a line by least squares, per that of a reading."""
    return float(1.0 / np.linalg.norm(t if odd else t - t.mean()))


SLOWEST, SHAPES = tuple(np.linspace(1.7, 4.0, 24)), tuple(np.geomspace(0.5, 5.0, 12))


def frontier(t: Array, odd: bool, powers: Sequence[float] = SLOWEST, saturating: Sequence[float] = SHAPES) -> float:
    """Expected length at a line of the shortest 95 % interval of the class, over that of a line by least squares.

    With a line alone and k standard deviations of the slope's best test against the nearest curve of the class, its length is
    2 (z p + density(z)) / k, z the quantile of p = .95 (Pratt 1961). Late bends are not in it: with them it is 10 to 12.
    """
    one_sided = not t.min() < 0.0 < t.max()
    free = np.zeros((len(t), 0)) if odd else np.stack([np.ones_like(t), *([] if one_sided else [t * t])], 1)
    bent = [power(t, p) for p in powers] + [power(t, 2.0) / (1.0 + np.abs(t) / k) for k in saturating]
    least = np.inf
    for f in bent:  # two shapes of one sign are never nearer than the nearer of both
        r = np.linalg.qr(np.column_stack([free, f, t]), mode="r")
        least = min(least, abs(float(r[-1, -1])))
    z = stats.norm.ppf(0.95)
    return float((0.95 * z + stats.norm.pdf(z)) / least / (stats.norm.ppf(0.975) * line_deviation(t, odd)))


def cell(family: str, design: str, noise: float, campaigns: int, seed: int, number: int = 0) -> Array:
    """(campaign, 3): covered, U95 over that of a line's least squares, standard deviations by which a line is ruled out."""
    rng = np.random.default_rng((seed, FAMILIES.index(family), DESIGNS.index(design), NOISE.index(noise), number))
    t, odd = settings(design, np.random.default_rng((seed, DESIGNS.index(design), number)))
    name, how = (*family.split(", "), "")[:2]
    force = np.tile(t, (campaigns, 1))
    if name != "line":
        size = np.exp(rng.uniform(np.log(0.3), np.log(3.0), campaigns)) * (-1.0 if how == "opposed" else 1.0)
        force = force + size[:, None] * np.stack([BENT[name](rng, t) for _ in range(campaigns)])
    if t.min() < 0.0:
        force = force + rng.uniform(-0.05, 0.05, (campaigns, 1)) + rng.uniform(-0.1, 0.1, (campaigns, 1)) * t * t
    deviation = noise * np.abs(force).max(1)
    found = estimate_many(prepare(t, odd=odd), force + deviation[:, None] * rng.standard_normal(force.shape))
    straight = np.stack([t] if odd else [np.ones_like(t), t, *([t * t] if t.min() < 0.0 else [])], 1)
    across = np.linalg.qr(straight)[0]
    left = np.linalg.norm(force - force @ across @ across.T, axis=1) / deviation
    plain = stats.t.ppf(0.975, len(t) - (1 if odd else 2)) * line_deviation(t, odd) * deviation
    return np.stack([np.abs(found.value - 1.0) <= found.u95, found.u95 / plain, left], 1)


def run_round(design: str, number: int, seed: int) -> Array:
    """(family, noise, campaign, 3) of `cell`, and the frontier of the round's settings behind the last campaign."""
    every = [[cell(family, design, noise, CAMPAIGNS, seed, number) for noise in NOISE] for family in FAMILIES]
    least = frontier(*settings(design, np.random.default_rng((seed, DESIGNS.index(design), number))))
    return np.pad(np.array(every), ((0, 0), (0, 0), (0, 1), (0, 0)), constant_values=least)


def main(work: Path, count: int, seed: int) -> None:
    """Run what is missing, write the table after each round."""
    work.mkdir(parents=True, exist_ok=True)
    rounds: dict[str, list[Array]] = {d: [] for d in DESIGNS}
    for number in range(count):
        for design in DESIGNS:
            path = work / f"{seed}_{design.replace(' ', '_')}_{number}.npy"
            if not path.exists():
                np.save(work / "part.npy", run_round(design, number, seed))
                (work / "part.npy").rename(path)
            rounds[design].append(np.load(path))
        lines = ["family,design,noise %,campaigns,line,cover %,mean U95 / line,frontier"]
        for design, (i, family), (j, noise) in product(DESIGNS, enumerate(FAMILIES), enumerate(NOISE)):
            inside, length, left = np.concatenate([r[i, j, :-1] for r in rounds[design]]).T
            least = np.mean([r[i, j, -1, 0] for r in rounds[design]])
            lines.append(
                f"{family.replace(',', ':')},{design},{100 * noise:g},{len(inside)},{np.median(left):.1f},{100 * inside.mean():.1f},"
                f"{length.mean():.2f},{least:.2f}"
            )
        (work / f"one_signed_seed{seed}.csv").write_text("\n".join(lines) + "\n")


@dataclass
class Cell:
    """Campaigns of one family, design and noise: of the first seeds, and later ones."""

    family: str
    design: str
    noise: float
    line: float
    length: float
    least: float
    first: int
    first_inside: int
    later: int = 0
    later_inside: int = 0

    @property
    def bound(self) -> float:
        return BOUNDS[self.line > RULED_OUT]

    @property
    def cover(self) -> float:
        return 100.0 * (self.first_inside + self.later_inside) / (self.first + self.later)

    def interval(self, level: float = LOOK) -> tuple[float, float]:
        """Clopper-Pearson's, %, of all campaigns."""
        return clopper_pearson(self.first_inside + self.later_inside, self.first + self.later, level)

    @property
    def open(self) -> bool:
        low, high = self.interval()
        return low < self.bound <= high and self.first + self.later < MOST


def clopper_pearson(inside: int, count: int, level: float) -> tuple[float, float]:
    """%."""
    tail = 0.5 * (1.0 - level)
    low = stats.beta.ppf(tail, inside, count - inside + 1) if inside else 0.0
    high = stats.beta.isf(tail, inside + 1, count - inside) if inside < count else 1.0
    return 100.0 * float(low), 100.0 * float(high)


def first_cells() -> list[Cell]:
    """What the first two seeds found."""
    out = []
    with FIRST[0].open() as a, FIRST[1].open() as b:
        for rows in zip(csv.DictReader(a), csv.DictReader(b), strict=True):
            counts = [int(r["campaigns"]) for r in rows]
            inside = sum(round(n * float(r["cover %"]) / 100.0) for n, r in zip(counts, rows))
            length, least = (
                float(np.average([float(r[key]) for r in rows], weights=counts))
                for key in ("mean U95 / line", "frontier")
            )
            r = rows[0]
            family, noise = r["family"].replace(":", ","), float(r["noise %"]) / 100.0
            out.append(Cell(family, r["design"], noise, float(r["line"]), length, least, sum(counts), inside))
    return out


def chosen(c: Cell) -> bool:
    """Whether the first campaigns leave the bound open, or cover less than 97 %."""
    return c.family not in OUTSIDE and (clopper_pearson(c.first_inside, c.first, 0.95)[0] < c.bound or c.cover < 97.0)


def ask_further(work: Path) -> None:
    """100 campaigns more in each open cell, and again; then 1,000 in every one that missed its bound by then, come what may."""
    work.mkdir(parents=True, exist_ok=True)
    cells = first_cells()
    some = [c for c in cells if chosen(c)]
    while left := [c for c in some if c.open]:
        for c in left:
            add(c, work)
        write(cells)
    for c in [c for c in some if c.cover < c.bound]:
        while c.first + c.later < MOST:
            add(c, work)
    write(cells)


def add(c: Cell, work: Path) -> None:
    """100 campaigns, of WORK where they are there."""
    path = work / f"{LATER}_{c.family}_{c.design}_{c.noise:g}_{c.later}.npy".replace(" ", "_").replace(",", "")
    if not path.exists():
        rounds = [cell(c.family, c.design, c.noise, CAMPAIGNS, LATER, c.later // CAMPAIGNS + k) for k in range(5)]
        np.save(path, np.concatenate(rounds))
    found = np.load(path)
    c.later, c.later_inside = c.later + len(found), c.later_inside + round(found[:, 0].sum())


def write(cells: Sequence[Cell]) -> None:
    """The table."""
    lines = ["family,design,noise %,campaigns,line,cover %,mean U95 / line,frontier,later,later cover %"]
    lines += [
        f"{c.family.replace(',', ':')},{c.design},{100 * c.noise:g},{c.first + c.later},{c.line:.1f},{c.cover:.1f},{c.length:.2f},{c.least:.2f},"
        f"{c.later},{f'{100 * c.later_inside / c.later:.1f}' if c.later else ''}"
        for c in cells
    ]
    TABLE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if sys.argv[2:] == ["more"]:
        ask_further(Path(sys.argv[1]))
    else:
        asked = [*map(int, sys.argv[2:]), *(ROUNDS, SEED)[len(sys.argv) - 2 :]]
        main(Path(sys.argv[1]), asked[0], asked[1])
