"""Own CFD runs of a body: its wanted coefficients beside published columns, and against the test after ASME V&V 20."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import ABSENT, Table, as_printed, percent, with_u95
from coeflab.core.wording import collected, listed
from coeflab.law.symbols import primed
from coeflab.report.tables.budgets import SET_IN_A_COMPUTATION, grid_of_some, sentences_on_open
from coeflab.report.tables.results import NO_VALUE
from coeflab.report.texts import table_of
from coeflab.study.lines import NAME
from coeflab.study.towed import NO_RESULT as SHARE
from coeflab.study.towed import Towed
from coeflab.study.validation import AS_PRINTED, in_millions

NO_RESULT = "no result"
AGAINST = {True: "within U_V", False: "beyond U_V", None: "no verdict"}


def own_tow(found: Towed) -> Table:
    """The wanted coefficients of a towed body beside the published columns, what is missing with its reason; 80 columns."""
    rows = []
    for r in found.rows:
        value, u95 = (NO_VALUE, ABSENT) if r.missing else with_u95(r.value, r.u95)
        value = value if r.is_result else NO_RESULT
        line = ABSENT if r.line is None else as_printed(float(f"{r.line:.3g}"))
        rows.append((primed(r.symbol), value, u95, percent(r.u_grid, r.value), line, *map(as_printed, r.published)))
    named = collected((r.why, primed(r.symbol)) for r in found.rows)
    absent = f", as there is no {listed(found.tow.absent)} yet" if found.tow.absent else ""
    run_at = "" if found.reynolds is None else f", Re {in_millions(found.reynolds)}"
    where = f"Campaign {found.tow.campaign}{absent}{run_at}." if found.tow.campaign else ""
    every = len(found.rows) > 1 and len(named) == 1
    lacking = {r.why for r in found.rows if r.missing}
    reasons = [
        f"{'All' if every else ', '.join(symbols)}: {'no value, ' * (why in lacking)}{why}."
        for why, symbols in named.items()
        if why
    ]
    assessed = any(r.u_grid for r in found.rows) or all(r.value is None for r in found.rows)
    grid = "" if assessed else "There is no grid study: U95 leaves out the discretisation error."
    without = collected((r.no_grid, primed(r.symbol)) for r in found.rows if assessed and r.no_grid and not r.missing)
    no_grid = [
        f"{', '.join(symbols)}: {why}; U95 leaves out the discretisation error." for why, symbols in without.items()
    ]
    wide = [f"{primed(r.symbol)} {r.value:.2g}" for r in found.rows if not r.is_result]
    few = f"No result: U95 above {SHARE:.0%} of the value ({', '.join(wide)})." if wide else ""
    spread = [f"{primed(r.symbol)} {percent(r.model, r.value)}" for r in found.rows if r.model is not None]
    models = f"Model error, beside U95: another turbulence model moves {', '.join(spread)}." if spread else ""
    notes = tuple(n for n in (where, few, *reasons, *found.turned, grid, *no_grid, models, found.tow.note) if n)
    columns = tuple(f"{name}, printed" for name in found.columns) if len(found.columns) == 1 else found.columns
    headers = ("", "CFD", "U95" if not grid else "U95 without grid", "grid", NAME, *columns)
    return Table(f"Own CFD: {found.tow.name}", headers, tuple(rows), notes, frozenset({0}))


def tow_against(found: Towed) -> Table:
    """Comparison error of a tow against validation uncertainty, ASME V&V 20; no rows without an experiment. 80 columns."""
    rows = []
    for r in found.rows:
        v = r.validation
        if v is None:
            continue
        verdict = f"weak: U_V is {v.share} of D" if r.verdict and v.weak else AGAINST[r.verdict]
        rows.append(
            (
                primed(r.symbol), with_u95(v.computed, r.u95)[0], with_u95(v.measured, v.u_measured)[0],
                *with_u95(v.error, v.u_validation), verdict,
            )
        )  # fmt: skip
    none = collected((r.why_none, primed(r.symbol)) for r in found.rows if r.why_none and not r.is_turned)
    tests = collected((r.validation.experiment, r) for r in found.rows if r.validation is not None)
    printed = {
        test: [as_printed(p) for r in rows for p in [p for p in r.published if p is not None][:1]]
        for test, rows in tests.items()
        if not test.endswith(AS_PRINTED)
    }
    notes = [
        f"D of {', '.join(primed(r.symbol) for r in those)}: {_test(test, printed.get(test, []))}{_stated(found, test)}."
        for test, those in tests.items()
    ]
    notes += [f"No verdict on {', '.join(s)}: {why}." for why, s in none.items()]
    judged = [r.validation for r in found.rows if r.validation is not None]
    known = dict.fromkeys((v.experiment, v.reynolds) for v in judged)
    notes += [f"Re: {in_millions(s)} in the CFD, {in_millions(d)} in {test}." for test, (s, d) in known if s and d]
    notes += sentences_on_open(
        (
            grid_of_some(u, judged, not all(u in each.lacking for each in judged))
            for v in judged
            for u in v.lacking
            if u not in SET_IN_A_COMPUTATION
        ),
        what="From the CFD, U_V leaves out",
    )
    fitted = [primed(v.symbol) for v in judged if v.lacking_measured]
    of = f"U_V of {listed(fitted)}" if 0 < len(fitted) < len(judged) else "U_V"
    notes += sentences_on_open((u for v in judged for u in v.lacking_measured), what=f"From the test, {of} leaves out")
    return table_of("own_cfd.tow_against", rows, notes, name=found.tow.name)


def _stated(found: Towed, test: str) -> str:
    """The relative uncertainty of printed values in U_V, where all of a test have one; empty for our own fits."""
    if not test.endswith(AS_PRINTED):
        return ""
    of = (r.validation for r in found.rows if r.validation is not None and r.validation.experiment == test)
    shares = {f"{100.0 * v.u_measured / abs(v.measured):.2g} %" for v in of if v.u_measured and v.measured}
    return f"; U_V includes the {shares.pop()} that the source states" if len(shares) == 1 else ""


def _test(test: str, printed: Sequence[str]) -> str:
    """Where the measured side of a tow comes from, with the printed values beside our fit."""
    if test.endswith(AS_PRINTED):
        return test
    return f"our fit to the points of {test}" + (f" (published: {', '.join(printed)})" if printed else "")
