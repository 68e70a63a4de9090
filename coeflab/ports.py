"""Floor 2: what a plugin of each room looks like. A plugin is a module with these names in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.campaign import Campaign
from coeflab.model.check import Check
from coeflab.model.fit_result import FitResult
from coeflab.model.force_table import ForceTable
from coeflab.model.glider import Glider
from coeflab.model.manoeuvre import Figure, Manoeuvre
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.scaling import Scaling
from coeflab.model.study import Study
from coeflab.model.trajectory import Trajectory
from coeflab.model.vehicle import Vehicle
from coeflab.presentation.document import Document


@runtime_checkable
class Plugin(Protocol):
    """What every plugin has: one line about itself and the works that it rests on."""

    summary: str
    citations: tuple[str, ...]


@runtime_checkable
class Importer(Plugin, Protocol):
    """Reads the tables of a campaign into SI and FRD."""

    def read(self, campaign: Campaign, only: str | None = None) -> tuple[ForceTable, ...]:
        """Tables in SI and FRD.

        Parameters
        ----------
        campaign : Campaign
        only : str, optional
            File name of the one table that is wanted.
        """
        ...


@runtime_checkable
class BodyReader(Plugin, Protocol):
    """Reads a body."""

    def read(self, path: Path) -> Body:
        """The body of a file.

        Parameters
        ----------
        path : Path
            Of its body.toml.
        """
        ...


@runtime_checkable
class Fit(Plugin, Protocol):
    """Turns the tables of one campaign into coefficients."""

    def fit(self, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
        """Coefficients with their uncertainty.

        Parameters
        ----------
        tables : sequence of ForceTable
        scaling : Scaling
            Length of the primes.
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...


@runtime_checkable
class AddedMassMethod(Plugin, Protocol):
    """Computes the added-mass matrix of a body."""

    def added_mass(self, body: Body, density: float) -> AddedMass:
        """The matrix about the body's reference point, FRD.

        Parameters
        ----------
        body : Body
        density : float
            kg/m^3.
        """
        ...


@runtime_checkable
class Simulator(Plugin, Protocol):
    """Moves a vehicle through a manoeuvre."""

    def simulate(self, vehicle: Vehicle | Glider, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory:
        """The motion, as far as it goes; how it ended is a status of it.

        Parameters
        ----------
        vehicle : Vehicle or Glider
        manoeuvre : Manoeuvre
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...


@runtime_checkable
class ManoeuvrePlugin(Plugin, Protocol):
    """Says what a manoeuvre orders, and reads its figures off the motion."""

    plane: str

    def plan(self, vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
        """What is ordered when.

        Parameters
        ----------
        vehicle : Vehicle
        options : mapping of str to value
            Of the plugin's `Options`.
        """
        ...

    def figures(self, trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
        """Figures of the motion, each with a status.

        Parameters
        ----------
        trajectory : Trajectory
        vehicle : Vehicle
        options : mapping of str to value
            Those that planned it.
        """
        ...


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
class ParameterImporter(Plugin, Protocol):
    """Reads somebody's model file."""

    def read(self, path: Path) -> ParameterFile:
        """The model as a parameter file.

        Parameters
        ----------
        path : Path
        """
        ...


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


@runtime_checkable
class Renderer(Plugin, Protocol):
    """Renders a report in a format."""

    def render(self, document: Document) -> Mapping[str, bytes]:
        """Contents by file name.

        Parameters
        ----------
        document : Document
        """
        ...
