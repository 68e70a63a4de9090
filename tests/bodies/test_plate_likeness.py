"""Meshes that are like one plate, and those that are not."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from coeflab.bodies.added_mass.primitives import like_one_plate
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Plate
from coeflab.law.transforms import rotation


def mesh(made: trimesh.Trimesh, turn: np.ndarray | None = None) -> TriangleMesh:
    return TriangleMesh(np.asarray(made.vertices) @ (np.eye(3) if turn is None else turn.T), np.asarray(made.faces))


def test_a_board_in_any_pose() -> None:
    board = trimesh.creation.box(extents=(1.0, 0.5, 0.02))
    board.apply_translation([2.0, 1.0, -1.0])
    turn = rotation(np.radians(20.0), np.radians(-35.0), np.radians(10.0))
    for pose in (np.eye(3), turn):
        found = like_one_plate(mesh(board, pose))
        assert isinstance(found.form, Plate)
        assert sorted((found.form.chord, found.form.span)) == pytest.approx([0.5, 1.0], rel=1e-4)
        assert abs(found.rotation[:, 2] @ pose[:, 2]) == pytest.approx(1.0, rel=1e-6)
        assert found.centre == pytest.approx(pose @ np.array([2.0, 1.0, -1.0]), rel=1e-4)


def test_other_bodies_are_none() -> None:
    board = trimesh.creation.box(extents=(1.0, 0.5, 0.02))
    second = board.copy()
    second.apply_translation([0.0, 0.0, 0.5])
    beside = board.copy()
    beside.apply_translation([0.0, 0.6, 0.0])
    ring = trimesh.creation.annulus(0.45, 0.5, 0.02)
    for made in (trimesh.creation.box(), board + second, board + beside, ring, trimesh.creation.icosphere(2)):
        assert like_one_plate(mesh(made)) is None
