"""Manoeuvres of a plan: what they come to, and plans that ask for what cannot be."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.formats.export import exports_of
from coeflab.motion.manoeuvre import PlannedManoeuvre
from coeflab.motion.simulation import manoeuvres_of
from coeflab.report.sections.manoeuvres import manoeuvre_sections
from coeflab.study.plan import read_plan
from tests.motion.vehicles import made, rudder_covered
from tests.report.studies import FULL, small_study
from tests.vehicle.test_inertia import accelerating

PLAN = '[study]\nname = "s"\n[[table]]\ncampaign = "suboff_roddy_2"\n'


def quiet(_: str) -> None:
    """Nobody listens."""


def test_the_plan_of_suboff_asks_for_a_zigzag_and_a_turning_circle() -> None:
    planned = read_plan(shipped("cfd_data") / "suboff" / "plan.toml").manoeuvres
    assert [(m.parameter_file, m.name) for m in planned] == [
        ("suboff_fully_appended", "zigzag"),
        ("suboff_fully_appended", "turning_circle"),
    ]


def test_options_of_a_manoeuvre_are_read_from_the_plan(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(
        PLAN + '[[manoeuvre]]\nparameter_file = "a"\nname = "zigzag"\n[manoeuvre.options]\nrudder = "20 deg"\n'
    )
    (planned,) = read_plan(path).manoeuvres
    assert planned.options == {"rudder": "20 deg"}
    assert planned.file == path


def test_an_unknown_key_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(PLAN + '[[manoeuvre]]\nparameter_file = "a"\nname = "zigzag"\nrudder = 3\n')
    with pytest.raises(InputError, match="rudder"):
        read_plan(path)


def test_an_angle_of_a_plan_needs_its_unit() -> None:
    for bare in (0.35, 20):
        with pytest.raises(InputError, match="an angle without a unit") as refused:
            manoeuvres_of([PlannedManoeuvre("v", "zigzag", {"rudder": bare})], {"v": made()}, quiet)
        assert f'"{bare} rad"' in refused.value.advice


def test_options_reach_the_manoeuvre() -> None:
    found = [
        manoeuvres_of([PlannedManoeuvre("v", "straight_run", {"duration": d})], {"v": made()}, quiet)[0]
        for d in (5.0, 9.0)
    ]
    assert [f.trajectory.time[-1] for f in found] == [5.0, 9.0]


@pytest.mark.parametrize(
    ("planned", "column"),
    [
        (PlannedManoeuvre("other", "zigzag", place="manoeuvre[0]"), "manoeuvre[0].parameter_file"),
        (PlannedManoeuvre("v", "zigzag", {"rudder": "400 deg"}, place="manoeuvre[0]"), "manoeuvre[0].zigzag.rudder"),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(planned: PlannedManoeuvre, column: str) -> None:
    with pytest.raises(InputError) as caught:
        manoeuvres_of([planned], {"v": made()}, quiet)
    assert caught.value.column == column


def test_nothing_is_drawn_of_a_motion_that_nothing_determines() -> None:
    """Two panels of no width, whose warnings the command line leaked."""
    from dataclasses import replace

    planned = PlannedManoeuvre("v", "zigzag", {"rudder": "20 deg"})
    made_up = manoeuvres_of([planned], {"v": rudder_covered(np.radians(15.0))}, quiet)
    (section,) = manoeuvre_sections(replace(small_study(FULL), manoeuvres=made_up))
    (zigzag,) = section.subsections
    assert zigzag.figures == ()
    assert "Nothing is drawn" in " ".join(zigzag.paragraphs)


def test_a_turn_that_nothing_limits_is_said_to_be_undetermined() -> None:
    from dataclasses import replace

    made_up = manoeuvres_of([PlannedManoeuvre("v", "turning_circle")], {"v": rudder_covered(0.5, 0.5)}, quiet)
    (section,) = manoeuvre_sections(replace(small_study(FULL), manoeuvres=made_up))
    (turn,) = section.subsections
    status = {row[0]: row[-2] for row in turn.tables[0].rows}
    assert status["steady turning diameter"] == "no value"
    assert len(turn.figures) == 2
    assert len(turn.subsections[0].figures) >= 1
    assert turn.subsections[0].appendix


def test_a_plan_chooses_accelerations_for_manoeuvres_and_exports(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    asked = '[[manoeuvre]]\nparameter_file = "v"\nname = "straight_run"\naccelerations = "computed"\n[manoeuvre.options]\nduration = 5\n'
    path.write_text(PLAN + asked + '[[export]]\nto = "mss"\naccelerations = "computed"\n[[export]]\nto = "csv"\n')
    plan = read_plan(path)
    assert [e.accelerations for e in plan.exports] == ["computed", "measured"]
    file = accelerating()
    (made_of,) = manoeuvres_of(plan.manoeuvres, {"v": file}, quiet)
    assert made_of.vehicle.water.used == "computed"
    assert made_of.vehicle.water.source in made_of.statements
    ((exported,), _) = exports_of([replace(plan.exports[0], accept_loss=True)], [file], quiet)
    assert exported.loss.water.used == "computed"
    path.write_text(PLAN + '[[export]]\nto = "mss"\naccelerations = "guessed"\n')
    with pytest.raises(InputError, match="guessed"):
        read_plan(path)
