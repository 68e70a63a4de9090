"""A motion of a vehicle with an arm from its body.toml, and its pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from coeflab.arm.arm_file import BODY, read_arm
from coeflab.arm.chain import Chain
from coeflab.arm.figures import animation, hull_of, simulated, simulated_sheet
from coeflab.arm.manoeuvres import MANOEUVRES
from coeflab.arm.readers.arm import read
from coeflab.core.errors import InputError
from coeflab.core.options import described
from coeflab.core.text.toml import read_toml
from coeflab.motion.manoeuvre import Manoeuvre
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.trajectory import Trajectory


def moved_by(body: Path, name: str, options: Mapping[str, Any]) -> tuple[Chain, Manoeuvre, Trajectory]:
    """Read a body.toml and make a manoeuvre; what its keys are to blame for names their lines.

    Parameters
    ----------
    body : Path
        A body.toml or its folder.
    name : str
        Of a manoeuvre.
    options : mapping of str to value
        Of the manoeuvre and of the simulator.

    Raises
    ------
    InputError
        With file and line, or with the option.
    """
    own = {o.name for o in described(MANOEUVRES[name].options)} if name in MANOEUVRES else set()
    simulator = SIMULATORS.load("arm")
    known = own | {o.name for o in described(simulator.Options)}
    if name in MANOEUVRES and (strange := [option for option in options if option not in known]):
        expected = f"one of {', '.join(sorted(known))}"
        option = f"--{strange[0].replace('_', '-')}"
        raise InputError(f"{option} for {name}", expected, column=option, advice="See --help-options.")
    texts = {k: v if k in ("lasts", "stays") else str(v) for k, v in options.items() if k in own}
    arm = read_arm(body, name, texts)
    stated = {f.name: getattr(arm.controller, f.name) for f in fields(arm.controller)}
    stated["knows_current"] = "yes" if arm.controller.knows_current else "no"
    try:
        with SIMULATORS.guarded("arm"):
            how = {k: v for k, v in options.items() if k not in own}
            return arm.chain, arm.manoeuvre, simulator.simulate(arm.chain, arm.manoeuvre, stated | how)
    except InputError as why:
        column = "" if why.file is not None or why.column is None else why.column
        toml = read_toml(body / BODY if body.is_dir() else body)
        place, _, key = column.partition(".")
        if column == "thruster":
            raise toml.fail(column, why.found, why.expected, why.advice) from None
        if not place.startswith("phase["):
            raise
        place = arm.places[int(place[6:-1])]
        if not place:
            raise why.at(column=f"--{key}") from None
        raise toml.fail(f"{place}.{key}", why.found, why.expected, why.advice) from None


def pictures(body: Path, chain: Chain, name: str, moved: Trajectory) -> dict[str, bytes]:
    """Joints, torques, thrusts and the path of the end effector as a drawing, and a page that plays the motion."""
    motion = simulated(chain, hull_of(read(body / "body.toml" if body.is_dir() else body)), moved)
    what = "motion" if name == "arm_motion" else name.replace("_", " ")
    words = f"{what.capitalize()} of {chain.name} over {float(moved.time[-1]):.3g} s: {', '.join(moved.phases)}."
    return {
        f"{name}.svg": simulated_sheet(motion, moved),
        f"{name}.html": animation(motion, f"{what.capitalize()} of {chain.name}", words),
    }
