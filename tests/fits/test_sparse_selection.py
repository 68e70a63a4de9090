"""Selection by arrays: the library, scaling, twins, the criterion, and folds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.fits.statistics.cross_validation import (
    constrained_space,
    one_standard_error,
    predict_left_out,
    shuffled_folds,
    thirds,
)
from coeflab.fits.statistics.sparse_selection import library, refine, scaled, select, twins
from coeflab.law.terms import design


def thresholded(matrix: np.ndarray, y: np.ndarray, threshold: float) -> np.ndarray:
    """Sequentially thresholded least squares in six lines, independent of pysindy."""
    keep = np.ones(matrix.shape[1], dtype=bool)
    b = np.zeros(matrix.shape[1])
    for _ in range(10):
        b[:] = 0.0
        b[keep] = np.linalg.lstsq(matrix[:, keep], y, rcond=None)[0]
        keep = np.abs(b) > threshold
    return np.where(keep, b, 0.0)


def test_library_has_every_function_once() -> None:
    """sgn(x)^s |x|^n for two variables to degree 3: 4 of degree one, 8 of two, 12 of three."""
    terms = library(("v", "r"), 3, absolute=True)
    assert len(terms) == 24
    points = {"v": np.array([-0.7, 0.4, 0.9, -0.3]), "r": np.array([0.5, -0.8, 0.6, -0.9])}
    values = {tuple(np.round(t.evaluate(points), 12)) for t in terms}
    assert len(values) == 24
    assert {t.suffix for t in library(("v",), 3, absolute=True)} == {"v", "|v|", "vv", "v|v|", "vvv", "vv|v|"}
    assert {t.suffix for t in library(("v",), 3, absolute=False)} == {"v", "vv", "vvv"}


@given(st.integers(0, 1000), st.booleans())
def test_scaling_makes_everything_unit(seed: int, intercept: bool) -> None:
    rng = np.random.default_rng(seed)
    x = rng.standard_normal((30, 3)) * [1.0, 1e-6, 1e6] + [0.0, 1e-6, 3e6]
    matrix, y, size, height = scaled(x, 1e-5 * rng.standard_normal(30), intercept=intercept)
    assert np.sqrt(np.mean(matrix**2, axis=0)) == pytest.approx(1.0)
    assert np.sqrt(np.mean(y**2)) == pytest.approx(1.0)
    assert np.all(size > 0.0)
    assert height > 0.0


def test_columns_that_repeat_each_other_are_named_and_the_later_one_is_never_chosen() -> None:
    v = np.linspace(0.0, 0.3, 40)
    x = np.column_stack([v, v**2, v * np.abs(v), np.zeros(40), v**3])
    assert twins(x) == {2: 1}
    noise = 1e-5 * np.random.default_rng(1).standard_normal(40)
    chosen = select(x, -0.02 * v - 0.05 * v**2 + noise, thresholded, seed=1, resamples=0)
    assert chosen.support == (0, 1)


def test_the_same_seed_gives_the_same_answer_and_units_do_not_matter() -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(-1.0, 1.0, (80, 6))
    y = x[:, 1] - 0.4 * x[:, 4] + 0.1 * rng.standard_normal(80)
    first = select(x, y, thresholded, seed=5, resamples=40)
    assert first == select(x, y, thresholded, seed=5, resamples=40)
    other = select(x * [1e-4, 1e3, 1.0, 10.0, 1e-6, 1e5], 1e-5 * y, thresholded, seed=5, resamples=40)
    assert other.support == first.support == (1, 4)
    assert other.frequency == first.frequency
    assert first.frequency[1] == 1.0
    assert min(first.frequency) < 0.5


def test_noise_alone_rarely_gives_a_term() -> None:
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(200):
        x, y = rng.standard_normal((60, 10)), rng.standard_normal(60)
        matrix, unit, _, _ = scaled(x, y, intercept=True)
        found += bool(refine(matrix, unit, [], known=1)[0])
    assert found <= 10


def test_refinement_finds_the_best_of_all_subsets() -> None:
    """Against an exhaustive search over 2^8 supports."""
    rng = np.random.default_rng(2)
    for _ in range(10):
        x = rng.uniform(-1.0, 1.0, (50, 1)) ** np.arange(1, 9)
        matrix, y, _, _ = scaled(x, x[:, 0] - 0.5 * x[:, 2] + 0.02 * rng.standard_normal(50), intercept=False)

        def cost(mask: int, matrix: np.ndarray = matrix, y: np.ndarray = y) -> float:
            columns = [j for j in range(8) if mask >> j & 1]
            left = y - (matrix[:, columns] @ np.linalg.lstsq(matrix[:, columns], y, rcond=None)[0] if columns else 0.0)
            return float(50 * np.log(left @ left / 50) + len(columns) * (np.log(50) + 2 * np.log(8)))

        best = min(range(256), key=cost)
        found, lead = refine(matrix, y, [])
        assert cost(sum(1 << j for j in found)) == pytest.approx(cost(best), abs=1e-6)
        assert lead >= 0.0


def test_a_response_without_variation_or_a_library_without_motion_chooses_nothing() -> None:
    x = np.random.default_rng(0).standard_normal((20, 2))
    assert select(x, np.full(20, 3.0), thresholded, seed=1).support == ()
    assert select(np.zeros((20, 2)), x[:, 0], thresholded, seed=1).support == ()


def test_thirds_walk_along_the_sorted_rows() -> None:
    fold = thirds([np.array([3.0, 1.0, 2.0, 5.0, 4.0, 6.0])])
    assert fold.tolist() == [2, 0, 1, 1, 0, 2]
    assert sorted(np.bincount(shuffled_folds(11, 3, 1))) == [3, 4, 4]
    assert np.array_equal(shuffled_folds(11, 3, 1), shuffled_folds(11, 3, 1))


def test_left_out_predictions_are_those_of_separate_fits() -> None:
    rng = np.random.default_rng(4)
    x = np.column_stack([np.ones(20), rng.standard_normal((20, 2))])
    y, fold = rng.standard_normal(20), np.arange(20) % 4
    predicted = predict_left_out(x, y, fold)
    for k in range(4):
        b = np.linalg.lstsq(x[fold != k], y[fold != k], rcond=None)[0]
        assert predicted[fold == k] == pytest.approx(x[fold == k] @ b, abs=1e-12)
    tied = predict_left_out(x, y, fold, (np.array([[0.0, 1.0, -2.0]]), np.array([0.3])))
    b2 = np.linalg.lstsq(
        np.column_stack([x[:, 0], 2 * x[:, 1] + x[:, 2]])[fold != 0], (y - 0.3 * x[:, 1])[fold != 0], rcond=None
    )[0]
    assert tied[fold == 0] == pytest.approx(x[fold == 0] @ [b2[0], 2 * b2[1] + 0.3, b2[1]], abs=1e-12)


def test_rows_that_the_others_do_not_determine_get_no_prediction() -> None:
    x = np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.0, 1.0]])
    assert np.isnan(predict_left_out(x, x[:, 0], np.array([0, 1, 2, 3]))).tolist() == [False, False, False, True]


def test_constraints_that_contradict_each_other_are_refused() -> None:
    c = np.array([[1.0, 1.0], [2.0, 2.0]])
    with pytest.raises(ValueError, match="cannot hold"):
        constrained_space((c, np.array([1.0, 1.0])), 2)
    start, free = constrained_space((c, np.array([1.0, 2.0])), 2)
    assert c @ start == pytest.approx([1.0, 2.0])
    assert c @ free == pytest.approx(0.0, abs=1e-12)


def test_one_standard_error_takes_the_sparsest_that_is_as_good() -> None:
    errors = np.array([[1.0, 1.2, 0.8], [0.9, 1.1, 1.0], [1.05, 1.0, 1.05], [3.0, 3.0, 3.0]])
    assert one_standard_error(errors) == 2


def test_design_of_the_library_is_what_the_terms_say() -> None:
    terms = library(("v", "r"), 2, absolute=True)
    columns = {"v": np.array([-2.0]), "r": np.array([3.0])}
    values = dict(zip([t.suffix for t in terms], design(terms, columns)[0], strict=True))
    assert (values["v|v|"], values["|v|r"], values["v|r|"], values["vr"], values["vv"]) == (-4.0, 6.0, -6.0, -6.0, 4.0)
