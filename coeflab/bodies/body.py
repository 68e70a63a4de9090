"""A body: its particulars and mass properties, one configuration of appendages at a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.source import MeshSource
from coeflab.bodies.shape import Shape
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, shown
from coeflab.core.provenance import InputFile, Source
from coeflab.core.types import brief, locked
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Scaling

SAME_VOLUME, SAME_SURFACE = 0.01, 0.03  # printed particulars of one model; sail and planes of a submarine are more


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Configuration:
    """One state of appendages.

    Attributes
    ----------
    name, title : str
    volume, wetted_surface : float, optional
        m^3, m^2.
    centre_of_buoyancy : (3,) array, optional
        m, FRD, from the datum.
    mass : MassProperties, optional
    projected_areas : (3,) array, optional
        Along x, y and z, m^2, where each line of sight crosses the surface twice; hidden faces count as well.
    second_moments : (3, 3) array, optional
        Integral of d d^T over the volume, d from the centre of buoyancy, m^5.
    """

    name: str
    title: str
    volume: float | None
    wetted_surface: float | None
    centre_of_buoyancy: NDArray[np.float64] | None
    mass: MassProperties | None
    projected_areas: NDArray[np.float64] | None = None
    second_moments: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        for name in ("centre_of_buoyancy", "projected_areas", "second_moments"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def displaced_inertia(self, density: float) -> NDArray[np.float64] | None:
        """(3, 3) inertia of the displaced water about the centre of buoyancy, kg m^2; None where it is not known."""
        spread = self.second_moments
        return None if spread is None else np.asarray(density * (np.trace(spread) * np.eye(3) - spread))


@dataclass(frozen=True, slots=True)
class Measured:
    """An acceleration derivative that somebody measured, primed by the body's length, about its reference point.

    Attributes
    ----------
    symbol : str
    printed : str
        As it stands in the source; a closing question mark is a last digit that cannot be read.
    citation, place : str
    """

    symbol: str
    printed: str
    citation: str
    place: str

    def __post_init__(self) -> None:
        try:
            finite = all(np.isfinite(v) and v != 0.0 for v in self.bounds)
        except ValueError:
            finite = False
        if not finite:
            raise InputError(shown(self.printed), 'a number other than zero, ending in "?" where a digit is illegible')

    @property
    def bounds(self) -> tuple[float, float]:
        """The value twice, or with the illegible digit at 0 and at 9."""
        return float(self.printed.replace("?", "0")), float(self.printed.replace("?", "9"))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A body with one or more configurations.

    Attributes
    ----------
    name, title : str
    datum : Datum
    reference_point : (3,) array
        Point of the mass properties, m, FRD, from the datum.
    lengths : mapping of str to float
        Named particulars, m.
    configurations : tuple of Configuration
    source : Source
    files : tuple of InputFile
    shape : Shape, optional
        What the body looks like, where its file says so.
    scaling : Scaling, optional
        The length that primes are made with, where the file names one.
    measured : tuple of Measured
        Acceleration derivatives from elsewhere, to be shown beside computed ones.
    mesh : MeshSource, optional
        Where the shape's parts stand for a mesh: that mesh.
    """

    name: str
    title: str
    datum: Datum
    reference_point: NDArray[np.float64]
    lengths: Mapping[str, float]
    configurations: tuple[Configuration, ...]
    source: Source
    files: tuple[InputFile, ...]
    shape: Shape | None = None
    scaling: Scaling | None = None
    measured: tuple[Measured, ...] = ()
    mesh: MeshSource | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "lengths", MappingProxyType(dict(self.lengths)))
        object.__setattr__(self, "reference_point", locked(self.reference_point))

    def configuration(self, name: str) -> Configuration | None:
        """The configuration of that name, if the body has it."""
        return next((c for c in self.configurations if c.name == name), None)

    def require_shape(self) -> Shape:
        """The shape.

        Raises
        ------
        InputError
            The body's file gives particulars only.
        """
        if self.shape is None:
            raise InputError(
                f"{self.name}, a body of particulars without a shape",
                "a body that says what it looks like",
                advice="Give its body.toml parts ([[part]], reader primitives), or name another body.",
            )
        return self.shape

    def require(self, name: str) -> Configuration:
        """The configuration of that name.

        Raises
        ------
        InputError
        """
        found = self.configuration(name)
        if found is None:
            known = ", ".join(c.name for c in self.configurations)
            raise InputError(f"no configuration {shown(name)} of {self.name}", f"one of {known}")
        return found


@dataclass(frozen=True, slots=True)
class Likeness:
    """Whether a shape is that of a vehicle.

    Attributes
    ----------
    same : bool or None
        None where nothing but their names can be compared, and these differ.
    words : str
        What was compared.
    """

    same: bool | None
    words: str


def likeness(hull: Body, vehicle: str, stated: Configuration | None, own_file: bool = False) -> Likeness:
    """Compare a shape with the vehicle that it is to stand for.

    A body that bears the vehicle's name, or whose file has a configuration of that name, is the vehicle unless both its
    volume and its wetted surface say otherwise. A body of another name is the vehicle where both are known and agree.

    Parameters
    ----------
    hull : Body
        With a shape; its first configuration is computed from it.
    vehicle : str
    stated : Configuration or None
        Of the vehicle, from its particulars.
    own_file : bool
        The particulars stand in the hull's own file, which then describes one vehicle.
    """
    named = hull.name == vehicle or hull.configuration(vehicle) is not None
    if (named and own_file) or stated is None:
        return Likeness(
            True if named else None, f"the body of {vehicle}" if named else "no particulars to compare with"
        )
    own = next(iter(hull.configurations), None)
    apart, words = [], []
    for what, unit, limit in (("volume", "m^3", SAME_VOLUME), ("wetted_surface", "m^2", SAME_SURFACE)):
        ours, theirs = getattr(own, what, None), getattr(stated, what)
        if ours and theirs:
            share = ours / theirs - 1.0
            apart.append(abs(share) > limit)
            words.append(
                f"{what.replace('_', ' ')} {ours:.4g} against {theirs:.4g} {unit} ({share:+.1%}, limit {limit:.0%})"
            )
    said = ", ".join(words) or "neither volume nor wetted surface to compare"
    if len(apart) == 2:
        return Likeness(not (all(apart) if named else any(apart)), said)
    return Likeness(True if named else False if any(apart) else None, said)


def mass_from_primes(mass: float, moment: float, inertia: float | None, by: Scaling, density: float) -> MassProperties:
    """Dimensional mass properties from m', xG' m', I' (m' = m / (1/2 rho L^3))."""
    unit = by.unit("m", density)
    return MassProperties(
        mass * unit, moment * unit * by.length, None if inertia is None else inertia * by.unit("I", density)
    )
