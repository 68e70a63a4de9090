"""What the report counts as found, and what it says of rig and balance."""

from __future__ import annotations

from dataclasses import replace

from coeflab.core.provenance import Source
from coeflab.fits.uncertainty.budget import RIG
from coeflab.report.first_page import answer
from coeflab.report.sections.verdict import verdict
from tests.report.studies import FULL, budgets, small_study

STATED = "static derivatives 4-5 %"


def harvest(study) -> str:
    return next(p for p in verdict(study).texts if p.startswith("We found "))


def test_copies_by_symmetry_do_not_count_and_kinds_are_named():
    study = small_study(FULL)
    found = [c for c in study.coefficients if c.value is not None]
    plain = harvest(study)
    assert plain.startswith(f"We found {len(found)} coefficients (")
    assert "linear" in plain
    assert "copies" not in plain
    fit = study.fits[0]
    turned = tuple(replace(s, by_symmetry="tow/other") if s.symbol == "Nv" else s for s in fit.sweeps)
    copied = harvest(replace(study, fits=(replace(fit, sweeps=turned), *study.fits[1:])))
    assert copied.startswith("We found 1 coefficient (")
    assert copied.endswith("Another one follows from these by symmetry.")


def test_the_first_page_says_what_the_source_states_where_rig_and_balance_are_left_out():
    study = small_study(FULL)
    tables = tuple(replace(t, source=Source("t", kind="experiment", stated_uncertainty=STATED)) for t in study.tables)
    found = tuple(replace(b, unassessed=(*b.unassessed, RIG)) for b in budgets(study))
    wanted = f"; the test report states for its own: {STATED}."
    (said,) = (n for n in answer(replace(study, tables=tables, budgets=found)).notes if n.endswith(wanted))
    assert said.startswith("Not in U95: errors of ")
    assert not any(
        "the test report states " in n for n in answer(replace(study, tables=tables, budgets=budgets(study))).notes
    )
    assert not any("the test report states " in n for n in answer(replace(study, budgets=found)).notes)
