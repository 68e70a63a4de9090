"""The outline of a body: what semi-empirical methods see of it: hulls as sections, foils, ring wings, propellers and bluff parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import brief, locked, locking


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Sections:
    """A hull as sections across x; m, FRD, from the datum.

    Attributes
    ----------
    name : str
    x : (n,) array
        Stations, falling: from the foremost to the aftmost.
    area, breadth, depth, girth : (n,) array
        m^2 and m: of each section; breadth along y, depth along z.
    centre : (n, 2) array
        y and z of each section's centre of area.
    round_sections : bool
        The hull is a body of revolution about its centres.
    """

    name: str
    x: NDArray[np.float64]
    area: NDArray[np.float64]
    breadth: NDArray[np.float64]
    depth: NDArray[np.float64]
    girth: NDArray[np.float64]
    centre: NDArray[np.float64]
    round_sections: bool = False

    def __post_init__(self) -> None:
        n = len(self.x)
        for name in ("x", "area", "breadth", "depth", "girth", "centre"):
            values = getattr(self, name)
            if len(values) != n:
                raise InputError(f"{len(values)} values of {name}", f"{n}, one a station")
            object.__setattr__(self, name, locked(values))
        if n < 3 or not np.all(np.diff(self.x) < 0.0):
            raise InputError(f"{n} stations", "at least three, from the foremost to the aftmost", column="x")

    @property
    def length(self) -> float:
        """From the first station to the last, m."""
        return float(self.x[0] - self.x[-1])


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("root tip stand")
class Foil:
    """A fin, a sail, a wing: what stands out of the hull of one side; m, FRD, from the datum.

    Attributes
    ----------
    name : str
        Of the piece.
    root, tip : (3,) array
        Quarter-chord points of the exposed root, at the hull's surface, and of the tip.
    root_chord, tip_chord : float
    thickness : float
        Of the section, over its chord.
    stand : (2,) array
        y and z of the axis of what it stands on; the hull's radius there is the root's distance from it. Of a foil that
        stands alone, its root.
    control : str
        The angle that turns all of it (``dr``); empty where it is fixed.
    flap : float
        Chord of the part that turns, over the whole chord; 1 turns all of it.
    sign : float
        Turn about the root-to-tip direction for one unit of that angle, right-handed.
    other_controls : tuple of (str, float)
        Further angles that turn it, as those of an X tail do, each with its sign.
    """

    name: str
    root: NDArray[np.float64]
    tip: NDArray[np.float64]
    root_chord: float
    tip_chord: float
    thickness: float
    stand: NDArray[np.float64]
    control: str = ""
    flap: float = 1.0
    sign: float = 1.0
    other_controls: tuple[tuple[str, float], ...] = ()

    @property
    def turns(self) -> tuple[tuple[str, float], ...]:
        """Every angle that turns it, with its sign."""
        return ((self.control, self.sign), *self.other_controls) if self.control else ()

    @property
    def span(self) -> float:
        """Exposed, across x, m."""
        return float(np.hypot(*(self.tip - self.root)[1:]))

    @property
    def area(self) -> float:
        """Exposed planform, one side, m^2."""
        return 0.5 * (self.root_chord + self.tip_chord) * self.span


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre")
class RingWing:
    """A ring wing, a duct or a shroud about x; m, FRD, from the datum.

    Attributes
    ----------
    name : str
    centre : (3,) array
        Of its quarter-chord circle.
    diameter, chord : float
        Of that circle; of the section.
    thickness : float
        Of the section, over its chord.
    """

    name: str
    centre: NDArray[np.float64]
    diameter: float
    chord: float
    thickness: float


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre")
class Propeller:
    """An open propeller that turns about x; m, FRD, from the datum.

    Attributes
    ----------
    name : str
        Of its thruster.
    centre : (3,) array
        Of its disc.
    diameter : float
    blades : int
    pitch_ratio, area_ratio : float
        P/D, and expanded blade area over the disc's, A_E/A_0.
    """

    name: str
    centre: NDArray[np.float64]
    diameter: float
    blades: int
    pitch_ratio: float
    area_ratio: float


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre rotation half_extents areas unshielded")
class Bluff:
    """A part that the flow separates from in every direction: a box, a tube of a frame, a sphere; m, FRD, from the datum.

    Attributes
    ----------
    name : str
    kind : str
        ``box``, ``cylinder`` (axis along its own x), ``plate`` (normal along its own z), ``ellipsoid`` or ``mesh``.
    centre : (3,) array
    rotation : (3, 3) array
        Columns are its own axes.
    half_extents : (3,) array
        Along its own axes.
    areas : (3,) array
        Silhouettes along x, y and z of the body, m^2.
    unshielded : (3,) array, optional
        The same where one surface of the part stands behind another and counts again, as the bars of a frame do; the
        silhouettes unless given.
    """

    name: str
    kind: str
    centre: NDArray[np.float64]
    rotation: NDArray[np.float64]
    half_extents: NDArray[np.float64]
    areas: NDArray[np.float64]
    unshielded: NDArray[np.float64] | None = None

    @property
    def in_the_open(self) -> NDArray[np.float64]:
        """(3,) areas with nothing hidden, m^2."""
        return self.areas if self.unshielded is None else self.unshielded


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre areas")
class Unseen:
    """Area of a body that no method sees; m, FRD, from the datum.

    Attributes
    ----------
    name : str
    centre : (3,) array
    areas : (3,) array
        Silhouettes along x, y and z, m^2.
    """

    name: str
    centre: NDArray[np.float64]
    areas: NDArray[np.float64]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """What semi-empirical methods see of a body.

    Attributes
    ----------
    hulls : tuple of Sections
        Slender, streamlined; more than one of a catamaran.
    foils : tuple of Foil
        One each: a pair of fins is two.
    rings : tuple of RingWing
    bluff : tuple of Bluff
        All of a vehicle of ROV type, the rest of others.
    wetted_surface, volume : float
        m^2, m^3, of all.
    left_out : tuple of str
        What of the body no method sees, one line each.
    propellers : tuple of Propeller
    unseen : tuple of Unseen
        Their areas, where these are known.
    """

    hulls: tuple[Sections, ...]
    foils: tuple[Foil, ...]
    rings: tuple[RingWing, ...]
    bluff: tuple[Bluff, ...]
    wetted_surface: float
    volume: float
    left_out: tuple[str, ...] = ()
    propellers: tuple[Propeller, ...] = ()
    unseen: tuple[Unseen, ...] = ()
