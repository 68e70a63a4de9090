"""`next_tests`: which test takes most off the uncertainty of a figure, and at which settings to run it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.api.estimating import estimate
from coeflab.api.fitting import fit
from coeflab.api.parameters import parameters_of
from coeflab.api.questions import above_zero, share_of
from coeflab.api.result import Result
from coeflab.bodies import body as plain
from coeflab.bodies.simplify.source import names_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped, typed
from coeflab.core.finding import Finding, Severity
from coeflab.core.machine import one_thread
from coeflab.core.missed import suggesting, was_method
from coeflab.core.texts import input_error
from coeflab.core.types import in_angles
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import COMPONENTS, primed
from coeflab.motion.uncertainty.tests import Kind
from coeflab.motion.uncertainty.uncertainty import Question
from coeflab.study import next_tests as plain_tests
from coeflab.study import study as plain_study
from coeflab.study.next_tests import MEMBERS, ProposedTest, Ranges, Reached, Wanted
from coeflab.study.plan import names_plan, plan_at, read_plan
from coeflab.study.run import run as carried_out
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Kind", "NextTests", "ProposedTest", "Reached", "next_tests"]
MATRIX, ANGLES = {"v": "drift", "w": "attack", "r": "yaw", "q": "pitch"}, ("drift", "attack")
SHORT = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")  # without `wanted`: the one of these whose U95 is largest beside its value


@suggesting
@dataclass(frozen=True, slots=True, repr=False, eq=False)
class NextTests(plain_tests.NextTests):
    """Tests by what they take off; ``tests`` has a `ProposedTest` each, ``best`` U95 after all of them.

    Examples
    --------
    >>> import coeflab as cf
    >>> found = cf.next_tests("suboff_bare_hull", "Yr'")
    >>> str(found.tests[0].kind), found.tests[0].symbols, found.tests[0].wanted_then < found.u95
    ('rotating arm, yaw', ("Yr'",), True)
    """

    def __repr__(self) -> str:
        then = ", ".join(f"{t.kind} {t.wanted_then:.2g}" for t in self.tests if t.variable)
        return in_angles(
            self, f"{self.wanted} {self.value:.4g} +- {self.u95:.2g}; U95 then: {then or 'no test of one variable'}"
        )

    def frame(self) -> pd.DataFrame:
        """A row a run: test, setting (rad, or r'), its unit.

        Examples
        --------
        >>> import coeflab as cf
        >>> len(cf.next_tests("suboff_bare_hull", "Yr'", runs=5).frame())
        5
        """
        import pandas as pd

        rows = [
            {
                "test": str(t.kind), "variable": t.variable, "setting": float(x),
                "unit": "1" if t.variable in ("r", "q") else "rad",
            }
            for t in self.tests
            for x in t.angles
        ]  # fmt: skip
        return pd.DataFrame(rows, columns=["test", "variable", "setting", "unit"])

    @property
    def matrix(self) -> str:
        """Drifts, attacks and rates of the runs as the [matrix] of a tank.toml, for `coeflab tow BODY --matrix`; each once.

        Examples
        --------
        >>> import coeflab as cf
        >>> "yaw = [" in cf.next_tests("suboff_bare_hull", "Yr'", runs=5).matrix
        True
        """
        settings = {t.variable: t.angles for t in self.tests if t.variable in MATRIX}
        lines = []
        for variable, key in MATRIX.items():
            values = [
                f'"{np.degrees(x):.4g} deg"' if key in ANGLES else f"{x:.4g}" for x in settings.get(variable, ()) if x
            ]
            lines.append(f"{key} = [{', '.join(dict.fromkeys(values))}]")
        return was_method("matrix", "\n".join(["[matrix]", *lines, ""]))


@one_thread()
def next_tests(
    source: Any,
    wanted: str = "",
    *,
    tables: Any = None,
    runs: int = 7,
    target: float | str | None = None,
    noise: float | str | None = None,
    angle: float | str = "12 deg",
    control: float | str = "15 deg",
    rate: float = 0.4,
    manoeuvre: str = "turning_circle",
    **options: Any,
) -> NextTests:
    """Which test takes most off U95 of a coefficient or figure, and the settings of its best runs.

    Tests are ranked by the share of the variance that goes with them. Their settings are searched by the estimator itself on
    simulated readings: curves and scatter of the rows that were run, else of the parameter file or the estimates with a noise
    that is assumed.

    Parameters
    ----------
    source : str, Path, Vehicle, Result, Study, table or Body
        A plan of one vehicle, a parameter file, fitted tables, or a body without any data, whose estimates have U95.
    wanted : str
        ``"Yv'"``, ``"G_h"``, or a figure of the manoeuvre, ``"Tactical diameter"``; by default the one of Yv', Nv', Zw', Mw',
        Yr', Nr' whose U95 is the largest share of its value.
    tables : as of `fit`
        Rows behind the coefficients of a parameter file.
    runs : int
        Of each test; 3 to 24 where nothing was run.
    target : float or str, optional
        U95 that is wanted: a share of the value, ``"10%"``.
    noise : float or str, optional
        Standard deviation of a reading over the largest reading, where nothing was run; unless given that of the rows of the
        same component, else 1 %.
    angle, control : float or str
        Largest drift or attack, and largest control angle, of a test that was not run.
    rate : float
        Largest r', q'.
    manoeuvre : str
        Whose figure is wanted.
    options
        Of the manoeuvre: ``rudder="20 deg"``.

    Returns
    -------
    NextTests

    Raises
    ------
    InputError
        A figure without an interval, nothing with U95, a range that is none, a plan of several vehicles.
    """
    ranges = Ranges(
        above_zero(angle, "angle", "angle"), above_zero(control, "angle", "control"), above_zero(rate, "none", "rate")
    )
    kind, name = _meant(source), ""
    held: list[Coefficient]
    parameters: ParameterFile | None = None
    fitted: list[Result] = []
    if kind is plain_study.Study:
        study = _of_one_vehicle(source)
        parameters, name = next(iter(study.parameter_files.values())), study.plan.name
        held = list(parameters.coefficients)
        fitted = [Result(tuple(study.fits), tuple(study.tables))] if study.tables else []
    elif kind is ParameterFile:
        parameters = parameters_of(source)
        held, name = list(parameters.coefficients), parameters.name
    elif kind is Result:
        fitted = [source if isinstance(source, Result) else fit(source)]
        held = []
    else:
        estimates = estimate(source).fits
        held, name = [c for f in estimates for c in f.coefficients.coefficients], estimates[0].body
    if tables is not None:
        fitted += [tables if isinstance(tables, Result) else fit(tables)]
    sweeps = [s for r in fitted for f in r.fits for s in f.sweeps]
    joint = [r for r in fitted if r.tables and not any(f.sweeps for f in r.fits)]
    others = [s for r in joint for f in fit(list(r.tables)).fits for s in f.sweeps]
    measured = [c for r in fitted for f in r.fits for c in f.coefficients.coefficients]
    valued = [c for c in measured if c.value is not None]
    known = {c.symbol.removesuffix("'"): c for c in (*measured, *held, *reversed(valued))}
    figure = _wanted(wanted, known, parameters, manoeuvre, options)
    goal = None if target is None else share_of(target, "target") * abs(figure.value)
    computed = any(t.source.kind == "cfd" for r in fitted for t in r.tables)
    found = plain_tests.next_tests(
        figure,
        list(known.values()),
        sweeps,
        ranges,
        runs,
        None if noise is None else share_of(noise, "noise"),
        target=goal,
        computed=computed,
        others=others,
        given=_given(kind, name, [c for r in fitted for f in r.fits for c in f.campaigns]),
    )
    return NextTests(**{f.name: getattr(found, f.name) for f in fields(plain_tests.NextTests)})


def _of_one_vehicle(source: Any) -> plain_study.Study:
    """The study of a plan with one parameter file; which of several a person means, nobody knows."""
    if isinstance(source, plain_study.Study):
        study, files = source, dict.fromkeys(source.parameter_files)
        campaigns = [c for f in source.fits for c in f.campaigns]
    else:
        plan = read_plan(plan_at(source))
        files, campaigns = (
            dict.fromkeys(f.name for f in plan.parameter_files),
            [c for f in plan.parameter_files for c in f.campaigns],
        )
        if len(files) < 2:
            return _of_one_vehicle(carried_out(plan))
    if len(files) == 1:
        return study
    raise input_error(
        "front_door.plan_vehicles", column="source", count_of_files=len(files), files=", ".join(files),
        fromkeys=", ".join(dict.fromkeys(campaigns)),
    )  # fmt: skip


def _given(kind: type, name: str, campaigns: Sequence[str]) -> Finding:
    """What the question was asked of, as it was understood."""
    known = {plain_study.Study: "plan", Result: "rows", ParameterFile: "both" if campaigns else "file"}
    what = "body" if kind is plain_study.Study and not campaigns else known.get(kind, "body")
    return Finding.of("design.given", name, Severity.NOTE, kind=what, campaigns=list(dict.fromkeys(campaigns)))


def _meant(source: Any) -> type:
    """Study of a plan, Result of tables, ParameterFile or Body, by what it is or what a path leads to."""
    if isinstance(source, plain_study.Study):
        return plain_study.Study
    if isinstance(source, Result | ForceTable):
        return Result
    if isinstance(source, plain.Body):
        return plain.Body
    if isinstance(source, ParameterFile) or hasattr(source, "file"):
        return ParameterFile
    if not isinstance(source, str | Path):
        return Result
    path = typed(source)
    if len(path.parts) == 1 and list((shipped("cfd_data") / path).glob("*.parameters.json")):
        return ParameterFile
    if path.suffix.lower() == ".json":
        return ParameterFile
    if names_plan(path):
        return plain_study.Study
    return plain.Body if names_body(str(source)) else Result


def _wanted(
    name: str, known: dict[str, Coefficient], parameters: ParameterFile | None, manoeuvre: str, options: dict[str, Any]
) -> Wanted:
    if not name:
        sized = [c for s in SHORT if (c := known.get(s)) is not None and c.value and c.u95]
        if not sized:
            raise InputError(f"none of {', '.join(map(primed, SHORT))} with U95", "one, or a figure", column="--for")
        return plain_tests.of_symbol(max(sized, key=lambda c: float(c.u95 or 0.0) / abs(float(c.value or 1.0))))
    if (c := known.get(name.removesuffix("'"))) is not None:
        return plain_tests.of_symbol(c)
    name = next((index for index in INDICES if index.casefold() == name.casefold()), name)
    if name in INDICES or name[:1] not in COMPONENTS or not name.endswith("'"):
        if parameters is None:
            raise input_error("front_door.what_has_mass", column="--for", name=name)
        if name in INDICES:
            return plain_tests.of_index(parameters, name)
        return plain_tests.of_manoeuvre(parameters, name, Question(manoeuvre, options, members=MEMBERS))
    raise InputError(f"{name}, of which nothing is known", f"one of {', '.join(map(primed, known))}", column="--for")
