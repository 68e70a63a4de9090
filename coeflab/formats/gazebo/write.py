"""gz-sim: an SDF 1.10 model with <fluid_added_mass> and viscous damping in the Hydrodynamics plugin.

The physics engine adds the Coriolis and centripetal forces of <fluid_added_mass> and nothing can switch them off, so the
plugin gets what is left of every term. Integration is implicit in the added mass and does not explode where it is larger than
the body's own (gz-sim issues 1462 and 1923), which is why this way of writing is the default; ``gazebo_plugin`` is the other.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from coeflab.core.axes import FLU
from coeflab.formats.exported_law import common_changes, exported_law
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
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.vehicle.parameter_file import ParameterFile

summary = "gz-sim: SDF 1.10 with <fluid_added_mass>, viscous parts in the Hydrodynamics plugin"
citations = ("fossen2011", "gz_sim")
adds_coriolis = True
holds = frozenset({"hydrostatics", "thrusters", "surfaces", "rates"})
force, not_held, missing = sdf_force, not_in_sdf, missing_in_sdf
added_mass = sdf_added_mass
steered_force, dressed = sdf_steered_force, with_mesh

VERSION = "1.10"


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """A model, its link's origin at the reference point, and a world of water with it."""
    h = exported_law(parameters)
    fluid = None if h.inert else h.matrix * np.outer(FLU, FLU)
    written = [
        ("disable_coriolis", "true"),
        ("disable_added_mass", "true"),
        *tags(h.form.less(ideal_quadratics(h.matrix))),
    ]
    return sdf(parameters, VERSION, written, fluid)


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """What was changed, in words."""
    h = exported_law(parameters)
    added = (
        "no added mass is known: totals are written and no <fluid_added_mass>"
        if h.inert
        else f"gz-sim adds -C_A(nu) nu of <fluid_added_mass> ({h.statements[0]}): the viscous part of every term, total less what it "
        "adds, is written, so that nothing counts twice"
    )
    return (added, *common_changes(parameters, h, whole=True), *fins(parameters), *placed(parameters))
