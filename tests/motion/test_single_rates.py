"""Arrays, plain numbers and the compiled kernel give the same rates."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.files import shipped
from coeflab.law.force_law import BASE, WIND, ForceLaw, ForceTerm, Reading
from coeflab.law.symbols import COMPONENTS
from coeflab.law.terms import Factor, Term
from coeflab.motion.dynamics import Dynamics
from coeflab.motion.ensemble import alone
from coeflab.motion.rates_of_one import rates_of_one, term_force_of_one
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.conform import vector_sets
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats.massed import torpedo


def of_tables() -> Vehicle:
    """C_D, C_S and C_n over beta, yaw damping over r, held within their tables."""
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    return vehicle(file, ("u", "v", "r"))


def apart() -> Vehicle:
    """Drag and lift that act in other axes than an increment does."""
    return vehicle(
        ParameterFile.model_validate_json(json.dumps(next(s for s in vector_sets() if s.name == "turned").parameters))
    )


@pytest.mark.parametrize("made", [lambda: vehicle(torpedo()), of_tables, apart], ids=["derivatives", "tables", "apart"])
def test_random_states(made: object) -> None:
    v: Vehicle = made()  # type: ignore[operator]
    rng = np.random.default_rng(3)
    states = rng.normal(size=(200, 14))
    states[:, 3:7] /= np.linalg.norm(states[:, 3:7], axis=1)[:, None]
    states[0, 7:13] = 0.0
    states[1, 7:10] = 0.0
    states[2, 7] = -2.0
    angles, wrench = rng.normal(0.0, 0.2, size=(200, 3)), rng.normal(0.0, 5.0, size=(200, 6))
    dynamics = alone(v).dynamics(np.array([0.3, -0.2, 0.1]))
    expected = dynamics.rates(states.T, angles.T, wrench.T).T
    one = rates_of_one(dynamics)
    found = np.array([one(s.tolist(), a.tolist(), w.tolist()) for s, a, w in zip(states, angles, wrench, strict=True)])
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-11)
    force = term_force_of_one(v.law)
    plain = np.array([force(s.tolist(), a.tolist()) for s, a in zip(states, angles, strict=True)])
    assert plain == pytest.approx(v.law.term_force(states[:, 7:13].T, angles.T).T, rel=1e-12, abs=1e-10)


NUMBERS = st.floats(-3.0, 3.0).map(lambda x: round(x, 3))
READINGS = st.builds(
    Reading, st.sampled_from([0.0, 1.0, 4.2]), st.floats(-1.0, -0.1), st.floats(0.1, 1.0), st.booleans()
)
FACTORS = st.builds(Factor, st.sampled_from([b for b in BASE if b != "V"]), st.integers(1, 3), st.booleans())


@st.composite
def terms(draw: Any) -> ForceTerm:
    """A term of at most three factors, each read as it is, primed or held."""
    term = Term(tuple(draw(st.lists(FACTORS, max_size=3))))
    held = {v: draw(READINGS) for v, _, _ in term.factors if draw(st.booleans())}
    component, power = draw(st.sampled_from([*COMPONENTS, *WIND])), draw(st.integers(-2, 2))
    into = draw(st.tuples(st.booleans(), st.booleans(), st.booleans()))
    return ForceTerm(
        "any", component, term, draw(NUMBERS), power, 1.0, "table", readings=tuple(held.items()), into=into
    )


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.lists(terms(), max_size=6), st.integers(0, 2**32 - 1))
def test_random_laws(of: list[ForceTerm], seed: int) -> None:
    """Any law of at most six terms on a body of random inertia: the copies are compared with the arrays."""
    compiled = pytest.importorskip("coeflab.motion.integrators.compiled")
    rng = np.random.default_rng(seed)
    law = ForceLaw(tuple(of), np.zeros((6, 6, 6)))
    forms, inverse, lever = rng.normal(size=(6, 21)), rng.normal(size=(6, 6)), rng.normal(size=(3, 1))
    dynamics = Dynamics(law, forms, inverse, rng.normal(size=1), lever, rng.normal(size=3))
    state, angles, wrench = rng.normal(size=14), rng.normal(0.0, 0.2, 3), rng.normal(size=6)
    state[3:7] /= np.linalg.norm(state[3:7])
    expected = dynamics.rates(state[:, None], angles[:, None], wrench[:, None])[:, 0]
    scale = 1e-11 * max(1.0, float(np.abs(expected).max()))
    assert rates_of_one(dynamics)(state.tolist(), angles.tolist(), wrench.tolist()) == pytest.approx(
        expected, abs=scale
    )
    assert compiled.rates(dynamics, state, angles, wrench) == pytest.approx(expected, abs=scale)
