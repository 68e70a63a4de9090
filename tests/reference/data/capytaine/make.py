"""Make capytaine.json beside this file: two bodies, their meshes and capytaine's added mass by both formulations.

Usage: python make.py PYTHON, with an interpreter that has capytaine 3.0; from the checkout.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from coeflab.bodies.mesh.structured_surface import box_surface

HERE = Path(__file__).parent
PEER = HERE.parents[3] / "benchmarks" / "capytaine_added_mass.py"


def bodies() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """A box that is blown up to an ellipsoid 3 : 1 : 0.6, and a box 2 : 1 : 0.5; turned, and off the origin."""
    turn = np.linalg.qr(np.array([[1.0, 0.4, -0.2], [0.1, 1.0, 0.3], [0.2, -0.1, 1.0]]))[0]
    turn *= np.linalg.det(turn)
    cube, faces = box_surface(np.array([2.0, 2.0, 2.0]), 600)
    ball = np.tan(np.pi / 4.0 * cube)
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    box, sides = box_surface(np.array([2.0, 1.0, 0.5]), 600)
    away = np.array([0.5, -0.3, 0.2])
    return {
        "ellipsoid": (np.round((ball * [3.0, 1.0, 0.6]) @ turn.T + away, 6), faces),
        "box": (np.round(box @ turn.T + away, 6), sides),
    }


def main() -> None:
    out = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (vertices, faces) in bodies().items():
            path = str(Path(folder) / "mesh.npz")
            np.savez(path, vertices=vertices, faces=faces)
            out[name] = {"vertices": vertices.tolist(), "faces": faces.tolist()}
            for method in ("direct", "indirect"):
                command = (sys.argv[1], str(PEER), path, method)
                done = subprocess.run(command, check=True, capture_output=True, text=True)
                found = json.loads(done.stdout.splitlines()[-1])
                out["capytaine"], out[name][method] = found["capytaine"], np.round(found["matrix"], 9).tolist()
    (HERE / "capytaine.json").write_text(json.dumps(out) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
