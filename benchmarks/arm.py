"""Time of a call of M, C and all rates of a vehicle with an arm: numpy, compiled and Pinocchio, on three links and on six.

python benchmarks/arm.py
Pinocchio knows no water: our M and C hold added mass and our rates drag, weight and buoyancy besides. The best of several counts.
"""

from __future__ import annotations

import sys
import timeit
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from coeflab.arm import compiled, kane
from coeflab.arm.arm_file import read_chain
from coeflab.arm.chain import Chain
from coeflab.core.files import shipped
from tests.arm.chains import pinocchio_model

REPEATS = 7


def microseconds(call: Callable[[], object], number: int) -> float:
    call()
    return min(timeit.repeat(call, number=number, repeat=REPEATS)) / number * 1e6


def timed(chain: Chain) -> None:
    n = chain.count
    rng = np.random.default_rng(1)
    q, speeds = rng.normal(size=n), rng.normal(size=6 + n)
    frame, bodies, nodes = compiled.packed(chain)
    water, control = np.zeros(6), np.zeros(6 + n)
    state = np.concatenate([np.zeros(3), [1.0, 0.0, 0.0, 0.0], q, speeds])
    at = np.concatenate([np.zeros(6), [1.0], q])
    model = pinocchio_model(chain)
    data = model.createData()
    plain = {
        "M": lambda: kane.mass_matrix(chain, q),
        "C": lambda: kane.bias(chain, q, speeds),
        "rates": lambda: kane.right_hand_side(chain, state, control),
    }
    quick = {
        "M": lambda: compiled.mass_matrix(frame, bodies, q),
        "C": lambda: compiled.bias(frame, bodies, q, speeds, water),
        "rates": lambda: compiled.rates(frame, bodies, nodes, state, control, water),
    }
    peer = {
        "M": lambda: pin.crba(model, data, at),
        "C": lambda: pin.nonLinearEffects(model, data, at, speeds),
        "rates": lambda: pin.aba(model, data, at, speeds, control),
    }
    for name, call in plain.items():
        slow, fast, other = microseconds(call, 50), microseconds(quick[name], 5000), microseconds(peer[name], 5000)
        print(f"{n:5d} {name:6} {slow:9.1f} {fast:9.2f} {other:9.2f} {fast / other:19.2f}")


def main() -> None:
    puma = read_chain(shipped("geometry") / "urv_puma")
    more = [replace(one, joint=replace(one.joint, name=f"{one.joint.name}_2")) for one in puma.links]
    print("microseconds a call")
    print(f"{'links':>5} {'':6} {'numpy':>9} {'compiled':>9} {'Pinocchio':>9} {'compiled/Pinocchio':>19}")
    for chain in (puma, replace(puma, links=(*puma.links, *more))):
        timed(chain)


if __name__ == "__main__":
    main()
