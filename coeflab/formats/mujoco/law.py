"""MuJoCo's ellipsoid model of fluid forces, steady part, and the ellipsoid that has given added masses.

Source of the law: MuJoCo documentation, chapter Fluid forces, section Ellipsoid model; engine_passive.c, functions
mj_ellipsoidFluidModel, mj_addedMassForces and mj_viscousForces (google-deepmind/mujoco, commit 01a932e). The added inertia is
written there too but never used, for MuJoCo has no accelerations at that place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.types import Array, brief

TINY = 1e-15


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FluidEllipsoid:
    """One geom with ``fluidshape="ellipsoid"``.

    Attributes
    ----------
    axes : (3,) array
        Semi-axes along x, y, z, m.
    blunt, slender, angular, kutta, magnus : float
        ``fluidcoef``, in its order.
    density : float
        kg/m^3.
    viscosity : float
        Pa s.
    """

    axes: Array
    blunt: float
    slender: float
    angular: float
    kutta: float
    magnus: float
    density: float
    viscosity: float = 0.0

    def force(self, v: Array, w: Array) -> tuple[Array, Array]:
        """Force and torque at the centre, each (n, 3), for velocities and rates (n, 3) along the axes.

        MuJoCo takes its added masses by a 15-point quadrature, which differs from the closed form by less than 1e-6.
        """
        rho, (a, b, c) = self.density, self.axes
        mass = np.diag(ellipsoid_added_mass(self.axes, rho))
        momentum = mass[:3] * v
        force = np.cross(momentum, w)
        torque = np.cross(momentum, v) + np.cross(mass[3:] * w, w)
        speed = np.linalg.norm(v, axis=1, keepdims=True)
        longest, middle = np.sort(self.axes)[::-1][:2]
        faces = np.array([b * c, c * a, a * b]) ** 2
        across, along = np.sum(faces**2 * v**2, axis=1, keepdims=True), np.sum(faces * v**2, axis=1, keepdims=True)
        area = np.pi * np.sqrt(across / np.maximum(TINY, along))
        cosine = along / np.maximum(TINY, speed * across)
        circulation = np.cross(faces * v, v) * (self.kutta * rho * cosine * area)
        force += np.cross(circulation, v) + np.cross(w, v) * (self.magnus * rho * 4.0 / 3.0 * np.pi * a * b * c)
        sphere = 2.0 / 3.0 * float(np.sum(self.axes))
        drag = self.blunt * area + self.slender * (np.pi * longest * middle - area)
        force -= (3.0 * np.pi * sphere * self.viscosity + rho * speed * drag) * v
        swept = 8.0 / 15.0 * np.pi * self.axes * np.array([max(b, c), max(c, a), max(a, b)]) ** 4
        largest = 8.0 / 15.0 * np.pi * middle * longest**4
        turned = np.linalg.norm(w * (self.angular * swept + self.slender * (largest - swept)), axis=1, keepdims=True)
        torque -= (np.pi * sphere**3 * self.viscosity + rho * turned) * w
        return force, torque


def ellipsoid_of_masses(masses: Array, density: float) -> tuple[Array, float]:
    """Semi-axes, to twelve digits, of the ellipsoid of given added masses along x, y and z, and the largest relative miss.

    Parameters
    ----------
    masses : (3,) array
        Above zero, kg.
    density : float
        kg/m^3.
    """
    from scipy.optimize import least_squares

    wanted = np.log(masses)

    def miss(logs: Array) -> Array:
        return np.asarray(np.log(np.diag(ellipsoid_added_mass(np.exp(logs), density))[:3]) - wanted)

    size = (float(np.mean(masses[1:])) / density) ** (1.0 / 3.0)
    start = np.log(size * np.array([2.0, 0.5, 0.5]))
    found = least_squares(miss, start, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=200)
    axes = np.array([float(f"{x:.12g}") for x in np.exp(found.x)])
    return axes, float(np.max(np.abs(miss(np.log(axes)))))
