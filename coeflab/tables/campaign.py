"""What a campaign.toml declares about its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core import declarations as takes
from coeflab.core.axes import Axes, Datum, DatumKeys, Frame
from coeflab.core.errors import InputError, shown
from coeflab.core.files import named
from coeflab.core.provenance import TABLE_KINDS, Source
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import brief, locked
from coeflab.core.wording import Verbatim
from coeflab.law.scaling import Conditions, Scaling, doubtful_mass
from coeflab.tables.column_map import ColumnMap, Entry

if TYPE_CHECKING:
    pass

from coeflab.tables.input_uncertainty import InputUncertainty

FILE = "campaign.toml"

# Unit vectors, FRD, from the body to the side that the centre of its circle lies on.
SIDES = {"starboard": (0.0, 1.0, 0.0), "port": (0.0, -1.0, 0.0), "above": (0.0, 0.0, -1.0), "below": (0.0, 0.0, 1.0)}
SIGNED = "+R "  # before the side that a positive radius means
CENTRES = (*SIDES, *(f"{SIGNED}{side}" for side in SIDES))
# What a body may be declared to be: its own mirror image in y = 0 or z = 0, the same after a quarter of a turn about x.
PORT_STARBOARD, UP_DOWN, FOURFOLD = "port-starboard", "up-down", "fourfold"
SYMMETRIES = (PORT_STARBOARD, UP_DOWN, FOURFOLD)


@brief
@dataclass(frozen=True, slots=True)
class Cut:
    """A symmetry plane through the body, on one side of which its forces are computed or measured.

    The image in the plane has the same ``doubled`` components, and the opposite ``cancelled`` ones, which vanish in the sum.

    Attributes
    ----------
    plane : str
    symmetry : str
        That a body has which is its own image in the plane.
    doubled, cancelled : tuple of str
        Of X Y Z K M N, FRD.
    carries_no : str
        The lost ones in words.
    across : tuple of str
        Motions that leave the plane: half of the body says nothing of them.
    controls : tuple of str
        Controls that do so when they are deflected.
    """

    plane: str
    symmetry: str
    doubled: tuple[str, ...]
    cancelled: tuple[str, ...]
    carries_no: str
    across: tuple[str, ...]
    controls: tuple[str, ...]


CUTS = {
    PORT_STARBOARD: Cut(
        "y = 0", PORT_STARBOARD, ("X", "Z", "M"), ("Y", "K", "N"), "side force, roll or yaw", ("v", "p", "r"), ("dr",)
    ),
    UP_DOWN: Cut(
        "z = 0", UP_DOWN, ("X", "Y", "N"), ("Z", "K", "M"), "normal force, roll or pitch", ("w", "p", "q"), ("ds", "db")
    ),
}  # fmt: skip
HALVES = {"starboard": PORT_STARBOARD, "port": PORT_STARBOARD, "upper": UP_DOWN, "lower": UP_DOWN}
HALF_WORDS = 'true or false, or which half: "starboard" or "port" of a cut at y = 0, "upper" or "lower" of one at z = 0'


def cut_of(half: bool | str | None) -> Cut | None:
    """The cut of a half model, for which ``true`` is one at y = 0; None of a whole one."""
    if not half:
        return None
    return CUTS[HALVES[half] if isinstance(half, str) else PORT_STARBOARD]


def half_of_body(value: Any, _file: Path | None = None) -> bool | str:
    """A value of ``half_model``.

    Raises
    ------
    InputError
        It is none.
    """
    if isinstance(value, bool) or (isinstance(value, str) and value in HALVES):
        return Verbatim(value) if isinstance(value, str) else value
    raise InputError(shown(value), HALF_WORDS)


def _symmetries(value: Any, file: Path) -> tuple[str, ...]:
    names: tuple[str, ...] = takes.TEXTS.read(value, file)
    for name in names:
        if name not in SYMMETRIES or names.count(name) > 1:
            raise InputError(shown(name), f"each once of {', '.join(SYMMETRIES)}")
    return names


SYMMETRY_WORDS = takes.Takes(
    "a list of texts",
    _symmetries,
    {"type": "array", "items": {"type": "string", "enum": list(SYMMETRIES)}, "uniqueItems": True},
)
HalfModel = Annotated[
    bool | str,
    takes.Takes(HALF_WORDS, half_of_body, {"anyOf": [{"type": "boolean"}, {"type": "string", "enum": list(HALVES)}]}),
]


@brief
@dataclass(frozen=True, slots=True)
class TowedInertia(takes.Declaration):
    """Mass properties of the towed model, for forces that contain its inertia.

    Attributes
    ----------
    mass : float
        kg.
    centre_of_gravity : (3,) array
        m, FRD, from the datum.
    inertia : tuple of 3 floats or None
        Ix Iy Iz about the centre of gravity, kg m^2; may be absent where every row turns about one axis of the body alone.
    """

    mass: Annotated[takes.Mass, takes.ABOVE_ZERO]
    centre_of_gravity: takes.Point
    inertia: Annotated[tuple[float, ...], takes.numbers(3, "inertia", "three numbers [x, y, z] of inertia")] | None = (
        None
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarMotionKeys(takes.Declaration):
    """What stands between the water and the records of oscillating runs.

    Attributes
    ----------
    filter : mapping
        What the recording did to each channel: ``forces`` or single ones of X Y Z K M N, and ``motion`` where the records hold it.
        "none", "Butterworth 4, 5 Hz", "zero-phase Butterworth 4, 5 Hz", "delay 0.01 s" or "lag 3 deg" (positive: late).
    restoring : tuple of 2 floats
        [roll, pitch]: moments of weight and buoyancy per radian in the recorded K and M, positive upright, N m; [0, 0] for a
        computation without gravity.
    """

    filter: Annotated[Mapping[str, Any], takes.TABLE]
    restoring: (
        Annotated[tuple[float, ...], takes.numbers(2, "moment", "two numbers [roll, pitch] of moments per radian")]
        | None
    ) = None


@brief
@dataclass(frozen=True, slots=True)
class TableDeclaration(takes.Declaration):
    """One ``[[table]]`` of a campaign.

    Attributes
    ----------
    file : str
        From the folder of the campaign.toml.
    sha256 : str
        Expected hash, or empty.
    contains_inertia : bool or None
        Whether forces and moments hold the model's own inertia; a rotating arm has to say so.
    labels, ignore : tuple of str
        Columns that name rows, and columns to skip.
    select : mapping of str to str
        Only rows with this text in that label column enter fits; ``reason`` says why.
    cells : str
        Column with the cells of the grid that computed each row, or empty. Of rows at one condition that on the grid which most share enters fits.
    variant : str
        Column that says what a study changed in a row, as "domain = large" (domain, turbulence or iterations); blank or "matrix"
        in a row of none. Rows of studies do not enter fits; how far they differ enters U95, but of turbulence models, whose spread stands beside it.
    reference_point : (3,) array or None
        Of this table's moments and rates, m, FRD, from the datum; the campaign's unless given. Moments are moved to the campaign's.
    arm_point : (3,) array or None
        Point that U, angles, velocities and R are measured at, m, FRD, from the datum; the reference point unless given, and
        required with a column R.
    centre : str
        Side of the body on which the centre of its circle lies, where a column R has the radius: starboard (r > 0), port,
        above (q > 0), below; or "+R starboard" and the like, where R has a sign.
    half_model : bool or str
        As campaign.half_model, which it overrides.
    by_symmetry : str
        File of the table whose rows these are, mirrored or turned by the body's symmetry: stated, not run. They decide no fit
        together with those.
    forces_density : float or None
        Of the fluid that the forces were computed with, kg/m^3, where a solver's files state it. Another density of the campaign is
        refused: the primes would be wrong by their ratio.
    assumed : tuple of str
        Keys that an import accepted although no source states them, such as table.arm_point: every coefficient that hangs on one says
        so. Delete a key here once the source states it.
    contains_thrust : bool or None
        Whether X holds the thrust of a propeller that runs, columns rps, J or thrust: unless false, X of such rows enters no fit.
    constant : mapping of str to float
        Columns of the source with one number throughout that are none of the table, such as rps: what was held while speeds varied.
    source_sha256 : str
        Of the file that the table was made from; for people.
    """

    file: takes.Text
    sha256: takes.Words = ""
    contains_inertia: takes.Flag | None = None
    labels: takes.Texts = ()
    ignore: takes.Texts = ()
    select: Mapping[str, Any] = field(default_factory=dict)
    cells: takes.Words = ""
    variant: takes.Words = ""
    reference_point: takes.Point | None = None
    arm_point: takes.Point | None = None
    centre: Annotated[str, takes.one_of(*CENTRES)] = ""
    half_model: HalfModel | None = None
    by_symmetry: takes.Words = ""
    forces_density: takes.Density | None = None
    assumed: takes.Texts = ()
    contains_thrust: takes.Flag | None = None
    constant: Annotated[Mapping[str, Any], takes.TABLE] = field(default_factory=dict)
    source_sha256: takes.Anything = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "select", MappingProxyType(dict(self.select)))
        object.__setattr__(self, "constant", MappingProxyType(dict(self.constant)))
        for name in ("reference_point", "arm_point"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def check(self) -> None:
        """The reason of the selection is a text."""
        if not isinstance(self.select_reason, str):
            raise InputError(shown(self.select_reason), "a text", column="select.reason")
        for name, value in self.constant.items():
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise InputError(shown(value), "a number", column=f"constant.{name}")

    @property
    def selected(self) -> Mapping[str, str]:
        """Text that each label column has in the rows that enter fits."""
        return {name: str(text) for name, text in self.select.items() if name != "reason"}

    @property
    def select_reason(self) -> str:
        """Why the others do not."""
        return Verbatim(self.select.get("reason", "not selected by the campaign"))


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignHead(takes.Declaration):
    """What the campaign is.

    Attributes
    ----------
    name : str
        The folder's unless given.
    title : str
        As reports print it.
    body : str
        Configuration of a body.toml that the tables are about.
    importer : str
        Format of the tables; ``coeflab formats`` lists them.
    half_model : bool or str
        Whether the tables are of one half of a symmetric model, and which. starboard, port or true, cut at y = 0: X, Z, M are
        doubled, Y, K, N refused, as v, p, r. upper or lower, cut at z = 0: X, Y, N are doubled, Z, K, M refused, as w, p, q; the
        body is declared up-down under symmetry. false: forces are of the whole body.
    symmetry : tuple of str
        What the body is exactly: port-starboard, up-down (each its own mirror image), fourfold (a quarter of a turn about x leaves
        it as it is). A sweep of one side is then odd or even by declaration, and needs no other side. Leave it out for a model
        whose own asymmetry is to be measured.
    appendages, reynolds, notes, configuration, date : any
        For people.
    """

    name: takes.Words | None = None
    title: takes.Text
    body: takes.Text
    importer: takes.Words = "csv"
    half_model: HalfModel | None = None
    symmetry: Annotated[tuple[str, ...], SYMMETRY_WORDS] = ()
    appendages: takes.Anything = None
    reynolds: takes.Anything = None
    notes: takes.Anything = None
    configuration: takes.Anything = None
    date: takes.Anything = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignAxes(DatumKeys):
    """Axes and signs of the tables' columns.

    Attributes
    ----------
    frame : str or list of str
        FRD, FLU, CFD (x aft, y starboard, z up), or where x, y and z point.
    alpha, beta : str
        Which sign the angle has, as a formula: v = +U sin(beta) or v = -U sin(beta), w = +U sin(alpha) or w = -U sin(alpha).
    assumed : tuple of str
        Angles, alpha and beta, whose sign nobody stated: it was inferred from Yv' < 0 or Zw' < 0, which then prove nothing.
    reference_point : (3,) array
        Of moments and rates, [x, y, z], m, FRD, from the datum.
    """

    frame: Frame
    alpha: takes.Text | None = None
    beta: takes.Text | None = None
    assumed: takes.Texts = ()
    reference_point: takes.Point


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignConditions(Conditions):
    """Fluid and speed of the test.

    Attributes
    ----------
    appendages, notes, configuration, date : any
        For people.
    """

    appendages: takes.Anything = None
    notes: takes.Anything = None
    configuration: takes.Anything = None
    date: takes.Anything = None


@dataclass(frozen=True, slots=True, kw_only=True)
class TableSource(Source):
    """Where the tables come from.

    Attributes
    ----------
    sha256, url : any
        Of what was read; for people.
    """

    kind: Annotated[str, takes.one_of(*TABLE_KINDS)]
    sha256: takes.Anything = None
    url: takes.Anything = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignFile(takes.Declaration):
    """A campaign.toml: what a folder of tables from one test or one set of computations declares about them.

    Attributes
    ----------
    campaign : table
        What the campaign is.
    axes : table
        Axes, signs and the reference point of the tables' columns.
    scaling : table
        The length of the primes.
    conditions : table
        Fluid and speed.
    source : table
        Where the tables come from.
    inertia : table
        Mass properties of the model, where tables contain its inertia.
    uncertainty : table
        95 % half-widths of errors that all points share; absent where not assessed, which is not zero.
    importer : table
        Options of the importer, such as sheet of excel; ``coeflab formats`` lists them.
    columns : table
        What each column of the files is, by its name there: "Y [N]", "-beta [deg]", label, ignore; docs/data_in.md.
    planar_motion : table
        Filters and restoring moments of oscillating runs.
    table : array of tables
        One for each file.
    """

    campaign: CampaignHead
    axes: CampaignAxes
    scaling: Scaling
    conditions: CampaignConditions
    source: TableSource
    inertia: Annotated[TowedInertia | None, takes.OrEmpty()] = None
    uncertainty: Annotated[InputUncertainty | None, takes.OrEmpty()] = None
    importer: Annotated[dict[str, Any], takes.TABLE] = field(default_factory=dict)
    columns: dict[str, Entry] = field(default_factory=dict)
    planar_motion: PlanarMotionKeys | None = None
    table: tuple[TableDeclaration, ...] = ()

    def check(self) -> None:
        """At least one table; those by symmetry are of others, and of a body with a symmetry, as halves cut at z = 0 are."""
        if not self.table:
            raise input_error("tables.no_table", column="table")
        density = self.conditions.density
        if self.inertia is not None and (doubt := doubtful_mass(self.inertia.mass, density, self.scaling)):
            raise input_error("tables.mass_of_no_body", column="inertia.mass", mass=self.inertia.mass, doubt=doubt)
        halves = [("campaign", self.campaign.half_model)]
        halves += [(f"table[{i}]", t.half_model) for i, t in enumerate(self.table) if t.half_model is not None]
        for where, half in halves:
            cut = cut_of(half)
            # Most bodies are alike to port and starboard; alike above and below are few, which somebody has to say.
            if cut is not None and cut.symmetry == UP_DOWN and UP_DOWN not in self.campaign.symmetry:
                raise input_error(
                    "tables.half_without_symmetry", column=f"{where}.half_model", half=shown(half), plane=cut.plane, up_down=UP_DOWN,
                )  # fmt: skip
        for i, table in enumerate(self.table):
            others = [t.file for t in self.table if t is not table and not t.by_symmetry]
            if table.by_symmetry and table.by_symmetry not in others:
                expected = f"the file of a table that was run: {', '.join(others) or 'there is none'}"
                raise InputError(shown(table.by_symmetry), expected, column=f"table[{i}].by_symmetry")
            if table.by_symmetry and not self.campaign.symmetry:
                advice = f"Add campaign.symmetry, a list of {', '.join(SYMMETRIES)}."
                raise input_error("tables.no_declared_symmetry", column=f"table[{i}].by_symmetry", advice=advice)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Campaign:
    """A folder of tables from one test or one set of computations.

    `lines` has the line of every ``[[table]]`` in its file, `options` are those of the importer.
    """

    path: Path
    name: str
    title: str
    body: str
    importer: str
    axes: Axes
    signs: Mapping[str, str]
    datum: Datum
    reference_point: NDArray[np.float64]
    scaling: Scaling
    conditions: Conditions
    half_model: bool | str | None
    inertia: TowedInertia | None
    source: Source
    tables: tuple[TableDeclaration, ...]
    uncertainty: InputUncertainty | None = None
    columns: Mapping[str, ColumnMap] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    lines: tuple[int | None, ...] = ()
    planar_motion: PlanarMotionKeys | None = None
    symmetry: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    notes: str = ""

    def __post_init__(self) -> None:
        for name in ("signs", "columns", "options"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))
        object.__setattr__(self, "reference_point", locked(self.reference_point))

    def wanted(self, only: str | None) -> tuple[TableDeclaration, ...]:
        """The tables, or the one of that file name.

        Raises
        ------
        InputError
            There is none.
        """
        out = tuple(t for t in self.tables if only is None or Path(t.file).name == only)
        if not out:
            known = ", ".join(t.file for t in self.tables)
            raise InputError(f"no [[table]] for {shown(only)}", f"one of {known}", file=self.path, column="table")
        return out

    def fail(self, table: TableDeclaration, key: str, code: str, **facts: Any) -> InputError:
        """An error about a key of one ``[[table]]``, to be raised by the caller."""
        at = next(i for i, own in enumerate(self.tables) if own is table)
        line = self.lines[at] if self.lines else None
        return input_error(code, self.path, line, key=f"table[{at}].{key}", **facts)


def read_campaign(path: str | Path) -> Campaign:
    """Read and check a campaign.toml.

    Parameters
    ----------
    path : str or Path
        The file itself, or the name of a shipped campaign.

    Raises
    ------
    InputError
        Everything missing, unknown or inconsistent, by file, line and key.
    """
    path = named(path, FILE)
    toml = read_toml(path)
    file = takes.declared(CampaignFile, toml)
    return campaign_of(file, path, tuple(toml.line(("table", i)) for i in range(len(file.table))))


def campaign_of(file: CampaignFile, path: Path, lines: tuple[int | None, ...] = ()) -> Campaign:
    """A campaign of what is declared, by a campaign.toml or by a program.

    Parameters
    ----------
    file : CampaignFile
    path : Path
        Of its campaign.toml; a path that does not exist where there is none.
    lines : tuple of int or None
        See `Campaign`.
    """
    head, axes, at, source = file.campaign, file.axes, file.conditions, file.source
    signs = {"alpha": axes.alpha, "beta": axes.beta}
    return Campaign(
        path=path,
        name=Verbatim(path.parent.name) if head.name is None else head.name,
        title=head.title,
        body=head.body,
        importer=head.importer,
        axes=axes.frame,
        signs={name: str(sign) for name, sign in signs.items() if sign is not None},
        datum=axes.origin,
        reference_point=axes.reference_point,
        scaling=file.scaling,
        conditions=Conditions(at.density, at.speed, at.viscosity, at.reynolds),
        half_model=head.half_model,
        inertia=file.inertia,
        source=Source(*(getattr(source, f.name) for f in fields(Source))),
        tables=file.table,
        uncertainty=file.uncertainty,
        columns=file.columns,
        options=file.importer,
        lines=lines,
        planar_motion=file.planar_motion,
        symmetry=head.symmetry,
        assumed=axes.assumed,
        notes="" if head.notes is None else Verbatim(head.notes),
    )
