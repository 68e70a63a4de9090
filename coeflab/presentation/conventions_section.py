"""The conventions that every number of a report obeys, in short."""

from __future__ import annotations

from coeflab.model.study import Study
from coeflab.presentation.axes_figure import axes_figures
from coeflab.presentation.document import Section

TITLE = "Conventions used"
AXES = (
    "Axes: x forward, y to starboard, z down, right-handed, fixed in the body. X, Y, Z, K, M, N are what the fluid "
    "exerts on the body."
)
ANGLES = (
    "Angles: v' = v/U = sin(beta), positive when the body moves to starboard; w' = w/U = sin(alpha) cos(beta), "
    "positive when it moves down."
)
CONTROLS = (
    "Control angles keep the sign of their table. In the towing tank of SUBOFF a positive rudder angle gives Y to starboard and "
    "turns the bow to port (Ydr' = 0.005929, Ndr' = -0.002217), a positive stern plane angle gives Z up and turns the bow down "
    "(Zds' = -0.005603, Mds' = -0.002409): Roddy (1990), Table 4. The sketch has the sign of these."
)


def conventions_section(study: Study) -> Section:
    """Axes, signs, reference point, length, and what the forces contain."""
    text = [
        f"{AXES} Tables in other axes are turned into these as they are read.",
        f"{ANGLES} A table has to declare its own sign; figures show the sign used here. The fits "
        "use v' and w' themselves, the figures label them in degrees.",
        CONTROLS,
        _reference_points(study),
        _lengths(study),
        "Contents of the forces: hydrodynamic force in steady motion. Velocity derivatives therefore contain their "
        "potential parts, the Munk moment among them; a simulator that adds the Coriolis terms of the added mass must "
        "not count them again. Inertia of the model, where a table carries it, is taken out as the table is read.",
        "Forces at zero angle need not vanish on a real model. Every curve has a value at rest of its own, and where "
        "the points lie on both sides of zero it has a term of the other parity as well.",
    ]
    return Section("conventions", TITLE, tuple(t for t in text if t), figures=axes_figures("axes"))


def published_conventions(own: tuple[str, ...]) -> Section:
    """Axes and signs of a publication reproduced.

    Parameters
    ----------
    own : tuple of str
        What holds for this publication alone.
    """
    return Section("conventions", TITLE, (AXES, ANGLES, *own), figures=axes_figures("axes", controls=False))


def _reference_points(study: Study) -> str:
    places: dict[str, list[str]] = {}
    for f in study.fits:
        x, y, z = (float(c) for c in f.coefficients.reference_point)
        at = f"({x:.5g}, {y:.5g}, {z:.5g}) m from {f.coefficients.datum}"
        places.setdefault(at, []).append(f.campaign)
    if len(places) == 1:
        return f"Moments and velocities refer to the point {next(iter(places))}, in the axes above."
    each = "; ".join(f"{', '.join(dict.fromkeys(names))}: {at}" for at, names in places.items())
    return f"Moments and velocities refer to these points, in the axes above. {each}." if each else ""


def _lengths(study: Study) -> str:
    lengths = list(dict.fromkeys(str(f.coefficients.scaling) for f in study.fits))
    if not lengths:
        return ""
    named = " and ".join(lengths)
    return (
        f"Primes: Y' = Y / (1/2 rho U^2 L^2), N' = N / (1/2 rho U^2 L^3), r' = r L/U, with L = {named}. "
        "Coefficients on another length differ; they are rescaled before they are compared."
    )
