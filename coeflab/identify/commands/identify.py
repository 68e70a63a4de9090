"""``coeflab identify``: coefficients from time series of motions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.core.table import Check
    from coeflab.identify.identified import Identified


EXAMPLE = "coeflab identify zigzag.csv turning_circle.csv --params vehicle.parameters.json"


@options.worded
def command(
    *,
    series: list[Path],
    params: Path,
    columns: str = "",
    thruster: str = "",
    terms: str = "",
    weak: bool = True,
    window: str = "",
    asymmetric: bool = False,
    fit_added_mass: bool = False,
    accelerations: str = "measured",
    optimizer: str = "stlsq",
    resamples: int = 200,
    seed: int = 1,
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Identify coefficients from time series of motions.

    They are compared with those of a parameter file. The rigid body is taken from the file; the terms of the force are chosen by sparse regression in the weak form. Says
    which terms the series cannot tell. Exit code 1 when nothing was identified, or with bias alone.

    With --thruster the series are bench tests of it: thrust and torque are fitted over the steady stretches of its command; with
    --out a copy of the parameter file has the new curves.
    """
    if thruster:
        _bench(series, params, thruster, window, out, json)
        return
    from coeflab.api.parameters import read_parameters
    from coeflab.identify import identified_tables
    from coeflab.identify.identify import identify_from

    asked: dict[str, object] = {
        "terms": terms, "form": "weak" if weak else "derivative", "symmetric": "no" if asymmetric else "yes",
        "added_mass": "fit" if fit_added_mass else "known", "optimizer": optimizer, "resamples": resamples, "seed": seed,
        "accelerations": accelerations, "columns": columns,
    }  # fmt: skip
    if window:
        asked["window"] = window
    with show.progress(json) as say:
        say(f"reading {len(series)} time series")
        found = identify_from(series, read_parameters(params), asked)
    written = [] if out is None else _write(found, out)
    if json:
        show.json_object({**as_json(found), "files": [str(p) for p in written]})
    else:
        show.found(found.findings)
        show.table(identified_tables.terms(found))
        show.table(identified_tables.balances(found))
        for path in written:
            show.path(path)
    if found.failed:
        raise typer.Exit(1)


def _bench(series: list[Path], params: Path, thruster: str, window: str, out: Path | None, json: bool) -> None:
    """Curves of a thruster from its bench tests."""
    from json import dumps

    from coeflab.api.parameters import read_parameters
    from coeflab.api.vehicle import Vehicle
    from coeflab.core.files import write_all
    from coeflab.core.units import quantity
    from coeflab.core.wording import file_stem
    from coeflab.identify.identified_figures import bench_figure
    from coeflab.identify.thruster import WINDOW, bench_test, with_curves
    from coeflab.report.as_json.findings import findings
    from coeflab.report.figures.svg_file import sheet

    within = quantity(window, "time", key="--window") if window else WINDOW
    checks: Sequence[Check] = ()
    found = bench_test(series, read_parameters(params), thruster, within)
    content = {
        f"{thruster}.bench.json": (dumps(found.as_json(), indent=2, allow_nan=False) + "\n").encode(),
        f"{thruster}.bench.svg": sheet([(bench_figure(found),)]) if out is not None else b"",
    }
    if out is not None:
        result = with_curves(read_parameters(params), found)
        content[f"{file_stem(result.name)}.parameters.json"] = result.to_json()
        checks = Vehicle(result).checks
    written = [] if out is None else [out / name for name in content]
    if out is not None:
        write_all(out, content)
    if json:
        show.json_object({**found.as_json(), "findings": findings(checks), "files": [str(p) for p in written]})
    else:
        show.table(found.table())
        for path in written:
            show.path(path)
        show.file_findings(params.stem, checks)
    if show.failed(checks):
        raise typer.Exit(1)


def as_json(found: Identified) -> dict[str, Any]:
    """Every candidate with its values, absent ones null, and the works that the method rests on."""
    from coeflab.core.provenance import work
    from coeflab.identify.identify import citations
    from coeflab.report.as_json.findings import finding_as_data

    return {
        "name": found.name,
        "series": list(found.series),
        "method": found.method,
        "half_window": found.half,
        "seed": found.seed,
        "resamples": found.resamples,
        "terms": [
            {
                "symbol": t.symbol, "outcome": t.outcome.value, "why": t.why or None, "value": t.value, "low": t.low,
                "high": t.high, "inclusion_frequency": t.frequency, "file_value": t.file_value, "file_u95": t.file_u95,
                "file_source": t.file_source or None, "verdict": t.verdict.value or None,
            }
            for t in found.terms
        ],
        "balances": [
            {
                "component": b.component,  "stretches": b.stretches, "threshold": b.threshold,
                "unexplained": b.left,
            }
            for b in found.balances
        ],
        "statements": list(found.statements),
        "findings": [finding_as_data(f) for f in found.findings],
        "citations": [work(key) for key in citations],
    }  # fmt: skip


def _write(found: Identified, folder: Path) -> list[Path]:
    """CSV, JSON and SVG; none where one cannot be made."""
    import json

    from coeflab.core.files import write_all
    from coeflab.identify.identified_figures import identified_figure
    from coeflab.identify.identified_tables import terms_csv
    from coeflab.report.figures.svg_file import sheet

    content = {
        f"{found.name}.identified.csv": terms_csv(found),
        f"{found.name}.identified.json": (json.dumps(as_json(found), indent=2, allow_nan=False) + "\n").encode(),
        f"{found.name}.identified.svg": sheet([(identified_figure(found, "identified"),)]),
    }
    write_all(folder, content)
    return [folder / name for name in content]
