"""coeflab: hydrodynamic coefficients of underwater vehicles, with an uncertainty, for simulators.

>>> import coeflab as cf
>>> result = cf.fit("suboff_roddy_2")              # a shipped campaign: Roddy's towing tests of SUBOFF, 1990
>>> round(result["Yv'"].value, 4), round(result["Yv'"].u95, 4)
(-0.0262, 0.0027)

Data in: `read_table`, `read_tables`, `read_body`, `read_vehicle`. Coefficients: `fit`, `estimate`, `next_tests`. Vehicles: `vehicle`, `compare`, `export`.
Motions: `simulate`, `trim`. Towing: `tow`. Studies: `run`. What these return has ``frame()`` for a DataFrame and ``plot(ax=...)`` for a picture.
SI and radians; a text such as ``"20 deg"`` has its unit. Wrong input is an `InputError`; nothing is written but by what says so.

Names are imported on first use, so that ``import coeflab`` costs nothing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from coeflab.core.cards import drawn_by
from coeflab.core.version import VERSION

if TYPE_CHECKING:
    from coeflab.api.body import AddedMass, Body, read_body
    from coeflab.api.comparing import Comparison, compare
    from coeflab.api.designing import NextTests, next_tests
    from coeflab.api.estimating import estimate
    from coeflab.api.exporting import export
    from coeflab.api.fitted_law import Evaluated, FittedLaw
    from coeflab.api.fitting import fit
    from coeflab.api.motion import Motion, manoeuvres, simulate
    from coeflab.api.names import shipped_names
    from coeflab.api.reading import read_table, read_tables
    from coeflab.api.result import Points, Result
    from coeflab.api.studies import Study, run
    from coeflab.api.table import Table
    from coeflab.api.trimming import Trim, trim
    from coeflab.api.validations import validation
    from coeflab.api.vehicle import Vehicle, read_vehicle, vehicle
    from coeflab.core.errors import AxesError, CoeflabError, InputError, PluginError, ScalingMismatchError, UnitsError
    from coeflab.core.files import shipped
    from coeflab.core.table import Check
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.formats.export import Export
    from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
    from coeflab.law.scaling import Conditions, Scaling
    from coeflab.motion.trim.linear_model import LinearModel, LinearSchedule
    from coeflab.report.rendered import rendered
    from coeflab.study.plan import read_plan
    from coeflab.study.study import Plan
    from coeflab.tables.campaign import read_campaign
    from coeflab.tables.force_table import ForceTable
    from coeflab.tables.importers import PlannedTable
    from coeflab.tank.front_door import Tow, tow
    from coeflab.vehicle.parameter_file import ParameterFile


__version__ = VERSION
_HOMES = {
    "api.reading": (
        "read_table",
        "read_tables",
    ),
    "api.table": ("Table",),
    "api.fitting": ("fit",),
    "api.fitted_law": ("Evaluated", "FittedLaw"),
    "api.result": (
        "Points",
        "Result",
    ),
    "api.body": (
        "AddedMass",
        "Body",
        "read_body",
    ),
    "api.vehicle": (
        "Vehicle",
        "read_vehicle",
        "vehicle",
    ),
    "api.motion": (
        "Motion",
        "manoeuvres",
        "simulate",
    ),
    "api.names": ("shipped_names",),
    "api.exporting": ("export",),
    "api.comparing": (
        "Comparison",
        "compare",
    ),
    "api.estimating": ("estimate",),
    "api.designing": ("NextTests", "next_tests"),
    "tank.front_door": ("Tow", "tow"),
    "api.trimming": ("Trim", "trim"),
    "api.studies": (
        "Study",
        "run",
    ),
    "core.errors": (
        "AxesError",
        "CoeflabError",
        "InputError",
        "PluginError",
        "ScalingMismatchError",
        "UnitsError",
    ),
    "core.files": ("shipped",),
    "core.table": ("Check",),
    "law.coefficient": (
        "Coefficient",
        "CoefficientSet",
        "Status",
    ),
    "law.scaling": (
        "Conditions",
        "Scaling",
    ),
    "formats.export": ("Export",),
    "fits.results.fit_result": ("FitResult",),
    "fits.results.fitted_model": ("FittedModel",),
    "motion.trim.linear_model": ("LinearModel", "LinearSchedule"),
    "tables.force_table": ("ForceTable",),
    "tables.campaign": ("read_campaign",),
    "tables.importers": ("PlannedTable",),
    "vehicle.parameter_file": ("ParameterFile",),
    "study.plan": ("read_plan",),
    "study.study": ("Plan",),
    "api.validations": ("validation",),
    "report.rendered": ("rendered",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "AddedMass",
    "AxesError",
    "Body",
    "Check",
    "Coefficient",
    "CoefficientSet",
    "CoeflabError",
    "Comparison",
    "Conditions",
    "Evaluated",
    "Export",
    "FitResult",
    "FittedLaw",
    "FittedModel",
    "ForceTable",
    "InputError",
    "LinearModel",
    "LinearSchedule",
    "Motion",
    "NextTests",
    "ParameterFile",
    "Plan",
    "PlannedTable",
    "PluginError",
    "Points",
    "Result",
    "Scaling",
    "ScalingMismatchError",
    "Status",
    "Study",
    "Table",
    "Tow",
    "Trim",
    "UnitsError",
    "Vehicle",
    "__version__",
    "compare",
    "estimate",
    "export",
    "fit",
    "manoeuvres",
    "next_tests",
    "read_body",
    "read_campaign",
    "read_plan",
    "read_table",
    "read_tables",
    "read_vehicle",
    "rendered",
    "run",
    "shipped",
    "shipped_names",
    "simulate",
    "tow",
    "trim",
    "validation",
    "vehicle",
]


_RENAMED = {
    "read_parameter_file": ("vehicle.parameter_file", "read_vehicle", "0.4")
}  # home, new name, release that lacks it


def __getattr__(name: str) -> Any:
    if name in _RENAMED:
        home, new, gone = _RENAMED[name]
        import warnings

        warnings.warn(f"coeflab.{name} is coeflab.{new}; {name} goes in {gone}", DeprecationWarning, stacklevel=2)
        return getattr(import_module(f"coeflab.{home}"), name)
    if name in _HOME:
        return getattr(import_module(f"coeflab.{_HOME[name]}"), name)
    near = "" if name.startswith("_") else import_module("coeflab.core.missed").nearest(name, __all__, verbs=True)
    raise AttributeError(
        f"module 'coeflab' has no attribute {name!r}{f'. Did you mean coeflab.{near}?' if near else ''}"
    )


def __dir__() -> list[str]:
    return __all__


def _card(renderer: str) -> Callable[[object], str]:
    found: Callable[[object], str] = getattr(import_module("coeflab.report.notebook"), renderer)
    return found


drawn_by(_card)


class _FrontDoor(ModuleType):
    """The package, of which ``vehicle`` is the verb, although a folder has that name too, whose import would set it."""

    @property
    def vehicle(self) -> Any:
        return import_module("coeflab.api.vehicle").vehicle

    @vehicle.setter
    def vehicle(self, folder: ModuleType) -> None:
        pass


sys.modules[__name__].__class__ = _FrontDoor
