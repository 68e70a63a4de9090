"""Integrals of closed meshes against boxes and tetrahedra in any pose."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.bodies.mesh.integrals import mesh_integrals

CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
CUBE_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7],
     [1, 7, 3]]
)  # fmt: skip
CORNER = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
CORNER_FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])

sizes = st.tuples(*[st.floats(0.1, 10.0)] * 3).map(np.array)
shifts = st.tuples(*[st.floats(-20.0, 20.0)] * 3).map(np.array)


@st.composite
def turns(draw: st.DrawFn) -> np.ndarray:
    """A rotation from a unit quaternion."""
    q = np.array(draw(st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda v: np.linalg.norm(v) > 0.1)))
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@given(size=sizes, turn=turns(), shift=shifts)
@settings(max_examples=60, deadline=None)
def test_boxes_in_any_pose(size: np.ndarray, turn: np.ndarray, shift: np.ndarray) -> None:
    found = mesh_integrals((CUBE * size) @ turn.T + shift, CUBE_FACES)
    volume = size.prod()
    assert found.volume == pytest.approx(volume, rel=1e-10)
    assert found.centre == pytest.approx(shift, abs=1e-10)
    assert found.area == pytest.approx(2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]), rel=1e-10)
    second = turn @ np.diag(volume * size**2 / 12.0) @ turn.T
    assert found.second_moments == pytest.approx(second, abs=1e-9 * np.trace(second))
    faces = volume / size
    assert found.projected == pytest.approx(np.abs(turn) @ faces, rel=1e-10)


@given(size=sizes, turn=turns(), shift=shifts)
@settings(max_examples=60, deadline=None)
def test_tetrahedra_in_any_pose(size: np.ndarray, turn: np.ndarray, shift: np.ndarray) -> None:
    """A corner cut off by a plane: volume abc/6, centre at a quarter, second moments abc/60 (1 + delta) about the corner."""
    found = mesh_integrals((CORNER * size) @ turn.T + shift, CORNER_FACES)
    volume = size.prod() / 6.0
    assert found.volume == pytest.approx(volume, rel=1e-10)
    assert found.centre == pytest.approx(turn @ size / 4.0 + shift, abs=1e-9)
    own = size.prod() / 120.0 * np.outer(size, size) * (1.0 + np.eye(3)) - volume * np.outer(size, size) / 16.0
    assert found.second_moments == pytest.approx(turn @ own @ turn.T, abs=1e-8 * np.trace(own))


def test_inward_faces_enclose_a_negative_volume() -> None:
    assert mesh_integrals(CUBE, CUBE_FACES[:, ::-1]).volume == pytest.approx(-1.0)


def test_a_sheet_encloses_nothing() -> None:
    found = mesh_integrals(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 1]]))
    assert found.volume == 0.0
    assert np.isnan(found.centre).all()
    assert found.area == pytest.approx(1.0)
