"""Words of reports stand in templates: every template is asked for, every code has one."""

from __future__ import annotations

import ast
import re
from string import Formatter
from typing import Any

import pytest

from coeflab.report.texts import table_of, templates, text_of, texts_of
from tests.sources import PACKAGE, texts

SUBJECTS = sorted(f.stem for f in (PACKAGE / "report" / "texts").glob("*.toml"))
SOURCE = "\n".join(texts().values())


@pytest.mark.parametrize("subject", SUBJECTS)
def test_every_template_is_asked_for(subject: str) -> None:
    of_a_name = {m[1] for m in re.finditer(rf'f"{subject}\.(\w*)\{{', SOURCE)}  # the rest of a code is a fact
    of_a_name |= {m[1] for m in re.finditer(rf"f'{subject}\.(\w*)\{{", SOURCE)}
    idle = [c for c in templates(subject) if f'"{subject}.{c}"' not in SOURCE and not any(map(c.startswith, of_a_name))]
    assert idle == []


def test_every_code_has_a_template() -> None:
    for subject, what in re.findall(r'(?:table|text|texts)_of\(\s*"([a-z0-9_]+)\.([a-z0-9_]+)"', SOURCE):
        if subject in SUBJECTS:
            assert what in templates(subject), f"{subject}.{what}"


def braces(worded: Any) -> set[str]:
    """Facts of a template, those of a table in its title and notes."""
    if isinstance(worded, str):
        return {re.split(r"[.\[]", field)[0] for _, field, _, _ in Formatter().parse(worded) if field is not None}
    some = [worded.get("title", ""), *worded.get("notes", ())] if isinstance(worded, dict) else worded
    return set().union(*map(braces, some))


def test_every_call_gives_the_facts_of_its_template() -> None:
    compared, wrong = 0, []
    for source in texts().values():
        calls = (n for n in ast.walk(ast.parse(source)) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name))
        for call in (c for c in calls if c.func.id in ("text_of", "texts_of", "table_of") and c.args):
            code = getattr(call.args[0], "value", None)
            subject, _, what = code.partition(".") if isinstance(code, str) else ("", "", "")
            if subject in SUBJECTS and what in templates(subject):
                compared += 1
                given = {k.arg for k in call.keywords} - ({"rows", "notes"} if call.func.id == "table_of" else set())
                wrong += [f"{code}: {given}"] if given != braces(templates(subject)[what]) else []
    assert compared > 140
    assert wrong == []


def test_facts_stand_in_their_places() -> None:
    assert text_of("document.own_plan", name="plan.toml", name_2="plan.toml").startswith(
        "Run this in the folder of plan.toml;"
    )
    assert len(texts_of("data_quality.section")) == 2
    shown = table_of("uncertainty.budget", [("a",) * 6], ["a note"], symbol="Yv'", campaign="tow")
    assert (shown.title, shown.notes, shown.left) == ("Budget of Yv', tow", ("a note",), {0})
    with pytest.raises(KeyError):
        table_of("uncertainty.budget", [])
