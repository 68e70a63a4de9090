"""``coeflab fit``: a table, a campaign or several campaigns jointly, printed, nothing written."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show
from coeflab.core.errors import InputError, shown

if TYPE_CHECKING:
    from coeflab.api.campaigns import Study, Sweep
    from coeflab.core.table import Table
    from coeflab.report.document import Figure


SUITS = 0.05  # probability of a lack of fit as large by chance, below which a form does not suit its window
DEFAULT = "slope_at_origin"
EXAMPLE = "coeflab fit suboff_roddy_2 --symbol Yv"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


@options.worded
def command(
    *,
    ctx: typer.Context,
    table: list[str],
    fit: str = "",
    constraint: list[str],
    symbol: list[str],
    length: str = "",
    length_name: str = "",
    speed: str = "",
    next_runs: str | None = None,
    diagnostics: bool = False,
    figure: Path | None = None,
    help_options: bool = False,
    include_uncertain: bool = False,
    strict: bool = False,
    json: bool = False,
) -> None:
    """Fit the coefficients of one table or several.

    Several become one parameter file by a plan: coeflab new, coeflab run.

    Any further --option VALUE goes to the fit: --seed 2, --degree 4, --terms "Yv Yv|v|". See --fit NAME --help-options.
    Exit code 1 when a check fails; with --strict when one warns, too.
    """
    from coeflab.core.files import located
    from coeflab.core.units import positive_typed

    if help_options:
        from coeflab.cli.formats import explain

        explain("fits", fit or DEFAULT)
        return
    from coeflab.api.campaigns import fit_campaigns, of_slopes, suited_fit, typed_scaling

    if next_runs is not None:  # goes in 0.4
        raise InputError(f"fit --next {shown(next_runs)}", "coeflab next TABLE", column="--next")
    names, of_fit = given([*table, *ctx.args], constraint)
    if not names:
        raise InputError("no table", "a campaign folder, one CSV of it, or a shipped campaign's name", column="TABLE")
    if figure is not None and figure.suffix not in (".svg", ".pdf", ".png"):
        raise InputError(shown(figure.name), "a file name that ends in .svg, .pdf or .png", column="--figure")
    paths = [located(name, "cfd_data") for name in names]
    fit = fit or suited_fit(paths[0])
    at = positive_typed(speed, "speed", "--speed") if speed else None
    scaling = typed_scaling(length, length_name)
    with show.progress(json) as say:
        study = fit_campaigns(
            paths, fit, of_fit, speed=at, scaling=scaling, include_uncertain=include_uncertain, progress=say
        )
    wanted = [s.removesuffix("'") for s in symbol]
    _refuse_strange(study, wanted)
    if wanted:
        study = of_slopes(study)
    if figure is not None:
        _draw(study, wanted, figure)
    if json:
        from coeflab.report.as_json import studies as as_json

        show.json_object(_only(as_json.study(study, []), wanted))
    else:
        _print(study, wanted)
        if diagnostics:
            _diagnose(study)
        if figure is not None:
            show.path(figure)
    show.exit_code(study.failed, study.warned, strict)


def given(words: list[str], equations: list[str]) -> tuple[list[str], dict[str, int | float | str]]:
    """Tables, which come first, and the options of the fit; equations join those of ``--constraints``."""
    names = list(takewhile(lambda word: not word.startswith("--"), words))
    options = further(words[len(names) :])
    if equations:
        options["constraints"] = ", ".join([*filter(None, [str(options.get("constraints", ""))]), *equations])
    return names, options


def further(arguments: list[str]) -> dict[str, int | float | str]:
    """Options for a plugin from ``--name value`` or ``--name=value``; numbers where they read as such.

    Raises
    ------
    InputError
        No name, no value, or an option twice.
    """
    out: dict[str, int | float | str] = {}
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        name, equals, value = word.partition("=")
        if not name.startswith("--") or (not equals and not rest):
            raise InputError(shown(word), "--option VALUE")
        text, key = value if equals else rest.pop(0), name[2:].replace("-", "_")
        if key in out:
            raise InputError(f"{name} given twice", "it once, for only the last would count", column=name)
        for kind in (int, float):
            try:
                out[key] = kind(text)
                break
            except ValueError:
                continue
        else:
            out[key] = text
    return out


def _only(content: dict[str, Any], symbols: list[str]) -> dict[str, Any]:
    """The object of a study with nothing but the wanted coefficients, where any are."""
    from coeflab.api.names import primed

    named = set(map(primed, symbols))
    parts = ("coefficients", "comparisons") if named else ()
    return content | {part: [c for c in content[part] if c["symbol"] in named] for part in parts}


def _refuse_strange(study: Study, symbols: list[str]) -> None:

    known = [s.symbol for f in study.fits for s in f.sweeps]
    for symbol in symbols:
        if symbol not in known:
            near = next((k for k in known if k.casefold() == symbol.casefold()), None)
            raise InputError(
                f"no sweep for {shown(symbol)}",
                f"one of {', '.join(dict.fromkeys(known))}" if known else "no --symbol: this fit has no sweeps",
                advice=f"Did you mean {near}?" if near else "",
            )


def _draw(study: Study, symbols: list[str], file: Path) -> None:
    """All figures of the fits in one file; of sweeps those of the wanted symbols, where any are."""
    from coeflab.core.files import write_atomically
    from coeflab.report.figures.estimator import estimator_figure
    from coeflab.report.figures.files import as_kind
    from coeflab.report.figures.model import distinct, model_figures
    from coeflab.report.figures.svg_file import sheet
    from coeflab.report.figures.sweep import sweep_figure
    from coeflab.report.sections.oscillations import oscillation_figures

    rows: list[tuple[Figure, ...]] = []
    for fit in study.fits:
        rows += [oscillation_figures(o, f"o{i}") for i, o in enumerate(fit.oscillations)]
        for i, s in enumerate(s for s in fit.sweeps if not symbols or s.symbol in symbols):
            rows.append((sweep_figure(s, f"s{i}"), estimator_figure(s, (), f"e{i}")))
        for i, m in enumerate(distinct(fit.models)):
            rows.append(model_figures(m, f"m{i}"))
    rows = [row for row in rows if row]
    if not rows:
        raise InputError("nothing to draw", "a fit with a curve or a surface", column="--figure")
    write_atomically(file, as_kind(sheet(rows), file.suffix[1:]))


def _diagnose(study: Study) -> None:
    from coeflab.report.figures.model import distinct
    from coeflab.report.tables import models as model_tables
    from coeflab.report.tables import oscillations as oscillation_tables

    models = distinct([m for f in study.fits for m in f.models])
    for content in (t for f in study.fits for t in oscillation_tables.runs(f)):
        show.table(content)
    if not models and not any(f.oscillations for f in study.fits):
        show.text("No fitted model to diagnose; --symbol shows the windows and estimators of a slope.")
        return
    show.table(model_tables.diagnostics(models))
    for model in models:
        show.table(model_tables.influence(model))
        show.table(model_tables.correlations(model))


def _print(study: Study, symbols: list[str]) -> None:
    from coeflab.report.tables import budgets as budget_tables
    from coeflab.report.tables import force_tables
    from coeflab.report.tables import models as model_tables
    from coeflab.report.tables import nouns as noun_tables
    from coeflab.report.tables import oscillations as oscillation_tables
    from coeflab.report.tables import results as tables

    found = tables.headline(study, symbols) or " ".join(oscillation_tables.headline(f) for f in study.fits)
    found = found or " ".join(tables.resistances(study))
    show.sentence(" ".join(filter(None, (found, tables.primed_about(study)))))
    for line in (*tables.undetermined_by_move(study), *tables.answers(study)):
        show.sentence(line)
    if symbols:
        _of_symbols(study, symbols)
    else:
        show.sentence(force_tables.unused(study.tables))
        show.text()
        show.table(tables.coefficients(study) if show.whole() else tables.coefficients_in(study, show.width()))
        models = tuple(m for f in study.fits for m in f.models)
        for model in models:
            show.table(noun_tables.terms(model))
            show.table(budget_tables.model_parts(model))
        for f in study.fits:
            show.table(oscillation_tables.explained(f, study.fits))
            show.table(oscillation_tables.over_frequency(f))
        for each in model_tables.qualities(models):
            show.table(each)
        show.table(model_tables.campaigns(study.fits))
    show.findings(study.checks)


def _of_symbols(study: Study, symbols: list[str]) -> None:
    """One coefficient after the other: what its interval is made of, by largest setting, by other forms."""
    from coeflab.core.table import percent
    from coeflab.report.tables import nouns as noun_tables
    from coeflab.report.tables import sweeps as sweep_tables

    known = {s.symbol: (f, s) for f in study.fits for s in f.sweeps}
    for symbol in symbols:
        fit, sweep = known[symbol]
        c = fit.coefficients[symbol]
        if c.value is not None:
            parts = {"random": c.parts.random, "form": c.parts.model_form, "input": c.parts.input}
            result = ", ".join(f"{name} {percent(part, c.value)}" for name, part in parts.items() if part)
            points = f"{c.n_points} points of {c.campaign}, {noun_tables.window_text(c)}"
            show.sentence(f"{points}; U95: {result}." if result else f"{points}.")
        show.text()
        for content in (sweep_tables.sensitivity(sweep), sweep_tables.left_out(sweep), _forms(sweep)):
            show.table(content)


def _forms(sweep: Sweep) -> Table:
    """Other forms, each in the widest window where its points do not contradict it; every window with ``--wide``."""
    from coeflab.report.tables import sweeps as sweep_tables

    every = sweep_tables.estimators(sweep)
    if show.whole():
        return every
    tested = any(math.isfinite(e.lack_of_fit) for e in sweep.forms)
    widest = {e.family.name: i for i, e in enumerate(sweep.forms)}
    best = {e.family.name: i for i, e in enumerate(sweep.forms) if e.lack_of_fit >= SUITS}
    without = [name for name in widest if best and name not in best]
    if best:
        notes = [f"Widest window with p of the lack of fit >= {SUITS:g}; HC2, HC3: robust errors."]
    elif tested:
        notes = [
            f"No form has p of the lack of fit >= {SUITS:g} in any window; shown: all rows. HC2, HC3: robust errors."
        ]
    else:
        notes = [
            "Not tested (p): no setting is repeated, no error of a point is stated; shown: all rows. HC2, HC3: robust errors."
        ]
    best = best or widest
    notes += [f"In no window: {', '.join(without)}."] if without else []
    rows = tuple(every.rows[i] for i in sorted(best.values()))
    headers = tuple("p" if h == "lack of fit" else h for h in every.headers)
    return replace(
        every,
        title=f"{every.title}, none recommended",
        headers=headers,
        rows=rows,
        notes=tuple(notes),
        spare=("AICc", "95 % HC3", "dof"),
    )
