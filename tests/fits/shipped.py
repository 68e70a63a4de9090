"""Shipped campaigns, read once, and parts of their tables."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from coeflab.core.files import shipped
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS


@cache
def tables(campaign: str) -> tuple[ForceTable, ...]:
    """All tables of a campaign."""
    return IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / campaign / FILE))


def rows(t: ForceTable, keep: np.ndarray) -> ForceTable:
    """The table with some of its rows."""

    def cut(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {k: v[keep] for k, v in columns.items()}

    return replace(
        t, motion=cut(t.motion), controls=cut(t.controls), speed=t.speed[keep], forces=cut(t.forces),
        errors=cut(t.errors), usable=cut(t.usable), labels=tuple(np.array(t.labels)[keep]),
    )  # fmt: skip
