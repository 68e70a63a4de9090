"""Whether damping damps, its rates are in radians, and both planes are written in one set of axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.types import dataclass
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS, LINEAR, MOTIONS, primed
from coeflab.vehicle.force_law import force_law, force_of_tables
from coeflab.vehicle.plausible_added_mass import MISTYPED, PROBE, stated_matrix
from coeflab.vehicle.second_order import products_once, slot

if TYPE_CHECKING:
    from coeflab.law.force_law import ForceTerm
    from coeflab.vehicle.parameter_file import ParameterFile


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
            values=", ".join(f"{_in_si(o.term, p):.4g}" for o in drives), count="one" if len(drives) == 1 else "many",
        ))  # fmt: skip
    for o in own:
        if not o.odd and o.term.component in "YKN":
            name = primed(o.term.symbol)
            facts = {"force": name[0], "motion": o.motion}
            out.append(Check.of("plausibility.one_way", name, Severity.WARN, statistic=o.term.coefficient, **facts))
    return out


def _in_si(term: ForceTerm, p: ParameterFile) -> float:
    """The number as the file has it at its speed, not the factor of its product."""
    c = p.coefficient(term.symbol)
    return term.coefficient if c is None or c.value_si is None else c.value_si


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
