"""Findings are data; their words stand in templates alone, and every template is for a code that exists."""

from __future__ import annotations

import re

import pytest

from coeflab.core.errors import PluginError
from coeflab.core.finding import Finding, Severity, worst
from coeflab.core.texts import remark, templates, words
from tests.sources import PACKAGE, texts

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


def test_every_template_is_of_a_code_that_the_source_makes() -> None:
    written = "\n".join(texts().values())
    codes = set(re.findall(r'"([a-z0-9_]+\.[a-z0-9_]+)"', written))
    parts = set(re.findall(r'"([a-z0-9_]+)"', written))
    for subject in SUBJECTS:
        handed_over = parts if f'f"{subject}.{{' in written else set()  # the rest of a code
        unused = {code for code in templates(subject) if f"{subject}.{code}" not in codes and code not in handed_over}
        assert unused == set(), subject


def test_every_code_that_the_source_makes_has_a_template() -> None:
    for file, text in texts().items():
        for code in re.findall(r'Finding(?:\.of)?\(\s*"([^"]+)"', text):
            subject, _, what = code.partition(".")
            assert what in templates(subject), f"{file}: {code}"
