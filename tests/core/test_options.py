"""Options of plugins: what they take, what they say about themselves."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.core.errors import InputError, UnitsError
from coeflab.core.options import bounded, described, measured, one_of, parse_options, words
from coeflab.fits import FITS


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a test.

    Attributes
    ----------
    area : float
        Of the ``fin``,
        on one side.
    kind : {"round", "flat"}
        Which.
    names : tuple of str
        Some.
    first, second : int
        Both alike.
    """

    area: float = measured(0.0, 0.0, 10.0, "area")
    kind: str = one_of("round", "round", "flat")
    names: tuple[str, ...] = words("a", "b")
    first: int = bounded(1, 0, 9)
    second: int = bounded(2, 0, 9)


@pytest.mark.parametrize(
    ("given", "area"), [(0.05, 0.05), ("0.05 m^2", 0.05), ("500 cm^2", 0.05), ("1 ft^2", 0.09290304), (2, 2.0)]
)
def test_an_area_is_si_or_carries_its_unit(given, area):
    assert parse_options(Options, {"area": given}, "x").area == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize("given", ["0.05", "0.05 m", "much", True, "20 m^2", -1.0])
def test_another_dimension_or_a_wild_area_is_refused(given):
    with pytest.raises((InputError, UnitsError)) as why:
        parse_options(Options, {"area": given}, "x")
    assert why.value.column == "x.area"


def test_every_option_is_described_by_the_docstring():
    area, kind, names, first, second = described(Options)
    assert (area.takes, area.default) == ("area, bare in m^2 or with its unit", "0 m^2")
    assert area.meaning == "Of the fin, on one side."
    assert (kind.takes, kind.default, kind.meaning) == ("round, flat", "round", "Which.")
    assert (names.takes, names.default) == ("words", "a b")
    assert first.meaning == second.meaning == "Both alike."
    assert second.takes == "whole number, 0 to 9"


@pytest.mark.parametrize(
    ("given", "hint"),
    [({"areas": 1}, "Did you mean area?"), ({"kind": "rond"}, "Did you mean round?"), ({"first": 10}, "")],
)
def test_a_wrong_option_points_to_the_explanation(given, hint):
    with pytest.raises(InputError) as why:
        parse_options(Options, given, "surface")
    assert hint in why.value.advice
    assert why.value.advice.endswith("`coeflab formats surface` explains every option.")


@pytest.mark.parametrize("room", [FITS, ADDED_MASS], ids=lambda r: r.package)
def test_every_option_of_every_plugin_has_a_meaning(room):
    for name in room.names():
        kind = getattr(room.load(name), "Options", None)
        for option in described(kind) if kind else ():
            assert option.meaning, f"{name}.{option.name}"
