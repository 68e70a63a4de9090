"""Added mass of an ellipsoid in unbounded fluid, from the needle through the sphere to the disc.

Source: Lamb, Hydrodynamics (1932), sections 114-115 and 121 a; Carlson's symmetric integrals after DLMF 19.23 and 19.36.

Added mass of simple parts about their own centres: cylinders and plates.

Source: the HUUV paper (Talarczyk et al. 2025), equations 28-32, with these corrections: the plate moves c^2 b and not
c^2 b^3 (equation 30); the cylinder turns with rho pi r^2 L^3 / 12 about its centre, so that one standing on its end has
L^3 / 3 and a mast [(r_h + L)^3 - r_h^3] / 3, which come out of the transform to a common point; a plate's arm takes the k
of its motion along the normal, not k', beside its own turning term (equation 31); the off-diagonal terms m / 20 of equation
33 are dropped for those that the transform gives. Equation 30 leaves out what a mast moves along its own axis; here it is
the tenth of its displaced mass that equation 28 gives every cylinder, below 1 % of the vehicle's heave. Equation 32 is the
hull's alone; here a mast away from the yaw axis adds its lateral mass times its arm squared, by the same transform.

Added mass of plane sections in unbounded fluid, in closed form; per unit length, density 1.

A section matrix is (3, 3), symmetric: sway (along y), heave (along z), roll (y towards z), about a named point.

Bodies of revolution: integrals of a meridian and added mass by sections.

Lift of a wing of low aspect ratio and the Munk moment of a spheroid, for small angles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from scipy.special import elliprd

from coeflab.core.types import Array, brief

_DUPLICATIONS = 40


def mixed_integral(x: float, y: float, z: float) -> float:
    """Integral over t from 0 of (t+x)^(-1/2) (t+y)^(-3/2) (t+z)^(-3/2), for y, z > 0 and x >= 0.

    Notes
    -----
    It is the difference quotient of R_D in y and z. Carlson's duplication, applied to that quotient, has positive
    terms only, so y = z needs no case of its own; every step shrinks the spread of the arguments fourfold.
    """
    total, weight = 0.0, 1.0
    for _ in range(_DUPLICATIONS):
        p, s, r = np.sqrt([x, y, z])
        shared = p * s + p * r + s * r
        total += weight * 3.0 * (s * s + s * r + r * r + shared) / ((s + r) * s * r * (y + shared) * (z + shared))
        x, y, z, weight = (x + shared) / 4.0, (y + shared) / 4.0, (z + shared) / 4.0, weight / 16.0
    mean = (x + 3.0 * y + 3.0 * z) / 7.0
    return float(2.0 / 3.0 * (total + weight * 0.6 * mean**-2.5))


def _shape_integrals(axes: Array) -> Array:
    """(3,) integrals over lambda of 1 / ((axis^2 + lambda) Delta); infinite for an axis of zero."""
    a, b, c = axes**2
    return np.array([2.0 / 3.0 * elliprd(b, c, a), 2.0 / 3.0 * elliprd(a, c, b), 2.0 / 3.0 * elliprd(a, b, c)])


def shape_factors(axes: Array) -> Array:
    """Lamb's alpha0, beta0, gamma0 of the semi-axes; their sum is 2, from which the largest is taken.

    At most one axis may be zero.
    """
    scaled = axes / np.max(axes)
    r = _shape_integrals(scaled)
    short = int(np.argmin(scaled))
    factors = np.empty(3)
    for i in range(3):
        if i != short:
            factors[i] = np.prod(scaled) * r[i] if np.isfinite(r[i]) else 0.0
    factors[short] = 2.0 - sum(factors[i] for i in range(3) if i != short)
    return factors


def _turning(axes: Array, r: Array, i: int) -> float:
    """Added moment of inertia about axis ``i`` per density.

    Notes
    -----
    Lamb's m/5 (b^2 - c^2)^2 I / (2 - (b^2 + c^2) I), with the denominator written as alpha0 + 2 J,
    J = gamma0 - b^2 I = beta0 - c^2 I >= 0, and abc divided out of both.
    """
    j, k = sorted(({0, 1, 2} - {i}), key=lambda n: -axes[n])
    b, c = axes[j], axes[k]
    if axes[i] == 0.0:
        return 0.0
    if c == 0.0:
        integral, rest = 2.0 / b**2, r[j]
    else:
        mixed = mixed_integral(axes[i] ** 2, b**2, c**2)
        integral, rest = np.prod(axes) * mixed, r[j] - c**2 * mixed
    return float(4.0 * np.pi / 15.0 * ((b - c) * (b + c)) ** 2 * integral / (r[i] + 2.0 * rest))


def ellipsoid_added_mass(axes: Array, density: float) -> Array:
    """(6, 6) added mass about the centre, along the principal axes.

    Parameters
    ----------
    axes : (3,) array
        Semi-axes along x, y, z, m, none negative. One may be zero (a disc); with two at zero nothing is displaced and
        nothing accelerated.
    density : float
        kg/m^3.

    Returns
    -------
    (6, 6) array
        kg and kg m^2, diagonal.

    Notes
    -----
    Lamb 114 (8): A11 = m alpha0 / (2 - alpha0) with 2 - alpha0 = beta0 + gamma0, which neither disc nor needle cancels;
    abc is divided out, so that a disc of radius a gives 8/3 rho a^3 and 16/45 rho a^5 at zero thickness.
    """
    if np.count_nonzero(axes) < 2:
        return np.zeros((6, 6))
    size = float(np.max(axes))
    scaled = axes / size
    factors, r = shape_factors(scaled), _shape_integrals(scaled)
    out = np.zeros(6)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = size**3 * 4.0 * np.pi / 3.0 * factors[i] / (r[j] + r[k])
        out[3 + i] = size**5 * _turning(scaled, r, i)
    return density * np.diag(out)


_gauss = lru_cache(32)(np.polynomial.legendre.leggauss)  # whose arrays nothing here changes


def graded_nodes(start: float, end: float, count: int, power: int = 1) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [start, end], graded to both ends.

    ``power`` above 1 clusters them by t^power / (t^power + (1 - t)^power), which takes the roots at a round nose or tail
    out of the integrand.
    """
    nodes, weights = _gauss(count)
    t, w = (nodes + 1.0) / 2.0, weights / 2.0
    up, down = t**power, (1.0 - t) ** power
    share = up / (up + down)
    slope = power * (t * (1.0 - t)) ** (power - 1) / (up + down) ** 2
    return start + (end - start) * share, abs(end - start) * w * slope


def spheroid_munk_slope(length: float, diameter: float) -> float:
    """Nv' of a prolate spheroid in potential flow by its length: -2 (k2 - k1) V / L^3; its Yv' is zero.

    Parameters
    ----------
    length, diameter : float
        m.
    """
    moved = ellipsoid_added_mass(np.array([length, diameter, diameter]) / 2.0, 1.0)
    return float(-2.0 * (moved[1, 1] - moved[0, 0]) / length**3)


@dataclass(frozen=True, slots=True)
class MeridianIntegrals:
    """Volume m^3, centre of volume m, wetted surface m^2 and axial second moment of volume about that centre m^5."""

    volume: float
    centre: float
    wetted_surface: float
    second_moment: float


def meridian_integrals(x: Array, weight: Array, radius: Array, radius_slope: Array) -> MeridianIntegrals:
    """Integrals of a body of revolution.

    Parameters
    ----------
    x, weight, radius : (n,) arrays
        Stations, quadrature weights and radii, m.
    radius_slope : (n,) array
        R dR/dx, m, which stays finite at a round end: S = 2 pi integral of sqrt(R^2 + (R R')^2) dx.
    """
    area = np.pi * radius**2 * weight
    volume = float(np.sum(area))
    centre = float(np.sum(area * x)) / volume
    surface = float(2.0 * np.pi * np.sum(weight * np.hypot(radius, radius_slope)))
    return MeridianIntegrals(volume, centre, surface, float(np.sum(area * (x - centre) ** 2)))


@dataclass(frozen=True, slots=True)
class EndCorrection:
    """Lamb's inertia coefficients of a spheroid: axial k1 and lateral k2 over its displaced mass, turning k' over the
    turning inertia that sections alone would give it.
    """

    axial: float
    lateral: float
    turning: float


def lamb_end_correction(length: float, volume: float) -> EndCorrection:
    """End correction from the spheroid of the same length and volume.

    Sections give a spheroid A22 = m and A55 = m a^2 / 5; Lamb's exact values over these are k2 and k'.
    """
    a = length / 2.0
    b = float(np.sqrt(3.0 * volume / (4.0 * np.pi * a)))
    exact = ellipsoid_added_mass(np.array([a, b, b]), 1.0)
    return EndCorrection(
        float(exact[0, 0] / volume), float(exact[1, 1] / volume), float(exact[4, 4] / (volume * a**2 / 5.0))
    )


def strip_added_mass(integrals: MeridianIntegrals, density: float, correction: EndCorrection | None = None) -> Array:
    """(6, 6) added mass about the centre of volume, x along the axis.

    Each section moves rho pi R^2 per length across the axis (Newman 1977, section 4.16), nothing along or about it.
    Sections alone know nothing of ends; ``correction`` multiplies by k2 and k' and adds k1 along the axis.
    """
    mass, inertia = density * integrals.volume, density * integrals.second_moment
    k = correction or EndCorrection(0.0, 1.0, 1.0)
    axial, lateral, turning = k.axial * mass, k.lateral * mass, k.turning * inertia
    return np.diag([axial, lateral, lateral, 0.0, turning, turning])


AXIAL_SHARE = 0.1
DISC_TURN = 16.0 / 45.0 / (8.0 / 3.0) / 4.0  # turning over axial mass of a disc of diameter 1
CYLINDER_RATIOS = (0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0)
BOX_RATIOS = (1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
# By our panel method, benchmarks/panel_tables.py: density 1, three families up to 6,000 panels, extrapolated at order 4/3.
# Cylinder of diameter 1 and these lengths: along, across and turning.
_CYLINDERS = (
    (0.387167, 0.0117053, 0.0130247), (0.404733, 0.0369454, 0.0131969), (0.425816, 0.0932866, 0.0132026),
    (0.436611, 0.162295, 0.0131408), (0.452567, 0.300757, 0.0159862), (0.461647, 0.455283, 0.0256413),
    (0.47482, 0.794506, 0.085573), (0.484492, 1.15532, 0.235292), (0.494094, 1.90608, 0.987629),
    (0.505612, 3.44991, 5.6537), (0.510736, 5.79369, 26.4212), (0.521062, 8.93814, 96.4083),
    (0.529044, 15.241, 476.021),
)  # fmt: skip
# Box of shortest side 1: rows by longest over middle, columns by middle over shortest; along the longest, the middle and
# the shortest side, and about them.
_BOXES = (
    ((0.639178, 0.639178, 0.639178, 0.0396032, 0.0396032, 0.0396032),
     (1.1732, 1.1732, 2.08632, 0.194411, 0.194411, 0.185639),
     (1.76809, 1.76809, 4.81797, 0.772666, 0.772666, 0.544468), (3.07695, 3.07695, 15.656, 5.86057, 5.86057, 2.39042),
     (6.07026, 6.07026, 69.428, 75.4879, 75.4879, 14.7259), (14.4634, 14.4634, 524.519, 2339.18, 2339.18, 156.989)),
    ((0.658628, 1.1351, 1.1351, 0.0626068, 0.119251, 0.119251),
     (1.20747, 2.01874, 3.695, 0.308219, 0.844647, 0.538292), (1.81974, 2.98589, 8.52638, 1.23525, 3.55478, 1.53395),
     (3.17616, 5.09404, 27.7015, 9.40999, 26.9661, 6.49486), (6.15432, 9.68079, 122.172, 120.398, 339.299, 37.7076),
     (15.4587, 23.8692, 935.233, 3791.44, 10584.8, 411.24)),
    ((0.670754, 1.66746, 1.66746, 0.0852514, 0.324345, 0.324345),
     (1.22761, 2.90589, 5.41646, 0.422588, 2.43569, 1.41074), (1.85296, 4.26022, 12.4915, 1.70515, 10.254, 3.92119),
     (3.22369, 7.16143, 40.4906, 12.9825, 76.924, 16.0312), (6.31421, 13.5877, 178.834, 166.66, 964.437, 91.0205),
     (15.6625, 32.7684, 1362.81, 5215.56, 29809.8, 946.086)),
    ((0.686166, 2.79235, 2.79235, 0.132573, 1.38283, 1.38283), (1.25417, 4.752, 9.02111, 0.655761, 10.423, 5.74708),
     (1.88793, 6.85013, 20.7136, 2.63659, 43.4241, 15.4601), (3.29732, 11.4331, 67.1139, 20.2068, 322.749, 61.2795),
     (6.42262, 21.3041, 295.136, 258.257, 4004.98, 333.66), (15.886, 50.7036, 2241.94, 8063.55, 123036, 3336.18)),
    ((0.700568, 5.1106, 5.1106, 0.225093, 8.10337, 8.10337), (1.27727, 8.50654, 16.4296, 1.1233, 60.1154, 32.1607),
     (1.92999, 12.1899, 37.6493, 4.53489, 248.203, 84.5892), (3.33936, 19.9224, 121.289, 34.6614, 1822.5, 322.075),
     (6.52603, 36.9135, 532.409, 442.182, 22462.9, 1710.74), (16.0588, 87.0127, 4028.64, 13775.1, 685253, 16614.3)),
    ((0.714857, 11.0337, 11.0337, 0.467426, 79.4864, 79.4864), (1.30323, 18.0803, 35.184, 2.30842, 578.285, 302.924),
     (1.95864, 25.5222, 80.333, 9.35908, 2365.18, 773.976), (3.38567, 41.4306, 258.531, 71.0042, 17242.9, 2878.85),
     (6.86592, 79.0487, 1141.03, 916.039, 212740, 15526.1), (16.2679, 177.93, 8505.18, 27982.3, 6.37219e+06, 141805)),
)  # fmt: skip
PLATE_ASPECTS = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.25, 8.0, 10.0)
PLATE_COEFFICIENTS = (0.5790, 0.6419, 0.6898, 0.7569, 0.8009, 0.8318, 0.8719, 0.8967, 0.9168, 0.9347, 0.9476)


def plate_coefficient(aspect: float) -> float:
    """Coefficient k of a rectangular plate moving along its normal, m = k pi/4 rho c^2 b with c <= b.

    Parameters
    ----------
    aspect : float
        b / c, at least 1.

    Notes
    -----
    Computed for this project with a lattice of doublets of no thickness on four grids, extrapolated, to 1e-4 at the
    eleven aspects of the table; boxes of thickness 0.2 to 0.025 c by the panel method tend to the same within 1 % at
    aspect 1, 2 and 5. DNV-RP-H103, Table A-2, has 0.579, 0.642, 0.690, 0.757, 0.801, 0.830, 0.872, 0.897, 0.917, 0.934
    and 0.947: within 0.25 %. Between them and up to the two-dimensional limit k = 1 (aspect infinite, closed form) a
    monotone cubic in 1 / aspect.
    """
    from scipy.interpolate import PchipInterpolator

    inverse = [0.0, *(1.0 / a for a in reversed(PLATE_ASPECTS))]
    values = [1.0, *reversed(PLATE_COEFFICIENTS)]
    return float(PchipInterpolator(inverse, values)(1.0 / aspect))


def plate_added_mass(chord: float, span: float, density: float) -> Array:
    """(6, 6) added mass of a rectangular plate about its centre: chord along x, span along y, normal along z.

    Notes
    -----
    Along the normal k pi/4 rho c^2 b with c the shorter side. The plate's own turning terms are those of the elliptic
    disc of equal area and aspect ratio (Lamb, exact for the disc): an estimate for a rectangle, 27 % below sections
    in the limit of a long one.
    """
    short, long = sorted((chord, span))
    normal = plate_coefficient(long / short) * np.pi / 4.0 * density * short**2 * long
    disc = ellipsoid_added_mass(np.array([chord, span, 0.0]) / np.sqrt(np.pi), density)
    return np.diag([0.0, 0.0, normal, disc[3, 3], disc[4, 4], 0.0])


def cylinder_added_mass(radius: float, length: float, density: float) -> Array:
    """(6, 6) added mass of a cylinder about its centre, axis along x: HUUV equations 28-32 as corrected.

    Axial 0.1 rho pi r^2 L (the paper's allowance), lateral rho pi r^2 L and turning rho pi r^2 L^3 / 12 (sections,
    ends not corrected), nothing about the axis.
    """
    mass = density * np.pi * radius**2 * length
    turning = mass * length**2 / 12.0
    return np.diag([AXIAL_SHARE * mass, mass, mass, 0.0, turning, turning])


@cache
def _cylinder_curves() -> Callable[[float], Array]:
    """Axial over that of a disc, lateral over sections, turning over that of both, by L / (L + D)."""
    from scipy.interpolate import PchipInterpolator

    length, found = np.array(CYLINDER_RATIOS), np.array(_CYLINDERS)
    axial, lateral = found[:, 0] * 3.0, found[:, 1] / (np.pi / 4.0 * length)
    turning = found[:, 2] / (found[:, 1] * length**2 / 12.0 + DISC_TURN * found[:, 0])
    values = np.column_stack([axial, lateral, turning])
    # A disc: Lamb's 8/3 r^3 and 16/45 r^5; an endless cylinder: sections.
    ends = np.array([1.0, 0.0, 1.0]), np.array([values[-1, 0], 1.0, 1.0])
    at = np.concatenate([[0.0], length / (length + 1.0), [1.0]])
    curve = PchipInterpolator(at, np.vstack([ends[0], values, ends[1]]))
    return lambda ratio: np.asarray(curve(ratio / (1.0 + ratio)))


def cylinder_with_ends(radius: float, length: float, density: float) -> Array:
    """The same with its flat ends, by our panel method at 13 lengths from a tenth to twenty diameters.

    Notes
    -----
    A monotone cubic in L / (L + D) between them, which ends at Lamb's disc and at sections. With a
    quarter of the panels the worst entry of the table would change by 4.8 %, that of the box by 10.8 % (boxes of 10:1).
    """
    diameter = 2.0 * radius
    axial, lateral, turning = _cylinder_curves()(length / diameter)
    along, across = axial * diameter**3 / 3.0, lateral * np.pi * radius**2 * length
    turn = turning * (across * length**2 / 12.0 + DISC_TURN * along * diameter**2)
    return density * np.diag([along, across, across, 0.0, turn, turn])


@cache
def _box_curves() -> Callable[[float, float], Array]:
    """Masses over the ellipsoid's, and turning over masses times squared sides, by the logarithms of both ratios."""
    from scipy.interpolate import RectBivariateSpline

    steps = np.log(BOX_RATIOS)
    found = np.array(_BOXES)
    values = np.empty_like(found)
    for i, long in enumerate(BOX_RATIOS):
        for j, middle in enumerate(BOX_RATIOS):
            values[i, j] = found[i, j] / _box_scales(np.array([long * middle, middle, 1.0]), found[i, j, :3])
    curves = [RectBivariateSpline(steps, steps, np.log(values[:, :, k]), kx=3, ky=3) for k in range(6)]
    most = steps[-1]
    return lambda long, middle: np.array(
        [float(np.exp(c(min(np.log(long), most), min(np.log(middle), most))[0, 0])) for c in curves]
    )


def _box_scales(sides: Array, masses: Array) -> Array:
    """(6,) Lamb's masses of the ellipsoid of equal volume and proportions; of turning, of the masses at their levers."""
    ellipsoid = np.diag(ellipsoid_added_mass(sides / 2.0 * np.cbrt(6.0 / np.pi), 1.0))[:3]
    turning = [masses[k - 2] * sides[k - 1] ** 2 + masses[k - 1] * sides[k - 2] ** 2 for k in range(3)]
    return np.concatenate([ellipsoid, turning])


def box_added_mass(sides: Array, density: float) -> Array:
    """(6, 6) added mass of a box about its centre, by our panel method at 36 proportions.

    Parameters
    ----------
    sides : (3,) array
        Along x, y, z, m.
    density : float
        kg/m^3.

    Notes
    -----
    Cubic splines over the logarithms of longest over middle and middle over shortest side, each from 1 to 10, of the masses
    over those of Lamb's ellipsoid of equal volume and proportions and of the turning terms over masses times squared levers;
    beyond 10 these are held. A cube has 0.639 of its displaced mass (Sihvola et al. 2004: 0.6383).
    """
    order = np.argsort(-sides, kind="stable")
    ranked = sides[order]
    ratios = _box_curves()(float(ranked[0] / ranked[1]), float(ranked[1] / ranked[2]))
    masses = ratios[:3] * _box_scales(ranked, np.zeros(3))[:3]
    turning = ratios[3:] * _box_scales(ranked, masses)[3:]
    out = np.empty(6)
    out[order], out[3 + order] = masses, turning
    for i, j in ((0, 1), (1, 2), (0, 2)):
        if sides[i] == sides[j]:
            out[[i, j]], out[[3 + i, 3 + j]] = out[[i, j]].mean(), out[[3 + i, 3 + j]].mean()
    return density * np.diag(out)


Curve = Callable[[float], float]
ELLIPSE_TOLERANCE = 0.005
RECTANGLE_TOLERANCE = 1e-4
# Rectangle of half-sides a and b = a 10^(-k/6): over pi b^2 along a, over pi a^2 along b, roll over pi a^4. Computed with
# section_flow at 1,600 elements graded to the corners; 1,100 change no entry by more than 4e-5.
_ALONG_A = (
    1.513166, 1.610243, 1.716910, 1.832362, 1.955615, 2.085590, 2.221201, 2.361420, 2.505323, 2.652117, 2.801131, 2.951840,
    3.103790,
)  # fmt: skip
_ALONG_B = (
    1.513166, 1.426224, 1.349647, 1.283336, 1.226880, 1.179604, 1.140642, 1.109014, 1.083700, 1.063705, 1.048099, 1.036052,
    1.026843,
)  # fmt: skip
_ROLL = (
    0.230638, 0.152947, 0.146876, 0.148594, 0.148448, 0.146433, 0.143553, 0.140496, 0.137621, 0.135084, 0.132932, 0.131160,
    0.129730,
)  # fmt: skip
STEPS_PER_DECADE = 6
SLENDEREST_RECTANGLE = 100.0


@brief
@dataclass(frozen=True, slots=True)
class SectionIntegrals:
    """Area m^2, centroid (2,) m, and second moments (2, 2) about the centroid m^4, of all contours of a section."""

    area: float
    centroid: Array
    second: Array


def section_integrals(contours: list[Array]) -> SectionIntegrals:
    """Integrals inside closed contours, (n, 2) each; clockwise ones are holes."""
    origin = contours[0].mean(axis=0)
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for contour in contours:
        p = contour - origin
        q = np.roll(p, -1, axis=0)
        twice = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        total = p + q
        area += float(twice.sum()) / 2.0
        first += twice @ total / 6.0
        second += ((p * twice[:, None]).T @ p + (q * twice[:, None]).T @ q + (total * twice[:, None]).T @ total) / 24.0
    if not area > 0.0:
        return SectionIntegrals(0.0, origin, np.zeros((2, 2)))
    offset = first / area
    return SectionIntegrals(area, origin + offset, second - area * np.outer(offset, offset))


def ellipse(a: float, b: float) -> Array:
    """Ellipse with semi-axes a along y and b along z, about its centre.

    Source: Newman, Marine Hydrodynamics (1977), Table 4.3; a circle is a = b, a flat plate a = 0 or b = 0.
    """
    return np.diag([np.pi * b**2, np.pi * a**2, np.pi * (a**2 - b**2) ** 2 / 8.0])


def rectangle(a: float, b: float) -> Array:
    """Rectangle of half-sides a along y and b along z, about its centre; b / a from 0.01 to 100.

    Splines over the logarithm of the ratio through computed values; the printed ones agree to the digits they have
    (DNV-RP-C205, table D-1: 1.51 for a square, 1.14 and 2.23 for ten to one).
    """
    sway, heave, roll = _splines()
    t = np.log10(b / a) * STEPS_PER_DECADE
    if abs(t) > 12.0 + 1e-9:
        raise ValueError("a rectangle more slender than 100 to 1")
    along_y, along_z = (sway, heave) if t <= 0.0 else (heave, sway)
    return np.pi * np.diag([along_y(abs(t)) * b**2, along_z(abs(t)) * a**2, roll(abs(t)) * (a**4 + b**4)])


@cache
def _splines() -> tuple[Curve, Curve, Curve]:
    """Of sway, heave and roll over a^4 + b^4, by six times the decades of a / b; even about the square where they are."""
    from scipy.interpolate import CubicSpline

    step = np.arange(13.0)
    whole = CubicSpline(np.r_[-step[:0:-1], step], np.r_[_ALONG_A[:0:-1], _ALONG_B])
    ratio = 10.0 ** (-4.0 * step / STEPS_PER_DECADE)
    roll = CubicSpline(step, np.array(_ROLL) / (1.0 + ratio), bc_type=((1, 0.0), "not-a-knot"))
    return (lambda t: whole(-t)), whole, roll


def turned(matrix: Array, angle: float) -> Array:
    """The section turned from y towards z by ``angle``, rad."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ matrix @ turn.T)


def carried(matrix: Array, point: Array) -> Array:
    """The matrix about the origin of a section whose own is about ``point`` (2,).

    A roll rate p about the origin moves the point by (-p z, p y).
    """
    carry = np.eye(3)
    carry[:2, 2] = -point[1], point[0]
    return np.asarray(carry.T @ matrix @ carry)


def as_ellipse(contour: Array, whole: SectionIntegrals) -> tuple[float, float, float] | None:
    """Semi-axes and the angle of the first from y, of the ellipse with the contour's area and second moments.

    None where a corner or the middle of a side lies further than 0.5 % from it, along the radius.
    """
    moments, axes = np.linalg.eigh(whole.second)
    if not moments[0] > 0.0:
        return None
    ratio = np.sqrt(moments[1] / moments[0])
    a, b = np.sqrt(whole.area * ratio / np.pi), np.sqrt(whole.area / ratio / np.pi)
    points = (contour - whole.centroid) @ axes
    for p in (points, (points + np.roll(points, -1, axis=0)) / 2.0):
        if np.max(np.abs(np.hypot(p[:, 1] / a, p[:, 0] / b) - 1.0)) > ELLIPSE_TOLERANCE:
            return None
    return float(a), float(b), float(np.arctan2(axes[1, 1], axes[0, 1]))


def as_rectangle(contour: Array, whole: SectionIntegrals) -> tuple[float, float, float] | None:
    """Half-sides and the angle of the first from y, of the rectangle that a contour is.

    None where it is more slender than 100 to 1, or a corner lies further than 1e-4 of its size from the rectangle of the
    same area and second moments, or the contour has another area than its corners.
    """
    size = float(np.ptp(contour, axis=0).max())
    side = np.roll(contour, -1, axis=0) - contour
    before = np.roll(side, 1, axis=0)
    bend = before[:, 0] * side[:, 1] - before[:, 1] * side[:, 0]
    corners = contour[
        np.abs(bend) > RECTANGLE_TOLERANCE * size * np.minimum(*(np.linalg.norm(v, axis=1) for v in (side, before)))
    ]
    if len(corners) != 4:
        return None
    one, two = corners[1] - corners[0], corners[2] - corners[1]
    a, b = float(np.linalg.norm(one)) / 2.0, float(np.linalg.norm(two)) / 2.0
    fourth = corners[0] + two - corners[3]
    square = (
        abs(one @ two) <= RECTANGLE_TOLERANCE * 4.0 * a * b and np.linalg.norm(fourth) <= RECTANGLE_TOLERANCE * size
    )
    full = abs(4.0 * a * b / whole.area - 1.0) <= RECTANGLE_TOLERANCE
    if not (square and full and max(a / b, b / a) <= SLENDEREST_RECTANGLE):
        return None
    return a, b, float(np.arctan2(one[1], one[0]))
