"""`export`: a vehicle as the files of a simulator."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from coeflab.api.parameters import HasParameters, parameters_of
from coeflab.api.questions import above_zero
from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_all
from coeflab.core.texts import input_error
from coeflab.formats import EXPORTERS, loss_tables
from coeflab.formats.export import Export
from coeflab.formats.export import export as rendered
from coeflab.formats.lacking_law import without_law
from coeflab.formats.missing_parts import Kind
from coeflab.vehicle.other_water import in_water
from coeflab.vehicle.parameter_file import ParameterFile

__all__ = ["Export", "ParameterFile", "export", "in_water", "loss_tables", "refusal", "require_targets", "without_law"]
WITH_MASS = "Give the vehicle a mass and an added mass."


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
            raise refusal(result, parameters, "accept_loss=True, to write the rest", place=f"{to}, ")
        write_all(Path(out), result.files)
    return result


def refusal(
    result: Export, parameters: ParameterFile, expected: str, advice: str = WITH_MASS, place: str = ""
) -> InputError:
    """The error about a target that loses part of a file and nobody accepted that.

    Parameters
    ----------
    result : Export
    parameters : ParameterFile
    expected : str
        What would do.
    advice : str
        Where the target lacks a mass.
    place : str
        Before the words, such as the target.
    """
    loss = result.loss
    losses = () if loss is None else loss.lost
    missing = parameters.added_mass is None and any(x.kind is Kind.MISSING for x in losses)
    return input_error(
        "front_door.target_loses_part", place=place, name=shown(parameters.name),
        value="" if loss is None else loss_tables.in_short(loss), expected=expected, advice=advice if missing else "",
    )  # fmt: skip


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
