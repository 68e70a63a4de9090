"""What the checks find in a study; of another package's that raises, that it did."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from coeflab.core.errors import CoeflabError
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.wording import Verbatim
from coeflab.study.checks import CHECKS
from coeflab.study.study import Study

Progress = Callable[[str], None]


def checked(study: Study, progress: Progress = lambda _: None) -> Study:
    """The study with what every check finds."""
    findings = [c for name in CHECKS.names() for c in _findings(name, study)]
    progress(f"{len(findings)} checks")
    return study.with_checks(tuple(findings))


def _findings(name: str, study: Study) -> tuple[Check, ...]:
    """What one check finds; of another package's that raises, the finding is that it did."""
    try:
        with CHECKS.guarded(name):
            found = tuple(CHECKS.load(name).check(study))
            if not all(isinstance(c, Check) for c in found):
                raise TypeError("a finding that is no Check")
    except CoeflabError as why:
        if CHECKS.is_shipped(name):
            raise
        return (
            Check(name, "every campaign", Severity.WARN, Verbatim(why), "a check that ends with findings",
                  "What this check looks at was not assessed. Mend or uninstall the package that it comes from."),
        )  # fmt: skip
    return found if CHECKS.is_shipped(name) else tuple(map(_in_their_words, found))


def _in_their_words(c: Check) -> Check:
    """Another package's finding: nothing in its texts is taken for a symbol."""
    return replace(
        c, name=Verbatim(c.name), subject=Verbatim(c.subject), statistic=Verbatim(c.statistic), rule=Verbatim(c.rule),
        comment=Verbatim(c.comment),
    )  # fmt: skip
