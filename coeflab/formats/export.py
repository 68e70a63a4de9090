"""Parameter files for simulators: the target's files, and what they lose."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError, PluginError, shown
from coeflab.core.machine import one_thread
from coeflab.core.missed import suggesting
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import brief, in_angles
from coeflab.core.wording import PREFIX, file_stem
from coeflab.formats import (
    EXPORTERS,
    BuiltExporter,
    DressedExporter,
    InertialExporter,
    PartialExporter,
    SimulatorExporter,
    SteeredExporter,
)
from coeflab.formats.lacking_law import found_in, lacking_tables, without_law
from coeflab.formats.loss import Loss, loss_of
from coeflab.formats.loss_tables import as_text, in_short
from coeflab.formats.missing_parts import Kind, LossItem, common_losses
from coeflab.vehicle.inertia import MEASURED, converted, water_inertia, with_accelerations

if TYPE_CHECKING:
    from coeflab.bodies.shape import Shape
    from coeflab.vehicle.parameter_file import ParameterFile

LONGEST = 255
ACCEPT = "--accept-loss"


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
        The table in it; empty where a command line stands for the plan.
    """

    to: str
    accept_loss: bool = False
    strict: bool = False
    accelerations: str = MEASURED
    file: Path | None = None
    place: str = "export"

    def key(self, name: str) -> str | None:
        """Dotted name of a key; None where no plan is written."""
        return f"{self.place}.{name}" if self.place else None


@one_thread()
def export(
    parameters: ParameterFile, target: str, accelerations: str = MEASURED, *, accept_loss: bool = False
) -> Export:
    """Render a parameter file for a target and evaluate the target's own law from the rendered files.

    Parameters
    ----------
    parameters : ParameterFile
    target : str
    accelerations : {"measured", "computed"}
        As for `coeflab.motion.simulation.simulate`. The loss is counted from the file with its measured ones.
    accept_loss : bool
        Write without the terms that the target would do the wrong way round, and say which, where it has such.

    Raises
    ------
    PluginError
        No exporter has that name.
    InputError
        The target cannot hold the file at all, or not with its signs and ``accept_loss`` is false, or a file of it would leave the
        folder.
    """
    plugin = EXPORTERS.load(target)
    water = water_inertia(parameters, accelerations)
    given = with_accelerations(parameters, accelerations)
    with EXPORTERS.guarded(target):
        files = dict(plugin.render(given if isinstance(plugin, SimulatorExporter) else parameters))
    _refuse_places(files, parameters, target)
    if not isinstance(plugin, SimulatorExporter):
        files |= _remarks(files, parameters, target, found_in(parameters))
        return Export(parameters.name, target, files, None, plugin.citations)
    left = _left_out(plugin, given, accept_loss)
    missing = tuple(LossItem(Kind.MISSING, words) for words in plugin.missing(given))
    losses = (*left, *missing, *common_losses(parameters, plugin.holds, water))
    changes = (
        *dict.fromkeys((*plugin.changes(given), *water.warnings)),
        *without_law(parameters),
        *converted(parameters),
        *_renamed(files, parameters),
    )
    found = loss_of(
        target, parameters, files, plugin.force, plugin.not_held(given), losses, changes, water,
        plugin.added_mass if isinstance(plugin, InertialExporter) else None,
        plugin.steered_force if isinstance(plugin, SteeredExporter) else None,
    )  # fmt: skip
    lacking = () if "tables" in plugin.holds else lacking_tables(parameters)
    if isinstance(plugin, BuiltExporter):
        with EXPORTERS.guarded(target):
            files = dict(plugin.built(files))
    files |= _remarks(files, parameters, target, (*lacking, *found_in(parameters)))
    files[f"{file_stem(parameters.name)}.{target}.loss.txt"] = as_text(found, given).encode()
    return Export(parameters.name, target, files, found, plugin.citations)


def _remarks(
    files: Mapping[str, bytes], parameters: ParameterFile, target: str, due: Sequence[str]
) -> dict[str, bytes]:
    """What files have to say of their numbers, beside those of a format that has no place for it."""

    def letters(text: str) -> str:
        return re.sub(r"[\W_]+", "", text)

    written = letters("\n".join(content.decode(errors="ignore") for content in files.values()))
    found = [words for words in due if letters(words) not in written]
    if not found:
        return {}
    return {f"{file_stem(parameters.name)}.{target}.remarks.txt": ("\n".join(found) + "\n").encode()}


def _left_out(plugin: SimulatorExporter, given: ParameterFile, accept_loss: bool) -> tuple[LossItem, ...]:
    """What the target's files are without, for it would be of the wrong sign there.

    Raises
    ------
    InputError
        Something is, and no loss is accepted.
    """
    found = plugin.left_out(given) if isinstance(plugin, PartialExporter) else None
    if found is None:
        return ()
    why, words = found
    if not accept_loss:
        advice = f"{why.advice} Or accept the loss: it is written without, and the loss report says of what."
        raise InputError(why.found, why.expected, file=why.file, column=why.column, advice=advice)
    return tuple(LossItem(Kind.LEFT_OUT, phrases) for phrases in words)


def _refuse_places(files: Mapping[str, bytes], parameters: ParameterFile, target: str) -> None:
    """Refuse file names that lead out of the folder or that no file can bear."""
    for name in files:
        if "/" in name or "\\" in name or name.startswith(".") or not name.isprintable() or len(name) > LONGEST:
            theirs = parameters.name in name
            raise input_error(
                "formats.file_of_another_name", column="name" if theirs else f"exporter.{target}", name=shown(name),
                wanted="a name that files can be given" if theirs else "a plain file name",
            )  # fmt: skip


def _renamed(files: Mapping[str, bytes], parameters: ParameterFile) -> tuple[str, ...]:
    """What files are called where it is not the parameter file's name."""
    stems = sorted({name.partition(".")[0] for name in files})
    if parameters.name in stems:
        return ()
    return (
        f"files are called {', '.join(stems)}: of the name {shown(parameters.name)} letters and digits are kept, at most 63, and "
        f"{PREFIX} stands before a digit or a word that the target or a file system reserves",
    )


def parameter_files_rendered(several: Iterable[ParameterFile]) -> dict[str, bytes]:
    """Every parameter file and its tables as CSV, by name. Nothing is written."""
    files: dict[str, bytes] = {}
    for parameters in several:
        files[f"{file_stem(parameters.name)}.parameters.json"] = parameters.to_json()
        files.update(EXPORTERS.load("csv").render(parameters))
    return files


def refuse_unknown(planned: Sequence[PlannedExport]) -> None:
    """Refuse targets without an exporter before anything is computed.

    Raises
    ------
    PluginError
        Names the plan's file and key.
    """
    for p in planned:
        try:
            EXPORTERS.load(p.to)
        except PluginError as why:
            raise PluginError(f"{p.file}, {shown(str(p.key('to')))}: {why}" if p.file else str(why)) from None


def placed(exports: Iterable[Export]) -> dict[str, bytes]:
    """The files of exports beside their parameter files, by place."""
    return {f"{e.folder}/{name}" if e.folder else name: content for e in exports for name, content in e.files.items()}


def exports_of(
    planned: Sequence[PlannedExport],
    files: Iterable[ParameterFile],
    progress: Callable[[str], None],
    shapes: Mapping[str, Shape] = MappingProxyType({}),
) -> tuple[tuple[Export, ...], tuple[Refused, ...]]:
    """Every parameter file of a study for every target of its plan; what is refused does not keep the rest from being made.

    Parameters
    ----------
    planned : sequence of PlannedExport
    files : iterable of ParameterFile
    progress : callable
        Takes what is being done, in words.
    shapes : mapping of str to Shape, optional
        By the name of the parameter file: what a target shows, where the added mass is that of the file's own body.

    Returns
    -------
    tuple of Export
    tuple of Refused
        A target cannot hold a file, or not all of it and the plan does not accept that.
    """
    out: list[Export] = []
    refused: list[Refused] = []
    for p, parameters in ((p, parameters) for p in planned for parameters in files):
        try:
            out.append(_dressed(_accepted(p, parameters), parameters, shapes))
        except InputError as why:
            refused.append(Refused(parameters.name, p.to, why))
            progress(f"refused {parameters.name} for {p.to}")
        else:
            progress(f"exported {parameters.name} for {p.to}")
    return tuple(out), tuple(refused)


def _dressed(result: Export, parameters: ParameterFile, shapes: Mapping[str, Shape]) -> Export:
    """With what the target shows of the body, where its shape is known and the file's."""
    plugin, shape, hull = EXPORTERS.load(result.target), shapes.get(parameters.name), parameters.added_mass
    if not isinstance(plugin, DressedExporter) or shape is None or hull is None or hull.body != parameters.body:
        return result
    return replace(result, files=plugin.dressed(result.files, shape, np.array(parameters.reference_point.point)))


def _accepted(p: PlannedExport, parameters: ParameterFile) -> Export:
    """The export, if the plan accepts what it loses.

    Raises
    ------
    InputError
        Names the plan's file and key.
    """
    try:
        result = export(parameters, p.to, p.accelerations, accept_loss=p.accept_loss and not p.strict)
    except InputError as why:
        found = f"{why.found} in {parameters.name} for {p.to}"
        raise InputError(found, why.expected, file=p.file, column=p.key("to"), advice=why.advice) from None
    if not result.lossless and (p.strict or not p.accept_loss):
        accept = "accept_loss = true" if p.place else ACCEPT
        lost = loss_refused(result, parameters, strict=p.strict, place=f"{p.to}, ", accept=accept)
        column, advice = p.key("strict" if p.strict else "accept_loss"), text_of("formats.loss_of_plan", to=p.to)
        raise InputError(lost.found, lost.expected, file=p.file, column=column, advice=advice)
    return result


def loss_refused(
    result: Export, parameters: ParameterFile, advice: str = "", *, strict: bool = False, place: str = "",
    accept: str = ACCEPT,
) -> InputError:  # fmt: skip
    """The error about a target that loses part of a file and nobody accepted that.

    Parameters
    ----------
    result : Export
    parameters : ParameterFile
    advice : str
        Where the target lacks a mass.
    strict : bool
        No loss is accepted.
    place : str
        Before the words, such as the target.
    accept : str
        What accepts the loss.
    """
    loss = result.loss
    missing = loss is not None and parameters.added_mass is None and any(x.kind is Kind.MISSING for x in loss.lost)
    return input_error(
        "formats.loses_part", place=place, name=shown(parameters.name), value="" if loss is None else in_short(loss),
        expected=text_of("formats.without_loss" if strict else "formats.with_loss", accept=accept), advice=advice if missing else "",
    )  # fmt: skip
