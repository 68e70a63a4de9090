"""CSV tables with units in their headers, beside a campaign.toml that declares what the numbers mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import angle_sign
from coeflab.core.delimited import Cells, read_cells, require_unit
from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.symbols import ANGULAR, COMPONENTS, CONTROL_COLUMNS, LINEAR, MOMENTS, MOTIONS
from coeflab.core.units import Header, factor
from coeflab.kernels.transforms import rigid_body_force
from coeflab.model.campaign import Campaign, Inertia, TableDeclaration
from coeflab.model.force_table import Exclusion, ForceTable

summary = "CSV with units in the headers (beta [deg], Y [N], Y' [-]) and a campaign.toml"
citations = ("sname1950",)

Array = NDArray[np.float64]
ANGLES = ("alpha", "beta")
UNCERTAIN, POINT = "uncertain", "point"
SYMMETRIC = ("X", "Z", "M")
EXAMPLES = {**dict.fromkeys(COMPONENTS, "Y [N]"), "alpha": "alpha [deg]", "beta": "beta [deg]", "r": "r [rad/s]"}


@dataclass(frozen=True, slots=True, eq=False)
class _Raw:
    """Columns in SI, still in the table's own axes."""

    angles: dict[str, Array]
    velocity: dict[str, Array]
    controls: dict[str, Array]
    speed: Array
    forces: dict[str, Array]
    errors: dict[str, Array]
    labels: dict[str, list[str]]


def _kind(name: str) -> tuple[str, str] | None:
    """(role, dimension) of a column by its name, None for an unknown one."""
    plain = name.removesuffix("'")
    force = plain.removeprefix("se_")
    if force in COMPONENTS:
        return ("error" if plain != force else "force"), "moment" if force in MOMENTS else "force"
    if plain in ANGLES and plain == name:
        return "angle", "angle"
    if plain in CONTROL_COLUMNS and plain == name:
        return "control", "angle"
    if plain in LINEAR or name == "U":
        return "speed" if name == "U" else "velocity", "speed"
    return ("velocity", "rate") if plain in ANGULAR else None


def _factor(header: Header, dimension: str, cells: Cells) -> float:
    """SI factor of a column, errors placed at its header."""
    line = cells.first_line - 1
    unit = require_unit(header, cells.file, line, EXAMPLES.get(header.name, f"{header.name} [...]"))
    primed = header.name.endswith("'")
    try:
        return factor(unit, "none" if primed else dimension)
    except UnitsError as why:
        advice = why.advice
        if primed:
            advice = f"A primed column has the unit [-]; for a dimensional one write {header.name[:-1]} [...]."
        elif unit == "-" and dimension in ("force", "moment", "speed", "rate"):
            advice = f"For the nondimensional (prime) form write {header.name}' [-]."
        raise UnitsError(
            why.found, why.expected, file=cells.file, line=line, column=header.text, advice=advice
        ) from None


def _columns(cells: Cells, campaign: Campaign, table: TableDeclaration) -> _Raw:
    n = len(cells)
    raw = _Raw({}, {}, {}, np.full(n, campaign.conditions.speed), {}, {}, {})
    primes: list[tuple[Header, str, Array]] = []
    for header in cells.headers:
        kind = _kind(header.name)
        if header.name in table.ignore:
            continue
        if header.name in (*table.labels, UNCERTAIN, POINT):
            raw.labels[header.name] = cells.texts(header.name)
            continue
        if kind is None:
            known = ", ".join((*ANGLES, "U", *MOTIONS, *CONTROL_COLUMNS, *COMPONENTS))
            raise InputError(
                f"the unknown column {shown(header.text)}",
                f"one of {known}, se_..., {POINT}, {UNCERTAIN}",
                file=cells.file,
                line=cells.first_line - 1,
                column=header.text,
                advice="Name other columns under labels or ignore of the [[table]] in campaign.toml.",
            )
        role, dimension = kind
        values = cells.numbers(header.name) * _factor(header, dimension, cells)
        if header.name.endswith("'"):
            primes.append((header, role, values))
        elif role == "speed":
            raw.speed[:] = values
        elif role == "control":
            raw.controls[CONTROL_COLUMNS[header.name]] = values
        else:
            places = {"angle": raw.angles, "velocity": raw.velocity, "force": raw.forces, "error": raw.errors}
            places[role][header.name.removeprefix("se_")] = values
    if "u" in raw.velocity and "U" not in (h.name for h in cells.headers):
        raw.speed[:] = np.sqrt(np.sum([raw.velocity[c] ** 2 for c in LINEAR if c in raw.velocity], axis=0))
    _check_speed(cells, raw.speed)
    length, density = campaign.scaling.length, campaign.conditions.density
    for header, role, values in primes:
        name = header.name[:-1].removeprefix("se_")
        target = {"velocity": raw.velocity, "force": raw.forces, "error": raw.errors}[role]
        if name in target:
            raise InputError(
                f"{name} and {name}'", "one of them", file=cells.file, line=cells.first_line - 1, column=header.text
            )
        if role == "velocity":
            target[name] = values * raw.speed / (length if name in ANGULAR else 1.0)
        else:
            target[name] = values * 0.5 * density * raw.speed**2 * length ** (3 if name in MOMENTS else 2)
    return raw


def _check_speed(cells: Cells, speed: Array) -> None:
    bad = np.flatnonzero(~(speed > 0.0))
    if bad.size:
        raise InputError(
            f"a speed of {speed[bad[0]]:g} m/s", "a speed above zero", file=cells.file, line=cells.line(int(bad[0])),
            column="U",
        )  # fmt: skip


def _check_settings(cells: Cells, raw: _Raw) -> None:
    """Settings are never blank, and no angle is beyond a half turn."""
    headers = {h.name: h for h in cells.headers}
    back = {short: column for column, short in CONTROL_COLUMNS.items()}
    for name, values in {**raw.angles, **raw.velocity, **raw.controls}.items():
        header = headers.get(back.get(name, name)) or headers[name + "'"]
        blank = np.flatnonzero(np.isnan(values))
        if blank.size:
            raise InputError(
                "a blank cell", "a number", file=cells.file, line=cells.line(int(blank[0])), column=header.text
            )
        if name in raw.angles or name in raw.controls:
            wide = np.flatnonzero(np.abs(values) > np.pi)
            if wide.size:
                raise InputError(
                    f"an angle of {values[wide[0]]:.4g} rad",
                    "an angle within half a turn",
                    file=cells.file,
                    line=cells.line(int(wide[0])),
                    column=header.text,
                    advice=f"If the column is in degrees, write {header.name} [deg].",
                )


def _motion(campaign: Campaign, cells: Cells, raw: _Raw) -> dict[str, Array]:
    """Velocities in FRD."""
    if raw.angles and any(c in raw.velocity for c in LINEAR if c != "u"):
        raise InputError("angles and velocity columns", "one or the other", file=cells.file, line=cells.first_line - 1)
    zero = np.zeros(len(cells))
    angle = {}
    for name in ANGLES:
        if name in raw.angles:
            sign = angle_sign(name, campaign.signs.get(name), campaign.path)
            angle[name] = sign * raw.angles[name]
    alpha, beta = angle.get("alpha", zero), angle.get("beta", zero)
    if angle:
        flow = {"u": np.cos(alpha) * np.cos(beta), "v": np.sin(beta), "w": np.sin(alpha) * np.cos(beta)}
        linear = np.column_stack([raw.speed * flow[c] for c in LINEAR])
    else:
        own = np.column_stack([raw.velocity.get(c, zero) for c in LINEAR])
        linear = own @ campaign.axes.rotation.T
        if np.all(linear[:, 0] == 0.0):
            rest = raw.speed**2 - np.sum(linear**2, axis=1)
            if np.any(rest < 0.0):
                row = int(np.flatnonzero(rest < 0.0)[0])
                raise InputError(
                    "a cross-flow faster than U", "v and w within U", file=cells.file, line=cells.line(row)
                )
            linear[:, 0] = np.sqrt(rest)
    angular = np.column_stack([raw.velocity.get(c, zero) for c in ANGULAR]) @ campaign.axes.rotation.T
    return {**dict(zip(LINEAR, linear.T, strict=True)), **dict(zip(ANGULAR, angular.T, strict=True))}


def _turned(campaign: Campaign, columns: dict[str, Array], signed: bool) -> dict[str, Array]:
    """Force columns in FRD; axes are at right angles, so each goes to one component."""
    out = {}
    for group in (COMPONENTS[:3], COMPONENTS[3:]):
        for i, name in enumerate(group):
            j = int(np.argmax(np.abs(campaign.axes.rotation[i])))
            if group[j] in columns:
                sign = float(campaign.axes.rotation[i, j]) if signed else 1.0
                out[name] = sign * columns[group[j]]
    return out


def _half_model(cells: Cells, raw: _Raw, motion: dict[str, Array]) -> None:
    """Refuse what a half model cannot measure."""
    odd = [c for c in raw.forces if c not in SYMMETRIC]
    moving = [m for m in ("v", "p", "r") if np.any(motion[m] != 0.0)]
    if odd or moving:
        what = f"the antisymmetric {', '.join(odd)}" if odd else f"motion {', '.join(moving)}"
        raise InputError(
            f"{what} on a half model",
            "X, Z, M in symmetric flow",
            file=cells.file,
            line=cells.first_line - 1,
            advice="A symmetry plane cannot carry side force, roll or yaw; compute the whole model for those.",
        )


def _exclusions(
    cells: Cells, campaign: Campaign, table: TableDeclaration, raw: _Raw, frd: dict[str, str]
) -> tuple[dict[str, NDArray[np.bool_]], list[Exclusion]]:
    """Which cells fits may use, and why not the others. ``frd`` maps FRD components to the table's columns."""
    n = len(cells)
    usable = {c: np.ones(n, dtype=bool) for c in frd}
    out: list[Exclusion] = []
    doubtful = raw.labels.get(UNCERTAIN, [""] * n)
    settings = {*raw.angles, *raw.velocity}
    for row in range(n):
        named = doubtful[row].replace(";", " ").split()
        for token in named:
            if token not in raw.forces and token not in settings:
                raise InputError(
                    shown(token), "names of columns, separated by blanks", file=cells.file,
                    line=cells.line(row), column=UNCERTAIN,
                )  # fmt: skip
        for component, column in frd.items():
            value = raw.forces[column][row]
            if column in named or settings & set(named):
                usable[component][row] = False
                reason = "blank in the source" if np.isnan(value) else 'digit doubtful in the source ("uncertain")'
                out.append(Exclusion(row, cells.line(row), component, reason, uncertain=not np.isnan(value)))
            elif np.isnan(value):
                raise InputError(
                    "a blank cell", "a number", file=cells.file, line=cells.line(row), column=column,
                    advice=f'If the source has no readable value there, name {column} under "{UNCERTAIN}".',
                )  # fmt: skip
        for label, wanted in table.select.items():
            if label not in raw.labels:
                raise InputError(
                    f"a selection by {shown(label)}", "a label column of the table", file=campaign.path, column="select"
                )
            if raw.labels[label][row] != wanted:
                reason = f"{label} {raw.labels[label][row]}: {table.select_reason}"
                out.append(Exclusion(row, cells.line(row), "", reason))
                for mask in usable.values():
                    mask[row] = False
    return usable, out


def _without_inertia(
    inertia: Inertia, campaign: Campaign, forces: dict[str, Array], motion: dict[str, Array]
) -> dict[str, Array]:
    """Add what holds the model on its circle, so that the fluid's force remains."""
    centre = np.array(inertia.centre) - campaign.reference_point
    tensor = np.diag(inertia.tensor) + inertia.mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    nu = np.column_stack([motion[m] for m in MOTIONS])
    held = rigid_body_force(inertia.mass, centre, tensor, nu)
    return {c: values + held[:, COMPONENTS.index(c)] for c, values in forces.items()}


def _read_table(campaign: Campaign, table: TableDeclaration) -> ForceTable:
    path = campaign.path.parent / table.file
    cells = read_cells(path)
    digest = sha256_of(path)
    if table.sha256 and table.sha256 != digest:
        raise InputError(
            f"sha256 {digest[:12]}...", f"{table.sha256[:12]}... as campaign.toml declares", file=path,
            advice="The table was changed after it was entered; restore it or update table.sha256.",
        )  # fmt: skip
    raw = _columns(cells, campaign, table)
    _check_settings(cells, raw)
    if not raw.forces:
        raise InputError("no force column", "at least one of X Y Z K M N", file=path, line=cells.first_line - 1)
    motion = _motion(campaign, cells, raw)
    notes = [] if campaign.axes.name == "FRD" else [f"axes turned from {campaign.axes.name} to FRD"]
    own = {c: np.full(1, i, dtype=float) for i, c in enumerate(raw.forces)}
    names = list(raw.forces)
    frd = {c: names[int(v[0])] for c, v in _turned(campaign, own, signed=False).items()}
    usable, exclusions = _exclusions(cells, campaign, table, raw, frd)
    forces = _turned(campaign, raw.forces, signed=True)
    errors = _turned(campaign, raw.errors, signed=False)
    _check_errors(cells, errors)
    if campaign.half_model:
        _half_model(cells, raw, motion)
        forces, errors = ({c: 2.0 * v for c, v in x.items()} for x in (forces, errors))
        notes.append("half model: X, Z, M doubled")
    if any(np.any(motion[m] != 0.0) for m in ANGULAR):
        if table.contains_inertia is None:
            raise InputError(
                "no declaration", "contains_inertia = true or false", file=campaign.path, column="table.contains_inertia",
                advice="A balance on a rotating arm carries the model's inertia, a solver in a rotating frame does not; "
                "for a slender body the sign of Yr' depends on it.",
            )  # fmt: skip
        if table.contains_inertia:
            if campaign.inertia is None:
                raise InputError(
                    "contains_inertia = true without mass",
                    "[inertia] with mass, centre_of_gravity, inertia",
                    file=campaign.path,
                    column="inertia",
                )
            forces = _without_inertia(campaign.inertia, campaign, forces, motion)
            notes.append(f"inertia of the model taken out (m = {campaign.inertia.mass:g} kg)")
    point = raw.labels.get(POINT, [])
    return ForceTable(
        name=f"{campaign.name}/{table.file}",
        campaign=campaign.name,
        title=campaign.title,
        body=campaign.body,
        motion=motion,
        controls=raw.controls,
        speed=raw.speed,
        forces=forces,
        errors=errors,
        usable=usable,
        exclusions=tuple(exclusions),
        labels=tuple(point[i] if point else f"line {cells.line(i)}" for i in range(len(cells))),
        reference_point=campaign.reference_point,
        datum=campaign.datum,
        conditions=campaign.conditions,
        scaling=campaign.scaling,
        source=campaign.source,
        files=(
            InputFile(f"{campaign.name}/{campaign.path.name}", sha256_of(campaign.path)),
            InputFile(f"{campaign.name}/{table.file}", digest),
        ),
        notes=tuple(notes),
    )


def _check_errors(cells: Cells, errors: dict[str, Array]) -> None:
    for component, values in errors.items():
        bad = np.flatnonzero(~(values > 0.0))
        if bad.size:
            raise InputError(
                f"{values[bad[0]]:g}", "a standard error above zero", file=cells.file,
                line=cells.line(int(bad[0])), column=f"se_{component}",
            )  # fmt: skip


def read(campaign: Campaign, only: str | None = None) -> tuple[ForceTable, ...]:
    """Read the tables of a campaign.

    Parameters
    ----------
    campaign : Campaign
    only : str, optional
        File name of the one table that is wanted.

    Returns
    -------
    tuple of ForceTable

    Raises
    ------
    InputError
        Names file, line and column, what was found and what was expected.
    """
    wanted = [t for t in campaign.tables if only is None or Path(t.file).name == only]
    if not wanted:
        known = ", ".join(t.file for t in campaign.tables)
        raise InputError(f"no [[table]] for {shown(only)}", f"one of {known}", file=campaign.path, column="table")
    return tuple(_read_table(campaign, t) for t in wanted)
