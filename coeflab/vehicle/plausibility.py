"""Whether the numbers of a parameter file can be those of a body in water: buoyancy, added mass, signs of the damping.

Whether a stated added mass can be that of a body in water.

Whether damping damps, its rates are in radians, and both planes are written in one set of axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check
from coeflab.core.texts import known
from coeflab.core.types import dataclass
from coeflab.law.added_mass import ROUNDING, definiteness
from coeflab.law.rigid_body import about_another, ideal_quadratics
from coeflab.law.symbols import COMPONENTS, LINEAR, MOTIONS, derivative, primed
from coeflab.vehicle import imported_numbers
from coeflab.vehicle.contradictions import twice_findings
from coeflab.vehicle.expected_signs import sign_findings
from coeflab.vehicle.force_law import force_law, force_of_tables, points_of, spoken
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.law_at_points import missed_for_certain
from coeflab.vehicle.second_order import products_once, slot
from coeflab.vehicle.sizes import size_findings
from coeflab.vehicle.sources import acts_in

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.law.force_law import ForceTerm
    from coeflab.vehicle.parameter_file import ParameterFile

X_APART = "The law of X ends before these points. X does not limit exports and motions; the other components do."
CHANGED = 1e-6  # of the largest force: far above rounding, far below what any digit of a coefficient is worth
MISTYPED = 0.05  # asymmetry of one wrong digit; more is another convention
HEAVY = 5.0  # of the mass: a disc or plate in a vehicle's place
LIGHT = 0.15  # of the mass, across: a ball has 0.5
SMALLEST_PRIME = 1e-5  # of 1/2 rho L^3: a cylinder 400 diameters long
PROBE = 0.05
NAME, LAW = "plausibility", "law at points"


def stated_matrix(parameters: ParameterFile) -> Array:
    """Added mass (6, 6) as stated, SI; NaN where nothing is."""
    density = parameters.conditions.density
    if parameters.added_mass is not None:
        return np.array(parameters.added_mass.matrix) * (density / parameters.added_mass.density)
    out = np.full((6, 6), np.nan)
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is not None and len(d.factors) == 1 and d.factors[0].endswith("dot"):
            at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0][0])
            out[at] = 0.0 - c.value * parameters.scaling.unit(d.text, density)
    return out


def added_mass_findings(p: ParameterFile, signs: str = "") -> list[Check]:
    """Zeros, signs, symmetry, definiteness and size; at least one finding. ``signs`` as in `plausibility`."""
    stated = stated_matrix(p)
    if not np.any(np.nan_to_num(stated)):
        return [Check.of("plausibility.no_added_mass", "added mass", Severity.WARN)]
    matrix = np.nan_to_num(np.where(np.isnan(stated), stated.T, stated))
    out = _diagonal(np.diag(stated), signs)
    unknown = np.isnan(np.diag(stated)) & np.any(matrix, axis=1)
    if np.any(unknown):
        out.append(Check.of("plausibility.no_diagonal", "M_A", Severity.WARN, unknown=_names(unknown)))
        matrix = np.where(unknown[:, None] | unknown, 0.0, matrix)
    out += _asymmetry(matrix)
    found = definiteness((matrix + matrix.T) / 2.0)
    if np.all(np.diag(matrix) >= 0.0) and found.smallest < -ROUNDING:
        least = "without a bound" if np.isinf(found.smallest) else f"{found.smallest:.3g}"
        out.append(Check.of("plausibility.not_definite", "M_A", Severity.FAIL, least=least))
    elif not out:
        out.append(Check.of("plausibility.definite", "M_A", Severity.PASS, smallest=found.smallest))
    return out + _size(p, np.diag(matrix)[:3])


def _names(which: NDArray[np.bool_]) -> str:
    return ", ".join(f"{COMPONENTS[i]}{MOTIONS[i]}" for i in np.flatnonzero(which))


def _diagonal(stated: Array, signs: str) -> list[Check]:
    out = []
    negative = np.nan_to_num(stated) < 0.0
    if np.any(negative):
        values = ", ".join(f"{x:.4g}" for x in stated[negative])
        facts = {"values": values, "signs": f" {signs}".rstrip()}
        out.append(Check.of("plausibility.negative_diagonal", f"M_A {_names(negative)}", Severity.FAIL, **facts))
    across = (stated == 0.0) & (np.arange(6) < 3)
    if np.any(across):
        out.append(Check.of("plausibility.zero_diagonal", f"M_A {_names(across)}", Severity.WARN))
    return out


def _size(p: ParameterFile, diagonal: Array) -> list[Check]:
    out = []
    prime = float(np.max(diagonal[1:])) / p.scaling.unit("m", p.conditions.density)
    if p.scaling.length_name != "1 m" and 0.0 < prime < SMALLEST_PRIME:
        out.append(
            Check.of("plausibility.small_prime", "M_A Yv, Zw", Severity.FAIL, statistic=prime, threshold=SMALLEST_PRIME)
        )
    if p.mass is not None and (heaviest := float(np.max(diagonal))) > HEAVY * p.mass.mass:
        share = heaviest / p.mass.mass
        out.append(Check.of("plausibility.heavy", "M_A", Severity.WARN, statistic=share, threshold=HEAVY))
    across = diagonal[1:][diagonal[1:] > 0.0]
    if p.mass is not None and across.size and not _in_air(p) and (share := float(np.max(across)) / p.mass.mass) < LIGHT:
        out.append(Check.of("plausibility.small_across", "M_A Yv, Zw", Severity.WARN, share=share, light=LIGHT))
    return out


def _asymmetry(matrix: Array) -> list[Check]:
    out = []
    root = np.sqrt(np.abs(np.diag(matrix)))
    for i, j in np.argwhere(np.triu(matrix != matrix.T)):
        scale = root[i] * root[j] or max(abs(matrix[i, j]), abs(matrix[j, i]))
        apart = abs(matrix[i, j] - matrix[j, i]) / scale
        if apart > ROUNDING:
            severity = Severity.WARN if apart <= MISTYPED else Severity.FAIL
            pair = f"M_A {COMPONENTS[i]}{MOTIONS[j]} and {COMPONENTS[j]}{MOTIONS[i]}"
            entries = {"one": matrix[i, j], "other": matrix[j, i]}
            out.append(Check.of("plausibility.asymmetric", pair, severity, statistic=apart, **entries))
    return out


PLANES = (("Y", "N", 1, 5), ("Z", "M", 2, 4))
SMALLEST = {1: 0.15, 2: 0.05}
OPPOSITE = (("Nv", "Mw"), ("Nuv", "Muw"), ("Nv|v|", "Mw|w|"), ("Yr", "Zq"), ("Yur", "Zuq"), ("Yr|r|", "Zq|q|"))
EQUAL = (("Yv", "Zw"), ("Yuv", "Zuw"), ("Nr", "Mq"), ("Nur", "Muq"))
ALIKE = 0.01
PARTNERS = (*OPPOSITE, *EQUAL, ("Nr|r|", "Mq|q|"), ("Yv|v|", "Zw|w|"))


@dataclass(frozen=True, slots=True)
class _Own:
    """A term of a motion on itself."""

    term: ForceTerm
    motion: str
    odd: bool


def damping_findings(p: ParameterFile, signs: str = "") -> list[Check]:
    """Signs, rates and axes; at least one finding about the signs, with what the file's format says of them."""
    own = _own_terms(p)
    out = _signs(own, signs, p)
    products = _products_with_u(p)
    if not own and not products:
        out += _by_tables(p)
    elif not any(c.severity is Severity.FAIL for c in out) and not any(t.coefficient > 0.0 for t in products):
        several = f"{len(own) + len(products)} terms of a motion on itself"
        out.append(Check.of("plausibility.damps", "damping", Severity.PASS, found=several))
    return [*out, *_rates(p, own), *_mirrored(p), *_partners(p), *_ideal_products(p)]


def _by_tables(p: ParameterFile) -> list[Check]:
    """What the fitted tables do against each motion alone, forward speed aside: its power at `PROBE` of speed and of U/L."""
    nothing = Check.of("plausibility.nothing_damps", "damping", Severity.WARN)
    nu = np.zeros((12, 6))
    nu[:, 0] = p.conditions.speed
    unit = p.conditions.speed * np.where(np.arange(6) < 3, 1.0, 1.0 / p.scaling.length)
    ways = np.array([1.0, -1.0])[:, None] * PROBE * unit
    for i in range(1, 6):
        nu[2 * i : 2 * i + 2, i] = ways[:, i]
    force = force_of_tables(p, nu)
    if force is None:
        return [nothing]
    power = [float(force[0, 0]), *(float(force[2 * i, i] - force[2 * i + 1, i]) for i in range(1, 6))]
    damps = [f"{c} against {m}" for c, m, x in zip(COMPONENTS, MOTIONS, power, strict=True) if x < 0.0]
    drives = [f"{c} with {m}" for c, m, x in zip(COMPONENTS, MOTIONS, power, strict=True) if x > 0.0]
    out = []
    if drives:
        out.append(Check.of("plausibility.tables_drive", "damping", Severity.WARN, drives=", ".join(drives)))
    if damps:
        out.append(Check.of("plausibility.tables_damp", "damping", Severity.PASS, damps=", ".join(damps)))
    return out or [nothing]


def _products_with_u(p: ParameterFile) -> list[ForceTerm]:
    """Slopes of a motion on itself that go with the speed, such as Yuv; `sign_findings` judges their signs."""
    return [
        t for t in force_law(p).terms
        if t.coefficient != 0.0 and t.kind != "potential" and t.term.degree == 2
        and {v for v, _, _ in t.product.factors} == {"u", MOTIONS[COMPONENTS.index(t.component)]} != {"u"}
    ]  # fmt: skip


def _own_terms(p: ParameterFile) -> list[_Own]:
    """Of X every term in u alone: a drag ahead, whether it turns with the course, as Xu|u|, or not, as Xuu."""
    out = []
    for t in force_law(p).terms:
        variables = {v for v, _, _ in t.product.factors}
        motion = MOTIONS[COMPONENTS.index(t.component)]
        resistance = t.ahead or (t.component == "X" and variables == {"u"})
        if t.coefficient != 0.0 and (variables == {motion} or resistance):
            out.append(_Own(t, motion, t.product.odd_in(motion) or resistance))
    return out


def _outweighs(driving: _Own, own: list[_Own], p: ParameterFile) -> bool:
    """Whether the force drives somewhere: of a law that says where it holds there, else whatever the other terms are."""
    names = (f"asin({driving.motion}/U)", f"{driving.motion}'")
    held = [h for h in p.law_holds if h.component == driving.term.component and h.variable in names]
    if not held:
        return True
    speed, largest = p.conditions.speed, max(abs(b) for h in held for b in (h.low, h.high))
    unit = speed if driving.motion in LINEAR else speed / p.scaling.length
    motion = np.linspace(0.05, 1.0, 20) * (np.sin(largest) if driving.motion in "vw" else largest) * unit
    mine = [o.term for o in own if o.odd and o.term.component == driving.term.component]
    force = sum(t.coefficient * speed**t.speed_power * motion**t.product.degree for t in mine)
    return bool(np.any(force > 0.0))


def driving_terms(p: ParameterFile) -> list[ForceTerm]:
    """Terms of a motion on itself that drive it somewhere; below zero they damp."""
    return [o.term for o in _driving(_own_terms(p), p)]


def _driving(own: list[_Own], p: ParameterFile) -> list[_Own]:
    return [o for o in own if o.odd and o.term.coefficient > 0.0 and _outweighs(o, own, p)]


def _signs(own: list[_Own], signs: str, p: ParameterFile) -> list[Check]:
    out = []
    drives = _driving(own, p)
    if drives:
        out.append(Check.of(
            "plausibility.drives", ", ".join(primed(o.term.symbol) for o in drives), Severity.FAIL, signs=f" {signs}".rstrip(),
            values=", ".join(f"{o.term.coefficient:.4g}" for o in drives), count="one" if len(drives) == 1 else "many",
        ))  # fmt: skip
    for o in own:
        if not o.odd and o.term.component in "YKN":
            name = primed(o.term.symbol)
            facts = {"force": name[0], "motion": o.motion}
            out.append(Check.of("plausibility.one_way", name, Severity.WARN, statistic=o.term.coefficient, **facts))
    return out


def _rates(p: ParameterFile, own: list[_Own]) -> list[Check]:
    """Damping of pitch and yaw against that of heave and sway by the radius of gyration k of the added mass.

    Nr is of the order of k^2 Yv, Nr|r| of k^3 Yv|v|; published vehicles have 1 to 8 times that. A rate in degrees makes it 57
    and 3283 times smaller.
    """
    diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
    out = []
    for force, moment, i, j in PLANES:
        if diagonal[i] <= 0.0 or diagonal[j] <= 0.0:
            continue
        for a in own:
            for b in own:
                n = a.term.product.degree
                same = n == b.term.product.degree and a.term.speed_power == b.term.speed_power and a.odd and b.odd
                if (a.term.component, b.term.component) != (force, moment) or not same or n not in SMALLEST:
                    continue
                usual = a.term.coefficient * (diagonal[j] / diagonal[i]) ** (0.5 * (n + 1))
                same_way = b.term.coefficient * float(np.sign(usual))
                if 0.0 < same_way < SMALLEST[n] * abs(usual):
                    out.append(Check.of(
                        "plausibility.small_rate", primed(b.term.symbol), Severity.WARN, statistic=same_way / abs(usual), power=n + 1,
                        threshold=SMALLEST[n], value=b.term.coefficient, of=a.term.symbol, k=(diagonal[j] / diagonal[i]) ** 0.5,
                    ))  # fmt: skip
    return out


def _mirrored(p: ParameterFile) -> list[Check]:
    """Yaw and pitch of one size, where x forward, y starboard, z down set what couples the two planes against each other."""
    opposite, equal = (
        [_same_size(p, a, b, sign) for a, b in pairs] for pairs, sign in ((OPPOSITE, 1.0), (EQUAL, -1.0))
    )
    matrix = np.nan_to_num(stated_matrix(p))
    if matrix[1, 5] and _alike(matrix[1, 5], matrix[2, 4]):
        opposite.append(("M_A Yr and Zq", matrix[1, 5], matrix[2, 4]))
    out = []
    for wrong, due in ((opposite, "opposite"), (equal, "equal")):
        found = [f for f in wrong if f is not None]
        if found:
            pairs, values = (
                "; ".join(x) for x in zip(*((n, f"{x:.4g} and {y:.4g}") for n, x, y in found), strict=True)
            )
            out.append(Check.of("plausibility.mirrored", pairs, Severity.WARN, values=values, due=due))
    return out


def _partners(p: ParameterFile) -> list[Check]:
    """Yaw and pitch of other sizes, of a body whose added mass is alike in both planes."""
    diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
    if not (_alike(diagonal[1], diagonal[2]) and _alike(diagonal[4], diagonal[5])):
        return []
    found = []
    for a, b in PARTNERS:
        first, second = p.coefficient(a), p.coefficient(b)
        if first is None or second is None or not first.value_si or not second.value_si:
            continue
        if not _alike(abs(first.value_si), abs(second.value_si), MISTYPED):
            found.append((f"{a} and {b}", f"{first.value_si:.4g} and {second.value_si:.4g} (SI)"))
    return [Check.of("plausibility.partners_apart", pair, Severity.NOTE, found=values) for pair, values in found]


def _same_size(p: ParameterFile, a: str, b: str, sign: float) -> tuple[str, float, float] | None:
    """Both values where the second is ``sign`` times the first."""
    first, second = p.coefficient(a), p.coefficient(b)
    if first and second and first.value_si and second.value_si and _alike(first.value_si, sign * second.value_si):
        return f"{a} and {b}", first.value_si, second.value_si
    return None


def _ideal_products(p: ParameterFile) -> list[Check]:
    """Stated products of two velocities that have the size of Kirchhoff's for the stated added mass, and the other sign."""
    stated = np.nan_to_num(stated_matrix(p))
    ideal = products_once(ideal_quadratics((stated + stated.T) / 2.0))
    wrong, right = [], 0
    for t in force_law(p).terms:
        match slot(t):
            case ("signed", j, k) if j:  # with u they hold what separates and lifts too
                theory = float(ideal[COMPONENTS.index(t.component), j, k])
                right += _alike(t.coefficient, theory, MISTYPED)
                if _alike(t.coefficient, -theory, MISTYPED):
                    wrong.append((primed(t.symbol), t.coefficient, theory))
    if not wrong or not right:  # all of them reversed is a simulator's own convention
        return []
    values = "; ".join(f"{x:.4g}, by the added mass {y:.4g}" for _, x, y in wrong)
    return [Check.of("plausibility.kirchhoff", ", ".join(w[0] for w in wrong), Severity.WARN, values=values)]


def _alike(a: float, b: float, within: float = ALIKE) -> bool:
    return abs(a - b) <= within * max(abs(a), abs(b)) and a * b != 0.0


SMALL = 1e-4  # of the speed: a slope at zero, by central difference


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
        *([] if _in_air(parameters) else size_findings(parameters)),
        *law_findings(parameters),
        *twice_findings(parameters),
        *(as_check(f.code.partition(".")[0].replace("_", " "), f) for f in parameters.findings if known(f)),
    )


def law_findings(parameters: ParameterFile) -> tuple[Check, ...]:
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
            out.append(Check(LAW, f"{f.component} {f.table}", Severity.FAIL, now, f"{then}, as stated", means))
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
        out.append(Check(LAW, f"{f.component} {f.table}", severity, words, rule, comment))
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
        if _in_air(p)
        else imported_numbers.water(NAME, density)
    ]
    if p.mass is not None:
        diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
        out += imported_numbers.gyration(NAME, p.mass.mass, density, float(diagonal[1]), float(diagonal[5]))
        if p.mass.inertia_matrix is not None and not _in_air(p):
            own = about_another(np.array(p.mass.inertia_matrix), p.mass.mass, centre_of_gravity(p), np.zeros(3))
            out += imported_numbers.body_gyration(NAME, p.mass.mass, np.diag(own).tolist(), density, diagonal.tolist())
    return out


def _in_air(p: ParameterFile) -> bool:
    """A density of air, and no added mass of water."""
    densities = [p.conditions.density] + ([] if p.added_mass is None else [p.added_mass.density])
    return all(imported_numbers.AIR[0] < density <= imported_numbers.AIR[1] for density in densities)


def _buoyancy(p: ParameterFile) -> list[Check]:
    """Volume against mass, gravity, and which of the two centres is above the other."""
    h = p.hydrostatics
    if h is None:
        return []
    out = [*imported_numbers.gravity(NAME, h.gravity, "hydrostatics.gravity")]
    if p.mass is None:
        return out
    if not _in_air(p):
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
