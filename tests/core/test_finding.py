"""Findings are data; their words stand in templates alone, and every template is for a code that exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import coeflab
from coeflab.core.errors import PluginError
from coeflab.core.finding import Finding, Severity, worst
from coeflab.core.texts import remark, templates, words

PACKAGE = Path(coeflab.__file__).parent
SUBJECTS = sorted(f.stem for f in (PACKAGE / "core" / "texts").glob("*.toml"))
FOUND = Finding.of("finding.example", "drift", Severity.WARN, statistic=0.19, threshold=0.05, rows=[80, 81])


def test_the_words_of_a_finding_are_those_of_its_template() -> None:
    assert words(FOUND) == ("The rows 80 and 81 are 19% off the law.", "at most 5%", "Check them.")
    assert remark(FOUND) == "The rows 80 and 81 are 19% off the law. Check them."


def test_a_finding_of_somebody_elses_file_is_shown_by_its_code() -> None:
    assert remark(Finding("later.found", "Yv'", Severity.NOTE)) == "later.found: Yv'"
    with pytest.raises(PluginError, match="later"):
        words(Finding("later.found", "Yv'", Severity.NOTE))
    with pytest.raises(PluginError, match="facts"):
        words(Finding("finding.example", "Yv'", Severity.NOTE))


def test_the_worst_of_several() -> None:
    assert worst([FOUND, Finding("a.b", "c", Severity.NOTE)]) is Severity.WARN
    assert worst([]) is Severity.PASS


@pytest.mark.parametrize("subject", SUBJECTS)
def test_every_template_is_of_a_code_that_the_source_makes(subject: str) -> None:
    made: set[str] = set()
    for file in PACKAGE.rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        made |= set(re.findall(rf'"({re.escape(subject)}\.[a-z0-9_]+)"', text))
    if any(
        f'f"{subject}.{{' in f.read_text(encoding="utf-8") for f in PACKAGE.rglob("*.py")
    ):  # the rest of a code is handed over
        words_of = "\n".join(f.read_text(encoding="utf-8") for f in PACKAGE.rglob("*.py"))
        made |= {f"{subject}.{word}" for word in re.findall(r'"([a-z0-9_]+)"', words_of)}
    assert made >= {f"{subject}.{code}" for code in templates(subject)}


def test_every_code_that_the_source_makes_has_a_template() -> None:
    for file in PACKAGE.rglob("*.py"):
        for code in re.findall(r'Finding(?:\.of)?\(\s*"([^"]+)"', file.read_text(encoding="utf-8")):
            subject, _, what = code.partition(".")
            assert what in templates(subject), f"{file}: {code}"
