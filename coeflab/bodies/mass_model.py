"""The mass of a vehicle from its parts: solids, shells, payload, ballast and flooded volume; static trim."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any

import numpy as np

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import form_solid
from coeflab.bodies.pieces import Piece
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.table import Table, number, with_u95
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.law.rigid_body import MassProperties, about_another, inertia_doubt, parallel_axis
from coeflab.law.transforms import rotation
from coeflab.law.water import FRESH_DENSITY

GRAVITY = 9.80665
# Nominal densities, kg/m^3; a part whose density is known better states its own.
MATERIALS = {
    "aluminium": 2700.0, "stainless steel": 7950.0, "steel": 7850.0, "titanium": 4430.0, "lead": 11340.0, "brass": 8500.0,
    "acrylic": 1180.0, "POM": 1410.0, "PVC": 1400.0, "HDPE": 950.0, "glass fibre": 1900.0, "carbon fibre": 1550.0,
    "borosilicate glass": 2230.0,
}  # fmt: skip
SIZES = {"point": (), "box": ("length", "width", "height"), "cylinder": ("radius", "length"), "sphere": ("radius",)}
PANELS = 20_000
NEUTRAL, LEVEL, EVEN = 0.01, 1e-9, 5e-5  # weight and buoyancy within; centres at one place, of the length of BG
OVERLAP = 1e-3  # of the smaller part's volume
Size = Annotated[takes.Length, takes.ABOVE_ZERO]


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre inertia")
class MassPart:
    """A part with its mass.

    Attributes
    ----------
    name, material : str
    mass : float
        kg.
    centre : (3,) array
        m, FRD, from the datum.
    inertia : (3, 3) array
        About its own centre, kg m^2.
    volume : float
        Of what is filled, m^3; 0 of a point.
    u95 : float or None
        95 % half-width of the mass, kg, where it is stated.
    flooded : bool
        Water that the vehicle carries with it.
    """

    name: str
    material: str
    mass: float
    centre: Array
    inertia: Array
    volume: float = 0.0
    u95: float | None = None
    flooded: bool = False


def _place(value: float) -> str:
    """A coordinate to a tenth of a millimetre."""
    return f"{round(float(value), 4) + 0.0:.4f}"


def at_rest(excess: float, bg: Array) -> tuple[float, float] | None:
    """Pitch and roll at rest, rad: the centre of gravity hangs below that of buoyancy.

    Parameters
    ----------
    excess : float
        Weight over buoyancy, less one.
    bg : (3,) array
        From the centre of buoyancy to that of gravity, m, FRD.

    Returns
    -------
    tuple of float
        None where weight and buoyancy differ by more than 1 %, or both centres lie at one place.
    """
    if abs(excess) > NEUTRAL or np.linalg.norm(bg) <= LEVEL:
        return None
    x, y, z = bg
    return float(np.arctan2(-x, np.hypot(y, z))), float(np.arctan2(y, z))


def rest_words(angles: tuple[float, float] | None, bg: Array) -> str:
    """Of `at_rest`, in words: where the bow points, and whether it stays upright; of a vehicle that is not neutral with ballast at B."""
    if angles is not None:
        return f"at rest: {_angles(angles, bg)}"
    ballasted = at_rest(0.0, bg)  # a weight at B does not turn the line from B to G
    if ballasted is None:
        return "no trim at rest: G is at B"
    return (
        f"no trim at rest: weight and buoyancy differ by over 1 %; ballasted to neutral at B: {_angles(ballasted, bg)}"
    )


def _angles(angles: tuple[float, float], bg: Array) -> str:
    pitch, roll = (round(float(a), 2) + 0.0 for a in np.degrees(angles))
    bow = f" (bow {'up' if pitch > 0.0 else 'down'})" if pitch else ""
    upright = "" if bg[2] > 0.0 else "; G lies above B: it turns over"
    return f"pitch {f'{pitch:+.2f}' if pitch else '0'} deg{bow}, roll {f'{roll:+.2f}' if roll else '0'} deg{upright}"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre_of_buoyancy")
class MassModel:
    """All parts of a vehicle, and the water that its outer shape displaces.

    Attributes
    ----------
    parts : tuple of MassPart
    density : float
        Of the water, kg/m^3.
    volume : float
        Displaced by the outer shape, flooded rooms included, m^3.
    centre_of_buoyancy : (3,) array
        m, FRD, from the datum.
    assumed : bool
        Whether nobody stated the density.
    """

    parts: tuple[MassPart, ...]
    density: float
    volume: float
    centre_of_buoyancy: Array
    assumed: bool = False

    @property
    def mass(self) -> float:
        """With the water in flooded rooms, kg."""
        return sum(part.mass for part in self.parts)

    @property
    def dry(self) -> float:
        """Without it, kg."""
        return sum(part.mass for part in self.parts if not part.flooded)

    @property
    def u95(self) -> float | None:
        """Of the mass, kg: root of the sum of squares; None where a part's is not stated."""
        own = [part.u95 for part in self.parts]
        known = [u for u in own if u is not None]
        return float(np.sqrt(np.sum(np.square(known)))) if len(known) == len(own) else None

    @property
    def centre(self) -> Array:
        """(3,) centre of gravity, m, FRD, from the datum."""
        return np.asarray(sum(part.mass * part.centre for part in self.parts) / self.mass)

    @property
    def centre_u95(self) -> Array | None:
        """(3,) from the uncertainty of the parts' masses alone, m; None where a part's is not stated."""
        if self.u95 is None:
            return None
        arms = np.array([(part.u95 or 0.0) * (part.centre - self.centre) for part in self.parts])
        return np.asarray(np.sqrt(np.sum(arms**2, axis=0)) / self.mass)

    @property
    def inertia(self) -> Array:
        """(3, 3) about the centre of gravity, kg m^2."""
        return np.asarray(
            sum(part.inertia + parallel_axis(part.mass, part.centre - self.centre) for part in self.parts)
        )

    @property
    def bg(self) -> Array:
        """(3,) from the centre of buoyancy to that of gravity, m, FRD; positive z is stable."""
        return np.asarray(self.centre - self.centre_of_buoyancy)

    @property
    def net(self) -> float:
        """Weight less buoyancy, N; positive sinks."""
        return GRAVITY * (self.mass - self.density * self.volume)

    @property
    def trim(self) -> tuple[float, float] | None:
        """Pitch and roll at rest, rad: the centre of gravity hangs below that of buoyancy.

        None where weight and buoyancy differ by more than 1 %, or both centres lie at one place.
        """
        return at_rest(self.mass / (self.density * self.volume) - 1.0, self.bg)

    def properties(self, reference: Array) -> MassProperties:
        """Mass properties about a point.

        Parameters
        ----------
        reference : (3,) array
            m, FRD, from the datum.
        """
        centre = self.centre - reference
        about = about_another(self.inertia, self.mass, np.zeros(3), centre)
        transverse = float(about[1, 1]) if np.isclose(about[1, 1], about[2, 2], rtol=1e-2) else None
        return MassProperties(self.mass, self.mass * float(centre[0]), transverse, centre, about)

    def table(self) -> Table:
        """Parts, sums and static trim."""
        rows = [
            (
                p.name,
                p.material,
                number(p.mass, 4) if p.u95 is None else with_u95(p.mass, p.u95)[0],
                "" if p.u95 is None else number(p.u95, 2),
                *map(_place, p.centre),
            )
            for p in self.parts
        ]
        u95 = "" if self.u95 is None else number(self.u95, 2)
        rows.append(("all", "", number(self.mass, 5), u95, *map(_place, self.centre)))
        return Table(
            "Mass",
            ("part", "made of", "kg", "U95", "x m", "y m", "z m"),
            tuple(rows),
            tuple(self.words()),
            frozenset({0, 1}),
        )

    def words(self) -> tuple[str, ...]:
        """Weight, buoyancy, BG and trim, one line each."""
        displaced = self.density * self.volume
        share = self.mass / displaced - 1.0
        does = "neutral" if abs(share) < EVEN else f"{'sinks' if share > 0.0 else 'floats'}, {share:+.2%}"
        assumed = ", assumed: no [water] density in its body.toml" if self.assumed else ""
        phrases = [
            f"displaces {displaced:.5g} kg of water of {self.density:g} kg/m^3{assumed}: {does}",
            f"BG = [{', '.join(map(_place, self.bg))}] m",
            "inertia about G: "
            + ", ".join(f"{n} {v:.4g}" for n, v in zip(("Ix", "Iy", "Iz"), np.diag(self.inertia), strict=True))
            + " kg m^2",
        ]
        return (*phrases, rest_words(self.trim, self.bg))

    def as_json(self) -> dict[str, Any]:
        """For machines: SI, FRD, from the datum; absent values are null."""
        trim = self.trim
        return {
            "density": self.density,
            "density_assumed": self.assumed,
            "volume": self.volume,
            "centre_of_buoyancy": self.centre_of_buoyancy.tolist(),
            "parts": [
                {"name": p.name, "made_of": p.material, "mass": p.mass, "u95": p.u95, "point": p.centre.tolist(), "inertia": p.inertia.tolist(),
                 "density": p.mass / p.volume if p.volume else None, "flooded": p.flooded}
                for p in self.parts
            ],
            "mass": {"value": self.mass, "u95": self.u95, "dry": self.dry},
            "centre_of_gravity": {"value": self.centre.tolist(), "u95": None if self.centre_u95 is None else self.centre_u95.tolist()},
            "inertia": {"value": self.inertia.tolist(), "point": self.centre.tolist()},
            "bg": self.bg.tolist(),
            "net_weight": self.net,
            "trim": None if trim is None else {"pitch": trim[0], "roll": trim[1]},
        }  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class WaterKeys(takes.Declaration):
    """The water that the mass model is for.

    Attributes
    ----------
    density : float
        Fresh water of 20 deg C unless given.
    """

    density: Annotated[takes.Density, takes.ABOVE_ZERO] = FRESH_DENSITY


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MassKeys(takes.Declaration):
    """A part with a mass: of a form in its place, of a piece of the shape, ballast, or water in a flooded room.

    Attributes
    ----------
    name : str
        One for each part.
    mass : float
        Weighed or stated; else density or material times volume.
    density : float
        Of what fills it.
    material : str
        In place of a density: its nominal one.
    of : str
        A piece of the shape, such as hull: filled, or with a thickness its shell, inward from the surface.
    thickness : float
        Of that shell.
    form : str
        A box has length, width and height along x, y and z; a cylinder radius and length along x; a sphere a radius; a point
        none.
    centre : (3,) array
        [x, y, z], m, FRD, from the datum.
    rotation : (3,) tuple
        [roll, pitch, yaw] of the form.
    length, width, height, radius : float
        Of the form.
    inertia : (3,) tuple
        [Ix, Iy, Iz] about its centre, where a stated mass has one of its own.
    u95 : float
        95 % half-width of its mass.
    flooded : bool
        A room full of water: the vehicle carries it, and displaces it as well.
    ballast : bool
        Its mass is what is missing to the displaced water.
    """

    name: takes.Text
    mass: Annotated[takes.Mass, takes.ABOVE_ZERO] | None = None
    density: Annotated[takes.Density, takes.ABOVE_ZERO] | None = None
    material: Annotated[str, takes.one_of(*MATERIALS)] | None = None
    of: takes.Text | None = None
    thickness: Size | None = None
    form: Annotated[str, takes.one_of(*SIZES)] = "point"
    centre: takes.Point | None = None
    rotation: Annotated[tuple[float, float, float], takes.numbers(3, "angle", "three numbers [x, y, z] of angle")] = (
        0.0, 0.0, 0.0,
    )  # fmt: skip
    length: Size | None = None
    width: Size | None = None
    height: Size | None = None
    radius: Size | None = None
    inertia: (
        Annotated[tuple[float, float, float], takes.numbers(3, "inertia", "[Ix, Iy, Iz], three moments of inertia")]
        | None
    ) = None
    u95: Annotated[takes.Mass, takes.ZERO_OR_MORE] | None = None
    flooded: takes.Flag = False
    ballast: takes.Flag = False

    def check(self) -> None:
        """One way to its mass, one to its place."""
        stated = [k for k in ("mass", "density", "material") if getattr(self, k) is not None]
        stated += [k for k in ("flooded", "ballast") if getattr(self, k)]
        if len(stated) != 1:
            found = " and ".join(stated) or "nothing that gives its mass"
            raise input_error("bodies.one_mass_density", column=(stated or ["mass"])[-1], found=found)
        if (self.of is None) == (self.centre is None):
            found = "neither" if self.of is None else "both"
            raise InputError(found, "centre, or of: a piece of the shape", column="centre")
        if self.of is not None and (
            self.form != "point" or (stated[0] in ("flooded", "ballast", "mass") and self.thickness is not None)
        ):
            raise input_error("bodies.density_material_piece", column="of", stated=stated[0])
        if self.thickness is not None and self.of is None:
            raise InputError("a thickness", "of as well: the piece whose shell it is", column="thickness")
        for key in ("length", "width", "height", "radius"):
            if (getattr(self, key) is not None) != (key in SIZES[self.form]):
                sizes = ", ".join(SIZES[self.form]) or "none"
                raise InputError(
                    "nothing" if key in SIZES[self.form] else "an unknown key",
                    f"the sizes of a {self.form}: {sizes}",
                    column=key,
                )
        if self.form == "point" and self.of is None and stated[0] not in ("mass", "ballast"):
            raise input_error("bodies.form_sizes", column="form", stated=stated[0], list=", ".join(list(SIZES)[1:]))
        if self.inertia is not None:
            if self.mass is None or self.form != "point" or self.of is not None:
                raise InputError("an inertia", "one with a stated mass at a point", column="inertia")
            if doubt := inertia_doubt(self.mass, np.zeros(3), np.diag(self.inertia)):
                raise InputError(doubt, "the inertia of a body about its centre of gravity", column="inertia")

    @property
    def sizes(self) -> tuple[float, ...]:
        """Of the form, m."""
        return tuple(float(getattr(self, key)) for key in SIZES[self.form])

    @property
    def solid(self) -> Any:
        """The form in its place; None of a point or a piece."""
        if self.form == "point" or self.centre is None:
            return None
        kind, sizes = ("ellipsoid", self.sizes * 3) if self.form == "sphere" else (self.form, self.sizes)
        return form_solid(kind, sizes, rotation(*self.rotation), self.centre)

    def part(self, pieces: Sequence[Piece], water: float) -> MassPart:
        """The part; ballast has no mass yet.

        Raises
        ------
        InputError
            A piece that the body does not have, a shell thicker than it.
        """
        density = MATERIALS[self.material] if self.material is not None else water if self.flooded else self.density
        if self.of is not None:
            volume, centre, second = self._of(pieces)
        else:
            centre = np.zeros(3) if self.centre is None else self.centre
            volume, second = 0.0, np.zeros((3, 3))
            if self.form != "point":
                result = {"box": Box, "cylinder": Cylinder}.get(self.form)
                form = Ellipsoid(*self.sizes * 3) if result is None else result(*self.sizes)
                turn = rotation(*self.rotation)
                volume, second = form.volume, form.volume * turn @ np.diag(form.spread) @ turn.T
        mass = self.mass if self.mass is not None else 0.0 if self.ballast else (density or 0.0) * volume
        own = mass / volume * second if volume else np.zeros((3, 3))
        inertia = np.trace(own) * np.eye(3) - own if self.inertia is None else np.diag(self.inertia)
        return MassPart(self.name, self._words(density), mass, centre, inertia, volume, self.u95, self.flooded)

    def _words(self, density: float | None) -> str:
        what = self.of or self.form
        if self.thickness is not None:
            what = f"{1000.0 * self.thickness:.4g} mm shell of {what}"
        if self.flooded or self.ballast:
            return f"{'water' if self.flooded else 'ballast'}, {what}"
        return what if self.mass is not None else f"{self.material or f'{density:g} kg/m^3'}, {what}"

    def _of(self, pieces: Sequence[Piece]) -> tuple[float, Array, Array]:
        """Volume, centre and second moments about it of a piece or of its shell."""
        found = next((piece for piece in pieces if piece.name == self.of), None)
        if found is None:
            known = ", ".join(piece.name for piece in pieces) or "none"
            raise InputError(f"no piece {shown(self.of)} of the shape", f"one of {known}", column="of")
        whole = found.surface(PANELS)
        outer = whole.integrals
        if self.thickness is None:
            return outer.volume, outer.centre, outer.second_moments
        inner = mesh_integrals(_inward(whole, self.thickness), whole.faces)
        volume = outer.volume - inner.volume
        if not 0.0 < inner.volume < outer.volume or volume > 1.02 * outer.area * self.thickness:
            found_thickness = f"{self.thickness:g} m, which leaves nothing within {self.of}"
            raise input_error("bodies.thickness_leaves_room", column="thickness", found=found_thickness)
        centre = (outer.volume * outer.centre - inner.volume * inner.centre) / volume
        second = outer.second_moments + outer.volume * np.outer(outer.centre - centre, outer.centre - centre)
        second = second - inner.second_moments - inner.volume * np.outer(inner.centre - centre, inner.centre - centre)
        return volume, centre, second


def _inward(mesh: TriangleMesh, by: float) -> Array:
    """Vertices moved inward along the mean of the normals of their faces, weighted by angle (Thuermer & Wuethrich 1998)."""
    corner = mesh.vertices[mesh.faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    total = np.zeros_like(mesh.vertices)
    for k in range(3):
        a, b = corner[:, (k + 1) % 3] - corner[:, k], corner[:, (k + 2) % 3] - corner[:, k]
        angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ij,ij->i", a, b))
        np.add.at(total, mesh.faces[:, k], angle[:, None] * normal)
    total /= np.maximum(np.linalg.norm(total, axis=1), np.finfo(float).tiny)[:, None]
    return np.asarray(mesh.vertices - by * total)


def modelled(
    keys: Sequence[MassKeys], pieces: Sequence[Piece], water: float, volume: float, centre_of_buoyancy: Array
) -> MassModel:
    """The mass model of a body.

    Parameters
    ----------
    keys : sequence of MassKeys
    pieces : sequence of Piece
        Of its shape.
    water : float
        Density, kg/m^3.
    volume : float
        Displaced, m^3.
    centre_of_buoyancy : (3,) array
        m, FRD, from the datum.

    Raises
    ------
    InputError
        Two parts of one name, forms that overlap, a shell thicker than its piece, more water than the body holds, two
        ballasts, or no room for one; ``column`` is the key from the top of the file.
    """
    parts: list[MassPart] = []
    for i, one in enumerate(keys):
        if one.name in (part.name for part in parts):
            raise InputError(f"two parts called {shown(one.name)}", "one name for each part", column=f"mass[{i}].name")
        try:
            parts.append(one.part(pieces, water))
        except InputError as why:
            raise why.at(column=f"mass[{i}].{why.column}") from None
    _require_apart(keys)
    flooded = sum(part.volume for part in parts if part.flooded)
    if flooded > volume:
        i = next(i for i, one in enumerate(keys) if one.flooded)
        raise input_error("bodies.flooded_rooms", column=f"mass[{i}].flooded", flooded=flooded, volume=volume)
    spare = [i for i, one in enumerate(keys) if one.ballast]
    if len(spare) > 1:
        raise InputError("a second ballast", "one part with ballast = true", column=f"mass[{spare[1]}].ballast")
    if spare:
        missing = water * volume - sum(part.mass for part in parts)
        if missing <= 0.0:
            found = f"the other parts, {-missing:.4g} kg heavier than the water that the body displaces"
            raise InputError(found, f"parts lighter than {water * volume:.5g} kg", column=f"mass[{spare[0]}].ballast")
        parts[spare[0]] = _weighed(parts[spare[0]], missing, keys[spare[0]])
    return MassModel(tuple(parts), water, volume, centre_of_buoyancy)


def _weighed(part: MassPart, mass: float, keys: MassKeys) -> MassPart:
    """Ballast with its mass, spread evenly over its form."""
    inertia = np.zeros((3, 3))
    if part.volume:
        result: Callable[..., Any] = {"box": Box, "cylinder": Cylinder}.get(keys.form, lambda r: Ellipsoid(r, r, r))
        turn = rotation(*keys.rotation)
        own = mass * turn @ np.diag(result(*keys.sizes).spread) @ turn.T
        inertia = np.trace(own) * np.eye(3) - own
    return MassPart(part.name, part.material, mass, part.centre, inertia, part.volume, part.u95)


def _require_apart(keys: Sequence[MassKeys]) -> None:
    """Refuse forms that share a volume."""
    solids = [(i, one, one.solid) for i, one in enumerate(keys)]
    for (_, a, first), (i, b, second) in combinations([s for s in solids if s[2] is not None], 2):
        shared = (first ^ second).volume()
        if shared > OVERLAP * min(first.volume(), second.volume()):
            found = f"{shown(b.name)}, which shares {shared:.3g} m^3 with {shown(a.name)}"
            raise InputError(found, "parts that do not overlap", column=f"mass[{i}].centre")
