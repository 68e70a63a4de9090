"""What a parameter file states twice with different numbers, and a status that promises more than its entry holds."""

from __future__ import annotations

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.law.coefficient import Status
from coeflab.law.symbols import primed
from coeflab.vehicle.inertia import stated_accelerations
from coeflab.vehicle.matching import one_slope
from coeflab.vehicle.parameter_file import ParameterFile

NAME = "plausibility"
ALIKE = 1e-3  # relative: what four printed digits leave


def twice_findings(p: ParameterFile) -> tuple[Check, ...]:
    """Notes about numbers that stand in two places and differ, with the one that is used."""
    return (*_slopes(p), *_added_mass(p), *_inertia(p), *_intervals(p))


def _slopes(p: ParameterFile) -> tuple[Check, ...]:
    """Slopes under two names, which both act: an equal number is the same one twice."""
    values = {c.symbol: c.value for c in p.coefficients if c.value and c.law != "rest"}
    out = []
    for slope, names in one_slope(values).items():
        each = [float(values[n] or 0.0) for n in names]
        equal = max(each) - min(each) <= ALIKE * max(map(abs, each))
        out.append(as_check(NAME, Finding.of(
            "parameter_file.slope_twice", p.name, Severity.FAIL if equal else Severity.WARN, statistic=sum(each), slope=slope,
            names=tuple(names), values=tuple(each), advice=names[0], by="equal" if equal else "sum",
        )))  # fmt: skip
    return tuple(out)


def _added_mass(p: ParameterFile) -> tuple[Check, ...]:
    """Acceleration derivatives that differ from the added mass."""
    hull = p.added_mass
    if hull is None:
        return ()
    computed = np.array(hull.matrix) * (p.conditions.density / hull.density)
    differing = [
        f"{primed(name)} gives {entry:.4g}, added_mass {computed[at]:.4g}"
        for at, (name, entry) in stated_accelerations(p).items()
        if abs(computed[at] - entry) > ALIKE * max(abs(computed[at]), abs(entry))
    ]
    if not differing:
        return ()
    found = "; ".join(differing)
    return (Check.of("plausibility.added_mass_twice", "added mass stated twice", Severity.NOTE, found=found),)


def _inertia(p: ParameterFile) -> tuple[Check, ...]:
    """A transverse moment of inertia that differs from the matrix."""
    mass = p.mass
    if mass is None or mass.inertia is None or mass.inertia_matrix is None:
        return ()
    across = np.diag(mass.inertia_matrix)[1:]
    if np.all(np.abs(across - mass.inertia) <= ALIKE * mass.inertia):
        return ()
    iy, iz = across.tolist()
    places = "mass.inertia and mass.inertia_matrix"
    return (Check.of("plausibility.inertia_twice", places, Severity.NOTE, statistic=mass.inertia, iy=iy, iz=iz),)


def _intervals(p: ParameterFile) -> tuple[Check, ...]:
    """A status that says that an interval exists, without one."""
    bare = [c.symbol for c in p.coefficients if c.status is Status.OK and c.u95 is None]
    if not bare:
        return ()
    return (Check.of("plausibility.ok_without_u95", ", ".join(bare), Severity.WARN),)
