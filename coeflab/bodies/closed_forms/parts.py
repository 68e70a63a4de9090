"""Added mass of simple parts about their own centres: cylinders, plates and boxes.

Source: the HUUV paper (Talarczyk et al. 2025), equations 28-32, with these corrections: the plate moves c^2 b and not
c^2 b^3 (equation 30); the cylinder turns with rho pi r^2 L^3 / 12 about its centre, so that one standing on its end has
L^3 / 3 and a mast [(r_h + L)^3 - r_h^3] / 3, which come out of the transform to a common point; a plate's arm takes the k
of its motion along the normal, not k', beside its own turning term (equation 31); the off-diagonal terms m / 20 of equation
33 are dropped for those that the transform gives. Equation 30 leaves out what a mast moves along its own axis; here it is
the tenth of its displaced mass that equation 28 gives every cylinder, below 1 % of the vehicle's heave. Equation 32 is the
hull's alone; here a mast away from the yaw axis adds its lateral mass times its arm squared, by the same transform.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.types import Array

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
