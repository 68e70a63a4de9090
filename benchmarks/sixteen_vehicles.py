"""Recommended added mass of sixteen synthetic vehicles against more panels on the same mesh, motion by motion.

Usage: python benchmarks/sixteen_vehicles.py [PANELS] [NAME ...]
PANELS are 16,000 unless given. Recommended is what `coeflab simplify` says at 6,000 panels: the parts, whose stated error is
their difference from the mesh and that mesh's own error estimate, or the mesh with its error estimate. Inside: the largest
difference of a motion that moves water lies within the stated error and the finer mesh's own. The vehicles are those of
tests/bodies.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np

from coeflab.bodies.added_mass.panel import added_mass
from coeflab.bodies.added_masses import against_mesh
from coeflab.bodies.simplify.simplify import simplify
from tests.bodies.test_twelve import VEHICLES, body

DENSITY, COARSE = 1000.0, 6_000
MOTIONS = "uvwpqr"


def row(name: str, panels: int) -> tuple[str, bool]:
    """The line of one vehicle, and whether every motion is inside."""
    given = body(name)
    found = against_mesh(simplify(given), panels=COARSE)
    fine = added_mass(given, DENSITY, {"panels": panels})
    if found.compared is None:
        chosen, kind = added_mass(given, DENSITY, {"panels": COARSE}), "mesh"
        stated = np.diag(chosen.error) if chosen.error is not None else np.full(6, np.nan)
    else:
        parts, mesh = found.compared
        own = np.diag(mesh.error) if mesh.error is not None else np.full(6, np.nan)
        use_mesh = found.advice.startswith("USE THE MESH")
        chosen, kind = (mesh, "mesh") if use_mesh else (parts, "parts")
        stated = own if use_mesh else own + np.abs(np.diag(parts.matrix) - np.diag(mesh.matrix))
    scale = DENSITY / float(chosen.density if np.isfinite(chosen.density) else DENSITY)
    value, true = scale * np.diag(chosen.matrix), np.diag(fine.matrix)
    limit = scale * stated + (np.diag(fine.error) if fine.error is not None else 0.0)
    moves = true > 1e-3 * np.array([true[:3].max()] * 3 + [true[3:].max()] * 3)
    off = np.where(moves, (value - true) / np.where(moves, true, 1.0), 0.0)
    share = np.where(moves, limit / np.where(moves, true, 1.0), np.inf)
    worst = int(np.argmax(np.where(moves, np.abs(off) / share, -1.0)))
    inside = bool(np.all(np.abs(off) <= share))
    return (
        f"{name:18s}{kind:7s}{MOTIONS[worst]:3s}{100.0 * off[worst]:+8.2f} %{100.0 * share[worst]:8.2f} %  "
        f"{'inside' if inside else 'OUTSIDE'}",
        inside,
    )


def main() -> None:
    panels = int(sys.argv[1]) if len(sys.argv) > 1 else 16_000
    names = sys.argv[2:] or list(VEHICLES)
    print(f"{'vehicle':18s}{'use':7s}{'at':3s}{'off':>10s}{'stated':>10s}")
    count = 0
    for name in names:
        text, inside = row(name, panels)
        count += inside
        print(text, flush=True)
    print(f"{count} of {len(names)} inside in every motion.")


if __name__ == "__main__":
    main()
