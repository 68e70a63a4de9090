"""Findings are data; their words stand in templates alone, and every template is for a code that exists."""

from __future__ import annotations

import ast
import re
from string import Formatter

import pytest

from coeflab.core.errors import PluginError, UnitsError
from coeflab.core.finding import Finding, Severity, worst
from coeflab.core.texts import input_error, remark, templates, words
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


def test_every_refusal_has_its_words_and_hands_over_their_facts() -> None:
    refusals = {f"{s}.{code}": words for s in SUBJECTS for code, words in templates(s).items() if "found" in words}
    place = {"file", "line", "column", "key", "where", "kind", "row", "name"}
    for file, text in texts().items():
        for call in (n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call)):
            codes = [a.value for a in call.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
            if ast.unparse(call.func) == "input_error" and not isinstance(call.args[0], ast.Name):
                assert codes[:1] == [c for c in codes[:1] if c in refusals] != [], f"{file}: {ast.unparse(call)}"
            for code in (c for c in codes if c in refusals):
                parts = refusals[code]
                assert {"found", "expected"} <= set(parts) <= {"found", "expected", "advice"}, f"{file}: {code}"
                wanted = {name for part in parts.values() for _, name, _, _ in Formatter().parse(part) if name}
                assert wanted - place == {k.arg for k in call.keywords} - place, f"{file}: {code}"
                assert wanted & place <= {k.arg for k in call.keywords}, f"{file}: {code}"


def test_a_refusal_is_worded_by_its_template() -> None:
    found = input_error("tables.too_many_numbers", "a.csv", 7, monitor_numbers=1000)
    assert (
        str(found)
        == "a.csv, line 7: found more than 1,000 numbers; expected a monitor of one run. Write every tenth iteration."
    )
    assert isinstance(input_error("tables.no_share", kind=UnitsError, unit="N", name="Y"), UnitsError)
