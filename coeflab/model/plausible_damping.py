"""Whether damping damps, its rates are in radians, and both planes are written in one set of axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.symbols import COMPONENTS, MOTIONS, primed
from coeflab.kernels.brief import brief
from coeflab.model.check import Check, Severity
from coeflab.model.force_law import LawTerm, force_law
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.plausible_added_mass import NAME, stated_matrix

PLANES = (("Y", "N", 1, 5), ("Z", "M", 2, 4))
SMALLEST = {1: 0.15, 2: 0.05}
MIRRORED = (("Nv", "Mw"), ("Nuv", "Muw"), ("Yr", "Zq"), ("Yur", "Zuq"))
ALIKE = 0.01
WRONG = "a sign is wrong."


@brief
@dataclass(frozen=True, slots=True)
class _Own:
    """A term of a motion on itself."""

    term: LawTerm
    motion: str
    odd: bool


def damping_findings(p: ParameterFile) -> list[Check]:
    """Signs, rates and axes; at least one finding about the signs."""
    own = _own_terms(p)
    out = _signs(own)
    if not own:
        out.append(
            _check("damping", Severity.WARN, "none of X0', Xu, Yv, Zw, Kp, Mq, Nr", "at least one", "Nothing damps.")
        )
    elif not any(c.severity is Severity.FAIL for c in out):
        out.append(_check("damping", Severity.PASS, f"{len(own)} terms of a motion on itself", "below zero"))
    return [*out, *_rates(p, own), *_mirrored(p)]


def _check(subject: str, severity: Severity, statistic: str, rule: str, comment: str = "") -> Check:
    return Check(NAME, subject, severity, statistic, rule, comment)


def _own_terms(p: ParameterFile) -> list[_Own]:
    out = []
    for t in force_law(p).terms:
        variables = {v for v, _, _ in t.term.factors}
        motion = MOTIONS[COMPONENTS.index(t.component)]
        resistance = t.component == "X" and not variables and t.speed_power == 2
        if t.coefficient != 0.0 and (variables == {motion} or resistance):
            out.append(_Own(t, motion, t.term.odd_in(motion) or resistance))
    return out


def _signs(own: list[_Own]) -> list[Check]:
    out = []
    drives = [o for o in own if o.odd and o.term.coefficient > 0.0]
    if drives:
        it = "It drives the motion that it" if len(drives) == 1 else "They drive the motions that they"
        out.append(_check(", ".join(primed(o.term.symbol) for o in drives), Severity.FAIL,
                          ", ".join(f"{o.term.coefficient:.4g}" for o in drives) + " (SI)", "below zero",
                          f"{it} should damp: {WRONG}"))  # fmt: skip
    for o in own:
        if not o.odd and o.term.component in "YKN":
            name = primed(o.term.symbol)
            out.append(_check(name, Severity.WARN, f"{o.term.coefficient:.4g} (SI)",
                              "zero for a body symmetric port to starboard",
                              f"It pushes one way in both directions; {name[0]}{o.motion}|{o.motion}|' is meant?"))  # fmt: skip
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
                n = a.term.term.degree
                same = n == b.term.term.degree and a.term.speed_power == b.term.speed_power and a.odd and b.odd
                if (a.term.component, b.term.component) != (force, moment) or not same or n not in SMALLEST:
                    continue
                usual = a.term.coefficient * (diagonal[j] / diagonal[i]) ** (0.5 * (n + 1))
                if 0.0 < (share := b.term.coefficient / usual) < SMALLEST[n]:
                    out.append(_check(
                        primed(b.term.symbol), Severity.WARN, f"{b.term.coefficient:.4g}, {share:.2g} of k^{n + 1} {a.term.symbol}",
                        f"at least {SMALLEST[n]:g}; k = {(diagonal[j] / diagonal[i]) ** 0.5:.3g} m of the added mass",
                        "Is it per degree and second? Rates are in rad/s.",
                    ))  # fmt: skip
    return out


def _mirrored(p: ParameterFile) -> list[Check]:
    """Yaw and pitch of the same size and sign, which x forward, y starboard, z down turn against each other."""
    found = []
    for a, b in MIRRORED:
        first, second = p.coefficient(a), p.coefficient(b)
        if first and second and first.value_si and second.value_si and _alike(first.value_si, second.value_si):
            found.append((f"{a} and {b}", first.value_si, second.value_si))
    matrix = np.nan_to_num(stated_matrix(p))
    if matrix[1, 5] and _alike(matrix[1, 5], matrix[2, 4]):
        found.append(("M_A Yr and Zq", matrix[1, 5], matrix[2, 4]))
    if not found:
        return []
    return [_check(
        "; ".join(f[0] for f in found), Severity.WARN, "; ".join(f"{x:.4g} and {y:.4g}" for _, x, y in found), "of opposite signs",
        "A body alike in both planes has them opposite with z down (FRD). Were the planes copied from different axes?",
    )]  # fmt: skip


def _alike(a: float, b: float) -> bool:
    return abs(a - b) <= ALIKE * max(abs(a), abs(b))
