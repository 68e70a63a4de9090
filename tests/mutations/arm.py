"""Mutations of the laws of a vehicle with an arm."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from coeflab.arm import control, kane, thrusters
from coeflab.arm.thrusters import TorqueThruster, VoltageThruster
from coeflab.law import transforms
from tests.mutations.harness import Suboff, Verdicts, edited, refusals, validate_urv


def arm(what: str, function: Any, old: str, new: str) -> tuple[str, Callable[[Suboff], Verdicts]]:
    """Another law of the vehicle with an arm."""
    runs = function.__module__ == control.__name__

    def run(_: Suboff) -> Verdicts:
        with np.errstate(all="ignore"), edited(function, old, new):
            return refusals(lambda: validate_urv(runs))

    return what, run


URV = (
    arm("sign of a in Denavit-Hartenberg", transforms.denavit_hartenberg, "[a * ct, a * st, d]", "[-a * ct, -a * st, d]"),
    arm("sign of alpha in Denavit-Hartenberg", transforms.denavit_hartenberg, "-st * ca, st * sa]", "-st * ca, -st * sa]"),
    arm("arm of the partial velocities reversed", kane.partial_velocities, "places[moved] - at.pivot[k]", "at.pivot[k] - places[moved]"),
    arm("sign of w x r of the vehicle", kane.partial_velocities, "z, -y, -z", "-z, -y, -z"),
    arm("partial velocity of a sliding joint +5 %", kane.partial_velocities, "else:\n            out[moved, :3, 6 + k] = at.axis[k]",
        "else:\n            out[moved, :3, 6 + k] = 1.05 * at.axis[k]"),
    arm("sign of the added mass in M", kane.mass_matrix, "+ chain.inertias[1]", "- chain.inertias[1]"),
    arm("added mass in M +5 %", kane.mass_matrix, "+ chain.inertias[1]", "+ 1.05 * chain.inertias[1]"),
    arm("sign of w x I w", kane.bias, "+ cross(w, spin)", "- cross(w, spin)"),
    arm("sign of w x A v", kane.bias, "+ cross(w, p)", "- cross(w, p)"),
    arm("sign of w x D w", kane.bias, "+ cross(w, h)", "- cross(w, h)"),
    arm("sign of v x A v, the Munk moment", kane.bias, "+ cross(through, p)", "- cross(through, p)"),
    arm("Munk moment +5 %", kane.bias, "+ cross(through, p)", "+ 1.05 * cross(through, p)"),
    arm("sign of A (w x v)", kane.bias, "- cross(w, through)", "+ cross(w, through)"),
    arm("sign of the current", kane.bias, "v - turn @ current", "v + turn @ current"),
    arm("sign of the water's acceleration in C", kane.bias, "a - turn @ acceleration", "a + turn @ acceleration"),
    arm("sign of w x v of the vehicle", kane._bias_accelerations, "= cross(w, v)", "= -cross(w, v)"),
    arm("Coriolis acceleration of a sliding joint +5 %", kane._bias_accelerations, "2.0 * cross(w, along)", "2.1 * cross(w, along)"),
    arm("sign of w x q' z", kane._bias_accelerations, "turning + cross(w, along)", "turning - cross(w, along)"),
    arm("weight +5 %", kane.weight, "chain.gravity * down", "1.05 * chain.gravity * down"),
    arm("sign of the buoyancy", kane.buoyancy, "-chain.gravity", "chain.gravity"),
    arm("sign of the fluid acceleration", kane.fluid_acceleration, "q, acceleration)", "q, -acceleration)"),
    arm("fluid acceleration +5 %", kane.fluid_acceleration, "q, acceleration)", "q, 1.05 * acceleration)"),
    arm("sign of the vehicle's drag", kane.drag, "-0.5 * chain.density", "0.5 * chain.density"),
    arm("the vehicle's drag +5 %", kane.drag, "-0.5 * chain.density", "-0.525 * chain.density"),
    arm("sign of the links' drag", kane.drag, "push = -(factors", "push = (factors"),
    arm("the links' drag +5 %", kane.drag, "push = -(factors", "push = -(1.05 * factors"),
    arm("sign of the moment of the links' drag", kane.drag, "cross(arm, push)", "cross(push, arm)"),
    arm("flow along a link drags", kane.drag, "flow - np.sum(flow * along, axis=1)[:, None] * along", "flow"),
    arm("sign of the end effector", kane.end_in_earth, "+ at.end", "- at.end"),
    arm("sign of alpha of the torque model", TorqueThruster.rates, "- self.alpha", "+ self.alpha"),
    arm("beta of the torque model +5 %", TorqueThruster.rates, "self.beta * torque", "1.05 * self.beta * torque"),
    arm("sign of the torque model's thrust", TorqueThruster.force, "self.thrust * state", "-self.thrust * state"),
    arm("steady torque of the torque model +5 %", TorqueThruster.steady, "self.alpha / self.beta", "1.05 * self.alpha / self.beta"),
    arm("sign of k1 of the voltage model", VoltageThruster.rates, "-self.damping * state", "self.damping * state"),
    arm("k2 of the voltage model +5 %", VoltageThruster.rates, "self.drive * volts", "1.05 * self.drive * volts"),
    arm("sign of kh of the voltage model", VoltageThruster.rates, "- self.load * torque", "+ self.load * torque"),
    arm("sign of the jet's momentum", VoltageThruster.rates, "thrust - slowed", "thrust + slowed"),
    arm("momentum of the jet +5 %", VoltageThruster.rates, "self.momentum * area", "1.05 * self.momentum * area"),
    arm("length of the column of water +5 %", VoltageThruster.rates, "area * self.column", "1.05 * area * self.column"),
    arm("sign of the blades' drag in the thrust", VoltageThruster._blade, "- drag * np.sin(angle)", "+ drag * np.sin(angle)"),
    arm("lift of the blades +5 %", VoltageThruster._blade, "pressure * self.lift", "1.05 * pressure * self.lift"),
    arm("sign of the blades' drag in the torque", VoltageThruster._blade, "+ drag * np.cos(angle)", "- drag * np.cos(angle)"),
    arm("voltage that holds a thrust +5 %", VoltageThruster.steady, "self.load * self._blade", "1.05 * self.load * self._blade"),
    arm("lever of the thruster matrix reversed", thrusters.thruster_matrix, "np.cross(t.place, t.axis)", "np.cross(t.axis, t.place)"),
    arm("sign of the pull to the station", control.wanted_accelerations, "pulled = place**2", "pulled = -(place**2)"),
    arm("pull to the station +5 %", control.wanted_accelerations, "pulled = place**2", "pulled = 1.05 * place**2"),
    arm("sign of w x v in the controller", control.wanted_accelerations, "- kane.cross", "+ kane.cross"),
    arm("righting of the controller +5 %", control.wanted_accelerations, "2.0 * place**2 * _turn_left", "2.1 * place**2 * _turn_left"),
    arm("sign of the quaternion that is left", control._turn_left, "else -vector", "else vector"),
    arm("pull of the joints +5 %", control.wanted_accelerations, "controller.joint_frequency**2", "1.05 * controller.joint_frequency**2"),
    arm("sign of the acceleration that a track asks for", control.wanted_accelerations, "change + pace", "-change + pace"),
    arm("sign of all forces in computed torque", control._Loop.asked, "m @ changes - force", "m @ changes + force"),
    arm("sign of the weight in station keeping", control._Loop.asked, "- kane.weight", "+ kane.weight"),
    arm("sign of the buoyancy in station keeping", control._Loop.asked, "- kane.buoyancy", "+ kane.buoyancy"),
    arm("pace of a propeller +5 %", control.demand, "pace * (aim", "1.05 * pace * (aim"),
    arm("losses of a propeller in its controller +5 %", control.demand, "- idle)", "- 1.05 * idle)"),
    arm("largest thrust of the torque model +5 %", control.most_thrust, "model.thrust * model.beta", "1.05 * model.thrust * model.beta"),
    arm("largest thrust of the voltage model +5 %", control._most_by_voltage, "return gain", "return 1.05 * gain"),
)  # fmt: skip
