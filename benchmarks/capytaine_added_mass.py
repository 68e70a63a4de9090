"""Added mass of one mesh by capytaine, run by an interpreter that has it; the other side of added_mass_panels.py and panel_capytaine.py.

Usage: python capytaine_added_mass.py MESH.npz direct|indirect [DEPTH]
Prints one line of JSON: the 6 x 6 matrix about the origin at density 1, seconds of building and solving (after a small
body has paid for what capytaine tabulates at first use), seconds of the processor over all threads, and the peak memory of
the process in bytes. With DEPTH, m, the origin lies so far below a free surface at infinite frequency.
"""

from __future__ import annotations

import json
import logging
import resource
import sys
import time

import capytaine
import numpy as np

DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")


def added_mass(vertices: np.ndarray, faces: np.ndarray, method: str, depth: float = np.inf) -> np.ndarray:
    surface, down = (np.inf, 0.0) if np.isinf(depth) else (0.0, depth)
    quads = np.hstack([faces, faces[:, :1]])
    body = capytaine.FloatingBody(
        mesh=capytaine.Mesh(vertices=vertices - np.array([0.0, 0.0, down]), faces=quads),
        dofs=capytaine.rigid_body_dofs(rotation_center=(0, 0, -down)),
    )
    solver = capytaine.BEMSolver(method=method)
    problems = [
        capytaine.RadiationProblem(body=body, radiating_dof=dof, free_surface=surface, omega=np.inf, rho=1.0)
        for dof in DOFS
    ]
    results = [solver.solve(problem) for problem in problems]
    return np.array([[result.added_masses[dof] for result in results] for dof in DOFS])


def main() -> None:
    logging.disable(logging.WARNING)
    mesh, method = np.load(sys.argv[1]), sys.argv[2]
    depth = float(sys.argv[3]) if len(sys.argv) > 3 else np.inf
    corners = np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [-1.0, -1.0, -1.0]])
    added_mass(corners, np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]]), method, 2.0 * depth)
    start, before = time.perf_counter(), time.process_time()
    matrix = added_mass(mesh["vertices"], mesh["faces"], method, depth)
    seconds, processor = time.perf_counter() - start, time.process_time() - before
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    version = capytaine.__version__
    print(
        json.dumps(
            {"capytaine": version, "matrix": matrix.tolist(), "seconds": seconds, "processor": processor, "peak": peak}
        )
    )


if __name__ == "__main__":
    main()
