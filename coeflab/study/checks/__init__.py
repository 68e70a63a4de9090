"""What stands out in a study: one plugin a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from coeflab.core.table import Check
    from coeflab.study.study import Study


@runtime_checkable
class Checker(Plugin, Protocol):
    """Looks at a whole study and says what stands out.

    Attributes
    ----------
    answers : bool
        Whether what passes or is noted answers a question of its own, such as how fine a grid has to be: terminals show it.
    """

    answers: bool = False

    def check(self, study: Study) -> Sequence[Check]:
        """Findings, those that pass among them.

        Parameters
        ----------
        study : Study
        """
        ...


CHECKS = Registry("coeflab.checks", "check", Checker, __name__)  # type: ignore[type-abstract]
