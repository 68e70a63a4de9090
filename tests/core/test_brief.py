"""What a notebook prints of a noun stays short, whatever the noun holds."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel

import coeflab
from coeflab.core.files import shipped
from coeflab.core.types import brief
from coeflab.glider.flight import fly
from coeflab.motion.simulation import simulate
from coeflab.report.document import Document
from coeflab.study.study import Study
from coeflab.tables.campaign import read_campaign

LONGEST = 500


def nouns(value: Any, seen: dict[int, Any]) -> Iterator[Any]:
    """Every dataclass and model that can be reached."""
    if id(value) in seen or isinstance(value, (str, int, float, Enum, Path, np.ndarray, type)):
        return
    seen[id(value)] = value
    if dataclasses.is_dataclass(value):
        yield value
        for f in dataclasses.fields(value):
            yield from nouns(getattr(value, f.name), seen)
    elif isinstance(value, BaseModel):
        yield value
        for name in type(value).model_fields:
            yield from nouns(getattr(value, name), seen)
    elif isinstance(value, Mapping):
        for v in value.values():
            yield from nouns(v, seen)
    elif isinstance(value, (tuple, list)):
        for v in value:
            yield from nouns(v, seen)


def longest(roots: list[Any]) -> dict[str, int]:
    """The longest repr or str of every kind of noun below the roots."""
    out: dict[str, int] = {}
    seen: dict[int, Any] = {}
    for root in roots:
        for noun in nouns(root, seen):
            kind = f"{type(noun).__module__}.{type(noun).__name__}"
            texts = (
                [repr(noun)] if "__str__" in vars(type(noun)) else [repr(noun), str(noun)]
            )  # a table prints itself whole
            out[kind] = max(out.get(kind, 0), *map(len, texts))
    return out


def test_nouns_of_a_study_and_its_report_are_short(suboff: Study, suboff_document: Document) -> None:
    campaign = read_campaign(shipped("cfd_data") / "suboff_cfd_barehull" / "campaign.toml")
    found = longest([suboff, campaign, suboff_document])
    assert {k: n for k, n in found.items() if n > LONGEST} == {}
    kinds = {k.rpartition(".")[2] for k in found}
    assert kinds >= {
        "Study", "Plan", "ForceTable", "Campaign", "Coefficient", "CoefficientSet", "FitResult", "Sweep", "Body",
        "Triangulation", "AddedMass", "ParameterFile", "Comparison", "Reference", "Check", "Budget", "Simulation",
        "Trajectory", "Vehicle", "Document", "Section", "Table", "Figure", "Scene",
    }  # fmt: skip
    public = {n: getattr(coeflab, n) for n in coeflab.__all__}
    nouns_of_a_study = {
        n for n, c in public.items() if dataclasses.is_dataclass(c) and ".api." not in getattr(c, "__module__", "")
    }
    assert kinds >= nouns_of_a_study - {"FittedModel", "PlannedTable", "LinearModel", "LinearSchedule", "Trim", "Tow"}


def test_nouns_of_other_verbs_are_short(suboff: Study) -> None:
    parameters = suboff.parameter_files["suboff_bare_hull"]
    found = longest([simulate(parameters, "straight_run", {}), fly("thauv", 1, {}), coeflab.validation("suboff")])
    assert {k: n for k, n in found.items() if n > LONGEST} == {}


def test_a_noun_says_what_it_holds(suboff: Study) -> None:
    assert repr(suboff).startswith("<Study suboff: ")
    assert "\n" not in repr(suboff)
    assert "of 41 coefficients valued" in repr(suboff.parameter_files["suboff_fully_appended"])
    assert repr(suboff.coefficients[0]).startswith("<Coefficient Yv' = -0.02")
    assert repr(suboff.plan).startswith("Plan(name='suboff', title=")
    assert repr(suboff.body.source).startswith("Source(")  # type: ignore[union-attr]


@pytest.mark.parametrize("size", [1, 10_000])
def test_the_length_does_not_grow_with_the_content(size: int) -> None:
    @brief
    @dataclasses.dataclass(frozen=True)
    class Noun:
        name: str
        texts: tuple[str, ...]
        entries: dict[str, float]
        values: Any
        nested: Any
        number: float = 1.0
        nothing: None = None

    one = Noun("n" * size, ("t" * size,) * size, {f"key{i}": 1.0 for i in range(size)}, np.zeros((size, 3)), None)
    outer = dataclasses.replace(one, nested=one)
    assert len(repr(outer)) < LONGEST
    if size == 1:
        assert repr(outer) == (
            "Noun(name='n', texts=('t'), entries={key0}, values=<array 1 x 3>, nested=<Noun 'n'>, number=1.0)"
        )
