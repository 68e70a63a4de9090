"""How to make a report again: the exact command, the version, and how to see that the inputs are the same."""

from __future__ import annotations

import hashlib
import shlex

from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.version import VERSION
from coeflab.report.acceptance import Acceptance
from coeflab.report.document import Section
from coeflab.study.study import Plan, Study

PLAN = "plan.toml"
VERSION_TEXT = (
    f"This report was made by coeflab {VERSION}: coeflab --version tells which one is installed. Nothing is released yet, so many "
    "states of the sources carry that number: note the commit beside a report that has to be made again, and install it with "
    "pip install . -c constraints.txt, which also takes the libraries in the versions that the tests run with."
)
SAME = (
    "Equal inputs, sources and libraries give this report byte for byte, whatever the folder that --out names; every format is made from the "
    "same content, so it may be asked for alone."
)


def reproduction(study: Study) -> Section:
    """Of a study: its shipped name, or its own plan."""
    file = study.plan.file
    if file is None:
        return _section(
            ("The plan was made by a program, not read from a file, so no command gives this report.",),
            (),
            study.inputs,
        )
    name = shipped_name(study.plan)
    if name:
        where = f"The study {name} is shipped with coeflab, its plan and its data; the command works in any folder."
        return _section((where, SAME), (command(name),), study.inputs)
    where = (
        f"Run this in the folder of {file.name}; what the plan names has to lie where the plan says. coeflab run {file.name} writes "
        "the same HTML, and beside it the parameter files and the coefficients."
    )
    return _section((where, SAME), (command(file.name),), study.inputs)


def published_reproduction(found: Acceptance, inputs: tuple[InputFile, ...]) -> Section:
    """Of a publication reproduced."""
    where = f"The validation {found.name} is shipped with coeflab with its data; the command works in any folder."
    return _section((where, SAME), (command(found.name),), inputs)


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
    return Section("reproduce", "How to reproduce", (*text, VERSION_TEXT, *_hashes(inputs)), code=code)


def _hashes(inputs: tuple[InputFile, ...]) -> tuple[str, ...]:
    if not inputs:
        return ()
    return (
        "What went in is listed under Provenance: the sha256 of every file's bytes, as sha256sum prints it. Their digest is "
        f"{digest_of(inputs)}, the first 16 digits of the sha256 of one line a file, its name, a space and its sha256, in the order "
        "of that table. The head of this report shows it; a report with another digest has other inputs.",
    )
