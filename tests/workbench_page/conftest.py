"""A boat with drift, rotating-arm and rudder sweeps, its study and its workbench page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.fits import FITS
from coeflab.fits.uncertainty.budget import budgets_of, with_budget
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.report.bench import bench_of
from coeflab.report.document import Document
from coeflab.report.formats import REPORTERS
from coeflab.study.study import Plan, Study
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface
from tests.report.studies import small_table

SCALING, AT = Scaling(2.0, "LOA"), Conditions(1000.0, 1.5)
PRESSURE, LENGTH = 0.5 * AT.density * AT.speed**2, SCALING.length
DECLARED = InputUncertainty(angle=0.004, rate=0.01, speed=0.005, force=0.01, reference_point=0.01)


def _table(name: str, variable: str, settings: list[float]):
    """One sweep of a made-up boat: v' in degrees, r' as it is, rudder in degrees; noise of a seed."""
    x = np.array(settings)
    n, rng = len(x), np.random.default_rng(len(x))
    zero, first = np.zeros(n), small_table(settings)
    v = np.sin(np.radians(x)) if variable == "v" else zero
    r = x if variable == "r" else zero
    dr = np.radians(x) if variable == "dr" else zero
    y = (
        2e-4
        - 0.04 * v
        - 0.08 * v * np.abs(v)
        + 0.004 * r
        + 0.003 * r * np.abs(r)
        + 0.012 * dr
        + 3e-5 * rng.standard_normal(n)
    )
    m = -0.006 * v + 0.02 * v**3 - 0.009 * r - 0.006 * r * np.abs(r) - 0.006 * dr + 1e-5 * rng.standard_normal(n)
    forces = {"Y": PRESSURE * LENGTH**2 * y, "N": PRESSURE * LENGTH**3 * m}
    if variable == "v":
        forces["X"] = PRESSURE * LENGTH**2 * (-0.004 - 0.01 * v**2 + 1e-6 * rng.standard_normal(n))
    return replace(
        first, name=f"boat/{name}", campaign="boat", body="boat", forces=forces, errors={}, exclusions=(),
        motion=first.motion | {"u": AT.speed * np.sqrt(1.0 - v**2), "v": AT.speed * v, "r": r * AT.speed / LENGTH},
        controls={"dr": dr} if variable == "dr" else {}, usable={c: np.ones(n, dtype=bool) for c in forces},
        labels=tuple(f"{variable} {i}" for i in range(n)), uncertainty=DECLARED,
    )  # fmt: skip


TABLES = (
    _table("drift", "v", [-14, -12, -10, -8, -6, -4, -2, 0, 2, 4, 6, 8, 10, 12]),
    _table("arm", "r", [-0.6, -0.45, -0.3, -0.15, 0.0, 0.15, 0.3, 0.45, 0.6]),
    _table("rudder", "dr", [-20, -15, -10, -5, 0, 5, 10, 15, 20]),
)


def fitted(tables):
    """The slopes with their budgets, as the workbench makes them."""
    fit = FITS.load("slope_at_origin").fit(tables, SCALING, {})
    found = budgets_of(fit, {t.name: t for t in tables})
    return with_budget(fit, found), found


def parameter_file(fits, tables, mass: float = 60.0):
    file = assemble(
        PlannedParameterFile("boat", "boat", ("boat",), ()), "boats", fits, tables, (), (), None, AT, tables[0].files
    )
    body = MassProperties(mass, 0.0, None, np.zeros(3), np.diag([0.9, 14.0, 14.0]))
    return file.model_copy(
        update={
            "mass": body.primed(SCALING, AT.density),
            "hydrostatics": ParameterHydrostatics(
                volume=mass / 1000.0, centre_of_buoyancy=(0.0, 0.0, 0.0), gravity=9.81
            ),
            "surfaces": (ParameterSurface(control="dr", limit=0.6, rate=0.3),),
            "schema_version": "1.3",
        }
    )


@pytest.fixture(scope="session")
def boat():
    fit, found = fitted(TABLES)
    tied = FITS.load("tied_law").complete(fit, TABLES, SCALING, {})
    file = parameter_file([fit, tied], TABLES)
    return Study(
        plan=Plan(name="boats", title="A boat <b>", tables=(), wanted=("Yv", "Nv")), tables=TABLES, fits=(fit, tied),
        missing=(), body=None, references=(), comparisons=(), parameter_files={"boat": file}, inputs=TABLES[0].files,
        budgets=found,
    )  # fmt: skip


@pytest.fixture(scope="session")
def bench(boat):
    return bench_of(boat)


@pytest.fixture(scope="session")
def address(bench, tmp_path_factory):
    """Of the page, written once."""
    made = Document("A boat <b>", "", (), "boats", "0123456789abcdef", bench=bench)
    path = tmp_path_factory.mktemp("bench") / "workbench.html"
    path.write_bytes(REPORTERS.load("workbench").render(made)["workbench.html"])
    return path.as_uri()


@pytest.fixture(scope="session")
def page(browser, address):
    """For tests that compute on it and leave it as it is."""
    opened = browser.new_page()
    opened.goto(address)
    settled(opened)
    yield opened
    opened.close()


def settled(opened) -> None:
    """Wait until the page has computed what was last asked for."""
    opened.wait_for_selector("#bench[data-state=ready]")
