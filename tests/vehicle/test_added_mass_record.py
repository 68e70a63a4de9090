"""The added mass of a file: rounding errors of a motion that moves no water are none."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.law.added_mass import AddedMass
from coeflab.vehicle.parameter_parts import added_mass_record


def test_the_roll_of_a_body_of_revolution_is_zero_and_not_its_rounding_error() -> None:
    """Moved along the axis by a lever with a rounding error, sway gave a roll of 1e-31 and a row that was no kinetic energy."""
    body = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    matrix = np.diag([1.466, 35.52, 35.52, 1.158e-31, 4.193, 4.193])
    matrix[1, 3] = matrix[3, 1] = 2.018e-16
    matrix[2, 3] = matrix[3, 2] = 2.018e-15
    matrix[3, 4] = matrix[4, 3] = 1.642e-17
    hull = AddedMass(matrix, body.reference_point, body.datum, body.name, "panel", density=1000.0)
    assert not hull.definiteness.holds
    found = SimpleNamespace(ordered=(hull,), density=1000.0)
    made = added_mass_record(found, body.reference_point, body.datum)  # type: ignore[arg-type]
    assert made.definiteness.holds
    assert not np.any(made.matrix[3])
    assert made.matrix[1, 1] == 35.52
