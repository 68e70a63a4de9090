"""From a path that a person names to tables: which importer knows it, what its file holds, what its campaign makes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.axes import angle_sign
from coeflab.core.errors import InputError, shown
from coeflab.core.files import readable
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.delimited import Cells, read_cells
from coeflab.core.text.model_kinds import model_kind_of
from coeflab.core.texts import input_error
from coeflab.core.wording import Verbatim
from coeflab.tables.campaign import FILE, Campaign, TableDeclaration, read_campaign
from coeflab.tables.conditions import BETWEEN
from coeflab.tables.dialect import is_of_openfoam
from coeflab.tables.evidence import evidence
from coeflab.tables.force_table import STUDIES, ForceTable
from coeflab.tables.importers import IMPORTERS, Importer, PlannedTable
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.tables.mapping import Assigned, assigned, declared_mapping, mapped_table
from coeflab.tables.raw_table import RawTable
from coeflab.tables.runs import find_runs
from coeflab.tables.transposed import upright

Progress = Callable[[str], None]
GENERAL = "table"  # any delimited text: those of one tool come first
MATRIX = "matrix"  # in the column of studies: a row of none
FIRST, CUT = 3, 70  # lines of an unknown text that are shown, and letters of each
OF_RUNS = ("names", "run_list", "state")


def recognised(path: Path) -> tuple[str, ...]:
    """Importers of raw tables or runs that know a file or folder by its content; a tool's own before the general one."""
    known = []
    for name in IMPORTERS.usable() if path.is_file() or path.is_dir() else ():
        importer = IMPORTERS.load(name)
        with IMPORTERS.guarded(name):
            if (importer.raw or importer.run) and importer.recognises(path):
                known.append(name)
    known = [n for n in known if n != GENERAL] or known
    return tuple(known or ([GENERAL] if _is_of_a_campaign(path) else ()))


def _is_of_a_campaign(path: Path) -> bool:
    """Whether an importer of campaigns knows a text whose campaign.toml is not there yet."""
    for name in IMPORTERS.usable():
        importer = IMPORTERS.load(name)
        with IMPORTERS.guarded(name):
            if importer.read and not (importer.raw or importer.run) and path.is_file() and importer.recognises(path):
                return True
    return False


def importer_of(path: Path, name: str = "") -> str:
    """The one importer of a path.

    Parameters
    ----------
    path : Path
    name : str, optional
        The one that a person names.

    Raises
    ------
    InputError
        None or several know the path; or the named one reads neither tables nor runs.
    """
    readers = [n for n in IMPORTERS.usable() if IMPORTERS.load(n).raw or IMPORTERS.load(n).run]
    if name:
        importer = IMPORTERS.load(name)
        if not (importer.raw or importer.run):
            raise InputError(f"the importer {name}", f"one of {', '.join(readers)}", column="--as")
        return name
    readable(path)
    if path.is_file() and path.stat().st_size == 0:
        raise input_error("tables.empty_file", path)
    known = recognised(path)
    if not known and path.is_dir():
        return find_runs(path)[0]
    if len(known) == 1:
        return known[0]
    if not known and (begin := _first_lines(path)):
        if kind := model_kind_of(path):
            raise input_error("tables.model_of_simulator", path, sort=kind, path=path)
        if is_of_openfoam([text for _, text in _first_lines(path, 60)]):
            raise input_error("tables.openfoam_file_alone", path)
        others = ", ".join(n for n in readers if n != GENERAL)
        unread = input_error("tables.unknown_text", path, general=GENERAL, others=others, as_table=_as_table(path))
        unread.example = "\n".join(f"  {number:2d}  {text}" for number, text in begin)
        raise unread
    found = f"something that {' and '.join(known)} read" if known else "nothing that an importer knows by its content"
    each = "; ".join(f"{n}: {IMPORTERS.load(n).reads or IMPORTERS.load(n).summary}" for n in known or readers)
    raise InputError(found, f"--as {' or --as '.join(known or readers)}", file=path, advice=f"{each}.")


def _as_table(path: Path) -> str:
    """What keeps a text from being a table, for one who takes it for one; empty where nothing does."""
    try:
        IMPORTERS.load(GENERAL).raw(path, {})  # type: ignore[misc]
    except InputError as why:
        return f"As {GENERAL}{f', line {why.line}' * bool(why.line)}: found {why.found}; expected {why.expected}. "
    return ""


def _first_lines(path: Path, most: int = FIRST) -> list[tuple[int, str]]:
    """The first lines of a text that are not blank, by their numbers and cut; none of what is no text."""
    try:
        with stream_of(path) as stream:
            sample = stream.read(1 << 14)
    except OSError:
        return []
    for encoding in ("utf-8-sig", "cp1252"):
        try:
            text = sample.decode(encoding, "strict" if len(sample) < 1 << 14 else "ignore")
            break
        except UnicodeDecodeError:
            continue
    else:
        return []
    lines = [(n, line.expandtabs().rstrip()) for n, line in enumerate(text.splitlines(), start=1) if line.strip()][
        :most
    ]
    return [(n, line[:CUT]) for n, line in lines] if all(line.isprintable() for _, line in lines) else []


def read_raw(
    path: Path, name: str, options: Mapping[str, Any] | None = None, progress: Progress | None = None
) -> RawTable:
    """A table as its file has it, or the runs of a folder as one table.

    Parameters
    ----------
    path : Path
    name : str
        Of the importer.
    options : mapping, optional
        Of the importer; of collected runs also ``names``, ``run_list`` and ``state``, see `coeflab.tables.collect.collect_groups`.
    progress : callable, optional
        Is handed a line now and then.

    Raises
    ------
    InputError
        By file and line; or an option that is not known.
    """
    importer = IMPORTERS.load(name)
    readable(path)
    with IMPORTERS.guarded(name):
        if importer.raw is not None:
            if any((options or {}).get(option) for option in OF_RUNS):
                raise input_error("tables.names_of_one_table", path, name=path.name)
            return upright(importer.raw(path, dict(options or {})))
    return _of_runs(path, name, options or {}, [str((options or {}).get("names", ""))], progress)[0]


def read_groups(
    path: Path, name: str, options: Mapping[str, Any], progress: Progress | None = None
) -> tuple[RawTable, ...]:
    """A table of the runs of each of several patterns, which the option ``names`` holds with `BETWEEN`.

    Parameters
    ----------
    path, name, options, progress
        See `read_raw`; the pattern of a table is in its dialect.

    Raises
    ------
    InputError
        As `read_raw`; a run of no pattern, or of two.
    """
    patterns = [text.strip() for text in str(options.get("names", "")).split(BETWEEN)]
    tables = zip(patterns, _of_runs(path, name, options, patterns, progress), strict=True)
    return tuple(replace(table, dialect={**table.dialect, "names": pattern}) for pattern, table in tables)


def _of_runs(
    path: Path, name: str, options: Mapping[str, Any], patterns: Sequence[str], progress: Progress | None
) -> tuple[RawTable, ...]:
    """A table of the runs of each pattern of names."""
    from coeflab.tables.collect import collect_groups

    given = {key: value for key, value in options.items() if key not in OF_RUNS}
    runs, state = (str(options.get(option, "")) for option in OF_RUNS[1:])
    with IMPORTERS.guarded(name):
        groups = collect_groups(
            path, name, options=given, patterns=patterns, run_list=Path(runs) if runs else None, progress=progress,
            state=Path(state) if state else None,
        )  # fmt: skip
    return tuple(group.table for group in groups)


def with_declarations(
    table: ForceTable, file: Path, cells: str = "", uncertainty: InputUncertainty | None = None, variant: str = ""
) -> ForceTable:
    """A table with its cell counts, studies and input uncertainty.

    Parameters
    ----------
    table : ForceTable
        As its importer read it, row for row.
    file : Path
        The table's own file.
    cells : str
        Column of the cell counts, or empty.
    uncertainty : InputUncertainty, optional
    variant : str
        Column that says what a study changed, or empty.

    Raises
    ------
    InputError
        No such column, a count that is not above zero, or a change that is none of a known study.
    """
    table = replace(table, uncertainty=uncertainty)
    if not (cells or variant):
        return table
    read = read_cells(file)
    for column, holds in ((cells, "cell counts that [[table]] cells"), (variant, "studies that [[table]] variant")):
        if column and column not in [h.name for h in read.headers]:
            raise input_error("tables.no_column_of_study", file, read.first_line - 1, column, head=column, holds=holds)
    if variant:
        table = replace(table, variants=_variants(read, variant)).without_studies()
    if not cells:
        return table
    counts = read.numbers(cells)
    bad = np.flatnonzero(counts <= 0.0)
    if bad.size:
        raise input_error("tables.no_cell_count", file, read.line(int(bad[0])), cells, counts=counts[bad[0]])
    return replace(table, cells=counts).on_one_grid()


def _variants(read: Cells, column: str) -> tuple[str, ...]:
    """What a study changed in every row, as ``name = value``; several changes with a comma between."""
    out = []
    for row, text in enumerate(read.texts(column)):
        pairs = []
        for part in () if text.strip() in ("", MATRIX) else text.split(","):
            name, sign, value = map(str.strip, part.partition("="))
            if name not in STUDIES or not sign or not value or "=" in value:
                raise input_error(
                    "tables.no_study", read.file, read.line(row), column, text=shown(text), matrix=MATRIX,
                    studies=", ".join(f"{n} = ..." for n in STUDIES),
                )  # fmt: skip
            pairs.append(f"{name} = {value}")
        out.append(Verbatim(", ".join(pairs)))
    return tuple(out)


def declared(tables: Sequence[ForceTable], campaign: Campaign) -> tuple[ForceTable, ...]:
    """The tables of a campaign with what its campaign.toml declares about them."""
    columns = {f"{campaign.name}/{t.file}": t for t in campaign.tables}
    out = []
    for table in tables:
        t = columns[table.name]
        out.append(with_declarations(table, campaign.path.parent / t.file, t.cells, campaign.uncertainty, t.variant))
    return tuple(out)


def table_at(
    path: Path,
    fits: tuple[str, ...] = (),
    options: Mapping[str, Mapping[str, Any]] | None = None,
    speed: float | None = None,
) -> PlannedTable:
    """A campaign folder, its campaign.toml, or one CSV of it."""
    only = path.name if path.is_file() and path.suffix != ".toml" else None
    return PlannedTable(path, fits, options or {}, only, speed)


def _declaration(path: Path) -> Path:
    return path / FILE if path.is_dir() else path if path.suffix == ".toml" else path.parent / FILE


def suited_fit(path: Path) -> str:
    """The fit that the tables of a campaign are for, as its importer says; the usual one where none can be asked."""
    declaration = _declaration(path)
    name = read_campaign(declaration).importer if declaration.exists() else "csv"
    return IMPORTERS.load(name).fit if name in IMPORTERS.names() else Importer.fit


def read_tables(planned: PlannedTable) -> tuple[ForceTable, ...]:
    """The tables of a planned campaign, rows of other speeds than the one that is wanted left out.

    Raises
    ------
    InputError
        By file, line and column; no row of the wanted speed.
    """
    tables = _every_speed(planned)
    if planned.speed is None:
        return tables
    found = tuple(t.at_speed(planned.speed) for t in tables)
    if not any(mask.any() for t in found for mask in t.usable.values()):
        have = sorted({round(float(u), 6) for t in tables for u in t.speed})
        raise input_error(
            "tables.no_row_at_speed", planned.campaign, column="speed", speed=planned.speed, have=", ".join(f"{u:g}" for u in have[:10]),
        )  # fmt: skip
    return found


def _every_speed(planned: PlannedTable) -> tuple[ForceTable, ...]:
    """The tables of a planned campaign: a folder, its campaign.toml, or one table beside it.

    Raises
    ------
    InputError
        By file, line and column.
    """
    path = planned.campaign
    declaration = _declaration(path)
    if not declaration.exists():
        raise input_error("tables.no_campaign_toml", path, path=FILE, parent=declaration.parent)
    campaign = read_campaign(declaration)
    importer = IMPORTERS.load(campaign.importer)
    if importer.read is not None:
        if campaign.columns:
            raise input_error(
                "tables.columns_of_other_importer", declaration, column="columns", importer=shown(campaign.importer),
                own=campaign.importer,
            )  # fmt: skip
        with IMPORTERS.guarded(campaign.importer):
            return declared(importer.read(campaign, planned.only, campaign.options), campaign)
    if not (importer.raw or importer.run):
        raise input_error(
            "tables.importer_without_tables", declaration, column="campaign.importer", importer=campaign.importer
        )
    return tuple(_mapped(campaign, table) for table in campaign.wanted(planned.only))


def _mapped(campaign: Campaign, table: TableDeclaration) -> ForceTable:
    folder = campaign.path.parent
    options = dict(campaign.options)
    options |= {name: folder / str(options[name]) for name in ("run_list", "state") if options.get(name)}
    raw = read_raw(folder / table.file, campaign.importer, options)
    out = mapped_table(raw, campaign, table)
    signs = tuple(_contradicted(assigned(raw, declared_mapping(campaign, table), len(campaign.tables) == 1), campaign))
    return replace(out, notes=(*out.notes, *signs)) if signs else out


def _contradicted(columns: Sequence[Assigned], campaign: Campaign) -> Iterator[str]:
    """What the numbers show against the signs of rates and angles that a campaign declares, as an import would ask."""
    for shows in evidence(columns, campaign.axes):
        if shows.against:
            yield f"warning: {shows.statement}"
            continue
        name = shows.key.partition(".")[2]
        words = campaign.signs.get(name) if name else None
        if words and angle_sign(name, shows.value) != angle_sign(name, words):
            yield f"warning: {shows.statement}, so {shows.value}; declared is the opposite"
