"""A link under gz-sim's Hydrodynamics system: what an SDF file holds of it, and the force that gz-sim makes of that.

Everything here is in the link frame FLU, about the link's origin, as in the file. The law is that of gz-sim's head of 2026
(commit 42d1720), src/systems/hydrodynamics: HydrodynamicsUtils.hh lines 43-70 (Coriolis of <xDotU>), 87-112 (damping), 148
and below (Coriolis of <fluid_added_mass>), put together in Hydrodynamics.cc, Configure and PreUpdate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.text.xml import numbers
from coeflab.core.types import Array, brief, locked
from coeflab.law.rigid_body import momentum_force

FORCES, VELOCITIES = "xyzkmn", "UVWPQR"
SYSTEM = {"filename": "gz-sim-hydrodynamics-system", "name": "gz::sim::systems::Hydrodynamics"}
RESISTANCE = "coeflab_x0"
FLUID = tuple((i, j) for i in range(6) for j in range(i, 6))
FLUID_TAGS = {(i, j): "xyzpqr"[i] + "xyzpqr"[j] for i, j in FLUID}
DENSITY, LENGTH = "coeflab_density", "coeflab_length"
DENSITIES = ("water_density", "waterDensity", "uniform_fluid_density", "default_density", DENSITY)
# Row, column, sign, and index of diagonal entry and velocity, of every entry of buildCoriolisMatrix.
CORIOLIS = (
    (0, 4, -1, 2), (0, 5, 1, 1), (1, 3, 1, 2), (1, 5, -1, 0), (2, 3, -1, 1), (2, 4, 1, 0), (3, 1, -1, 2), (3, 2, 1, 1),
    (3, 4, -1, 5), (3, 5, 1, 4), (4, 0, 1, 2), (4, 2, -1, 0), (4, 3, 1, 5), (4, 5, -1, 3), (5, 0, -1, 1), (5, 1, 1, 0),
    (5, 3, -1, 4), (5, 4, 1, 3),
)  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class GzLink:
    """One link and its Hydrodynamics plugin.

    Attributes
    ----------
    model, link : str
    linear : (6, 6) array
        <xU> ... <nR>.
    signed, absolute : (6, 6, 6) arrays
        <xVR> and <yVabsU>, by force, velocity, velocity.
    resistance : float
        <coeflab_x0>, which gz-sim passes over: what <xUabsU>, <xVV> and <xWW> hold in common as X0 U^2.
    plugin_mass : (6, 6) array
        <xDotU> ..., Fossen's sign: negative.
    disable_coriolis, disable_added_mass : bool
    fluid_mass : (6, 6) array
        <fluid_added_mass>, positive; zeros where there is none.
    mass : float or None
        kg, of the link.
    centre : (3,) array
        Centre of gravity in the link frame, m.
    inertia : (3, 3) array or None
        About the centre of gravity, kg m^2, in the same axes.
    density : float or None
        kg/m^3, where the file states one.
    """

    model: str
    link: str
    linear: Array
    signed: Array
    absolute: Array
    plugin_mass: Array
    disable_coriolis: bool
    disable_added_mass: bool
    fluid_mass: Array
    mass: float | None
    centre: Array
    inertia: Array | None
    density: float | None
    resistance: float = 0.0

    def __post_init__(self) -> None:
        for name in ("linear", "signed", "absolute", "plugin_mass", "fluid_mass", "centre"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def force(self, state: Array) -> Array:
        """Force and moment (n, 6) in steady motion without current, for velocities (n, 6) of the link's origin.

        The system's wrench is minus ``-C(Ma) v + D v``, applied at the link's origin. The plugin's Coriolis matrix is C_A
        of the positive added mass, so its share comes out as plus C_A(v) v: the reverse of what an ideal fluid does.
        With <fluid_added_mass> the physics engine (DART) moves a body of the summed spatial inertia, which is -C_A(v) v.
        """
        wrench = np.zeros_like(state)
        if not self.disable_coriolis:
            matrix = np.zeros((len(state), 6, 6))
            for row, column, sign, entry in CORIOLIS:
                matrix[:, row, column] = sign * self.plugin_mass[entry, entry] * state[:, entry]
            wrench -= np.einsum("nij,nj->ni", matrix, state)
        for i in range(6):
            for j in range(6):
                damping = -self.linear[i, j] - np.abs(state) @ self.absolute[i, j] - state @ self.signed[i, j]
                wrench[:, i] += damping * state[:, j]
        return np.asarray(-wrench + momentum_force(state @ self.fluid_mass.T, state))


def read_gz_link(root: Element, file: Path | str | None = None) -> GzLink:
    """The link of the one Hydrodynamics plugin of a document.

    Raises
    ------
    InputError
        No plugin or several, no link name, a tag that is no number.
    """
    found = [e for e in root.iter("plugin") if "hydrodynamics" in (e.get("filename", "") + e.get("name", "")).lower()]
    if len(found) != 1:
        raise InputError(
            f"{len(found)} Hydrodynamics plugins", "one <plugin> of the system Hydrodynamics", file=file,
            advice="Keep one vehicle in the file." if found else "",
        )  # fmt: skip
    plugin = found[0]
    name = (plugin.findtext("link_name") or "").strip()
    if not name:
        raise InputError("no <link_name>", "the link that the plugin acts on", file=file)
    link = next((e for e in root.iter("link") if e.get("name") == name.rpartition("::")[2]), None)
    inertial = None if link is None else link.find("inertial")
    pose = [0.0] * 6 if inertial is None or inertial.find("pose") is None else _numbers(inertial, "pose", 6, file)
    axes = {(i, j): _one(inertial, f"inertia/i{'xyz'[i]}{'xyz'[j]}", file) for i in range(3) for j in range(i, 3)}
    model = next((e.get("name", "") for e in root.iter("model")), "")
    density = next((v for tag in DENSITIES for e in root.iter(tag) if (v := numbers(e.text, (1,), tag, file)[0])), None)
    return GzLink(
        model=model,
        link=name,
        linear=_tagged(plugin, (6, 6), lambda i, j: FORCES[i] + VELOCITIES[j], file),
        signed=_tagged(plugin, (6, 6, 6), lambda i, j, k: FORCES[i] + VELOCITIES[j] + VELOCITIES[k], file),
        absolute=_tagged(plugin, (6, 6, 6), lambda i, j, k: f"{FORCES[i]}{VELOCITIES[j]}abs{VELOCITIES[k]}", file),
        plugin_mass=_tagged(plugin, (6, 6), lambda i, j: f"{FORCES[i]}Dot{VELOCITIES[j]}", file),
        disable_coriolis=_flag(plugin, "disable_coriolis", file),
        disable_added_mass=_flag(plugin, "disable_added_mass", file),
        fluid_mass=_fluid(inertial, file),
        mass=_one(inertial, "mass", file),
        centre=np.array(pose[:3]),
        inertia=symmetric(axes),
        density=density,
        resistance=_one(plugin, RESISTANCE, file) or 0.0,
    )


def _numbers(parent: Element, tag: str, count: int, file: Path | str | None) -> tuple[float, ...]:
    return numbers(parent.findtext(tag), (count,), tag, file)


def _one(parent: Element | None, tag: str, file: Path | str | None) -> float | None:
    return None if parent is None or parent.find(tag) is None else _numbers(parent, tag, 1, file)[0]


def _tagged(plugin: Element, shape: tuple[int, ...], name: Callable[..., str], file: Path | str | None) -> Array:
    out = np.zeros(shape)
    for at in np.ndindex(*shape):
        out[at] = _one(plugin, name(*at), file) or 0.0
    return out


def _flag(plugin: Element, tag: str, file: Path | str | None) -> bool:
    text = (plugin.findtext(tag) or "false").strip().lower()
    if text not in ("true", "false", "1", "0"):
        raise InputError(shown(text), "true or false", file=file, column=tag)
    return text in ("true", "1")


def _fluid(inertial: Element | None, file: Path | str | None) -> Array:
    out = np.zeros((6, 6))
    element = None if inertial is None else inertial.find("fluid_added_mass")
    for (i, j), tag in FLUID_TAGS.items():
        out[i, j] = out[j, i] = _one(element, tag, file) or 0.0
    return out


def symmetric(axes: Mapping[tuple[int, int], float | None]) -> Array | None:
    """An inertia (3, 3) from its entries; products that are not stated are zero, None without all three moments."""
    if any(axes[i, i] is None for i in range(3)):
        return None
    return np.array([[axes[min(i, j), max(i, j)] or 0.0 for j in range(3)] for i in range(3)])
