"""Make the *synthetic* alpha-beta table of a vehicle like the HUUV, from stated coefficients, with seeded noise.

Run ``python cfd_data/make_synthetic_huuv.py``. Nothing in it is measured or computed by CFD: it is there so that fits of
tables, their tests and their users have a table whose truth is known. The range is that of Talarczyk et al. (2025),
attack -25 to 25 degrees and drift 0 to 25 degrees. The script enters the sha256 of the table in campaign.toml.
"""

from __future__ import annotations

import csv
import hashlib
import io
import re
import sys
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parent / "huuv_synthetic"
SEED = 20250925
STEP = 2.5
LARGEST = 25.0
REPEATS = 8  # more runs at no angle, which show the scatter
DENSITY, SPEED, AREA, LENGTH = 998.0, 1.0, 0.04, 1.2
NOISE = 0.002
TRUTH: dict[str, dict[tuple[int, int], float]] = {
    "C_D": {(0, 0): 0.30, (2, 0): 1.20, (0, 2): 0.90, (2, 2): 2.00},
    "C_S": {(0, 1): -1.10, (0, 3): -2.40},
    "C_L": {(1, 0): 1.00, (3, 0): 1.80},
    "C_m": {(1, 0): 0.35, (3, 0): -0.30},
    "C_n": {(0, 1): -0.40, (0, 3): 0.50},
}
COLUMNS = ("X [N]", "Y [N]", "Z [N]", "M [N*m]", "N [N*m]")


def table() -> str:
    """The table: settings in degrees, forces in N and N m in FRD, six significant digits."""
    steps = np.arange(-LARGEST, LARGEST + STEP / 2, STEP)
    alpha, beta = (a.ravel() for a in np.meshgrid(steps, steps[steps >= 0.0], indexing="ij"))
    first, again = len(alpha), np.random.default_rng(SEED + 1)
    alpha, beta = (np.concatenate([x, np.zeros(REPEATS)]) for x in (alpha, beta))
    a, b = np.radians(alpha), np.radians(beta)
    rng = np.random.default_rng(SEED)
    value = {
        name: sum(c * a**i * b**j for (i, j), c in terms.items())
        + NOISE * np.concatenate([rng.standard_normal(first), again.standard_normal(REPEATS)])
        for name, terms in TRUTH.items()
    }
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
    drag, side, lift = value["C_D"], value["C_S"], value["C_L"]
    q = 0.5 * DENSITY * SPEED**2 * AREA
    columns = (
        q * (-ca * cb * drag - ca * sb * side + sa * lift),
        q * (-sb * drag + cb * side),
        q * (-sa * cb * drag - sa * sb * side - ca * lift),
        q * LENGTH * value["C_m"],
        q * LENGTH * value["C_n"],
    )
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(("point", "alpha [deg]", "beta [deg]", *COLUMNS))
    for i in range(len(a)):
        writer.writerow((i + 1, f"{alpha[i]:g}", f"{beta[i]:g}", *(f"{c[i]:.6g}" for c in columns)))
    return out.getvalue()


def main() -> None:
    """Write the table and its hash."""
    content = table().encode()
    (FOLDER / "table.csv").write_bytes(content)
    description = FOLDER / "campaign.toml"
    changed, count = re.subn(
        r'(\nsha256 = ")[0-9a-f]*(")', rf"\g<1>{hashlib.sha256(content).hexdigest()}\g<2>", description.read_text()
    )
    if count != 1:
        raise SystemExit("no place for the hash")
    description.write_text(changed)
    sys.stdout.write(f"huuv_synthetic/table.csv: {content.count(bytes([10])) - 1} rows\n")


if __name__ == "__main__":
    main()
