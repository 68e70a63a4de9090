"""Added mass of boxes and flat-ended cylinders by the panel method: the tables of coeflab/bodies/closed_forms.py.

Usage: python panel_tables.py [PANELS]
Prints Python literals. Three families of panels each, extrapolated at the order 4/3 of right-angled edges; the last line of each
says how far a quarter of the panels would have been off.
"""

from __future__ import annotations

import sys
from itertools import pairwise

import numpy as np

from coeflab.bodies.closed_forms.parts import BOX_RATIOS, CYLINDER_RATIOS
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.panel_solver.solve import panel_added_mass
from coeflab.bodies.shape import Box, Cylinder, Form, Part, Parts
from coeflab.core.machine import compiles

ORDER = 4.0 / 3.0


def limit(form: Form, panels: int) -> tuple[np.ndarray, np.ndarray]:
    """Diagonal of the matrix at vanishing panel size, density 1, and what the two coarser families alone would have given."""
    found, counts = [], []
    for share in (1, 4, 16):
        mesh = meshed(Parts((Part("p", form, np.zeros(3), np.eye(3)),)), panels // share)
        corners = mesh.vertices[mesh.faces]
        found.append(np.diag(panel_added_mass(corners, np.zeros(3), compiles()).matrix))
        counts.append(len(corners))
    steps = [
        a + (a - b) / ((m / n) ** (ORDER / 2.0) - 1.0) for (a, b), (m, n) in zip(pairwise(found), pairwise(counts))
    ]
    return steps[0], steps[1]


def boxes(panels: int) -> float:
    worst = 0.0
    for long in BOX_RATIOS:
        for middle in BOX_RATIOS:
            fine, coarse = limit(Box(long * middle, middle, 1.0), panels)
            worst = max(worst, float(np.max(np.abs(coarse / fine - 1.0))))
            print(f"    {long:g}, {middle:g}: ({', '.join(f'{v:.6g}' for v in fine)})", flush=True)
    return worst


def cylinders(panels: int) -> float:
    worst = 0.0
    for ratio in CYLINDER_RATIOS:
        fine, coarse = limit(Cylinder(0.5, ratio), panels)
        worst = max(worst, float(np.max(np.abs(coarse / fine - 1.0)[[0, 1, 4]])))
        print(f"    {ratio:g}: ({', '.join(f'{fine[k]:.6g}' for k in (0, 1, 4))})", flush=True)
    return worst


def main() -> None:
    panels = int(sys.argv[1]) if len(sys.argv) > 1 else 6_000
    print("# cylinder of diameter 1: length: axial, lateral, turning")
    print(f"# a quarter of the panels: within {cylinders(panels):.2%}")
    print(
        "# box: longest over middle, middle over shortest: along and about the longest, the middle and the shortest side"
    )
    print(f"# a quarter of the panels: within {boxes(panels):.2%}")


if __name__ == "__main__":
    main()
