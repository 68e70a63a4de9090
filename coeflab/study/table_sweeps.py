"""A table cut into sweeps: rows in which one variable alone changes, with what symmetry makes of a component over it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.fits.statistics.data_gate import Parity
from coeflab.law.symbols import LINEAR, MOTIONS, PORT_STARBOARD
from coeflab.law.transforms import incidence
from coeflab.tables.force_table import ForceTable

SAME = 0.006  # rad or primed: settings that count as one, 0.34 degrees
LATERAL = ("beta", "v", "r", "p", "dr")
ANGLE_OF = {"beta": "asin(v/U)", "alpha": "alpha"}


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """Rows of a table in which one variable changes; ``still``: all others are at rest."""

    variable: str
    rows: NDArray[np.intp]
    x: Array
    still: bool
    lateral: bool

    def parity(self, component: str) -> Parity:
        """What port-starboard symmetry makes of a component."""
        if not self.lateral or self.variable not in LATERAL:
            return Parity.ANY
        return Parity.ODD if component in PORT_STARBOARD else Parity.EVEN


def levels(x: Array) -> NDArray[np.intp]:
    """Labels of settings that agree; sorted neighbours within `SAME` of the first."""
    order = np.argsort(x, kind="stable")
    labels, label, start = np.empty(len(x), dtype=np.intp), -1, -np.inf
    for i in order:
        if x[i] - start > SAME:
            label, start = label + 1, x[i]
        labels[i] = label
    return labels


def ahead_counts(table: ForceTable) -> bool:
    """Whether the rows run at their speed U; not so in tables of damping about a state of rest."""
    total = np.sqrt(np.sum([np.asarray(table.motion[m]) ** 2 for m in LINEAR], axis=0))
    return bool(np.allclose(total, table.speed, rtol=0.05))


def settings_of(table: ForceTable) -> dict[str, Array]:
    """Variables of the rows: angles in radians, rates primed, speed over the largest."""
    length = table.scaling.length
    if not ahead_counts(table):
        return {m: np.asarray(table.primed_motion(m, length)) for m in MOTIONS}
    alpha, beta = incidence(*(np.asarray(table.motion[m]) for m in LINEAR))
    out = {"alpha": alpha, "beta": beta} | {m: table.primed_motion(m, length) for m in "pqr"}
    out |= {c: np.asarray(a) for c, a in table.controls.items()}
    return out | {"speed": np.log(table.speed)}


def sweeps_of(table: ForceTable, selected: NDArray[np.bool_]) -> Iterator[Sweep]:
    """Sweeps of at least three settings among the rows that are kept, variable by variable."""
    settings = settings_of(table)
    labels = np.column_stack([levels(x) for x in settings.values()])
    names = list(settings)
    for k, name in enumerate(names):
        if len(np.unique(labels[selected, k])) < 3:
            continue
        others = np.delete(labels, k, axis=1)
        for group in np.unique(others[selected], axis=0):
            rows = np.flatnonzero(selected & (others == group).all(1))
            x = settings[name][rows]
            x = table.speed[rows] if name == "speed" else np.sin(x) if name in ("alpha", "beta") else x
            rest = {
                n: float(np.abs(settings[n][rows]).max(initial=0.0)) <= SAME for n in names if n not in (name, "speed")
            }
            lateral = all(still for n, still in rest.items() if n in LATERAL)
            yield Sweep(name, rows, x, all(rest.values()), lateral)


def setting_in_words(name: str, x: float) -> str:
    """A setting with its unit."""
    if name in ("alpha", "beta"):
        return f"{ANGLE_OF[name]} = {np.degrees(np.arcsin(np.clip(x, -1.0, 1.0))):.1f} deg"
    if name in ("dr", "ds", "db"):
        return f"{name} {np.degrees(x):.1f} deg"
    return f"{x:.3g} m/s" if name == "speed" else f"{name}' {x:.3g}"
