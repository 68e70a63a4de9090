"""`export`: a vehicle as the files of a simulator."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from coeflab.api.parameters import HasParameters, parameters_of
from coeflab.api.questions import above_zero
from coeflab.core.errors import InputError
from coeflab.core.files import write_all
from coeflab.core.texts import text_of
from coeflab.formats import EXPORTERS, loss_tables
from coeflab.formats.export import Export, loss_refused
from coeflab.formats.export import export as rendered
from coeflab.formats.lacking_law import without_law
from coeflab.vehicle.other_water import in_water
from coeflab.vehicle.parameter_file import ParameterFile

__all__ = [
    "Export",
    "ParameterFile",
    "export",
    "in_water",
    "loss_refused",
    "loss_tables",
    "require_targets",
    "without_law",
]


def export(
    vehicle: HasParameters | ParameterFile | str | Path,
    to: str,
    out: str | Path | None = None,
    *,
    accept_loss: bool = False,
    accelerations: str = "measured",
    density: float | str | None = None,
) -> Export:
    """Files of a simulator, and what they lose.

    Parameters
    ----------
    vehicle : Vehicle, str or Path
        A parameter file, or the name of a shipped one.
    to : str
        xdyn, gazebo, mss, mujoco, fmu, c ...: ``cf.plugins("exporters")``.
    out : str or Path, optional
        Folder to write into; without it nothing is written, and ``files`` has the contents.
    accept_loss : bool
        Write although the target cannot hold everything; ``loss`` says what is lost.
    accelerations : {"measured", "computed"}
    density : float or str, optional
        Of the water, kg/m^3; default the file's. Primes, mass and volume stay.

    Returns
    -------
    Export
        ``files``, ``loss``, ``lossless``.

    Raises
    ------
    InputError
        The target cannot hold all of the file and no loss is accepted.
    PluginError
        No such target.

    Examples
    --------
    >>> import coeflab as cf
    >>> sorted(cf.export("remus100", "csv").files)[0]
    'remus100.coefficients.csv'
    """
    parameters = parameters_of(vehicle)
    if density is not None:
        parameters = in_water(parameters, above_zero(density, "density", "density"))
    result = rendered(parameters, to, accelerations, accept_loss=accept_loss)
    if out is not None:
        if not accept_loss and not result.lossless:
            advice = text_of("formats.loss_lacks_mass")
            raise loss_refused(result, parameters, advice, place=f"{to}, ")
        write_all(Path(out), result.files)
    return result


def require_targets(names: Sequence[str]) -> None:
    """Refuse targets that no exporter has, before anything is computed.

    Raises
    ------
    InputError, PluginError
        None is named; no exporter has the name.
    """
    if not names:
        raise InputError("no target", f"one of {', '.join(EXPORTERS.names())}", column="--to")
    for name in names:
        EXPORTERS.load(name)
