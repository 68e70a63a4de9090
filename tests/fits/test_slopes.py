"""Single forms in growing windows: what other analysts would have said."""

from __future__ import annotations

import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from coeflab.core.types import Array
from coeflab.fits.statistics import slopes
from coeflab.fits.statistics.slopes import design, estimate, windows

TRUTHS = {
    "line": lambda x: 1e-4 - 0.03 * x,
    "{x} + {x}^3": lambda x: 1e-4 - 0.03 * x - 0.2 * x**3,
    "{x} + {x}^3 + {x}^5": lambda x: 1e-4 - 0.03 * x - 0.3 * x**3 + 2.0 * x**5,
    "{x} + {x}|{x}|": lambda x: 1e-4 - 0.03 * x - 0.06 * x * np.abs(x),
    "{x}^2": lambda x: 1e-4 - 0.03 * x**2,
    "{x}^2 + {x}^4": lambda x: 1e-4 - 0.03 * x**2 - 0.2 * x**4,
    "{x}^2 + |{x}|^3": lambda x: 1e-4 - 0.03 * x**2 - 0.2 * np.abs(x) ** 3,
}


def angles(*degrees: float) -> Array:
    return np.sin(np.radians(degrees))


@pytest.mark.parametrize("one_sided", [False, True])
@pytest.mark.parametrize("family", [*slopes.ODD, *slopes.EVEN], ids=lambda f: f.name)
def test_every_form_gives_back_a_planted_one(family: slopes.Family, one_sided: bool) -> None:
    x = angles(*np.linspace(0.0 if one_sided else -18.0, 18.0, 19))
    target = "x" if family in slopes.ODD else "x2"
    found = estimate(family, target, x, TRUTHS[family.name](x), None, np.arange(19))
    assert found.value == pytest.approx(-0.03, rel=1e-9)


@pytest.mark.parametrize("x", [[], [0.0, 0.0, 0.0], [0.1], [0.0, 0.1]])
def test_nothing_to_fit_gives_no_estimate(x: list[float]) -> None:
    assert estimate(slopes.ODD[0], "x", np.array(x), np.zeros(len(x)), None, np.arange(len(x))) is None


def test_windows_go_by_nominal_angle() -> None:
    """Nominal 4 degrees of Roddy's tables are 3.93 to 4.11 as run."""
    x = angles(0.0, 2.0, -1.9, 3.93, -4.11, 4.03, -3.98, 5.97, -6.02, 10.05, -9.98, 18.0, -18.05)
    found = {len(rows): np.degrees(np.arcsin(w)) for w, rows in windows(x, np.inf)}
    assert found == {n: pytest.approx(w) for n, w in [(3, 2.0), (7, 4.11), (9, 6.02), (11, 10.05), (13, 18.05)]}
    assert [len(rows) for _, rows in windows(x, angles(4.0)[0])] == [3, 7]


def test_an_estimate_with_standard_errors_is_the_weighted_fit_of_statsmodels() -> None:
    rng = np.random.default_rng(11)
    x = np.sin(np.radians(np.linspace(-18.0, 18.0, 25) + rng.uniform(-0.1, 0.1, 25)))
    y = TRUTHS["{x} + {x}^3 + {x}^5"](x) + 1e-4 * rng.standard_normal(25)
    se = rng.uniform(2e-5, 4e-4, len(x))
    rows, family = np.flatnonzero(np.abs(x) < 0.25), slopes.ODD[1]
    found = estimate(family, "x", x, y, se, rows)
    peer = {
        k: sm.WLS(y[rows], design(family.terms, x[rows]), se[rows] ** -2.0).fit(cov_type=k, use_t=True)
        for k in ("HC2", "HC3")
    }
    assert found.value == pytest.approx(peer["HC2"].params[1], rel=1e-9)
    assert found.half_hc2 == pytest.approx(peer["HC2"].bse[1] * stats.t.ppf(0.975, found.freedom), rel=1e-9)
    assert found.half_hc3 == pytest.approx(peer["HC3"].bse[1] * stats.t.ppf(0.975, len(rows) - 3), rel=1e-9)
    assert found.freedom < len(rows) - 3
    misfit = float(np.sum(((y[rows] - peer["HC2"].fittedvalues) / se[rows]) ** 2))
    assert found.lack_of_fit == pytest.approx(stats.chi2.sf(misfit, len(rows) - 3), rel=1e-8)
    assert found.window == np.abs(x[rows]).max()


@pytest.mark.parametrize("rows", [41, 99])
def test_rest_and_curvature_of_few_and_of_very_many_rows(rows: int) -> None:
    """99 rows ended in an error of shapes: strips of the part over x beside rows."""
    x = np.linspace(-0.22, 0.22, rows)
    rest, curvature = slopes.rest_and_curvature(x, -0.5 + 2.0 * x - 3.0 * x**2)
    assert rest == pytest.approx(-0.5, rel=1e-2)
    assert curvature == pytest.approx(-3.0, rel=5e-2)


def stalled(degrees: Array, at: float) -> Array:
    """Synthetic lift of a thin wing to its stall, then that of a plate."""
    return np.where(
        np.abs(degrees) <= at, 2.0 * np.pi * np.sin(np.radians(degrees)), 1.1 * np.sin(2.0 * np.radians(degrees))
    )


@pytest.mark.parametrize(("degrees", "at", "ends"), [
    (np.arange(-90.0, 91.0, 5.0), 15.0, (-15.0, 15.0)), (np.arange(0.0, 41.0, 1.0), 12.0, (-np.inf, 12.0)),
    (np.arange(-6.0, 31.0, 2.0), 14.0, (-np.inf, 14.0)), (np.arange(-12.0, 13.0, 2.0), 14.0, (-np.inf, np.inf)),
])  # fmt: skip
@pytest.mark.parametrize("rest", [0.0, 0.4, -0.4])
def test_a_sweep_ends_at_its_stall(degrees: Array, at: float, ends: tuple[float, float], rest: float) -> None:
    """Rows to 90 and 180 degrees bent X0' to a thrust; a camber moves the force at rest, not the stall."""
    x = np.sin(np.radians(degrees))
    low, high = slopes.before_stall(np.repeat(x, 2), np.repeat(-rest - stalled(degrees, at), 2))
    assert np.degrees(np.arcsin(np.clip([low, high], -1.0, 1.0))) == pytest.approx(np.clip(ends, -90.0, 90.0), abs=1e-3)


@pytest.mark.parametrize("shape", [lambda x: x, lambda x: x * np.abs(x), lambda x: x + 3.0 * x**3])
@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
@pytest.mark.parametrize("n", [5, 13, 61])
def test_no_stall_is_seen_in_scatter(shape: object, noise: float, n: int) -> None:
    """A bluff body's cross flow rises up to 90 degrees; scatter of a dense sweep is no fall: one false alarm in a hundred at most."""
    x = np.sin(np.radians(np.linspace(-90.0, 90.0, n)))
    chance = np.random.default_rng(1)
    y = shape(x)  # type: ignore[operator]
    found = [slopes.before_stall(x, y + noise * np.abs(y).max() * chance.standard_normal(n)) for _ in range(200)]
    assert sum(ends != (-np.inf, np.inf) for ends in found) <= 2


def test_nothing_has_no_stall() -> None:
    assert slopes.before_stall(np.empty(0), np.empty(0)) == (-np.inf, np.inf)


@pytest.mark.parametrize("wrong", [{4: 4.0}, {3: 10.2}])
def test_one_bad_row_is_no_stall(wrong: dict[int, float]) -> None:
    force = np.array([0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0])
    for row, value in wrong.items():
        force[row] = value
    assert slopes.before_stall(2.0 * np.arange(7.0), -force) == (-np.inf, np.inf)
    assert slopes.before_stall(2.0 * np.arange(6.0), -np.array([0.0, 2.0, 4.0, 6.0, 5.0, 4.5])) == (-np.inf, 6.0)
