"""Roddy's configuration 2 in pounds and feet, in axes of a CFD code and about another point: a check of every conversion to primes.

Run ``python cfd_data/make_dimensional.py``. The forces are those of ``suboff_roddy_2/table.csv`` times 1/2 rho U^2 L^2 (moments L^3),
moved to a point off the hull's axis and turned to x aft, y starboard, z up. Plain Python; nothing of coeflab is imported, so that a wrong power, sign or lever
in coeflab shows as a difference between the two campaigns. No new evidence: the same measurement written in another way.
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
from pathlib import Path

HERE = Path(__file__).resolve().parent
FOOT = 0.3048  # m
POUND = 0.45359237  # kg
POUND_FORCE = POUND * 9.80665  # N
KNOT = 1852.0 / 3600.0  # m/s
DENSITY = 62.27456 * POUND / FOOT**3
SPEED, LENGTH = 6.5 * KNOT, 13.9792 * FOOT
PRINTED = (-6.6042 * FOOT, 0.0, 0.0)  # FRD, from the nose
POINT = (-1.3, 0.25, -0.4)  # FRD, from the nose: off the axis, so that every moment takes from two forces
HEADERS = (
    "point",
    "delta_r [deg]",
    "beta [deg]",
    *(f"{c} [lbf]" for c in "XYZ"),
    *(f"{c} [lbf*ft]" for c in "KMN"),
    "uncertain",
)


def dimensional(row: dict[str, str]) -> list[str]:
    """One row: point, angles, forces in lbf, moments in lbf ft about POINT, axes x aft, y starboard, z up."""
    pressure = 0.5 * DENSITY * SPEED**2 * LENGTH**2
    number = {c: float(row[f"{c}' [-]"]) if row[f"{c}' [-]"] else float("nan") for c in "XYZKMN"}
    x, y, z = (number[c] * pressure for c in "XYZ")
    k, m, n = (number[c] * pressure * LENGTH for c in "KMN")
    a, b, c = (p - q for p, q in zip(PRINTED, POINT))  # from the new point to the old one
    k, m, n = k + b * z - c * y, m + c * x - a * z, n + a * y - b * x
    turned = [-x, y, -z, -k, m, -n]  # half a turn about y
    units = [POUND_FORCE] * 3 + [POUND_FORCE * FOOT] * 3
    cells = ["" if math.isnan(v) else f"{v / u:.9g}" for v, u in zip(turned, units)]
    return [row["point"], row["delta_r [deg]"], row["beta [deg]"], *cells, row["uncertain"]]


def main() -> None:
    """Write the table and the hashes of it and of its source."""
    raw = (HERE / "suboff_roddy_2" / "table.csv").read_bytes()
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEADERS)
    writer.writerows(dimensional(row) for row in csv.DictReader(io.StringIO(raw.decode())))
    folder = HERE / "suboff_roddy_2_dimensional"
    table = out.getvalue().encode()
    (folder / "table.csv").write_bytes(table)
    text = (folder / "campaign.toml").read_text()
    for key, content in (("sha256", table), ("source_sha256", raw)):
        text = re.sub(rf'(?m)^({key} = ")[0-9a-f]*"', rf'\g<1>{hashlib.sha256(content).hexdigest()}"', text)
    (folder / "campaign.toml").write_text(text)


if __name__ == "__main__":
    main()
