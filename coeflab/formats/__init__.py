"""Parameter files in the formats of other programs: one folder a program, with ``write``, ``read`` and its force law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from coeflab.core.errors import InputError
from coeflab.core.registry import Plugin, Registry

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from coeflab.bodies.shape import Shape
    from coeflab.core.table import Check
    from coeflab.vehicle.parameter_file import ParameterFile


@runtime_checkable
class Exporter(Plugin, Protocol):
    """Renders a parameter file for a target; pure, so that golden files hold it."""

    def render(self, parameters: ParameterFile) -> Mapping[str, bytes]:
        """Contents by file name.

        Parameters
        ----------
        parameters : ParameterFile
        """
        ...


@runtime_checkable
class SimulatorExporter(Exporter, Protocol):
    """An exporter whose target has a force law of its own, which proves what the export is worth.

    ``adds_coriolis`` says whether the target itself adds -C_A(nu) nu from the added mass that it is given. ``holds`` names the
    keys of the file beside its force law, of hydrostatics, thrusters and surfaces, that the target is given.
    """

    adds_coriolis: bool
    holds: frozenset[str]

    def force(self, files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 6) force of the target's law, FRD, about the file's reference point, in steady motion.

        Parameters
        ----------
        files : mapping of str to bytes
            What `render` made.
        nu : (n, 6) array
            u v w p q r, SI.
        """
        ...

    def not_held(self, parameters: ParameterFile) -> tuple[str, ...]:
        """Terms of the law that the target has no place for.

        Parameters
        ----------
        parameters : ParameterFile
        """
        ...

    def missing(self, parameters: ParameterFile) -> tuple[str, ...]:
        """What the target needs and the file does not have.

        Parameters
        ----------
        parameters : ParameterFile
        """
        ...

    def changes(self, parameters: ParameterFile) -> tuple[str, ...]:
        """What the target is given otherwise than the file has it, in words.

        Parameters
        ----------
        parameters : ParameterFile
        """
        ...


@runtime_checkable
class InertialExporter(SimulatorExporter, Protocol):
    """A simulator's exporter that also says what added mass the target integrates, so that accelerations are compared too."""

    def added_mass(self, files: Mapping[str, bytes]) -> NDArray[np.float64]:
        """(6, 6) added mass read from the written files, FRD, about the file's reference point, kg, kg m, kg m^2.

        Parameters
        ----------
        files : mapping of str to bytes
            What `render` made.
        """
        ...


@runtime_checkable
class SteeredExporter(SimulatorExporter, Protocol):
    """A simulator's exporter whose target holds control angles, so that their forces are compared too."""

    def steered_force(
        self, files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(n, 6) forces of the target, read from the written files, as `force`.

        Parameters
        ----------
        files : mapping of str to bytes
            What `render` made.
        nu : (n, 6) array
        controls : (n, 3) array
            dr, ds, db, rad.
        """
        ...


@runtime_checkable
class BuiltExporter(Exporter, Protocol):
    """An exporter whose files hold what a compiler of this machine makes of them, where there is one."""

    def built(self, files: Mapping[str, bytes]) -> Mapping[str, bytes]:
        """The files with it.

        Parameters
        ----------
        files : mapping of str to bytes
            What `render` made.
        """
        ...


@runtime_checkable
class DressedExporter(Exporter, Protocol):
    """An exporter whose target shows the body, where its shape is known beside the parameter file."""

    def dressed(self, files: Mapping[str, bytes], shape: Shape, point: NDArray[np.float64]) -> Mapping[str, bytes]:
        """The files with a mesh.

        Parameters
        ----------
        files : mapping of str to bytes
            What `render` made.
        shape : Shape
            m, FRD, from its datum.
        point : (3,) array
            The file's reference point from that datum.
        """
        ...


@runtime_checkable
class PartialExporter(SimulatorExporter, Protocol):
    """A simulator's exporter that leaves out of the law what its target would do the wrong way round.

    What it writes then is for those alone who accept losses.
    """

    def left_out(self, parameters: ParameterFile) -> tuple[InputError, tuple[str, ...]] | None:
        """Why the file is refused where no loss is accepted, and what is left out, in words; None where nothing is.

        Parameters
        ----------
        parameters : ParameterFile
        """
        ...


class NoDensityError(InputError):
    """A model file that states no density of the water, where none is given."""


def _nothing_found(_: Path) -> tuple[Check, ...]:
    return ()


@runtime_checkable
class ParameterImporter(Plugin, Protocol):
    """Reads somebody's model file.

    Attributes
    ----------
    reads : str
        What it reads, as a list of formats names it.
    signs : str
        The signs that the format takes, a sentence for findings about a wrong one.
    examine : callable
        From a path to findings: what the format lets go wrong and a parameter file cannot show.
    """

    reads: str
    signs: str = ""
    examine: Callable[[Path], Sequence[Check]] = _nothing_found

    def recognises(self, path: Path) -> bool:
        """Whether the file is of this format, by its content; at most one importer knows a file.

        Parameters
        ----------
        path : Path
            Of UTF-8 text.
        """
        ...

    def read(self, path: Path, density: float | None = None) -> ParameterFile:
        """The model as a parameter file.

        Parameters
        ----------
        path : Path
        density : float, optional
            kg/m^3, where the file states none.

        Raises
        ------
        NoDensityError
            The format states a density, this file does not, and none is given.
        """
        ...


EXPORTERS = Registry("coeflab.exporters", "exporter", Exporter, __name__, "write")  # type: ignore[type-abstract]
PARAMETER_IMPORTERS = Registry(
    "coeflab.parameter_importers",
    "parameter importer",
    ParameterImporter,  # type: ignore[type-abstract]
    __name__,
    "read",
)
