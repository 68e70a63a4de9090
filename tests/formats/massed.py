"""Parameter files with full mass properties: a torpedo whose centre of gravity is not the reference point."""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass
from coeflab.law.rigid_body import MassProperties, parallel_axis
from coeflab.vehicle.parameter_file import ParameterFile
from tests.vehicle.test_force_law import LENGTH, parameters

MASS, CENTRE = 60.0, np.array([0.04, -0.01, 0.03])
OWN = np.array([[0.9, 0.05, -0.1], [0.05, 14.0, 0.02], [-0.1, 0.02, 14.5]])
INERTIA = OWN + parallel_axis(MASS, CENTRE)
ADDED = np.array([
    [3.0, 0.2, 0.1, 0.05, 0.3, -0.2],
    [0.2, 55.0, 0.5, 0.4, 0.2, 1.5],
    [0.1, 0.5, 52.0, -0.3, -1.2, 0.1],
    [0.05, 0.4, -0.3, 0.6, 0.05, -0.04],
    [0.3, 0.2, -1.2, 0.05, 11.0, 0.1],
    [-0.2, 1.5, 0.1, -0.04, 0.1, 12.0],
])  # fmt: skip
VALUES = {
    "X0": -2e-4, "Yv": -4e-2, "Yr": 1.2e-2, "Yv|v|": -0.11, "Yvvv": -0.1, "Zw": -4e-2, "Zq": -1.2e-2, "Kp": -2e-3,
    "Mw": 2e-3, "Mq": -1e-2, "Nv": -2e-3, "Nr": -1e-2, "Nv|v|": -1e-2, "Ydr": 1e-2, "Ndr": -5e-3,
}  # fmt: skip


def with_mass(file: ParameterFile, centre: np.ndarray = CENTRE) -> ParameterFile:
    """The file with the torpedo's mass properties."""
    mass = MassProperties(MASS, MASS * centre[0], None, centre, OWN + parallel_axis(MASS, centre))
    return file.model_copy(update={"mass": mass.primed(LENGTH, file.conditions.density)})


def torpedo() -> ParameterFile:
    """Straight-running and stable, every entry of its added mass other than zero."""
    return with_mass(parameters(VALUES, AddedMass(ADDED, np.zeros(3), Datum("nose"), "body of tow", "panel")))
