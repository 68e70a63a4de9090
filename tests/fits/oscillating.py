"""Oscillating runs made by the shipped synthetic law, in memory."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from coeflab.core.files import shipped
from coeflab.fits.planar_motion import fit
from coeflab.fits.results.fit_result import FitResult
from coeflab.tables.importers import PlannedTable
from coeflab.tables.planar_motion import DISPLACEMENTS, PlanarMotionRun, PlanarMotionTable, TimeSeries
from coeflab.tables.reading import read_tables


@cache
def law() -> ModuleType:
    """The script that makes the shipped campaign."""
    spec = importlib.util.spec_from_file_location("make_pmm_synthetic", shipped("cfd_data") / "make_pmm_synthetic.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@cache
def campaign() -> PlanarMotionTable:
    (table,) = read_tables(PlannedTable(shipped("cfd_data") / "pmm_synthetic", ()))
    assert isinstance(table, PlanarMotionTable)
    return table


def record(columns: dict[str, Any], file: str = "run.csv") -> TimeSeries:
    def those(*names: str) -> dict[str, Any]:
        return {n: columns[n] for n in names if n in columns}

    accelerations = {n[0]: columns[n] for n in columns if n.endswith("dot")}
    return TimeSeries(
        Path(file),
        columns["t"],
        those("y", "z", "phi", "theta", "psi"),
        those(*"uvwpqr"),
        accelerations,
        those(*"XYZKMN"),
    )


def run(motion: str, amplitude: float, frequency: float = 2.0, label: str = "", **how: Any) -> PlanarMotionRun:
    """One run by the law; ``how`` goes to the script's record()."""
    m = law()
    phase = how.pop("phase", 0.7)
    drift = np.radians(how.pop("drift", 0.0))
    one = m.Run(motion, amplitude, frequency, drift, phase)
    return PlanarMotionRun(
        label=label or f"{motion} {amplitude:g} {frequency:g}",
        line=2,
        listed=Path("runs.csv"),
        motion=motion,
        omega=one.omega,
        speed=m.SPEED,
        amplitude=None,
        phase=None,
        drift=drift,
        attack=0.0,
        record=record(m.record(one, **how)),
    )


def declared(given: PlanarMotionRun, amplitude: float) -> PlanarMotionRun:
    """The run without columns of the motion, which the list of runs declares instead."""
    m = law()
    own, _ = m.OWN[given.motion]
    size = amplitude * m.SPEED / (m.LENGTH if own in "pqr" else 1.0) / given.omega
    return replace(given, amplitude=size, phase=0.7, record=record({"t": given.record.time, **given.record.forces}))


def table(*runs: PlanarMotionRun, **changed: Any) -> PlanarMotionTable:
    return replace(campaign(), runs=runs, **changed)


def fitted(*runs: PlanarMotionRun, options: dict[str, Any] | None = None, **changed: Any) -> FitResult:
    made = table(*runs, **changed)
    return fit([made], made.scaling, options or {})


def truth(symbol: str) -> float:
    linear, quadratic, mass = law().LAW[symbol[1]][symbol[0]]
    return float(mass if symbol.endswith("dot") else quadratic if "|" in symbol else linear)


__all__ = ["DISPLACEMENTS", "campaign", "declared", "fitted", "law", "record", "run", "table", "truth"]
