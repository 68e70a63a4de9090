"""Sparse force laws: planted terms come back, scaling is needed, and SUBOFF's tables."""

from __future__ import annotations

import warnings
from functools import cache
from importlib import import_module

import numpy as np
import pysindy
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.sparse_selection import library, select
from coeflab.law.coefficient import Status
from coeflab.law.named_terms import symmetric
from coeflab.law.terms import Term, design
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS

TRIALS, POINTS, NOISE = 100, 200, 0.02
SMALLEST, LARGEST = 1e-4, 1e-2
TERMS = tuple(t for t in library(("v", "r"), 3, absolute=True) if symmetric("Y", t))


@cache
def tables(campaign: str) -> tuple[ForceTable, ...]:
    return IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / campaign / FILE))


def fitted(campaign: str, **options: object) -> FitResult:
    used = tables(campaign)
    return FITS.load("sparse").fit(used, used[0].scaling, {"ensembles": 20, **options})


def model(result: FitResult, component: str) -> FittedModel:
    return next(m for m in result.models if m.response == component)


def planted(seed: int, least_share: float) -> tuple[tuple[int, ...], np.ndarray, np.ndarray]:
    """Two to four of twelve terms, coefficients of 1e-4 to 1e-2, drift to 17 degrees and r' to 0.6; support, design, y.

    ``least_share``: contribution (root mean square) of the smallest term in that of the largest; what lies far below
    the noise nobody can find.
    """
    rng = np.random.default_rng(seed)
    columns = {"v": np.sin(rng.uniform(-0.3, 0.3, POINTS)), "r": rng.uniform(-0.6, 0.6, POINTS)}
    matrix = design(TERMS, columns)
    rms = np.sqrt(np.mean(matrix**2, axis=0))
    while True:
        support = np.sort(rng.choice(len(TERMS), int(rng.integers(2, 5)), replace=False))
        size = np.exp(rng.uniform(np.log(least_share), 0.0, len(support))) / rms[support]
        if size.max() / size.min() <= LARGEST / SMALLEST:
            break
    size *= np.exp(rng.uniform(np.log(SMALLEST / size.min()), np.log(LARGEST / size.max())))
    assert size.min() >= SMALLEST * (1 - 1e-9)
    assert size.max() <= LARGEST * (1 + 1e-9)
    exact = matrix[:, support] @ (size * rng.choice([-1.0, 1.0], len(support)))
    noise = NOISE * np.sqrt(np.mean(exact**2)) * rng.standard_normal(POINTS)
    return tuple(int(j) for j in support), matrix, exact + noise


def chosen(seed: int, least_share: float) -> tuple[set[int], set[int]]:
    """Planted and chosen terms of one trial."""
    support, matrix, y = planted(seed, least_share)
    optimizer = FITS.load("sparse").scaled_optimizer("stlsq")
    return set(support), set(select(matrix, y, optimizer, seed=seed, resamples=0).support)


@pytest.mark.slow
def test_planted_terms_are_found_in_95_percent_of_trials() -> None:
    with import_module("threadpoolctl").threadpool_limits(1):
        found = [chosen(seed, 0.3) for seed in range(TRIALS)]
    assert np.mean([a == b for a, b in found]) >= 0.95


@pytest.mark.slow
def test_terms_below_the_noise_may_be_missed_but_others_are_not_invented() -> None:
    """Shares down to 0.1 % of the largest term, under noise of 2 %: at most one chosen term in ten was not planted."""
    with import_module("threadpoolctl").threadpool_limits(1):
        found = [chosen(1000 + seed, 1e-3) for seed in range(25)]
    invented = sum(len(b - a) for a, b in found)
    assert invented <= 0.1 * sum(len(b) for _, b in found)


def test_the_default_threshold_on_unscaled_columns_wipes_every_coefficient() -> None:
    """Why the library is scaled: pysindy's default of 0.1 is ten times the largest coefficient here."""
    _, matrix, y = planted(1, 0.3)
    # pysindy warns that its own threshold eliminated everything.
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        wiped = pysindy.STLSQ().fit(matrix, y[:, None]).coef_
    assert not np.any(wiped)
    assert any("eliminated all coefficients" in str(w.message) for w in said)
    support, found = chosen(1, 0.3)
    assert found == support


@pytest.mark.parametrize("kind", ["stlsq", "sr3"])
def test_both_optimizers_keep_what_exceeds_the_threshold(kind: str) -> None:
    optimizer = FITS.load("sparse").scaled_optimizer(kind)
    x = np.linalg.qr(np.random.default_rng(0).standard_normal((50, 3)))[0] * np.sqrt(50)
    y = x @ [1.0, 0.3, 0.05]
    for threshold, kept in ((0.02, 3), (0.1, 2), (0.5, 1)):
        b = optimizer(x, y, threshold)
        assert np.flatnonzero(b).tolist() == list(range(kept))
        assert b[0] == pytest.approx(1.0, rel=0.03)


# The real sweeps


def test_roddys_sweep_gives_drift_square_and_rudder() -> None:
    """Configuration 2: Y' and N' by v, v|v| and dr, as in the standard equations (Gertler & Hagen 1967)."""
    result = fitted("suboff_roddy_2", components="Y N")
    assert result.settings["Y"] == "Ydr Yv Yv|v|"
    assert result.settings["N"] == "Ndr Nv Nv|v|"
    for m in result.models:
        assert m.post_selection
        assert len([s for s in m.statements if "chosen on these rows" in s or "has seen" in s]) == 1
        assert any("U95 and the error of left-out rows are too small" in s for s in m.statements)
        assert m.fit.press_rms < 0.02 * np.ptp(m.y)
    for c in result.coefficients.coefficients:
        assert c.status is Status.FORM_ASSUMED
        assert "ignores the choice" in c.estimator


def test_symmetry_is_respected_unless_told_otherwise() -> None:
    strict = fitted("suboff_roddy_2", components="Z")
    assert all(symmetric("Z", t) for t in model(strict, "Z").terms)
    free = fitted("suboff_roddy_2", components="Z", symmetric="no")
    assert not all(symmetric("Z", t) for t in model(free, "Z").terms)


def test_both_optimizers_agree_on_the_bare_hulls_side_force() -> None:
    a, b = (fitted("suboff_cfd_barehull", components="Y", optimizer=o) for o in ("stlsq", "sr3"))
    assert a.settings["Y"] == b.settings["Y"]
    assert {"Yr", "Yv"} <= set(model(a, "Y").symbols)
    said = " ".join(model(a, "Y").statements)
    assert "no row excites them: Yv|r|" in said
    assert "resamples" in said


def test_the_same_seed_gives_the_same_result() -> None:
    a, b = (fitted("suboff_cfd_barehull", components="N", seed=3) for _ in range(2))
    assert model(a, "N").statements == model(b, "N").statements
    assert a.coefficients.covariance.tobytes() == b.coefficients.covariance.tobytes()


def test_covariance_is_that_of_the_intervals() -> None:
    result = fitted("suboff_roddy_2", components="Y N")
    u95 = np.array([c.u95 for c in result.coefficients.coefficients], dtype=float)
    assert np.diag(result.coefficients.covariance) == pytest.approx((u95 / 2) ** 2)
    m = result.models[0]
    assert result.coefficients.covariance[0, 1] == pytest.approx(m.covariance[0, 1])


def test_without_intercept_there_is_no_constant() -> None:
    m = model(fitted("suboff_roddy_2", components="Y", intercepts="no"), "Y")
    assert Term() not in m.terms


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"components": "Q"}, "some of X, Y, Z"),
        ({"variables": "v,slip"}, '"slip"'),
        ({"folds": 20}, "or more for each of 20 folds"),
        ({"optimizer": "stlq"}, "Did you mean stlsq"),
    ],
)
def test_wrong_input_is_one_clear_error(options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        fitted("suboff_cfd_barehull", **options)
