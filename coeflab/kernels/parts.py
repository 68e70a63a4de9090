"""Added mass of simple parts about their own centres: cylinders and plates.

Source: the HUUV paper (Talarczyk et al. 2025), equations 28-32, with these corrections: the plate moves c^2 b and not
c^2 b^3 (equation 30); the cylinder turns with rho pi r^2 L^3 / 12 about its centre, so that one standing on its end has
L^3 / 3 and a mast [(r_h + L)^3 - r_h^3] / 3, which come out of the transform to a common point; a plate's arm takes the k
of its motion along the normal, not k', beside its own turning term (equation 31); the off-diagonal terms m / 20 of equation
33 are dropped for those that the transform gives. Equation 30 leaves out what a mast moves along its own axis; here it is
the tenth of its displaced mass that equation 28 gives every cylinder, below 1 % of the vehicle's heave. Equation 32 is the
hull's alone; here a mast away from the yaw axis adds its lateral mass times its arm squared, by the same transform.
"""

from __future__ import annotations

import numpy as np

from coeflab.kernels.axisymmetric import lamb_end_correction
from coeflab.kernels.ellipsoid import ellipsoid_added_mass
from coeflab.kernels.least_squares import Array

AXIAL_SHARE = 0.1
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


def cylinder_with_ends(radius: float, length: float, density: float) -> Array:
    """The same with Lamb's k1, k2 and k' of the spheroid of equal length and volume in place of 0.1, 1 and 1."""
    k = lamb_end_correction(length, np.pi * radius**2 * length)
    mass = density * np.pi * radius**2 * length
    lateral, turning = k.lateral * mass, k.turning * mass * length**2 / 12.0
    return np.diag([k.axial * mass, lateral, lateral, 0.0, turning, turning])


def box_added_mass(sides: Array, density: float) -> Array:
    """(6, 6) added mass of a box: Lamb's ellipsoid of equal volume and proportions, an estimate."""
    return ellipsoid_added_mass(sides / 2.0 * np.cbrt(6.0 / np.pi), density)
