"""Every validation notices a wrong sign, constant or axis, or says by numbers why none could."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from coeflab.core.finding import Severity
from coeflab.glider import motion
from coeflab.study.study import Study
from tests.mutations.harness import Outcome, Suboff, Verdicts, compare, edited, validate_huuv
from tests.mutations.mutations import NR, UNDETECTABLE, YR, every_constant, mutations, of_huuv, published, unchanged
from tests.mutations.table import PAGE, lines_of

STEP = int(os.environ.get("COEFLAB_CONSTANTS", "10"))  # one constant of ten; with 1 all, as was tried once
STUDIES = ("thauv", "flyingfish", "huuv", "suboff", "urv", "remus", "tank", "estimates")

# +5 % or the other sign of what nothing depends on, or less than is allowed: chosen, assumed, or not recomputed by anything.
OPEN = {
    "flyingfish": set(),
    "huuv": {f"{name} +5 %" for name in ("inertia", "length", "density", "speed", "rigid_inertia", "largest_drift", "largest_rate",
                                         "five_dof pitch_inertia")},
    "thauv": set(),
    "suboff": {
        f"{name} +5 %"
        for name in (
            "Zds = -0.005603", "Ndr = -0.002217", "Kv = -0.000019", "Kv = -0.000584", "Zwdot = -0.014529", "Mwdot = -0.000561",
            "Zqdot = -0.000633", "Mqdot = -0.000860", "Yvdot = -0.016186", "Nvdot = 0.000396", "Yrdot = 0.000398",
            "Nrdot = -0.000897", "Nvdot = 0.000202", "Yrdot = 0.000060", "Nrdot = -0.000676", "Ydr = 0.005929", "Mds = -0.002409",
        )
    },
    "remus": set(),
}  # fmt: skip


@pytest.fixture(scope="module")
def study(suboff: Study, tmp_path_factory: pytest.TempPathFactory) -> Suboff:
    return Suboff(suboff, tmp_path_factory.mktemp("mutated"))


@pytest.fixture(scope="module")
def base(study: Suboff):
    return cache(lambda name: unchanged(name, study))


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_every_mutation_is_noticed_or_moves_nothing_that_is_compared(
    name: str, study: Suboff, base: Callable[[str], Verdicts]
) -> None:
    """And docs/mutations.md says so: `python -m tests.mutations.table` writes it anew."""
    outcomes = {m: compare(base(name), m.run(study)) for m in mutations() if m.study == name}
    assert [m.what for m, o in outcomes.items() if not o.by and not m.why_not] == []
    assert [m.what for m, o in outcomes.items() if m.why_not and (o.by or not o.share < 1.0)] == []
    page = PAGE.read_text(encoding="utf-8")
    assert [line for line in lines_of(outcomes) if line not in page] == []


def test_few_mutations_go_unnoticed() -> None:
    assert 4 * len(UNDETECTABLE) <= len(mutations())
    assert max(Counter((m.study, m.what) for m in mutations()).values()) == 1


@pytest.mark.parametrize("name", STUDIES)
def test_unchanged_everything_holds(name: str, base: Callable[[str], Verdicts]) -> None:
    found: Verdicts = base(name)
    assert found.rows or found.checks
    assert [key for key, row in found.rows.items() if not row.holds] == []
    assert [key for key, (severity, _) in found.checks.items() if severity is Severity.FAIL] == []


@pytest.mark.slow
@pytest.mark.parametrize("signs", [(YR,), (NR,), (YR, NR)])
def test_flipped_literature_never_makes_a_stable_suboff(signs: tuple[tuple[str, str], ...], study: Suboff) -> None:
    checks = published(*signs)(study).checks
    said = [text for key, (_, text) in checks.items() if key == "check stability: suboff_fully_appended G_h"]
    assert len(said) == 1
    assert said[0].endswith((": unstable", ": sign open", ": no verdict"))


@pytest.mark.slow
@pytest.mark.parametrize("name", OPEN)
def test_every_constant_of_a_shipped_law(name: str, study: Suboff, base: Callable[[str], Verdicts]) -> None:
    every = every_constant(name)
    assert set(OPEN[name]) <= {what for what, _ in every}
    assert len(OPEN[name]) <= 0.27 * len(every)
    outcomes: dict[str, Outcome] = {what: compare(base(name), run(study)) for what, run in every[::STEP]}
    assert {what for what, o in outcomes.items() if not o.by} == OPEN[name] & set(outcomes)
    assert not {what for what in OPEN[name] & set(outcomes) if outcomes[what].share >= 1.0}


def test_a_law_is_as_it_was_after_a_mutation() -> None:
    before = motion.rates
    with edited(motion.rates, "p1 * q + net_mass", "-p1 * q + net_mass"):
        assert motion.rates is not before
    assert motion.rates is before


def test_an_outcome_names_what_fails() -> None:
    as_it_is = unchanged("huuv", None)
    assert compare(as_it_is, as_it_is) == Outcome((), "", 0.0)
    found = compare(as_it_is, of_huuv(d0=1.05)(None))
    assert (found.by, found.caught[0]) == ("fails", "Steady turns by root finding: 0, 60 %, u")
    assert found.share > 1.0
    assert validate_huuv.__module__ == "tests.mutations.harness"


def test_the_page_is_beside_the_others() -> None:
    assert Path(__file__).parents[2] / "docs" == PAGE.parent
