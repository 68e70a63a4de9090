"""A robot's one link in Stonefish, and the drags along its axes that stand for a force law.

Stonefish's form drag grows with the cube of the speed, its friction in proportion to it, and both are weighed by the direction of
the force on the whole mesh. Drags that meet a resistance straight ahead can be several times too large in drift.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief
from coeflab.formats.loss import covered_grid
from coeflab.formats.stonefish.law import added, raw_drag, weighed
from coeflab.law.transforms import force_transfer, velocity_transfer
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import second_order

DIGITS, ROUNDING = 6, 1e-9
FORCES = "XYZ"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class StonefishLink:
    """A mesh in water and its drags.

    Attributes
    ----------
    vertices, faces : (n, 3) and (m, 3) arrays
        m, FRD, from the reference point.
    centre : (3,) array
        Centre of gravity.
    form, skin : (3,) arrays
        ``quadratic_drag`` in s/m and ``viscous_drag`` in m/s, along the axes.
    density : float
        kg/m^3.
    """

    vertices: Array
    faces: NDArray[np.int64]
    centre: Array
    form: Array
    skin: Array
    density: float

    @property
    def corners(self) -> Array:
        """Of the faces, (m, 3, 3), from the centre of gravity."""
        return np.asarray(self.vertices[self.faces] - self.centre)

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD, about the reference point: drags, and what the added mass takes up in turning."""
        return np.asarray(self._inertial(nu) + self.per_coefficient(nu) @ np.concatenate([self.form, self.skin]))

    def per_coefficient(self, nu: Array) -> Array:
        """(n, 6, 6): the force, about the reference point, of each of the three form and three skin coefficients."""
        v, w = self._own(nu)
        form_force, form_torque, skin_force, skin_torque = raw_drag(self.corners, v, w)
        out = []
        for force, torque, scale in (
            (form_force, form_torque, 0.5 * self.density),
            (skin_force, skin_torque, self.density),
        ):
            for axis in scale * np.eye(3):
                out.append(self._moved(weighed(force, axis), weighed(torque, axis)))
        return np.stack(out, axis=-1)

    def _inertial(self, nu: Array) -> Array:
        v, w = self._own(nu)
        mass, moments = added(self.corners, self.density)
        return self._moved(-np.cross(w, mass * v), -np.cross(w, moments * w))

    def _own(self, nu: Array) -> tuple[Array, Array]:
        own = nu @ velocity_transfer(self.centre).T
        return own[:, :3], own[:, 3:]

    def _moved(self, force: Array, torque: Array) -> Array:
        return np.asarray(np.hstack([force, torque]) @ force_transfer(-self.centre).T)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ChosenDrags:
    """A link with drags, and what they are worth.

    Attributes
    ----------
    link : StonefishLink
    met : bool
        Whether the drags meet the file at its speed, straight along each axis; else they are those of least squares.
    none, at_speed, least : (3,) arrays
        Root mean square error of X, Y, Z over the covered range, N, without drag and with either kind of drags.
    ahead : float or None
        Drag straight ahead at the file's speed over the file's; None where the file has none.
    """

    link: StonefishLink
    met: bool
    none: Array
    at_speed: Array
    least: Array
    ahead: float | None

    def in_words(self) -> str:
        """The rule, the choice and its figures."""
        kinds = (
            ("no drag", self.none),
            ("drags met at the file's speed", self.at_speed),
            ("least squares", self.least),
        )
        figures = "; ".join(
            f"{kind} {' '.join(f'{c} {e:.3g}' for c, e in zip(FORCES, errors, strict=True))}" for kind, errors in kinds
        )
        chosen = (
            "drags that meet the file in value and slope at its speed are written, for over the covered range they make neither X "
            "nor Y nor Z worse than no drag"
            if self.met
            else "the drags are those of least squares over the covered range (X, Y and Z each over its error without drag, none below "
            "zero), for drags that meet the file at its speed make a force worse than no drag in drift and turning"
        )
        ahead = (
            "" if self.ahead is None else f"; straight ahead at that speed the drag is {self.ahead:.3g} of the file's"
        )
        return f"{chosen}; rms error in N: {figures}{ahead}"


def chosen_drags(parameters: ParameterFile, bare: StonefishLink) -> ChosenDrags:
    """Drags for a link without any.

    Those that meet the file straight along each axis at its speed, in value and slope, unless X, Y or Z then has a larger
    error over the covered range than without drag; else least squares, whose coefficients are not negative.
    """
    law, (nu, _) = force_law(parameters), covered_grid(parameters)
    columns = bare.per_coefficient(nu)[:, :3]
    missing = (law.force(nu) - bare.force(nu))[:, :3]
    met = met_at_speed(parameters, bare)
    none = _rms(missing)
    least = _least_squares(columns, missing, none)
    at_speed = _rms(missing - columns @ met)
    good = bool(np.all(at_speed <= none + ROUNDING * none.max()))
    coefficients = met if good else least
    link = replace(bare, form=coefficients[:3], skin=coefficients[3:])
    straight = parameters.conditions.speed * np.eye(6)[:1]
    resistance = float(law.force(straight)[0, 0])
    ahead = float(link.force(straight)[0, 0]) / resistance if resistance else None
    return ChosenDrags(link, good, none, at_speed, _rms(missing - columns @ least), ahead)


def met_at_speed(parameters: ParameterFile, bare: StonefishLink) -> Array:
    """Form and skin (6,): a drag k v^2 as k/(2U) v^3 + k U/2 v; zero along an axis where the file has none, or one that drives."""
    speed, law, axis = parameters.conditions.speed, second_order(force_law(parameters)), np.arange(3)
    square = np.maximum(-law.absolute[axis, axis, axis], 0.0)
    linear = np.maximum(-law.linear[axis, axis], 0.0)
    form_force, _, skin_force, _ = raw_drag(bare.corners, np.eye(3), np.zeros((3, 3)))
    form = 2.0 * square / (2.0 * speed) / (bare.density * -np.diag(form_force))
    skin = (linear + square * speed / 2.0) / (bare.density * -np.diag(skin_force))
    return np.concatenate([form, skin])


def _least_squares(columns: Array, wanted: Array, scale: Array) -> Array:
    """Coefficients (6,), none negative, to six digits: the seventh differs from one machine to the next."""
    from scipy.optimize import nnls

    used = scale > 0.0
    if not np.any(used):
        return np.zeros(6)
    a, b = columns[:, used] / scale[used, None], wanted[:, used] / scale[used]
    found, _ = nnls(a.reshape(-1, 6), b.ravel())
    return np.array([float(f"{x:.{DIGITS}g}") for x in found])


def _rms(errors: Array) -> Array:
    return np.asarray(np.sqrt(np.mean(errors**2, axis=0)))
