"""What an export loses: the target's own force law against that of the parameter file, over the range that is covered."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from coeflab.core.types import Array, brief, in_angles, locking
from coeflab.formats.missing_parts import Kind, LossItem
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.law.rigid_body import momentum_force
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.force_law import motion_law, steered_terms
from coeflab.vehicle.inertia import WaterInertia, known_mass, water_inertia
from coeflab.vehicle.law_at_points import SMALL, LawAtPoints, law_at_points
from coeflab.vehicle.parameter_file import ParameterFile

SPEEDS = (0.5, 1.0, 1.5)  # of the file's: a law that holds at one speed only shows
# Values of a motion: zero and both signs at the least, five where there are fewer than MANY motions to combine.
POINTS, FEW, MANY = 5, 3, 5
DEFLECTED = 0.35  # rad, of a control that no campaign covers: 20 deg
ASSUMED = 0.2  # prime range of a motion that no campaign covers: 11 deg of incidence
LOSSLESS = 1e-9  # rounding of coefficients that are written with 17 digits and multiplied a few times
ANGLES = {"asin(v/U)": "v", "asin(w/U)": "w"}


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("worst rms largest size")
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


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Loss:
    """What one target makes of one parameter file.

    Attributes
    ----------
    target : str
    not_held : tuple of str
        Terms that the target cannot represent, in words, symbol first.
    lost : tuple of LossItem
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
    controls : tuple of str
        Which controls of the file's coefficients were varied, or that the target holds none of them; then what each does above
        zero.
    rare : Apart
        As ``forces``, astern, broadside and at rest, see `rare_states`.
    """

    target: str
    not_held: tuple[str, ...]
    lost: tuple[LossItem, ...]
    changes: tuple[str, ...]
    forces: Apart
    accelerations: Apart | None
    not_compared: str
    water: WaterInertia
    grid: str
    at_points: tuple[LawAtPoints, ...] = ()
    controls: tuple[str, ...] = ()
    rare: Apart | None = None

    def __repr__(self) -> str:
        what, share = self.furthest
        gone = len(self.lost) + len(self.not_held)
        return in_angles(
            self, f"{self.target}: {gone or 'nothing'} lost, {what} within {share:.2g}, {len(self.changes)} changes"
        )

    def __str__(self) -> str:
        """Everything that is lost or changed, a line each; the loss report among the files has the forces too."""
        lines = [f"{Kind.NOT_HELD}: {what}" for what in self.not_held] + [str(one) for one in self.lost]
        return "\n".join([repr(self), *lines, *(f"changed: {words}" for words in self.changes)])

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
        """Components in which the target is further from the file than no force at all would be, in the root mean square.

        One that is too small to judge is none of them.
        """
        least = LOSSLESS * self.largest.max(initial=0.0)
        judged = zip(COMPONENTS, self.rms, self.size, strict=True)
        return tuple(c for c, r, s in judged if r > max(s, least) and c not in self.too_small)

    @property
    def too_small(self) -> tuple[str, ...]:
        """Components that are next to nothing beside their like in the file, and differ in the target."""
        largest = self.forces.largest
        of = np.repeat([float(largest[:3].max()), float(largest[3:].max())], 3)
        each = zip(COMPONENTS, largest, of, self.relative, strict=True)
        return tuple(c for c, own, like, share in each if own < SMALL * like and share > LOSSLESS)

    @property
    def lossless(self) -> bool:
        """Whether the target holds everything, has what it needs, and forces and accelerations are the file's to rounding."""
        alike = self.furthest[1] <= LOSSLESS and (self.rare is None or self.rare.furthest[1] <= LOSSLESS)
        return not self.not_held and not self.lost and alike


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
    phrases = [f"{n}' {a:.3g} to {b:.3g}" for n, (a, b) in ranges.items() if n not in assumed]
    if assumed:
        bare = ", ".join(f"{n}'" for n in assumed)
        phrases.append(
            f"{bare} -{ASSUMED:g} to {ASSUMED:g} (assumed: no data on {'it' if len(assumed) == 1 else 'them'})"
        )
    words = ", ".join(phrases) or "straight motion"
    words = "; ".join((words, *parameters.narrowed))
    return np.array(rows), f"{words}; U {', '.join(f'{f * speed:.3g}' for f in SPEEDS)} m/s; {len(rows)} states"


def rare_states(parameters: ParameterFile) -> Array:
    """Velocities (n, 6) that no test covers and every vehicle meets: astern, broadside, at rest.

    Straight astern, to either side, up and down, at each of `SPEEDS`, and at no speed, along with none and either extreme of
    one motion that `covered_grid` tries; in planes that the file speaks of.
    """
    grid, speed = covered_grid(parameters)[0], parameters.conditions.speed
    fastest = float(np.max(np.linalg.norm(grid[:, :3], axis=1)))
    extremes = [np.zeros(6)]
    for k in range(1, 6):
        at = float(np.max(np.abs(grid[:, k])))
        extremes += [way * at * np.eye(6)[k] for way in (1.0, -1.0) if at > 0.0]
    across = [k for k in (1, 2) if np.any(grid[:, k])]
    ways = [-np.eye(6)[0], *(way * np.eye(6)[k] for k in across for way in (1.0, -1.0)), np.zeros(6)]
    rows = [
        factor * (speed * way + extreme * speed / fastest) for factor in SPEEDS for way in ways for extreme in extremes
    ]
    return np.unique(np.array(rows) + 0.0, axis=0)


def _moved_by_terms(parameters: ParameterFile) -> set[str]:
    of_terms = {f for c in parameters.coefficients if c.value for f in derivative(c.symbol).factors}
    return (of_terms | {v.name for m in parameters.models for v in m.variables}) & set(MOTIONS)


def loss_of(
    target: str,
    parameters: ParameterFile,
    files: Mapping[str, bytes],
    force: Callable[[Mapping[str, bytes], Array], Array],
    not_held: tuple[str, ...],
    lost: tuple[LossItem, ...],
    changes: tuple[str, ...],
    water: WaterInertia,
    added_mass: Callable[[Mapping[str, bytes]], Array] | None = None,
    steered: Callable[[Mapping[str, bytes], Array, Array], Array] | None = None,
) -> Loss:
    """Evaluate a target's law and added mass, from its own files, beside those of the parameter file, tables and all.

    Parameters
    ----------
    target : str
    parameters : ParameterFile
    files : mapping of str to bytes
        What was exported.
    force : callable
        The target's files and (n, 6) velocities -> (n, 6) forces, FRD, about the file's reference point, steady motion.
    not_held : tuple of str
        Terms that the target has no place for.
    lost : tuple of LossItem
        What else of the file it is not given.
    changes : tuple of str
        What it is given otherwise, in words.
    water : WaterInertia
        The accelerations that the export was asked for.
    added_mass : callable, optional
        The target's files -> the (6, 6) added mass that it integrates, FRD, about the file's reference point.
    steered : callable, optional
        As ``force``, with (n, 3) controls dr ds db in rad, of a target that holds them.
    """
    nu, words = covered_grid(parameters)
    law, rare = motion_law(parameters)[0], rare_states(parameters)
    turned = steered_terms(parameters)
    names = tuple(n for n in CONTROLS if any(n in t.variables for t in turned))
    if steered is None or not names:
        phrases: tuple[str, ...] = (
            (f"controls: {', '.join(names)} not held; no row here has their force",) if names else ()
        )
        ours, theirs = law.force(nu), force(files, nu)
        seldom = apart(force(files, rare), law.force(rare))
    else:
        controls, phrases = _deflected(parameters, names, len(nu))
        nu = np.tile(nu, (len(controls) // len(nu), 1))
        ours, theirs = law.force(nu, controls), steered(files, nu, controls)
        controls, _ = _deflected(parameters, names, len(rare))
        rare = np.tile(rare, (len(controls) // len(rare), 1))
        seldom = apart(steered(files, rare, controls), law.force(rare, controls))
    if any(t.kind == "table" for t in law.terms):
        words = f"{words}; the file's force with its fitted tables"
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
    return Loss(target, not_held, lost, changes, apart(theirs, ours), compared, why, water, words, found,
                (*phrases, *control_signs(parameters)), seldom)  # fmt: skip


def _deflected(parameters: ParameterFile, names: tuple[str, ...], states: int) -> tuple[Array, tuple[str, ...]]:
    """Controls (n, 3) for every state with none deflected, then with each alone to either side; and that in words.

    A control goes as far as the file's data do, else to `DEFLECTED`; not beyond its limit.
    """
    most: dict[str, float] = {s.control: s.limit for s in parameters.surfaces}
    reach = {n: max([abs(x) for c in parameters.offered if c.variable == n for x in (c.low, c.high)], default=0.0) or DEFLECTED
             for n in names}  # fmt: skip
    reach = {n: min(x, most.get(n, x)) for n, x in reach.items()}
    rows = [np.zeros(3)]
    rows += [np.where(np.array(CONTROLS) == n, way * reach[n], 0.0) for n in names for way in (-1.0, 1.0)]
    words = f"controls: each state also with {', '.join(f'{n} -{x:.3g} and {x:.3g} rad' for n, x in reach.items())}, one at a time"
    return np.repeat(rows, states, axis=0), (words,)


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


def unheld(
    law: ForceLaw, held: Callable[[ForceTerm], bool], *, ideal: bool, driven: Collection[str] = ()
) -> tuple[str, ...]:
    """What of a law a target does not take, in words, in the order of the file.

    Parameters
    ----------
    law : ForceLaw
    held : callable
        Whether the target takes a term.
    ideal : bool
        Whether it has the ideal fluid's products that no measured term speaks of.
    driven : collection of str
        Derivatives by controls that it has in fins of its own.
    """
    terms = tuple(t.symbol for t in law.terms if t.coefficient != 0.0 and not held(t))
    names = [
        f"{COMPONENTS[i]}{MOTIONS[j]}{MOTIONS[k]}"
        for i, j, k in product(range(6), range(6), range(6))
        if j <= k and law.ideal[i, j, k] != 0.0
    ]
    products = (f"the ideal fluid's {', '.join(names)}",) if names else ()
    controls = tuple(
        f"{s} (control or acceleration)" for s in law.left_out if not s.endswith("dot") and s not in driven
    )
    return (*terms, *(() if ideal else products), *controls)
