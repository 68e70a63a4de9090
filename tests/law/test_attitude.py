"""Attitudes of parts: there and back, tidy forms, right angles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.law.transforms import about_axis, angles, relabelled, rotation, snapped

ANGLE = st.floats(-np.pi, np.pi)


@given(ANGLE, st.floats(-np.pi / 2, np.pi / 2), ANGLE)
def test_angles_there_and_back(roll: float, pitch: float, yaw: float) -> None:
    turn = rotation(roll, pitch, yaw)
    again = angles(turn)
    assert rotation(*again) == pytest.approx(turn, abs=2e-8)
    assert abs(again[1]) <= np.pi / 2


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_upright_has_no_roll(pitch: float) -> None:
    turn = rotation(0.4, pitch, 1.1)
    roll, _, yaw = angles(turn)
    assert roll == 0.0
    assert rotation(0.0, pitch, yaw) == pytest.approx(turn, abs=1e-12)


@given(ANGLE, ANGLE, ANGLE)
def test_relabelling_is_proper_and_keeps_the_axes(roll: float, pitch: float, yaw: float) -> None:
    turn = rotation(roll, pitch, yaw)
    for normal in (False, True):
        made = relabelled(turn, normal)
        assert np.linalg.det(made) == pytest.approx(1.0)
        shared = np.abs(turn.T @ made)
        assert np.sort(shared.ravel())[-3:] == pytest.approx(1.0)
        assert np.trace(made) >= np.trace(turn) - 1e-9
    assert abs(made[:, 2] @ turn[:, 2]) == pytest.approx(1.0)


def test_relabelling_undoes_a_permutation() -> None:
    assert relabelled(np.eye(3)[:, [1, 2, 0]]) == pytest.approx(np.eye(3))
    assert relabelled(-np.eye(3)) == pytest.approx(np.eye(3))


@pytest.mark.parametrize(
    ("axis", "expected"),
    [
        ([-1.0, 0, 0], (0.0, 0.0, 0.0)),
        ([0, -1.0, 0], (0.0, 0.0, 90.0)),
        ([0, 0, 1.0], (0.0, 90.0, 0.0)),
        ([0, 0, -1.0], (0.0, 90.0, 0.0)),
        ([1.0, 1.0, 0], (0.0, 0.0, 45.0)),
        ([1.0, 0, -0.5], (0.0, np.degrees(np.arctan(0.5)), 0.0)),
    ],
)
def test_round_parts_are_not_rolled(axis: list[float], expected: tuple[float, ...]) -> None:
    turn = about_axis(np.array(axis))
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert np.degrees(angles(turn)) == pytest.approx(expected, abs=1e-9)


def test_nearly_upright_keeps_its_side() -> None:
    turn = about_axis(np.array([1e-5, 1e-5, -1.0]))
    assert turn[:, 1] == pytest.approx([0, 1, 0], abs=1e-4)


def test_snapping() -> None:
    near = np.radians([0.9, -1.2, 91.0])
    assert snapped(rotation(*near), np.radians(2.0)) == pytest.approx(rotation(0.0, 0.0, np.pi / 2), abs=1e-12)
    far = rotation(*np.radians([3.0, 40.0, -50.0]))
    assert snapped(far, np.radians(2.0)) == pytest.approx(far, abs=1e-12)
    upright = snapped(rotation(*np.radians([30.0, 89.5, 30.5])), np.radians(2.0))
    assert upright == pytest.approx(rotation(0.0, np.pi / 2, 0.0), abs=1e-12)
