"""Which method is recommended: planted results, bodies whose exact answer is known, and what is said of rough guides."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.bodies.added_masses import added_masses
from coeflab.bodies.body import Body
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Ellipsoid, Part, Parts, StandIn
from coeflab.bodies.triangulation import APART, OF_MESH, RULE, Triangulation, _felt
from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.law.added_mass import AddedMass
from coeflab.report.tables.added_mass import derivatives

RHO = 1000.0


def shipped_body(name: str) -> Body:
    return read_body(Path(shipped("geometry")) / name / "body.toml")


def told(body: Body, *methods: tuple[str, bool]) -> Triangulation:
    """Results of those methods, rough or not, all the same matrix."""
    results = tuple(AddedMass(np.eye(6), np.zeros(3), Datum("d"), body.name, m, ("said",), None, r) for m, r in methods)
    return Triangulation(body, RHO, results, {}, ())


def spheres(*places: float, radius: float = 0.1) -> Body:
    parts = tuple(
        Part(f"s{i}", Ellipsoid(radius, radius, radius), np.array([x, 0.0, 0.0]), np.eye(3))
        for i, x in enumerate(places)
    )
    return replace(shipped_body("spheroid_example"), shape=Parts(parts), reference_point=np.zeros(3))


HULL = "suboff_bare_hull"
ALL = ("ellipsoid", "panel", "primitives", "strip", "strip:lamb")


@pytest.mark.parametrize(
    ("rough", "refused", "chosen"),
    [
        ((), (), "panel"),
        (("ellipsoid",), ("panel", "primitives"), "strip:lamb"),
        (("strip", "strip:lamb"), ("panel", "primitives"), "ellipsoid"),
        (("primitives", "strip", "strip:lamb"), ("panel",), "ellipsoid"),
        (("ellipsoid", "primitives", "strip", "strip:lamb"), ("panel",), "primitives"),
        (("ellipsoid", "strip", "strip:lamb"), ("panel", "primitives"), "strip:lamb"),
    ],
)
def test_rough_guides_come_last_and_say_so(rough: tuple[str, ...], refused: tuple[str, ...], chosen: str) -> None:
    kept = tuple((m, m in rough) for m in ALL if m not in refused)
    found = told(shipped_body(HULL), *kept)
    assert found.recommended.method == chosen
    assert bool(found.caution) is (chosen in rough)
    if found.caution:
        assert found.caution.endswith("for the method primitives")
        assert f"{chosen} is a rough guide" in found.caution
        assert found.recommended.statements == (found.caution, "said")
        assert found.caution in derivatives(found).notes
    else:
        assert found.recommended.statements == ("said",)


def test_the_rule_names_what_is_rough() -> None:
    for words in ("too far apart to interact", "rough guides come last", "over 10 %", "a mesh as one plate"):
        assert words in RULE


def test_dipoles_by_hand() -> None:
    """Neighbours at 1 m and 2 m of the one in the middle row: 3 (0.1^3 + 0.1^3 / 8) at the ends, 6 x 0.1^3 between."""
    assert _felt(spheres(0.0).shape.parts) == 0.0
    assert _felt(spheres(-1.0, 0.0, 1.0).shape.parts) == pytest.approx(6e-3, rel=1e-12)
    assert _felt(spheres(0.0, 2.0).shape.parts) == pytest.approx(3.75e-4, rel=1e-12)


def test_every_method_states_its_place() -> None:
    methods = {n: ADDED_MASS.load(n).places for n in ADDED_MASS.names()}
    ranked = sorted((place, f"{n}:{p}".strip(":")) for n, places in methods.items() for p, place in places.items())
    assert [name for _, name in ranked] == [
        "panel",
        "primitives",
        "strip:lamb",
        "ellipsoid",
        "primitives:huuv",
        "strip",
    ]
    assert all({"", *ADDED_MASS.load(n).presets} == set(places) for n, places in methods.items())
    assert [n for n in methods if ADDED_MASS.load(n).takes_sheets] == ["panel"]


@pytest.mark.parametrize(
    ("places", "chosen"), [((0.0,), "ellipsoid"), ((-1.0, 1.0), "primitives"), ((0.0, 0.5), "panel")]
)
def test_exact_closed_forms_come_before_panels(places: tuple[float, ...], chosen: str) -> None:
    methods = tuple((m, False) for m in ("ellipsoid", "panel", "primitives"))
    assert told(spheres(*places), *methods).recommended.method == chosen
    assert told(spheres(0.0), *methods[1:]).recommended.method == "primitives"


def test_a_box_alone_is_no_exact_closed_form() -> None:
    methods = tuple((m, False) for m in ("ellipsoid", "panel", "primitives"))
    assert told(shipped_body("huuv_mesh"), *methods).recommended.method == "panel"
    assert told(shipped_body("huuv"), *methods).recommended.method == "panel"


@pytest.mark.slow
def test_what_spheres_feel_is_within_the_estimate() -> None:
    """Panels on two spheres, 5 radii apart, beside each alone: along the line 3 (R/d)^3, across half of it, Lamb 138."""
    pair, alone = spheres(0.0, 0.5), spheres(0.0)
    options = {"panels": 3000, "kernel": "numpy"}
    both = added_masses(pair, RHO, "panel", options).results[0]
    single = added_masses(alone, RHO, "panel", options).results[0]
    change = np.diag(both.matrix)[:3] / (2.0 * np.diag(single.matrix)[:3]) - 1.0
    bound = _felt(pair.shape.parts)
    assert bound == pytest.approx(0.024)
    assert bound > APART
    assert change == pytest.approx([-bound, bound / 2.0, bound / 2.0], abs=0.15 * bound)


FIT = StandIn("ellipsoid", 0.99, 0.0, (0.01, 0.0, 0.0), 0.0, 0.01)
WORSE = replace(FIT, kind="other", misfit=0.447)


def standing(fit: StandIn) -> Body:
    """A sphere that stands for a piece of a mesh."""
    one = spheres(0.0)
    return replace(one, shape=Parts(tuple(replace(p, fit=fit) for p in one.require_shape().parts)))


@pytest.mark.parametrize(("fit", "rough"), [(FIT, False), (WORSE, True)])
def test_a_stand_in_is_never_exact(fit: StandIn, rough: bool) -> None:
    """An ellipsoid of misfit .45 was "exact, spread 0.0 %": nothing compares it with what it stands for."""
    found = added_masses(standing(fit), RHO)
    assert added_masses(spheres(0.0), RHO).recommended.statements[0].startswith("the body is an ellipsoid: exact")
    assert not any("exact;" in s or s.endswith("exact") for r in found.results for s in r.statements)
    assert all(r.rough == rough for r in found.results)
    assert "exact" not in found.rule
    assert found.rule == OF_MESH
    assert np.all(np.isnan(found.spread))
    assert {row[-1] for row in derivatives(found).rows} == {"-"}
    said = (
        "as parts are poor stand-ins for a mesh: s0: class other (misfit 0.45"
        if rough
        else "NOT CHECKED: the parts replace"
    )
    assert said in found.caution
    assert found.recommended.statements[0] == found.caution
    assert found.caution in derivatives(found).notes


def test_the_panel_method_on_the_mesh_comes_before_its_stand_ins() -> None:
    body = standing(WORSE)
    results = tuple(
        AddedMass(factor * np.eye(6), np.zeros(3), "d", "b", m, (), None, m != "panel")
        for m, factor in (("ellipsoid", 3.0), ("primitives", 3.0), ("panel", 1.0))
    )
    found = Triangulation(body, RHO, results, {}, (), spheres(0.0), ("panel",))
    assert (found.recommended.method, found.caution) == ("panel", "")
    assert np.diag(found.spread) == pytest.approx(2.0)
    assert found.shape is found.original.shape
