"""What the README prints: its commands run, its figures are theirs, its pages exist."""

from __future__ import annotations

import re
import runpy
import shlex
import shutil
from pathlib import Path

import pytest

from coeflab.cli import ORDER
from tests.cli.conftest import Run

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
REMUS = ROOT / "cfd_data" / "remus100" / "remus100.parameters.json"
BY_CI = ("validate suboff", "test")  # .ci/run, as they stand
# tests/reports/test_gallery.py and tests/report make these pages, tests/workbench_page that one; tests/cli/test_serve.py serves.
ELSEWHERE = ("report suboff --to html,pdf", "serve reports")


def commands() -> list[str]:
    fenced = re.findall(r"^```(\w*)\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)
    blocks = [block for language, block in fenced if not language]
    lines = [line.partition("  #")[0].strip() for block in blocks for line in block.splitlines()]
    return [line for line in lines if line and not line.startswith("source ")]


def test_the_two_commands_of_ci_are_the_first() -> None:
    assert commands()[:2] == [f"python3 start.py {words}" for words in BY_CI]
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert all(command in ci for command in commands()[:2])


@pytest.mark.slow
def test_every_other_command_runs_in_turn(coeflab: Run, tmp_path: Path) -> None:
    """In one folder, as a reader types them."""
    shutil.copytree(ROOT / "cfd_data" / "remus100", tmp_path / "cfd_data" / "remus100")
    for command in commands()[2:]:
        program, *words = shlex.split(command)
        assert program == "coeflab"
        if command.removeprefix("coeflab ") not in ELSEWHERE:
            done = coeflab(*words)
            assert done.returncode == 0, (command, done.stderr, done.stdout)
    made = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    assert {"reports/my_study/report.html", "reports/zigzag/zigzag.csv", "reports/zigzag/zigzag.svg"} <= made


def test_every_command_that_is_named_exists() -> None:
    named = {line.split()[1] for line in commands()[2:] if not line.split()[1].startswith("-")}
    named |= set(re.findall(r"`coeflab ([a-z-]+)", TEXT))
    assert named <= set(ORDER)


def test_the_shipped_file_is_what_its_maker_writes() -> None:
    made = runpy.run_path(str(ROOT / "cfd_data" / "make_remus.py"))["parameter_file"]()
    assert REMUS.read_bytes() == made.to_json()


def test_pages_and_pictures_exist() -> None:
    links = re.findall(r"\]\(([^)#]+)\)|src=\"([^\"]+)\"", TEXT)
    assert links
    assert not [a or b for a, b in links if not (ROOT / (a or b)).is_file()]


def test_it_is_short() -> None:
    """The first own result is on the first screen."""
    lines = TEXT.splitlines()
    assert len(TEXT.split()) <= 700
    assert lines.index("## Your first own result") < 20
