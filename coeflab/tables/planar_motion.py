"""Runs of a planar motion mechanism: forces over time on a model that oscillates while it is towed.

A filter delays a force and so turns damping into added mass; what the campaign declares of it is undone by its complex gain.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked, locked_columns
from coeflab.core.units import quantity
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.campaign import TowedInertia
from coeflab.tables.force_table import ForceTable

VARIABLES = {"sway": "v", "heave": "w", "roll": "p", "pitch": "q", "yaw": "r"}
DISPLACEMENTS = {"sway": "y", "heave": "z", "roll": "phi", "pitch": "theta", "yaw": "psi"}
LARGEST_LAG = np.radians(90.0)
MOST_POLES = 12
FILTER_WORDS = '"none", "Butterworth 4, 5 Hz", "zero-phase Butterworth 4, 5 Hz", "delay 0.01 s" or "lag 3 deg"'
_BUTTERWORTH = re.compile(r"(zero-phase )?butterworth (\d+), *(.+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Filter:
    """What a channel does to an oscillation before it is recorded.

    Attributes
    ----------
    order : int
        Of a Butterworth low-pass; 0 for none.
    cut_off : float
        Its frequency of half power, Hz.
    zero_phase : bool
        Whether the Butterworth was run forwards and backwards: gain squared, no lag.
    delay : float
        s.
    lag : float
        Of the fundamental, rad; harmonics lag by as much again for each order, as after a delay.
    text : str
        As declared.
    """

    order: int = 0
    cut_off: float = np.inf
    zero_phase: bool = False
    delay: float = 0.0
    lag: float = 0.0
    text: str = "none"

    @classmethod
    def read(cls, text: object, file: Path, key: str) -> Filter:
        """A filter from its declaration in words.

        Raises
        ------
        InputError
            None of the known forms, or a lag beyond 90 deg.
        """
        words = " ".join(text.split()) if isinstance(text, str) else ""
        try:
            result = cls._of(words)
        except InputError:
            result = None  # the complaint below names all forms
        if result is None:
            raise input_error(
                "tables.no_filter_in_words", file, column=key, text=shown(text), filter_words=FILTER_WORDS
            )
        return result

    @classmethod
    def _of(cls, words: str) -> Filter | None:
        if words == "none":
            return cls()
        if match := _BUTTERWORTH.fullmatch(words):
            order, cut_off = int(match[2]), quantity(match[3], "frequency")
            known = 1 <= order <= MOST_POLES and cut_off > 0.0
            return cls(order, cut_off, bool(match[1]), text=words) if known else None
        kind, _, amount = words.partition(" ")
        if kind == "delay":
            return cls(delay=quantity(amount, "time"), text=words)
        if kind == "lag" and abs(lag := quantity(amount, "angle")) <= LARGEST_LAG:
            return cls(lag=lag, text=words)
        return None

    def gain(self, omega: float, order: int = 1) -> complex:
        """Complex gain H of a harmonic: recorded = H times true, for exp(+i omega t); a lag has a negative argument.

        Butterworth (1930): H(s) = 1 / prod(s/w_c - p_k), p_k = exp(i pi (2k + n - 1) / 2n).

        Parameters
        ----------
        omega : float
            Of the fundamental, rad/s.
        order : int
            Of the harmonic.
        """
        s = 1j * order * omega / (2.0 * np.pi * self.cut_off)
        k = np.arange(1, self.order + 1)
        gain = complex(1.0 / np.prod(s - np.exp(1j * np.pi * (2 * k + self.order - 1) / (2.0 * max(self.order, 1)))))
        if self.zero_phase:
            gain = complex(abs(gain) ** 2)
        return gain * complex(np.exp(-1j * order * (omega * self.delay + self.lag)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TimeSeries:
    """One record, SI and FRD, as read: nothing is taken out.

    Attributes
    ----------
    file : Path
    time : (n,) array
        s, rising.
    displacements : mapping of str to (n,) array
        y z (m, from a point that moves with the carriage) and phi theta psi (rad), where the record has them.
    velocities, accelerations : mapping of str to (n,) array
        u v w p q r of the body and their rates, where the record has them.
    forces : mapping of str to (n,) array
        The measured ones of X Y Z K M N, N and N m.
    """

    file: Path
    time: Array
    displacements: Mapping[str, Array]
    velocities: Mapping[str, Array]
    accelerations: Mapping[str, Array]
    forces: Mapping[str, Array]

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", locked(self.time))
        for name in ("displacements", "velocities", "accelerations", "forces"):
            object.__setattr__(self, name, locked_columns(getattr(self, name)))

    @property
    def has_motion(self) -> bool:
        """Whether the record holds the motion."""
        return bool(self.displacements or self.velocities or self.accelerations)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class PlanarMotionRun:
    """One run with what the list of runs says of it.

    Attributes
    ----------
    label : str
    line : int
        In the list of runs, which is ``listed``.
    listed : Path
    motion : str
        A key of `VARIABLES`.
    omega : float
        rad/s, as declared.
    speed : float
        Of the carriage, m/s.
    amplitude : float or None
        Of the displacement (m, rad), as declared.
    phase : float or None
        rad: displacement = amplitude sin(omega t + phase).
    drift, attack : float
        Mean sideslip and angle of attack, rad, v = +U sin(drift), w = +U sin(attack).
    record : TimeSeries
    in_air : TimeSeries or None
        The same motion in air.
    """

    label: str
    line: int
    listed: Path
    motion: str
    omega: float
    speed: float
    amplitude: float | None
    phase: float | None
    drift: float
    attack: float
    record: TimeSeries
    in_air: TimeSeries | None = None

    def fail(
        self, found: str, expected: str, file: Path | None = None, column: str = "", advice: str = ""
    ) -> InputError:
        """An error about the run, to be raised by the caller."""
        at = self.line if file is None else None
        return InputError(found, expected, file=file or self.listed, line=at, column=column or None, advice=advice)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class PlanarMotionTable(ForceTable):
    """A list of oscillating runs; the rows are their means over the record, which no steady fit may use.

    Attributes
    ----------
    runs : tuple of PlanarMotionRun
        About the point that the file's moments are about.
    inertia : TowedInertia or None
        Of the model, where the forces contain it and no run in air takes it out.
    filters : mapping of str to Filter
        For every force component, and ``motion``.
    restoring : (float, float) or None
        Moments of weight and buoyancy per radian of roll and of pitch that the forces contain, positive upright, N m.
    """

    runs: tuple[PlanarMotionRun, ...]
    inertia: TowedInertia | None
    filters: Mapping[str, Filter] = field(default_factory=dict)
    restoring: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        ForceTable.__post_init__(self)
        object.__setattr__(self, "filters", MappingProxyType(dict(self.filters)))

    @property
    def point(self) -> Array:
        """(3,) where moments and velocities of the runs are about, m, FRD, from the datum."""
        return self.reference_point if self.measured_about is None else self.measured_about

    @property
    def components(self) -> tuple[str, ...]:
        """Force components that some run has."""
        return tuple(c for c in COMPONENTS if any(c in r.record.forces for r in self.runs))
