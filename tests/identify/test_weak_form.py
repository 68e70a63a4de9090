"""Window averages against closed forms, quadrature and pysindy's weak library."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from coeflab.identify.windows import FEWEST, Windows, refined, windows


def uneven(seed: int, n: int = 200, end: float = 10.0) -> np.ndarray:
    steps = np.random.default_rng(seed).uniform(0.2, 1.8, n)
    return np.concatenate([[0.0], np.cumsum(steps) / np.sum(steps) * end])


@given(seed=st.integers(0, 1000), level=st.floats(-1e3, 1e3), slope=st.floats(-1e3, 1e3))
def test_straight_lines_are_exact_whatever_the_steps(seed: int, level: float, slope: float) -> None:
    time = uneven(seed)
    w = windows(time, 1.3, 0.7)
    line = (level + slope * time)[:, None]
    kept, moved = w.averages(line, line)
    size = abs(level) + 10.0 * abs(slope) + 1e-30
    assert np.max(np.abs(kept[:, 0] - level - slope * w.centres)) <= 1e-11 * size
    assert np.max(np.abs(moved[:, 0] - slope)) <= 1e-11 * size


def test_a_curve_against_quadrature() -> None:
    time, half, centre = uneven(3, 4000), 1.3, 4.1
    (kept,), (moved,) = Windows(time, np.array([centre]), half).averages(np.sin(time)[:, None], np.sin(time)[:, None])

    def test_function(t: float) -> float:
        return (1.0 - ((t - centre) / half) ** 2) ** 4

    ends = (centre - half, centre + half)
    whole = quad(test_function, *ends)[0]
    assert kept[0] == pytest.approx(quad(lambda t: test_function(t) * np.sin(t), *ends)[0] / whole, rel=1e-5)
    assert moved[0] == pytest.approx(quad(lambda t: test_function(t) * np.cos(t), *ends)[0] / whole, rel=1e-5)


def test_the_rate_of_noise_is_far_below_that_of_differences() -> None:
    time = np.linspace(0.0, 60.0, 3001)
    noise = np.random.default_rng(1).standard_normal((3001, 1))
    _, moved = windows(time, 1.0, 0.5).averages(noise, noise)
    assert np.std(moved) < 0.02 * np.std(np.gradient(noise[:, 0], time))


def test_splines_between_few_rows_take_the_cut_corners_out() -> None:
    """cos averaged over a window is cos at its middle times a factor that quadrature gives."""
    time = np.linspace(0.0, 12.0, 61)
    curve = np.cos(2.0 * time)[:, None]
    factor = quad(lambda x: (1.0 - x * x) ** 4 * np.cos(2.0 * x), -1.0, 1.0)[0] / (256.0 / 315.0)
    middles = np.array([5.03, 6.4])
    coarse = Windows(time, middles, 1.0).averages(curve, curve)[0][:, 0]
    fine_time, fine_curve = refined(time, curve, 1.0)
    fine = Windows(fine_time, middles, 1.0).averages(fine_curve, fine_curve)[0][:, 0]
    true = factor * np.cos(2.0 * middles)
    assert np.max(np.abs(fine / true - 1.0)) < 3e-4
    assert np.min(np.abs(coarse / true - 1.0)) > 3e-3
    assert refined(np.linspace(0.0, 12.0, 6001), np.zeros((6001, 1)), 1.0)[0].shape == (6001,)


def test_windows_over_a_gap_or_with_few_rows_are_left_out() -> None:
    time = np.concatenate([np.linspace(0.0, 5.0, 101), np.linspace(6.0, 11.0, 101)])
    w = windows(time, 0.5, 0.25)
    assert len(w.centres) > 20
    assert not np.any((w.centres + 0.5 > 5.0) & (w.centres - 0.5 < 6.0))
    assert len(windows(np.linspace(0.0, 10.0, 10 * (FEWEST - 3)), 0.5, 0.25).centres) == 0
    assert len(windows(np.linspace(0.0, 1.0, 100), 0.6, 0.25).centres) == 0


@pytest.mark.filterwarnings("ignore:.*axes labeled for array.*")
def test_pysindy_gives_the_same_averages() -> None:
    """Its windows lie anywhere, so they are read back from the rows that it took."""
    import pysindy

    time = np.linspace(0.0, 10.0, 501)
    x = (np.sin(1.3 * time) + 0.2 * time)[:, None]
    library = pysindy.WeakPDELibrary(
        pysindy.PolynomialLibrary(degree=1, include_bias=True), spatiotemporal_grid=time, K=6, p=4, H_xt=[1.0]
    )
    library.fit(pysindy.AxesArray(x, {"ax_time": 0, "ax_coord": 1}))
    features = np.asarray(library.transform(pysindy.AxesArray(x, {"ax_time": 0, "ax_coord": 1})))
    rates = np.asarray(library.convert_u_dot_integral(pysindy.AxesArray(x, {"ax_time": 0, "ax_coord": 1})))
    for k, (rows,) in enumerate(library.inds_k):
        first, last = time[rows[0]], time[rows[-1]]
        (kept,), (moved,) = Windows(time, np.array([(first + last) / 2.0]), (last - first) / 2.0).averages(x, x)
        assert features[k, 1] / features[k, 0] == pytest.approx(kept[0], rel=1e-9)
        assert rates[k, 0] / features[k, 0] == pytest.approx(moved[0], rel=1e-9)
