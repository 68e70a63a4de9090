"""A second list of mutations, chosen before the code was read: signs, powers, transfers, media, series, grids and tables."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np

from coeflab.arm import kane
from coeflab.bodies import fin_lift
from coeflab.bodies.closed_forms import ellipsoid, revolution
from coeflab.core.files import shipped
from coeflab.estimates import crossflow
from coeflab.fits.uncertainty import grid_convergence
from coeflab.glider import motion as glider_motion
from coeflab.glider.glider import Glider
from coeflab.glider.motion import GliderBody
from coeflab.law import scaling, transforms
from coeflab.law.force_law import ForceLaw
from coeflab.motion import media, steady_turns
from coeflab.published.flyingfish import model as flyingfish_model
from coeflab.published.huuv import model as huuv_model
from tests.mutations.harness import (
    Suboff,
    Verdicts,
    edited,
    fish,
    refusals,
    steered,
    validate_estimates,
    validate_flyingfish,
    validate_huuv,
    validate_tank,
    validate_thauv,
    validate_urv,
)

Run = Callable[[Suboff], Verdicts]


def law(validate: Callable[[], Verdicts], function: Any, old: str, new: str, times: int = 1) -> Run:
    """A validation under another law."""

    def run(_: Suboff) -> Verdicts:
        with np.errstate(all="ignore"), edited(function, old, new, times):
            return refusals(validate)

    return run


def study_law(function: Any, old: str, new: str, **others: int) -> Run:
    """The study of SUBOFF, computed anew under another law; ``others`` are exponents of the length in the table of units."""

    def run(s: Suboff) -> Verdicts:
        units = {c: (2, power, 1) for c, power in others.items()}
        with ExitStack() as stack:
            stack.enter_context(np.errstate(all="ignore"))
            stack.enter_context(edited(function, old, new))
            stack.enter_context(patch.dict(scaling.QUANTITIES, units))
            return refusals(lambda: s.verdicts(s.rerun({}, anew=True)))

    return run


def data(edits: dict[str, list[tuple[str, str]]]) -> Run:
    """The study of SUBOFF on copies with edited texts."""
    return lambda s: refusals(lambda: s.verdicts(s.rerun(edits)))


def flipped(campaign: str, column: str) -> Run:
    """Sign of a column of a table."""

    def run(s: Suboff) -> Verdicts:
        lines = (shipped("cfd_data") / campaign / "table.csv").read_text(encoding="utf-8").splitlines()
        at, changes = lines[0].split(",").index(column), []
        for line in lines[1:]:
            cells = line.split(",")
            cells[at] = cells[at][1:] if cells[at].startswith("-") else f"-{cells[at]}" if cells[at] else ""
            changes.append((line, ",".join(cells)))
        return data({f"{campaign}/table.csv": changes})(s)

    return run


def _fish() -> Verdicts:
    return validate_flyingfish(fish())


def _glider() -> Verdicts:
    return validate_thauv(lambda g: g, (0,))


def _huuv() -> Verdicts:
    return validate_huuv(steered())


def always_heavy(g: Glider) -> Glider:
    """The engine makes the glider heavy where it ought to make it light."""
    return replace(g, phases=tuple(replace(p, net_mass=abs(p.net_mass)) for p in g.phases))


def joint_2(_: Suboff) -> Verdicts:
    """Whether it turns or slides."""
    other = "(-1.0 if k == 1 else 1.0) * "
    with (
        np.errstate(all="ignore"),
        edited(kane._bias_accelerations, "= turning + cross(w, along)", f"= turning + {other}cross(w, along)"),
    ):
        return refusals(validate_urv)


MUNK = '(2, ("my",), -u * v, (-v, -u, none)),\n        (2, ("mx",), u * v, (v, u, none))'
BLIND: tuple[tuple[str, str, Run], ...] = (
    ("suboff", "moments primed by L^2", study_law(scaling.powers_of, "2, 3 if", "2, 2 if", K=2, M=2, N=2)),
    ("suboff", "sign of the transfer of moments", study_law(transforms.force_transfer, "-skew(shift)", "skew(shift)")),
    ("suboff", "LOA for LBP in configuration 2", data({"suboff_roddy_2/campaign.toml": [('"13.9792 ft"', '"14.2917 ft"')]})),
    ("suboff", "inertia taken out of forces that hold none",
        data({"suboff_cfd_barehull/campaign.toml": [("contains_inertia = false                       # multiple", "contains_inertia = true # multiple")]})),
    ("suboff", "sign of M in the table of configuration 1", flipped("suboff_roddy_1", "M' [-]")),
    ("tank", "(N1/N2)^(1/2) between grids in space", law(validate_tank, grid_convergence.cell_sizes, "1.0 / dimension", "1.0 / 2.0")),
    ("tank", "Lamb's transverse factor of a spheroid +5 %",
        law(validate_tank, ellipsoid.ellipsoid_added_mass, "out[i] = size**3", "out[i] = (1.05 if i else 1.0) * size**3")),
    ("tank", "sign of Lamb's turning factor", law(validate_tank, ellipsoid.ellipsoid_added_mass, "size**5 * _turning", "-(size**5) * _turning")),
    ("tank", "lift slope by cos^2 of the sweep", law(validate_tank, fin_lift.low_aspect_lift_slope, "(c * np.sqrt", "(c**2 * np.sqrt")),
    ("tank", "x for x^2 in the strips' turning", law(validate_tank, revolution.meridian_integrals, "area * (x - centre) ** 2", "area * np.abs(x - centre)")),
    ("flyingfish", "sign of the weight in equation 51",
        law(_fish, flyingfish_model.steady_residuals, "needed[:, 0] += weight", "needed[:, 0] -= weight")),
    ("flyingfish", "thrust by the speed's 1.9th power",
        law(_fish, flyingfish_model.steady_residuals, "rotors.thrust[1] * speeds**2", "rotors.thrust[1] * speeds**1.9")),
    ("flyingfish", "air and water exchanged", law(_fish, media.through_media, "_stretch(media[phases[0].medium]", "_stretch(media[1 - phases[0].medium]")),
    ("flyingfish", "attitude reset at the surface",
        law(_fish, media.through_media, "attitude=part.attitude[-1]", "attitude=np.array([1.0, 0.0, 0.0, 0.0])")),
    ("thauv", "sign of the lift in the polar", law(_glider, glider_motion.rates, "lift = (polar", "lift = -(polar")),
    ("thauv", "alpha for alpha^2 in the drag", law(_glider, glider_motion.rates, "polar.drag[1] * alpha * alpha", "polar.drag[1] * alpha")),
    ("thauv", "sign of the sliding mass's moment", law(_glider, GliderBody.moments, "+ slide * position", "- slide * position")),
    ("thauv", "sign of the buoyancy engine on the way up", lambda _: refusals(lambda: validate_thauv(always_heavy))),
    ("huuv", "sign of (m + m_y) v r", law(_huuv, steady_turns.features, '(0, ("m", "my"), v * r, (none, r, v))', '(0, ("m", "my"), -v * r, (none, -r, -v))')),
    ("huuv", "Munk moment twice", law(_huuv, steady_turns.features, MUNK, MUNK.replace("u * v", "2.0 * u * v").replace("(-v, -u,", "(-2.0 * v, -2.0 * u,").replace("(v, u,", "(2.0 * v, 2.0 * u,"))),
    ("huuv", "no dead zone", law(_huuv, huuv_model.thrust_rates, "left > dead_zone, right > dead_zone", "left > 0.0, right > 0.0")),
    ("huuv", "sign of beta in the table of C_n",
        law(_huuv, huuv_model.parameter_file, '{"beta": ((("beta", 1, False),), c["n1"]), "beta^3": ((("beta", 3, False),), c["n3"])}',
            '{"beta": ((("beta", 1, False),), -c["n1"]), "beta^3": ((("beta", 3, False),), -c["n3"])}')),
    ("urv", "sign of the weight of link 2",
        law(validate_urv, kane.weight, "inertias[0][:, 0, 0]", "inertias[0][:, 0, 0] * np.where(np.arange(chain.count + 1) == 2, -1.0, 1.0)")),
    ("urv", "sign of the Coriolis term of joint 2", joint_2),
    ("estimates", "aspect ratio of a fin without its image", law(validate_estimates, vars(fin_lift)["_group"], "aspect = 2.0 *", "aspect =")),
    ("estimates", "sign of the cross-flow drag's lever",
        law(validate_estimates, crossflow.collected, "-integral(down * x, x), integral(side * x, x)", "integral(down * x, x), -integral(side * x, x)")),
    ("suboff", "v v for v|v| in the law", study_law(ForceLaw._multiplied, "np.abs(values, out=pool[split:])", "pool[split:] = values")),
)  # fmt: skip
