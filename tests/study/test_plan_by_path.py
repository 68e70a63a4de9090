"""A plan by its path, its folder or its shipped name is the plan itself."""

from __future__ import annotations

from pathlib import Path

import pytest

import coeflab
from coeflab.core.errors import InputError
from coeflab.study.plan import read_plan
from coeflab.tables.campaign import read_campaign

PLAN = """[study]
name = "one"

[[table]]
campaign = "campaign"
"""


@pytest.fixture
def place(tmp_path: Path) -> Path:
    template = Path(coeflab.__file__).parent / "cli" / "template" / "campaign"
    (tmp_path / "campaign").mkdir()
    for file in template.iterdir():
        (tmp_path / "campaign" / file.name).write_bytes(file.read_bytes())
    (tmp_path / "plan.toml").write_text(PLAN)
    return tmp_path


def test_a_plan_is_carried_out_by_its_path_and_by_its_folder(place: Path) -> None:
    expected = coeflab.run(coeflab.read_plan(place / "plan.toml"))
    for given in (place / "plan.toml", str(place / "plan.toml"), str(place)):
        study = coeflab.run(given)
        assert study.plan.name == "one"
        assert [c.value for c in study.coefficients] == [c.value for c in expected.coefficients]


@pytest.mark.slow
def test_a_plan_is_carried_out_by_its_shipped_name() -> None:
    assert coeflab.run("huuv_synthetic").plan.name == "huuv_synthetic"


def test_a_fault_of_an_option_names_the_file(place: Path) -> None:
    (place / "plan.toml").write_text(
        PLAN + 'fits = ["slope_at_origin"]\n\n[table.options.slope_at_origin]\nnothing = 3\n'
    )
    with pytest.raises(InputError) as why:
        coeflab.run(place)
    assert "plan.toml" in str(why.value)


def test_what_is_not_there_is_told_with_the_shipped_names() -> None:
    with pytest.raises(InputError, match=r"no file .*suboff_nothing.*or a shipped name \(.*suboff"):
        coeflab.run("suboff_nothing")


@pytest.mark.parametrize("given", [None, 3, ["plan.toml"]])
def test_anything_else_is_refused_with_advice(given: object) -> None:
    with pytest.raises(InputError, match=r"expected a Plan, the path of a plan.toml") as why:
        coeflab.run(given)  # type: ignore[arg-type]
    assert why.value.advice


@pytest.mark.parametrize(
    ("head", "what", "command"),
    [
        ("study", "a plan", "coeflab run"), ("matrix", "a matrix of runs", "coeflab tow"), ("tank", "a tow", "coeflab tow"),
        ("configuration", "a body", "coeflab vehicle"), ("campaign", "a campaign", "coeflab fit"),
    ],
)  # fmt: skip
def test_a_file_of_another_kind_is_said_to_be_one(tmp_path: Path, head: str, what: str, command: str) -> None:
    """A plan was read as a campaign, with a complaint a key."""
    (tmp_path / "own.toml").write_text(f"[{head}]\nx = 1\n")
    for read in (coeflab.read_plan, read_campaign):
        if (head, read) in (("study", coeflab.read_plan), ("campaign", read_campaign)):
            continue
        with pytest.raises(InputError) as why:
            read(tmp_path / "own.toml")
        assert (why.value.found, why.value.line, why.value.others) == (f"{what}, with [{head}]", 1, ())
        assert command in why.value.advice


PLACED = '[study]\nname = "placed"\nreference_point = {}\n[[table]]\ncampaign = "suboff_roddy_2"\n'


@pytest.mark.parametrize(
    ("place", "point", "datum"),
    [
        ('"-1.6 from nose"', [-1.6, 0.0, 0.0], "nose"),
        ('"nose -1600, 0, 200 mm"\ndatum = "nose"', [-1.6, 0.0, 0.2], "nose"),
        ('"midship"\ndatum_note = "half of LBP"', [0.0, 0.0, 0.0], "midship"),
        ('"-1.6"\ndatum = "nose"', [-1.6, 0.0, 0.0], "nose"),
    ],
)
def test_a_point_in_words_is_the_one_that_tables_take(
    tmp_path: Path, place: str, point: list[float], datum: str
) -> None:
    (tmp_path / "plan.toml").write_text(PLACED.format(place))
    plan = read_plan(tmp_path / "plan.toml")
    assert plan.reference_point is not None
    assert plan.reference_point.tolist() == point
    assert plan.datum is not None
    assert plan.datum.id == datum


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ('"-1.6 from nose"\ndatum = "midship"', 'a point from "nose" beside datum = "midship"'),
        ('"1.6 m aft of nose"', "Leave out aft."),
        ("[-1.6, 0.0]", "a point [x, y, z] in metres"),
    ],
)
def test_a_point_that_cannot_be_told_is_refused_by_its_line(tmp_path: Path, place: str, words: str) -> None:
    (tmp_path / "plan.toml").write_text(PLACED.format(place))
    with pytest.raises(InputError, match="reference_point") as refused:
        read_plan(tmp_path / "plan.toml")
    assert "line 3" in str(refused.value)
    assert words in str(refused.value)
