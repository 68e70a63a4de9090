"""What a campaign.toml declares about its tables.

What a campaign declares about the uncertainty of its inputs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import Axes, Datum, parse_axes, read_datum
from coeflab.core.provenance import TABLE_KINDS, Source, read_source
from coeflab.core.text.toml import Section, read_toml
from coeflab.core.types import brief, locked
from coeflab.core.wording import Verbatim
from coeflab.law.scaling import Conditions, Scaling, read_conditions, read_scaling

SECTION = "uncertainty"
# Beyond these an input is a mistyped unit (per cent for a share, degrees for radians) or no measurement.
LARGEST_RELATIVE = 0.5
LARGEST_ANGLE = 0.0873  # 5 deg


@dataclass(frozen=True, slots=True)
class InputUncertainty:
    """95 % half-widths of errors that all points of a campaign share; None where nothing was declared.

    Attributes
    ----------
    angle : float or None
        Offset of every set angle, rad.
    rate : float or None
        Of every set rate, relative.
    speed : float or None
        Relative.
    force, moment : float or None
        Calibration, relative.
    reference_point : float or None
        Of the point that moments and rates refer to, along x, m.
    length : float or None
        Of the length of the primes, relative.
    density : float or None
        Relative.
    """

    angle: float | None = None
    rate: float | None = None
    speed: float | None = None
    force: float | None = None
    moment: float | None = None
    reference_point: float | None = None
    length: float | None = None
    density: float | None = None

    @property
    def declared(self) -> tuple[str, ...]:
        """Names of the inputs with a half-width."""
        return tuple(n for n in NAMES if getattr(self, n) is not None)


NAMES = tuple(f.name for f in fields(InputUncertainty))
DIMENSIONS = {"angle": "angle", "reference_point": "length"}


def read_input_uncertainty(section: Section) -> InputUncertainty | None:
    """Read ``[uncertainty]`` of a campaign.toml: 95 % half-widths in SI or as texts with a unit (``"0.1 deg"``).

    Returns
    -------
    InputUncertainty or None
        None where the section is absent or empty: not assessed, which is not zero.

    Raises
    ------
    InputError
        An unknown key, a half-width that is not above zero, or a relative one above one half.
    """
    if not section.content:
        return None
    found: dict[str, float] = {}
    for name in NAMES:
        section.raw(name)
    for name in NAMES:
        dimension = DIMENSIONS.get(name, "none")
        value = section.optional_quantity(name, dimension)
        if value is None:
            continue
        if not value > 0.0:
            raise section.fail(
                name, f"{value:g}", "a 95 % half-width above zero", "Leave the key out where it was not assessed."
            )
        if name == "angle" and value > LARGEST_ANGLE:
            raise section.fail(
                name, f"{value:g} rad", "a half-width up to 5 deg", 'A bare number is in rad; write "0.1 deg".'
            )  # fmt: skip
        if dimension == "none" and value > LARGEST_RELATIVE:
            raise section.fail(
                name, f"{value:g}", "a relative half-width up to 0.5", "One per cent is 0.01."
            )  # fmt: skip
        found[name] = value
    section.finish()
    return InputUncertainty(**found)


FILE = "campaign.toml"


@brief
@dataclass(frozen=True, slots=True)
class Inertia:
    """Mass properties of the towed model, for forces that contain its inertia.

    Attributes
    ----------
    mass : float
        kg.
    centre : tuple of 3 floats
        Centre of gravity, m, FRD, from the datum.
    tensor : tuple of 3 floats
        Ix Iy Iz about the centre of gravity, kg m^2.
    """

    mass: float
    centre: tuple[float, float, float]
    tensor: tuple[float, float, float]


@brief
@dataclass(frozen=True, slots=True)
class TableDeclaration:
    """One ``[[table]]`` of a campaign.

    Attributes
    ----------
    file : str
    sha256 : str
        Expected hash, or empty.
    contains_inertia : bool or None
        None where it was not declared.
    labels, ignore : tuple of str
        Columns that name rows, and columns to skip.
    select : mapping of str to str
        Only rows with this text in that label column enter fits.
    select_reason : str
    cells : str
        Column with the cells of the grid that computed each row, or empty.
    """

    file: str
    sha256: str
    contains_inertia: bool | None
    labels: tuple[str, ...]
    ignore: tuple[str, ...]
    select: Mapping[str, str]
    select_reason: str
    cells: str = ""


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Campaign:
    """A folder of tables from one test or one set of computations."""

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
    half_model: bool
    inertia: Inertia | None
    source: Source
    tables: tuple[TableDeclaration, ...]
    uncertainty: InputUncertainty | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "signs", MappingProxyType(dict(self.signs)))
        object.__setattr__(self, "reference_point", locked(self.reference_point))


def _inertia(section: Section) -> Inertia | None:
    if not section.content:
        return None
    centre = section.point("centre_of_gravity")
    out = Inertia(
        section.positive("mass", "mass"),
        (float(centre[0]), float(centre[1]), float(centre[2])),
        section.triple("inertia", "inertia"),
    )
    section.finish()
    return out


def _tables(root: Section) -> tuple[TableDeclaration, ...]:
    out = []
    for t in root.sections("table"):
        select = t.section("select", required=False)
        chosen = {k: str(select.raw(k)) for k in select.content if k != "reason"}
        out.append(
            TableDeclaration(
                file=t.text("file"),
                sha256=t.text("sha256", ""),
                contains_inertia=t.flag("contains_inertia") if t.has("contains_inertia") else None,
                labels=t.texts("labels"),
                ignore=t.texts("ignore"),
                select=MappingProxyType(chosen),
                select_reason=select.text("reason", "not selected by the campaign"),
                cells=t.text("cells", ""),
            )
        )
        t.raw("source_sha256")
        t.finish()
    if not out:
        raise root.fail("table", "no [[table]]", "at least one table", 'Add [[table]] with file = "table.csv".')
    return tuple(out)


def read_campaign(path: Path) -> Campaign:
    """Read and check a campaign.toml.

    Parameters
    ----------
    path : Path
        The file itself.

    Raises
    ------
    InputError
        Anything missing, unknown or inconsistent, by file and key.
    """
    root = read_toml(path)
    head = root.section("campaign")
    axes = root.section("axes")
    scaling = root.section("scaling")
    conditions = root.section("conditions")
    source = root.section("source")
    campaign = Campaign(
        path=path,
        name=Verbatim(head.text("name", path.parent.name)),
        title=head.text("title"),
        body=head.text("body"),
        importer=head.text("importer", "csv"),
        axes=parse_axes(axes.raw("frame"), path),
        signs={k: str(axes.text(k)) for k in ("alpha", "beta") if axes.has(k)},
        datum=read_datum(axes),
        reference_point=axes.point("reference_point"),
        scaling=read_scaling(scaling),
        conditions=read_conditions(conditions),
        half_model=head.flag("half_model", False),
        inertia=_inertia(root.section("inertia", required=False)),
        source=read_source(source, TABLE_KINDS, required=True),
        tables=_tables(root),
        uncertainty=read_input_uncertainty(root.section("uncertainty", required=False)),
    )
    for optional in ("appendages", "reynolds", "notes", "configuration", "date"):
        head.raw(optional)
        conditions.raw(optional)
    source.raw("sha256")
    source.raw("url")
    for section in (head, axes, scaling, conditions, source, root):
        section.finish()
    return campaign
