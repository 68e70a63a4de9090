"""The main path: tables -> fits -> comparisons -> parameter files -> checks, one study.

What a plan names, read: tables about one reference point, bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.readers import read_body
from coeflab.core.errors import CoeflabError, InputError, ScalingMismatchError, shown
from coeflab.core.files import stem
from coeflab.core.finding import Severity
from coeflab.core.machine import one_thread
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.table import Check
from coeflab.core.wording import Verbatim
from coeflab.fits import FITS, CompletingFit
from coeflab.fits.joint.rows import joint_name, one_length
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.uncertainty.budget import Budget, as_estimates, budgets_of, with_budget
from coeflab.fits.uncertainty.model_budget import with_model_budgets
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import MOTIONS, derivative
from coeflab.motion.simulation import manoeuvres_of
from coeflab.report.content import document
from coeflab.report.formats import REPORTERS
from coeflab.study.checks import CHECKS
from coeflab.study.plan import plan_at, read_plan
from coeflab.study.study import Plan, PlannedJoint, Study
from coeflab.tables.assumptions import carried
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.tables.planar_motion import PlanarMotionTable
from coeflab.tables.reading import read_tables
from coeflab.vehicle.assemble import PlannedParameterFile, assemble
from coeflab.vehicle.merge import merged
from coeflab.vehicle.parameter_file import read_parameter_file, refusals_told
from coeflab.vehicle.reference import compare, compare_set, read_references
from coeflab.workbench.exports import exports_of, parameter_files_rendered, refuse_unknown
from coeflab.workbench.hulls import hulls_of
from coeflab.workbench.vehicle import from_shape


def settled(table: ForceTable, plan: Plan) -> ForceTable:
    """The table about the plan's reference point."""
    if plan.include_uncertain:
        table = table.with_uncertain_cells()
    if plan.reference_point is None:
        return table
    if plan.datum and plan.datum != table.datum:
        raise ScalingMismatchError(
            f"the plan measures points from {shown(plan.datum.id)}, {table.campaign} from {shown(table.datum.id)}; "
            "state the reference point from one datum. A body names its own as datum under [body] of its body.toml; that of a mesh is its origin."
        )
    return table.about(plan.reference_point)


def together(joint: PlannedJoint, plan: Plan) -> list[ForceTable]:
    """All tables of a joint fit, each once."""
    read = [settled(t, plan) for planned in joint.tables for t in read_tables(planned)]
    names = [t.name for t in read]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise InputError(f"the table {shown(twice)} twice", "every table once, and campaigns of different names",
                         column="campaigns", advice="A row that counts twice makes every interval too narrow.")  # fmt: skip
    return read


__all__ = ["checked", "read_body", "read_tables", "rendered", "run"]

Progress = Callable[[str], None]
FEWEST = 3
COMBINES = "manoeuvring_model"  # the fit of rows that vary several motions at once


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
    refuse_unknown(plan.exports)
    if not plan.tables and not plan.joint:
        return checked(_of_shape(plan, progress), progress)
    tables: list[ForceTable] = []
    fits: list[FitResult] = []
    budgets: list[Budget] = []
    unfitted: dict[str, str] = {}
    ours = [t.added for t in plan.tows if t.added is not None]
    for planned in plan.tables:
        read = [settled(t, plan) for t in read_tables(planned)]
        progress(f"read {read[0].campaign}: {sum(map(len, read))} rows")
        scaling = plan.scaling or read[0].scaling
        is_ours = planned.campaign in ours
        enough = [t for t in read if _has_points(t)] if is_ours else read
        for name in planned.fits if enough else ():
            try:
                fitted, found = _fitted(name, enough, scaling, planned.options.get(name, {}), fits)
            except InputError as why:
                if not is_ours:
                    raise
                unfitted.setdefault(read[0].campaign, why.found)
                continue
            budgets += found
            fits.append(fitted)
            progress(f"fitted {read[0].campaign} by {name}")
        tables += read
    for joint in plan.joint:
        read = together(joint, plan)
        progress(f"read {joint_name(t.campaign for t in read)}: {sum(map(len, read))} rows")
        fitted, found = _fitted(joint.fit, read, plan.scaling or one_length(read), joint.options)
        budgets += found
        fits.append(fitted)
        progress(f"fitted {fitted.campaign} by {joint.fit}")
        tables += [t for t in read if t.name not in {known.name for known in tables}]
    body = read_body(_body_file(plan.body)) if plan.body else None
    references = tuple(r for path in plan.references for r in read_references(path))
    groups = plan.parameter_files or _groups(fits, plan)
    missing = tuple(c for g in groups for c in _missing(g, fits, tables, plan.wanted))
    first = plan.scaling or fits[0].coefficients.scaling
    conditions = plan.conditions or tables[0].conditions
    hulls = hulls_of(groups, conditions.density, progress)
    inputs = _inputs(plan, tables, [b for b in (body, *(h.body for h in hulls.values())) if b is not None])
    files = {}
    for g in groups:
        with refusals_told(f"parameter_file.{g.name}"[:80]):
            files[g.name] = assemble(
                g, plan.name, fits, tables, missing, references, body, conditions, inputs, hulls.get(g.name)
            )
            if g.base is not None:
                files[g.name] = merged(read_parameter_file(g.base), files[g.name], g.name).parameters
    exports, refused = exports_of(plan.exports, files.values(), progress)
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
        manoeuvres=manoeuvres_of(plan.manoeuvres, files, progress),
        unfitted=unfitted,
    )
    return checked(study, progress)


def _of_file(place: str | Path, progress: Progress) -> Study:
    """The study of the plan at a path; what an option of a fit is to blame for names the file."""
    if not isinstance(place, (str, Path)):
        raise InputError(
            f"run({type(place).__name__})", "a Plan, the path of a plan.toml, or the name of a shipped plan",
            advice="A publication that coeflab.validation reproduces is done already; a campaign or a body goes into a Plan.",
        )  # fmt: skip
    file = plan_at(place)
    try:
        return run(read_plan(file), progress)
    except InputError as why:
        if why.file is None:
            why.file = file
        raise


def _of_shape(plan: Plan, progress: Progress) -> Study:
    """The study of a body alone."""
    if plan.body is None:
        raise InputError("no table and no body", "a table, or a body to estimate from", column="table")
    return from_shape(plan, read_body(_body_file(plan.body)), progress=progress)


def _body_file(path: Path) -> Path:
    """A shipped name is a folder."""
    return path / "body.toml" if path.is_dir() else path


def checked(study: Study, progress: Progress = lambda _: None) -> Study:
    """The study with what every check finds."""
    findings = [c for name in CHECKS.names() for c in _findings(name, study)]
    progress(f"{len(findings)} checks")
    return study.with_checks(tuple(findings))


def _has_points(table: ForceTable) -> bool:
    """Whether a component of a tow has points enough for a fit, as runs that did not converge do not count."""
    return any(len(np.unique(table.setting[mask])) >= FEWEST for mask in table.usable.values())


def _findings(name: str, study: Study) -> tuple[Check, ...]:
    """What one check finds; of another package's that raises, the finding is that it did."""
    try:
        with CHECKS.guarded(name):
            found = tuple(CHECKS.load(name).check(study))
            if not all(isinstance(c, Check) for c in found):
                raise TypeError("a finding that is no Check")
    except CoeflabError as why:
        if CHECKS.is_shipped(name):
            raise
        return (
            Check(name, "every campaign", Severity.WARN, Verbatim(why), "a check that ends with findings",
                  "What this check looks at was not assessed. Mend or uninstall the package that it comes from."),
        )  # fmt: skip
    return found if CHECKS.is_shipped(name) else tuple(map(_in_their_words, found))


def _in_their_words(c: Check) -> Check:
    """Another package's finding: nothing in its texts is taken for a symbol."""
    said = map(Verbatim, (c.statistic, c.rule, c.comment))
    return Check(Verbatim(c.name), Verbatim(c.subject), c.severity, *said)


def _fitted(
    name: str,
    tables: Sequence[ForceTable],
    scaling: Scaling,
    options: Mapping[str, Any],
    earlier: Sequence[FitResult] = (),
) -> tuple[FitResult, tuple[Budget, ...]]:
    """One fit with its budgets in it, and these; one that completes another is given that, budgets and all."""
    _refuse_several(name, tables)
    _refuse_unsuited(name, tables)

    def once(some: Sequence[ForceTable], by: Scaling) -> FitResult:
        with FITS.guarded(name):
            plugin = FITS.load(name)
            if isinstance(plugin, CompletingFit):
                own = [f for f in earlier if (f.fit, f.campaign) == (plugin.completes, tables[0].campaign)]
                if own:
                    return plugin.complete(own[-1], some, by, options)
            return plugin.fit(some, by, options)

    fit = once(tables, scaling)
    _refuse_starved(fit, tables)
    found = budgets_of(fit, {t.name: t for t in tables})
    fit, more = with_model_budgets(with_budget(fit, found), tables, scaling, once)
    assumed = carried([f for t in tables for f in t.findings], fit.coefficients.coefficients)
    fit = replace(fit, findings=(*fit.findings, *assumed))
    if all(t.source.kind == "estimate" for t in tables):
        return as_estimates(fit), tuple(replace(b, u95=None) for b in (*found, *more))
    return fit, (*found, *more)


def _refuse_several(name: str, tables: Sequence[ForceTable]) -> None:
    """Refuse several campaigns in a fit that knows nothing of their intercepts and scatter."""
    campaigns = joint_name(t.campaign for t in tables)
    if len({t.campaign for t in tables}) > 1 and not FITS.load(name).joins_campaigns:
        able = [n for n in FITS.usable() if FITS.load(n).joins_campaigns]
        raise InputError(f"{name} over the campaigns {campaigns}", f"a fit that joins campaigns: {', '.join(able)}",
                         column="fit", advice="Or fit each campaign by itself.")  # fmt: skip


def _refuse_unsuited(name: str, tables: Sequence[ForceTable]) -> None:
    """Refuse a fit of steady forces to oscillating runs, and the reverse."""
    with FITS.guarded(name):
        series = FITS.load(name).reads_series
    odd = next((t for t in tables if isinstance(t, PlanarMotionTable) != series), None)
    if odd is not None:
        what = "steady forces" if series else "oscillating runs"
        able = [n for n in FITS.usable() if FITS.load(n).reads_series != series]
        few = ", ".join(able) if len(able) < FEWEST else "slope_at_origin, tied_law or another fit of steady forces"
        raise InputError(f"{name} over {what}", f"fits of those: {few}", file=odd.name, column="fits")


def _refuse_starved(fit: FitResult, tables: Sequence[ForceTable]) -> None:
    """Refuse a sweep in which no force component has more points than the simplest form has parameters."""
    sweeps = [s for s in fit.sweeps if s.parity == "odd" and s.variable in MOTIONS]
    for table, variable in dict.fromkeys((s.table, s.variable) for s in sweeps):
        points = max(len(s.x) for s in sweeps if (s.table, s.variable) == (table, variable))
        if points < FEWEST:
            combined = next((_combined(t) for t in tables if t.name == table), 0)
            joined = f"{combined} rows combine motions: --fit {COMBINES} fits them as one model. Or run"
            raise InputError(
                f"{points} usable point{'s' * (points != 1)} of the sweep over {variable}'",
                f"at least {FEWEST} for an intercept, a slope and an error",
                file=table,
                advice=f"{joined if combined >= FEWEST else 'Run'} more settings, or leave the table out of the plan.",
            )


def _combined(table: ForceTable) -> int:
    """Rows in which more than one of v, w, p, q, r is not at rest."""
    sizes = [np.abs(table.motion[m]) for m in MOTIONS[1:]]
    moving = [size > AT_REST * float(np.max(size, initial=0.0)) for size in sizes]
    return int(np.sum(np.sum(moving, axis=0) > 1))


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
            raise InputError(
                f"no campaign {shown(campaign)} in the plan", f"one of {', '.join(sorted(names))}",
                column=f"parameter_file.{group.name}",
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


@one_thread()
def rendered(study: Study, formats: Sequence[str] = ("html",)) -> dict[str, bytes]:
    """Every file of a study: parameter files, exports and the core of the report, by name. Nothing is written."""
    files: dict[str, bytes] = {}
    report = document(study, full=False)
    for name in formats:
        with REPORTERS.guarded(name):
            files.update(REPORTERS.load(name).render(report))
    files.update(parameter_files_rendered(study.parameter_files.values()))
    for made in study.exports:
        files.update(
            {f"{made.folder}/{name}" if made.folder else name: content for name, content in made.files.items()}
        )
    return files
