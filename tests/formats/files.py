"""Parameter files for the tests of exporters: one of every kind of term, full added mass, and names that hurt."""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import CONTROLS, derivative
from coeflab.law.terms import parse_suffix
from coeflab.vehicle.parameter_file import ParameterFile
from tests.vehicle.test_force_law import HULL, parameters

VALUES = {
    "X0": -1.5e-3, "Y0": 1e-4, "Xvv": 4e-3, "Xvr": 1.1e-2, "Yv": -3e-2, "Yr": 5.2e-3, "Yv|v|": -0.11, "Y|v|r": -2e-3,
    "Yvvv": -0.21, "Yvrr": -0.07, "Zw": -2e-2, "Zq": -6e-3, "Zvv": 1e-3, "Kp": -1e-4, "Kvw": 2e-3, "Mw": 1.2e-2,
    "Mq": -3e-3, "Nv": -1.4e-2, "Nr": -4e-3, "Nv|v|": -1e-2, "Nuv": 1e-3, "Ydr": 1e-2, "Ndr": -6e-3, "Xdrdr": -2e-3,
    "Nvdr": 3e-4, "Mds": -5e-3,
}  # fmt: skip
HOSTILE = (
    'it\'s "quoted" <b>&amp;</b>',
    "two\nlines'; system('x');\r\nend",
    "../../etc/passwd",
    "%{ block",
    "a \\ b \\n ''' \"\"\" {0} {name}",
    "function",
    "123 \U0001f6a2\u200d\u2028 vehicle",
    "x" * 10_000,
    "\u0000\u001b[31m",
)


def full(seed: int) -> ParameterFile:
    """Every kind of term, and a full random added mass."""
    root = np.random.default_rng(seed).normal(size=(6, 6))
    hull = AddedMass(40.0 * root @ root.T, np.zeros(3), Datum("nose"), "body of tow", "panel")
    return parameters(VALUES, hull)


def plain() -> ParameterFile:
    """The file of the golden exports: a diagonal added mass."""
    return parameters(VALUES, HULL)


def at_rest() -> ParameterFile:
    """Damping about a state of rest, acceleration derivatives, no added mass."""
    return parameters({"Yv": -3e-2, "Yv|v|": -0.1, "Nr": -4e-3, "Yvdot": -1.2e-2, "Nvdot": 1e-4}, law="rest")


def named(name: str) -> ParameterFile:
    """The plain file under another name and of another body; no length is checked."""
    return plain().model_copy(update={"name": name, "body": name})


def control_force(file: ParameterFile, nu: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """What the control terms of a file give, term by term: 1/2 rho L^k U^n times the velocities and angles."""
    columns = dict(zip((*"uvwpqr", *CONTROLS), np.hstack([nu, delta]).T, strict=True))
    speed = np.linalg.norm(nu[:, :3], axis=1)
    out = np.zeros((len(nu), 6))
    for c in file.coefficients:
        d = derivative(c.symbol)
        if set(d.factors) & set(CONTROLS):
            scale = (
                0.5
                * file.conditions.density
                * file.scaling.length ** powers_of(d.text)[1]
                * speed ** powers_of(d.text)[0]
            )
            out[:, "XYZKMN".index(d.component)] += c.value * scale * parse_suffix(d.text[1:]).evaluate(columns)
    return out


def slopes_alone(parameters: ParameterFile) -> ParameterFile:
    """The file without the terms that `coeflab.fits.tied_law` found, and without points."""
    kept = tuple(c for c in parameters.coefficients if not c.estimator.startswith("least squares beyond"))
    names = [c.symbol for c in kept]
    rows = [parameters.covariance.symbols.index(n) for n in names]
    covariance = {"symbols": names, "matrix": [[parameters.covariance.matrix[i][j] for j in rows] for i in rows]}
    content = parameters.model_dump(exclude={"measured", "law_holds", "law_at_points"})
    return ParameterFile.model_validate({**content, "coefficients": kept, "covariance": covariance})
