"""Drag, side force and lift against rotations composed from their definition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.law.transforms import body_forces, incidence, wind_forces

alphas = st.floats(-np.pi, np.pi)
betas = st.floats(-np.pi / 2, np.pi / 2)
forces = st.tuples(*[st.floats(-100.0, 100.0)] * 3)


def one(*values: float) -> tuple[np.ndarray, ...]:
    return tuple(np.array([v]) for v in values)


def about(axis: int, angle: float) -> np.ndarray:
    """Rotation matrix about a coordinate axis, right-handed."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(3)
    out[i, i] = out[j, j] = np.cos(angle)
    out[j, i], out[i, j] = np.sin(angle), -np.sin(angle)
    return out


@given(alphas, betas, forces)
def test_forces_come_back(alpha, beta, force):
    back = body_forces(*one(alpha, beta), *wind_forces(*one(alpha, beta, *force)))
    np.testing.assert_allclose(np.ravel(back), force, atol=1e-12 * max(1.0, *map(abs, force)))


@given(alphas, betas, forces)
def test_against_a_rotation_composed_from_its_definition(alpha, beta, force):
    """Fossen (2011), section 2.4: body from flow axes is Ry(-alpha) Rz(beta); D is against x, L against z."""
    body_from_flow = about(1, -alpha) @ about(2, beta)
    along = body_from_flow.T @ np.array(force)
    found = np.ravel(wind_forces(*one(alpha, beta, *force)))
    np.testing.assert_allclose(found, [-along[0], along[1], -along[2]], atol=1e-11)


@given(alphas, betas)
def test_the_velocity_lies_on_the_flow_axis(alpha, beta):
    velocity = about(1, -alpha) @ about(2, beta) @ np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(
        velocity, [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)], atol=1e-15
    )
    drag, side, lift = wind_forces(*one(alpha, beta), *(-velocity[:, None]))
    np.testing.assert_allclose([drag[0], side[0], lift[0]], [1.0, 0.0, 0.0], atol=1e-15)


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(0.1, 20.0))
def test_incidence_of_a_velocity(alpha, beta, speed):
    u, v, w = speed * np.cos(alpha) * np.cos(beta), speed * np.sin(beta), speed * np.sin(alpha) * np.cos(beta)
    found = incidence(*one(u, v, w))
    np.testing.assert_allclose(np.ravel(found), [alpha, beta], atol=1e-7)


@pytest.mark.parametrize(
    ("alpha", "beta", "force", "sign"),
    [
        (0.0, 0.0, (-3.0, 0.0, 0.0), (1, 0, 0)),
        (0.0, 0.0, (0.0, 2.0, 0.0), (0, 1, 0)),
        (0.0, 0.0, (0.0, 0.0, -2.0), (0, 0, 1)),
        (np.pi / 2, 0.0, (0.0, 0.0, -2.0), (1, 0, 0)),
        (0.0, np.pi / 2, (0.0, -2.0, 0.0), (1, 0, 0)),
        (np.pi, 0.0, (3.0, 0.0, 0.0), (1, 0, 0)),
    ],
)
def test_signs_that_can_be_seen_without_a_matrix(alpha, beta, force, sign):
    """Backward force ahead, upward force in heave, port force in sway: drag is above zero when the fluid brakes."""
    found = np.ravel(wind_forces(*one(alpha, beta, *force)))
    assert [int(np.sign(np.round(f, 12))) for f in found] == list(sign)


def test_at_rest_there_is_no_incidence():
    assert np.ravel(incidence(*one(0.0, 0.0, 0.0))).tolist() == [0.0, 0.0]
