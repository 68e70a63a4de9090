"""Lists of runs that a person wrote, and the condition of every run from all its origins: files, the list, the name."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown, together
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.toml import read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.units import SI, Header, factor, fits
from coeflab.core.wording import listed, repeated
from coeflab.law.symbols import LINEAR
from coeflab.tables.column_names import named_as
from coeflab.tables.conditions import (
    COUNTED,
    DIMENSIONS,
    EXTENSION,
    SETTINGS,
    SPELT,
    Condition,
    NamePattern,
    NoConditionError,
    condition_of,
    in_a_list,
    named,
)
from coeflab.tables.vocabulary import one_name

RUN = "run"
# Angles that files hold as a vector of six digits, and rates in other units, differ in their last digits.
CLOSE, CLOSE_ANGLE = 1e-3, 1e-4
BESIDE = "{} (beside angles)"
_QUANTITY = re.compile(r"([-+\u2212]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(\S.*)")


@brief
@dataclass(frozen=True, slots=True)
class RunList:
    """A list of runs that a person wrote.

    Attributes
    ----------
    path : Path
    runs : mapping of str to mapping of str to Condition
        By the name of the run, in the order of the file.
    """

    path: Path
    runs: Mapping[str, Mapping[str, Condition]]

    def matches(self, runs: Sequence[str]) -> dict[str, str]:
        """By run the name in the list that means it: its path, its last part, that without its extension or a common end.

        Without its extension, and without what all runs end in behind ``_``, ``-`` or ``.``, a name counts where it means
        one run alone.

        Raises
        ------
        InputError
            No name of the list is a run.
        """
        lasts = {run: run.rpartition("/")[2] for run in runs}
        out = {run: n for run, last in lasts.items() for n in (last, run) if n in self.runs}
        stems = {run: EXTENSION.sub("", last) for run, last in lasts.items()}
        for shorter in (stems, _without_common_end(stems)):
            times, taken = Counter(shorter.values()), set(out.values())
            out |= {
                run: name
                for run, name in shorter.items()
                if run not in out and name in self.runs and name not in taken and times[name] == 1
            }
        if not out and self.runs and runs:
            raise input_error(
                "tables.names_runs", self.path,
                found=f"none of its {len(self.runs)} names is a run" if len(self.runs) > 1 else f"{next(iter(self.runs))}, which is no run",
                named=named(runs),
            )  # fmt: skip
        return out


def _without_common_end(names: Mapping[str, str]) -> dict[str, str]:
    """Names without what all of them end in, from a ``_``, ``-`` or ``.`` on."""
    backwards = zip(*(reversed(name) for name in names.values()), strict=False)
    alike = "".join(letters[0] for letters in takewhile(lambda letters: len(set(letters)) == 1, backwards))
    end = alike[::-1] if len(names) > 1 else ""
    match = re.search(r"[-_.]", end)
    return {key: name.removesuffix(end[match.start() :]) for key, name in names.items()} if match else {}


def read_run_list(path: Path) -> RunList:
    """A list of runs: CSV with a column ``run`` and units in the headers, or TOML with ``[runs.NAME]`` and texts with units.

    Raises
    ------
    InputError
        No column ``run``, a run twice, a setting without its unit, a number that is none.
    """
    return _toml_list(path) if path.suffix.lower() == ".toml" else _csv_list(path)


def _csv_list(path: Path) -> RunList:
    cells = read_cells(path)
    names = [h.name for h in cells.headers]
    if RUN not in names:
        raise InputError(f"columns {', '.join(names)}", f"a column {RUN}", file=path, line=cells.first_line - 1)
    runs = [text.replace("\\", "/").strip("/") for text in cells.texts(RUN)]
    for name in repeated(runs):
        row = len(runs) - 1 - runs[::-1].index(name)
        raise InputError(f"the run {shown(name)} twice", "every run once", file=path, line=cells.line(row), column=RUN)
    out: dict[str, dict[str, Condition]] = {name: {} for name in runs}
    of_columns = {header.name: setting_of(header.name) for header in cells.headers}
    for name in repeated(n for n in of_columns.values() if n in DIMENSIONS):
        both = [column for column, n in of_columns.items() if n == name]
        raise input_error("tables.two_columns_of_a_setting", path, cells.first_line - 1, both=listed(both), name=name)
    for header in cells.headers:
        name = of_columns[header.name]
        if name == RUN:
            continue
        is_label = name not in DIMENSIONS and header.unit is None
        if not is_label:
            _require(header, name, path, cells.first_line - 1)
            if (
                name not in DIMENSIONS
                and name not in COUNTED
                and any(fits(header.unit or "", d) for d in ("angle", "speed", "rate"))
            ):
                raise input_error(
                    "tables.unit_of_motion_without_setting", path, cells.first_line - 1, header.text, text=shown(header.text),
                    settings=", ".join(SETTINGS),
                )  # fmt: skip
        numbers = np.full(len(cells), np.nan) if is_label else cells.numbers(header.name)
        for row, (run, text, number) in enumerate(zip(runs, cells.texts(header.name), numbers, strict=True)):
            origin = f"{path.name}:{cells.line(row)}"
            if is_label and text:
                out[run][name] = Condition(text, np.nan, "", (origin,))
            elif text:
                out[run][name] = condition_of(float(number), header.unit or "", name, origin)
    return RunList(path, out)


def setting_of(name: str) -> str:
    """The setting that a column of a list of runs is by its name, as in text tables; the name itself where it is none."""
    plain = one_name(name)
    found = plain if plain in DIMENSIONS or plain == RUN else named_as(name)
    return found if found in DIMENSIONS else plain


def _require(header: Header, name: str, path: Path, line: int) -> None:
    dimension = DIMENSIONS.get(name)
    if dimension is None:
        return
    example = SI[dimension] or "-"
    if header.unit is None:
        raise input_error(
            "tables.column_without_unit", path, line, header.text, kind=UnitsError, text=header.text, name=name,
            which="deg" if dimension == "angle" else example,
        )  # fmt: skip
    try:
        factor(header.unit, dimension)
    except UnitsError as why:
        raise why.at(path, line, header.text) from None


def _toml_list(path: Path) -> RunList:
    read = read_toml(path)
    runs = read.content.get("runs")
    if not isinstance(runs, Mapping) or not runs or set(read.content) != {"runs"}:
        raise read.fail("runs", f"keys {', '.join(read.content)}", "tables [runs.NAME] and nothing else")
    out: dict[str, dict[str, Condition]] = {}
    for run, content in runs.items():
        line = read.line(("runs", run))
        origin = f"{path.name}:{line}" if line else path.name
        if not isinstance(content, Mapping):
            raise InputError(shown(content), "a table of conditions", file=path, line=line, key=f"runs.{run}")
        out[run.replace("\\", "/").strip("/")] = {
            plain: _toml_condition(plain, value, origin, path, line)
            for plain, value in ((setting_of(str(name)), value) for name, value in content.items())
        }
    return RunList(path, out)


def _toml_condition(name: str, value: object, origin: str, path: Path, line: int | None) -> Condition:
    dimension = DIMENSIONS.get(name)
    if dimension in (None, "none") and isinstance(value, (int, float)) and not isinstance(value, bool):
        return Condition(float(value), float(value), "-", (origin,))
    if dimension is None and isinstance(value, str):
        return Condition(value, np.nan, "", (origin,))
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) and len(value) <= 60 else None
    expected = f'a text with its unit, such as "4 {"deg" if dimension == "angle" else SI[dimension or "none"]}"'
    if match is None:
        raise UnitsError(shown(value), expected, file=path, line=line, key=name)
    try:
        return condition_of(float(match[1].replace("\u2212", "-")), match[2].strip(), name, origin)
    except UnitsError as why:
        raise why.at(path, line, key=name) from None


def joined(
    stated: Mapping[str, Mapping[str, Condition]], pattern: NamePattern | None, run_list: RunList | None
) -> dict[str, dict[str, Condition]]:
    """The conditions of every run from all their origins: files first, then the list of runs, then the name.

    Parameters
    ----------
    stated : mapping of run to mapping of str to Condition
        As `of_files` gives them.
    pattern : NamePattern or None
    run_list : RunList or None

    Raises
    ------
    InputError
        Two origins contradict each other; all that do are listed.
    """
    complaints: list[InputError] = []
    out: dict[str, dict[str, Condition]] = {}
    in_lists = run_list.matches(list(stated)) if run_list else {}
    for run, from_files in stated.items():
        found = dict(from_files)
        others = [run_list.runs[in_lists[run]]] if run_list and run in in_lists else []
        others += [pattern.conditions(run) or {}] if pattern else []
        for other in others:
            for name, one in other.items():
                if name not in found:
                    found[name] = one
                elif _same(name, found[name], one):
                    found[name] = replace(found[name], origins=(*found[name].origins, *one.origins))
                else:
                    complaints.append(_contradiction(run, name, found[name], one))
        out[run] = found
    turned = turned_in_one_flow(out)
    for run, found in out.items():
        complaints += _other_incidence(run, found, turned is not None)
    if complaints:
        raise together(complaints)
    return out


def _same(name: str, a: Condition, b: Condition) -> bool:
    if isinstance(a.value, str) or isinstance(b.value, str):
        return a.value == b.value
    floor = CLOSE_ANGLE if DIMENSIONS.get(name) == "angle" else 1e-9
    return abs(a.value - b.value) <= max(CLOSE * max(abs(a.value), abs(b.value)), floor)


def _contradiction(run: str, name: str, a: Condition, b: Condition) -> InputError:
    advice = ""
    if not isinstance(a.value, str) and not isinstance(b.value, str) and np.isclose(a.value, -b.value, rtol=CLOSE):
        advice = (
            f"If the two count {name} with opposite signs, leave {name} out of the list or the pattern: files count."
        )
    return InputError(f"{name} = {a} and {b}", "one value", file=run, advice=advice)


def turned_in_one_flow(conditions: Mapping[str, Mapping[str, Condition]]) -> Condition | None:
    """Velocity along x that all runs with angles share by their files while these angles differ: the body is turned in the mesh.

    Parameters
    ----------
    conditions : mapping of run to mapping of str to Condition
    """
    rows = [c for c in conditions.values() if not {"alpha", "beta"}.isdisjoint(c)]
    flows = [[c.get(n) or c.get(BESIDE.format(n)) for n in LINEAR] for c in rows]
    velocity, angles = map(_numbers, (flows, [[c.get("alpha"), c.get("beta")] for c in rows]))
    if len(rows) < 2 or np.max(np.ptp(np.nan_to_num(angles), axis=0)) <= CLOSE_ANGLE:
        return None
    across = np.hypot(velocity[:, 1], velocity[:, 2])
    along = np.all(across <= CLOSE * np.abs(velocity[:, 0])) and abs(np.sign(velocity[:, 0]).sum()) == len(rows)
    return flows[0][0] if along else None


def _numbers(rows: Sequence[Sequence[Condition | None]]) -> Array:
    """Values of settings, NaN for what is missing or a text."""
    known = [[np.nan if one is None or isinstance(one.value, str) else one.value for one in row] for row in rows]
    return np.array(known, dtype=float)


def _other_incidence(run: str, found: dict[str, Condition], turned: bool) -> list[InputError]:
    """Velocities of the files beside angles: one of the two is a setting, and they must agree as far as axes let one say."""
    flow = [found[c] for c in LINEAR if c in found and not isinstance(found[c].value, str)]
    angles = [found[a] for a in ("alpha", "beta") if a in found and not isinstance(found[a].value, str)]
    if not flow or not angles:
        return []
    if len(flow) == len(LINEAR) and not turned:
        velocity = np.array([f.value for f in flow], dtype=float)
        speed = float(np.linalg.norm(velocity))
        if speed > 0.0:
            by_flow = float(np.arccos(np.max(np.abs(velocity)) / speed))
            by_angle = float(np.arccos(np.clip(np.prod([np.cos(a.value) for a in angles]), -1.0, 1.0)))
            if max(by_flow, by_angle) < np.pi / 4 and abs(by_flow - by_angle) > 0.002 + 0.01 * by_angle:
                words = ", ".join(f"{c} = {found[c]}" for c in (*LINEAR, "alpha", "beta") if c in found)
                return [
                    input_error(
                        "tables.two_incidences", run, words=words, by_flow=np.degrees(by_flow), by_angle=np.degrees(by_angle),
                    )
                ]  # fmt: skip
    for c in LINEAR:
        if c in found:
            found[BESIDE.format(c)] = found.pop(c)
    return []


def required(conditions: Mapping[str, Mapping[str, Condition]], pattern: NamePattern | None) -> list[InputError]:
    """Complaints about settings that some runs have and others lack, and about runs without any setting.

    Parameters
    ----------
    conditions : mapping of run to mapping of str to Condition
        Of the runs that have forces.
    pattern : NamePattern or None
        Named in the complaint where a name does not fit it.
    """
    known = [s for s in SETTINGS if any(s in c for c in conditions.values())]
    sources = "a list of runs or a pattern of names, such as --name 'b{beta:deg}_r{r:rad/s}'"
    if conditions and not known:
        return [NoConditionError(list(conditions))]
    lacking: dict[tuple[str, ...], list[str]] = {}
    for name in known:
        lacking.setdefault(tuple(run for run, c in conditions.items() if name not in c), []).append(name)
    out = []
    for runs, names in lacking.items():
        if runs:
            unfit = pattern and any(pattern.conditions(r) is None for r in runs)
            why = f"The name does not fit {shown(pattern.text)}. {SPELT}. " if pattern and unfit else ""
            out.append(input_error(
                "tables.runs_without_setting", names=listed(names), runs=named(runs), sources=sources, why=why,
                in_a_list=in_a_list(names[0]),
            ))  # fmt: skip
    return out
