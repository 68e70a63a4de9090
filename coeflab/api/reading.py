"""`read_table` and `read_tables`: forces from a file, arrays, runs of a solver or a shipped campaign."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coeflab.api.importing import column_maps, filled_in
from coeflab.api.questions import KEYS, in_keywords, open_questions, settings_of
from coeflab.api.table import OscillatingTable, Table
from coeflab.core.errors import InputError, shown, together
from coeflab.core.files import located
from coeflab.core.keywords import all_spoken
from coeflab.core.texts import input_error
from coeflab.core.wording import identifier
from coeflab.tables import reading
from coeflab.tables.campaign import FILE
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.in_memory import raw_of_columns, tables_of
from coeflab.tables.parts import Part, read_parts, require_parts, stated_together, with_shared_words
from coeflab.tables.planar_motion import PlanarMotionTable
from coeflab.tables.settings import assumed
from coeflab.tables.several_tables import complaints_of, form_together, is_pending, settled_together

if TYPE_CHECKING:
    import pandas as pd


Source = "str | Path | pd.DataFrame | Mapping[str, Any] | ForceTable"
SYMBOLS = {
    "rho": "density",
    "U": "speed",
    "V": "speed",
    "L": "length",
    "nu": "viscosity",
    "point": "about",
    "half": "half_model",
}
ARRAYS = "columns"  # the importer of arrays, as the form names it


def read_table(
    source: str | Path | pd.DataFrame | Mapping[str, Any] | ForceTable,
    *,
    frame: str | Sequence[str] | None = None,
    alpha: str | None = None,
    beta: str | None = None,
    about: str | float | Sequence[float] | None = None,
    datum: str | None = None,
    length: float | str | None = None,
    length_name: str | None = None,
    density: float | str | None = None,
    speed: float | str | None = None,
    viscosity: float | str | None = None,
    half_model: bool | str | None = None,
    symmetry: str | Sequence[str] | None = None,
    centre: str | None = None,
    arm_point: str | float | Sequence[float] | None = None,
    contains_inertia: bool | None = None,
    mass: float | str | None = None,
    centre_of_gravity: str | float | Sequence[float] | None = None,
    inertia: Sequence[float] | None = None,
    area: float | str | None = None,
    moment_length: float | str | None = None,
    units: str | None = None,
    columns: Mapping[str, str] | None = None,
    body: str | None = None,
    kind: str | None = None,
    citation: str | None = None,
    name: str | None = None,
    table: str | None = None,
    importer: str = "",
    options: Mapping[str, Any] | None = None,
    accept: bool = False,
    **also: Any,
) -> Table:
    """Forces over settings, in SI and FRD about one point.

    A file that says everything, such as a campaign with its campaign.toml, needs no keyword. Of anything else the keywords
    answer what ``coeflab import`` asks; nothing is assumed. Nothing is written.

    Parameters
    ----------
    source : str, Path, DataFrame or mapping of str to array_like
        A text table, sheet, case or folder of runs that an importer knows; a campaign; the name of a shipped one; arrays by
        headers such as ``"Y [N]"``.
    frame : str or sequence of str, optional
        Axes of the columns: FRD, FLU, CFD, or where x, y and z point.
    alpha, beta : {"+", "-"} or formula, optional
        Sign of an angle: ``"+"`` of beta is v = +U sin(beta), v to starboard, of alpha w = +U sin(alpha), w down, whatever `frame` is.
    about : str, float or (3,) sequence, optional
        Point of the moments: ``"nose, 1.0 m aft"``, ``"-1.0 from nose"``, or x or x, y, z from `datum`, m, x forward.
    datum : str, optional
        Point of the body that places count from, where `about` does not name it.
    length : float or str, optional
        Of the primes, m, or ``"4.356 m LOA"``.
    length_name : str, optional
        Which length that is.
    density, speed, viscosity : float or str, optional
        kg/m^3, m/s, m^2/s.
    half_model : bool or str, optional
        ``starboard``, ``port``, ``upper`` or ``lower`` where forces are those of a half.
    symmetry : str or sequence of str, optional
        ``port-starboard``, ``up-down``, ``fourfold``: what the body is exactly.
    centre : str, optional
        Of a rotating arm: side on which the centre of the circle lies.
    arm_point : str, float or (3,) sequence, optional
        Point that runs with the speed U; ``"reference point"``.
    contains_inertia : bool, optional
        Whether forces hold the model's own inertia, which is then taken out.
    mass : float or str, optional
        Of the model, kg.
    centre_of_gravity : str, float or (3,) sequence, optional
        Of the model, as `about`.
    inertia : (3,) sequence of float, optional
        Ix, Iy, Iz about it, kg m^2.
    area, moment_length : float or str, optional
        What makes coefficients of the forces, m^2 and m; ``"prime"``: the length.
    units : {"SI", "US"}, optional
        Of columns that state none: m, m/s, N; or ft, ft/s, lbf.
    columns : mapping of str to str, optional
        What a column is: ``{"Fy": "Y [N]", "psi": "-beta [deg]", "run": "label", "note": "ignore"}``.
    body, kind, citation, name : str, optional
        Which configuration, what the numbers are (experiment, cfd ...), their source, a name of the table.
    table : str, optional
        Which of several tables: sheet, file of the campaign or group of runs.
    importer : str
        The one that reads it, where its content does not tell.
    options : mapping, optional
        Of the importer.
    accept : bool
        Take what the file offers and the numbers show, axes and signs too, as ``coeflab import --accept`` does; not
        `contains_inertia`, which no number shows and which turns the sign of Yr'.
    **also
        `axes` and `unit` are `frame` and `units`, as `coeflab.read_body` calls them.

    Returns
    -------
    Table
        A cell that is no number is left out of its row's component: `exclusions` has the row, and `notes` a line.

    Raises
    ------
    InputError
        Nothing there, nothing an importer knows, several tables, a wrong unit; or what nobody said, by keyword.

    Examples
    --------
    >>> import coeflab as cf
    >>> import numpy as np
    >>> v = np.linspace(-0.3, 0.3, 9)
    >>> drift = cf.read_table(
    ...     {"v [m/s]": v, "Y [N]": -120.0 * v, "N [N m]": -60.0 * v}, name="drift",
    ...     frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft",
    ... )
    >>> len(drift), drift.varies, [float(x) for x in drift.reference_point]
    (9, ('v',), [-1.0, 0.0, 0.0])
    """
    words = {
        k: v
        for k, v in locals().items()
        if k not in ("source", "columns", "name", "table", "importer", "options", "accept", "also")
    } | also
    found = tables_from(source, words, columns or {}, name, importer, options or {}, accept)
    if table is not None:
        own_names = [t.name.rpartition("/")[2] for t in found]
        chosen = [t for t, n in zip(found, own_names, strict=True) if table in (n, Path(n).stem, t.name)]
        if not chosen:
            raise InputError(
                f"no table {shown(table)}", f"one of {', '.join(own_names)}", file=_called(source), column="table"
            )
        return chosen[0]
    if len(found) > 1:
        names = ", ".join(t.name.rpartition("/")[2] for t in found)
        raise input_error(
            "front_door.table_one", _called(source), column="table", count_of_found=len(found), names=names,
        )  # fmt: skip
    return found[0]


def read_tables(
    source: str | Path | pd.DataFrame | Mapping[str, Any] | ForceTable | PlannedTable,
    *,
    columns: Mapping[str, str] | None = None,
    name: str | None = None,
    importer: str = "",
    options: Mapping[str, Any] | None = None,
    accept: bool = False,
    **keywords: Any,
) -> tuple[Table, ...]:
    """All tables of a workbook, a folder of runs or a campaign.

    Parameters
    ----------
    source, columns, name, importer, options, accept, **keywords
        As of `read_table`.

    Returns
    -------
    tuple of Table

    Raises
    ------
    InputError
        As `read_table`; an unknown keyword.

    Examples
    --------
    >>> import coeflab as cf
    >>> [t.name for t in cf.read_tables("suboff_roddy_2")]
    ['suboff_roddy_2/table.csv']
    """
    return tables_from(source, keywords, columns or {}, name, importer, options or {}, accept)


def tables_from(
    source: Any, keywords: Mapping[str, Any], columns: Mapping[str, str], name: str | None, importer: str,
    options: Mapping[str, Any], accept: bool,
) -> tuple[Table, ...]:  # fmt: skip
    """The tables of anything that is one.

    Parameters
    ----------
    source, columns, name, importer, options, accept
        As of `read_table`.
    keywords : mapping of str to object
        Its other keywords; None says nothing.
    """
    keywords = _keywords(keywords)
    stated = {k: v for k, v in keywords.items() if v is not None}
    if isinstance(source, ForceTable | PlannedTable):
        _require_nothing(stated, columns, "a table that was read")
        read = (source,) if isinstance(source, ForceTable) else reading.read_tables(source)
        return tuple(map(table_of, read))
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        raw = raw_of_columns(source, f"<{name or 'table'}>")
        return _filled_in((Part("", raw, ARRAYS, {}),), (), keywords, columns, identifier(name or "table"), accept)
    if not isinstance(source, str | Path):
        raise input_error("front_door.path_name_shipped", column="source", __name__=type(source).__name__)
    path = located(source, "cfd_data")
    if _is_campaign(path) and not importer:
        _require_nothing(stated, columns, f"{path}, whose {FILE} says everything")
        return tuple(map(table_of, reading.read_tables(reading.table_at(path))))
    parts, chosen = read_parts(path, importer, options)
    parts = with_shared_words(parts)
    return _filled_in(parts, chosen, keywords, columns, identifier(name or path.resolve().stem), accept)


def table_of(read: ForceTable) -> Table:
    """A force table with the front door's methods."""
    if isinstance(read, Table):
        return read
    kind = OscillatingTable if isinstance(read, PlanarMotionTable) else Table
    return kind(**{f.name: getattr(read, f.name) for f in fields(read)} | {"notes": all_spoken(read.notes)})


def _called(source: Any) -> str:
    return str(source) if isinstance(source, str | Path) else "source"


def _is_campaign(path: Path) -> bool:
    """Whether a campaign.toml declares it."""
    if path.is_dir():
        return (path / FILE).is_file()
    if path.suffix == ".toml":
        return True
    if not (path.parent / FILE).is_file():
        return False
    from coeflab.tables.campaign import read_campaign

    return path.name in [t.file for t in read_campaign(path.parent / FILE).tables]


def _require_nothing(stated: Mapping[str, Any], columns: Mapping[str, str], what: str) -> None:
    if names := [*stated, *["columns"] * bool(columns)]:
        raise InputError(f"{', '.join(names)} with {what}", "no keyword about its content", column=names[0])


def _filled_in(
    parts: Sequence[Part],
    chosen: Sequence[Any],
    keywords: Mapping[str, Any],
    columns: Mapping[str, str],
    name: str,
    accept: bool,
) -> tuple[Table, ...]:
    """Raw tables, filled in by what is said; complaints about what nobody said."""
    source = str(parts[0].raw.path) if len(parts) == 1 else str(parts[0].raw.path.parent)
    known = settings_of(keywords)
    maps = column_maps(columns, parts, "columns", 'columns["{name}"]', source, source)
    require_parts(known, parts)
    settings = {**assumed(Path(name)), **stated_together(parts), **known}
    whole = source if len(parts) > 1 else ""
    founds, settled = settled_together(parts, maps, settings, accept, whole)
    if complaints := complaints_of(founds):
        raise in_keywords(together(complaints), source)
    if is_pending(parts, founds) or (chosen and not accept):
        lines = form_together(parts, founds, settings, [one.line for one in chosen] if not accept else [], None, whole)
        raise open_questions(lines, source, [p.name for p in parts])
    try:
        return tuple(map(table_of, tables_of(filled_in(parts, founds, settled))))
    except InputError as why:
        raise in_keywords(why, source) from None


def _keywords(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """What is said by the names of the keywords; ``axes`` and ``unit``, as of `coeflab.read_body`, are ``frame`` and ``units``.

    Raises
    ------
    InputError
        A keyword that there is not, with the one that is near.
    """
    out: dict[str, Any] = {}
    complaints = []
    for given, value in keywords.items():
        keyword = {"axes": "frame", "unit": "units"}.get(given, given)
        if keyword not in KEYS:
            near = SYMBOLS.get(given) or next(iter(get_close_matches(given, KEYS, 1)), "")
            complaints.append(input_error(
                "front_door.unknown_keyword", column=given, given=given, keys=", ".join(KEYS),
                advice=f"Did you mean {near}?" if near else "",
            ))  # fmt: skip
        elif out.get(keyword) is None:
            out[keyword] = value
        elif value is not None:
            complaints.append(InputError(f"{keyword} and {given}", "one of both, which are one", column=given))
    if complaints:
        raise together(complaints)
    return out
