"""Nouns stay as they are: no attribute can be set, every array and mapping is read-only and a copy."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from coeflab.bodies.readers import read_body
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.types import locked, locked_columns, remembered
from coeflab.law.added_mass import AddedMass
from coeflab.law.scaling import Conditions, Scaling
from coeflab.study.study import Study
from coeflab.tables.campaign import Campaign, read_campaign
from coeflab.tables.force_table import ForceTable
from tests.law.test_scaling import coefficients


@pytest.fixture(scope="module")
def nouns(suboff: Study) -> dict[str, Any]:
    return {
        "study": suboff,
        "plan": suboff.plan,
        "table": suboff.tables[0],
        "fit": suboff.fits[0],
        "sweep": suboff.fits[0].sweeps[0],
        "set": suboff.fits[0].coefficients,
        "coefficient": suboff.coefficients[0],
        "reference": suboff.references[3],
        "comparison": suboff.comparisons[0],
        "check": suboff.checks[0],
        "body": read_body(shipped("geometry") / "suboff" / "body.toml"),
        "parameter file": next(iter(suboff.parameter_files.values())),
        "campaign": read_campaign(shipped("cfd_data") / "suboff_cfd_barehull" / "campaign.toml"),
        "added mass": AddedMass(np.eye(6), np.zeros(3), Datum("nose"), "b", "m"),
        "scaling": Scaling(1.0, "L"),
        "conditions": Conditions(1.0, 1.0),
        "source": suboff.tables[0].source,
    }


NOUNS = (
    "study", "plan", "table", "fit", "sweep", "set", "coefficient", "reference", "comparison", "check", "body",
    "parameter file", "campaign", "added mass", "scaling", "conditions", "source",
)  # fmt: skip


@pytest.mark.parametrize("name", NOUNS)
def test_no_attribute_can_be_set(nouns: dict[str, Any], name: str) -> None:
    noun = nouns[name]
    fields = (
        [f.name for f in dataclasses.fields(noun)] if dataclasses.is_dataclass(noun) else list(type(noun).model_fields)
    )
    assert fields
    for field in fields:
        with pytest.raises((AttributeError, ValueError), match=r"frozen|cannot assign"):
            setattr(noun, field, None)


def parts(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    yield path, value
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        for f in dataclasses.fields(value):
            yield from parts(getattr(value, f.name), f"{path}.{f.name}")
    elif isinstance(value, Mapping):
        for k, v in value.items():
            yield from parts(v, f"{path}[{k}]")
    elif isinstance(value, tuple):
        for i, v in enumerate(value):
            yield from parts(v, f"{path}[{i}]")


@pytest.mark.parametrize("name", ["table", "set", "body", "campaign", "added mass", "reference"])
def test_everything_inside_is_read_only(nouns: dict[str, Any], name: str) -> None:
    for path, value in parts(nouns[name], name):
        assert not isinstance(value, (list, dict, set)), path
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable, path
        if isinstance(value, Mapping):
            assert isinstance(value, MappingProxyType), path


def test_arrays_are_copies() -> None:
    mine = np.zeros(3)
    kept, columns = locked(mine), locked_columns({"Y": mine})
    mine[0] = 1.0
    assert kept[0] == columns["Y"][0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        kept[0] = 1.0
    with pytest.raises(TypeError):
        columns["Z"] = mine  # type: ignore[index]
    covariance = np.eye(1)
    noun = coefficients({"Yv": 1.0})
    changed = dataclasses.replace(noun, covariance=covariance)
    covariance[0, 0] = 5.0
    assert changed.covariance[0, 0] == 1.0


def test_verbs_leave_the_old_object(nouns: dict[str, Any]) -> None:
    table: ForceTable = nouns["table"]
    before = {c: np.array(v) for c, v in table.forces.items()}
    table.about(np.array([1.0, 2.0, 3.0]))
    table.with_uncertain_cells()
    for c, v in table.forces.items():
        np.testing.assert_array_equal(v, before[c])


def test_campaign_is_a_noun_too(nouns: dict[str, Any]) -> None:
    campaign: Campaign = nouns["campaign"]
    with pytest.raises(TypeError):
        campaign.signs["beta"] = "x"  # type: ignore[index]


def test_added_mass_is_six_by_six() -> None:
    with pytest.raises(InputError, match="6 x 6"):
        AddedMass(np.eye(3), np.zeros(3), Datum("nose"), "b", "m")


def test_a_force_table_is_a_data_frame_for_notebooks(suboff) -> None:
    table = next(t for t in suboff.tables if t.campaign == "suboff_roddy_1")
    frame = table.frame()
    assert frame.shape == (64, 6 + 1 + 6)
    assert frame.loc["1", "Z [N]"] == table.forces["Z"][0]
    assert frame["Z [N]"].isna().sum() == (~table.usable["Z"]).sum() > 0


def test_the_last_results_are_remembered_by_the_bytes_of_arrays() -> None:
    calls: list[float] = []

    @remembered(2)
    def total(x: NDArray[np.float64], factor: float = 1.0) -> float:
        calls.append(factor)
        return factor * float(x.sum())

    x = np.array([1.0, 2.0])
    assert [total(x), total(x.copy()), total(x, 2.0), total(x, factor=2.0)] == [3.0, 3.0, 6.0, 6.0]
    assert calls == [1.0, 2.0, 2.0]
    x[0] = 5.0
    assert total(x) == 7.0
    assert total(np.array([1.0, 2.0]), 1.0) == 3.0
    assert len(calls) == 5


def test_nouns_of_arrays_are_remembered_by_their_content() -> None:
    calls: list[str] = []

    @dataclass(frozen=True, eq=False)
    class Hull:
        radius: NDArray[np.float64]
        name: str
        again: object = None

    @remembered(8)
    def largest(hull: Hull, over: tuple[NDArray[np.float64], ...] = ()) -> float:
        calls.append(hull.name)
        return float(hull.radius.max()) + sum(float(x.max()) for x in over)

    def remade(share: float) -> None:
        raise AssertionError(share)

    one = np.array([1.0, 2.0])
    assert largest(Hull(one, "a")) == largest(Hull(one.copy(), "a")) == 2.0
    assert calls == ["a"]
    assert largest(Hull(one, "a", partial(remade, 0.5))) == largest(Hull(one, "a", partial(remade, 0.5)))
    assert calls == ["a", "a"]
    others = [
        Hull(one, "b"),
        Hull(2.0 * one, "a"),
        Hull(one, "a", partial(remade, 0.6)),
        Hull(one, "a", partial(remade, share=0.5)),
    ]
    assert [largest(h) for h in others] == [2.0, 4.0, 2.0, 2.0]
    assert largest(Hull(one, "a"), (one,)) == largest(Hull(one, "a"), over=(one,)) == 4.0
    assert len(calls) == 2 + 4 + 2
