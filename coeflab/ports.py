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

    def read(self, campaign: Campaign, only: str | None = None) -> tuple[ForceTable, ...]: ...


@runtime_checkable
class BodyReader(Plugin, Protocol):
    """Reads a body."""

    def read(self, path: Path) -> Body: ...


@runtime_checkable
class Fit(Plugin, Protocol):
    """Turns the tables of one campaign into coefficients."""

    def fit(self, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult: ...


@runtime_checkable
class AddedMassMethod(Plugin, Protocol):
    """Computes the added-mass matrix of a body."""

    def added_mass(self, body: Body, density: float) -> AddedMass: ...


@runtime_checkable
class Simulator(Plugin, Protocol):
    """Moves a vehicle through a manoeuvre."""

    def simulate(self, vehicle: Vehicle | Glider, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory: ...


@runtime_checkable
class ManoeuvrePlugin(Plugin, Protocol):
    """Says what a manoeuvre orders, and reads its figures off the motion."""

    plane: str

    def plan(self, vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre: ...

    def figures(self, trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]: ...


@runtime_checkable
class Exporter(Plugin, Protocol):
    """Renders a parameter file for a target; pure, so that golden files hold it."""

    def render(self, parameters: ParameterFile) -> Mapping[str, bytes]: ...


@runtime_checkable
class SimulatorExporter(Exporter, Protocol):
    """An exporter whose target has a force law of its own, which proves what the export is worth.

    ``adds_coriolis`` says whether the target itself adds -C_A(nu) nu from the added mass that it is given. ``not_held`` are terms
    of the law that it has no place for, ``missing`` what it needs and the file does not have. ``holds`` names the keys of the
    file beside its force law, of hydrostatics, thrusters and surfaces, that the target is given.
    """

    adds_coriolis: bool
    holds: frozenset[str]

    def force(self, files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]: ...

    def not_held(self, parameters: ParameterFile) -> tuple[str, ...]: ...

    def missing(self, parameters: ParameterFile) -> tuple[str, ...]: ...

    def changes(self, parameters: ParameterFile) -> tuple[str, ...]: ...


@runtime_checkable
class ParameterImporter(Plugin, Protocol):
    """Reads somebody's model file."""

    def read(self, path: Path) -> ParameterFile: ...


@runtime_checkable
class Checker(Plugin, Protocol):
    """Looks at a whole study and says what stands out."""

    def check(self, study: Study) -> Sequence[Check]: ...


@runtime_checkable
class Renderer(Plugin, Protocol):
    """Renders a report in a format."""

    def render(self, document: Document) -> Mapping[str, bytes]: ...
