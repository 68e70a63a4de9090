"""Numbers in the prose of the documentation: those that the program has today."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.table import number, percent, plus_minus
from coeflab.law.symbols import derivative
from coeflab.study.study import Study
from coeflab.vehicle.force_law import full_force
from coeflab.vehicle.law_at_points import law_at_points
from coeflab.vehicle.parameter_file import ParameterFile

DOCS = Path(__file__).parents[1] / "docs"
BODIES = {
    "appended": "suboff_fully_appended",
    "bare hull": "suboff_bare_hull",
    "bare hull, computed": "suboff_bare_hull_cfd",
}
PAIR = r"-?\d[\d.]* \+- \d[\d.]*"

pytestmark = pytest.mark.slow


def page(name: str) -> str:
    return " ".join((DOCS / name).read_text(encoding="utf-8").split())


def rows(name: str, pattern: str) -> list[str] | list[tuple[str, ...]]:
    return re.findall(pattern, (DOCS / name).read_text(encoding="utf-8"), re.MULTILINE)


def slopes_alone(p: ParameterFile) -> ParameterFile:
    kept = tuple(c for c in p.coefficients if len(derivative(c.symbol).factors) < 2)
    return p.model_copy(update={"coefficients": kept, "law_holds": ()})


def test_of_two_largest_angles(suboff: Study) -> None:
    (sweep,) = (s for f in suboff.fits if f.campaign == "suboff_roddy_3" for s in f.sweeps if s.symbol == "Yv")
    (shorter,) = (s for s in sweep.sensitivity if abs(np.degrees(np.arcsin(s.cap)) - 10.0) < 0.2)
    ends = f"{plus_minus(shorter.value, shorter.u95)} to 10 deg and {plus_minus(sweep.value, sweep.u95)} to 18 deg"
    assert f"Yv' of the bare hull is {ends}" in page("slope_at_origin.md")


def test_of_total_potential_and_viscous_parts(suboff: Study) -> None:
    line = rf"^\| ([a-z ]+) \| parameter file \| ({PAIR}) \| (-[\d.]+) \| (\+[\d.]+) \| .*?Yvdot' (-[\d.]+), Xudot' (-[\d.]+) \|$"
    printed = rows("theory.md", line)
    assert [body for body, *_ in printed] == ["appended", "bare hull"]
    for body, total, potential, viscous, yvdot, xudot in printed:
        p = suboff.parameter_files[BODIES[body]]
        c = next(c for c in p.coefficients if c.symbol == "Nv'")
        assert total == plus_minus(c.value, c.u95)
        assert (potential, viscous) == (f"{c.potential:.4f}", f"{c.value - c.potential:+.4f}")
        mass = 0.5 * p.conditions.density * p.scaling.length**3
        matrix = p.added_mass.matrix
        assert (yvdot, xudot) == (f"{-matrix[1][1] / mass:.4f}", f"{-matrix[0][0] / mass:.4f}")


def test_of_the_widest_interval_of_a_slope(suboff: Study) -> None:
    c = next(c for c in suboff.coefficients if (c.campaign, c.symbol) == ("suboff_roddy_3", "Yv"))
    share = percent(c.u95, c.value).partition(".")[0]
    assert f"up to {share} % of the slope (Yv' of the bare hull)" in page("validation.md")


def test_of_slopes_alone_at_the_points(suboff: Study) -> None:
    """Worst miss of the file's slopes, in % of the largest force; all points without control angle. X has a set-up of its own."""
    line = r"^\| ([a-z ,]+) \| ([YZKMN]) over ([vwr]) \| ([\d.]+) \|"
    printed = {(body, c, v): worst for body, c, v, worst in rows("law_and_points.md", line)}
    assert len(printed) == 11
    for (body, component, variable), worst in printed.items():
        p = slopes_alone(suboff.parameter_files[BODIES[body]])
        found = law_at_points(p.measured, (), full_force(p), p.scaling.length, controls=False)
        place = {"v": "asin(v/U)", "w": "asin(w/U)", "r": "r'"}[variable]
        (f,) = (f for f in found if f.component == component and f"({place} " in f.worst_at)
        assert number(100.0 * f.worst / f.largest, 2) == worst, (body, component)
    y, n = (printed["appended", c, "v"] for c in "YN")
    assert f"by {y} % of the largest Y and {n} % of the largest N" in page("law_and_points.md")


def test_of_the_law_at_the_points(suboff: Study) -> None:
    """The column *Law*: worst of what the report prints, points beyond the range of the law among them."""
    line = r"^\| ([a-z ,]+) \| ([XYZKMN]) over ([vwr])[^|]* \| [\d.]+ \| ([\d.]+) \|"
    printed = rows("law_and_points.md", line)
    assert len(printed) == 14
    for body, component, variable, worst in printed:
        place = {"v": "asin(v/U)", "w": "asin(w/U)", "r": "r'"}[variable]
        (f,) = (
            f
            for f in suboff.parameter_files[BODIES[body]].law_at_points
            if f.component == component and f"({place} " in f.worst_at
        )
        inside_only = component == "X"  # X holds to 16 degrees, which its row says
        found = f.worst if inside_only else max(f.worst, f.worst_beyond)
        places = len(worst.partition(".")[2])
        assert f"{100.0 * found / f.largest:.{places}f}" == worst, (body, component)


def test_of_the_ratio_of_two_lengths() -> None:
    ratio = 4.356 / (13.9792 * 0.3048)
    assert f"The square of their ratio is {ratio**2:.3f}, its cube {ratio**3:.3f}." in page("theory.md")
