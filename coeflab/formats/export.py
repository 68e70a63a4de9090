"""A parameter file as one target takes it: files and their loss, an export that a plan asks for, and one that is refused."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.errors import InputError
from coeflab.core.missed import suggesting
from coeflab.core.types import brief, in_angles
from coeflab.core.wording import file_stem
from coeflab.formats.loss import Loss
from coeflab.vehicle.inertia import MEASURED

RARE = "astern, broadside and at rest"


@suggesting
@dataclass(frozen=True, slots=True, repr=False)
class Export:
    """Files by name, and what is lost. Names of files and folders are made of the parameter file's by `file_stem`.

    Attributes
    ----------
    parameters : str
        Name of the parameter file.
    target : str
    files : mapping of file name to bytes
        The loss report among them, where there is a loss to report.
    loss : Loss or None
        None for tables, which hold the parameter file as it is.
    citations : tuple of str
        Of the target: where its force law was read.
    """

    parameters: str
    target: str
    files: Mapping[str, bytes]
    loss: Loss | None
    citations: tuple[str, ...] = ()

    def __repr__(self) -> str:
        how = "lossless" if self.lossless else "with losses"
        return in_angles(self, f"{self.parameters} for {self.target}, {how}: {', '.join(self.files)}")

    @property
    def lossless(self) -> bool:
        """Whether nothing of the parameter file is lost."""
        return self.loss is None or self.loss.lossless

    @property
    def folder(self) -> str:
        """Where the files stand beside the parameter file: a folder of their own, tables beside it."""
        return "" if self.loss is None else f"{file_stem(self.parameters)}.{self.target}"


@dataclass(frozen=True, slots=True)
class Refused:
    """A planned export that was not made, and why.

    Attributes
    ----------
    parameters : str
        Name of the parameter file.
    target : str
    why : InputError
        Names the plan's file and key.
    """

    parameters: str
    target: str
    why: InputError


@brief
@dataclass(frozen=True, slots=True)
class PlannedExport:
    """One ``[[export]]``: every parameter file of the study for one target.

    Attributes
    ----------
    to : str
        The exporter.
    accept_loss : bool
        Write although the target cannot hold everything.
    strict : bool
        Refuse any loss, whatever else is said.
    accelerations : {"measured", "computed"}
    file : Path or None
        The plan's, for messages.
    place : str
        The table in it.
    """

    to: str
    accept_loss: bool = False
    strict: bool = False
    accelerations: str = MEASURED
    file: Path | None = None
    place: str = "export"

    def key(self, name: str) -> str:
        """Dotted name of a key."""
        return f"{self.place}.{name}"
