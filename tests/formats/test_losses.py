"""What every simulator loses beside terms: inertia, accelerations, another body, other water, fitted tables, names."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.types import Array
from coeflab.formats import EXPORTERS, SimulatorExporter, SteeredExporter
from coeflab.formats.export import export
from coeflab.formats.loss import LOSSLESS, covered_grid, loss_of
from coeflab.formats.loss_tables import in_short, percent
from coeflab.formats.missing_parts import Kind, missing_mass, missing_water
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.model import parameter_file as huuv_file
from coeflab.published.huuv.model import read_huuv
from coeflab.vehicle.force_law import force_law, motion_law
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats import files as made
from tests.formats.massed import ADDED, VALUES, torpedo, with_mass
from tests.vehicle.test_force_law import HULL, LENGTH, parameters

TARGETS = [n for n in EXPORTERS.names() if isinstance(EXPORTERS.load(n), SimulatorExporter)]
NEED_MASS = [
    "fmi",
    "gazebo",
    "gazebo_plugin",
    "mujoco",
    "python_vehicle_simulator",
    "stonefish",
    "uuv_simulator",
    "xdyn",
]


def each_target(test: Any) -> Any:
    """What is lost by each, over a few states."""
    return pytest.mark.usefixtures("few_states")(pytest.mark.parametrize("target", TARGETS)(test))


def lost(file: ParameterFile, target: str, kind: Kind, accelerations: str = "measured") -> list[str]:
    loss = export(file, target, accelerations).loss
    return [x.what for x in loss.lost if x.kind is kind]


def with_added(file: ParameterFile, **changed: object) -> ParameterFile:
    assert file.added_mass is not None
    return file.model_copy(update={"added_mass": replace(file.added_mass, **changed)})


@each_target
def test_a_whole_file_lacks_nothing(target: str) -> None:
    loss = export(torpedo(), target).loss
    assert loss.lost == ()


@pytest.mark.parametrize("target", NEED_MASS)
def test_a_mass_that_is_needed_and_not_there_is_a_loss(target: str) -> None:
    file = made.plain()
    if target in ("fmi", "xdyn"):  # nothing would move
        with pytest.raises(InputError, match="no mass"):
            export(file, target)
        return
    (said,) = lost(file, target, Kind.MISSING)
    assert "inertia" in said
    made_of = export(file, target)
    assert not made_of.lossless
    assert said in next(c for n, c in made_of.files.items() if n.endswith(".loss.txt")).decode()


def test_the_transverse_moment_alone_leaves_the_roll_inertia_open() -> None:
    file = torpedo()
    assert file.mass is not None
    one = file.model_copy(update={"mass": replace(file.mass, inertia=14.0, inertia_matrix=None)})
    none = file.model_copy(update={"mass": replace(file.mass, inertia_matrix=None)})
    assert missing_mass(file, "x") == ()
    assert missing_mass(one, "x")[0].startswith("roll inertia: the file has the transverse one alone")
    assert missing_mass(none, "x") == ("moments of inertia: the file has none; x",)


def test_added_mass_that_is_not_there_is_a_loss() -> None:
    bare, some = with_mass(parameters(VALUES)), with_mass(parameters({**VALUES, "Yvdot": -0.01, "Nrdot": -1e-3}))
    assert missing_water(bare) == ("added mass: the file has none; the vehicle accelerates as if in air",)
    assert missing_water(some) == ("added mass in surge, heave, roll, pitch: not in the file; zero is written",)
    for target in ("gazebo", "mss", "xdyn"):
        assert lost(bare, target, Kind.MISSING) == list(missing_water(bare))
        assert not export(bare, target).lossless


@each_target
def test_a_measured_acceleration_that_gives_way_is_a_loss_with_both_values(target: str) -> None:
    """-Yvdot of 600 kg at 1/2 rho L^3 = 4000 kg is -0.15."""
    file = with_mass(parameters({**VALUES, "Yvdot": -0.12, "Nrdot": -72.0 / (500.0 * LENGTH.length**5)}, HULL))
    assert lost(file, target, Kind.REPLACED) == []
    (said,) = lost(file, target, Kind.REPLACED, "computed")
    assert said == "Yvdot' -0.12 (fit) is not used: the added mass of body of tow by ellipsoid has -0.15, 1.25 times it"
    assert not export(file, target, "computed").lossless


@each_target
def test_an_added_mass_of_another_body_is_a_loss(target: str) -> None:
    file = with_added(torpedo(), body="AFF-8")
    (said,) = lost(file, target, Kind.MISMATCH)
    assert said.startswith("the added mass is that of AFF-8, the coefficients are those of body of tow")
    found = export(file, target)
    assert not found.lossless
    assert "mismatch: the added mass is that of AFF-8" in in_short(found.loss)


@each_target
def test_added_mass_of_other_water_is_converted_and_said(target: str) -> None:
    """1.5 times the matrix for 1.5 times the density is the same vehicle in the same water."""
    file = torpedo()
    other = with_added(file, density=1500.0, matrix=tuple(tuple(row) for row in (1.5 * ADDED).tolist()))
    again = ParameterFile.model_validate_json(other.model_dump_json())
    nu = np.random.default_rng(3).normal(size=(20, 6))
    to = EXPORTERS.load(target)
    np.testing.assert_allclose(to.force(to.render(again), nu), to.force(to.render(file), nu), rtol=1e-9, atol=1e-9)
    mine, theirs = export(file, target).loss, export(again, target).loss
    assert lost(again, target, Kind.REPLACED) == []
    (said,) = set(theirs.changes) - set(mine.changes)
    assert said.startswith("the added mass of body of tow is stated for 1500 kg/m^3 and multiplied by 0.666667")


def test_fitted_tables_over_two_angles_are_not_held_by_simulators() -> None:
    """C_D and C_n over alpha and beta are lost; the curve of Y' stands as its coefficients."""
    file = with_mass(read_parameter_file(Path(__file__).parents[1] / "data" / "parameters_1_1.json"))
    said = lost(file, "xdyn", Kind.NOT_HELD)
    assert [s.split(" (")[0] for s in said] == ["C_D over alpha, beta", "C_n over alpha, beta"]
    assert "the targets csv and toml contain the table" in said[0]
    assert any("hydrodynamic polar" in c and "one angle" in c for c in export(file, "xdyn").loss.changes)
    assert export(file, "toml").lossless


@pytest.mark.parametrize("target", TARGETS)
def test_a_file_of_tables_alone_is_no_proof_of_an_export_without_them(target: str) -> None:
    """The HUUV's drag and side force are tables: a target that is given none of them is not near the file."""
    file = huuv_file(read_huuv())
    refused = {"mujoco": "no added mass along x, y and z", "xdyn": "no mass.centre and mass.inertia_matrix"}
    if target in refused:
        with pytest.raises(InputError, match=refused[target]):
            export(file, target)
        return
    loss = export(file, target).loss
    ours = vehicle(file, free=("u", "v", "r")).law
    nu, _ = covered_grid(file)
    assert np.ptp(nu[:, 5]) > 0.0
    np.testing.assert_allclose(loss.largest, np.abs(ours.force(nu, np.zeros((len(nu), 3)))).max(axis=0), rtol=1e-12)
    assert loss.largest[0] > 1.0
    if "tables" in EXPORTERS.load(target).holds:
        assert loss.relative.max() < 1e-12
        return
    assert loss.relative[0] > 0.9
    assert loss.relative[1] > 0.5
    assert "the file's force with its fitted tables" in loss.grid


@pytest.mark.parametrize(("target", "name"), [("mss", "sin"), ("mss", "class"), ("python_vehicle_simulator", "print")])
def test_a_name_that_is_taken_is_changed_and_said(target: str, name: str) -> None:
    found = export(made.named(name), target)
    assert any(n.startswith(f"vehicle_{name}.") for n in found.files)
    assert f"{name}.{target}.loss.txt" in found.files
    assert any(c.startswith(f'files are called vehicle_{name}: of the name "{name}"') for c in found.loss.changes)


@pytest.mark.usefixtures("few_states")
@pytest.mark.parametrize("name", made.HOSTILE)
@pytest.mark.parametrize("target", [*TARGETS, "csv", "toml"])
def test_no_name_leads_out_of_the_folder(target: str, name: str) -> None:
    found = export(with_mass(made.named(name)), target)
    for path in (*found.files, found.folder or "x"):
        assert Path(path).name == path
        assert path.isprintable()
        assert not path.startswith(".")
        assert len(path.encode()) < 200


def test_a_plugin_that_uses_the_name_as_it_is_names_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.formats.mss.write.render", lambda p: {f"{p.name}.m": b""})
    with pytest.raises(InputError) as caught:
        export(made.named("../a"), "mss")
    assert caught.value.column == "name"


def test_a_force_that_is_worse_than_none_is_said() -> None:
    """HoloOcean's drag in drift is several times this torpedo's resistance."""
    loss = export(torpedo(), "holoocean").loss
    nu, _ = covered_grid(torpedo())
    ours = force_law(torpedo()).force(nu)
    worse = [c for c, r, o in zip("XYZKMN", loss.rms, np.sqrt((ours**2).mean(axis=0)), strict=True) if r > o]
    assert list(loss.worse_than_nothing) == worse
    assert worse == ["X"]
    text = export(torpedo(), "holoocean").files["file.holoocean.loss.txt"].decode()
    assert text.count("worse than no force at all: ") == len(worse)
    assert export(torpedo(), "xdyn").loss.worse_than_nothing == ()


def test_a_component_next_to_nothing_is_not_called_worse_than_none() -> None:
    """X, which HoloOcean's drag misses by more than itself, less than a hundredth of the largest force."""
    loss = export(torpedo(), "holoocean").loss
    assert loss.worse_than_nothing == ("X",)
    share = 0.009 * loss.forces.largest.max() / loss.forces.largest[0]
    faint = {name: np.array(getattr(loss.forces, name)) for name in ("largest", "worst", "rms", "size")}
    for values in faint.values():
        values[0] *= share
    small = replace(loss, forces=replace(loss.forces, **faint))
    assert small.too_small == ("X",)
    assert small.worse_than_nothing == ()


STEERED = [n for n in TARGETS if isinstance(EXPORTERS.load(n), SteeredExporter)]


@pytest.mark.usefixtures("few_states")
@pytest.mark.parametrize("target", STEERED)
def test_controls_are_among_what_is_compared(target: str) -> None:
    """A rudder of the other sign in the target's law shows, and so does one that is not read."""
    file = read_parameter_file(Path("remus100"))
    plugin = EXPORTERS.load(target)
    assert isinstance(plugin, SteeredExporter)
    rendered = plugin.render(file)

    def apart(force: Callable[[Mapping[str, bytes], Array, Array], Array]) -> float:
        loss = loss_of(target, file, rendered, plugin.force, (), (), (), water_inertia(file), None, force)
        assert loss.controls[0] == (
            "controls: each state also with dr -0.35 and 0.35 rad, ds -0.35 and 0.35 rad, one at a time"
        )
        return float(loss.relative[5])

    across = target in (
        "gazebo",
        "gazebo_plugin",
    )  # LiftDrag pushes across the stream: N of the largest drift loses cos(beta)
    assert apart(plugin.steered_force) <= (0.02 if across else LOSSLESS)
    assert apart(lambda files, nu, controls: plugin.steered_force(files, nu, -controls)) > 0.1
    assert apart(lambda files, nu, _: plugin.force(files, nu)) > 0.1


def test_a_rudder_astern_is_among_what_is_compared() -> None:
    """LiftDrag of gazebo has no force in a flow from behind: all of N by the rudder is lost there; MSS has it."""
    file = read_parameter_file(Path("remus100"))
    backwards, controls = np.array([[-file.conditions.speed, *[0.0] * 5]]), np.array([[0.35, 0.0, 0.0]])
    lost = abs(motion_law(file)[0].force(backwards, controls)[0, 5])
    loss = export(file, "gazebo").loss
    assert loss.rare.worst[5] >= lost > 0.0
    assert in_short(loss).endswith(f"N up to {percent(loss.rare.relative[5])} astern, broadside and at rest")
    assert export(file, "mss").loss.rare.furthest[1] <= LOSSLESS


@each_target
def test_what_a_control_does_stands_in_every_export(target: str) -> None:
    made_of = export(read_parameter_file(Path("remus100")), target)
    report = next(c for n, c in made_of.files.items() if n.endswith(".loss.txt")).decode()
    for said in ("dr > 0: turns to port (Ndr < 0)", "ds > 0: bow down (Mds < 0)"):
        assert said in report
        if target in STEERED and target not in ("c", "fmi"):  # as comments of C, and in the zip
            assert any(said in c.decode() for n, c in made_of.files.items() if not n.endswith(".loss.txt"))
    assert ("controls: dr, ds not held" in report) == (target not in STEERED)


def test_the_unit_says_what_its_inputs_do() -> None:
    (content,) = (
        c for n, c in export(read_parameter_file(Path("remus100")), "fmi").files.items() if n.endswith(".fmu")
    )
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert 'description="dr &gt; 0: turns to port (Ndr &lt; 0)"' in archive.read("modelDescription.xml").decode()


def test_products_of_the_ideal_fluid_are_named_only_where_they_are_written() -> None:
    """REMUS 100 for MSS: no h.ideal stands in the file, and the report named it."""
    seen = set()
    for file in (read_parameter_file(Path("remus100")), with_mass(made.full(3))):
        for target, written in (("mss", "h.ideal."), ("xdyn", "_ideal")):
            out = export(file, target, accept_loss=True)
            program = b"".join(c for n, c in out.files.items() if not n.endswith(".loss.txt")).decode()
            named = any("products of the ideal fluid" in c for c in out.loss.changes)
            assert named == (written in program), (file.name, target)
            seen.add(named)
    assert seen == {True, False}
