"""A link under uuv_simulator's hydrodynamic model "fossen": what its XML holds, and the force that the plugin makes of that.

The law is that of uuv_gazebo_plugins/src/HydrodynamicModel.cc, commit bea0a1b: lines 228-329 (what is read), 332-391 (velocities
of the link's origin turned to x forward, y starboard, z down, and back), 410-421 (Coriolis of the added mass), 424-442 (damping;
off-diagonal quadratic entries are not used). Line 389 applies the force by AddRelativeForce, which Gazebo's ODELink puts at the
centre of gravity, not at the link's origin. DAVE uses the same plugin.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.text.xml import numbers
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.formats.gazebo.law import symmetric
from coeflab.formats.uuv_simulator.xacro import Xacro
from coeflab.law.rigid_body import momentum_force
from coeflab.law.transforms import force_transfer, rotation

PLUGIN_DENSITY = 1028.0
FRD = np.array([1.0, -1.0, -1.0])
MATRICES = ("added_mass", "linear_damping", "linear_damping_forward_speed", "quadratic_damping")


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("added_mass linear forward quadratic centre reference")
class FossenLink:
    """One link, in FRD about its origin.

    Attributes
    ----------
    link : str
    added_mass, linear, forward, quadratic : (6, 6) arrays
        As in the file: added mass positive, damping negative.
    centre : (3,) array
        Centre of gravity from the link's origin, FRD, m; zero where the file does not say.
    reference : (3,) array
        Origin of a link ``reference_point`` fixed to this one, FRD, m; zero where there is none.
    density : float or None
        kg/m^3.
    mass, volume, length : float or None
        Of the link, in kg, m^3 and m.
    inertia : (3, 3) array or None
        About the centre of gravity, kg m^2, in the same axes.
    """

    link: str
    added_mass: Array
    linear: Array
    forward: Array
    quadratic: Array
    centre: Array
    reference: Array
    density: float | None
    mass: float | None
    volume: float | None
    length: float | None
    inertia: Array | None

    def force(self, nu: Array) -> Array:
        """Force and moment (n, 6) about the link's origin in steady motion without current, for its velocities (n, 6)."""
        damping = nu @ self.linear.T + nu[:, :1] * (nu @ self.forward.T) + np.diag(self.quadratic) * np.abs(nu) * nu
        return np.asarray((damping + momentum_force(nu @ self.added_mass.T, nu)) @ self.arm.T)

    @property
    def arm(self) -> Array:
        """(6, 6) matrix that takes what is applied at the centre of gravity to the link's origin."""
        return force_transfer(-self.centre)


def read_fossen_link(root: Element, file: Path | str | None = None) -> FossenLink:
    """The one link with a hydrodynamic model of a URDF or xacro document.

    Raises
    ------
    InputError
        None or several, another model than fossen, a matrix without 6 or 36 numbers, a property that is not defined.
    """
    x = Xacro(root, file)
    found = [e for e in root.iter("link") if e.find("hydrodynamic_model") is not None]
    if len(found) != 1:
        raise input_error(
            "formats.several_models", file, count=len(found), advice="Keep one vehicle in the file." if found else ""
        )
    element, model = found[0], found[0].find("hydrodynamic_model")
    _refuse_shapes(model, file)
    name = element.get("name", "")
    inertials = [i for e in root.iter("link") if e.get("name", "") == name and (i := e.find("inertial")) is not None]
    inertial = inertials[0] if inertials else None
    read = {tag: _matrix(model, tag, x, file) for tag in MATRICES}
    axes = {
        (i, j): _attribute(inertial, "inertia", f"i{'xyz'[i]}{'xyz'[j]}", x, file)
        for i in range(3)
        for j in range(i, 3)
    }
    inertia, turn = symmetric(axes), rotation(*_origin(inertial, "rpy", x, file))
    if inertia is not None:
        inertia = turn @ inertia @ turn.T
    return FossenLink(
        link=name,
        added_mass=read["added_mass"],
        linear=read["linear_damping"],
        forward=read["linear_damping_forward_speed"],
        quadratic=read["quadratic_damping"],
        centre=FRD * np.array(_origin(inertial, "xyz", x, file)) + 0.0,
        reference=FRD * np.array(_reference(root, name, x, file)) + 0.0,
        density=next(
            (_scalar(e, "fluid_density", x, file) for e in root.iter() if e.find("fluid_density") is not None), None
        ),
        mass=_attribute(inertial, "mass", "value", x, file),
        volume=_scalar(element, "volume", x, file),
        length=_scalar(element, "box/length", x, file),
        inertia=None if inertia is None else inertia * np.outer(FRD, FRD) + 0.0,
    )


def _refuse_shapes(model: Element | None, file: Path | str | None) -> None:
    """Refuse models whose coefficients the plugin computes from a shape."""
    kind = "" if model is None else (model.findtext("type") or "").strip()
    if kind != "fossen":
        raise input_error("formats.another_type", file, sort=shown(kind))


def _matrix(model: Element | None, tag: str, x: Xacro, file: Path | str | None) -> Array:
    text = None if model is None else model.findtext(tag)
    if text is None:
        return np.zeros((6, 6))
    values = numbers(x.text(text), (36,) if tag == "added_mass" else (6, 36), tag, file)
    return np.diag(values) if len(values) == 6 else np.array(values).reshape(6, 6)


def _scalar(parent: Element, tag: str, x: Xacro, file: Path | str | None) -> float | None:
    text = parent.findtext(tag)
    return None if text is None else numbers(x.text(text), (1,), tag, file)[0]


def _attribute(parent: Element | None, tag: str, name: str, x: Xacro, file: Path | str | None) -> float | None:
    element = None if parent is None else parent.find(tag)
    text = None if element is None else element.get(name)
    return None if text is None else numbers(x.text(text), (1,), f"{tag} {name}", file)[0]


def _origin(parent: Element | None, name: str, x: Xacro, file: Path | str | None) -> tuple[float, ...]:
    """Place, ``xyz``, m, or roll, pitch and yaw, ``rpy``, rad, of an origin."""
    element = None if parent is None else parent.find("origin")
    text = None if element is None else element.get(name)
    return (0.0, 0.0, 0.0) if text is None else numbers(x.text(text), (3,), f"origin {name}", file)


def _reference(root: Element, link: str, x: Xacro, file: Path | str | None) -> tuple[float, ...]:
    for joint in root.iter("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        fixed = joint.get("type") == "fixed" and parent is not None and child is not None
        if fixed and (parent.get("link"), child.get("link")) == (link, "reference_point"):  # type: ignore[union-attr]
            return _origin(joint, "xyz", x, file)
    return (0.0, 0.0, 0.0)
