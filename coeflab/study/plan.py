"""Reading a plan.toml."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.axes import Datum, DatumName
from coeflab.core.errors import InputError, shown
from coeflab.core.files import located, named, shipped, stem, typed
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.fits import BY_DEFAULT, JOINT
from coeflab.formats.export import PlannedExport
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import derivative
from coeflab.motion.manoeuvre import PlannedManoeuvre
from coeflab.study.study import Plan, PlannedConversion, PlannedJoint, PlannedTow
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.reading import suited_fit, table_at
from coeflab.tables.settings import of_datum, read_settings
from coeflab.tables.words.points import POINT_OF
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.inertia import ACCELERATIONS, MEASURED
from coeflab.vehicle.schema_versions import SHIPPED

_NAME = re.compile(r"^[\w][\w .+-]{0,79}$")


def _no_file_name(name: str) -> str:
    fits = _NAME.fullmatch(name) and name.strip(". ") == name
    return "" if fits else "letters, digits, blank, . + - _ (it names files), at most 80"


FileName = Annotated[takes.Text, takes.Within(_no_file_name, schema={"pattern": _NAME.pattern})]
CampaignPath = Annotated[Path, takes.located_in("cfd_data")]
BodyPath = Annotated[Path, takes.located_in("geometry")]
Accelerations = Annotated[str, takes.one_of(*ACCELERATIONS)]


def _several(value: Any, file: Path) -> tuple[Path, ...]:
    names = takes.TEXTS.read(value, file)
    if len(names) < 2:
        raise InputError(shown(list(names)), "the paths of two or more campaigns")
    return tuple(located(name, "cfd_data", file.parent) for name in names)


def _derivatives(value: Any, file: Path) -> tuple[str, ...]:
    names: tuple[str, ...] = takes.TEXTS.read(value, file)
    for name in names:
        derivative(name)
    return names


def _parameters(value: Any, file: Path) -> Path:
    name = takes.text_of(value, file)
    found = typed(file.parent / name)
    return found if found.is_file() else named(name, SHIPPED)


class Place(NamedTuple):
    """A point and the id of what it counts from, empty where that is not named."""

    point: Array
    datum: str = ""


def _place(value: Any, file: Path) -> Place:
    """A list, or words as readers of tables take them: ``-1.6 from nose``, ``midship``."""
    if not isinstance(value, str):
        return Place(np.array(takes.POINT.read(value, file)))
    given = read_settings(POINT_OF, value)
    return Place(np.array(given[POINT_OF], dtype=float), given.get("axes.datum", ""))


Options = Annotated[Mapping[str, Any], takes.TABLE]


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyKeys(takes.Declaration):
    """The study as a whole.

    Attributes
    ----------
    name : str
        Of the folder of the results.
    title : str
        As the report prints it; the name unless given.
    reference_point : Place
        [x, y, z] of all moments, m, FRD, from the datum, or in words "-1.6 from nose"; each campaign's own unless given. The rows of the
        tables are moved there and fitted.
    datum : str
        Id of the point of the body that the reference point counts from; each campaign's own unless given.
    datum_note : str
        Where it is, in free words.
    wanted : tuple of str
        Derivatives that must appear, with a status where no table gives them.
    include_uncertain : bool
        Use cells that their source marks as doubtful.
    """

    name: FileName
    title: takes.Words | None = None
    reference_point: (
        Annotated[Place, takes.Takes(takes.POINT_WORDS, _place, {"anyOf": [takes.POINT.schema, {"type": "string"}]})]
        | None
    ) = None
    datum: DatumName | None = None
    datum_note: takes.Words | None = None
    wanted: Annotated[tuple[str, ...], takes.Takes("a list of texts", _derivatives, takes.TEXTS.schema)] = ()
    include_uncertain: takes.Flag = False

    def check(self) -> None:
        """A note goes with a datum, and one datum with a point."""
        named = self.reference_point.datum if self.reference_point else ""
        if named and self.datum is not None and not of_datum(named, self.datum):
            raise input_error(
                "study.point_beside_datum", column="reference_point", named=shown(named), datum=shown(self.datum)
            )
        if self.datum_note is not None and not (self.datum or named):
            raise InputError("a note without a datum", "datum, the id that it explains", column="datum_note")


@dataclass(frozen=True, slots=True)
class BodyKeys(takes.Declaration):
    """The vehicle.

    Attributes
    ----------
    path : Path
        Of its body.toml, or a shipped name.
    """

    path: BodyPath


@dataclass(frozen=True, slots=True)
class AddedMassKeys(takes.Declaration):
    """The shape whose added mass is computed.

    Attributes
    ----------
    body : Path
        Of its body.toml, or a shipped name.
    method : str
        ``all`` recommends one by the stated rule, else a method's name.
    """

    body: BodyPath
    method: takes.Words = "all"


@dataclass(frozen=True, slots=True)
class TableKeys(takes.Declaration):
    """A campaign and its fits.

    Attributes
    ----------
    campaign : Path
        Folder of the campaign, its campaign.toml, one CSV of it, or a shipped name.
    fits : tuple of str
        Names of fits, slope_at_origin and tied_law unless given; ``coeflab formats`` lists them.
    options : mapping
        A table of options for each fit, by its name.
    speed : float or None
        m/s; only rows of this speed, within 2 %, enter the fits: where a slope depends on the speed, one fit a speed.
    """

    campaign: CampaignPath
    fits: takes.Texts = ()
    options: Options = field(default_factory=dict)
    speed: Annotated[takes.Speed, takes.ABOVE_ZERO] | None = None

    def check(self) -> None:
        """Options are those of the fits."""
        for name, options in self.options.items():
            if not isinstance(options, dict):
                raise InputError(shown(options), f"a table [table.options.{name}]", column=f"options.{name}")
        idle = next((name for name in self.options if name not in self.used), None)
        if idle is not None:
            found, expected = (
                f"options of {shown(idle)}, which is not among the fits",
                f"options of {', '.join(self.used)}",
            )
            raise InputError(found, expected, column="options")

    @property
    def used(self) -> tuple[str, ...]:
        """The fits."""
        return self.fits or BY_DEFAULT


@dataclass(frozen=True, slots=True, kw_only=True)
class JointKeys(takes.Declaration):
    """One fit over several campaigns.

    Attributes
    ----------
    campaigns : tuple of Path
        Two or more, each as in ``[[table]]``.
    fit : str
        Name of the fit.
    options : mapping
        Of the fit.
    """

    campaigns: Annotated[
        tuple[Path, ...], takes.Takes("a list of texts", _several, takes.TEXTS.schema | {"minItems": 2})
    ]
    fit: takes.Words = JOINT
    options: Options = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterFileKeys(takes.Declaration):
    """A parameter file to be written.

    Attributes
    ----------
    name : str
        Of the file.
    body : str
        Configuration that it is about.
    campaigns, literature : tuple of str
        Campaigns and kinds of published values that its coefficients come from.
    added_mass : Path
        The body.toml of its added mass, or a shipped name.
    added_mass_method : str
        ``all`` recommends one by the stated rule, else a method's name.
    base : Path
        A parameter file, or the name of a shipped one: what the campaigns do not give is as it is there, such as mass, buoyancy
        and thrusters.
    """

    name: FileName
    body: takes.Text
    campaigns: takes.Texts = ()
    literature: takes.Texts = ()
    added_mass: BodyPath | None = None
    added_mass_method: takes.Words = "all"
    base: Annotated[Path, takes.Takes("a text", _parameters, {"type": "string"})] | None = None


@dataclass(frozen=True, slots=True)
class ReferencesKeys(takes.Declaration):
    """Published values to compare with.

    Attributes
    ----------
    path : Path
        Of a published.toml.
    """

    path: CampaignPath


@dataclass(frozen=True, slots=True)
class ExportKeys(takes.Declaration):
    """Files for a simulator.

    Attributes
    ----------
    to : str
        The target; ``coeflab formats`` lists them.
    accept_loss : bool
        Write the files where the target cannot hold everything.
    strict : bool
        Refuse any loss.
    accelerations : {"measured", "computed"}
        Measured acceleration derivatives where they leave an inertia, or the computed added mass alone.
    """

    to: takes.Text
    accept_loss: takes.Flag = False
    strict: takes.Flag = False
    accelerations: Accelerations = MEASURED


@dataclass(frozen=True, slots=True)
class ManoeuvreKeys(takes.Declaration):
    """A manoeuvre to be simulated.

    Attributes
    ----------
    parameter_file : str
        Name of a parameter file of the study.
    name : str
        Of the manoeuvre; ``coeflab formats`` lists them.
    options : mapping
        Of the manoeuvre.
    accelerations : {"measured", "computed"}
        Measured acceleration derivatives where they leave an inertia, or the computed added mass alone.
    """

    parameter_file: takes.Text
    name: takes.Text
    options: Options = field(default_factory=dict)
    accelerations: Accelerations = MEASURED


@dataclass(frozen=True, slots=True)
class ConversionKeys(takes.Declaration):
    """A campaign that holds the numbers of another in other units, axes or about another point: primes must agree row by row.

    Attributes
    ----------
    campaign : Path
        As in ``[[table]]``; its rows are compared and not fitted.
    of : str
        Name of the campaign that it is a copy of, one of those of ``[[table]]``.
    """

    campaign: CampaignPath
    of: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TowKeys(takes.Declaration):
    """A body that is towed by our own computations, each wanted coefficient beside what is published of it.

    Attributes
    ----------
    name : str
        Of the body, as tables print it.
    body : str
        Configuration that it is.
    campaigns : tuple of str
        Folders of campaigns as in ``[[table]]``; the first that is there counts, and none has to be.
    fourfold : bool
        Whether a quarter of a turn about x leaves the body as it is: Zw' = Yv', Mw' = -Nv', stated and not run.
    experiment : tuple of str
        Names of references that hold tests to compare with, in that order.
    columns : tuple of str
        Names of references to print beside.
    note : str
        What a reader has to know of the comparison.
    """

    name: takes.Words
    body: takes.Text
    campaigns: takes.Texts
    fourfold: takes.Flag = False
    experiment: takes.Texts = ()
    columns: takes.Texts = ()
    note: takes.Words = ""

    def check(self) -> None:
        """A campaign at least."""
        if not self.campaigns:
            raise InputError("no campaign", "the path of one or more", column="campaigns")


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanFile(takes.Declaration):
    """A plan.toml: a study of tables, or of a body alone by estimates, and what is made of it.

    Attributes
    ----------
    study : table
        The study as a whole.
    scaling : table
        The length of all primes; each campaign's own unless given.
    conditions : table
        Fluid and speed of dimensional values; those of the first campaign unless given.
    body : table
        The vehicle.
    added_mass : table
        The shape whose added mass is computed.
    table : array of tables
        A campaign and its fits, one each.
    joint : array of tables
        A fit over several campaigns.
    parameter_file : array of tables
        A parameter file of some of the campaigns.
    references : array of tables
        Published values to compare with.
    tow : array of tables
        Bodies towed by our own computations, whether their campaigns are there yet or not.
    conversion : array of tables
        Copies of campaigns in other units, axes or about other points, to check the conversion to primes.
    export : array of tables
        Files for a simulator, every target once.
    manoeuvre : array of tables
        A manoeuvre to be simulated.
    """

    study: StudyKeys
    scaling: Annotated[Scaling | None, takes.OrEmpty()] = None
    conditions: Annotated[Conditions | None, takes.OrEmpty()] = None
    body: Annotated[BodyKeys | None, takes.OrEmpty()] = None
    added_mass: Annotated[AddedMassKeys | None, takes.OrEmpty()] = None
    table: tuple[TableKeys, ...] = ()
    joint: tuple[JointKeys, ...] | None = None
    parameter_file: tuple[ParameterFileKeys, ...] = ()
    references: tuple[ReferencesKeys, ...] = ()
    tow: tuple[TowKeys, ...] = ()
    conversion: tuple[ConversionKeys, ...] = ()
    export: tuple[ExportKeys, ...] = ()
    manoeuvre: tuple[ManoeuvreKeys, ...] = ()

    def check(self) -> None:
        """A table or a body at least; parameter files and targets once each."""
        if not self.table and self.joint is None and self.body is None:
            raise input_error("study.least_one_body", column="table")
        names = [f.name.casefold() for f in self.parameter_file]
        for i, f in enumerate(self.parameter_file):
            if names[i] in names[:i]:
                found = f"the parameter file {shown(f.name)} twice"
                raise InputError(found, "a name of its own for each", column=f"parameter_file[{i}].name")
        targets = [e.to for e in self.export]
        for i, target in enumerate(targets):
            if target in targets[:i]:
                raise InputError(f"the target {shown(target)} twice", "every target once", column=f"export[{i}].to")


def _tow(keys: TowKeys, plan: Path, tables: Sequence[Path]) -> PlannedTow:
    """The tow with the first of its campaigns that is there."""
    absent: list[str] = []
    found: Path | None = None
    for name in keys.campaigns:
        try:
            found = located(name, "cfd_data", plan.parent)
        except InputError:
            absent.append(Path(name).name)
            continue
        break
    campaign, added = "", None
    if found is not None:
        campaign = read_campaign(found / FILE if found.is_dir() else found).name
        added = None if any(found.resolve() == t.resolve() for t in tables) else found
    return PlannedTow(
        keys.name, keys.body, campaign, tuple(absent), keys.fourfold, keys.experiment, keys.columns, keys.note, added
    )


def plan_at(place: str | Path) -> Path:
    """The plan.toml that a person means: its path, its folder, or a shipped name such as suboff; of a campaign its campaign.toml.

    Parameters
    ----------
    place : str or Path

    Raises
    ------
    InputError
        No path of a file, and no shipped name.
    """
    path = typed(place)
    inside = shipped("cfd_data") / path.name
    if (
        not path.exists()
        and path == Path(path.name)
        and (inside / FILE).is_file()
        and not (inside / "plan.toml").exists()
    ):
        return inside / FILE
    if not path.is_dir():
        return named(path, "plan.toml")
    return path / FILE if (path / FILE).is_file() and not (path / "plan.toml").exists() else path / "plan.toml"


def names_plan(name: str | Path) -> bool:
    """Whether a plan, a folder with its plan.toml or a shipped plan is meant, and no campaign alone.

    Examples
    --------
    >>> names_plan("suboff"), names_plan("suboff_roddy_2"), names_plan("suboff_bare_hull")
    (True, False, False)
    """
    try:
        path = plan_at(name)
    except InputError:
        return False
    if path.suffix != ".toml" or path.name == FILE or not path.is_file():
        return False
    return "study" in read_toml(path).content


def _of_campaign(path: Path) -> Plan:
    """The plan of a campaign alone: the fit that suits it, slopes at the origin with the law."""
    campaign, suited = read_campaign(path), suited_fit(path.parent)
    fits = BY_DEFAULT if suited in BY_DEFAULT else (suited,)
    return Plan(
        stem(campaign.name), campaign.title, (table_at(path.parent, fits),), file=InputFile(path.name, sha256_of(path))
    )


def read_plan(path: str | Path) -> Plan:
    """Read a plan.

    Parameters
    ----------
    path : str or Path
        The file itself, or the name of a shipped one; paths inside resolve from its folder. A campaign.toml stands for a plan of that campaign alone, by the fit that suits it.

    Raises
    ------
    InputError
        Everything that is wrong, by file, line and key.
    """
    path = named(path, "plan.toml")
    if path.name == FILE:
        return _of_campaign(path)
    file = takes.declared(PlanFile, read_toml(path))
    study = file.study
    datum = study.datum or (study.reference_point.datum if study.reference_point else "")
    tows = tuple(_tow(t, path, [own.campaign for own in file.table]) for t in file.tow)
    return Plan(
        name=study.name,
        title=study.name if study.title is None else study.title,
        tables=(
            *(table_at(t.campaign, t.used, t.options, t.speed) for t in file.table),
            *(table_at(t.added, BY_DEFAULT) for t in tows if t.added is not None),
        ),
        tows=tows,
        conversions=tuple(PlannedConversion(c.campaign, c.of) for c in file.conversion),
        joint=tuple(PlannedJoint(tuple(map(table_at, j.campaigns)), j.fit, j.options) for j in file.joint or ()),
        reference_point=None if study.reference_point is None else study.reference_point.point,
        datum=Datum.named(datum, study.datum_note or "") if datum else None,
        scaling=file.scaling,
        conditions=file.conditions,
        body=None if file.body is None else file.body.path,
        references=tuple(r.path for r in file.references),
        parameter_files=tuple(
            PlannedParameterFile(f.name, f.body, f.campaigns, f.literature, f.added_mass, f.added_mass_method, f.base)
            for f in file.parameter_file
        ),
        exports=tuple(
            PlannedExport(e.to, e.accept_loss, e.strict, e.accelerations, path, f"export[{i}]")
            for i, e in enumerate(file.export)
        ),
        manoeuvres=tuple(
            PlannedManoeuvre(m.parameter_file, m.name, m.options, m.accelerations, path, f"manoeuvre[{i}]")
            for i, m in enumerate(file.manoeuvre)
        ),
        wanted=tuple(w.removesuffix("'") for w in study.wanted or ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")),
        include_uncertain=study.include_uncertain,
        file=InputFile(path.name, sha256_of(path)),
        hull=None if file.added_mass is None else file.added_mass.body,
        method=file.added_mass.method if file.added_mass else "all",
    )
