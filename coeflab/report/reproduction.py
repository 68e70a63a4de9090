"""How to make a report again: the exact command, the version, and how to see that the inputs are the same."""

from __future__ import annotations

import hashlib
import shlex

from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.version import VERSION
from coeflab.report.document import Section
from coeflab.report.texts import text_of
from coeflab.study.study import Plan, Study

PLAN = "plan.toml"


def reproduction(study: Study) -> Section:
    """Of a study: its shipped name, or its own plan."""
    file = study.plan.file
    if file is None and study.plan.command:
        return _section((text_of("document.shape"), text_of("document.same")), (study.plan.command,), study.inputs)
    if file is None:
        return _section((text_of("document.by_program"),), (), study.inputs)
    name = shipped_name(study.plan)
    if name:
        where = text_of("document.shipped_plan", name=name)
        return _section((where, text_of("document.same")), (command(name),), study.inputs)
    where = text_of("document.own_plan", name=file.name)
    return _section((where, text_of("document.same")), (command(file.name),), study.inputs)


def published_reproduction(name: str, inputs: tuple[InputFile, ...]) -> Section:
    """Of a publication reproduced."""
    where = text_of("document.shipped_validation", name=name)
    return _section((where, text_of("document.same")), (command(name),), inputs)


def command(study: str) -> str:
    """What to type for the report of a study, a plan's name or that of a shipped one."""
    return f"coeflab report {shlex.quote(study)} --to html,pdf"


def shipped_name(plan: Plan) -> str:
    """The name of a shipped study, whose plan and campaigns these are; empty for a plan of one's own."""
    data = shipped("cfd_data").resolve()
    own = {path.parent.name: path for path in data.glob(f"*/{PLAN}")}.get(plan.name)
    is_same = own is not None and plan.file == InputFile(PLAN, sha256_of(own))
    return plan.name if is_same and all(t.campaign.resolve().is_relative_to(data) for t in plan.tables) else ""


def digest_of(inputs: tuple[InputFile, ...]) -> str:
    """Sixteen hexadecimal digits over all inputs; empty where there are none."""
    whole = "".join(f"{f.name} {f.sha256}\n" for f in inputs)
    return hashlib.sha256(whole.encode()).hexdigest()[:16] if whole else ""


def _section(text: tuple[str, ...], code: tuple[str, ...], inputs: tuple[InputFile, ...]) -> Section:
    return Section(
        "reproduce",
        "How to reproduce",
        (*text[1:], text_of("document.version", version=VERSION), *_hashes(inputs), *text[:1]),
        code=code,
    )


def _hashes(inputs: tuple[InputFile, ...]) -> tuple[str, ...]:
    if not inputs:
        return ()
    return (text_of("document.hashes", inputs=digest_of(inputs)),)
