"""One wrong number or sign at a time in a copy of the inputs or laws, and the validation that ought to notice.

Inputs are frozen nouns, replaced, or copied folders, edited; laws are functions, exchanged for the time of one validation. No
source is written. Figures, fits that the mutation does not touch and searches for trims are left out, so that one takes a
fraction of a second.
"""

from __future__ import annotations
import __future__

import hashlib
import inspect
import math
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory, mkdtemp
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

import coeflab.study.run as carried_out
from coeflab.core.errors import CoeflabError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.glider.flight import Flown
from coeflab.glider.glide import GlideRun
from coeflab.glider.glider import Glider
from coeflab.glider.glider_file import gliders_at, read_glider
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.motion.simulators import SIMULATORS
from coeflab.published.estimates import acceptance as from_shape
from coeflab.published.flyingfish import acceptance as flyingfish
from coeflab.published.flyingfish import motions
from coeflab.published.flyingfish.model import FlyingFish, calibrated, read_flyingfish
from coeflab.published.huuv import acceptance as huuv
from coeflab.published.huuv.five_dof import FiveDof, read_five_dof
from coeflab.published.huuv.five_dof_file import five_dof_file
from coeflab.published.huuv.five_dof_rows import stated_rows
from coeflab.published.huuv.model import Huuv, parameter_file, read_huuv
from coeflab.published.parameter_files import flyingfish_file
from coeflab.published.tank import acceptance as tank
from coeflab.published.thauv import acceptance as thauv
from coeflab.published.thauv import in_space
from coeflab.published.thauv.in_space import FlownSpiral
from coeflab.published.urv import acceptance as urv
from coeflab.published.urv import tasks as urv_tasks
from coeflab.report.acceptance import Compared, ComparedTable
from coeflab.study.checks import data_gate
from coeflab.study.plan import read_plan
from coeflab.study.study import Study
from coeflab.study.validation import printed_indices
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausibility import plausibility

GRAVE = {Severity.WARN: "warns", Severity.FAIL: "fails"}
REFUSED = "refused"


@dataclass(frozen=True)
class Row:
    """One compared quantity: found less what it is compared with, what is allowed, in one unit, and whether it holds."""

    apart: float
    allowed: float
    holds: bool


@dataclass(frozen=True)
class Verdicts:
    """What one validation says: rows by table, case and quantity, and checks by name, each with severity and statistic."""

    rows: dict[str, Row]
    checks: dict[str, tuple[Severity, str]]
    refused: str = ""


@dataclass(frozen=True)
class Outcome:
    """What a mutation does to a validation.

    Attributes
    ----------
    caught : tuple of str
        Rows that held and do not, checks that passed and warn or fail, or the refusal.
    by : str
        ``fails``, ``warns`` or ``refused``, the gravest; empty where nothing is caught.
    share : float
        Largest change of a compared quantity over what is allowed; zero where none depends on what is mutated.
    """

    caught: tuple[str, ...]
    by: str
    share: float


def compare(base: Verdicts, mutated: Verdicts) -> Outcome:
    """What changed from pass to fail, and how far any quantity moved."""
    if mutated.refused:
        return Outcome((mutated.refused,), REFUSED, math.inf)
    fails = [key for key, row in base.rows.items() if row.holds and key in mutated.rows and not mutated.rows[key].holds]
    worse: dict[Severity, list[str]] = {Severity.FAIL: [], Severity.WARN: []}
    for key, (severity, _) in mutated.checks.items():
        before = base.checks.get(key, (Severity.PASS, ""))[0]
        if severity in worse and before not in worse:
            worse[severity].append(key)
    caught = [*fails, *worse[Severity.FAIL]]
    by = "fails" if caught else "warns" if worse[Severity.WARN] else ""
    moved = [
        abs(mutated.rows[k].apart - row.apart) / row.allowed
        if row.allowed
        else float(mutated.rows[k].apart != row.apart)
        for k, row in base.rows.items()
        if k in mutated.rows and not (math.isnan(row.apart) and math.isnan(mutated.rows[k].apart))
    ]
    texts = any(mutated.checks.get(k, (None, ""))[1] != text for k, (_, text) in base.checks.items())
    return Outcome(tuple(caught or worse[Severity.WARN]), by, max([*moved, 0.5 * texts]))


def of_tables(tables: tuple[ComparedTable, ...], checks: tuple[Check, ...] = ()) -> Verdicts:
    """The verdicts of a publication, and of what its parameter file is checked for."""
    rows = {f"{t.title}: {r.case}, {r.quantity}": _row(r) for t in tables for r in t.rows}
    return Verdicts(rows, of_checks(checks))


def _row(r: Compared) -> Row:
    found = math.nan if r.found is None else r.found
    if r.at_most:
        return Row(found, abs(r.against), r.holds)
    return Row(found - r.against, r.tolerance * (abs(r.against) if r.relative and r.against else 1.0), r.holds)


def of_checks(checks: tuple[Check, ...]) -> dict[str, tuple[Severity, str]]:
    """The gravest of each name and subject."""
    out: dict[str, tuple[Severity, str]] = {}
    order = list(Severity)
    for c in sorted(checks, key=lambda c: order.index(c.severity)):
        out.setdefault(f"check {c.name}: {c.subject}", (c.severity, str(c.statistic)))
        if c.severity in GRAVE:
            out[f"check {c.name}: {c.subject}"] = (c.severity, str(c.statistic))
    return out


def refusals(validate: Callable[[], Verdicts]) -> Verdicts:
    """A mutation that no reader lets through is caught as well."""
    try:
        return validate()
    except (CoeflabError, ValueError) as why:
        return Verdicts({}, {}, f"{type(why).__name__}: {str(why).splitlines()[0][:60]}")


# ---- laws exchanged ------------------------------------------------------------------------------------------------


@contextmanager
def exchanged(old: Any, new: Any) -> Iterator[None]:
    """Every name in coeflab, and here, that means a function means another one."""
    places = [
        (module, name)
        for key, module in list(sys.modules.items())
        if key.startswith(("coeflab", __package__))
        for name, value in list(vars(module).items())
        if value is old
    ]
    assert places, old
    try:
        for module, name in places:
            setattr(module, name, new)
        yield
    finally:
        for module, name in places:
            setattr(module, name, old)


@contextmanager
def edited(function: Any, old: str, new: str, times: int = 1) -> Iterator[None]:
    """A function of a module or of a class, compiled again with a piece of its text replaced."""
    source = textwrap.dedent(inspect.getsource(function))
    assert source.count(old) == times, (source.count(old), old)
    scope = dict(function.__globals__)
    code = compile(
        source.replace(old, new), f"<mutated {function.__qualname__}>", "exec", __future__.annotations.compiler_flag
    )
    exec(code, scope)
    made = scope[function.__name__]
    # The mutant sees the module as it is, and later exchanges in it.
    mutant = FunctionType(made.__code__, function.__globals__, made.__name__, made.__defaults__, made.__closure__)
    mutant.__kwdefaults__ = made.__kwdefaults__
    owner = _owner(function)
    if owner is None:
        with exchanged(function, mutant):
            yield
        return
    setattr(owner, function.__name__, mutant)
    try:
        yield
    finally:
        setattr(owner, function.__name__, function)


def _owner(function: Any) -> Any:
    name, _, _ = function.__qualname__.rpartition(".")
    module: ModuleType = sys.modules[function.__module__]
    return getattr(module, name) if name else None


# ---- TJ-FlyingFish -------------------------------------------------------------------------------------------------


@cache
def fish() -> FlyingFish:
    return read_flyingfish()


def validate_flyingfish(fish: FlyingFish, file: ParameterFile | None = None) -> Verdicts:
    """All but searches for trims and the bench."""
    constants = calibrated(fish.rotors, fish.motion, fish.angles, fish.speeds)
    made = flyingfish_file(fish) if file is None else file
    c = motions.craft(fish, 0)
    tables = (
        *flyingfish.implied(fish, constants), *flyingfish.carried(fish, made), flyingfish.air(fish),
        motions.equations(c, "water"), motions.equations(c, "air"), motions.third(fish), motions.surface(c),
    )  # fmt: skip
    return of_tables(tables, plausibility(made))


def validate_fish_trims(fish: FlyingFish, *names: str) -> Verdicts:
    """What trims are searched for, by name: hovering, both_readings, tracks."""
    made = motions.craft(fish, 0 if names == ("hovering",) else None)
    return of_tables(tuple(getattr(motions, name)(made) for name in names))


def validate_fish_bench(fish: FlyingFish) -> Verdicts:
    """Rotor curves identified from the synthetic bench tests."""
    return of_tables((motions.bench(fish),))


# ---- HUUV ----------------------------------------------------------------------------------------------------------


@cache
def steered() -> Huuv:
    return read_huuv()


def validate_huuv(huuv_: Huuv) -> Verdicts:
    """All but motions in time and fits to Fig. 17."""
    file = parameter_file(huuv_)
    return of_tables(huuv.turned(huuv_, file), plausibility(file))


@cache
def in_five() -> FiveDof:
    return read_five_dof(steered())


def validate_five(five: FiveDof) -> Verdicts:
    """Five degrees of freedom, all but motions in time; the rows of the horizontal plane are `validate_huuv`'s."""
    return of_tables(stated_rows(five, five_dof_file(five)))


# ---- THAUV ---------------------------------------------------------------------------------------------------------


@cache
def gliders() -> tuple[Glider, ...]:
    return gliders_at(Path(str(shipped("cfd_data") / "thauv")))


def read_back(glider: Glider) -> Glider:
    """Through its file, whose reader refuses what no glider can be."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "glider.toml"
        path.write_bytes(glider.file())
        return read_glider(path)


def flown(glider: Glider) -> Flown:
    return Flown(GlideRun(glider, SIMULATORS.load("glider").simulate(glider, glider.manoeuvre(1), {})), ())


@cache
def unmutated_flight(case: int) -> Flown:
    return flown(gliders()[case])


def validate_thauv(change: Callable[[Glider], Glider] | None = None, cases: tuple[int, ...] = (0, 1, 2)) -> Verdicts:
    """All of it; ``change`` is made to the gliders of some cases, None flies all of them again."""
    made = {}
    for i, g in enumerate(gliders()):
        again = change is None or i in cases
        made[g.name.rpartition("_")[2]] = (
            flown(g if change is None else read_back(change(g))) if again else unmutated_flight(i)
        )
    return of_tables(thauv.compared(made))


@cache
def unmutated_spiral() -> FlownSpiral:
    return in_space.flown_spiral(gliders()[1])


def validate_thauv_in_space(change: Callable[[Glider], Glider] | None = None) -> Verdicts:
    """What the vertical plane does not hold, of case 02; its spiral flies again where the glider is changed."""
    glider = gliders()[1] if change is None else read_back(change(gliders()[1]))
    flown_again = unmutated_spiral() if change is None else in_space.flown_spiral(glider)
    return of_tables(in_space.compared_in_space(glider, flown_again))


# ---- URV with an arm ------------------------------------------------------------------------------------------------


def validate_urv(controlled: bool = False) -> Verdicts:
    """What needs no motion in time, and on request the runs under control whose errors theory knows."""
    moved = (urv_tasks.control(urv_tasks.at_once()),) if controlled else ()
    return of_tables((*urv.compared(), *moved))


# ---- Tow tank, and estimates from the shape -----------------------------------------------------------------------------


def validate_tank() -> Verdicts:
    """All of it."""
    return of_tables(tank.acceptance().tables)


def validate_estimates() -> Verdicts:
    """All of it."""
    return of_tables(from_shape.acceptance().tables)


# ---- SUBOFF --------------------------------------------------------------------------------------------------------


def _alike(a: Any, b: Any) -> bool:
    """Whether two tables, or what they hold, are equal to the last bit."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, Mapping):
        return a.keys() == b.keys() and all(_alike(a[k], b[k]) for k in a)
    if is_dataclass(a):
        return all(_alike(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    return bool(a == b)


@dataclass(frozen=True)
class Suboff:
    """The study as it is, and the way to run it with something changed.

    Attributes
    ----------
    study : Study
    folder : Path
        For copies.
    gated : dict
        What the gate for data found in tables as they are, by their names and the length.
    """

    study: Study
    folder: Path
    gated: dict[tuple[tuple[str, ...], float], Any] = field(default_factory=dict)

    def verdicts(self, study: Study | None = None) -> Verdicts:
        """Of comparisons with published slopes, of printed indices, and of checks."""
        s = study or self.study
        rows = {
            f"{c.coefficient.symbol}' of {c.coefficient.campaign}, {c.reference}": Row(
                math.nan if c.difference is None else c.difference, c.coefficient.u95 or math.nan, bool(c.passed)
            )
            for c in s.comparisons
            if c.passed is not None
        }
        rows |= {
            f"{i.name} of {i.reference}, printed": Row(i.found - i.printed, i.allowed, i.holds)
            for i in printed_indices(s)
        }
        return Verdicts(rows, of_checks(s.checks))

    def rerun(self, edits: dict[str, list[tuple[str, str]]], anew: bool = False) -> Study:
        """The plan on copies with edited texts: names under cfd_data, what is replaced by what (every time it occurs).

        ``anew``: fits are made again although their tables are as before, as a law is another one.
        """
        place = Path(mkdtemp(dir=self.folder))
        data = Path(str(shipped("cfd_data")))
        for name in (
            "suboff",
            *(f"suboff_roddy_{i}" for i in (1, 2, 3)),
            "suboff_cfd_barehull",
            "suboff_roddy_2_dimensional",
        ):
            shutil.copytree(data / name, place / "cfd_data" / name)
        shutil.copytree(data.parent / "geometry" / "suboff", place / "geometry" / "suboff")
        for name, changes in edits.items():
            path = place / "cfd_data" / name if not name.startswith("geometry") else place / name
            text = path.read_text(encoding="utf-8")
            was = hashlib.sha256(path.read_bytes()).hexdigest()
            for old, new in changes:
                assert old in text, (name, old)
                text = text.replace(old, new)
            path.write_text(text, encoding="utf-8")
            campaign = path.parent / "campaign.toml"
            if path.suffix == ".csv":
                stated = campaign.read_text(encoding="utf-8")
                campaign.write_text(
                    stated.replace(was, hashlib.sha256(path.read_bytes()).hexdigest()), encoding="utf-8"
                )
        hulls = {"suboff_aff8": "suboff_aff8", "suboff_bare_hull": "suboff_bare_hull"}
        plan_path = place / "cfd_data" / "suboff" / "plan.toml"
        text = plan_path.read_text(encoding="utf-8")
        for name in hulls:
            text = text.replace(f'added_mass = "{name}"', f'added_mass = "{data.parent / "geometry" / name}"')
        plan_path.write_text(text, encoding="utf-8")
        plan = replace(read_plan(plan_path), exports=(), manoeuvres=())
        return self._run(plan, anew)

    def _run(self, plan: Any, anew: bool) -> Study:
        """Fits of tables that are as before, what the gate finds in them, and the added mass of the hulls are not made anew."""
        fitted, hulls_of, gate = vars(carried_out)["fitted"], vars(carried_out)["_hulls"], data_gate.findings
        known = {t.name: t for t in self.study.tables}

        def same(table: Any) -> bool:
            old = known.get(table.name)
            return (
                not anew
                and old is not None
                and all(
                    np.array_equal(getattr(table, kind)[k], getattr(old, kind)[k], equal_nan=True)
                    for kind in ("forces", "motion", "usable")
                    for k in getattr(old, kind)
                )
                and (table.scaling.length, table.conditions) == (old.scaling.length, old.conditions)
            )

        def memo(name: str, tables: Any, scaling: Scaling, options: Any, earlier: Any = ()) -> Any:
            for f in self.study.fits:
                if (
                    f.fit == name
                    and f.campaign == tables[0].campaign
                    and all(map(same, tables))
                    and f.coefficients.scaling == scaling
                ):
                    return f, tuple(b for b in self.study.budgets if b.campaign == f.campaign)
            return fitted(name, tables, scaling, options, earlier)

        def through_gate(tables: Any, length: float) -> Any:
            if not all(_alike(t, known.get(t.name)) for t in tables):
                return gate(tables, length)
            key = (tuple(t.name for t in tables), length)
            if key not in self.gated:
                self.gated[key] = gate(tables, length)
            return self.gated[key]

        hulls = self.study.hulls
        with exchanged(fitted, memo), exchanged(hulls_of, lambda *_: hulls), exchanged(gate, through_gate):
            return carried_out.run(plan)


# ---- REMUS ---------------------------------------------------------------------------------------------------------

# Prestero (2001), tables of chapter 4 and appendix: SI, x forward, y starboard, z down.
REMUS = {
    "Xudot": -0.93, "Yvdot": -35.5, "Yrdot": 1.93, "Zwdot": -35.5, "Zqdot": -1.93, "Kpdot": -0.0704, "Mwdot": -1.93,
    "Mqdot": -4.88, "Nvdot": 1.93, "Nrdot": -4.88,
    "Xu|u|": -1.62, "Xwq": -35.5, "Xqq": -1.93, "Xvr": 35.5, "Xrr": -1.93,
    "Yv|v|": -1310.0, "Yr|r|": 0.632, "Yuv": -28.6, "Ywp": 35.5, "Yur": 5.22, "Ypq": 1.93,
    "Zw|w|": -131.0, "Zq|q|": -0.632, "Zuw": -28.6, "Zuq": -5.22, "Zvp": -35.5, "Zrp": 1.93,
    "Kp|p|": -0.13,
    "Mw|w|": 3.18, "Mq|q|": -188.0, "Mrp": 4.86, "Muq": -2.0, "Muw": 24.0, "Mvp": -1.93,
    "Nv|v|": -3.18, "Nr|r|": -94.0, "Nuv": -24.0, "Npq": -4.86, "Nwp": -1.93, "Nur": -2.0,
}  # fmt: skip


def validate_remus(values: dict[str, float]) -> Verdicts:
    """What `coeflab params check` says."""
    scaling, at = Scaling(1.33, "overall length"), Conditions(1030.0, 1.5)
    coefficients = {s: (v / scaling.unit(s, at.density, at.speed), "motion") for s, v in values.items()}
    mass = MassProperties(30.48, 0.0, 3.45, np.array([0.0, 0.0, 0.0196]), np.diag([0.177, 3.45, 3.45]))
    stated = Stated("remus", "remus", scaling, at, coefficients, mass=mass)
    return Verdicts({}, of_checks(plausibility(stated_file(stated, [], ("prestero2001",)))))
