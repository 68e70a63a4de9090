"""Speeds pooled in one sweep: a primed slope that depends on the speed, or on another level of the test, is found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import coeflab as cf
from coeflab.cli import app
from coeflab.tables.levels import levels_of, slopes_by_level

X = np.radians([-20.0, -10.0, 0.0, 10.0, 20.0])
SPEEDS = (0.45, 0.7, 1.0, 1.3)


def pooled(
    slope_of: Callable[[float], float], noise: float = 0.0, seed: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    u = np.repeat(SPEEDS, X.size)
    x = np.tile(X, len(SPEEDS))
    y = np.concatenate([slope_of(s) * X for s in SPEEDS])
    return x, y + noise * np.max(np.abs(y)) * rng.normal(size=y.size), u


def test_slopes_behind_a_propeller_at_one_rate_are_those_of_each_speed() -> None:
    found = slopes_by_level(*pooled(lambda u: 0.0031 * (1.3 / u) ** 1.65))
    assert found.levels == pytest.approx(SPEEDS)
    assert found.slopes == pytest.approx([0.0031 * (1.3 / u) ** 1.65 for u in SPEEDS], rel=1e-6)
    assert found.depends
    assert found.spread == pytest.approx(1.0 - (0.45 / 1.3) ** 1.65, rel=1e-6)


@pytest.mark.parametrize("exponent", [0.0, 0.05])
def test_one_slope_and_the_trend_of_a_reynolds_number_are_no_dependence(exponent: float) -> None:
    found = slopes_by_level(*pooled(lambda u: 0.02 * u**-exponent))
    assert not found.depends


def test_scatter_alone_is_seldom_taken_for_a_dependence() -> None:
    found = [slopes_by_level(*pooled(lambda u: 0.02, noise=0.05, seed=s)) for s in range(200)]
    assert sum(f is not None and f.depends for f in found) <= 4  # at 1 %, of 200


def test_levels_are_those_of_a_measured_speed() -> None:
    assert levels_of(np.array([1.0, 0.99, 1.01, 0.5])).tolist() == [1, 1, 1, 0]
    assert slopes_by_level(X, X, np.ones(5)) is None
    assert slopes_by_level(X[:4], X[:4], np.array([1.0, 1.0, 2.0, 2.0])) is None


def test_one_level_of_a_column_is_taken_by_its_word(tmp_path: Path) -> None:
    """Synthetic polars of three flaps in one table: slopes of all rows belong to none, those of one flap are right."""
    rows = [
        f"{a},{flap},{(4.0 + 0.04 * flap) * np.sin(np.radians(a)) + 0.02 * flap:.6f},{0.02 + 0.001 * abs(flap):.4f}"
        for flap in (-10, 0, 10)
        for a in range(-8, 9, 2)
    ]
    (path := tmp_path / "flaps.csv").write_text("\n".join(["alpha,deflection,CL,CD", *rows]) + "\n")
    set_ = ["coefficients.area=1", "axes.frame=FRD", "scaling.length=1 m L", "axes.alpha=+"]
    command = [
        "import",
        str(path),
        "--out",
        str(tmp_path / "out"),
        *(w for s in set_ for w in ("--set", s)),
        "--accept",
    ]
    asked = CliRunner().invoke(app, command)
    assert asked.exit_code == 2
    assert '--map "deflection=label [-10]"' in " ".join(asked.output.split())
    done = CliRunner().invoke(app, [*command, "--map", "deflection=label [10]"])
    assert done.exit_code == 0, done.output
    assert "another deflection than 10" in " ".join(done.output.split())
    assert "give a slope of none" not in " ".join(done.output.split())
    found = cf.fit(tmp_path / "out")["Zw'"]
    assert found.value == pytest.approx(-(4.4 + 0.03), rel=0.002)
