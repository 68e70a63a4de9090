"""Which simple form a closed surface resembles, and the form's dimensions; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.oriented_box import oriented_box
from coeflab.bodies.mesh.solids import Solid, form_solid, revolved, surface
from coeflab.bodies.shape import Form, Turned, shadow
from coeflab.bodies.simplify.plate_fit import PlateFit, plate_fit
from coeflab.bodies.simplify.volume_forms import MAKES, Fit, Piece, boxes, cylinders, ellipsoids, tubes, turned_form
from coeflab.core.types import Array, brief
from coeflab.law.transforms import about_axis

PLAIN, BAR = 0.02, 5.0
THIN = 0.2
MISFIT, SHARED = 0.1, 0.8
ROUND_PLATE, PLATE_SHARED, FULL = 0.02, 0.6, 0.5
BETTER = 1e-4


@brief
@dataclass(frozen=True, slots=True)
class Likeness:
    """A form and the numbers that chose it.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``tube`` (radius, inner radius, length), ``plate`` (chord, span), ``ellipsoid``
        (semi-axes), ``box`` or ``bar`` (sides), or ``revolution``.
    sizes : tuple of float
        m; of a revolution its stations, then its radii.
    rotation : (3, 3) array
        From the form's axes to the outer ones.
    centre : (3,) array
        m.
    clear : bool
        False where no form is good: the one of least misfit is named, and the piece stays a mesh.
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
        """The form, or ``mesh``."""
        return self.form if self.clear else "mesh"

    @property
    def built(self) -> Form:
        """The form itself."""
        if self.form == "revolution":
            half = len(self.sizes) // 2
            return Turned(self.sizes[:half], self.sizes[half:])
        found: Form = MAKES[self.form](*self.sizes)
        return found


def likeness(of: Solid) -> Likeness:
    """Classify a solid and fit the form.

    Notes
    -----
    A tube where the piece has a hole and a tube of its extents and volume has a misfit of at most 0.1.
    A plate where the mean thickness, volume over area projected along the normal, is under 0.2 of the shorter of mean
    chord and span, whatever its sections and taper, if 0.6 of the volume lies within the plate's outline (a triangle's
    0.69 does, a ring's does not) and it fills half of its convex hull (a frame does not); a disc that a cylinder fits with a misfit under 0.02 is a cylinder.
    Else the cylinder, ellipsoid or box of the piece's volume with the least misfit: error of the length, plus errors of
    the three projected areas over their sum (`Fit.misfit`). Their axes are the principal ones and those of the oriented
    box. A misfit over 0.1, or a form that shares less than 0.8 of the volume with the piece, is no likeness. Where the misfit is
    over 0.02 and the piece is round, the body of revolution that follows its sections is taken if its misfit is less than half.
    A box more than five times as long as wide is a bar.
    """
    piece = Piece.of(surface(of))
    principal = np.linalg.eigh(piece.spread)[1]
    frames = [principal, oriented_box(piece.vertices, principal)[0]]
    if of.genus() > 0:
        hollow = list(tubes(piece, frames))
        if hollow:
            tube, misfit = _least(piece, hollow)
            inside = (of ^ form_solid("tube", tube.sizes, tube.rotation, piece.centre)).volume() / piece.volume
            if misfit <= MISFIT and inside >= SHARED:
                why = f"misfit tube {misfit:.3f}; shares {inside:.0%} of the volume"
                return Likeness("tube", tube.sizes, tube.rotation, piece.centre, True, why, inside, misfit)
    best = [_least(piece, list(fits(piece, frames))) for fits in (cylinders, ellipsoids, boxes)]
    flat = _thin(of, piece, principal[:, ::-1])
    if flat is not None and best[0][1] > ROUND_PLATE:
        thickness = piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span))
        sides = (flat.chord, flat.span, float(piece.extents(flat.rotation)[2]) * 2.0)
        within = (of ^ form_solid("box", sides, flat.rotation, flat.centre)).volume() / piece.volume
        reason = f"mean thickness {thickness:.3f} of the shorter of mean chord and span, under {THIN:g}"
        full = piece.volume / of.hull().volume()
        if within < PLATE_SHARED:
            reason += f"; only {within:.0%} of the volume within its outline, under {PLATE_SHARED:.0%}"
        if full < FULL:
            reason += f"; fills only {full:.0%} of its convex hull, under {FULL:.0%}"
        clear = within >= PLATE_SHARED and full >= FULL
        return Likeness("plate", sides[:2], flat.rotation, flat.centre, clear, reason, within)
    fit, misfit = min(best, key=lambda scored: round(scored[1] / BETTER))
    shared = (of ^ form_solid(fit.form, fit.sizes, fit.rotation, piece.centre)).volume() / piece.volume
    clear = misfit <= MISFIT and shared >= SHARED
    reason = (
        "misfit " + ", ".join(f"{f.form} {value:.3f}" for f, value in best) + f"; shares {shared:.0%} of the volume"
    )
    if not clear or misfit > PLAIN:
        turned = _turned(of, piece, reason)
        if turned is not None and turned.misfit is not None and turned.misfit < (misfit / 2.0 if clear else np.inf):
            return turned
    if not clear:
        reason += f"; bounds {MISFIT:g} and {SHARED:.0%}"
    longest, next_one = sorted(fit.extents)[:0:-1]
    form = "bar" if fit.form == "box" and longest > BAR * next_one else fit.form
    if form == "bar":
        fit = Fit("box", tuple(np.sort(fit.sizes)[::-1]), relabelled_by_length(fit))
    return Likeness(form, fit.sizes, fit.rotation, piece.centre, clear, reason, shared, misfit)


def relabelled_by_length(fit: Fit) -> Array:
    """The axes of a box in the order of its sides, the longest first, right-handed, the first two ahead, starboard or up."""
    first, second = fit.rotation[:, np.argsort(-np.array(fit.sizes), kind="stable")[:2]].T
    x = about_axis(first)[:, 0]
    y = second * np.sign(second[int(np.argmax(np.abs(second) > np.abs(second).max() - 1e-6))])
    return np.column_stack([x, y, np.cross(x, y)])


def _turned(of: Solid, piece: Piece, reason: str) -> Likeness | None:
    """The body of revolution that a piece is, where it is one."""
    found = turned_form(surface(of), piece)
    if found is None:
        return None
    form, turn, centre = found
    areas = piece.projected(turn)
    own = np.array([shadow(form, axis) for axis in np.eye(3)])
    misfit = float(np.abs(own - areas).sum() / areas.sum())
    shared = (of ^ revolved(np.array(form.stations), np.array(form.radii), turn, centre)).volume() / piece.volume
    if misfit > MISFIT or shared < SHARED:
        return None
    reason = f"revolution {misfit:.3f}, shares {shared:.0%} of the volume; {reason}"
    return Likeness("revolution", (*form.stations, *form.radii), turn, centre, True, reason, min(shared, 1.0), misfit)


def _thin(of: Solid, piece: Piece, turn: Array) -> PlateFit | None:
    """The plate across the third column of ``turn``, if it is thin; of equal area, a square has the longest short side."""
    if piece.volume / float(piece.projected(turn)[2]) ** 1.5 >= THIN:
        return None
    flat = plate_fit(surface(of), turn)
    if not flat.span > 0.0:
        return None
    return flat if piece.volume / (flat.chord * flat.span * min(flat.chord, flat.span)) < THIN else None


def _least(piece: Piece, fits: list[Fit]) -> tuple[Fit, float]:
    """The fit of least misfit, the first of those that are as good."""
    scored = [(fit, fit.misfit(piece)) for fit in fits]
    return min(scored, key=lambda pair: round(pair[1] / BETTER))
