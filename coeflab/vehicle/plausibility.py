"""Whether the numbers of a parameter file can be those of a body in water: buoyancy, added mass, signs of the damping."""

from __future__ import annotations

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check
from coeflab.core.texts import known
from coeflab.law.rigid_body import about_another, ideal_quadratics
from coeflab.vehicle import imported_numbers
from coeflab.vehicle.contradictions import twice_findings
from coeflab.vehicle.expected_signs import sign_findings
from coeflab.vehicle.force_law import force_law, force_of_tables, points_of, spoken
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.law_at_points import LawAtPoints, missed_for_certain
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausible_added_mass import (
    CHANGED,
    LAW,
    NAME,
    X_APART,
    added_mass_findings,
    in_air,
    stated_matrix,
)
from coeflab.vehicle.plausible_damping import damping_findings
from coeflab.vehicle.sizes import size_findings
from coeflab.vehicle.sources import acts_in

SMALL = 1e-4  # of the speed: a slope at zero, by central difference
ALONG = 0.9  # of a thruster's direction: within 26 deg of x


def plausibility(parameters: ParameterFile, signs: str = "") -> tuple[Check, ...]:
    """Findings in the order units, buoyancy, added mass, Munk moment, damping, signs ahead, sizes, points, what stands twice, what the file was written with; every question that could be asked has at least one.

    Parameters
    ----------
    parameters : ParameterFile
    signs : str, optional
        The signs that the format takes which the file was read from, a sentence; findings about a wrong one end with it.
    """
    return (
        *_units(parameters),
        *_buoyancy(parameters),
        *added_mass_findings(parameters, signs),
        *_munk(parameters),
        *damping_findings(parameters, signs),
        *sign_findings(parameters),
        *([] if in_air(parameters) else size_findings(parameters)),
        *_astern(parameters),
        *law_findings(parameters),
        *twice_findings(parameters),
        *(as_check(f.code.partition(".")[0].replace("_", " "), f) for f in parameters.findings if known(f)),
    )


def _astern(p: ParameterFile) -> list[Check]:
    """Fixed thrusters along x whose largest command pushes astern, as where the axis is that of the jet."""
    out = []
    for t in p.thrusters:
        push = t.direction[0] * t.curve.at(t.curve.high)
        along = abs(t.direction[0]) > ALONG and t.tilt_axis is None
        if along and push < 0.0 and -push >= abs(t.curve.at(t.curve.low)):
            out.append(
                Check.of(
                    "plausibility.astern",
                    f"thruster {t.name}",
                    Severity.NOTE,
                    push=push,
                    command=t.curve.high,
                    unit=t.curve.unit,
                )
            )
    return out


def law_findings(parameters: ParameterFile) -> tuple[Check, ...]:
    """As `findings_at_points`."""
    return tuple(found for _, found in findings_at_points(parameters))


def findings_at_points(parameters: ParameterFile) -> tuple[tuple[LawAtPoints, Check], ...]:
    """The law, as the file has it, against the measured points in the file, by component and table.

    A point missed where the law is said to hold fails; points outside of that range are a warning that names them. So does a
    law that is no longer the one whose misses the file states.
    """
    out = []
    bent = spoken(parameters).beyond_slopes
    stated = {(f.component, f.table): f for f in parameters.law_at_points}
    for f in points_of(parameters):
        largest = f.largest or 1.0
        allowed = 100.0 * f.allowed / largest
        rule = f"every point within {allowed:.2g} % of the largest force: 3 times the scatter of repeated runs + 5 %"
        before = stated.get((f.component, f.table), f)
        if max(abs(f.rms - before.rms), abs(f.worst - before.worst)) > CHANGED * f.largest:
            now, then = (
                f"rms {100.0 * x.rms / largest:.3g} %, worst {100.0 * x.worst / largest:.3g} %" for x in (f, before)
            )
            means = "A coefficient was changed after the file was written: this is not the law that was compared."
            out.append((f, Check(LAW, f"{f.component} {f.table}", Severity.FAIL, now, f"{then}, as stated", means)))
        words = f"worst {100.0 * f.worst / largest:.2g} %, rms {100.0 * f.rms / largest:.2g} %, worst at {f.worst_at or 'no point'}"
        if f.beyond and not f.small and not f.missed:
            words = (
                f"points {', '.join(f.beyond)}, outside the range of the law, differ by up to {100.0 * f.worst_beyond / largest:.2g} %; "
                f"inside it {100.0 * f.worst / largest:.2g} % at most (allowed {allowed:.2g} %)"
            )
        if taken := _taken_off(parameters, f.component, f.table):
            words += f". An error of the set-up is subtracted, up to {100.0 * taken / largest:.2g} %: the part of X that is odd in the drift"
        severity, comment = Severity.PASS, "The law holds at its points."
        if f.small:
            severity, comment = Severity.NOTE, "Below 1 % of the largest force or moment of this table: not judged."
        elif f.missed:
            certain = missed_for_certain(parameters.measured, f, parameters.scaling.length)
            severity = Severity.FAIL if certain else Severity.WARN
            tables = [m.response for m in parameters.models if f.component in acts_in(m)]
            longer = (
                f"Its law is the table of {', '.join(tables)}: give that fit another degree or form (coeflab formats surface)" if tables
                else "Look for a reading apart from its repeats" if f.component in bent
                else 'Fit the law beyond its slopes (fits = ["slope_at_origin", "tied_law"])'
            )  # fmt: skip
            comment = (
                f"It misses {', '.join(f.missed)}. {longer}, or look for a coefficient or a sign that is not the fit's."
            )
            if not certain:
                comment = f"{comment} The scatter of the readings may be the reason: repeat more runs."
        elif f.beyond:
            severity = Severity.WARN
            comment = (
                X_APART if f.component == "X" else "The law ends before these points, and so do exports and motions."
            )
        out.append((f, Check(LAW, f"{f.component} {f.table}", severity, words, rule, comment)))
    return tuple(out)


def _taken_off(p: ParameterFile, component: str, table: str) -> float:
    """Largest force of the set-up that differs from row to row: X, odd in drift; zero where it is a constant."""
    by_row = (np.array(f.at_rest) for m in p.measured if m.table == table for f in m.forces if f.component == component)
    return max((float(np.abs(rows).max()) for rows in by_row if component == "X" and np.ptp(rows) > 0.0), default=0.0)


def _units(p: ParameterFile) -> list[Check]:
    density = p.conditions.density
    span = f"{imported_numbers.AIR[0]:g} to {imported_numbers.AIR[1]:g} kg/m^3"
    out = [
        Check.of("plausibility.air", "density", Severity.PASS, density=density, rule_is=span)
        if in_air(p)
        else imported_numbers.water(NAME, density)
    ]
    if p.mass is not None:
        diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
        out += imported_numbers.gyration(NAME, p.mass.mass, density, float(diagonal[1]), float(diagonal[5]))
        if p.mass.inertia_matrix is not None and not in_air(p):
            own = about_another(np.array(p.mass.inertia_matrix), p.mass.mass, centre_of_gravity(p), np.zeros(3))
            out += imported_numbers.body_gyration(NAME, p.mass.mass, np.diag(own).tolist(), density, diagonal.tolist())
    return out


def _buoyancy(p: ParameterFile) -> list[Check]:
    """Volume against mass, gravity, and which of the two centres is above the other."""
    h = p.hydrostatics
    if h is None:
        return []
    out = [*imported_numbers.gravity(NAME, h.gravity, "hydrostatics.gravity")]
    if p.mass is None:
        return out
    if not in_air(p):
        out += imported_numbers.displaced(
            NAME, p.mass.mass, h.volume, p.conditions.density, "mass and hydrostatics.volume"
        )
    below = h.centre_of_buoyancy[2] - float(centre_of_gravity(p)[2])
    if below > 0.0:
        place = "hydrostatics.centre_of_buoyancy"
        out.append(Check.of("plausibility.capsizes", place, Severity.WARN, statistic=below))
    return out


def _munk(p: ParameterFile) -> tuple[Check, ...]:
    """Tables of N or M that are said to be without the potential part and look like measured totals."""
    apart = tuple(m for m in p.models if not m.contains_potential)
    hull = p.added_mass
    if hull is None or not apart:
        return ()
    p = p.model_copy(update={"models": apart})
    written, speed = [], p.conditions.speed
    for component, (force, _, across) in imported_numbers.MOMENTS.items():
        nu = np.zeros((2, 6))
        nu[:, 0], nu[:, across] = speed, (-SMALL * speed, SMALL * speed)
        tables = force_of_tables(p, nu)
        if tables is not None:
            slope = float(tables[1, force] - tables[0, force]) / (2.0 * SMALL * speed**2)
            written.append(imported_numbers.Written(component, f"models of {component}", slope, True))
    ideal = ideal_quadratics(np.array(hull.matrix)) * (p.conditions.density / hull.density)
    return imported_numbers.munk_twice(NAME, written, force_law(p).ideal, ideal)
