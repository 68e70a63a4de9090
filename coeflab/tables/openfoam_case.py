"""What the dictionaries of a case of OpenFOAM say: function objects, fluid, inflow, rotating frames, mesh, log."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import FOAM_FIELD_BYTES, LARGEST_NUMBER, PATTERN_WORK
from coeflab.core.text.foam import Foam, FoamCase
from coeflab.core.text.patterns import PatternProblem, pattern
from coeflab.core.text.series import opened
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array
from coeflab.tables.openfoam_forces import is_vector, listed, number
from coeflab.tables.openfoam_symmetry import MIRRORS
from coeflab.tables.raw_table import Stated

# A number and its place.
NumberAt = tuple[float, str]
OPEN = {
    "freestream": "freestreamValue", "freestreamVelocity": "freestreamValue", "inletOutlet": "inletValue",
    "fixedValue": "value", "uniformFixedValue": "uniformValue", "supersonicFreestream": "UInf",
    "SRFFreestreamVelocity": "UInf", "SRFVelocity": "inletValue",
}  # fmt: skip
# Types of patches of a velocity that let no water in of a speed of their own.
CLOSED = (
    *MIRRORS, "noSlip", "slip", "zeroGradient", "movingWallVelocity", "MRFnoSlip", "empty", "wedge", "cyclic", "processor",
    "calculated", "fixedNormalSlip", "partialSlip",
)  # fmt: skip


def function_objects(case: FoamCase, names: Sequence[str]) -> dict[str, Foam]:
    """What the case says of its function objects: system/controlDict, system/functions, or a file of the same name."""
    out: dict[str, Foam] = {}
    control = case.read("system/controlDict")
    for holder in (control.part("functions") if control else None, case.read("system/functions")):
        for name, part in holder.parts() if holder is not None else ():
            out.setdefault(name, part)
    for name in names:
        if name not in out and (alone := case.read(f"system/{name}")) is not None:
            out[name] = alone.part(name) or alone
    return out


def body_patches(case: FoamCase, part: Foam | None) -> list[str]:
    """The patches of a function object, patterns with their quotation marks."""
    key = next((k for k in ("patches", "patch") if part is not None and k in part.entries), "patches")
    found = case.listed(part, key)
    for patch in found:
        try:
            pattern(patch.strip('"') if patch.startswith('"') else "")
        except PatternProblem as problem:
            place = case.where(part, key)
            case.note(
                Finding.of("foam.pattern", patch, Severity.WARN, place=place, text=shown(patch), why=str(problem))
            )
    return found


def matching_patches(patches: Sequence[str], known: Mapping[str, set[str]]) -> set[str]:
    """The patches that a list of names, groups and patterns takes; a pattern that takes none stands for itself.

    Raises
    ------
    InputError
        Patterns and names that would take too long.
    """
    out = set()
    letters = sum(map(len, known)) + len(known)
    spent = 0
    for patch in patches:
        hits = {n for n, groups in known.items() if patch.strip('"') in {n, *groups}}
        if patch.startswith('"'):
            try:
                read = pattern(patch.strip('"'))
            except PatternProblem:
                out |= hits or {patch}
                continue
            spent += len(patch) * letters
            if spent > PATTERN_WORK:
                raise InputError(f"patterns of {len(known):,} patches", "fewer, or shorter ones", column="patches")
            hits |= {n for n in known if read.matches(n)}
        out |= hits or {patch}
    return out


def known_patches(case: FoamCase, lists: Sequence[Sequence[str]]) -> dict[str, set[str]]:
    """Every patch with its groups: from the mesh, else as the function objects name them."""
    boundary = case.read("constant/polyMesh/boundary")
    if boundary is None:
        return {p: set() for patches in lists for p in patches if not p.startswith('"')}
    out = {}
    for name, part in boundary.parts():
        out[name] = set(case.listed(part, "inGroups"))
    return out


def walls(case: FoamCase) -> set[str]:
    """The patches of the mesh that are walls."""
    boundary = case.read("constant/polyMesh/boundary")
    return {n for n, part in boundary.parts() if case.word(part, "type") == "wall"} if boundary is not None else set()


def stated_density(case: FoamCase, part: Foam | None) -> tuple[NumberAt | None, list[str]]:
    """The density that forces were multiplied by, and what disagrees."""
    fluid: NumberAt | None = None
    for name in ("transportProperties", "physicalProperties", "thermophysicalProperties"):
        properties = case.read(f"constant/{name}")
        for keys in (("rho",), ("mixture", "equationOfState", "rho")):
            found = case.value(properties, *keys)
            if fluid is None and found is not None and is_number(found[0]):
                fluid = float(found[0]), found[1]
    rho, reference = case.value(part, "rho"), case.value(part, "rhoInf")
    if reference is None or not is_number(reference[0]) or (rho is not None and rho[0] != "rhoInf"):
        return fluid, [] if fluid is not None else ["no file states the density that forces were multiplied by"]
    stated = float(reference[0]), reference[1]
    other = f", while {fluid[1]} says {fluid[0]:g}" if fluid is not None and fluid[0] != stated[0] else ""
    if stated[0] == 1.0:
        return stated, [
            f"{stated[1]}: rhoInf 1, so forces are those of a fluid of 1 kg/m^3{other}; "
            "the option density turns them to another"
        ]
    return stated, [f"{stated[1]}: forces are those of rhoInf {stated[0]:g} kg/m^3{other}"] if other else []


def _inflow(case: FoamCase, name: str) -> Stated | None:
    """The velocity of the water far away, in the solver's axes, m/s: what the open boundaries of 0/U say, if they agree."""
    for folder in ("0", "0.orig"):
        field_ = case.read(f"{folder}/{name}")
        if field_ is not None:
            break
    else:
        return None
    boundary = field_.part("boundaryField")
    found: list[tuple[list[float], str, bool]] = []
    silent: list[str] = []
    for patch, part in boundary.parts() if boundary is not None else ():
        kind = case.word(part, "type")
        key = OPEN.get(kind)
        if key is None:
            if kind not in CLOSED:
                silent.append(f"{case.where(part, 'type') or case.where(part)} ({patch} of type {kind or 'none'})")
            continue
        stated = case.value(part, key)
        if stated is None or not is_vector(stated[0]):
            silent.append(f"{case.where(part, key) or case.where(part, 'type')} ({key} of {patch} is no vector)")
            continue
        if kind == "SRFFreestreamVelocity":
            relative = case.value(part, "relative")
            if relative is not None and relative[0]:
                case.note(text_of("foam.relative_inflow", place=stated[1], patch=patch))
                silent.append(stated[1])
                continue
        # A wall may be of type fixedValue too: at rest it says nothing.
        is_wall = kind in ("fixedValue", "uniformFixedValue") and not any(stated[0])
        found.append(([float(v) for v in stated[0]], stated[1], is_wall))
    # What flows back at rest says nothing beside a patch that states its inflow otherwise.
    open_ = [f for f in found if not f[2] and any(f[0])] or [f for f in found if not f[2] and not silent]
    if not open_:
        case.note(
            Finding.of(
                "foam.no_inflow", f"{folder}/{name}", Severity.WARN, place=f"{folder}/{name}", lines=tuple(silent[:5]),
                stopped="somewhere" if silent else "nowhere",
            )
        )  # fmt: skip
        return None
    if any(f[0] != open_[0][0] for f in open_):
        case.note(text_of("foam.several_inflows", field=f"{folder}/{name}", place=open_[0][1]))
        return None
    return Stated(tuple(open_[0][0]), open_[0][1])


def _share_of_mesh(case: FoamCase, zone: str) -> float | None:
    """The share of the cells that a cell zone holds; None where the mesh does not say."""
    found, file = stated_cells(case), case.root / "constant/polyMesh/cellZones"
    cells = found.value if found is not None else None
    if not isinstance(cells, int) or not file.is_file():
        return 1.0 if zone == "all" else None
    if file not in case.files:
        case.files.append(file)
    with opened(file) as stream:
        content = stream.read(FOAM_FIELD_BYTES)
    match = re.search(
        rb"(?:^|\s)" + re.escape(zone).encode() + rb"\s*\{[^{}]*?cellLabels\s+List<label>\s*(\d+)", content
    )
    return int(match[1]) / cells if match is not None else None


def stated_cells(case: FoamCase) -> Stated | None:
    """Cells, from the note at the head of constant/polyMesh/owner, or of those of all processors."""
    parts = [f for f in listed(case.root) if re.fullmatch(r"processor\d+", f.name)]
    for owners in ([case.root / "constant/polyMesh/owner"], [p / "constant/polyMesh/owner" for p in parts]):
        total, place = 0, ""
        for owner in owners:
            file = owner if owner.is_file() else owner.with_name("owner.gz")
            if not file.is_file():
                break
            with opened(file) as stream:
                match = re.search(rb"nCells:\s*(\d+)", stream.read(4096))
            if match is None:
                break
            if file not in case.files:
                case.files.append(file)
            total += int(match[1])
            place = place or case.relative(file)
        else:
            if owners:
                return Stated(total, place)
    return None


@dataclass(frozen=True, slots=True)
class Frame:
    """A rotating frame: its rates, rad/s, and a point of its axis, m, where they are known; and its place."""

    turning: tuple[Array, Array] | None
    place: str


def rotating_frame(case: FoamCase, wanted: str, body: set[str], known: Mapping[str, set[str]]) -> Frame | None:
    """The rotating frame that is the body's own motion; one that is not known where the files do not say enough.

    Parameters
    ----------
    case : FoamCase
    wanted : {"", "body", "none"}
        Whether frames of MRFProperties are the motion of the body; by what they cover where empty.
    body : set of str
        Patches of the body.
    known : mapping of str to set of str
        Patches with their groups.

    Raises
    ------
    InputError
        Several frames.
    """
    srf = case.read("constant/SRFProperties")
    if srf is not None:
        speeds = srf.part(f"{case.word(srf, 'SRFModel')}Coeffs")
        return _frame(case, srf, speeds or srf, "SRFProperties")
    zones = case.read("constant/MRFProperties")
    out = []
    for name, part in zones.parts() if zones is not None else ():
        active = case.value(part, "active")
        if name == "FoamFile" or (active is not None and not active[0]):
            continue
        zone = next(iter(case.listed(part, "cellZone") or case.listed(part, "cellSet")), "")
        share = _share_of_mesh(case, zone) if zone else None
        still = body & matching_patches(case.listed(part, "nonRotatingPatches"), known)
        rotor = (
            "as the option rotation says so" if wanted == "none"
            else "" if wanted == "body"
            else "as it does not turn the body's patches" if still
            else f"as it covers {share:.0%} of the cells" if share is not None and share < 1.0
            else ""
        )  # fmt: skip
        where = f"constant/MRFProperties, {name}"
        if rotor:
            case.note(text_of("foam.rotor", place=where, why=rotor))
        elif wanted != "body" and share is None:
            case.note(text_of("foam.unknown_frame", place=where))
            out.append(Frame(None, where))
        else:
            out.append(_frame(case, part, part, f"MRFProperties, {name}"))
    if len(out) > 1:
        raise input_error("tables.several_rotating_frames", case.root / "constant/MRFProperties", count=len(out))
    return out[0] if out else None


def _frame(case: FoamCase, part: Foam, speeds: Foam, what: str) -> Frame:
    axis, origin = case.value(part, "axis"), case.value(part, "origin")
    omega, rpm = case.value(speeds, "omega"), case.value(speeds, "rpm")
    rate = omega[0] if omega is not None else rpm[0] * math.pi / 30.0 if rpm is not None and is_number(rpm[0]) else None
    if axis is None or origin is None or not is_vector(axis[0]) or not is_vector(origin[0]) or not is_number(rate):
        case.note(text_of("foam.incomplete_frame", place=what))
        return Frame(None, f"constant/{what}")
    unit = np.array(axis[0], dtype=float)
    if not np.any(unit):
        raise input_error("tables.axis_of_no_length", case.root / "constant", column=what)
    turning = float(str(rate)) * unit / np.linalg.norm(unit)
    return Frame((turning, np.array(origin[0], dtype=float)), (omega or rpm or axis)[1])


def is_number(value: Any) -> bool:
    """Whether a value of a dictionary is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < LARGEST_NUMBER


def body_motion(
    case: FoamCase, frame: Frame | None, point: tuple[list[float], str] | None, name: str
) -> dict[str, Stated]:  # fmt: skip
    """Velocity and rates of the body through the water at rest, in the solver's axes.

    The water comes with U; seen from it the body moves with -U, and with omega x r where its frame turns:
    v = omega x (CofR - origin) - U, (p, q, r) = omega.

    Parameters
    ----------
    case : FoamCase
    frame : Frame or None
    point : tuple of list of float and str, or None
        CofR, m, and its place.
    name : str
        Of the velocity, ``U`` or ``Urel``.
    """
    out: dict[str, Stated] = {}
    inflow = _inflow(case, name)
    if frame is not None and frame.turning is None:
        return out
    if frame is not None and frame.turning is not None:
        out.update({n: Stated(float(w) + 0.0, frame.place) for n, w in zip("pqr", frame.turning[0])})
        if point is None:
            case.note(text_of("foam.no_centre"))
            return out
    if inflow is None:
        return out
    water, place = np.asarray(inflow.value, dtype=float), inflow.place
    velocity = -water
    if frame is not None and frame.turning is not None and point is not None:
        omega, origin = frame.turning
        velocity = velocity + np.cross(omega, np.array(point[0]) - origin)
        place = f"{place}, {frame.place}, {point[1]}"
        if np.any(np.cross(omega, water)):
            case.note(text_of("foam.unsteady_inflow", place=inflow.place, frame=frame.place))
    out.update({n: Stated(float(v) + 0.0, place) for n, v in zip("uvw", velocity)})
    out["U"] = Stated(float(np.linalg.norm(velocity)), place)
    return out


def stated_y_plus(case: FoamCase, body: set[str]) -> Stated | None:
    """The largest average y+ of the body's patches at the last time."""
    last: dict[str, tuple[float, float, str]] = {}
    for folder in listed(case.root / "postProcessing"):
        for time in listed(folder) if folder.is_dir() else ():
            file = time / "yPlus.dat"
            if not file.is_file():
                continue
            case.files.append(file)
            with opened(file) as stream:
                for line, raw in enumerate(islice(stream, 1_000_000), start=1):
                    cells = raw.decode("utf-8", "replace").split()
                    if len(cells) == 5 and math.isfinite(number(cells[0])) and math.isfinite(number(cells[4])):
                        now = (number(cells[0]), number(cells[4]), f"{case.relative(file)}:{line}")
                        last[cells[1]] = max(now, last.get(cells[1], now), key=lambda n: n[0])
    mine = [v for patch, v in last.items() if patch in body] or ([] if body else list(last.values()))
    if not mine:
        return None
    largest = max(mine, key=lambda n: n[1])
    return Stated(largest[1], largest[2])


def read_log(case: FoamCase, application: str) -> tuple[dict[str, str], str, bool]:
    """What the solver's log says: version and solver, how the run broke off (or empty), whether it came to its end."""
    words: dict[str, str] = {}
    for file in listed(case.root):
        if not (file.name.startswith("log") or file.suffix == ".log") or not file.is_file():
            continue
        with opened(file) as stream:
            head = stream.read(1 << 14).decode("utf-8", "replace")
            program = re.search(r"^Exec\s*:\s*(\S+)", head, re.MULTILINE)
            if program is None or (application and program[1].rpartition("/")[2] != application):
                continue
            tail = head
            if file.suffix != ".gz":
                stream.seek(max(0, file.stat().st_size - (1 << 14)))
                tail = stream.read(1 << 14).decode("utf-8", "replace")
        case.files.append(file)
        build = re.search(r"^Build\s*:\s*(.+)$", head, re.MULTILINE)
        openfoam_com = re.search(r"OPENFOAM=(\d+)|\bv(\d{4})\b", build[1]) if build is not None else None
        words = {"solver": program[1]}
        if openfoam_com is not None:
            words |= {"version": f"v{openfoam_com[1] or openfoam_com[2]}", "fork": "openfoam.com"}
        elif build is not None:
            words |= {"version": build[1].strip(), "fork": "openfoam.org"}
        if (met := re.search(r"solution converged in (\d+) iterations", tail)) is not None:
            words["convergence"] = f"the solver's residualControl was met after {met[1]} iterations ({file.name})"
        broken = re.search(
            r"FOAM FATAL[^\n]*|sigFpe::[^\n]*|Floating point exception(?! trapping)|Segmentation fault|\bKilled\b", tail
        )
        return (
            words,
            f"{file.name}: {shown(broken[0])}" if broken is not None else "",
            re.search(r"^End\b", tail, re.M) is not None,
        )
    return words, "", False


def word(case: FoamCase, file: str, *keys: str) -> str:
    """A word of a dictionary; empty where it is not stated."""
    return case.word(case.read(file), *keys)
