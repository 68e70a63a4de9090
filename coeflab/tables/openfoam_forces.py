"""Forces that OpenFOAM's function objects wrote: both forks by their headers, restarts joined, in the axes of the mesh."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.text.foam import Foam, FoamCase
from coeflab.core.text.foam_values import is_finite
from coeflab.core.text.series import read_comments, read_series
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.symbols import COMPONENTS
from coeflab.law.transforms import force_transfer

_FILE = re.compile(r"(forces|force|forceCoeffs|coefficient)(_[-+.\deE]+)?\.dat(\.gz)?")
_TIME = re.compile(r"[-+]?\d[\d.eE+-]*")
_GROUP = re.compile(r"(local)?(force|moment)s?\(([^)]*)\)", re.IGNORECASE)
XYZ = "xyz"
VECTORS = ("CofR", "dragDir", "sideDir", "liftDir", "rollAxis", "pitchAxis", "yawAxis")
NUMBERS = ("magUInf", "lRef", "Aref")
_MOST = 200_000  # entries of one folder


def listed(folder: Path) -> list[Path]:
    """What a folder holds, sorted; nothing where it is none.

    Raises
    ------
    InputError
        It is shut, or its links run in a circle.
    """
    try:
        with os.scandir(folder) as found:
            return sorted(folder / e.name for e in islice(found, _MOST))
    except (FileNotFoundError, NotADirectoryError):
        return []
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable folder", file=folder) from None


def number(text: str) -> float:
    """A number; infinite where it is none."""
    try:
        return float(text)
    except ValueError:
        return math.inf


def found_histories(functions: Path) -> Iterator[tuple[str, float, str, Path]]:
    """Name of the function object, time, kind and file of every history, in order of the restarts."""
    for function in listed(functions):
        folders = [f for f in listed(function) if _TIME.fullmatch(f.name)] if function.is_dir() else []
        for folder in sorted(folders, key=lambda f: number(f.name)):
            # A second run from the same time writes force_0.dat beside force.dat.
            files = [(match, f) for f in listed(folder) if (match := _FILE.fullmatch(f.name))]
            for match, file in sorted(files, key=lambda m: (m[0][2] is not None, number((m[0][2] or "_0")[1:]))):
                yield function.name, number(folder.name), match[1], file


def is_vector(value: Any) -> bool:
    """Whether a value of a dictionary is three finite numbers."""
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(isinstance(v, (int, float)) and math.isfinite(v) for v in value)
    )


@dataclass(slots=True)
class History:
    """The joined history of one function object.

    Attributes
    ----------
    values : dict of str to array
        Time; X ... N; and of every share, such as pressure X.
    facts : dict of str to (str or list, place)
        What the comments of the last file state: CofR, magUInf ...
    wild, cut : str
        Where numbers stop to be finite, and where a line is not whole.
    """

    name: str
    is_coefficients: bool
    values: dict[str, Array] = field(default_factory=dict)
    facts: dict[str, tuple[Any, str]] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    wild: str = ""
    cut: str = ""

    @property
    def shares(self) -> list[str]:
        """Parts of the force, such as pressure and viscous."""
        return list(dict.fromkeys(n.rpartition(" ")[0] for n in self.values if " " in n))


def _facts(case: FoamCase, file: Path, comments: Sequence[str]) -> dict[str, tuple[Any, str]]:
    """``# CofR : (0 0 0)`` and the like: vectors and numbers by name, each with its place."""
    out: dict[str, tuple[Any, str]] = {}
    for line, comment in enumerate(comments, start=1):
        name, _, text = comment.partition(":")
        numbers = [number(t) for t in text.replace("(", " ").replace(")", " ").split()]
        value: Any = numbers if name.strip() in VECTORS else numbers[0] if len(numbers) == 1 else None
        if is_vector(value) or (name.strip() in NUMBERS and value is not None and math.isfinite(value)):
            out[name.strip()] = (value, f"{case.relative(file)}:{line}")
    return out


def _header(file: Path, comments: Sequence[str]) -> tuple[str, int]:
    """The line of the column names, and its number."""
    for line, comment in reversed(list(enumerate(comments, start=1))):
        if comment.lower().startswith("time"):
            return comment[4:], line
    raise input_error("tables.no_line_of_names", file, len(comments) + 1)


def _force_columns(header: str, what: str) -> list[str]:
    """Names such as ``pressure force x`` of the columns of a file of forces, without the time."""
    groups = list(_GROUP.finditer(header))
    if groups:
        return [
            f"{'local ' if g[1] else ''}{share} {g[2].lower()} {c}"
            for g in groups for share in re.split(r"[\s,]+", g[3].strip()) for c in XYZ
        ]  # fmt: skip
    out = []
    for token in header.replace("(", " ").replace(")", " ").split():
        share, _, axis = token.rpartition("_")
        out.append(f"{share} {what} {axis}")
    return out


def _sums(columns: Sequence[str], what: str) -> dict[str, list[int]]:
    """Of which numbers of a row (from 1; the time is 0) every component of force or moment is the sum."""
    names = dict(zip(XYZ, COMPONENTS[:3] if what == "force" else COMPONENTS[3:], strict=True))
    by_share: dict[str, dict[str, int]] = {}
    for i, column in enumerate(columns, start=1):
        share, kind, axis = column.rsplit(" ", 2)
        if kind == what and not share.startswith("local "):
            by_share.setdefault(share, {})[names.get(axis, axis)] = i
    total = by_share.pop("total", None)
    out = {}
    for name in names.values():
        parts = [s[name] for s in by_share.values() if name in s]
        if total is not None and name in total:
            out[name] = [total[name]]
        elif parts:
            out[name] = parts
    for share, at in by_share.items():
        out.update({f"{share} {name}": [i] for name, i in at.items()})
    return out


def _read_file(case: FoamCase, file: Path, kind: str) -> History:
    """One file, or a file of forces with its file of moments."""
    if file not in case.files:
        case.files.append(file)
    comments = read_comments(file)
    header, line = _header(file, comments)
    out = History(file.parents[1].name, kind in ("forceCoeffs", "coefficient"), facts=_facts(case, file, comments))
    if out.is_coefficients:
        columns = header.split()
        which = {c: [i] for i, c in enumerate(columns, start=1)}
    else:
        what = "moment" if kind == "moment" else "force"
        columns = _force_columns(header, what)
        which = _sums(columns, "force") | _sums(columns, "moment")
        if not which:
            raise input_error("tables.no_columns_of_forces", file, line, header=shown(header))
    series = read_series(file, len(columns) + 1, [[0], *which.values()])
    out.values = dict(zip(["time", *which], series.columns, strict=True))
    place = case.relative(file)
    out.remarks += [f"{place}: {r}" for r in series.remarks]
    out.cut = f"{place}: {series.cut}" if series.cut else ""
    if series.wild is not None:
        row, at = series.wild
        out.wild = f"{place}:{at}: the first number that is not finite, at time {out.values['time'][row]:g}"
    if kind == "force":
        moments = file.with_name(file.name.replace("force", "moment", 1))
        if moments.is_file():
            _add_moments(out, _read_file(case, moments, "moment"), place)
        else:
            out.remarks.append(f"{place}: no {moments.name} in the same folder, so no moments")
    return out


def _add_moments(forces: History, moments: History, place: str) -> None:
    """Add the moments of the same times."""
    one, other = forces.values["time"], moments.values.pop("time")
    if not np.array_equal(one, other, equal_nan=True):
        times, mine, its = np.intersect1d(one, other, return_indices=True)
        forces.remarks.append(
            f"{place}: {len(one)} rows of forces and {len(other)} of moments; the {len(times)} times of both are kept"
        )
        forces.values = {n: v[mine] for n, v in forces.values.items()}
        moments.values = {n: v[its] for n, v in moments.values.items()}
    forces.values.update(moments.values)
    forces.remarks += moments.remarks
    forces.wild, forces.cut = forces.wild or moments.wild, forces.cut or moments.cut


def _joined(case: FoamCase, files: Sequence[tuple[str, Path]]) -> History:
    """The files of one function object in order; a later start wins from its first time on."""
    parts = [_read_file(case, file, kind) for kind, file in files]
    last = parts[-1]
    out = History(last.name, last.is_coefficients, facts=last.facts)
    for part in parts:
        if "CofR" in part.facts and "CofR" in last.facts and part.facts["CofR"][0] != last.facts["CofR"][0]:
            moved(part, part.facts["CofR"], last.facts["CofR"])
        out.remarks += part.remarks
    out.wild, out.cut = next((p.wild for p in parts if p.wild), ""), last.cut
    names = [n for n in parts[0].values if all(n in p.values for p in parts)]
    times = np.concatenate([p.values["time"] for p in parts])
    later = np.minimum.accumulate(np.append(times, np.inf)[::-1])[::-1][1:]
    keep = times < later
    if not keep.all():
        begins = " and ".join(f"{case.relative(f)}" for _, f in files[1:]) or "a start within the file"
        out.remarks.append(
            f"{np.count_nonzero(~keep)} rows of {out.name} were computed again by {begins}; the later stay"
        )
    for name in names:
        column = np.concatenate([p.values.pop(name) for p in parts]) if len(parts) > 1 else parts[0].values.pop(name)
        out.values[name] = column if keep.all() else column[keep]
    return out


@np.errstate(invalid="ignore", over="ignore")
def moved(history: History, old: tuple[Sequence[float], str], new: tuple[Sequence[float], str]) -> None:
    """Moments about another point; the points in m, each with its place."""
    turn = force_transfer(np.array(new[0]) - np.array(old[0]))[3:, :3]
    for share in ["", *history.shares]:
        names = [f"{share} {c}".strip() for c in COMPONENTS]
        if all(n in history.values for n in names):
            forces = [history.values[n] for n in names[:3]]
            for i, name in enumerate(names[3:]):
                history.values[name] = history.values[name] + sum(turn[i, j] * forces[j] for j in range(3))
    history.remarks.append(f"moments of {history.name} were moved from the point of {old[1]} to that of {new[1]}")


@np.errstate(invalid="ignore", over="ignore")
def _turned(history: History, axes: Array) -> None:
    """Forces and moments from local axes (rows of the matrix) to the solver's."""
    for share in ["", *history.shares]:
        for group in (COMPONENTS[:3], COMPONENTS[3:]):
            names = [f"{share} {c}".strip() for c in group]
            if all(n in history.values for n in names):
                old = [history.values[n] for n in names]
                for i, name in enumerate(names):
                    history.values[name] = sum((axes[j, i] * old[j] for j in range(3)), np.zeros_like(old[0]))


def added(case: FoamCase, histories: Sequence[History]) -> History:
    """The sum of several function objects, moments about the point of the first."""
    out = histories[0]
    for other in histories[1:]:
        if other.is_coefficients or out.is_coefficients or not np.array_equal(out.values["time"], other.values["time"]):
            raise input_error("tables.other_times", case.root, column="function", name=out.name, other=other.name)
        if "CofR" in out.facts and "CofR" in other.facts and other.facts["CofR"][0] != out.facts["CofR"][0]:
            moved(other, other.facts["CofR"], out.facts["CofR"])
        for name in [n for n in out.values if n != "time"]:
            if name in other.values:
                out.values[name] = out.values[name] + other.values[name]
            else:
                del out.values[name]
        out.remarks += other.remarks
        out.wild, out.cut = out.wild or other.wild, out.cut or other.cut
    return out


def _local_axes(case: FoamCase, part: Foam, file: Path) -> Array | None:
    """Rows e1 e2 e3 of the axes in which a force.dat is written; None where they are the solver's.

    As OpenFOAM 1912 does it, which was tried: CofR comes before coordinateSystem, and means the solver's axes.
    """
    system = part.part("coordinateSystem")
    if system is None or "CofR" in part.entries or file.with_name("localForce.dat").is_file():
        return None
    turned = system.part("rotation") or system.part("coordinateRotation") or system
    kind = case.value(turned, "type")
    e = [case.value(turned, f"e{i}") for i in (1, 2, 3)]
    given = [np.array(v[0], dtype=float) if v is not None and is_vector(v[0]) else None for v in e]
    if kind is not None and kind[0] == "none":
        return None
    if kind is not None and kind[0] == "axisAngle":
        axis, angle = case.value(turned, "axis"), case.value(turned, "angle")
        if axis is not None and angle is not None and is_vector(axis[0]) and any(axis[0]) and is_finite(angle[0]):
            from scipy.spatial.transform import Rotation

            unit = np.array(axis[0], dtype=float) / np.linalg.norm(axis[0])
            return np.array(Rotation.from_rotvec(np.radians(angle[0]) * unit).as_matrix()).T
    x, y, z = given
    if x is None and y is not None and z is not None:
        x = np.cross(y, z)
    elif x is not None and y is None and z is not None:
        y = np.cross(z, x)
    if x is None or y is None or not np.any(np.cross(x, y)):
        raise input_error("tables.unread_axes", file)
    x = x / np.linalg.norm(x)
    z = np.cross(x, y) / np.linalg.norm(np.cross(x, y))
    return np.array([x, np.cross(z, x), z])


def oriented(case: FoamCase, files: list[tuple[str, Path]], part: Foam | None, remarks: list[str]) -> History:
    """The history of one function object, in the solver's axes."""
    kinds = {k for k, _ in files}
    # A forceCoeffs object may write both; forces say more.
    forces = [f for f in files if f[0] in ("force", "forces")]
    chosen = [f for f in files if f[0] == ("force" if "force" in kinds else "forces")] if forces else files
    history = _joined(case, chosen)
    axes = _local_axes(case, part, chosen[-1][1]) if part is not None and "force" in kinds else None
    if axes is not None:
        _turned(history, axes)
        remarks.append(f"forces of {history.name} were turned from its coordinateSystem to the axes of the mesh")
    return history


def from_coefficients(history: History, density: float) -> str:
    """Turn coefficients into forces of that density; the reason where that is not possible."""
    facts, values = {k: v for k, (v, _) in history.facts.items()}, history.values
    missing = [n for n in ("magUInf", "Aref", "dragDir", "liftDir") if n not in facts]
    if missing:
        return f"its comments state no {' and no '.join(missing)}"
    drag, lift = np.array(facts["dragDir"]), np.array(facts["liftDir"])
    side = np.array(facts.get("sideDir", np.cross(lift, drag)))
    frame = np.array([drag, side, lift])
    if not np.allclose(frame @ frame.T, np.eye(3), atol=1e-4):
        return "dragDir and liftDir are not at right angles, or not of length 1"
    axes = [np.array(facts.get(n, d)) for n, d in (("rollAxis", drag), ("pitchAxis", side), ("yawAxis", lift))]
    speed, area = facts["magUInf"], facts["Aref"]
    scale = 0.5 * density * speed * speed * area
    if not math.isfinite(scale):
        return f"magUInf {speed:g} and Aref {area:g} make a force beyond what a number can hold"
    moment = ("CmRoll", "Cm" if "Cm" in values else "CmPitch", "CmYaw")
    for names, directions, unit, components in (
        (("Cd", "Cs", "Cl"), frame, scale, COMPONENTS[:3]),
        (moment, np.array(axes), scale * facts.get("lRef", math.nan), COMPONENTS[3:]),
    ):
        for i, component in enumerate(components):
            # A component is known where no coefficient that is missing has a part along it.
            if all(n in values or abs(d[i]) < 1e-9 for n, d in zip(names, directions)) and math.isfinite(unit):
                parts = [d[i] * values[n] for n, d in zip(names, directions) if n in values and abs(d[i]) >= 1e-9]
                if parts:
                    values[component] = unit * np.sum(parts, axis=0)
    for name in [n for n in values if n not in ("time", *COMPONENTS)]:
        del values[name]
    return ""
