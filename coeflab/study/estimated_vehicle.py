"""From a shape and a mass to a vehicle: added mass, estimates, parameter file, exports, a first turn and zigzag."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab import estimates as methods
from coeflab.bodies.added_masses import added_masses, wall_sweep
from coeflab.bodies.body import Body
from coeflab.bodies.drafted import drafted, is_untouched
from coeflab.bodies.mesh.file import SELF_DESCRIBED
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import mesh_statements
from coeflab.bodies.orientation import require_orientation
from coeflab.bodies.outlining import fins_along
from coeflab.bodies.simplify.source import BODY
from coeflab.bodies.triangulation import Triangulation
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.core.files import located, stem
from coeflab.core.machine import one_thread
from coeflab.core.text.bounded import log_text
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array
from coeflab.core.units import positive_typed, three_typed
from coeflab.fits import BY_DEFAULT
from coeflab.fits.joint.moving import LEFT_OUT
from coeflab.formats.export import PlannedExport, exports_of
from coeflab.law.added_mass import NearWall
from coeflab.law.scaling import Conditions, Scaling, require_hull
from coeflab.law.symbols import CONTROLS
from coeflab.law.water import FRESH_WATER, conditions_of, water_of
from coeflab.motion.approach import along, mirrored, yaw_acceleration
from coeflab.motion.manoeuvre import UPRIGHT, Simulation
from coeflab.motion.simulation import manoeuvres_of, moved, simulate
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.turn_limits import linear_growth
from coeflab.motion.uncertainty.uncertainty import Carried, Question, uncertainty
from coeflab.study.study import FromShape, Plan, Study
from coeflab.tables.reading import table_at
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.force_law import ahead_from
from coeflab.vehicle.from_shape import CLOSED, ESTIMATES, Stated, as_fit, by_series, equipped, lacking, weighed
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.held_to_model import Motions, held_to_model
from coeflab.vehicle.merge import Merged, estimates_of, merged
from coeflab.vehicle.parameter_file import ParameterFile, located_refusals, read_parameter_file

NOTHING = Stated()
Progress = Callable[[str], None]
LEVEL = ("u", "v", "r")  # a first manoeuvre stays in the horizontal plane, whatever trim and weight are
STRAIGHT = ("u",)
# Sway and yaw accelerations of a straight course, of U^2/L and (U/L)^2, that are rounding of a body alike to both sides.
ASIDE = 1e-6
TURN, LIMIT = "turning_circle", float(np.radians(15.0))
MEMBERS, SEED = 100, 1
STATES = 200  # of each manoeuvre, at which law and force model are compared
REMAINING = 0.2  # of the speed, of a coast-down
TURNS, LONGER = (
    1.25,
    2.5,
)  # of the turn whose uncertainty is computed; time that it may take over that of the file's own


@one_thread()
def from_shape(
    plan: Plan, body: Body, stated: Stated = NOTHING, progress: Progress = lambda _: None, wall: str = "",
    distances: Sequence[float] = (),
) -> Study:  # fmt: skip
    """The study of a body without tables, with exports, first manoeuvres and what the estimates do to these.

    Checks and files are left to what takes the study.

    Parameters
    ----------
    plan : Plan
        Without tables: name, exports, manoeuvres, conditions, scaling.
    body : Body
        With a shape.
    stated : Stated
        What is known of its mass beside the body's file.
    progress : callable
        Takes what is being done, in words.
    wall : str
        ``bottom``, ``surface_zero`` or ``surface_infinite``; none where empty.
    distances : sequence of float
        From the reference point to the wall, m: added mass there, by the panel method, goes into the parameter files.
    """
    study = estimated(plan, body, stated, progress, wall, distances)
    shape = study.shape
    if shape is None:
        return study
    files: dict[str, ParameterFile] = dict(study.parameter_files)
    heavy, vehicle = shape.weighed, next(iter(files.values()))
    standing = fins_along(heavy.body.outline) if heavy.body.outline is not None else None
    words = [*shape.statements, *_drift_limit(vehicle), *([standing.words] if standing is not None else [])]
    words.extend(by_series(heavy.body, shape.conditions.speed))
    planned = manoeuvres_of(plan.manoeuvres, files, progress)
    moves, troubles = (planned, ()) if planned else first_manoeuvres(vehicle, progress)
    files = {name: compared(p, shape.estimates, moves) for name, p in files.items()}
    vehicle = next(iter(files.values()))
    exports, refused = exports_of(
        plan.exports,
        files.values(),
        progress,
        {n: h.body.shape for n, h in study.hulls.items() if h.body.shape is not None},
    )
    carried, why = _carried(vehicle, moves, progress)
    missing = (*lacking(heavy.body, vehicle, heavy.assumed, bool(_steered(vehicle))), *troubles, *why)
    shape = replace(shape, statements=tuple(words), missing=missing, carried=carried)
    return replace(study, parameter_files=files, exports=exports, refused=refused, manoeuvres=moves, shape=shape)


@one_thread()
def estimated(
    plan: Plan, body: Body, stated: Stated = NOTHING, progress: Progress = lambda _: None, wall: str = "",
    distances: Sequence[float] = (),
) -> Study:  # fmt: skip
    """Added mass, estimates and parameter files of a body without tables.

    Parameters
    ----------
    plan : Plan
        Without tables: name, exports, manoeuvres, conditions, scaling.
    body : Body
        With a shape.
    stated : Stated
        What is known of its mass beside the body's file.
    progress : callable
        Takes what is being done, in words.
    wall : str
        ``bottom``, ``surface_zero`` or ``surface_infinite``; none where empty.
    distances : sequence of float
        From the reference point to the wall, m: added mass there, by the panel method, goes into the parameter files.

    Raises
    ------
    InputError
        No shape, no volume, a mass or an inertia that no body has, nothing that can be estimated.
    """
    shape = body.require_shape()
    require_orientation(body)
    conditions, scaling = plan.conditions or FRESH_WATER, plan.scaling or body.scaling
    conditions = replace(conditions, viscosity=conditions.viscosity or water_of(conditions.density)[1])
    words = [*mesh_statements(body), *_assumed(plan, conditions, stated.unstated)]
    if scaling is None:
        if not shape.length > 0.0:
            hollow = "" if any(c.volume for c in body.configurations) else f" It has no volume either. {CLOSED}"
            raise input_error("study.body_long_along", length=shape.length, hollow=hollow)
        scaling = Scaling(shape.length, "length over all")
    point = body.reference_point if plan.reference_point is None else plan.reference_point
    body = replace(body, scaling=scaling, reference_point=point)
    heavy = weighed(body, stated, conditions.density)
    progress(f"added mass of {body.name}")
    found = added_masses(heavy.body, conditions.density, plan.method, reproducible=True)
    walls: tuple[NearWall, ...] = ()
    if wall:
        progress(f"added mass of {body.name} near a wall")
        near = wall_sweep(heavy.body, conditions.density, wall, distances)
        walls = tuple(NearWall(wall, d, n.matrix) for d, n in zip(sorted(set(distances)), near, strict=True))
    progress(f"estimates of {body.name}")
    water = methods.Water(conditions.density, float(conditions.viscosity or 0.0), conditions.speed)
    result = methods.estimated(heavy.body, water, added_mass=found.recommended)
    fit = as_fit(result, body.name)
    files: dict[str, ParameterFile] = {}
    hulls: dict[str, Triangulation] = {}
    inputs = tuple(dict.fromkeys(([plan.file] if plan.file else []) + list(body.files)))
    for group in plan.parameter_files or (PlannedParameterFile(stem(body.name), body.name, (ESTIMATES,), ()),):
        taken = replace(group, body=body.name, campaigns=(ESTIMATES,))
        with located_refusals(f"parameter_file.{group.name}"[:80]):
            first = assemble(taken, plan.name, [fit], [], [], (), heavy.body, conditions, inputs, found)
            notes = (*first.provenance.notes, *heavy.statements, *words, *result.notes)
            first = first.model_copy(update={"provenance": first.provenance.model_copy(update={"notes": notes})})
            if walls and first.added_mass is not None:
                first = first.model_copy(update={"added_mass": replace(first.added_mass, walls=walls)})
            files[group.name] = equipped(first, heavy.body, heavy.configuration)
        hulls[group.name] = found
    return Study(
        plan=plan, tables=(), fits=(fit,), missing=(), body=heavy.body, references=(), comparisons=(),
        parameter_files=files, hulls=hulls, inputs=inputs, shape=FromShape(heavy, result, conditions, (*heavy.statements, *words)),
    )  # fmt: skip


def compared(parameters: ParameterFile, estimates: methods.Estimates, moves: Sequence[Simulation]) -> ParameterFile:
    """The file with what its law leaves out of the estimates' own forces, over the states of manoeuvres.

    Parameters
    ----------
    parameters : ParameterFile
    estimates : Estimates
        Whose forces the law stands for.
    moves : sequence of Simulation
    """
    over = [
        Motions(s.manoeuvre.name.replace("_", " "), s.trajectory.velocity[rows], angles_at(s.trajectory, rows))
        for s in moves
        if len(s.trajectory.time)
        for rows in [np.unique(np.linspace(0, len(s.trajectory.time) - 1, STATES).astype(int))]
    ]
    found = held_to_model(parameters, estimates.forces, "estimates", over)
    return parameters.model_copy(update={"findings": (*parameters.findings, *found)}) if found else parameters


def angles_at(trajectory: Trajectory, rows: Array) -> Array:
    """Angles (n, 3) of dr, ds, db at some of the times; zero of what was not ordered."""
    none = np.zeros(len(trajectory.time))
    return np.column_stack([np.asarray(trajectory.controls.get(c, none))[rows] for c in CONTROLS])


def _assumed(plan: Plan, conditions: Conditions, unstated: Sequence[str]) -> tuple[str, ...]:
    """What of speed, density and viscosity nobody stated."""
    lacking = {"density", "speed"} if plan.conditions is None else set(unstated)
    water = f"{water_of(conditions.density)[0]} water of 20 deg C"
    parts = [f"{conditions.speed:g} m/s"] * ("speed" in lacking)
    parts += [f"{water}, {conditions.density:g} kg/m^3"] * ("density" in lacking)
    if "density" not in lacking and plan.conditions is not None and plan.conditions.viscosity is None:
        parts.append(f"the viscosity of {water}, {conditions.viscosity:g} m^2/s")
    return (f"assumed: {(' in ' if 'density' in lacking else ', ').join(parts)}",) if parts else ()


def _drift_limit(parameters: ParameterFile) -> tuple[str, ...]:
    """From which drift on the law pushes the body ahead, in words; empty where it never does."""
    angle = ahead_from(parameters)
    if angle is None:
        return ()
    return (
        f"limit: from {angle:d} deg of drift the law gives an X that points ahead; it is a law of small drift: use it below",
    )


def first_manoeuvres(
    parameters: ParameterFile, progress: Progress = lambda _: None
) -> tuple[tuple[Simulation, ...], tuple[str, ...]]:
    """A turn and a zigzag in the horizontal plane, by the rudder or by two thrusters; else a coast-down.

    The coast-down of a body that is alike to port and starboard moves in surge alone: rounding may not turn it.

    Parameters
    ----------
    parameters : ParameterFile
    progress : callable
        Takes what is being done, in words.

    Returns
    -------
    tuple of Simulation
    tuple of str
        What could not be moved, and why.
    """
    planned = _steered(parameters)
    out, troubles = [], []
    for name, options in planned or (("stop", {"astern": 0.0, "remaining": REMAINING}),):
        try:
            free, words = (LEVEL, ()) if planned else _coasting(parameters)
            result = simulate(parameters, name, options, free=free)
            out.append(replace(result, statements=(*result.statements, *words)))
        except InputError as why:
            troubles.append(f"no {name.replace('_', ' ')}: found {why.found}; expected {why.expected}")
            continue
        progress(f"simulated {name}")
    return tuple(out), tuple(troubles)


def _steered(parameters: ParameterFile) -> tuple[tuple[str, dict[str, Any]], ...]:
    """Manoeuvres by what steers; none where nothing does."""
    limit = next((s.limit for s in parameters.surfaces if s.control == "dr"), LIMIT)
    acts = any(c.value and c.symbol.removesuffix("'") in ("Ndr", "Ydr") for c in parameters.coefficients)
    if acts:
        angle = min(LIMIT, limit)
        return (TURN, {"rudder": angle}), ("zigzag", {"rudder": min(angle, float(np.radians(10.0)))})
    pair = _pair(parameters)
    if not pair:
        return ()
    words = tuple(f"{name}={command:g}" for name, command in pair.items())
    return (TURN, {"commands": words}), ("zigzag", {"commands": words})


def _coasting(parameters: ParameterFile) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Motions of a coast-down, and what that means: surge alone where no force turns the body off its straight course."""
    body = moved(parameters, "stop", LEVEL)
    nu = along(body, 0.0)
    rates = body.acceleration(nu[None, :], np.array([UPRIGHT]), np.zeros((1, 3)), np.zeros(6))[0]
    pace = float(nu[0]) / body.length
    if abs(rates[1]) > ASIDE * pace * float(nu[0]) or abs(rates[5]) > ASIDE * pace**2:
        return LEVEL, ()
    grows = linear_growth(body, ("v", "r"), float(nu[0]))
    held = "straight ahead: sway and yaw are held"
    if not grows > 0.0:
        return STRAIGHT, (held,)
    return STRAIGHT, (
        held,
        f"the straight course is unstable: with sway and yaw free a disturbance grows e-fold in {1.0 / grows:.2g} s at {nu[0]:g} m/s",
    )


def _pair(parameters: ParameterFile) -> dict[str, float]:
    """Orders for two thrusters that mirror each other: the port one ahead at its most, the other off; empty without any."""
    if len(parameters.thrusters) < 2:
        return {}
    try:
        body = moved(parameters, TURN, LEVEL)
        port = next(
            t for t in body.thrusters if t.position[1] < 0.0 and abs(t.direction[0]) > 0.5 and t.tilt_axis is None
        )
        orders = {t.name: 0.0 for t in body.thrusters}
        orders[port.name] = port.curve.high
        turned = mirrored(body, orders)
    except (InputError, StopIteration):
        return {}
    used = {port.name, *(name for name, command in turned.items() if command)}
    nu: Array = along(body, 0.0)
    return {n: v for n, v in orders.items() if n in used} if yaw_acceleration(body, orders, nu) else {}


def _carried(
    parameters: ParameterFile, moves: tuple[Simulation, ...], progress: Progress
) -> tuple[tuple[Carried, ...], tuple[str, ...]]:
    """The uncertainty of the estimates through the first manoeuvre."""
    planned = _steered(parameters)
    name, options = planned[0] if planned else ("stop", {"astern": 0.0, "remaining": REMAINING})
    own = next((s for s in moves if s.manoeuvre.name == name), None)
    if own is None:
        return (), ()
    ended = own.figures[0] if own.figures else None
    if ended is not None and ended.status == "not reached":
        return (), (f"no uncertainty of the {name.replace('_', ' ')}: its {ended.name} is not reached, {ended.why}",)
    progress(f"uncertainty of the {name.replace('_', ' ')}")
    longest = max(LONGER * float(own.trajectory.time[-1]), 1.0)
    options = {**options, "longest": longest / (2.0 if name == TURN else 1.0)} | (
        {"turns": TURNS} if name == TURN else {}
    )
    try:
        return (uncertainty(parameters, Question(name, options, MEMBERS, SEED, free=own.vehicle.free)),), ()
    except InputError as why:
        return (), (f"no uncertainty of the {name.replace('_', ' ')}: found {why.found}; expected {why.expected}",)


@one_thread()
def replaced(
    base: ParameterFile, other: ParameterFile, name: str = "", own: Scaling | None = None, *, alone: bool = False
) -> tuple[Merged, tuple[Simulation, ...], tuple[Carried, ...]]:
    """The base with the numbers of another file, its first manoeuvres, and what the estimates left in it do to them.

    Parameters
    ----------
    base, other : ParameterFile
    name : str
        Of the merged file; the base's unless given.
    own : Scaling, optional
        What the other's data were primed by.
    alone : bool
        As of `coeflab.vehicle.merge.merged`.

    Raises
    ------
    InputError, ScalingMismatchError
        As of `coeflab.vehicle.merge.merged`.
    """
    result = merged(base, other, name, own, alone=alone)
    moves, _ = first_manoeuvres(result.parameters)
    carried, _ = _carried(result.parameters, moves, lambda _: None) if estimates_of(result.parameters) else ((), ())
    return result, moves, carried


def completed_by_hand(
    body: Body, name: str, folder: Path, unit: str = "", axes: str = "", repair: bool = False, fill: bool = False, sheets: bool = False,
) -> tuple[dict[str, bytes], bool]:  # fmt: skip
    """A body.toml of a bare mesh for its owner to complete, by its name; none of another body.

    Where the folder has one that was edited, there is none either, and the second is true.

    Parameters
    ----------
    body : Body
        What `subject` made of the others.
    name, unit, axes : str
    folder : Path
    repair, fill, sheets : bool
    """
    path, shape = Path(name), body.shape
    if path.suffix.lower() == ".toml" or not path.is_file() or not isinstance(shape, TriangleMesh):
        return {}, False
    own = SELF_DESCRIBED.get(path.suffix.lower().lstrip("."), ("", ""))
    text = drafted(
        body, shape, path, folder, unit or own[0], axes or own[1], repair=repair, fill=fill, sheets=sheets
    ).encode()
    there = folder / BODY
    selected = there.exists() and not is_untouched(log_text(there))
    return {} if selected else {BODY: text}, selected


def asked(
    body: Body, mass: str = "", cg: str = "", inertia: str = "", speed: str = "", density: str = "", length: str = "",
    method: str = "all", to: Sequence[str] = (), accept_loss: bool = False,
) -> tuple[Plan, Stated]:  # fmt: skip
    """What a person asks for of a body, as a plan and what is stated of the mass; numbers in SI or with their unit.

    Parameters
    ----------
    body : Body
    mass, cg, inertia, speed, density, length : str
        As typed; empty: not stated. ``cg`` and ``inertia`` are three numbers with commas between.
    method : str
        Of added mass.
    to : sequence of str
        Targets of exports.
    accept_loss : bool
        Of these.

    Raises
    ------
    InputError
        Not a number, not above zero, a unit of another kind; names the option.
    """
    weight = positive_typed(mass, "mass", "--mass") if mass else None
    centre = np.array(three_typed(cg, "length", "--cg")) if cg else None
    turning = None if not inertia else np.diag(three_typed(inertia, "inertia", "--inertia"))
    conditions, unstated = conditions_of(
        positive_typed(density, "density", "--density") if density else None,
        positive_typed(speed, "speed", "--speed") if speed else None,
    )
    require_hull(length, "--length")
    scaling = Scaling(positive_typed(length, "length", "--length"), "length") if length else None
    exports = tuple(PlannedExport(target, accept_loss, place="") for target in dict.fromkeys(to))
    title = body.title if body.title and not body.datum.id.endswith(body.title) else body.name
    plan = Plan(stem(body.name), title, (), conditions=conditions, scaling=scaling, exports=exports, method=method)
    return plan, Stated(weight, centre, turning, unstated)


def given_by(name: str, base: ParameterFile, run: Callable[[Plan], Study]) -> tuple[ParameterFile, Scaling]:
    """A parameter file, or what the default fits make of campaigns about the base's reference point; and its own length.

    What no campaign among them can move there is left about its own point: fitted numbers of the base may move it.

    Parameters
    ----------
    name : str
        Of a file or a campaign; several campaigns with commas between.
    base : ParameterFile
    run : callable
        `coeflab.study.run.run`.

    Raises
    ------
    InputError
        Neither.
    """
    path = Path(name)
    if path.suffix.lower() == ".json":
        found = read_parameter_file(path)
        return found, found.scaling
    campaigns = tuple(table_at(p, BY_DEFAULT) for p in campaigns_named(name))
    plan = Plan(
        stem(path.name), path.name, campaigns, np.array(base.reference_point.point), base.reference_point.origin,
        scaling=base.scaling, conditions=base.conditions,
    )  # fmt: skip
    try:
        study = run(plan)
    except ScalingMismatchError as why:
        if base.mass is None:
            raise
        x, y, z = np.array(base.reference_point.point) + base.mass.centre_of_gravity
        words = text_of(
            "vehicle.centre_from_datum", why=why, name=base.name, x=x, y=y, z=z, datum=base.reference_point.datum
        )
        raise ScalingMismatchError(words) from None
    if any(f.code == LEFT_OUT for fit in study.fits for f in fit.findings):
        own = run(replace(plan, reference_point=None, datum=None)) if len(campaigns) == 1 else study
        study = replace(own, tables=study.tables)
    return next(iter(study.parameter_files.values())), study.tables[0].scaling


def campaigns_named(name: str) -> list[Path]:
    """Where the campaigns are that a person names with commas between, or one whose own name holds a comma.

    Parameters
    ----------
    name : str

    Raises
    ------
    InputError
        One is not there.
    """
    try:
        alone = "," not in name or Path(name).exists()
    except OSError:  # longer than any path can be
        alone = False
    names = [name] if alone else [n.strip() for n in name.split(",") if n.strip()]
    return [located(n, "cfd_data") for n in names or [name]]
