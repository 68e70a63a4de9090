"""Write the parameter file of the REMUS 100 from Prestero's coefficients: ``python cfd_data/make_remus.py``.

T. Prestero (2001), tables of chapter 4 and appendix: SI, x forward, y starboard, z down, about the centre of buoyancy. They are
totals: his simulation adds no C_A(nu) nu. Fin coefficients are per U^2; the four of them are as public simulation codes copy
them from the thesis, which agree.
"""

from __future__ import annotations

import numpy as np

from coeflab.core.files import shipped, write_atomically
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics

VALUES = {
    "Xudot": -0.93, "Yvdot": -35.5, "Yrdot": 1.93, "Zwdot": -35.5, "Zqdot": -1.93, "Kpdot": -0.0704, "Mwdot": -1.93,
    "Mqdot": -4.88, "Nvdot": 1.93, "Nrdot": -4.88,
    "Xu|u|": -1.62, "Xwq": -35.5, "Xqq": -1.93, "Xvr": 35.5, "Xrr": -1.93,
    "Yv|v|": -131.0, "Yr|r|": 0.632, "Yuv": -28.6, "Ywp": 35.5, "Yur": 5.22, "Ypq": 1.93,
    "Zw|w|": -131.0, "Zq|q|": -0.632, "Zuw": -28.6, "Zuq": -5.22, "Zvp": -35.5, "Zrp": 1.93,
    "Kp|p|": -0.13,
    "Mw|w|": 3.18, "Mq|q|": -188.0, "Mrp": 4.86, "Muq": -2.0, "Muw": 24.0, "Mvp": -1.93,
    "Nv|v|": -3.18, "Nr|r|": -94.0, "Nuv": -24.0, "Npq": -4.86, "Nwp": -1.93, "Nur": -2.0,
}  # fmt: skip
FINS = {"Ydr": 9.64, "Ndr": -6.15, "Zds": -9.64, "Mds": -6.15}
MASS, BELOW, INERTIA = 30.48, 0.0196, (0.177, 3.45, 3.45)
LENGTH, DENSITY, SPEED = 1.33, 1030.0, 1.54
NOTES = (
    "Yv|v| is -131 kg/m, as Zw|w|: the thesis prints -1.31e+3, ten times that of the same body of revolution in the other plane.",
    "The vehicle has 7 N more buoyancy than weight; this file leaves them out: buoyancy equals weight.",
    "No limit and no rate of the rudder is stated.",
)


def parameter_file() -> ParameterFile:
    """The file; every coefficient is stated, none has an interval."""
    scaling, at = Scaling(LENGTH, "LOA"), Conditions(DENSITY, SPEED)
    values = VALUES | {symbol: value * SPEED**2 for symbol, value in FINS.items()}
    mass = MassProperties(MASS, 0.0, INERTIA[1], np.array([0.0, 0.0, BELOW]), np.diag(INERTIA))
    primed = {s: (v / scaling.unit(s, at.density, at.speed), "motion") for s, v in values.items()}
    stated = Stated("remus100", "REMUS 100 (Prestero 2001)", scaling, at, primed, mass=mass, notes=NOTES)
    afloat = ParameterHydrostatics(volume=MASS / DENSITY, centre_of_buoyancy=(0.0, 0.0, 0.0))
    return stated_file(stated, (), ("prestero2001",)).model_copy(update={"hydrostatics": afloat})


if __name__ == "__main__":
    write_atomically(shipped("cfd_data") / "remus100" / "remus100.parameters.json", parameter_file().to_json())
