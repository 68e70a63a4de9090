"""Which data tables two results of two parameter files have in common, and the verdicts of a comparison."""

from __future__ import annotations

from enum import StrEnum
from typing import Protocol

from coeflab.vehicle.parameter_file import Provenance


class Verdict(StrEnum):
    """What the difference of two coefficients says; equal, other sign and other size of two values of which one has no U95."""

    WITHIN = "within"
    EQUAL = "equal"
    APART = "apart"
    OTHER_SIGN = "other sign"
    OTHER_SIZE = "other size"
    NOT_COMPARABLE = "not comparable"


class FromTable(Protocol):
    """Something fitted, with the table and campaign it comes from: comma lists where there are several."""

    @property
    def table(self) -> str | None:
        """``campaign/file.csv``."""

    @property
    def campaign(self) -> str | None:
        """Name of the campaign."""


def _hashes(of: FromTable, provenance: Provenance) -> dict[str, str]:
    """Names by sha256 of the tables behind a result; declarations are no data."""
    tables = set((of.table or "").split(", ")) | {of.table}
    found = {i.sha256: i.name for i in provenance.inputs if i.name in tables}
    if found or not of.campaign:
        return found
    folders = {*of.campaign.split(", "), of.campaign}
    inputs = [i for i in provenance.inputs if not i.name.endswith(".toml")]
    return {i.sha256: i.name for i in inputs if i.name.rpartition("/")[0] in folders}


def shared_tables(a: FromTable, b: FromTable, inputs_a: Provenance, inputs_b: Provenance) -> tuple[str, ...]:
    """Tables with the same bytes behind both, by the first file's names.

    A result names its table; where it does not, or not as the file's provenance does, all tables of its campaign count.

    Parameters
    ----------
    a, b : FromTable
        Results of the two files.
    inputs_a, inputs_b : Provenance
        Of the two files.
    """
    ours, theirs = _hashes(a, inputs_a), _hashes(b, inputs_b)
    return tuple(sorted({name for sha256, name in ours.items() if sha256 in theirs}))
