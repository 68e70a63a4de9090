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
    from coeflab.core.errors import AxesError, CoeflabError, InputError, ScalingMismatchError, UnitsError
    from coeflab.core.files import shipped
    from coeflab.model.body import Body
    from coeflab.model.campaign import read_campaign
    from coeflab.model.check import Check
    from coeflab.model.coefficient import Coefficient, CoefficientSet, Status
    from coeflab.model.fit_result import FitResult
    from coeflab.model.fitted_model import FittedModel
    from coeflab.model.force_table import ForceTable
    from coeflab.model.parameter_file import ParameterFile, read_parameter_file
    from coeflab.model.plan import read_plan
    from coeflab.model.scaling import Conditions, Scaling
    from coeflab.model.study import Plan, PlannedTable, Study
    from coeflab.studies.validate import validation
    from coeflab.workbench import read_body, read_tables, rendered, run

__version__ = VERSION
_HOMES = {
    "core.errors": ("AxesError", "CoeflabError", "InputError", "ScalingMismatchError", "UnitsError"),
    "core.files": ("shipped",),
    "model.body": ("Body",),
    "model.campaign": ("read_campaign",),
    "model.check": ("Check",),
    "model.coefficient": ("Coefficient", "CoefficientSet", "Status"),
    "model.fit_result": ("FitResult",),
    "model.fitted_model": ("FittedModel",),
    "model.force_table": ("ForceTable",),
    "model.parameter_file": ("ParameterFile", "read_parameter_file"),
    "model.plan": ("read_plan",),
    "model.scaling": ("Conditions", "Scaling"),
    "model.study": ("Plan", "PlannedTable", "Study"),
    "studies.validate": ("validation",),
    "workbench": ("read_body", "read_tables", "rendered", "run"),
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
