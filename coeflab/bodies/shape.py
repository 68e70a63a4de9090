"""What a body looks like: parts of simple form, each with its pose, or a body of revolution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.closed_forms.revolution import MeridianIntegrals, graded_nodes, meridian_integrals
from coeflab.bodies.forms import (
    CLASSES,
    Bar,
    Box,
    Cylinder,
    Ellipsoid,
    Faceted,
    Finned,
    Form,
    Plate,
    Tube,
    Turned,
    shadow,
    within_reach,
)
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.law.symbols import MOTIONS

__all__ = [
    "APART", "CLASSES", "THIN", "Agreement", "Bar", "Box", "Cylinder", "Ellipsoid", "Faceted", "Finned", "Form", "Part", "Parts", "Plate",
    "Revolution", "Shape", "StandIn", "Tube", "Turned", "as_revolution", "shadow", "within_reach",
]  # fmt: skip
STATIONS = 64  # graded to both ends, where radii change most
POOR, OTHER = 0.1, "other"
APART = 0.15  # of an entry of the mesh's added mass: further from it the parts are no stand-in
THIN = 0.05  # of the shorter side: up to here the panel method leaves a body to the formulas of plates


@dataclass(frozen=True, slots=True)
class StandIn:
    """How well a form stands for the piece of a mesh in whose place it is; errors are form over piece, less one.

    Attributes
    ----------
    kind : str
        The form that the piece is like, or ``other``: it is like none, and the nearest stands in.
    shared : float
        Share of the piece's volume that lies within the form, of a plate within its outline.
    volume, length : float
        Errors; a plate has no volume: -1.
    areas : (float, float, float)
        Errors of the areas projected along the part's own axes.
    misfit : float, optional
        Of a solid: error of the length, plus errors of the areas over their sum.
    thickness : float, optional
        Of a plate: mean thickness of the piece over the shorter side.
    """

    kind: str
    shared: float
    volume: float
    areas: tuple[float, float, float]
    length: float
    misfit: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        if self.kind not in (*CLASSES.values(), OTHER):
            raise InputError(shown(self.kind), f"one of {', '.join((*CLASSES.values(), OTHER))}", column="class")
        for name, errors in (("volume", (self.volume,)), ("length", (self.length,)), ("areas", self.areas)):
            for value in errors:
                if not -1.0 <= value < np.inf:
                    raise InputError(f"{value:g}", "an error of form over piece, less one: -1 or more", column=name)
        if not 0.0 <= self.shared <= 1.0:
            raise InputError(f"{self.shared:g}", "a share from 0 to 1", column="shared")
        if (self.misfit is None) == (self.thickness is None):
            found = "neither misfit nor thickness" if self.misfit is None else "both misfit and thickness"
            raise InputError(found, "the misfit of a solid, or the thickness of a plate", column="misfit")
        for name, measure in (("misfit", self.misfit), ("thickness", self.thickness)):
            if measure is not None and not 0.0 <= measure < np.inf:
                raise InputError(f"{measure:g}", "a number of at least zero", column=name)

    @property
    def counting(self) -> dict[str, float]:
        """The errors that count: of a plate the area along its normal, which its added mass goes with."""
        if self.thickness is not None:
            return {"A z": self.areas[2]}
        return {
            **dict(zip(("A x", "A y", "A z"), self.areas, strict=True)),
            "length": self.length,
            "volume": self.volume,
        }

    def over(self, bound: float) -> tuple[str, ...]:
        """Which errors are larger, in words."""
        return tuple(f"{name} {100.0 * e:+.1f} %" for name, e in self.counting.items() if abs(e) > bound)

    @property
    def worst(self) -> str:
        """The largest error that counts, in words."""
        return max(((abs(e), f"{name} {100.0 * e:+.0f} %") for name, e in self.counting.items()))[1]

    @property
    def likeness(self) -> str:
        """Misfit of a solid, thickness of a plate, in words."""
        return f"thickness {self.thickness:.2g}" if self.misfit is None else f"misfit {self.misfit:.2g}"

    @property
    def poor(self) -> tuple[str, ...]:
        """What makes it a poor stand-in, in words: class other, or an error over 10 %."""
        like = f"class other ({self.likeness}, shares {self.shared:.0%} of the volume)"
        return (*((like,) if self.kind == OTHER else ()), *self.over(POOR))

    @property
    def rough(self) -> tuple[str, ...]:
        """Why formulas of the form are only a rough guide to the piece: `poor`, or a plate for a piece that is not thin."""
        if self.thickness is None or self.thickness <= THIN:
            return self.poor
        thick = f"a plate without thickness for a piece of mean thickness {self.thickness:.2g} of the shorter side"
        return (*self.poor, thick)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre rotation")
class Part:
    """A named form somewhere on the body.

    Attributes
    ----------
    name : str
    form : Form
    centre : (3,) array
        m, FRD, from the datum.
    rotation : (3, 3) array
        Components along the part's own axes to those along the body's.
    fit : StandIn, optional
        Where the part stands for a piece of a mesh: how well. Without it the part is what its maker says it is.
    """

    name: str
    form: Form
    centre: Array
    rotation: Array
    fit: StandIn | None = None

    def __post_init__(self) -> None:
        turn = self.rotation
        proper = turn.shape == (3, 3) and np.allclose(turn @ turn.T, np.eye(3), atol=1e-9) and np.linalg.det(turn) > 0.0
        if not proper:
            raise InputError(f"the pose of part {shown(self.name)}, which mirrors or stretches", "a rotation")
        if self.fit is not None and self.fit.kind not in (CLASSES[type(self.form)], OTHER):
            raise input_error(
                "bodies.fit_part", column="fit", kind_2=self.fit.kind, name=shown(self.name), classes=CLASSES[type(self.form)],
            )  # fmt: skip

    @property
    def second_moments(self) -> Array:
        """(3, 3) of the volume about its centre along the body's axes, over the volume, m^2."""
        own = self.form.spread
        return np.asarray(self.rotation @ (own if own.ndim == 2 else np.diag(own)) @ self.rotation.T)

    @property
    def middle(self) -> Array:
        """(3,) half way between its ends along x, y and z, m, FRD, from the datum."""
        if isinstance(self.form, Faceted):
            placed = self.form.mesh.vertices @ self.rotation.T
            return np.asarray(self.centre + (placed.min(axis=0) + placed.max(axis=0)) / 2.0)
        offset = self.form.middle if isinstance(self.form, Turned) else 0.0
        return np.asarray(self.centre + self.rotation[:, 0] * offset)


@dataclass(frozen=True, slots=True)
class Agreement:
    """Added mass of parts against the panel method on the mesh that they stand for.

    Attributes
    ----------
    entries : tuple of six, float or None
        Of u, v, w, p, q, r: parts over mesh, less one. None where the mesh moves no water, or less than its error.
    error : float or None
        Estimate for the mesh's entries, the largest of them, over the entry; None where none was made.
    """

    entries: tuple[float | None, ...]
    error: float | None

    def __post_init__(self) -> None:
        if len(self.entries) != len(MOTIONS):
            raise InputError(f"{len(self.entries)} motions", f"{len(MOTIONS)}: {', '.join(MOTIONS)}")

    @property
    def apart(self) -> tuple[str, ...]:
        """Motions in which they differ by more than 15 %, in words."""
        found = zip(MOTIONS, self.entries, strict=True)
        return tuple(f"{m} {100.0 * e:+.0f} %" for m, e in found if e is not None and abs(e) > APART)

    @property
    def unresolved(self) -> bool:
        """The mesh's own error is beyond those 15 %: no agreement can be told."""
        return self.error is not None and self.error > APART


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Parts:
    """A body as simple parts; where they overlap the overlap counts twice.

    Attributes
    ----------
    parts : tuple of Part
    agreement : Agreement, optional
        Where they stand for a mesh: how far their added mass is from its.
    """

    parts: tuple[Part, ...]
    agreement: Agreement | None = None

    def __post_init__(self) -> None:
        names = [p.name for p in self.parts]
        if not names:
            raise InputError("a body without parts", "at least one part")
        twice = sorted({n for n in names if names.count(n) > 1})
        if twice:
            raise InputError(f"two parts called {shown(twice[0])}", "one name for each part")

    @property
    def stand_ins(self) -> tuple[StandIn, ...]:
        """The fits of the parts that stand for pieces of a mesh."""
        return tuple(p.fit for p in self.parts if p.fit is not None)

    @property
    def rough(self) -> tuple[str, ...]:
        """Which parts are only a rough guide to their pieces of a mesh, and why; what they move together otherwise."""
        out = tuple(f"{p.name}: {', '.join(p.fit.rough)}" for p in self.parts if p.fit is not None and p.fit.rough)
        apart = () if self.agreement is None else self.agreement.apart
        return (*out, f"added mass off the mesh's: {', '.join(apart)}") if apart else out

    @property
    def volume(self) -> float:
        """Sum over the parts, m^3."""
        return sum(p.form.volume for p in self.parts)

    @property
    def centre_of_volume(self) -> Array:
        """(3,) array, m, FRD, from the datum; of plates alone the mean of their centres."""
        weights = np.array([p.form.volume for p in self.parts])
        centres = np.array([p.centre for p in self.parts])
        return np.asarray(np.average(centres, axis=0, weights=weights if np.any(weights) else None))

    @property
    def length(self) -> float:
        """Along x, over all parts that displace water, m; 0 where none does."""
        solid = [p for p in self.parts if p.form.volume > 0.0]
        half = [float(p.form.half_extents(p.rotation)[0]) for p in solid]
        fore = max((p.middle[0] + h for p, h in zip(solid, half, strict=True)), default=0.0)
        aft = min((p.middle[0] - h for p, h in zip(solid, half, strict=True)), default=0.0)
        return float(fore - aft)

    @property
    def breadth_over_depth(self) -> float:
        """Root of the ratio of the second moments of volume along y and along z; b/c of an ellipsoid exactly."""
        middle = self.centre_of_volume
        total = np.zeros(3)
        for p in self.parts:
            total += p.form.volume * (np.diag(p.second_moments) + (p.centre - middle) ** 2)
        return float(np.sqrt(total[1] / total[2]))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("x weight radius radius_slope axis")
class Revolution:
    """A body of revolution about an axis along x, by quadrature stations.

    Attributes
    ----------
    x, weight, radius, radius_slope : (n,) arrays
        Stations (FRD, from the datum), their weights, radii, and R dR/dx; m.
    axis : (2,) array
        y and z of the axis, m, FRD, from the datum.
    length : float
        From end to end, m.
    """

    x: Array
    weight: Array
    radius: Array
    radius_slope: Array
    axis: Array
    length: float

    def __post_init__(self) -> None:
        if np.any(self.radius < 0.0) or not np.any(self.radius > 0.0):
            raise InputError("a negative or vanishing radius", "a meridian with radii above zero")

    @property
    def integrals(self) -> MeridianIntegrals:
        """Volume, centre, wetted surface and second moment."""
        return meridian_integrals(self.x, self.weight, self.radius, self.radius_slope)

    @property
    def volume(self) -> float:
        """m^3."""
        return self.integrals.volume

    @property
    def centre_of_volume(self) -> Array:
        """(3,) array, m, FRD, from the datum."""
        return np.array([self.integrals.centre, *self.axis])

    @property
    def breadth_over_depth(self) -> float:
        """One, for a circle."""
        return 1.0


Shape = Parts | Revolution | TriangleMesh


def as_revolution(shape: Shape) -> Revolution | None:
    """The body of revolution about x that a shape is, or None.

    Parts are one when there is a single cylinder, or a single spheroid or sphere, whose axis lies along x.
    """
    if isinstance(shape, Revolution):
        return shape
    if isinstance(shape, TriangleMesh) or len(shape.parts) > 1:
        return None
    part = shape.parts[0]
    form = part.form
    if isinstance(form, Box | Plate | Tube | Finned | Faceted) or not np.isclose(
        abs(part.rotation[0, 0]), 1.0, rtol=1e-12
    ):
        return None
    if isinstance(form, Ellipsoid) and form.y != form.z:
        return None
    if isinstance(form, Turned):
        x, weight, radius, slope = form.nodes
        ahead = float(np.sign(part.rotation[0, 0]))
        return Revolution(part.centre[0] + ahead * x, weight, radius, ahead * slope, part.centre[1:], form.length)
    half = form.x if isinstance(form, Ellipsoid) else form.length / 2.0
    offset, weight = graded_nodes(-half, half, STATIONS)
    if isinstance(form, Ellipsoid):
        radius = form.y * np.sqrt(1.0 - (offset / half) ** 2)
        slope = -(form.y**2) * offset / half**2
    else:
        radius, slope = np.full(STATIONS, form.radius), np.zeros(STATIONS)
    return Revolution(part.centre[0] + offset, weight, radius, slope, part.centre[1:], 2.0 * half)
