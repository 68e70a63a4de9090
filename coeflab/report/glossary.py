"""The terms of reports and of docs/glossary.md: one place defines them, and a page links to them.

`linked_html` links the first mention of a term, `definitions_html` is the list that it leads to, `markdown` is docs/glossary.md.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from html import escape

from coeflab.core.provenance import work
from coeflab.report.notation import html, html_with


@dataclass(frozen=True, slots=True)
class Term:
    """A term and what it means.

    Attributes
    ----------
    name : str
    meaning : str
        One to three sentences, plain text.
    sources : tuple of str
        Keys of works of `coeflab.core.provenance`; empty for a word of coeflab alone.
    spellings : tuple of str
        How texts write it besides its name. One with a capital is found as it stands, others also at the start of a sentence.
    page : str
        Of docs/, where there is more; empty without one.
    by_name : bool
        Whether the name alone is a mention; not for a word of everyday English such as "form".
    """

    name: str
    meaning: str
    sources: tuple[str, ...] = ()
    spellings: tuple[str, ...] = ()
    page: str = ""
    by_name: bool = True

    @property
    def anchor(self) -> str:
        """Its id in a page: ``term-u95``."""
        return "term-" + re.sub(r"[^a-z0-9]+", "-", self.name.lower()).strip("-")


# fmt: off
TERMS: tuple[Term, ...] = (
    # Axes, symbols, lengths
    Term("FRD", "Body axes used throughout: x forward, y to starboard (right), z down, right-handed. X, Y, Z, K, M, N are what the "
         "fluid exerts on the body.", ("sname1950", "gertler1967")),
    Term("FLU", "Body axes of ROS and Gazebo: x forward, y to port (left), z up. From FRD, Y, Z, M, N, v, w, q and r change sign."),
    Term("NED", "Earth axes: x north, y east, z down.", ("fossen2011",)),
    Term("prime", "Nondimensional, written with a prime: Y' = Y / (1/2 rho U^2 L^2), N' = N / (1/2 rho U^2 L^3), v' = v/U, "
         "r' = r L/U. The length L is stated, since LBP and LOA give different values.", ("sname1950",), ("primed", "primes")),
    Term("LBP", "Length between perpendiculars, 4.26086 m for SUBOFF: Roddy's length for primes.", ("roddy1990",)),
    Term("LOA", "Overall length, 4.356 m for SUBOFF. With LBP or LOA as length, static force derivatives of SUBOFF differ by 4.5 %, moments by "
         "6.9 %.", ("groves1989",)),
    Term("sideslip angle", "beta = asin(v/U), positive when the body moves to starboard. Roddy's drift angle has the other sign; "
         "each table declares its own.", ("sname1950",), ("sideslip", "drift angle", "angle of drift")),
    Term("angle of attack", "alpha = atan2(w, u), positive when the body moves down.", ("sname1950",)),
    Term("reference point", "The point that moments and velocities refer to. Coefficients about different points are moved to one "
         "before they are compared.", ("feldman1979",)),
    Term("static derivative", "Slope of a force or moment over v or w at zero angle: Yv', Nv', Zw', Mw'.", ("gertler1967",),
         ("static derivatives",)),
    Term("rotary derivative", "Slope of a force or moment over a rate of turn at zero rate: Yr', Nr', Zq', Mq'. It needs a rotating "
         "arm or an oscillating model.", ("gertler1967",), ("rotary derivatives",), "rotating_arm.md"),
    Term("Yv'", "Side force by sideslip: slope of Y' over v' = v/U at zero drift. Negative: the hull resists going sideways. Zw' is its like "
         "in the vertical plane, heave force by w' = w/U.", ("gertler1967",), (), "axes_and_signs.md", False),
    Term("Nv'", "Yaw moment by sideslip, about the reference point: slope of N' over v' at zero drift. Negative: it turns the bow further "
         "away from the flow (Munk moment); fins aft make it less so. Mw' is its like in pitch, with the other sign: positive turns "
         "the bow further up.", ("gertler1967",), (), "axes_and_signs.md", False),
    Term("Yr'", "Side force by yaw rate: slope of Y' over r' = r L/U. Zq' is its like by pitch rate. With m' it decides whether the straight "
         "course is stable.", ("gertler1967",), (), "rotating_arm.md", False),
    Term("Nr'", "Yaw damping: slope of N' over r' = r L/U. Negative: the water resists turning. Mq' is its like in pitch.",
         ("gertler1967",), (), "rotating_arm.md", False),
    Term("X0'", "Resistance straight ahead: X / (1/2 rho U^2 L^2) at zero angle and rate. Negative: drag. It changes slowly with the Reynolds "
         "number.", ("gertler1967",), (), "slope_at_origin.md", False),
    Term("even part", "The part of a curve that keeps its sign when the angle changes sign; the rest is the odd part. Port-starboard "
         "symmetry makes Y, K, N odd and X, Z, M even in v.", (), ("odd part", "even and odd parts")),
    # Tests
    Term("rotating arm", "Test rig that tows a model on a circle: v and r are steady together.", ("ittc_captive",), ("rotating-arm",),
         "rotating_arm.md"),
    Term("PMM", "Planar motion mechanism: it oscillates a towed model and gives damping and acceleration derivatives.",
         ("gertler1959",), ("planar motion mechanism",), "planar_motion.md"),
    Term("RANS", "Reynolds-averaged Navier-Stokes: CFD that models turbulence instead of resolving it.", ("oberkampf2010",)),
    Term("plateau", "The end of an iterative run, where every force has neither trend nor drift beyond its own scatter. A run "
         "without one is unconverged and does not enter a fit.", ("white1997", "geyer1992"), (), "data_in_runs.md"),
    Term("cross-body", "Compared with another body or another kind of test: shown without a verdict.", (), (), "validation.md"),
    Term("re-analysis", "The same measurements, evaluated by their authors and by coeflab. It tests the evaluation, not the measurements.", (),
         ("re-analysed",), "validation.md"),
    Term("SUBOFF", "Submarine model of DARPA (DTRC Model 5470) with equations for its shape and published captive tests.",
         ("groves1989", "roddy1990")),
    Term("AFF-8", "SUBOFF with sail and four stern planes. Roddy's configurations 1 and 2 also carry a ring wing.", ("groves1989",)),
    # Fits and intervals
    Term("U95", "Half-width of the 95 % interval: the true value lies in value +- U95 with about 95 % probability, if the parts "
         "that were not assessed are small. The uncertainty budget lists what is in it and what was not assessed.", ("jcgm100",), (), "slope_at_origin.md"),
    Term("slope at the origin", "The recommended derivative: the weighted median of many fits to the whole sweep, each a line plus v|v|, "
         "cubic and smooth parts; no window and no form is chosen.", ("wahba1990",), ("slopes at the origin", "slope_at_origin"), "slope_at_origin.md"),
    Term("scatter", "Random error of single readings about the curve: the random part of U95.", (), ("random part",)),
    Term("form", "The terms that a fitted curve may have, such as a line or a + s v + q v|v|. The form part of U95 is the error from not "
         "knowing them.", (), ("form part", "model form", "single forms"), "fixed_forms.md", False),
    Term("form rejected", "The residuals show that the form is wrong: the value has no U95. Add the missing term or fit a "
         "narrower range.", (), ("form_rejected",), "fixed_forms.md"),
    Term("sign open", "There is a number, but U95 exceeds it: the 95 % interval contains zero. It is not to be used alone.", (),
         ("sign_open",)),
    Term("tied law", "The force law that a simulator gets: it follows the measured points over their whole range, and its slopes at "
         "zero are the recommended ones.", (), ("tied_law",), "law_and_points.md"),
    Term("range of the data", "The convex hull of the measured conditions. A law is stated to hold inside; outside it is "
         "extrapolated.", (), ("covered range",), "law_and_points.md"),
    Term("HC2", "Standard errors that hold when the scatter differs from point to point, corrected for leverage. HC3 is the more "
         "cautious variant.", ("mackinnon1985",), ("HC3",)),
    Term("leverage", "How strongly a point pulls the fitted curve towards itself, from 0 to 1.", ("mackinnon1985",)),
    Term("degrees of freedom", "Number of points that are left to judge the scatter after the coefficients are fitted. Few make the "
         "interval wide.", ("bell2002", "imbens2016")),
    Term("Wald test", "Tests whether an equation between coefficients, such as Zw = Yv, agrees with their joint uncertainty.",
         ("tipton2015",)),
    Term("R2", "Share of the variance of the points that a fit explains. It does not judge a slope: a good R2 with a wrong form still "
         "gives a wrong derivative."),
    Term("information criterion", "AICc, BIC and PRESS compare forms by fit and number of terms; lower is better. They choose no "
         "recommended value here.", ("hurvich1989", "schwarz1978", "allen1974"), ("AICc", "BIC", "PRESS")),
    Term("data gate", "Compares every measured cell with what the other rows predict, and warns about a cell that does not fit.", (), (),
         "data_gate.md"),
    Term("inclusion frequency", "How often a term is selected when the data are resampled.", ("fasel2022",),
         ("inclusion frequencies",)),
    Term("Sobol index", "Share of a result's variance that comes from one coefficient.", (), ("Sobol indices", "Sobol")),
    Term("Monte Carlo error", "Uncertainty of an interval because a finite number of samples was drawn.", ("jcgm100",)),
    # Verification and validation
    Term("GCI", "Grid convergence index: the 95 % half-width for the grid, from at least three grids.", ("celik2008", "roache1998"),
         ("grid convergence index",), "validation.md"),
    Term("grid study", "The same condition computed on three or more grids.", ("celik2008", "eca2014"), ("grid studies",),
         "validation.md"),
    Term("iteration noise", "Fluctuation of a force that remains when a steady computation has converged.", ("eca2014",)),
    Term("U_V", "Validation uncertainty: U_V^2 = U_D^2 + U_SN^2 + U_input^2 + U_red^2. U_D: test. U_SN: grid, domain and "
         "iterations. U_input: inputs of the computation. U_red: fit of a slope to computed points, coeflab's addition to ASME "
         "V&V 20.", ("asme_vv20",), (), "validation.md"),
    Term("U_SN", "Numerical uncertainty of the computation: grid, domain, iterations.", ("asme_vv20",), ("U_red",), "validation.md"),
    Term("E = S - D", "Comparison error: computation S minus test D. Where |E| < U_V no modelling error can be shown.", ("asme_vv20",), (),
         "validation.md"),
    Term("basis", "Where the number comes from that ours is compared with. Predicted: published, and not used to make our model. Printed and "
         "recomputed: published, and computed here from other published numbers. Revised: our methods were revised after a comparison with "
         "it. Calibration: our model was fitted to it. Consistency: computed here in a second way, or by theory. Only the first two are "
         "validation.", (), ("printed and recomputed",), "validation.md", False),
    # Potential flow
    Term("added mass", "Inertia of the water that an accelerated body moves: the 6x6 matrix M_A, symmetric. Acceleration derivatives "
         "are its negatives: Xudot = -m_x, Yvdot = -m_y.", ("newman1977", "fossen2011"), ("added-mass matrix",)),
    Term("acceleration derivative", "Force or moment over an acceleration, such as Yvdot'.", ("gertler1967",),
         ("acceleration derivatives",)),
    Term("Munk moment", "Moment of an ideal fluid on a body at an angle, (m_x - m_y) u v in yaw: it turns the body "
         "broadside. Measured Nv' and Mw' contain it.", ("newman1977", "fossen2011")),
    Term("C_A(nu)", "Coriolis and centripetal matrix of the added mass. A simulator that adds it must get the viscous part of each "
         "derivative only.", ("fossen2011",), ("C_A",), "parameter_file.md"),
    Term("viscous part", "A measured derivative minus its potential part, which is a term of -C_A(nu) nu.", ("fossen2011",),
         ("potential part", "potential parts"), "parameter_file.md"),
    Term("panel method", "Potential flow about the real surface by boundary elements, extrapolated over meshes.", ("hess1967",),
         ("panels",)),
    Term("strip theory", "Added mass as the sum of two-dimensional sections along the body.", ("newman1977", "bryson1954"), ("strips",)),
    Term("spheroid", "Ellipsoid of revolution; its added mass is known exactly, by Lamb's k1, k2 and k'.", ("lamb1918", "lamb1932"),
         ("spheroids",)),
    Term("Myring hull", "Torpedo shape with nose, cylinder and tail given by equations.", ("myring1976",)),
    # Stability and manoeuvres
    Term("G_h", "Directional stability index in the horizontal plane, 1 - Nv' (Yr' - m') / [Yv' (Nr' - xG' m')]. Positive: stable with "
         "controls fixed.", ("roddy1990",)),
    Term("G_v", "Directional stability index in the vertical plane at high speed, 1 - Mw' (Zq' + m') / [Zw' (Mq' - xG' m')]. Positive: "
         "stable with controls fixed.", ("roddy1990", "feldman1979")),
    Term("BG", "Height of the centre of buoyancy above the centre of gravity: it gives the restoring moment in roll and pitch.",
         ("gertler1967",)),
    Term("zigzag", "The rudder is put over to one side until the heading has changed by a set angle, then to the other. 20/20 means "
         "20 deg of rudder at 20 deg of heading.", ("imo_msc137", "ittc_free_running"), ("zigzags",)),
    Term("execute", "The moment when the helm of a zigzag is ordered over.", ("imo_msc137",), ("second execute", "third execute"), "", False),
    Term("overshoot", "How far the heading still changes in a zigzag after the rudder is reversed.", ("imo_msc137",),
         ("overshoots", "overshoot angle")),
    Term("advance", "Distance along the first course until the heading has changed by 90 deg.", ("imo_msc137",),
         (), "", False),
    Term("tactical diameter", "Distance across the first course until the heading has changed by 180 deg.", ("imo_msc137",)),
    Term("spiral", "Steady yaw rate over rudder angle, up and down again. A loop shows directional instability.",
         ("ittc_free_running",)),
    Term("pull-out", "The rudder is put back to zero in a steady turn. A yaw rate that remains shows directional instability.",
         ("ittc_free_running",)),
    Term("free decay", "Roll or pitch released from an angle: period and damping.", ("ittc_roll_decay",)),
    Term("trim", "The speeds, attitude and commands of a steady motion.", (), ("trimmed",), "", False),
    Term("extrapolated", "The motion leaves the range of the data: the result has a value, but no test supports it."),
    Term("no value", "There is no number. The reason stands beside it or below the table, such as no data: no table varies the motion. "
         "Files and JSON call it no_table, too_few_points or not_determined."),
    # Files
    Term("parameter file", "NAME.parameters.json: coefficients with covariance, range, sources, mass, added mass. Every simulator file is "
         "written from it.", (), ("parameter files",), "parameter_file.md"),
    Term("loss", "What a simulator's own force law cannot express. It is measured over the range of the data and needs --accept-loss.",
         (), ("losses",), "parameter_file.md", False),
    Term("synthetic", "Computed from stated coefficients plus noise, to show or test a method: neither measured nor CFD."),
)
# fmt: on


def linked_html(text: str, seen: set[str], *, listed: bool = True) -> str:
    """A sentence as HTML with its symbols, as `notation.html`, and the first mention of every term linked to its definition.

    Parameters
    ----------
    text : str
    seen : set of str
        Anchors of the terms that are linked already, in this page or section; those linked here are added.
    listed : bool
        Whether the page ends with the definitions; else a term only shows its own.

    Returns
    -------
    str
        Links are ``<a class="term" href="#term-u95" title="...">U95</a>``. In texts of users nothing is linked.
    """
    found = []

    def marks(plain: str) -> Iterator[tuple[int, int, str, str]]:
        for start, end, term in mentions(plain):
            if term.anchor not in seen and term.anchor not in found:
                found.append(term.anchor)
                title = escape(term.meaning, quote=True)
                if listed:
                    yield start, end, f'<a class="term" href="#{term.anchor}" title="{title}">', "</a>"
                else:
                    yield start, end, f'<abbr class="term" tabindex="0" title="{title}">', "</abbr>"

    out = html_with(text, marks)
    seen.update(anchor for anchor in found if not listed or f'href="#{anchor}"' in out)
    return out


def definitions_html(anchors: Collection[str]) -> str:
    """The definitions of terms as one ``<dl class="terms">``, in the alphabet's order; docs/glossary.md has their sources.

    Parameters
    ----------
    anchors : collection of str
        As `linked_html` collects them.
    """
    rows = []
    for term in alphabetical():
        if term.anchor in anchors:
            rows.append(f'<dt id="{term.anchor}">{html(term.name)}</dt>\n<dd>{html(term.meaning)}</dd>')
    return '<dl class="terms">\n' + "\n".join(rows) + "\n</dl>" if rows else ""


def mentions(text: str) -> Iterator[tuple[int, int, Term]]:
    """Every mention of a term in a text: where it begins and ends, and which."""
    pattern, terms = _spelled()
    for found in pattern.finditer(text):
        yield found.start(), found.end(), terms[found[0]] if found[0] in terms else terms[_lowered(found[0])]


def alphabetical() -> tuple[Term, ...]:
    """The terms as a glossary lists them."""
    return tuple(sorted(TERMS, key=lambda t: (t.name.lower(), t.name)))


HEAD = """# Glossary

Terms of coeflab's reports and files, each with its source. The HTML report links the first mention of a term to this text.
Generated from `coeflab/report/glossary.py`, checked by `tests/report/test_glossary.py`.

"""


def markdown() -> str:
    """docs/glossary.md."""
    rows = []
    for term in alphabetical():
        more = f" [{term.page}]({term.page})" if term.page else ""
        sources = f" *{' '.join(work(key) for key in term.sources)}*" if term.sources else ""
        rows.append(f'<a id="{term.anchor}"></a>**{_escaped(term.name)}**: {_escaped(term.meaning)}{more}{sources}\n')
    return HEAD + "\n".join(rows)


def _escaped(text: str) -> str:
    return re.sub(r"([|*_\[\]<])", r"\\\1", text)


def _lowered(text: str) -> str:
    return text[:1].lower() + text[1:]


@cache
def _spelled() -> tuple[re.Pattern[str], dict[str, Term]]:
    terms = {word: term for term in TERMS for word in (*(term.name,) * term.by_name, *term.spellings)}
    words = []
    for word in sorted(terms, key=len, reverse=True):
        first, rest = re.escape(word[0]), re.escape(word[1:])
        words.append(f"[{word[0].upper()}{word[0]}]{rest}" if word == word.lower() else first + rest)
    return re.compile(rf"(?<![\w'./|-])(?:{'|'.join(words)})(?![\w'|-])(?!\.\w)"), terms
