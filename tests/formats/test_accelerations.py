"""What a target integrates is what ``simulate`` integrates: accelerations evaluated from the written files alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from coeflab.core.text.xml import parse_xml
from coeflab.core.text.yaml import parse_yaml
from coeflab.formats import EXPORTERS, InertialExporter
from coeflab.formats.export import Export, export
from coeflab.formats.gazebo.law import read_gz_link
from coeflab.formats.loss import LOSSLESS
from coeflab.formats.loss_tables import forces, in_short, parts
from coeflab.formats.uuv_simulator.law import read_fossen_link
from coeflab.formats.xdyn.law import xdyn_body
from coeflab.law.added_mass import potential_part
from coeflab.law.rigid_body import parallel_axis, rigid_body_force, rigid_body_inertia
from coeflab.law.transforms import moved
from coeflab.motion.manoeuvre import UPRIGHT
from coeflab.motion.vehicle import vehicle
from coeflab.report.sections import exports as export_section
from coeflab.study.study import Study
from coeflab.vehicle.inertia import water_inertia, with_accelerations
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.massed import with_mass
from tests.vehicle.test_inertia import accelerating

few_states = pytest.mark.usefixtures("few_states")

Array = np.ndarray
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
TARGETS = ["fmi", "gazebo", "gazebo_plugin", "mss", "python_vehicle_simulator", "uuv_simulator", "xdyn"]
# Ahead, turning at will: with no drift u is U, so that targets of second order have the file's own law.
STATES = np.array([[2.0, 0.0, 0.0, 0.0, 0.0, 0.0], [1.5, 0.0, 0.0, 0.1, -0.2, 0.3], [2.5, 0.0, 0.0, 0.0, 0.0, -0.4]])
PUSH = np.array([3.0, -20.0, 10.0, 0.5, 7.0, -9.0])
AHEAD = np.array(
    [0.15, 0.0, 0.0]
)  # of gravity, where uuv_simulator, without products of two rates, loses nothing in yaw
both = pytest.mark.parametrize("accelerations", ["measured", "computed"])


def content(files: Mapping[str, bytes], suffix: str) -> str:
    return next(c for n, c in files.items() if n.endswith(suffix)).decode()


def of_sdf(files: Mapping[str, bytes]) -> tuple[float, Array, Array, Array]:
    """Mass, centre, inertia and added mass about the link's origin, FRD, as gz-sim integrates them."""
    link = read_gz_link(parse_xml(content(files, ".sdf")))
    centre, central = FLU[:3] * link.centre, link.inertia * np.outer(FLU[:3], FLU[:3])
    added = (link.fluid_mass if link.disable_added_mass else link.fluid_mass - link.plugin_mass) * np.outer(FLU, FLU)
    return link.mass, centre, central + parallel_axis(link.mass, centre), added


def of_urdf(files: Mapping[str, bytes]) -> tuple[float, Array, Array, Array]:
    link = read_fossen_link(parse_xml(content(files, ".urdf")))
    centre = link.centre - link.reference
    return link.mass, centre, link.inertia + parallel_axis(link.mass, centre), moved(link.added_mass, link.reference)


def of_xdyn(files: Mapping[str, bytes]) -> tuple[float, Array, Array, Array]:
    body = xdyn_body(parse_yaml(content(files, ".yml"), "file"), "file")
    centre, mass = body.centre - body.manoeuvring[0].point, body.rigid[0, 0]
    return mass, centre, body.rigid[3:, 3:] + parallel_axis(mass, centre), moved(body.added, -centre)


READERS: dict[str, Callable[[Mapping[str, bytes]], tuple[float, Array, Array, Array]]] = {
    "gazebo": of_sdf, "gazebo_plugin": of_sdf, "uuv_simulator": of_urdf, "xdyn": of_xdyn,
}  # fmt: skip


def accelerations_written(target: str, files: Mapping[str, bytes], known: tuple[int, ...]) -> Array:
    """Rates of u v w p q r in every state, at rest in the water's frame of attitude, pushed: from the files alone."""
    mass, centre, inertia, added = READERS[target](files)
    plugin: Any = EXPORTERS.load(target)
    total = plugin.force(files, STATES) - rigid_body_force(mass, centre, inertia, STATES) + PUSH
    at = np.ix_(known, known)
    out = np.zeros_like(STATES)
    out[:, known] = np.linalg.solve((rigid_body_inertia(mass, centre, inertia) + added)[at], total[:, known].T).T
    return out


def accelerations_simulated(file: ParameterFile, accelerations: str, free: str) -> Array:
    body = vehicle(file, tuple(free), accelerations=accelerations)
    still = np.repeat([UPRIGHT], len(STATES), axis=0)
    righting = body.restoring(still)
    return body.acceleration(STATES, still, np.zeros((len(STATES), 3)), PUSH - righting[0])


def vehicle_for(target: str) -> ParameterFile:
    file = accelerating()
    return with_mass(file, AHEAD) if target == "uuv_simulator" else file


def written(file: ParameterFile, target: str, accelerations: str) -> Export:
    return export(file, target, accelerations)


def own(made: Export) -> dict[str, bytes]:
    return {n: c for n, c in made.files.items() if not n.endswith(".loss.txt")}


@few_states
@both
@pytest.mark.parametrize("target", READERS)
def test_the_first_acceleration_is_that_of_simulate(target: str, accelerations: str) -> None:
    """Every entry of M_A other than zero, a centre of gravity off the reference point, an asymmetric measured pair."""
    file = vehicle_for(target)
    found = accelerations_written(target, own(written(file, target, accelerations)), (0, 1, 2, 3, 4, 5))
    wanted = accelerations_simulated(file, accelerations, "uvwpqr")
    kept = [0] if target == "uuv_simulator" else [0, 1, 2]
    np.testing.assert_allclose(found[kept], wanted[kept], rtol=1e-10, atol=1e-12)
    other = accelerations_simulated(file, {"measured": "computed", "computed": "measured"}[accelerations], "uvwpqr")
    assert np.max(np.abs(found - other)) > 0.01


@few_states
@both
@pytest.mark.parametrize("target", ["gazebo", "gazebo_plugin"])
def test_the_flagship_too(suboff: Study, target: str, accelerations: str) -> None:
    """Nvdot' of SUBOFF was -.17 times the measured one in what was exported."""
    file = suboff.parameter_files["suboff_fully_appended"]
    found = accelerations_written(target, own(written(file, target, accelerations)), (0, 1, 2, 4, 5))
    wanted = accelerations_simulated(file, accelerations, "uvwqr")
    at = np.ix_([0, 2], [0, 1, 2, 4, 5])  # no roll, whose inertia the file does not state
    np.testing.assert_allclose(found[at], wanted[at], rtol=1e-9, atol=1e-12)


@few_states
@pytest.mark.parametrize("target", ["gazebo", "gazebo_plugin", "uuv_simulator", "xdyn"])
def test_a_flipped_sign_shows(target: str) -> None:
    """The sway-yaw entry of the written added mass, with the other sign."""
    file = vehicle_for(target)
    files = own(written(file, target, "measured"))
    sound, wanted = (
        accelerations_written(target, files, tuple(range(6))),
        accelerations_simulated(file, "measured", "uvwpqr"),
    )
    mass, centre, inertia, added = READERS[target](files)
    wrong = added.copy()
    wrong[1, 5] = wrong[5, 1] = -added[1, 5]
    flipped = {**READERS, target: lambda _: (mass, centre, inertia, wrong)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(f"{__name__}.READERS", flipped)
        bad = accelerations_written(target, files, tuple(range(6)))
    assert np.max(np.abs(bad[0] - wanted[0])) > 1e3 * max(np.max(np.abs(sound[0] - wanted[0])), 1e-12)


@both
@pytest.mark.parametrize("target", TARGETS)
def test_the_added_mass_of_the_files_is_the_one_in_use(target: str, accelerations: str) -> None:
    file, plugin = accelerating(), EXPORTERS.load(target)
    assert isinstance(plugin, InertialExporter)
    made = written(file, target, accelerations)
    np.testing.assert_allclose(
        plugin.added_mass(own(made)), vehicle(file, accelerations=accelerations).added, rtol=1e-10, atol=1e-10
    )


@both
@pytest.mark.parametrize("target", ["gazebo", "uuv_simulator"])
def test_what_a_target_adds_is_taken_off_by_the_matrix_it_has(target: str, accelerations: str) -> None:
    """In drift with no rate the force of first order is the file's law, so the viscous part fits the C_A(nu) of the exported M_A."""
    file, plugin = vehicle_for(target), EXPORTERS.load(target)
    drift = np.array([[2.0, 1e-6, 0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0, 0.0, 1e-6]])
    files = own(written(file, target, accelerations))
    straight = plugin.force(files, STATES[:1])
    law = vehicle(with_accelerations(file, accelerations))
    ours = law.force(drift, np.zeros((2, 3))) - law.force(STATES[:1], np.zeros((1, 3)))
    np.testing.assert_allclose(plugin.force(files, drift) - straight, ours, rtol=1e-5, atol=1e-11)


@pytest.mark.parametrize("target", ["fmi", "mss", "python_vehicle_simulator", "xdyn"])
def test_nothing_is_lost_where_both_are_the_same(target: str) -> None:
    file = accelerating()
    loss = written(file, target, "measured").loss
    assert loss.lossless
    assert loss.furthest[1] <= LOSSLESS
    table = forces(loss)
    assert len(table.rows) == 12
    assert {row[-1] for row in table.rows} == {"0 %"}


@pytest.mark.parametrize("target", TARGETS)
def test_the_row_itself_says_that_accelerations_differ(target: str) -> None:
    """Difference of yaw from rest by hand: the push over both inertias."""
    file = accelerating()
    made = written(file, target, "computed")
    loss = made.loss
    assert not loss.lossless
    name, share = loss.furthest
    assert share > 0.06
    percent = f"{float(f'{100 * share:.2g}'):g} %"
    assert f"{name} differs by up to" in in_short(loss)
    rows = {row[0]: row for row in forces(loss).rows}
    assert rows["dr/dt"][-1] != "0 %"
    assert any(row[0] == name and row[-1] == percent for row in forces(loss).rows)
    text = next(c for n, c in made.files.items() if n.endswith(".loss.txt")).decode()
    assert "dr/dt  rad/s^2" in text
    assert "This export is not lossless" in text
    assert "Yvdot' -0.012 (fit) is not used" in text
    shown = cast("Study", SimpleNamespace(exports=(made,), refused=()))
    ((_, _, verdict, worst, chosen, _),) = export_section.summary(shown).rows
    assert (chosen, worst) == ("computed", f"{percent} ({name})")
    assert verdict.startswith("accepted")


def test_motions_without_a_known_inertia_have_no_number(suboff: Study) -> None:
    file = suboff.parameter_files["suboff_fully_appended"]
    assert file.mass is not None
    file = file.model_copy(update={"mass": replace(file.mass, centre=None, inertia_matrix=None)})
    loss = written(file, "mss", "measured").loss
    rows = {row[0]: row for row in forces(loss).rows}
    assert rows["dp/dt"][2:] == ("-",) * 4
    assert rows["dr/dt"][-1] == "0 %"
    assert any("p: not compared" in n for n in forces(loss).notes)
    nothing = accelerating().model_copy(update={"mass": None})
    assert written(nothing, "mss", "measured").loss.accelerations is None


@few_states
def test_the_choice_is_named_in_every_file() -> None:
    file = accelerating()
    for target in (*TARGETS, "stonefish"):
        made = written(file, target, "measured")
        text = b"".join(made.files.values())
        assert b"accelerations: Yvdot', Nvdot'" in text, target
        assert b"accelerations computed, the added mass of body of tow by panel" in b"".join(
            written(file, target, "computed").files.values()
        ), target


def test_two_splits_say_that_they_are_two() -> None:
    """Nv' of the torpedo by the matrix of the file, and by the Yvdot' that the export integrates; the total is one."""
    plain = accelerating()
    hull = plain.added_mass
    assert hull is not None
    each = tuple(
        replace(c, potential=potential_part(c.symbol, hull, plain.scaling, hull.density)) for c in plain.coefficients
    )
    file = plain.model_copy(update={"coefficients": each})
    booked, written = parts(file), parts(file, water_inertia(file))
    by_file, by_export = ({row[0]: row[1:4] for row in table.rows}["Nv'"] for table in (booked, written))
    assert by_file[0] == by_export[0]
    assert by_file[1:] != by_export[1:]
    assert any("the parameter file books other potential parts" in note for note in written.notes)
    assert any("take the acceleration derivatives of the file first" in note for note in booked.notes)
    computed = parts(file, water_inertia(file, "computed"))
    assert computed.rows == booked.rows
    assert not any("books other potential parts" in note for note in computed.notes)
