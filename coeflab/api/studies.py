"""`run` and `Study`: a plan.toml carried out, and its report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

from coeflab.api.result import Result
from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_all
from coeflab.core.missed import suggesting
from coeflab.study import study as plain
from coeflab.study.run import run as carried_out
from coeflab.study.study import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from coeflab.api.vehicle import Vehicle
    from coeflab.report.acceptance import Acceptance
    from coeflab.report.document import Document
    from coeflab.study.towed import Towed

__all__ = ["Plan", "Study", "report_files", "require_formats", "run"]


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Study(plain.Study):
    """Everything that a plan gives: tables, fits, comparisons, parameter files, checks; see `coeflab.run`.

    Examples
    --------
    >>> import coeflab as cf
    >>> study = cf.run("suboff_roddy_2")
    >>> round(study.result["Nv'"].value, 4)
    -0.0147
    """

    @property
    def result(self) -> Result:
        """The coefficients of all fits; of one that several give, ``of(campaign)`` chooses."""
        return Result(tuple(self.fits), tuple(self.tables))

    @property
    def tows(self) -> tuple[Towed, ...]:
        """Every planned tow, carried out or not: its coefficients beside published columns and tests."""
        from coeflab.study.towed import towed

        return towed(self)

    def vehicle(self, name: str = "") -> Vehicle:
        """A parameter file of the study as a vehicle.

        Parameters
        ----------
        name : str
            Of the file; may be left out where there is one.
        """
        from coeflab.api.vehicle import Vehicle

        files = self.parameter_files
        if name not in files and not (name == "" and len(files) == 1):
            raise InputError(f"no vehicle {shown(name)}", f"one of {', '.join(files)}", column="name")
        return Vehicle(files[name] if name else next(iter(files.values())))

    def report(self, path: str | Path, *, full: bool = False, short: bool = False, review: bool = False) -> Path:
        """Write the report; equal studies give equal bytes.

        Parameters
        ----------
        path : str or Path
            Ends in .html, .pdf or .tex; of a folder that is there report.html in it.
        full, short, review : bool
            With the appendix; one page; with what a reviewer asks for.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            Another ending.
        """
        file = Path(path) / "report.html" if Path(path).is_dir() else Path(path)
        from coeflab.report.formats import REPORTERS

        formats = {s: name for name in REPORTERS.usable() if (s := REPORTERS.load(name).suffix)}
        if file.suffix not in formats:
            raise InputError(shown(file.name), f"a name that ends in {', '.join(formats)}", column="path")
        _, result, _ = report_files(self, [formats[file.suffix]], full=full, short=short, review=review)
        own = next(name for name in result if name.endswith(file.suffix))
        write_all(file.parent, {file.name if name == own else name: content for name, content in result.items()})
        return file

    def figures(self, folder: str | Path, *, full: bool = False, style: str | Path | None = None) -> tuple[Path, ...]:
        """Write every figure of the report as SVG, PDF and PNG, and its numbers as CSV.

        Parameters
        ----------
        folder : str or Path
            To write into; made where it is not there.
        full : bool
            Those of the appendix too.
        style : str or Path, optional
            A style of Matplotlib, or its name.

        Returns
        -------
        tuple of Path
            Of the files, sorted.

        Raises
        ------
        InputError
            No such style.
        """
        _, drawn, _ = report_files(self, ["figures"], full=full, style=style)
        content = {Path(name).name: file for name, file in drawn.items()}
        write_all(Path(folder), content)
        return tuple(Path(folder) / name for name in sorted(content))

    def plot(self, symbol: str | None = None, ax: Axes | None = None) -> Axes:
        """A slope, or without a symbol every coefficient; see `Result.plot`."""
        return self.result.plot(symbol, ax)


def report_files(
    found: plain.Study | Acceptance,
    formats: Sequence[str] = ("html",),
    *,
    full: bool = False,
    short: bool = False,
    review: bool = False,
    sections: Sequence[str] = (),
    style: str | Path | None = None,
) -> tuple[Document, dict[str, bytes], bool]:
    """The files of a report; nothing is written.

    Parameters
    ----------
    found : Study or Acceptance
        From `run`, or from `studied`.
    formats : sequence of str
        html, pdf, latex, workbench, figures.
    full, short, review : bool
        With the appendix; one page; from files to points and every curve.
    sections : sequence of str
        Only these, by anchor or title.
    style : str or Path, optional
        A style of Matplotlib for the figures.

    Returns
    -------
    document, files, failed
        Contents by name; whether something of what it tells fails.

    Raises
    ------
    InputError
        No such format, section or style.
    """
    from coeflab.api.documents import only, report_of, written
    from coeflab.report.figures.files import styled

    with styled(style):
        result = report_of(found, short=short, full=full or (bool(sections) and not review), review=review)
        document = only(result.document, sections)
        files: dict[str, bytes] = {}
        for name in formats:
            files.update(written(document, [name]))
    if short:
        files = {name.replace("report", "summary", 1): content for name, content in files.items()}
    return document, files, result.failed


def require_formats(names: Sequence[str]) -> None:
    """Refuse formats that no renderer has.

    Raises
    ------
    InputError, PluginError
        None is named; no renderer has the name.
    """
    from coeflab.report.formats import REPORTERS

    if not names:
        raise InputError("no format", f"one or more of {', '.join(REPORTERS.names())}", column="--to")
    for name in names:
        REPORTERS.load(name)


def run(plan: Plan | str | Path, progress: Callable[[str], None] = lambda _: None) -> Study:
    """Carry out a plan. Nothing is written.

    Parameters
    ----------
    plan : Plan, str or Path
        The path of a plan.toml or of its folder, a campaign, or the name of a shipped study.
    progress : callable, optional
        Takes what is being done, in words.

    Returns
    -------
    Study

    Raises
    ------
    CoeflabError
        Input that cannot be used.

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.run("suboff_roddy_2").vehicle()["Yv'"].value < 0
    True
    """
    found = carried_out(plan, progress)
    found = replace(found, checks=tuple(c.spoken() for c in found.checks))
    return Study(**{f.name: getattr(found, f.name) for f in fields(plain.Study)})
