"""What words over a table say: numbers with a unit before words, ordinary spellings, and what contradicts itself is open."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from coeflab.tables.dialect import Marks
from coeflab.tables.questions import Question, questions
from coeflab.tables.raw_table import RawTable, Stated
from coeflab.tables.settings import Setting
from coeflab.tables.words_above import water_density, words_above


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
