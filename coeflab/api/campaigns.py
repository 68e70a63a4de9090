"""`fit_campaigns`: campaigns as they are, without a plan: fitted one by one or jointly, and checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from coeflab.core.errors import InputError
from coeflab.core.units import positive_typed
from coeflab.core.wording import Verbatim
from coeflab.fits import BY_DEFAULT, FITS, JOINT, USUAL
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.rows.too_few import FEW_ROWS
from coeflab.law.scaling import Scaling, require_hull
from coeflab.study.run import run
from coeflab.study.study import Plan, PlannedJoint, Study
from coeflab.tables.reading import suited_fit, table_at

__all__ = ["FirstFit", "Study", "Sweep", "first_fit", "fit_campaigns", "of_slopes", "suited_fit"]
MAIN = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
Progress = Callable[[str], None]


def typed_scaling(length: str, name: str) -> Scaling | None:
    """The length of the primes as a shell has it; None without one.

    Parameters
    ----------
    length, name : str
        ``--length`` and ``--length-name``.

    Raises
    ------
    InputError
        One without the other, no length, or a bare number that is that of no hull.
    """
    if bool(length) != bool(name):
        raise InputError("--length without its name", "--length and --length-name together")
    if not length:
        return None
    require_hull(length, "--length")
    return Scaling(positive_typed(length, "length", "--length"), name)


def fit_campaigns(
    paths: Sequence[Path],
    by: str,
    options: Mapping[str, Any] | None = None,
    *,
    speed: float | None = None,
    scaling: Scaling | None = None,
    include_uncertain: bool = False,
    progress: Progress = lambda _: None,
) -> Study:
    """The study of campaigns by a fit, jointly where it joins campaigns, else each by itself; `coeflab.fit` gives the coefficients alone.

    Parameters
    ----------
    paths : sequence of Path
        Folders of campaigns, or one CSV of each.
    by : str
        Name of the fit; `suited_fit` says which a campaign is for.
    options : mapping, optional
        Of the fit.
    speed : float, optional
        Only rows of this speed, m/s.
    scaling : Scaling, optional
        Length of the primes; the campaign's own unless given.
    include_uncertain : bool
        Use cells that the source marks as doubtful.
    progress : callable, optional
        Takes what is being done, in words.

    Raises
    ------
    InputError
        As `coeflab.run`.

    Examples
    --------
    >>> import coeflab as cf
    >>> study = fit_campaigns([cf.shipped("cfd_data") / "suboff_roddy_2"], "slope_at_origin")
    >>> round(study.fits[0].coefficients["Yv'"].value, 4)
    -0.0262
    """
    given = dict(options or {})
    alone = len(paths) == 1 or not FITS.load(by).joins_campaigns
    study = run(Plan(
        name=Verbatim("_".join(p.stem for p in paths)[:80]),
        title=Verbatim(", ".join(p.name for p in paths)),
        tables=tuple(table_at(p, (by,), {by: given}, speed) for p in paths) if alone else (),
        joint=() if alone else (PlannedJoint(tuple(table_at(p, speed=speed) for p in paths), by, given),),
        scaling=scaling,
        wanted=MAIN if by == USUAL else (),
        include_uncertain=include_uncertain,
    ), progress)  # fmt: skip
    return replace(study, checks=tuple(c for c in study.checks if c.name != "law at points"))  # none is offered


def of_slopes(study: Study) -> Study:
    """The study without findings of a law, of which a slope alone is no part."""
    from coeflab.vehicle.not_in_law import NOT_IN_LAW

    return study.with_checks(tuple(c for c in study.checks if c.finding is None or c.finding.code != NOT_IN_LAW))


class FirstFit(NamedTuple):
    """The first fit of a new campaign that its rows allow.

    Attributes
    ----------
    study : Study or None
    by : str
        Name of the fit that was tried last.
    suited : bool
        Whether it is the one that the campaign is for.
    planned : bool
        Whether a study of the campaign fits so by itself.
    why : str
        Why the first one is refused; empty where none is.
    further : str
        Name of the fit to look at next, which takes rows that this one leaves out; empty for the suited one.
    """

    study: Study | None
    by: str
    suited: bool
    planned: bool
    why: str
    further: str


def first_fit(folder: Path, progress: Progress = lambda _: None) -> FirstFit:
    """A campaign by the fit that it is for; where another model takes combined rows to more of the main derivatives, by that.

    Parameters
    ----------
    folder : Path
    progress : callable, optional

    Examples
    --------
    >>> import coeflab as cf
    >>> first_fit(cf.shipped("cfd_data") / "suboff_roddy_2").by
    'slope_at_origin'
    """
    suited = suited_fit(folder)
    study, why, by = None, "", suited
    try:
        study = fit_campaigns([folder], suited, progress=progress)
    except InputError as refused:
        why = str(refused)
    combined = study is not None and any(
        f.code == FEW_ROWS and f["by"] == "combined" for fit in study.fits for f in fit.findings
    )
    if suited == USUAL and (study is None or combined):
        try:
            joint = fit_campaigns([folder], JOINT, progress=progress)
        except InputError:
            joint = None
        if study is None or (joint is not None and len(_valued(joint)) > len(_valued(study))):
            study, by = joint, JOINT
    further = "" if study is None else JOINT if combined and by == suited else "" if by == suited else by
    return FirstFit(study, by, by == suited, study is not None and by in BY_DEFAULT, why, further)


def _valued(study: Study) -> set[str]:
    """The main derivatives that have a value."""
    valued = {c.symbol for fit in study.fits for c in fit.coefficients.coefficients if c.value is not None}
    return valued & set(MAIN)
