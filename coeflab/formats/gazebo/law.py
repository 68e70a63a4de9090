"""A link under gz-sim's Hydrodynamics system: what an SDF file holds of it, and the force that gz-sim makes of that.

Everything here is in the link frame FLU, about the link's origin, as in the file. The law is that of gz-sim's head of 2026
(commit 42d1720), src/systems/hydrodynamics: HydrodynamicsUtils.hh lines 43-70 (Coriolis of <xDotU>), 87-112 (damping), 148
and below (Coriolis of <fluid_added_mass>), put together in Hydrodynamics.cc, Configure and PreUpdate; other systems: systems.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.text.xml import numbers
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.formats.gazebo.assembly import pose_of
from coeflab.formats.gazebo.systems import GZ_SIM, System, system_of
from coeflab.law.rigid_body import momentum_force

FORCES, VELOCITIES = "xyzkmn", "UVWPQR"
SYSTEM = {"filename": "gz-sim-hydrodynamics-system", "name": "gz::sim::systems::Hydrodynamics"}
RESISTANCE = "coeflab_x0"
FLUID = tuple((i, j) for i in range(6) for j in range(i, 6))
FLUID_TAGS = {(i, j): "xyzpqr"[i] + "xyzpqr"[j] for i, j in FLUID}
DENSITY, LENGTH = "coeflab_density", "coeflab_length"
DENSITIES = ("water_density", "waterDensity", "uniform_fluid_density", "default_density", DENSITY)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("linear signed absolute plugin_mass fluid_mass centre")
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
    system : System
        Whose law it is.
    missing : tuple of str
        Tags that the file has not, where the system then takes a value of its own, with that value.
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
    system: System = GZ_SIM
    missing: tuple[str, ...] = ()

    def force(self, state: Array) -> Array:
        """Force and moment (n, 6) in steady motion without current, for velocities (n, 6) of the link's origin.

        The system's wrench is minus ``-C(Ma) v + D v``, applied at the link's origin. The plugin's Coriolis matrix is C_A
        of the positive added mass, so its share comes out as plus C_A(v) v: the reverse of what an ideal fluid does.
        With <fluid_added_mass> the physics engine (DART) moves a body of the summed spatial inertia, which is -C_A(v) v.
        """
        wrench = np.zeros_like(state)
        if not self.disable_coriolis:
            matrix = np.zeros((len(state), 6, 6))
            for row, column, sign, entry in self.system.coriolis:
                matrix[:, row, column] = sign * self.plugin_mass[entry, entry] * state[:, entry]
            wrench -= np.einsum("nij,nj->ni", matrix, state)
        for i in range(6):
            for j in range(6):
                damping = -self.linear[i, j] - np.abs(state) @ self.absolute[i, j] - state @ self.signed[i, j]
                wrench[:, i] += damping * state[:, j]
        return np.asarray(-wrench + momentum_force(state @ self.fluid_mass.T, state))

    @property
    def coriolis(self) -> Array:
        """(6, 6, 6) quadratics of the plugin's own Coriolis matrix, symmetric in the last two axes; zero where it is switched off."""
        out = np.zeros((6, 6, 6))
        for row, column, sign, entry in () if self.disable_coriolis else self.system.coriolis:
            half = 0.5 * sign * self.plugin_mass[entry, entry]
            out[row, entry, column] += half
            out[row, column, entry] += half
        return out


def hydrodynamics(root: Element, file: Path | str | None = None) -> tuple[Element, System]:
    """The one Hydrodynamics plugin of a document, and whose law it is.

    Raises
    ------
    InputError
        No such plugin or several; one whose law is not known.
    """
    found = [e for e in root.iter("plugin") if "hydrodynamics" in (e.get("filename", "") + e.get("name", "")).lower()]
    if len(found) != 1:
        raise input_error(
            "formats.several_plugins", file, count=len(found), advice="Keep one vehicle in the file." if found else ""
        )
    return found[0], system_of(found[0].get("filename", ""), found[0].get("name", ""), file)


def as_sdf(root: Element) -> Element:
    """A document whose links are written as SDF writes them; those of a URDF state the same in attributes, which are copied here."""
    for link in root.iter("link") if root.tag == "robot" else ():
        for part in link.iter("inertial"):
            if (origin := part.find("origin")) is not None and part.find("pose") is None:
                SubElement(part, "pose").text = f"{origin.get('xyz', '0 0 0')} {origin.get('rpy', '0 0 0')}"
            if (mass := part.find("mass")) is not None and mass.get("value") is not None:
                mass.text = mass.get("value")
        for part in (*link.iterfind("inertial/inertia"), *link.iterfind("collision/geometry/*")):
            for name, value in part.attrib.items():
                if part.find(name) is None:
                    SubElement(part, name).text = value
    return root


def read_gz_link(root: Element, file: Path | str | None = None) -> GzLink:
    """The link of the one Hydrodynamics plugin of a document, as `as_sdf` leaves it.

    Raises
    ------
    InputError
        No plugin or several, one whose law is not known, no link name, a tag that is no number.
    """
    plugin, system = hydrodynamics(root, file)
    name = (plugin.findtext("link_name") or "").strip()
    if not name:
        raise input_error("formats.no_link_name", file)
    link = next((e for e in root.iter("link") if e.get("name") == name.rpartition("::")[2]), None)
    inertial = None if link is None else link.find("inertial")
    pose = pose_of(inertial, file)
    axes = {(i, j): _one(inertial, f"inertia/i{'xyz'[i]}{'xyz'[j]}", file) for i in range(3) for j in range(i, 3)}
    inertia = symmetric(axes)
    model = next((e.get("name", "") for e in root.iter("model")), root.get("name", "") if root.tag == "robot" else "")
    density = next((v for tag in DENSITIES for e in root.iter(tag) if (v := numbers(e.text, (1,), tag, file)[0])), None)
    switch, on = system.switch
    damping, missing = _damping(plugin, system, file)
    return GzLink(
        model=model,
        link=name,
        linear=damping[0],
        signed=damping[1],
        absolute=damping[2],
        plugin_mass=damping[3],
        disable_coriolis=_flag(plugin, switch, file, default=on) is not on,
        disable_added_mass=system.defaults is None and _flag(plugin, "disable_added_mass", file),
        fluid_mass=_fluid(inertial, file),
        mass=_one(inertial, "mass", file),
        centre=pose.place,
        inertia=None if inertia is None else pose.turn @ inertia @ pose.turn.T,
        density=density,
        resistance=_one(plugin, RESISTANCE, file) or 0.0,
        system=system,
        missing=missing,
    )


def _damping(
    plugin: Element, system: System, file: Path | str | None
) -> tuple[tuple[Array, Array, Array, Array], tuple[str, ...]]:
    """Linear, signed and absolute damping and added mass by the system's own tags, and the tags that it fills itself."""
    if system.defaults is None:
        return (
            _tagged(plugin, (6, 6), lambda i, j: FORCES[i] + VELOCITIES[j], file),
            _tagged(plugin, (6, 6, 6), lambda i, j, k: FORCES[i] + VELOCITIES[j] + VELOCITIES[k], file),
            _tagged(plugin, (6, 6, 6), lambda i, j, k: f"{FORCES[i]}{VELOCITIES[j]}abs{VELOCITIES[k]}", file),
            _tagged(plugin, (6, 6), lambda i, j: f"{FORCES[i]}Dot{VELOCITIES[j]}", file),
        ), ()
    linear, absolute, mass = np.zeros((6, 6)), np.zeros((6, 6, 6)), np.zeros((6, 6))
    missing = []
    for i, (f, v) in enumerate(zip(FORCES, VELOCITIES, strict=True)):
        values = []
        for tag in (f"{f}{v}", f"{f}{v}{v}", f"{f}Dot{v}"):
            stated = _one(plugin, tag, file)
            values.append(system.defaults[tag] if stated is None else stated)
            if stated is None and system.defaults[tag]:
                missing.append(f"<{tag}> {system.defaults[tag]:g}")
        linear[i, i], absolute[i, i, i], mass[i, i] = values
    return (linear, np.zeros((6, 6, 6)), absolute, mass), tuple(missing)


def read_tags(system: System) -> frozenset[str]:
    """Every tag of the plugin that a law here reads."""
    own = {"link_name", system.switch[0], *DENSITIES, LENGTH, RESISTANCE}
    if system.defaults is not None:
        return frozenset({*own, *system.defaults})
    pairs = [(f, v) for f in FORCES for v in VELOCITIES]
    return frozenset({
        *own, "disable_added_mass", *(f + v for f, v in pairs), *(f"{f}Dot{v}" for f, v in pairs),
        *(f + v + w for f, v in pairs for w in VELOCITIES), *(f"{f}{v}abs{w}" for f, v in pairs for w in VELOCITIES),
    })  # fmt: skip


def _one(parent: Element | None, tag: str, file: Path | str | None) -> float | None:
    return None if parent is None or parent.find(tag) is None else numbers(parent.findtext(tag), (1,), tag, file)[0]


def _tagged(plugin: Element, shape: tuple[int, ...], name: Callable[..., str], file: Path | str | None) -> Array:
    out = np.zeros(shape)
    for at in np.ndindex(*shape):
        out[at] = _one(plugin, name(*at), file) or 0.0
    return out


def _flag(plugin: Element, tag: str, file: Path | str | None, *, default: bool = False) -> bool:
    text = (plugin.findtext(tag) or str(default)).strip().lower()
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
