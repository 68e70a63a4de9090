"""coeflab: virtual CFD-tow and rotating-arm coefficient workbench for underwater vehicles.

>>> import coeflab
>>> study = coeflab.run(coeflab.validation("suboff"))
>>> study.fits[0].coefficients["Yv'"].value

Names are imported on first use, so that ``import coeflab`` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from coeflab.core.version import VERSION

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.readers import read_body
    from coeflab.core.errors import AxesError, CoeflabError, InputError, ScalingMismatchError, UnitsError
    from coeflab.core.files import shipped
    from coeflab.core.table import Check
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
    from coeflab.law.scaling import Conditions, Scaling
    from coeflab.published import validation
    from coeflab.study.plan import read_plan
    from coeflab.study.study import Plan, Study
    from coeflab.tables.campaign import read_campaign
    from coeflab.tables.force_table import ForceTable
    from coeflab.tables.importers import PlannedTable
    from coeflab.tables.reading import read_tables
    from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
    from coeflab.workbench import rendered, run


__version__ = VERSION
_HOMES = {
    "core.errors": ("AxesError", "CoeflabError", "InputError", "ScalingMismatchError", "UnitsError"),
    "core.files": ("shipped",),
    "bodies.body": ("Body",),
    "tables.campaign": ("read_campaign",),
    "core.table": ("Check",),
    "law.coefficient": ("Coefficient", "CoefficientSet", "Status"),
    "fits.results.fit_result": ("FitResult",),
    "fits.results.fitted_model": ("FittedModel",),
    "tables.force_table": ("ForceTable",),
    "vehicle.parameter_file": ("ParameterFile", "read_parameter_file"),
    "study.plan": ("read_plan",),
    "law.scaling": ("Conditions", "Scaling"),
    "study.study": ("Plan", "Study"),
    "tables.importers": ("PlannedTable",),
    "tables.reading": ("read_tables",),
    "bodies.readers": ("read_body",),
    "published": ("validation",),
    "workbench": ("rendered", "run"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "AxesError",
    "Body",
    "Check",
    "Coefficient",
    "CoefficientSet",
    "CoeflabError",
    "Conditions",
    "FitResult",
    "FittedModel",
    "ForceTable",
    "InputError",
    "ParameterFile",
    "Plan",
    "PlannedTable",
    "Scaling",
    "ScalingMismatchError",
    "Status",
    "Study",
    "UnitsError",
    "__version__",
    "read_body",
    "read_campaign",
    "read_parameter_file",
    "read_plan",
    "read_tables",
    "rendered",
    "run",
    "shipped",
    "validation",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"coeflab.{_HOME[name]}"), name)
    raise AttributeError(f"module 'coeflab' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
