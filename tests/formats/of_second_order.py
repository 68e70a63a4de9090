"""Parameter files for targets of second order: terms that they hold exactly, mass, and the vehicles of the literature."""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import Datum
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.added_mass import AddedMass
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.vehicle.test_force_law import parameters

EXACT = {
    "Xu|u|": -2e-3, "Xvv": 4e-3, "Xvr": 1.1e-2, "Yuv": -3e-2, "Yur": 5.2e-3, "Yv|v|": -0.11, "Yv|r|": -2e-3, "Zuu": 1e-4,
    "Zuw": -2e-2, "Zvv": 1e-3, "Kvw": 2e-3, "Kp|p|": -1e-5, "Muw": 1.2e-2, "Mq|q|": -1e-3, "Nuv": -1.4e-2, "Nur": -4e-3,
    "Nr|r|": -1e-3, "Npq": 3e-4,
}  # fmt: skip
FORWARD = {
    "Xu|u|": -2e-3, "Yuv": -3e-2, "Yur": 5.2e-3, "Zuu": 1e-4, "Zuw": -2e-2, "Kup": -1e-4, "Muw": 1.2e-2, "Nuv": -1.4e-2,
    "Nur": -4e-3,
}  # fmt: skip
CENTRE = np.array([0.03, 0.0, 0.02])
INERTIA = np.array([[0.9, 0.0, -0.02], [0.0, 6.0, 0.0], [-0.02, 0.0, 6.2]])


def with_mass(file: ParameterFile, centre: np.ndarray = CENTRE) -> ParameterFile:
    """The file with 50 kg at a centre of gravity."""
    mass = MassProperties(50.0, 50.0 * centre[0], None, centre, INERTIA)
    return file.model_copy(update={"mass": mass.primed(file.scaling, file.conditions.density)})


def exact(seed: int, values: dict[str, float] = EXACT) -> ParameterFile:
    """No term in U, and a full random added mass."""
    root = np.random.default_rng(seed).normal(size=(6, 6))
    return parameters(values, AddedMass(40.0 * root @ root.T, np.zeros(3), Datum("nose"), "body of tow", "panel"))


def golden() -> ParameterFile:
    """The file of the golden exports."""
    return with_mass(made.plain())


def bluerov2_heavy() -> ParameterFile:
    """von Benzon et al., JMSE 10(12):1898, 2022: linear and quadratic damping about a state of rest."""
    scaling, at = Scaling(1.0, "1 m"), Conditions(1000.0, 1.0)
    linear = {"Xu": -13.7, "Zw": -33.0, "Mq": -0.8}
    square = {"Xu|u|": -141.0, "Yv|v|": -217.0, "Zw|w|": -190.0, "Kp|p|": -1.19, "Mq|q|": -0.47, "Nr|r|": -1.5}
    values = {
        s: (v / scaling.unit(s, at.density, at.speed), "rest" if s in linear else "motion")
        for s, v in {**linear, **square}.items()
    }
    matrix = np.diag([6.36, 7.12, 18.68, 0.189, 0.135, 0.222])
    mass = MassProperties(13.5, 0.0, None, np.zeros(3), np.diag([0.26, 0.23, 0.37]))
    return stated_file(Stated("bluerov2", "BlueROV2 Heavy", scaling, at, values, matrix=matrix, mass=mass), [], ())
