"""The workbench page in a notebook cell, by anywidget (the extra "notebook")."""

from __future__ import annotations

from typing import Any

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.report.bench import bench_of
from coeflab.report.formats.workbench import data_json, numbers, source
from coeflab.study.study import Study


def module() -> str:
    """The script of the cell, an ECMAScript module with ``render``."""
    return "\n".join((numbers(), source("page.js"), source("widget.js")))


def widget(study: Study) -> Any:
    """The workbench of a study, for the last line of a notebook cell.

    Parameters
    ----------
    study : Study

    Returns
    -------
    anywidget.AnyWidget

    Raises
    ------
    InputError
        No sweep of the study gives a slope, or anywidget is not installed.
    """
    bench = bench_of(study)
    if bench is None:
        raise InputError(f"{study.plan.name}, without a sweep that gives a slope", "a study with slopes at the origin")
    try:
        import anywidget
        import traitlets
    except ModuleNotFoundError as why:
        raise input_error("report.no_module", name=why.name) from None
    members = {
        "_esm": module(),
        "_css": source("page.css"),
        "content": traitlets.Unicode(data_json(bench)).tag(sync=True),
        "numbers": traitlets.Unicode(numbers()).tag(sync=True),
    }
    return type("Workbench", (anywidget.AnyWidget,), members)()
