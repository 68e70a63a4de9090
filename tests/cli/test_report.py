from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
from html import unescape
from pathlib import Path

import pymupdf
import pytest

from tests.cli.conftest import COEFLAB, flat


@pytest.fixture
def study(coeflab, tmp_path) -> Path:
    """The template of `coeflab new`: one small campaign."""
    assert coeflab("new", "boat").returncode == 0
    return tmp_path / "boat"


def files_in(folder: Path) -> set[str]:
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


@pytest.fixture(scope="module")
def reported(forks, tmp_path_factory):
    """A folder with that study and its report in both formats, and what the command said."""
    folder = tmp_path_factory.mktemp("reported")
    assert forks.run(("new", "boat"), folder).returncode == 0
    return folder, forks.run(("report", folder / "boat", "--to", "html,pdf", "--out", "made"), folder)


@pytest.mark.slow
def test_both_formats_are_written(reported):
    folder, done = reported
    assert done.returncode == 0, done.stderr
    assert files_in(folder / "made") == {"report.html", "report.pdf"}
    assert "made/report.pdf" in flat(done.stdout)
    assert done.stderr == ""
    made = pymupdf.open(folder / "made" / "report.pdf")
    assert made.metadata["title"] in (folder / "made" / "report.html").read_text()


@pytest.mark.slow
def test_a_plan_and_its_folder_give_the_same_bytes(coeflab, reported):
    folder, _ = reported
    coeflab("report", folder / "boat" / "plan.toml", "--out", "b", cwd=folder)
    for name in ("report.html", "report.pdf"):
        assert (folder / "made" / name).read_bytes() == (folder / "b" / name).read_bytes()


def test_the_summary_has_one_page_and_a_name_of_its_own(coeflab, study, tmp_path):
    done = coeflab("report", study, "--summary", "--out", "made")
    assert done.returncode == 0, done.stderr
    assert files_in(tmp_path / "made") == {"summary.html", "summary.pdf"}
    assert len(pymupdf.open(tmp_path / "made" / "summary.pdf")) == 1


def test_a_campaign_is_a_study_of_its_own(coeflab, study, tmp_path):
    """Slopes at the origin, law, parameter file and report without a plan; of a shipped one by its name."""
    place = study.relative_to(tmp_path) / "campaign"
    done = coeflab("run", place)
    assert done.returncode == 0, done.stderr
    (made,) = (tmp_path / "reports").iterdir()
    assert (made / "report.html").is_file()
    (file,) = made.glob("*.parameters.json")
    symbols = [c["symbol"] for c in json.loads(file.read_bytes())["coefficients"]]
    assert {"Yv'", "Nv'", "Yr'", "Nr'"} <= set(symbols)
    assert commands_in(made / "report.html")[-1] == "coeflab report campaign.toml --to html,pdf"
    told = coeflab("report", place, "--to", "html", "--out", "again")
    assert told.returncode == 0, told.stderr
    assert (tmp_path / "again" / "report.html").read_bytes() == (made / "report.html").read_bytes()
    assert coeflab("run", "suboff_roddy_3", "--out", "shipped").returncode == 0


def test_only_the_named_sections(coeflab, study, tmp_path):
    done = coeflab("report", study, "--section", "checks", "--section", "Verdict", "--json", "--out", "made")
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert [s["anchor"] for s in said["sections"]] == ["verdict", "checks"]
    titles = [t for _, t, _ in pymupdf.open(tmp_path / "made" / "report.pdf").get_toc()]
    assert any(t.endswith("Verdict") for t in titles)
    assert not any(t.endswith("Conventions used") for t in titles)
    assert [Path(p).name for p in said["files"]] == ["report.html", "report.pdf"]


def test_the_appendix_comes_on_request_and_is_found_by_section(coeflab, study, tmp_path):
    """The core as `run` writes it too; the whole one says how to make it again."""
    assert coeflab("run", study / "plan.toml", "--out", "run").returncode in (0, 1)
    sections = {}
    for name, more in (("core", ()), ("whole", ("--full",)), ("part", ("--section", "data-quality"))):
        done = coeflab("report", study, "--to", "html", "--json", "--out", name, *more)
        assert done.returncode == 0, done.stderr
        sections[name] = [s["anchor"] for s in json.loads(done.stdout)["sections"]]
    assert "data-quality" not in sections["core"]
    assert sections["whole"][: len(sections["core"])] == sections["core"]
    assert {"campaigns", "data-quality", "budget"} <= set(sections["whole"])
    assert sections["part"] == ["data-quality"]
    assert (tmp_path / "core" / "report.html").read_bytes() == (tmp_path / "run" / "report.html").read_bytes()
    assert commands_in(tmp_path / "whole" / "report.html")[-1].endswith(" --full")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("boat", "--section", "verdikt"), ("verdikt", "Did you mean verdict?")),
        (("boat", "--to", "html,docx"), ("docx", "html, latex, pdf")),
        (("boat", "--to", ","), ("no format",)),
        (("boat", "--summary", "--section", "verdict"), ("--summary",)),
        (("boat", "--summary", "--full"), ("--summary",)),
        (("subof",), ("subof", "Did you mean suboff?")),
        (("empty",), ("a folder without plan.toml and campaign.toml", "a campaign or a validation")),
        (("nowhere.toml",), ("nowhere.toml",)),
    ],
)
def test_one_error_and_nothing_written(coeflab, study, tmp_path, arguments, words):
    (tmp_path / "empty").mkdir()
    before = files_in(tmp_path)
    done = coeflab("report", *arguments, "--out", "made")
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) <= 4
    for word in words:
        assert word in done.stderr
    assert files_in(tmp_path) == before


@pytest.mark.slow
def test_open_hands_the_file_to_the_browser(study, tmp_path):
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/shown\n')
    browser.chmod(0o755)
    command = [str(COEFLAB), "report", str(study), "--to", "pdf", "--open", "--out", "made"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env=os.environ | {"BROWSER": f"{browser} %s"},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "shown").read_text().strip() == (tmp_path / "made" / "report.pdf").as_uri()


@pytest.mark.slow
def test_a_publication_by_name(coeflab, tmp_path):
    done = coeflab("report", "flyingfish")
    assert done.returncode == 0, done.stderr
    assert files_in(tmp_path / "reports" / "flyingfish") == {"report.html", "report.pdf"}
    stated = commands_in(tmp_path / "reports" / "flyingfish" / "report.html")
    assert stated == ["coeflab report flyingfish --to html,pdf"]
    (tmp_path / "elsewhere").mkdir()
    assert coeflab(*shlex.split(stated[0])[1:], "--out", "elsewhere/again").returncode == 0
    for name in ("report.html", "report.pdf"):
        again = tmp_path / "elsewhere" / "again" / name
        assert again.read_bytes() == (tmp_path / "reports" / "flyingfish" / name).read_bytes()


def commands_in(page: Path) -> list[str]:
    """What a report tells to type."""
    text = page.read_text(encoding="utf-8")
    return [
        unescape(line)
        for block in re.findall(r"<pre[^>]*><code>(.*?)</code>", text, re.DOTALL)
        for line in block.split("\n")
    ]


@pytest.mark.slow
def test_the_stated_command_makes_the_same_report(coeflab, study, tmp_path):
    plan = (study / "plan.toml").rename(study / "my plan.toml")
    assert coeflab("report", plan, "--to", "html", "--out", "a").returncode == 0
    (stated,) = commands_in(tmp_path / "a" / "report.html")
    assert str(tmp_path) not in (tmp_path / "a" / "report.html").read_text(encoding="utf-8")
    done = subprocess.run(
        [str(COEFLAB), *shlex.split(stated)[1:], "--out", str(tmp_path / "b")], cwd=study, capture_output=True, text=True,
        check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "b" / "report.html").read_bytes() == (tmp_path / "a" / "report.html").read_bytes()
