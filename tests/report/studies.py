"""Studies that are small enough to build by hand."""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.provenance import InputFile, Source
from coeflab.fits.slope_at_origin import fit
from coeflab.fits.uncertainty.budget import budgets_of
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.scaling import Conditions, Scaling
from coeflab.study.study import Plan, Study
from coeflab.tables.force_table import Exclusion, ForceTable
from coeflab.vehicle.published_values import Comparison, Relation

HOSTILE = "<script>alert('x')</script> & \"y\" $a_b$"
ENDLESS = "\u05e9\u05dc\u05d5\u05dd \u202eright to left\u202c " + "x" * 5000
LENGTH = Scaling(2.0, "LOA")
CONDITIONS = Conditions(1000.0, 1.5)


def small_table(angles: list[float], *, named: str = "tow", errors: bool = False) -> ForceTable:
    """Sway force and yaw moment over sideslip, with one doubtful cell where there are points enough."""
    v = np.sin(np.radians(angles))
    n, speed = len(angles), CONDITIONS.speed
    q = 0.5 * CONDITIONS.density * speed**2 * LENGTH.length**2
    ripple = 1e-5 * np.cos(7.0 * np.arange(n))
    forces = {
        "Y": q * (1e-4 - 0.03 * v - 0.2 * v**3 + ripple),
        "N": q * LENGTH.length * (-0.014 * v + 0.1 * v**3 + ripple),
    }
    usable = {c: np.ones(n, dtype=bool) for c in forces}
    exclusions = ()
    if n > 5:
        usable["Y"][1] = False
        exclusions = (Exclusion(1, 3, "Y", HOSTILE, uncertain=True),)
    zero = np.zeros(n)
    return ForceTable(
        name=f"{named}/table.csv",
        campaign=named,
        title=f"Campaign {named}",
        body=f"body of {named}",
        motion={"u": speed * np.sqrt(1.0 - v**2), "v": speed * v, "w": zero, "p": zero, "q": zero, "r": zero},
        controls={},
        speed=np.full(n, speed),
        forces=forces,
        errors={c: np.full(n, 1e-4 * q) for c in forces} if errors else {},
        usable=usable,
        exclusions=exclusions,
        labels=tuple(f"{named} {i}" for i in range(n)),
        reference_point=np.zeros(3),
        datum=Datum("nose"),
        conditions=CONDITIONS,
        scaling=LENGTH,
        source=Source("synthetic", kind="synthetic"),
        files=(InputFile(f"{named}/table.csv", "0" * 64),),
    )


def small_study(angles: list[float], *, named: str = "tow", errors: bool = False, published: bool = False) -> Study:
    """One table, no body, no references; with ``published`` one re-analysis per coefficient."""
    table = small_table(angles, named=named, errors=errors)
    result = fit([table], LENGTH, {})
    missing = (Coefficient("Nr", None, None, Status.NO_TABLE, table.body, campaign=named),)
    comparisons = []
    for c in result.coefficients.coefficients if published else ():
        if c.value is not None:
            near, gap = c.value * 1.01, -0.01 * c.value
            comparisons.append(Comparison(c, named, Relation.RE_ANALYSIS, "LOA", near, gap, combined=None, passed=True))
    return Study(
        plan=Plan(name="small", title=f"Study {named}", tables=(), wanted=("Yv", "Nv", "Nr")),
        tables=(table,),
        fits=(result,),
        missing=missing,
        body=None,
        references=(),
        comparisons=tuple(comparisons),
        parameter_files={},
        inputs=table.files,
        budgets=budgets_of(result, {table.name: table}),
    )


FULL = [-12.0, -10.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]
HALF = [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
FEW = [0.0, 5.0]


def budgets(study):
    """Budgets of a small study, as the workbench makes them before they enter the coefficients."""
    tables = {t.name: t for t in study.tables}
    return tuple(b for fit in study.fits for b in budgets_of(fit, tables))
