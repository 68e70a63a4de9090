"""The words of findings and refusals: one TOML file a subject, one table a code. Nothing else in coeflab words a finding.

A table has ``statement``, and may have ``rule`` (what it was held against) and ``advice``. ``{statistic}``, ``{threshold}``, ``{advice}``,
``{subject}`` and the names of facts stand in braces, with a format of Python where one is needed: ``{statistic:.0%}``. Numbers without
a format have three digits; several values are listed. A sentence may differ with a fact: ``statement.upper`` is taken where the
fact named by ``by`` has the value ``upper``.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from pathlib import Path
from string import Formatter
from typing import Any, NamedTuple

from coeflab.core.errors import InputError, PluginError
from coeflab.core.finding import Finding
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml
from coeflab.core.wording import listed

PARTS = ("statement", "rule", "advice")


class Wording(NamedTuple):
    """A finding in words; ``rule`` and ``advice`` are empty where its template has none."""

    statement: str
    rule: str
    advice: str


@cache
def templates(subject: str) -> dict[str, dict[str, Any]]:
    """The templates of a subject, by code without the subject."""
    file = files(__name__).joinpath(f"{subject}.toml")
    if not file.is_file():
        raise PluginError(f"no words for findings of {subject!r}")
    return own_toml(own_text(file))


class _Words(Formatter):
    """``str.format`` whose numbers have three digits unless told otherwise."""

    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, tuple):
            return listed([self.format_field(v, format_spec) for v in value]) if value else "none"
        if isinstance(value, float) and not format_spec:
            return f"{value:.3g}"
        return str(super().format_field(value, format_spec))


def words(finding: Finding) -> Wording:
    """A finding in words.

    Raises
    ------
    PluginError
        No template has its code, or a template asks for a fact that the finding has not.
    """
    subject, _, what = finding.code.partition(".")
    template = templates(subject).get(what)
    if template is None:
        raise PluginError(f"no words for the finding {finding.code!r}")
    facts = {fact.name: fact.value for fact in finding.facts}
    known = {
        "subject": finding.subject, "statistic": finding.statistic, "threshold": finding.threshold, "advice": finding.advice, **facts,
    }  # fmt: skip
    out = []
    for part in PARTS:
        text = template.get(part, "")
        if isinstance(text, dict):
            text = text.get(str(facts.get(template.get("by", ""), "")), text.get("else", ""))
        try:
            out.append(_Words().vformat(text, (), known))
        except (KeyError, ValueError, TypeError) as wrong:
            raise PluginError(f"the words of {finding.code!r} do not fit its facts: {wrong!r}") from wrong
    return Wording(*out)


def known(finding: Finding) -> bool:
    """Whether a finding, which may be of somebody else's file, has words here that fit."""
    try:
        words(finding)
    except PluginError:
        return False
    return True


def remark(finding: Finding) -> str:
    """Statement and advice in a line; code and subject where a file of somebody else holds a finding that is not known here."""
    try:
        text = words(finding)
    except PluginError:
        return f"{finding.code}: {finding.subject}"
    stop = "." if text.advice and text.statement[-1:] not in ".!?:;" else ""
    return f"{text.statement}{stop} {text.advice}".strip()


def input_error(
    code: str,
    file: str | Path | None = None,
    line: int | None = None,
    column: str | None = None,
    *,
    key: str | None = None,
    where: str = "",
    kind: type[InputError] = InputError,
    **facts: object,
) -> InputError:
    """An error about input, to be raised by the caller, in the words of its code.

    Parameters
    ----------
    code : str
        Subject and table of `core/texts`, such as ``tables.empty_file``.
    file, line, column, key
        See `InputError`.
    where : str
        Behind what was found, such as `` in row 7``.
    kind : type of InputError
    **facts
        What the words name in braces.
    """
    subject, _, what = code.partition(".")
    template = templates(subject)[what]
    found, expected, advice = (template.get(part, "").format_map(facts) for part in ("found", "expected", "advice"))
    return kind(found + where, expected, file=file, line=line, column=column, key=key, advice=advice)
