"""HoloOcean: a scenario whose agent moves by ``fossen_model: torpedo``.

The torpedo is a spheroid of the file's length and mass with REMUS 100's kind of law: it has no place for Yv, Nv, Yr or Mw and
no Munk moment. X0, Zw, Xww and Nr (at the file's speed) find theirs in Cd, area_fraction, e and T_yaw.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.text.json import parse_json
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import identifier
from coeflab.formats.exported_law import held_when_straight, states_buoyancy, straight_coefficients
from coeflab.formats.holoocean.torpedo import CROSS_FLOW, GRAVITY, WATER, Torpedo, lifting_area
from coeflab.formats.loss import unheld
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.inertia import central_inertia, centre_of_gravity
from coeflab.vehicle.parameter_file import ParameterFile

summary = (
    "HoloOcean: a scenario with fossen_model torpedo; drag, lift in heave and damping in yaw, no Yv, no Munk moment"
)
citations = ("fossen2011", "holoocean")
adds_coriolis = False
holds: frozenset[str] = frozenset()

NEVER = 1e9
_DEFAULTS = {"area_fraction": 0.7, "zeta_roll": 0.3, "zeta_pitch": 0.8, "r44": 0.3, "e": 0.7}
_LEFT_OUT = "the added mass of the file: HoloOcean computes its own, of a spheroid of this length and diameter"

_INERTIA = "the moments of inertia of the file: HoloOcean computes those of the spheroid"


def _fitted(parameters: ParameterFile) -> tuple[Torpedo, ForceLaw, tuple[str, ...]]:
    """The torpedo, the file's law, and which of the keys with defaults were found from the file.

    Raises
    ------
    InputError
        No mass, or one that makes the spheroid no longer than thick.
    """
    p, law = parameters, force_law(parameters)
    if p.mass is None:
        raise input_error("formats.holoocean_without_mass")
    length = p.scaling.length
    diam = float(np.sqrt(6.0 * p.mass.mass / (np.pi * p.conditions.density * length)))
    if diam >= length:
        raise InputError(f"{p.mass.mass:g} kg on {length:g} m", "a body longer than thick", column="mass.mass")
    moving = tuple(t for t in law.terms if t.speed_power == 2 - t.product.degree)
    of = {t.symbol: t.coefficient for t in moving if t.symbol == "Xww"}
    of |= straight_coefficients(replace(law, terms=moving), p.conditions.speed)
    rest = {t.symbol: t.coefficient for t in law.terms if t.speed_power == 0 and t.term.degree == 1}
    pressure, front = 0.5 * WATER, np.pi * diam**2 / 4.0
    blunt = max(0.0, -of.get("X0", 0.0)) / pressure
    found = {}
    area = lifting_area(-of.get("Zw", 0.0) / pressure - blunt, diam)
    if area is not None:
        found["area_fraction"] = area / (length * diam)
        aspect, slope = diam**2 / area, -of["Zw"] / pressure - blunt
        induced = slope + blunt / 2.0 - of.get("Xww", 0.0) / pressure
        if "Xww" in of and induced > 0.0:
            found["e"] = slope**2 / area / (np.pi * aspect * induced)
    centre = centre_of_gravity(p)
    keys = {**_DEFAULTS, **found}
    unit = Torpedo(
        p.mass.mass,
        length,
        diam,
        centre,
        _buoyancy(p, centre),
        T_surge=1.0,
        T_sway=1.0,
        T_yaw=1.0,
        Cd=blunt / front,
        **keys,
    )
    for k, (key, symbol) in enumerate((("zeta_roll", "Kp"), ("zeta_pitch", "Mq")), 3):
        size = 2.0 * np.sqrt(unit.mass * GRAVITY * max(0.0, float(unit.r_bg[2] - unit.r_bb[2])) * unit.inert[k])
        if size > 0.0:  # damping of roll and pitch is a share of the critical one, which needs a righting moment
            rate = -rest.get(symbol, 0.0) - of.get(symbol, 0.0) * p.conditions.speed
            found[key] = max(0.0, float(rate / size))
    unit = replace(
        unit, zeta_roll=found.get("zeta_roll", unit.zeta_roll), zeta_pitch=found.get("zeta_pitch", unit.zeta_pitch)
    )
    yaw = -rest.get("Nr", 0.0) - of.get("Nr", 0.0) * p.conditions.speed
    rates = (-rest.get("Xu", 0.0), -rest.get("Yv", 0.0), yaw)
    times = [float(m / rate) if rate > 0.0 else NEVER for m, rate in zip(unit.inert[[0, 1, 5]], rates, strict=True)]
    whole = {f.name: getattr(unit, f.name) for f in fields(unit)}
    whole |= dict(zip(("T_surge", "T_sway", "T_yaw"), times, strict=True))
    return Torpedo(**whole), law, tuple(found)


def _rights(parameters: ParameterFile) -> bool:
    """Whether the file has buoyancy above its weight: HoloOcean takes the root of the righting moment."""
    h = parameters.hydrostatics
    return h is not None and h.centre_of_buoyancy[2] <= centre_of_gravity(parameters)[2]


def _buoyancy(parameters: ParameterFile, centre: Array) -> Array:
    """r_bb: of the file where it rights the vehicle; else that of gravity."""
    h = parameters.hydrostatics
    return np.array(h.centre_of_buoyancy, dtype=float) if h is not None and _rights(parameters) else centre


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One scenario; the agent's origin is the reference point.

    Raises
    ------
    InputError
        As `_fitted` says.
    """
    torpedo, _, _ = _fitted(parameters)
    name = identifier(parameters.name)
    values = {f.name: getattr(torpedo, f.name) for f in fields(torpedo)}
    dynamics = {k: v.tolist() if isinstance(v, np.ndarray) else float(v) for k, v in values.items()}
    agent = {
        "agent_name": name,
        "agent_type": "TorpedoAUV",
        "sensors": [{"sensor_type": "DynamicsSensor", "configuration": {"UseCOM": True, "UseRPY": False}}],
        "control_scheme": 1,
        "location": [0, 0, -10],
        "rotation": [0, 0, 0],
        "fossen_model": "torpedo",
        "control_mode": "manualControl",
        "dynamics": {"rho": parameters.conditions.density, **dynamics},
    }
    scenario = {"name": name, "package_name": "Ocean", "world": "OpenWater", "main_agent": name, "agents": [agent]}
    return {f"{name}.json": (json.dumps(scenario, indent=2, allow_nan=False) + "\n").encode()}


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """HoloOcean's own law (`coeflab.formats.holoocean.write`, with its source) of the scenario's agent; FRD as it is."""
    return _read(files).force(nu)


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """What HoloOcean computes for a spheroid of the scenario's length and diameter."""
    return np.diag(_read(files).added)


def _read(files: Mapping[str, bytes]) -> Torpedo:
    (content,) = (raw for name, raw in files.items() if name.endswith(".json"))
    dynamics = parse_json(content.decode())["agents"][0]["dynamics"]
    given = {f.name: dynamics[f.name] for f in fields(Torpedo)}
    vectors = {k: np.array(given[k]) for k in ("r_bg", "r_bb")}
    return Torpedo(**{**given, **vectors})


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """The added mass; every term whose derivative at straight motion is not the target's; products; controls."""
    torpedo, law, found = _fitted(parameters)
    straight = held_when_straight(torpedo.force, law, parameters.conditions.speed)

    def held(t: ForceTerm) -> bool:
        return straight(t) or (t.symbol == "Xww" and "e" in found)

    inertia = (_INERTIA,) if central_inertia(parameters) is not None else ()
    return (_LEFT_OUT, *inertia, *unheld(law, held, ideal=False))


def missing(parameters: ParameterFile) -> tuple[str, ...]:  # noqa: ARG001 - the port's signature
    """Nothing: without a mass there is no export, and the rest is the spheroid's."""
    return ()


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the torpedo was made, in words."""
    t, _, found = _fitted(parameters)
    speed = parameters.conditions.speed
    words = [
        f"HoloOcean 2.3: the vehicle is a spheroid {t.length:.6g} m long, diameter {t.diam:.4g} m, that displaces its mass; HoloOcean adds its added "
        "mass, and of C_A(nu) nu only the products with p: no Munk moment",
        f"Cd {t.Cd:.4g} from X0; lift and drag are computed with 1026 kg/m^3 whatever rho is, for which Cd and area_fraction compensate",
        f"cross-flow drag is that of a cylinder, C_D {CROSS_FLOW:.4g} on {t.length:.4g} x {t.diam:.4g} m, in sway and yaw: not a matter of the file",
        f"T_yaw {t.T_yaw:.4g} s: damping in yaw does not grow with the speed; it equals Nr at {speed:g} m/s",
        "r_bb is the file's centre of buoyancy; HoloOcean takes buoyancy as equal to weight, whatever the file's volume is"
        if _rights(parameters)
        else "r_bb lies in r_bg, so that nothing rights the vehicle or damps roll and pitch: "
        + (
            "the file's buoyancy lies below its weight, where HoloOcean has no number"
            if parameters.hydrostatics is not None
            else f"{states_buoyancy(parameters, 'the file states no buoyancy')}; write the vehicle's"
        ),
        "axes and reference point are the file's",
    ]
    if "area_fraction" in found:
        words.append(f"area_fraction {t.area_fraction:.4g} from Zw: the reference area of the lift, not the hull's")
    if "e" in found:
        words.append(f"e {t.e:.4g} from Xww")
    if "zeta_roll" in found:
        words.append(
            f"zeta_roll {t.zeta_roll:.4g}, zeta_pitch {t.zeta_pitch:.4g} equal Kp and Mq at {speed:g} m/s; damping does not grow with the speed"
        )
    selected = [k for k in _DEFAULTS if k not in found]
    words.append(f"HoloOcean's default is used for {', '.join(selected)}: not in the file")
    unused = [n for n, value in (("T_surge", t.T_surge), ("T_sway", t.T_sway), ("T_yaw", t.T_yaw)) if value == NEVER]
    if unused:
        words.append(f"{', '.join(unused)} {NEVER:g} s, which is no damping: the file has none there")
    return tuple(words)
