"""Coverage of the intervals of `coeflab identify` on simulated series of a vehicle whose coefficients are known.

``python -m tests.coverage.identify_campaigns [SEEDS]`` writes ``identify_table.csv`` beside this file. A campaign is the six
manoeuvres of `tests.identify.test_identify`, or two of them, with noise on u v r of a share of each one's root mean square:
white; white but heavy-tailed (Student, 3 degrees of freedom); or neighbouring rows correlated by 0.9. The terms are given, or chosen from
the whole library; then a term that is not in the truth counts as zero, and exchangeable ones, which have no interval, do not
count. Seeds are those of the noise.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.signal import lfilter

from coeflab.core.types import Array
from coeflab.fits.sparse import scaled_optimizer
from coeflab.identify.candidate_terms import candidate_terms
from coeflab.identify.force_balance import Candidate, correlated, weak
from coeflab.identify.identification import exchangeable, half_widths, identify, multiples
from coeflab.identify.series import MotionSeries, read_series
from coeflab.motion.simulation import simulate
from coeflab.motion.vehicle import vehicle
from coeflab.report.tables.motion import motion_csv
from tests.identify.test_identify import FILE, RUNS, TRUE

SEEDS, CHOSEN = 10, 4
HALF = 1.124  # s, three quarters of L/V
TERMS = {"X": "X0 Xvv Xvr Xdrdr", "Y": "Yv Yr Yv|v| Ydr", "N": "Nv Nr N|v|r Ndr"}
BODY = vehicle(FILE, free=("u", "v", "r"))
TABLE = Path(__file__).with_name("identify_table.csv")
HEADER = ("noise", "level %", "manoeuvres", "terms", "intervals", "cover %", "without interval")


@dataclass(frozen=True)
class Kind:
    """One kind of campaign."""

    noise: str
    level: float
    runs: tuple[int, ...] = (0, 1, 2, 3, 4, 5)
    chosen: bool = False


KINDS = (
    Kind("white", 0.01), Kind("white", 0.05), Kind("heavy-tailed", 0.03), Kind("correlated", 0.01),
    Kind("white", 0.01, (1, 4)), Kind("white", 0.03, (1, 4)),
    Kind("white", 0.01, chosen=True), Kind("white", 0.05, chosen=True),
)  # fmt: skip


def clean() -> list[MotionSeries]:
    out = []
    with TemporaryDirectory() as folder:
        for name, options in RUNS:
            file = Path(folder) / f"{name}.csv"
            file.write_bytes(
                motion_csv(simulate(FILE, name, options, {"record": 0.02}, free=("u", "v", "r")).trajectory)
            )
            out.append(read_series(file, BODY))
    return out


def noisy(series: Sequence[MotionSeries], kind: Kind, seed: int) -> list[MotionSeries]:
    rng, out = np.random.default_rng(seed), []
    for s in (series[k] for k in kind.runs):
        velocity = np.array(s.velocity)
        for k in (0, 1, 5):
            e = rng.standard_normal(len(velocity))
            if kind.noise == "heavy-tailed":
                e = rng.standard_t(3, len(velocity)) / 3.0**0.5
            elif kind.noise == "correlated":
                e = lfilter([(1.0 - 0.9**2) ** 0.5], [1.0, -0.9], e)
            velocity[:, k] += kind.level * np.sqrt(np.mean(velocity[:, k] ** 2)) * e
        out.append(replace(s, velocity=velocity))
    return out


def library(component: str, *, chosen: bool) -> list[Candidate]:
    asked = () if chosen else tuple(TERMS[component].split())
    every = candidate_terms(
        FILE, frozenset(("u", "v", "r", "dr")), asked, symmetric=True, accelerations=False, driven=frozenset()
    )
    return [t for t in every if t.component == component]


def campaign(series: Sequence[MotionSeries], kind: Kind, component: str, seed: int) -> tuple[list[bool], int]:
    """Which intervals hold the truth, and how many terms have none."""
    terms = library(component, chosen=kind.chosen)
    rows = noisy(series, kind, seed)
    if any(correlated(s, HALF) for s in rows):
        return [], len(terms)
    p = weak(rows, BODY, component, terms, HALF)
    again = multiples(p.gram.sum(axis=0))
    usable = [j for j in range(len(terms)) if j not in again]
    p, terms = p.of(usable), [terms[j] for j in usable]
    kept: Sequence[int] = range(len(terms))
    swaps: dict[int, tuple[int, ...]] = {}
    if kind.chosen:
        kept = identify(p, scaled_optimizer("stlsq"), seed=1, resamples=40).retained
        swaps = exchangeable(p, kept)
    values, half = p.solved(kept), half_widths(p, kept)
    off: Array = np.array(
        [v / terms[k].per_prime - TRUE.get(terms[k].symbol, 0.0) for v, k in zip(values, kept, strict=True)]
    )
    inside = np.abs(off) <= half / np.array([terms[k].per_prime for k in kept])
    alone = [not swaps.get(k) for k in kept]
    return [bool(i) for i, a in zip(inside, alone, strict=True) if a], len(alone) - sum(alone)


def row(series: Sequence[MotionSeries], kind: Kind, seeds: int) -> dict[str, object]:
    count = CHOSEN if kind.chosen else seeds
    found = [campaign(series, kind, c, seed) for c in ("YN" if kind.chosen else "XYN") for seed in range(count)]
    inside = [i for some, _ in found for i in some]
    return dict(zip(HEADER, (
        kind.noise, f"{100 * kind.level:g}", len(kind.runs), "chosen" if kind.chosen else "given", len(inside),
        f"{100 * np.mean(inside):.1f}" if inside else "", sum(n for _, n in found),
    ), strict=True))  # fmt: skip


def main(seeds: int) -> None:
    series = clean()
    rows = [row(series, kind, seeds) for kind in KINDS]
    with TABLE.open("w", newline="") as out:
        writer = csv.DictWriter(out, HEADER, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else SEEDS)
