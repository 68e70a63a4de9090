"""Studies, fits, exports and publications for machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coeflab.core.finding import Finding
from coeflab.core.wording import finite
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.oscillation import Oscillation
from coeflab.fits.results.pooling import Pooling
from coeflab.formats.export import Export
from coeflab.formats.loss import Loss
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import primed
from coeflab.report.acceptance import Acceptance, Held, held, held_of_study
from coeflab.report.as_json.findings import finding, finding_as_data
from coeflab.report.as_json.motions import accelerations
from coeflab.report.tables import results as tables
from coeflab.study.next_tests import NextTests
from coeflab.study.study import Study
from coeflab.study.towed import Towed, towed
from coeflab.tables.force_table import ForceTable


def coefficient(c: Coefficient, scaling: str, assumed: Sequence[Finding] = ()) -> dict[str, Any]:
    """One coefficient; absent values are null and carry a status."""
    p = c.parts
    return {
        "symbol": primed(c.symbol), "value": c.value, "u95": c.u95, "unit": c.unit, "table": c.table, "campaign": c.campaign,
        "body": c.body, "scaling": scaling, "estimator": c.estimator or None, "window": None if c.window is None else list(c.window),
        "n_points": c.n_points, "status": c.status.value, "assumed": [f["key"] for f in assumed],
        "parts": {"random": p.random, "model_form": p.model_form, "window": p.window, "input": p.input},
    }  # fmt: skip


def model(m: FittedModel) -> dict[str, Any]:
    """One fitted force law or table; a coefficient that the data leave open is null."""
    rows = zip(m.symbols, m.terms, m.fit.coefficients, m.half_width, strict=True)
    return {
        "response": m.response, "unit": m.unit, "form": m.form, "table": m.table, "campaign": m.campaign, "body": m.body,
        "n_points": m.n_points, "rms": m.fit.rms, "left_out_rms": finite(m.fit.press_rms),
        "coefficients": [
            {"symbol": s, "term": str(t), "value": finite(float(v)), "half_width_95": finite(float(h))}
            for s, t, v, h in rows
        ],
        "domain": {
            "variables": list(m.domain.variables),
            "low": [float(x) for x in m.domain.low],
            "high": [float(x) for x in m.domain.high],
            "outside": m.domain.rule.value,
        },
        "holds": ["random", *m.shared], "post_selection": m.post_selection, "statements": list(m.statements),
    }  # fmt: skip


def pooling(campaign: str, p: Pooling) -> dict[str, Any]:
    """The campaigns of one component of a joint fit, and the test of one law."""
    return {
        "response": p.response, "campaign": campaign,
        "campaigns": [
            {
                "campaign": s.campaign, "n_points": s.n_points, "intercept": s.intercept, "intercept_half_width_95": s.half_width,
                "noise": s.noise, "rms": s.rms, "rms_alone": s.rms_alone,
                "left_out_rms_of_range": finite(s.left_out.rms) if s.left_out.is_known else None,
            }
            for s in p.shares
        ],
        "every_third_left_out_rms_of_range": finite(p.every_third.rms) if p.every_third.is_known else None,
        "one_law": {
            "f": finite(p.test.statistic), "restrictions": p.test.restrictions, "freedom": finite(p.test.freedom),
            "probability": finite(p.test.probability), "rejected": p.rejected,
        },
    }  # fmt: skip


def oscillation(campaign: str, o: Oscillation) -> dict[str, Any]:
    """One component of oscillating runs; half-widths are 95 %, unknown ones null."""
    e = o.explained()
    return {
        "campaign": campaign,
        "motion": o.motion,
        "symbol": primed(o.symbol),
        "steady_interval": None if o.interval is None else list(o.interval),
        "by_amplitude": {
            "amplitude": e.amplitude, "measured": finite(e.measured[0]), "measured_u95": finite(e.measured[1]),
            "difference_from_zero_amplitude": finite(e.difference), "explained": finite(e.by_amplitude),
        },
        "over_frequency": {
            primed(name): {"slope": finite(at.frequency[0]), "u95": finite(at.frequency[1]), "p": finite(at.frequency[2])}
            for name, at in ((o.symbol, o.damping), (f"{o.symbol}dot", o.inertia))
        },
        "runs": [
            {
                "run": r.label, "amplitude": r.amplitude, "frequency": r.frequency, "cycles": r.cycles, "drift": r.drift,
                "damping": finite(r.damping[0]), "damping_u95": finite(r.damping[1]), "inertia": finite(r.inertia[0]),
                "inertia_u95": finite(r.inertia[1]), "mean": r.mean, "used": r.used,
            }
            for r in o.runs
        ],
    }  # fmt: skip


def export(result: Export) -> dict[str, Any]:
    """What one target makes of a parameter file; forces are X Y Z K M N, SI."""
    loss = result.loss
    return {
        "parameter_file": result.parameters, "target": result.target, "accelerations": None if loss is None else accelerations(loss.water),
        "lossless": result.lossless, "not_held": [] if loss is None else list(loss.not_held),
        "lost": [] if loss is None else [{"kind": x.kind.value, "what": x.what} for x in loss.lost],
        "changes": [] if loss is None else list(loss.changes), "grid": None if loss is None else loss.grid,
        "controls": [] if loss is None else list(loss.controls), "worst_difference": None if loss is None else loss.worst.tolist(),
        "rms_difference": None if loss is None else loss.rms.tolist(), "largest_force": None if loss is None else loss.largest.tolist(),
        "astern_broadside_rest": None if loss is None or loss.rare is None else loss.rare.worst.tolist(),
        "accelerations_compared": None if loss is None else accelerations_compared(loss),
        "law_at_points": [] if loss is None else [f.model_dump(mode="json") for f in loss.at_points],
    }  # fmt: skip


def accelerations_compared(loss: Loss) -> dict[str, Any]:
    """Differences of the rates of u v w p q r, m/s^2 and rad/s^2; null where they are not known."""
    found = loss.accelerations
    if found is None:
        return {"why_not": loss.not_compared}
    return {
        "worst_difference": [finite(x) for x in found.worst.tolist()], "rms_difference": [finite(x) for x in found.rms.tolist()],
        "largest": [finite(x) for x in found.largest.tolist()], "why_not": loss.not_compared or None,
    }  # fmt: skip


def numbers(found: Held) -> dict[str, dict[str, int]]:
    """How many numbers of each basis there are and hold; only the first two bases validate anything."""
    return {b.value: {"count": count, "hold": good} for b, (good, count) in found.items()}


def tow(found: Towed) -> dict[str, Any]:
    """Every wanted coefficient of a towed body; absent values are null and ``missing`` and ``why`` say why."""
    return {
        "name": found.tow.name, "body": found.body, "campaign": found.tow.campaign or None, "reynolds": found.reynolds,
        "rows": [
            {
                "symbol": primed(r.symbol), "value": r.value, "u95": r.u95, "u_grid": r.u_grid, "is_result": r.is_result,
                "one_line": r.line, "model_spread": r.model, "missing": r.missing or None, "why": r.why or None,
                "published": dict(zip(found.columns, r.published, strict=True)),
                "test": None if r.validation is None else r.validation.experiment,
                "measured": None if r.validation is None else r.validation.measured,
                "error": None if r.validation is None else r.validation.error,
                "u_validation": None if r.validation is None else r.validation.u_validation, "within_u_validation": r.verdict,
                "why_no_verdict": r.why_none or None,
            }
            for r in found.rows
        ],
    }  # fmt: skip


def declared(t: ForceTable) -> dict[str, Any]:
    """What its campaign.toml says of a table."""
    d = t.declared
    return {
        "table": t.name, "frame": d.frame if d else None, "signs": dict(d.signs) if d else {}, "signs_assumed": list(t.assumed),
        "reference_point": list(d.reference_point) if d else None, "datum": t.datum.id, "length": t.scaling.length,
        "length_name": t.scaling.length_name, "density": t.conditions.density, "speed": t.conditions.speed,
        "symmetry": list(t.symmetry), "source": t.source.citation, "source_sha256": (d.source_sha256 if d else "") or None,
        "notes": (d.notes if d else "") or None,
    }  # fmt: skip


def table(t: ForceTable) -> dict[str, Any]:
    """What a table holds, SI and FRD."""
    return {
        "name": t.name, "body": t.body, "rows": len(t), "varies": list(t.varies), "components": list(t.forces),
        "reference_point": t.reference_point.tolist(), "datum": t.datum.id, "scaling": str(t.scaling), "density": t.conditions.density,
        "density_of_rows": None if t.density is None else t.density.tolist(),
        "excluded": [{"line": e.line, "component": e.component, "reason": e.reason} for e in t.exclusions], "notes": list(t.notes),
    }  # fmt: skip


def study(s: Study, files: list[str]) -> dict[str, Any]:
    """A whole study."""
    scalings = {f.campaign: str(f.coefficients.scaling) for f in s.fits}
    common = str(s.fits[0].coefficients.scaling)
    return {
        "study": s.plan.name, "passed": not s.failed, "u95_of_slopes_covers": tables.covers(s), "numbers": numbers(held_of_study(s)),
        "coefficients": [
            coefficient(c, scalings.get(c.campaign or "", common), tables.assumed_of(s, c)) for c in s.coefficients
        ],
        "findings": [finding_as_data(f) for f in dict.fromkeys(found for fit in s.fits for found in fit.findings)],
        "models": [model(m) for f in s.fits for m in f.models],
        "poolings": [pooling(f.campaign, p) for f in s.fits for p in f.poolings],
        "oscillations": [oscillation(f.campaign, o) for f in s.fits for o in f.oscillations],
        "comparisons": [
            {
                "symbol": primed(c.coefficient.symbol), "campaign": c.coefficient.campaign, "value": c.coefficient.value,
                "u95": c.coefficient.u95, "reference": c.reference, "relation": c.relation.value, "length_read_as": c.reading,
                "published": c.published, "difference": c.difference, "passed": c.passed,
            }
            for c in s.comparisons
        ],
        "tows": [tow(t) for t in towed(s)], "campaigns": [declared(t) for t in s.tables if t.declared is not None],
        "law_at_points": {
            name: [f.model_dump(mode="json") for f in p.law_at_points] for name, p in s.parameter_files.items()
        },
        "checks": [finding(c) for c in s.checks], "exports": [export(result) for result in s.exports],
        "refused_exports": [{"parameter_file": r.parameters, "target": r.target, "why": str(r.why)} for r in s.refused], "files": files,
    }  # fmt: skip


def acceptance(found: Acceptance) -> dict[str, Any]:
    """A publication reproduced, table by table."""
    return {
        "name": found.name,
        "title": found.title,
        "passed": found.holds,
        "numbers": numbers(held(found)),
        "tables": {
            t.key: {
                "title": t.title,
                "source": t.source,
                "repeats": t.repeats or None,
                "passed": t.holds,
                "rows": [
                    {
                        "case": r.case, "quantity": r.quantity, "unit": r.unit, "held_against": r.against, "found": r.found,
                        "difference": r.difference, "relative": r.relative, "tolerance": r.tolerance, "basis": r.basis, "at_most": r.at_most,
                        "passed": r.holds,
                    }
                    for r in t.rows
                ],
                "statements": list(t.statements),
            }
            for t in found.tables
        },
        "errata": list(found.errata),
        "statements": list(found.statements),
        "citations": list(found.citations),
    }  # fmt: skip


def next_tests(found: NextTests) -> dict[str, Any]:
    """Tests, best first; settings in rad, or r' and q'; U95 of the wanted figure after the runs of each test alone."""
    return {
        "for": found.wanted,
        "value": found.value,
        "u95": found.u95,
        "target": found.target,
        "reached": str(found.reached),
        "u95_after_all": found.best,
        "noise_assumed": found.noise,
        "curves_assumed": list(found.assumed),
        "tests": [
            {
                "test": str(t.kind),
                "variable": t.variable or None,
                "share_of_variance": t.share,
                "settings": [float(x) for x in t.angles],
                "u95_then": t.wanted_then,
                "coefficients": [
                    {"symbol": s, "u95_now": now, "u95_then": then}
                    for s, (now, then) in zip(t.symbols, t.u95, strict=True)
                ],
            }
            for t in found.tests
        ],
    }
