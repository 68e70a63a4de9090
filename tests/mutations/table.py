"""The table of docs/mutations.md: ``python -m tests.mutations.table`` writes it anew."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.mutations.harness import REFUSED, Outcome, Suboff, compare
from tests.mutations.mutations import Mutation, mutations, unchanged

PAGE = Path(__file__).parents[2] / "docs" / "mutations.md"
BEGIN, END = "<!-- mutation table: made by tests/mutations/table.py -->", "<!-- end of the mutation table -->"
HEAD = "| validation | mutation | noticed | first by |\n|---|---|---|---|\n"


def lines_of(outcomes: Mapping[Mutation, Outcome]) -> list[str]:
    """A line for each mutation."""
    return [f"| {m.study} | {_cell(m.what)} | {o.by or 'no'} | {_cell(_by(m, o))} |" for m, o in outcomes.items()]


def _by(m: Mutation, o: Outcome) -> str:
    if not o.by:
        return f"{m.why_not}. Largest change of a compared quantity: {_share(o.share)}"
    if o.by == REFUSED:
        return "the input is refused"
    return _named(o.caught[0])


def _named(key: str) -> str:
    """A table of a publication, a check, or a comparison of SUBOFF."""
    return (
        key.partition(": ")[0]
        if not key.startswith("check ")
        else key.partition(": ")[0].removeprefix("check ") + " check"
    )


def _share(share: float) -> str:
    if share < 1e-9:
        return "zero"
    return f"below {10.0 ** math.ceil(math.log10(100.0 * share)):g} % of what is allowed"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def main() -> None:
    """Run every mutation and write the table into the page."""
    from coeflab.core.files import shipped
    from coeflab.study.plan import read_plan
    from coeflab.study.run import run

    plan = replace(read_plan(Path(str(shipped("cfd_data"))) / "suboff" / "plan.toml"), exports=(), manoeuvres=())
    with TemporaryDirectory() as folder:
        study = Suboff(run(plan), Path(folder))
        base = {name: unchanged(name, study) for name in dict.fromkeys(m.study for m in mutations())}
        outcomes = {m: compare(base[m.study], m.run(study)) for m in mutations()}
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    unnoticed = sum(not o.by for o in outcomes.values())
    count = (
        f"{len(outcomes) - unnoticed} of {len(outcomes)} are noticed; {unnoticed} move nothing that is compared.\n\n"
    )
    PAGE.write_text(
        f"{before}{BEGIN}\n{count}{HEAD}" + "\n".join(lines_of(outcomes)) + f"\n{END}{after}", encoding="utf-8"
    )


if __name__ == "__main__":
    main()
