"""The JSON contract of the command line.

A body's particulars for machines.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.finding import Finding
from coeflab.core.table import Check
from coeflab.core.texts import remark
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import Pooling
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.oscillation import Oscillation
from coeflab.formats.export import Export, Loss
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import ANGULAR, primed
from coeflab.motion.manoeuvre import Figure, Simulation
from coeflab.report.acceptance import Acceptance, Held, held, held_of_study
from coeflab.report.tables import next_runs as next_tables
from coeflab.report.tables import results as tables
from coeflab.study.study import Study
from coeflab.study.towed import Towed, towed
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.inertia import WaterInertia


def coefficient(c: Coefficient, scaling: str, assumed: Sequence[Finding] = ()) -> dict[str, Any]:
    """One coefficient; absent values are null and carry a status."""
    p = c.parts
    return {
        "symbol": primed(c.symbol),
        "value": c.value,
        "u95": c.u95,
        "unit": c.unit,
        "table": c.table,
        "campaign": c.campaign,
        "body": c.body,
        "scaling": scaling,
        "estimator": c.estimator or None,
        "window": None if c.window is None else list(c.window),
        "n_points": c.n_points,
        "status": c.status.value,
        "assumed": [f["key"] for f in assumed],
        "parts": {"random": p.random, "model_form": p.model_form, "window": p.window, "input": p.input},
    }


def finding_as_data(f: Finding) -> dict[str, Any]:
    """A finding as data, and its words."""
    return {
        "code": f.code, "subject": f.subject, "severity": str(f.severity), "statistic": f.statistic, "threshold": f.threshold,
        "advice": f.advice, "facts": {name: list(v) if isinstance(v, tuple) else v for name, v in f.facts}, "words": remark(f),
    }  # fmt: skip


def next_runs(s: Study, symbols: Sequence[str], count: int) -> list[dict[str, Any]]:
    """The runs that would narrow each slope most; asin(v/U) in radians, rates as r' = r L/U; U95 is the whole one."""
    out = []
    for fit in s.fits:
        for sweep in (one for one in fit.sweeps if not symbols or one.symbol in symbols):
            degrees = sweep.variable not in ANGULAR
            runs = [
                {
                    "setting": float(np.arcsin(np.clip(x, -1.0, 1.0))) if sweep.is_angle else x,
                    "unit": "rad" if degrees else "1",
                    "u95_after": after,
                }
                for x, after in next_tables.next_runs(s, fit, sweep, count)
            ]
            if runs:
                rest = next_tables.outside(fit, sweep)
                u95 = None if sweep.u95 is None else float(np.hypot(sweep.u95, rest))
                words = {"symbol": primed(sweep.symbol), "campaign": fit.campaign, "variable": sweep.variable}
                out.append(words | {"u95_now": u95, "outside": rest, "runs": runs})
    return out


def model(m: FittedModel) -> dict[str, Any]:
    """One fitted force law or table; a coefficient that the data leave open is null."""
    rows = zip(m.symbols, m.terms, m.fit.coefficients, m.half_width, strict=True)
    return {
        "response": m.response,
        "unit": m.unit,
        "form": m.form,
        "table": m.table,
        "campaign": m.campaign,
        "body": m.body,
        "n_points": m.n_points,
        "rms": m.fit.rms,
        "left_out_rms": finite(m.fit.press_rms),
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
        "holds": ["random", *m.shared],
        "post_selection": m.post_selection,
        "statements": list(m.statements),
    }


def pooling(campaign: str, p: Pooling) -> dict[str, Any]:
    """The campaigns of one component of a joint fit, and the test of one law."""
    return {
        "response": p.response,
        "campaign": campaign,
        "campaigns": [
            {
                "campaign": s.campaign,
                "n_points": s.n_points,
                "intercept": s.intercept,
                "intercept_half_width_95": s.half_width,
                "noise": s.noise,
                "rms": s.rms,
                "rms_alone": s.rms_alone,
                "left_out_rms_of_range": finite(s.left_out.rms) if s.left_out.told else None,
            }
            for s in p.shares
        ],
        "every_third_left_out_rms_of_range": finite(p.every_third.rms) if p.every_third.told else None,
        "one_law": {
            "f": finite(p.test.statistic),
            "restrictions": p.test.restrictions,
            "freedom": finite(p.test.freedom),
            "probability": finite(p.test.probability),
            "rejected": p.rejected,
        },
    }


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


def accelerations(water: WaterInertia) -> dict[str, Any]:
    """Which accelerations were asked for and taken, and where they come from."""
    return {"asked": water.asked, "used": water.used, "source": water.source, "warnings": list(water.warnings)}


def findings(found: Sequence[Check]) -> list[dict[str, str]]:
    """Findings of `coeflab params check`."""
    return [
        {"severity": str(c.severity), "what": c.subject, "found": c.statistic, "expected": c.rule, "means": c.comment}
        for c in found
    ]


def export(made: Export) -> dict[str, Any]:
    """What one target makes of a parameter file; forces are X Y Z K M N, SI."""
    loss = made.loss
    return {
        "parameter_file": made.parameters,
        "target": made.target,
        "accelerations": None if loss is None else accelerations(loss.water),
        "lossless": made.lossless,
        "not_held": [] if loss is None else list(loss.not_held),
        "lost": [] if loss is None else [{"kind": x.kind.value, "what": x.what} for x in loss.lost],
        "changes": [] if loss is None else list(loss.changes),
        "grid": None if loss is None else loss.grid,
        "controls": [] if loss is None else list(loss.controls),
        "worst_difference": None if loss is None else loss.worst.tolist(),
        "rms_difference": None if loss is None else loss.rms.tolist(),
        "largest_force": None if loss is None else loss.largest.tolist(),
        "astern_broadside_rest": None if loss is None or loss.rare is None else loss.rare.worst.tolist(),
        "accelerations_compared": None if loss is None else accelerations_compared(loss),
        "law_at_points": [] if loss is None else [f.model_dump(mode="json") for f in loss.at_points],
    }


def accelerations_compared(loss: Loss) -> dict[str, Any]:
    """Differences of the rates of u v w p q r, m/s^2 and rad/s^2; null where they are not known."""
    found = loss.accelerations
    if found is None:
        return {"why_not": loss.not_compared}
    return {
        "worst_difference": [finite(x) for x in found.worst.tolist()],
        "rms_difference": [finite(x) for x in found.rms.tolist()],
        "largest": [finite(x) for x in found.largest.tolist()],
        "why_not": loss.not_compared or None,
    }


def finding(c: Check) -> dict[str, str]:
    """One finding of a check."""
    return {
        "check": c.name, "subject": c.subject, "severity": c.severity.value, "found": c.statistic, "rule": c.rule,
        "comment": c.comment,
    }  # fmt: skip


def numbers(found: Held) -> dict[str, dict[str, int]]:
    """How many numbers of each basis there are and hold; only the first two bases validate anything."""
    return {b.value: {"count": count, "hold": good} for b, (good, count) in found.items()}


def tow(found: Towed) -> dict[str, Any]:
    """Every wanted coefficient of a towed body; absent values are null and ``missing`` and ``why`` say why."""
    return {
        "name": found.tow.name,
        "body": found.body,
        "campaign": found.tow.campaign or None,
        "reynolds": found.reynolds,
        "rows": [
            {
                "symbol": primed(r.symbol),
                "value": r.value,
                "u95": r.u95,
                "u_grid": r.u_grid,
                "is_result": r.is_result,
                "one_line": r.line,
                "model_spread": r.model,
                "missing": r.missing or None,
                "why": r.why or None,
                "published": dict(zip(found.columns, r.published, strict=True)),
                "test": None if r.validation is None else r.validation.experiment,
                "measured": None if r.validation is None else r.validation.measured,
                "error": None if r.validation is None else r.validation.error,
                "u_validation": None if r.validation is None else r.validation.u_validation,
                "within_u_validation": r.verdict,
                "why_no_verdict": r.why_none or None,
            }
            for r in found.rows
        ],
    }


def declared(t: ForceTable) -> dict[str, Any]:
    """What its campaign.toml says of a table."""
    d = t.declared
    return {
        "table": t.name,
        "frame": d.frame if d else None,
        "signs": dict(d.signs) if d else {},
        "signs_assumed": list(t.assumed),
        "reference_point": list(d.reference_point) if d else None,
        "datum": t.datum.id,
        "length": t.scaling.length,
        "length_name": t.scaling.length_name,
        "density": t.conditions.density,
        "speed": t.conditions.speed,
        "symmetry": list(t.symmetry),
        "source": t.source.citation,
        "source_sha256": (d.source_sha256 if d else "") or None,
        "notes": (d.notes if d else "") or None,
    }


def study(s: Study, files: list[str]) -> dict[str, Any]:
    """A whole study."""
    scalings = {f.campaign: str(f.coefficients.scaling) for f in s.fits}
    common = str(s.fits[0].coefficients.scaling)
    return {
        "study": s.plan.name,
        "passed": not s.failed,
        "u95_of_slopes_covers": tables.covers(s),
        "numbers": numbers(held_of_study(s)),
        "coefficients": [
            coefficient(c, scalings.get(c.campaign or "", common), tables.assumed_of(s, c)) for c in s.coefficients
        ],
        "findings": [finding_as_data(f) for f in dict.fromkeys(found for fit in s.fits for found in fit.findings)],
        "models": [model(m) for f in s.fits for m in f.models],
        "poolings": [pooling(f.campaign, p) for f in s.fits for p in f.poolings],
        "oscillations": [oscillation(f.campaign, o) for f in s.fits for o in f.oscillations],
        "comparisons": [
            {
                "symbol": primed(c.coefficient.symbol),
                "campaign": c.coefficient.campaign,
                "value": c.coefficient.value,
                "u95": c.coefficient.u95,
                "reference": c.reference,
                "relation": c.relation.value,
                "length_read_as": c.reading,
                "published": c.published,
                "difference": c.difference,
                "passed": c.passed,
            }
            for c in s.comparisons
        ],
        "tows": [tow(t) for t in towed(s)],
        "campaigns": [declared(t) for t in s.tables if t.declared is not None],
        "law_at_points": {
            name: [f.model_dump(mode="json") for f in p.law_at_points] for name, p in s.parameter_files.items()
        },
        "checks": [finding(c) for c in s.checks],
        "exports": [export(result) for result in s.exports],
        "refused_exports": [{"parameter_file": r.parameters, "target": r.target, "why": str(r.why)} for r in s.refused],
        "files": files,
    }


def figures(found: tuple[Figure, ...]) -> list[dict[str, Any]]:
    """Figures of a manoeuvre; absent values are null and carry a status."""
    return [
        {
            "name": f.name, "value": f.value, "unit": f.unit, "status": f.status, "why": f.why or None,
            "interval_95": None if f.low is None else [f.low, f.high], "definition": f.definition,
        }
        for f in found
    ]  # fmt: skip


def simulation(made: Simulation) -> dict[str, Any]:
    """A simulated manoeuvre without its time series."""
    t = made.trajectory
    return {
        "vehicle": made.vehicle.name,
        "manoeuvre": made.manoeuvre.name,
        "free": list(made.vehicle.free),
        "accelerations": accelerations(made.vehicle.water),
        "ended": t.ended.value,
        "why": t.why or None,
        "duration": float(t.time[-1]),
        "outside": sorted(name for name, flags in t.outside.items() if flags.any()),
        "determined_until": None if math.isinf(made.determined) else made.determined,
        "undetermined": made.undetermined or None,
        "figures": figures(made.figures),
        "statements": list(made.statements),
    }


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


def body_json(body: Body, density: float) -> dict[str, Any]:
    """Volumes, centres, areas and inertia of the displaced water by configuration, SI, FRD; None where not known."""
    out: dict[str, Any] = {"body": body.name, "datum": str(body.datum), "density": density}
    if isinstance(body.shape, TriangleMesh):
        out |= {"faces": len(body.shape.faces), "extents": body.shape.extents.tolist()}
    out["configurations"] = [
        {
            "name": c.name,
            "title": c.title,
            "volume": c.volume,
            "wetted_surface": c.wetted_surface,
            "centre_of_buoyancy": _listed(c.centre_of_buoyancy),
            "projected_areas": _listed(c.projected_areas),
            "displaced_inertia": _listed(c.displaced_inertia(density)),
        }
        for c in body.configurations
    ]
    return out


def _listed(values: NDArray[np.float64] | None) -> list[Any] | None:
    return None if values is None else list(values.tolist())
