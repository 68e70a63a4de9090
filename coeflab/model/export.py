"""A parameter file as one target takes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from coeflab.core.errors import InputError
from coeflab.core.identifiers import file_stem
from coeflab.kernels.brief import brief
from coeflab.model.loss import Loss


@brief
@dataclass(frozen=True, slots=True)
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
