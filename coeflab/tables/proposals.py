"""What the columns of an unknown file probably are, by their names; and what their numbers show of axes and signs.

Proposals are confirmed by a person, evidence is shown to one: nothing here decides.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.axes import Axes
from coeflab.core.errors import InputError, UnitsError
from coeflab.core.types import Array
from coeflab.core.units import factor
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROL_COLUMNS, LINEAR, MOMENTS
from coeflab.tables.column_map import (
    ACROSS,
    EXAMPLES,
    FORCES,
    ROLES,
    WIND,
    WIND_NAMES,
    WORDS,
    ColumnMap,
    folded,
    read_column_map,
    share,
    unturned,
)
from coeflab.tables.mapping import Assigned
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.words_above import BODY_AXES

OPEN = "?"
UNKNOWN = "no known name"
OWN = frozenset((*ROLES, *CONTROL_COLUMNS)) - {"label", "ignore", *WIND}  # names that coeflab's own tables have
ALLOWED = {
    "speed": "U, u, v, w", "rate": "p, q, r", "angle": "alpha, beta, dr, ds, db", "force": "X, Y, Z", "moment": "K, M, N",
    "length": "R", "density": "density",
}  # fmt: skip
TURN = "counts about the z axis of the frame: z down, r > 0 turns to starboard; z up (CFD, FLU), to port"
TURNS = {("p", True): "heels to starboard", ("p", False): "heels to port", ("q", True): "lifts the bow",
         ("q", False): "lowers the bow", ("r", True): "turns the bow to starboard", ("r", False): "turns the bow to port"}  # fmt: skip
OF_RATE = {"p": ("", "K"), "q": ("Z", "M"), "r": ("Y", "N")}  # force and moment that a rate moves first
STILL = 0.1  # of the span of Y or N: a span of Z or M that is none
CLEAR = 0.8  # correlation beyond which a slope has a sign
_SAID = {
    "X": "fx forcex xforce surgeforce longitudinalforce axialforce laengskraft langskraft kraftlangs kraftlaengs kraftx xkraft widerstandskraft forcelongitudinale effortlongitudinal fxtotal",
    "Y": "fy forcey yforce swayforce sideforce lateralforce transverseforce querkraft seitenkraft kraftquer "
    "krafty ykraft forcelaterale forcetransversale efforttransversal effortlateral fytotal",
    "Z": "fz forcez zforce heaveforce verticalforce normalforce vertikalkraft hubkraft kraftvertikal krafthoch kraftz zkraft "
    "forceverticale effortvertical fztotal",
    "K": "mx momentx xmoment rollmoment rollingmoment krangungsmoment kraengungsmoment momentumlangsachse momentumlaengsachse "
    "momentderoulis momentroulis",
    "M": "my momenty ymoment pitchmoment pitchingmoment trimmoment nickmoment stampfmoment momentumquerachse "
    "momentdetangage momenttangage",
    "N": "mz momentz zmoment yawmoment yawmom yawingmoment giermoment momentumhochachse "
    "momentumvertikalachse momentdelacet momentlacet",
    "alpha": "alpha α aoa angleofattack attack attackangle pitchangle incidence anstellwinkel trimmwinkel nickwinkel "
    "angledattaque angledincidence",
    "beta": "beta β drift driftangle sideslip sideslipangle yawangle driftwinkel schiebewinkel gierwinkel schraglage abdrift "
    "derive angledederive angledelacet",
    "U": "speed velocity towingspeed carriagespeed towspeed freestreamvelocity uinf vinf umag vmag vitesse "
    "geschwindigkeit geschw schleppgeschwindigkeit vmodell modellgeschwindigkeit vitessechariot vitessederemorquage",
    "u": "surgevelocity surgespeed longitudinalvelocity",
    "v": "swayvelocity swayspeed lateralvelocity transversevelocity",
    "w": "heavevelocity heavespeed verticalvelocity",
    "p": "rollrate omegax rollgeschwindigkeit",
    "q": "pitchrate omegay nickgeschwindigkeit",
    "r": "yawrate omegaz turnrate turningrate giergeschwindigkeit gierrate drehrate drehgeschwindigkeit "
    "vitessedelacet tauxdelacet",
    "R": "radius turningradius armradius radiusofturn armlength drehkreisradius bahnradius rayon rayondegiration",
    "density": "rho density waterdensity dichte wasserdichte densite massevolumique",
    "dr": "rudder rudderangle deltar ruder ruderwinkel seitenruder ruderlage barre angledebarre",
    "ds": "sternplane sternplaneangle elevator elevatorangle deltas hoehenruder hohenruder tiefenruder",
    "db": "bowplane bowplaneangle deltab",
    "cells": "cells ncells cellcount meshcells numberofcells elements gridcells zellen",
    "point": "run runno runnumber runid case caseno casename test testno testid point pointno id no nr number "
    "versuch versuchsnr versnr messung messpunkt fahrt fall lauf lfd lfdnr essai numero",
    "ignore": "comment comments remark remarks note notes bemerkung bemerkungen kommentar commentaire remarque remarques date datum time zeit heure uhrzeit "
    "iteration iterations residual residuals",
}
NAMES = {word: name for name, words in _SAID.items() for word in words.split()}
SYMBOLS = {"alpha": ("α",), "beta": ("β",), "U": ("V", "Vm", "VM", "v0", "V0"), "density": ("ρ",), "dr": ("δ", "δr")}
COEFFICIENTS = {
    **{f"c{c.casefold()}": c for c in COMPONENTS},
    **dict(zip(("cmx", "cmy", "cmz"), MOMENTS, strict=True)),
    **dict(zip(("cfx", "cfy", "cfz"), COMPONENTS, strict=False)),
    **dict(zip(("cmroll", "cmpitch", "cmyaw"), MOMENTS, strict=True)),
    **dict.fromkeys(("cd", "cdrag"), "drag"), **dict.fromkeys(("cl", "clift"), "lift"), "cc": "side",
    "croll": "K", "cpitch": "M", "cyaw": "N", "cside": "Y", "cs": "Y",
}  # fmt: skip
TURNED = "{} the flow, turned to body axes by the alpha and beta of each row"
UNITS = {"grad": "deg", "grd": "deg", "deg.": "deg", "sec": "s", "degree": "deg", "degrees": "deg", "°": "deg", "1/s": "rad/s", "s^-1": "rad/s", "n.m": "N*m",
         "n-m": "N*m", "knots": "kn", "kts": "kn", "newton": "N", "newtons": "N", "°/s": "deg/s"}  # fmt: skip
_THOUSAND = re.compile(r"([XYZKMN])['\u2032\u2019]?[\s_]*[x*×·]?[\s_]*(?:1000|1e3|10\^3)")
_MONITOR = re.compile(r"(?i)\b(?:monitor|report|plot)\b(?:\s*\d+)?")
_ERROR = re.compile(r"^(?:se|stderr|standarderror(?:of)?)(?=.)|(?<=.)(?:se|stderr|standarderror)$")


@dataclass(frozen=True, slots=True)
class Proposal:
    """What a column may be.

    Attributes
    ----------
    text : str
        As ``--map`` takes it, with ? for what has to be said; empty where nothing is known.
    why : str
        What it rests on.
    certain : bool
        The format itself fixes it, or the file uses coeflab's own names and a unit.
    note : str
        What a person should read beside it.
    """

    text: str
    why: str
    certain: bool = False
    note: str = ""

    @property
    def whole(self) -> bool:
        """Whether nothing has to be added."""
        return bool(self.text) and OPEN not in self.text


def proposed(column: RawColumn, stated: Mapping[str, object] | None = None) -> Proposal:
    """What a column may be, by what its format fixes, else by its name and unit.

    Parameters
    ----------
    column : RawColumn
    stated : mapping, optional
        What the file says of itself; ``coefficients.area`` and ``coefficients.length`` complete a coefficient.
    """
    name, why, certain = _name(column)
    if not name and column.unit in ("", "-", "1") and (m := _THOUSAND.fullmatch(column.name.strip())):
        return Proposal(f"{m[1]}' [1e-3]", f"its name: 1000 {m[1]}', a prime by the campaign's length")
    if not name:
        if column.is_text:
            return Proposal("label", "text")
        return Proposal("", why + allowed(column.unit, column.name.startswith("se_")) * (why == UNKNOWN))
    said = read_column_map(name)
    if said.name in WORDS:
        return Proposal(name, why, certain)
    if column.is_text and not np.any(np.isfinite(column.values)):
        return Proposal("label", "text")
    said_of = stated or {}
    by = (said_of.get("coefficients.area"), said_of.get("coefficients.length", said_of.get("scaling.length")))
    return _with_unit(column, said, why, certain, by)


def allowed(unit: str, error: bool = False) -> str:
    """What a column, or a standard error, may be by its unit alone, to follow a text; empty where the unit says nothing."""
    words = " ".join(unit.split())
    plain = UNITS.get(words.casefold(), words)
    names = next((said for dimension, said in ALLOWED.items() if _fits(plain, dimension)), "")
    if error and names[:1] in COMPONENTS:
        names = ", ".join(f"se_{name}" for name in names.split(", "))
    return f"; {words}: {names}, or ignore" if names else ""


def _fits(unit: str, dimension: str) -> bool:
    try:
        return bool(unit) and factor(unit, dimension) > 0.0
    except UnitsError:
        return False


def _name(column: RawColumn) -> tuple[str, str, bool]:
    """Plain name, what it rests on, and whether it is certain; of ``Side Force Monitor: Fy`` by both parts."""
    found = _whole_name(column)
    if found[0] or ":" not in column.name:
        return found
    error = "se_" * column.name.startswith("se_")
    parts = [_MONITOR.sub("", p).strip() for p in column.name.removeprefix("se_").split(":")]
    named = dict.fromkeys(n for p in parts if (n := _whole_name(replace(column, name=error + p))[0]))
    if len(named) == 1:
        return next(iter(named)), "its name", False
    return "", f"{' or '.join(named)} by its name" if named else UNKNOWN, False


def _whole_name(column: RawColumn) -> tuple[str, str, bool]:
    """By the name as it stands."""
    if column.means:
        try:
            return str(read_column_map(column.means)), "its format says so", True
        except InputError:
            return "label", f"its format says that it is {column.means}, which no fit uses", True
    own = column.name.strip()
    short = own.replace("′", "'").replace("’", "'")
    plain = short.removeprefix("se_").removesuffix("'")
    if plain in OWN:
        try:
            return str(read_column_map(short)), "its name", True
        except InputError:
            pass
    bare = folded(own)
    error = None if bare in NAMES else _ERROR.search(bare)  # Achse, Bremse
    bare = _ERROR.sub("", bare) if error else bare
    prefix, prime = "se_" if error else "", ""
    if bare.endswith("prime") or short.endswith("'"):
        bare, prime = bare.removesuffix("prime"), "'"
    if wind := WIND_NAMES.get(bare):
        also = "; Cl of aircraft is also the rolling moment, K" if bare == "cl" else ""
        return f"{prefix}{wind}{prime}", f"its name, {TURNED.format(ACROSS[wind])}{also}", False
    single = {c.casefold(): c for c in COMPONENTS} if prime or error else {}
    single |= {c: c for c in (*LINEAR, *ANGULAR)} if prime else {}
    name = NAMES.get(bare) or _with_symbol(own) or single.get(bare) or (COEFFICIENTS.get(bare, "") if not prime else "")
    if not name:
        return "", UNKNOWN, False
    if error and name not in COMPONENTS:
        return "", UNKNOWN, False
    return f"{prefix}{name}{prime}", "its name", False


def _with_symbol(own: str) -> str:
    """Of a name with its symbol behind it, ``Driftwinkel β``, where both say the same."""
    word, _, symbol = own.rpartition(" ")
    name = NAMES.get(folded(word), "")
    same = {*SYMBOLS.get(name, ()), name} - {""}
    return name if symbol.strip("()[], ") in same else ""


def _with_unit(column: RawColumn, said: ColumnMap, why: str, certain: bool, by: tuple[object, object]) -> Proposal:
    unit = " ".join(column.unit.split())
    name = str(said).partition(" [")[0]
    why += f"; {TURN}" * (said.name == "r")
    counted = share(unit) is not None
    if said.primed:
        return Proposal(f"{name} [{unit if counted else '-'}]", why, certain)
    unit = UNITS.get(unit.casefold(), unit)
    moment = said.name in MOMENTS
    is_coefficient = said.name in FORCES and (
        unit in ("-", "1") or counted or (not unit and folded(column.name) in COEFFICIENTS and not certain)
    )
    if is_coefficient:
        area, length = (
            f"{float(str(x))!r} m{u}" if x is not None else OPEN for x, u in zip(by, ("^2", ""), strict=True)
        )
        text = f"{name} [coefficient A={area}" + (f" L={length}]" if moment else "]")
        pure = f"counted in {unit}" if counted else "no unit"
        return Proposal(text, f"{why}, {pure}: by 1/2 rho U^2 A{' L' * moment}, or {name}' for primes", certain)
    try:
        whole = read_column_map(f"{name} [{unit}]") if unit else None
    except InputError:
        return Proposal(f"{name} [{OPEN}]", f"{why}; its unit [{column.unit}] is none of {said.dimension}")
    if whole is not None:
        by_both = why.replace("its name", "its name and unit", 1)
        return Proposal(str(whole), by_both, certain)
    if said.dimension == "angle" and np.nanmax(np.abs(column.values), initial=0.0) > np.pi:
        return Proposal(f"{name} [deg]", f"{why}; beyond half a turn in radians")
    return Proposal(f"{name} [{OPEN}]", f"{why}; no unit is stated, such as {EXAMPLES[said.dimension]}")


def proposals(raw: RawTable) -> tuple[Proposal, ...]:
    """What every column of a table may be; of several that may be the same, or name the rows, only the first keeps it."""
    stated = {key: s.value for key, s in raw.stated.items()}
    offered = any(s.offered for key, s in raw.stated.items() if key.startswith("coefficients."))
    out: list[Proposal] = []
    taken: dict[str, str] = {}
    for column in raw.columns:
        one = proposed(column, stated)
        one = replace(one, certain=False) if offered and "coefficient" in one.text else one
        one = _along_the_body(one, column, raw.stated[BODY_AXES].place) if BODY_AXES in raw.stated else one
        said = read_column_map(one.text.partition(" [")[0]) if one.text else None
        if said is not None and said.name not in ("label", "ignore"):
            if said.name == "point" and (said.plain in taken or _repeats(column)):
                one = Proposal("label", f"{one.why}, but rows share it" if _repeats(column) else one.why, one.certain)
            elif said.plain in taken:
                one = Proposal("", f"{said.plain} is {taken[said.plain]} already")
            else:
                taken[said.plain] = column.name
        out.append(one)
    for i, column in enumerate(raw.columns):
        # V is the speed beside what says where the water comes from; alone it may be a sway velocity in capitals.
        beside = {"alpha", "beta", "R"} & set(taken) and not {"U", "v"} & set(taken)
        if beside and column.name.strip() == "V" and out[i].why.startswith(UNKNOWN) and _fits(column.unit, "speed"):
            out[i] = Proposal(f"U [{column.unit}]", "its unit, beside an angle or a radius")
            taken["U"] = column.name
    return tuple(out)


def _along_the_body(one: Proposal, column: RawColumn, place: str) -> Proposal:
    """A resistance as X of the body, reversed where it is above zero, for words over the table say body axes."""
    if not one.text.removeprefix("se_").startswith("drag") or "coefficient" in one.text or one.certain:
        return one
    known = column.values[np.isfinite(column.values)]
    positive = bool(known.size) and float(np.median(known)) > 0.0
    error = one.text.startswith("se_")
    text = one.text.replace("drag", "-X" if positive and not error else "X", 1)
    note = f"X of the body{', reversed' if positive and not error else ''}: {place}; {one.text} if it is along the flow"
    return Proposal(text, f"{one.why.partition(', along the flow')[0]}, {note}", note=note)


def _repeats(column: RawColumn) -> bool:
    cells = column.texts or tuple(column.values.tolist())
    return len(set(cells)) < len(cells)


@dataclass(frozen=True, slots=True)
class Evidence:
    """What the numbers show.

    Attributes
    ----------
    text : str
    key, value : str
        What of campaign.toml follows from it for a slender body; empty where nothing does.
    against : str
        The rate whose sign or axis it contradicts; empty where it contradicts none.
    instead : str
        The rate of the file that turns about the axis whose force and moment vary; empty where the axis is not contradicted.
    """

    text: str
    key: str = ""
    value: str = ""
    against: str = ""
    instead: str = ""


def turn_of(said: ColumnMap, frame: Axes) -> str:
    """What a positive number in a column of a rate does to the body, such as turns the bow to port."""
    axis = frame.rotation[:, ANGULAR.index(said.name)]
    i = int(np.argmax(np.abs(axis)))
    return TURNS[ANGULAR[i], (float(axis[i]) > 0.0) != said.negative]


def _about_another_axis(data: Mapping[str, Array], frame: Axes) -> Iterator[Evidence]:
    """Rates about an axis whose own force and moment rest while those of the other plane vary."""
    for rate in (m for m in ANGULAR if m in data and np.any(np.nan_to_num(data[m]))):
        about = ANGULAR[int(np.argmax(np.abs(frame.rotation[:, ANGULAR.index(rate)])))]
        if about == rate == "p":
            continue  # roll moves Y and N too, and K is seldom measured
        for other in (m for m in ("q", "r") if m != about):
            found = [c for c in OF_RATE[other] if _varies(data, c, rate, frame)]
            pairs = [(own, c) for own, c in zip(OF_RATE[about], OF_RATE[other], strict=True) if own]
            if not found or any(_span(data, own, frame) > STILL * _span(data, c, frame) for own, c in pairs):
                continue
            instead = ANGULAR[int(np.argmax(np.abs(frame.rotation[ANGULAR.index(other)])))]
            axes = [("forward", "aft"), ("starboard", "port"), ("down", "up")][ANGULAR.index(about)]
            points = axes[float(frame.rotation[ANGULAR.index(about), ANGULAR.index(rate)]) < 0.0]
            named = {"p": "roll", "q": "pitch", "r": "yaw"}
            yield Evidence(
                f"{rate} counts about the {'xyz'[ANGULAR.index(rate)]} axis of the frame, which points {points}: {named[about]}. "
                f"But {' and '.join(found)} of the body vary and {' and '.join(own for own, _ in pairs)} "
                f"{'does' if len(pairs) == 1 else 'do'} not: {named[other]}, which is {instead} in this frame",
                against=rate, instead=instead,
            )  # fmt: skip
            break


def _varies(data: Mapping[str, Array], component: str, rate: str, frame: Axes) -> bool:
    values = _frd(data, component, frame)
    return values is not None and trend(values, data, rate) != 0


def _span(data: Mapping[str, Array], component: str, frame: Axes) -> float:
    values = _frd(data, component, frame)
    known = np.empty(0) if values is None else values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else 0.0


def evidence(columns: Sequence[Assigned], frame: Axes | None = None) -> tuple[Evidence, ...]:
    """What the numbers of a table show of axes and signs.

    Parameters
    ----------
    columns : sequence of Assigned
    frame : Axes, optional
        Of the file, once it is known; without it the sign of an angle stays open.
    """
    data = {one.said.name: one.values for one in columns if one.said.role not in ("word", "error")}
    out = [Evidence(why) for one in columns if (why := unturned(one.column.name, one.said))]
    angles = [one.said.name for one in columns if one.said.role == "angle"]
    for angle, component, flow, side, other in (
        ("beta", "Y", "v", "starboard", "port"), ("alpha", "Z", "w", "down", "up"),
    ):  # fmt: skip
        across, turned_by = ("side", 1.0) if component == "Y" else ("lift", -1.0)
        if across in data and angle in angles and (sign := trend(turned_by * data[across], data, angle)):
            same = "the same sign" if sign * turned_by > 0 else "opposite signs"
            out.append(Evidence(f"{across} and {angle} have {same}, and a slender body has {component}{flow}' < 0",
                                f"axes.{angle}", f"{flow} = {'-' if sign > 0 else '+'}U sin({angle})"))  # fmt: skip
            continue
        force = _frd(data, component, frame) if frame else data.get(component)
        if angle not in angles or force is None or not (sign := trend(force, data, angle)):
            continue
        as_pointed = f"{flow} = {'-' if sign > 0 else '+'}U sin({angle})"
        turned = f"{flow} = {'+' if sign > 0 else '-'}U sin({angle})"
        have = f"{component} and {angle} have {'the same sign' if sign > 0 else 'opposite signs'}"
        if frame is None:
            axis = "yz"[component == "Z"]
            out.append(Evidence(f"{have}: {as_pointed} if {axis} points {side}, {turned} if {axis} points {other}"))
        else:
            of = "" if frame.name == "FRD" else f" to {side}"
            said = f"{component}{of} and {angle}" + have.removeprefix(f"{component} and {angle}")
            out.append(Evidence(f"{said}, and a slender body has {component}{flow}' < 0", f"axes.{angle}", as_pointed))
    for component, rate in (("Y", "v"), ("Z", "w"), ("K", "p"), ("M", "q"), ("N", "r")):
        if component in data and rate in data and (sign := trend(data[component], data, rate)):
            if sign < 0:
                out.append(Evidence(f"{component} and {rate} have opposite signs, as damping has in one set of axes"))
            else:
                out.append(Evidence(
                    f"{component} and {rate} have the same sign: no damping of a slender body; one of them has the "
                    f'other sign (-{rate} or -{component}), or the force contains inertia', against=rate * (rate in ANGULAR)
                ))  # fmt: skip
    crossed = list(_about_another_axis(data, frame)) if frame else []
    out += crossed
    if "r" in data and np.any(np.nan_to_num(data["r"])) and not any(e.against == "r" for e in crossed):
        up = float(frame.rotation[2][2]) if frame else 0.0
        turn = f"r > 0 turns to {'starboard' if up > 0 else 'port'}: it {TURN.partition(':')[0]}"
        out += [Evidence(turn if up else f"r {TURN}")]
    out += _levers(data, {one.said.name: one.said for one in columns}, frame)
    if "drag" in data and np.any(ok := np.isfinite(data["drag"])) and np.all(data["drag"][ok] < 0.0):
        out.append(Evidence("warning: drag is below zero in every row: that is thrust, or -drag is meant"))
    x = _frd(data, "X", frame) if frame else data.get("X")
    x = np.empty(0) if x is None else x[np.isfinite(x)]
    if frame and x.size and np.all(x > 0):
        out.append(Evidence("warning: X is above zero in every row: in FRD that is thrust, not drag" if frame.name == "FRD"
                            else "warning: X turned to FRD is above zero in every row: that is thrust, not drag"))  # fmt: skip
    elif not frame and x.size and (np.all(x > 0) or np.all(x < 0)):
        out.append(Evidence(f"X is {'positive' if x[0] > 0 else 'negative'} throughout: drag, if x points "
                            f"{'aft' if x[0] > 0 else 'forward'}"))  # fmt: skip
    return tuple(out)


def _frd(data: Mapping[str, Array], component: str, frame: Axes) -> Array | None:
    group = next(g for g in (COMPONENTS[:3], COMPONENTS[3:], LINEAR, ANGULAR) if component in g)
    row = frame.rotation[group.index(component)]
    own = group[int(np.argmax(np.abs(row)))]
    return data[own] * float(row[group.index(own)]) if own in data else None


def astern(columns: Sequence[Assigned], frame: Axes) -> Assigned | None:
    """The column along the body's length if in FRD u is below zero in every row."""
    data = {one.said.name: one.values for one in columns if one.said.role == "velocity"}
    u = _frd(data, "u", frame)
    u = np.empty(0) if u is None else u[np.isfinite(u)]
    if not u.size or not np.all(u < 0.0):
        return None
    own = LINEAR[int(np.argmax(np.abs(frame.rotation[0])))]
    return next(one for one in columns if one.said.role == "velocity" and one.said.name == own)


def _levers(data: Mapping[str, Array], said: Mapping[str, ColumnMap], frame: Axes | None) -> list[Evidence]:
    """Where along x the forces act, which M of a left-handed triad contradicts; in FRD once the axes are known."""
    found = {}
    for moment, force, sign in (("N", "Y", 1.0), ("M", "Z", -1.0)):
        both = (_frd(data, moment, frame), _frd(data, force, frame)) if frame else (data.get(moment), data.get(force))
        if both[0] is not None and both[1] is not None:
            ok = np.isfinite(both[0]) & np.isfinite(both[1])
            m, f = both[0][ok], both[1][ok]
            if m.size >= 3 and np.any(f) and np.any(m) and abs(np.dot(m, f)) > CLEAR * np.sqrt((m @ m) * (f @ f)):
                found[moment, force] = sign * float(m @ f) / float(f @ f)
    turning = any(np.any(np.nan_to_num(data[m])) for m in (*ANGULAR, "R") if m in data)
    hull = "" if turning else "; that of a bare hull without large fins acts forward of midships"
    out = []
    for (moment, force), arm in found.items():
        if frame is None:
            out.append(
                Evidence(f"{moment} / {force}: the force acts toward {'+' if arm > 0 else '-'}x of the reference point")
            )
            continue
        kinds = {said[c].pure for c in (moment, force) if c in said}
        coefficient = any(said[c].area for c in (moment, force) if c in said)
        place = (
            "" if coefficient or len(kinds) != 1 else f" (x = {arm:.2g} {'of the length' if kinds == {True} else 'm'})"
        )
        side = "forward" if arm > 0 else "aft"
        out.append(Evidence(f"{moment} / {force}: the force acts {side} of the reference point{place}{hull}"))
    if len(found) == 2 and len({np.sign(arm) for arm in found.values()}) == 2:
        out.append(Evidence("N / Y and M / Z disagree on the side: a left-handed triad, or a sign of Y, Z, M or N"))
    return out


def trend(force: Array, data: Mapping[str, Array], setting: str) -> int:
    """Sign of a force's slope over a setting while the others rest; 0 where it is not clear."""
    x = data[setting]
    ok = np.isfinite(force) & np.isfinite(x)
    still = ok.copy()
    for name, values in data.items():
        if name in ("alpha", "beta", "v", "w", "p", "q", "r", "dr", "ds", "db") and name != setting:
            still &= np.abs(values) <= 1e-6 * max(float(np.nanmax(np.abs(values), initial=0.0)), 1e-12)
    ok = still if np.unique(x[still]).size >= 3 else ok
    if np.unique(x[ok]).size < 3:
        return 0
    dx, df = x[ok] - np.mean(x[ok]), force[ok] - np.mean(force[ok])
    size = np.sqrt(np.dot(dx, dx) * np.dot(df, df))
    shared = float(np.dot(dx, df) / size) if size > 0.0 else 0.0
    return int(np.sign(shared)) if abs(shared) >= CLEAR else 0
