"""The names of `import coeflab`, once: type checkers and editors read this file, and so does `coeflab` where to import a name from."""

from coeflab.api.body import AddedMass as AddedMass
from coeflab.api.body import Body as Body
from coeflab.api.body import read_body as read_body
from coeflab.api.comparing import Comparison as Comparison
from coeflab.api.comparing import compare as compare
from coeflab.api.designing import NextTests as NextTests
from coeflab.api.designing import next_tests as next_tests
from coeflab.api.estimating import estimate as estimate
from coeflab.api.exporting import export as export
from coeflab.api.fitted_law import Evaluated as Evaluated
from coeflab.api.fitted_law import FittedLaw as FittedLaw
from coeflab.api.fitting import fit as fit
from coeflab.api.motion import Motion as Motion
from coeflab.api.motion import manoeuvres as manoeuvres
from coeflab.api.motion import simulate as simulate
from coeflab.api.names import shipped_names as shipped_names
from coeflab.api.reading import read_table as read_table
from coeflab.api.reading import read_tables as read_tables
from coeflab.api.result import Points as Points
from coeflab.api.result import Result as Result
from coeflab.api.studies import Study as Study
from coeflab.api.studies import run as run
from coeflab.api.table import Table as Table
from coeflab.api.trimming import Trim as Trim
from coeflab.api.trimming import trim as trim
from coeflab.api.validations import validation as validation
from coeflab.api.vehicle import Vehicle as Vehicle
from coeflab.api.vehicle import read_vehicle as read_vehicle
from coeflab.api.vehicle import vehicle as vehicle
from coeflab.core.errors import (
    AxesError as AxesError,
)
from coeflab.core.errors import (
    CoeflabError as CoeflabError,
)
from coeflab.core.errors import (
    InputError as InputError,
)
from coeflab.core.errors import (
    PluginError as PluginError,
)
from coeflab.core.errors import (
    ScalingMismatchError as ScalingMismatchError,
)
from coeflab.core.errors import (
    UnitsError as UnitsError,
)
from coeflab.core.files import shipped as shipped
from coeflab.core.table import Check as Check
from coeflab.fits.results.fit_result import FitResult as FitResult
from coeflab.fits.results.fitted_model import FittedModel as FittedModel
from coeflab.formats.export import Export as Export
from coeflab.law.coefficient import Coefficient as Coefficient
from coeflab.law.coefficient import CoefficientSet as CoefficientSet
from coeflab.law.coefficient import Status as Status
from coeflab.law.scaling import Conditions as Conditions
from coeflab.law.scaling import Scaling as Scaling
from coeflab.motion.trim.linear_model import LinearModel as LinearModel
from coeflab.motion.trim.linear_model import LinearSchedule as LinearSchedule
from coeflab.report.rendered import rendered as rendered
from coeflab.study.plan import read_plan as read_plan
from coeflab.study.study import Plan as Plan
from coeflab.tables.campaign import read_campaign as read_campaign
from coeflab.tables.force_table import ForceTable as ForceTable
from coeflab.tables.importers import PlannedTable as PlannedTable
from coeflab.tank.front_door import Tow as Tow
from coeflab.tank.front_door import tow as tow
from coeflab.vehicle.parameter_file import ParameterFile as ParameterFile

__version__: str
