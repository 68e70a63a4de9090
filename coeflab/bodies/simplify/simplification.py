"""What a simplification found: parts beside the pieces of the mesh that they stand for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import Surface, simplified, solid, surface
from coeflab.bodies.mesh.source import ply
from coeflab.bodies.shape import (
    APART,
    CLASSES,
    Faceted,
    Part,
    Parts,
    Plate,
    StandIn,
    shadow,
)
from coeflab.bodies.simplify.part_file import mesh_name, part_file
from coeflab.bodies.simplify.part_forms import MISFIT, SHARED, Likeness
from coeflab.core.types import Array, brief
from coeflab.law.added_mass import AddedMass

LEAST_TURN = np.radians(0.05)
POOR, FAILED, DECIMALS = 0.05, 0.2, 6
MESH, SIMPLIFIED_FACES = "mesh.ply", 200_000
RULES = (
    "A thin body (mean thickness under 0.2 of the shorter of mean chord and span) is a plate of the area that it "
    "projects along its normal and of the span at the middle of it, hence of its aspect ratio; it has no thickness: volume and edges are left out.",
    "Any other is the cylinder, spheroid, ellipsoid or box with the least misfit: error of the length, plus errors of the three "
    "projected areas over their sum. Each keeps volume and length (a cylinder that fits better so: volume and area across), "
    "those of three sizes the largest projected area too.",
    "A round one with a misfit over 0.02 is the revolution that follows its sections where that fits better; one with a hole is "
    "a tube or ring; a box over five times as long as wide is a bar.",
    f"Where the least misfit is over {MISFIT:g}, or the form shares under {SHARED:.0%} of the volume, the piece stays a mesh.",
    "An attachment is cut off where it meets the hull's surface; its form keeps the attachment's centre.",
)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class SimplifiedPart:
    """A part and the piece of the mesh behind it.

    Attributes
    ----------
    part : Part
    likeness : Likeness
        The form as fitted, before rounding, and why.
    volume : float
        Of the piece, m^3.
    projected : (3,) array
        Of the piece along the part's own axes, m^2.
    extents : (3,) array
        Of the piece along the part's own axes, m.
    cut : bool
        Whether it was cut from a hull.
    turned : float
        Angle by which the pose was tidied, rad.
    surface : (vertices, faces)
        Of the piece.
    """

    part: Part
    likeness: Likeness
    volume: float
    projected: Array
    extents: Array
    cut: bool
    turned: float
    surface: Surface

    @property
    def volume_error(self) -> float:
        """Of the form over the piece, less one."""
        return self.part.form.volume / self.volume - 1.0

    @property
    def projected_errors(self) -> Array:
        """(3,) along the part's own axes, of the form over the piece, less one."""
        return np.array([shadow(self.part.form, axis) for axis in np.eye(3)]) / self.projected - 1.0

    @property
    def length_error(self) -> float:
        """Of the form over the piece, less one, along the own axis on which the piece is longest; a plate's in span."""
        longest = int(np.argmax(self.extents)) if self.part.form.volume else 1
        return float(2.0 * self.part.form.half_extents(np.eye(3))[longest] / self.extents[longest] - 1.0)

    def with_fit(self) -> SimplifiedPart:
        """The same with the quality of the fit in the part."""
        if isinstance(self.part.form, Faceted):
            fit = StandIn(CLASSES[Faceted], 1.0, 0.0, (0.0, 0.0, 0.0), 0.0, misfit=0.0)
            return replace(self, part=replace(self.part, fit=fit))
        like, (x, y, z) = self.likeness, (_rounded(e) for e in self.projected_errors)
        form = self.part.form
        thickness = None
        if isinstance(form, Plate):
            thickness = _rounded(self.volume / (form.chord * form.span * min(form.chord, form.span)))
        misfit = None if like.misfit is None else _rounded(like.misfit)
        shared, volume, length = (_rounded(v) for v in (like.shared, self.volume_error, self.length_error))
        fit = StandIn(like.kind, min(shared, 1.0), volume, (x, y, z), length, misfit, thickness)
        return replace(self, part=replace(self.part, fit=fit))

    @property
    def poor(self) -> tuple[str, ...]:
        """What is off by more than 5 %, in words; of a plate only the area along its normal counts."""
        return self.part.fit.over(POOR) if self.part.fit is not None else ()

    @property
    def remarks(self) -> tuple[str, ...]:
        """What it was found to be, in words."""
        like = self.likeness
        kind = like.form if like.clear else "no form is good, so it stays a mesh"
        out = [f"{'attachment' if self.cut else 'body'} of {self.volume:.5g} m^3: {kind} ({like.reason})"]
        if not like.clear:
            out.append("--box around each of its bodies, or --split convex, divides it")
        if self.turned > LEAST_TURN:
            out.append(f"pose tidied: turned by {np.degrees(self.turned):.1f} deg to right angles")
        return tuple(out)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Simplification:
    """A mesh, the simple parts in its place, and how far they agree.

    Attributes
    ----------
    body : Body
        Of the parts.
    shape : Parts
        The same parts.
    mesh : TriangleMesh
    parts : tuple of SimplifiedPart
    unassigned : float
        Volume of slivers that belong to no part, m^3.
    statements : tuple of str
        What was done to the mesh first.
    compared : (AddedMass, AddedMass), optional
        Of the parts and of the mesh, where both were computed.
    uncompared : str
        Why not.
    """

    body: Body
    shape: Parts
    mesh: TriangleMesh
    parts: tuple[SimplifiedPart, ...]
    unassigned: float
    statements: tuple[str, ...]
    compared: tuple[AddedMass, AddedMass] | None = None
    uncompared: str = ""

    @property
    def left_as_mesh(self) -> bool:
        """Whether nothing was found but the mesh itself."""
        return len(self.parts) == 1 and isinstance(self.parts[0].part.form, Faceted)

    @property
    def failures(self) -> tuple[str, ...]:
        """Projected areas that are off by more than 20 %, in words; what the edges of plates project is left out."""
        out = [
            f"{p.part.name}: {name} {100.0 * error:+.0f} %"
            for p in self.parts
            if p.part.fit is not None
            for name, error in p.part.fit.counting.items()
            if name.startswith("A") and abs(error) > FAILED
        ]
        errors = self.projected - sum(self._counting(p) for p in self.parts)
        whole = errors / self.mesh.integrals.projected
        return (
            *out,
            *(f"whole body: A {a} {100.0 * e:+.0f} %" for a, e in zip("xyz", whole, strict=True) if abs(e) > FAILED),
        )

    @staticmethod
    def _counting(p: SimplifiedPart) -> Array:
        """(3,) areas that a piece projects along x, y and z; of a plate without its edges."""
        own, (vertices, faces) = p.part.form, p.surface
        corner = vertices[faces]
        area = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) / 2.0
        if isinstance(own, Plate):
            normal = p.part.rotation[:, 2]
            return np.asarray(np.abs(normal) * np.abs(area @ normal).sum() / 2.0)
        return np.asarray(np.abs(area).sum(axis=0) / 2.0)

    @property
    def recommended(self) -> str | None:
        """``parts`` or ``mesh``; None where they were not compared."""
        if self.left_as_mesh or (self.shape.agreement is not None and self.shape.agreement.apart):
            return "mesh"
        return None if self.shape.agreement is None or self.shape.agreement.unresolved else "parts"

    @property
    def advice(self) -> str:
        """Which of them to use, in words."""
        if self.left_as_mesh:
            return "No form is good: the body stays a mesh, and its added mass is the panel method's."
        agreement = self.shape.agreement
        if agreement is None:
            return f"Parts were not compared with the mesh: {self.uncompared}"
        error = agreement.error
        unsure = " The mesh's own error was not estimated: raise --panels." if error is None else ""
        if error is not None and error > APART / 2.0:
            unsure = f" The mesh's own error is up to {error:.0%}."
        if agreement.apart:
            alone = " Parts are computed alone: what they do to each other is left out." if len(self.parts) > 1 else ""
            return f"USE THE MESH: parts are off by more than {APART:.0%}: {', '.join(agreement.apart)}.{alone}{unsure}"
        worst = max((abs(e) for e in agreement.entries if e is not None), default=0.0)
        if agreement.unresolved:
            return (
                f"Not known whether parts agree with the mesh: they differ by {worst:.1%} at most, and the mesh's own error is up to "
                f"{error:.0%}, beyond the bound of {APART:.0%}. Raise --panels."
            )
        return f"Parts agree with the mesh within {worst:.1%} in every motion; {APART:.0%} is the bound.{unsure}"

    @property
    def projected(self) -> Array:
        """(3,) areas, m^2, along x, y and z: sums over the parts, what hides what is not looked at."""
        along = np.eye(3)
        return np.array([sum(shadow(p.form, p.rotation.T @ d) for p in self.shape.parts) for d in along])

    def part_file(self) -> bytes:
        """The body.toml of the parts, with remarks for the person who corrects it."""
        opening = (
            f"Simple parts in place of {self.body.name.removesuffix('_simplified')}, made by coeflab simplify. Look at "
            "the overlay, and correct here what is wrong.",
            "Lengths in m, FRD, from the datum. Along its own axes a cylinder or spheroid lies along x; a plate has its "
            "chord along x, its span along y, its normal along z. rotation = [roll, pitch, yaw].",
            "fit: how well the form matches its piece of the mesh; class mesh is the piece itself. volume, areas (projected along "
            "the part's own axes) and length: form over piece, less one. Delete the fit of a part that you correct; "
            "what has none counts as you describe it.",
            "mesh: what the parts replace. Panel method and strips use the mesh itself; delete this table where the parts are to be another body.",
            *RULES,
            *self.statements,
        )
        return part_file(self.body, self.shape, opening, {p.part.name: p.remarks for p in self.parts}, MESH)

    def mesh_parts(self) -> dict[str, bytes]:
        """The surfaces of parts that stay meshes, by file, m, along the body's axes from the centre of each."""
        forms = {mesh_name(p): p.form for p in self.shape.parts if isinstance(p.form, Faceted)}
        return {name: ply(form.mesh.vertices, form.mesh.faces) for name, form in forms.items()}

    def mesh_file(self) -> bytes:
        """The mesh for which the parts stand, as PLY; above 200,000 faces decimated to that many."""
        if len(self.mesh.faces) <= SIMPLIFIED_FACES:
            return ply(self.mesh.vertices, self.mesh.faces)
        return ply(*surface(simplified(solid(self.mesh.vertices, self.mesh.faces), SIMPLIFIED_FACES)[0]))


def _rounded(value: float) -> float:
    """As the file gives it."""
    return round(float(value), DECIMALS) + 0.0
