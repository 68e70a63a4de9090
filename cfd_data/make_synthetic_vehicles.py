"""Make the synthetic campaigns of TJ-FlyingFish, THAUV and the HUUV elevator: printed laws, chosen settings, seeded noise.

Run ``python cfd_data/make_synthetic_vehicles.py``; it writes table.csv and campaign.toml of every campaign beside itself.
The papers print coefficients, not their tables, so these tables are computed from the coefficients. They show that a
fit gives back what went in; they are no measurement and no CFD. The noise is normal with one standard deviation per
force, a stated share of the largest value of that force.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent
Array = NDArray[np.float64]
MOTIONS, COMPONENTS = "uvwpqr", "XYZKMN"

FLYINGFISH = {
    "water": ((0.0998, 18.2222), (0.1658, 15.8047), (0.0064, 24.7142), (0.0032, 0.0489), (0.0008, 0.1554), (0.0029, 0.1872)),
    "air": ((0.0010, 0.0165), (0.0006, 0.0227), (0.0004, 0.0364), (0.0, 0.0002), (0.0, 0.0005), (0.0, 0.0013)),
}  # fmt: skip
THAUV = {
    "01": (-1.9169, 9.5281, 11.1159, 0.215, 1.1025, -1.4179),
    "02": (-1.8461, 9.8351, 11.5594, 0.2445, 0.3720, -2.4335),
    "03": (-1.265, 8.0948, 11.2805, 0.20525, 0.0985, -2.8938),
}
ELEVATOR = {"C_D0": 0.03, "C_D2": 1.1, "C_L1": -2.4, "C_L3": 1.5, "C_m1": 0.45, "C_m3": -0.3}
ELEVATOR_AREA, ELEVATOR_LENGTH, ELEVATOR_SPEED = 0.02, 0.2, 0.5

DAMPING_NOISE, POLAR_NOISE, ELEVATOR_NOISE = 0.002, 0.005, 0.005
SEEDS = {"water": 41, "air": 42, "01": 51, "02": 52, "03": 53, "elevator": 61}
LARGEST = {"water": (1.5, 3.0), "air": (10.0, 6.0)}
DENSITY = {"water": 1000.0, "air": 1.2}


@dataclass(frozen=True, slots=True)
class Description:
    """What a campaign.toml says that is not the same for all."""

    title: str
    body: str
    datum: str
    datum_note: str
    length: str
    length_name: str
    density: float
    speed: float
    citation: str
    place: str
    how: str
    notes: str
    alpha: bool


def noisy(values: Array, share: float, rng: np.random.Generator) -> Array:
    """Values plus normal noise of standard deviation ``share`` of the largest magnitude."""
    return values + share * float(np.max(np.abs(values))) * rng.standard_normal(len(values))


def csv_of(columns: Mapping[str, Array]) -> bytes:
    """Rows numbered from 1, nine digits."""
    lines = [",".join(("point", *columns))]
    for number, row in enumerate(zip(*columns.values(), strict=True), 1):
        lines.append(",".join((str(number), *(f"{float(x) + 0.0:.9g}" for x in row))))
    return ("\n".join(lines) + "\n").encode()


def campaign_of(name: str, d: Description, table: bytes) -> bytes:
    """campaign.toml with the hash of the table."""
    alpha = 'alpha = "w = +U sin(alpha)"\n' if d.alpha else ""
    still = "arm_point = [0.0, 0.0, 0.0]\n" if b"[rad/s]" in table.split(b"\n", 1)[0] else ""
    return f"""# SYNTHETIC: written by cfd_data/make_synthetic_vehicles.py, which also makes the table. No measurement, no CFD.
[campaign]
name = "{name}"
title = "{d.title}"
body = "{d.body}"
notes = "{d.notes}"

[axes]
frame = "FRD"
{alpha}datum = "{d.datum}"
datum_note = "{d.datum_note}"
reference_point = [0.0, 0.0, 0.0]

[scaling]
length = "{d.length}"
length_name = "{d.length_name}"

[conditions]
speed = "{d.speed:g} m/s"
density = "{d.density:g} kg/m^3"

[source]
citation = "{d.citation}"
place = "{d.place}"
kind = "synthetic"
how_obtained = "{d.how}"

[[table]]
file = "table.csv"
sha256 = "{hashlib.sha256(table).hexdigest()}"
contains_inertia = false
{still}""".encode()


def flyingfish(medium: str) -> tuple[bytes, Description]:
    """Sweeps of the six velocities one by one, both ways, from F = -(linear + quadratic |x|) x."""
    rng = np.random.default_rng(SEEDS[medium])
    share = np.array([s * k / 8.0 for k in range(1, 9) for s in (-1.0, 1.0)])
    linear, angular = LARGEST[medium]
    motion = np.zeros((6, 6 * len(share)))
    for i in range(6):
        motion[i, i * len(share) : (i + 1) * len(share)] = share * (linear if i < 3 else angular)
    laws = FLYINGFISH[medium]
    forces = [noisy(-(a + b * np.abs(x)) * x, DAMPING_NOISE, rng) for (a, b), x in zip(laws, motion, strict=True)]
    columns = {"U [m/s]": np.full(motion.shape[1], linear)}
    columns |= {f"{m} [{'m/s' if m in 'uvw' else 'rad/s'}]": x for m, x in zip(MOTIONS, motion, strict=True)}
    columns |= {f"{c} [{'N' if c in 'XYZ' else 'N*m'}]": f for c, f in zip(COMPONENTS, forces, strict=True)}
    equation = {"water": 50, "air": 49}[medium]
    pairs = ", ".join(f"{c} {a:g} + {b:g} abs({m})" for c, m, (a, b) in zip(COMPONENTS, MOTIONS, laws, strict=True))
    return csv_of(columns), Description(
        title=f"TJ-FlyingFish in {medium}, synthetic, one velocity at a time",
        body=f"tj_flyingfish_{medium}_synthetic",
        datum="cg",
        datum_note="centre of gravity",
        length="1 m",
        length_name="unit length (the paper prints none)",
        density=DENSITY[medium],
        speed=linear,
        citation=f"Synthetic table of this project; coefficients of the TJ-FlyingFish paper, equation {equation}.",
        place=f"coefficients: equation {equation}, printed for F = -(a + b abs(x)) x",
        how=f"Synthetic: forces from the printed damping ({pairs}; times minus the velocity) plus normal noise with a "
        f"standard deviation of {DAMPING_NOISE:.1%} of the largest force of each component, seed {SEEDS[medium]}. "
        "Velocities, density and length are chosen, the paper does not print them.",
        notes="U is a constant reference speed that primes refer to, the largest of the sweeps: a speed of zero cannot "
        "prime, and rotation on the spot has none of its own.",
        alpha=False,
    )


def thauv(case: str) -> tuple[bytes, Description]:
    """Angle-of-attack sweeps at three speeds; body forces by equations 17 and 18 of the paper."""
    rng = np.random.default_rng(SEEDS[case])
    degrees = np.tile(np.arange(-8.0, 9.0, 2.0), 3)
    speed = np.repeat([0.3, 0.5, 0.7], 9)
    l0, l1, d0, d2, m0, m1 = THAUV[case]
    lift = noisy((l0 + l1 * degrees) * speed**2, POLAR_NOISE, rng)
    drag = noisy((d0 + d2 * degrees**2) * speed**2, POLAR_NOISE, rng)
    moment = noisy((m0 + m1 * degrees) * speed**2, POLAR_NOISE, rng)
    a = np.radians(degrees)
    columns = {
        "U [m/s]": speed,
        "alpha [deg]": degrees,
        "X [N]": lift * np.sin(a) - drag * np.cos(a),
        "Z [N]": -(lift * np.cos(a) + drag * np.sin(a)),
        "M [N*m]": moment,
    }
    return csv_of(columns), Description(
        title=f"THAUV case {case}, synthetic, angle of attack at three speeds",
        body=f"thauv_case_{case}_synthetic",
        datum="cb",
        datum_note="centre of buoyancy, origin of the paper's body axes",
        length="1 m",
        length_name="unit length (the polar needs none)",
        density=1025.0,
        speed=0.5,
        citation=f"Synthetic table of this project; coefficients of the THAUV paper, Table 3, case {case}.",
        place=f"coefficients: Table 3, case {case}; law: equations 28-30",
        how=f"Synthetic: L = ({l0:g} + {l1:g} a) V^2, D = ({d0:g} + {d2:g} a^2) V^2, M = ({m0:g} + {m1:g} a) V^2 with a in "
        f"degrees, each plus normal noise with a standard deviation of {POLAR_NOISE:.1%} of its largest value, seed "
        f"{SEEDS[case]}; turned to body axes by the paper's equations 17 and 18. Angles and speeds are chosen.",
        notes="The paper does not print the unit of a; its speeds need degrees.",
        alpha=True,
    )


def elevator() -> tuple[bytes, Description]:
    """The elevator alone over its angle and the angle of attack; coefficients chosen, as the paper only plots its own."""
    rng = np.random.default_rng(SEEDS["elevator"])
    delta = np.tile(np.arange(-20.0, 21.0, 2.5), 3)
    alpha = np.repeat([-10.0, 0.0, 10.0], 17)
    e, a, k = np.radians(delta - alpha), np.radians(alpha), ELEVATOR
    q = 0.5 * 1000.0 * ELEVATOR_SPEED**2 * ELEVATOR_AREA
    drag = noisy(q * (k["C_D0"] + k["C_D2"] * e**2), ELEVATOR_NOISE, rng)
    lift = noisy(q * (k["C_L1"] * e + k["C_L3"] * e**3), ELEVATOR_NOISE, rng)
    moment = noisy(q * ELEVATOR_LENGTH * (k["C_m1"] * e + k["C_m3"] * e**3), ELEVATOR_NOISE, rng)
    columns = {
        "delta_s [deg]": delta,
        "alpha [deg]": alpha,
        "X [N]": lift * np.sin(a) - drag * np.cos(a),
        "Z [N]": -(lift * np.cos(a) + drag * np.sin(a)),
        "M [N*m]": moment,
    }
    values = ", ".join(f"{s} = {v:g}" for s, v in k.items())
    return csv_of(columns), Description(
        title="HUUV elevator, synthetic, elevator angle at three angles of attack",
        body="huuv_elevator_synthetic",
        datum="elevator_axis",
        datum_note="the elevator's axis of rotation",
        length=f"{ELEVATOR_LENGTH:g} m",
        length_name="characteristic length of the elevator",
        density=1000.0,
        speed=ELEVATOR_SPEED,
        citation="Synthetic table of this project; form of equations 15-17 of the HUUV paper, coefficients chosen.",
        place="form: equations 15-17; length: Table 1",
        how=f"Synthetic: {values} over delta - alpha in radians, by the area {ELEVATOR_AREA:g} m^2 and the length, each "
        f"force plus normal noise with a standard deviation of {ELEVATOR_NOISE:.1%} of its largest value, seed "
        f"{SEEDS['elevator']}. The coefficients are chosen: the paper plots its own in Fig. 15 and prints no number.",
        notes="With delta - alpha in FRD a positive delta turns the leading edge down, so C_L1 is negative.",
        alpha=True,
    )


def files() -> dict[str, bytes]:
    """Every file by its path below cfd_data."""
    made = {f"flyingfish_{medium}_synthetic": flyingfish(medium) for medium in FLYINGFISH}
    made |= {f"thauv_case_{case}_synthetic": thauv(case) for case in THAUV}
    made["huuv_elevator_synthetic"] = elevator()
    out = {}
    for name, (table, description) in made.items():
        out[f"{name}/table.csv"] = table
        out[f"{name}/campaign.toml"] = campaign_of(name, description, table)
    return out


def main() -> None:
    """Write every file."""
    for path, content in files().items():
        target = HERE / path
        target.parent.mkdir(exist_ok=True)
        target.write_bytes(content)
        sys.stdout.write(f"{path}: {len(content)} bytes\n")


if __name__ == "__main__":
    main()
