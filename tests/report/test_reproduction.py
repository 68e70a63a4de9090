"""How to make a report again: the command names what was meant and nothing of the machine."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile
from coeflab.core.version import VERSION
from coeflab.report.reproduction import command, digest_of, reproduction, shipped_name
from coeflab.study.plan import read_plan
from tests.report.studies import FULL, small_study

PLAN = shipped("cfd_data") / "suboff" / "plan.toml"


def of_plan(plan):
    return reproduction(replace(small_study(FULL), plan=plan))


def test_a_shipped_study_is_called_by_its_name() -> None:
    section = of_plan(read_plan(PLAN))
    assert section.code == ("coeflab report suboff --to html,pdf",)
    assert VERSION in " ".join(section.paragraphs)


def test_a_copied_plan_with_other_words_is_called_by_its_file_and_no_folder(tmp_path: Path) -> None:
    path = tmp_path / "my plan.toml"
    folder = PLAN.parent.as_posix()
    text = PLAN.read_text(encoding="utf-8").replace('"../', f'"{folder}/../')
    path.write_text(text.replace('"published.toml"', f'"{folder}/published.toml"'), encoding="utf-8")
    section = of_plan(read_plan(path))
    assert section.code == ("coeflab report 'my plan.toml' --to html,pdf",)
    assert str(tmp_path) not in " ".join((*section.paragraphs, *section.code))


def test_a_plan_of_the_same_name_and_other_bytes_is_not_the_shipped_one() -> None:
    plan = read_plan(PLAN)
    assert shipped_name(plan) == "suboff"
    assert shipped_name(replace(plan, file=InputFile("plan.toml", "0" * 64))) == ""
    elsewhere = replace(plan.tables[0], campaign=Path("/elsewhere/suboff_roddy_2"))
    assert shipped_name(replace(plan, tables=(elsewhere,))) == ""
    assert shipped_name(replace(plan, name="../" * 2000)) == ""


def test_the_digest_is_what_the_text_says_it_is() -> None:
    study = small_study(FULL)
    study = replace(study, plan=replace(study.plan, file=InputFile("plan.toml", "1" * 64)))
    lines = "".join(f"{f.name} {f.sha256}\n" for f in study.inputs)
    expected = hashlib.sha256(lines.encode()).hexdigest()[:16]
    assert digest_of(study.inputs) == expected
    assert expected in " ".join(reproduction(study).paragraphs)
    assert digest_of(()) == ""


@pytest.mark.parametrize("name", ["$(rm -rf)", "a b.toml", "x;y.toml"])
def test_names_cannot_leave_the_command(name: str) -> None:
    assert command(name) == f"coeflab report '{name}' --to html,pdf"
