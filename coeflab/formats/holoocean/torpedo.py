"""HoloOcean's Fossen dynamics of a torpedo: the steady hydrodynamic force, and parameters for given derivatives.

Source of the law: HoloOcean 2.3, client/src/holoocean/fossen_dynamics/torpedo.py (set_torpedo_parameters,
calculate_vehicle_parameters, dynamics) and helper_functions.py (forceLiftDrag, coeffLiftDrag, crossFlowDrag, Hoerner), read in
public copies: ximengtju/611-Smart-Captain at e97c392, DPRIcky/holoocean-multiagent-control at 53319866. Both helpers have the
density 1026 written into them. Of C_A(nu) eight entries are set to zero, the Munk moments among them; what is left has p.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief

WATER = 1026.0
GRAVITY = 9.81  # written into set_torpedo_parameters
STRIPS = 20
CROSS_FLOW = 1.2108 + (0.5 - 0.4933) / (0.5585 - 0.4933) * (1.0836 - 1.2108)  # Hoerner's table at B / 2T = 1/2
FADING = 3.0


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Torpedo:
    """The key ``dynamics`` of a scenario, under HoloOcean's names.

    Attributes
    ----------
    mass, length, diam : float
        kg, m.
    r_bg, r_bb : (3,) array
        Centres of gravity and buoyancy from the reference point, m, FRD.
    area_fraction, T_surge, T_sway, zeta_roll, zeta_pitch, T_yaw, r44, Cd, e : float
    """

    mass: float
    length: float
    diam: float
    r_bg: Array
    r_bb: Array
    area_fraction: float
    T_surge: float
    T_sway: float
    zeta_roll: float
    zeta_pitch: float
    T_yaw: float
    r44: float
    Cd: float
    e: float

    @property
    def inertia(self) -> tuple[float, float]:
        """Ix and Iy of the spheroid about its centre."""
        a, b = self.length / 2.0, self.diam / 2.0
        return 0.4 * self.mass * b**2, 0.2 * self.mass * (a**2 + b**2)

    @property
    def added(self) -> Array:
        """(6,) diagonal of the added mass: Lamb's factors of the spheroid times the mass."""
        slope = np.sqrt(1.0 - (self.diam / self.length) ** 2)
        log = np.log((1.0 + slope) / (1.0 - slope))
        alpha = 2.0 * (1.0 - slope**2) / slope**3 * (0.5 * log - slope)
        beta = 1.0 / slope**2 - (1.0 - slope**2) / (2.0 * slope**3) * log
        turn = slope**4 * (beta - alpha)
        turn /= (2.0 - slope**2) * (2.0 * slope**2 - (2.0 - slope**2) * (beta - alpha))
        ix, iy = self.inertia
        ahead, across = self.mass * alpha / (2.0 - alpha), self.mass * beta / (2.0 - beta)
        return np.array([ahead, across, across, self.r44 * ix, turn * iy, turn * iy])

    @property
    def inert(self) -> Array:
        """(6,) diagonal of mass and added mass about the reference point."""
        x, y, z = self.r_bg
        ix, iy = self.inertia
        turning = np.array([ix, iy, iy]) + self.mass * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
        return np.concatenate([np.full(3, self.mass), turning]) + self.added

    @property
    def damping(self) -> Array:
        """(6,) linear damping at rest; the first two fade with exp(-3 U)."""
        m = self.inert
        righting = self.mass * GRAVITY * float(self.r_bg[2] - self.r_bb[2])
        rates = 1.0 / np.array([self.T_surge, self.T_sway, self.T_sway, 1.0, 1.0, self.T_yaw])
        rates[3:5] = 2.0 * np.array([self.zeta_roll, self.zeta_pitch]) * np.sqrt(righting / m[3:5])
        return np.asarray(m * rates)

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD about the reference point, fins and propeller at rest."""
        u, v, w, p, q, r = nu.T
        speed = np.sqrt(u**2 + v**2 + w**2)
        fading = np.ones_like(nu)
        fading[:, :2] = np.exp(-FADING * speed)[:, None]
        out = -self.damping * fading * nu
        alpha, area = np.arctan2(w, u), self.area_fraction * self.length * self.diam
        aspect = self.diam**2 / area
        lift = np.pi * aspect / (1.0 + np.sqrt(1.0 + (aspect / 2.0) ** 2)) * alpha
        drag = self.Cd * np.pi * (self.diam / 2.0) ** 2 / area + lift**2 / (np.pi * self.e * aspect)
        pressure = 0.5 * WATER * speed**2 * area
        out[:, 0] += pressure * (lift * np.sin(alpha) - drag * np.cos(alpha))
        out[:, 2] -= pressure * (drag * np.sin(alpha) + lift * np.cos(alpha))
        step = self.length / STRIPS
        for x in np.arange(STRIPS + 1) * step - self.length / 2.0:
            across = -0.5 * WATER * self.diam * CROSS_FLOW * step * np.abs(v + x * r) * (v + x * r)
            out[:, 1] += across
            out[:, 5] += x * across
        a = self.added
        out[:, 1] += a[2] * w * p
        out[:, 2] -= a[1] * v * p
        out[:, 4] += (a[5] - a[3]) * p * r
        out[:, 5] += (a[3] - a[4]) * p * q
        return out


def lifting_area(slope: float, diam: float) -> float | None:
    """Reference area, m^2, whose lift has a slope area C_L,alpha; None where no area has: at most pi/2 diam^2.

    With aspect ratio diam^2 / area the slope is pi diam^2 / (1 + sqrt(1 + (aspect ratio / 2)^2)).
    """
    if slope <= 0.0:
        return None
    root = np.pi * diam**2 / slope - 1.0
    return None if root <= 1.0 else float(diam**2 / (2.0 * np.sqrt(root**2 - 1.0)))
