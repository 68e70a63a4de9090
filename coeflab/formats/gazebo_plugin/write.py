"""gz-sim: an SDF 1.9 model with <xDotU> in the Hydrodynamics plugin, Coriolis switched off, totals in the damping.

For physics engines without <fluid_added_mass> (Bullet, MuJoCo). The plugin's own Coriolis term has its sign reversed (see
`coeflab.formats.gazebo.law`), so it is disabled and the ideal fluid's products are written out. The plugin takes accelerations from
the step before, which is unstable where the added mass exceeds the body's own.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from coeflab.core.axes import FLU
from coeflab.formats.exported_law import common_changes, exported_law, number
from coeflab.formats.gazebo.law import FORCES, VELOCITIES
from coeflab.formats.gazebo.sdf import (
    fins,
    missing_in_sdf,
    not_in_sdf,
    placed,
    sdf,
    sdf_added_mass,
    sdf_force,
    sdf_steered_force,
    tags,
)
from coeflab.formats.gazebo.seen import with_mesh
from coeflab.vehicle.parameter_file import ParameterFile

summary = "gz-sim: SDF 1.9, added mass and total damping in the Hydrodynamics plugin, its Coriolis disabled"
citations = ("fossen2011", "gz_sim")
adds_coriolis = False
holds = frozenset({"hydrostatics", "thrusters", "surfaces", "rates"})
force, not_held, missing = sdf_force, not_in_sdf, missing_in_sdf
added_mass = sdf_added_mass
steered_force, dressed = sdf_steered_force, with_mesh

VERSION = "1.9"


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """A model, its link's origin at the reference point, and a world of water with it."""
    h = exported_law(parameters)
    written = [("disable_coriolis", "true")]
    mass = -h.matrix * np.outer(FLU, FLU)
    written += [(f"{FORCES[i]}Dot{VELOCITIES[j]}", number(mass[i, j])) for i, j in np.argwhere(mass)]
    return sdf(parameters, VERSION, [*written, *tags(h.form)], None)


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """What was changed, in words."""
    h = exported_law(parameters)
    out = [
        "the plugin's own Coriolis term has its sign reversed and is disabled: totals are written, and what the ideal fluid "
        "adds beyond them as products such as <xVR>",
        "no added mass is known: no <xDotU> is written"
        if h.inert
        else f"added mass ({h.statements[0]}) as <xDotU> ..., negative",
    ]
    if parameters.mass is not None and (heaviest := float(h.matrix[:3, :3].diagonal().max())) >= parameters.mass.mass:
        out.append(
            f"UNSTABLE: an added mass of {heaviest:.4g} kg is not below the vehicle's {parameters.mass.mass:.4g} kg, and the "
            "plugin integrates it explicitly; use the target gazebo"
        )
    return (*out, *common_changes(parameters, h, whole=True), *fins(parameters), *placed(parameters))
