"""A plan, and the study that it becomes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.finding import Severity
from coeflab.core.several import ByName, Several
from coeflab.core.table import Check
from coeflab.core.types import brief, in_angles, locking

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.triangulation import Triangulation
    from coeflab.core.axes import Datum
    from coeflab.core.provenance import InputFile
    from coeflab.estimates import Estimates
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.formats.export import Export, PlannedExport, Refused
    from coeflab.law.coefficient import Coefficient
    from coeflab.law.scaling import Conditions, Scaling
    from coeflab.motion.manoeuvre import PlannedManoeuvre, Simulation
    from coeflab.motion.uncertainty.uncertainty import Carried
    from coeflab.tables.force_table import ForceTable
    from coeflab.tables.importers import PlannedTable
    from coeflab.vehicle.from_shape import Weighed
    from coeflab.vehicle.gathered import PlannedParameterFile
    from coeflab.vehicle.parameter_file import ParameterFile
    from coeflab.vehicle.published_values import Comparison, Reference


@brief
@dataclass(frozen=True, slots=True)
class PlannedJoint:
    """One ``[[joint]]``: one fit over several tables or campaigns."""

    tables: tuple[PlannedTable, ...]
    fit: str
    options: Mapping[str, Any] = field(default_factory=dict)


@brief
@dataclass(frozen=True, slots=True)
class PlannedTow:
    """One ``[[tow]]``: a body of which every wanted coefficient is to come from our own computations.

    Attributes
    ----------
    name, body : str
    campaign : str
        Name of the campaign that is there; empty where none is.
    absent : tuple of str
        Folders that were looked for and are not there.
    fourfold : bool
        A quarter of a turn about x leaves the body as it is, so that derivatives of attack are stated from those of drift.
    experiment, columns : tuple of str
        References that hold the tests to compare with, and published columns to print.
    note : str
    added : Path or None
        Of the campaign where no ``[[table]]`` names it.
    """

    name: str
    body: str
    campaign: str = ""
    absent: tuple[str, ...] = ()
    fourfold: bool = False
    experiment: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    note: str = ""
    added: Path | None = None


@brief
@dataclass(frozen=True, slots=True)
class PlannedConversion:
    """One ``[[conversion]]``: a campaign that holds the numbers of another in other units, axes or about another point.

    Attributes
    ----------
    campaign : Path
    of : str
        Name of the other, among the campaigns of the plan's tables.
    """

    campaign: Path
    of: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """A table and the one that it is a copy of, both about the plan's reference point."""

    copy: ForceTable
    original: ForceTable


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("reference_point")
class Plan:
    """What to do, with paths resolved.

    Attributes
    ----------
    name, title : str
    reference_point : (3,) array or None
        m, FRD, from the datum; None leaves every campaign where it is.
    datum : Datum or None
        From which the reference point counts; None takes each campaign's own.
    scaling : Scaling or None
        None keeps each campaign's own length.
    conditions : Conditions or None
        For dimensional values; None takes the first campaign's.
    body : Path or None
    tables : tuple of PlannedTable
    joint : tuple of PlannedJoint
        Fits over several campaigns, after those of the tables.
    references : tuple of Path
    parameter_files : tuple of PlannedParameterFile
    exports : tuple of PlannedExport
    manoeuvres : tuple of PlannedManoeuvre
    wanted : tuple of str
        Coefficients that must appear, with a status if no table gives them.
    include_uncertain : bool
        Use cells that their source marks as doubtful.
    file : InputFile or None
    tows : tuple of PlannedTow
        Their campaigns are among the tables.
    command : str
        What was typed, of a plan that no file holds; paths by their last name.
    conversions : tuple of PlannedConversion
    """

    name: str
    title: str
    tables: tuple[PlannedTable, ...]
    reference_point: NDArray[np.float64] | None = None
    datum: Datum | None = None
    scaling: Scaling | None = None
    conditions: Conditions | None = None
    body: Path | None = None
    references: tuple[Path, ...] = ()
    parameter_files: tuple[PlannedParameterFile, ...] = ()
    exports: tuple[PlannedExport, ...] = ()
    wanted: tuple[str, ...] = ()
    include_uncertain: bool = False
    file: InputFile | None = None
    joint: tuple[PlannedJoint, ...] = ()
    hull: Path | None = None
    method: str = "all"
    manoeuvres: tuple[PlannedManoeuvre, ...] = ()
    tows: tuple[PlannedTow, ...] = ()
    command: str = ""
    conversions: tuple[PlannedConversion, ...] = ()


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FromShape:
    """What a study of a shape without tables rests on.

    Attributes
    ----------
    weighed : Weighed
        The body with its mass, and what is assumed.
    estimates : Estimates
    conditions : Conditions
    statements : tuple of str
        Mass against displacement, then what is assumed.
    missing : tuple of str
        For a manoeuvre under way, with what to write.
    carried : tuple of Carried
        The uncertainty of the estimates through the first manoeuvre; none where it shows nothing.
    """

    weighed: Weighed
    estimates: Estimates
    conditions: Conditions
    statements: tuple[str, ...]
    missing: tuple[str, ...] = ()
    carried: tuple[Carried, ...] = ()


TOGETHER = ("tables", "fits", "missing", "references", "comparisons", "inputs", "budgets", "checks", "exports", "refused",
            "manoeuvres")  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """Everything that a run found; export and report are two leaves of this one object.

    ``parameter_files`` and ``hulls``, the added mass of those that have one, go by the name of the file. ``refused`` are
    planned exports that were not made; all else stands. ``conversions`` are read to be compared, never fitted. ``unfitted`` says of the campaign of a tow why a fit of it could not
    be made. ``shape`` is there where no table is: then the fit is that of the estimates.

    Nouns of one kind are `Several` and `ByName`, whatever tuple or mapping they were given as: a tuple and a mapping that
    take names as well, ``study.coefficients["Yv"]``, and show themselves in a notebook.
    """

    plan: Plan
    tables: tuple[ForceTable, ...]
    fits: tuple[FitResult, ...]
    missing: tuple[Coefficient, ...]
    body: Body | None
    references: tuple[Reference, ...]
    comparisons: tuple[Comparison, ...]
    parameter_files: Mapping[str, ParameterFile]
    inputs: tuple[InputFile, ...]
    budgets: tuple[Budget, ...] = ()
    checks: tuple[Check, ...] = ()
    hulls: Mapping[str, Triangulation] = field(default_factory=dict)
    exports: tuple[Export, ...] = ()
    refused: tuple[Refused, ...] = ()
    manoeuvres: tuple[Simulation, ...] = ()
    unfitted: Mapping[str, str] = field(default_factory=dict)
    shape: FromShape | None = None
    conversions: tuple[Conversion, ...] = ()

    def __post_init__(self) -> None:
        for name in TOGETHER:
            object.__setattr__(self, name, Several(getattr(self, name)))
        for name in ("unfitted", "parameter_files", "hulls"):
            object.__setattr__(self, name, ByName(getattr(self, name)))

    def __repr__(self) -> str:
        judged = [c.passed for c in self.comparisons if c.passed is not None]
        valued = sum(c.value is not None for c in self.coefficients)
        agree = f", {sum(judged)} of {len(judged)} published values within U95" if judged else ""
        files = f", {len(self.parameter_files)} parameter files" if self.parameter_files else ""
        return in_angles(self, f"{self.plan.name}: {valued} coefficients by {len(self.fits)} fits{agree}{files}")

    def _repr_html_(self) -> str:
        """Its answer with pictures, for notebooks."""
        return html_by("study", self)

    @property
    def coefficients(self) -> Several[Coefficient]:
        """All fitted coefficients in the plan's order, then those that no table gives."""
        return Several((*(c for f in self.fits for c in f.coefficients.coefficients), *self.missing))

    @property
    def by_body(self) -> Mapping[str, tuple[str, ...]]:
        """Wanted coefficients of each body where every one has others, as campaigns of one body with two names have.

        Empty where one body has them all, or two have the same.
        """
        valued = [
            c for c in self.coefficients if c.origin == "fit" and c.value is not None and c.symbol in self.plan.wanted
        ]
        bodies = {
            b: tuple(dict.fromkeys(c.symbol for c in valued if c.body == b))
            for b in dict.fromkeys(c.body for c in valued)
        }
        apart = len(bodies) > 1 and sum(map(len, bodies.values())) == len({c.symbol for c in valued})
        return {b: s for b, s in bodies.items() if b} if apart else {}

    @property
    def failed(self) -> bool:
        """Whether a finding or a comparison fails, or an export was refused."""
        findings = any(c.severity is Severity.FAIL for c in self.checks)
        return findings or any(c.passed is False for c in self.comparisons) or bool(self.refused)

    @property
    def warned(self) -> bool:
        """Whether a finding is a warning."""
        return any(c.severity is Severity.WARN for c in self.checks)

    def with_checks(self, checks: tuple[Check, ...]) -> Study:
        """The study with its findings."""
        return replace(self, checks=checks)
