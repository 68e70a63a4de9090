"""Numbers that a person states: how they are typed, what a file of them holds, and what is said of a file written by hand."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.text.json import lines_of
from coeflab.core.units import also_written, same_unit
from coeflab.law.coefficient import Status
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import derivative
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.merge import merged
from coeflab.vehicle.own_numbers import as_file, imported_file, mass_of, own_number, own_numbers, typed_file
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.plausibility import plausibility

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

PAGE = (Path(__file__).parents[2] / "docs" / "parameter_file.md").read_text(encoding="utf-8")
BY_HAND = PAGE.partition('title="by_hand.parameters.json"\n')[2].partition("```")[0]
SCALING, AT = Scaling(2.0, "LOA"), Conditions(1000.0, 1.0)


@pytest.mark.parametrize(
    ("typed", "value", "u95"),
    [("Yv'=-0.03 +- 0.003", -0.03, 0.003), ("Yv' = -0.03", -0.03, None), ("Yv'=-3e-2+/-.003", -0.03, 0.003),
     ("Yv=-60 +- 6 N/(m/s)", -0.03, 0.003), ("Yv=-60 N s/m", -0.03, None)],
)  # fmt: skip
def test_primes_and_si_values_are_one_number(typed: str, value: float, u95: float | None) -> None:
    c = own_number(typed).coefficient(SCALING, AT, "hull")
    assert (c.symbol, c.status, c.origin, c.unit_si) == ("Yv'", Status.STATED, "stated", "N/(m/s)")
    assert c.value == pytest.approx(value)
    assert c.u95 == (None if u95 is None else pytest.approx(u95))
    assert c.value_si == pytest.approx(-60.0)


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("Yv'", "SYMBOL=VALUE"),
        ("Yv'=", "a number"),
        ("Yv'=-0,03", "decimal point"),
        ("Yv'=-0.03 N", "no unit"),
        ("Yv=-60", "N/(m/s), also written N s/m"),
        ("Nv=-60 N/(m/s)", "N*m/(m/s), also written Nm/(m/s)"),
        ("Yv'=1 +- -2", "U95 of zero or more"),
        ("Yv'=1e999", "finite"),
        ("Y_v=1", "Did you mean Yv'?"),
        ("Yv\u2019=1", "Did you mean Yv'?"),
        ("N_{\\dot r}=1", "SNAME"),
    ],
)
def test_what_is_typed_wrongly(typed: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        own_number(typed)
    assert said in str(caught.value)
    assert caught.value.column == "--set"


@pytest.mark.parametrize(
    ("typed", "value", "u95"),
    [
        ("Ydr=1.9 N/deg", 1.9 * 180.0 / np.pi, None),
        ("Ydr=1.9 +- 0.1 N/(deg)", 1.9 * 180.0 / np.pi, 0.1 * 180.0 / np.pi),
        ("Yv=-10 lbf/(m/s) +- 5%", -10 * 4.4482216152605, 0.5 * 4.4482216152605),
        ("Yv=-130 N/(m/s) +- 20 N/(m/s)", -130.0, 20.0),
        ("Yv=-130 N/(m/s) +- 20", -130.0, 20.0),
        ("Yv=-130 N s/m +/- 10 %", -130.0, 13.0),
        ("Yv=-130 N/(m/s) +- 2 lbf/(m/s)", -130.0, 2 * 4.4482216152605),
        ("Yv'=-0.03 +- 10%", -0.03, 0.003),
        ("Nr=-5 ft*lbf/(deg/s)", -5 * 1.3558179483314 * 180.0 / np.pi, None),
    ],
)
def test_units_and_intervals_as_people_write_them(typed: str, value: float, u95: float | None) -> None:
    """Factors by hand: 1 lbf = 4.4482216152605 N, 1 ft lbf = 1.3558179483314 N m, 1 rad = 180/pi deg."""
    found = own_number(typed)
    assert found.value == pytest.approx(value, rel=1e-9)
    assert found.u95 == (None if u95 is None else pytest.approx(u95, rel=1e-9))


def test_all_that_is_typed_wrongly_is_told_at_once() -> None:
    with pytest.raises(InputError) as caught:
        own_numbers(["Yv'=a", "Nr'=-0.01", "Yq=1 N/(m/s)", "Zz'=1"])
    assert len(caught.value.others) == 2


def test_a_rudder_has_its_limit_and_rate() -> None:
    (found,) = typed_file("own", ["Ydr'=0.01"], **WANTED, rudder="30 deg, 20 deg/s").surfaces
    assert (found.control, found.limit, found.rate) == ("dr", pytest.approx(np.pi / 6), pytest.approx(np.pi / 9))
    assert typed_file("own", ["Ydr'=0.01"], **WANTED, rudder="30 deg").surfaces[0].rate is None
    planes = typed_file("own", ["Zds'=-0.01"], **WANTED, bow_planes="10 deg", stern_planes="20 deg, 30 deg/s").surfaces
    assert [(s.control, s.limit, s.rate) for s in planes] == [
        ("ds", pytest.approx(np.pi / 9), pytest.approx(np.pi / 6)), ("db", pytest.approx(np.pi / 18), None),
    ]  # fmt: skip
    with pytest.raises(InputError, match="--stern-planes"):
        typed_file("own", ["Ydr'=0.01"], **WANTED, stern_planes="30")
    with pytest.raises(InputError, match="--rudder"):
        typed_file("own", ["Ydr'=0.01"], **WANTED, rudder="30")


def test_a_symbol_stands_once() -> None:
    with pytest.raises(InputError, match="Yv' twice"):
        own_numbers(["Yv'=1", "Yv=1 N/(m/s)"])


def test_a_file_of_them_holds_together_and_reads_back(tmp_path: Path) -> None:
    made = imported_file(
        "own", "hull", SCALING, AT, np.zeros(3), Datum("cg"), own_numbers(["Yv'=-0.03 +- 0.003", "Nv'=-0.012"]),
        mass_of(40.0, np.array([0.1, 0.0, 0.02]), (0.5, 12.0, 12.0)),
    )  # fmt: skip
    (tmp_path / "own.parameters.json").write_bytes(made.to_json())
    back = read_parameter_file(tmp_path / "own.parameters.json")
    assert back == made
    assert back.covariance.matrix == ((0.0015**2, None), (None, None))
    assert back.mass.mass_prime == pytest.approx(40.0 / (0.5 * 1000.0 * 8.0))
    assert back.mass.mass_moment == pytest.approx(4.0)
    assert back.mass.inertia_matrix[2, 2] == pytest.approx(12.0 + 40.0 * 0.01)
    assert back.mass.inertia_matrix[0, 2] == pytest.approx(-40.0 * 0.1 * 0.02)


WANTED = {"length": "2 m", "length_name": "LOA", "speed": "1", "density": "1000", "about": "cg"}


@pytest.mark.parametrize(
    ("change", "option"),
    [({"length": ""}, "--length"), ({"about": ""}, "--about"), ({"density": "1"}, "--density"), ({"speed": "0"}, "--speed"),
     ({"mass": "40", "about": "nose"}, "--cg"), ({"cg": "0,0,0"}, "--mass"), ({"volume": "0.04"}, "--cb"),
     ({"mass": "40", "inertia": "1,2,9"}, "--inertia")],
)  # fmt: skip
def test_nothing_is_assumed(change: dict[str, str], option: str) -> None:
    with pytest.raises(InputError) as caught:
        typed_file("own", ["Yv'=-0.03"], **{**WANTED, **change})
    assert caught.value.column == option
    assert typed_file("own", ["Yv'=-0.03"], **WANTED).mass is None


Edit = Callable[[dict[str, Any]], object]


def entry(content: dict[str, Any], symbol: str) -> dict[str, Any]:
    found: dict[str, Any] = next(c for c in content["coefficients"] if c["symbol"] == symbol)
    return found


WRONG: list[tuple[Edit, str]] = [
    (lambda d: d["mass"].update(mass_prime=0.05), "found mass_prime 0.05; expected 0.01, of mass 40 kg"),
    (lambda d: d["mass"].update(mass_moment_prime=0.001), "found mass_moment_prime 0.001; expected 0"),
    (lambda d: entry(d, "Yv'").update(unit_si=""), 'found Yv\': unit_si ""; expected N/(m/s)'),
    (lambda d: entry(d, "Nv'").pop("unit_si"), 'found nothing; expected "N*m/(m/s)"'),
    (lambda d: entry(d, "Nv'").update(unit_si="N/(m/s)"), "also written Nm/(m/s)"),
    (lambda d: entry(d, "Yv'").update(value_si=-61.0), "found Yv': value_si -61; expected its value -0.03"),
    (lambda d: entry(d, "Yv'").update(symbol="Yvv2'"), 'found "Yvv2\'"; expected a SNAME derivative'),
    (lambda d: entry(d, "Yv'").update(symbol="Y_v"), "Did you mean Yv'?"),
    (lambda d: entry(d, "Yv'").update(symbol="Yv\u2019"), "Did you mean Yv'?"),
    (lambda d: d["mass"].pop("mass_prime"), "found nothing; expected a value: m / (1/2 rho L^3)"),
]


@pytest.mark.parametrize(("edit", "said"), WRONG, ids=range(len(WRONG)))
def test_a_wrong_file_gets_one_found_and_one_expected(tmp_path: Path, edit: Edit, said: str) -> None:
    content = json.loads(BY_HAND)
    edit(content)
    (tmp_path / "p.json").write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_parameter_file(tmp_path / "p.json")
    message = str(caught.value)
    assert said in message
    assert message.count("found ") == message.count("expected ") == 1
    assert caught.value.line is not None


def test_all_that_is_wrong_comes_at_once_with_its_lines(tmp_path: Path) -> None:
    lines = BY_HAND.splitlines()
    wrong = BY_HAND.replace('"Yv\'", "value": -0.03', '"Y_v", "value": -0.03').replace('"Nrdot\'"', '"Nrdott\'"')
    (tmp_path / "p.json").write_text(wrong)
    with pytest.raises(InputError) as caught:
        read_parameter_file(tmp_path / "p.json")
    first, last = (next(k for k, s in enumerate(lines, 1) if f'"{name}' in s) for name in ("Yv'", "Nrdot'"))
    assert [e.line for e in (caught.value, *caught.value.others)] == [first, last]
    wrong = BY_HAND.replace('"value_si": -60.0', '"value_si": -61.0').replace(
        '"mass_prime": 0.01', '"mass_prime": 0.02'
    )
    (tmp_path / "p.json").write_text(wrong)
    with pytest.raises(InputError) as caught:
        read_parameter_file(tmp_path / "p.json")
    assert [e.line for e in (caught.value, *caught.value.others)] == [first, 8]


def test_lines_are_those_of_values_and_of_what_holds_a_missing_one() -> None:
    text = '{\n"a": {"b": [1,\n2, {}, {"c,}": "]\\""}],\n"d": null},\n"e": -1}'
    places = [("a", "b", 1), ("a", "b", 3, "c,}"), ("a", "d"), ("e",), ("a", "none"), ("f",), ()]
    assert list(lines_of(text, places).values()) == [3, 3, 4, 5, 2, 1, 1]


@pytest.mark.parametrize("symbol", ["Yv", "Nv", "Nr", "Yvdot", "Nr|r|", "X0", "N0", "Ydr"])
def test_the_other_spelling_is_one_that_is_taken(symbol: str) -> None:
    unit = derivative(symbol).unit
    assert same_unit(also_written(unit), unit), also_written(unit)


def test_a_moment_is_spelt_three_ways() -> None:
    assert same_unit("Nm/(m/s)", "N*m/(m/s)")
    assert same_unit("Nm s/m", "N*m/(m/s)")
    assert not same_unit("Nm/(m/s)", "N/(m/s)")
    assert not same_unit("", "N/(m/s)")


def said(content: dict[str, Any]) -> list[tuple[str, str]]:
    found = plausibility(ParameterFile.model_validate_json(json.dumps(content)))
    return [(c.severity, f"{c.subject}: {c.statistic}") for c in found if c.severity is not Severity.PASS]


def test_what_stands_twice_is_noted_where_it_differs() -> None:
    content = json.loads(BY_HAND)
    matrix = np.diag([1.0, 36.0, 36.0, 1.0, 8.0, 8.0]).tolist()
    content["added_mass"] = {"body": "placeholder", "method": "stated", "density": 1000.0, "matrix": matrix}
    assert not [s for _, s in said(content) if "stated twice" in s]
    matrix[1][1] = 40.0
    (found,) = [(k, s) for k, s in said(content) if "stated twice" in s]
    assert found[0] is Severity.NOTE
    assert "Yvdot' gives 36, added_mass 40" in found[1]
    content["mass"] |= {"centre": [0.0, 0.0, 0.0], "inertia_matrix": np.diag([1.0, 12.0, 13.0]).tolist()}
    assert [s for _, s in said(content) if "mass.inertia and" in s and "Iz 13" in s]


def test_ok_without_an_interval_is_a_warning() -> None:
    content = json.loads(BY_HAND)
    entry(content, "Nv'").update(status="ok")
    assert (Severity.WARN, "Nv': status ok without u95") in said(content)
    entry(content, "Nv'").update(u95=0.001)
    assert not [s for _, s in said(content) if "status ok" in s]


def law(*numbers: str) -> ParameterFile:
    return imported_file("law", "hull", SCALING, AT, np.zeros(3), Datum("cg"), own_numbers(numbers))


def test_one_number_is_replaced_in_its_place_and_no_other_with_it() -> None:
    base = law("Yv'=-0.03 +- 0.003", "Nv'=-0.012 +- 0.002", "Yv|v|'=-0.1", "Yvvv'=-0.2")
    made = merged(base, as_file(base, own_numbers(["Yv|v|=-300 +- 20 N/(m/s)^2"])), alone=True)
    values = {c.symbol: c.value for c in made.parameters.coefficients}
    assert values == pytest.approx({"Yv'": -0.03, "Nv'": -0.012, "Yv|v|'": -300.0 / 2000.0, "Yvvv'": -0.2})
    assert [r.symbol for r in made.replaced] == ["Yv|v|'"]
    changed = made.parameters.coefficient("Yv|v|")
    assert (changed.origin, changed.status, changed.u95) == ("stated", Status.STATED, pytest.approx(0.01))
    rows = made.parameters.covariance
    assert rows.matrix[rows.symbols.index("Nv'")][rows.symbols.index("Nv'")] == 0.001**2
    assert made.parameters.provenance.notes[-1] == "from --set: Yv|v|'"


def test_a_new_number_takes_the_place_of_the_terms_in_its_motions() -> None:
    base = law("Yv'=-0.03", "Yv|v|'=-0.1", "Yvvv'=-0.2", "Xu|u|'=-0.002")
    made = merged(base, as_file(base, own_numbers(["X0'=-0.0025"])), alone=True)
    assert [c.symbol for c in made.parameters.coefficients] == ["Yv'", "Yv|v|'", "Yvvv'", "X0'"]


DAMPING = {
    "Xu": -4.0,
    "Yv": -40.0,
    "Zw": -40.0,
    "Kp": -1.5,
    "Mq": -12.0,
    "Nr": -12.0,
    "Yr": 3.0,
    "Mw": 25.0,
    "Nv": -25.0,
    "Zq": 2.0,
}


def test_a_constant_acts_alike_at_every_speed_and_a_scaled_one_does_not() -> None:
    """Fossen's D: slopes of the water's force at 1, 1.5 and 2 m/s beside the typed numbers, by central differences."""
    units = {s: derivative(s).unit for s in DAMPING}
    for word, power in (("constant", 0), ("scaled", 1)):
        made = typed_file(
            "own", [f"{s}={v} {units[s]} {word} +- 10 %" for s, v in DAMPING.items()], **{**WANTED, "speed": "1.5"}
        )
        assert not made.findings
        law = force_law(made)
        for speed in (1.0, 1.5, 2.0):
            for s, v in DAMPING.items():
                at, step = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0]), 1e-6 * np.eye(6)["uvwpqr".index(s[1])]
                up, down = law.force(np.array([at + step, at - step]))[:, "XYZKMN".index(s[0])]
                factor = (speed / 1.5) ** power * (2.0 if (s, power) == ("Xu", 1) else 1.0)
                assert (up - down) / 2e-6 == pytest.approx(v * factor, rel=1e-6), (word, speed, s)


def test_si_values_say_what_they_do_at_other_speeds() -> None:
    """A finding a power of U, of those alone that are not stated to be constant or scaled, and whose force has a speed in it."""
    numbers = ["Yv=-40 N/(m/s)", "Nr=-12 N*m/(rad/s)", "Zw=-40 N/(m/s) constant", "Mq=-12 N*m/(rad/s) scaled", "Ydr=100 N/rad",
               "Yv|v|=-150 N/(m/s)^2", "Yvdot=-36 N/(m/s^2)", "Kp'=-0.01"]  # fmt: skip
    made = typed_file("own", numbers, **WANTED)
    assert [(f["symbols"], f["power"], f["twice"]) for f in made.findings] == [
        (("Yv", "Nr"), "U", 2.0),
        (("Ydr",), "U^2", 4.0),
    ]
    assert {c.symbol for c in made.coefficients if c.law == "rest"} == {"Zw'"}
    assert sum("scaled" in remark for remark in made.remarks) == 2
    assert sum(c.severity is Severity.NOTE and "Yv and Nr" in c.subject for c in plausibility(made)) == 1
    for typed in ("Yv'=-0.03 constant", "Yv=-40 N/(m/s) constant scaled", "Yv=-40 N/(m/s) rest"):
        with pytest.raises(InputError):
            own_number(typed)


def test_a_constant_stays_one_in_a_vehicle_of_another_speed() -> None:
    """Merged into a file of 1 m/s and fresh water from one of 2 m/s and the sea; what was replaced is no longer said to be scaled."""
    base = typed_file("base", ["Yv=-30 N/(m/s)", "Nr=-5 N*m/(rad/s)"], **WANTED)
    there = {**WANTED, "speed": "2", "density": "1025"}
    other = typed_file("other", ["Yv=-40 N/(m/s) constant +- 4"], **there)
    found = merged(base, other).parameters
    (yv,) = [c for c in found.coefficients if c.symbol == "Yv'"]
    assert (yv.law, yv.value_si) == ("rest", pytest.approx(-40.0))
    assert yv.u95 == pytest.approx(0.1 * abs(yv.value or 0.0))
    assert found.covariance.matrix[0][0] == pytest.approx((0.05 * (yv.value or 0.0)) ** 2)
    assert [f["symbols"] for f in found.findings] == [("Nr",)]


STATED = {"length": "3 m", "length_name": "LOA", "speed": "2 m/s", "density": "1025", "mass": "200 kg"}


@pytest.mark.parametrize(
    ("value", "warned"), [("-260", "Yv' = -260 (2)"), ("-2.1", "Yv' = -2.1 (2)"), ("-2.1 +- 0.2", ""), ("-1.9", "")]
)
def test_a_prime_beyond_that_of_a_plate_is_named(value: str, warned: str) -> None:
    p = typed_file("auv", [f"Yv'={value}", "Nv'=-0.02"], about="cg", inertia="3,120,120", **STATED)
    found = [c for c in plausibility(p) if c.subject == "Yv'" and c.severity is Severity.WARN]
    assert [c.statistic for c in found] == [warned] * bool(warned)
    other = p.model_copy(update={"scaling": Scaling(1.0, "1 m")})  # of no body: no plate of that side
    assert not [c for c in plausibility(other) if c.subject == "Yv'" and c.severity is Severity.WARN]


@pytest.mark.parametrize(
    ("about", "cg", "refused"),
    [
        ("nose", "-1500,0,30", "1499 m from the middle of LOA = 3 m"),
        ("nose", "4.6,0,0.03", "6.1 m from the middle"),
        ("midship", "-6.1,0,0", "6.1 m from the midship"),
        ("paper_axes", "-12.1,0,0", "12.1 m from the paper_axes"),
    ],
)
def test_a_centre_of_gravity_in_another_unit_is_refused(about: str, cg: str, refused: str) -> None:
    with pytest.raises(InputError, match="--cg") as why:
        typed_file("auv", ["Yv=-260 kg/s"], about=about, cg=cg, **STATED)
    assert refused in str(why.value)


@pytest.mark.parametrize(
    ("about", "cg", "warned"),
    [
        ("nose", "1.4,0,0.03", True),
        ("nose", "-1.4,0,0.03", False),
        ("midship", "-1.6,0,0", True),
        ("midship", "-1400 mm,0,30 mm", False),
        ("paper_axes", "-2.9,0,0", False),
        ("paper_axes", "-3.1,0,0", True),
    ],
)
def test_a_centre_of_gravity_beyond_the_ends_of_the_body_is_warned_of(about: str, cg: str, warned: bool) -> None:
    typed = typed_file("auv", ["Yv=-260 kg/s"], about=about, cg=cg, **STATED)
    found = [c.subject for c in plausibility(typed) if "ends of the body" in c.rule]
    assert found == ["auv"] * warned
