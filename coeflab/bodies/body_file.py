"""The keys of a body.toml, alike for every reader: head, particulars, configurations, primes, what turns, what weighs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration, Measured
from coeflab.bodies.mass_model import MassKeys, MassModel, WaterKeys, modelled
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.outline import Outline
from coeflab.bodies.pieces import Control, ControlKeys, Piece
from coeflab.bodies.recognition import outline_of
from coeflab.bodies.shape import Shape
from coeflab.bodies.thruster_keys import ThrusterKeys
from coeflab.core import declarations as takes
from coeflab.core.axes import DatumKeys
from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import InputFile, Source, sha256_of
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.rigid_body import MassProperties, about_another, inertia_doubt
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import derivative

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import CoreSchema


def mass_from_primes(mass: float, moment: float, inertia: float | None, by: Scaling, density: float) -> MassProperties:
    """Dimensional mass properties from m', xG' m', I' (m' = m / (1/2 rho L^3))."""
    unit = by.unit("m", density)
    return MassProperties(
        mass * unit, moment * unit * by.length, None if inertia is None else inertia * by.unit("I", density)
    )


@dataclass(frozen=True, slots=True)
class AssumedMassKeys(takes.Declaration):
    """What the source does not print of the mass, for every configuration with ``inertia_prime``.

    Attributes
    ----------
    centre_of_gravity_below : float
        How far the centre of gravity lies below the reference point.
    roll_gyradius : float
        Radius of gyration about the axis along x through the centre of gravity.
    why : str
        What the assumption is; it goes with the numbers into parameter files and exports.
    """

    centre_of_gravity_below: takes.Length
    roll_gyradius: Annotated[takes.Length, takes.ABOVE_ZERO]
    why: takes.Text

    def filled(self, printed: MassProperties) -> MassProperties:
        """With centre and matrix; the printed transverse inertia is about the reference point."""
        m, below = printed.mass, self.centre_of_gravity_below
        centre = np.array([printed.mass_moment / m, 0.0, below])
        matrix = np.diag([m * (self.roll_gyradius**2 + below**2), *[printed.inertia or 0.0] * 2])
        matrix[0, 2] = matrix[2, 0] = -m * centre[0] * below
        return replace(printed, centre=centre, inertia_matrix=matrix)

    def findings(self, name: str, mass: MassProperties) -> tuple[Finding, ...]:
        """What is assumed of a configuration, its roll inertia as the statistic."""
        centre, matrix = (
            mass.centre_of_gravity,
            np.zeros((3, 3)) if mass.inertia_matrix is None else mass.inertia_matrix,
        )
        return (
            Finding.of(
                "assumed.mass", name, Severity.NOTE, statistic=float(matrix[0, 0]), below=float(centre[2]),
                gyradius=self.roll_gyradius, why=self.why.strip().removesuffix("."),
            ),
        )  # fmt: skip


ROW = takes.numbers(3, "inertia", "three rows of three moments of inertia")
SIMPLE, FULL = ("mass", "centre_of_gravity_forward", "inertia"), ("mass", "centre_of_gravity", "inertia_matrix")
PRIMES = ("mass_moment_prime", "inertia_prime")


def _rows(value: Any, file: Path) -> Array:
    """(3, 3) array."""
    if not isinstance(value, list) or len(value) != 3 or not all(isinstance(row, list) for row in value):
        raise InputError(shown(value), ROW.words)
    return np.array([ROW.read(row, file) for row in value])


InertiaMatrix = Annotated[
    Array, takes.Takes(ROW.words, _rows, {"type": "array", "items": ROW.schema, "minItems": 3, "maxItems": 3})
]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConfigurationKeys(takes.Declaration):
    """One state of appendages: volume, surface, centre of buoyancy and mass, each as far as it is given.

    Attributes
    ----------
    name : str
        Campaigns and parameter files name it as their body.
    title : str
        As reports print it.
    volume, wetted_surface : float
        Of the outer shape.
    centre_of_buoyancy : (3,) array
        [x, y, z], m, FRD, from the datum.
    mass : float
        Of the vehicle.
    centre_of_gravity_forward : float
        How far the centre of gravity lies forward of the reference point, where ``centre_of_gravity`` is not given.
    inertia : float
        About the transverse axes through the reference point, where ``centre_of_gravity`` is not given.
    centre_of_gravity : (3,) array
        [x, y, z], m, FRD, from the datum.
    inertia_matrix : (3, 3) array
        About the centre of gravity, which has to be given.
    mass_prime, mass_moment_prime, inertia_prime : float
        m', x_G' m' and I' by the length and density of ``[prime]``, in place of mass.
    """

    name: takes.Text
    title: takes.Words = ""
    volume: Annotated[takes.Volume, takes.ABOVE_ZERO] | None = None
    wetted_surface: Annotated[takes.Area, takes.ABOVE_ZERO] | None = None
    centre_of_buoyancy: takes.Point | None = None
    mass: Annotated[takes.Mass, takes.ABOVE_ZERO] | None = None
    centre_of_gravity_forward: takes.Length | None = None
    inertia: Annotated[takes.Inertia, takes.ABOVE_ZERO] | None = None
    centre_of_gravity: takes.Point | None = None
    inertia_matrix: InertiaMatrix | None = None
    mass_prime: Annotated[takes.Pure, takes.ABOVE_ZERO] | None = None
    mass_moment_prime: takes.Pure | None = None
    inertia_prime: Annotated[takes.Pure, takes.ABOVE_ZERO] | None = None

    def require_mass(self) -> None:
        """Refuse keys of the mass that do not go together."""
        if self.mass_prime is not None:
            goes: tuple[str, ...] = PRIMES
            if self.mass_moment_prime is None:
                raise InputError("nothing", "a number", column="mass_moment_prime", advice="Add it.")
        else:
            goes = () if self.mass is None else SIMPLE if self.centre_of_gravity is None else FULL
        for key in dict.fromkeys(SIMPLE + FULL + PRIMES):
            if key in goes or getattr(self, key) is None:
                continue
            if goes is FULL and key in SIMPLE:
                raise InputError("both", f"centre_of_gravity and inertia_matrix, or {key}", column=key)
            raise InputError("keys that do not go together", f"only {', '.join(SIMPLE)}, or {', '.join(FULL)}, or "
                             f"mass_prime, {', '.join(PRIMES)}", column=key)  # fmt: skip
        if self.inertia_matrix is not None and self.mass is not None:
            doubt = inertia_doubt(self.mass, np.zeros(3), self.inertia_matrix)
            if doubt:
                raise InputError(doubt, "the inertia of a body about its centre of gravity", column="inertia_matrix")

    def build(self, prime: PrimeKeys | None, reference: Array, assumed: AssumedMassKeys | None = None) -> Configuration:
        """The configuration.

        Parameters
        ----------
        prime : PrimeKeys, optional
            What primed mass properties are divided by.
        reference : (3,) array
            The body's reference point, m, FRD, from its datum.
        assumed : AssumedMassKeys, optional
            What is not printed beside primes.

        Raises
        ------
        InputError
            With what is assumed, an inertia that no body has.
        """
        mass = self._mass(prime, reference)
        whole = Configuration(self.name, self.title, self.volume, self.wetted_surface, self.centre_of_buoyancy, mass)
        if assumed is None or mass is None or self.inertia_prime is None:
            return whole
        mass = assumed.filled(mass)
        try:
            mass.refuse()
        except ValueError as why:
            raise InputError(f"{why} in {self.name}", "the inertia of a body", column="roll_gyradius") from None
        return replace(whole, mass=mass, findings=assumed.findings(self.name, mass))

    def _mass(self, prime: PrimeKeys | None, reference: Array) -> MassProperties | None:
        if self.mass_prime is not None and prime is not None and prime.density is not None:
            return mass_from_primes(
                self.mass_prime, self.mass_moment_prime or 0.0, self.inertia_prime, prime.scaling, prime.density
            )
        if self.mass is None:
            return None
        if self.centre_of_gravity is None:
            return MassProperties(self.mass, self.mass * (self.centre_of_gravity_forward or 0.0), self.inertia)
        centre = self.centre_of_gravity - reference
        ahead = self.mass * float(centre[0])
        if self.inertia_matrix is None:
            return MassProperties(self.mass, ahead, None, centre)
        about = about_another(self.inertia_matrix, self.mass, np.zeros(3), centre)
        transverse = float(about[1, 1]) if np.isclose(about[1, 1], about[2, 2], rtol=1e-9) else None
        return MassProperties(self.mass, ahead, transverse, centre, about)


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyHead(DatumKeys):
    """What the body is.

    Attributes
    ----------
    name : str
        Of the body.
    title : str
        As reports print it.
    reader : str
        How the shape is given, particulars unless said; ``coeflab formats bodies`` lists them.
    reference_point : (3,) array
        Of mass moment and inertia, [x, y, z], m, FRD, from the datum.
    """

    name: takes.Text
    title: takes.Words = ""
    reader: takes.Words = "particulars"
    reference_point: takes.Point


@dataclass(frozen=True, slots=True)
class PrimeKeys(Scaling):
    """The length of primed values.

    Attributes
    ----------
    length : float
        Of the primes.
    length_name : str
        What that length is, such as LBP.
    density : float
        Where a configuration has ``mass_prime``, and only there.
    """

    density: Annotated[takes.Density, takes.ABOVE_ZERO] | None = None

    @property
    def scaling(self) -> Scaling:
        """The prime system."""
        return Scaling(self.length, self.length_name)


@dataclass(frozen=True, slots=True)
class MeasuredKeys(takes.Declaration):
    """Acceleration derivatives that somebody measured.

    Attributes
    ----------
    citation : str
        Key of a work or free text.
    place : str
        Pages or table in it.
    values : mapping of str to str
        Such as Yvdot = "-0.01326", primed by the length of ``[prime]``, as printed; a closing ? is an illegible digit.
    """

    citation: takes.Text
    values: dict[str, takes.Text]
    place: takes.Words = ""

    def check(self) -> None:
        """Derivatives by an acceleration, and numbers."""
        for symbol in self.values:
            try:
                self._one(symbol)
            except InputError as why:
                raise why.at(column=f"values.{symbol}") from None

    def _one(self, symbol: str) -> Measured:
        name = derivative(symbol).text
        if not name.endswith("dot"):
            raise InputError(f'"{symbol}"', "an acceleration derivative such as Yvdot")
        return Measured(name, self.values[symbol], self.citation, self.place)

    @property
    def built(self) -> tuple[Measured, ...]:
        """One by one."""
        return tuple(map(self._one, self.values))


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyFile(takes.Declaration):
    """A body.toml: a body and its configurations.

    Attributes
    ----------
    body : table
        What the body is.
    source : table
        Where it comes from.
    particulars : mapping of str to float
        Named lengths, such as length_overall and diameter.
    prime : table
        The length of primed values.
    assumed_mass : table
        What the source does not print of the mass.
    configuration : array of tables
        States of appendages.
    """

    reader: ClassVar[str] = ""
    body: BodyHead
    source: Source
    particulars: Mapping[str, Annotated[takes.Length, takes.ABOVE_ZERO]] = field(default_factory=dict)
    prime: Annotated[PrimeKeys | None, takes.OrEmpty()] = None
    assumed_mass: AssumedMassKeys | None = None
    configuration: tuple[ConfigurationKeys, ...] = ()

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        reference = super(BodyFile, cls).__get_pydantic_json_schema__(core, handler)
        keys = handler.resolve_ref_schema(reference)["properties"]
        named = {"const": cls.reader or "particulars"}
        own = {"properties": {"reader": named}} | ({"required": ["reader"]} if cls.reader else {})
        keys["body"] = {"allOf": [keys["body"], own], "description": keys["body"].pop("description")}
        return reference

    def check(self) -> None:
        """The reader, and the keys of the mass."""
        if self.reader and self.body.reader != self.reader:
            raise InputError(f'"{self.body.reader}"', f'"{self.reader}"', column="body.reader")
        primed = any(c.mass_prime is not None for c in self.configuration)
        if primed and (self.prime is None or self.prime.density is None):
            key, what = ("prime.length", "a length") if self.prime is None else ("prime.density", "a density")
            raise InputError("nothing", what, column=key, advice=f"Add {key}.")
        if self.prime is not None and not primed and (self.prime.density is not None or not self.reader):
            key = "prime.density" if self.reader else "prime"
            raise input_error(
                "bodies.key_without_mass", column=key,
                advice="Delete density in [prime]." if self.reader else "Delete [prime].",
            )  # fmt: skip
        for i, one in enumerate(self.configuration):
            try:
                one.require_mass()
            except InputError as why:
                raise why.at(column=f"configuration[{i}].{why.column}") from None
        if self.assumed_mass is None:
            return
        if not any(c.inertia_prime is not None for c in self.configuration):
            found = "a table without inertia_prime"
            raise InputError(found, "one [[configuration]] at least with inertia_prime", column="assumed_mass")
        for one in self.configuration:
            try:
                one.build(self.prime, self.body.reference_point, self.assumed_mass)
            except InputError as why:
                raise InputError(why.found, why.expected, column=f"assumed_mass.{why.column}") from None

    def build(self, path: Path, shape: Shape | None = None, computed: tuple[Configuration, ...] = ()) -> Body:
        """The body; printed configurations follow those that were computed from the shape."""
        head = self.body
        printed = tuple(c.build(self.prime, head.reference_point, self.assumed_mass) for c in self.configuration)
        return Body(
            name=head.name,
            title=head.title,
            datum=head.origin,
            reference_point=head.reference_point,
            lengths=self.particulars,
            configurations=(*computed, *printed),
            source=self.source,
            files=(InputFile(f"{head.name}/{path.name}", sha256_of(path)),),
            shape=shape,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapedBodyFile(BodyFile):
    """A body.toml with a shape.

    Attributes
    ----------
    measured : array of tables
        Acceleration derivatives from elsewhere, to be shown beside computed ones.
    control : array of tables
        Parts that turn.
    thruster : array of tables
        Thrusters, for manoeuvres and exports.
    mass : array of tables
        Parts with masses: they give the mass of the configuration that is computed from the shape.
    water : table
        What they float in.
    """

    measured: tuple[MeasuredKeys, ...] = ()
    control: tuple[ControlKeys, ...] = ()
    thruster: tuple[ThrusterKeys, ...] = ()
    mass: tuple[MassKeys, ...] = ()
    water: WaterKeys | None = None

    def check(self) -> None:
        """Primed values have a length."""
        BodyFile.check(self)
        if self.prime is None and any(m.values for m in self.measured):
            expected = "[prime] with length and length_name"
            raise InputError("primed values without a length", expected, column="measured")

    def shaped(
        self,
        path: Path,
        shape: Shape,
        computed: Configuration,
        pieces: tuple[Piece, ...] = (),
        outlined: Callable[[tuple[Control, ...]], Outline] | None = None,
    ) -> Body:
        """The body with its shape, its pieces, what turns and what was measured.

        Parameters
        ----------
        path : Path
        shape : Shape
        computed : Configuration
            From the shape.
        pieces : tuple of Piece
        outlined : callable, optional
            ``outlined(controls)``: the outline, where the reader knows more of it than the shape.

        Raises
        ------
        InputError
            A control of a part that is none of the pieces, by file, line and key.
        """
        controls: list[Control] = []
        own = {piece.name for piece in pieces}
        foils: tuple[str, ...] = ()
        if isinstance(shape, TriangleMesh) and any(set(one.parts) - own for one in self.control):
            foils = tuple(foil.name for foil in outline_of(shape).foils)
        for i, one in enumerate(self.control):
            try:
                controls.append(one.build(pieces, foils))
            except InputError as why:
                raise read_toml(path).fail(f"control[{i}].{why.column}", why.found, why.expected) from None
        model = self._weighed(path, computed, pieces)
        if model is not None:
            computed = replace(computed, mass=model.properties(self.body.reference_point))
        return replace(
            self.build(path, shape, (computed,)),
            mass_model=model,
            scaling=self.prime and self.prime.scaling,
            measured=tuple(m for s in self.measured for m in s.built),
            thrusters=tuple(t.built for t in self.thruster),
            pieces=pieces,
            controls=tuple(controls),
            outlined=None if outlined is None else cache(partial(outlined, tuple(controls))),
        )

    def _weighed(self, path: Path, computed: Configuration, pieces: tuple[Piece, ...]) -> MassModel | None:
        if not self.mass:
            return None
        toml = read_toml(path)
        if computed.volume is None or computed.centre_of_buoyancy is None:
            raise toml.fail("mass", "masses of a body that displaces nothing", "a shape with a volume")
        try:
            water = self.water or WaterKeys()
            result = modelled(self.mass, pieces, water.density, computed.volume, computed.centre_of_buoyancy)
            return replace(result, assumed=self.water is None)
        except InputError as why:
            raise toml.fail(why.column or "mass", why.found, why.expected, why.advice) from None
