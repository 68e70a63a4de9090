"""What stands out in a study: one plugin a file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

import numpy as np

from coeflab.core.registry import Plugin, Registry
from coeflab.core.table import Check
from coeflab.study.study import Study

CHECKS = Registry(__name__, "check", Checker)  # type: ignore[type-abstract]


@runtime_checkable
class Checker(Plugin, Protocol):
    """Looks at a whole study and says what stands out."""

    def check(self, study: Study) -> Sequence[Check]:
        """Findings, those that pass among them.

        Parameters
        ----------
        study : Study
        """
        ...
