"""Bodies without a surface worth a mesh, for what only their ends and mirrors decide."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.tank.towed_body import TowedBody

BODY_FILE = shipped("geometry") / "suboff_bare_hull" / "body.toml"
LENGTH = 4.26086
Y, Z, FOURFOLD = "y", "z", "4"


def with_mirrors(mirrors: str = "", *, nose: float = 2.013, stern: float = -2.343) -> TowedBody:
    """A tetrahedron from nose to stern that says to have mirrors: any of "yz4"."""
    vertices = np.array([[nose, 0.0, 0.0], [stern, 0.2, 0.0], [stern, -0.1, 0.2], [stern, -0.1, -0.2]])
    faces = np.array([[0, 1, 3], [0, 2, 1], [0, 3, 2], [1, 2, 3]])
    return TowedBody(
        read_body(BODY_FILE), vertices, faces, ("hull",), np.zeros(4, dtype=np.int64), {"hull": nose - stern},
        (False, Y in mirrors, Z in mirrors), FOURFOLD in mirrors,
    )  # fmt: skip
