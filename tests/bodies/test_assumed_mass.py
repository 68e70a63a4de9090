"""What Roddy does not print of SUBOFF's mass: stated as assumed, and with the number everywhere."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.texts import words
from coeflab.formats.export import export
from coeflab.study.study import Study

FOOT, LBP, DIAMETER = 0.3048, 13.9792, 1.6667  # ft
# Roddy 1990, Table 2, report p. 16: station 20 x / LBP, A / Amax.
STATIONS = [
    0.0,
    0.1,
    0.2,
    0.3,
    0.4,
    0.5,
    0.6,
    0.7,
    1.0,
    2.0,
    3.0,
    4.0,
    7.7143,
    10.0,
    15.1429,
    16.0,
    17.0,
    18.0,
    19.0,
    20.0,
    20.4167,
]
AREAS = [0.0, 0.08444, 0.15520, 0.21715, 0.27194, 0.32066, 0.36424, 0.40340, 0.50047, 0.71763, 0.88484, 0.98570, 1.0, 1.0, 1.0,
         0.95253, 0.67093, 0.30278, 0.07201, 0.01375, 0.0]  # fmt: skip
BODY = shipped("geometry") / "suboff" / "body.toml"


def test_the_gyradius_is_that_of_the_printed_offsets() -> None:
    """A disc of area A has A^2 / (2 pi) about its axis."""
    x, a = np.array(STATIONS) * LBP / 20.0, np.array(AREAS) * np.pi / 4.0 * DIAMETER**2
    gyradius = FOOT * np.sqrt(np.trapezoid(a**2 / (2.0 * np.pi), x) / np.trapezoid(a, x))
    mass = read_body(BODY).require("suboff_bare_hull").mass
    assert np.sqrt(mass.inertia_matrix[0, 0] / mass.mass) == pytest.approx(gyradius, rel=5e-4)


@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull"])
def test_mass_and_centres_are_those_of_table_1(suboff: Study, name: str) -> None:
    """m', x_G' m' and I' of Table 1; neutral, since m' is that of the printed buoyancy; BG is the printed VCB, .006669 ft."""
    buoyancy, moment, inertia, bg = {
        "suboff_fully_appended": (1556.2363, -0.127467e-4, 0.001084, 0.006669),
        "suboff_bare_hull": (1537.6841, 0.388697e-4, 0.001053, 0.0),
    }[name]
    file = suboff.parameter_files[name]
    mass, h = file.mass, file.hydrostatics
    pounds, half = 0.45359237, 0.5 * 62.27456 * 0.45359237 / FOOT**3
    length = LBP * FOOT
    assert mass.mass == pytest.approx(buoyancy * pounds, rel=1e-4)
    assert h.volume * file.conditions.density == pytest.approx(buoyancy * pounds, rel=1e-5)
    assert mass.centre[0] * mass.mass == pytest.approx(moment * half * length**4, rel=1e-9)
    assert np.diag(mass.inertia_matrix)[1:] == pytest.approx([inertia * half * length**5] * 2, rel=1e-9)
    assert (mass.centre - np.array(h.centre_of_buoyancy))[2] == pytest.approx(bg * FOOT, abs=1e-12)
    apart = {"suboff_fully_appended": 0.0, "suboff_bare_hull": 0.0048}[
        name
    ]  # m: x_G' m' and LCB of Table 1 as they are printed
    assert mass.centre[0] - h.centre_of_buoyancy[0] == pytest.approx(apart, abs=1e-4)


def test_what_is_assumed_goes_with_the_number(suboff: Study) -> None:
    file = suboff.parameter_files["suboff_fully_appended"]
    (found,) = [f for f in file.findings if f.code == "assumed.mass"]
    assert (found["gyradius"], found["below"]) == (0.1728, 0.0)
    assert found.statistic == pytest.approx(705.91 * 0.1728**2, rel=1e-4)
    said = words(found).statement
    assert said in file.remarks
    for target in ("xdyn", "python_vehicle_simulator", "mss", "c"):
        made = export(file, target, accept_loss=True)
        assert any(said in c.decode(errors="ignore") for n, c in made.files.items() if not n.endswith(".loss.txt")), (
            target
        )


@pytest.mark.parametrize(
    ("key", "value", "column"),
    [
        ("roll_gyradius", '"3 m"', "assumed_mass.roll_gyradius"),
        ("roll_gyradius", '"0 m"', "assumed_mass.roll_gyradius"),
        ("centre_of_gravity_below", '"1 kg"', "assumed_mass.centre_of_gravity_below"),
    ],
)
def test_what_no_body_has_is_refused(tmp_path: Path, key: str, value: str, column: str) -> None:
    shutil.copy(BODY, tmp_path / "body.toml")
    text = (tmp_path / "body.toml").read_text()
    line = next(one for one in text.splitlines() if one.startswith(f"{key} ="))
    (tmp_path / "body.toml").write_text(text.replace(line, f"{key} = {value}"))
    with pytest.raises(InputError) as refused:
        read_body(tmp_path / "body.toml")
    assert refused.value.column == column
    assert refused.value.line


def test_of_no_printed_inertia_nothing_is_assumed(tmp_path: Path) -> None:
    text = "\n".join(one for one in BODY.read_text().splitlines() if not one.startswith("inertia_prime"))
    (tmp_path / "body.toml").write_text(text)
    with pytest.raises(InputError, match="inertia_prime"):
        read_body(tmp_path / "body.toml")


def test_a_centre_below_gives_a_product_of_inertia(tmp_path: Path) -> None:
    """I_xz of the matrix is -m x_G z_G, and I_xx has m z_G^2; about the centre of gravity neither is left."""
    text = BODY.read_text().replace('below = "0 m"', 'below = "0.02 m"')
    (tmp_path / "body.toml").write_text(text)
    mass = read_body(tmp_path / "body.toml").require("suboff_bare_hull").mass
    own = mass.moved(mass.centre)
    assert own.inertia_matrix[0, 2] == pytest.approx(0.0, abs=1e-9)
    assert own.inertia_matrix[0, 0] == pytest.approx(mass.mass * 0.1728**2, rel=1e-9)
    assert mass.inertia_matrix[0, 2] == pytest.approx(-mass.mass_moment * 0.02)
    assert mass.centre[2] == 0.02
