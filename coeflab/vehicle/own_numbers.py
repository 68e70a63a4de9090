"""Numbers that a person states one by one: read as they are typed, and made a parameter file of.

Yv' = -0.0278 +- 0.0014          a prime
Yv = -35.5 +- 2 N/(m/s)          SI, at the density and speed of the file, and scaled with the speed as its prime is
Yv = -35.5 N/(m/s) constant      SI at every speed; "scaled" says the other
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from coeflab.bodies.thruster_keys import ThrusterKeys
from coeflab.core.axes import Datum, datum_name
from coeflab.core.declarations import validated
from coeflab.core.errors import InputError, shown, together
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error, words
from coeflab.core.types import Array, dataclass
from coeflab.core.units import also_written, positive_typed, three_typed, unit_ratio
from coeflab.core.version import VERSION
from coeflab.core.wording import listed, repeated
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.rigid_body import MassProperties, parallel_axis
from coeflab.law.scaling import Conditions, Scaling, doubtful_mass, doubtful_size, powers_of
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.from_shape import parameter_thruster
from coeflab.vehicle.matching import one_slope
from coeflab.vehicle.merge import SCALED_UNSAID
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile, ParameterPoint, Provenance
from coeflab.vehicle.parameter_parts import (
    Control,
    ParameterCovariance,
    ParameterHydrostatics,
    ParameterSurface,
    ParameterThruster,
)
from coeflab.vehicle.sizes import far_centre

STATED, BY_HAND = "stated", "--set"
EXAMPLE = '"Yv\'=-0.0278 +- 0.0014" or "Yv=-35.5 N/(m/s)"'
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
CONSTANT, SCALED = "constant", "scaled"
_OVER_SPEED = re.compile(rf"\s+({CONSTANT}|{SCALED})\b")
_UNIT = r"(?:[^\s,.\d+%\u00b1](?:(?!\+-|\+/-|\u00b1).)*?)?"
_TYPED = re.compile(
    rf"\s*(?P<value>{_NUMBER})\s*(?P<unit>{_UNIT})\s*"
    rf"(?:(?:\+-|\+/-|\u00b1)\s*(?P<u95>{_NUMBER})\s*(?P<of>%|{_UNIT})\s*)?"
)

ANOTHER_UNIT = (
    4.0  # times as far as the ends of the body: a centre of gravity in another unit, refused; nearer ones are warned of
)


@dataclass(frozen=True, slots=True)
class OwnNumber:
    """One number as it was typed.

    Attributes
    ----------
    symbol : str
        With prime.
    value : float
    u95 : float or None
    si : bool
        Whether both are SI, in the unit of the symbol, and no primes.
    over_speed : {"", "constant", "scaled"}
        What an SI value does at other speeds, where that is stated.
    """

    symbol: str
    value: float
    u95: float | None
    si: bool
    over_speed: str = ""

    @property
    def speed_power(self) -> int:
        """The n of U^n that the force goes with: 0 for a constant, and for products of two motions."""
        return 0 if self.over_speed == CONSTANT else powers_of(self.symbol)[0]

    def coefficient(self, scaling: Scaling, at: Conditions, body: str) -> Coefficient:
        """The coefficient by this length, at these conditions."""
        unit = scaling.unit(self.symbol, at.density, at.speed)
        to_prime = 1.0 / unit if self.si else 1.0
        value = self.value * to_prime
        return Coefficient(
            self.symbol, value, None if self.u95 is None else self.u95 * to_prime, Status.STATED, body, origin=STATED,
            estimator="stated one by one", value_si=self.value if self.si else value * unit, unit_si=derivative(self.symbol).unit,
            law="motion" if self.speed_power == powers_of(self.symbol)[0] else "rest",
        )  # fmt: skip


def own_number(typed: str) -> OwnNumber:
    """Read ``Yv'=-0.0278 +- 0.0014``, ``Yv=-35.5 N/(m/s) +- 6 %`` or ``Ydr=1.9 +- 0.2 N/deg``; a unit of the kind is converted.

    Behind an SI value may stand ``constant``, that it holds at every speed, or ``scaled``, that it goes with the speed as its prime.

    Raises
    ------
    InputError
        No symbol, no number, a negative U95, a unit behind a prime, or none or one of another kind behind an SI value.
    """
    named, equals, rest = typed.partition("=")
    symbol = named.strip()
    if not equals:
        raise InputError(shown(typed), f"SYMBOL=VALUE, such as {EXAMPLE}", column="--set")
    try:
        d = derivative(symbol)
    except InputError as why:
        raise why.at(column="--set") from None
    over_speed = _OVER_SPEED.findall(rest)
    match = _TYPED.fullmatch(_OVER_SPEED.sub("", rest))
    if match is None or len(over_speed) > 1:
        raise InputError(f"{shown(rest.strip())} for {symbol}", f"a number, such as {EXAMPLE}", column="--set",
                         advice="Write a decimal point." if "," in rest else "")  # fmt: skip
    value, u95 = float(match["value"]), None if match["u95"] is None else float(match["u95"])
    units = [match["unit"] or (match["of"] or "").strip("%"), (match["of"] or match["unit"]).strip("%")]
    if u95 is not None and match["of"] == "%":
        u95 *= abs(value) / 100.0
    if not np.isfinite(value) or (u95 is not None and not (np.isfinite(u95) and u95 >= 0.0)):
        raise InputError(f"{shown(rest.strip())} for {symbol}", "finite numbers, U95 of zero or more", column="--set")
    is_prime = symbol.endswith("'")
    unit = units[0] or units[1]
    if is_prime and unit:
        raise input_error("vehicle.unit_behind_prime", column="--set", unit=shown(unit), symbol=symbol, text=d.text)
    if is_prime and over_speed:
        raise input_error(
            "vehicle.speed_behind_prime", column="--set", over_speed=over_speed[0], symbol=symbol, text=d.text
        )
    ratios = [1.0 if is_prime else unit_ratio(u, d.unit) for u in units]
    if ratios[0] is None or (u95 is not None and ratios[1] is None and match["of"] != "%"):
        raise input_error(
            "vehicle.also_written", column="--set", text=d.text, value=f"the unit {shown(unit)}" if unit else "no unit",
            unit=d.unit, also_written=also_written(d.unit), constant=CONSTANT, scaled=SCALED,
        )  # fmt: skip
    value *= ratios[0]
    u95 = None if u95 is None else u95 * (ratios[0] if match["of"] == "%" or ratios[1] is None else ratios[1])
    return OwnNumber(primed(d.text), value, u95, not is_prime, over_speed[0] if over_speed else "")


def own_numbers(typed: Sequence[str | OwnNumber]) -> tuple[OwnNumber, ...]:
    """All that is typed, or was read from a file, none twice.

    Raises
    ------
    InputError
        As of `own_number`, or a symbol that stands twice, be it under two names.
    """
    read, complaints = [], []
    for one in typed:
        try:
            read.append(one if isinstance(one, OwnNumber) else own_number(one))
        except InputError as why:
            complaints.append(why)
    if complaints:
        raise together(complaints)
    out = tuple(read)
    if twice := repeated(n.symbol for n in out):
        raise InputError(f"{', '.join(twice)} twice", "each symbol once", column="--set")
    for slope, names in one_slope(n.symbol for n in out).items():
        raise input_error("vehicle.are_one_slope", column="--set", names=listed(names), slope=slope)
    return out


def scaled_unsaid(numbers: Sequence[OwnNumber], speed: float) -> tuple[Finding, ...]:
    """SI values that change with the speed, where nobody said so: a finding a power of U."""
    named: dict[int, list[str]] = {}
    for n in numbers:
        if n.si and not n.over_speed and n.speed_power:
            named.setdefault(n.speed_power, []).append(derivative(n.symbol).text)
    return tuple(
        Finding.of(
            SCALED_UNSAID, listed(names), Severity.NOTE, statistic=float(speed), power="U" if power == 1 else f"U^{power}",
            twice=2.0**power, symbols=tuple(names), advice=f'--set "{names[0]}=... {derivative(names[0]).unit} {CONSTANT}"',
        )
        for power, names in sorted(named.items())
    )  # fmt: skip


def imported_file(
    name: str, body: str, scaling: Scaling, conditions: Conditions, point: Array, datum: Datum, numbers: Sequence[OwnNumber],
    mass: MassProperties | None = None, hydrostatics: ParameterHydrostatics | None = None,
) -> ParameterFile:  # fmt: skip
    """A parameter file of numbers that somebody states.

    Parameters
    ----------
    name, body : str
    scaling : Scaling
    conditions : Conditions
    point : (3,) array
        m, FRD, from the datum: what moments and rates are about.
    datum : Datum
    numbers : sequence of OwnNumber
    mass : MassProperties, optional
        Without primes.
    hydrostatics : ParameterHydrostatics, optional

    Notes
    -----
    Numbers with U95 count as independent of each other: nothing says otherwise.
    """
    coefficients = tuple(n.coefficient(scaling, conditions, body) for n in numbers)
    variances = [None if c.u95 is None else (c.u95 / 2.0) ** 2 for c in coefficients]
    covariance = tuple(
        tuple(None if a is None or b is None else a if i == j else 0.0 for j, b in enumerate(variances))
        for i, a in enumerate(variances)
    )
    notes = ["numbers stated one by one, none fitted by coeflab"]
    if sum(v is not None for v in variances) > 1:
        notes.append("numbers with U95 count as independent of each other")
    x, y, z = map(float, point)
    none: tuple[CoveredRange, ...] = ()
    return ParameterFile(
        name=name, body=body, scaling=scaling,
        reference_point=ParameterPoint(point=(x, y, z), datum=datum.id),
        conditions=conditions,
        mass=None if mass is None else mass.primed(scaling, conditions.density),
        coefficients=coefficients,
        covariance=ParameterCovariance(symbols=tuple(c.symbol for c in coefficients), matrix=covariance),
        covered=none, hydrostatics=hydrostatics, findings=scaled_unsaid(numbers, conditions.speed),
        provenance=Provenance(coeflab_version=VERSION, study=name, inputs=(), citations=(), notes=tuple(notes)),
    )  # fmt: skip


def as_file(base: ParameterFile, numbers: Sequence[OwnNumber]) -> ParameterFile:
    """The numbers as a file of the base's length, conditions and reference point, to be merged into it."""
    at = base.reference_point
    result = imported_file(BY_HAND, base.body, base.scaling, base.conditions, np.array(at.point), at.origin, numbers)
    return result.model_copy(update={"provenance": result.provenance.model_copy(update={"notes": ()})})


def mass_of(mass: float, centre: Array | None, inertia: Sequence[float] = ()) -> MassProperties:
    """Mass properties as a person states them.

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,) array or None
        Centre of gravity from the reference point, m, FRD; None: in it.
    inertia : sequence of float
        About the centre of gravity, kg m^2: the transverse moment alone, Iy = Iz; or Ix, Iy, Iz, products zero.

    Raises
    ------
    InputError
        Two moments of inertia, or some that no body has.
    """
    if len(inertia) not in (0, 1, 3):
        raise input_error("vehicle.moments_of_inertia", column="--inertia", n_inertia=len(inertia))
    place = np.zeros(3) if centre is None else np.asarray(centre)
    x = float(place[0])
    about = np.diag(inertia) + parallel_axis(mass, place) if len(inertia) == 3 else None
    result = MassProperties(
        mass, mass * x, inertia[0] + mass * x * x if len(inertia) == 1 else None,
        place if centre is not None or about is not None else None, about,
    )  # fmt: skip
    try:
        result.refuse()
    except ValueError as why:
        raise InputError(str(why), "moments of inertia of a body", column="--inertia") from None
    return result


def typed_file(
    name: str, numbers: Sequence[str | OwnNumber], *, length: str, length_name: str, speed: str, density: str, about: str, mass: str = "",
    cg: str = "", inertia: str = "", volume: str = "", cb: str = "", body: str = "", thrusters: Sequence[str] = (), rudder: str = "",
    stern_planes: str = "", bow_planes: str = "",
) -> ParameterFile:  # fmt: skip
    """A parameter file of what a person typed behind the options of ``coeflab params new``; empty: not stated.

    Parameters
    ----------
    name, body : str
    numbers : sequence of str or OwnNumber
        As `own_number` reads them, or read.
    length, speed, density, mass, volume : str
        In SI or with a unit.
    length_name : str
    about : str
        Id of the reference point.
    cg, cb : str
        Three numbers from it, m, FRD.
    inertia : str
        About the centre of gravity, one or three numbers, kg m^2.
    thrusters : sequence of str
        As `typed_thruster` reads them.
    rudder, stern_planes, bow_planes : str
        Limit of its angle, and its rate: ``30 deg, 30 deg/s``; without a rate it moves at once.

    Raises
    ------
    InputError
        What is missing, or no number, by option.
    """
    for option, given in (("--length", length), ("--speed", speed), ("--density", density), ("--about", about)):
        if not given.strip():
            raise InputError("nothing", "cg, nose, midship ..." if option == "--about" else "a number", column=option,
                             advice=f"Add {option}: nothing is assumed.")  # fmt: skip
    if not numbers:
        raise InputError("no number", f"SYMBOL=VALUE, such as {EXAMPLE}", column="--set",
                         advice="A sheet of them: --from FILE.")  # fmt: skip
    known = own_numbers(numbers)
    scaling = Scaling(positive_typed(length, "length", "--length"), length_name)
    conditions = Conditions(
        positive_typed(density, "density", "--density"), positive_typed(speed, "speed", "--speed"), None
    )
    for key, number, option in (
        ("scaling.length", scaling.length, "--length"), ("conditions.density", conditions.density, "--density"),
        ("conditions.speed", conditions.speed, "--speed"),
    ):  # fmt: skip
        if doubt := doubtful_size(key, number):
            raise InputError(f"{number:g}", "a usual size of what swims", column=option, advice=f"{doubt}.")
    weighed = None
    if mass:
        if not cg and about.strip() != "cg":
            raise input_error("vehicle.mass_without_centre", column="--cg", about=about)
        heavy = positive_typed(mass, "mass", "--mass")
        if doubt := doubtful_mass(heavy, conditions.density, scaling):
            raise InputError(f"{heavy:g} kg", "a usual mass of what swims", column="--mass", advice=f"{doubt}.")
        one = [positive_typed(inertia, "inertia", "--inertia")] if inertia and "," not in inertia else []
        weighed = mass_of(
            heavy, np.array(three_typed(cg, "length", "--cg")) if cg else None,
            one or (three_typed(inertia, "inertia", "--inertia") if inertia else ()),
        )  # fmt: skip
    elif cg or inertia:
        raise InputError("nothing", "a mass, for --cg and --inertia to be of", column="--mass")
    afloat = None
    if volume or cb:
        if not (volume and cb):
            raise input_error("vehicle.volume_or_centre_alone", column="--cb" if volume else "--volume")
        afloat = ParameterHydrostatics(
            volume=positive_typed(volume, "volume", "--volume"), centre_of_buoyancy=three_typed(cb, "length", "--cb")
        )
    try:
        datum = Datum.named(datum_name(about.strip()))
    except InputError as why:
        raise why.at(column="--about") from None
    result = imported_file(name, body or name, scaling, conditions, np.zeros(3), datum, known, weighed, afloat)
    for found in (words(f) for f in far_centre(result) if (f.statistic or 0.0) > ANOTHER_UNIT * (f.threshold or 0.0)):
        raise InputError(f"{shown(cg)}. {found.statement.rstrip('.')}", found.rule, column="--cg", advice=found.advice)
    driven, surfaces = typed_thrusters(thrusters, conditions), typed_surfaces(rudder, stern_planes, bow_planes)
    return result.model_copy(update={"thrusters": driven, "surfaces": surfaces})


def typed_thrusters(texts: Sequence[str], conditions: Conditions) -> tuple[ParameterThruster, ...]:
    """Thrusters of different names; see `typed_thruster`."""
    out = tuple(typed_thruster(t, conditions) for t in texts)
    if twice := repeated(t.name for t in out):
        raise InputError(f"{', '.join(twice)} twice", "each thruster once", column="--thruster")
    return out


def typed_surfaces(rudder: str, stern_planes: str, bow_planes: str) -> tuple[ParameterSurface, ...]:
    """Limits and rates of the controls that are stated; see `typed_surface`."""
    fins: tuple[tuple[Control, str, str], ...] = (
        ("dr", rudder, "--rudder"),
        ("ds", stern_planes, "--stern-planes"),
        ("db", bow_planes, "--bow-planes"),
    )
    return tuple(typed_surface(control, text, option) for control, text, option in fins if text)


def typed_surface(control: Control, text: str, option: str) -> ParameterSurface:
    """Read ``30 deg, 30 deg/s``: the limit of a control's angle, and its rate.

    Raises
    ------
    InputError
    """
    limit, comma, rate = text.partition(",")
    return ParameterSurface(
        control=control, limit=positive_typed(limit.strip(), "angle", option),
        rate=positive_typed(rate.strip(), "rate", option) if comma else None,
    )  # fmt: skip


NUMBERS = ("bollard", "rate", "bollard_astern", "dead_zone", "torque", "handedness", "tilt_limit", "lag")
VECTORS = ("place", "axis", "tilt_axis")
WORDS = ("command", "unit")
COMMANDS = ("rate", "dead_zone")


def typed_thruster(text: str, conditions: Conditions) -> ParameterThruster:
    """Read ``main; bollard = 60 N; rate = 720; place = -0.8, 0, 0``: the keys of [[thruster]] of a body.toml.

    Parameters
    ----------
    text : str
        A name, then key = value, apart at semicolons; ``axis`` is ahead and ``place`` the reference point unless given.
    conditions : Conditions

    Raises
    ------
    InputError
    """
    name, *rest = (part.strip() for part in text.split(";"))
    keys: dict[str, object] = {"name": name, "place": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0]}
    for part in filter(None, rest):
        key, equals, value = (x.strip() for x in part.partition("="))
        if not equals or key not in (*NUMBERS, *VECTORS, *WORDS):
            raise InputError(
                shown(part), f"KEY = VALUE with {', '.join((*NUMBERS, *VECTORS, *WORDS))}", column="--thruster"
            )
        try:
            keys[key] = (
                [float(x) for x in value.split(",")] if key in VECTORS else float(value) if key not in WORDS else value
            )
        except ValueError:
            keys[key] = value
    for key in COMMANDS:  # "1100 rpm" says the unit of the command as well
        number, _, unit = str(keys.get(key, "")).partition(" ")
        if unit and keys.setdefault("unit", unit) == unit:
            keys[key] = float(number) if re.fullmatch(r"[-+.\d]+(e[-+]?\d+)?", number) else keys[key]
    try:
        stated = validated(ThrusterKeys, keys)
    except InputError as why:
        raise why.at(column=f"--thruster {why.column or ''}".strip()) from None
    return parameter_thruster(stated.built, np.zeros(3), conditions)
