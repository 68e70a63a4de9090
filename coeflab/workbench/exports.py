"""A parameter file for a simulator: the target's files, and what they lose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from coeflab.core.errors import InputError, shown
from coeflab.exporters import EXPORTERS
from coeflab.model.force_law import force_law
from coeflab.model.loss import Loss, loss_of
from coeflab.model.parameter_file import ParameterFile
from coeflab.ports import SimulatorExporter
from coeflab.presentation.loss_tables import as_text


@dataclass(frozen=True, slots=True)
class Export:
    """Files by name, and the loss; None for tables, which hold the parameter file as it is."""

    target: str
    files: Mapping[str, bytes]
    loss: Loss | None


def export(parameters: ParameterFile, target: str) -> Export:
    """Render a parameter file for a target and evaluate the target's own law from the rendered files.

    Raises
    ------
    PluginError
        No exporter has that name.
    InputError
        The target cannot hold the file at all, or a file of it would leave the folder.
    """
    plugin = EXPORTERS.load(target)
    files = dict(plugin.render(parameters))
    report = f"{parameters.name}.{target}.loss.txt"
    for name in (*files, report):
        if "/" in name or "\\" in name or name.startswith(".") or not name.isprintable():
            raise InputError(f"a file called {shown(name)}", "a plain file name", column=f"exporter.{target}")
    if not isinstance(plugin, SimulatorExporter):
        return Export(target, files, None)
    found = loss_of(
        target, force_law(parameters), parameters, files, plugin.force, plugin.not_held(parameters),
        plugin.changes(parameters),
    )  # fmt: skip
    files[report] = as_text(found, parameters).encode()
    return Export(target, files, found)
