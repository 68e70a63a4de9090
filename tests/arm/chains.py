"""The shipped arm, drawn arms, and the same as models of Pinocchio."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from coeflab.arm.arm_file import read_chain
from coeflab.arm.chain import Base, Chain, Joint, Link, Strip
from coeflab.core.files import shipped
from coeflab.core.types import Array

Q = np.array([0.3, -0.7, 0.5])
PAPER_SPEEDS = np.array([0.5, -0.2, 0.1, 0.05, -0.1, 0.2, 0.4, -0.3, 0.6])  # in the paper's frame 0


@cache
def puma() -> Chain:
    return read_chain(shipped("geometry") / "urv_puma")


def dry(chain: Chain, gravity: float = 0.0) -> Chain:
    """Without water."""
    links = tuple(replace(one, added_mass=np.zeros((6, 6)), strips=(), volume=0.0) for one in chain.links)
    base = replace(chain.base, added_mass=np.zeros((6, 6)), drag_area=np.zeros(3), volume=0.0)
    return replace(chain, base=base, links=links, gravity=gravity)


def ideal(chain: Chain, gravity: float = 0.0) -> Chain:
    """In ideal water: added mass, no drag; joints without limits."""
    links = tuple(replace(one, strips=(), joint=replace(one.joint, low=-np.inf, high=np.inf)) for one in chain.links)
    return replace(chain, links=links, base=replace(chain.base, drag_area=np.zeros(3)), gravity=gravity)


def _inertia(rng: np.random.Generator, size: float) -> Array:
    points = rng.normal(size=(6, 3)) * size
    return np.asarray(np.sum([p @ p * np.eye(3) - np.outer(p, p) for p in points], axis=0))


def _water(rng: np.random.Generator, size: float) -> Array:
    root = rng.normal(size=(6, 6)) * size
    return np.asarray(root @ root.T)


def drawn(seed: int, count: int = 6) -> Chain:
    """An arm of revolute and prismatic joints whose every number is drawn; its added mass couples all motions."""
    rng = np.random.default_rng(seed)
    links = []
    for k in range(count):
        kind: Any = "prismatic" if k % 3 == seed % 3 else "revolute"
        joint = Joint(f"joint_{k}", kind, *rng.normal(size=4))
        ends = rng.normal(size=(2, 3))
        links.append(
            Link(
                f"link_{k}", joint, float(rng.uniform(1.0, 9.0)), rng.normal(size=3), _inertia(rng, 0.6), _water(rng, 0.7),
                float(rng.uniform(1e-3, 1e-2)), rng.normal(size=3), (Strip(ends[0], ends[1], 0.1, 1.1),),
            )
        )  # fmt: skip
    base = Base("base", 40.0, _inertia(rng, 1.5), _water(rng, 3.0), 0.05, rng.normal(size=3), np.array([0.1, 0.2, 0.3]))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return Chain("drawn", base, tuple(links), rng.normal(size=3), turn * np.sign(np.linalg.det(turn)))


def state(chain: Chain, seed: int = 0) -> Array:
    rng = np.random.default_rng(seed)
    out = rng.normal(size=13 + 2 * chain.count)
    out[3:7] /= np.linalg.norm(out[3:7])
    return out


def pinocchio_model(chain: Chain) -> Any:
    """The bodies of a chain, without water, gravity along NED's down."""
    import pinocchio as pin

    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, chain.gravity])
    last = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    model.appendBodyToJoint(last, pin.Inertia(chain.base.mass, np.zeros(3), chain.base.inertia), pin.SE3.Identity())
    place = pin.SE3(np.array(chain.mount), np.array(chain.attachment))
    for link in chain.links:
        j = link.joint
        kind = pin.JointModelRZ() if j.turns else pin.JointModelPZ()
        last = model.addJoint(last, kind, place, j.name)
        about_z = pin.SE3(pin.utils.rotate("z", j.theta), np.array([0.0, 0.0, j.d]))
        place = about_z * pin.SE3(pin.utils.rotate("x", j.alpha), np.array([j.a, 0.0, 0.0]))
        model.appendBodyToJoint(last, pin.Inertia(link.mass, link.centre_of_mass, link.inertia), place)
    return model


def pinocchio_position(state: Array, count: int) -> Array:
    w, x, y, z = state[3:7]
    return np.concatenate([state[:3], [x, y, z, w], state[7 : 7 + count]])
