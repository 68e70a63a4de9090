"""Our estimates and AeroSandbox's AeroBuildup on the same appended SUBOFF, beside Roddy's measurements.

Usage: python aerobuildup.py [PYTHON]
PYTHON is an interpreter with aerosandbox; made in a temporary directory if none. Both get the hull, sail and four planes of
AFF-8 by the same outline; the measured body also carries ring wing 1, which neither has here.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np  # noqa: E402

from coeflab.bodies.body import Body  # noqa: E402
from coeflab.bodies.readers import read_body  # noqa: E402
from coeflab.core.files import shipped  # noqa: E402
from coeflab.estimates import Water, estimated  # noqa: E402
from coeflab.law.scaling import Scaling  # noqa: E402

WATER = Water(998.0, 1.05e-6, 3.3439)
MEASURED = {"Yv": -0.027834, "Nv": -0.013648, "Yr": 0.005251, "Nr": -0.004444,
            "Zw": -0.013910, "Mw": 0.010324, "Zq": -0.007545, "Mq": -0.003702}  # fmt: skip

# Runs in the peer's interpreter: axes aft, starboard, up; moments about the reference point; slopes by central differences.
PEER = """
import json, sys  # noqa: E402
import aerosandbox as asb
import numpy as np
given = json.load(open(sys.argv[1]))
turn = np.array([-1.0, 1.0, -1.0])
hull = asb.Fuselage(name="hull", xsecs=[
    asb.FuselageXSec(xyz_c=[-x, 0.0, 0.0], radius=r) for x, r in zip(given["x"], given["radius"])])
wings = []
for f in given["foils"]:
    sections = [asb.WingXSec(xyz_le=(np.array(p) + np.array([0.25 * c, 0, 0])) * turn, chord=c, twist=0.0,
                             airfoil=asb.Airfoil("naca%04d" % round(100 * f["thickness"])))
                for p, c in ((f["root"], f["root_chord"]), (f["tip"], f["tip_chord"]))]
    wings.append(asb.Wing(name=f["name"], symmetric=False, xsecs=sections))
point = np.array(given["point"]) * turn
plane = asb.Airplane(name="suboff", xyz_ref=point, wings=wings, fuselages=[hull], s_ref=1.0, c_ref=1.0, b_ref=1.0)
air = asb.Atmosphere(altitude=0.0)
speed, density = 40.0, air.density()
def force(v=0.0, w=0.0, p=0.0, q=0.0, r=0.0):
    u = speed
    total = np.sqrt(u * u + v * v + w * w)
    op = asb.OperatingPoint(atmosphere=air, velocity=total, alpha=np.degrees(np.arctan2(w, u)),
                            beta=np.degrees(np.arcsin(v / total)), p=p, q=q, r=r)
    out = asb.AeroBuildup(airplane=plane, op_point=op, xyz_ref=point, include_wave_drag=False).run()
    values = [*out["F_b"], *out["M_b"]]
    return np.array([float(np.asarray(x).ravel()[0]) for x in values])
length = given["length"]
steps = {"v": 0.02 * speed, "w": 0.02 * speed, "q": 0.02 * speed / length, "r": 0.02 * speed / length}
out = {}
for m, h in steps.items():
    slope = (force(**{m: h}) - force(**{m: -h})) / (2 * h)
    for i, c in enumerate("XYZKMN"):
        powers = (2 if c in "XYZ" else 3) + (1 if m in "pqr" else 0)
        out[c + m] = slope[i] / (0.5 * density * speed * length ** powers)
print(json.dumps({"version": asb.__version__, **out}))
"""


def given(body: Body, scaling: Scaling) -> dict[str, object]:
    """The outline as the peer takes it."""
    seen = body.outline
    assert seen is not None
    hull = seen.hulls[0]
    at = np.unique(np.linspace(0, len(hull.x) - 1, 60).round().astype(int))
    foils = [
        {"name": f.name, "root": f.root.tolist(), "tip": f.tip.tolist(), "root_chord": f.root_chord, "tip_chord": f.tip_chord,
         "thickness": f.thickness} for f in seen.foils
    ]  # fmt: skip
    return {"x": hull.x[at].tolist(), "radius": (hull.breadth[at] / 2.0).tolist(), "foils": foils,
            "point": body.reference_point.tolist(), "length": scaling.length}  # fmt: skip


def peer(python: str, known: dict[str, object], folder: Path) -> dict[str, float]:
    """Derivatives by AeroBuildup."""
    (folder / "given.json").write_text(json.dumps(known))
    (folder / "peer.py").write_text(PEER)
    done = subprocess.run(
        [python, str(folder / "peer.py"), str(folder / "given.json")], capture_output=True, text=True, check=True
    )
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def interpreter(folder: Path) -> str:
    """A Python with aerosandbox in an environment of its own."""
    subprocess.run([sys.executable, "-m", "venv", str(folder / "venv")], check=True)
    python = folder / "venv" / "bin" / "python"
    subprocess.run([str(python), "-m", "pip", "install", "--quiet", "aerosandbox"], check=True)
    return str(python)


def main() -> None:
    for name in ("suboff_aff8", "suboff_bare_hull"):
        body = read_body(Path(shipped("geometry")) / name / "body.toml")
        assert body.scaling is not None
        ours = estimated(replace(body, reference_point=np.array([-2.01296, 0.0, 0.0])), WATER).coefficients
        with tempfile.TemporaryDirectory() as place:
            python = sys.argv[1] if len(sys.argv) > 1 else interpreter(Path(place))
            theirs = peer(python, given(body, body.scaling), Path(place))
        measured = (
            MEASURED if name == "suboff_aff8" else {"Yv": -0.005948, "Nv": -0.012795, "Yr": 0.001811, "Nr": -0.001597}
        )
        print(f"{name}: estimates, AeroBuildup {theirs['version']}, Roddy")
        print(f"  {'':<5}{'coeflab':>10}{'AeroBuildup':>13}{'measured':>10}")
        for s, m in measured.items():
            print(f"  {s + chr(39):<5}{ours[s].value:>10.4f}{theirs[s]:>13.4f}{m:>10.4f}")
        for who, of in (
            ("coeflab", [float(ours[s].value or 0.0) for s in measured]),
            ("AeroBuildup", [theirs[s] for s in measured]),
        ):
            errors = [abs(a / m - 1.0) for a, m in zip(of, measured.values(), strict=True)]
            print(f"  {who}: median |error| {100 * np.median(errors):.0f} %, largest {100 * max(errors):.0f} %")


if __name__ == "__main__":
    main()
