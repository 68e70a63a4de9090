"""What a fit does not use it does not import."""

from __future__ import annotations

import json
import subprocess
import sys

LINES = """
import json, sys
import numpy as np
import coeflab as cf
v = np.linspace(-0.3, 0.3, 9)
drift = cf.read_table(
    {"v [m/s]": v, "Y [N]": -120.0 * v, "N [N m]": -60.0 * v}, name="drift",
    frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft",
)
cf.fit(drift)
print(json.dumps(sorted(sys.modules)))
"""


def modules(lines: str) -> list[str]:
    done = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True, check=True)
    found: list[str] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_a_fit_imports_no_picture_body_or_motion() -> None:
    loaded = modules(LINES)
    heavy = ("matplotlib", "trimesh", "typst", "typer", "rich", "numba")
    ours = ("report", "motion", "bodies", "vehicle", "formats", "tank", "cli")
    assert [m for m in loaded if m.split(".")[0] in heavy] == []
    assert [m for m in loaded if m.split(".")[0] == "coeflab" and m.split(".")[1:2] and m.split(".")[1] in ours] == []


def test_importing_coeflab_costs_nothing() -> None:
    loaded = modules("import json, sys\nimport coeflab\nprint(json.dumps(sorted(sys.modules)))")
    assert [
        m for m in loaded if m.split(".")[0] in ("numpy", "scipy", "pandas", "matplotlib", "pydantic", "pint")
    ] == []
    assert sorted(m for m in loaded if m.startswith("coeflab.")) == [
        "coeflab.core",
        "coeflab.core.cards",
        "coeflab.core.version",
    ]
