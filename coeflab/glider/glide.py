"""Glides of a glider: steady ones by the balance of forces and moment, and a motion in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.glider.glider import Glider, GliderPhase
from coeflab.glider.motion import eigenvalues
from coeflab.glider.space import Spiral, steady_spiral
from coeflab.glider.steady_glide import balanced, glide
from coeflab.motion.trajectory import Ended, Trajectory

SETTLED = 0.01  # of the steady speed
ABOVE = 0.5  # m over the surface, beyond what a motion overshoots by: then it flies in the air


@dataclass(frozen=True, slots=True)
class SteadyGlide:
    """A glide on which all forces and the pitch moment balance.

    Attributes
    ----------
    phase : str
        Whose orders it flies on.
    net_mass, position : float
        kg and m.
    speed : float
        m/s.
    alpha, zeta : float
        Angle of attack and glide angle (below zero on a dive), rad.
    lift, drag : float
        N.
    growth : float
        Largest real part of the eigenvalues, 1/s; below zero it is stable.
    """

    phase: str
    net_mass: float
    position: float
    speed: float
    alpha: float
    zeta: float
    lift: float
    drag: float
    growth: float

    @property
    def theta(self) -> float:
        """Pitch angle, rad."""
        return self.zeta + self.alpha

    @property
    def ahead(self) -> float:
        """Speed over ground, m/s."""
        return float(self.speed * np.cos(self.zeta))

    @property
    def sinking(self) -> float:
        """Speed downward, m/s."""
        return float(-self.speed * np.sin(self.zeta))

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.growth < 0.0


def steady_glides(glider: Glider, phase: GliderPhase) -> tuple[SteadyGlide, ...]:
    """Every steady glide ahead on the orders of a phase, by rising angle of attack; none at neutral buoyancy.

    Angles of attack are searched where the polar is covered, or within 30 degrees where it does not say.
    """
    body, weight = glider.body, phase.net_mass * glider.gravity
    if weight == 0.0:
        return ()
    ahead, below = body.moments(*phase.setting[:2])
    out = []
    for alpha in balanced(body.polar, weight, body.munk, ahead, below, glider.polar.searched):
        speed, zeta = (float(v) for v in glide(body.polar, weight, alpha))
        values = eigenvalues(body, phase.setting, speed, float(alpha), zeta + float(alpha))
        out.append(
            SteadyGlide(
                phase=phase.name,
                net_mass=phase.net_mass,
                position=phase.position,
                speed=speed,
                alpha=float(alpha),
                zeta=zeta,
                lift=float(body.polar.lift_at(alpha)) * speed**2,
                drag=float(body.polar.drag_at(alpha)) * speed**2,
                growth=float(values.real.max()),
            )
        )
    return tuple(out)


def steady_spirals(glider: Glider, phase: GliderPhase) -> tuple[Spiral, ...]:
    """The steady turns that the steady glides of a phase become under its roller and thrusters; none without a motion in space."""
    if glider.space is None:
        return ()
    straight = steady_glides(glider, phase)
    found = (steady_spiral(glider.space, phase.setting, s.speed, s.alpha, s.theta) for s in straight)
    return tuple(s for s in found if s is not None)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class GlideRun:
    """A motion of a glider in time.

    Attributes
    ----------
    glider : Glider
    trajectory : Trajectory
        Controls ``net_mass``, kg, and ``position`` of the sliding mass, m, as they stand.
    """

    glider: Glider
    trajectory: Trajectory

    @property
    def time(self) -> Array:
        """(n,) s."""
        return self.trajectory.time

    @property
    def x(self) -> Array:
        """(n,) distance over ground, m."""
        return np.asarray(self.trajectory.position[:, 0])

    @property
    def depth(self) -> Array:
        """(n,) m."""
        return np.asarray(self.trajectory.position[:, 2])

    @property
    def theta(self) -> Array:
        """(n,) pitch, rad; in the vertical plane beyond 90 degrees in a loop."""
        if np.any(self.trajectory.attitude[:, [1, 3]]):
            return np.asarray(self.trajectory.angles[:, 1])
        return np.asarray(2.0 * np.arctan2(self.trajectory.attitude[:, 2], self.trajectory.attitude[:, 0]))

    @property
    def speed(self) -> Array:
        """(n,) m/s."""
        return self.trajectory.speed

    @property
    def alpha(self) -> Array:
        """(n,) angle of attack, rad; NaN at rest."""
        u, w = self.trajectory.velocity[:, 0], self.trajectory.velocity[:, 2]
        return np.where(self.speed > 0.0, np.arctan2(w, u), np.nan)

    @property
    def ends(self) -> tuple[int, ...]:
        """Last row of each phase that was begun."""
        phase = self.trajectory.phase
        return tuple(int(i) for i in [*np.flatnonzero(np.diff(phase)), len(phase) - 1])

    def phase_of(self, index: int) -> GliderPhase:
        """The phase that stands under an index over all cycles."""
        return self.glider.phases[index % len(self.glider.phases)]

    def nearest(self, index: int) -> SteadyGlide | None:
        """The steady glide nearest in speed to the end of a phase."""
        speed = float(self.speed[self.ends[index]])
        found = steady_glides(self.glider, self.phase_of(index))
        return min(found, key=lambda g: abs(g.speed - speed), default=None)

    def steady_speed(self, index: int) -> float | None:
        """Speed, m/s, that a phase tends to: of the spiral where it turns, else of the nearest steady glide."""
        if not self.phase_of(index).turns:
            near = self.nearest(index)
            return None if near is None else near.speed
        spirals = steady_spirals(self.glider, self.phase_of(index))
        return spirals[0].speed if spirals else None

    def settling(self, index: int) -> float | None:
        """Time from the start of a phase until the speed stays within 1 % of the steady one, s; None where it does not."""
        steady, last = self.steady_speed(index), self.ends[index]
        first = self.ends[index - 1] if index else 0
        if steady is None:
            return None
        apart = np.flatnonzero(np.abs(self.speed[first : last + 1] / steady - 1.0) > SETTLED)
        row = first + (int(apart[-1]) + 1 if len(apart) else 0)
        return float(self.time[row] - self.time[first]) if row <= last else None

    def settled(self, index: int) -> bool:
        """Whether a phase ends within 1 % of the speed of a steady glide, the engine at rest."""
        steady, row = self.steady_speed(index), self.ends[index]
        reached = abs(float(self.trajectory.controls["net_mass"][row]) - self.phase_of(index).net_mass) < 1e-9
        return steady is not None and reached and abs(float(self.speed[row]) / steady - 1.0) < SETTLED

    @property
    def statements(self) -> tuple[str, ...]:
        """What a reader has to know, in words."""
        t = self.trajectory
        out = [*([] if t.ended is Ended.COMPLETE else [f"The motion ended early: {t.why}."]), *t.statements]
        if np.min(self.depth, initial=0.0) < -ABOVE:
            out.append(
                f"It rises to {-np.min(self.depth):.1f} m above the surface, which these equations do not model."
            )
        missed = [
            p.name
            for i in range(len(self.ends))
            if (p := self.phase_of(i)).until_depth is not None and t.reached[i] is None
        ]
        if missed and t.ended is Ended.COMPLETE:
            out.append(f"Not met within the time of the phase: the depth of {', '.join(dict.fromkeys(missed))}.")
        return tuple(out)
