"""Export then import returns every representable term to 1e-12: published vehicles and SUBOFF, every format that is read."""

from __future__ import annotations

import inspect
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from coeflab.formats import EXPORTERS, PARAMETER_IMPORTERS
from coeflab.formats.xdyn import write as xdyn
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import derivative
from coeflab.law.transforms import derivative_transfer, moved
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.inertia import centre_of_gravity, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import SURGE, second_order
from tests.formats.files import slopes_alone
from tests.formats.vehicles import FACTS, vehicle

READ_BY = {
    "gazebo": "gazebo",
    "gazebo_plugin": "gazebo",
    "mss": "mss",
    "uuv_simulator": "uuv_simulator",
    "xdyn": "xdyn",
}
EVERYTHING = ("mss", "xdyn")
NAMES = [*FACTS, "suboff_fully_appended", "suboff_bare_hull", "suboff_bare_hull_cfd"]
# All coefficients but accelerations and controls.
SECOND_ORDER = {
    "bluerov2_heavy": 9, "lauv": 20, "nps_auv2": 67 - 14, "torpedo_imperial": 5,
    "suboff_fully_appended": 17, "suboff_bare_hull": 7, "suboff_bare_hull_cfd": 9,
}  # fmt: skip


def is_acceleration(c: Coefficient) -> bool:
    return any(f.endswith("dot") for f in derivative(c.symbol).factors)


def stated(file: ParameterFile) -> dict[str, Coefficient]:
    """Coefficients with a value other than zero; accelerations are compared as a matrix."""
    return {c.symbol.removesuffix("'"): c for c in file.coefficients if c.value and not is_acceleration(c)}


def lost(target: str, file: ParameterFile) -> set[str]:
    """First words of what a target says it does not hold."""
    return {said.split()[0] for said in EXPORTERS.load(target).not_held(file)}


def alias(symbol: str) -> str:
    """What gz-sim calls a force at straight motion: X0 is whole, the others are u^2. It turns |v| r to r |v|."""
    if symbol[1:] == "0" and symbol[0] != "X":
        return f"{symbol[0]}uu"
    bars, _, plain = symbol[1:].rpartition("|")
    return f"{symbol[0]}{plain}{bars}|" if bars and plain else symbol


def round_trip(target: str, file: ParameterFile, folder: Path) -> ParameterFile:
    for name, content in EXPORTERS.load(target).render(file).items():
        (folder / name).write_bytes(content)
    importer: ModuleType = PARAMETER_IMPORTERS.load(READ_BY[target])
    known = {"density": file.conditions.density, "length": file.scaling.length, "speed": file.conditions.speed}
    takes = inspect.signature(importer.read).parameters
    return importer.read(folder / name, **{k: v for k, v in known.items() if k in takes})


def same_inertia(back: ParameterFile, file: ParameterFile) -> None:
    """Mass, its centre and what is known of its moments."""
    assert back.mass.mass == pytest.approx(file.mass.mass, rel=1e-12)
    np.testing.assert_allclose(centre_of_gravity(back), centre_of_gravity(file), rtol=1e-12, atol=1e-15)
    if file.mass.inertia_matrix is not None and back.mass.inertia_matrix is not None:
        scale = np.max(file.mass.inertia_matrix)
        np.testing.assert_allclose(back.mass.inertia_matrix, file.mass.inertia_matrix, rtol=1e-12, atol=1e-13 * scale)


@pytest.fixture(params=NAMES)
def file(request: pytest.FixtureRequest) -> ParameterFile:
    if request.param in FACTS:
        return vehicle(request.param)
    study: Study = request.getfixturevalue("suboff")
    return slopes_alone(study.parameter_files[request.param])


def test_every_importer_is_tried() -> None:
    assert {*READ_BY.values(), "stonefish"} == set(
        PARAMETER_IMPORTERS.names()
    )  # a scenario holds no force law to come back
    assert set(READ_BY) >= {t for t in EXPORTERS.names() if t in PARAMETER_IMPORTERS.names()} - {"stonefish"}


@pytest.mark.parametrize("target", ["gazebo", "gazebo_plugin", "mss", "xdyn"])
def test_every_representable_term_comes_back(target: str, file: ParameterFile, tmp_path: Path) -> None:
    back, without = round_trip(target, file, tmp_path), lost(target, file)
    held = {s: c for s, c in stated(file).items() if s not in without}
    returned = stated(back)
    for symbol, c in held.items():
        name = symbol if target in EVERYTHING else alias(symbol)
        assert name in returned, symbol
        same = returned[name]
        if c.law == "rest" and "|" not in symbol:
            assert (same.law, same.value_si) == ("rest", pytest.approx(c.value_si, rel=1e-12)), symbol
        else:
            assert same.value == pytest.approx(c.value, rel=1e-12), symbol
    assert len(held) == (len(stated(file)) if target in EVERYTHING else SECOND_ORDER[file.name])
    wanted = water_inertia(file).matrix
    np.testing.assert_allclose(water_inertia(back).matrix, wanted, rtol=1e-12, atol=1e-13 * np.max(wanted))
    if target == "xdyn" and file.mass is not None and file.mass.inertia_matrix is None:
        assert any(said.startswith("Rigid-body inertia: the parameter file has no") for said in xdyn.missing(file))
    else:
        same_inertia(back, file)


def linear_and_products(file: ParameterFile) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forces linear in the velocities, products with u or U, and own quadratic damping, as uuv_simulator has them."""
    form = second_order(force_law(file))
    products = form.signed[:, SURGE, :].copy()
    products[:, 1:] += form.absolute[:, 1:, SURGE]
    return form.linear, products, np.einsum("iii->i", form.absolute)


def test_uuv_simulator_about_its_centre_of_gravity(file: ParameterFile, tmp_path: Path) -> None:
    """The plugin's force acts at the centre of gravity: what comes back is stated there, and moved to the reference point."""
    back = round_trip("uuv_simulator", file, tmp_path)
    left, right = derivative_transfer(-centre_of_gravity(file))
    linear, products, quadratic = linear_and_products(back)
    moved_products = left @ products @ right
    moved_products[:, 1:] += np.outer(left @ products[:, SURGE], right[SURGE, 1:])
    for found, wanted in zip(
        (left @ linear @ right, moved_products, quadratic), linear_and_products(file), strict=True
    ):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12 * max(np.max(np.abs(wanted)), 1e-300))
    wanted = water_inertia(file).matrix
    found = moved(water_inertia(back).matrix, -centre_of_gravity(file))
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12 * np.max(wanted))
    assert np.count_nonzero(np.hstack(linear_and_products(file)[:2])) >= 2
    names = {s for s in stated(file) if s not in lost("uuv_simulator", file)}
    assert len(names) >= 2


@pytest.mark.parametrize("name", FACTS)
def test_the_facts_are_those_of_the_model_files(name: str) -> None:
    """Vehicles that are also kept as a model file: both were typed by themselves."""
    kept = {
        "bluerov2_heavy": ("xdyn", "bluerov2_heavy.yml"), "lauv": ("uuv_simulator", "lauv.urdf.xacro"),
        "nps_auv2": ("mss", "nps_auv2.m"), "torpedo_imperial": ("mss", "torpedo_imperial.m"),
    }  # fmt: skip
    importer, path = kept[name]
    read = PARAMETER_IMPORTERS.load(importer).read(Path(__file__).parent / "data" / path)
    ours = stated(vehicle(name))
    for symbol, c in stated(read).items():
        assert ours[symbol].value_si == pytest.approx(c.value_si, rel=1e-12), symbol
    if name != "lauv":
        assert set(ours) == set(stated(read))
    np.testing.assert_allclose(water_inertia(read).matrix, water_inertia(vehicle(name)).matrix, rtol=1e-9)
