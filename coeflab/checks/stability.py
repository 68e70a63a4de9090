"""Directional stability: G_h and G_v with intervals, from every parameter file that has what they need."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.kernels.stability import index_gradient, stability_index
from coeflab.model.check import Check, Severity
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.study import Study

summary = "stability indices G_h and G_v with U95 and verdict"
citations = ("feldman1979", "roddy1990")

PLANES = {"G_h": ("Yv'", "Nv'", "Yr'", "Nr'", 1.0), "G_v": ("Zw'", "Mw'", "Zq'", "Mq'", -1.0)}


def _index(parameters: ParameterFile, name: str) -> Check | None:
    *symbols, sign = PLANES[name]
    found = [parameters.coefficient(str(s)) for s in symbols]
    if not any(c is not None and c.value is not None for c in found):
        return None
    lacking = [str(s) for s, c in zip(symbols, found, strict=True) if c is None or c.value is None]
    if parameters.mass is None:
        lacking.append("m'")
    if lacking or parameters.mass is None:
        return Check(
            "stability", f"{parameters.name} {name}", Severity.NOTE, "not determined",
            "four derivatives and the mass", f"Missing: {', '.join(lacking)}.",
        )  # fmt: skip
    values = [float(c.value) for c in found if c is not None and c.value is not None]
    mass, moment = float(sign) * parameters.mass.mass_prime, parameters.mass.mass_moment_prime
    index = stability_index(values[0], values[1], values[2], values[3], mass, moment)
    gradient = index_gradient(values[0], values[1], values[2], values[3], mass, moment)
    rows = [parameters.covariance.symbols.index(str(s)) for s in symbols]
    cells = [[parameters.covariance.matrix[i][j] for j in rows] for i in rows]
    covariance = np.array([[np.nan if c is None else c for c in row] for row in cells])
    variance = float(gradient @ covariance @ gradient)
    half = 2.0 * variance**0.5 if variance >= 0.0 else None
    literature = [c.symbol for c in found if c is not None and c.origin == "literature"]
    verdict = "stable" if index > 0.0 else "unstable"
    sure = half is not None and abs(index) > half
    within = f" +- {half:.2g}" if half is not None else ""
    source = f" {', '.join(literature)} from literature (PMM)." if literature else ""
    limit = " High-speed limit without restoring moment." if name == "G_v" else ""
    return Check(
        "stability",
        f"{parameters.name} {name}",
        Severity.NOTE,
        f"{name} = {index:.3f}{within}: {verdict}" + ("" if sure else ", not beyond its uncertainty"),
        "above zero is stable",
        f"Directionally {verdict} with controls fixed.{limit}{source}",
    )


def check(study: Study) -> Sequence[Check]:
    """Indices of every parameter file; an unstable vehicle is a finding, not a failure."""
    return [c for p in study.parameter_files.values() for name in PLANES if (c := _index(p, name)) is not None]
