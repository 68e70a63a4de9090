"""A parameter file sent through a manoeuvre, with what a study of it adds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from coeflab.model.manoeuvre import Figure
from coeflab.model.simulation import Simulation
from coeflab.model.vehicle import PLANES
from coeflab.workbench.manoeuvres import determined_until, moved, simulate

__all__ = ["Simulation", "determined_until", "moved", "planes", "simulate", "with_intervals"]


def with_intervals(figures: Sequence[Figure], bounds: Mapping[str, tuple[float, float]]) -> tuple[Figure, ...]:
    """Figures with the intervals that were found for some of them."""
    return tuple(replace(f, low=bounds[f.name][0], high=bounds[f.name][1]) if f.name in bounds else f for f in figures)


def planes() -> str:
    """The planes and their motions, in words."""
    return "; ".join(f"{name}: {' '.join(motions)}" for name, motions in PLANES.items())
