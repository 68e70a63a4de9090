"""The list of mutations: one wrong sign, constant or axis each, and, where none can notice, why."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any
from unittest.mock import patch

import numpy as np

from coeflab.core.files import shipped
from coeflab.glider import motion as glider_motion
from coeflab.glider import space
from coeflab.glider.glider import Glider
from coeflab.glider.masses import MassModel
from coeflab.glider.space import SpaceBody
from coeflab.identify import thruster
from coeflab.law import rigid_body
from coeflab.law.rigid_body import momentum_quadratics, weighed
from coeflab.motion import media, steady_turns
from coeflab.motion.integrators.adaptive import _Phase
from coeflab.motion.manoeuvres import steady_motion
from coeflab.published import parameter_files
from coeflab.published.flyingfish import equations as aerial
from coeflab.published.flyingfish import model as flyingfish_model
from coeflab.published.flyingfish import motions
from coeflab.published.flyingfish.model import FlyingFish
from coeflab.published.flyingfish.rotors import rotor_wrench
from coeflab.published.huuv import five_dof, five_dof_file
from coeflab.published.huuv import model as huuv_model
from tests.mutations.arm import URV
from tests.mutations.blind import BLIND, flipped
from tests.mutations.harness import (
    REMUS,
    Suboff,
    Verdicts,
    edited,
    exchanged,
    fish,
    in_five,
    refusals,
    steered,
    validate_estimates,
    validate_fish_bench,
    validate_fish_trims,
    validate_five,
    validate_flyingfish,
    validate_huuv,
    validate_remus,
    validate_tank,
    validate_thauv,
    validate_thauv_in_space,
    validate_urv,
)

TENTH, TWENTIETH, FLIP = 1.1, 1.05, -1.0


@dataclass(frozen=True)
class Mutation:
    """One mutation.

    Attributes
    ----------
    study : str
        Which validation ought to notice.
    what : str
    run : callable
        The validation with the mutation in it; of SUBOFF it is handed the study.
    why_not : str
        Why no compared quantity depends on it; empty where it must be caught.
    """

    study: str
    what: str
    run: Callable[[Suboff], Verdicts]
    why_not: str = ""


def scaled(values: Any, index: Any, factor: float) -> Any:
    """A copy of an array with one entry times a factor."""
    out = np.array(values, dtype=float)
    out[index] *= factor
    return out


def in_place_of(function: Any, old: str, new: str, validate: Callable[[], Verdicts], times: int = 1) -> Verdicts:
    """A validation while a piece of a law's text is another."""
    with edited(function, old, new, times):
        return refusals(validate)


# ---- THAUV ---------------------------------------------------------------------------------------------------------


def glider(change: Callable[[Glider], Glider], cases: tuple[int, ...] = (0, 1, 2)) -> Callable[[Suboff], Verdicts]:
    """Some cases changed alike."""
    return lambda _: refusals(lambda: validate_thauv(change, cases))


def mass(**factors: float) -> Callable[[Suboff], Verdicts]:
    """Some of the masses times a factor."""
    return glider(lambda g: replace(g, mass=replace(g.mass, **{k: getattr(g.mass, k) * f for k, f in factors.items()})))


def polar(**factors: float) -> Callable[[Suboff], Verdicts]:
    """Some factors of the polar times a factor."""
    return glider(
        lambda g: replace(g, polar=replace(g.polar, **{k: getattr(g.polar, k) * f for k, f in factors.items()}))
    )


def glider_law(old: str, new: str) -> Callable[[Suboff], Verdicts]:
    """Another right-hand side of the glider's equations; one case flies, the others are as they were."""
    unchanged = lambda g: g  # noqa: E731
    return lambda _: in_place_of(glider_motion.rates, old, new, lambda: validate_thauv(unchanged, (0,)))


def in_space_law(function: Any, old: str, new: str) -> Callable[[Suboff], Verdicts]:
    """Another law of masses or of the motion in space."""
    return lambda _: in_place_of(function, old, new, validate_thauv_in_space)


def in_space(change: Callable[[MassModel], MassModel]) -> Callable[[Suboff], Verdicts]:
    """Other masses."""

    def changed(g: Glider) -> Glider:
        assert g.masses is not None
        return replace(g, masses=change(g.masses))

    return lambda _: refusals(lambda: validate_thauv_in_space(changed))


THAUV = (
    ("sign of -m3 v3 q in equation 17", glider_law("-p3 * q - net_mass", "p3 * q - net_mass")),
    ("sign of m1 v1 q in equation 18, as printed", glider_law("p1 * q + net_mass", "-p1 * q + net_mass")),
    ("sign of the Munk moment in equation 19", glider_law("p3 * v1 - p1 * v3", "p1 * v3 - p3 * v1")),
    ("sign of depth", glider_law("v3 * c - v1 * s,", "v1 * s - v3 * c,")),
    ("sign of the distance over ground", glider_law("v1 * c + v3 * s,", "-v1 * c - v3 * s,")),
    ("lift along the velocity's normal reversed", glider_law("lift * v3 - drag * v1", "-lift * v3 - drag * v1")),
    ("J x10", mass(pitch_inertia=10.0)),
    ("pitch damping x3", polar(pitch_damping=3.0)),
    ("sign of the moment below (buoyancy arm)", mass(moment_below=FLIP)),
    ("m3 +5 %", mass(heave=TWENTIETH)),
    ("angle of Table 3 in radians", glider(lambda g: replace(g, polar=replace(g.polar, angle_unit="rad")))),
    ("Munk moment already in the polar", glider(lambda g: replace(g, polar=replace(g.polar, contains_munk=True)))),
    ("g +5 %", glider(lambda g: replace(g, gravity=g.gravity * TWENTIETH))),
    (
        "a piston counts twice in equation 2",
        in_space_law(MassModel.centre_of_gravity, "self.piston * right", "2.0 * self.piston * right"),
    ),
    ("sign of R sin(gamma) in equation 4", in_space_law(MassModel.roller_place, "y + arm * sin", "y - arm * sin")),
    ("sign of R (1 - cos(gamma)) in equation 4", in_space_law(MassModel.roller_place, "z - (arm", "z + (arm")),
    ("water of equation 5 +5 %", in_space_law(MassModel.ballast, "self.density * pi", "1.05 * self.density * pi")),
    ("sign of 2 m_b in equation 6", in_space_law(MassModel.displaced, "self.total - 2.0", "self.total + 2.0")),
    ("sign of equation 7", in_space_law(MassModel.centre_of_buoyancy, "-self.ballast", "self.ballast")),
    (
        "sign of the attitude's rate in equation 10",
        in_space_law(space.rates_in_space, "-b * p - c * q - d * r", "b * p + c * q + d * r"),
    ),
    ("handedness of R in equation 8", in_space_law(space.rotation, "2.0 * (b * c - a * d)", "2.0 * (b * c + a * d)")),
    ("sign of P x w in equation 13", in_space_law(space.pushed, "np.cross(p, turn)", "np.cross(turn, p)")),
    ("sign of H x w in equation 12", in_space_law(space.pushed, "np.cross(h, turn)", "np.cross(turn, h)")),
    ("sign of M v x v in equation 12", in_space_law(space.pushed, "np.cross(p, v)", "np.cross(v, p)")),
    ("sign of the net weight in equation 13", in_space_law(space.pushed, "+ setting.net_mass", "- setting.net_mass")),
    (
        "sign of the masses' moment in equation 12",
        in_space_law(space.pushed, "np.cross(body.moments(setting), down)", "np.cross(down, body.moments(setting))"),
    ),
    ("sign of the side force", in_space_law(SpaceBody.water, "side = -s.K_S", "side = s.K_S")),
    ("sign of the yaw moment of sideslip", in_space_law(SpaceBody.water, "s.K_Y * beta", "-s.K_Y * beta")),
    ("sign of the yaw damping", in_space_law(SpaceBody.water, "- s.yaw_damping", "+ s.yaw_damping")),
    ("lift +5 % in space", in_space_law(SpaceBody.water, "lift = (polar", "lift = 1.05 * (polar")),
    ("drag +5 % in space", in_space_law(SpaceBody.water, "drag = (polar", "drag = 1.05 * (polar")),
    (
        "thrusters exchanged",
        in_space_law(SpaceBody.thrust, "setting.left - setting.right", "setting.right - setting.left"),
    ),
    ("roller's mass +5 %", in_space(lambda m: replace(m, roller=m.roller * TWENTIETH))),
    ("radius of the pistons +5 %", in_space(lambda m: replace(m, piston_radius=m.piston_radius * TWENTIETH))),
)


# ---- TJ-FlyingFish -------------------------------------------------------------------------------------------------


def of_fish(change: Callable[[FlyingFish], FlyingFish]) -> Callable[[Suboff], Verdicts]:
    """The published data changed."""
    return lambda _: refusals(lambda: validate_flyingfish(change(fish())))


def rotors(name: str, index: int, factor: float) -> Callable[[Suboff], Verdicts]:
    """One factor of damping, thrust or torque."""
    return of_fish(
        lambda f: replace(f, rotors=replace(f.rotors, **{name: scaled(getattr(f.rotors, name), index, factor)}))
    )


def fish_law(function: Any, old: str, new: str, times: int = 1) -> Callable[[Suboff], Verdicts]:
    """Another law of motion under the parameter file, or other equations."""
    return lambda _: in_place_of(function, old, new, lambda: validate_flyingfish(fish()), times)


def handed(f: FlyingFish) -> FlyingFish:
    """Rotor 1 turns the other way."""
    first, *others = f.handedness
    return replace(f, handedness=(-first, *others))


def constant(name: str, factor: float) -> Callable[[Suboff], Verdicts]:
    """One calibrated constant."""
    return of_fish(lambda f: replace(f, constants=f.constants | {name: f.constants[name] * factor}))


def trims_law(names: str, function: Any, old: str, new: str) -> Callable[[Suboff], Verdicts]:
    """Another law under the trims and what is flown from them."""
    return lambda _: in_place_of(function, old, new, lambda: validate_fish_trims(fish(), *names.split()))


def bench_law(old: str, new: str) -> Callable[[Suboff], Verdicts]:
    """Another identification of the bench tests."""
    return lambda _: in_place_of(thruster.bench_test, old, new, lambda: validate_fish_bench(fish()))


TRIMS = (
    (
        "rotors in air push down",
        trims_law("hovering", flyingfish_model.thrusters, "1.0 if wet else -1.0", "1.0 if wet else 1.0"),
    ),
    ("thrust in the parameter file +5 %, hovering", trims_law("hovering", flyingfish_model.thrusters, "map(float, factors)", "map(float, 1.05 * factors)")),
    (
        "damping in air +5 %, flight ahead",
        lambda _: refusals(lambda: validate_fish_trims(replace(fish(), air=fish().air * TWENTIETH), "hovering")),
    ),
    ("sides of the rotors in the parameter file", trims_law("both_readings", flyingfish_model.thrusters, "y * length", "-y * length")),
    ("height of the rotors in the parameter file +5 %", trims_law("both_readings", flyingfish_model.thrusters, "-height)", "-1.05 * height)")),
    ("trims by equation 40 as printed", trims_law("both_readings", motions.craft, "x[None, 4:], -1.0)", "x[None, 4:], 1.0)")),
    ("sign of the turn of a helix", trims_law("tracks", steady_motion.helix, "north * aside + east", "-north * aside + east")),
    ("rate of heading of a helix +5 %", trims_law("tracks", steady_motion.helix, "turned = yaw_rate", "turned = 1.05 * yaw_rate")),
    ("sign of m v x r under the tracks", trims_law("tracks", momentum_quadratics, "out[:3, 3:, :] -= ", "out[:3, 3:, :] += ")),
)  # fmt: skip
BENCHES = (
    ("equations 41 and 43: thrust of the bench +5 %", bench_law("design, table[:, k],", "design, (1.05 if load == 'thrust' else 1.0) * table[:, k],")),
    ("equations 41 and 43: sign of the thrust of the bench", bench_law("design, table[:, k],", "design, (-1.0 if load == 'thrust' else 1.0) * table[:, k],")),
    ("equations 42 and 44: torque of the bench +5 %", bench_law("design, table[:, k],", "design, (1.05 if load == 'torque' else 1.0) * table[:, k],")),
    ("equations 42 and 44: sign of the torque of the bench", bench_law("design, table[:, k],", "design, (-1.0 if load == 'torque' else 1.0) * table[:, k],")),
    ("equations 41 to 44: square of the rotor speed +5 %", bench_law("command, squares = table[:, 0], table[:, 1]", "command, squares = table[:, 0], 1.05 * table[:, 1]")),
    ("equations 41 to 44: n^3 for n^2", bench_law("_design(command, squares,", "_design(command, command * squares,")),
)  # fmt: skip

FLYINGFISH = (
    ("Yv|v| +5 %", rotors("quadratic", 1, TWENTIETH)),
    ("Kp|p| x10", rotors("quadratic", 3, 10.0)),
    ("damping in air x100", of_fish(lambda f: replace(f, air=f.air * 100.0))),
    ("handedness of rotor 1", of_fish(handed)),
    ("rotors 1 and 2 exchanged", of_fish(lambda f: replace(f, arms=f.arms[[1, 0, 2, 3]]))),
    ("thrust factor +5 %", rotors("thrust", 1, TWENTIETH)),
    ("torque factor +5 %", rotors("torque", 1, TWENTIETH)),
    ("sign of the buoyancy moment", constant("buoyancy_moment", FLIP)),
    ("mass +5 %", constant("mass", TWENTIETH)),
    (
        "sign of the lever in equation 40",
        fish_law(rotor_wrench, "lever * np.sum(across", "-lever * np.sum(across"),
    ),
    (
        "sign of m u r in equation 52",
        fish_law(flyingfish_model.steady_residuals, "mass * u * r - weight", "-mass * u * r - weight"),
    ),
    ("sign of the restoring roll moment", fish_law(weighed, "ly * gz - lz * gy", "lz * gy - ly * gz")),
    (
        "sign of weight less buoyancy",
        fish_law(weighed, "excess * gx, excess * gy, excess * gz", "-excess * gx, -excess * gy, -excess * gz"),
    ),
    (
        "sign of the Coriolis forces of the mass, m v x r",
        fish_law(momentum_quadratics, "out[:3, 3:, :] -= ", "out[:3, 3:, :] += "),
    ),
    ("sign of v r in equation 7", fish_law(aerial.body_rates, "x / mass + v * r", "x / mass - v * r")),
    ("sign of u q in equation 9", fish_law(aerial.body_rates, "+ u * q", "- u * q")),
    ("sign of (I_z - I_y) q r in equation 10", fish_law(aerial.body_rates, "(k - (iz - iy)", "(k + (iz - iy)")),
    ("sign of (I_x - I_y) p q in equation 12", fish_law(aerial.body_rates, "(n + (ix - iy)", "(n - (ix - iy)")),
    ("weight +5 % in equations 7 to 9", fish_law(aerial.body_rates, "g = gravity * ", "g = 1.05 * gravity * ")),
    ("sign of the righting moment in equation 23", fish_law(aerial.body_rates, "+ righting * st", "- righting * st")),
    (
        "sign of cos phi sin psi in equation 1",
        fish_law(aerial.earth_rates, "(cf * sp - cp * sf * st)", "(cf * sp + cp * sf * st)"),
    ),
    (
        "sign of r cos phi tan theta in equation 4",
        fish_law(aerial.earth_rates, "+ r * cf * st / ct", "- r * cf * st / ct"),
    ),
    (
        "thrust in air down, equation 31 as printed",
        fish_law(aerial.aerial_wrench, "if as_printed else -1.0", "if as_printed else 1.0"),
    ),
    ("sign of the pitch moment in equation 33", fish_law(aerial.aerial_wrench, "(t3 - t4) * arm", "(t4 - t3) * arm")),
    ("thrust factor in air +5 %", of_fish(lambda f: replace(f, rotor_air=scaled(f.rotor_air, (0, 1), TWENTIETH)))),
    ("torque factor in air +5 %", of_fish(lambda f: replace(f, rotor_air=scaled(f.rotor_air, (1, 1), TWENTIETH)))),
    ("damping in air +5 %", of_fish(lambda f: replace(f, air=f.air * TWENTIETH))),
    ("air with the forces of water", fish_law(media.through_media, "media[phases[0].medium], start", "vehicle, start")),
    (
        "change of medium at the end of a step",
        fish_law(_Phase.move, "now = float(brentq(", "_ = float(brentq("),
    ),
    (
        "speed lost at the surface",
        fish_law(media.through_media, "velocity=part.velocity[-1]", "velocity=0.95 * part.velocity[-1]"),
    ),
    *TRIMS,
    *BENCHES,
)


# ---- HUUV ----------------------------------------------------------------------------------------------------------


def of_huuv(**factors: float) -> Callable[[Suboff], Verdicts]:
    """Constants of the steady turns times a factor."""
    changed = {k: steered().constants[k] * f for k, f in factors.items()}
    return lambda _: refusals(lambda: validate_huuv(replace(steered(), constants=dict(steered().constants) | changed)))


def huuv_law(function: Any, old: str, new: str, times: int = 1) -> Callable[[Suboff], Verdicts]:
    """Another law."""
    return lambda _: in_place_of(function, old, new, lambda: validate_huuv(steered()), times)


def reversed_coriolis(_: Suboff) -> Verdicts:
    """All products of velocities in the equations of the turns: no power is lost."""
    features, sign = steady_turns.features, np.where(np.arange(13) < 5, -1.0, 1.0)

    def reversed_products(velocity: Any) -> Any:
        force, by = features(velocity)
        return force * sign, by * sign[:, None]

    with exchanged(features, reversed_products):
        return refusals(lambda: validate_huuv(steered()))


def reversed_added(_: Suboff) -> Verdicts:
    """Of the added mass, in the rates of the parameter file."""
    old = rigid_body.ideal_quadratics
    with exchanged(old, lambda m: -old(m)):
        return refusals(lambda: validate_huuv(steered()))


def of_five(name: str, factor: float) -> Callable[[Suboff], Verdicts]:
    """A constant of five_dof.toml times a factor."""
    changed = replace(in_five(), constants={**in_five().constants, name: in_five().constants[name] * factor})
    return lambda _: refusals(lambda: validate_five(changed))


def five_law(function: Any, old: str, new: str, times: int = 1) -> Callable[[Suboff], Verdicts]:
    """Another law in five degrees of freedom."""
    return lambda _: in_place_of(function, old, new, lambda: validate_five(in_five()), times)


FIVE = (
    *(
        (f"five_dof.toml: {name} +5 %", of_five(name, TWENTIETH))
        for name in ("centre_below", "displaced", "tuned_by", "area", "length", "lever", "C_D2", "C_L1", "C_m1")
    ),
    ("equation 5 as printed: sign of the lift", five_law(five_dof.hull_damping, "* side - sa * lift", "* side + sa * lift")),
    ("equation 5 as printed: side force without cos(alpha)", five_law(five_dof.hull_damping, "ca * sb * side", "sb * side")),
    ("equation 7 as printed: no side force", five_law(five_dof.hull_damping, " - sa * sb * side", "")),
    ("equation 11: sign of the pitching moment", five_law(five_dof.hull_damping, "pitching + mq", "mq - pitching")),
    ("equation 14: sign of the elevators' lever", five_law(five_dof.elevator_damping, '+ c["lever"]', '- c["lever"]')),
    ("elevators counted twice at no deflection", five_law(five_dof.elevator_damping, "(deflected - still)", "deflected")),
    ("equation 1: sign of m_z z_CG in C", five_law(five_dof.coriolis, "along + surge * q", "along - surge * q")),
    ("erratum 6: sign of the righting moment", five_law(five_dof.restoring, "out[:, 3] = ", "out[:, 3] = -")),
    ("sign of weight less buoyancy in g", five_law(five_dof.restoring, "huuv.weight - huuv.buoyancy", "huuv.buoyancy - huuv.weight")),
    ("equation 30 as printed: c^2 b^3", five_law(five_dof.simple_masses, "short**2 * wide", "short**2 * wide**3")),
    ("equation 31 as printed: L_m^3", five_law(five_dof.simple_masses, "((r + tall) ** 3 - r**3)", "tall**3")),
    ("slope of C_m(alpha): sign of the Munk moment", five_law(five_dof.pitch_slope, "added[2, 2] - added[0, 0]", "added[0, 0] - added[2, 2]")),
    ("sign of the lift in the parameter file", five_law(five_dof_file.five_dof_file, 'c["s1"] / by', '-c["s1"] / by')),
    ("delta + alpha in the parameter file", five_law(vars(five_dof_file)["_effective"], "(-1.0) ** k", "1.0")),
)  # fmt: skip

HUUV = (
    (
        "reverse thrust x5",
        lambda _: refusals(
            lambda: validate_huuv(replace(steered(), reverse=(5.0 * steered().reverse[0], 5.0 * steered().reverse[1])))
        ),
    ),
    ("moments of inertia x10", of_huuv(inertia=10.0)),
    *((f"{name} +5 %", of_huuv(**{name: TWENTIETH})) for name in ("d0", "d2", "s1", "s3", "n1", "n3", "nrr")),
    ("thruster arm +5 %", of_huuv(arm=TWENTIETH)),
    ("sign of the added mass m_y", of_huuv(my=FLIP)),
    ("sign of the added mass m_x", of_huuv(mx=FLIP)),
    ("sign of m_yr", of_huuv(myr=FLIP)),
    ("sign of the Coriolis matrix in the equations", reversed_coriolis),
    (
        "sign of (m + m_x) u r",
        huuv_law(
            steady_turns.features, '(1, ("m", "mx"), -u * r, (-r, none, -u))', '(1, ("m", "mx"), u * r, (r, none, u))'
        ),
    ),
    ("sign of C_A of the parameter file", reversed_added),
    ("sign of the thrusters' moment", huuv_law(huuv_model.thrust_rates, "arm * (a - b)", "arm * (b - a)")),
    ("sign of the side force in the parameter file", huuv_law(huuv_model.parameter_file, '-c["s1"]', 'c["s1"]')),
    *FIVE,
)


# ---- SUBOFF --------------------------------------------------------------------------------------------------------

TOWED = ("suboff_roddy_1", "suboff_roddy_2", "suboff_roddy_3")


def suboff(edits: dict[str, list[tuple[str, str]]]) -> Callable[[Suboff], Verdicts]:
    """The plan on copies of its folders."""
    return lambda s: refusals(lambda: s.verdicts(s.rerun(edits)))


def campaign(name: str, *changes: tuple[str, str]) -> Callable[[Suboff], Verdicts]:
    """One campaign.toml."""
    return suboff({f"{name}/campaign.toml": list(changes)})


def published(*changes: tuple[str, str]) -> Callable[[Suboff], Verdicts]:
    """Roddy's printed values."""
    return suboff({"suboff/published.toml": list(changes)})


YR, NR = ('Yr = "0.005251"', 'Yr = "-0.005251"'), ('Nr = "-0.004444"', 'Nr = "0.004444"')
SUBOFF = (
    ("reference point of configuration 2 .5 m aft", campaign("suboff_roddy_2", ('["-6.6042 ft"', '["-8.2446 ft"'))),
    ("reference point of the plan .5 m aft", suboff({"suboff/plan.toml": [('["-6.6042 ft"', '["-8.2446 ft"')]})),
    ("length of configuration 2 +5 %", campaign("suboff_roddy_2", ('"13.9792 ft"', '"14.6782 ft"'))),
    ("length of the plan +5 %", suboff({"suboff/plan.toml": [('"13.9792 ft"', '"14.6782 ft"')]})),
    ("density of the plan +10 %", suboff({"suboff/plan.toml": [('"62.27456 lb/ft^3"', '"68.50202 lb/ft^3"')]})),
    ("density of the computation +10 %", campaign("suboff_cfd_barehull", ('"998 kg/m^3"', '"1097.8 kg/m^3"'))),
    ("density of configuration 2 +10 %", campaign("suboff_roddy_2", ('"62.27456 lb/ft^3"', '"68.50202 lb/ft^3"'))),
    ("speed of the computation +10 %", campaign("suboff_cfd_barehull", ('"2.0 m/s"', '"2.2 m/s"'))),
    (
        "Y and Z exchanged in configuration 2",
        suboff({"suboff_roddy_2/table.csv": [("Y' [-],Z' [-]", "Z' [-],Y' [-]")]}),
    ),
    (
        "sign of the drift angle in configuration 2",
        campaign("suboff_roddy_2", ("v = -U sin(beta)", "v = +U sin(beta)")),
    ),
    ("z up in configuration 1 (sign of Z and N)", campaign("suboff_roddy_1", ('frame = "FRD"', 'frame = "FLU"'))),
    ("literature Yr' with the other sign", published(YR)),
    ("literature Nr' with the other sign", published(NR)),
    ("literature Yr' and Nr' with the other signs", published(YR, NR)),
    ("literature Mq' with the other sign", published(('Mq = "-0.003702"', 'Mq = "0.003702"'))),
    ("mass m' +5 %", suboff({"geometry/suboff/body.toml": [("mass_prime = 0.018296", "mass_prime = 0.019211")]})),
)


# ---- REMUS ---------------------------------------------------------------------------------------------------------


def remus(*symbols: str) -> Callable[[Suboff], Verdicts]:
    """Parameters with the other sign."""
    return lambda _: refusals(lambda: validate_remus(REMUS | {s: -REMUS[s] for s in symbols}))


SIGNS = ("Xu|u|", "Yv|v|", "Yuv", "Yur", "Zuq", "Mq|q|", "Muw", "Nuv", "Nr|r|", "Nur", "Xvr", "Npq", "Yvdot", "Nvdot")


def heavier_to_turn(_: Suboff) -> Verdicts:
    """The moment of inertia that the parameter file of TJ-FlyingFish assumes, x10."""
    with patch.object(parameter_files, "FLYINGFISH_INERTIA", 10.0 * parameter_files.FLYINGFISH_INERTIA):
        return refusals(lambda: validate_flyingfish(fish()))


UNDETECTABLE = (
    Mutation(
        "thauv", "rate of the buoyancy engine +5 %",
        glider(lambda g: replace(g, engine=replace(g.engine, rate=g.engine.rate * TWENTIETH))),
        "assumed, not printed: it shifts the first half minute of a dive of which 170 s is printed to 10 s",
    ),
    Mutation(
        "flyingfish", "moments of inertia x10", heavier_to_turn,
        "assumed, not printed: every printed motion is steady, and a force is compared, not an acceleration",
    ),
    Mutation(
        "flyingfish", "largest rotor speed +5 %", of_fish(lambda f: replace(f, largest_speed=f.largest_speed * TWENTIETH)),
        "chosen, not printed: no printed motion reaches it",
    ),
    Mutation(
        "huuv", "moments of inertia +5 %", of_huuv(inertia=TWENTIETH),
        "chosen, not printed: the printed turns are steady; only x3 is more than a body of that length can have",
    ),
    Mutation(
        "suboff", "speed of configuration 2 +10 %", campaign("suboff_roddy_2", ('"6.5 kn"', '"7.15 kn"')),
        "Roddy prints Y' and N': neither slope nor index depends on the speed, and no viscosity is printed beside Re = 14e6",
    ),
)  # fmt: skip


def mutations() -> tuple[Mutation, ...]:
    """All of the list, in the order of the table."""
    named = (("thauv", THAUV), ("flyingfish", FLYINGFISH), ("huuv", HUUV), ("suboff", SUBOFF), ("urv", URV))
    out = [Mutation(study, what, run) for study, some in named for what, run in some]
    out.append(Mutation("suboff", "sign of N in the table of configuration 2", flipped("suboff_roddy_2", "N' [-]")))
    out += [Mutation("remus", f"sign of {s}", remus(s)) for s in SIGNS]
    out += [Mutation(study, what, run) for study, what, run in BLIND]
    return (*out, *UNDETECTABLE)


def unchanged(study: str, suboff_study: Suboff | None) -> Verdicts:
    """A validation as it is."""
    match study:
        case "thauv":
            plane, turned = validate_thauv(lambda g: g), validate_thauv_in_space()
            return Verdicts({**plane.rows, **turned.rows}, plane.checks)
        case "flyingfish":
            quick, trims = (
                validate_flyingfish(fish()),
                validate_fish_trims(fish(), "hovering", "both_readings", "tracks"),
            )
            return replace(quick, rows=quick.rows | trims.rows | validate_fish_bench(fish()).rows)
        case "huuv":
            level, five = validate_huuv(steered()), validate_five(in_five())
            return replace(level, rows=level.rows | five.rows)
        case "remus":
            return validate_remus(REMUS)
        case "urv":
            return validate_urv(controlled=True)
        case "tank":
            return validate_tank()
        case "estimates":
            return validate_estimates()
    return suboff_study.verdicts()


# ---- every constant ------------------------------------------------------------------------------------------------


def every_constant(study: str) -> tuple[tuple[str, Callable[[Suboff], Verdicts]], ...]:
    """Each constant of the shipped laws +5 % and with the other sign, by name."""
    return tuple(
        (f"{name} {'+5 %' if factor == TWENTIETH else 'flipped'}", run)
        for factor in (TWENTIETH, FLIP)
        for name, run in SWEEPS[study](factor)
    )


def _fish_constants(factor: float) -> Iterator[tuple[str, Callable[[Suboff], Verdicts]]]:
    for name, size in (("linear", 6), ("quadratic", 6), ("thrust", 2), ("torque", 2)):
        yield from ((f"{name}[{k}]", rotors(name, k, factor)) for k in range(size) if getattr(fish().rotors, name)[k])
    yield from ((name, constant(name, factor)) for name in fish().constants)
    for name, value in (("air", fish().air), ("rotor_air", fish().rotor_air), ("arms", fish().arms)):
        for at in np.argwhere(value).tolist():
            yield (
                f"{name}{at}",
                of_fish(lambda f, n=name, a=tuple(at): replace(f, **{n: scaled(getattr(f, n), a, factor)})),
            )


def _huuv_constants(factor: float) -> Iterator[tuple[str, Callable[[Suboff], Verdicts]]]:
    yield from ((name, of_huuv(**{name: factor})) for name, value in steered().constants.items() if value)
    for k, name in enumerate(("reverse intercept", "reverse slope")):
        changed = replace(steered(), reverse=tuple(scaled(steered().reverse, k, factor).tolist()))
        yield name, lambda _, h=changed: refusals(lambda: validate_huuv(h))
    changed = replace(steered(), dead_zone=steered().dead_zone * factor)
    yield "dead zone", lambda _: refusals(lambda: validate_huuv(changed))
    for name, value in steered().chosen.items():
        chosen = replace(steered(), chosen=dict(steered().chosen) | {name: value * factor})
        yield name, lambda _, h=chosen: refusals(lambda: validate_huuv(h))
    yield from ((f"five_dof {name}", of_five(name, factor)) for name in in_five().constants)


def _glider_constants(factor: float) -> Iterator[tuple[str, Callable[[Suboff], Verdicts]]]:
    for case in range(3):
        for name in ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M"):
            yield (
                f"{name} of case 0{case + 1}",
                lambda _, n=name, c=case: refusals(
                    lambda: validate_thauv(
                        lambda g: replace(g, polar=replace(g.polar, **{n: getattr(g.polar, n) * factor})), (c,)
                    )
                ),
            )
    # Of what all cases share the first flies alone.
    shared: dict[str, Callable[[Glider], Glider]] = {
        "pitch_damping": lambda g: replace(g, polar=replace(g.polar, pitch_damping=g.polar.pitch_damping * factor)),
        "gravity": lambda g: replace(g, gravity=g.gravity * factor),
        "engine.ahead": lambda g: replace(g, engine=replace(g.engine, ahead=g.engine.ahead * factor)),
        "sliding_mass.mass": lambda g: replace(
            g, sliding_mass=replace(g.sliding_mass, mass=g.sliding_mass.mass * factor)
        ),
        "net masses of the phases": lambda g: replace(
            g, phases=tuple(replace(p, net_mass=p.net_mass * factor) for p in g.phases)
        ),
    }
    for name in ("surge", "heave", "pitch_inertia", "moment_ahead", "moment_below"):
        shared[name] = lambda g, n=name: replace(g, mass=replace(g.mass, **{n: getattr(g.mass, n) * factor}))  # type: ignore[misc]
    yield from ((name, glider(change, (0,))) for name, change in shared.items())


def _printed_constants(factor: float) -> Iterator[tuple[str, Callable[[Suboff], Verdicts]]]:
    """Roddy's values and indices, those of each configuration and kind; a value with an illegible digit is not read at all."""
    path = shipped("cfd_data") / "suboff" / "published.toml"
    for line in path.read_text(encoding="utf-8").splitlines()[LITERATURE:]:
        for symbol, printed in (
            re.findall(r'(\w+) = "(-?[\d.]+)"', line) if line.startswith(("values", "indices")) else ()
        ):
            changed = repr(round(float(printed) * factor, 9))
            yield f"{symbol} = {printed}", published((f'{symbol} = "{printed}"', f'{symbol} = "{changed}"'))


def _remus_constants(factor: float) -> Iterator[tuple[str, Callable[[Suboff], Verdicts]]]:
    """Signs alone: no published motion of REMUS is in this repository."""
    yield from ((s, remus(s)) for s in REMUS) if factor == FLIP else ()


LITERATURE = 42  # lines of published.toml before Roddy's own values
SWEEPS = {
    "flyingfish": _fish_constants, "huuv": _huuv_constants, "thauv": _glider_constants, "suboff": _printed_constants,
    "remus": _remus_constants,
}  # fmt: skip
