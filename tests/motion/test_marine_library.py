"""Candidate terms: which there are, and that they are the terms of the law that simulators use."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.identify.candidate_terms import candidate_terms
from coeflab.identify.candidates import allowed, candidates, column, same
from coeflab.law.symbols import derivative
from coeflab.law.terms import Term, parse_suffix
from coeflab.motion.vehicle import vehicle
from tests.motion.vehicles import STABLE, made

PLANAR = ("u", "v", "r", "dr")


def suffixes(component: str, symmetric: bool = True) -> list[str]:
    return [t.suffix for t in candidates(component, PLANAR, symmetric)]


def test_the_horizontal_library() -> None:
    assert suffixes("X") == ["0", "vv", "rr", "vr", "drdr"]
    assert suffixes("Y") == suffixes("N") == ["v", "r", "v|v|", "r|r|", "v|r|", "r|v|", "dr"]
    assert set(suffixes("Y", symmetric=False)) > {"0", "vv", "vr", "v|v|"}


@given(
    st.sampled_from("XYZKMN"),
    st.sampled_from([t.suffix for t in candidates("X", ("u", "v", "w", "p", "q", "r", "dr", "ds"), False)]),
)
def test_symmetry_is_that_of_the_symbol(component: str, suffix: str) -> None:
    assert allowed(component, parse_suffix(suffix)) is not derivative(component + suffix).odd_in_port_starboard


def test_the_order_of_factors_does_not_matter() -> None:
    assert same(parse_suffix("|v|v"), parse_suffix("v|v|"))
    assert same(parse_suffix("vr"), parse_suffix("rv"))
    assert not same(parse_suffix("v|r|"), parse_suffix("r|v|"))


@pytest.mark.parametrize("components", ["XYN", "ZMK"])
def test_the_terms_make_the_force_of_the_vehicle(components: str) -> None:
    """Sum of coefficient times column, against the law that moves the vehicle."""
    extra = {"Yv|v|": -0.06, "N|v|r": -0.02, "Xvr": 0.01, "Xdrdr": -0.004, "Xvv": -0.02, "Mw|w|": 0.01, "Yvvv": -0.3}
    file = made({**STABLE, **extra})
    body = vehicle(file)
    rng = np.random.default_rng(1)
    nu, controls = rng.uniform(-1.0, 1.0, (50, 6)), rng.uniform(-0.4, 0.4, (50, 3))
    columns = dict(zip(("u", "v", "w", "p", "q", "r", "dr", "ds", "db"), np.hstack([nu, controls]).T, strict=True))
    force = body.force(nu, controls)
    terms = candidate_terms(file, frozenset(columns), ["file"], symmetric=True, accelerations=False, driven=frozenset())
    for c in components:
        total = np.zeros(50)
        for t in terms:
            if t.component == c:
                entry = file.coefficient(t.symbol)
                total += entry.value * t.per_prime * column(c, t.term, columns)
        assert total == pytest.approx(force[:, "XYZKMN".index(c)], rel=1e-12, abs=1e-12)


def test_damping_about_rest_has_no_speed_in_it() -> None:
    columns = {m: np.array([0.0, 2.0]) for m in ("u", "v", "w", "p", "q", "r")}
    assert column("Y", parse_suffix("v"), columns, rest=True) == pytest.approx([0.0, 2.0])
    assert column("X", Term(), {**columns, "u": np.array([0.0, -2.0])}) == pytest.approx([0.0, -12.0])
