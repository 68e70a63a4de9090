"""A case of OpenFOAM, of both forks: forces by their headers, inflow, rotation and fluid from the dictionaries.

What the headers look like was taken from the tools' own output; docs/data_in_openfoam.md lists it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.options import measured, one_of, parse_options, words
from coeflab.core.text.foam import Foam, FoamCase
from coeflab.core.texts import input_error
from coeflab.core.wording import listed, repeated
from coeflab.law.symbols import COMPONENTS
from coeflab.tables import openfoam_case
from coeflab.tables.openfoam_forces import (
    XYZ,
    History,
    added,
    found_histories,
    from_coefficients,
    is_vector,
    moved,
    oriented,
)
from coeflab.tables.openfoam_symmetry import mirror_patches
from coeflab.tables.raw_table import HALF_MODEL, NO_FORCES, Ended, RawColumn, RawTable, Run, Stated

summary = "a case of OpenFOAM (.com and .org): forces, forceCoeffs, inflow, MRF and SRF, restarts"
computed = True
citations = (
    "Weller, Tabor, Jasak and Fureby (1998): A tensorial approach to computational continuum mechanics using "
    "object-oriented techniques. Computers in Physics 12, 620-631",
)


@dataclass(frozen=True, slots=True)
class Options:
    """What the files leave open.

    Attributes
    ----------
    function : tuple of str
        The function object (folder of postProcessing) of the whole body; several are added.
    rotation : str
        Whether a rotating frame of constant/MRFProperties is the motion of the body: body, or none (a rotor). Without it
        one is that covers the whole mesh.
    density : float
        Forces are turned to this density, kg/m^3, from rhoInf; 0 leaves them.
    """

    function: tuple[str, ...] = words()
    rotation: str = one_of("", "", "body", "none")
    density: float = measured(0.0, 0.0, 1e5, "density")


def _case_of(path: Path) -> Path:
    return path.parent if path.name == "postProcessing" else path


def recognises(path: Path) -> bool:
    """Whether the folder is one case: it has system/controlDict, or forces in postProcessing."""
    try:
        if not path.is_dir():
            return False
        root = _case_of(path)
        if any((root / "system" / name).is_file() for name in ("controlDict", "controlDict.gz")):
            return True
        return any(True for _ in found_histories(root / "postProcessing"))
    except (OSError, InputError):
        return False


def _whole(case: FoamCase, found: Mapping[str, bool], parts: Mapping[str, Foam], asked: Sequence[str]) -> list[str]:
    """The function objects that are the whole body: asked for, the only one, or the one that covers all others.

    Parameters
    ----------
    case : FoamCase
    found : mapping of str to bool
        Function objects with a history, and whether it holds coefficients alone.
    parts : mapping of str to Foam
    asked : sequence of str
    """
    names = ", ".join(found)
    missing = [n for n in asked if n not in found]
    if missing:
        raise input_error(
            "tables.no_forces_of_function", case.root, column="function", missing=shown(missing[0]), names=names
        )
    if twice := repeated(asked):
        raise input_error("tables.function_twice", case.root, column="function", twice=listed(twice))
    if asked:
        return list(asked)
    if len(found) == 1:
        return list(found)
    lists = {n: openfoam_case.body_patches(case, parts.get(n)) for n in found}
    known = openfoam_case.known_patches(case, list(lists.values()))
    sets = {n: openfoam_case.matching_patches(p, known) for n, p in lists.items()}
    union = set().union(*sets.values())
    best = [n for n in found if sets[n] == union] if all(sets.values()) else []
    # Forces and coefficients of the same patches are one; the forces say more.
    best = [n for n in best if not found[n]] or best
    if len(best) != 1:
        silent = [n for n in found if not sets[n]]
        what = (
            f"{' and '.join(best)} cover the same patches" if best
            else f"no dictionary says which patches {' and '.join(silent)} has" if silent
            else "none of them covers all patches"
        )  # fmt: skip
        raise input_error(
            "tables.no_whole_body", case.root, column="function", names=names, what=what, next=next(iter(found))
        )
    return best


def _table(
    history: History, share: str, case: FoamCase, time: RawColumn, unit: tuple[str, str], **more: Any
) -> RawTable:
    """One table of a history; its columns are taken out of it, as they are long."""
    columns = [time]
    for i, component in enumerate(COMPONENTS):
        values = history.values.pop(f"{share} {component}".strip(), None)
        if values is not None:
            name = f"{'F' if i < 3 else 'M'}{XYZ[i % 3]}"
            columns.append(RawColumn(name, unit[i // 3], values, means=component))
    for name in [n for n in history.values if n != "time" and " " not in n and not share]:
        columns.append(RawColumn(name, "-", history.values.pop(name)))
    return RawTable(case.root, tuple(columns), **more)


def run(path: Path, options: Mapping[str, Any]) -> Run:
    """One condition with its history, in the solver's axes.

    Parameters
    ----------
    path : Path
        Folder of the case, or its postProcessing.
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        No forces, forces of which none is the whole body, files that cannot be read; what to do about it.
    """
    given = parse_options(Options, options, "openfoam")
    case = FoamCase(_case_of(path))
    found: dict[str, list[tuple[str, Path]]] = {}
    for name, _, kind, file in found_histories(case.root / "postProcessing"):
        found.setdefault(name, []).append((kind, file))
    if not found:
        raise input_error("tables.never_run", case.root, no_forces=NO_FORCES)
    parts = openfoam_case.function_objects(case, list(found))
    coefficients = {n: all(k in ("forceCoeffs", "coefficient") for k, _ in files) for n, files in found.items()}
    whole = _whole(case, coefficients, parts, given.function)
    remarks: list[str] = []
    histories = {name: oriented(case, files, parts.get(name), remarks) for name, files in found.items()
                 if name in whole or not coefficients[name]}  # fmt: skip
    main = added(case, [histories.pop(n) for n in whole])
    part = parts.get(whole[0])
    known = openfoam_case.known_patches(case, [openfoam_case.body_patches(case, p) for p in parts.values()])
    body = set().union(
        *(openfoam_case.matching_patches(openfoam_case.body_patches(case, parts.get(n)), known) for n in whole)
    )
    if bare := openfoam_case.walls(case) - body:
        case.note(f"constant/polyMesh/boundary: forces of the body leave out the walls {', '.join(sorted(bare))}")
    density, complaints = openfoam_case.stated_density(case, part)
    remarks += complaints
    unit, density = _scaled(case, [main, *histories.values()], density, given.density, remarks)
    point = _reference_point(case, main, part)
    for history in histories.values():
        own = _reference_point(case, history, parts.get(history.name))
        if point is not None and own is not None and own[0] != point[0]:
            moved(history, own, point)
    frame = openfoam_case.rotating_frame(case, given.rotation, body, known)
    has_srf = any((case.root / d / f"Urel{z}").is_file() for d in ("0", "0.orig") for z in ("", ".gz"))
    conditions = openfoam_case.body_motion(case, frame, point, "Urel" if has_srf else "U")
    speed, flow = main.facts.get("magUInf"), conditions.get("U")
    if speed is not None and flow is not None and abs(float(str(flow.value)) - speed[0]) > 0.005 * speed[0]:
        case.note(f"{speed[1]}: magUInf {speed[0]:g} is not the speed {flow.value:.6g} m/s of {flow.place}")
    if any((case.root / "constant" / n).is_file() for n in ("dynamicMeshDict", "dynamicMeshDict.gz")):
        case.note("constant/dynamicMeshDict: the motion of a moving mesh is not read; state it in a list of runs")
    for name, value in (
        ("cells", openfoam_case.stated_cells(case)),
        ("y_plus", openfoam_case.stated_y_plus(case, body)),
    ):
        if value is not None:
            conditions[name] = value
    phrases, broken, ended = openfoam_case.read_log(case, openfoam_case.word(case, "system/controlDict", "application"))
    scheme = openfoam_case.word(case, "system/fvSchemes", "ddtSchemes", "default")
    counted = scheme in ("steadyState", "localEuler")
    time = RawColumn(
        "Time", "s" if scheme and not counted else "", main.values.pop("time"), means="iteration" if counted else "time"
    )
    ending, why = _ending(len(time.values), main, broken, ended)
    stated = _stated(case, main, conditions, density, point, whole)
    if "solver" in phrases:
        stated["source.how_obtained"] = Stated(
            f"{phrases['solver']} of OpenFOAM {phrases.get('version', '')}".strip(), "log of the solver"
        )
    tables = {s: _table(main, s, case, time, unit) for s in main.shares}
    for name, history in histories.items():
        its_time = replace(time, values=history.values.pop("time"))
        tables[name] = _table(history, "", case, its_time, unit)
        remarks += history.remarks
    table = _table(
        main, "", case, time, unit, files=tuple(dict.fromkeys(case.files)), stated=stated,
        dialect={"function object": ", ".join(whole), **phrases}, remarks=(*main.remarks, *remarks, *case.notes),
    )  # fmt: skip
    return Run(case.root, case.root.resolve().name, table, conditions, tables, ending, why, cut=not broken)


def _scaled(
    case: FoamCase,
    all_of_them: Sequence[History],
    density: openfoam_case.NumberAt | None,
    wanted: float,
    remarks: list[str],
) -> tuple[tuple[str, str], openfoam_case.NumberAt | None]:
    """Forces in N of one density; units of forces and moments, and that density."""
    main = all_of_them[0]
    if main.is_coefficients:
        rho, place = density if density is not None else (1.0, "")
        reason = from_coefficients(main, wanted or rho)
        if reason:
            remarks.append(f"{main.name}: coefficients stay as they are, as {reason}")
            return ("-", "-"), density
        if density is None and not wanted:
            remarks.append(f"{main.name}: without a density forces are made those of a fluid of 1 kg/m^3")
        return ("N", "N m"), (wanted, "option density") if wanted else (rho, place or main.facts["magUInf"][1])
    if not wanted:
        return ("N", "N m"), density
    if density is None or not density[0]:
        raise input_error("tables.no_rho_inf", case.root, column="density", name=main.name)
    for history in all_of_them:
        for name in history.values:
            if name != "time":
                history.values[name] = history.values[name] * (wanted / density[0])
    remarks.append(f"forces were turned from {density[0]:g} ({density[1]}) to {wanted:g} kg/m^3")
    return ("N", "N m"), (wanted, "option density")


def _reference_point(case: FoamCase, history: History, part: Foam | None) -> tuple[list[float], str] | None:
    """CofR: of the comments, else of the dictionary."""
    for found in (history.facts.get("CofR"), case.value(part, "CofR")):
        if found is not None and is_vector(found[0]):
            return [float(v) for v in found[0]], found[1]
    return None


def _ending(rows: int, history: History, broken: str, ended: bool) -> tuple[Ended, str]:
    """How the run ended."""
    if not rows:
        return Ended.EMPTY, f"{history.name}: a header and no rows" + (f"; {broken}" if broken else "")
    if history.wild:
        return Ended.DIVERGED, history.wild
    if broken or (history.cut and not ended):
        return Ended.CRASHED, broken or f"{history.cut}: broken off, or still running"
    return Ended.WHOLE, ""


def _stated(
    case: FoamCase, history: History, conditions: Mapping[str, Stated], density: openfoam_case.NumberAt | None,
    point: tuple[list[float], str] | None, whole: Sequence[str],
) -> dict[str, Stated]:  # fmt: skip
    """What the files say of keys of campaign.toml."""
    out = {"table.contains_inertia": Stated(False, f"function object {whole[0]}: forces of the fluid alone")}
    if density is not None:
        out["conditions.density"] = Stated(*density)
    if point is not None:
        out["axes.reference_point"] = Stated(tuple(point[0]), point[1])
    if mirrors := mirror_patches(case):
        place = mirrors.partition(": ")[0]
        out[HALF_MODEL] = Stated("symmetry plane", place, offered=True, contradicted=mirrors)
    speed = history.facts.get("magUInf")
    if "U" in conditions:
        out["conditions.speed"] = conditions["U"]
    elif speed is not None and openfoam_case.is_number(speed[0]):
        out["conditions.speed"] = Stated(float(speed[0]), speed[1])
    if "u" in conditions and any(rate in conditions for rate in "pqr"):
        out["table.arm_point"] = Stated("reference point", conditions["u"].place)
    if (length := history.facts.get("lRef")) is not None and openfoam_case.is_number(length[0]):
        out["scaling.length"] = Stated(float(length[0]), length[1])
    for name in ("transportProperties", "physicalProperties"):
        nu = case.value(case.read(f"constant/{name}"), "nu")
        if nu is not None and openfoam_case.is_number(nu[0]):
            out["conditions.viscosity"] = Stated(float(nu[0]), nu[1])
    return out
