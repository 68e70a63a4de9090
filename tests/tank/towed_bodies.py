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


def _fin(number: int) -> str:
    return f"""
[[fin]]
name = "f{number}"
section = "NACA 0015"
roll = "{90 * number - 45} deg"
root = 0.05
tip = 0.30
root_chord = 0.24
tip_chord = 0.18
trailing_edge = -0.92
"""


# A spheroid of 4:1 with four fins that lie in no mirror plane.
X_FINS = """
[body]
name = "x_fins"
reader = "finned"
datum = "centre"
datum_note = "of the spheroid"
reference_point = [0.0, 0.0, 0.0]
[source]
citation = "synthetic"
kind = "synthetic"
[prime]
length = 2.0
length_name = "length"
[hull]
kind = "spheroid"
length = 2.0
diameter = 0.5
""" + "".join(map(_fin, (1, 2, 3, 4)))
