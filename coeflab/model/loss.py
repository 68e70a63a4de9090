"""What an export loses: the target's own force law against that of the parameter file, over the range that is covered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.kernels.brief import brief
from coeflab.model.force_law import ForceLaw, LawTerm, force_law
from coeflab.model.frozen import locked
from coeflab.model.lost import Lost
from coeflab.model.motion_terms import as_arrays, motion_terms, open_products
from coeflab.model.parameter_file import ParameterFile

Array = NDArray[np.float64]
SPEEDS = (0.5, 1.0, 1.5)  # of the file's: a law that holds at one speed only shows
# Values of a motion: zero and both signs at the least, five where there are fewer than MANY motions to combine.
POINTS, FEW, MANY = 5, 3, 5
ASSUMED = 0.2  # prime range of a motion that no campaign covers: 11 deg of incidence
LOSSLESS = 1e-9  # rounding of coefficients that are written with 17 digits and multiplied a few times
ANGLES = {"asin(v/U)": "v", "asin(w/U)": "w"}


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
    worst, rms, largest, size : (6,) array
        Largest and root-mean-square difference of the target's force from the file's, and the file's largest and
        root-mean-square force, over the grid; N and N m.
    grid : str
        The velocities that were tried, in words.
    """

    target: str
    not_held: tuple[str, ...]
    lost: tuple[Lost, ...]
    changes: tuple[str, ...]
    worst: Array
    rms: Array
    largest: Array
    size: Array
    grid: str

    def __post_init__(self) -> None:
        for name in ("worst", "rms", "largest", "size"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def relative(self) -> Array:
        """(6,) worst over the largest force of the component; over the largest force or moment where it is zero."""
        scale = self.largest.copy()
        for group in (slice(0, 3), slice(3, 6)):
            scale[group] = np.where(scale[group] > 0.0, scale[group], scale[group].max(initial=0.0))
        return np.divide(self.worst, scale, out=np.where(self.worst > 0.0, np.inf, 0.0), where=scale > 0.0)

    @property
    def worse_than_nothing(self) -> tuple[str, ...]:
        """Components in which the target is further from the file than no force at all would be, in the root mean square."""
        least = LOSSLESS * self.largest.max(initial=0.0)
        return tuple(c for c, r, s in zip(COMPONENTS, self.rms, self.size, strict=True) if r > max(s, least))

    @property
    def lossless(self) -> bool:
        """Whether the target holds everything, has what it needs, and its force is the file's to rounding."""
        return not self.not_held and not self.lost and bool(np.all(self.relative <= LOSSLESS))


def covered_grid(parameters: ParameterFile) -> tuple[Array, str]:
    """Velocities (n, 6) over what the file's campaigns cover, at half, full and one and a half times its speed.

    Every combination of a few values of each covered motion; straight motion alone where none is covered. A motion that
    the file has terms of and no campaign covers, such as a rate from literature, is tried to 0.2 either way.
    """
    speed, length = parameters.conditions.speed, parameters.scaling.length
    ranges: dict[str, tuple[float, float]] = {}
    for c in parameters.covered:
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
    return np.array(rows), f"{words}; U {', '.join(f'{f * speed:.3g}' for f in SPEEDS)} m/s; {len(rows)} states"


def _moved_by_terms(parameters: ParameterFile) -> set[str]:
    of_terms = {f for c in parameters.coefficients if c.value for f in derivative(c.symbol).factors}
    return (of_terms | {v.name for m in parameters.models for v in m.variables}) & set(MOTIONS)


def force_of_tables(parameters: ParameterFile, nu: Array) -> Array | None:
    """(n, 6) what the fitted tables change in the force of the derivatives and of the ideal fluid; None where there is none."""
    stated = {c.symbol for c in parameters.coefficients}
    tabled = [t for t in motion_terms(parameters, tables=False)[0] if t.symbol not in stated]
    if not tabled:
        return None
    beside = open_products(parameters, tables=False) - force_law(parameters).ideal
    return as_arrays(tabled, beside).force(nu, np.zeros((len(nu), len(CONTROLS))))


def loss_of(
    target: str,
    law: ForceLaw,
    parameters: ParameterFile,
    files: Mapping[str, bytes],
    force: Callable[[Mapping[str, bytes], Array], Array],
    not_held: tuple[str, ...],
    lost: tuple[Lost, ...],
    changes: tuple[str, ...],
) -> Loss:
    """Evaluate a target's law, from its own files, beside the law of the parameter file.

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
    """
    nu, words = covered_grid(parameters)
    tables = force_of_tables(parameters, nu)
    ours, theirs = law.force(nu), force(files, nu)
    if tables is not None:
        ours, words = ours + tables, f"{words}; the file's force with its fitted tables"
    apart = np.abs(theirs - ours)
    return Loss(
        target,
        not_held,
        lost,
        changes,
        apart.max(axis=0),
        np.sqrt((apart**2).mean(axis=0)),
        np.abs(ours).max(axis=0),
        np.sqrt((ours**2).mean(axis=0)),
        words,
    )


def unheld(law: ForceLaw, held: Callable[[LawTerm], bool], *, ideal: bool) -> tuple[str, ...]:
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
