"""Coverage of fixed-form fits on simulated campaigns whose truth has a term that the form lacks, or none.

``python -m tests.coverage.forms_campaigns [CAMPAIGNS]`` writes ``forms_table.csv`` beside this file, by default 100 campaigns
a cell (form, missing function, its share of the largest force, noise). Seeds are (2026, number of the cell).

``seen`` is the size of the misfit that the residuals can show, in standard errors: the norm of the part of the missing
function that the form cannot follow, over the noise of one reading. Below about six it drowns.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.fits.statistics.remainder import Block, judged, left_out
from coeflab.law.terms import Term, design, parse_suffix, power_terms

CAMPAIGNS = 100
NOISE = (0.03, 0.01, 0.001)
SHARES = (0.1, 0.3)
SEEN = 6.0
TABLE = Path(__file__).with_name("forms_table.csv")
HEADER = ("form", "missing", "share %", "noise %", "points", "seen", "scatter alone covers %", "covers or rejected %",
          "rejected %", "median width ratio", "mean width ratio", "remark")  # fmt: skip


@dataclass(frozen=True)
class Truth:
    """A form over its settings, its coefficients, and functions that it may lack."""

    form: str
    x: Mapping[str, Array]
    terms: tuple[Term, ...]
    b: tuple[float, ...]
    missing: Mapping[str, Array]
    growing: bool = False

    @property
    def force(self) -> Array:
        """Without what is missing, shape (n,)."""
        return np.asarray(design(self.terms, self.x) @ np.array(self.b))


def named(*suffixes: str) -> tuple[Term, ...]:
    return tuple(parse_suffix(s) for s in suffixes)


def power(variable: str, n: int) -> Term:
    return Term(((variable, n, False),)) if n else Term()


def truths() -> list[Truth]:
    both, ahead, few = np.linspace(-2.0, 2.0, 16), np.linspace(0.2, 2.0, 12), np.linspace(-2.0, 2.0, 8)
    out = [
        Truth(f"damping, {how}", {"u": u}, named("u", "u|u|"), (-10.0, -30.0),
              {"u^3": u**3, "bend": np.sign(u) * np.maximum(np.abs(u) - 0.9, 0.0)})
        for how, u in (("both ways", both), ("one way", ahead), ("eight points", few))
    ]  # fmt: skip
    a = np.radians(np.linspace(-12.0, 12.0, 21))
    out += [
        Truth("polar, lift", {"alpha": a}, (power("alpha", 0), power("alpha", 1)), (0.5, 9.0), {"alpha^3": a**3}),
        Truth("polar, drag", {"alpha": a}, (power("alpha", 0), power("alpha", 2)), (0.3, 12.0),
              {"|alpha|^3": np.abs(a) ** 3, "alpha^3": a**3}),
        Truth("polynomial, line", {"v": a}, named("0", "v"), (0.001, -0.03), {"v|v|": a * np.abs(a), "v^3": a**3}),
    ]  # fmt: skip
    alpha, beta = (g.ravel() for g in np.meshgrid(np.linspace(-0.2, 0.2, 7), np.linspace(-0.3, 0.3, 7)))
    surface = power_terms(("alpha", "beta"), 2, "total", {"beta": "even"})
    out.append(
        Truth("surface", {"alpha": alpha, "beta": beta}, surface, tuple(np.linspace(0.3, 1.0, len(surface))),
              {"alpha beta^2": alpha * beta**2, "alpha^3": alpha**3, "beta^4": beta**4})
    )  # fmt: skip
    v = np.concatenate([np.linspace(-0.3, 0.3, 13), np.zeros(13), np.tile(np.linspace(-0.2, 0.2, 5), 4)])
    r = np.concatenate([np.zeros(13), np.linspace(-0.6, 0.6, 13), np.repeat(np.linspace(-0.5, 0.5, 4), 5)])
    lateral, b = named("0", "v", "v|v|", "r", "r|r|", "v|r|"), (1e-4, -0.028, -0.06, 0.005, 0.002, -0.03)
    out += [
        Truth("manoeuvring", {"v": v, "r": r}, lateral, b, {"vrr": v * r**2, "vvr": v**2 * r, "vvv": v**3}),
        Truth("damping, growing scatter", {"u": both}, named("u", "u|u|"), (-10.0, -30.0), {}, growing=True),
    ]
    return out


def cell(
    truth: Truth, missing: str, share: float, noise: float, campaigns: int, seed: Sequence[int]
) -> dict[str, object]:
    """One row of the table."""
    rng = np.random.default_rng(list(seed))
    force, b, n = truth.force, np.array(truth.b), len(truth.force)
    largest = float(np.abs(force).max())
    extra = truth.missing[missing] if missing else np.zeros(n)
    extra = extra * (share * largest / (float(np.abs(extra).max()) or 1.0))
    matrix, block = design(truth.terms, truth.x), Block(slice(None), truth.terms, truth.x)
    basis = np.linalg.qr(matrix)[0]
    seen = float(np.linalg.norm(extra - basis @ (basis.T @ extra))) / (noise * largest)
    scale = noise * largest * (0.3 + np.abs(force) / largest if truth.growing else np.ones(n))
    alone, covered, rejected, ratio = [], [], [], []
    for _ in range(campaigns):
        y = force + extra + scale * rng.standard_normal(n)
        fit = fit_linear(matrix, y)
        part, ((none, likeliest),) = left_out(matrix, fit.residuals, None, None, (block,))
        found = judged(part, none, likeliest, fit.coefficients, fit.half_width)
        off, whole = np.abs(fit.coefficients - b), np.hypot(fit.half_width, found.half_width)
        alone.append(off <= fit.half_width)
        rejected.append(found.rejected)
        covered.append((off <= whole) | found.rejected)
        ratio.append(whole / fit.half_width)
    worst = 100.0 * float(np.min(np.mean(covered, axis=0)))
    below = "hidden by the noise" if missing and seen < SEEN else "below 90"
    remark = "" if worst >= 90.0 else below
    return dict(zip(HEADER, (
        truth.form, missing or "nothing", f"{100 * share:.0f}", f"{100 * noise:g}", n, f"{seen:.1f}",
        f"{100 * np.min(np.mean(alone, axis=0)):.1f}", f"{worst:.1f}", f"{100 * np.max(np.mean(rejected, axis=0)):.1f}",
        f"{np.max(np.median(ratio, axis=0)):.2f}", f"{np.max(np.mean(ratio, axis=0)):.2f}", remark,
    ), strict=True))  # fmt: skip


def cells() -> list[tuple[Truth, str, float, float]]:
    return [
        (t, missing, share, noise)
        for t in truths()
        for missing in ("", *t.missing)
        for share in (SHARES if missing else (0.0,))
        for noise in NOISE
    ]


def main(campaigns: int) -> None:
    rows = [cell(*c, campaigns, (2026, k)) for k, c in enumerate(cells())]
    with TABLE.open("w", newline="") as out:
        writer = csv.DictWriter(out, HEADER, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CAMPAIGNS)
