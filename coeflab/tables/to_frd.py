"""From the columns of any importer to a ForceTable: axes, angle signs, half models, inertia, exclusions.

Columns of a table in SI but in its own axes: what every importer makes of its file before the common turn to FRD.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE, Axes, angle_sign
from coeflab.core.errors import InputError, shown, together
from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.law.rigid_body import rigid_body_force
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOMENTS, MOTIONS
from coeflab.tables.assumptions import assumed
from coeflab.tables.campaign import CENTRES, SIDES, SIGNED, Campaign, Cut, TableDeclaration, TowedInertia, cut_of
from coeflab.tables.column_map import WIND
from coeflab.tables.force_table import DRIVEN, FEWEST_SPEEDS, Declared, Exclusion, ForceTable, running_rows


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """Columns in SI, by their plain names, in the axes that the campaign declares.

    Attributes
    ----------
    file : Path
    header_line : int
    lines : tuple of int
        Line number of every row.
    headers : dict of str to str
        Header of a column as written, by its plain name (``Y`` for ``Y' [-]``).
    angles : dict of str to array
        ``alpha``, ``beta`` in radians, in the sign that the table uses.
    velocity : dict of str to array
        u v w p q r, m/s and rad/s.
    controls : dict of str to array
        ``dr``, ``ds``, ``db`` in radians.
    speed : (n,) array
        U, m/s.
    forces, errors : dict of str to array
        X Y Z K M N and their standard errors, N and N m; NaN where blank. Of ``drag``, ``lift`` (up) and ``side`` (to
        starboard), along and across the flow, `in_body_axes` makes X, Y and Z.
    labels : dict of str to list of str
    doubtful : tuple of frozenset of str
        For every row the plain names of columns whose digits are doubtful in the source.
    row_labels : tuple of str
        One short name per row.
    files : tuple of Path
        What was read, where ``file`` is a folder.
    radius : (n,) array or None
        Column R, from the arm point to the centre of the circle, m; in the place of p, q and r.
    density : (n,) array or None
        Of the water of every row, kg/m^3; by default the campaign's.
    propeller : dict of str to array
        ``rps`` in rad/s, ``J``, ``thrust`` in N; NaN where blank.
    """

    file: Path
    header_line: int
    lines: tuple[int, ...]
    headers: Mapping[str, str]
    angles: Mapping[str, Array]
    velocity: Mapping[str, Array]
    controls: Mapping[str, Array]
    speed: Array
    forces: Mapping[str, Array]
    errors: Mapping[str, Array]
    labels: Mapping[str, list[str]]
    doubtful: tuple[frozenset[str], ...]
    row_labels: tuple[str, ...] = field(default=())
    files: tuple[Path, ...] = ()
    radius: Array | None = None
    density: Array | None = None
    propeller: Mapping[str, Array] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.lines)

    def fail(self, code: str, *, row: int | None = None, name: str = "", **facts: object) -> InputError:
        """An error about one cell, a column or the header, to be raised by the caller; of a folder by the name of the run."""
        is_folder = self.file.is_dir()
        line = None if is_folder else self.header_line or None if row is None else self.lines[row]
        where = f" in {self.row_labels[row]}" if is_folder and row is not None and self.row_labels else ""
        return input_error(code, self.file, line, self.headers.get(name, name) or None, where=where, **facts)

    @property
    def digest(self) -> str:
        """Hexadecimal sha256 of the numbers, for columns that no file holds."""
        out = sha256()
        for part in (self.angles, self.velocity, self.controls, {"U": self.speed}, self.forces, self.errors):
            for name in sorted(part):
                out.update(name.encode() + np.ascontiguousarray(part[name], dtype="<f8").tobytes())
        return out.hexdigest()

    @property
    def settings(self) -> dict[str, Array]:
        """What the test was set to: angles, velocities, control angles."""
        return {**self.angles, **self.velocity, **self.controls}

    def check(self) -> None:
        """Refuse settings that are blank, angles beyond a half turn, and standard errors that are none.

        Raises
        ------
        InputError
            By line and column; of every column the first cell.
        """
        if complaints := list(self._complaints()):
            raise together(complaints)

    def _complaints(self) -> Iterator[InputError]:
        if not self.forces:
            yield self.fail("tables.no_force_column")
        if (row := _first(~(self.speed > 0.0))) is not None:
            found = "a blank cell" if np.isnan(self.speed[row]) else f"a speed of {self.speed[row]:g} m/s"
            yield self.fail("tables.speed_of_row", row=row, name="U", found=found)
        if self.density is not None and (row := _first(~(self.density > 0.0))) is not None:
            found = "a blank cell" if np.isnan(self.density[row]) else f"a density of {self.density[row]:g} kg/m^3"
            yield self.fail("tables.density_of_row", row=row, name="density", found=found)
        for name, values in self.settings.items():
            if (row := _first(np.isnan(values))) is not None:
                yield self.fail("tables.blank_cell", row=row, name=name)
                continue
            if name in self.velocity or (row := _first(np.abs(values) > np.pi)) is None:
                continue
            yield self.fail(
                "tables.angle_beyond_half_turn", row=row, name=name, angle=values[row], plain=self.headers[name].partition(" [")[0],
            )  # fmt: skip
        for name, values in self.errors.items():
            if name not in self.forces:
                yield self.fail("tables.error_without_force", name=f"se_{name}", force=name)
                continue
            unused = np.isnan(self.forces[name]) & np.isnan(values)
            if (row := _first(~(values > 0.0) & ~unused)) is not None:
                found = "a blank cell" if np.isnan(values[row]) else f"{values[row]:g}"
                yield self.fail("tables.standard_error_of_row", row=row, name=f"se_{name}", found=found)


def _first(where: NDArray[np.bool_]) -> int | None:
    rows = np.flatnonzero(where)
    return int(rows[0]) if rows.size else None


BLANK, MARKED = "blank in the source", 'marked "uncertain" in the source'
STRAIGHT, SIDEWAYS = 1e-12, 1e-3  # sine of an angle that is none; cosine of one beyond which Y says nothing of C
SAME_DENSITY = 1e-3  # relative, as runs of one table may differ
ONE_AXIS = 1e-9  # of the largest rate: smaller ones are rounding
TAKEN_OUT = "inertia of the model subtracted"
HALF = "half model"


def force_table(columns: Columns, campaign: Campaign, table: TableDeclaration) -> ForceTable:
    """Turn columns into the fluid's force on the body in FRD about the campaign's reference point.

    Moments that the table has about a point of its own are moved; one whose move needs a force that the table lacks is left
    left out, which the notes say. Lift and drag are turned to body axes, see `in_body_axes`.

    Raises
    ------
    InputError
        A cell that cannot be, or something that campaign.toml leaves open or contradicts.
    """
    columns.check()
    digest = sha256_of(columns.file, columns.files) if columns.file.exists() else columns.digest
    if table.sha256 and table.sha256 != digest:
        raise input_error("tables.table_changed", columns.file, digest=digest[:12], sha256=table.sha256[:12])
    if complaints := list(_undeclared(columns, campaign, table)):
        raise together(complaints)
    point = campaign.reference_point if table.reference_point is None else table.reference_point
    motion = _motion(columns, campaign, table, point)
    notes = [] if campaign.axes.name == "FRD" else [f"axes turned from {campaign.axes.name} to FRD"]
    if wind := [c for c in WIND if c in columns.forces]:
        columns = in_body_axes(columns, campaign)
        still = [f"{a} = 0" for a in ("alpha", "beta") if columns.angles and a not in columns.angles]
        notes.append(
            f"{', '.join(wind)} turned to body axes by the flow of each row" + f" ({', '.join(still)})" * bool(still)
        )
    sources = columns_of(campaign.axes)
    usable, exclusions = _exclusions(columns, campaign, table, {c: s for c, (s, _) in sources.items()})
    if table.contains_thrust is not False:
        exclusions = (*exclusions, *_driven(columns, usable))
    forces = {c: sign * columns.forces[s] for c, (s, sign) in sources.items() if s in columns.forces}
    errors = {c: columns.errors[s] for c, (s, _) in sources.items() if s in columns.errors}
    if columns.radius is not None:
        notes.append(f"rates from U and R, centre of the circle: {table.centre}")
    if table.arm_point is not None and np.any(table.arm_point != point):
        notes.append(f"U and velocities are those of {_place(table.arm_point)}, moved from there")
    half = campaign.half_model if table.half_model is None else table.half_model
    if (cut := cut_of(half)) is not None:
        _require_symmetry(columns, cut, forces, motion)
        forces, errors = ({c: 2.0 * v for c, v in x.items()} for x in (forces, errors))
        notes.append(f"{HALF}{f' ({half})' if isinstance(half, str) else ''}: {', '.join(cut.doubled)} doubled")
    turns = any(np.any(motion[m] != 0.0) for m in ANGULAR)
    if turns and table.contains_inertia and campaign.inertia is not None:
        forces = _without_inertia(campaign, campaign.inertia, point, forces, motion)
        notes.append(f"{TAKEN_OUT} (m = {campaign.inertia.mass:g} kg)")
    result = ForceTable(
        name=f"{campaign.name}/{table.file}",
        campaign=campaign.name,
        title=campaign.title,
        body=campaign.body,
        motion=motion,
        controls=columns.controls,
        speed=columns.speed,
        forces=forces,
        errors=errors,
        usable=usable,
        exclusions=exclusions,
        labels=columns.row_labels or tuple(f"line {line}" for line in columns.lines),
        reference_point=point,
        datum=campaign.datum,
        conditions=campaign.conditions,
        scaling=campaign.scaling,
        source=campaign.source,
        files=(
            *(
                [InputFile(f"{campaign.name}/{campaign.path.name}", sha256_of(campaign.path))]
                if campaign.path.exists()
                else []
            ),
            InputFile(f"{campaign.name}/{table.file}", digest),
        ),
        notes=tuple(notes),
        findings=tuple(_assumed(columns, campaign, table, motion)),
        lines=columns.lines,
        density=columns.density,
        propeller=columns.propeller,
        model_mass=None if campaign.inertia is None else campaign.inertia.mass,
        arm_point=table.arm_point,
        symmetry=campaign.symmetry,
        by_symmetry=f"{campaign.name}/{table.by_symmetry}" if table.by_symmetry else "",
        assumed=campaign.assumed,
        declared=Declared(
            campaign.axes.name,
            tuple(campaign.signs.items()),
            tuple(map(float, point)),
            campaign.notes,
            "" if table.source_sha256 is None else str(table.source_sha256),
            tuple((name, float(value)) for name, value in table.constant.items()),
        ),
        primed=frozenset(c for c, (s, _) in sources.items() if columns.headers.get(s, "").startswith(f"{s}'")),
    )
    return result.about(campaign.reference_point)


def _assumed(
    columns: Columns, campaign: Campaign, table: TableDeclaration, motion: Mapping[str, Array]
) -> Iterator[Finding]:
    """What of a table no source states, and what it is taken for."""
    name = f"{campaign.name}/{table.file}"
    point = campaign.reference_point if table.reference_point is None else table.reference_point
    of = {"table": table, "axes": campaign, "scaling": campaign.scaling, "conditions": campaign.conditions}
    words = {"axes.reference_point": _place(point), "table.centre": f"to {table.centre}"}
    at = point if table.arm_point is None else table.arm_point
    same = "the reference point, " if not np.any(at != point) else ""
    words["table.arm_point"] = f"{same}{_place(at)} from the {campaign.datum.id}"
    words |= {f"axes.{angle}": campaign.signs.get(angle, "") for angle in campaign.assumed}
    words["coefficients.area"] = f"1/2 rho U^2 L^2 with L = {campaign.scaling}"
    keys = [*table.assumed, *(f"axes.{angle}" for angle in campaign.assumed if angle in columns.angles)]
    keys += ["table.arm_point"] * (table.arm_point is None and bool(np.any(motion["q"]) or np.any(motion["r"])))
    for key in dict.fromkeys(keys):
        section, _, plain = key.partition(".")
        value = words.get(key) or getattr(of.get(section), plain, "")
        if section == "columns":
            value = columns.headers.get(plain, plain)
        yield assumed(key, name, value, Severity.NOTE if key in ("axes.alpha", "axes.beta") else Severity.WARN)
    still = np.all([columns.velocity.get(c, 0.0) == np.zeros(len(columns)) for c in LINEAR], axis=0)
    if "U" not in columns.headers and surge_column(campaign) in columns.velocity and np.any(still):
        yield Finding.of(
            "assumed.on_the_spot", name, Severity.NOTE, statistic=campaign.conditions.speed, rows=int(still.sum())
        )


def _place(point: Array) -> str:
    return f"({', '.join(f'{x:.6g}' for x in point)}) m"


def _undeclared(columns: Columns, campaign: Campaign, table: TableDeclaration) -> Iterator[InputError]:
    """Everything that campaign.toml leaves open or contradicts about a table: the density of its forces, and an arm."""
    result, declared = table.forces_density, campaign.conditions.density
    in_newton = any(not columns.headers.get(c, c).startswith(f"{c}'") for c in columns.forces)
    if result is not None and columns.density is None and in_newton and abs(declared - result) > SAME_DENSITY * result:
        yield input_error(
            "tables.other_forces_density", campaign.path, key="conditions.density", declared=declared, result=result, path=table.file,
        )  # fmt: skip
    rates = [c for c in ANGULAR if c in columns.velocity]
    turns = [*(c for c in MOMENTS if c in columns.forces), *rates, *["R"] * (columns.radius is not None)]
    if campaign.datum == ANYWHERE and turns:
        yield input_error(
            "tables.datum_anywhere", campaign.path, key="axes.datum", id=shown(ANYWHERE.id), turns=", ".join(turns)
        )
    if columns.radius is not None:
        if rates:
            yield columns.fail("tables.radius_beside_rates", name="R", rates=", ".join(rates))
        if not table.centre:
            yield campaign.fail(table, "centre", "tables.no_centre", centres=", ".join(map(shown, CENTRES)))
        if table.arm_point is None:
            yield campaign.fail(
                table, "arm_point", "tables.no_arm_point", reference_point=[float(x) for x in campaign.reference_point]
            )
    elif table.centre:
        yield campaign.fail(table, "centre", "tables.centre_without_radius")
    turning = columns.radius is not None or any(np.any(columns.velocity[c] != 0.0) for c in rates)
    if turning and table.contains_inertia is None:
        yield campaign.fail(table, "contains_inertia", "tables.inertia_of_arm_not_declared")
    if turning and table.contains_inertia and campaign.inertia is None:
        yield campaign.fail(table, "contains_inertia", "tables.inertia_of_arm_without_mass")


def _motion(columns: Columns, campaign: Campaign, table: TableDeclaration, point: Array) -> dict[str, Array]:
    """Velocities in FRD at a point."""
    linear = _linear(columns, campaign)
    zero = np.zeros(len(columns))
    if columns.radius is None:
        angular = np.column_stack([columns.velocity.get(c, zero) for c in ANGULAR]) @ campaign.axes.rotation.T
    else:
        angular = _on_circle(columns, table.centre, linear)
    if table.arm_point is not None:
        linear = linear + np.cross(angular, point - table.arm_point)
    return {**dict(zip(LINEAR, linear.T, strict=True)), **dict(zip(ANGULAR, angular.T, strict=True))}


def _linear(columns: Columns, campaign: Campaign) -> Array:
    """Velocities u v w in FRD, (n, 3), at the point that the table states them for."""
    linear_columns = [c for c in LINEAR if c in columns.velocity]
    if columns.angles and linear_columns:
        raise columns.fail("tables.angles_beside_velocities", linear_columns=", ".join(linear_columns))
    zero = np.zeros(len(columns))
    angle = {
        name: angle_sign(name, campaign.signs.get(name), campaign.path) * values
        for name, values in columns.angles.items()
    }
    alpha, beta = angle.get("alpha", zero), angle.get("beta", zero)
    if angle:
        flow = (np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta))
        linear = np.column_stack([columns.speed * part for part in flow])
    else:
        own = np.column_stack([columns.velocity.get(c, zero) for c in LINEAR])
        linear = own @ campaign.axes.rotation.T
        if surge_column(campaign) not in columns.velocity:
            rest = columns.speed**2 - np.sum(linear**2, axis=1)
            if np.any(rest < 0.0):
                row = int(np.flatnonzero(rest < 0.0)[0])
                raise columns.fail("tables.cross_flow_faster", row=row)
            linear[:, 0] = np.sqrt(rest)
    return np.asarray(linear)


def in_body_axes(columns: Columns, campaign: Campaign) -> Columns:
    """Lift, drag and side force as X, Y, Z in the declared axes, by the flow of each row.

    With L up, D aft and C to starboard, across and along the flow, and a, b of u = U cos(a) cos(b), v = U sin(b),
    w = U sin(a) cos(b), in FRD::

        X = -D cos(a) cos(b) - C cos(a) sin(b) + L sin(a)
        Y = -D sin(b)        + C cos(b)
        Z = -D sin(a) cos(b) - C sin(a) sin(b) - L cos(a)

    Where the table has Y of the body in the place of C, C = (Y + D sin(b)) / cos(b). The flow is that of the row's angles
    or velocities, before they are moved to another point. Standard errors become the bound sum |coefficient| se, which
    holds for any correlation.

    Notes
    -----
    The matrix of flow (wind) to body axes of the Society of Flight Test Engineers, Reference Handbook (2013), 6.2.3, applied
    to (-D, C, -L).

    Raises
    ------
    InputError
        A part that X, Y or Z needs is missing: drag, lift at an incidence, the side force (or Y) at a drift angle, or the
        flow itself; X or Z of the body beside drag, or Y beside side.
    """
    sources = columns_of(campaign.axes)
    if complaints := list(_wind_complaints(columns, {c: s for c, (s, _) in sources.items()})):
        raise together(complaints)
    linear = _linear(columns, campaign)
    u, sin_b, w = (linear / np.linalg.norm(linear, axis=1)[:, None]).T
    cos_b = np.hypot(u, w)
    inclined = cos_b > 0.0
    cos_a, sin_a = (np.divide(part, cos_b, out=np.full(len(columns), rest), where=inclined) for part, rest in ((u, 1.0), (w, 0.0)))  # fmt: skip
    result, (y, y_sign) = {"X": "drag", "Y": "side", "Z": "lift"}, sources["Y"]
    parts: dict[str, dict[str, Array]] = {
        "X": {"drag": -cos_a * cos_b, "side": -cos_a * sin_b, "lift": sin_a},
        "Y": {"drag": -sin_b, "side": cos_b},
        "Z": {"drag": -sin_a * cos_b, "side": -sin_a * sin_b, "lift": -cos_a},
    }
    if "side" not in columns.forces and y in columns.forces:
        if (row := _first(cos_b < SIDEWAYS)) is not None:
            raise columns.fail("tables.flow_from_the_side", row=row)
        for part, along in (("X", cos_a), ("Z", sin_a)):
            of_y = {"drag": -along / cos_b, y: -y_sign * along * sin_b / cos_b}
            parts[part] = of_y | {"lift": parts[part]["lift"]}
    moved = {name: value for name, value in columns.forces.items() if name not in WIND}
    errors = {name: value for name, value in columns.errors.items() if name not in WIND}
    headers, doubtful = dict(columns.headers), [set(words) for words in columns.doubtful]
    for part, of in result.items():
        if of not in columns.forces:
            continue
        needed = {name: k for name, k in parts[part].items() if np.any(np.abs(k) > STRAIGHT)}
        if (lacking := next((n for n in needed if n not in columns.forces), "")) and lacking in WIND:
            angle, row = ("alpha", np.abs(sin_a)) if lacking == "lift" else ("beta", np.abs(sin_b))
            raise columns.fail(
                "tables.wind_part_lacks", row=int(np.argmax(row)), name=of, of=of, lacking=lacking, angle=angle,
                degrees=np.degrees(np.arcsin(min(row.max(), 1.0))), or_body=f", or {y} of the body" * (lacking == "side"), part=part,
            )  # fmt: skip
        own, sign = sources[part]
        moved[own] = sign * np.asarray(sum(k * columns.forces[name] for name, k in needed.items()))
        if all(name in columns.errors for name in needed):
            errors[own] = np.asarray(sum(np.abs(k) * columns.errors[name] for name, k in needed.items()))
        headers[own] = headers.get(of, of)
        for row, words in enumerate(columns.doubtful):
            doubtful[row] |= {own} if words & set(needed) else set()
    return replace(columns, forces=moved, errors=errors, headers=headers, doubtful=tuple(map(frozenset, doubtful)))


def _wind_complaints(columns: Columns, own: Mapping[str, str]) -> Iterator[InputError]:
    """What is missing or doubled beside lift, drag and side force; ``own`` maps FRD components to the table's columns."""
    wind = [c for c in WIND if c in columns.forces]
    if "drag" not in wind:
        yield columns.fail("tables.wind_without_drag", name=wind[0], wind=" and ".join(wind))
    for part, beside in (("X", "drag"), ("Z", "drag"), ("Y", "side")):
        if own[part] in columns.forces and beside in wind:
            yield columns.fail(
                "tables.wind_beside_body_axes", name=own[part], wind=" and ".join(wind), own=own[part], beside=beside
            )
    moving = [c for c in LINEAR if c in columns.velocity]
    for force, angle in (("lift", "alpha"), ("side", "beta")):
        if force in wind and angle not in columns.angles and not moving:
            yield columns.fail("tables.wind_without_angle", name=force, force=force, angle=angle)
    resistance = not columns.settings and np.unique(columns.speed).size >= FEWEST_SPEEDS
    if wind == ["drag"] and not columns.angles and not moving and not resistance:
        yield columns.fail("tables.drag_without_direction", name="drag")


def _on_circle(columns: Columns, centre: str, linear: Array) -> Array:
    """Rates p q r, (n, 3), of a body that runs on a circle, with the axis that ``centre`` names in its plane.

    The centre lies R away from the arm point across its velocity V, towards a side c. Omega x (point - centre) = V gives
    omega = |V|/R and the axis V x c: r = U/R for a centre to starboard, and p = -tan(alpha) r for a pitched body.
    """
    radius = np.asarray(columns.radius)
    side, signed = centre.removeprefix(SIGNED), centre.startswith(SIGNED)
    if (row := _first(~(np.abs(radius) > 0.0 if signed else radius > 0.0))) is not None:
        found = "a blank cell" if np.isnan(radius[row]) else f"a radius of {radius[row]:g} m"
        raise columns.fail(
            "tables.no_radius", row=row, name="R", found=found, wanted="a radius that is not zero" if signed else "a radius above zero",
            signs="" if signed else f' Where the sign of R separates the sides, write centre = "{SIGNED}{side}".',
        )  # fmt: skip
    axis = np.cross(linear, SIDES[side])
    size, speed = np.linalg.norm(axis, axis=1), np.linalg.norm(linear, axis=1)
    if (row := _first(size <= 1e-9 * speed)) is not None:
        raise columns.fail("tables.straight_to_the_centre", row=row, name="R", side=side)
    return np.asarray(axis * (speed / (radius * size))[:, None] + 0.0)


def surge_column(campaign: Campaign) -> str:
    """The table's velocity column along the body's length."""
    return LINEAR[int(np.argmax(np.abs(campaign.axes.rotation[0])))]


def speed_of_rows(
    stated: Array | None,
    velocity: Mapping[str, Array],
    primes: Mapping[str, Array],
    campaign: Campaign,
    n: int,
    has_angles: bool,
) -> Array:
    """U of every row: its column, else the length of a full velocity vector, the campaign's where that is zero; else the campaign's.

    Parameters
    ----------
    stated : (n,) array or None
        The column U, m/s.
    velocity : mapping of str to (n,) array
        Velocities that are not primed, m/s, in the table's axes.
    primes : mapping of str to (n,) array
        Primed ones, of which v' = v/U counts.
    campaign : Campaign
    n : int
    has_angles : bool
        Angles say the direction, and the campaign the speed.
    """
    if stated is not None:
        return stated
    if surge_column(campaign) not in velocity or has_angles:
        return np.full(n, campaign.conditions.speed)
    squares: Array = np.sum([velocity[c] ** 2 for c in LINEAR if c in velocity], axis=0)
    # v' = v / U, so the dimensional part is U^2 (1 - v'^2).
    shares = [primes[c] ** 2 for c in LINEAR if c in primes]
    rest = 1.0 - np.sum(shares, axis=0) if shares else np.ones(n)
    found = np.sqrt(np.divide(squares, rest, out=np.zeros(n), where=rest > 0.0))
    on_the_spot = (found == 0.0) & (rest > 0.0) & np.any(found > 0.0)  # one velocity at a time, a rate without speed
    return np.where(on_the_spot, campaign.conditions.speed, found)


def columns_of(axes: Axes) -> dict[str, tuple[str, float]]:
    """For every FRD component the table's column and its sign; axes are at right angles, so each is one column."""
    out = {}
    for group in (COMPONENTS[:3], COMPONENTS[3:]):
        for i, name in enumerate(group):
            j = int(np.argmax(np.abs(axes.rotation[i])))
            out[name] = group[j], float(axes.rotation[i, j])
    return out


def _require_symmetry(columns: Columns, cut: Cut, forces: Mapping[str, Array], motion: Mapping[str, Array]) -> None:
    """Refuse what half of a body cannot measure."""
    odd = [c for c in forces if c in cut.lost]
    moving = [m for m in cut.across if np.any(motion[m] != 0.0)]
    moving += [c for c in cut.controls if np.any(columns.controls.get(c, 0.0) != 0.0)]
    if odd or moving:
        what = f"the antisymmetric {', '.join(odd)}" if odd else f"motion {', '.join(moving)}"
        remedy = "leave these columns out (ignore), or " if odd else ""
        raise columns.fail(
            "tables.lost_by_half_model", what=what, plane=cut.plane, doubled=", ".join(cut.doubled), carries_no=cut.carries_no,
            remedy=remedy,
        )  # fmt: skip


def _exclusions(
    columns: Columns, campaign: Campaign, table: TableDeclaration, frd: Mapping[str, str]
) -> tuple[dict[str, NDArray[np.bool_]], tuple[Exclusion, ...]]:
    """Which cells fits may use, and why not the others. ``frd`` maps FRD components to the table's columns."""
    have = {c: column for c, column in frd.items() if column in columns.forces}
    usable = {c: np.ones(len(columns), dtype=bool) for c in have}
    settings = {*columns.settings, "U", "R", "density"}
    status = [text if text != "converged" else "" for text in columns.labels.get("status", [""] * len(columns))]
    out: list[Exclusion] = []
    for label in table.selected:
        if label not in columns.labels:
            raise input_error(
                "tables.selection_without_label", campaign.path, column="table.select", label=shown(label), name=label
            )
    for row, (line, doubtful) in enumerate(zip(columns.lines, columns.doubtful, strict=True)):
        for component, column in have.items():
            value = columns.forces[column][row]
            if column in doubtful or settings & doubtful:
                usable[component][row] = False
                reason = BLANK if np.isnan(value) else 'digit doubtful in the source ("uncertain")'
                reason = f"{status[row]}, {BLANK if np.isnan(value) else MARKED}" if status[row] else reason
                out.append(Exclusion(row, line, component, reason, not np.isnan(value), status[row], True))
            elif np.isnan(value):
                raise columns.fail("tables.blank_cell_of_force", row=row, name=column, head=column)
        for label, wanted in table.selected.items():
            if columns.labels[label][row] != wanted:
                why = f"{label} {columns.labels[label][row]}: {table.select_reason}"
                out.append(Exclusion(row, line, "", why, of_source=True))
                for mask in usable.values():
                    mask[row] = False
    return usable, tuple(out)


def _driven(columns: Columns, usable: Mapping[str, NDArray[np.bool_]]) -> Iterator[Exclusion]:
    """X of rows in which a propeller runs: thrust is in it, so that it gives no X0'; marked as not usable."""
    running = running_rows(columns.propeller, len(columns))
    for row in np.flatnonzero(running & usable["X"]) if "X" in usable else ():
        usable["X"][row] = False
        yield Exclusion(int(row), columns.lines[row], "X", DRIVEN, of_source=True)


def _without_inertia(
    campaign: Campaign, inertia: TowedInertia, point: Array, forces: Mapping[str, Array], motion: Mapping[str, Array]
) -> dict[str, Array]:
    """Add what holds the model on its circle, so that the fluid's force remains; about one axis alone Ix, Iy, Iz hold nothing."""
    rates = np.sort(np.abs([motion[m] for m in ANGULAR]), axis=0)
    if inertia.inertia is None and np.any(rates[1] > ONE_AXIS * rates[2]):
        raise input_error("tables.two_axes_without_inertia", campaign.path, column="inertia.inertia")
    centre = inertia.centre_of_gravity - point
    tensor = np.diag(inertia.inertia or (0.0, 0.0, 0.0)) + inertia.mass * (
        centre @ centre * np.eye(3) - np.outer(centre, centre)
    )
    nu = np.column_stack([motion[m] for m in MOTIONS])
    held = rigid_body_force(inertia.mass, centre, tensor, nu)
    return {c: values + held[:, COMPONENTS.index(c)] for c, values in forces.items()}
