"""A synthetic vehicle of known coefficients, sent through manoeuvres, is found again behind noise."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.identify.identified import Identified, Outcome, Verdict
from coeflab.identify.identified_figures import identified_figure
from coeflab.identify.identify import identify_from
from coeflab.motion.simulation import simulate
from coeflab.report.tables.motion import motion_csv
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterSurface
from tests.motion.vehicles import STABLE, made, with_limits

pytestmark = pytest.mark.slow
TRUE = {
    **STABLE, "Yv|v|": -0.06, "N|v|r": -0.02, "Xvr": 0.01, "Xdrdr": -0.004, "Xvv": -0.02,
    "Yvdot": -1.2e-2, "Nrdot": -8e-4, "Xudot": -6e-4,
}  # fmt: skip
RUNS: tuple[tuple[str, Mapping[str, Any]], ...] = (
    ("zigzag", {"rudder": "10 deg", "heading": "10 deg", "executes": 8}),
    ("zigzag", {"rudder": "20 deg", "heading": "20 deg", "executes": 8}),
    ("zigzag", {"rudder": "35 deg", "heading": "5 deg", "executes": 12}),
    ("zigzag", {"rudder": "30 deg", "heading": "60 deg", "executes": 6}),
    ("turning_circle", {"rudder": "35 deg", "turns": 1.0}),
    ("turning_circle", {"rudder": "10 deg", "side": "port", "turns": 1.0}),
)
LATERAL = {"Y": {"Yv", "Yr", "Yv|v|", "Ydr"}, "N": {"Nv", "Nr", "N|v|r", "Ndr"}}
FILE = with_limits(made(TRUE), 0.7, 0.3)


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("clean")
    out = []
    for k, (name, options) in enumerate(RUNS):
        found = simulate(FILE, name, options, {"record": 0.02}, free=("u", "v", "r"))
        out.append(folder / f"{k}_{name}.csv")
        out[-1].write_bytes(motion_csv(found.trajectory))
    return out


def columns(path: Path) -> tuple[list[str], np.ndarray]:
    head, *rows = csv.reader(path.read_text().splitlines())
    return head, np.array(rows, dtype=float)


def write(path: Path, head: list[str], values: np.ndarray) -> Path:
    path.write_text("\n".join([",".join(head), *(",".join(repr(float(x)) for x in row) for row in values)]) + "\n")
    return path


def noisy(files: list[Path], folder: Path, level: float, seed: int) -> list[Path]:
    """Copies with white noise on u v r, of this share of each one's root mean square."""
    rng, out = np.random.default_rng(seed), []
    for file in files:
        head, values = columns(file)
        for name in ("u [m/s]", "v [m/s]", "r [rad/s]"):
            k = head.index(name)
            values[:, k] += level * np.sqrt(np.mean(values[:, k] ** 2)) * rng.standard_normal(len(values))
        out.append(write(folder / file.name, head, values))
    return out


def kept(found: Identified, component: str) -> set[str]:
    return {t.symbol.removesuffix("'") for t in found.found if t.component == component}


def error(found: Identified, symbol: str) -> float:
    value = found[symbol].value
    return abs(value / TRUE[symbol] - 1.0)


def test_clean_series_give_every_planted_term(clean: list[Path]) -> None:
    found = identify_from(clean, FILE, {})
    assert not found.failed
    assert kept(found, "X") == {"X0", "Xvv", "Xvr", "Xdrdr"}
    for component, symbols in LATERAL.items():
        assert kept(found, component) == symbols
        assert max(error(found, s) for s in symbols) < 2e-3
    assert {b.component for b in found.balances} == {"X", "Y", "N"}
    assert max(b.left or 0.0 for b in found.balances) < 1e-3


@pytest.mark.parametrize("seed", [3, 4])
def test_one_per_cent_of_noise(clean: list[Path], tmp_path: Path, seed: int) -> None:
    found = identify_from(noisy(clean, tmp_path, 0.01, seed), FILE, {})
    for component, symbols in LATERAL.items():
        assert kept(found, component) == symbols
        assert {found[s].outcome for s in symbols} == {Outcome.IDENTIFIED}
        assert max(error(found, s) for s in symbols - {"Yr"}) < 0.04
    assert error(found, "Yr") < 0.15
    assert error(found, "X0") < 5e-3


def test_at_five_per_cent_the_weak_form_stands_where_differences_fail(clean: list[Path], tmp_path: Path) -> None:
    files = noisy(clean, tmp_path, 0.05, 3)
    asked = {"terms": "Yv Yr Yv|v| Ydr Nv Nr N|v|r Ndr"}
    found, other = (identify_from(files, FILE, {**asked, "form": form}) for form in ("weak", "derivative"))
    linear = ("Yv", "Ydr", "Nv", "Nr", "Ndr")
    assert max(error(found, s) for s in linear) < 0.1
    for s in ("Yv", "Ydr", "Nr", "Ndr"):
        there = other[s].value
        assert there is None or abs(there / TRUE[s] - 1.0) > 1.5 * error(found, s)
    worst = [1.0 if other[s].value is None else error(other, s) for s in linear]
    assert max(worst) > 0.5


def test_controls_that_are_held_over_a_row_move_coefficients_and_by_how_much_stands_beside(
    clean: list[Path], tmp_path: Path
) -> None:
    """Before: intervals of a few tenths of a per cent, values some per cent off, no word."""
    files = []
    for file in clean:
        head, values = columns(file)
        k = head.index("dr [rad]")
        values[:-1, k] = (values[:-1, k] + values[1:, k]) / 2.0
        files.append(write(tmp_path / file.name, head, values))
    found = identify_from(files, FILE, {"terms": "file"})
    said = next(f for f in found.findings if f.code == "record.held")
    shares = dict(re.findall(r"(\S+)' ([-+]\d+)%", " ".join(said["each"])))
    assert float(shares["Ndr"]) > 2.0
    for symbol, share in shares.items():
        t = found[symbol]
        assert t.value is not None
        assert abs(t.value - TRUE[symbol]) > (t.half or np.inf)
        assert t.value * (1.0 + float(share) / 100.0) == pytest.approx(TRUE[symbol], rel=0.02)


def test_what_does_not_move_is_not_identifiable(tmp_path: Path) -> None:
    motion = simulate(FILE, "straight_run", {"duration": 60.0}, {"record": 0.05}, free=("u", "v", "r")).trajectory
    (tmp_path / "run.csv").write_bytes(motion_csv(motion))
    head, values = columns(tmp_path / "run.csv")
    still = identify_from([tmp_path / "run.csv"], FILE, {})
    assert [t.symbol for t in still.terms] == ["X0'"]
    assert any("nothing of Y, Z, K, M, N can be identified" in s for s in still.statements)
    rng = np.random.default_rng(1)
    for name in ("v [m/s]", "r [rad/s]"):
        values[:, head.index(name)] = 0.02 * rng.standard_normal(len(values))
    found = identify_from([write(tmp_path / "noise.csv", head, values)], FILE, {})
    assert found["Nr"].outcome is Outcome.NOT_IDENTIFIABLE
    assert found["Nr"].value is None
    assert "r does not move beyond noise" in found["Nr"].why
    assert {t.symbol for t in found.found} == {"X0'"}
    assert error(found, "X0") < 5e-3


def test_a_steady_turn_does_not_tell_its_terms_apart(tmp_path: Path) -> None:
    options = {"rudder": "25 deg", "turns": 3.0}
    motion = simulate(FILE, "turning_circle", options, {"record": 0.02}, free=("u", "v", "r")).trajectory
    (tmp_path / "turn.csv").write_bytes(motion_csv(motion))
    head, values = columns(tmp_path / "turn.csv")
    write(tmp_path / "turn.csv", head, values[values[:, 0] > values[-1, 0] - 60.0])
    (tmp_path / "noisy").mkdir()
    found = identify_from(noisy([tmp_path / "turn.csv"], tmp_path / "noisy", 0.01, 1), FILE, {"window": "1 s"})
    for component in "YN":
        known = [t for t in found.terms if t.component == component and t.outcome is Outcome.IDENTIFIED]
        assert not known


def test_positions_alone_identify_nothing(clean: list[Path], tmp_path: Path) -> None:
    """u v r of noisy x, y, psi share their noise from row to row: values without an interval are no identified ones."""
    rng, files = np.random.default_rng(7), []
    for file in clean[:2]:
        head, values = columns(file)
        names = {"t [s]": ("t [s]", 0.0), "north [m]": ("x [m]", 0.005), "east [m]": ("y [m]", 0.005), "psi [rad]": ("psi [rad]", 1e-3),
                 "dr [rad]": ("dr [rad]", 0.0), "thrust [N]": ("thrust [N]", 0.0)}  # fmt: skip
        rows = values[::5][:, [head.index(n) for n in names]]
        rows = rows + rng.standard_normal(rows.shape) * [level for _, level in names.values()]
        files.append(write(tmp_path / file.name, [new for new, _ in names.values()], rows))
    found = identify_from(files, FILE, {})
    assert found.found
    assert {t.outcome for t in found.found} <= {Outcome.BIASED, Outcome.EXCHANGEABLE}
    assert found.failed
    assert not [f for f in found.findings if f.code == "record.held"]  # it compares with intervals
    assert all(t.low is None and t.verdict is Verdict.NONE for t in found.terms)
    assert not any("removes the bias" in s or s.startswith("Interval") for s in found.statements)
    assert "biased" in identified_figure(found, "here").svg


def test_units_of_the_file_do_not_matter(clean: list[Path], tmp_path: Path) -> None:
    other = []
    for file in noisy(clean[1:4], tmp_path, 0.01, 5):
        head, values = columns(file)
        names = {"u [m/s]": ("u [kn]", 3600.0 / 1852.0), "r [rad/s]": ("r [deg/s]", 180.0 / np.pi)}
        for name, (new, scale) in names.items():
            k = head.index(name)
            values[:, k] *= scale
            head[k] = new
        other.append(write(tmp_path / f"other_{file.name}", head, values))
    one, two = (identify_from(f, FILE, {}) for f in ([tmp_path / f.name for f in clean[1:4]], other))
    assert [t.outcome for t in one.terms] == [t.outcome for t in two.terms]
    for a, b in zip(one.found, two.found, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-6)
        assert (a.low is None) == (b.low is None) == (a.outcome is Outcome.EXCHANGEABLE)
        if a.low is not None:
            assert a.low == pytest.approx(b.low, rel=1e-5)


def without(file: ParameterFile, ending: str) -> ParameterFile:
    left = tuple(c for c in file.coefficients if not c.symbol.endswith(ending))
    return file.model_copy(update={"coefficients": left})


def test_an_unknown_added_mass_is_found_where_a_known_force_sets_the_scale(clean: list[Path]) -> None:
    unknown = without(FILE, "dot'")
    found = identify_from(clean, unknown, {})
    assert error(found, "Xudot") < 0.02
    assert error(found, "X0") < 2e-3
    assert any(s.startswith("N, Y: the added mass is not known") for s in found.statements)
    with pytest.raises(InputError, match="without a known force along N"):
        identify_from(clean, unknown, {"terms": "Nr Nrdot"})


def test_uneven_steps_give_the_same(clean: list[Path], tmp_path: Path) -> None:
    rng, files = np.random.default_rng(2), []
    for file in clean:
        head, values = columns(file)
        files.append(write(tmp_path / file.name, head, values[rng.random(len(values)) < 0.7]))
    found = identify_from(files, FILE, {})
    for component, symbols in LATERAL.items():
        assert kept(found, component) == symbols
        assert max(error(found, s) for s in symbols) < 1e-2


def test_a_gap_is_no_filter_and_a_rudder_of_the_other_sign_is_named(clean: list[Path], tmp_path: Path) -> None:
    """Before: no intervals, "as a filter leaves it"; Ndr' of the other sign than the file's without a word."""
    files = []
    for file in noisy(clean, tmp_path, 0.01, 2):
        head, values = columns(file)
        values[:, head.index("dr [rad]")] *= -1.0
        files.append(write(file, head, np.delete(values, slice(400, 500), axis=0)))
    found = identify_from(files, FILE, {"terms": "file"})
    assert found["Ndr"].half
    assert found["Ndr"].value == pytest.approx(-TRUE["Ndr"], rel=0.03)
    opposite = [f for f in found.findings if f.code == "record.opposite"]
    assert [f["columns"] for f in opposite] == [("Ydr'", "Ndr'")]
    assert not [f for f in identify_from(clean[:2], FILE, {"terms": "file"}).findings if f.code == "record.opposite"]


def test_verdicts_against_u95(clean: list[Path]) -> None:
    widths = {"Yv'": 1e-3, "Nr'": 1e-12}
    shifted = {"Ydr'": 0.013}
    changed = tuple(
        replace(c, u95=widths.get(c.symbol, 1e-4 if c.symbol in shifted else None), value=shifted.get(c.symbol, c.value))
        for c in FILE.coefficients
    )  # fmt: skip
    found = identify_from(clean, FILE.model_copy(update={"coefficients": changed}), {})
    assert found["Yv"].verdict is Verdict.WITHIN
    assert found["Ydr"].verdict is Verdict.OUTSIDE
    assert found["Nv"].verdict is Verdict.NO_U95
    assert found["Yr|r|"].verdict is Verdict.NONE
    drawing = identified_figure(found, "a")
    assert "Yv\u2032" in re.sub("<[^>]*>", "", drawing.svg)
    assert "Yv' identified" in drawing.description


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"terms": "Zw"}, "the series have no other motion"),
        ({"terms": "Yvdotr"}, "an acceleration by itself"),
        ({"terms": "nonsense"}, "SNAME"),
        ({"window": "500 s"}, "0 stretches of 2e+03 s"),
        ({"resamples": 3}, "resamples"),
    ],
)
def test_refusals(clean: list[Path], options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError) as why:
        identify_from(clean[:1], FILE, options)
    assert words in str(why.value)


def test_the_vertical_plane_with_weight_and_buoyancy(tmp_path: Path) -> None:
    file = made({**TRUE, "Zw|w|": -0.05, "Zwdot": -1.2e-2, "Mqdot": -8e-4}, metacentric=0.02)
    file = file.model_copy(update={"surfaces": (ParameterSurface(control="ds", limit=0.7, rate=0.3),)})
    for k, planes in enumerate((8, 12, 16, 20, 24)):
        options = {"planes": f"{planes} deg", "pitch": f"{planes / 2} deg", "way": "rise" if k % 2 else "dive"}
        motion = simulate(file, "depth_change", options, {"record": 0.02}, free=("u", "w", "q")).trajectory
        (tmp_path / f"{k}.csv").write_bytes(motion_csv(motion))
    files = [tmp_path / f"{k}.csv" for k in range(5)]
    found = identify_from(files, file, {"terms": "Zw Zq Zw|w| Zds Mw Mq Mds"})
    for symbol in ("Zw", "Zds", "Mw", "Mq", "Mds"):
        value = found[symbol].value
        assert value == pytest.approx(TRUE[symbol], rel=0.03), symbol
    head, values = columns(files[0])
    keep = [k for k, name in enumerate(head) if name != "theta [rad]"]
    with pytest.raises(InputError, match="no column theta"):
        identify_from([write(tmp_path / "flat.csv", [head[k] for k in keep], values[:, keep])], file, {})
