"""Plugins that other distributions install, broken ones among them: real dist-info folders on the path."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.errors import PluginError
from coeflab.core.finding import Severity
from coeflab.core.registry import Registry as Room
from coeflab.core.version import VERSION
from coeflab.fits import FITS
from coeflab.study.checks import CHECKS
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan

Install = Callable[..., None]
GOOD = "from coeflab.core.table import Check, Severity\nsummary = 'theirs'\ncitations = ()\n"


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Install distributions into a folder on the path: name, module text, and entry points by room."""
    site = tmp_path / "site"
    site.mkdir()
    rooms: tuple[Room[Any], ...] = (CHECKS, FITS)
    mine: list[str] = []

    def forget() -> None:
        for room in rooms:
            for name in ("_claims", "_shipped"):
                room.__dict__.pop(name, None)

    def installed(distribution: str, text: str, **points: str) -> None:
        module = distribution.replace("-", "_")
        mine.append(module)
        (site / f"{module}.py").write_text(text)
        info = site / f"{module}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.2\n")
        lines = [f"[coeflab.{room}]\n{name} = {module}\n" for room, name in points.items()]
        (info / "entry_points.txt").write_text("\n".join(lines))
        forget()

    monkeypatch.syspath_prepend(str(site))
    importlib.invalidate_caches()
    yield installed
    forget()
    for name in mine:
        sys.modules.pop(name, None)


@pytest.fixture
def plan(write_campaign: Callable[..., Path]) -> Plan:
    folder = write_campaign()
    (folder / "plan.toml").write_text('[study]\nname = "t"\n[[table]]\ncampaign = "."\nfits = ["slope_at_origin"]\n')
    return read_plan(folder / "plan.toml")


@pytest.mark.parametrize("fault", ["import nothing_of_that_name", "1 / 0", "raise SystemExit(3)", "def ("])
def test_one_that_cannot_be_imported_is_named_with_the_reason(install: Install, plan: Plan, fault: str) -> None:
    install("half-built", fault, checks="half")
    assert "half" not in CHECKS.usable()
    assert "signs" in CHECKS.usable()
    ((name, reason),) = CHECKS.unusable()
    assert name == "half"
    assert 'the check "half" of half-built 1.2 cannot be imported: ' in reason
    study = run(plan)
    (found,) = [c for c in study.checks if c.name == "half"]
    assert found.severity is Severity.WARN
    assert "half-built 1.2" in found.statistic
    assert {c.name for c in study.checks} > {"half"}


@pytest.mark.parametrize(
    ("body", "what"),
    [
        ("raise ZeroDivisionError('no points')", "ZeroDivisionError: no points"),
        ("from coeflab.core.errors import InputError; raise InputError('this', 'that')", "found this; expected that"),
        ("return None", "TypeError: "),
        ("return ['fine']", "TypeError: a finding that is no Check"),
    ],
)
def test_a_check_that_raises_is_a_finding(install: Install, plan: Plan, body: str, what: str) -> None:
    install("rude", f"{GOOD}def check(study):\n    {body}\n", checks="rude")
    study = run(plan)
    (found,) = [c for c in study.checks if c.name == "rude"]
    assert found.severity is Severity.WARN
    assert what in found.statistic
    assert "not assessed" in found.comment
    assert not study.failed


def test_a_good_one_takes_part(install: Install, plan: Plan) -> None:
    install(
        "kind",
        f"{GOOD}def check(study):\n    return [Check('kind', 's', Severity.PASS, 'a', 'b', 'c')]\n",
        checks="kind",
    )
    assert [c.statistic for c in run(plan).checks if c.name == "kind"] == ["a"]
    assert CHECKS.unusable() == ()


def test_ours_stays_where_a_name_is_claimed(install: Install, plan: Plan, caplog: pytest.LogCaptureFixture) -> None:
    install("usurper", f"{GOOD}def fit(tables, scaling, options):\n    raise RuntimeError\n", fits="slope_at_origin")
    assert FITS.load("slope_at_origin").__name__ == "coeflab.fits.slope_at_origin"  # type: ignore[attr-defined]
    assert run(plan).fits[0].coefficients.symbols
    ((name, reason),) = FITS.unusable()
    assert name == "slope_at_origin"
    assert reason == (
        f'the fit "slope_at_origin" of usurper 1.2 is refused: coeflab {VERSION} ships one of that name, which stays'
    )
    assert [r.getMessage() for r in caplog.records if r.levelname == "WARNING"] == [f"{reason}."]


def test_a_name_that_two_claim_is_neithers(install: Install) -> None:
    for name in ("north", "south"):
        install(name, f"{GOOD}def check(study):\n    return []\n", checks="pole")
    assert "pole" not in CHECKS.names()
    assert CHECKS.unusable() == (("pole", 'the check "pole" is refused: north 1.2 and south 1.2 claim it'),)
    with pytest.raises(PluginError, match=r"Known: .* north 1\.2 and south 1\.2 claim it"):
        CHECKS.load("pole")


def test_a_fit_that_raises_is_an_error_with_its_name(install: Install, write_campaign: Callable[..., Path]) -> None:
    install("rough", f"{GOOD}def fit(tables, scaling, options):\n    return tables[99]\n", fits="rough")
    folder = write_campaign()
    (folder / "plan.toml").write_text('[study]\nname = "t"\n[[table]]\ncampaign = "."\nfits = ["rough"]\n')
    with pytest.raises(PluginError, match=r'the fit "rough" of rough 1\.2 failed: IndexError'):
        run(read_plan(folder / "plan.toml"))


@pytest.mark.slow
def test_formats_lists_the_broken(install: Install, tmp_path: Path) -> None:
    install("half-built", "import nothing_of_that_name", checks="half", fits="slope_at_origin")
    start = f"import sys; sys.path.insert(0, {str(tmp_path / 'site')!r}); from coeflab.cli import main; main()"
    made = subprocess.run(
        [sys.executable, "-c", start, "formats", "--json"], capture_output=True, text=True, check=False
    )
    assert made.returncode == 0, made.stderr
    plugins = json.loads(made.stdout)["plugins"]
    broken = {p["name"]: p["broken"] for p in plugins if "broken" in p}
    assert "half-built 1.2 cannot be imported: ModuleNotFoundError" in broken["half"]
    assert "half-built 1.2 is refused" in broken["slope_at_origin"]
    assert {"signs", "slope_at_origin"} <= {p["name"] for p in plugins if "broken" not in p}
