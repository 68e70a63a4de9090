"""A vehicle from its shape and mass, with stated toy numbers in the place of estimates."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab import estimates as methods
from coeflab.bodies.body import Body
from coeflab.bodies.forms import Box, Faceted
from coeflab.bodies.mass_model import MassModel, MassPart
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.pieces import Control
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Part, Parts
from coeflab.bodies.simplify.source import subject
from coeflab.bodies.thrusters import Thruster
from coeflab.cli.vehicle import typed
from coeflab.core.errors import InputError
from coeflab.core.files import shipped, write_all
from coeflab.core.finding import Severity
from coeflab.core.text.toml import quoted
from coeflab.estimates import Contribution, Estimates, Water
from coeflab.formats.export import export, parameter_files_rendered
from coeflab.formats.loss import Loss
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.symbols import derivative
from coeflab.law.transforms import rotation
from coeflab.motion.simulation import simulate
from coeflab.report.content import document
from coeflab.report.first_page import answer
from coeflab.report.sections.estimates import (
    answer_of_merge,
    estimates_table,
    main_spread,
    manoeuvre_table,
    replaced_section,
    shares_figure,
)
from coeflab.study import estimated_vehicle as workbench_vehicle
from coeflab.study.checks import buoyancy, export_loss, longest_axis
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.vehicle.force_law import ahead_from, full_force
from coeflab.vehicle.from_shape import Stated, spread_of, weighed
from coeflab.vehicle.merge import merged
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.schema_versions import SCHEMA_VERSION

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

VALUES = {"Xu|u|": -0.004, "Yv": -0.03, "Nv": -0.012, "Yr": 0.005, "Nr": -0.006, "Yv|v|": -0.1, "Nr|r|": -0.003}
RUDDER = {"Ydr": 0.008, "Ndr": -0.0035}
SHARE = 0.4
SHAPE = shipped("geometry") / "spheroid_example" / "body.toml"
DISPLACED = 998.2 * np.pi / 6.0 * 3.0 * 0.5**2
PLAN = Plan("toy", "Toy", (), method="ellipsoid")


def toy(body: Body, water: Water, towed: bool = False, added_mass: AddedMass | None = None) -> Estimates:
    """Stated numbers, of the rudder where there is one."""
    values = VALUES | (RUDDER if any(c.name == "dr" for c in body.controls) else {})
    each = tuple(
        Coefficient(s, v, SHARE * abs(v), Status.ESTIMATE, origin="estimate", estimator="stated by a test")
        for s, v in values.items()
    )
    assert body.scaling is not None
    found = CoefficientSet(each, np.diag([(c.u95 or 0.0) ** 2 / 4.0 for c in each]), body.scaling, body.reference_point,
                           body.datum, body.name)  # fmt: skip
    still = lambda nu, angles: np.zeros((len(nu), 6))  # noqa: E731
    made = Contribution("hull", "toy force", "toy", still, SHARE, "lamb1932", "p. 1")
    return Estimates(found, (made,), {s: {"hull, toy force": v} for s, v in values.items()}, still, ("toy numbers",))


@pytest.fixture(autouse=True)
def _toy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(methods, "estimated", toy)


@pytest.fixture(scope="module")
def bare() -> Body:
    return read_body(SHAPE)


@pytest.fixture(scope="module")
def steered(bare: Body) -> Study:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(methods, "estimated", toy)
        return from_shape(
            PLAN, with_rudder(bare), Stated(390.0, np.array([0.0, 0.0, 0.02]), np.diag([10.0, 150.0, 150.0]))
        )


def with_rudder(body: Body, limit: float | None = np.radians(12.0)) -> Body:
    hinge = Control("dr", ("hull",), np.array([-1.4, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), limit, np.radians(20.0))
    return replace(body, controls=(hinge,))


def pushed(name: str, y: float) -> Thruster:
    curve = np.array([[-1000.0, -30.0], [0.0, 0.0], [1000.0, 60.0]])
    return Thruster(name, np.array([-1.0, y, 0.0]), np.array([1.0, 0.0, 0.0]), curve, "speed", "rpm")


def test_a_body_alone_gives_a_parameter_file_of_estimates(steered: Study, tmp_path: Path) -> None:
    ((name, made),) = steered.parameter_files.items()
    path = tmp_path / f"{name}.json"
    path.write_bytes(made.to_json())
    back = read_parameter_file(path)
    assert back == made
    assert back.schema_version == SCHEMA_VERSION
    assert {(c.status, c.origin) for c in back.coefficients} == {(Status.ESTIMATE, "estimate")}
    assert {c.symbol.removesuffix("'"): c.u95 for c in back.coefficients} == pytest.approx(
        {s: SHARE * abs(v) for s, v in (VALUES | RUDDER).items()}
    )
    assert back.hydrostatics.volume == pytest.approx(DISPLACED / 998.2)
    assert back.mass.centre.tolist() == [0.0, 0.0, 0.02]
    assert back.mass.inertia_matrix[2, 2] == pytest.approx(150.0, rel=1e-3)


@pytest.mark.parametrize(
    ("mass", "said"),
    [(DISPLACED - 10.0, "10 kg of ballast to neutral"), (DISPLACED + 20.0, "20 kg too heavy"), (DISPLACED, "neutrally buoyant"),
     (None, "as heavy as the water")],
)  # fmt: skip
def test_the_mass_is_compared_with_the_displacement(bare: Body, mass: float | None, said: str) -> None:
    found = weighed(bare, Stated(mass), 998.2)
    assert said in found.statements[0]
    assert ("mass" in found.assumed) == (mass is None)
    assert {"centre", "inertia"} <= set(found.assumed)


def test_what_makes_a_light_vehicle_neutral_is_said_where_its_file_states_no_masses(bare: Body) -> None:
    light = weighed(bare, Stated(DISPLACED - 10.0), 998.2).statements[0]
    assert "[[mass]] with ballast = true, or flooded = true" in light
    assert light.endswith("and without a stated mass it is neutral")
    for mass in (DISPLACED, DISPLACED + 20.0):
        assert "[[mass]]" not in weighed(bare, Stated(mass), 998.2).statements[0]
    part = MassPart("dry", "point", 300.0, np.zeros(3), np.zeros((3, 3)))
    stated = replace(bare, mass_model=MassModel((part,), 998.2, DISPLACED / 998.2, np.zeros(3)))
    said = weighed(stated, Stated(DISPLACED - 10.0), 998.2).statements
    assert "[[mass]]" not in said[0]
    assert said[1].startswith(f"the stated {DISPLACED - 10.0:.4g} kg stand in the place of the 300 kg of [[mass]]")


@pytest.mark.parametrize(("share", "ballasted"), [(1.0, False), (0.9, True)])
def test_a_centre_of_gravity_ahead_hangs_the_bow_down_and_is_warned_of(
    steered: Study, share: float, ballasted: bool
) -> None:
    """tan(pitch) = -x / z of G from B: 4 mm ahead and 10 mm below it are 21.8 deg bow down, with any ballast at B."""
    body = steered.shape.weighed.body
    middle = body.configurations[0].centre_of_buoyancy
    found = weighed(body, Stated(share * DISPLACED, middle + np.array([0.004, 0.0, 0.010])), 998.2)
    assert "pitch -21.80 deg (bow down), roll 0 deg" in found.statements[1]
    assert ("ballasted to neutral at B" in found.statements[1]) is ballasted
    (said,) = (
        c
        for c in buoyancy.check(replace(steered, shape=replace(steered.shape, weighed=found)))
        if c.name == "trim_at_rest"
    )
    assert said.severity is Severity.WARN
    assert "pitch -21.8 deg (bow down)" in said.statistic
    assert said.comment.startswith("As if ballasted") is ballasted
    level = weighed(body, Stated(share * DISPLACED, middle + np.array([0.0005, 0.0, 0.010])), 998.2)
    checks = buoyancy.check(replace(steered, shape=replace(steered.shape, weighed=level)))
    assert all(c.name != "trim_at_rest" for c in checks)


def test_a_report_of_a_shape_has_its_command_the_name_of_what_is_missing_and_no_work_called_none(
    steered: Study,
) -> None:
    assert steered.shape is not None
    typed_so = typed(
        "work/hull 3.stl", {"unit": "mm", "mass": "34 kg", "cg": ""}, {"repair": True, "fill": False}, ["xdyn"]
    )
    assert typed_so == "coeflab vehicle 'hull 3.stl' --unit=mm --mass='34 kg' --repair --to xdyn"
    unsourced = replace(steered.body, source=replace(steered.body.source, citation="none"))
    study = replace(
        steered, plan=replace(steered.plan, command=typed_so), body=unsourced,
        shape=replace(steered.shape, missing=("no thruster: write [[thruster]]",)),
    )  # fmt: skip
    page = document(study, full=False)
    (reproduce,) = (s for s in page.sections if s.anchor == "reproduce")
    assert reproduce.code == (typed_so,)
    assert "none" not in dict(page.works)
    chips = {c.name: c.text for c in answer(study, drawn=False).chips}
    assert chips["Missing"] == "no thruster"
    said = "not in the estimates: main: force across of its propeller, without [thruster.propeller]"
    listed = replace(study, shape=replace(steered.shape, missing=(said,)))
    chips = {c.name: c.text for c in answer(listed, drawn=False).chips}
    assert chips["Missing"] == "not in the estimates: main: force across of its propeller"


@pytest.mark.parametrize("mass", [DISPLACED / 3.1, 3.1 * DISPLACED, 0.028])
def test_a_mass_that_no_unit_makes_a_vehicle_is_refused(bare: Body, mass: float) -> None:
    with pytest.raises(InputError, match="of displacement"):
        weighed(bare, Stated(mass), 998.2)
    water = MassPart("hold", "water", 1.0, np.zeros(3), np.zeros((3, 3)), flooded=True)
    flooded = replace(bare, mass_model=MassModel((water,), 998.2, DISPLACED / 998.2, np.zeros(3)))
    assert weighed(flooded, Stated(mass), 998.2).configuration.mass is not None


@pytest.mark.parametrize(("share", "severity"), [(1.15, Severity.PASS), (1.3, Severity.WARN), (0.7, Severity.WARN)])
def test_a_mass_far_from_the_displacement_is_warned_of(steered: Study, share: float, severity: Severity) -> None:
    heavy = weighed(steered.shape.weighed.body, Stated(share * DISPLACED), 998.2)
    (found,) = buoyancy.check(replace(steered, shape=replace(steered.shape, weighed=heavy)))
    assert found.severity is severity


def test_an_export_that_is_worse_than_no_force_is_warned_of(steered: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    made = export(next(iter(steered.parameter_files.values())), "xdyn")
    assert export_loss.check(replace(steered, exports=(made,))) == []
    monkeypatch.setattr(Loss, "worse_than_nothing", property(lambda _: ("X", "K")))
    (found,) = export_loss.check(replace(steered, exports=(made,)))
    assert found.severity is Severity.WARN
    assert found.statistic == "rms error exceeds the rms force: X and K"


def test_the_inertia_of_displaced_water_is_that_of_the_spheroid(bare: Body) -> None:
    a, b, volume = 1.5, 0.25, DISPLACED / 998.2
    assert np.diag(spread_of(bare, bare.configurations[0])) == pytest.approx(
        volume / 5.0 * np.array([a**2, b**2, b**2])
    )
    mass = weighed(bare, Stated(500.0), 998.2).configuration.mass
    assert np.diag(mass.inertia_matrix) == pytest.approx(500.0 / 5.0 * np.array([2.0 * b**2, a**2 + b**2, a**2 + b**2]))


def test_a_faceted_part_spreads_as_its_box(bare: Body) -> None:
    """Its moments are a matrix; their diagonal alone was taken, and added to every row."""
    box, turn = trimesh.creation.box(extents=(2.0, 0.5, 0.25)), rotation(0.3, -0.2, 0.5)
    facets = Faceted.about_its_centre(TriangleMesh(np.array(box.vertices), np.array(box.faces)))[0]
    one, other = (
        spread_of(replace(bare, shape=Parts((Part("hull", form, np.zeros(3), turn),))), replace(bare.configurations[0], second_moments=None))
        for form in (facets, Box(2.0, 0.5, 0.25))
    )  # fmt: skip
    assert one == pytest.approx(other, abs=1e-12)
    assert abs(other[0, 1]) > 0.01


def test_an_inertia_that_no_body_has_is_refused(bare: Body) -> None:
    with pytest.raises(InputError, match="--inertia"):
        weighed(bare, Stated(400.0, None, np.diag([1.0, 2.0, 9.0])), 998.2)


def test_without_control_and_thruster_it_coasts_and_says_what_is_missing(bare: Body) -> None:
    found = from_shape(PLAN, bare)
    assert not any("drift" in s for s in found.shape.statements)
    assert [m.manoeuvre.name for m in found.manoeuvres] == ["stop"]
    assert "coast-down" in {row[0] for row in manoeuvre_table(found.manoeuvres, ()).rows}
    missing = " ".join(found.shape.missing)
    assert "no rudder: write [[control]]" in missing
    assert "no thruster: write [[thruster]]" in missing
    assert "--mass, --cg, --inertia" in missing
    assert not any(c.symbol.startswith(("Ydr", "Ndr")) for p in found.parameter_files.values() for c in p.coefficients)


def test_added_mass_near_a_wall_goes_into_the_file(bare: Body, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    few = partial(workbench_vehicle.wall_sweep, given={"panels": 1000})
    monkeypatch.setattr(workbench_vehicle, "wall_sweep", few)
    made = from_shape(PLAN, bare, wall="bottom", distances=(2.0, 0.5)).parameter_files
    write_all(tmp_path, parameter_files_rendered(made.values()))
    hull = read_parameter_file(next(tmp_path.glob("*.parameters.json"))).added_mass
    assert [(w.wall, w.distance) for w in hull.walls] == [("bottom", 0.5), ("bottom", 2.0)]
    close, far = (w.matrix[2, 2] / hull.matrix[2, 2] for w in hull.walls)
    assert close > 1.05 > far > 0.97


def test_a_rudder_turns_it_within_its_limit(steered: Study) -> None:
    turn, zigzag = steered.manoeuvres
    assert (turn.manoeuvre.name, zigzag.manoeuvre.name) == ("turning_circle", "zigzag")
    assert abs(turn.manoeuvre.phases[0].orders["dr"]) == pytest.approx(np.radians(12.0))
    assert abs(zigzag.manoeuvre.phases[0].orders["dr"]) == pytest.approx(np.radians(10.0))
    assert turn.vehicle.free == ("u", "v", "r")
    assert not any("at once" in s for s in turn.statements)
    shown = from_shape(PLAN, with_rudder(read_body(SHAPE), None))
    assert any(m.startswith("no limit and rate of dr") for m in shown.shape.missing)


def test_two_thrusters_turn_it_too(bare: Body) -> None:
    found = from_shape(PLAN, replace(bare, thrusters=(pushed("port", -0.3), pushed("starboard", 0.3))))
    turn = found.manoeuvres[0]
    assert turn.manoeuvre.phases[0].orders == {"port": 1000.0, "starboard": 0.0}
    assert turn.trajectory.heading[-1] > 0.0
    (made,) = found.parameter_files.values()
    assert [made.thrusters[0].curve.at(c) for c in (-1000.0, -500.0, 500.0, 1000.0)] == pytest.approx(
        [-30.0, -15.0, 30.0, 60.0]
    )
    assert not any("rudder" in m for m in found.shape.missing)


def test_shares_of_the_turn_name_the_estimates(steered: Study) -> None:
    (made,) = steered.parameter_files.values()
    main = main_spread(steered.shape.carried)
    assert main[0].figure.name == "tactical diameter"
    assert main[0].low < main[0].figure.value < main[0].high
    found = {row[0]: row for row in estimates_table(made, steered.shape.carried, steered.shape.estimates.shares).rows}
    assert found["Nv'"][4] == "estimate"
    assert found["Nv'"][-1] == "toy force 100 %"
    figure = shares_figure(made, steered.shape.carried, "shares")
    assert "Nr' estimate" in figure.description


def test_shares_above_the_whole_are_explained_below_their_table(steered: Study) -> None:
    assert steered.shape is not None
    (made,) = steered.parameter_files.values()
    for known, told in (((("Xu|u|'", 1.0), ("Yv'", 0.56)), True), ((("Yv'", 0.56),), False)):
        each = [
            replace(c, importances=tuple(replace(i, known=known) for i in c.importances)) for c in steered.shape.carried
        ]
        notes = estimates_table(made, each, few=True).notes
        assert any("Numbers of one method are correlated" in n for n in notes) == told


def test_the_answer_and_the_report_say_estimate(steered: Study) -> None:
    table = manoeuvre_table(steered.manoeuvres, steered.shape.carried if steered.shape is not None else ())
    assert {
        "turning circle: 12 deg of rudder from 2 m/s, dr = -12 deg.",  # to starboard, as Ndr' < 0
        "zigzag: 10 deg of rudder from 2 m/s, dr = -10 deg.",
    } < set(table.notes)
    assert any("--manoeuvre zigzag" in note for note in table.notes)
    first = answer(steered)
    one = answer(replace(steered, shape=replace(steered.shape, missing=("no thruster",))))
    assert ("Missing", "no thruster") in [(c.name, c.text) for c in one.chips]
    assert "at 12 deg of rudder and 2 m/s (95 %" in first.sentence
    said = re.search(r"([\d.]+) m at 12 .*\(95 % ([\d.]+) to ([\d.]+)\)", first.sentence)
    middle, low, high = (
        x.replace(".", "") for x in said.groups()
    )  # to one place, with two digits of half the interval
    assert 20 <= int(high) - int(low) < 200
    assert int(low) < int(middle) < int(high)
    assert len(first.sentence) <= 160
    assert "estimate" in first.sentence
    assert first.slope is not None
    assert first.forest is not None
    page = document(steered, full=True)
    sections = {s.anchor: s for s in page.sections}
    assert sections["coefficients"].title == "Estimates"
    assert "Each slope comes from one model" not in " ".join(sections["coefficients"].texts)
    assert any("kg of ballast" in p for p in sections["verdict"].texts) or "too heavy" in " ".join(
        sections["verdict"].texts
    )


def test_a_plan_of_a_body_alone_runs(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(f'[study]\nname = "alone"\n[body]\npath = {quoted(str(SHAPE))}\n')
    plan = replace(read_plan(path), method="ellipsoid")
    found = run(plan)
    assert list(found.parameter_files) == ["spheroid_example"]
    assert found.shape is not None
    assert found.checks
    path.write_text('[study]\nname = "none"\n')
    with pytest.raises(InputError, match=r"no \[\[table\]\].*\[body\]"):
        read_plan(path)


@pytest.mark.parametrize(
    ("curve", "said"),
    [("[[0, 0], [10, -1]]", "do not fall"), ("[[0, 0]]", "two points"), ("[[0, 0], [0, 5]]", "rising commands"),
     ('[[0, 0], ["a", 5]]', "thruster")],
)  # fmt: skip
def test_a_curve_that_is_none_is_refused(tmp_path: Path, curve: str, said: str) -> None:
    path = tmp_path / "body.toml"
    more = f'[[thruster]]\nname = "main"\nplace = [-1.5, 0.0, 0.0]\naxis = [1, 0, 0]\ncurve = {curve}\n'
    path.write_text(SHAPE.read_text() + more)
    with pytest.raises(InputError, match=said) as refused:
        read_body(path)
    assert "body.toml" in str(refused.value)


@pytest.mark.parametrize(
    ("option", "text"),
    [("mass", "-3"), ("mass", "46 m"), ("cg", "1,2"), ("inertia", "1,2,x"), ("speed", "0"), ("length", "long")],
)
def test_an_option_that_is_no_number_is_named(bare: Body, option: str, text: str) -> None:
    with pytest.raises(InputError, match=f"--{option}"):
        asked(bare, **{option: text})


def fitted(base: ParameterFile, keep: dict[str, tuple[str, float]], **more: object) -> ParameterFile:
    """A file of some numbers of another, as a fit would give them."""
    content = json.loads(base.to_json())
    rows = []
    for c in content["coefficients"]:
        if c["symbol"] in keep:
            symbol, value = keep[c["symbol"]]
            rows.append({**c, "symbol": symbol, "unit_si": derivative(symbol).unit, "value": value, "u95": 0.001, "status": "ok", "origin": "fit",
                         "campaign": "tow", "value_si": None, "potential": None})  # fmt: skip
    content |= {"name": "tow", "coefficients": rows, "covariance": {"symbols": [], "matrix": []}, "added_mass": None}
    return ParameterFile.model_validate_json(json.dumps(content | more))


def test_estimates_that_take_the_law_off_measured_points_go(steered: Study) -> None:
    """A fit that is straight in r over its arm: the estimated Nr|r| bends the law away from these points, Yv|v| touches none."""
    (base,) = steered.parameter_files.values()
    keep = {"Yr'": ("Yr'", 0.004), "Nr'": ("Nr'", -0.006)}
    bare = fitted(base, keep)
    r = np.array([-0.4, -0.2, 0.2, 0.4])
    states = np.zeros((4, 6))
    states[:, 0], states[:, 5] = base.conditions.speed, r
    moment = full_force(bare)(states, np.zeros((4, 3)))[:, 5]
    table = {
        "table": "arm.csv", "campaign": "tow", "labels": ["1", "2", "3", "4"],
        "motion": [{"name": "u", "values": states[:, 0].tolist()}, {"name": "r", "values": r.tolist()}],
        "forces": [{"component": "N", "values": moment.tolist(), "at_rest": [0.0] * 4, "scatter": None}],
    }  # fmt: skip
    made = merged(base, fitted(base, keep, measured=[table]))
    left = {c.symbol for c in made.estimates}
    assert "Nr|r|'" not in left
    assert "Yv|v|'" in left
    assert [x.share for x in made.parameters.law_at_points if x.component == "N"] == pytest.approx([0.0], abs=1e-9)
    assert "Nr|r|'" in {c.symbol for c in merged(base, bare).estimates}


def test_a_fit_replaces_estimates_one_by_one(steered: Study) -> None:
    (base,) = steered.parameter_files.values()
    made = merged(
        base, fitted(base, {"Yv'": ("Yv'", -0.025), "Nv'": ("Nv'", -0.014), "Yv|v|'": ("Yvvv'", -0.2)}), "both"
    )
    left = {c.symbol for c in made.estimates}
    assert left == {"Xu|u|'", "Yr'", "Nr'", "Nr|r|'", "Ydr'", "Ndr'"}
    assert [(r.symbol, r.after is None) for r in made.replaced] == [
        ("Yv'", False), ("Nv'", False), ("Yv|v|'", True), ("Yvvv'", False),
    ]  # fmt: skip
    page = answer_of_merge(made, (), ())
    assert page.sentence == "both: 3 numbers replaced, 6 estimates left."
    assert [(r.symbol, r.value, r.published[0]) for r in page.rows if r.source not in ("", "estimate")] == [
        ("Yv", -0.025, VALUES["Yv"]), ("Nv", -0.014, VALUES["Nv"]),
    ]  # fmt: skip
    assert page.forest is not None
    symbols = list(made.parameters.covariance.symbols)
    matrix = np.array(made.parameters.covariance.matrix, dtype=float)
    i, j = symbols.index("Yv'"), symbols.index("Nr'")
    assert matrix[i, i] == pytest.approx(0.0005**2)
    assert matrix[j, j] == pytest.approx((SHARE * 0.006 / 2.0) ** 2)
    assert matrix[i, j] == 0.0
    nv, before = made.parameters.coefficient("Nv"), base.coefficient("Nv")
    assert nv.potential == before.potential != 0.0
    assert nv.value_si == pytest.approx(before.value_si * -0.014 / -0.012)
    with pytest.raises(InputError, match=r"estimates only in .*, nothing to replace others with"):
        merged(base, base)


def test_numbers_of_another_length_are_converted_and_said(steered: Study) -> None:
    (base,) = steered.parameter_files.values()
    keep = {"Yv'": ("Yv'", -0.025)}
    longer = replace(base.scaling, length=2.0 * base.scaling.length, length_name="LOA")
    other = fitted(base, keep).model_copy(update={"scaling": longer})
    made = merged(base, other)
    found = made.parameters.coefficient("Yv")
    assert found.value == pytest.approx(-0.025 * 4.0)  # Y / (rho U L^2 / 2): the same force on half the length
    for words in (str(longer), str(base.scaling), "scale model"):
        assert words in made.lengths
        assert any(words in note for note in made.parameters.provenance.notes)
    assert merged(base, fitted(base, keep)).lengths == ""
    fitted_by_ours = merged(base, fitted(base, keep), own=longer)  # a campaign of that length
    assert str(longer) in fitted_by_ours.lengths
    assert made.lengths[1:] in " ".join(replaced_section(made, ()).paragraphs)


def test_a_mesh_that_is_longest_across_is_a_warning(steered: Study, tmp_path: Path) -> None:
    """A bar of 2 m along x of its file; thin plates across, as wings, are none."""
    bar = trimesh.creation.box(extents=(2000.0, 200.0, 200.0))
    bar.export(tmp_path / "bar.stl")
    wing = trimesh.creation.box(extents=(100.0, 4000.0, 10.0)).apply_translation((0.0, 0.0, 50.0))
    trimesh.boolean.union([bar, wing]).export(tmp_path / "wing.stl")
    for name, axes, found in (
        ("bar", "FLU", Severity.PASS), ("bar", "port,aft,up", Severity.WARN), ("wing", "FLU", Severity.PASS),
    ):  # fmt: skip
        body = subject(str(tmp_path / f"{name}.stl"), "mm", axes)
        shape = replace(steered.shape, weighed=replace(steered.shape.weighed, body=body))
        (check,) = longest_axis.check(replace(steered, shape=shape))
        assert check.severity is found
    assert longest_axis.check(steered) == []  # no mesh


@pytest.mark.parametrize(
    ("datum", "nose_at", "severities"),
    [("nose", 0.0, ()), ("midship", 1.0, ()), ("stern", 2.0, ()), ("origin", 0.0, ()), ("tow_point", 0.3, ()),
     ("midship", 0.0, ("warn",)), ("stern", 0.0, ("warn",)), ("nose", 1.0, ("warn",)), ("bow", 2.0, ("warn",))],
)  # fmt: skip
def test_a_datum_whose_name_the_mesh_contradicts_warns(
    steered: Study, tmp_path: Path, datum: str, nose_at: float, severities: tuple[str, ...]
) -> None:
    """A bar of 2 m: moments of tables about another midship would move by 1 m with no word."""
    bar = trimesh.creation.box(extents=(2.0, 0.2, 0.2)).apply_translation((nose_at - 1.0, 0.0, 0.0))
    bar.export(tmp_path / "bar.stl")
    body = subject(str(tmp_path / "bar.stl"), "m", "FLU")
    body = replace(body, datum=replace(body.datum, id=datum))
    shape = replace(steered.shape, weighed=replace(steered.shape.weighed, body=body))
    *found, _ = longest_axis.check(replace(steered, shape=shape))
    assert tuple(str(c.severity) for c in found) == severities


def test_a_centre_of_gravity_far_from_the_hull_is_refused(bare: Body) -> None:
    with pytest.raises(
        InputError, match=r"a centre of gravity 1\.6\d* m from .*; expected at most half the length of the body, 1\.5 m"
    ):
        weighed(bare, Stated(390.0, np.array([1.6, 0.0, 0.02])), 998.2)


def test_a_coast_down_that_does_not_end_has_no_stopping_time_anywhere(
    bare: Body, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of almost no resistance: `not reached` in the table, no figure in the headline, and why among what is missing."""
    monkeypatch.setitem(VALUES, "Xu|u|", -4e-6)
    found = from_shape(PLAN, bare, Stated(390.0))
    (figure,) = (f for f in found.manoeuvres[0].figures if f.name == "stopping time")
    assert (figure.value, figure.status) == (None, "not reached")
    assert found.shape.carried == ()
    assert main_spread(found.shape.carried) is None
    assert any("stopping time is not reached" in line for line in found.shape.missing)


def test_rounding_does_not_turn_a_coast_down(bare: Body, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A directionally unstable body: mesh, renumbered mesh and equations coast alike, straight ahead, and X0' has the variance."""
    monkeypatch.setitem(VALUES, "Nv", -0.03)
    monkeypatch.setattr(workbench_vehicle, "MEMBERS", 40)
    ball = trimesh.creation.icosphere(3)
    ball.apply_scale([1.5, 0.25, 0.25])
    shuffled = trimesh.Trimesh(ball.vertices, np.random.default_rng(3).permutation(ball.faces), process=False)
    shuffled.apply_transform(trimesh.transformations.rotation_matrix(0.3, [1.0, 0.0, 0.0]))
    bodies = [bare]
    for name, mesh in (("one", ball), ("other", shuffled)):
        mesh.export(tmp_path / f"{name}.stl")
        bodies.append(subject(str(tmp_path / f"{name}.stl"), "m", "FLU"))
    plan = replace(PLAN, method="strip:lamb", scaling=bare.scaling)
    found = [from_shape(plan, body, Stated(390.0)) for body in bodies]
    times = []
    for one in found:
        (move,) = one.manoeuvres
        assert not np.any(move.trajectory.velocity[:, 1:])
        assert "straight ahead: sway and yaw are held" in move.statements
        assert any(s.startswith("the straight course is unstable") for s in move.statements)
        main = main_spread(one.shape.carried)
        assert [(s, round(v, 2)) for s, v in main[1].known] == [("Xu|u|'", 1.0)]
        times.append(next(f.value for f in move.figures if f.name == "stopping time"))
    assert times[2] == pytest.approx(times[1], rel=1e-6)
    assert times[1] == pytest.approx(times[0], rel=2e-2)


def test_the_drift_from_which_the_law_pushes_ahead_is_said(bare: Body, monkeypatch: pytest.MonkeyPatch) -> None:
    """X = -0.004 cos^2 + 0.02 sin^2 changes its sign at atan(sqrt(0.2)) = 24.1 deg."""
    monkeypatch.setitem(VALUES, "Xvv", 0.02)
    shape = from_shape(PLAN, bare).shape
    assert any(s.startswith("limit: from 25 deg of drift") for s in shape.statements)


def test_a_manoeuvre_beyond_what_estimates_hold_says_so(steered: Study) -> None:
    p = next(iter(steered.parameter_files.values())).model_copy(update={"surfaces": ()})
    small, large = (simulate(p, "zigzag", {"rudder": np.radians(a)}) for a in (10.0, 20.0))
    assert not [s for s in small.statements if "do not stall" in s]
    assert [s for s in large.statements if s.startswith("limit: 20 deg of rudder") and "do not stall" in s]
    bent = tuple(c for c in p.coefficients if c.symbol != "Xu|u|'")
    pushed = [
        replace(bent[0], symbol="X0'", value=-0.004, value_si=None, potential=None),
        replace(bent[0], symbol="Xvv'", value=4.0, value_si=None, potential=None),
    ]
    off = p.model_copy(update={"coefficients": (*bent, *pushed)})
    assert ahead_from(off) == 2
    (said,) = [s for s in simulate(off, "zigzag", {"rudder": np.radians(10.0)}).statements if "points ahead" in s]
    assert said.startswith("limit: drift reaches")
    stated = tuple(replace(c, status=Status.STATED) for c in off.coefficients)
    kept = simulate(off.model_copy(update={"coefficients": stated}), "zigzag", {"rudder": np.radians(20.0)})
    assert not [s for s in kept.statements if s.startswith("limit: ")]


def test_a_body_that_is_not_alike_to_both_sides_turns_as_it_coasts(bare: Body) -> None:
    heavy = Stated(390.0, np.array([0.0, 0.02, 0.0]))
    (move,) = from_shape(PLAN, bare, heavy).manoeuvres
    assert move.vehicle.free == ("u", "v", "r")
    assert np.any(move.trajectory.velocity[:, 5])


@pytest.mark.parametrize(
    ("density", "speed", "viscosity", "assumed"),
    [
        ("", "", 1.0034e-6, ["assumed: 2 m/s in fresh water of 20 deg C, 998.2 kg/m^3"]),
        ("1025", "", 1.0508e-6, ["assumed: 2 m/s, the viscosity of sea water of 20 deg C, 1.0508e-06 m^2/s"]),
        ("1000", "3 kn", 1.0034e-6, ["assumed: the viscosity of fresh water of 20 deg C, 1.0034e-06 m^2/s"]),
        ("", "3", 1.0034e-6, ["assumed: fresh water of 20 deg C, 998.2 kg/m^3"]),
    ],
)
def test_a_density_brings_the_viscosity_of_its_water_and_what_is_assumed_stays_named(
    bare: Body, density: str, speed: str, viscosity: float, assumed: list[str]
) -> None:
    plan, stated = asked(bare, density=density, speed=speed, method="ellipsoid")
    ((_, made),) = from_shape(plan, bare, stated).parameter_files.items()
    assert made.conditions.viscosity == viscosity
    assert [n for n in made.provenance.notes if n.startswith("assumed: ") and "water of 20" in n] == assumed
