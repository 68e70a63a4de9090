"""Glider files: units, round trips, one clear error."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError, UnitsError
from coeflab.core.files import shipped
from coeflab.glider.glider import BuoyancyEngine, Glider, GliderMass, GliderPhase, SlidingMass, StatedPolar
from coeflab.glider.glider_file import KINDS, gliders_at, read_glider

THAUV = shipped("cfd_data") / "thauv"
CASE_01 = (THAUV / "case_01.toml").read_text()
ABOVE = st.floats(1e-6, 1e6)
ANY = st.floats(-1e6, 1e6)
TEXT = st.text(st.characters(exclude_categories=["C"]), min_size=1).filter(lambda s: s.strip())
ENDS = st.tuples(ANY, ANY).map(lambda e: (min(e), max(e)))


@st.composite
def gliders(draw: st.DrawFn) -> Glider:
    slide, net = draw(ENDS), draw(ENDS)
    covered = draw(st.none() | st.tuples(st.floats(-1.5, -0.01), st.floats(0.01, 1.5)))
    polar = StatedPolar(
        draw(st.sampled_from(["deg", "rad"])), draw(ANY), draw(ABOVE), draw(ABOVE), draw(st.floats(0, 1e6)), draw(ANY),
        draw(ANY), draw(st.floats(0, 1e6)), draw(st.booleans()), covered,
    )  # fmt: skip
    phase = st.builds(
        GliderPhase,
        TEXT,
        st.floats(*net),
        st.floats(*slide),
        lasts=st.floats(1e-3, 1e7),
        until_depth=st.none() | st.floats(0, 1e4),
    )
    return Glider(
        name=draw(st.from_regex(r"[A-Za-z0-9_-]{1,20}", fullmatch=True)),
        title=draw(TEXT),
        citation=draw(TEXT),
        gravity=draw(ABOVE),
        mass=GliderMass(draw(ABOVE), draw(ABOVE), draw(ABOVE), draw(ANY), draw(ANY)),
        sliding_mass=SlidingMass(draw(st.floats(0, 1e6)), draw(ANY), *slide, draw(ABOVE)),
        engine=BuoyancyEngine(draw(ANY), low=net[0], high=net[1], rate=draw(ABOVE)),
        polar=polar,
        phases=tuple(draw(st.lists(phase, min_size=1, max_size=3))),
        basis=(("mass.surge", f"{draw(st.sampled_from(KINDS))}: a source"),),
    )


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30, deadline=None)
@given(gliders())
def test_what_is_written_is_read_again(tmp_path: Path, glider: Glider) -> None:
    file = tmp_path / "glider.toml"
    file.write_bytes(glider.file())
    assert read_glider(file) == glider


@pytest.mark.parametrize("name", ["thauv", "slocum"])
def test_shipped_gliders_say_what_each_number_rests_on(name: str) -> None:
    for g in gliders_at(shipped("cfd_data") / name):
        covered = {key.partition(".")[0] for key, _ in g.basis}
        parts = {key for key, _ in g.basis if "." in key}
        assert {"polar", "engine", "sliding_mass", "phase"} <= covered
        assert "mass" in dict(g.basis) or {f"mass.{k}" for k in GliderMass.__slots__} <= parts


def test_the_three_cases_differ_by_their_polar_alone() -> None:
    cases = gliders_at(THAUV)
    assert [c.name for c in cases] == ["thauv_case_01", "thauv_case_02", "thauv_case_03"]
    assert len({(c.mass, c.engine, c.sliding_mass, c.phases) for c in cases}) == 1
    assert len({c.polar for c in cases}) == 3


def test_units_are_read() -> None:
    imperial = CASE_01.replace('surge = "70 kg"', 'surge = "154.323583529 lb"').replace('"660 s"', '"11 min"')
    assert imperial != CASE_01
    file = _written(imperial)
    assert read_glider(file).mass.surge == pytest.approx(70.0, rel=1e-9)
    assert read_glider(file).phases[0].lasts == 660.0


def test_degrees_and_radians_are_two_vehicles() -> None:
    per_degree = read_glider(_written(CASE_01)).polar.per_radian
    per_radian = read_glider(_written(CASE_01.replace('"deg"', '"rad"'))).polar.per_radian
    assert per_degree.lift[1] / per_radian.lift[1] == pytest.approx(180.0 / np.pi)
    assert per_degree.drag[1] / per_radian.drag[1] == pytest.approx((180.0 / np.pi) ** 2)


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def _written(text: str) -> Path:
    Path("case.toml").write_text(text)
    return Path("case.toml")


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ('angle_unit = "deg"\n', "", "polar.angle_unit", "57.3"),
        ('angle_unit = "deg"', 'angle_unit = "grad"', "polar.angle_unit", '"deg" or "rad"'),
        ("contains_munk = false\n", "", "polar.contains_munk", "true or false"),
        ('surge = "70 kg"', 'surge = "-70 kg"', "mass.surge", "above zero"),
        ('surge = "70 kg"', 'surge = "70 m"', "mass.surge", "mass"),
        ('surge = "70 kg"', 'surg = "70 kg"', "mass.surge", "Add mass.surge"),
        ('surge = "70 kg"', 'surge = nan', "mass.surge", "finite"),
        ("K_D0 = 11.1159", "K_D0 = 0.0", "polar.K_D0", "above zero"),
        ("K_D = 0.215", "K_D = -0.215", "polar.K_D", "zero or more"),
        ("K_L = 9.5281", "K_L = -9.5281", "polar.K_L", "upward"),
        ("K_L = 9.5281", 'K_L = "9.5281 N"', "polar.K_L", "pure number"),
        ("pitch_damping = 55.0", "pitch_damping = -55.0", "polar.pitch_damping", "zero or more"),
        ('net_mass = "0.48302 kg"', 'net_mass = "4.8302 kg"', "phase[0].net_mass", "which it reaches"),
        ('position = "0.03 m"', 'position = "3 m"', "phase[0].position", "which it reaches"),
        ('lasts = "660 s"', 'lasts = "0 s"', "phase[0].lasts", "above zero"),
        ('lasts = "660 s"', 'lasts = "1 year"', "phase[0].lasts", "at most"),
        ('lasts = "660 s"\n', 'lasts = "660 s"\nuntil = 3\n', "phase[0].until", "unknown key"),
        ('low = "-0.05 m"', 'low = "0.06 m"', "sliding_mass.low", "no more than high"),
        ('rate = "0.001 m/s"', 'rate = "0 m/s"', "sliding_mass.rate", "above zero"),
        ('name = "thauv_case_01"', 'name = "../x"', "glider.name", "letters"),
        ('"printed: Table 3', '"copied: Table 3', "basis.polar", "printed"),
        ('"mass.heave" =', '"mass.hevae" =', "basis.mass.hevae", "table.key"),
        ("pitch_damping = 55.0", 'pitch_damping = 55.0\ncovered = ["8 deg", "-8 deg"]', "polar.covered", "two angles"),
    ],
)  # fmt: skip
def test_one_clear_error(old: str, new: str, key: str, words: str) -> None:
    assert CASE_01.count(old) >= 1
    with pytest.raises(InputError) as caught:
        read_glider(_written(CASE_01.replace(old, new, 1)))
    first, *more = str(caught.value).split("\n")
    assert re.match(rf'case\.toml, line \d+, "{re.escape(key)}": ', first)
    assert words in first
    assert [m.partition('": ')[0] for m in more] == (['case.toml, line 8, "mass.surg'] if "surg " in new else [])


def test_no_phase() -> None:
    bare = re.sub(r"\[\[phase\]\].*?(?=\[basis\])", "", CASE_01, flags=re.DOTALL).replace("\nphase = ", "\n# ")
    with pytest.raises(InputError, match=r"no phase.*\[\[phase\]\]"):
        read_glider(_written(bare))


def test_a_folder_without_gliders_or_with_a_name_twice() -> None:
    with pytest.raises(InputError, match="without a TOML file"):
        gliders_at(Path())
    _written(CASE_01)
    Path("again.toml").write_text(CASE_01)
    with pytest.raises(InputError, match=r"the name in again\.toml too"):
        gliders_at(Path())


def test_a_bare_angle_is_no_pure_number() -> None:
    with pytest.raises(UnitsError):
        read_glider(_written(CASE_01.replace("K_M0 = 1.1025", 'K_M0 = "1.1025 deg"')))
