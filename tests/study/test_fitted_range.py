"""A longer sweep that moves a slope beyond the U95 of a shorter one, and widens it, is said at the coefficient.

``python tests/study/test_fitted_range.py COUNT SEED`` prints how many of COUNT simulated campaigns get the warning.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.fits.results.fit_result import Sensitivity
from coeflab.fits.statistics.origin_slope import estimate
from coeflab.study.checks import coverage
from coeflab.study.checks.fitted_range import check, moved_by_the_rest
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study
from tests.coverage.slope_campaigns import FAMILIES
from tests.report.studies import FULL, small_study
from tests.study.test_own_tows import HEAD

WHOLE, U95 = -0.030, 0.0030
CAP = float(np.sin(np.radians(10.0)))


@pytest.mark.parametrize(
    ("value", "u95", "found"),
    [
        (-0.0330, 0.0019, True),  # 1.58 times narrower, moved by 1.6 of its U95
        (-0.0330, 0.0021, False),  # 1.43 times narrower
        (-0.0315, 0.0019, False),  # the whole lies within
        (-0.0400, None, False),
    ],
)
def test_the_rule(value: float, u95: float | None, found: bool) -> None:
    sweep = next(s for s in small_study(FULL).fits[0].sweeps if s.symbol == "Yv")
    one = replace(sweep, value=WHOLE, u95=U95, sensitivity=(Sensitivity(CAP, value, u95), Sensitivity(0.3, WHOLE, U95)))
    assert (moved_by_the_rest(one) is not None) is found
    assert moved_by_the_rest(replace(one, target="x2")) is None


def test_a_move_below_a_tenth_is_a_note_and_a_copy_by_symmetry_says_nothing() -> None:
    study = small_study(FULL)
    fit = study.fits[0]

    def found(by_symmetry: str, shorter: float) -> list[Severity]:
        sweeps = tuple(
            replace(s, value=WHOLE, u95=U95, sensitivity=(Sensitivity(CAP, shorter, 0.001),), by_symmetry=by_symmetry)
            if s.symbol == "Yv"
            else replace(s, sensitivity=())
            for s in fit.sweeps
        )
        return [c.severity for c in check(replace(study, fits=(replace(fit, sweeps=sweeps),)))]

    assert found("", -0.0340) == [Severity.WARN]
    assert found("", -0.0320) == [Severity.NOTE]
    assert found("tow/other", -0.0340) == []


def test_a_copy_by_symmetry_repeats_no_finding_on_its_settings() -> None:
    """A sweep that begins far from zero is warned of; the one that is turned from it is not."""
    study = small_study(FULL)
    fit = study.fits[0]

    def found(by_symmetry: str) -> list[str]:
        far = tuple(
            replace(s, x=np.copysign(1.0 + np.abs(s.x), s.x), by_symmetry=by_symmetry)
            for s in fit.sweeps
            if s.symbol == "Yv"
        )
        return [
            c.statistic
            for c in coverage.check(replace(study, fits=(replace(fit, sweeps=far),)))
            if c.severity is Severity.WARN
        ]

    assert any(said.startswith("smallest |v'| = ") for said in found(""))
    assert found("tow/other") == []


@pytest.fixture(scope="module")
def bare_hull(tmp_path_factory: pytest.TempPathFactory) -> Study:
    plan = tmp_path_factory.mktemp("bare") / "plan.toml"
    text = HEAD.partition("[[references]]")[0].replace(
        '[[table]]\ncampaign = "suboff_roddy_2"\nfits = ["slope_at_origin"]\n', ""
    )
    plan.write_text(text.replace('"suboff_roddy_3"', f'"{shipped("cfd_data") / "suboff_roddy_3"}"'))
    return run(read_plan(plan))


def test_both_ranges_of_the_bare_hull_hold_yv(bare_hull: Study) -> None:
    """-0.0060 +- 0.0025 to 10 deg, -0.0038 +- 0.0031 to 18 deg: no warning, since the mixture's +- 0.0013 to 10 deg is no more."""
    assert not [c for c in check(bare_hull) if c.subject == "suboff_roddy_3 Yv'"]
    sweep = next(s for f in bare_hull.fits for s in f.sweeps if s.symbol == "Yv")
    shorter = sweep.sensitivity[0]
    assert sweep.value == pytest.approx(-0.0038, abs=5e-5)
    assert shorter.value == pytest.approx(-0.0060, abs=5e-5)
    assert abs(sweep.value - shorter.value) < shorter.u95 < sweep.u95


def fired(count: int, seed: int) -> Counter[str]:
    """Families of simulated campaigns, to 18 degrees in steps of 1.5 to 3, that get the warning."""
    rng, out = np.random.default_rng(seed), Counter[str]()
    pattern = next(s for s in small_study(FULL).fits[0].sweeps if s.symbol == "Yv")
    for i in range(count):
        name = list(FAMILIES)[i % len(FAMILIES)]
        v = np.sin(np.radians(np.arange(-18.0, 18.01, float(rng.choice([1.5, 2.0, 3.0])))))
        y = FAMILIES[name].curve(v)
        y = y + float(rng.choice([0.03, 0.01, 0.003, 0.001])) * np.abs(y).max() * rng.standard_normal(len(v))
        caps = [float(np.sin(np.radians(c))) for c in (10.0, 12.0)]
        ended = [estimate(v[k], y[k]) for k in (np.abs(v) <= 1.03 * c for c in caps)]
        whole = estimate(v, y)
        shorter = tuple(Sensitivity(c, s.value, s.u95) for c, s in zip(caps, ended, strict=True))
        one = replace(pattern, value=whole.value, u95=whole.u95, sensitivity=shorter)
        out[name] += moved_by_the_rest(one) is not None
    return out


@pytest.mark.slow
def test_few_simulated_campaigns_are_warned_of() -> None:
    """7 of 400 (seed 20261123): of tanh, sine and v^5, whose curve the shorter range does not show. Here 64, 3 standard deviations."""
    assert fired(64, 20261123).total() <= 64 * 0.0175 + 3.0 * (64 * 0.0175) ** 0.5


if __name__ == "__main__":
    found = fired(int(sys.argv[1]), int(sys.argv[2]))
    sys.stdout.write(f"{found.total()} of {sys.argv[1]}: {+found}\n")
