"""What an export loses: the target's own force law against that of the parameter file, over the range that is covered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from coeflab.core.types import Array, brief, locked
from coeflab.formats.lost import Lost
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.law.rigid_body import momentum_force
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.vehicle.force_law import force_of_tables
from coeflab.vehicle.inertia import WaterInertia, known_mass, water_inertia
from coeflab.vehicle.law_at_points import LawAtPoints, law_at_points
from coeflab.vehicle.parameter_file import ParameterFile

SPEEDS = (0.5, 1.0, 1.5)  # of the file's: a law that holds at one speed only shows
# Values of a motion: zero and both signs at the least, five where there are fewer than MANY motions to combine.
POINTS, FEW, MANY = 5, 3, 5
ASSUMED = 0.2  # prime range of a motion that no campaign covers: 11 deg of incidence
LOSSLESS = 1e-9  # rounding of coefficients that are written with 17 digits and multiplied a few times
ANGLES = {"asin(v/U)": "v", "asin(w/U)": "w"}


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Apart:
    """How far a target is from the parameter file, six components each: forces, or rates of u v w p q r.

    Attributes
    ----------
    worst, rms : (6,) array
        Largest and root-mean-square difference; NaN of a component that is not compared.
    largest, size : (6,) array
        Largest and root-mean-square value of the file.
    """

    worst: Array
    rms: Array
    largest: Array
    size: Array

    def __post_init__(self) -> None:
        for name in ("worst", "rms", "largest", "size"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def relative(self) -> Array:
        """(6,) worst over the largest value of the component; over the largest of its three where that is zero."""
        scale = self.largest.copy()
        for group in (slice(0, 3), slice(3, 6)):
            scale[group] = np.where(scale[group] == 0.0, np.nanmax(scale[group], initial=0.0), scale[group])
        return np.divide(self.worst, scale, out=np.where(self.worst > 0.0, np.inf, 0.0), where=scale != 0.0)

    @property
    def furthest(self) -> tuple[int, float]:
        """The component with the largest relative difference, the first of those that are alike to rounding, and that."""
        shares = np.nan_to_num(self.relative, nan=0.0, posinf=np.inf)
        return int(np.argmax(shares >= shares.max() * (1.0 - LOSSLESS))), float(shares.max())


def apart(theirs: Array, ours: Array) -> Apart:
    """The difference of (n, 6) values."""
    by = np.abs(theirs - ours)
    return Apart(
        by.max(axis=0), np.sqrt((by**2).mean(axis=0)), np.abs(ours).max(axis=0), np.sqrt((ours**2).mean(axis=0))
    )


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Loss:
    """What one target makes of one parameter file.

    Attributes
    ----------
    target : str
    not_held : tuple of str
        Terms that the target cannot represent, in words, symbol first.
    lost : tuple of Lost
        What is lost beside terms.
    changes : tuple of str
        What was changed in sign, axes or form, and why.
    forces : Apart
        Of the target's force from the file's, over the grid; N and N m.
    accelerations : Apart or None
        Of the rates of u v w p q r, m/s^2 and rad/s^2, over the grid and from rest under a push along each axis. NaN for motions
        whose inertia the file does not state; None where none is compared.
    not_compared : str
        Why accelerations are not, or not all, compared, in words; empty where all are.
    water : WaterInertia
        The accelerations that the export was asked for.
    grid : str
        The velocities that were tried, in words.
    at_points : tuple of LawAtPoints
        How far the target's force is from the measured points of the file; empty where the file has none.
    """

    target: str
    not_held: tuple[str, ...]
    lost: tuple[Lost, ...]
    changes: tuple[str, ...]
    forces: Apart
    accelerations: Apart | None
    not_compared: str
    water: WaterInertia
    grid: str
    at_points: tuple[LawAtPoints, ...] = ()

    @property
    def worst(self) -> Array:
        """(6,) of the forces, as in `Apart`."""
        return self.forces.worst

    @property
    def rms(self) -> Array:
        """(6,) of the forces, as in `Apart`."""
        return self.forces.rms

    @property
    def largest(self) -> Array:
        """(6,) of the forces, as in `Apart`."""
        return self.forces.largest

    @property
    def size(self) -> Array:
        """(6,) of the forces, as in `Apart`."""
        return self.forces.size

    @property
    def relative(self) -> Array:
        """(6,) of the forces, as in `Apart`."""
        return self.forces.relative

    @property
    def furthest(self) -> tuple[str, float]:
        """The force component, or the rate of a motion, with the largest relative difference, and that."""
        i, share = self.forces.furthest
        found = COMPONENTS[i], share
        if self.accelerations is not None:
            j, other = self.accelerations.furthest
            found = (f"d{MOTIONS[j]}/dt", other) if other > max(share, LOSSLESS) else found
        return found

    @property
    def worse_than_nothing(self) -> tuple[str, ...]:
        """Components in which the target is further from the file than no force at all would be, in the root mean square."""
        least = LOSSLESS * self.largest.max(initial=0.0)
        return tuple(c for c, r, s in zip(COMPONENTS, self.rms, self.size, strict=True) if r > max(s, least))

    @property
    def lossless(self) -> bool:
        """Whether the target holds everything, has what it needs, and forces and accelerations are the file's to rounding."""
        return not self.not_held and not self.lost and self.furthest[1] <= LOSSLESS


def covered_grid(parameters: ParameterFile) -> tuple[Array, str]:
    """Velocities (n, 6) over what the file offers, see `ParameterFile.offered`, at half, full and one and a half times its speed.

    Every combination of a few values of each covered motion; straight motion alone where none is covered. A motion that
    the file has terms of and no campaign covers, such as a rate from literature, is tried to 0.2 either way.
    """
    speed, length = parameters.conditions.speed, parameters.scaling.length
    ranges: dict[str, tuple[float, float]] = {}
    for c in parameters.offered:
        name = ANGLES.get(c.variable, c.variable.removesuffix("'"))
        if name not in MOTIONS:
            continue
        low, high = np.sin([c.low, c.high]) if c.variable in ANGLES else (c.low, c.high)
        before = ranges.get(name, (low, high))
        ranges[name] = (min(float(low), before[0]), max(float(high), before[1]))
    assumed = [n for n in MOTIONS[1:] if n not in ranges and n in _moved_by_terms(parameters)]
    ranges |= dict.fromkeys(assumed, (-ASSUMED, ASSUMED))
    names = list(ranges)
    values = [np.linspace(*ranges[n], POINTS if len(names) < MANY else FEW) for n in names]
    rows = []
    for factor in SPEEDS:
        at = factor * speed
        for chosen in product(*values):
            primes = dict(zip(names, chosen, strict=True))
            side = np.array([primes.get("v", 0.0), primes.get("w", 0.0)])
            across = float(side @ side)
            if across > 1.0:
                continue
            rates = [primes.get(r, 0.0) * at / length for r in "pqr"]
            rows.append([at * np.sqrt(1.0 - across), *(at * side), *rates])
    words = ", ".join(
        f"{n}' {a:.3g} to {b:.3g}{' (covered by no campaign)' if n in assumed else ''}" for n, (a, b) in ranges.items()
    )
    words = words or "straight motion"
    words = "; ".join((words, *parameters.narrowed))
    return np.array(rows), f"{words}; U {', '.join(f'{f * speed:.3g}' for f in SPEEDS)} m/s; {len(rows)} states"


def _moved_by_terms(parameters: ParameterFile) -> set[str]:
    of_terms = {f for c in parameters.coefficients if c.value for f in derivative(c.symbol).factors}
    return (of_terms | {v.name for m in parameters.models for v in m.variables}) & set(MOTIONS)


def loss_of(
    target: str,
    law: ForceLaw,
    parameters: ParameterFile,
    files: Mapping[str, bytes],
    force: Callable[[Mapping[str, bytes], Array], Array],
    not_held: tuple[str, ...],
    lost: tuple[Lost, ...],
    changes: tuple[str, ...],
    water: WaterInertia,
    added_mass: Callable[[Mapping[str, bytes]], Array] | None = None,
) -> Loss:
    """Evaluate a target's law and added mass, from its own files, beside those of the parameter file.

    Parameters
    ----------
    target : str
    law : ForceLaw
        Of the parameter file.
    parameters : ParameterFile
    files : mapping of str to bytes
        What was exported.
    force : callable
        The target's files and (n, 6) velocities -> (n, 6) forces, FRD, about the file's reference point, steady motion.
    not_held : tuple of str
        Terms that the target has no place for.
    lost : tuple of Lost
        What else of the file it is not given.
    changes : tuple of str
        What it is given otherwise, in words.
    water : WaterInertia
        The accelerations that the export was asked for.
    added_mass : callable, optional
        The target's files -> the (6, 6) added mass that it integrates, FRD, about the file's reference point.
    """
    nu, words = covered_grid(parameters)
    tables = force_of_tables(parameters, nu)
    ours, theirs = law.force(nu), force(files, nu)
    if tables is not None:
        ours, words = ours + tables, f"{words}; the file's force with its fitted tables"
    compared, why = None, "its exporter does not say what added mass it integrates"
    if added_mass is not None:
        compared, why = accelerations_apart(parameters, added_mass(files), nu, theirs, ours)
    found = law_at_points(
        parameters.measured,
        parameters.law_holds,
        lambda at, _: force(files, at),
        parameters.scaling.length,
        controls=False,
    )
    return Loss(target, not_held, lost, changes, apart(theirs, ours), compared, why, water, words, found)


def accelerations_apart(
    parameters: ParameterFile, added: Array, nu: Array, theirs: Array, ours: Array
) -> tuple[Apart | None, str]:
    """Rates of u v w p q r under forces (n, 6) at velocities (n, 6), by a target's added mass and by that of the file.

    Six rows more: from rest, pushed along each axis by the file's largest force or moment. Both have the rigid body of the file.
    Motions whose inertia it does not state are held and have NaN; second stands why.
    """
    rigid, known = known_mass(parameters)
    if not known:
        return None, "accelerations are not compared: the file states no mass"
    largest = np.abs(ours).max(axis=0)
    groups = np.repeat([largest[:3].max(), largest[3:].max()], 3)
    push = np.diag(np.where(largest > 0.0, largest, np.where(groups > 0.0, groups, 1.0)))
    own = momentum_force(nu @ rigid.T, nu)
    at = np.ix_(known, known)

    def rates(mass: Array, forces: Array) -> Array:
        out = np.full((len(forces) + 6, 6), np.nan)
        every = np.vstack([forces + own, push])[:, known]
        out[:, known] = np.linalg.solve((rigid + mass)[at], every.T).T
        return out

    reference = water_inertia(parameters).matrix
    try:
        found = apart(rates(added, theirs), rates(reference, ours))
    except np.linalg.LinAlgError:
        return None, "accelerations are not compared: an inertia M + M_A is singular"
    held = [m for k, m in enumerate(MOTIONS) if k not in known]
    return found, f"{', '.join(held)}: not compared, the file does not state the inertia" if held else ""


def unheld(law: ForceLaw, held: Callable[[ForceTerm], bool], *, ideal: bool) -> tuple[str, ...]:
    """What of a law a target does not take, in words, in the order of the file.

    Parameters
    ----------
    law : ForceLaw
    held : callable
        Whether the target takes a term.
    ideal : bool
        Whether it has the ideal fluid's products that no measured term speaks of.
    """
    terms = tuple(t.symbol for t in law.terms if t.coefficient != 0.0 and not held(t))
    names = [
        f"{COMPONENTS[i]}{MOTIONS[j]}{MOTIONS[k]}"
        for i, j, k in product(range(6), range(6), range(6))
        if j <= k and law.ideal[i, j, k] != 0.0
    ]
    products = (f"the ideal fluid's {', '.join(names)}",) if names else ()
    controls = tuple(f"{s} (control or acceleration)" for s in law.left_out if not s.endswith("dot"))
    return (*terms, *(() if ideal else products), *controls)
