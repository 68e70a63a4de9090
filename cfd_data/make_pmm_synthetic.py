"""Make the SYNTHETIC campaigns of a planar motion mechanism: runs over time, and steady tables of the same law.

Run ``python cfd_data/make_pmm_synthetic.py``; it writes pmm_synthetic/ (runs.csv and one file a run), pmm_synthetic_steady/ and
their campaign.toml beside itself. Nothing is measured or computed by CFD: the forces follow stated coefficients, the model's
inertia is put in, the records pass a stated Butterworth filter and have seeded noise that is correlated over time.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import signal

HERE = Path(__file__).resolve().parent
Array = NDArray[np.float64]
MOTIONS, COMPONENTS = "uvwpqr", "XYZKMN"
LENGTH, DENSITY, SPEED = 2.0, 1000.0, 1.5
MASS, CENTRE, INERTIA = 72.0, (0.03, 0.0, 0.02), (1.1, 14.0, 14.2)
RESTORING = (14.1, 14.1)  # N m/rad of roll and pitch
FILTER = (2, 2.0)  # order and cut-off, Hz, of the Butterworth that the forces pass
CYCLES, SAMPLES, SEED, NOISE, CORRELATION = 4, 24, 20261122, 0.005, 0.5

# Primed, of the fluid's force on the body: of the velocity, its x|x| and the acceleration. Invented; sizes as of a bare hull.
LAW: dict[str, dict[str, tuple[float, float, float]]] = {
    "v": {"Y": (-0.0280, -0.0900, -0.0160), "N": (-0.0140, 0.0060, 0.0004), "K": (-0.0003, -0.0008, -0.0002)},
    "r": {"Y": (0.0060, -0.0012, 0.0003), "N": (-0.0046, -0.0020, -0.0009)},
    "w": {"Z": (-0.0270, -0.0850, -0.0158), "M": (0.0142, -0.0050, -0.0003)},
    "q": {"Z": (-0.0058, 0.0011, -0.0003), "M": (-0.0044, -0.0019, -0.0008)},
    "p": {"K": (-0.00030, -0.00004, -0.00002)},
}
OWN = {"sway": ("v", "y"), "heave": ("w", "z"), "roll": ("p", "phi"), "pitch": ("q", "theta"), "yaw": ("r", "psi")}
RUNS = {  # amplitude of the primed velocity, w', mean drift in degrees
    "sway": ((0.05, 2.0, 0.0), (0.10, 2.0, 0.0), (0.15, 2.0, 0.0), (0.20, 2.0, 0.0), (0.10, 1.0, 0.0), (0.10, 3.0, 0.0)),
    "yaw": ((0.15, 2.0, 0.0), (0.30, 2.0, 0.0), (0.45, 2.0, 0.0), (0.30, 1.0, 0.0), (0.30, 3.0, 0.0), (0.30, 2.0, 6.0)),
    "heave": ((0.05, 2.0, 0.0), (0.10, 2.0, 0.0), (0.20, 2.0, 0.0)),
    "pitch": ((0.15, 2.0, 0.0), (0.30, 2.0, 0.0), (0.45, 2.0, 0.0)),
    "roll": ((0.30, 3.0, 0.0), (0.60, 3.0, 0.0), (0.90, 3.0, 0.0)),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Run:
    """One run: its motion, amplitude of the primed velocity, w' = omega L/U, mean drift in rad, phase of the displacement in rad."""

    motion: str
    amplitude: float
    frequency: float
    drift: float = 0.0
    phase: float = 0.0

    @property
    def omega(self) -> float:
        """rad/s."""
        return self.frequency * SPEED / LENGTH


def unit(component: str) -> float:
    """N or N m of one primed unit of force or moment."""
    return 0.5 * DENSITY * SPEED**2 * LENGTH ** (3 if component in "KMN" else 2)


def fluid(nu: Array, rates: Array) -> dict[str, Array]:
    """Fluid's forces of the law, N and N m, for velocities and accelerations (n, 6)."""
    out = {c: np.zeros(len(nu)) for c in COMPONENTS}
    for m, forces in LAW.items():
        scale = (LENGTH if m in "pqr" else 1.0) / SPEED
        i = MOTIONS.index(m)
        s, sdot = nu[:, i] * scale, rates[:, i] * scale * LENGTH / SPEED
        for c, (linear, quadratic, mass) in forces.items():
            out[c] += unit(c) * (linear * s + quadratic * s * np.abs(s) + mass * sdot)
    return out


def held(nu: Array, rates: Array) -> dict[str, Array]:
    """What the balance must exert to move the model: mass times acceleration of its centre, and the moments about the origin.

    Written out with cross products of the body's motion, not with the matrices of the package.
    """
    centre, tensor = np.array(CENTRE), np.diag(INERTIA)
    v, w, vdot, wdot = nu[:, :3], nu[:, 3:], rates[:, :3], rates[:, 3:]
    acceleration = vdot + np.cross(w, v) + np.cross(wdot, centre) + np.cross(w, np.cross(w, centre))
    force = MASS * acceleration
    moment = wdot @ tensor + np.cross(w, w @ tensor) + np.cross(centre, force)
    return dict(zip(COMPONENTS, np.hstack([force, moment]).T, strict=True))


def record(
    run: Run, rng: np.random.Generator | None = None, inertia: bool = True, restoring: bool = True,
    butterworth: tuple[int, float] | None = FILTER, cycles: float = CYCLES, samples: int = SAMPLES, noise: float = NOISE,
) -> dict[str, Array]:  # fmt: skip
    """Columns of one run: t, the displacement(s) and the recorded forces, SI, FRD."""
    grid = 2.0 * np.pi * np.arange(512) / 512
    own, displacement = OWN[run.motion]
    size = run.amplitude * SPEED / (LENGTH if own in "pqr" else 1.0)
    nu, rates = np.zeros((512, 6)), np.zeros((512, 6))
    nu[:, 0], nu[:, 1] = SPEED * np.cos(run.drift), SPEED * np.sin(run.drift)
    nu[:, MOTIONS.index(own)] += size * np.cos(grid)
    rates[:, MOTIONS.index(own)] -= size * run.omega * np.sin(grid)
    if run.motion in ("yaw", "pitch") and not run.drift:
        # The carriage keeps its speed, and the path's slope is the angle: along the body U / cos(angle).
        turned = size / run.omega * np.sin(grid)
        nu[:, 0] = SPEED / np.cos(turned)
        rates[:, 0] = SPEED * np.sin(turned) / np.cos(turned) ** 2 * size * np.cos(grid)
    forces = fluid(nu, rates)
    model = held(nu, rates)
    angle = size / run.omega * np.sin(grid)
    wanted = {"sway": "YNK", "yaw": "YN", "heave": "ZM", "pitch": "ZM", "roll": "K"}[run.motion]
    time = np.arange(round(cycles * samples)) * 2.0 * np.pi / (run.omega * samples)
    theta = run.omega * time + run.phase
    out = {"t": time}
    if run.motion == "yaw" and not run.drift:
        # The path whose slope is the heading: ydot = U tan psi, integrated by its harmonics.
        slope = np.fft.rfft(SPEED * np.tan(angle)) / 512
        k = np.arange(1, 20)
        y = 2.0 * np.real(np.exp(1j * np.outer(theta, k)) @ (slope[1:20] / (1j * k * run.omega)))
        out["y"] = y
    if not (run.motion == "yaw" and run.drift):
        out[displacement] = size / run.omega * np.sin(theta)
    else:
        out[own] = size * np.cos(theta)
    if run.motion == "pitch":
        # z of the path that keeps w at zero: zdot = -U tan theta.
        slope = np.fft.rfft(-SPEED * np.tan(angle)) / 512
        k = np.arange(1, 20)
        out["z"] = 2.0 * np.real(np.exp(1j * np.outer(theta, k)) @ (slope[1:20] / (1j * k * run.omega)))
    for c in wanted:
        whole = forces[c] - (model[c] if inertia else 0.0)
        if restoring and run.motion in ("roll", "pitch") and c == {"roll": "K", "pitch": "M"}[run.motion]:
            whole = whole - RESTORING[run.motion == "pitch"] * angle
        content = np.fft.rfft(whole) / 512
        if butterworth is not None:
            pole, zero = signal.butter(butterworth[0], 2.0 * np.pi * butterworth[1], analog=True, output="ba")
            content = content * signal.freqs(pole, zero, run.omega * np.maximum(np.arange(len(content)), 1e-9))[1]
        k = np.arange(60)
        weight = np.where(k == 0, 1.0, 2.0)
        clean = np.real(np.exp(1j * np.outer(theta, k)) @ (weight * content[:60]))
        out[c] = clean
        if rng is not None:
            white = rng.standard_normal(len(time) + 50)
            error = signal.lfilter([np.sqrt(1.0 - CORRELATION**2)], [1.0, -CORRELATION], white)[50:]
            out[c] = clean + noise * float(np.max(np.abs(clean))) * error
    return out


def csv_of(columns: Mapping[str, Array], units: Mapping[str, str], digits: int = 6) -> bytes:
    """A CSV with units in the headers."""
    lines = [",".join(f"{n} [{units[n]}]" for n in columns)]
    lines += [",".join(f"{float(x) + 0.0:.{digits}g}" for x in row) for row in zip(*columns.values(), strict=True)]
    return ("\n".join(lines) + "\n").encode()


UNITS = {
    "t": "s", "y": "m", "z": "m", "phi": "rad", "theta": "rad", "psi": "rad", "r": "rad/s", "q": "rad/s",
    "beta": "deg", "alpha": "deg", **dict.fromkeys("XYZ", "N"), **dict.fromkeys("KMN", "N*m"),
}  # fmt: skip
HOW = "Evaluated from coefficients that are stated in cfd_data/make_pmm_synthetic.py; no measurement, no CFD."


def campaign_of(name: str, title: str, importer: str, rest: str) -> bytes:
    """A campaign.toml."""
    return f"""# SYNTHETIC: written by cfd_data/make_pmm_synthetic.py, which also makes the tables. No measurement, no CFD.
[campaign]
name = "{name}"
title = "{title}"
body = "pmm_synthetic_hull"
importer = "{importer}"

[axes]
frame = "FRD"
alpha = "w = +U sin(alpha)"
beta = "v = +U sin(beta)"
datum = "midship"
reference_point = [0.0, 0.0, 0.0]              # also the pivot of the mechanism

[scaling]
length = "{LENGTH} m"
length_name = "LOA"

[conditions]
speed = "{SPEED} m/s"
density = "{DENSITY:g} kg/m^3"

[source]
citation = "pmm_synthetic"
place = "cfd_data/make_pmm_synthetic.py, seed {SEED}"
kind = "synthetic"
how_obtained = "{HOW}"

{rest}""".encode()


def steady() -> dict[str, Array]:
    """Steady drift, attack, rotation in yaw and in pitch by the same law, without noise of time but 0.3 % of the largest force."""
    angles = np.radians([-14.0, -10.0, -6.0, -3.0, 0.0, 3.0, 6.0, 10.0, 14.0])
    turns = np.array([-0.6, -0.45, -0.3, -0.15, 0.15, 0.3, 0.45, 0.6]) * SPEED / LENGTH
    rows = [(b, 0.0, 0.0, 0.0) for b in angles] + [(0.0, a, 0.0, 0.0) for a in angles]
    rows += [(0.0, 0.0, r, 0.0) for r in turns] + [(0.0, 0.0, 0.0, q) for q in turns]
    beta, alpha, r, q = np.array(rows).T
    nu = np.zeros((len(rows), 6))
    nu[:, 0] = SPEED * np.cos(alpha) * np.cos(beta)
    nu[:, 1], nu[:, 2], nu[:, 4], nu[:, 5] = SPEED * np.sin(beta), SPEED * np.sin(alpha), q, r
    rng = np.random.default_rng(SEED + 1)
    forces = {c: v for c, v in fluid(nu, np.zeros_like(nu)).items() if c in "YZMN"}
    noisy = {c: v + 0.003 * np.max(np.abs(v)) * rng.standard_normal(len(v)) for c, v in forces.items()}
    return {"beta": np.degrees(beta), "alpha": np.degrees(alpha), "r": r, "q": q, **noisy}


def files() -> dict[str, bytes]:
    """Every file by its path under cfd_data."""
    rng = np.random.default_rng(SEED)
    out: dict[str, bytes] = {}
    listed = ["run,file,motion,frequency [Hz],beta [deg]"]
    for motion, settings in RUNS.items():
        for n, (amplitude, frequency, drift) in enumerate(settings, 1):
            run = Run(motion, amplitude, frequency, np.radians(drift), float(rng.uniform(-3.0, 3.0)))
            name = f"{motion}_{n}"
            listed.append(f"{name},runs/{name}.csv,{motion},{run.omega / (2.0 * np.pi):.6g},{drift:g}")
            out[f"pmm_synthetic/runs/{name}.csv"] = csv_of(record(run, rng), UNITS)
    out["pmm_synthetic/runs.csv"] = ("\n".join(listed) + "\n").encode()
    order, cut_off = FILTER
    out["pmm_synthetic/campaign.toml"] = campaign_of(
        "pmm_synthetic", "Synthetic runs of a planar motion mechanism (no measurement, no CFD)", "pmm",
        f"""[inertia]
mass = "{MASS} kg"
centre_of_gravity = {list(CENTRE)}
inertia = {list(INERTIA)}                      # about the centre of gravity

[planar_motion]
filter = {{ forces = "Butterworth {order}, {cut_off:g} Hz", motion = "none" }}
restoring = {list(RESTORING)}                       # N m per radian of roll and pitch, weight and buoyancy

[[table]]
file = "runs.csv"
sha256 = "{hashlib.sha256(out["pmm_synthetic/runs.csv"]).hexdigest()}"
contains_inertia = true                        # a balance in the model
""",
    )  # fmt: skip
    out["pmm_synthetic_steady/table.csv"] = csv_of(steady(), UNITS)
    out["pmm_synthetic_steady/campaign.toml"] = campaign_of(
        "pmm_synthetic_steady", "Synthetic steady drift and rotation of the hull of pmm_synthetic (no measurement, no CFD)", "csv",
        f"""[[table]]
file = "table.csv"
sha256 = "{hashlib.sha256(out["pmm_synthetic_steady/table.csv"]).hexdigest()}"
contains_inertia = false                       # the fluid's force alone
arm_point = [0.0, 0.0, 0.0]                    # velocities hold at the reference point
""",
    )  # fmt: skip
    out["pmm_synthetic/beside_steady.toml"] = b"""# SYNTHETIC: oscillating runs beside steady ones of the same law.
[study]
name = "pmm_synthetic"
title = "Synthetic planar motion mechanism beside steady tests"
wanted = ["Yv", "Nv", "Zw", "Mw", "Yr", "Nr", "Yvdot", "Nrdot"]

[[table]]
campaign = "../pmm_synthetic_steady"

[[table]]
campaign = "."
fits = ["planar_motion"]
"""
    return out


def main() -> int:
    """Write them."""
    for name, content in files().items():
        path = HERE / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return 0


if __name__ == "__main__":
    sys.exit(main())
