"""Write parameter files of the TJ-FlyingFish and of THAUV's dives, and a bench test of a rotor: ``python cfd_data/make_flyingfish.py``.

The paper plots forces and torques of its bench (Fig. 5) and prints the identified curves, equations 45 to 48. The tables here are
computed from those equations: steps of the speed with the lag of a motor and seeded normal noise. They show that the
identification gives back what went in; they are no measurement.
"""

from __future__ import annotations

import numpy as np

from coeflab.core.files import shipped, write_all
from coeflab.glider.glider_file import gliders_at
from coeflab.published.flyingfish.model import MEDIA, FlyingFish, read_flyingfish
from coeflab.published.parameter_files import flyingfish_file
from coeflab.published.thauv.in_space import dive_files

SEEDS = {"water": 71, "air": 72}
STEPS, HOLD, RATE, LAG = 9, 2.5, 20.0, 0.12  # steps of so many s, rows a second, time constant of the motor in s
NOISE, RPM_NOISE = 0.01, 0.001  # standard deviations: of the largest load and the largest speed
LARGEST = {"water": 2700.0, "air": 9000.0}


def bench(fish: FlyingFish, medium: str) -> bytes:
    """Time, speed, thrust and torque while the speed is stepped up."""
    rng = np.random.default_rng(SEEDS[medium])
    time = np.arange(0.0, STEPS * HOLD, 1.0 / RATE)
    levels = LARGEST[medium] * np.arange(1, STEPS + 1) / STEPS
    speed, n = np.zeros(len(time)), 0.0
    for i, t in enumerate(time):
        n += (levels[min(int(t / HOLD), STEPS - 1)] - n) * (1.0 - np.exp(-1.0 / (RATE * LAG)))
        speed[i] = n
    laws = (fish.rotors.thrust, fish.rotors.torque) if medium == "water" else tuple(fish.rotor_air)
    loads = [a * speed + b * speed**2 for a, b in laws]
    noisy = [x + NOISE * x.max() * rng.standard_normal(len(x)) for x in loads]
    read = speed + RPM_NOISE * speed.max() * rng.standard_normal(len(speed))
    lines = ["t [s],speed [rpm],T [N],Q [N*m]"]
    lines += [f"{t:.2f},{n:.1f},{a:.4f},{b:.6f}" for t, n, a, b in zip(time, read, *noisy, strict=True)]
    return ("\n".join(lines) + "\n").encode()


def files() -> dict[str, bytes]:
    """Every file by its path below cfd_data."""
    fish = read_flyingfish()
    dives = dive_files(gliders_at(shipped("cfd_data") / "thauv"))
    made = {f"thauv/{p.name}.parameters.json": p.to_json() for p in dives}
    made |= {f"flyingfish_bench_synthetic/{medium}.csv": bench(fish, medium) for medium in MEDIA}
    return made | {
        f"flyingfish/flyingfish_{medium}.parameters.json": flyingfish_file(fish, medium).to_json() for medium in MEDIA
    }


if __name__ == "__main__":
    folder = shipped("cfd_data")
    (folder / "flyingfish_bench_synthetic").mkdir(exist_ok=True)
    write_all(folder, files())
