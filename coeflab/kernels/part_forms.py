"""Which simple form a closed surface resembles, and the form's dimensions; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.kernels.brief import brief
from coeflab.kernels.form_fits import Fit, Piece, boxes, cylinders, ellipsoids
from coeflab.kernels.least_squares import Array
from coeflab.kernels.oriented_box import oriented_box
from coeflab.kernels.plate_fit import PlateFit, plate_fit
from coeflab.kernels.solids import Solid, form_solid, surface

THIN = 0.2
MISFIT, SHARED = 0.1, 0.8
ROUND_PLATE, PLATE_SHARED = 0.02, 0.6
BETTER = 1e-4


@brief
@dataclass(frozen=True, slots=True)
class Likeness:
    """A form and the numbers that chose it.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``plate`` (chord, span), ``ellipsoid`` (semi-axes) or ``box`` (sides).
    sizes : tuple of float
        m.
    rotation : (3, 3) array
        From the form's axes to the outer ones.
    centre : (3,) array
        m.
    clear : bool
        False where no form is good, and the one of least misfit stands in.
    reason : str
        The test that held, or why none did, in words and numbers.
    shared : float
        Share of the volume within the form; of a plate within its outline.
    misfit : float, optional
        Of a solid form.
    """

    form: str
    sizes: tuple[float, ...]
    rotation: Array
    centre: Array
    clear: bool
    reason: str
    shared: float
    misfit: float | None = None

    @property
    def kind(self) -> str:
        """The form, or ``other``."""
        return self.form if self.clear else "other"


def likeness(of: Solid) -> Likeness:
    """Classify a solid and fit the form.

    Notes
    -----
    A plate where the mean thickness, volume over area projected along the normal, is under 0.2 of the shorter of mean
    chord and span, whatever its sections and taper, if 0.6 of the volume lies within the plate's outline (a triangle's
    0.69 does, a ring's does not); a disc that a cylinder fits with a misfit under 0.02 is a cylinder.
    Else the cylinder, ellipsoid or box of the piece's volume with the least misfit: error of the length, plus errors of
    the three projected areas over their sum (`Fit.misfit`). Their axes are the principal ones and those of the oriented
    box. A misfit over 0.1, or a form that shares less than 0.8 of the volume with the piece, is no likeness.
    """
    piece = Piece.of(surface(of))
    principal = np.linalg.eigh(piece.spread)[1]
    frames = [principal, oriented_box(piece.vertices, principal)[0]]
    best = [_least(piece, list(fits(piece, frames))) for fits in (cylinders, ellipsoids, boxes)]
    flat = _thin(of, piece, principal[:, ::-1])
    if flat is not None and best[0][1] > ROUND_PLATE:
        thickness = piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span))
        sides = (flat.chord, flat.span, float(piece.extents(flat.rotation)[2]) * 2.0)
        within = (of ^ form_solid("box", sides, flat.rotation, flat.centre)).volume() / piece.volume
        reason = f"mean thickness {thickness:.3f} of the shorter of mean chord and span, under {THIN:g}"
        if within < PLATE_SHARED:
            reason += f"; only {within:.0%} of the volume within its outline, under {PLATE_SHARED:.0%}"
        return Likeness("plate", sides[:2], flat.rotation, flat.centre, within >= PLATE_SHARED, reason, within)
    fit, misfit = min(best, key=lambda scored: round(scored[1] / BETTER))
    shared = (of ^ form_solid(fit.form, fit.sizes, fit.rotation, piece.centre)).volume() / piece.volume
    clear = misfit <= MISFIT and shared >= SHARED
    reason = (
        "misfit " + ", ".join(f"{f.form} {value:.3f}" for f, value in best) + f"; shares {shared:.0%} of the volume"
    )
    if not clear:
        reason += f"; bounds {MISFIT:g} and {SHARED:.0%}"
    return Likeness(fit.form, fit.sizes, fit.rotation, piece.centre, clear, reason, shared, misfit)


def _thin(of: Solid, piece: Piece, turn: Array) -> PlateFit | None:
    """The plate across the third column of ``turn``, if it is thin; of equal area, a square has the longest short side."""
    if piece.volume / float(piece.projected(turn)[2]) ** 1.5 >= THIN:
        return None
    flat = plate_fit(surface(of), turn)
    return flat if piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span)) < THIN else None


def _least(piece: Piece, fits: list[Fit]) -> tuple[Fit, float]:
    """The fit of least misfit, the first of those that are as good."""
    scored = [(fit, fit.misfit(piece)) for fit in fits]
    return min(scored, key=lambda pair: round(pair[1] / BETTER))
