"""The law of a vehicle from its shape against the estimates' own forces: a turn by either is the same turn."""

from __future__ import annotations

import json
from dataclasses import replace
from math import degrees, hypot

import numpy as np
import pytest
from scipy.optimize import fsolve

from coeflab.bodies.simplify.source import subject
from coeflab.core.finding import Severity
from coeflab.estimates import STEERED, _derived, _steered
from coeflab.estimates.fins import FoilForce
from coeflab.report.sections.manoeuvres import without_u95
from coeflab.study.estimated_vehicle import asked, compared, from_shape
from coeflab.study.study import Study
from coeflab.vehicle.held_to_model import law_u95
from coeflab.vehicle.merge import findings_of_merged

ANGLE = -np.radians(15.0)


@pytest.fixture(scope="module")
def study() -> Study:
    body = subject("myring_auv")
    return from_shape(asked(body)[0], body)


def by_the_file(content: dict[str, object], left_out: tuple[str, ...] = ()) -> object:
    """X Y N over u v r and rudder from the numbers of a parameter file and nothing else; the ideal fluid's products are totals in it."""
    at, length = content["conditions"], content["scaling"]["length"]
    terms = [
        (c["symbol"].rstrip("'"), c["value"]) for c in content["coefficients"]
        if c["value"] is not None and c["symbol"].rstrip("'") not in left_out
    ]  # fmt: skip

    def force(u: float, v: float, r: float, rudder: float) -> tuple[float, float, float]:
        speed, out = hypot(u, v), {"X": 0.0, "Y": 0.0, "N": 0.0}
        of = {"u": u / speed, "v": v / speed, "r": r * length / speed, "dr": rudder}
        for symbol, value in terms:
            product, rest = value, symbol[1:]
            while rest and product:
                name = (
                    rest[:4]
                    if rest[:4] == "|dr|"
                    else rest[:3]
                    if rest[0] == "|"
                    else rest[:2]
                    if rest[0] == "d"
                    else rest[0]
                )
                rest, bare = rest[len(name) :], name.strip("|")
                product *= 1.0 if bare == "0" else (abs(of.get(bare, 0.0)) if name[0] == "|" else of.get(bare, 0.0))
            if symbol[0] in out:
                out[symbol[0]] += product
        pressure = 0.5 * at["density"] * speed**2 * length**2
        return pressure * out["X"], pressure * out["Y"], pressure * length * out["N"]

    return force


def steady_turn(content: dict[str, object], force: object) -> tuple[float, float, float]:
    """Speed over that of the approach, yaw rate in deg/s and drift, at the thrust that kept the approach."""
    mass, ahead = content["mass"], content["conditions"]["speed"]
    thrust = -force(ahead, 0.0, 0.0, 0.0)[0]

    def balance(state: np.ndarray) -> tuple[float, float, float]:
        u, v, r = state
        x, y, n = force(u, v, r, ANGLE)
        return (x + thrust + mass["mass"] * v * r + mass["mass_moment"] * r * r, y - mass["mass"] * u * r,
                n - mass["mass_moment"] * u * r)  # fmt: skip

    u, v, r = fsolve(balance, (0.8 * ahead, -0.1 * ahead, 0.3))
    return hypot(u, v) / ahead, degrees(r), degrees(np.arctan2(v, u))


def test_a_turn_by_the_law_is_a_turn_by_the_estimates(study: Study) -> None:
    """.876 and 23.8 deg/s by coefficients without Xvdr and Xrdr, .652 and 17.5 deg/s by the forces that they come from."""
    file = next(iter(study.parameter_files.values()))
    content = json.loads(file.to_json())
    made = study.shape.estimates

    def theirs(u: float, v: float, r: float, rudder: float) -> tuple[float, float, float]:
        f = made.forces(np.array([[u, v, 0.0, 0.0, 0.0, r]]), {"dr": np.array([rudder])})[0]
        return f[0], f[1], f[5]

    model, law = steady_turn(content, theirs), steady_turn(content, by_the_file(content))
    assert model[:2] == pytest.approx((0.652, 17.52), rel=5e-3)
    assert law[:2] == pytest.approx(model[:2], rel=0.02)
    poorer = steady_turn(content, by_the_file(content, ("Xvdr", "Xrdr")))
    assert poorer[:2] == pytest.approx((0.876, 23.83), rel=5e-3)
    figures = {f.name: f.value for f in study.manoeuvres[0].figures}
    assert figures["speed in turn / approach speed"] == pytest.approx(law[0], rel=1e-3)
    assert degrees(figures["steady yaw rate"]) == pytest.approx(law[1], rel=1e-3)
    (carried,) = study.shape.carried
    spread = next(s for s in carried.spreads if s.figure.name == "speed in turn / approach speed")
    assert spread.low <= model[0] <= spread.high


def test_what_the_law_leaves_out_is_a_finding(study: Study) -> None:
    file, made = next(iter(study.parameter_files.values())), study.shape.estimates
    (met,) = (f for f in file.findings if f.code.startswith("law.model"))
    assert (met.code, met.severity) == ("law.model_met", Severity.NOTE)
    kept = tuple(c for c in file.coefficients if c.symbol not in ("Xvdr'", "Xrdr'"))
    symbols = tuple(c.symbol for c in kept)
    at = [file.covariance.symbols.index(s) for s in symbols]
    cells = tuple(tuple(file.covariance.matrix[i][j] for j in at) for i in at)
    covariance = file.covariance.model_copy(update={"symbols": symbols, "matrix": cells})
    poorer = file.model_copy(update={"coefficients": kept, "covariance": covariance, "findings": ()})
    found = compared(poorer, made, study.manoeuvres).findings
    warned = [f for f in found if f.severity is Severity.WARN]
    assert {f["component"] for f in warned} == {"X"}
    assert max(f["share"] for f in warned) > 0.3
    assert all(f.statistic > f.threshold for f in warned)
    left = findings_of_merged((*found, *found), "both")
    assert [f.code for f in left] == ["law.model_left"]


def test_u95_of_a_law_is_that_of_its_terms(study: Study) -> None:
    """Straight ahead X is X0 alone, and a rudder on a straight course is Ydr and Ndr alone."""
    file = next(iter(study.parameter_files.values()))
    at, length = file.conditions, file.scaling.length
    pressure = 0.5 * at.density * at.speed**2 * length**2
    nu, controls = np.array([[at.speed, 0.0, 0.0, 0.0, 0.0, 0.0]]), np.zeros((1, 3))
    assert law_u95(file, nu, controls)[0, 0] == pytest.approx(pressure * file.coefficient("X0").u95, rel=1e-9)
    controls[0, 0] = 0.1
    assert law_u95(file, nu, controls)[0, 1] == pytest.approx(0.1 * pressure * file.coefficient("Ydr").u95, rel=1e-9)


def test_the_part_along_x_of_a_turned_fin() -> None:
    """X = 1/2 rho i (a - k i / S), i = A a + B u d over cross velocity a = v + r x and angle d: X_vd = 1/2 rho u B (1 - 2 k A / S)."""
    own, turned, induced, lifting, density = 0.031, 0.018, 0.42, 0.05, 1000.0
    x, speed, length = -0.6, 1.7, 1.4
    place, none = np.array([x, 0.0, 0.0]), np.zeros(3)
    fin = FoilForce(
        place,
        place,
        0.0,
        np.array([0.0, 1.0, 0.0]),
        own,
        0.0,
        turned,
        0.0,
        lifting,
        induced,
        0.0,
        (("dr", 1.0),),
        density,
    )
    assert STEERED["dr"] == ("v", "r")
    slope = 0.5 * density * speed * turned * (1.0 - 2.0 * induced * own / lifting)
    unit = 0.5 * density * speed**2 * length**2
    drift = np.array([0.1, 0.2, 0.3])
    ahead = float(
        drift**2 @ np.sqrt(1.0 - drift**2) / (drift @ drift)
    )  # u over U of the grid, as least squares weighs it
    expected = {"v": ahead * slope * speed / unit, "r": slope * x * speed / length / unit}
    for motion, value in expected.items():
        found, _ = _derived((_steered(length, speed, motion, "dr"),), fin, np.array([unit]))
        assert found[0] == pytest.approx(value, rel=1e-9), motion
    assert replace(fin, turned=0.0)(np.array([[speed, *none[:2], 0.0, 0.0, 0.0]]), {"dr": np.ones(1)})[0, 0] == 0.0


def test_the_report_says_of_one_turn_what_its_first_page_says(study: Study) -> None:
    """Before: a 95 % range of the tactical diameter on page 1, and "No U95: each manoeuvre is computed once"."""
    said = without_u95(study)
    assert "turning circle 100" in said
    assert "zigzag is computed once" in said
    bare = replace(study, shape=replace(study.shape, carried=()))
    assert without_u95(bare).startswith("No U95")
