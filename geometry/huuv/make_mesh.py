"""Make geometry/huuv_mesh/huuv.stl: a vehicle arranged like Fig. 7 of the HUUV paper; every dimension is synthetic.

A hull with rounded nose and tail, a domed mast and two elevators of finite thickness, fused by a boolean union, in
millimetres, x forward, y port, z up. Run: python geometry/huuv/make_mesh.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from manifold3d import CrossSection, Manifold

LENGTH, RADIUS, NOSE, TAIL = 1200.0, 70.0, 90.0, 150.0
MAST_X, MAST_RADIUS, MAST_TOP = 100.0, 20.0, 370.0
CHORD, SPAN, THICKNESS, ELEVATOR_X = 120.0, 240.0, 10.0, -500.0
INSIDE = 30.0


def hull() -> Manifold:
    """Cylinder with half ellipsoids at both ends, along x, its middle at the origin."""
    angle = np.linspace(0.0, np.pi / 2.0, 13)
    nose = [(RADIUS * np.cos(a), LENGTH / 2.0 - NOSE + NOSE * np.sin(a)) for a in angle]
    tail = [(RADIUS * np.cos(a), -LENGTH / 2.0 + TAIL - TAIL * np.sin(a)) for a in angle[::-1]]
    return Manifold.revolve(CrossSection([np.array(tail + nose)]), 64).rotate((0.0, 90.0, 0.0))


def mast() -> Manifold:
    """Upright cylinder with a half sphere on top, from inside the hull."""
    angle = np.linspace(0.0, np.pi / 2.0, 9)
    dome = [(MAST_RADIUS * np.cos(a), MAST_TOP - MAST_RADIUS + MAST_RADIUS * np.sin(a)) for a in angle]
    outline = [(0.0, INSIDE), (MAST_RADIUS, INSIDE), *dome]
    return Manifold.revolve(CrossSection([np.array(outline)]), 40).translate((MAST_X, 0.0, 0.0))


def elevator(side: float) -> Manifold:
    """Plate with elliptic section edges, from inside the hull to its tip; +1 is port."""
    angle = 2.0 * np.pi * np.arange(48) / 48.0
    section = np.column_stack([np.cos(angle), np.sin(angle)])
    outline = np.sign(section) * np.abs(section) ** 0.5 * [CHORD / 2.0, THICKNESS / 2.0]
    long = RADIUS + SPAN - INSIDE
    made = Manifold.extrude(CrossSection([outline]), long).rotate((-90.0 * side, 0.0, 0.0))
    return made.translate((ELEVATOR_X, side * INSIDE, 0.0))


def stl(of: Manifold) -> bytes:
    """Binary STL, normals left to the reader."""
    mesh = of.to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    record = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    record["corners"] = corners
    header = b"coeflab: synthetic vehicle like the HUUV, mm, x forward, y port, z up".ljust(80)
    return header + np.uint32(len(corners)).tobytes() + record.tobytes()


if __name__ == "__main__":
    fused = hull() + mast() + elevator(1.0) + elevator(-1.0)
    out = Path(__file__).resolve().parents[1] / "huuv_mesh" / "huuv.stl"
    out.write_bytes(stl(fused))
