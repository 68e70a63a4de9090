"""The co-simulation unit in an FMU of coeflab: a rigid body under the force law in resources/model.json.

It needs pythonfmu, which is in the FMU, and Python's standard library. Equations of motion about the reference point (Fossen
2011, equations 3.42, 6.9 and 2.68)::

    (M_RB + M_A) nu_dot = tau(nu, delta) + external - C_RB(nu) nu        eta_dot = J(q) nu

tau holds -C_A(nu) nu. Axes x forward, y starboard, z down; positions north, east, down. Weight and buoyancy are those of the
parameters hydrostatics.* (Fossen 2011, equation 4.6); without them they are equal and act at one point. The water is at rest. Runge and Kutta's method of order 4, in steps of at most ``step``.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

SLOWEST = 1e-9  # m/s, of U in a denominator
Vector = list[float]


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def inverse(matrix: list[Vector]) -> list[Vector]:
    """By Gauss and Jordan, with row pivots.

    Raises
    ------
    ValueError
        Singular.
    """
    n = len(matrix)
    rows = [[*row, *(float(i == j) for j in range(n))] for i, row in enumerate(matrix)]
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        if rows[i][i] == 0.0:
            raise ValueError("mass and added mass make a singular matrix")
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(n):
            if k != i:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [row[n:] for row in rows]


class Unit(Fmi2Slave):  # type: ignore[misc]  # pythonfmu has no types
    """One vehicle."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.model = json.loads((Path(self.resources) / "model.json").read_text(encoding="utf-8"))
        self.values: dict[str, float] = {}
        for variable in self.model["variables"]:
            name = variable["name"]
            self.values[name] = variable["start"]
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality[variable["causality"]],
                    getter=lambda name=name: self.values[name],
                    setter=lambda value, name=name: self.values.__setitem__(name, value),
                ),
                nested=False,
            )
        self.state = [0.0] * 13
        self.inertia, self.inverse = [[0.0] * 6 for _ in range(6)], [[0.0] * 6 for _ in range(6)]

    def group(self, name: str, *members: str) -> Vector:
        """Values of several variables."""
        return [self.values[f"{name}.{m}"] for m in members]

    def scale(self, length_power: int) -> float:
        """1/2 rho L^k; 1 for k = 0, which stands for values in SI."""
        return 0.5 * self.values["density"] * float(self.model["length"] ** length_power) if length_power else 1.0

    def exit_initialization_mode(self) -> None:
        """Masses and the start of the motion are known from here on."""
        missing = [n for n in ("mass.m", "mass.Ixx", "mass.Iyy", "mass.Izz") if self.values[n] <= 0.0]
        if missing:
            raise ValueError("set " + ", ".join(missing) + ": the parameter file does not state it")
        m, centre = self.values["mass.m"], self.group("mass", "x_g", "y_g", "z_g")
        xx, yy, zz, xy, xz, yz = self.group("mass", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz")
        x, y, z = (m * c for c in centre)
        self.inertia = [
            [m, 0.0, 0.0, 0.0, z, -y], [0.0, m, 0.0, -z, 0.0, x], [0.0, 0.0, m, y, -x, 0.0],
            [0.0, -z, y, xx, xy, xz], [z, 0.0, -x, xy, yy, yz], [-y, x, 0.0, xz, yz, zz],
        ]  # fmt: skip
        total = [row[:] for row in self.inertia]
        for a in self.model["accelerations"]:
            total[a["force"]][a["motion"]] -= self.scale(a["length_power"]) * self.values[a["value"]]
        self.inverse = inverse(total)
        roll, pitch, yaw = (a / 2.0 for a in self.group("start", "roll", "pitch", "yaw"))
        (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
        self.state = [
            *self.group("start", "north", "east", "down"),
            cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
            *self.group("start", *"uvwpqr"),
        ]  # fmt: skip
        self.publish()

    def hydrodynamics(self, nu: Vector) -> Vector:
        """X Y Z K M N of the water at the present control angles."""
        moving = [*nu, *self.group("control", "dr", "ds", "db")]
        speed = max(math.sqrt(nu[0] ** 2 + nu[1] ** 2 + nu[2] ** 2), SLOWEST)
        out = [0.0] * 6
        for term in self.model["terms"]:
            value = self.values[term["value"]] * self.scale(term["length_power"]) * speed ** term["speed_power"]
            if "course" in term:  # 1 ahead, -1 astern: X0 is drag astern too
                value *= max(-1.0, min(1.0, term["course"] * nu[0] / speed))
            for index, power, absolute in term["factors"]:
                value *= (abs(moving[index]) if absolute else moving[index]) ** power
            out[term["force"]] += value
        return out

    def restoring(self, quaternion: Vector) -> Vector:
        """X Y Z K M N of weight and buoyancy."""
        if "hydrostatics.volume" not in self.values:
            return [0.0] * 6
        q0, q1, q2, q3 = quaternion
        down = [2.0 * (q1 * q3 - q0 * q2), 2.0 * (q2 * q3 + q0 * q1), 1.0 - 2.0 * (q1 * q1 + q2 * q2)]
        g = self.values["hydrostatics.g"]
        weight, buoyancy = self.values["mass.m"] * g, self.values["density"] * g * self.values["hydrostatics.volume"]
        gravity, lift = self.group("mass", "x_g", "y_g", "z_g"), self.group("hydrostatics", "x_b", "y_b", "z_b")
        arm = [weight * a - buoyancy * b for a, b in zip(gravity, lift)]
        return [*((weight - buoyancy) * d for d in down), *cross(arm, down)]

    def rates(self, state: Vector) -> Vector:
        """Time derivative of position, quaternion and velocities."""
        (q0, *q), nu = state[3:7], state[7:]
        v, w = nu[:3], nu[3:]
        turned = cross(q, v)
        twice = cross(q, turned)
        way = [v[i] + 2.0 * (q0 * turned[i] + twice[i]) for i in range(3)]
        spin = cross(q, w)
        turning = [-0.5 * sum(a * b for a, b in zip(q, w)), *(0.5 * (q0 * w[i] + spin[i]) for i in range(3))]
        momentum = [sum(a * b for a, b in zip(row, nu)) for row in self.inertia]
        p, h = momentum[:3], momentum[3:]
        centripetal = [*cross(w, p), *(a + b for a, b in zip(cross(w, h), cross(v, p)))]
        external = self.group("external", *"XYZKMN")
        given = zip(self.hydrodynamics(nu), self.restoring(state[3:7]), external, centripetal)
        force = [a + b + c - d for a, b, c, d in given]
        return way + turning + [sum(a * b for a, b in zip(row, force)) for row in self.inverse]

    def do_step(self, current_time: float, step_size: float) -> bool:  # noqa: ARG002
        """Integrate over one communication step with the inputs held."""
        count = max(1, math.ceil(step_size / self.values["step"] - 1e-9))
        h = step_size / count
        for _ in range(count):
            start = self.state
            slopes = [self.rates(start)]
            for part in (0.5, 0.5, 1.0):
                slopes.append(self.rates([s + part * h * d for s, d in zip(start, slopes[-1])]))
            a, b, c, d = slopes
            self.state = [s + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) for i, s in enumerate(start)]
            size = math.sqrt(sum(x * x for x in self.state[3:7]))
            self.state[3:7] = [x / size for x in self.state[3:7]]
        self.publish()
        return True

    def publish(self) -> None:
        """The state as outputs."""
        q0, q1, q2, q3 = self.state[3:7]
        angles = (
            math.atan2(2.0 * (q0 * q1 + q2 * q3), 1.0 - 2.0 * (q1 * q1 + q2 * q2)),
            math.asin(max(-1.0, min(1.0, 2.0 * (q0 * q2 - q3 * q1)))),
            math.atan2(2.0 * (q0 * q3 + q1 * q2), 1.0 - 2.0 * (q2 * q2 + q3 * q3)),
        )
        self.write("position", ("north", "east", "down"), self.state[:3])
        self.write("attitude", ("roll", "pitch", "yaw"), angles)
        self.write("velocity", "uvwpqr", self.state[7:])
        self.write("hydrodynamic", "XYZKMN", self.hydrodynamics(self.state[7:]))

    def write(self, name: str, members: Any, numbers: Any) -> None:
        """Set several variables."""
        for member, number in zip(members, numbers):
            self.values[f"{name}.{member}"] = number
