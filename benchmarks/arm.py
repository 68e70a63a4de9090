"""Time of a call of M and of C: coeflab's numpy and compiled routes and Pinocchio, the shipped PUMA and an arm of six links.

python benchmarks/arm.py
"""

from __future__ import annotations

import timeit
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pinocchio as pin

from coeflab.core.files import shipped
from coeflab.motion.multibody import compiled, kane
from coeflab.motion.multibody.arm_file import read_chain
from coeflab.motion.multibody.chain import Chain

REPEATS = 7


def microseconds(call: Callable[[], object], number: int) -> float:
    """Best of several, which other work on the machine disturbs least."""
    call()
    return min(timeit.repeat(call, number=number, repeat=REPEATS)) / number * 1e6


def model_of(chain: Chain) -> pin.Model:
    model = pin.Model()
    last = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    model.appendBodyToJoint(last, pin.Inertia(chain.base.mass, np.zeros(3), chain.base.inertia), pin.SE3.Identity())
    place = pin.SE3(np.array(chain.mount), np.array(chain.attachment))
    for link in chain.links:
        j = link.joint
        last = model.addJoint(last, pin.JointModelRZ() if j.turns else pin.JointModelPZ(), place, j.name)
        place = pin.SE3(pin.utils.rotate("z", j.theta), np.array([0.0, 0.0, j.d]))
        place = place * pin.SE3(pin.utils.rotate("x", j.alpha), np.array([j.a, 0.0, 0.0]))
        model.appendBodyToJoint(last, pin.Inertia(link.mass, link.centre_of_mass, link.inertia), place)
    return model


def main() -> None:
    puma = read_chain(shipped("geometry") / "urv_puma")
    renamed = [replace(one, joint=replace(one.joint, name=f"{one.joint.name}_2")) for one in puma.links]
    print(
        f"{'links':>5} {'':8} {'numpy':>9} {'compiled':>9} {'Pinocchio':>9}  compiled/Pinocchio   (microseconds a call)"
    )
    for chain in (puma, replace(puma, links=(*puma.links, *renamed))):
        n = chain.count
        rng = np.random.default_rng(1)
        q, speeds = rng.normal(size=n), rng.normal(size=6 + n)
        frame, bodies, nodes = compiled.packed(chain)
        water, control = np.zeros(6), np.zeros(6 + n)
        state = np.concatenate([np.zeros(3), [1.0, 0.0, 0.0, 0.0], q, speeds])
        model = model_of(chain)
        data = model.createData()
        at = np.concatenate([np.zeros(6), [1.0], q])
        for name, numpy_route, quick, peer in (
            (
                "M",
                lambda: kane.mass_matrix(chain, q),
                lambda: compiled.mass_matrix(frame, bodies, q),
                lambda: pin.crba(model, data, at),
            ),
            (
                "C",
                lambda: kane.bias(chain, q, speeds),
                lambda: compiled.bias(frame, bodies, q, speeds, water),
                lambda: pin.nonLinearEffects(model, data, at, speeds),
            ),
            (
                "rates",
                lambda: kane.right_hand_side(chain, state, control),
                lambda: compiled.rates(frame, bodies, nodes, state, control, water),
                lambda: pin.aba(model, data, at, speeds, control),
            ),
        ):
            slow, fast, other = microseconds(numpy_route, 50), microseconds(quick, 5000), microseconds(peer, 5000)
            print(f"{n:5d} {name:8} {slow:9.1f} {fast:9.2f} {other:9.2f}  {fast / other:.2f}")


if __name__ == "__main__":
    main()
