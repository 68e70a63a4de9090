"""Where the viscous side force of drift and of turning acts: aft of the centre of gravity and on the body.

A strip of the body at x that resists its cross-flow velocity v + x r with c(x) >= 0 gives Yv = -S c, Nv = Yr = -S c x,
Nr = -S c x^2 (S: the integral along the body). So with the potential parts taken off, Nv/Yv and Yr/Yv are centres of what
separates and lifts, and Nr/Yv is the square of a distance. Flow separates, and tails are set, aft. A wrong sign of Nv or Yr
moves its centre ahead or off the body; so does inertia of the model in a rotating arm's force, which reads Yr' - m' and
Nr' - m' xG', or inertia subtracted from a force that never contained it. In the vertical plane Zw, -Mw, -Zq, Mq stand for Yv, Nv, Yr,
Nr.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.law.symbols import primed
from coeflab.vehicle.expected_signs import REACH, UNSURE

if TYPE_CHECKING:
    from coeflab.law.coefficient import Coefficient
    from coeflab.study.study import Study
    from coeflab.vehicle.parameter_file import ParameterFile

summary = "centres of the viscous side force against the hull; inertia in rotating-arm forces against m'"
citations = ("feldman1979", "gertler1967")

PLANES = (("Yv", "Nv", "Yr", "Nr", 1.0), ("Zw", "Mw", "Zq", "Mq", -1.0))
ANYWHERE = 1.75  # from a reference point that may lie at either end
ALONE = (-0.3, 0.9)  # Yr' / m' where nobody measured Yv'; 0.1 to 0.5 on hulls with and without tails


@dataclass(frozen=True, slots=True)
class _Plane:
    """One plane of a file, turned so that its four derivatives have the signs of the horizontal one."""

    file: ParameterFile
    slope: Coefficient | None
    moment: Coefficient | None
    rate: Coefficient | None
    damping: Coefficient | None
    sign: float
    mass: float | None
    centre: float | None
    taken_out: bool | None
    model: float | None

    @property
    def reach(self) -> float:
        """How far from the centre a force may act, x/L."""
        return REACH if self.centre is not None else ANYWHERE

    def place(self, c: Coefficient, less: float = 0.0) -> tuple[float, float]:
        """Forward of the centre, x/L, with its half-width, of a value that is too large by ``less``."""
        assumed = UNSURE * (self.mass or 0.0) if c.potential is None else UNSURE * abs(c.potential)
        slope = _value(self.slope)
        x = self.sign * (_value(c) - less - (c.potential or 0.0)) / slope
        doubt = ((c.u95 or 0.0) + assumed + abs(x) * (self.slope.u95 or 0.0 if self.slope else 0.0)) / abs(slope)
        return x - (self.centre or 0.0), doubt

    def is_significant(self, c: Coefficient, less: float = 0.0) -> bool:
        """Whether the force acts on the body and, where the centre is known, not ahead of it."""
        x, doubt = self.place(c, less)
        return abs(x) - doubt <= self.reach and (self.centre is None or x - doubt <= 0.0)

    def readings(self, c: Coefficient, prime: float) -> Iterator[tuple[str, float]]:
        """What the value would be in place of what stands there: with the inertia treated the other way, with its other sign."""
        if prime and self.taken_out is not True:
            yield "if the table contains the model's inertia (contains_inertia = true)", _value(c) + prime
        if prime and self.taken_out is not False:
            yield "if it never contained the inertia that was subtracted (contains_inertia = false)", _value(c) - prime
        yield "with the other sign", -_value(c)


def check(study: Study) -> Sequence[Check]:
    """Findings on both planes of every parameter file, whatever the origin of its coefficients."""
    out: list[Check] = []
    for name, file in study.parameter_files.items():
        for plane in _planes(study, name, file):
            found = _drift(plane), _turning(plane), _damping(plane), _contained(plane)
            out += [c for c in found if c is not None]
    return out


def _planes(study: Study, name: str, file: ParameterFile) -> Iterator[_Plane]:
    mass = None if file.mass is None else file.mass.mass_prime
    centre = None if file.mass is None else file.mass.mass_moment_prime / file.mass.mass_prime
    if mass is None:
        mass = _displaced(study, name, file)
    if centre is None and file.added_mass is not None and (across := file.added_mass.matrix[1][1]) > 0.0:
        centre = file.added_mass.matrix[1][5] / across / file.scaling.length
    for slope, moment, rate, damping, sign in PLANES:
        found = [file.coefficient(s) for s in (slope, moment, rate, damping)]
        given = [c if c is not None and c.value is not None and c.law == "motion" else None for c in found]
        rotary = next((c for c in given[2:] if c is not None), None)
        yield _Plane(
            file, given[0], given[1], given[2], given[3], sign, mass, centre, _inertia_taken_out(study, rotary),
            mass if file.mass is not None else _modelled(study, file, rotary),
        )  # fmt: skip


def _displaced(study: Study, name: str, file: ParameterFile) -> float | None:
    """M' of a neutrally buoyant body of the known volume."""
    stated = study.body.configuration(file.body) if study.body else None
    volume = stated.volume if stated else None
    if volume is None and name in study.hulls:
        volume = study.hulls[name].body.require_shape().volume
    return volume / file.scaling.unit("m", 1.0) if volume else None


def _inertia_taken_out(study: Study, c: Coefficient | None) -> bool | None:
    """None where no table of the study gives the value."""
    return next((t.inertia_subtracted for t in study.tables if c is not None and c.table and t.name == c.table), None)


def _modelled(study: Study, file: ParameterFile, c: Coefficient | None) -> float | None:
    """M' of the model that the table of a value was run with, where its campaign states it; of the file's primes."""
    table = next((t for t in study.tables if c is not None and c.table == t.name), None)
    if table is None or table.model_mass is None:
        return None
    return table.model_mass / file.scaling.unit("m", table.conditions.density)


def _value(c: Coefficient | None) -> float:
    return 0.0 if c is None or c.value is None else c.value


def _drift(p: _Plane) -> Check | None:
    """Nv and Mw: only where the Munk moment, most of them, is known."""
    c = p.moment
    if c is None or c.potential is None or _value(p.slope) >= 0.0:
        return None
    x, doubt = p.place(c)
    rule = f"within {p.reach:g} L"
    if abs(x) - doubt <= p.reach:
        return _passed(p, c, x, rule)
    fits = abs(p.place(c, 2.0 * _value(c))[0]) <= p.reach
    return _doubted(p, c, f"viscous force {_placed(p, x)}", rule, list(p.readings(c, 0.0)) if fits else [])


def _turning(p: _Plane) -> Check | None:
    """Yr and Zq."""
    c = p.rate
    if c is None:
        return None
    prime = p.sign * (p.mass or 0.0)
    if p.slope is None:
        return _turning_alone(p, c, prime)
    if _value(p.slope) >= 0.0:
        return None
    x, doubt = p.place(c)
    rule = f"{'aft, ' if p.centre is not None else ''}within {p.reach:g} L"
    if p.is_significant(c) or (abs(x) - doubt <= p.reach and _drifts_ahead(p)):
        return _passed(p, c, x, rule)
    fitting = [r for r in p.readings(c, prime) if p.is_significant(c, _value(c) - r[1])]
    return _doubted(p, c, f"viscous force {_placed(p, x)}", rule, fitting)


def _drifts_ahead(p: _Plane) -> bool:
    """Whether drift, too, makes its viscous force ahead: a vehicle with its fins forward."""
    if p.moment is None or p.moment.potential is None:
        return False
    x, doubt = p.place(p.moment)
    return x - doubt > 0.0


def _turning_alone(p: _Plane, c: Coefficient, prime: float) -> Check | None:
    """Yr and Zq of a file without Yv or Zw, about a point near the centre of gravity: against m' alone."""
    if not prime or p.centre is None or abs(p.centre) > UNSURE:
        return None
    low, high = ALONE
    if low <= _value(c) / prime <= high:
        return None
    near = [r for r in p.readings(c, prime) if low <= r[1] / prime <= high]
    return _doubted(p, c, f"{_value(c) / prime:.2f} m'", f"{low:g} to {high:g} m'", near)


def _damping(p: _Plane) -> Check | None:
    """Nr and Mq where the lever of the centre of gravity makes m' xG' felt."""
    c, prime = p.damping, (p.mass or 0.0) * (p.centre or 0.0)
    if c is None or abs(prime) < 0.05 * abs(_value(c)) or _value(p.slope) >= 0.0:
        return None
    furthest = abs(p.centre or 0.0) + REACH

    def fits(value: float) -> bool:
        return 0.0 <= (value - (c.potential or 0.0)) / _value(p.slope) <= furthest**2

    if fits(_value(c)):
        return None
    rule = f"{primed(c.symbol[:-1])}/{p.slope.symbol if p.slope else ''} from 0 to {furthest**2:.2f} L^2"
    near = [(w, v) for w, v in p.readings(c, prime) if fits(v)]
    return _doubted(p, c, f"{_value(c):.4g}, with m' xG' = {prime:.3g}", rule, near)


def _contained(p: _Plane) -> Check | None:
    """Yr and Zq of a table that is declared to be without inertia, and that are just what the model's mass would give."""
    c = p.rate
    if (
        c is None
        or c.u95 is None
        or p.taken_out is not False
        or not p.model
        or abs(_value(c) + p.sign * p.model) > c.u95
    ):
        return None
    return Check.of(
        "viscous_centre.contained", f"{p.file.name} {c.symbol}", Severity.NOTE, symbol=c.symbol, value=_value(c), u95=c.u95,
        mass=-p.sign * p.model, without=_value(c) + p.sign * p.model,
    )  # fmt: skip


def _placed(p: _Plane, x: float) -> str:
    of = "the centre of gravity" if p.file.mass is not None else "the centre of the added mass"
    return f"{abs(x):.2f} L {'ahead' if x > 0.0 else 'aft'} of {of if p.centre is not None else 'the reference point'}"


def _passed(p: _Plane, c: Coefficient, x: float, rule: str) -> Check:
    side = "aft" if x <= 0.0 else "ahead"
    return Check.of(
        "viscous_centre.sound", f"{p.file.name} {c.symbol}", Severity.PASS, place=_placed(p, x), rule=rule, side=side
    )


def _doubted(p: _Plane, c: Coefficient, found: str, rule: str, readings: Sequence[tuple[str, float]]) -> Check:
    """A warning with every reading of the value that would stand."""
    case = "readings" if readings else "no_mass" if p.mass is None and c is p.rate else "none"
    each = "; ".join(f"{words}, {c.symbol} = {value:.4g}" for words, value in readings)
    inertia = p.mass is not None and any("inertia" in w for w, _ in readings)
    return Check.of(
        "viscous_centre.doubted", f"{p.file.name} {c.symbol}", Severity.WARN, found=found, rule=rule, case=case, symbol=c.symbol,
        value=_value(c), each=each, mass=f" m' = {p.mass:.4g}." if inertia else "",
    )  # fmt: skip
