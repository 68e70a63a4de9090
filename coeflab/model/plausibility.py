"""Whether the numbers of a parameter file can be those of a body in water: units, buoyancy, added mass, signs of the damping."""

from __future__ import annotations

import numpy as np

from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.model.check import Check, Severity
from coeflab.model.exported_law import centre_of_gravity
from coeflab.model.force_law import force_law
from coeflab.model.loss import force_of_tables
from coeflab.model.munk_moment import MOMENTS, Written, munk_twice
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.plausible_added_mass import NAME, added_mass_findings, stated_matrix
from coeflab.model.plausible_damping import damping_findings
from coeflab.model.units_told import displaced, gravity, gyration, water

SMALL = 1e-4  # of the speed: a slope at zero, by central difference


def plausibility(parameters: ParameterFile) -> tuple[Check, ...]:
    """Findings in the order units, buoyancy, added mass, Munk moment, damping; every question that could be asked has at least one."""
    return (
        *_units(parameters),
        *_buoyancy(parameters),
        *added_mass_findings(parameters),
        *_munk(parameters),
        *damping_findings(parameters),
    )


def _units(p: ParameterFile) -> list[Check]:
    density = p.conditions.density
    out = [water(NAME, density)]
    if p.mass is not None:
        diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
        out += gyration(NAME, p.mass.mass, density, float(diagonal[1]), float(diagonal[5]))
    return out


def _buoyancy(p: ParameterFile) -> list[Check]:
    """Volume against mass, gravity, and which of the two centres is above the other."""
    h = p.hydrostatics
    if h is None:
        return []
    out = [*gravity(NAME, h.gravity, "hydrostatics.gravity")]
    if p.mass is None:
        return out
    out += displaced(NAME, p.mass.mass, h.volume, p.conditions.density, "mass and hydrostatics.volume")
    below = h.centre_of_buoyancy[2] - float(centre_of_gravity(p)[2])
    if below > 0.0:
        out.append(Check(
            NAME, "hydrostatics.centre_of_buoyancy", Severity.WARN, f"{below:.4g} m below the centre of gravity", "above it",
            "The vehicle turns over. z is down: was the point copied from axes with z up?",
        ))  # fmt: skip
    return out


def _munk(p: ParameterFile) -> tuple[Check, ...]:
    """Tables of N or M that are said to be without the potential part and look like measured totals."""
    apart = tuple(m for m in p.models if not m.contains_potential)
    hull = p.added_mass
    if hull is None or not apart:
        return ()
    p = p.model_copy(update={"models": apart})
    written, speed = [], p.conditions.speed
    for component, (force, _, across) in MOMENTS.items():
        nu = np.zeros((2, 6))
        nu[:, 0], nu[:, across] = speed, (-SMALL * speed, SMALL * speed)
        tables = force_of_tables(p, nu)
        if tables is not None:
            slope = float(tables[1, force] - tables[0, force]) / (2.0 * SMALL * speed**2)
            written.append(Written(component, f"models of {component}", slope, True))
    ideal = ideal_quadratics(np.array(hull.matrix)) * (p.conditions.density / hull.density)
    return munk_twice(NAME, written, force_law(p).ideal, ideal)
