"""A ``[[configuration]]`` of a body.toml: what is printed of a body, with its mass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import shown
from coeflab.core.toml import Section
from coeflab.core.units import quantity
from coeflab.kernels.rigid_body import about_another, inertia_doubt
from coeflab.model.body import Configuration, MassProperties, mass_from_primes
from coeflab.model.scaling import read_scaling


def _inertia_matrix(section: Section) -> NDArray[np.float64] | None:
    """(3, 3) about the centre of gravity, kg m^2, if given."""
    if not section.has("inertia_matrix"):
        return None
    rows = section.raw("inertia_matrix")
    if not isinstance(rows, list) or [isinstance(r, list) and len(r) for r in rows] != [3, 3, 3]:
        raise section.fail("inertia_matrix", shown(rows), "three rows of three moments of inertia")
    key = section.key("inertia_matrix")
    return np.array([[quantity(v, "inertia", file=section.file, key=key) for v in row] for row in rows])


def _full_mass(section: Section, mass: float, reference: NDArray[np.float64]) -> MassProperties:
    """Mass properties from the place of the centre of gravity and the inertia about it."""
    for other in ("centre_of_gravity_forward", "inertia"):
        if section.has(other):
            raise section.fail(other, "both", f"centre_of_gravity and inertia_matrix, or {other}")
    centre = section.point("centre_of_gravity") - reference
    own = _inertia_matrix(section)
    if own is None:
        return MassProperties(mass, mass * float(centre[0]), None, centre)
    doubt = inertia_doubt(mass, np.zeros(3), own)
    if doubt:
        raise section.fail("inertia_matrix", doubt, "the inertia of a body about its centre of gravity")
    about = about_another(own, mass, np.zeros(3), centre)
    transverse = float(about[1, 1]) if np.isclose(about[1, 1], about[2, 2], rtol=1e-9) else None
    return MassProperties(mass, mass * float(centre[0]), transverse, centre, about)


def _mass(section: Section, prime: Section, reference: NDArray[np.float64]) -> MassProperties | None:
    if section.has("mass_prime"):
        by = read_scaling(prime)
        inertia = section.optional_positive("inertia_prime", "none")
        return mass_from_primes(
            section.positive("mass_prime", "none"),
            section.quantity("mass_moment_prime", "none"),
            inertia,
            by,
            prime.positive("density", "density"),
        )
    if not section.has("mass"):
        return None
    mass = section.positive("mass", "mass")
    if section.has("centre_of_gravity"):
        return _full_mass(section, mass, reference)
    forward = section.optional_quantity("centre_of_gravity_forward", "length") or 0.0
    return MassProperties(mass, mass * forward, section.optional_positive("inertia", "inertia"))


def read_configuration(section: Section, prime: Section, reference: NDArray[np.float64]) -> Configuration:
    """One configuration: volume, surface, centre of buoyancy and mass, each as far as it is given.

    Parameters
    ----------
    section : Section
    prime : Section
        What primed mass properties are divided by; empty where there are none.
    reference : (3,) array
        The body's reference point, m, FRD, from its datum.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    out = Configuration(
        name=section.text("name"),
        title=section.text("title", ""),
        volume=section.optional_positive("volume", "volume"),
        wetted_surface=section.optional_positive("wetted_surface", "area"),
        centre_of_buoyancy=section.point("centre_of_buoyancy") if section.has("centre_of_buoyancy") else None,
        mass=_mass(section, prime, reference),
    )
    section.finish()
    return out
