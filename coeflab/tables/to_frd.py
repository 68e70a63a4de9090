"""From the columns of any importer to a ForceTable: axes, angle signs, half models, inertia, exclusions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE, angle_sign
from coeflab.core.errors import InputError, shown, together
from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.rigid_body import rigid_body_force
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOMENTS, MOTIONS
from coeflab.tables.assumptions import INERTIA, assumed
from coeflab.tables.campaign import CENTRES, SIDES, SIGNED, Campaign, Cut, TableDeclaration, TowedInertia, cut_of
from coeflab.tables.column_map import WIND
from coeflab.tables.columns import Columns, first_row
from coeflab.tables.force_table import DRIVEN, Declared, Exclusion, ForceTable, running_rows, speed_at
from coeflab.tables.wind_axes import in_body_axes

BLANK, MARKED = "blank in the source", 'marked "uncertain" in the source'
SAME_DENSITY = 1e-3  # relative, as runs of one table may differ
ONE_AXIS = 1e-9  # of the largest rate: smaller ones are rounding
WITHOUT_BALANCE = ("cfd", "synthetic", "estimate")  # kinds of tables whose forces no balance read


def force_table(columns: Columns, campaign: Campaign, table: TableDeclaration) -> ForceTable:
    """Turn columns into the fluid's force on the body in FRD about the campaign's reference point.

    Moments that the table has about a point of its own are moved; one whose move needs a force that the table lacks is left
    out, which the notes say. Lift and drag are turned to body axes, see `in_body_axes`.

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
        columns = in_body_axes(columns, campaign.axes, _linear(columns, campaign))
        still = [f"{a} = 0" for a in ("alpha", "beta") if columns.angles and a not in columns.angles]
        notes.append(
            f"{', '.join(wind)} turned to body axes by the flow of each row" + f" ({', '.join(still)})" * bool(still)
        )
    sources = campaign.axes.columns
    usable, exclusions = _exclusions(columns, campaign, table, {c: s for c, (s, _) in sources.items()})
    if table.contains_thrust is not False:
        exclusions = (*exclusions, *_driven(columns, usable))
    forces = {c: sign * columns.forces[s] for c, (s, sign) in sources.items() if s in columns.forces}
    errors, rounding = (
        {c: x[s] for c, (s, _) in sources.items() if s in x} for x in (columns.errors, columns.rounding)
    )
    if columns.radius is not None:
        notes.append(f"rates from U and R, centre of the circle: {table.centre}")
    if table.arm_point is not None and np.any(table.arm_point != point):
        notes.append(f"U and velocities are those of {_place(table.arm_point)}, moved from there")
    half, place = (
        (campaign.half_model, "campaign.toml") if table.half_model is None else (table.half_model, "its table")
    )
    halved = ""
    if half is not None:
        done = f"{', '.join(c.doubled)} doubled" if (c := cut_of(half)) else "nothing doubled"
        halved = f"half model{f' ({half})' if isinstance(half, str) else ''}: {done}, by half_model of {place}"
        notes.append(halved)
    if (cut := cut_of(half)) is not None:
        _require_symmetry(columns, cut, forces, motion)
        forces, errors, rounding = ({c: 2.0 * v for c, v in x.items()} for x in (forces, errors, rounding))
    turns = any(np.any(motion[m] != 0.0) for m in ANGULAR)
    subtracted = turns and bool(table.contains_inertia) and campaign.inertia is not None
    if subtracted and campaign.inertia is not None:
        forces = _without_inertia(campaign, campaign.inertia, point, forces, motion)
        notes.append(f"inertia of the model subtracted (m = {campaign.inertia.mass:g} kg)")
    result = ForceTable(
        name=f"{campaign.name}/{table.file}",
        campaign=campaign.name,
        title=campaign.title,
        body=campaign.body,
        motion=motion,
        controls=columns.controls,
        speed=speed_at(columns.speed, _linear(columns, campaign), np.column_stack([motion[m] for m in LINEAR])),
        forces=forces,
        errors=errors,
        rounding={c: np.stack([forces[c], error]) for c, error in rounding.items() if c in forces},
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
        inertia_subtracted=subtracted,
        halved=halved,
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
    words["coefficients.length"] = f"{campaign.scaling.length:g}"
    words["coefficients.area"] = f"1/2 rho U^2 L^2 with L = {campaign.scaling}"
    keys = [*table.assumed, *(f"axes.{angle}" for angle in campaign.assumed if angle in columns.angles)]
    turns = bool(np.any(motion["q"]) or np.any(motion["r"]))
    keys += ["table.arm_point"] * (table.arm_point is None and turns)
    for key in dict.fromkeys(keys):
        section, _, plain = key.partition(".")
        value = words.get(key) or getattr(of.get(section), plain, "")
        if section == "columns":
            value = columns.headers.get(plain, plain)
        yield assumed(key, name, value, Severity.NOTE if key in ("axes.alpha", "axes.beta") else Severity.WARN)
    if turns and table.contains_inertia is False and campaign.source.kind not in WITHOUT_BALANCE:
        mass, severity = ("unknown", Severity.WARN) if campaign.inertia is None else ("known", Severity.NOTE)
        yield Finding.of(INERTIA, name, severity, mass=mass, motions=("q", "r"), components=())
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


def _on_circle(columns: Columns, centre: str, linear: Array) -> Array:
    """Rates p q r, (n, 3), of a body that runs on a circle, with the axis that ``centre`` names in its plane.

    The centre lies R away from the arm point across its velocity V, towards a side c. Omega x (point - centre) = V gives
    omega = |V|/R and the axis V x c: r = U/R for a centre to starboard, and p = -tan(alpha) r for a pitched body.
    """
    radius = np.asarray(columns.radius)
    side, signed = centre.removeprefix(SIGNED), centre.startswith(SIGNED)
    if (row := first_row(~(np.abs(radius) > 0.0 if signed else radius > 0.0))) is not None:
        found = "a blank cell" if np.isnan(radius[row]) else f"a radius of {radius[row]:g} m"
        raise columns.fail(
            "tables.no_radius", row=row, name="R", found=found, wanted="a radius that is not zero" if signed else "a radius above zero",
            signs="" if signed else f' Where the sign of R separates the sides, write centre = "{SIGNED}{side}".',
        )  # fmt: skip
    axis = np.cross(linear, SIDES[side])
    size, speed = np.linalg.norm(axis, axis=1), np.linalg.norm(linear, axis=1)
    if (row := first_row(size <= 1e-9 * speed)) is not None:
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


def _require_symmetry(columns: Columns, cut: Cut, forces: Mapping[str, Array], motion: Mapping[str, Array]) -> None:
    """Refuse what half of a body cannot measure."""
    odd = [c for c in forces if c in cut.cancelled]
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
