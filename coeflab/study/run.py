"""The main path: tables -> fits -> comparisons -> parameter files -> checks, one study.

What a plan names, read: tables about one reference point, bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.files import shipped, stem
from coeflab.core.finding import Finding
from coeflab.core.machine import one_thread
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.fits.joint.one_point import one_length
from coeflab.fits.joint.rows import joint_name
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import derivative
from coeflab.study.checking import checked
from coeflab.study.checks.sizes import UNITS_APART, masses_of_models
from coeflab.study.fitting import FEWEST, fitted, refuse_empty, rejoined
from coeflab.study.study import Conversion, Plan, PlannedConversion, PlannedJoint, Study
from coeflab.study.symmetry import confirmed, of_bodies
from coeflab.tables.reading import read_tables, table_at
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.parameter_file import ParameterFile, located_refusals, read_parameter_file
from coeflab.vehicle.published_values import compare, compare_set, read_references

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.triangulation import Triangulation
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.formats.export import Export, Refused
    from coeflab.law.scaling import Scaling
    from coeflab.motion.manoeuvre import Simulation
    from coeflab.tables.force_table import ForceTable


def settled(table: ForceTable, plan: Plan) -> ForceTable:
    """The table about the plan's reference point."""
    if plan.include_uncertain:
        table = table.with_uncertain_cells()
    if plan.reference_point is None:
        return table
    if plan.datum:
        table = table.counted_from(plan.datum, plan.reference_point)
    if plan.datum and plan.datum != table.datum:
        raise ScalingMismatchError(
            f"the plan measures points from {shown(plan.datum.id)}, {table.campaign} from {shown(table.datum.id)}; "
            f'state the reference point from one datum. Where both are one point: datum = "{plan.datum.id}" under [axes] of '
            f"the campaign.toml of {table.campaign}; where the {table.datum.id} lies elsewhere, that and its place from the {plan.datum.id}, such as "
            f"the centre of gravity of body.toml, as reference_point. A body names its own under [body] of its body.toml; that of a mesh is its origin."
        )
    return table.about(plan.reference_point)


def conversions(planned: PlannedConversion, plan: Plan, tables: Sequence[ForceTable]) -> Iterator[Conversion]:
    """The tables of a copy, each beside the one of the same place in its original.

    Parameters
    ----------
    planned : PlannedConversion
    plan : Plan
    tables : sequence of ForceTable
        Of the plan, settled; those of the original are among them.

    Raises
    ------
    InputError
        Another number of tables or of rows than the original has.
    """
    copies = [settled(t, plan) for t in read_tables(table_at(planned.campaign))]
    originals = [t for t in tables if t.campaign == planned.of]
    if len(copies) != len(originals):
        raise input_error(
            "study.many_campaign_copy", column="conversion.of", count_of_copies=len(copies), count_of_originals=len(originals),
            of=shown(planned.of),
        )  # fmt: skip
    for copy, original in zip(copies, originals, strict=True):
        if len(copy) != len(original):
            raise InputError(
                f"{len(copy)} rows in {copy.name}, {len(original)} in {original.name}",
                "one row for each",
                column="conversion.of",
            )
        yield Conversion(copy, original)


def together(joint: PlannedJoint, plan: Plan) -> tuple[list[ForceTable], frozenset[str], list[Finding]]:
    """All tables of a joint fit, each once; see `_held_by_bodies`."""
    read, right, ruled_out = _held_by_bodies([t for planned in joint.tables for t in read_tables(planned)], plan)
    names = [t.name for t in read]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise InputError(f"the table {shown(twice)} twice", "every table once, and campaigns of different names",
                         column="campaigns", advice="A row that counts twice makes every interval too narrow.")  # fmt: skip
    return read, right, ruled_out


def _held_by_bodies(tables: Sequence[ForceTable], plan: Plan) -> tuple[list[ForceTable], frozenset[str], list[Finding]]:
    """`of_bodies` about each campaign's own point, then the plan's point and scaling."""
    turned = {t.body for t in tables if t.by_symmetry}
    read, right, ruled_out = of_bodies(tables, _bodies(plan, turned) if turned else ())
    return [settled(t, plan) for t in read], right, ruled_out


Progress = Callable[[str], None]


@one_thread()
def run(plan: Plan | str | Path, progress: Progress = lambda _: None) -> Study:
    """Carry out a plan.

    Parameters
    ----------
    plan : Plan, str or Path
        A plan, the path of a plan.toml or of its folder, or the name of a shipped one: ``coeflab.run("suboff")``.
    progress : callable, optional
        Means in words what happens.

    Returns
    -------
    Study
        Nothing has been written.

    Raises
    ------
    CoeflabError
        Input that cannot be used.
    """
    if not isinstance(plan, Plan):
        return _of_file(plan, progress)
    if plan.exports:
        from coeflab.formats.export import refuse_unknown

        refuse_unknown(plan.exports)
    if not plan.tables and not plan.joint:
        return checked(_of_shape(plan, progress), progress)
    tables, fits, budgets, unfitted = _fits(plan, progress)
    body = _body(plan)
    _require_kilograms(tables, body)
    references = tuple(r for path in plan.references for r in read_references(path))
    groups = plan.parameter_files or _groups(fits, plan)
    missing = tuple(c for g in groups for c in _missing(g, fits, tables, plan.wanted))
    first = plan.scaling or fits[0].coefficients.scaling
    own = {t.campaign: t.conditions for t in reversed(tables)}
    at = {
        g.name: plan.conditions or next((own[c] for c in g.campaigns if c in own), tables[0].conditions) for g in groups
    }
    hulls = _hulls(groups, next(iter(at.values())).density, progress)
    inputs = _inputs(plan, tables, [b for b in (body, *(h.body for h in hulls.values())) if b is not None])
    files = {}
    for g in groups:
        with located_refusals(f"parameter_file.{g.name}"[:80]):
            files[g.name] = assemble(
                g, plan.name, fits, tables, missing, references, body, at[g.name], inputs, hulls.get(g.name)
            )
            if g.base is not None:
                from coeflab.vehicle.merge import merged

                files[g.name] = merged(read_parameter_file(g.base), files[g.name], g.name).parameters
    exports, refused, manoeuvres = _used(plan, files, hulls, progress)
    study = Study(
        plan=plan,
        tables=tuple(tables),
        fits=tuple(fits),
        missing=missing,
        body=body,
        references=references,
        comparisons=tuple(c for f in fits for c in compare_set(f.coefficients, references))
        + compare(missing, references, first),
        parameter_files=files,
        hulls=hulls,
        inputs=inputs,
        budgets=tuple(budgets),
        exports=exports,
        refused=refused,
        manoeuvres=manoeuvres,
        unfitted=unfitted,
        conversions=tuple(c for planned in plan.conversions for c in conversions(planned, plan, tables)),
    )
    return checked(study, progress)


def _fits(plan: Plan, progress: Progress) -> tuple[list[ForceTable], list[FitResult], list[Budget], dict[str, str]]:
    """Tables, fits and budgets of a plan, and the own tows that have too few points for a fit, with why."""
    tables: list[ForceTable] = []
    fits: list[FitResult] = []
    of_fits: list[tuple[str, list[ForceTable], Scaling, Mapping[str, Any]]] = []
    budgets: list[Budget] = []
    unfitted: dict[str, str] = {}
    ours = [t.added for t in plan.tows if t.added is not None]
    towed: set[str] = set()
    by_body = frozenset[str]()
    for planned in plan.tables:
        read, right, ruled_out = _held_by_bodies(read_tables(planned), plan)
        progress(f"read {read[0].campaign}: {sum(map(len, read))} rows")
        by_body |= right
        scaling = plan.scaling or read[0].scaling
        is_ours = planned.campaign in ours
        towed |= {read[0].campaign} if is_ours else set()
        enough = [t for t in read if _has_points(t)] if is_ours else read
        for name in planned.fits if enough else ():
            try:
                result, found = fitted(name, enough, scaling, planned.options.get(name, {}), fits)
            except InputError as why:
                if not is_ours:
                    raise
                unfitted.setdefault(read[0].campaign, why.found)
                continue
            budgets += found
            fits.append(replace(result, findings=(*result.findings, *ruled_out)))
            ruled_out = []
            of_fits.append((name, enough, scaling, planned.options.get(name, {})))
            progress(f"fitted {read[0].campaign} by {name}")
        tables += read
    for joint in plan.joint:
        read, right, ruled_out = together(joint, plan)
        by_body |= right
        progress(f"read {joint_name(t.campaign for t in read)}: {sum(map(len, read))} rows")
        result, found = fitted(joint.fit, read, plan.scaling or one_length(read), joint.options)
        budgets += found
        fits.append(replace(result, findings=(*result.findings, *ruled_out)))
        of_fits.append((joint.fit, read, plan.scaling or one_length(read), joint.options))
        progress(f"fitted {result.campaign} by {joint.fit}")
        tables += [t for t in read if t.name not in {known.name for known in tables}]
    refuse_empty([f for f in fits if f.campaign not in towed])
    return tables, [confirmed(f, by_body) for f in rejoined(fits, of_fits)], budgets, unfitted


def _hulls(
    groups: Sequence[PlannedParameterFile], density: float, progress: Callable[[str], None]
) -> dict[str, Triangulation]:
    """Added mass of the parameter files that name a hull, by file; a hull that several name is computed once.

    Parameters
    ----------
    groups : sequence of PlannedParameterFile
    density : float
        kg/m^3.
    progress : callable
        Takes what is being done, in words.
    """
    if all(g.hull is None for g in groups):
        return {}
    from coeflab.bodies.added_masses import added_masses

    known: dict[tuple[Path, str], Triangulation] = {}
    out = {}
    for group in groups:
        if group.hull is None:
            continue
        key = (group.hull, group.method)
        if key not in known:
            body = read_body(group.hull / "body.toml" if group.hull.is_dir() else group.hull)
            progress(f"added mass of {body.name}")
            known[key] = added_masses(body, density, group.method, reproducible=True)
        out[group.name] = known[key]
    return out


def _used(
    plan: Plan, files: Mapping[str, ParameterFile], hulls: Mapping[str, Triangulation], progress: Progress
) -> tuple[tuple[Export, ...], tuple[Refused, ...], tuple[Simulation, ...]]:
    """What a plan does with its parameter files; what it does not ask for is not imported."""
    exports: tuple[Export, ...] = ()
    refused: tuple[Refused, ...] = ()
    manoeuvres: tuple[Simulation, ...] = ()
    if plan.exports:
        from coeflab.formats.export import exports_of

        exports, refused = exports_of(
            plan.exports,
            files.values(),
            progress,
            {n: h.body.shape for n, h in hulls.items() if h.body.shape is not None},
        )
    if plan.manoeuvres:
        from coeflab.motion.simulation import manoeuvres_of

        manoeuvres = manoeuvres_of(plan.manoeuvres, files, progress)
    return exports, refused, manoeuvres


def _of_file(place: str | Path, progress: Progress) -> Study:
    """The study of the plan at a path; what an option of a fit is to blame for names the file."""
    if not isinstance(place, (str, Path)):
        raise input_error("study.plan_path_plan", __name__=type(place).__name__)
    from coeflab.study.plan import plan_at, read_plan

    file = plan_at(place)
    try:
        return run(read_plan(file), progress)
    except InputError as why:
        if why.file is None:
            why.file = file
        raise


def _of_shape(plan: Plan, progress: Progress) -> Study:
    """The study of a body alone."""
    from coeflab.study.estimated_vehicle import from_shape

    body = _body(plan)
    if body is None:
        raise InputError("no table and no body", "a table, or a body to estimate from", column="table")
    return from_shape(plan, body, progress=progress)


def _body(plan: Plan) -> Body | None:
    """What the plan names; a shipped name is a folder."""
    if plan.body is None:
        return None

    return read_body(plan.body / "body.toml" if plan.body.is_dir() else plan.body)


def _bodies(plan: Plan, wanted: Set[str]) -> tuple[Body, ...]:
    """The plan's own and the hulls of its parameter files; of the shipped ones, which are called as their folders, the wanted."""
    geometry = shipped("geometry")
    named = dict.fromkeys(h for h in (plan.hull, *(g.hull for g in plan.parameter_files)) if h is not None)
    hulls = (h for h in named if h.parent != geometry or h.name in wanted)
    others = (read_body(h / "body.toml" if h.is_dir() else h) for h in hulls)
    return tuple(b for b in (_body(plan), *others) if b is not None)


def _require_kilograms(tables: Sequence[ForceTable], body: Body | None) -> None:
    """Refuse two masses of one body that only their units tell apart; `study.checks.sizes` says where they merely differ."""
    for table, stated, ratio in masses_of_models(tables, body):
        if not 1.0 / UNITS_APART < ratio < UNITS_APART:
            raise input_error(
                "study.kg_under_inertia", column="inertia.mass", model_mass=table.model_mass, campaign=table.campaign,
                stated=stated,
            )  # fmt: skip


def _has_points(table: ForceTable) -> bool:
    """Whether a component of a tow has points enough for a fit, as runs that did not converge do not count."""
    return any(len(np.unique(table.setting[mask])) >= FEWEST for mask in table.usable.values())


def _groups(fits: list[FitResult], plan: Plan) -> tuple[PlannedParameterFile, ...]:
    """One parameter file per body when the plan names none."""
    bodies: dict[str, list[str]] = {}
    for f in fits:
        bodies.setdefault(f.body, []).append(f.campaign)
    names = [stem(b) for b in bodies]
    numbered = [n if names.count(n) == 1 else f"{n}_{names[:i].count(n) + 1}" for i, n in enumerate(names)]
    groups = zip(numbered, bodies.items(), strict=True)
    return tuple(
        PlannedParameterFile(n, b, tuple(dict.fromkeys(c)), (), plan.hull, plan.method) for n, (b, c) in groups
    )


def _missing(
    group: PlannedParameterFile, fits: list[FitResult], tables: list[ForceTable], wanted: tuple[str, ...]
) -> list[Coefficient]:
    """Wanted coefficients that no table of a group gives, or one with too few runs."""
    names = {f.campaign for f in fits}
    for campaign in group.campaigns:
        if campaign not in names:
            raise input_error(
                "study.campaign_plan", column=f"parameter_file.{group.name}", campaign=shown(campaign),
                names=", ".join(sorted(names)),
            )  # fmt: skip
    if not any(f.sweeps for f in fits if f.campaign in group.campaigns):
        return []
    have = {s for f in fits if f.campaign in group.campaigns for s in f.coefficients.symbols}
    mine = [t for t in tables if t.campaign in group.campaigns]

    def status(symbol: str) -> Status:
        factors = set(derivative(symbol).factors)
        varied = any(symbol[0] in t.forces and factors <= set(t.varies) for t in mine)
        return Status.TOO_FEW_POINTS if varied else Status.NO_TABLE

    return [
        Coefficient(s, None, None, status(s), group.body, campaign=", ".join(group.campaigns))
        for s in wanted
        if s not in have
    ]


def _inputs(plan: Plan, tables: list[ForceTable], bodies: list[Body]) -> tuple[InputFile, ...]:
    files = [plan.file] if plan.file else []
    files += [f for t in tables for f in t.files]
    files += [f for b in bodies for f in b.files]
    files += [InputFile(p.name, sha256_of(p)) for p in plan.references]
    return tuple(dict.fromkeys(files))
