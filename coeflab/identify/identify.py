"""Coefficients identified from time series of motions, and held against those of a parameter file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import REPLICATES
from coeflab.core.machine import one_thread
from coeflab.core.options import bounded, measured, one_of, parse_options, text, words
from coeflab.core.texts import input_error, remark
from coeflab.fits.sparse import scaled_optimizer
from coeflab.identify.candidate_terms import candidate_terms
from coeflab.identify.candidates import ALONG
from coeflab.identify.force_balance import (
    BIASING,
    NOISE,
    STRETCH,
    Candidate,
    centres,
    correlated,
    differenced,
    excited,
    known,
    stretches,
    weak,
)
from coeflab.identify.identification import FEWEST_STRETCHES, Found, Products, exchangeable, identify, multiples
from coeflab.identify.identified import HOW, Balanced, Identified, IdentifiedTerm, Outcome, together_in_words
from coeflab.identify.series import ANGLES, MotionSeries, read_series
from coeflab.law.added_mass import potential_part
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, primed
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.force_law import EDGE, known_with_terms
from coeflab.vehicle.inertia import ACCELERATIONS, MEASURED, WaterInertia
from coeflab.vehicle.parameter_file import ParameterFile

citations = (
    "brunton2016", "kaptanoglu2022", "fasel2022", "messenger2021", "gurevich2019", "soderstrom1983", "fossen2011",
)  # fmt: skip
PASSES = 0.75  # half-width of a window, in times that the vehicle passes its length
ENOUGH_ROWS = 50


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the identification.

    Attributes
    ----------
    terms : tuple of str
        Candidates such as Yv, Y|v|v, Nr, Ydr, Yvdot; ``file``: those of the parameter file; none: terms of the first and
        second order over what moves.
    form : str
        ``weak``: averages over windows; ``derivative``: central differences, for clean series.
    window : float
        Half of a window, s; 0: three quarters of L/V.
    symmetric : str
        ``yes`` leaves out what a body symmetric port to starboard cannot have.
    added_mass : str
        ``known``: that of the parameter file; ``fit``: acceleration derivatives are candidates, as they are where the file
        knows none.
    optimizer : str
        ``stlsq`` or ``sr3`` of pysindy.
    resamples, seed : int
    columns : str
        Names of the columns of the series, with units, in the place of their own.
    """

    terms: tuple[str, ...] = words()
    form: str = one_of("weak", "weak", "derivative")
    window: float = measured(0.0, 0.0, 1e4, "time")
    symmetric: str = one_of("yes", "yes", "no")
    added_mass: str = one_of("known", "known", "fit")
    accelerations: str = one_of(MEASURED, *ACCELERATIONS)
    optimizer: str = one_of("stlsq", "stlsq", "sr3")
    resamples: int = bounded(200, 20, REPLICATES)
    seed: int = bounded(1, 0, 2**31)
    columns: str = text("")


@one_thread()
def identify_from(files: Sequence[Path], parameters: ParameterFile, options: dict[str, object]) -> Identified:
    """Read the series and identify.

    Parameters
    ----------
    files : sequence of Path
        Time series, see `coeflab.identify.series.read_series`.
    parameters : ParameterFile
        Mass, inertia, thrusters, scaling, and the coefficients to compare with.
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        A file or an option that cannot be used, or series too short or too coarse for the window.
    """
    o = parse_options(Options, options, "identify")
    reader = vehicle(parameters, free=("u",), accelerations=o.accelerations)
    series = [read_series(f, reader, o.columns) for f in files]
    moving = frozenset().union(*(s.moving for s in series))
    body = vehicle(parameters, free=[m for m in MOTIONS if m in moving], accelerations=o.accelerations)
    _attitude_known(series, files, body, moving)
    half = o.window or _half(series, body)
    _long_enough(series, files, half)
    return _identified(series, parameters, body, moving, half, o)


def _long_enough(series: Sequence[MotionSeries], files: Sequence[Path], half: float) -> None:
    """Raise where there are too few windows to draw stretches of time from."""
    count = sum(len(np.unique(stretches(centres(s, half), half))) for s in series)
    if count < FEWEST_STRETCHES:
        raise input_error(
            "identify.stretches_rows_enough", files[0], column="identify.window", count=count, stretch=STRETCH * half,
            fewest_stretches=FEWEST_STRETCHES,
        )  # fmt: skip


def _attitude_known(
    series: Sequence[MotionSeries], files: Sequence[Path], body: Vehicle, moving: frozenset[str]
) -> None:
    lever = body.mass * body.centre * body.hydrostatics.gravity - body.buoyancy * np.array(
        body.hydrostatics.centre_of_buoyancy
    )
    heavy = abs(body.weight - body.buoyancy) + np.abs(lever).sum() > 1e-9 * body.weight
    if not (heavy and moving & {"w", "p", "q"}):
        return
    for s, file in zip(series, files, strict=True):
        lacking = [a for a in ANGLES if a not in s.given]
        if lacking:
            raise input_error("identify.roll_pitch_weight", file, 1, lacking[0], lacking=" or ".join(lacking))


def _half(series: Sequence[MotionSeries], body: Vehicle) -> float:
    """Half of a window: as long as the vehicle takes for a part of its length, and not below what the rows carry."""
    speed = float(np.median(np.concatenate([np.linalg.norm(s.velocity[:, :3], axis=1) for s in series])))
    step = max(float(np.median(np.diff(s.time))) for s in series)
    return max(PASSES * body.length / max(speed, 1e-3 * body.speed), 12.0 * step)


def _identified(
    series: Sequence[MotionSeries], parameters: ParameterFile, body: Vehicle, moving: frozenset[str], half: float,
    o: Options,
) -> Identified:  # fmt: skip
    share = excited(series, half)
    shared = tuple(dict.fromkeys(m for s in series for m in correlated(s, half)))
    biased = any(correlated(s, half, BIASING) for s in series)
    fit_added = o.added_mass == "fit" or not np.any(body.added)
    library = candidate_terms(
        parameters, moving, o.terms, symmetric=o.symmetric == "yes", accelerations=fit_added,
        driven=frozenset(c for k, c in enumerate(COMPONENTS) if any(np.any(known(s, body)[:, k] != 0.0) for s in series)),
    )  # fmt: skip
    law, found = known_with_terms(parameters, [(t.symbol, t.component, t.term) for t in library if not t.rate])
    body = replace(body, law=law)
    terms: list[IdentifiedTerm] = []
    balances = []
    late: list[str] = []
    form = weak if o.form == "weak" else differenced
    for c in COMPONENTS:
        mine = [t for t in library if t.component == c]
        if not mine:
            continue
        balance = form(series, body, c, mine, half)
        some, balanced = _component(c, mine, balance, share, parameters, body.water, o)
        if not shared:  # else no interval stands
            late += _late(some, mine, balance, form([_held(s) for s in series], body, c, mine, half))
        terms += [_of_shared_noise(t, biased) for t in some] if shared else some
        balances.append(balanced)
    return Identified(
        parameters.name, tuple(s.file for s in series), f"{o.form} form", half, o.seed, o.resamples, tuple(terms),
        tuple(balances), (*map(remark, found), *_shared(shared, series), *_statements(series, body, moving, share, library, half, o, biased)),
        (*(f for f in found if f.code != EDGE), *(f for s in series for f in s.findings),
         *([Finding.of("record.held", parameters.name, Severity.WARN, each=late)] if late else []), *_opposite(terms, library, parameters.name)),
    )  # fmt: skip


def _opposite(terms: Sequence[IdentifiedTerm], library: Sequence[Candidate], name: str) -> list[Finding]:
    """Controls of which every term, odd in them, has the other sign than in the file."""
    out = []
    of = {primed(t.symbol): t.term for t in library if not t.rate}
    for control in CONTROLS:
        both = [t for t in terms if t.value and t.file_value and t.symbol in of and of[t.symbol].odd_in(control)]
        if both and all(t.value * t.file_value < 0.0 for t in both if t.value and t.file_value):
            out.append(
                Finding.of("record.opposite", name, Severity.WARN, columns=[t.symbol for t in both], control=control)
            )
    return out


def _held(s: MotionSeries) -> MotionSeries:
    """With controls that keep their value from row to row, which is half a row later."""
    return replace(s, controls=(s.controls + np.vstack([s.controls[:1], s.controls[:-1]])) / 2.0)


def _late(terms: Sequence[IdentifiedTerm], mine: Sequence[Candidate], balance: Products, held: Products) -> list[str]:
    """Coefficients that held controls move beyond their intervals, with the change."""
    at = [j for j, t in enumerate(terms) if t.value is not None]
    moved = (held.solved(at) - balance.solved(at)) / [mine[j].per_prime for j in at]
    return [
        f"{t.symbol} {by / t.value:+.0%}"
        for t, by in zip([terms[j] for j in at], moved, strict=True)
        if t.value and t.half is not None and abs(by) > t.half
    ]


def _shared(motions: Sequence[str], series: Sequence[MotionSeries]) -> tuple[str, ...]:
    """Why there are no intervals, where neighbouring rows share their noise, and what would give some."""
    if not motions:
        return ()
    derived = {m for s in series for f in s.findings if f.code == "record.derived" for m in f["columns"]} & {*motions}
    advice = (
        f"{', '.join(m for m in motions if m in derived)} follow of x, y and psi, so there are no unfiltered rows of them: give recorded ones, of a speed log or a rate gyro."
        if derived
        else "Use unfiltered rows, or thin them."
    )
    return (
        f"No intervals: neighbouring rows share the noise of {', '.join(motions)}, as a filter leaves it. Even and odd rows are "
        f"then no instruments for each other, and the values are biased. {advice}",
    )


def _component(
    component: str, mine: Sequence[Candidate], balance: Products, share: dict[str, float], parameters: ParameterFile,
    water: WaterInertia, o: Options,
) -> tuple[list[IdentifiedTerm], Balanced]:  # fmt: skip
    """Terms of one component."""
    why = _unusable(mine, balance, share)
    usable = [j for j in range(len(mine)) if j not in why]
    found, others = None, {}
    if usable:
        sub = balance.of(usable)
        found = identify(sub, scaled_optimizer(o.optimizer), seed=o.seed, resamples=o.resamples)
        others = exchangeable(sub, found.retained)
    out = []
    for j, candidate in enumerate(mine):
        file = _in_file(candidate, parameters, water)
        if j in why or found is None:
            out.append(_term(candidate, Outcome.NOT_IDENTIFIABLE, why[j], file))
            continue
        out.append(_result(candidate, usable.index(j), found, others, [mine[k] for k in usable], file))
    return out, Balanced(
        component, found.threshold if found else None, found.left if found else None,
        len(balance.total),
    )  # fmt: skip


def _unusable(mine: Sequence[Candidate], balance: Products, share: dict[str, float]) -> dict[int, str]:
    """Why a candidate cannot be identified, for those that cannot."""
    out: dict[int, str] = {}
    gram = balance.gram.sum(axis=0)
    power = np.diag(gram)
    for j, t in enumerate(mine):
        still = sorted(m for m in t.needs if share[m] < NOISE)
        if still:
            out[j] = f"{', '.join(still)} {'does' if len(still) == 1 else 'do'} not move beyond noise"
        elif not power[j] > 0.0:
            out[j] = "not excited beyond noise"
    left = [j for j in range(len(mine)) if j not in out]
    if left:
        for j, first in multiples(gram[np.ix_(left, left)]).items():
            out[left[j]] = f"a multiple of {mine[left[first]].symbol}' in these series"
    return out


File = tuple[float | None, float | None, str]


def _in_file(candidate: Candidate, parameters: ParameterFile, water: WaterInertia) -> File:
    """Value and U95 that the file has, or what its added mass gives to a product of velocities."""
    c = parameters.coefficient(candidate.symbol)
    if c is not None and c.value is not None:
        return c.value, c.u95, c.origin
    if parameters.added_mass is not None and not candidate.rate:
        ideal = potential_part(
            candidate.symbol, water.as_noun(parameters), parameters.scaling, parameters.conditions.density
        )
        if ideal:
            return ideal, None, "ideal fluid"
    return None, None, ""


def _term(candidate: Candidate, outcome: Outcome, why: str, file: File, **more: float | None) -> IdentifiedTerm:
    return IdentifiedTerm(
        primed(candidate.symbol), candidate.component, outcome, why, file_value=file[0], file_u95=file[1],
        file_source=file[2], **more,
    )  # fmt: skip


def _result(
    candidate: Candidate,
    at: int,
    found: Found,
    others: dict[int, tuple[int, ...]],
    usable: Sequence[Candidate],
    file: File,
) -> IdentifiedTerm:
    frequency = float(found.frequency[at])
    if at not in found.retained:
        return _term(candidate, Outcome.NOT_NEEDED, "", file, frequency=frequency)
    scale = 1.0 / candidate.per_prime
    value, low, high = (float(a[at]) * scale for a in (found.coefficients, found.low, found.high))
    swaps = [primed(usable[k].symbol) for k in others[at]]
    known = bool(np.isfinite(low)) and not swaps
    outcome = Outcome.EXCHANGEABLE if swaps else Outcome.IDENTIFIED
    return _term(
        candidate, outcome, together_in_words(swaps) if swaps else "", file, value=value, frequency=frequency,
        low=low if known else None, high=high if known else None,
    )  # fmt: skip


def _of_shared_noise(term: IdentifiedTerm, biased: bool) -> IdentifiedTerm:
    """Without an interval where neighbouring rows share their noise, and not as identified where it is large."""
    outcome = Outcome.BIASED if biased and term.outcome is Outcome.IDENTIFIED else term.outcome
    return replace(term, outcome=outcome, low=None, high=None)


def _statements(
    series: Sequence[MotionSeries],
    body: Vehicle,
    moving: frozenset[str],
    share: dict[str, float],
    library: Sequence[Candidate],
    half: float,
    o: Options,
    biased: bool,
) -> tuple[str, ...]:
    """What was assumed, and what the series cannot show."""
    out = [*body.water.statements] if biased else [HOW, *body.water.statements]
    if o.form == "weak" and not biased:
        out.append("Even and odd rows serve each other as instruments, which removes the bias of white noise.")
    elif o.form != "weak":
        out.append("Central differences and plain least squares: noise biases the coefficients. Prefer the weak form.")
    coarse = {s.file: 2.0 * half / float(np.median(np.diff(s.time))) for s in series}
    for name, rows in coarse.items():
        if rows < ENOUGH_ROWS:
            out.append(
                f"{name}: {rows:.0f} rows a window. Below {ENOUGH_ROWS} the corners of controls and motions between rows are "
                "cut, which moves coefficients by some per cent that no interval shows."
            )
    still = [m for m in MOTIONS if m not in moving]
    if still:
        gone = [c for c in COMPONENTS if ALONG[c] in still]
        out.append(
            f"{', '.join(still)} do not move: nothing of {', '.join(gone)} can be identified, nor any term in them."
        )
    noisy = [m for m in (*MOTIONS, *CONTROLS) if m in moving and share[m] < NOISE]
    if noisy:
        out.append(f"{', '.join(noisy)}: noise alone, so that no term in them can be identified.")
    pushed = [s.file for s in series if not np.any(s.wrench)]
    if pushed:
        out.append(f"{', '.join(pushed)}: no thrust in it, or none given; if there was some, X is wrong by it.")
    out.append(f"The rigid body is known; {body.statements[-1]}.")
    fitted = sorted({t.component for t in library if t.rate})
    if fitted:
        out.append(f"{', '.join(fitted)}: acceleration derivatives are candidates, beside the rigid body alone.")
    unknown = sorted({t.component for t in library} - set(fitted))
    if unknown and not np.any(body.added):
        out.append(
            f"{', '.join(unknown)}: the added mass is not known and counts as zero, and no known force sets the scale; every value depends on that."
        )
    return tuple(out)
