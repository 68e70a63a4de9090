"""The HUUV in five degrees of freedom as a parameter file, where the roll is left undescribed, so that simulators hold it."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from typing import Any

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.formats.stated_table import stated_table
from coeflab.law.added_mass import AddedMass, OtherMethod
from coeflab.law.rigid_body import MassProperties
from coeflab.published.huuv.five_dof import BODY, FiveDof, pitch_slope
from coeflab.published.huuv.model import parameter_file
from coeflab.vehicle.parameter_file import ParameterFile

SOURCES = ("vehicle.toml", "turns.csv", "five_dof.toml")
NOTES = (
    "Horizontal plane: constants of vehicle.toml, tuned to the MATLAB half of Fig. 17 or chosen. Vertical plane: C_L, C_m and M_mq are "
    "the horizontal laws over the paper's factor of 2, assumed; the paper prints no number of Figs. 12-16.",
    "Elevators: db, both together, laws over delta - alpha of a synthetic table; the file takes V^2 where equations 15-17 have "
    "V_xz^2 = V^2 cos^2(beta).",
    "Sense of db: as in the paper, over delta - alpha, a positive angle turns the leading edge down and the trailing edge up, so that "
    "+30 deg at alpha = 0 lifts less and turns the bow down. That is against coeflab's rule for planes on a body, hinge [0, 1, 0], "
    "positive with trailing edges down; the sign is the paper's and is kept.",
    "Weight 19 kg printed; buoyancy, z_CG and moments of inertia assumed. Roll is not described: p stays zero.",
)
MASSES = {
    "stated": "m_x, m_y, m_yr and J_z of the steady turns, which the paper does not print; the rest by equations 28-32, radii assumed",
    "geometry": "equations 28-32 as corrected of an assumed geometry: an illustration",
}


def five_dof_file(huuv: FiveDof) -> ParameterFile:
    """Tables over incidence, rates and elevator angle, weight and buoyancy, thrusters, and the added mass of `FiveDof.added`."""
    base, c, own = parameter_file(huuv.level), huuv.level.constants, huuv.constants
    by, density, primes = own["tuned_by"], huuv.density, base.scaling
    force, moment = (primes.unit(component, density) for component in "XN")
    end, fastest, most = (huuv.level.chosen["largest_drift"], huuv.level.chosen["largest_rate"], own["largest_angle"])
    result: dict[str, Any] = {
        "form": "polynomial", "table": "five_dof.toml", "campaign": "HUUV, assumed",
        "statements": ("Assumed, see five_dof.toml: neither points nor residuals.",),
    }  # fmt: skip
    attack, drift = ("rad", -end, end), ("rad", -end, end)

    def power(variable: str, n: int) -> tuple[tuple[str, int, bool], ...]:
        return ((variable, n, False),)

    pressed = 0.5 * density * own["area"]
    elevator = {
        "C_D": (force, (0, 2), (own["C_D0"], own["C_D2"])),
        "C_L": (force, (1, 3), (own["C_L1"], own["C_L3"])),
        "C_m": (moment, (1, 3), tuple(own["length"] * own[f"C_m{n}"] + own["lever"] * own[f"C_L{n}"] for n in (1, 3))),
    }
    horizontal = [m.model_dump() for m in base.models if m.response != "C_D"]
    models = (
        stated_table(
            "C_D", {"alpha": attack, "beta": drift},
            {"1": ((), c["d0"]), "alpha^2": (power("alpha", 2), c["d2"]), "beta^2": (power("beta", 2), c["d2"])},
            force, **result,
        ),
        *horizontal,
        stated_table(
            "C_L", {"alpha": attack},
            {"alpha": (power("alpha", 1), c["s1"] / by), "alpha^3": (power("alpha", 3), c["s3"] / by)}, force, **result,
        ),
        stated_table(
            "C_m", {"alpha": attack},
            {"alpha": (power("alpha", 1), -pitch_slope(huuv)), "alpha^3": (power("alpha", 3), -c["n3"] / by)}, moment, **result,
        ),
        stated_table(
            "M", {"q": ("rad/s", -fastest, fastest)}, {"q|q|": ((("q", 1, False), ("q", 1, True)), -c["nrr"] / by)}, 1.0,
            unit="N*m", **result,
        ),
        *(
            stated_table(
                response, {"alpha": attack, "db": ("rad", -most, most)},
                _effective(powers, [pressed * v for v in values]), unit, **result,
            )
            for response, (unit, powers, values) in elevator.items()
        ),
    )  # fmt: skip
    centre = np.array([0.0, 0.0, own["centre_below"]])
    provenance = base.provenance.model_copy(update={"notes": (*NOTES, MASSES[huuv.masses]), "inputs": _inputs()})
    content = {
        **base.model_dump(),
        "name": "huuv_5dof" if huuv.masses == "stated" else "huuv_5dof_geometry",
        "body": "HUUV",
        "mass": MassProperties(c["m"], 0.0, own["pitch_inertia"], centre).primed(primes, density),
        "models": models,
        "added_mass": _added_mass(huuv),
        "hydrostatics": {"volume": own["displaced"], "centre_of_buoyancy": (0.0, 0.0, 0.0)},
        "surfaces": ({"control": "db", "limit": most},),
        "thrusters": tuple(t.model_dump() for t in base.thrusters),
        "provenance": provenance.model_dump(),
    }
    return ParameterFile.model_validate(content)


def _effective(powers: Sequence[int], values: Sequence[float]) -> dict[str, Any]:
    """Sum of values times (delta - alpha)^power - (-alpha)^power as products of db and alpha."""
    out: dict[str, Any] = {}
    for n, value in zip(powers, values, strict=True):
        for k in range(n):
            factors = tuple((v, p, False) for v, p in (("db", n - k), ("alpha", k)) if p)
            symbol = " ".join(v if p == 1 else f"{v}^{p}" for v, p, _ in factors)
            out[symbol] = (factors, value * comb(n, k) * (-1.0) ** k)
    return out


def _added_mass(huuv: FiveDof) -> AddedMass:
    other = OtherMethod("assumed geometry, equations 28-32 as corrected", huuv.geometry)
    words = (MASSES[huuv.masses],)
    return AddedMass(
        huuv.added, datum=Datum("cb"), body="HUUV", method="stated" if huuv.masses == "stated" else "primitives:huuv", statements=words, density=huuv.density,
        others=(other,) if huuv.masses == "stated" else (),
    )  # fmt: skip


def _inputs() -> tuple[InputFile, ...]:
    folder = shipped("cfd_data") / "huuv"
    body = shipped("geometry") / BODY / "body.toml"
    return (*(InputFile(n, sha256_of(folder / n)) for n in SOURCES), InputFile(f"{BODY}/body.toml", sha256_of(body)))
