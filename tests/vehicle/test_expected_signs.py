"""Wrong signs and sizes of slopes and controls at speed are found, whatever the terms are called."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.units import same_unit
from coeflab.study.study import Study
from coeflab.vehicle.expected_signs import control_signs, sign_findings
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.plausibility import plausibility
from tests.formats.vehicles import FACTS, vehicle

SHIPPED = sorted(Path(str(shipped("cfd_data"))).glob("*/*.parameters.json"))
PER_DEGREE = 0.017453292519943295


def remus(**factors: float) -> ParameterFile:
    """The shipped file with coefficients times factors; ``Yuv`` stands for Yuv'."""
    file = read_parameter_file(Path("remus100"))
    changed = tuple(
        replace(c, value=f * c.value, value_si=f * c.value_si)
        if (f := factors.get(c.symbol.removesuffix("'"))) is not None and c.value is not None and c.value_si is not None
        else c
        for c in file.coefficients
    )
    return file.model_copy(update={"coefficients": changed})


def found(file: ParameterFile) -> Mapping[str, Severity]:
    return {c.subject: c.severity for c in sign_findings(file) if c.severity is not Severity.PASS}


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.name.partition(".")[0])
def test_shipped_vehicles_have_none(path: Path) -> None:
    assert found(read_parameter_file(path)) == {}


@pytest.mark.parametrize("name", FACTS)
def test_published_vehicles_have_none(name: str) -> None:
    assert found(vehicle(name)) == {}


def test_suboff_has_none(suboff: Study) -> None:
    assert [(name, told) for name, file in suboff.parameter_files.items() if (told := found(file))] == []


def test_both_planes_flipped_together_fail() -> None:
    """Pairs of yaw and pitch agree; nothing but the sign at speed tells."""
    told = found(remus(Yuv=-1.0, Nuv=-1.0, Zuw=-1.0, Muw=-1.0))
    assert told == dict.fromkeys(("Yuv'", "Nuv'", "Zuw'", "Muw'"), Severity.FAIL)
    assert any(c.severity is Severity.FAIL for c in plausibility(remus(Yuv=-1.0, Zuw=-1.0)))


@pytest.mark.parametrize(
    ("symbols", "severity"),
    [
        (("Yuv", "Zuw"), Severity.FAIL), (("Nuv", "Muw"), Severity.FAIL), (("Nur", "Muq"), Severity.FAIL),
        (("Yur", "Zuq"), Severity.WARN),
    ],
)  # fmt: skip
def test_one_kind_flipped_in_both_planes(symbols: tuple[str, ...], severity: Severity) -> None:
    told = found(remus(**dict.fromkeys(symbols, -1.0)))
    assert {told[f"{s}'"] for s in symbols} == {severity}


@pytest.mark.parametrize("factor", [0.5, 0.8, 1.25])
def test_another_size_of_the_same_sign_passes(factor: float) -> None:
    assert found(remus(Yuv=factor, Zuw=factor)) == {}
    assert found(remus(Nuv=factor, Muw=factor)) == {}


@pytest.mark.parametrize(("symbol", "pair"), [("Ndr", "Ydr', Ndr'"), ("Ydr", "Ydr', Ndr'"), ("Mds", "Zds', Mds'")])
def test_a_rudder_that_would_stand_ahead(symbol: str, pair: str) -> None:
    assert found(remus(**{symbol: -1.0})) == {pair: Severity.WARN}


def test_controls_per_degree() -> None:
    assert found(remus(Ydr=PER_DEGREE, Ndr=PER_DEGREE)) == {"Ydr'": Severity.WARN, "Ydr', Zds'": Severity.WARN}
    every = dict.fromkeys(("Ydr", "Ndr", "Zds", "Mds"), PER_DEGREE)
    assert found(remus(**every)) == {"Ydr'": Severity.WARN, "Zds'": Severity.WARN}
    assert found(remus(Ndr=PER_DEGREE)) == {"Ydr', Ndr'": Severity.WARN}
    assert "Ydr', Zds'" in found(remus(Zds=57.0, Mds=57.0))


def test_what_a_control_does_is_said_by_the_signs_of_the_file() -> None:
    assert control_signs(remus()) == ("dr > 0: turns to port (Ndr < 0)", "ds > 0: bow down (Mds < 0)")
    turned = remus(Ydr=-1.0, Ndr=-1.0, Zds=-1.0, Mds=-1.0)
    assert control_signs(turned) == ("dr > 0: turns to starboard (Ndr > 0)", "ds > 0: bow up (Mds > 0)")
    assert control_signs(remus(Ndr=0.0)) == ("dr > 0: pushes to starboard (Ydr > 0)", "ds > 0: bow down (Mds < 0)")
    assert control_signs(remus(Ydr=0.0, Ndr=0.0, Zds=0.0, Mds=0.0)) == ()


@pytest.mark.parametrize(("symbol", "unit"), [("Ydr'", "N/(deg)"), ("Ndr'", "N/(rad)"), ("Nur'", "N*m/(m/s)/(deg/s)")])
def test_a_unit_that_is_not_that_of_the_symbol_is_refused(tmp_path: Path, symbol: str, unit: str) -> None:
    file = read_parameter_file(Path("remus100"))
    changed = tuple(replace(c, unit_si=unit) if c.symbol == symbol else c for c in file.coefficients)
    (tmp_path / "a.json").write_bytes(file.model_copy(update={"coefficients": changed}).to_json())
    with pytest.raises(InputError, match="unit_si") as why:
        read_parameter_file(tmp_path / "a.json")
    assert symbol in str(why.value)
    assert unit in str(why.value)


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("N s/m", "N/(m/s)", True), ("N/rad", "N/(rad)", True), ("N/(m/s)^2", "kg/m", True), ("N/(deg)", "N/(rad)", False),
        ("N*m", "N", False), ("furlong", "m", False), ("lbf/(m/s)", "N/(m/s)", False), ("9^9^9", "N", False),
    ],
)  # fmt: skip
def test_units_are_one_whatever_their_spelling(one: str, other: str, same: bool) -> None:
    assert same_unit(one, other) is same


def test_partners_of_other_sizes_are_noted_with_both_values() -> None:
    """Prestero's Nr|r| is half of his Mq|q| on a body of revolution."""
    notes = {c.subject: c.statistic for c in plausibility(remus()) if c.severity is Severity.NOTE}
    assert notes == {"Nr|r| and Mq|q|": "-94 and -188 (SI)"}


def refusal(folder: Path, change: Callable[[dict[str, Any]], None]) -> str:
    content = json.loads(read_parameter_file(Path("remus100")).to_json())
    change(content)
    (folder / "a.json").write_text(json.dumps(content))
    with pytest.raises(InputError) as why:
        read_parameter_file(folder / "a.json")
    return str(why.value)


def test_a_misspelt_key_is_named_with_its_coefficient(tmp_path: Path) -> None:
    def misspell(content: dict[str, Any]) -> None:
        yuv = next(c for c in content["coefficients"] if c["symbol"] == "Yuv'")
        yuv["valeu"] = yuv.pop("value")

    told = refusal(tmp_path, misspell)
    assert '"coefficients.Yuv\'.valeu": found an unknown key' in told


def test_a_value_beside_another_in_si_says_what_to_change(tmp_path: Path) -> None:
    def double(content: dict[str, Any]) -> None:
        content["coefficients"][17]["value"] *= 2.0

    assert "write null for value_si" in refusal(tmp_path, double)


def test_a_mass_that_no_inertia_fits_is_named(tmp_path: Path) -> None:
    def heavy(content: dict[str, Any]) -> None:
        content["mass"]["mass"] = 3048.0

    assert "at a mass of 3048 kg" in refusal(tmp_path, heavy)


def test_suboff_is_said_to_be_fitted() -> None:
    with pytest.raises(InputError, match="coeflab validate suboff"):
        read_parameter_file(Path("suboff"))
