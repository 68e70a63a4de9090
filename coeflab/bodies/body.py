"""A body: its particulars and mass properties, one configuration of appendages at a time.

What a body.toml may hold is in `coeflab.bodies.body_file`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mass_model import MassModel
from coeflab.bodies.mesh.source import MeshSource
from coeflab.bodies.outline import Outline
from coeflab.bodies.outlining import with_propellers
from coeflab.bodies.pieces import Control, Piece
from coeflab.bodies.recognition import outline_of
from coeflab.bodies.shape import Shape
from coeflab.bodies.thrusters import Thruster
from coeflab.core.axes import Axes, Datum
from coeflab.core.cards import html_by
from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding
from coeflab.core.provenance import InputFile, Source
from coeflab.core.texts import input_error
from coeflab.core.types import brief, in_angles, locked
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Scaling


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
    findings : tuple of Finding
        What of its mass is assumed.
    """

    name: str
    title: str
    volume: float | None
    wetted_surface: float | None
    centre_of_buoyancy: NDArray[np.float64] | None
    mass: MassProperties | None
    projected_areas: NDArray[np.float64] | None = None
    second_moments: NDArray[np.float64] | None = None
    findings: tuple[Finding, ...] = ()

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
    thrusters : tuple of Thruster
    mesh : MeshSource, optional
        Where the shape's parts stand for a mesh: that mesh.
    pieces : tuple of Piece
        The closed pieces that the shape is made of, where its reader knows them.
    controls : tuple of Control
        Which of them turn.
    mass_model : MassModel, optional
        Where its file gives parts with masses.
    outlined : callable, optional
        Makes the outline where the reader knows more of it than the shape.
    axes : Axes, optional
        Of the mesh file that the shape came from, as stated; None of shapes that are stated in FRD.
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
    thrusters: tuple[Thruster, ...] = ()
    mesh: MeshSource | None = None
    pieces: tuple[Piece, ...] = ()
    controls: tuple[Control, ...] = ()
    mass_model: MassModel | None = None
    outlined: Callable[[], Outline] | None = None
    axes: Axes | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "lengths", MappingProxyType(dict(self.lengths)))
        object.__setattr__(self, "reference_point", locked(self.reference_point))

    def __repr__(self) -> str:
        shape = type(self.shape).__name__ if self.shape is not None else "no shape"
        length = f", {self.scaling.length_name} {self.scaling.length:.5g} m" if self.scaling else ""
        return in_angles(self, f"{self.name}: {shape}{length}, {len(self.configurations)} configurations")

    def _repr_html_(self) -> str:
        """Outlines and particulars, for notebooks."""
        return html_by("body", self)

    @property
    def outline(self) -> Outline | None:
        """What semi-empirical methods see of it, made when first asked for; None of a body without a shape."""
        if self.outlined is None and self.shape is None:
            return None
        seen = self.outlined() if self.outlined is not None else outline_of(self.require_shape(), self.controls)
        return with_propellers(seen, self.thrusters)

    def configuration(self, name: str) -> Configuration | None:
        """The configuration of that name, if the body has it; of the body's own name the one that its [[mass]] parts weigh."""
        weighed = self.configurations[:1] if name == self.name and self.mass_model is not None else ()
        named = next((c for c in self.configurations if c.name == name), None)
        return named or next(iter(weighed), None)

    def require_shape(self) -> Shape:
        """The shape.

        Raises
        ------
        InputError
            The body's file gives particulars only.
        """
        if self.shape is None:
            raise input_error("bodies.body_particulars_without", name=self.name)
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
