"""The rigid-body simulator beside xdyn, beside scipy's LSODA, and a thousand vehicles beside a loop over one.

Usage: python simulation.py [PYTHON]
PYTHON is an interpreter that has lxdyn; without one, that of tests/consumers/lxdyn_environment.py is taken, and xdyn is left
out where there is none. The vehicle is the synthetic torpedo of the tests: fifteen terms and a full added mass. Every figure
is the best of several, taken in turn, because the machine may be busy; compilation comes before.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from coeflab.formats.xdyn import write as xdyn  # noqa: E402
from coeflab.motion.ensemble import Ensemble, alone  # noqa: E402
from coeflab.motion.manoeuvre import Manoeuvre, Phase  # noqa: E402
from coeflab.motion.marching import march  # noqa: E402
from coeflab.motion.rates_of_one import rates_of_one  # noqa: E402
from coeflab.motion.simulators import rigid_body  # noqa: E402
from coeflab.motion.vehicle import Vehicle, vehicle  # noqa: E402
from tests.consumers.lxdyn_environment import PYTHON  # noqa: E402
from tests.formats.massed import torpedo  # noqa: E402

REPEATS, STEP, RUDDER = 5, 0.02, 0.15
SHORT, LONG, OFTEN, MEMBERS = 10.0, 60.0, 50, 1000


def turning(v: Vehicle, seconds: float) -> Manoeuvre:
    """Rudder over at once, for as long."""
    start = np.array([v.speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    return Manoeuvre("turn", (Phase("turn", {"dr": RUDDER, "thrust": v.resistance(v.speed)}, seconds),), start)


def best(*runs: Callable[[], object]) -> list[float]:
    """Seconds of each, the best of several taken in turn."""
    times = [[] for _ in runs]
    for _ in range(REPEATS):
        for taken, run in zip(times, runs, strict=True):
            start = time.perf_counter()
            run()
            taken.append(time.perf_counter() - start)
    return [min(taken) for taken in times]


def beside_xdyn(v: Vehicle, python: str) -> None:
    """Steps a second; what each side spends before its first step is taken off by a short run."""
    text = xdyn.render(torpedo())["file.yml"].decode().replace("values: [0.0]", f"values: [{RUDDER}]")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "model.yml").write_text(text, encoding="utf-8")
        runner = str(ROOT / "tests" / "consumers" / "run_lxdyn.py")

        def theirs(seconds: float) -> None:
            command = [python, runner, "model.yml", str(seconds), str(STEP)]
            subprocess.run(command, cwd=folder, check=True, capture_output=True)

        def ours(seconds: float) -> None:
            march(v, turning(v, OFTEN * seconds), STEP, kernel="compiled")

        times = best(*(lambda f=f, s=s: f(s) for f in (theirs, ours) for s in (SHORT, LONG)))
    steps = (LONG - SHORT) / STEP
    their, our = steps / (times[1] - times[0]), OFTEN * steps / (times[3] - times[2])
    print(f"one vehicle, RK4 of {STEP} s, every step kept")
    print(f"  xdyn      {their:12,.0f} steps/s")
    print(f"  compiled  {our:12,.0f} steps/s")
    print(f"  ratio     {our / their:12.1f} (target: at least 20)")


def beside_lsoda(v: Vehicle) -> None:
    """The default, without numba, and solve_ivp on the same equations, tolerance and rows."""
    seconds, tolerance = 300.0, 1e-9
    plan = turning(v, seconds)
    dynamics, rudder = alone(v).dynamics(np.zeros(3)), np.array([[RUDDER], [0.0], [0.0]])
    wrench = v.wrench({"thrust": v.resistance(v.speed)})[:, None]
    first = np.zeros(14)
    first[[3, 7]] = 1.0, v.speed
    rows = np.arange(0.0, seconds + 0.5, 1.0)

    one, angles, pushed = rates_of_one(dynamics), rudder[:, 0].tolist(), wrench[:, 0].tolist()

    def in_arrays(_: float, state: np.ndarray) -> np.ndarray:
        return dynamics.rates(state[:, None], rudder, wrench)[:, 0]

    def in_numbers(_: float, state: np.ndarray) -> list[float]:
        return one(state.tolist(), angles, pushed)

    def theirs(rates: Callable[[float, np.ndarray], object] = in_arrays) -> object:
        return solve_ivp(rates, (0.0, seconds), first, "LSODA", rows, rtol=tolerance, atol=tolerance)

    def ours() -> object:
        return rigid_body.simulate(v, plan, {"tolerance": tolerance, "record": 1.0})

    gap = np.abs(theirs().y[:3, -1] - ours().position[-1]).max()  # type: ignore[attr-defined]
    their, lent, our = best(theirs, lambda: theirs(in_numbers), ours)
    print(f"one vehicle, {seconds:.0f} s, default of the simulator (no numba); both end within {gap:.1e} m")
    print(f"  solve_ivp {their:12.4f} s on rates in numpy, {lent:.4f} s on our rates in plain numbers")
    print(f"  simulate  {our:12.4f} s")
    print(f"  ratio     {their / our:12.2f} (target: at least 1); {lent / our:.2f} with our rates lent to solve_ivp")


def many(v: Vehicle) -> None:
    """A thousand members beside one after another in numpy."""
    draws = v.law.coefficient * (1.0 + 0.05 * np.random.default_rng(1).standard_normal((MEMBERS, len(v.terms))))
    ensemble = Ensemble(v, draws)
    plan, short = turning(v, 20.0), turning(v, 4.0)

    def together(kernel: str) -> None:
        march(ensemble, plan, STEP, 1.0, kernel)

    def one() -> None:
        march(ensemble.member(0), short, STEP, 1.0, "numpy")

    plain, compiled, loop = best(lambda: together("numpy"), lambda: together("compiled"), one)
    busy = time.process_time()
    together("compiled")
    busy = time.process_time() - busy
    steps = MEMBERS * 20.0 / STEP
    alone_rate = 4.0 / STEP / loop
    print(f"{MEMBERS} vehicles, RK4 of {STEP} s, {os.cpu_count()} cores")
    print(f"  one at a time, numpy  {alone_rate:12,.0f} vehicle-steps/s")
    for name, seconds in (("together, numpy", plain), ("together, compiled", compiled)):
        print(f"  {name:20s}  {steps / seconds:12,.0f} vehicle-steps/s, ratio {steps / seconds / alone_rate:.0f}")
    print(f"  compiled, of every second of a core's own time: {steps / busy:,.0f} vehicle-steps")
    print("  targets: ratio at least 100, over 1,000,000 vehicle-steps/s")


def main() -> None:
    v = vehicle(torpedo())
    march(v, turning(v, 1.0), STEP, kernel="compiled")
    python = sys.argv[1] if len(sys.argv) > 1 else str(PYTHON)
    if Path(python).exists():
        beside_xdyn(v, python)
    else:
        print("lxdyn is not installed: python3 tests/consumers/lxdyn_environment.py")
    beside_lsoda(v)
    many(v)


if __name__ == "__main__":
    main()
