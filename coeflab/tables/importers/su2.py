"""Histories of SU2 (history.csv, history.dat of 6, 7, 8) and the config file beside them.

Coefficients: CFx, CFy, CFz are the fluid's force on the body along the axes of the mesh over 1/2 rho U^2 REF_AREA, CMx, CMy,
CMz its moment about REF_ORIGIN_MOMENT over 1/2 rho U^2 REF_AREA REF_LENGTH, right-handed about the same axes
(``CEulerSolver::SetReferenceValues`` and ``CIncEulerSolver::SetReferenceValues`` of su2code/SU2: rho and U of the free
stream, for incompressible flow with INC_NONDIM= REFERENCE_VALUES those of INC_DENSITY_REF and INC_VELOCITY_REF).

Angles: SU2 lets the free stream come with V = U (cos AOA cos SIDESLIP, sin SIDESLIP, sin AOA cos SIDESLIP) in the axes of
the mesh, in degrees (``CEulerSolver::SetNondimensionalization``, config_template.cfg: "only for compressible flows");
incompressible flow has INC_VELOCITY_INIT instead. The body moves with -V through the water. With x aft, y starboard and z
up ("CFD") this is w = +U sin(alpha), v = -U sin(beta): a positive sideslip lets the water come from port.

Rotating frames: the mesh turns with ROTATION_RATE (rad/s, axes of the mesh) about MOTION_ORIGIN and moves with
TRANSLATION_RATE, so the point REF_ORIGIN_MOMENT of the body moves with TRANSLATION_RATE + ROTATION_RATE x
(REF_ORIGIN_MOMENT - MOTION_ORIGIN) - V.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import LARGEST_NUMBER, MONITOR_FILES, TOML_BYTES
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.text.bounded import stream_of
from coeflab.core.texts import input_error
from coeflab.tables.half_bodies import planes_in_files, stated_plane
from coeflab.tables.monitor_files import decoded, files_of, first_filled, head, kind_of, lines_of, one_run, require
from coeflab.tables.monitors import Monitor, how_ended, in_order, laid_out, pieced, raw_table, read_monitor
from coeflab.tables.raw_table import Run, Stated

summary = "histories of SU2 6, 7 and 8 (history.csv, history.dat) with the config file beside them"
computed = True
reads = "history.csv or history.dat of SU2 with its .cfg"
citations = (
    "Economon T. D. et al. (2016): SU2: an open-source suite for multiphysics simulation and design. AIAA Journal 54(3).",
)

FORCES = {"CFx": "X", "CFy": "Y", "CFz": "Z", "CMx": "K", "CMy": "M", "CMz": "N"}
JUDGED = (*FORCES, "CD", "CL", "CSF", "CLift", "CDrag", "CSideForce")
COEFFICIENTS = (*JUDGED, "CEff", "CL/CD")
INDICES, ROW = ("Time_Iter", "Outer_Iter", "Inner_Iter", "Iteration"), "row of the history"
_NAME = re.compile(r"(?:Time|Outer|Inner)_Iter|rms\[.*|bgs\[.*")
_OLD = {"CL", "CD", "CLift", "CDrag"}
_SURFACE = re.compile(r"(?P<name>C[A-Za-z]{1,3})\((?P<marker>.+)\)")
_KEY = re.compile(r"\s*([A-Za-z_][A-Za-z0-9_]*)\s*=\s*(.*)")
_PART = re.compile(r"(.+)_\d{5}")


def wrote(lines: Sequence[str]) -> bool:
    """Whether quoted names have Time_Iter, Outer_Iter, Inner_Iter or residuals (7, 8), or Iteration and CL (6 and before)."""
    names = _names([line for _, line in first_filled(lines, 4)])
    return any(map(_NAME.fullmatch, names)) or (names[:1] == ("Iteration",) and not _OLD.isdisjoint(names))


def _names(lines: Sequence[str]) -> tuple[str, ...]:
    """Names of the columns of a history of SU2, CSV or Tecplot, from its first lines; empty where it is none."""
    selected = [line for line in lines if not line.startswith("TITLE")]
    if selected and selected[0].startswith("VARIABLES"):
        own = selected[0].partition("=")[2].strip()
        selected = selected[1:] if own in ("", "\\") else [own, *selected[1:]]
    if not selected or not selected[0].startswith('"'):
        return ()
    cells = selected[0].split(",")
    names = [cell.strip() for cell in cells if cell.strip()]
    quoted = all(len(n) > 2 and n[0] == n[-1] == '"' and '"' not in n[1:-1] for n in names)
    return tuple(n[1:-1].strip() for n in names) if quoted and len(names) > 1 else ()


def recognises(path: Path) -> bool:
    """Whether a file is a history of SU2, or a folder holds those of one run and no other monitors."""
    if path.is_dir():
        return bool(one_run(files_of(path, "su2"), _PART))
    return path.is_file() and kind_of(head(path)) == "su2"


def run(path: Path, options: Mapping[str, Any] | None = None) -> Run:
    """Read the history of a run and its conditions.

    Parameters
    ----------
    path : Path
        The history, or the folder that holds it.
    options : mapping, optional
        None are known.

    Returns
    -------
    Run
        Coefficients with the unit ``-`` in the axes of the mesh; conditions from the config file alone.

    Raises
    ------
    InputError
        No history of SU2, no coefficients in it, two runs in one folder, or a config file that cannot be read.
    """
    parse_options(NoOptions, options or {}, "importers.su2")
    files = _histories(path)
    pieces = [_read(f) for f in files]
    config, config_files, remarks = _config(files)
    files = (*files, config.path) if config else files
    if not any(p.names for p in pieces):
        return Run.empty(path, f"{files[0].name}: empty", files)
    index, inner = _index(pieces)
    pieces = [in_order(p, index, inner) for p in pieces]
    judged = [j for j, name in enumerate(pieces[-1].names) if _SURFACE.sub(r"\g<name>", name) in JUDGED]
    ended, why = how_ended(pieces[-1], judged)
    monitor = pieced(pieces, index)
    conditions, stated, words = _stated(config, monitor)
    half, texts = _symmetry_planes(files[0], config_files)
    stated |= half
    files = (*files, *texts)
    if config is not None and (change := _rescaled(config, conditions, monitor)):
        words = [*words, change]
    dialect = {
        "format": f"SU2 history, {'6 or before' if 'Iteration' in monitor.names else '7 or later'}",
        "delimiter": "comma",
        "decimal mark": "point",
    }
    tables = {
        marker: raw_table(replace(monitor, columns=list(monitor.columns), remarks=()), path, columns, files, dialect)
        for marker, columns in _surfaces(monitor.names, index).items()
    }
    columns = [
        (j, name, *_meaning(name, j == index)) for j, name in enumerate(monitor.names) if not _SURFACE.fullmatch(name)
    ]
    whole = raw_table(monitor, path, columns, files, dialect, stated, (*remarks, *words))
    return Run(path, path.stem, whole, conditions, tables, ended, why)


def _histories(path: Path) -> tuple[Path, ...]:
    """Files of the run, in order."""
    if not path.is_dir():
        return (path,)
    found = files_of(path, "su2")
    if ordered := one_run(found, _PART):
        return ordered
    names = ", ".join(f.name for f in found) or "no history of SU2"
    raise input_error("tables.several_histories", path, names=shown(names, 200))


def _read(path: Path) -> Monitor:
    """One history, or a monitor without columns for an empty file."""
    raw = head(path)
    if not raw.strip():
        if not path.is_file():
            raise InputError("no such file", "a history of SU2", file=path)
        return Monitor(path, (), [], np.empty(0, dtype=np.int64), 0)
    require(raw, path, "su2", "a history of SU2 (Time_Iter, Inner_Iter, rms[...])")
    filled = first_filled(lines_of(decoded(raw)[0]), 4)
    names = _names([line for _, line in filled])
    at = next(n for n, line in filled if f'"{names[0]}"' in line)
    zone = next((n for n, line in filled if n > at and line.startswith("ZONE")), at)
    names = tuple(n if names.index(n) == i else f"{n} ({names[:i].count(n) + 1})" for i, n in enumerate(names))
    if not any(_SURFACE.sub(r"\g<name>", n).partition("[")[0] in COEFFICIENTS for n in names):
        raise input_error("tables.no_coefficients_of_force", path, at)
    monitor = read_monitor(path, laid_out(raw, path, zone, names, ",", at))
    if any(n in names for n in INDICES):
        return monitor
    numbered = np.arange(1.0, len(monitor) + 1.0)
    return replace(monitor, names=(*names, ROW), columns=[*monitor.columns, numbered])


def _index(pieces: Sequence[Monitor]) -> tuple[int, bool]:
    """Position of the column that counts, and whether it stands still during inner iterations."""
    names = pieces[0].names
    present = [n for n in INDICES if n in names]
    for name in present:
        values = np.concatenate([p.columns[names.index(name)] for p in pieces if p.names == names])
        if values.size and np.any(values != values[0]):
            return names.index(name), name != present[-1]
    return names.index(present[-1] if present else ROW), False


def _meaning(name: str, counts: bool) -> tuple[str, str]:
    """Unit and meaning of a column."""
    if name in COEFFICIENTS:
        return "-", FORCES.get(name, "")
    if name == "Cur_Time":
        return "s", "time"
    return ("deg" if name == "AoA" else "", "iteration" if counts else "")


def _surfaces(names: Sequence[str], index: int) -> dict[str, list[tuple[int, str, str, str]]]:
    """Columns of every marker, each with the column that counts."""
    out: dict[str, list[tuple[int, str, str, str]]] = {}
    for j, name in enumerate(names):
        if match := _SURFACE.fullmatch(name):
            own = out.setdefault(match["marker"], [(index, names[index], "", "iteration")])
            own.append((j, match["name"], *_meaning(match["name"], False)))
    return out


# ---------------------------------------------------------------------------------------------------- the config file


@dataclass(frozen=True, slots=True)
class _Config:
    """Keys of a config file with their lines."""

    path: Path
    keys: Mapping[str, tuple[str, int]]

    def text(self, key: str) -> str:
        return self.keys.get(key, ("", 0))[0]

    def at(self, *keys: str) -> str:
        """File and lines of keys that it has."""
        return f"{self.path.name}:{', '.join(str(self.keys[k][1]) for k in keys if k in self.keys)}"

    def numbers(self, key: str, many: int) -> tuple[float, ...] | None:
        """Numbers of a key, None where it is not there.

        Raises
        ------
        InputError
            Something else than finite numbers.
        """
        if key not in self.keys:
            return None
        text, line = self.keys[key]
        cells = text.strip("() \t").replace(",", " ").split()
        try:
            values = tuple(float(c) for c in cells)
        except ValueError:
            values = ()
        if len(values) != many or not all(math.isfinite(v) and abs(v) <= LARGEST_NUMBER for v in values):
            wanted = "a number" if many == 1 else f"{many} numbers"
            raise InputError(shown(text), wanted, file=self.path, line=line, key=key)
        return values

    def vector(self, key: str) -> tuple[float, float, float] | None:
        """A vector, written as one key or as KEY_X, KEY_Y, KEY_Z; None where neither is there."""
        if key in self.keys:
            values = self.numbers(key, 3)
            return (values[0], values[1], values[2]) if values else None
        parts = [self.numbers(f"{key}_{axis}", self._many(f"{key}_{axis}")) for axis in "XYZ"]
        if any(part and len(set(part)) > 1 for part in parts):
            return None  # one point a marker
        if all(part is None for part in parts):
            return None
        return (*(part[0] if part else 0.0 for part in parts),)  # type: ignore[return-value]

    def _many(self, key: str) -> int:
        return max(len(self.text(key).replace(",", " ").split()), 1)

    def place(self, key: str) -> str:
        """File and lines of a vector."""
        return self.at(key, *(f"{key}_{axis}" for axis in "XYZ"))


_SYMMETRY_IN_LOG = re.compile(
    r"(?i)^[\s|]*symmetry plane(?: boundary)?\s*[|:]\s*(?P<name>[^|]*)|^\s*MARKER_SYM\w*\s*=[\s(]*(?!NONE\b)(?P<marker>[^\s,()]+)"
)


def _symmetry_planes(history: Path, configs: Sequence[_Config]) -> tuple[dict[str, Stated], list[Path]]:
    """Markers of symmetry planes in any config file beside a history, else in a log of the solver or a config of all runs; and those."""
    places = []
    for config in configs:
        for key in ("MARKER_SYM", "MARKER_SYMMETRY"):
            names = [
                n for n in config.text(key).strip("() \t").replace(",", " ").split() if n.upper() not in ("NONE", "\\")
            ]
            places += [f"{config.at(key)}: marker {name} is a symmetry plane" for name in names]
    if places:
        return stated_plane(places), []
    return planes_in_files(history.parent, (".cfg", ".log", ".out", ".txt"), _SYMMETRY_IN_LOG)


def _config(files: Sequence[Path]) -> tuple[_Config | None, Sequence[_Config], list[str]]:
    """The config file of a history: the only one beside it, or the only one whose CONV_FILENAME names it; and all beside it."""
    folder = files[0].parent
    try:
        config_files = sorted(p for p in folder.iterdir() if p.suffix.lower() == ".cfg" and p.is_file())[:MONITOR_FILES]
    except OSError:
        config_files = []
    every = configs = [_read_config(p) for p in config_files]
    if len(configs) > 1:
        configs = [c for c in configs if (c.text("CONV_FILENAME") or "history").partition(".")[0] == files[0].stem]
    if len(configs) == 1:
        return configs[0], configs, []
    if config_files:
        names = shown(", ".join(p.name for p in config_files), 200)
        why = f"conditions not read: config files {names}, and CONV_FILENAME does not show which one is meant"
        return None, configs or every, [why]
    return None, [], [f"conditions not read: no .cfg file beside {files[0].name}"]


def _read_config(path: Path) -> _Config:
    try:
        with stream_of(path) as stream:
            raw = stream.read(TOML_BYTES + 1)
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None
    if len(raw) > TOML_BYTES or b"\0" in raw:
        raise input_error("tables.no_config_file", path)
    keys: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines_of(raw.decode("utf-8", "replace")), start=1):
        if match := _KEY.match(line.partition("%")[0]):
            keys[match[1].upper()] = (match[2].strip(), number)
    return _Config(path, keys)


def _stated(config: _Config | None, monitor: Monitor) -> tuple[dict[str, Stated], dict[str, Stated], list[str]]:
    """Conditions, keys of campaign.toml and remarks that the config file gives."""
    conditions: dict[str, Stated] = {}
    stated: dict[str, Stated] = {}
    if config is None:
        return conditions, stated, []
    if config.text("SYSTEM_MEASUREMENTS").upper() == "US":
        return conditions, stated, [f"{config.at('SYSTEM_MEASUREMENTS')}: conditions not read: US units"]
    remarks = []
    incompressible = config.text("SOLVER").upper().startswith("INC_") or (
        config.text("REGIME_TYPE").upper() == "INCOMPRESSIBLE"
    )
    for key, name in (
        ("REF_LENGTH", "coefficients.length"),
        ("REF_LENGTH_MOMENT", "coefficients.length"),
        ("REF_AREA", "coefficients.area"),
    ):
        values = config.numbers(key, 1)
        if values and values[0] > 0.0:
            stated[name] = Stated(values[0], config.at(key))
        elif values:
            remarks.append(f"{config.at(key)}: {key} {values[0]:g}: SU2 takes it from the mesh")
    density = "INC_DENSITY_INIT" if incompressible else "FREESTREAM_DENSITY"
    if incompressible and (values := config.numbers(density, 1)):
        stated["conditions.density"] = Stated(values[0], config.at(density))
    reference = config.vector("REF_ORIGIN_MOMENT")
    if reference is not None:
        stated["axes.reference_point"] = Stated(reference, config.place("REF_ORIGIN_MOMENT"))
    flow = None
    if incompressible:
        flow = config.vector("INC_VELOCITY_INIT")
        if flow is None:
            remarks.append(f"{config.path.name}: no INC_VELOCITY_INIT: speed and angles not stated")
    else:
        _add_angles(config, monitor, conditions)
    kind = (config.text("GRID_MOVEMENT_KIND") or config.text("GRID_MOVEMENT")).upper()
    moving = kind in ("ROTATING_FRAME", "STEADY_TRANSLATION") and config.text("GRID_MOVEMENT").upper() != "NO"
    if not moving:
        if kind not in ("", "NO", "NONE", "YES"):
            remarks.append(f"{config.at('GRID_MOVEMENT')}: a moving mesh ({shown(kind)}): no steady condition")
            return {}, stated, remarks
        if flow is not None:
            _add_velocity(conditions, [-v for v in flow], config.at("INC_VELOCITY_INIT"), stated)
        return conditions, stated, remarks
    still = config.numbers("MACH_NUMBER", 1) == (0.0,) if not incompressible else False
    flow = (0.0, 0.0, 0.0) if still else flow
    if still:
        for name in ("alpha", "beta", "mach"):
            conditions.pop(name, None)
    rate = config.vector("ROTATION_RATE") if kind == "ROTATING_FRAME" else None
    if rate is not None:
        place = config.place("ROTATION_RATE")
        conditions |= {n: Stated(v, place) for n, v in zip("pqr", rate, strict=True)}
        stated["table.contains_inertia"] = Stated(False, config.at("GRID_MOVEMENT"))
    if flow is None:
        return conditions, stated, remarks
    if rate is not None and any(rate) and reference is None:
        remarks.append(f"{config.path.name}: no REF_ORIGIN_MOMENT: velocities of the reference point not stated")
        return conditions, stated, remarks
    arm = np.subtract(reference or 0.0, config.vector("MOTION_ORIGIN") or (0.0, 0.0, 0.0))
    turning = np.cross(rate or (0.0, 0.0, 0.0), arm)
    own = np.asarray(config.vector("TRANSLATION_RATE") or (0.0, 0.0, 0.0)) + turning - np.asarray(flow)
    keys = (
        "INC_VELOCITY_INIT",
        "MOTION_ORIGIN",
        "ROTATION_RATE",
        "TRANSLATION_RATE",
        "REF_ORIGIN_MOMENT_X",
        "MACH_NUMBER",
    )
    _add_velocity(conditions, [float(v) for v in own], config.at(*keys), stated, turns=rate is not None)
    return conditions, stated, remarks


def _add_velocity(
    conditions: dict[str, Stated], own: Sequence[float], place: str, stated: dict[str, Stated], turns: bool = False
) -> None:
    """Velocity of the body through the water, axes of the mesh; of one that turns at the point of its moments."""
    if turns:
        stated["table.arm_point"] = Stated("reference point", place)
    speed = math.hypot(*own)
    conditions["U"] = stated["conditions.speed"] = Stated(speed, place)
    conditions |= {n: Stated(v + 0.0, place) for n, v in zip("uvw", own, strict=True)}


def _rescaled(config: _Config, conditions: Mapping[str, Stated], monitor: Monitor) -> str:
    """Coefficients of incompressible flow made those by the run's own density and speed; what was done, or empty.

    SU2 divides by INC_DENSITY_REF and INC_VELOCITY_REF where INC_NONDIM= REFERENCE_VALUES, else by the free stream, which in
    a rotating frame is not the speed of the body.
    """
    if "U" not in conditions or (flow := config.vector("INC_VELOCITY_INIT")) is None:
        return ""
    own = (config.numbers("INC_DENSITY_INIT", 1) or (math.nan,))[0]
    density, speed = own, math.hypot(*flow)
    keys = ["INC_VELOCITY_INIT"]
    if config.text("INC_NONDIM").upper() == "REFERENCE_VALUES":
        keys = ["INC_DENSITY_REF", "INC_VELOCITY_REF"]
        density, speed = ((config.numbers(key, 1) or (1.0,))[0] for key in keys)
    elif math.isnan(density):
        own = density = 1.0
    towed = float(cast("float", conditions["U"].value))
    with np.errstate(all="ignore"):
        factor = float(np.divide(density * np.square(speed), own * np.square(towed)))
    if abs(factor - 1.0) < 1e-9:
        return ""
    if not (math.isfinite(factor) and factor > 0.0):
        return f"{config.at(*keys)}: coefficients by {density:g} kg/m^3 and {speed:g} m/s, not by density and speed of the run"
    for j, name in enumerate(monitor.names):
        if _SURFACE.sub(r"\g<name>", name) in JUDGED:
            monitor.columns[j] = monitor.columns[j] * factor
    return (
        f"{config.at(*keys)}: coefficients by {density:g} kg/m^3 and {speed:g} m/s multiplied by {factor:.10g}: "
        "by density and speed of the run"
    )


def _add_angles(config: _Config, monitor: Monitor, conditions: dict[str, Stated]) -> None:
    """AOA, SIDESLIP_ANGLE and MACH_NUMBER of compressible flow; at fixed lift the last AoA of the history."""
    for key, name in (("AOA", "alpha"), ("SIDESLIP_ANGLE", "beta")):
        if values := config.numbers(key, 1):
            conditions[name] = Stated(math.radians(values[0]), config.at(key))
    if values := config.numbers("MACH_NUMBER", 1):
        conditions["mach"] = Stated(values[0], config.at("MACH_NUMBER"))
    if config.text("FIXED_CL_MODE").upper() == "YES":
        conditions.pop("alpha", None)
        found = "AoA" in monitor.names and len(monitor)
        last = monitor.columns[monitor.names.index("AoA")][-1] if found else math.nan
        if math.isfinite(last):
            conditions["alpha"] = Stated(math.radians(float(last)), monitor.at(-1))
