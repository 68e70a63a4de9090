"""Vehicle models of the Marine Systems Simulator (MSS): ``.m`` files whose coefficients are plain assignments."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import JSON_BYTES
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.table import Check, as_check
from coeflab.core.text.toml import read_text
from coeflab.core.texts import input_error
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.formats.left_out import left_out
from coeflab.formats.mss.m_file import (
    DENSITIES,
    GRAVITIES,
    LENGTHS,
    MASSES,
    MFile,
    MValues,
    added_mass,
    foreign_values,
    is_acceleration,
    is_derivative,
    read_m_file,
)
from coeflab.formats.stated_coefficients import matrix_doubts
from coeflab.formats.stated_file import MODEL_ORIGIN, Law, Stated, stated_file
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.rigid_body import MassProperties, ideal_quadratics, inertia_doubt, parallel_axis
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, CONTROLS
from coeflab.vehicle.imported_numbers import SLUGS, Written, gravity, gyration, munk_twice, no_mass, water, weight
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface

summary = "MSS .m files with plain assignments: primed or SI derivatives, slug and foot units recognised by rho or g"
citations = ("sname1950", "fossen2011", "mss")
reads = "MSS .m"
signs = "MSS takes Xudot ... and damping such as Yv negative."

# Squares that stand for x |x|: damping, and by each motion's own the rest of what it does across, as Prestero writes Nvv, Yrr, Mww, Zqq.
OWN_AXES = {"u": "Xuu", "v": "Yvv", "w": "Zww", "p": "Kpp", "q": "Mqq", "r": "Nrr"}
ODD = re.compile(r"[YKN](vv|pp|rr)|[ZM](ww|qq)|Xuu")
TURNING = ("Nv", "Nuv", "Mw", "Muw")


def recognises(path: Path) -> bool:
    """Whether the file assigns a number to a derivative, as an m-file does."""
    text = read_text(path, JSON_BYTES)
    other = re.search(
        r"^(\[+[A-Za-z_][\w.\"'-]*\]+[ \t]*(#.*)?|[ \t-]*[a-z][\w ]*:[ \t]*)$", text, re.MULTILINE
    )  # TOML, YAML
    assigned = re.search(
        r"^[^%#\n]*(\b[XYZKMN]\w*[ \t]*=[ \t]*[-+.\d(\w]|=[ \t]*(imlay61|spheroid)[ \t]*\()", text, re.MULTILINE
    )
    return text.lstrip()[:1] not in ("<", "{") and other is None and assigned is not None


def read(path: Path, density: float | None = None) -> ParameterFile:
    """Read a model file.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where the file states none.

    Raises
    ------
    InputError
        No derivative or no density in it, a derivative that is no plain arithmetic or has two values.
    """
    found = read_m_file(path)
    source = InputFile(path.name, sha256_of(path))
    stated = _own(found, path) if "coeflab" in found.numbers else _foreign(found, path, density)
    return stated_file(stated, [source], citations)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    found = read_m_file(path)
    if "coeflab" in found.numbers:
        own = MValues(*_own_conditions(found, path), True, False, {s: v for s, (_, v) in found.derivatives.items()})
        return _munk(found, own)
    values = foreign_values(found, path, density=1.0)
    return (*_units(found, values), *_munk(found, values), *_capsizes(found))


def _units(found: MFile, values: MValues) -> list[Check]:
    out: list[Check] = []
    mass, forces = found.named(*MASSES), found.named("W")
    if rho := found.named(*DENSITIES):
        out.append(
            as_check("mss", Finding.of("model.in_slugs", f"density {rho[0]}", Severity.NOTE, statistic=rho[1], low=SLUGS[0], high=SLUGS[1]))
            if values.imperial
            else water("mss", rho[1], f"density {rho[0]}")
        )  # fmt: skip
        if (g := found.named(*GRAVITIES)) and not values.imperial:
            out += gravity("mss", g[1], g[0])
        if mass and forces and not values.imperial:
            out += weight("mss", forces[1], mass[1], f"{forces[0]} and {mass[0]}")
    if mass:
        out += no_mass("mss", mass[1], mass[0])
        if rho and found.named("xG", "x_G", "xg") is None and not values.primed:
            hull = np.diag(values.added_mass)
            out += gyration("mss", mass[1] * values.units[0], values.conditions.density, hull[1], hull[5])
    return out


def _munk(found: MFile, values: MValues) -> tuple[Check, ...]:
    """Where the file adds C_A(nu) nu; one whose entries it sets afterwards cannot be told."""
    if not found.adds_coriolis or found.changes_coriolis:
        return ()
    ideal = ideal_quadratics(values.added_mass)
    written = []
    for symbol in TURNING:
        if symbol not in values.values:
            continue
        stays = values.stays(symbol) or found.derivatives[symbol][0] == "rest"
        value = (
            values.values[symbol] * values.scaling.unit(symbol, values.conditions.density, values.conditions.speed)
            if stays
            else values.product(symbol)
        )
        written.append(Written(symbol[0], symbol, float(value), not stays))
    return munk_twice("mss", written, ideal, ideal)


def _capsizes(found: MFile) -> tuple[Check, ...]:
    """A centre of gravity above that of buoyancy, which with z down is the smaller z."""
    gravity_at, buoyancy_at = found.named("zG", "z_G", "zg"), found.named("zB", "z_B", "zb")
    above = (buoyancy_at[1] if buoyancy_at else 0.0) - (gravity_at[1] if gravity_at else 0.0)
    if gravity_at is None or above <= 0.0:
        return ()
    keys = gravity_at[0] + (f" and {buoyancy_at[0]}" if buoyancy_at else "")
    return (as_check("mss", Finding.of("model.capsizes", keys, Severity.WARN, statistic=above)),)


def _own_conditions(found: MFile, path: Path) -> tuple[Scaling, Conditions]:
    n = found.numbers
    missing = [k for k in ("rho", "U0", "L", "x_ref", "y_ref", "z_ref") if k not in n]
    if missing:
        raise input_error("formats.facts_lack", path, missing=", ".join(missing))
    return Scaling(n["L"], found.texts.get("L_name", "L")), Conditions(n["rho"], n["U0"], n.get("viscosity"))


def _own(found: MFile, path: Path) -> Stated:
    """A file that the exporter wrote: nothing is guessed."""
    n = found.numbers
    scaling, at = _own_conditions(found, path)
    coefficients: dict[str, tuple[float, Law]] = {}
    matrix, method = None, found.texts.get("MA_method")
    doubts: tuple[str, ...] = ()
    if method is not None:
        stated = {s: v * scaling.unit(s, at.density) for s, (_, v) in found.derivatives.items() if is_acceleration(s)}
        matrix = added_mass(stated)
        doubts = matrix_doubts(matrix)
        matrix = None if doubts else matrix
    for symbol, (group, value) in found.derivatives.items():
        if group == "rest":
            coefficients[symbol] = (value / scaling.unit(symbol, at.density, at.speed), "rest")
        elif matrix is None or not is_acceleration(symbol):
            coefficients[symbol] = (value, "motion")
    return Stated(
        name=found.texts.get("name", "")[:200] or path.stem,
        body=found.texts.get("body", "")[:200] or path.stem,
        scaling=scaling,
        conditions=at,
        coefficients=coefficients,
        point=(n["x_ref"], n["y_ref"], n["z_ref"]),
        datum=Datum.named(found.texts.get("datum", MODEL_ORIGIN.id)),
        matrix=matrix,
        matrix_body=found.texts.get("MA_body", ""),
        matrix_method=method or "stated",
        mass=_own_mass(n),
        surfaces=tuple(
            ParameterSurface(control=c, limit=n[f"limit_{c}"], rate=n.get(f"rate_{c}"))
            for c in CONTROLS
            if f"limit_{c}" in n
        ),
        notes=doubts,
        findings=(
            *left_behind(found, path.stem, OWN_NUMBERS),
            *left_out(path.stem, "terms", ["look-up tables of the function tabled"] * found.tabled),
            *left_out(path.stem, "actuators", ["thrusters of the function driven"] * found.driven),
        ),
    )


def _own_mass(n: Mapping[str, float]) -> MassProperties | None:
    if "m" not in n or "mxG" not in n:
        return None
    centre = [n[k] for k in ("xG", "yG", "zG") if k in n]
    inertia = [n[f"I{i}{j}"] for i in (1, 2, 3) for j in (1, 2, 3) if f"I{i}{j}" in n]
    return MassProperties(
        n["m"],
        n["mxG"],
        n.get("I_transverse"),
        np.array(centre) if len(centre) == 3 else None,
        np.array(inertia).reshape(3, 3) if len(inertia) == 9 else None,
    )


def _foreign(found: MFile, path: Path, density: float | None) -> Stated:
    """Somebody's own model: viscous parts become totals where the file adds C_A(nu) nu itself."""
    v = foreign_values(found, path, density)
    notes = []
    if v.imperial:
        words = [f"{k} = {x:g}" for k, x in filter(None, (found.named(*DENSITIES), found.named(*GRAVITIES)))]
        notes.append(f"slug, foot and pound, recognised by {', '.join(words)}; converted to SI")
    name = v.scaling.length_name
    notes.append(f"lengths made dimensionless by {name}" + ("" if name != "1 m" else ": the file states none"))
    notes.append(
        "primed derivatives, recognised by r2 = rho*L^2/2 and the like; U is taken where the file's own equations may have u"
        if v.primed
        else "dimensional derivatives: forces do not scale with U unless the velocities in the name say so"
    )
    matrix = v.added_mass
    doubts = matrix_doubts(matrix)
    selected = matrix if found.adds_coriolis and not doubts else None
    notes += [*doubts, _coriolis_note(found, selected is not None)]
    hull = None if selected is None else AddedMass(selected, np.zeros(3), MODEL_ORIGIN, path.stem, "stated")
    coefficients: dict[str, tuple[float, Law]] = {}
    squares: dict[str, str] = {}
    for symbol, value in v.values.items():
        if selected is not None and is_acceleration(symbol):
            continue
        damping = f"{symbol[:2]}|{symbol[2:]}|"
        own_axis = OWN_AXES.get(symbol[-1], "") if ODD.fullmatch(symbol) else ""
        if v.values.get(own_axis, 0.0) < 0.0 and damping not in v.values:
            squares[symbol] = damping
            coefficients[damping] = (value, "motion")
            continue
        rest = v.stays(symbol)
        own = 0.0 if hull is None or rest else potential_part(symbol, hull, v.scaling, v.conditions.density) or 0.0
        coefficients[symbol] = (value + own, "rest" if rest else "motion")
    if squares:
        both = ", ".join(f"{a} read as {b}" for a, b in squares.items())
        notes.append(f"{both}: odd in the motion")
    findings: list[Finding] = []
    mass = _mass(found, v, findings, path.stem)
    afloat = _hydrostatics(found, v)
    taken = [*READ, *found.calls, *(() if mass is None else (*MASSES, *ABOUT, *AXES_OF_INERTIA))]
    taken += [] if mass is None or mass.inertia_matrix is None else INERTIAS
    taken += [] if afloat is None else [*BUOYANCIES, *CENTRES_B]
    if found.calls:
        findings.append(Finding.of("model.imlay", path.stem, Severity.NOTE, names=found.calls))
    return Stated(
        name=path.stem[:200], body=path.stem[:200], scaling=v.scaling, conditions=v.conditions, coefficients=coefficients,
        matrix=selected, mass=mass, hydrostatics=afloat, notes=tuple(notes),
        findings=(*left_behind(found, path.stem, tuple(taken)), *findings),
    )  # fmt: skip


# What a name of a number that is not read means; the first that fits.
MEANS = (
    ("hydrostatics", re.compile(r"[WB]|Weight|Buoyancy|[xyz]_?[gbGB]|nabla|Vol\w*|BG\w*|r_?[bg]_?\w*")),
    ("inertia", re.compile(r"m|mass|I_?[xyz]{1,2}|I\d\d|[Rr]\d\d|k_?[xyz]{2}")),
    ("strips", re.compile(r"C_?[dD]_?[xyzc]?\w?")),
    ("propulsion", re.compile(r"n_?prop\w*|n_?max|[Dd]_?prop\w*|w_?(ake|frac)?|t_?(hr|ded)\w*|[KTQ]_?[tqTQ]_?\w*|Tau\w*|tau\w*|prop\w*|eta|eps\w*|[XKMN]prop")),
    ("terms", re.compile(r"[XYZKMN][a-z]\w*")),
)  # fmt: skip
ABOUT = ("xG", "x_G", "xg", "yG", "y_G", "yg", "zG", "z_G", "zg")
AXES_OF_INERTIA = ("Iy", "Iyy", "Iz", "Izz")
INERTIAS = ("Ix", "Ixx", "Iy", "Iyy", "Iz", "Izz", "Ixy", "Ixz", "Iyz")
APART = (0.2, 5.0)  # B over m g of what may be a buoyancy; beyond, B is a breadth
BUOYANCIES = ("B", "Buoyancy", "nabla", "Vol", "V_disp")
CENTRES_B = ("xB", "x_B", "xb", "yB", "y_B", "yb", "zB", "z_B", "zb")
EQUATIONS = re.compile(r"tau\w*|D|Dmtrx|g|X_\w+|Y_\w+|Z_\w+|K_\w+|M_\w+|N_\w+")
READ = (*DENSITIES, *GRAVITIES, *LENGTHS, "U0", "U", "r2", "r3", "r4", "r5")
OWN_NUMBERS = (*READ, *MASSES, "coeflab", "x_ref", "y_ref", "z_ref", "viscosity", "mxG", "xG", "yG", "zG", "I_transverse",
               *(f"{kind}_{c}" for kind in ("limit", "rate") for c in CONTROLS),
               *(f"I{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)))  # fmt: skip


def left_behind(found: MFile, subject: str, read: tuple[str, ...]) -> tuple[Finding, ...]:
    """What the file states and this reader has no place for.

    Parameters
    ----------
    found : MFile
    subject : str
        Whom the findings are about.
    read : tuple of str
        Names that the reader takes, beside derivatives.
    """
    taken = found.needed([*(n for n in found.numbers if is_derivative(n)), *read])
    kinds: dict[str, list[str]] = {}
    for name in found.numbers:
        if name not in taken:
            kind = next((k for k, means in MEANS if means.fullmatch(name)), "numbers")
            kinds.setdefault(kind, []).append(name)
    own = "coeflab" in found.numbers  # its equations are the exporter's
    equations = [
        f"{n} (line {line})"
        for n, line in found.unread.items()
        if not own and (n in COMPONENTS or EQUATIONS.fullmatch(n))
    ]
    return (
        *(f for kind, names in kinds.items() for f in left_out(subject, kind, names)),
        *left_out(subject, "equations", equations),
    )


def _coriolis_note(found: MFile, has_coriolis: bool) -> str:
    if has_coriolis and found.changes_coriolis:
        return "the file adds C_A(nu) nu and then sets entries of it, which is not read: totals here include all of it"
    if has_coriolis:
        return "the file adds C_A(nu) nu itself: its derivatives are viscous, totals are written here"
    if found.adds_coriolis:
        return "the file adds C_A(nu) nu itself, which this added mass does not allow: its products are left out"
    return "no C_A(nu) in the file: products of velocities that it does not name are taken as zero"


def _point(found: MFile, letter: str, unit: float) -> np.ndarray | None:
    """A centre from the origin, m: xG yG zG, or a vector r_bg; what is not stated of it is zero, None where nothing is."""
    parts = [found.first(*(f"{axis}{form}" for form in (letter, f"_{letter}", letter.lower()))) for axis in "xyz"]
    if any(p is not None for p in parts):
        return np.array([0.0 if p is None else p * unit for p in parts])
    named = (f"r_b{letter}", f"r_b{letter.lower()}", f"r_{letter.lower()}", f"r_{letter}", f"r{letter}")
    vector = next((found.vectors[n] for n in named if n in found.vectors), None)
    return None if vector is None else np.array(vector) * unit


def _mass(found: MFile, v: MValues, findings: list[Finding], subject: str) -> MassProperties | None:
    """Mass where the centre of gravity is known too; in a file of primes a mass below one is a prime.

    Moments of inertia are about the origin, as MSS's rigid-body matrices of such files take them; those of `spheroid` about the centre.
    """
    mass_unit, length_unit = v.units
    mass, centre = found.first(*MASSES), _point(found, "G", length_unit)
    if mass is None or centre is None or mass <= 0.0:
        return None
    prime = v.primed and mass < 1.0
    kilograms = mass * v.scaling.unit("m", v.conditions.density) if prime else mass * mass_unit
    rolling, pitch, yaw = (found.first(*names) for names in (("Ix", "Ixx"), ("Iy", "Iyy"), ("Iz", "Izz")))
    square = mass_unit * length_unit**2
    transverse = pitch * square if pitch is not None and pitch == yaw and pitch > 1.0 else None
    matrix = None
    if rolling is not None and pitch is not None and yaw is not None and (not v.primed or pitch > 1.0):
        xy, xz, yz = (found.first(n) or 0.0 for n in ("Ixy", "Ixz", "Iyz"))
        matrix = square * np.array([[rolling, -xy, -xz], [-xy, pitch, -yz], [-xz, -yz, yaw]])
        if "spheroid" in found.calls:
            matrix = matrix + parallel_axis(kilograms, centre)
        if doubt := inertia_doubt(kilograms, centre, matrix):
            findings.append(Finding.of("model.no_inertia", subject, Severity.FAIL, why=doubt))
            matrix = transverse = None
    if matrix is not None and "spheroid" in found.calls:
        transverse = float(matrix[1, 1]) if abs(matrix[1, 1] - matrix[2, 2]) < 1e-9 * matrix[1, 1] else None
    return MassProperties(kilograms, kilograms * float(centre[0]), transverse, centre, matrix)


def _hydrostatics(found: MFile, v: MValues) -> ParameterHydrostatics | None:
    """Of the buoyancy B in the file's unit of force, or of a volume nabla; with the centre of buoyancy that it states."""
    mass_unit, length_unit = v.units
    centre = _point(found, "B", length_unit)
    buoyancy, volume = found.named("B", "Buoyancy"), found.named("nabla", "Vol", "V_disp")
    strength = found.first(*GRAVITIES)
    g = STANDARD_GRAVITY if strength is None else strength * length_unit
    if centre is None or not g > 0.0:
        return None
    mass = found.first(*MASSES)
    is_breadth = (
        not v.primed
        and mass is not None
        and mass > 0.0
        and not APART[0] < (buoyancy or ("", 0.0))[1] * length_unit / (mass * g) < APART[1]
    )
    if volume is not None:
        displaced = volume[1] * length_unit**3
    elif buoyancy is not None and not is_breadth:
        displaced = buoyancy[1] * mass_unit * length_unit / (v.conditions.density * g)
    else:
        return None
    if not displaced > 0.0:
        return None
    x, y, z = centre.tolist()
    return ParameterHydrostatics(volume=displaced, centre_of_buoyancy=(x, y, z), gravity=g)
