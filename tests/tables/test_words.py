"""What words over a table say: numbers with a unit before words, ordinary spellings, and what contradicts itself is open."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tables.column_company import proposals
from coeflab.tables.column_map import read_column_map
from coeflab.tables.dialect import Marks
from coeflab.tables.interpretation import interpreted
from coeflab.tables.mapping import Assigned
from coeflab.tables.parts import Part
from coeflab.tables.proposals import proposed
from coeflab.tables.questions import Question, questions
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tables.settings import Setting, read_in, require_one_datum
from coeflab.tables.settings_in_files import against_words
from coeflab.tables.several_tables import form_together
from coeflab.tables.words.above import _STATED, words_above
from coeflab.tables.words.axes import FORMULA, TURN_OF_R
from coeflab.tables.words.points import POINT_FROM
from coeflab.tables.words.water import water_density


def said(*lines: str, marks: Marks | None = None) -> dict[str, Stated]:
    return words_above([(n, [line]) for n, line in enumerate(lines, start=1)], marks or Marks())


def asked(stated: Mapping[str, Stated], **settings: object) -> dict[str, Question]:
    raw = RawTable(Path("t.csv"), (), stated=stated)
    known = {key.replace("__", "."): Setting(value, "confirmed") for key, value in settings.items()}
    return {q.key: q for q in questions(raw, (), known)}


@pytest.mark.parametrize(
    ("line", "density"),
    [
        ("Towing tank, density 1025 kg/m^3", 1025.0),
        ("Schleppkanal, Dichte 1025 kg/m³", 1025.0),
        ("Towing tank; Wasserdichte 1025 kg/m3", 1025.0),
        ("sea water 1025 kg/m3", 1025.0),
        ("Towing tank, water of 1.025 g/cm^3", 1025.0),
        ("towing tank, density 1.025 kg/m3", 1025.0),
        ("wind tunnel, air density 1.21 kg/m^3 at 20 °C", 1.21),
        ("fresh water, foam of 80 kg/m3, 1000 kg/m3", 1000.0),
    ],
)
def test_a_number_with_a_unit_of_density_wins_over_words(line: str, density: float) -> None:
    marks = Marks(",", ".") if "1.025 kg" in line else Marks()
    one = asked(said(line, marks=marks))["conditions.density"]
    assert float(one.default) == pytest.approx(density), one
    assert one.why.startswith('line 1: "')


@pytest.mark.parametrize("line", ["sea water, density 1100 kg/m3", "fresh water, rho = 1.2 kg/m^3", "fresh water; rho = 1100",
                                  "density 1000 kg/m3, density 1025 kg/m3"])  # fmt: skip
def test_a_density_that_contradicts_the_words_is_open(line: str) -> None:
    one = asked(said(line))["conditions.density"]
    assert one.open
    assert "line 1" in one.choices
    assert "but" in one.choices


@pytest.mark.parametrize(
    ("line", "celsius", "salt"),
    [("fresh water 18 °C", 18, 0), ("fresh water, 12 °C", 12, 0), ("tank at 12 °C", 12, 0), ("water of 12,5 °C", 12.5, 0),
     ("Süßwasser 15 °C", 15, 0), ("sea water 8 °C", 8, 35), ("T = 12 °C", 12, 0), ("temperature 12 °C", 12, 0),
     ("Wassertemperatur 7 Grad Celsius", 7, 0), ("air at 22 °C, fresh water 12 °C ± 1 °C", 12, 0)],
)  # fmt: skip
def test_temperatures_in_ordinary_spelling_are_those_of_the_water(line: str, celsius: float, salt: float) -> None:
    one = said(line)["conditions.density"]
    assert one.value == pytest.approx(water_density(celsius, salt), abs=0.051)
    assert f"of {celsius:g} °C" in one.place
    assert "conditions.density" not in said("wind tunnel at 20 °C")


@pytest.mark.parametrize(
    "line",
    ["reference length c = 2.4 m", "reference length 2.4 m", "c_ref = 2.4 m", "chord c = 2.4 m", "Lref = 2.4 m", "Bezugslänge 2400 mm",
     "reference length: 2.4 m", "L_ref = 2.4 m", "reference length L = 2.4 m", "mean chord (c) of 2.4 m", "reference length c: 240 cm"],
)  # fmt: skip
def test_the_reference_length_of_coefficients_in_ordinary_words(line: str) -> None:
    found = said(f"CMy by {line}, A = 0.2 m^2")
    assert found["coefficients.length"].value == pytest.approx(2.4)
    assert found["coefficients.area"].value == pytest.approx(0.2)
    assert "scaling.length" not in found or found["scaling.length"].contradicted


def test_the_overall_length_wins_over_a_diameter() -> None:
    """Primes by a tenth of the length are a hundred times too large."""
    for words in ("overall length 3.0 m", "LOA = 3.0 m", "Länge über alles: 3,0 m"):
        found = said("Lref = 0.30 m (diameter), Aref = 0.07 m^2", words)
        assert found["scaling.length"].value == 3.0
        assert found["coefficients.length"].value == 0.3
        assert found["scaling.length_name"].value == "LOA"
        force = [Assigned(RawColumn("CN", "-", np.ones(3)), read_column_map("N [coefficient A=0.07 m^2 L=0.3 m]"))]
        raw = RawTable(Path("t.csv"), (), stated=found)
        assert next(q for q in questions(raw, force, {}) if q.key == "scaling.length").default == "3"


@pytest.mark.parametrize("words", ["Lref = 0.30 m (diameter)", "chord c = 0.3 m", "reference length 0.3 m (beam)",
                                   "reference length (diameter) = 0.3 m", "reference length 0.3 m, the hull diameter"])  # fmt: skip
def test_a_length_across_the_body_leaves_that_of_the_primes_open(words: str) -> None:
    force = [Assigned(RawColumn("CN", "-", np.ones(3)), read_column_map("N [coefficient A=0.07 m^2 L=0.3 m]"))]
    found = {q.key: q for q in questions(RawTable(Path("t.csv"), (), stated=said(words)), force, {})}
    assert found["scaling.length"].open
    assert "line 1" in found["scaling.length"].choices


def test_a_reference_point_beyond_the_length_of_the_coefficients_leaves_that_of_the_primes_open() -> None:
    force = [Assigned(RawColumn("CN", "-", np.ones(3)), read_column_map("N [coefficient A=0.07 m^2 L=0.3 m]"))]
    assert "scaling.length" not in said("Lref = 3.0 m, diameter 0.3 m")
    raw = RawTable(Path("t.csv"), ())
    for x, is_open in ((-1.5, True), (-0.2, False)):
        known = {"axes.datum": Setting("nose", "said"), "axes.reference_point": Setting([x, 0.0, 0.0], "said")}
        one = next(q for q in questions(raw, force, known) if q.key == "scaling.length")
        assert one.open is is_open
        assert ("1.5 m from the nose" in one.choices) is is_open


def test_time_for_a_line_of_blanks_grows_with_its_length() -> None:
    def seconds(blanks: int) -> float:
        line = f"reference length{' ' * blanks}x"
        start = time.process_time()
        list(_STATED.finditer(line))
        return time.process_time() - start

    assert seconds(1900) < 0.5  # was 9 s
    assert said(f"L{' ' * 400}= 4.2 m")["scaling.length"].value == 4.2


def test_two_lines_that_differ_leave_a_key_open() -> None:
    found = said("reference length 0.3 m", "Lref = 0.4 m, Lpp = 3.0 m; speed 2", "L = 3.1 m")
    one = asked(found)["scaling.length"]
    assert one.open
    assert 'line 2: "Lpp = 3.0 m", but line 3: "L = 3.1 m"' in one.choices
    raw = RawTable(Path("t.csv"), (RawColumn("CMz", "-", np.ones(3)),), stated=found)
    assert "L=?" in proposals(raw, {"coefficients.area": 0.1})[0].text


@pytest.mark.parametrize(
    ("name", "unit", "cells", "text"),
    [("Mz", "Nm", ("8,1", "149.19", "-8,1"), ""), ("Giermoment am Modell", "Nm", ("8,1", "149.19", "-8,1"), ""),
     ("Fy", "N", ("8.1", "1.2", "9.1"), ""), ("N", "N*m", ("8,1", "149.19", "-8,1"), ""),
     ("Mz", "Nm", ("8,1", "9,9 *", "-8,1"), "N [Nm]"), ("Bemerkung", "", ("a", "149.19", "b"), "ignore"),
     ("Fy", "N", ("diverged", "stalled", "x"), ""), ("Datum", "", ("1.2.24", "2.2.24", "3.2.24"), "ignore")],
)  # fmt: skip
def test_a_force_among_whose_numbers_are_other_decimal_marks_is_open(
    name: str, unit: str, cells: tuple[str, ...], text: str
) -> None:
    """As text it would be a label, and its slopes would be gone without a word."""
    marks = Marks(",")
    values = np.array([math.nan if (x := marks.number(c)) is None else x for c in cells])
    one = proposed(RawColumn(name, unit, values, cells))
    assert one.text == text
    if not text:
        assert any(f'"{c}"' in one.why for c in ("149.19", "8.1", "diverged") if c in cells)


@pytest.mark.parametrize(
    ("line", "holds"),
    [("forces not corrected for model mass 820 kg", True), ("inertia of the model included / not subtracted", True),
     ("uncorrected for inertia", True), ("corrected for inertia", False), ("inertia subtracted", False),
     ("forces contain the inertia of the model", True), ("Massenkräfte nicht abgezogen", True), ("Kräfte mit Trägheitsanteil", True), ("Trägheitsanteile herausgerechnet", False),
     ("mit Trägheitskorrektur", False), ("with inertia corrections", False), ("Kräfte inkl Massenkräfte", True), ("Massenkräfte abgezogen", False),
     ("um die Trägheit des Modells korrigiert", False), ("without inertia correction", True), ("forces without inertia", False),
     ("the inertia is not included", False), ("inertie non soustraite", True), ("not corrected for blockage; mass 820 kg", None),
     ("moments of inertia included below", None), ("blockage corrected, model mass 820 kg", None)],
)  # fmt: skip
def test_words_of_inertia_are_proposed(line: str, holds: bool | None) -> None:
    found = said(f"Rotating arm, {line}").get("table.contains_inertia")
    assert (found.value if found else None) is holds
    if "820" in line:
        assert said(line)["inertia.mass"].value == 820.0


def test_a_line_that_the_delimiter_split_is_one_sentence() -> None:
    """Else "corrected" of one clause would be about the mass of the next."""
    found = words_above([(1, ["blockage corrected", "model mass 820 kg", "Wassertemperatur", "12", "°C"])], Marks())
    assert "table.contains_inertia" not in found
    assert (found["inertia.mass"].value, found["conditions.density"].value) == (820.0, 999.5)


ARM = (Assigned(RawColumn("R", "m", np.array([8.0, 10.0, 12.0])), read_column_map("R [m]")),)


def of_arm(stated: Mapping[str, Stated], **settings: object) -> dict[str, Question]:
    known = {key.replace("__", "."): Setting(value, "confirmed") for key, value in settings.items()}
    return {q.key: q for q in questions(RawTable(Path("t.csv"), (), stated=stated), ARM, known)}


def test_mass_and_centre_of_gravity_of_words_are_in_the_form_at_once() -> None:
    found = said("uncorrected for inertia, model mass 820 kg, centre of gravity 1.2 m aft of the nose")
    one = of_arm(found, axes__datum="nose")
    assert (one["table.contains_inertia"].default, one["inertia.mass"].default) == ("true", "820")
    assert one["inertia.centre_of_gravity"].default == "-1.2, 0, 0"
    assert "1.2 m aft of the nose" in of_arm(found, axes__datum="midship")["inertia.centre_of_gravity"].choices
    assert of_arm(found, axes__datum="midship")["inertia.centre_of_gravity"].open
    assert "inertia.mass" not in asked(found)  # a straight tow
    assert "inertia.mass" not in of_arm(said("corrected for inertia, model mass 820 kg"))
    assert of_arm(said("xG = -0.05 m; inertia included"))["inertia.centre_of_gravity"].open
    both = of_arm(said("corrected for inertia", "inertia included"))["table.contains_inertia"]
    assert both.open
    assert "line 1" in both.choices
    assert "line 2" in both.choices


def test_words_against_a_proposal_or_a_setting_are_named() -> None:
    """A side by the numbers or a solver's habit does not overrule a line; nor does --set without a mark."""
    yaw = RawColumn("Mz", "N*m", np.array([-1.0, -0.8, -0.7]))
    columns = (*ARM, Assigned(yaw, read_column_map("N [N*m]")))
    for words, side, is_open in (("all turns to starboard", "port", False), ("all turns to port", "starboard", True)):
        frame = {"axes.frame": Setting("FRD", "confirmed")}
        raw = RawTable(Path("t.csv"), (*(c.column for c in columns),), stated=said(words))
        one = next(q for q in questions(raw, columns, frame) if q.key == "table.centre")
        assert one.open is is_open, one
        assert not is_open or ('line 1: "all turns to port"' in one.choices and "Nr' < 0" in one.choices)
        known = {"table.centre": Setting(side, "confirmed")}
        found = interpreted(raw, {"R": read_column_map("R [m]"), "Mz": read_column_map("N [N*m]")}, known)
        assert any(e.text.startswith("warning: table.centre") and "line 1" in e.text for e in found.shows)
        line = next(one for one in form_together([Part("", raw, "", {})], [found], known) if one.key == "table.centre")
        assert line.why == f'! but line 1: "{words}"'
    assert "table.centre" not in said("r > 0 turns to starboard; positive rudder turns to port")


@pytest.mark.parametrize(("key", "value", "said_of"), [("conditions.density", 998.0, "density 1025 kg/m3"), ("inertia.mass", "900 kg", "mass 820 kg"),
                         ("table.contains_inertia", False, "inertia included"), ("axes.frame", "FRD", "x aft, y starboard, z up")])  # fmt: skip
def test_a_setting_against_the_words_is_marked(key: str, value: object, said_of: str) -> None:
    raw = RawTable(Path("t.csv"), (), stated=said(said_of))
    [(marked, _, place)] = against_words(raw, {key: Setting(value, "confirmed")})
    assert marked == key
    assert place.startswith("line 1")


@pytest.mark.parametrize(
    ("line", "point", "is_open"),
    [("Bezugspunkt der Momente: 1,2 m hinter dem Bug", "-1.2 m nose", False), ("moments about 2.013 m from FP", "-2.013 m FP", False),
     ("moments réduits au point x = 1.2 m du nez", "-1.2 m nose", False), ("Momente um x/L = 0.45", "-0.45 L nose?", False),
     ("Momentenbezugspunkt 45 % der Länge", "-0.45 L nose?", False), ("reference point 1.9 m forward of AP", "1.9 m AP", False),
     ("moments about 2100 mm aft of bow", "-2.1 m nose", False), ("reference point 0.2 m from midships", "0.2 m midship", True),
     ("reference point x = 1.2 m", "1.2 m nose?", True), ("moments about 1.2 m aft of the nose, 0.1 m below the axis", "-1.2 m nose", True),
     ("Moments about LCB, 2.31 m aft of the nose", "-2.31 m nose", False), ("about the body; moments about LCB (2.31 m aft of FP)", "-2.31 m FP", False),
     ("moments about the centre of gravity, x = 2.25 m aft of the nose", "-2.25 m nose", False), ("moments about LCB = 0.19 m forward of midships", "0.19 m midship", False),
     ("Moments about LCB, at its height", "0 m nose?", True), ("moments about the body axes", "", False), ("moments about CG, 3 m/s", "", False),
     ("Moments about midships, length 4.3 m", "", False), ("moments about midships; model mass 820 kg", "", False)],
)  # fmt: skip
def test_a_number_for_the_point_of_the_moments(line: str, point: str, is_open: bool) -> None:
    """A side that no word says is open; a share of the length without a point counts aft of the nose, which is said."""
    found = said(line, marks=Marks(",") if "1,2" in line else None)
    assert str(found[POINT_FROM].value) == point if point else POINT_FROM not in found
    if point:
        one = asked({**found, "scaling.length": Stated(4.0, "line 9", offered=True)})["axes.reference_point"]
        assert one.open is is_open
        assert "line 1" in (one.choices if is_open else one.why)
        assert ("it does not say" in one.why) is (point.endswith("?") and not is_open)


def test_a_point_that_two_lines_give_differently_is_open_and_another_datum_is_not_mixed_in() -> None:
    two = said("moments about 1.2 m aft of the nose", "MRP 1.4 m aft of the nose")
    assert "line 2" in asked(two)["axes.reference_point"].choices
    assert asked(two)["axes.reference_point"].open
    one = said("moments about 1.2 m aft of the nose")
    assert asked(one, axes__datum="midship")["axes.reference_point"].open
    assert asked(one, axes__datum="bow")["axes.reference_point"].default == "-1.2, 0, 0"
    known = {"axes.datum": Setting("nose", "said"), "axes.reference_point": Setting([-1.0, 0.0, 0.0], "said")}
    [(marked, _, place)] = against_words(RawTable(Path("t.csv"), (), stated=one), known)
    assert (marked, place[:6]) == ("axes.reference_point", "line 1")


def test_left_handed_axes_are_named() -> None:
    one = asked(said("Modell 3", "x vorn, y Steuerbord, z oben"))["axes.frame"]
    assert one.open
    assert "line 2 is left-handed: x forward, y starboard, z up" in one.choices
    assert asked(said("x vorn, y Steuerbord, z unten"))["axes.frame"].default == "FRD"


def arm_asked(*lines: str, **settings: object) -> Question:
    """What is asked of the point of the arm over a table with radii."""
    raw = RawTable(Path("t.csv"), (), stated=said(*lines))
    arm = [Assigned(RawColumn("R", "m", np.array([10.0, -10.0])), read_column_map("R [m]"))]
    known = {key.replace("__", "."): Setting(value, "confirmed") for key, value in settings.items()}
    return next(q for q in questions(raw, arm, known) if q.key == "table.arm_point")


@pytest.mark.parametrize(
    ("line", "x"),
    [
        (
            "Model held on the arm at a point 2.75 m aft of the nose, which runs on R; R positive: centre to starboard",
            -2.75,
        ),
        ("R measured to a point 275 cm aft of the bow", -2.75),
        ("Modell am Arm befestigt bei 2,75 m hinter dem Bug", -2.75),
        ("Arm point 0.40 m aft of the moment point", -2.35 - 0.40),
        ("U and R are those of the reference point", -2.35),
        ("the arm holds the model 2.75 m aft of the nose", -2.75),
        ("towed at the reference point; R positive to starboard", -2.35),
        ("tow post at 2.75 m aft of the bow", -2.75),
        ("strut attached 2750 mm abaft the nose", -2.75),
        ("R is the radius of the path of the nose", 0.0),
        ("Führungspunkt 2,75 m hinter dem Bug", -2.75),
        ("point de remorquage 2,75 m en arrière de l'étrave", -2.75),
    ],
)
def test_words_on_the_point_of_the_arm_are_quoted_and_proposed(line: str, x: float) -> None:
    """The reference point in its place moves Yr' by the arm between them times Yv'."""
    one = arm_asked(line, axes__datum="nose", axes__reference_point=[-2.35, 0.0, 0.0])
    assert [float(part) for part in one.default.split(",")] == pytest.approx([x, 0.0, 0.0])
    assert "line 1" in one.short
    assert not arm_asked(line).open


@pytest.mark.parametrize("line", ["R is measured to the strut", "Arm attached at the balance", "Arm point 0.4 m aft",
                                  "Arm point 2.75 m aft of the nose and 0.2 m below the axis"])  # fmt: skip
def test_words_on_the_point_of_the_arm_without_number_or_datum_leave_it_open(line: str) -> None:
    one = arm_asked(line, axes__datum="nose", axes__reference_point=[-2.35, 0.0, 0.0])
    assert one.open
    assert f'line 1: "{line}"' in one.choices


@pytest.mark.parametrize("line", ["Rudders fixed at 5 deg", "Model held at a constant speed of 3 m/s", "Body fixed axes at midship", "R of 20 m", "speed of 2 m/s at midwater", "towed at 2 m/s", "tow post of steel", "centre of rotation 20 m to starboard",
                                  "Moments about a point 2.35 m aft of the nose", "Model fixed in heave and pitch"])  # fmt: skip
def test_other_words_leave_the_point_of_the_arm_to_its_default(line: str) -> None:
    assert arm_asked(line).shown == "the reference point"


def test_a_french_line_gives_axes_point_and_centre_of_gravity() -> None:
    """The article before a vowel hid the point: l'étrave, l'avant."""
    found = said(
        "x vers l'avant, y vers tribord, z vers le bas; moments par rapport à 1.9 m en arrière de l'étrave; centre de gravité 1.95 m en arrière de l'étrave"
    )
    assert found["axes.frame"].value == "FRD"
    assert (found["axes.from"].value, found["inertia.from"].value) == ("-1.9 m nose", "-1.95 nose")


def test_a_point_of_the_arm_from_a_named_point() -> None:
    assert read_in("Arm/table.arm_point", "-2.75 from nose") == {
        "Arm/table.arm_point": [-2.75, 0.0, 0.0],
        "axes.datum": "nose",
    }
    assert read_in("Arm/table.reference_point", "-2.3 from nose") == {
        "Arm/table.reference_point": [-2.3, 0.0, 0.0],
        "axes.datum": "nose",
    }
    own = read_in("table.reference_point", "-0.1 from midship")
    with pytest.raises(InputError, match=r"table\.reference_point from the same point"):
        require_one_datum({"axes.datum": Setting("nose", "confirmed")}, own)
    with pytest.raises(InputError, match="midship"):
        require_one_datum({"axes.datum": Setting("nose", "confirmed")}, read_in("table.arm_point", "-0.1 from midship"))


@pytest.mark.parametrize(
    ("line", "key", "value"),
    [
        ("beta = -asin(v/U)", FORMULA, "v = -U sin(beta)"),
        ("drift, v' = - sin β", FORMULA, "v = -U sin(beta)"),
        ("β = arcsin (v/U), alpha = 0", FORMULA, "v = +U sin(beta)"),
        ("v=U*sin(beta)", FORMULA, "v = +U sin(beta)"),
        ("Drift angle positive with the bow to port of the course", "axes.beta", "v = +U sin(beta)"),
        ("Drift angle positive with the bow to starboard of the course", "axes.beta", "v = -U sin(beta)"),
        ("Driftwinkel positiv: Bug nach Backbord", "axes.beta", "v = +U sin(beta)"),
        ("beta negative with the bow to port", "axes.beta", "v = -U sin(beta)"),
        ("sideslip positive with the flow from starboard", "axes.beta", "v = +U sin(beta)"),
        ("Angle of attack positive with the bow down", "axes.alpha", "w = -U sin(alpha)"),
        ("Anstellwinkel positiv, Bug oben; Anstellwinkel positiv mit Bug nach oben", "axes.alpha", "w = +U sin(alpha)"),
        ("r positiv nach Backbord drehend", TURN_OF_R, "port"),
        ("yaw rate positive to starboard", TURN_OF_R, "starboard"),
    ],
)
def test_words_on_the_sign_of_an_angle_or_a_rate(line: str, key: str, value: str) -> None:
    found = said(line)
    assert found[key].value == value
    assert "line 1" in found[key].place
    assert found[key].place.count("(") == found[key].place.count(")")


@pytest.mark.parametrize("line", ["R positive: centre of the circle to starboard", "Y positive to starboard, N positive bow to starboard",
                                  "Drift angle positive to starboard", "drift angle from -10 to 10 deg, bow to port",
                                  "delta_r positive: trailing edge to port"])  # fmt: skip
def test_other_words_say_no_sign_of_an_angle(line: str) -> None:
    assert not {"axes.alpha", "axes.beta", TURN_OF_R} & set(said(line))


def test_a_sign_in_words_that_the_numbers_contradict_is_open() -> None:
    b, y = np.array([-8.0, -4.0, 0.0, 4.0, 8.0]), np.array([-2.0, -1.0, 0.0, 1.0, 2.0])

    def asked_of(line: str, rate: str = "") -> tuple[dict[str, Question], list[str]]:
        columns = [RawColumn("beta", "deg", b), RawColumn("Y", "N", y)]
        columns += [
            RawColumn("r", "deg/s", b[::-1] * 0 + np.array([1.0, 2, 0, 1, 2])),
            RawColumn("N", "N*m", -b),
        ] * bool(rate)
        raw = RawTable(Path("t.csv"), tuple(columns), 0, np.arange(5), stated=said(*filter(None, (line, rate))))
        found = interpreted(raw, {}, {"axes.frame": Setting("FRD", "confirmed")}, accept=True)
        return {q.key: q for q in found.questions}, [d.why for d in found.doubts]

    beta = asked_of("Drift angle positive with the bow to starboard of the course")[0]["axes.beta"]
    assert beta.default == "v = -U sin(beta)", "Y and beta have the same sign, as the words say"
    assert "line 1" in beta.why, "the words state it: nothing is inferred from Yv' < 0"
    assert asked_of("v = +U sin(beta)")[0]["axes.beta"].open
    beta = asked_of("Drift angle positive with the bow to port of the course")[0]["axes.beta"]
    assert beta.open
    assert "bow to port" in beta.choices
    assert "but v = -U sin(beta)" in beta.choices
    assert not any("by the axes" in why for why in asked_of("", "r positive turning to starboard")[1])
    assert any(
        "by the axes r > 0 turns the bow to starboard" in why for why in asked_of("", "r positive turning to port")[1]
    )


@pytest.mark.parametrize(
    ("axes", "line", "sign"),
    [("x forward, y starboard, z down", "v = U sin(beta)", "+"), ("x forward, y to port, z up", "v = U sin(beta)", "-"),
     ("x forward, y to port, z up", "beta = -asin(v/U)", "+"), ("x aft, y starboard, z up", "v = -U sin(beta)", "-"),
     ("x aft, y port, z down", "v = U sin(beta)", "-"), ("x forward, y to port, z up", "v = U sin(beta); beta positive with the bow to starboard", "-"),
     ("x forward, y to port, z up", "v = U sin(beta); beta positive with the bow to port", ""), ("x forward, y up, z starboard", "v = U sin(beta)", ""),
     ("Towing tank", "v = U sin(beta)", "")],
)  # fmt: skip
@pytest.mark.parametrize("first", [True, False])
def test_a_formula_of_v_counts_in_the_axes_of_its_file(axes: str, line: str, sign: str, first: bool) -> None:
    """N = 500 sin(beta) of a sheet in FLU came out as Nv' < 0 by a formula of v to port."""
    b = np.array([-8.0, -4.0, 0.0, 4.0, 8.0])
    columns = (RawColumn("beta", "deg", b), RawColumn("N", "N m", b))
    raw = RawTable(Path("t.csv"), columns, lines=np.arange(5), stated=said(*(axes, line)[:: 1 if first else -1]))
    beta = {q.key: q for q in interpreted(raw, {}, {}, accept=True).questions}["axes.beta"]
    assert beta.default == (f"v = {sign}U sin(beta)" if sign else "")
    known = {"axes.frame": Setting(["forward", "port", "up"], "confirmed")}
    if sign:  # a frame by hand goes before that in words
        against = [key for key, *_ in against_words(raw, known | {"axes.beta": Setting(beta.default, "confirmed")})]
        assert ("axes.beta" in against) == ("port" not in axes)


@pytest.mark.parametrize(
    ("line", "speed"),
    [
        ("LOA = 5.2 m, fresh water 17 °C, carriage speed 3.0 m/s", 3.0),
        ("towing speed 3 m/s", 3.0),
        ("speed 5.83 kn", 5.83 * 1852 / 3600),
        ("Schleppgeschwindigkeit 3,0 m/s", 3.0),
        ("at a speed of 10.8 km/h", 3.0),
    ],
)
def test_a_speed_in_words_without_a_sign(line: str, speed: float) -> None:
    assert said(line)["conditions.speed"].value == pytest.approx(speed)


@pytest.mark.parametrize(
    "line",
    ["wind speed 3 m/s", "speed 2 m/s and 3 m/s", "speeds 2 to 3 m/s", "speed above 3 m/s", "speed of sound 1480 m/s"],
)
def test_other_speeds_are_not_taken(line: str) -> None:
    assert "conditions.speed" not in said(line)


def test_a_german_overall_length_and_primes_by_the_volume() -> None:
    found = said("Lüa = 2,30 m; Momentenbezugspunkt 1,05 m hinter dem Bug", marks=Marks(",", "."))
    assert found["scaling.length"].value == pytest.approx(2.3)
    assert found["scaling.length_name"].value == "LOA"
    for words in ("forces by 1/2 rho U^2 V^(2/3)", "Volumen^2/3", "∇^{2/3}"):
        one = asked(said("LOA = 2.3 m", words))["scaling.length"]
        assert one.open
        assert "line 2" in one.choices
        assert "V^(1/3)" in one.choices


@pytest.mark.parametrize(
    ("behind", "point"),
    [("m", "-2, -0.1, -0.3"), ("m, in FRD", "-2, 0.1, 0.3"), ("m (FLU)", "-2, -0.1, -0.3"), ("m in the FRD frame", "-2, 0.1, 0.3"),
     ("m in the CFD model", "-2, -0.1, -0.3"), ("m in CFD axes", "2, 0.1, -0.3")],
)  # fmt: skip
def test_a_point_with_a_frame_of_its_own_is_read_in_that(behind: str, point: str) -> None:
    """The place of a load cell in FRD over a table in FLU was turned: 0.6 m below its place, and on the other side."""
    found = said(f"moments about the load cell at (-2.0, 0.1, 0.3) {behind}")
    one = asked(found, axes__frame="FLU")["axes.reference_point"]
    assert one.default == point
    assert "FRD" not in behind or "FRD" in one.why


@pytest.mark.parametrize("unit", ["mm", "[mm]", "in mm", "(mm), in FRD"])
def test_coordinates_of_a_point_have_their_unit(unit: str) -> None:
    assert said(f"moments about the balance at (-2000 100 300) {unit}")["axes.reference_point"].value == (
        -2.0,
        0.1,
        0.3,
    )
