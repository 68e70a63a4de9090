"""Whether the numbers of a parameter file can be those of a body in water: units, added mass, signs of the damping."""

from __future__ import annotations

import numpy as np

from coeflab.model.check import Check
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.plausible_added_mass import NAME, added_mass_findings, stated_matrix
from coeflab.model.plausible_damping import damping_findings
from coeflab.model.units_told import gyration, water


def plausibility(parameters: ParameterFile) -> tuple[Check, ...]:
    """Findings in the order units, added mass, damping; every question that could be asked has at least one."""
    return (*_units(parameters), *added_mass_findings(parameters), *damping_findings(parameters))


def _units(p: ParameterFile) -> list[Check]:
    density = p.conditions.density
    out = [water(NAME, density)]
    if p.mass is not None:
        diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
        out += gyration(NAME, p.mass.mass, density, float(diagonal[1]), float(diagonal[5]))
    return out
